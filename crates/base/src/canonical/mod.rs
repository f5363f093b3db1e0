//! Canonical JSON: exactly one text per value, so that digests and diffs are meaningful.
//!
//! - Object keys are sorted by their UTF-8 bytes, at every depth, regardless of the order in which the type
//!   serialises them.
//! - Indentation is two spaces, but an array that contains no arrays or objects stays on one line.
//! - Strings are escaped as in `serde_json`, which escapes only `"`, `\` and control characters.
//! - Integers are plain 64-bit numbers. Floats have the shortest form that parses back to the same bits,
//!   always with a `.` or an exponent (`1.0`, not `1`; `1e+16`). An `f32` is first widened to `f64`.
//! - The text ends with a single line feed.
//!
//! A value that JSON cannot represent exactly is an error; it is never written as a different value. Examples
//! are NaN and infinities, a duplicate key, and nesting that the parser would reject. A `serde_json::Value`
//! and the type from which it was created yield the same text. Parsing a canonical text and writing it again
//! yields the same bytes.

mod float;
mod node;

use std::fmt::{self, Write};

use crate::digest::Digest;
use serde::Serialize;

pub use node::Node;

/// The maximum nesting depth of arrays and objects, which equals the maximum that `serde_json` parses.
pub const MAX_DEPTH: usize = 127;

/// The error for a value without a canonical JSON text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{} cannot be written as canonical JSON: {fault}", match at.as_str() { "" => "the value".into(), at => format!("`{}`", at.escape_debug()) })]
pub struct CanonicalError {
    /// The position of the fault in the value, as keys and indices joined by dots. Empty if the fault is the
    /// value itself.
    pub at: String,
    /// The kind of fault.
    pub fault: Fault,
}

/// The faults that prevent a canonical JSON text.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// A float is NaN or infinite.
    #[error("the number is not finite")]
    NotFinite,
    /// An object key has a type without a unique spelling. Only strings, integers, booleans and unit variants
    /// have one.
    #[error("the key is not a string")]
    Key,
    /// An object contains this key twice, for example through `#[serde(flatten)]`.
    #[error("the key `{}` occurs twice", .0.escape_debug())]
    DuplicateKey(String),
    /// Arrays and objects are nested deeper than [`MAX_DEPTH`].
    #[error("the value is nested deeper than {MAX_DEPTH} levels")]
    TooDeep,
    /// The type encodes its value with a private convention of its crate, as a TOML date does.
    #[error("`{0}` is private to its crate: convert it to plain data first")]
    Private(&'static str),
    /// The value's own `Serialize` implementation failed.
    #[error("{0}")]
    Other(String),
}

/// Returns the canonical JSON of `value`, with a line feed at the end. Cost: O(n log n), and one copy of the value.
///
/// # Errors
/// Returns the first [`Fault`], in the order in which the value serialises itself.
pub fn to_canonical_json<T: Serialize + ?Sized>(value: &T) -> Result<String, CanonicalError> {
    Ok(Node::new(value)?.to_text())
}

/// Returns `true` if `bytes` are the canonical JSON of `value`. The text is not built, and the comparison stops at the
/// first difference.
///
/// # Errors
/// Returns the same errors as [`to_canonical_json`].
pub fn is_canonical_json<T: Serialize + ?Sized>(value: &T, bytes: &[u8]) -> Result<bool, CanonicalError> {
    let mut rest = Rest(bytes);
    Ok(Node::new(value)?.write(&mut rest).is_ok() && rest.0.is_empty())
}

/// Returns the digest of the canonical JSON of `value`, computed without building the text.
///
/// # Errors
/// Returns the same errors as [`to_canonical_json`].
pub fn canonical_digest<T: Serialize + ?Sized>(value: &T) -> Result<Digest, CanonicalError> {
    let mut hashed = Hashed(blake3::Hasher::new());
    Node::new(value)?.write(&mut hashed).expect("a hasher takes all that is written to it");
    Ok(Digest::from_bytes(*hashed.0.finalize().as_bytes()))
}

/// The part of an expected text that has not been matched yet.
struct Rest<'a>(&'a [u8]);

impl Write for Rest<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0 = self.0.strip_prefix(text.as_bytes()).ok_or(fmt::Error)?;
        Ok(())
    }
}

/// A sink that hashes a text without storing it.
struct Hashed(blake3::Hasher);

impl Write for Hashed {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text.as_bytes());
        Ok(())
    }
}

impl Node {
    /// Returns the canonical JSON, with a line feed at the end.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        self.write(&mut text).expect("a string takes all that is written to it");
        text
    }

    /// Writes the canonical JSON to `out`. Returns an error only if `out` returns an error.
    fn write(&self, out: &mut impl Write) -> fmt::Result {
        write_node(self, 0, out).and_then(|()| out.write_str("\n"))
    }
}

fn write_node(node: &Node, indent: usize, out: &mut impl Write) -> fmt::Result {
    match node {
        Node::Null => out.write_str("null"),
        Node::Bool(value) => out.write_str(if *value { "true" } else { "false" }),
        Node::Integer(number) => write!(out, "{number}"),
        Node::Float(number) => out.write_str(&float::shortest(*number)),
        Node::Text(text) => write_text(text, out),
        Node::Array(items) if items.iter().all(Node::is_scalar) => {
            out.write_str("[")?;
            for (index, item) in items.iter().enumerate() {
                out.write_str(if index == 0 { "" } else { ", " })?;
                write_node(item, indent, out)?;
            }
            out.write_str("]")
        }
        Node::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                out.write_str(if index == 0 { "[" } else { "," })?;
                new_line(indent + 1, out)?;
                write_node(item, indent + 1, out)?;
            }
            new_line(indent, out)?;
            out.write_str("]")
        }
        Node::Object(fields) if fields.is_empty() => out.write_str("{}"),
        Node::Object(fields) => {
            for (index, (key, value)) in fields.iter().enumerate() {
                out.write_str(if index == 0 { "{" } else { "," })?;
                new_line(indent + 1, out)?;
                write_text(key, out)?;
                out.write_str(": ")?;
                write_node(value, indent + 1, out)?;
            }
            new_line(indent, out)?;
            out.write_str("}")
        }
    }
}

fn write_text(text: &str, out: &mut impl Write) -> fmt::Result {
    out.write_str(&serde_json::to_string(text).expect("every string has a JSON form"))
}

fn new_line(indent: usize, out: &mut impl Write) -> fmt::Result {
    out.write_str("\n")?;
    (0..indent).try_for_each(|_| out.write_str("  "))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use serde_json::{Value, json};

    use super::*;

    #[track_caller]
    fn check<T: Serialize + ?Sized>(value: &T, expect: &str) {
        let text = to_canonical_json(value).expect("canonical");
        assert_eq!(text, format!("{expect}\n"));
        assert_eq!(canonical_digest(value), Ok(Digest::of(text.as_bytes())));
        assert_eq!(is_canonical_json(value, text.as_bytes()), Ok(true));
        for other in [&text[..text.len() - 1], &format!("{text}\n"), &text.replacen('\n', " \n", 1), ""] {
            assert_eq!(is_canonical_json(value, other.as_bytes()), Ok(false), "{other}");
        }
        let read: Value = serde_json::from_str(&text).expect("canonical JSON is JSON");
        assert_eq!(to_canonical_json(&read).expect("canonical"), text, "not idempotent");
    }

    #[track_caller]
    fn refuse<T: Serialize + ?Sized>(value: &T, at: &str, fault: Fault) {
        assert_eq!(to_canonical_json(value), Err(CanonicalError { at: at.into(), fault }));
    }

    #[test]
    fn scalars() {
        check(&(), "null");
        check(&None::<u8>, "null");
        check(&true, "true");
        check(&u64::MAX, "18446744073709551615");
        check(&i64::MIN, "-9223372036854775808");
        check("a\"\\/\n\u{1}\u{7f}é\u{2028}", "\"a\\\"\\\\/\\n\\u0001\u{7f}é\u{2028}\"");
        check(&'x', "\"x\"");
    }

    #[test]
    fn floats() {
        for (value, expect) in
            [(-0.0, "-0.0"), (1.0, "1.0"), (0.1 + 0.2, "0.30000000000000004"), (1e16, "1e+16")]
        {
            check(&value, expect);
        }
        check(&0.5_f32, "0.5");
        check(&0.1_f32, "0.10000000149011612");
    }

    #[test]
    fn keys_sort_by_bytes_at_every_depth() {
        let value =
            json!({ "b": { "z": 1, "Z": 2, "é": 3, "a": {} }, "a": [], "B": [{ "y": 1, "x": 2 }], "": 0 });
        check(
            &value,
            r#"{
  "": 0,
  "B": [
    {
      "x": 2,
      "y": 1
    }
  ],
  "a": [],
  "b": {
    "Z": 2,
    "a": {},
    "z": 1,
    "é": 3
  }
}"#,
        );
    }

    #[test]
    fn arrays_of_scalars_stay_on_one_line() {
        check(&json!([1, "two", null, 2.5, true]), r#"[1, "two", null, 2.5, true]"#);
        check(&json!([[1, 2], [3]]), "[\n  [1, 2],\n  [3]\n]");
        check(&json!([1, []]), "[\n  1,\n  []\n]");
    }

    #[derive(Serialize)]
    enum Shape {
        Unit,
        Newtype(u8),
        Tuple(u8, u8),
        Struct { y: u8, x: u8 },
    }

    #[derive(Serialize)]
    struct Everything {
        shapes: Vec<Shape>,
        none: Option<u8>,
        some: Option<u8>,
        pair: (u8, f64),
        numbered: BTreeMap<i32, u8>,
    }

    /// Checks that keys are sorted as text (`10` before `9`), as in a `Value`.
    #[test]
    fn every_serde_shape() {
        let everything = Everything {
            shapes: vec![Shape::Unit, Shape::Newtype(1), Shape::Tuple(1, 2), Shape::Struct { y: 1, x: 2 }],
            none: None,
            some: Some(3),
            pair: (1, 0.5),
            numbered: [(9, 0), (10, 1), (-1, 2)].into(),
        };
        check(
            &everything,
            r#"{
  "none": null,
  "numbered": {
    "-1": 2,
    "10": 1,
    "9": 0
  },
  "pair": [1, 0.5],
  "shapes": [
    "Unit",
    {
      "Newtype": 1
    },
    {
      "Tuple": [1, 2]
    },
    {
      "Struct": {
        "x": 2,
        "y": 1
      }
    }
  ],
  "some": 3
}"#,
        );
        let by_value = serde_json::to_value(&everything).expect("plain data");
        assert_eq!(to_canonical_json(&by_value), to_canonical_json(&everything));
    }

    #[test]
    fn values_outside_json_are_refused_with_their_path() {
        refuse(&f64::NAN, "", Fault::NotFinite);
        refuse(&f32::INFINITY, "", Fault::NotFinite);
        let nested: BTreeMap<&str, Vec<Option<f64>>> = [("games", vec![Some(1.0), Some(f64::NAN)])].into();
        refuse(&nested, "games.1", Fault::NotFinite);
        refuse(&Some(u128::MAX), "", Fault::Other("u128 is not supported".into()));
        let keyed: BTreeMap<Vec<u8>, u8> = [(vec![1], 1)].into();
        refuse(&keyed, "", Fault::Key);
        let date: toml::Value = toml::from_str("when = 2026-12-01").expect("TOML");
        refuse(&date, "when", Fault::Private("$__toml_private_Datetime"));
    }

    #[test]
    fn a_key_twice_is_refused() {
        #[derive(Serialize)]
        struct Twice {
            a: u8,
            #[serde(flatten)]
            rest: BTreeMap<String, u8>,
        }
        let twice = |key: &str| Twice { a: 1, rest: [(key.to_string(), 2)].into() };
        check(&twice("b"), "{\n  \"a\": 1,\n  \"b\": 2\n}");
        refuse(&twice("a"), "", Fault::DuplicateKey("a".into()));
    }

    #[test]
    fn nesting_is_bounded_like_the_reader() {
        let nested = |depth: usize| (0..depth).fold(json!(1), |inner, _| json!([inner]));
        let deepest = to_canonical_json(&nested(MAX_DEPTH)).expect("canonical");
        assert!(serde_json::from_str::<Value>(&deepest).is_ok());
        let deeper = nested(MAX_DEPTH + 1);
        assert!(serde_json::from_str::<Value>(&deeper.to_string()).is_err());
        let error = to_canonical_json(&deeper).expect_err("too deep");
        assert_eq!(error.fault, Fault::TooDeep);
    }
}
