//! Conversion from TOML to the types of a configuration. General deserializers accept an array that is too long, and an
//! array in place of a table. The deserializer of this file accepts only valid values. For an invalid value, it reports
//! the position and what is expected there.
//!
//! Serde makes the compiler compile the generic functions again for each of some 50 types. So these functions contain
//! little, and call others that are neither generic nor inlined. With all of the code in them, they would be a
//! twentieth of the library.

mod choice;
mod content;

use super::wrong::{Wrong, one_of};
use crate::model::Counted;
use crate::model::snapshot::snapshot;
use choice::Choice;
use content::Content;
use serde::Serialize;
use serde::de::Error;
use serde::de::value::StrDeserializer;
use serde::de::{DeserializeOwned, DeserializeSeed, MapAccess, SeqAccess, Visitor};
use serde::forward_to_deserialize_any;
use std::fmt::Display;
use std::ops::Range;
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

/// Converts a table to a type of the configuration. Keys that the type does not have are refused.
pub fn deserialize<T: DeserializeOwned>(table: &Table) -> Result<T, Wrong> {
    T::deserialize(Node { content: Content::Table(table), span: table.span() })
}

/// Converts a part of a configuration to a table.
pub fn to_document(part: &impl Serialize) -> Result<DocumentMut, Wrong> {
    let part = snapshot(part).map_err(Wrong::custom)?;
    toml_edit::ser::to_document(&part).map_err(Wrong::custom)
}

/// A value or a table, with its position.
struct Node<'a> {
    content: Content<'a>,
    span: Option<Range<usize>>,
}

impl<'a> Node<'a> {
    #[inline(never)]
    fn item(item: &'a Item) -> Self {
        Self { content: Content::of_item(item), span: item.span() }
    }

    #[inline(never)]
    fn value(value: &'a Value) -> Self {
        Self { content: Content::of_value(value), span: value.span() }
    }

    #[inline(never)]
    fn refusal(self, expected: &dyn Display) -> Wrong {
        Wrong::at(self.span, format!("must be {expected}, not {}", self.content.kind()))
    }

    fn refuse<T>(self, expected: impl Display) -> Result<T, Wrong> {
        Err(self.refusal(&expected))
    }

    #[inline(never)]
    fn float<'de, V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.content {
            Content::Float(number) => visitor.visit_f64(number),
            Content::Integer(number) => visitor.visit_f64(number as f64),
            _ => self.refuse("a number"),
        }
    }

    #[inline(never)]
    fn integer<'de, V: Visitor<'de>>(
        self,
        low: impl Into<i128>,
        high: impl Into<i128>,
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        let Content::Integer(number) = self.content else { return self.refuse("a whole number") };
        let misfit = match i128::from(number) {
            less if less < low.into() => "small",
            more if more > high.into() => "large",
            _ => return visitor.visit_i64(number),
        };
        Err(Wrong::at(
            self.span,
            format!(
                "{number} is too {misfit} for this key: see its description in docs/sun2xp.toml, or in docs/remote.md \
                 for the table [serve]"
            ),
        ))
    }
}

macro_rules! integers {
    ($($method:ident: $type:ty),*) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
            self.integer(<$type>::MIN, <$type>::MAX, visitor)
        })*
    };
}

impl<'de> serde::Deserializer<'de> for Node<'_> {
    type Error = Wrong;

    integers! {
        deserialize_u8: u8, deserialize_u16: u16, deserialize_u32: u32, deserialize_u64: u64,
        deserialize_i8: i8, deserialize_i16: i16, deserialize_i32: i32, deserialize_i64: i64
    }

    fn deserialize_f32<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.float(visitor)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.float(visitor)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.content {
            Content::Boolean(flag) => visitor.visit_bool(flag),
            _ => self.refuse("true or false"),
        }
    }

    fn deserialize_str<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.content {
            Content::Text(text) => visitor.visit_str(text),
            _ => self.refuse("a text in quotes"),
        }
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        self.deserialize_str(visitor)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        // This is called only for a key that is present.
        visitor.visit_some(self)
    }

    fn deserialize_newtype_struct<V: Visitor<'de>>(self, _name: &'static str, visitor: V) -> Result<V::Value, Wrong> {
        visitor.visit_newtype_struct(self)
    }

    #[inline(never)]
    fn deserialize_tuple<V: Visitor<'de>>(self, length: usize, visitor: V) -> Result<V::Value, Wrong> {
        let Content::Array(array) = self.content else {
            return self.refuse(format_args!("an array of {length} entries"));
        };
        let found = array.len();
        if found != length {
            return Err(Wrong::at(
                self.span,
                format!("has {}, and must have {length}", Counted(found as u64, "entry", "entries")),
            ));
        }
        visitor.visit_seq(Entries { entries: array.iter().enumerate() })
    }

    #[inline(never)]
    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _name: &'static str,
        _keys: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        let Content::Table(table) = self.content else { return self.refuse("a table") };
        let span = self.span;
        visitor.visit_map(Keys { table, rest: table.iter(), item: None }).map_err(|wrong: Wrong| wrong.or_at(span))
    }

    #[inline(never)]
    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _name: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Wrong> {
        let span = self.span.clone();
        let choice = match self.content {
            Content::Text(name) => Choice { name, span: self.span, inside: None },
            Content::Table(table) => match table.iter().next().filter(|_| table.len() == 1) {
                Some((name, item)) => Choice { name, span: self.span, inside: Some(Node::item(item)) },
                None => {
                    return Err(Wrong::at(self.span, format!("must have one key, {}", one_of(variants))));
                }
            },
            _ => return self.refuse(one_of(variants)),
        };
        visitor.visit_enum(choice).map_err(|wrong: Wrong| wrong.or_at(span))
    }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Result<V::Value, Wrong> {
        match self.content {
            Content::Text(_) => self.deserialize_str(visitor),
            Content::Integer(number) => visitor.visit_i64(number),
            Content::Float(number) => visitor.visit_f64(number),
            Content::Boolean(flag) => visitor.visit_bool(flag),
            Content::Array(array) => visitor.visit_seq(Entries { entries: array.iter().enumerate() }),
            Content::Table(_) => self.deserialize_struct("", &[], visitor),
            Content::Date | Content::Tables => self.refuse("a value of another kind"),
        }
    }

    forward_to_deserialize_any! {
        i128 u128 char bytes byte_buf unit unit_struct seq tuple_struct map identifier ignored_any
    }
}

/// Iterates over the entries of an array.
struct Entries<I> {
    entries: I,
}

impl<'de, 'a, I: Iterator<Item = (usize, &'a Value)>> SeqAccess<'de> for Entries<I> {
    type Error = Wrong;

    #[inline(never)]
    fn next_element_seed<T: DeserializeSeed<'de>>(&mut self, seed: T) -> Result<Option<T::Value>, Wrong> {
        let Some((index, value)) = self.entries.next() else { return Ok(None) };
        seed.deserialize(Node::value(value)).map(Some).map_err(|wrong| wrong_entry(wrong, value, index))
    }
}

/// Iterates over the keys of a table.
struct Keys<'a> {
    table: &'a dyn TableLike,
    rest: Box<dyn Iterator<Item = (&'a str, &'a Item)> + 'a>,
    /// The key that was returned last, with its value.
    item: Option<(&'a str, &'a Item)>,
}

impl<'a> Keys<'a> {
    #[inline(never)]
    fn advance(&mut self) -> Option<&'a str> {
        self.item = self.rest.next();
        self.item.map(|(key, _)| key)
    }

    #[inline(never)]
    fn take(&mut self) -> Result<(&'a str, &'a Item), Wrong> {
        // Serde asks for a value only after its key.
        self.item.take().ok_or_else(|| Wrong::at(None, "has no value".into()))
    }

    #[cold]
    #[inline(never)]
    fn wrong_key(&self, wrong: Wrong, key: &str) -> Wrong {
        wrong.or_at(self.table.key(key).and_then(|key| key.span()))
    }

    #[cold]
    #[inline(never)]
    fn wrong_value(&self, wrong: Wrong, key: &str, item: &Item) -> Wrong {
        wrong.or_at(item.span().or_else(|| self.table.key(key)?.span())).in_key(key)
    }
}

#[cold]
#[inline(never)]
fn wrong_entry(wrong: Wrong, value: &Value, index: usize) -> Wrong {
    wrong.or_at(value.span()).in_entry(index)
}

impl<'de> MapAccess<'de> for Keys<'_> {
    type Error = Wrong;

    #[inline(never)]
    fn next_key_seed<K: DeserializeSeed<'de>>(&mut self, seed: K) -> Result<Option<K::Value>, Wrong> {
        let Some(key) = self.advance() else { return Ok(None) };
        seed.deserialize(StrDeserializer::new(key)).map(Some).map_err(|wrong: Wrong| self.wrong_key(wrong, key))
    }

    #[inline(never)]
    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, Wrong> {
        let (key, item) = self.take()?;
        seed.deserialize(Node::item(item)).map_err(|wrong| self.wrong_value(wrong, key, item))
    }
}
