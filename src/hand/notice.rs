//! What a hand says on standard error: one line each, for people who do not look at results.

use crate::model::one_line;
use crate::realtime::print_line;

/// One line.
pub(super) fn print_notice(text: &str) {
    print_line(&one_line(text));
}
