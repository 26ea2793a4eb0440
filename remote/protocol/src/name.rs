//! The names of hands and clients. A name is a part of Zenoh keys, so it must not contain a character that has a
//! special meaning in a key.

use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// Why a text is not a name.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum NameError {
    /// The name is empty or too long.
    #[error("the name has {length} characters: the name of a {what} has 1 to {most}")]
    Length {
        /// What has the name, such as `hand` or `client`.
        what: &'static str,
        /// The length of the text, in characters.
        length: usize,
        /// The largest length.
        most: usize,
    },
    /// The name has a character that is not permitted.
    #[error("the name has the character {character:?}: the name of a {what} has only {allowed}")]
    Character {
        /// What has the name, such as `hand` or `client`.
        what: &'static str,
        /// The first such character.
        character: char,
        /// The permitted characters.
        allowed: &'static str,
    },
}

/// The name of a hand: 1 to 32 characters, `a` to `z`, `0` to `9` and `-`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct HandName(String);

/// The name of a client: 1 to 64 characters, `A` to `Z`, `a` to `z`, `0` to `9`, `.`, `_` and `-`. With TLS it is the
/// common name of the client's certificate.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ClientName(String);

impl HandName {
    /// The largest length of a name, bytes.
    pub const LONGEST: usize = 32;

    /// Returns the name as text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl ClientName {
    /// The largest length of a name, bytes.
    pub const LONGEST: usize = 64;

    /// Returns the name as text.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl FromStr for HandName {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        let allowed = |character: char| matches!(character, 'a'..='z' | '0'..='9' | '-');
        check(text, "hand", Self::LONGEST, "a to z, 0 to 9 and -", allowed)?;
        Ok(Self(text.into()))
    }
}

impl FromStr for ClientName {
    type Err = NameError;

    fn from_str(text: &str) -> Result<Self, NameError> {
        let allowed = |character: char| character.is_ascii_alphanumeric() || matches!(character, '.' | '_' | '-');
        check(text, "client", Self::LONGEST, "A to Z, a to z, 0 to 9, `.`, `_` and `-`", allowed)?;
        Ok(Self(text.into()))
    }
}

fn check(
    text: &str,
    what: &'static str,
    most: usize,
    described: &'static str,
    allowed: impl Fn(char) -> bool,
) -> Result<(), NameError> {
    if let Some(character) = text.chars().find(|&character| !allowed(character)) {
        return Err(NameError::Character { what, character, allowed: described });
    }
    match text.len() {
        length if (1..=most).contains(&length) => Ok(()),
        length => Err(NameError::Length { what, length, most }),
    }
}

impl fmt::Display for HandName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}

impl fmt::Display for ClientName {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}
