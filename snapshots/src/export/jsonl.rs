//! JSON Lines: one object per row, with its keys in the order of the columns.

use super::columns::{Column, ColumnKind, Value};
use serde::ser::{Serialize, SerializeMap, SerializeSeq, Serializer};

/// Writes the rows as JSON Lines, in UTF-8. Floats are printed as the shortest text that reads back as the same
/// number.
pub(super) fn write(columns: &[Column], rows: &[Vec<Value>]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for row in rows {
        let fields = columns.iter().map(|column| (column.name, column.kind)).zip(row);
        serde_json::to_writer(&mut bytes, &Object(fields.collect())).expect("writing to memory cannot fail");
        bytes.push(b'\n');
    }
    bytes
}

struct Object<'a>(Vec<((&'static str, ColumnKind), &'a Value)>);

impl Serialize for Object<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for ((name, kind), value) in &self.0 {
            map.serialize_entry(name, &Typed(*kind, value))?;
        }
        map.end()
    }
}

struct Typed<'a>(ColumnKind, &'a Value);

impl Serialize for Typed<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match (self.0, self.1) {
            (_, Value::Missing) => serializer.serialize_none(),
            (_, Value::Text(text)) => serializer.serialize_str(text),
            (_, Value::Integer(number)) => serializer.serialize_i64(*number),
            (_, Value::Number(number)) => serializer.serialize_f64(*number),
            (_, Value::Flag(flag)) => serializer.serialize_bool(*flag),
            (_, Value::Texts(texts)) => {
                serializer.collect_seq(texts.iter().map(|text| Typed(ColumnKind::Text, text)))
            }
            (ColumnKind::Records(fields), Value::Records(records)) => {
                let mut list = serializer.serialize_seq(Some(records.len()))?;
                for record in records {
                    list.serialize_element(&Object(fields.iter().copied().zip(record).collect()))?;
                }
                list.end()
            }
            (_, Value::Records(_)) => unreachable!("only columns of records hold records"),
        }
    }
}
