//! What FaultText returns.

use crate::finger::FaultKind;
use std::ffi::CString;
use std::sync::LazyLock;

/// One text for each kind of fault, in the order of their numbers.
pub(super) static TEXTS: LazyLock<Vec<CString>> = LazyLock::new(|| {
    let text = |kind: &FaultKind| {
        let told = kind.description();
        let text = format!("{}: {}", told.name, told.explanation());
        // The table has no zero byte; if it had, the text would be empty.
        CString::new(text).unwrap_or_default()
    };
    FaultKind::ALL.iter().map(text).collect()
});

/// Composes the texts, before the process forks: a child may find the lock of a thread that composes them taken for
/// ever.
pub(super) fn compose_texts() {
    LazyLock::force(&TEXTS);
}
