//! Parquet: the same rows, stored by column.
//!
//! Plain format 1.0 without compression, with one row group and without time or machine in the footer: the same rows
//! give the same bytes. Dictionaries of the columns keep repeated texts cheap.

use super::columns::{Column, ColumnKind, Value};
use parquet::basic::Compression;
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{WriterProperties, WriterVersion};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::parser::parse_message_type;
use std::fmt::Write;
use std::sync::Arc;

/// The author stated in the file, a fixed text that does not depend on the library's version.
const CREATED_BY: &str = "infinite-arcade";

/// Writes the rows as a Parquet file, with the canary in its metadata too.
///
/// # Errors
/// The library fails, which is not expected.
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

/// The schema in Parquet's own notation, with lists in the three-level form that the format prescribes.
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
    match kind {
        ColumnKind::Text => format!("required binary {name} (STRING); "),
        ColumnKind::MaybeText => format!("optional binary {name} (STRING); "),
        ColumnKind::Integer => format!("required int64 {name}; "),
        ColumnKind::MaybeInteger => format!("optional int64 {name}; "),
        ColumnKind::Number => format!("required double {name}; "),
        ColumnKind::MaybeNumber => format!("optional double {name}; "),
        ColumnKind::Flag => format!("required boolean {name}; "),
        ColumnKind::Texts | ColumnKind::Records(_) => unreachable!("a field of a record is no list"),
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
    /// Adds a value or null, `base` levels deep.
    fn put(&mut self, kind: ColumnKind, value: &'a Value, base: i16, repeated: i16) {
        let optional =
            matches!(kind, ColumnKind::MaybeText | ColumnKind::MaybeInteger | ColumnKind::MaybeNumber);
        let missing = *value == Value::Missing;
        self.there.push(base + i16::from(optional && !missing));
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
        let texts = || {
            let bytes = |value: &&Value| match value {
                Value::Text(text) => ByteArray::from(text.as_str()),
                other => unreachable!("{other:?} among texts"),
            };
            self.values.iter().map(bytes).collect::<Vec<ByteArray>>()
        };
        let integer = |value: &&Value| match value {
            Value::Integer(number) => *number,
            other => unreachable!("{other:?} among whole numbers"),
        };
        let number = |value: &&Value| match value {
            Value::Number(number) => *number,
            other => unreachable!("{other:?} among numbers"),
        };
        let flag = |value: &&Value| match value {
            Value::Flag(flag) => *flag,
            other => unreachable!("{other:?} among flags"),
        };
        match writer {
            ColumnWriter::ByteArrayColumnWriter(writer) => writer.write_batch(&texts(), there, repeated),
            ColumnWriter::Int64ColumnWriter(writer) => {
                writer.write_batch(&self.values.iter().map(integer).collect::<Vec<i64>>(), there, repeated)
            }
            ColumnWriter::DoubleColumnWriter(writer) => {
                writer.write_batch(&self.values.iter().map(number).collect::<Vec<f64>>(), there, repeated)
            }
            ColumnWriter::BoolColumnWriter(writer) => {
                writer.write_batch(&self.values.iter().map(flag).collect::<Vec<bool>>(), there, repeated)
            }
            _ => unreachable!("the schema has no other types"),
        }
    }
}

/// The leaves of a column: one, or one for each field of its records.
fn leaves<'a>(kind: ColumnKind, rows: &[&'a Value]) -> Vec<Leaf<'a>> {
    let fields: Vec<ColumnKind> = match kind {
        ColumnKind::Records(fields) => fields.iter().map(|(_, kind)| *kind).collect(),
        ColumnKind::Texts => vec![ColumnKind::Text],
        other => vec![other],
    };
    let mut leaves: Vec<Leaf<'a>> = fields.iter().map(|_| Leaf::default()).collect();
    for row in rows {
        match row {
            Value::Records(records) => {
                for (at, record) in records.iter().enumerate() {
                    for ((leaf, kind), value) in leaves.iter_mut().zip(&fields).zip(record) {
                        leaf.put(*kind, value, 1, i16::from(at > 0));
                    }
                }
                if records.is_empty() {
                    leaves.iter_mut().for_each(Leaf::none);
                }
            }
            Value::Texts(texts) => {
                for (at, text) in texts.iter().enumerate() {
                    leaves[0].put(ColumnKind::Text, text, 1, i16::from(at > 0));
                }
                if texts.is_empty() {
                    leaves[0].none();
                }
            }
            value => leaves[0].put(kind, value, 0, 0),
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
        kinds.map(|(name, kind)| Column::new(name, kind, |_| Value::Missing)).to_vec()
    }

    fn text(text: &str) -> Value {
        Value::Text(text.to_owned())
    }

    fn rows() -> Vec<Vec<Value>> {
        let record =
            |who: &str, share: Option<f64>| vec![text(who), share.map_or(Value::Missing, Value::Number)];
        let full = vec![
            text("wAw\nw w\n"),
            text("é"),
            Value::Integer(i64::MIN),
            Value::Number(0.1),
            Value::Flag(true),
            Value::Texts(vec![text("a"), text("b")]),
            Value::Records(vec![record("x", None), record("y", Some(0.5)), record("z", None)]),
        ];
        let nothing = vec![
            text(""),
            Value::Missing,
            Value::Missing,
            Value::Missing,
            Value::Flag(false),
            Value::Texts(Vec::new()),
            Value::Records(Vec::new()),
        ];
        vec![full.clone(), nothing, full]
    }

    /// After reading back, lists begin and end where they did, and nulls are null.
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
