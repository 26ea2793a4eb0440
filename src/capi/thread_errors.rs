//! The last refusals of each thread. They are in thread-local memory, so that a refusal allocates nothing.

use crate::capi::handle::Handle;
use crate::capi::text::Text;
use std::cell::RefCell;
use std::ffi::{c_char, c_int};
use std::fmt::Display;

/// Number of hands whose last refusal a thread remembers. A larger number would enlarge the thread-local data of every
/// thread of the planner.
pub(super) const REMEMBERED: usize = 4;

/// Room for a text, bytes. The texts of the library are shorter, because they abbreviate what they quote.
const TEXT: usize = 2048;

/// The last refusal of a hand.
struct Entry {
    /// Number of this refusal among those of the thread, from 1; 0 if the entry is unused.
    count: u64,
    handle: Handle,
    /// SUN2XP_ERROR_...
    number: c_int,
    errno: c_int,
    call: Text<48>,
    text: Text<TEXT>,
    remedy: Text<96>,
}

/// A refusal, with pointers that are valid until the thread's next refusal.
pub(super) struct Found {
    pub number: c_int,
    pub errno: c_int,
    pub call: *const c_char,
    pub text: *const c_char,
    pub remedy: *const c_char,
}

struct Errors {
    entries: [Entry; REMEMBERED],
}

thread_local! {
    // All bytes are zero, so that the value takes no space in the library's file.
    static ERRORS: RefCell<Errors> = const {
        RefCell::new(Errors {
            entries: [const {
                Entry {
                    count: 0,
                    handle: Handle::NULL,
                    number: 0,
                    errno: 0,
                    call: Text::EMPTY,
                    text: Text::EMPTY,
                    remedy: Text::EMPTY,
                }
            }; REMEMBERED],
        })
    };
}

impl Errors {
    /// The entry for a new refusal of a hand: the entry of the same hand, or else the oldest entry.
    fn entry(&mut self, handle: Handle) -> &mut Entry {
        let newest = self.newest().count;
        let same = |entry: &Entry| entry.count != 0 && entry.handle == handle;
        let index = self
            .entries
            .iter()
            .position(same)
            .unwrap_or_else(|| (0..REMEMBERED).min_by_key(|&index| self.entries[index].count).unwrap_or_default());
        let entry = &mut self.entries[index];
        entry.count = newest + 1;
        entry
    }

    fn newest(&self) -> &Entry {
        self.entries[1..].iter().fold(
            &self.entries[0],
            |newest, entry| {
                if entry.count > newest.count { entry } else { newest }
            },
        )
    }
}

/// Stores a refusal of the calling thread. Returns false if another call of this thread is using the refusals. This
/// happens if a log callback makes a call, or if a signal handler interrupts that other call and makes a call that is
/// forbidden in signal handlers. errno still reports such a refusal.
pub(super) fn store(
    handle: Handle,
    number: c_int,
    errno: c_int,
    call: &str,
    text: &dyn Display,
    remedy: &dyn Display,
) -> bool {
    ERRORS.with(|errors| {
        let Ok(mut errors) = errors.try_borrow_mut() else { return false };
        let entry = errors.entry(handle);
        (entry.handle, entry.number, entry.errno) = (handle, number, errno);
        entry.call.compose(format_args!("{call}"));
        entry.text.compose(format_args!("{call}: {text}"));
        entry.remedy.compose(format_args!("{remedy}"));
        true
    })
}

/// Passes the text of the newest refusal to a function, which must not make calls of the library.
pub(super) fn with_newest_text(call: impl FnOnce(&str)) {
    ERRORS.with(|errors| {
        if let Ok(errors) = errors.try_borrow() {
            call(errors.newest().text.as_str());
        }
    });
}

/// The last refusal of the calling thread for a hand, or for any hand if the handle is null.
pub(super) fn find(handle: Handle) -> Found {
    ERRORS.with(|errors| {
        let none = || Found { number: 0, errno: 0, call: c"".as_ptr(), text: c"".as_ptr(), remedy: c"".as_ptr() };
        let Ok(errors) = errors.try_borrow() else { return none() };
        let entries = errors.entries.iter();
        let found = entries.filter(|entry| entry.count != 0 && (handle == Handle::NULL || entry.handle == handle));
        found.max_by_key(|entry| entry.count).map_or_else(none, |entry| Found {
            number: entry.number,
            errno: entry.errno,
            call: entry.call.as_c_string(),
            text: entry.text.as_c_string(),
            remedy: entry.remedy.as_c_string(),
        })
    })
}
