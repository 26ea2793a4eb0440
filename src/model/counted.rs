//! Numbers of things in messages, with the noun in the singular or the plural.

use std::fmt::{Display, Formatter, Result};

/// Displays a number and the noun for it: `Counted(1, "finger", "fingers")` is "1 finger".
#[derive(Clone, Copy, Debug)]
pub struct Counted<'a>(pub u64, pub &'a str, pub &'a str);

impl Display for Counted<'_> {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> Result {
        let Self(number, one, more) = *self;
        write!(formatter, "{number} {}", if number == 1 { one } else { more })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_one_is_singular() {
        let said = [0, 1, 2].map(|number| Counted(number, "reply", "replies").to_string());
        assert_eq!(said, ["0 replies", "1 reply", "2 replies"]);
    }
}
