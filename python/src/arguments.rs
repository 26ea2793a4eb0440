//! Conversion of arguments to numbers: numpy arrays, lists, and everything else that numpy converts.

use crate::errors::Refusal;
use numpy::ndarray::Dimension;
use numpy::{PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyOverflowError, PyTypeError, PyValueError};
use pyo3::intern;
use pyo3::prelude::*;
use pyo3::types::{PyList, PyTuple};

/// Returns the numbers of an array with this shape, row by row.
pub fn numbers(object: &Bound<'_, PyAny>, name: &str, shape: &[usize]) -> PyResult<Vec<f64>> {
    let array = as_array(object, name)?;
    if array.shape() != shape {
        let (wanted, found) = (tuple(shape), tuple(array.shape()));
        let text = format!("{name} has the shape {found}: pass an array with the shape {wanted}");
        return Err(Refusal::Argument(text).raise(object.py()));
    }
    let array = array.try_readonly()?;
    Ok(array.as_array().iter().copied().collect())
}

/// Returns the numbers of an array with one dimension.
pub fn list(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    let array = as_array(object, name)?;
    if array.ndim() != 1 {
        let text = format!("{name} has the shape {}: pass an array with the shape (n,)", tuple(array.shape()));
        return Err(Refusal::Argument(text).raise(object.py()));
    }
    let array = array.try_readonly()?;
    Ok(array.as_array().iter().copied().collect())
}

/// Returns three numbers.
pub fn vector(object: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; 3]> {
    // Arrays of float64 with one dimension, lists and tuples are converted quickly. numpy converts all other objects to
    // an array, whose shape is then checked. PyO3's conversion of a sequence would also accept bytes, and with numpy
    // before 2.4 a column, which is an array with the shape (3, 1).
    if let Ok(array) = object.cast::<PyArray1<f64>>() {
        if is_regular(array)
            && let (3, [Some(x), Some(y), Some(z)]) = (array.len(), [0, 1, 2].map(|place| array.get_owned(place)))
        {
            return Ok([x, y, z]);
        }
    } else if (object.is_instance_of::<PyList>() || object.is_instance_of::<PyTuple>())
        && let Ok(numbers) = object.extract::<[f64; 3]>()
    {
        return Ok(numbers);
    }
    let numbers = numbers(object, name, &[3])?;
    Ok([numbers[0], numbers[1], numbers[2]])
}

/// Returns the rows of a 3 x 3 matrix.
pub fn rows(object: &Bound<'_, PyAny>, name: &str) -> PyResult<[[f64; 3]; 3]> {
    if let Ok(array) = object.cast::<PyArray2<f64>>()
        && array.shape() == [3, 3]
        && is_regular(array)
    {
        let entry = |row, column| array.get_owned([row, column]).unwrap_or(f64::NAN);
        return Ok(std::array::from_fn(|row| std::array::from_fn(|column| entry(row, column))));
    }
    let numbers = numbers(object, name, &[3, 3])?;
    Ok(std::array::from_fn(|row| std::array::from_fn(|column| numbers[3 * row + column])))
}

/// Returns the array itself, or a new one with the same numbers as `float64`.
pub fn as_array<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    if let Ok(array) = object.cast::<PyArrayDyn<f64>>()
        && is_regular(array)
    {
        return Ok(array.clone());
    }
    let py = object.py();
    // `numpy.array` copies an irregular array, but `numpy.asarray` returns it unchanged.
    let array = py.import("numpy")?.call_method1(intern!(py, "array"), (object, intern!(py, "float64")));
    Ok(array.map_err(|error| not_numbers(py, name, error))?.cast_into::<PyArrayDyn<f64>>()?)
}

/// Returns the refusal of an argument that numpy does not convert. Returns other exceptions, such as those of signal
/// handlers, unchanged.
fn not_numbers(py: Python<'_>, name: &str, error: PyErr) -> PyErr {
    if !error.is_instance_of::<PyTypeError>(py) && !error.is_instance_of::<PyValueError>(py) {
        return error;
    }
    let text = format!("{name} is no array of numbers ({}): pass numbers", error.value(py));
    let refused = Refusal::Argument(text).raise(py);
    refused.set_cause(py, Some(error));
    refused
}

/// Whether the address of each number of the array is a multiple of the number's size. A column of a structured array
/// can have other addresses, and the crate `numpy` reads such an array at wrong addresses.
fn is_regular<D: Dimension>(array: &Bound<'_, PyArray<f64, D>>) -> bool {
    const SIZE: usize = size_of::<f64>();
    array.data().addr().is_multiple_of(SIZE)
        && array.strides().iter().all(|stride| stride.unsigned_abs().is_multiple_of(SIZE))
}

/// Returns the number of a finger.
pub fn finger(object: &Bound<'_, PyAny>) -> PyResult<i32> {
    let refused = || format!("there is no finger {object}: fingers are 1, 2 and 3");
    in_range(object, object.extract(), refused)
}

/// Returns the number of a finger, or `None` for Python's None.
pub fn some_finger(object: &Bound<'_, PyAny>) -> PyResult<Option<i32>> {
    if object.is_none() { Ok(None) } else { finger(object).map(Some) }
}

/// Returns the numbers of fingers.
pub fn fingers(object: &Bound<'_, PyAny>) -> PyResult<Vec<i32>> {
    object.try_iter()?.map(|number| finger(&number?)).collect()
}

/// Returns the number of a joint.
pub fn joint(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    in_range(object, object.extract(), || format!("there is no joint {object}: joints are 0, 1 and 2"))
}

/// Returns the number of a tactile element.
pub fn element(object: &Bound<'_, PyAny>) -> PyResult<usize> {
    let refused = || format!("there is no tactile element {object}: elements are numbered from 0");
    in_range(object, object.extract(), refused)
}

/// Returns the priority of a reflex.
pub fn priority(object: &Bound<'_, PyAny>) -> PyResult<u8> {
    in_range(object, object.extract(), || format!("there is no priority {object}: pass a number from 0 to 255"))
}

/// Returns the number of a reflex, or `None` for Python's None.
pub fn some_reflex(object: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    let refused = || format!("there is no reflex {object}: use the number that install_reflex has returned");
    in_range(object, object.extract(), refused)
}

/// Refuses an integer that `T` cannot represent, such as a negative one if `T` is unsigned. Python's integers have no
/// limits.
pub fn in_range<T>(object: &Bound<'_, PyAny>, extracted: PyResult<T>, refused: impl FnOnce() -> String) -> PyResult<T> {
    let py = object.py();
    extracted.map_err(|error| match error.is_instance_of::<PyOverflowError>(py) {
        true => Refusal::Argument(refused()).raise(py),
        false => error,
    })
}

fn tuple(shape: &[usize]) -> String {
    let sizes = shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    if shape.len() == 1 { format!("({sizes},)") } else { format!("({sizes})") }
}

/// Returns an attribute, or `None` if its value is Python's None.
pub fn optional<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
    let value = object.getattr(name)?;
    Ok(if value.is_none() { None } else { Some(value) })
}
