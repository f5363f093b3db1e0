//! Serialisable values as JSON trees with sorted, distinct keys.
//!
//! `serde_json::to_value` does not suffice. It turns NaN into `null` and silently keeps the last of two
//! duplicate keys. Its maps are not sorted if any crate in the build enables `preserve_order`.

use std::collections::BTreeMap;
use std::fmt::Display;

use serde::ser::{self, Serialize, Serializer};

use super::{CanonicalError, Fault, MAX_DEPTH};

/// A JSON value. Objects are sorted by the bytes of their keys, because `String` orders by bytes.
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// The value `null`.
    Null,
    /// The value `true` or `false`.
    Bool(bool),
    /// An integer in the range of `i64` or `u64`.
    Integer(i128),
    /// A finite float.
    Float(f64),
    /// A string.
    Text(String),
    /// An array.
    Array(Vec<Node>),
    /// An object.
    Object(BTreeMap<String, Node>),
}

impl Node {
    /// Returns the tree for a value.
    ///
    /// # Errors
    /// Returns the same errors as [`to_canonical_json`](super::to_canonical_json).
    pub fn new<T: Serialize + ?Sized>(value: &T) -> Result<Node, CanonicalError> {
        value.serialize(ToNode { depth: 0 })
    }

    pub(super) fn is_scalar(&self) -> bool {
        !matches!(self, Node::Array(_) | Node::Object(_))
    }
}

/// The serializer for a value inside `depth` arrays and objects.
#[derive(Clone, Copy)]
pub(super) struct ToNode {
    depth: usize,
}

impl ToNode {
    fn enter(self) -> Result<ToNode, CanonicalError> {
        match self.depth {
            MAX_DEPTH => Err(Fault::TooDeep.into()),
            depth => Ok(ToNode { depth: depth + 1 }),
        }
    }

    fn list(self) -> Result<List, CanonicalError> {
        Ok(List { inside: self.enter()?, items: Vec::new(), variant: None })
    }

    fn fields(self) -> Result<Fields, CanonicalError> {
        Ok(Fields { inside: self.enter()?, fields: BTreeMap::new(), key: None, variant: None })
    }
}

impl From<Fault> for CanonicalError {
    fn from(fault: Fault) -> CanonicalError {
        CanonicalError { at: String::new(), fault }
    }
}

impl CanonicalError {
    /// Returns the same fault with `outer` prepended to its position. `outer` is the key, index or variant in the
    /// enclosing object or array.
    pub fn inside(mut self, outer: &str) -> CanonicalError {
        let separator = if self.at.is_empty() { "" } else { "." };
        self.at = format!("{outer}{separator}{}", self.at);
        self
    }
}

impl ser::Error for CanonicalError {
    fn custom<T: Display>(message: T) -> CanonicalError {
        Fault::Other(message.to_string()).into()
    }
}

/// An array under construction.
pub(super) struct List {
    inside: ToNode,
    items: Vec<Node>,
    variant: Option<&'static str>,
}

impl List {
    fn push<T: Serialize + ?Sized>(&mut self, item: &T) -> Result<(), CanonicalError> {
        let node =
            item.serialize(self.inside).map_err(|error| error.inside(&self.items.len().to_string()))?;
        self.items.push(node);
        Ok(())
    }

    fn finish(self) -> Result<Node, CanonicalError> {
        Ok(tagged(self.variant, Node::Array(self.items)))
    }
}

/// An object under construction.
pub(super) struct Fields {
    inside: ToNode,
    fields: BTreeMap<String, Node>,
    key: Option<String>,
    variant: Option<&'static str>,
}

impl Fields {
    fn insert<T: Serialize + ?Sized>(&mut self, key: String, value: &T) -> Result<(), CanonicalError> {
        let node = value.serialize(self.inside).map_err(|error| error.inside(&key))?;
        if self.fields.contains_key(&key) {
            return Err(Fault::DuplicateKey(key).into());
        }
        self.fields.insert(key, node);
        Ok(())
    }

    fn finish(self) -> Result<Node, CanonicalError> {
        Ok(tagged(self.variant, Node::Object(self.fields)))
    }
}

fn tagged(variant: Option<&'static str>, node: Node) -> Node {
    match variant {
        Some(name) => Node::Object([(name.to_string(), node)].into()),
        None => node,
    }
}

macro_rules! integers {
    ($($method:ident: $type:ty),*) => {$(
        fn $method(self, value: $type) -> Result<Node, CanonicalError> {
            Ok(Node::Integer(value.into()))
        }
    )*};
}

impl Serializer for ToNode {
    type Ok = Node;
    type Error = CanonicalError;
    type SerializeSeq = List;
    type SerializeTuple = List;
    type SerializeTupleStruct = List;
    type SerializeTupleVariant = List;
    type SerializeMap = Fields;
    type SerializeStruct = Fields;
    type SerializeStructVariant = Fields;

    fn serialize_bool(self, value: bool) -> Result<Node, CanonicalError> {
        Ok(Node::Bool(value))
    }
    integers! {
        serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64,
        serialize_u8: u8, serialize_u16: u16, serialize_u32: u32, serialize_u64: u64
    }
    fn serialize_f32(self, value: f32) -> Result<Node, CanonicalError> {
        self.serialize_f64(value.into())
    }
    fn serialize_f64(self, value: f64) -> Result<Node, CanonicalError> {
        if value.is_finite() { Ok(Node::Float(value)) } else { Err(Fault::NotFinite.into()) }
    }
    fn serialize_char(self, value: char) -> Result<Node, CanonicalError> {
        Ok(Node::Text(value.to_string()))
    }
    fn serialize_str(self, value: &str) -> Result<Node, CanonicalError> {
        Ok(Node::Text(value.to_string()))
    }
    fn serialize_bytes(self, value: &[u8]) -> Result<Node, CanonicalError> {
        value.serialize(self)
    }
    fn serialize_none(self) -> Result<Node, CanonicalError> {
        Ok(Node::Null)
    }
    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Node, CanonicalError> {
        value.serialize(self)
    }
    fn serialize_unit(self) -> Result<Node, CanonicalError> {
        Ok(Node::Null)
    }
    fn serialize_unit_struct(self, _: &'static str) -> Result<Node, CanonicalError> {
        Ok(Node::Null)
    }
    fn serialize_unit_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
    ) -> Result<Node, CanonicalError> {
        self.serialize_str(variant)
    }
    fn serialize_newtype_struct<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        value: &T,
    ) -> Result<Node, CanonicalError> {
        value.serialize(self)
    }
    fn serialize_newtype_variant<T: Serialize + ?Sized>(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        value: &T,
    ) -> Result<Node, CanonicalError> {
        let node = value.serialize(self.enter()?).map_err(|error| error.inside(variant))?;
        Ok(tagged(Some(variant), node))
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<List, CanonicalError> {
        self.list()
    }
    fn serialize_tuple(self, _: usize) -> Result<List, CanonicalError> {
        self.list()
    }
    fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<List, CanonicalError> {
        self.list()
    }
    fn serialize_tuple_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<List, CanonicalError> {
        Ok(List { variant: Some(variant), ..self.enter()?.list()? })
    }
    fn serialize_map(self, _: Option<usize>) -> Result<Fields, CanonicalError> {
        self.fields()
    }
    /// Rejects names that start with `$`. They are private conventions of `serde_json` (arbitrary precision, raw
    /// values) and `toml` (dates).
    fn serialize_struct(self, name: &'static str, _: usize) -> Result<Fields, CanonicalError> {
        if name.starts_with('$') { Err(Fault::Private(name).into()) } else { self.fields() }
    }
    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        variant: &'static str,
        _: usize,
    ) -> Result<Fields, CanonicalError> {
        Ok(Fields { variant: Some(variant), ..self.enter()?.fields()? })
    }
}

macro_rules! list {
    ($($name:ident :: $method:ident),*) => {$(
        impl ser::$name for List {
            type Ok = Node;
            type Error = CanonicalError;
            fn $method<T: Serialize + ?Sized>(&mut self, item: &T) -> Result<(), CanonicalError> {
                self.push(item)
            }
            fn end(self) -> Result<Node, CanonicalError> {
                self.finish()
            }
        }
    )*};
}
list!(
    SerializeSeq::serialize_element,
    SerializeTuple::serialize_element,
    SerializeTupleStruct::serialize_field,
    SerializeTupleVariant::serialize_field
);

macro_rules! fields {
    ($($name:ident),*) => {$(
        impl ser::$name for Fields {
            type Ok = Node;
            type Error = CanonicalError;
            fn serialize_field<T: Serialize + ?Sized>(
                &mut self,
                key: &'static str,
                value: &T,
            ) -> Result<(), CanonicalError> {
                self.insert(key.to_string(), value)
            }
            fn end(self) -> Result<Node, CanonicalError> {
                self.finish()
            }
        }
    )*};
}
fields!(SerializeStruct, SerializeStructVariant);

impl ser::SerializeMap for Fields {
    type Ok = Node;
    type Error = CanonicalError;

    /// Serialises a key as text, as in `serde_json`. Rejects keys that do not have a unique spelling, such as
    /// floats.
    fn serialize_key<T: Serialize + ?Sized>(&mut self, key: &T) -> Result<(), CanonicalError> {
        self.key = Some(match key.serialize(self.inside)? {
            Node::Text(text) => text,
            Node::Bool(value) => value.to_string(),
            Node::Integer(number) => number.to_string(),
            _ => return Err(Fault::Key.into()),
        });
        Ok(())
    }
    fn serialize_value<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), CanonicalError> {
        let key = self.key.take().ok_or(Fault::Key)?;
        self.insert(key, value)
    }
    fn end(self) -> Result<Node, CanonicalError> {
        self.finish()
    }
}
