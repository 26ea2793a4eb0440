//! Copying a value to a [`Snapshot`].

use super::value::{Fields, Snapshot, Unsupported};
use serde::ser::{
    Error, Impossible, SerializeSeq, SerializeStruct, SerializeStructVariant, SerializeTuple, SerializeTupleStruct,
};
use serde::{Serialize, Serializer};

/// Copies a value.
///
/// # Errors
/// Returns an error if the value contains a map, bytes, a character, a unit, a variant with several unnamed fields, a
/// floating-point number of 32 bits, or an integer of 128 bits.
pub fn snapshot<T: Serialize + ?Sized>(value: &T) -> Result<Snapshot, Unsupported> {
    value.serialize(Copying)
}

/// Copies a value.
struct Copying;

/// Copies entries, one after the other.
pub struct Entries(Vec<Snapshot>);

/// Copies named fields.
pub struct Named {
    fields: Fields,
    /// Name of the type.
    name: &'static str,
    /// Index and name of the variant, if the value is a variant of an enum.
    variant: Option<(u32, &'static str)>,
}

type Copied = Result<Snapshot, Unsupported>;

fn unsupported<T>(kind: &str) -> Result<T, Unsupported> {
    Err(Unsupported::custom(format_args!("a snapshot cannot contain {kind}")))
}

macro_rules! numbers {
    ($($method:ident: $type:ty => $kind:ident),*) => {
        $(fn $method(self, number: $type) -> Copied {
            Ok(Snapshot::$kind(number.into()))
        })*
    };
}

impl Serializer for Copying {
    type Ok = Snapshot;
    type Error = Unsupported;
    type SerializeSeq = Entries;
    type SerializeTuple = Entries;
    type SerializeTupleStruct = Entries;
    type SerializeTupleVariant = Impossible<Snapshot, Unsupported>;
    type SerializeMap = Impossible<Snapshot, Unsupported>;
    type SerializeStruct = Named;
    type SerializeStructVariant = Named;

    numbers! {
        serialize_bool: bool => Boolean, serialize_u8: u8 => Byte, serialize_u16: u16 => Unsigned,
        serialize_u32: u32 => Unsigned, serialize_u64: u64 => Unsigned, serialize_i8: i8 => SignedByte,
        serialize_i16: i16 => Signed, serialize_i32: i32 => Signed, serialize_i64: i64 => Signed,
        serialize_f64: f64 => Float, serialize_str: &str => Text
    }

    fn serialize_f32(self, _: f32) -> Copied {
        unsupported("a floating-point number of 32 bits")
    }

    fn serialize_char(self, _: char) -> Copied {
        unsupported("a character")
    }

    fn serialize_bytes(self, _: &[u8]) -> Copied {
        unsupported("bytes")
    }

    fn serialize_none(self) -> Copied {
        Ok(Snapshot::Absent)
    }

    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Copied {
        Ok(Snapshot::Present(Box::new(snapshot(value)?)))
    }

    fn serialize_unit(self) -> Copied {
        unsupported("a unit")
    }

    fn serialize_unit_struct(self, _: &'static str) -> Copied {
        unsupported("a unit")
    }

    fn serialize_unit_variant(self, name: &'static str, index: u32, variant: &'static str) -> Copied {
        Ok(Snapshot::Unit(name, index, variant))
    }

    fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, value: &T) -> Copied {
        value.serialize(self)
    }

    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        value: &T,
    ) -> Copied {
        Ok(Snapshot::Newtype(name, index, variant, Box::new(snapshot(value)?)))
    }

    fn serialize_seq(self, _: Option<usize>) -> Result<Entries, Unsupported> {
        Ok(Entries(Vec::new()))
    }

    fn serialize_tuple(self, length: usize) -> Result<Entries, Unsupported> {
        Ok(Entries(Vec::with_capacity(length)))
    }

    fn serialize_tuple_struct(self, _: &'static str, length: usize) -> Result<Entries, Unsupported> {
        self.serialize_tuple(length)
    }

    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeTupleVariant, Unsupported> {
        unsupported("a variant with several unnamed fields")
    }

    fn serialize_map(self, _: Option<usize>) -> Result<Self::SerializeMap, Unsupported> {
        unsupported("a map")
    }

    fn serialize_struct(self, name: &'static str, length: usize) -> Result<Named, Unsupported> {
        Ok(Named { fields: Vec::with_capacity(length), name, variant: None })
    }

    fn serialize_struct_variant(
        self,
        name: &'static str,
        index: u32,
        variant: &'static str,
        length: usize,
    ) -> Result<Named, Unsupported> {
        Ok(Named { fields: Vec::with_capacity(length), name, variant: Some((index, variant)) })
    }
}

impl Entries {
    #[inline(never)]
    fn add<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unsupported> {
        self.store(snapshot(value))
    }

    #[inline(never)]
    fn store(&mut self, copied: Copied) -> Result<(), Unsupported> {
        self.0.push(copied?);
        Ok(())
    }
}

impl SerializeSeq for Entries {
    type Ok = Snapshot;
    type Error = Unsupported;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unsupported> {
        self.add(value)
    }

    fn end(self) -> Copied {
        Ok(Snapshot::Sequence(self.0))
    }
}

impl SerializeTuple for Entries {
    type Ok = Snapshot;
    type Error = Unsupported;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unsupported> {
        self.add(value)
    }

    fn end(self) -> Copied {
        Ok(Snapshot::Tuple(self.0))
    }
}

impl SerializeTupleStruct for Entries {
    type Ok = Snapshot;
    type Error = Unsupported;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unsupported> {
        self.add(value)
    }

    fn end(self) -> Copied {
        Ok(Snapshot::Tuple(self.0))
    }
}

impl Named {
    #[inline(never)]
    fn add<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Unsupported> {
        self.store(key, snapshot(value))
    }

    #[inline(never)]
    fn store(&mut self, key: &'static str, copied: Copied) -> Result<(), Unsupported> {
        self.fields.push((key, copied?));
        Ok(())
    }

    fn finish(self) -> Snapshot {
        match self.variant {
            None => Snapshot::Struct(self.name, self.fields),
            Some((index, variant)) => Snapshot::Variant(self.name, index, variant, self.fields),
        }
    }
}

impl SerializeStruct for Named {
    type Ok = Snapshot;
    type Error = Unsupported;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Unsupported> {
        self.add(key, value)
    }

    fn end(self) -> Copied {
        Ok(self.finish())
    }
}

impl SerializeStructVariant for Named {
    type Ok = Snapshot;
    type Error = Unsupported;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, key: &'static str, value: &T) -> Result<(), Unsupported> {
        self.add(key, value)
    }

    fn end(self) -> Copied {
        Ok(self.finish())
    }
}
