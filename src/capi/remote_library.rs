//! Loads libsun2xp_remote.so, which reaches hands on other machines. Its interface is that of `sun2xp.h`, so this file
//! contains no network code. libsun2xp is not linked to libsun2xp_remote.so. It loads that library only for a
//! configuration with a table `[remote]`.

use crate::capi::error_calls::sun2xp_error;
use crate::capi::error_numbers::SUN2XP_ERROR_SYSTEM;
use crate::capi::event_struct::sun2xp_event;
use crate::capi::fault_struct::sun2xp_fault;
use crate::capi::fingertip_struct::sun2xp_tip;
use crate::capi::group_calls::sun2xp_set_point;
use crate::capi::handle::sun2xp_hand;
use crate::capi::limits_struct::sun2xp_limits;
use crate::capi::log_calls::{SUN2XP_LOG_WARNING, sun2xp_log};
use crate::capi::remote_hand::RemoteRefusal;
use crate::capi::status_struct::sun2xp_status;
use crate::capi::version_calls::{SUN2XP_ABI_VERSION, version_number};
use crate::realtime::{Mutex, Severity, report};
use std::ffi::{CStr, CString, OsStr, c_char, c_int, c_uint, c_void};
use std::os::unix::ffi::OsStrExt;
use std::path::Path;
use std::sync::OnceLock;

const VERSION: &str = env!("CARGO_PKG_VERSION");

type Hand = *mut sun2xp_hand;

/// Declares the functions of libsun2xp_remote.so that libsun2xp calls.
macro_rules! functions {
    ($($name:ident: $type:ty;)*) => {
        /// The functions of the loaded library, with the types of `sun2xp.h`.
        pub(super) struct RemoteLibrary {
            $(pub $name: $type,)*
        }

        impl RemoteLibrary {
            /// # Safety
            /// `library` is a handle of dlopen, and its functions have the types of `sun2xp.h`.
            unsafe fn find(library: *mut c_void) -> Option<Self> {
                // SAFETY: by the contract of this function, each address is that of a function with the given type.
                unsafe {
                    Some(Self {
                        $($name: {
                            let name = concat!("sun2xp_", stringify!($name), "\0");
                            let address = libc::dlsym(library, name.as_ptr().cast());
                            if address.is_null() {
                                return None;
                            }
                            std::mem::transmute::<*mut c_void, $type>(address)
                        },)*
                    })
                }
            }
        }
    };
}

functions! {
    abi_version: extern "C" fn() -> c_uint;
    version_number: extern "C" fn() -> c_uint;
    set_log: extern "C" fn(sun2xp_log, *mut c_void) -> c_int;
    error: unsafe extern "C" fn(*const sun2xp_hand, *mut sun2xp_error) -> c_int;
    open: unsafe extern "C" fn(*const c_char, *mut Hand) -> c_int;
    open_text: unsafe extern "C" fn(*const c_char, *mut Hand) -> c_int;
    close: extern "C" fn(Hand) -> c_int;
    send_position: unsafe extern "C" fn(Hand, c_int, *const f64) -> c_int;
    send_stiffness: unsafe extern "C" fn(Hand, c_int, *const f64) -> c_int;
    send_tip: unsafe extern "C" fn(Hand, c_int, *const f64) -> c_int;
    send_damping: extern "C" fn(Hand, c_int, f64) -> c_int;
    send_group: unsafe extern "C" fn(Hand, c_int, *const sun2xp_set_point) -> c_int;
    position: unsafe extern "C" fn(Hand, c_int, *mut f64) -> c_int;
    tip: unsafe extern "C" fn(Hand, c_int, *mut sun2xp_tip) -> c_int;
    status: unsafe extern "C" fn(Hand, c_int, *mut sun2xp_status) -> c_int;
    limits: unsafe extern "C" fn(Hand, c_int, *mut sun2xp_limits) -> c_int;
    fault: unsafe extern "C" fn(Hand, c_int, *mut sun2xp_fault) -> c_int;
    stop_all: extern "C" fn() -> c_int;
    stop: extern "C" fn(Hand, c_int) -> c_int;
    recover: extern "C" fn(Hand, c_int) -> c_int;
    zero: extern "C" fn(Hand, c_int) -> c_int;
    identify: extern "C" fn(Hand, c_int) -> c_int;
    wait: extern "C" fn(Hand, c_int, c_int, f64) -> c_int;
    next_event: unsafe extern "C" fn(Hand, *mut sun2xp_event) -> c_int;
    wait_event: unsafe extern "C" fn(Hand, *mut sun2xp_event, f64) -> c_int;
}

static LOADED: OnceLock<RemoteLibrary> = OnceLock::new();

/// The loaded library; none if no configuration needed it so far. Async-signal-safe.
pub(super) fn loaded() -> Option<&'static RemoteLibrary> {
    LOADED.get()
}

/// The file name of libsun2xp_remote.so, which ends with the ABI number.
fn file_name() -> String {
    format!("libsun2xp_remote.so.{SUN2XP_ABI_VERSION}")
}

/// libsun2xp_remote.so is in this subfolder of the folder of libsun2xp. It has the soname of libsun2xp, so it is not
/// installed in a folder that the loader searches by default: there it could take the place of libsun2xp.
const FOLDER: &str = "sun2xp-remote";

/// Loads the library from the place where it is installed. If it is not there, the loader searches for it. The library
/// stays loaded.
pub(super) fn load() -> Result<&'static RemoteLibrary, RemoteRefusal> {
    static LOADING: Mutex<()> = Mutex::new(());
    let _loading = LOADING.lock();
    if let Some(library) = loaded() {
        return Ok(library);
    }
    let name = file_name();
    let installed = own_folder().map(|folder| folder.join(FOLDER).join(&name)).filter(|path| path.exists());
    let place = installed.as_deref().unwrap_or(Path::new(&name));
    let file = CString::new(place.as_os_str().as_bytes()).unwrap_or_default();
    // SAFETY: the name is a C string. The initialisers of the library are those of this project.
    let library = unsafe { libc::dlopen(file.as_ptr(), libc::RTLD_NOW | libc::RTLD_LOCAL) };
    if library.is_null() {
        return Err(refusal(
            libc::ELIBACC,
            format!(
                "the configuration has a table [remote], and {name} cannot be loaded ({}): install it (make \
                 install-remote), or add its folder to LD_LIBRARY_PATH",
                loader_error()
            ),
        ));
    }
    // SAFETY: the library has the name and the ABI number of the library of this project.
    let found = unsafe { RemoteLibrary::find(library) };
    let same = |library: &RemoteLibrary| {
        (library.abi_version)() == SUN2XP_ABI_VERSION && (library.version_number)() == version_number()
    };
    let Some(library) = found.filter(same) else {
        return Err(refusal(
            libc::ELIBBAD,
            format!(
                "{} does not have version {VERSION}: install it and libsun2xp from the same version",
                place.display()
            ),
        ));
    };
    // Only warnings are passed on, because libsun2xp itself reports the refusals of the remote library.
    (library.set_log)(Some(pass_on_warning), std::ptr::null_mut());
    Ok(LOADED.get_or_init(|| library))
}

fn refusal(errno: c_int, text: String) -> RemoteRefusal {
    RemoteRefusal::Other { number: SUN2XP_ERROR_SYSTEM, errno, text, actions: Vec::new() }
}

extern "C" fn pass_on_warning(severity: c_int, text: *const c_char, _: *mut c_void) {
    if severity == SUN2XP_LOG_WARNING {
        // SAFETY: the library passes a C string, which is valid during this call.
        report(Severity::Warning, &unsafe { CStr::from_ptr(text) }.to_string_lossy());
    }
}

/// The folder from which this library was loaded.
fn own_folder() -> Option<std::path::PathBuf> {
    let mut found = std::mem::MaybeUninit::<libc::Dl_info>::zeroed();
    let own: fn() -> Option<std::path::PathBuf> = own_folder;
    // SAFETY: the address is that of a function of this library, and there is room for the result.
    let known = unsafe { libc::dladdr(own as *const c_void, found.as_mut_ptr()) } != 0;
    // SAFETY: all bytes of the result are initialised.
    let name = unsafe { found.assume_init() }.dli_fname;
    if !known || name.is_null() {
        return None;
    }
    // SAFETY: the loader gives a C string, which stays valid because this library stays loaded.
    let path = Path::new(OsStr::from_bytes(unsafe { CStr::from_ptr(name) }.to_bytes()));
    path.parent().filter(|folder| folder.is_absolute()).map(Path::to_path_buf)
}

fn loader_error() -> String {
    // SAFETY: the C library gives a C string or null. It is valid until the thread's next call of the loader.
    let text = unsafe { libc::dlerror() };
    if text.is_null() {
        return "no reason is known".into();
    }
    // SAFETY: as above.
    unsafe { CStr::from_ptr(text) }.to_string_lossy().into_owned()
}
