//! Messages of a hand on standard error, for users of planners that do not check results.

use crate::model::one_line;
use crate::realtime::{Severity, report};

/// Prints one line.
pub(super) fn print_notice(text: &str) {
    report(Severity::Warning, &one_line(text));
}
