//! Size of the part of every thread's stack that the C library uses for itself.
#![allow(unsafe_code, reason = "a function that the libc crate does not have")]

use std::ffi::c_void;
use std::mem::MaybeUninit;

/// Upper bound of the number of bytes that the C library takes from the stack of every thread before the thread runs.
/// glibc puts the thread-local data of the program and of its libraries there, so large `__thread` arrays in a planner
/// increase this number. The bound is the result of glibc's function `__pthread_get_minstack`, which includes a minimum
/// stack. A C library without that function, such as musl, adds the thread-local data to the requested stack size. Such
/// a library takes nothing from the requested stack, so the number is 0.
pub(super) fn taken_by_the_c_library() -> usize {
    // SAFETY: the name is a C string. The returned address is null if no library has a function with this name.
    let function = unsafe { libc::dlsym(libc::RTLD_DEFAULT, c"__pthread_get_minstack".as_ptr()) };
    if function.is_null() {
        return 0;
    }
    // SAFETY: the function has had this type in every glibc since 2.15. The standard library of Rust calls it in the
    // same way.
    let least_stack: unsafe extern "C" fn(*const libc::pthread_attr_t) -> usize =
        unsafe { std::mem::transmute::<*mut c_void, _>(function) };
    let mut attributes = MaybeUninit::uninit();
    // SAFETY: the attributes are initialised before the function reads them, and destroyed once.
    unsafe {
        if libc::pthread_attr_init(attributes.as_mut_ptr()) != 0 {
            return 0;
        }
        let bytes = least_stack(attributes.as_ptr());
        libc::pthread_attr_destroy(attributes.as_mut_ptr());
        bytes
    }
}
