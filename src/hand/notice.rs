//! Messages of a hand on standard error, for users of planners that do not check results.

use crate::model::one_line;
use crate::realtime::print_line;

/// Prints one line.
pub(super) fn print_notice(text: &str) {
    print_line(&one_line(text));
}
