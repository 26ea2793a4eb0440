//! Conversion of arguments to numbers: numpy arrays, lists, and everything else that numpy converts.

use crate::errors::Refusal;
use numpy::ndarray::Dimension;
use numpy::{PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::intern;
use pyo3::prelude::*;

/// Returns the numbers of an array with this shape, row by row.
pub fn numbers(object: &Bound<'_, PyAny>, name: &str, shape: &[usize]) -> PyResult<Vec<f64>> {
    let array = as_array(object)?;
    if array.shape() != shape {
        let (wanted, found) = (tuple(shape), tuple(array.shape()));
        let text = format!("{name} has the shape {found}: pass an array with the shape {wanted}");
        return Err(Refusal::Argument(text).raise(object.py()));
    }
    let array = array.try_readonly()?;
    Ok(array.as_array().iter().copied().collect())
}

/// Returns three numbers.
pub fn vector(object: &Bound<'_, PyAny>, name: &str) -> PyResult<[f64; 3]> {
    // These two cases are quick. All others become an array first.
    if let Ok(array) = object.cast::<PyArray1<f64>>() {
        if is_regular(array)
            && let (3, [Some(x), Some(y), Some(z)]) = (array.len(), [0, 1, 2].map(|place| array.get_owned(place)))
        {
            return Ok([x, y, z]);
        }
    } else if let Ok(numbers) = object.extract::<[f64; 3]>() {
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
pub fn as_array<'py>(object: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    if let Ok(array) = object.cast::<PyArrayDyn<f64>>()
        && is_regular(array)
    {
        return Ok(array.clone());
    }
    let py = object.py();
    // `array` copies an irregular array, which `asarray` does not.
    let array = py.import("numpy")?.call_method1(intern!(py, "array"), (object, intern!(py, "float64")))?;
    Ok(array.cast_into::<PyArrayDyn<f64>>()?)
}

/// Whether the address of each number of the array is a multiple of the number's size. A column of a structured array
/// can have other addresses, and the crate `numpy` reads such an array at wrong addresses.
fn is_regular<D: Dimension>(array: &Bound<'_, PyArray<f64, D>>) -> bool {
    const SIZE: usize = size_of::<f64>();
    array.data().addr().is_multiple_of(SIZE)
        && array.strides().iter().all(|stride| stride.unsigned_abs().is_multiple_of(SIZE))
}

fn tuple(shape: &[usize]) -> String {
    let sizes = shape.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
    if shape.len() == 1 { format!("({sizes},)") } else { format!("({sizes})") }
}

/// Returns an attribute; none if it is None.
pub fn optional<'py>(object: &Bound<'py, PyAny>, name: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
    let value = object.getattr(name)?;
    Ok(if value.is_none() { None } else { Some(value) })
}
