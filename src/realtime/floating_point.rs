//! The floating-point environment: rounding, flushing of denormals, and exception traps. Every thread has its own. A
//! new thread inherits the environment of the thread that starts it. The library always computes in the default
//! environment: the planner's environment must neither stop a servo nor change the last bit of a result.
//!
//! On x86-64, [`Environment`] changes only MXCSR, because nothing in this library uses the x87 unit.
#![allow(unsafe_code, reason = "no Rust function reads or writes these registers")]

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
use other as registers;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use processor as registers;

/// The environment that a thread had before it entered the default one. [`Environment::restore`] restores it.
#[must_use]
pub struct Environment(registers::Saved);

impl Environment {
    /// Enters the default environment.
    #[inline(always)]
    pub fn enter_default() -> Self {
        let saved = registers::read();
        if !registers::computes_as_default(&saved) {
            registers::write_default();
        }
        Self(saved)
    }

    /// Restores the environment, including its exception flags.
    #[inline(always)]
    pub fn restore(self) {
        registers::restore(&self.0);
    }
}

/// Puts the calling thread into the default environment permanently.
pub fn use_default_environment() {
    registers::write_default();
    #[cfg(target_arch = "x86_64")]
    // SAFETY: the instruction resets the x87 unit, in which no Rust code keeps a value.
    unsafe {
        std::arch::asm!("fninit", out("st(0)") _, out("st(1)") _, out("st(2)") _, out("st(3)") _, out("st(4)") _,
            out("st(5)") _, out("st(6)") _, out("st(7)") _, options(nostack));
    }
}

#[cfg(target_arch = "x86_64")]
mod processor {
    use std::arch::asm;

    /// MXCSR.
    pub type Saved = u32;

    /// Round to nearest, keep denormals, no exception traps.
    const DEFAULT: u32 = 0x1f80;

    /// The flags of the exceptions that have occurred.
    const FLAGS: u32 = 0x3f;

    #[inline(always)]
    pub fn read() -> u32 {
        let mut register = 0u32;
        // SAFETY: the instruction stores the register in a local variable.
        unsafe { asm!("stmxcsr [{}]", in(reg) &mut register, options(nostack, preserves_flags)) };
        register
    }

    #[inline(always)]
    fn write(register: u32) {
        // SAFETY: `register` was read from MXCSR or is its default, so no reserved bit is set.
        unsafe { asm!("ldmxcsr [{}]", in(reg) &register, options(nostack, preserves_flags)) };
    }

    #[inline(always)]
    pub fn computes_as_default(saved: &u32) -> bool {
        saved & !FLAGS == DEFAULT
    }

    #[inline(always)]
    pub fn write_default() {
        write(DEFAULT);
    }

    /// Writes the register without comparing it first, because reading it takes longer than writing it.
    #[inline(always)]
    pub fn restore(saved: &u32) {
        write(*saved);
    }
}

#[cfg(target_arch = "aarch64")]
mod processor {
    use std::arch::asm;

    /// FPCR and FPSR.
    pub type Saved = (u64, u64);

    #[inline(always)]
    pub fn read() -> (u64, u64) {
        let (control, status): (u64, u64);
        // SAFETY: the code reads two registers. `nomem` is not set, so that no access to memory moves across the code.
        unsafe {
            asm!("mrs {}, fpcr", "mrs {}, fpsr", out(reg) control, out(reg) status, options(nostack, preserves_flags))
        };
        (control, status)
    }

    #[inline(always)]
    pub fn computes_as_default(saved: &(u64, u64)) -> bool {
        saved.0 == 0
    }

    #[inline(always)]
    pub fn write_default() {
        // SAFETY: zero is the default of FPCR: round to nearest, keep denormals, no exception traps.
        unsafe { asm!("msr fpcr, {}", in(reg) 0u64, options(nostack, preserves_flags)) };
    }

    #[inline(always)]
    pub fn restore(saved: &(u64, u64)) {
        let (control, status) = read();
        // SAFETY: both values were read from these registers.
        unsafe {
            if control != saved.0 {
                asm!("msr fpcr, {}", in(reg) saved.0, options(nostack, preserves_flags));
            }
            if status != saved.1 {
                asm!("msr fpsr, {}", in(reg) saved.1, options(nostack, preserves_flags));
            }
        }
    }
}

#[cfg_attr(any(target_arch = "x86_64", target_arch = "aarch64"), allow(dead_code, reason = "only tests use it"))]
mod other {
    //! For other processors: C functions, which take ten times as long as direct access to the registers.

    use std::ffi::c_int;

    /// Room for a fenv_t. No known fenv_t is larger.
    #[repr(C, align(16))]
    pub struct Saved([u8; 64]);

    // These functions are in the mathematical library, which Rust's standard library links.
    unsafe extern "C" {
        fn fegetenv(environment: *mut Saved) -> c_int;
        fn fesetenv(environment: *const Saved) -> c_int;
    }

    pub fn read() -> Saved {
        let mut saved = Saved([0; 64]);
        // SAFETY: there is room for the environment.
        unsafe { fegetenv(&mut saved) };
        saved
    }

    /// The environment cannot be inspected, so the default is always written.
    pub fn computes_as_default(_: &Saved) -> bool {
        false
    }

    pub fn write_default() {
        // SAFETY: the address -1 is FE_DFL_ENV in the C libraries of Linux, except on PowerPC and Alpha.
        unsafe { fesetenv(std::ptr::without_provenance(usize::MAX)) };
    }

    pub fn restore(saved: &Saved) {
        // SAFETY: `saved` was written by `fegetenv`.
        unsafe { fesetenv(saved) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::c_int;
    use std::hint::black_box;

    unsafe extern "C" {
        fn fesetround(rounding: c_int) -> c_int;
        fn fegetround() -> c_int;
        fn fetestexcept(flags: c_int) -> c_int;
        fn feclearexcept(flags: c_int) -> c_int;
    }

    #[cfg(target_arch = "x86_64")]
    const UPWARD: c_int = 0x800;
    #[cfg(target_arch = "aarch64")]
    const UPWARD: c_int = 0x40_0000;
    const EVERY_FLAG: c_int = 0x1f;

    /// One third, with the rounding of the calling thread.
    fn third() -> f64 {
        black_box(1.0) / black_box(3.0)
    }

    /// Computes one third between `enter` and `restore` in a thread that rounds upward.
    fn check<E>(enter: impl FnOnce() -> E, restore: impl FnOnce(E)) {
        let nearest = third();
        // SAFETY: the C functions take no pointer. The rounding of this thread is restored below.
        unsafe { fesetround(UPWARD) };
        let upward = third();
        unsafe { feclearexcept(EVERY_FLAG) };
        let before = enter();
        let within = third();
        restore(before);
        let found = unsafe { (fegetround(), fetestexcept(EVERY_FLAG)) };
        unsafe { fesetround(0) };
        assert_ne!(nearest, upward);
        assert_eq!(within, nearest);
        assert_eq!(found, (UPWARD, 0), "rounding and flags");
    }

    #[test]
    fn the_default_environment_is_entered_and_left_without_a_trace() {
        check(Environment::enter_default, Environment::restore);
    }

    #[test]
    fn the_c_functions_do_the_same() {
        let enter = || {
            let saved = other::read();
            assert!(!other::computes_as_default(&saved));
            other::write_default();
            saved
        };
        check(enter, |saved| other::restore(&saved));
    }

    #[test]
    fn a_thread_can_use_the_default_environment_for_good() {
        let nearest = third();
        let thread = std::thread::spawn(move || {
            // SAFETY: the C function takes no pointer.
            unsafe { fesetround(UPWARD) };
            use_default_environment();
            // SAFETY: the C function takes no pointer.
            (third(), unsafe { fegetround() })
        });
        assert_eq!(thread.join().expect("no panic"), (nearest, 0));
    }
}
