//! The copy of a value. The values of several large types are copied to this one type. So a format needs code only for
//! this type, and not for each type that is copied.

use serde::ser::{Error, SerializeStruct, SerializeStructVariant, SerializeTuple};
use serde::{Serialize, Serializer};
use std::fmt::{self, Display, Formatter};

/// A copy of a value, with everything that a format may write of it.
#[derive(Debug)]
pub enum Snapshot {
    Boolean(bool),
    Byte(u8),
    Unsigned(u64),
    SignedByte(i8),
    Signed(i64),
    Float(f64),
    Text(String),
    Absent,
    Present(Box<Self>),
    Sequence(Vec<Self>),
    Tuple(Vec<Self>),
    Struct(&'static str, Fields),
    /// A variant without fields: the enum, the index of the variant and its name.
    Unit(&'static str, u32, &'static str),
    /// A variant with one field.
    Newtype(&'static str, u32, &'static str, Box<Self>),
    /// A variant with named fields.
    Variant(&'static str, u32, &'static str, Fields),
}

pub(super) type Fields = Vec<(&'static str, Snapshot)>;

/// A kind of value that no snapshot has. No type of a configuration or of a controller's state contains one.
#[derive(Debug)]
pub struct Unsupported(String);

impl Display for Unsupported {
    fn fmt(&self, formatter: &mut Formatter<'_>) -> fmt::Result {
        formatter.write_str(&self.0)
    }
}

impl std::error::Error for Unsupported {}

impl Error for Unsupported {
    fn custom<T: Display>(reason: T) -> Self {
        Self(reason.to_string())
    }
}

impl Serialize for Snapshot {
    #[inline(never)]
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match *self {
            Self::Boolean(flag) => serializer.serialize_bool(flag),
            Self::Byte(number) => serializer.serialize_u8(number),
            Self::Unsigned(number) => serializer.serialize_u64(number),
            Self::SignedByte(number) => serializer.serialize_i8(number),
            Self::Signed(number) => serializer.serialize_i64(number),
            Self::Float(number) => serializer.serialize_f64(number),
            Self::Text(ref text) => serializer.serialize_str(text),
            Self::Absent => serializer.serialize_none(),
            Self::Present(ref value) => serializer.serialize_some(&**value),
            Self::Sequence(ref entries) => serializer.collect_seq(entries),
            Self::Tuple(ref entries) => {
                let mut tuple = serializer.serialize_tuple(entries.len())?;
                entries.iter().try_for_each(|entry| tuple.serialize_element(entry))?;
                tuple.end()
            }
            Self::Struct(name, ref fields) => {
                let mut object = serializer.serialize_struct(name, fields.len())?;
                fields.iter().try_for_each(|(key, value)| object.serialize_field(key, value))?;
                object.end()
            }
            Self::Unit(name, index, variant) => serializer.serialize_unit_variant(name, index, variant),
            Self::Newtype(name, index, variant, ref value) => {
                serializer.serialize_newtype_variant(name, index, variant, &**value)
            }
            Self::Variant(name, index, variant, ref fields) => {
                let mut object = serializer.serialize_struct_variant(name, index, variant, fields.len())?;
                fields.iter().try_for_each(|(key, value)| object.serialize_field(key, value))?;
                object.end()
            }
        }
    }
}
