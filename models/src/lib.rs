//! Model checking of the lock-free code of sun2xp. This package compiles the lock-free files of the library a second
//! time. Their atomic types are those of loom, which runs the threads of a check in every order that the memory model
//! of C++ allows, up to a number of preemptions. `docs/deadlock.md` describes the checks.
//!
//! The models for spin are in `promela/`.

// The unit tests in the library's files use the library's own atomic types, so they are not run here.
#![cfg(not(test))]

#[allow(missing_docs, dead_code)]
#[path = "../../src/realtime"]
mod realtime {
    #[path = "../../models/src/atomics.rs"]
    pub mod atomics;
    mod clock;
    mod locks;
    mod memory;
    mod pages;
    mod ring;
    mod triple_buffer;

    pub use locks::Mutex;
    pub use memory::LockedMemory;
    pub use pages::{Pages, SharedPages};
    pub use ring::{Consumer, Producer, ring};
    pub use triple_buffer::{Input, Output, triple_buffer, triple_buffer_of};
}

mod control {
    pub use sun2xp::control::{SetPoint, motion};
}

mod model {
    pub use sun2xp::model::{FingerNumber, configuration};
}

#[allow(missing_docs, dead_code)]
#[path = "../../src/finger"]
mod finger {
    pub mod events {
        #[path = "../../../models/src/event_log_checks.rs"]
        pub mod event_log_checks;
        mod log;

        mod words {
            pub const WORDS: usize = 2;
        }

        use crate::model::FingerNumber;
        use words::WORDS;

        /// Takes the place of the event, whose many words would take loom too long.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Event {
            pub finger: FingerNumber,
            pub cycle: u64,
            pub time: u64,
            pub kind: (),
            pub part: (),
            pub values: (),
        }

        /// Takes the place of the occurrence, which is an event without its finger, cycle and time.
        pub struct Occurrence {
            pub kind: (),
            pub part: (),
            pub values: (),
        }

        impl Event {
            fn to_words(self) -> [u64; WORDS] {
                [self.cycle, self.time]
            }

            fn from_words(&[cycle, time]: &[u64; WORDS]) -> Option<Self> {
                Some(Self { finger: FingerNumber::ONE, cycle, time, kind: (), part: (), values: () })
            }
        }
    }
    #[path = "../../models/src/group_checks.rs"]
    pub mod group_checks;
    mod group_gate;
    mod mailbox;
    #[path = "../../models/src/mailbox_checks.rs"]
    pub mod mailbox_checks;
    mod sent;
    mod stop_signal;
    #[path = "../../models/src/stop_signal_checks.rs"]
    pub mod stop_signal_checks;
    mod validity;

    pub use group_gate::GroupGate;
    pub use sent::Replaced;
    pub use stop_signal::{StopCounts, stop_calls};
    pub use sun2xp::finger::{Fault, FaultKind, FingerReport, Stage};
    pub use validity::Validity;

    /// Takes the place of the controller, of which several copies would not fit on the stack that loom gives a thread.
    #[derive(Clone)]
    pub struct Adjustable {
        pub number: u32,
    }

    /// Takes the place of the path, without its large tables, which have pages of their own.
    mod path_buffer {
        use crate::control::motion::PathTable;
        use crate::realtime::LockedMemory;
        use nalgebra::Matrix6;

        pub struct PathBuffer {
            pub number: u32,
            pub origin: u64,
        }

        impl PathBuffer {
            pub fn new(_: &mut LockedMemory) -> Self {
                Self { number: 0, origin: 0 }
            }

            pub fn fill(&mut self, number: u32, origin: u64, _: Option<Matrix6<f64>>, _: &PathTable) {
                (self.number, self.origin) = (number, origin);
            }
        }
    }

    /// Takes the place of the orders, which contain controllers.
    #[derive(Clone)]
    pub enum Order {
        Nothing,
        Restart { limp: bool },
    }
}
#[allow(missing_docs, dead_code)]
#[path = "../../src/telemetry"]
mod telemetry {
    pub mod block_ring;
    #[path = "../../models/src/block_ring_checks.rs"]
    pub mod block_ring_checks;

    mod marks {
        /// Smaller than in the library, because loom would take too long with as many marks as in the library.
        pub const MARKS: usize = 1;
    }
}
pub mod ring_checks;
mod tracked;
pub mod triple_buffer_checks;

pub use finger::events::event_log_checks;
pub use finger::{group_checks, mailbox_checks, stop_signal_checks};
pub use realtime::atomics::weakened;
pub use telemetry::block_ring_checks;

use loom::model::Builder;
use loom::thread::{self, JoinHandle};
use std::sync::Arc;

/// Largest number of preemptions in one run of a check. Loom's authors found that most defects show with 2, and advise
/// 2 or 3.
const PREEMPTIONS: usize = 3;

/// Size of the stack of a thread, in machine words. Loom's documentation says bytes, but the coroutines in which loom
/// runs threads count words. Loom's default is 4096 words. Copies of a finger's report fill such a stack.
const STACK_WORDS: usize = 32 * 1024;

/// Runs `check` in every order of its threads that has at most `PREEMPTIONS` preemptions.
pub fn explore(check: impl Fn() + Send + Sync + 'static) {
    let mut builder = Builder::new();
    builder.preemption_bound = Some(PREEMPTIONS);
    let check = Arc::new(check);
    builder.check(move || {
        let check = check.clone();
        spawn(move || check()).join().expect("no panic");
    });
}

/// Starts a thread of a check.
fn spawn<T: Send + 'static>(run: impl FnOnce() -> T + Send + 'static) -> JoinHandle<T> {
    thread::Builder::new().stack_size(STACK_WORDS).spawn(run).expect("loom's threads always start")
}
