//! The C calls that a remedy names.

use crate::finger::Action;
use std::fmt::{self, Display, Formatter};

/// Displays the calls for these actions in parentheses, as an appendix to a text that describes the actions in words.
/// Displays nothing if there are no actions.
pub(super) struct RemedyCalls<'a>(pub &'a [Action]);

impl Display for RemedyCalls<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        for (index, &action) in self.0.iter().enumerate() {
            write!(formatter, "{}{}", if index == 0 { " (" } else { ", " }, call(action))?;
        }
        formatter.write_str(if self.0.is_empty() { "" } else { ")" })
    }
}

fn call(action: Action) -> &'static str {
    match action {
        Action::Open => "OpenHand",
        Action::Close => "CloseHand",
        Action::Recover => "RecoverHand",
        Action::Zero => "ZeroFinger",
        Action::Stop => "StopHand",
        Action::QueryStatus => "GetStatus",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_follow_in_parentheses_in_their_order() {
        assert_eq!(RemedyCalls(&[]).to_string(), "");
        assert_eq!(RemedyCalls(&[Action::Recover, Action::Zero]).to_string(), " (RecoverHand, ZeroFinger)");
    }
}
