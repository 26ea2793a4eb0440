//! The exported functions. Their comments are the C manual: cbindgen copies them into `include/Sun2Xp.h`, whose opening
//! chapters stand in `cbindgen.toml`. So they are written for C programmers, indented as they shall be read, and must not
//! close a C comment.

// The names of 1990.
#![allow(non_snake_case)]

use crate::capi::default_hand;
use crate::capi::refusal::{self, Refusal, guarded};
use crate::control::calibration::Task;
use crate::finger::Stage;
use crate::hand;
use std::ffi::{c_char, c_int, c_uint, c_ulong};
use std::mem::offset_of;

/// FingerStatus.State: the fingertip is the spring that it was told to be.
pub const FINGER_RUNNING: c_int = 1;

/// FingerStatus.State: the finger has stopped by itself, its motors are in the
/// configured end state, and its calls are refused with EIO and the reason. CloseHand
/// and OpenHand start again.
pub const FINGER_FAULTED: c_int = 2;

/// FingerStatus.State: the motors are off, after a calibration that was refused (which
/// says why). Set points have no effect. Another calibration, or CloseHand and OpenHand,
/// make it a spring again.
pub const FINGER_LIMP: c_int = 3;

/// FingerStatus.State: ZeroFinger or IdentifyFinger moves the finger, or its tendons are
/// brought under tension. Set points have no effect.
pub const FINGER_CALIBRATING: c_int = 4;

/// What GetStatus tells of a finger. Set Size = sizeof (struct FingerStatus) before the
/// call: later versions add members at the end, and a program never gets more than it
/// has room for.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct FingerStatus {
    /// In: bytes of room, sizeof *Status. Out: bytes that were filled, never more.
    pub Size: c_uint,
    /// FINGER_RUNNING, FINGER_FAULTED, FINGER_LIMP or FINGER_CALIBRATING.
    pub State: c_int,
    /// 1: the servo thread runs under SCHED_FIFO. 0: it does not, and shares its core with
    /// everybody.
    pub Realtime: c_int,
    /// Configured servo rate, Hz.
    pub Rate: f64,
    /// Measured servo rate since OpenHand, Hz.
    pub MeasuredRate: f64,
    /// How late cycles began, microseconds: half of them no later than this. The servo's
    /// jitter.
    pub WakeUpMedian: f64,
    /// The same, microseconds: 99 of 100 cycles no later than this.
    pub WakeUp99: f64,
    /// The same, microseconds: the worst since OpenHand.
    pub WakeUpMaximum: f64,
    /// The part of the joint torque that the tension limits let through in the last cycle,
    /// 0 to 1. Its direction is kept.
    pub TorqueScale: f64,
    /// Cycles since OpenHand.
    pub Cycles: c_ulong,
    /// Periods that were skipped because the servo was late.
    pub LateCycles: c_ulong,
    /// Cycles without a valid reply from the board.
    pub LostReplies: c_ulong,
    /// Damaged or foreign frames on the finger's port.
    pub DamagedFrames: c_ulong,
    /// The part of the calibration under way that is done, 0 to 1; 0 where there is none.
    pub Calibration: f64,
}

/// OpenHand - start the hand
///
///     int OpenHand(void);
///
/// Reads the configuration (chapter 8), opens the ports, starts the servos, brings the
/// tendons under tension and returns when every finger has answered and holds the pose
/// it is in, at the configured initial stiffness. So GetPos is valid from then on, and
/// nothing moves until SendPos. Takes about a second at most for the simulated hand.
///
/// Returns 0, or -1 with
///   EBUSY    a hand is open (it goes on), or another thread is just opening or closing one
///   EINVAL   the configuration cannot be used; HandError names file, line and reason
///   ENOENT, EACCES, EBUSY ...  the configuration file or a port cannot be opened; the
///            errno is the system's
///   ETIMEDOUT and other errnos of a link: a board does not answer, or is not one
///   EPERM    forked child
///
/// Threads: any; one hand a process.
///
///     if (OpenHand() != 0) { fprintf(stderr, "%s\n", HandError()); exit(1); }
#[unsafe(no_mangle)]
pub extern "C" fn OpenHand() -> c_int {
    guarded("OpenHand", default_hand::open)
}

/// CloseHand - stop the hand
///
///     int CloseHand(void);
///
/// Brings every finger to the configured end state - release: the torque ramps to zero;
/// hold: the board keeps the last torque, bounded, for a bounded time - and ends the
/// servos. With no hand open it does nothing and returns 0. After it OpenHand may be
/// called again. A planner that exits without it has it called for it.
///
/// Returns 0, or -1 with
///   EPERM    forked child
///
/// Threads: any. Waits for an OpenHand or CloseHand that another thread is in, then
/// closes.
#[unsafe(no_mangle)]
pub extern "C" fn CloseHand() -> c_int {
    guarded("CloseHand", default_hand::close)
}

/// SendPos - send desired joint angles to a finger
///
///     int SendPos(int i, const float *Pos);      also takes const double *Pos (chapter 4)
///
///   i     finger, 1 to 3
///   Pos   Pos[3]: desired angles of joints 0, 1, 2, rad (chapter 3). Read during the call only
///
/// The fingertip's spring is anchored there from the next cycle on, with the stiffness
/// sent last. All three angles take effect together. Does not wait for the finger to
/// arrive: ask GetPos. Limits are the configured joint limits; by default joint 0:
/// -1.0472 to 1.0472, joint 1: -0.5236 to 1.7453, joint 2: 0.0873 to 2.0944.
///
/// Returns 0, or -1 with
///   EFAULT   Pos is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an angle is NaN or infinite
///   ERANGE   an angle is outside the joint limits (or it is clamped: hand.out_of_range)
///   EIO      the finger is faulted
///   EPERM    forked child
///
/// Threads: any. Never waits for a servo; about 100 ns.
///
///     float Pos[3] = {0.0, 0.5, 0.8};
///     SendPos(1, Pos);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendPos(i: c_int, Pos: *const f32) -> c_int {
    guarded("SendPos", || {
        // SAFETY: the manual's contract: null, or the array of the synopsis.
        let joints = unsafe { load::<f32, 3>(Pos, "Pos") }?;
        default_hand::with(|hand| hand.send_position(i, joints.map(f64::from)))
    })
}

/// SendPosD - SendPos for an array of double
///
///     int SendPosD(int i, const double *Pos);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendPosD(i: c_int, Pos: *const f64) -> c_int {
    guarded("SendPosD", || {
        // SAFETY: the manual's contract: null, or the array of the synopsis.
        let joints = unsafe { load::<f64, 3>(Pos, "Pos") }?;
        default_hand::with(|hand| hand.send_position(i, joints))
    })
}

/// SendKx - set the stiffness of a fingertip
///
///     int SendKx(int i, const float *Kx);        also takes const double *Kx (chapter 4)
///
///   i     finger, 1 to 3
///   Kx    Kx[3][3] or Kx[9], row by row: entry [row][column] is the force along axis
///         row (x, y, z of the finger's frame, chapter 3) for a displacement of 1 cm
///         along axis column, N/cm. Read during the call only
///
/// Taken over whole, from the next cycle on and without a jump in torque: 95 % of the
/// change is there after 50 ms. Kx must be symmetric: a difference of up
/// to 1e-3 of the largest entry is averaged away. No eigenvalue may be below -1e-3 of
/// the largest one. Kx of lower rank is fine, and so is zero: the finger is limp along
/// those directions, still damped. The largest eigenvalue may be up to the configured
/// bound, by default 6 N/cm at 1000 Hz and above, and 5 N/cm below.
///
/// Returns 0, or -1 with
///   EFAULT   Kx is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an entry is NaN or infinite
///   EDOM     Kx is not symmetric, or has a negative eigenvalue
///   ERANGE   Kx is stiffer than the bound (or it is clamped: hand.out_of_range)
///   EIO      the finger is faulted
///   EPERM    forked child
///
/// Threads: any. Never waits for a servo; about 1 us.
///
///     double Kx[3][3] = {{3, 0, 0}, {0, 3, 0}, {0, 0, 1}};    soft along z
///     SendKx(1, Kx);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendKx(i: c_int, Kx: *const f32) -> c_int {
    guarded("SendKx", || {
        // SAFETY: the manual's contract: null, or the array of the synopsis.
        let entries = unsafe { load::<f32, 9>(Kx, "Kx") }?;
        default_hand::with(|hand| hand.send_stiffness(i, rows(entries.map(f64::from))))
    })
}

/// SendKxD - SendKx for an array of double
///
///     int SendKxD(int i, const double *Kx);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn SendKxD(i: c_int, Kx: *const f64) -> c_int {
    guarded("SendKxD", || {
        // SAFETY: the manual's contract: null, or the array of the synopsis.
        let entries = unsafe { load::<f64, 9>(Kx, "Kx") }?;
        default_hand::with(|hand| hand.send_stiffness(i, rows(entries)))
    })
}

/// GetPos - read the joint angles of a finger
///
///     int GetPos(int i, float *Pos);             also takes double *Pos (chapter 4)
///
///   i     finger, 1 to 3
///   Pos   Pos[3]: measured angles of joints 0, 1, 2, rad, from the servo's last cycle.
///         Written only if the call returns 0
///
/// Returns 0, or -1 with
///   EFAULT   Pos is null
///   ENODEV   no hand is open
///   EINVAL   no such finger
///   EIO      the finger is faulted
///   EPERM    forked child
///
/// Threads: any. Never waits for a servo; about 100 ns.
///
///     double Pos[3];
///     if (GetPos(2, Pos) == 0) printf("%g %g %g\n", Pos[0], Pos[1], Pos[2]);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetPos(i: c_int, Pos: *mut f32) -> c_int {
    guarded("GetPos", || {
        let joints = non_null(Pos, "Pos").and_then(|_| default_hand::with(|hand| hand.position(i)))?;
        // SAFETY: not null, and room for three by the manual's contract.
        unsafe { Pos.cast::<[f32; 3]>().write_unaligned(joints.map(|joint| joint as f32)) };
        Ok(())
    })
}

/// GetPosD - GetPos for an array of double
///
///     int GetPosD(int i, double *Pos);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetPosD(i: c_int, Pos: *mut f64) -> c_int {
    guarded("GetPosD", || {
        let joints = non_null(Pos, "Pos").and_then(|_| default_hand::with(|hand| hand.position(i)))?;
        // SAFETY: not null, and room for three by the manual's contract.
        unsafe { Pos.cast::<[f64; 3]>().write_unaligned(joints) };
        Ok(())
    })
}

/// HandError - why a call was refused, and what to do about it
///
///     const char *HandError(void);
///
/// The text of the calling thread's last refused call; an empty string if none was. A
/// call that succeeds leaves it, like errno, as it is: look at it after a call has
/// returned -1. Never null. It is the library's: do not free it. It is valid until the
/// next refused call of the same thread.
///
/// Threads: any; each has its own text. Works in a forked child too.
#[unsafe(no_mangle)]
pub extern "C" fn HandError() -> *const c_char {
    refusal::text()
}

/// GetStatus - rate, jitter and losses of a finger's servo
///
///     int GetStatus(int i, struct FingerStatus *Status);
///
///   i        finger, 1 to 3
///   Status   Status->Size is set by the caller, all else is filled in. Written only if
///            the call returns 0
///
/// Works on a faulted finger too.
///
/// Returns 0, or -1 with
///   EFAULT   Status is null
///   EINVAL   Size is too small; no such finger
///   ENODEV   no hand is open
///   EPERM    forked child
///
/// Threads: any.
///
///     struct FingerStatus Status;
///     Status.Size = sizeof Status;
///     if (GetStatus(1, &Status) == 0) printf("%.1f Hz\n", Status.MeasuredRate);
#[unsafe(no_mangle)]
pub unsafe extern "C" fn GetStatus(i: c_int, Status: *mut FingerStatus) -> c_int {
    guarded("GetStatus", || {
        let told = |filled| default_hand::with(|hand| hand.status(i).map(|status| told(&status, filled)));
        // SAFETY: the manual's contract: null, or as much room as its first member says.
        unsafe { fill(Status, "Status", FIRST_SIZE, told) }
    })
}

/// ZeroFinger - find the zeros of a finger's gauges and encoders
///
///     int ZeroFinger(int i);
///
///   i        finger, 1 to 3
///
/// Lets the tendons out and reads the gauges, then finds the zero of the encoders as
/// finger.zeroing.method says: "pose" - the finger stands in the configured pose when the
/// call begins; "stops" - each joint is led slowly against both of its stops, for which
/// the finger needs room; "kept" - the configured zero stays, if the board says that its
/// counts are still good. What was found is in force at once, and is written into the
/// configuration file if OpenHand has read one: only the keys that changed, comments stay.
/// Then the finger holds the pose it is in, at its initial stiffness: while it was limp a
/// free finger has moved, by up to some tenths of a radian.
///
/// Waits until it is done: seconds, up to a minute with "stops". Meanwhile GetStatus tells
/// the part that is done (FingerStatus.Calibration), other calls go on, and set points for
/// this finger have no effect.
///
/// Returns 0, or -1 with
///   ECANCELED  something stood in the way (a tendon is slack, a gauge dead, a joint meets
///              no stop or meets it early ...): the finger is limp, nothing was changed,
///              and HandError says what to do
///   ETIMEDOUT  not finished within finger.zeroing.time_limit_s: the same
///   EBUSY      the finger is being calibrated already
///   ENODEV     no hand is open, or it was closed meanwhile
///   EINVAL     no such finger
///   EIO        the finger is faulted
///   EPERM      forked child
///   EACCES, ENOSPC ...  the configuration file cannot be written; the zeros are in force
///              until CloseHand
///
/// Threads: any.
///
///     if (ZeroFinger(1) != 0) fprintf(stderr, "%s\n", HandError());
#[unsafe(no_mangle)]
pub extern "C" fn ZeroFinger(i: c_int) -> c_int {
    guarded("ZeroFinger", || default_hand::calibrate(i, Task::Zero))
}

/// IdentifyFinger - measure friction and tendon stiffness of a finger
///
///     int IdentifyFinger(int i);
///
///   i        finger, 1 to 3; it must have been zeroed
///
/// Leads the finger to its lower stops, moves each joint to and fro, presses against the
/// stops with up to 0.6 of the largest tension, and returns to where it began. Finds the
/// stiffness of each tendon and the friction of motors, conduits and joints. What was
/// found is in force at once and is written into the configuration file, as by
/// ZeroFinger. Takes about a minute, and the room that the joints can reach.
///
/// Returns and waits as ZeroFinger.
///
/// Threads: any.
#[unsafe(no_mangle)]
pub extern "C" fn IdentifyFinger(i: c_int) -> c_int {
    guarded("IdentifyFinger", || default_hand::calibrate(i, Task::Identify))
}

/// PushFinger - push the fingertip of a simulated finger
///
///     int PushFinger(int i, const double *Force);
///
///   i       finger, 1 to 3
///   Force   Force[3]: force on the fingertip along x, y, z of the finger's frame, N,
///           from now until the next call; zero lets go. Always double. Read during
///           the call only
///
/// Returns 0, or -1 with
///   EFAULT   Force is null
///   ENODEV   no hand is open
///   EINVAL   no such finger; an entry is NaN or infinite
///   ERANGE   a component is beyond 1000 N
///   ENOTSUP  the finger is on a real port
///   EPERM    forked child
///
/// Threads: any.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn PushFinger(i: c_int, Force: *const f64) -> c_int {
    guarded("PushFinger", || {
        // SAFETY: the manual's contract: null, or the array of the synopsis.
        let force = unsafe { load::<f64, 3>(Force, "Force") }?;
        default_hand::with(|hand| hand.push_simulated(i, force))
    })
}

/// The smallest size that a program can have been compiled with: up to the last member
/// of the first version.
const FIRST_SIZE: usize = offset_of!(FingerStatus, DamagedFrames) + size_of::<c_ulong>();

fn told(status: &hand::FingerStatus, filled: usize) -> FingerStatus {
    // Where `unsigned long` has 32 bits a count stops at its largest value.
    let count = |count: u64| c_ulong::try_from(count).unwrap_or(c_ulong::MAX);
    FingerStatus {
        Size: filled as c_uint,
        State: match status.stage {
            Stage::Faulted(_) => FINGER_FAULTED,
            Stage::Limp => FINGER_LIMP,
            Stage::Calibrating | Stage::Opening => FINGER_CALIBRATING,
            Stage::Running | Stage::Closing | Stage::Closed => FINGER_RUNNING,
        },
        Realtime: status.realtime.into(),
        Rate: status.rate,
        MeasuredRate: status.measured_rate,
        WakeUpMedian: status.wake_up.median,
        WakeUp99: status.wake_up.p99,
        WakeUpMaximum: status.wake_up.maximum,
        TorqueScale: status.torque_scale,
        Cycles: count(status.cycles),
        LateCycles: count(status.skipped_periods),
        LostReplies: count(status.lost_replies),
        DamagedFrames: count(status.damaged_frames),
        Calibration: status.calibration,
    }
}

pub(super) fn non_null<T>(pointer: *const T, name: &'static str) -> Result<(), Refusal> {
    if pointer.is_null() { Err(Refusal::Null(name)) } else { Ok(()) }
}

/// Copies an array of the caller's. Unaligned, because a planner may keep it in a
/// packed message.
///
/// # Safety
/// `array` is null or points to `N` entries.
pub(super) unsafe fn load<T, const N: usize>(array: *const T, name: &'static str) -> Result<[T; N], Refusal> {
    non_null(array, name)?;
    // SAFETY: not null, and `N` entries by the contract of this function.
    Ok(unsafe { array.cast::<[T; N]>().read_unaligned() })
}

/// Fills a struct of the caller's whose first member is its Size: at most as much as there is room for. `told` is asked with
/// the number of bytes that will be filled.
///
/// # Safety
/// `out` is null, or points to a Size and to as many bytes as that says.
pub(super) unsafe fn fill<T>(
    out: *mut T,
    name: &'static str,
    least: usize,
    told: impl FnOnce(usize) -> Result<T, Refusal>,
) -> Result<(), Refusal> {
    non_null(out, name)?;
    // SAFETY: not null; the first member is there by the contract. Only it: a program may have less room.
    let size = unsafe { out.cast::<c_uint>().read_unaligned() } as usize;
    if size < least {
        return Err(Refusal::SmallStruct { name, size, least });
    }
    let filled = size.min(size_of::<T>());
    let whole = told(filled)?;
    // SAFETY: `filled` is at most the caller's room and at most the size of `whole`.
    unsafe { (&raw const whole).cast::<u8>().copy_to_nonoverlapping(out.cast(), filled) };
    Ok(())
}

fn rows(entries: [f64; 9]) -> [[f64; 3]; 3] {
    let [a, b, c, d, e, f, g, h, i] = entries;
    [[a, b, c], [d, e, f], [g, h, i]]
}
