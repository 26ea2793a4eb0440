//! An enum: one of several names, as a string or as the only key of a table.

use crate::hand::configuration_file::wrong::Wrong;
use serde::de::value::StrDeserializer;
use serde::de::{DeserializeSeed, EnumAccess, VariantAccess, Visitor};
use serde::{Deserializer, de::Error};
use std::ops::Range;

/// The chosen name, its position, and its value.
pub(super) struct Choice<'a, T> {
    pub name: &'a str,
    pub span: Option<Range<usize>>,
    pub inside: Option<T>,
}

impl<'de, T: Deserializer<'de, Error = Wrong>> EnumAccess<'de> for Choice<'_, T> {
    type Error = Wrong;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Wrong> {
        seed.deserialize(StrDeserializer::new(self.name)).map(|variant| (variant, self))
    }
}

impl<'de, T: Deserializer<'de, Error = Wrong>> VariantAccess<'de> for Choice<'_, T> {
    type Error = Wrong;

    fn unit_variant(self) -> Result<(), Wrong> {
        match self.inside {
            None => Ok(()),
            Some(_) => Err(Wrong::at(self.span, format!("must be the text \"{}\", not a table", self.name))),
        }
    }

    fn struct_variant<V: Visitor<'de>>(self, keys: &'static [&'static str], visitor: V) -> Result<V::Value, Wrong> {
        match self.inside {
            Some(table) => table.deserialize_struct("", keys, visitor).map_err(|wrong| wrong.in_key(self.name)),
            None => Err(Wrong::at(self.span, format!("must be a table: {{ {} = {{ ... }} }}", self.name))),
        }
    }

    fn newtype_variant_seed<S: DeserializeSeed<'de>>(self, _: S) -> Result<S::Value, Wrong> {
        Err(Wrong::custom("no key of a configuration is of this type"))
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Wrong> {
        Err(Wrong::custom("no key of a configuration is of this type"))
    }
}
