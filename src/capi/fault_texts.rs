//! The texts of FaultText.

use crate::finger::FaultKind;
use std::ffi::CString;
use std::sync::LazyLock;

/// One text for each kind of fault, ordered by number.
pub(super) static TEXTS: LazyLock<Vec<CString>> = LazyLock::new(|| {
    let text = |kind: &FaultKind| {
        let description = kind.description();
        let text = format!("{}: {}", description.name, description.explanation());
        // The descriptions have no zero byte. If one had, its text would be empty.
        CString::new(text).unwrap_or_default()
    };
    FaultKind::ALL.iter().map(text).collect()
});

/// Composes the texts before the process forks. Otherwise a child could inherit the lock of a thread that is composing
/// them, and nothing would release it there.
pub(super) fn compose_texts() {
    LazyLock::force(&TEXTS);
}
