//! The texts of sun2xp_fault_text.

use crate::capi::remedy_calls::{Appendix, Interface, RemedyCalls};
use crate::finger::FaultKind;
use std::ffi::CString;
use std::sync::LazyLock;

/// One text for each kind of fault, ordered by number.
pub(super) static TEXTS: LazyLock<Vec<CString>> = LazyLock::new(|| {
    let text = |kind: &FaultKind| {
        let row = kind.description();
        let calls = Appendix(RemedyCalls(row.actions, Interface::Handles));
        let text = format!("{}: {}{calls}", row.name, row.explanation());
        // The table contains no zero byte. If it did, the text would be empty.
        CString::new(text).unwrap_or_default()
    };
    FaultKind::ALL.iter().map(text).collect()
});

/// Composes the texts before the process forks. Otherwise a child could inherit the lock of a thread that is composing
/// them, and nothing would release it there.
pub(super) fn compose_texts() {
    LazyLock::force(&TEXTS);
}
