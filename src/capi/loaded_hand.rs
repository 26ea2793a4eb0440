//! A hand on another machine, through libsun2xp_remote.so: each call is passed on, and each refusal is passed back.

use crate::calibration::Task;
use crate::capi::error_calls::sun2xp_error;
use crate::capi::error_numbers::SUN2XP_ERROR_DEFECT;
use crate::capi::event_struct::sun2xp_event;
use crate::capi::fault_struct::sun2xp_fault;
use crate::capi::fingertip_struct::sun2xp_tip;
use crate::capi::group_calls::{SUN2XP_WAIT_ARRIVED, SUN2XP_WAIT_SETTLED, sun2xp_set_point};
use crate::capi::handle::sun2xp_hand;
use crate::capi::limits_struct::sun2xp_limits;
use crate::capi::remedy_calls::{Interface, named};
use crate::capi::remote_hand::{RemoteHand, RemoteRefusal, RemoteSource};
use crate::capi::remote_library::{self, RemoteLibrary};
use crate::capi::status_struct::sun2xp_status;
use crate::finger::stop_calls;
use crate::hand::{FingerCommand, Pose, Until};
use crate::model::configuration::Configuration;
use crate::realtime::Mutex;
use std::collections::VecDeque;
use std::ffi::{CStr, CString, c_char, c_int};
use std::mem::MaybeUninit;
use std::os::unix::ffi::OsStringExt;
use std::ptr::{null, null_mut};
use std::sync::Arc;
use std::sync::atomic::{AtomicPtr, Ordering};
use std::time::Duration;

struct LoadedHand {
    library: &'static RemoteLibrary,
    /// The other library's handle; null when the hand is closed. It is never dereferenced.
    handle: AtomicPtr<sun2xp_hand>,
    /// Events that `wait_for_event` has taken from the other library, and that `next_event` has not returned yet.
    waiting: Mutex<VecDeque<sun2xp_event>>,
}

/// Loads the library, and opens a hand with it.
pub(super) fn open(source: RemoteSource, _: &Configuration) -> Result<Arc<dyn RemoteHand>, RemoteRefusal> {
    let stop_calls_seen = stop_calls();
    let library = remote_library::load()?;
    let (open, argument) = match source {
        RemoteSource::File(path) => (library.open, path.into_os_string().into_vec()),
        RemoteSource::Text(text) => (library.open_text, text.into_bytes()),
    };
    // The argument contains no zero byte: a text was a C string, and a path names a file that has been read.
    let argument = CString::new(argument).unwrap_or_default();
    let mut handle = null_mut();
    // SAFETY: the argument is a C string, and there is room for the handle.
    let result = unsafe { open(argument.as_ptr(), &raw mut handle) };
    if result != 0 {
        return Err(last_refusal(library, null()));
    }
    // A call of `stop_all` during this opening may have come before the library was loaded, and then did not reach the
    // library. So it is repeated here.
    if stop_calls() != stop_calls_seen {
        (library.stop_all)();
    }
    Ok(Arc::new(LoadedHand { library, handle: AtomicPtr::new(handle), waiting: Mutex::default() }))
}

/// Stops all hands of the loaded library. Async-signal-safe.
pub(super) fn stop_all() {
    if let Some(library) = remote_library::loaded() {
        (library.stop_all)();
    }
}

impl LoadedHand {
    fn handle(&self) -> *mut sun2xp_hand {
        self.handle.load(Ordering::Acquire)
    }

    /// The result of a call of the other library: a number that is not negative, or the refusal.
    fn result(&self, result: c_int) -> Result<c_int, RemoteRefusal> {
        if result < 0 { Err(last_refusal(self.library, self.handle())) } else { Ok(result) }
    }

    fn done(&self, result: c_int) -> Result<(), RemoteRefusal> {
        self.result(result).map(drop)
    }

    /// Gets a struct that begins with its size.
    fn filled<T: Copy>(
        &self,
        get: unsafe extern "C" fn(*mut sun2xp_hand, c_int, *mut T) -> c_int,
        finger: c_int,
    ) -> Result<T, RemoteRefusal> {
        let mut place = sized();
        // SAFETY: the struct has its size, and the function fills it.
        self.done(unsafe { get(self.handle(), finger, place.as_mut_ptr()) })?;
        // SAFETY: all bytes are initialised, and every member is a number.
        Ok(unsafe { place.assume_init() })
    }

    /// Returns the event that `take` takes, or none if there was no event. `take` returns 1 if it took an event.
    fn taken_by(&self, take: impl FnOnce(*mut sun2xp_event) -> c_int) -> Result<Option<sun2xp_event>, RemoteRefusal> {
        let mut event = sized();
        let taken = self.result(take(event.as_mut_ptr()))?;
        // SAFETY: all bytes are initialised, and every member is a number.
        Ok((taken == 1).then(|| unsafe { event.assume_init() }))
    }
}

/// A struct of `sun2xp.h` whose size is set and whose other members are zero.
fn sized<T: Copy>() -> MaybeUninit<T> {
    let mut place: MaybeUninit<T> = MaybeUninit::zeroed();
    // SAFETY: every struct of `sun2xp.h` begins with its size.
    unsafe { place.as_mut_ptr().cast::<usize>().write(size_of::<T>()) };
    place
}

/// The refusal that the other library has stored for this thread.
fn last_refusal(library: &RemoteLibrary, handle: *const sun2xp_hand) -> RemoteRefusal {
    let mut error = sized::<sun2xp_error>();
    // SAFETY: the struct has its size. On success its texts are C strings, which are valid until the next refusal.
    let reported = unsafe {
        ((library.error)(handle, error.as_mut_ptr()) == 0).then(|| {
            let error = error.assume_init();
            let text = |text: *const c_char| CStr::from_ptr(text).to_string_lossy().into_owned();
            (error.number, error.system_errno, text(error.call), text(error.text), text(error.remedy))
        })
    };
    let Some((number, errno, call, text, remedy)) = reported.filter(|reported| reported.0 != 0) else {
        let text = "libsun2xp_remote gave no reason: please report this defect of the library".into();
        return RemoteRefusal::Other { number: SUN2XP_ERROR_DEFECT, errno: libc::EIO, text, actions: Vec::new() };
    };
    // The name of the call and the remedy are removed here, because `reporting::refuse` adds the name of the call that
    // the planner made, and the remedy.
    let text = text.strip_prefix(&format!("{call}: ")).unwrap_or(&text);
    let text = text.strip_suffix(&format!(" ({remedy})")).unwrap_or(text).to_owned();
    RemoteRefusal::Other { number, errno, text, actions: named(&remedy, Interface::Handles) }
}

fn pointer<const N: usize>(numbers: Option<&[f64; N]>) -> *const f64 {
    numbers.map_or(null(), |numbers| numbers.as_ptr())
}

fn set_point(command: &FingerCommand) -> sun2xp_set_point {
    let (position, tip) = match &command.pose {
        Some(Pose::Joints(joints)) => (Some(joints), None),
        Some(Pose::Tip(tip)) => (None, Some(tip)),
        None => (None, None),
    };
    sun2xp_set_point {
        size: size_of::<sun2xp_set_point>(),
        finger: command.finger,
        position: pointer(position),
        tip: pointer(tip),
        stiffness: command.stiffness.as_ref().map_or(null(), |rows| rows.as_ptr().cast()),
        damping: command.damping.unwrap_or_default(),
    }
}

impl RemoteHand for LoadedHand {
    fn send(&self, commands: &[FingerCommand]) -> Result<(), RemoteRefusal> {
        if commands.is_empty() {
            // An empty group commands no finger, so it is not passed on.
            return Ok(());
        }
        let (library, hand) = (self.library, self.handle());
        // SAFETY: in each call, the pointers are those of arrays that exist during the call.
        let result = unsafe {
            match commands {
                // A command for one quantity of one finger uses the call for that quantity, which has refusals of its
                // own. sun2xp_send_group would also treat a damping of 0 as no command for the damping.
                [FingerCommand { finger, pose: Some(Pose::Joints(joints)), stiffness: None, damping: None, .. }] => {
                    (library.send_position)(hand, *finger, joints.as_ptr())
                }
                [FingerCommand { finger, pose: Some(Pose::Tip(tip)), stiffness: None, damping: None, .. }] => {
                    (library.send_tip)(hand, *finger, tip.as_ptr())
                }
                [FingerCommand { finger, pose: None, stiffness: Some(rows), damping: None, .. }] => {
                    (library.send_stiffness)(hand, *finger, rows.as_ptr().cast())
                }
                [FingerCommand { finger, pose: None, stiffness: None, damping: Some(ratio), .. }] => {
                    (library.send_damping)(hand, *finger, *ratio)
                }
                _ => {
                    let set_points: Vec<_> = commands.iter().map(set_point).collect();
                    (library.send_group)(hand, set_points.len() as c_int, set_points.as_ptr())
                }
            }
        };
        self.done(result)
    }

    fn position(&self, finger: c_int) -> Result<[f64; 3], RemoteRefusal> {
        let mut joints = [0.0; 3];
        // SAFETY: there is room for three angles.
        self.done(unsafe { (self.library.position)(self.handle(), finger, joints.as_mut_ptr()) })?;
        Ok(joints)
    }

    fn tip(&self, finger: c_int) -> Result<sun2xp_tip, RemoteRefusal> {
        self.filled(self.library.tip, finger)
    }

    fn status(&self, finger: c_int) -> Result<sun2xp_status, RemoteRefusal> {
        self.filled(self.library.status, finger)
    }

    fn limits(&self, finger: c_int) -> Result<sun2xp_limits, RemoteRefusal> {
        self.filled(self.library.limits, finger)
    }

    fn fault(&self, finger: c_int) -> Result<sun2xp_fault, RemoteRefusal> {
        self.filled(self.library.fault, finger)
    }

    fn stop(&self, finger: c_int) -> Result<(), RemoteRefusal> {
        self.done((self.library.stop)(self.handle(), finger))
    }

    fn recover(&self, finger: c_int) -> Result<(), RemoteRefusal> {
        self.done((self.library.recover)(self.handle(), finger))
    }

    fn calibrate(&self, finger: c_int, task: Task) -> Result<(), RemoteRefusal> {
        match task {
            Task::Zero => self.done((self.library.zero)(self.handle(), finger)),
            _ => self.done((self.library.identify)(self.handle(), finger)),
        }
    }

    fn wait(&self, finger: c_int, until: Until, limit: Duration) -> Result<(), RemoteRefusal> {
        let until = match until {
            Until::Arrived => SUN2XP_WAIT_ARRIVED,
            _ => SUN2XP_WAIT_SETTLED,
        };
        self.done((self.library.wait)(self.handle(), finger, until, limit.as_secs_f64()))
    }

    fn next_event(&self) -> Result<Option<sun2xp_event>, RemoteRefusal> {
        let waiting = self.waiting.lock().pop_front();
        if waiting.is_some() {
            return Ok(waiting);
        }
        let next_event = self.library.next_event;
        // SAFETY: `taken_by` passes room for an event.
        self.taken_by(|event| unsafe { next_event(self.handle(), event) })
    }

    fn wait_for_event(&self, limit: Option<Duration>) -> Result<(), RemoteRefusal> {
        if !self.waiting.lock().is_empty() {
            return Ok(());
        }
        let seconds = limit.map_or(-1.0, |limit| limit.as_secs_f64());
        let wait_event = self.library.wait_event;
        // SAFETY: `taken_by` passes room for an event.
        let taken = self.taken_by(|event| unsafe { wait_event(self.handle(), event, seconds) })?;
        self.waiting.lock().extend(taken);
        Ok(())
    }

    fn close(&self) {
        let handle = self.handle.swap(null_mut(), Ordering::AcqRel);
        if !handle.is_null() {
            // The call is refused only if the hand is closed already.
            (self.library.close)(handle);
        }
    }
}
