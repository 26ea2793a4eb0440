//! The C calls that a remedy names.

use crate::finger::Action;
use std::fmt::{self, Display, Formatter};

/// The interface to which a call belongs. A remedy names a call of the same interface as the refused call, if this
/// interface has one for the action. Otherwise it names the call with a handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Interface {
    /// The five calls of 1990.
    Of1990,
    /// The calls with handles.
    Handles,
}

impl Interface {
    pub fn of(call: &str) -> Self {
        if call.starts_with("sun2xp_") { Self::Handles } else { Self::Of1990 }
    }
}

/// Displays the calls for these actions, separated by commas.
pub(super) struct RemedyCalls<'a>(pub &'a [Action], pub Interface);

impl Display for RemedyCalls<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        for (index, &action) in self.0.iter().enumerate() {
            write!(formatter, "{}{}", if index == 0 { "" } else { ", " }, call(action, self.1))?;
        }
        Ok(())
    }
}

/// Displays the calls for these actions in parentheses, as an appendix to a text that describes the actions in words.
/// Displays nothing if there are no actions.
pub(super) struct Appendix<'a>(pub RemedyCalls<'a>);

impl Display for Appendix<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        if self.0.0.is_empty() { Ok(()) } else { write!(formatter, " ({})", self.0) }
    }
}

const ACTIONS: [Action; 5] = [Action::Open, Action::Close, Action::Recover, Action::Zero, Action::QueryStatus];

fn call(action: Action, interface: Interface) -> &'static str {
    match (action, interface) {
        (Action::Open, Interface::Of1990) => "OpenHand",
        (Action::Open, Interface::Handles) => "sun2xp_open",
        (Action::Close, Interface::Of1990) => "CloseHand",
        (Action::Close, Interface::Handles) => "sun2xp_close",
        (Action::Recover, _) => "sun2xp_recover",
        (Action::Zero, _) => "sun2xp_zero",
        (Action::QueryStatus, _) => "sun2xp_status",
    }
}

/// The actions whose calls a text lists, separated by commas, as [`RemedyCalls`] displays them.
pub(super) fn named(calls: &str, interface: Interface) -> Vec<Action> {
    let action = |name: &str| ACTIONS.into_iter().find(|&action| call(action, interface) == name);
    calls.split(", ").filter_map(action).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_follow_in_parentheses_in_their_order() {
        let appendix = |actions, interface| Appendix(RemedyCalls(actions, interface)).to_string();
        assert_eq!(appendix(&[], Interface::Handles), "");
        let actions = &[Action::Recover, Action::Close];
        assert_eq!(appendix(actions, Interface::of("GetPos")), " (sun2xp_recover, CloseHand)");
        assert_eq!(named("sun2xp_recover, sun2xp_close", Interface::Handles), actions);
        assert_eq!(named("", Interface::Handles), []);
        assert_eq!(appendix(actions, Interface::of("sun2xp_tip")), " (sun2xp_recover, sun2xp_close)");
    }
}
