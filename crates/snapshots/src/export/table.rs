//! The Parquet format: the same rows, stored by column.
//!
//! The file uses plain format 1.0 with one row group and no compression, and states neither a time nor a machine name
//! in the footer. The same rows therefore produce identical bytes. Dictionary encoding makes repeated texts cheap.

use super::columns::{Column, ColumnKind};
use parquet::basic::Compression;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{WriterProperties, WriterVersion};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use serde_json::Value;
use std::fmt::Write;
use std::sync::Arc;

/// The author stated in the file. The text is fixed, so it does not depend on the library's version.
const CREATED_BY: &str = "infinite-arcade";

/// Formats the rows as a Parquet file. The file's metadata contain the canary, which shows whether a corpus contains
/// the release.
///
/// # Errors
/// Returns an error if the library fails, which should not happen.
pub(super) fn write(columns: &[Column], rows: &[Vec<Value>], canary: &str) -> Result<Vec<u8>, ParquetError> {
    let properties = WriterProperties::builder()
        .set_created_by(CREATED_BY.to_owned())
        .set_writer_version(WriterVersion::PARQUET_1_0)
        .set_compression(Compression::UNCOMPRESSED)
        .set_max_row_group_row_count(Some(rows.len().max(1)))
        .set_key_value_metadata(Some(vec![KeyValue::new("canary".to_owned(), canary.to_owned())]))
        .build();
    let schema = Arc::new(parse_message_type(&schema(columns))?);
    let mut bytes = Vec::new();
    let mut file = SerializedFileWriter::new(&mut bytes, schema, Arc::new(properties))?;
    let mut group = file.next_row_group()?;
    for (at, column) in columns.iter().enumerate() {
        let values: Vec<&Value> = rows.iter().map(|row| &row[at]).collect();
        for leaf in leaves(column.kind, &values) {
            let mut writer = group.next_column()?.expect("the schema has a leaf for each that is written");
            leaf.write(writer.untyped())?;
            writer.close()?;
        }
    }
    group.close()?;
    file.close()?;
    Ok(bytes)
}

/// Returns the schema in Parquet's own notation, with lists in the three-level form prescribed by the format.
fn schema(columns: &[Column]) -> String {
    let mut text = "message item {\n".to_owned();
    for Column { name, kind, .. } in columns {
        let _ = match kind {
            ColumnKind::Texts => writeln!(
                text,
                "required group {name} (LIST) {{ repeated group list {{ required binary element (STRING); }} }}"
            ),
            ColumnKind::Records(fields) => {
                let fields: String = fields.iter().map(|(name, kind)| leaf(name, *kind)).collect();
                writeln!(
                    text,
                    "required group {name} (LIST) {{ repeated group list {{ required group element {{ {fields} }} }} }}"
                )
            }
            kind => writeln!(text, "{}", leaf(name, *kind)),
        };
    }
    text + "}"
}

fn leaf(name: &str, kind: ColumnKind) -> String {
    let repetition = if kind.is_optional() { "optional" } else { "required" };
    match kind.data_type() {
        "string" => format!("{repetition} binary {name} (STRING); "),
        "float64" => format!("{repetition} double {name}; "),
        "bool" => format!("{repetition} boolean {name}; "),
        same => format!("{repetition} {same} {name}; "),
    }
}

/// A leaf column of the file: values with their definition and repetition levels (S. Melnik et al., "Dremel:
/// interactive analysis of web-scale datasets", 2010).
#[derive(Default)]
struct Leaf<'a> {
    values: Vec<&'a Value>,
    there: Vec<i16>,
    repeated: Vec<i16>,
}

impl<'a> Leaf<'a> {
    /// Adds a value or null at the definition level `base`.
    fn put(&mut self, kind: ColumnKind, value: &'a Value, base: i16, repeated: i16) {
        let missing = value.is_null();
        self.there.push(base + i16::from(kind.is_optional() && !missing));
        self.repeated.push(repeated);
        if !missing {
            self.values.push(value);
        }
    }

    /// Adds an empty list.
    fn none(&mut self) {
        self.there.push(0);
        self.repeated.push(0);
    }

    fn write(&self, writer: &mut ColumnWriter<'_>) -> Result<usize, ParquetError> {
        let (there, repeated) = (Some(&self.there[..]), Some(&self.repeated[..]));
        match writer {
            ColumnWriter::ByteArrayColumnWriter(writer) => {
                let texts = self.all(|value| value.as_str().map(ByteArray::from));
                writer.write_batch(&texts, there, repeated)
            }
            ColumnWriter::Int64ColumnWriter(writer) => {
                writer.write_batch(&self.all(Value::as_i64), there, repeated)
            }
            ColumnWriter::DoubleColumnWriter(writer) => {
                writer.write_batch(&self.all(Value::as_f64), there, repeated)
            }
            ColumnWriter::BoolColumnWriter(writer) => {
                writer.write_batch(&self.all(Value::as_bool), there, repeated)
            }
            _ => unreachable!("the schema has no other types"),
        }
    }

    fn all<T>(&self, of: impl Fn(&'a Value) -> Option<T>) -> Vec<T> {
        self.values.iter().map(|value| of(value).expect("values have the type of their column")).collect()
    }
}

/// Returns a column's leaves: one for a plain column, or one per field of its records.
fn leaves<'a>(kind: ColumnKind, rows: &[&'a Value]) -> Vec<Leaf<'a>> {
    let fields: Vec<ColumnKind> = match kind {
        ColumnKind::Records(fields) => fields.iter().map(|(_, kind)| *kind).collect(),
        ColumnKind::Texts => vec![ColumnKind::Text],
        other => vec![other],
    };
    let mut leaves: Vec<Leaf<'a>> = fields.iter().map(|_| Leaf::default()).collect();
    for row in rows {
        let Value::Array(elements) = row else {
            leaves[0].put(kind, row, 0, 0);
            continue;
        };
        for (at, element) in elements.iter().enumerate() {
            let record = match element {
                Value::Array(record) => record.as_slice(),
                text => std::slice::from_ref(text),
            };
            for ((leaf, kind), value) in leaves.iter_mut().zip(&fields).zip(record) {
                leaf.put(*kind, value, 1, i16::from(at > 0));
            }
        }
        if elements.is_empty() {
            leaves.iter_mut().for_each(Leaf::none);
        }
    }
    leaves
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::columns::Column;
    use parquet::file::reader::{FileReader, SerializedFileReader};

    const FIELDS: &[(&str, ColumnKind)] = &[("who", ColumnKind::Text), ("share", ColumnKind::MaybeNumber)];

    fn columns() -> Vec<Column> {
        let kinds = [
            ("text", ColumnKind::Text),
            ("maybe_text", ColumnKind::MaybeText),
            ("maybe_integer", ColumnKind::MaybeInteger),
            ("maybe_number", ColumnKind::MaybeNumber),
            ("flag", ColumnKind::Flag),
            ("texts", ColumnKind::Texts),
            ("records", ColumnKind::Records(FIELDS)),
        ];
        kinds.map(|(name, kind)| Column::new(name, kind, |_| Value::Null)).to_vec()
    }

    fn text(text: &str) -> Value {
        Value::from(text)
    }

    fn rows() -> Vec<Vec<Value>> {
        let record = |who: &str, share: Option<f64>| vec![text(who), Value::from(share)];
        let full = vec![
            text("wAw\nw w\n"),
            text("é"),
            Value::from(i64::MIN),
            Value::from(0.1),
            Value::from(true),
            Value::from(vec![text("a"), text("b")]),
            Value::from(vec![record("x", None), record("y", Some(0.5)), record("z", None)]),
        ];
        let nothing = vec![
            text(""),
            Value::Null,
            Value::Null,
            Value::Null,
            Value::from(false),
            Value::Array(Vec::new()),
            Value::Array(Vec::new()),
        ];
        vec![full.clone(), nothing, full]
    }

    /// Reading a file back gives lists that begin and end at the same positions, and the same nulls.
    #[test]
    fn rows_are_read_back() {
        let bytes = write(&columns(), &rows(), "the canary").unwrap();
        let mut file = tempfile::tempfile().unwrap();
        std::io::Write::write_all(&mut file, &bytes).unwrap();
        let reader = SerializedFileReader::new(file).unwrap();
        let metadata = reader.metadata().file_metadata();
        assert_eq!((metadata.num_rows(), metadata.created_by()), (3, Some(CREATED_BY)));
        let pairs = metadata.key_value_metadata().unwrap();
        assert_eq!(pairs, &[KeyValue::new("canary".to_owned(), "the canary".to_owned())]);
        let found: Vec<String> = reader.into_iter().map(|row| row.unwrap().to_string()).collect();
        let full = "{text: \"wAw\nw w\n\", maybe_text: \"é\", maybe_integer: -9223372036854775808, maybe_number: 0.1, flag: true, \
                    texts: [\"a\", \"b\"], records: [{who: \"x\", share: null}, {who: \"y\", share: 0.5}, {who: \"z\", share: null}]}";
        let nothing = "{text: \"\", maybe_text: null, maybe_integer: null, maybe_number: null, flag: false, texts: [], records: []}";
        assert_eq!(found, [full, nothing, full]);
    }

    #[test]
    fn the_same_rows_are_the_same_bytes() {
        assert_eq!(write(&columns(), &rows(), "c").unwrap(), write(&columns(), &rows(), "c").unwrap());
        assert!(!write(&columns(), &[], "c").unwrap().is_empty());
    }
}
