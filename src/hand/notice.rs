//! Messages of a hand, for users of planners that do not check results. They go to the program's log callback, or to
//! standard error if there is none.

use crate::model::one_line;
use crate::realtime::{Severity, report};

/// Reports one line as a warning.
pub(super) fn print_notice(text: &str) {
    report(Severity::Warning, &one_line(text));
}
