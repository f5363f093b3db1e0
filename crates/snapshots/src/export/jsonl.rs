//! JSON Lines: one object per row, with its keys in column order.

use super::columns::{Column, ColumnKind};
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::Value;

/// Formats the rows as JSON Lines in UTF-8. Floats are printed as the shortest text that reads back as the same
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

impl<'a> Serialize for Typed<'a> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let (ColumnKind::Records(fields), Value::Array(records)) = (self.0, self.1) else {
            return self.1.serialize(serializer);
        };
        let object = |record: &'a Value| {
            let values = record.as_array().into_iter().flatten();
            Object(fields.iter().copied().zip(values).collect())
        };
        serializer.collect_seq(records.iter().map(object))
    }
}
