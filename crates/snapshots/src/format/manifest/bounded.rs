//! Reads a recipe as arbitrary JSON in bounded memory.
//!
//! A manifest is untrusted input, and its root can be compared only after the whole manifest has been read. Two
//! limits bound the memory that a few bytes can cost. Nesting depth is limited, because the canonical text indents
//! every level. The number of values is limited, because a value takes much more memory than the two bytes that
//! suffice to write it.

use std::cell::Cell;

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

/// The maximum nesting depth of a recipe's arrays and objects, including the recipe itself. Minted recipes have 4
/// levels.
pub(super) const MAX_NESTING: usize = 16;
/// The maximum number of values in a recipe. An object counts as [`OBJECT`] values.
pub(super) const MAX_VALUES: usize = 1 << 20;
/// The number of values that an object counts as.
const OBJECT: usize = 16;

/// Reads a value with at most [`MAX_NESTING`] levels and [`MAX_VALUES`] values. Any excess is rejected before
/// it is stored.
pub(super) fn bounded<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Value, D::Error> {
    Bounded { levels: MAX_NESTING, values: &Cell::new(MAX_VALUES) }.deserialize(deserializer)
}

/// The remaining budget: the number of levels below the current value, and the number of values in the rest of the
/// recipe.
#[derive(Clone, Copy)]
struct Bounded<'a> {
    levels: usize,
    values: &'a Cell<usize>,
}

impl Bounded<'_> {
    fn scalar<E: Error>(self, value: impl Into<Value>) -> Result<Value, E> {
        self.spend(1).map(|()| value.into())
    }

    fn spend<E: Error>(self, values: usize) -> Result<(), E> {
        let left = self.values.get().checked_sub(values);
        let left =
            left.ok_or_else(|| E::custom(format_args!("the recipe has more than {MAX_VALUES} values")));
        left.map(|left| self.values.set(left))
    }

    /// Returns the budget for the contents of an array or object.
    fn inside<E: Error>(self) -> Result<Self, E> {
        let levels = self.levels.checked_sub(1);
        let levels = levels
            .ok_or_else(|| E::custom(format_args!("the recipe is nested deeper than {MAX_NESTING} levels")));
        levels.map(|levels| Bounded { levels, ..self })
    }
}

impl<'de> DeserializeSeed<'de> for Bounded<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Bounded<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_bool<E: Error>(self, value: bool) -> Result<Value, E> {
        self.scalar(value)
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Value, E> {
        self.scalar(value)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Value, E> {
        self.scalar(value)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Value, E> {
        self.scalar(value)
    }

    fn visit_str<E: Error>(self, value: &str) -> Result<Value, E> {
        self.scalar(value)
    }

    fn visit_unit<E: Error>(self) -> Result<Value, E> {
        self.scalar(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        self.spend(1)?;
        let inside = self.inside()?;
        let mut list = Vec::new();
        while let Some(item) = items.next_element_seed(inside)? {
            list.push(item);
        }
        Ok(Value::Array(list))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        self.spend(OBJECT)?;
        let inside = self.inside()?;
        let mut fields = Map::new();
        while let Some(key) = entries.next_key::<String>()? {
            fields.insert(key, entries.next_value_seed(inside)?);
        }
        Ok(Value::Object(fields))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Value, serde_json::Error> {
        bounded(&mut serde_json::Deserializer::from_str(text))
    }

    #[track_caller]
    fn refuse(text: &str, expect: &str) {
        let error = read(text).expect_err(expect).to_string();
        assert!(error.contains(expect), "{error}");
    }

    fn nested(levels: usize) -> String {
        format!("{}{}", "[".repeat(levels), "]".repeat(levels))
    }

    #[test]
    fn the_same_value_as_without_bounds() {
        let text =
            r#"{ "a": [1, -2, 3.5, true, null, "x\n"], "b": { "": [] }, "c": 18446744073709551615, "a": 0 }"#;
        assert_eq!(read(text).expect("JSON"), serde_json::from_str::<Value>(text).expect("JSON"));
    }

    #[test]
    fn depth_is_bounded() {
        assert!(read(&nested(MAX_NESTING)).is_ok());
        refuse(&nested(MAX_NESTING + 1), "nested deeper than 16 levels");
        refuse(&"{\"a\":".repeat(MAX_NESTING + 1), "nested deeper than 16 levels");
        // Brackets inside a string do not count.
        assert!(read(&format!("\"{}\"", nested(99))).is_ok());
    }

    #[test]
    fn width_is_bounded() {
        let list = |item: &str, count: usize| format!("[{}]", vec![item; count].join(","));
        assert!(read(&list("0", MAX_VALUES - 1)).is_ok());
        refuse(&list("0", MAX_VALUES), "more than 1048576 values");
        refuse(&list("{}", MAX_VALUES / OBJECT), "more than 1048576 values");
    }

    /// The recipes of the stored releases stay far below the nesting limit.
    #[test]
    fn our_recipes_are_flat() {
        fn levels(value: &Value) -> usize {
            match value {
                Value::Array(items) => 1 + items.iter().map(levels).max().unwrap_or(0),
                Value::Object(fields) => 1 + fields.values().map(levels).max().unwrap_or(0),
                _ => 0,
            }
        }
        for release in ["format-1", "other-generation", "other-semantics"] {
            let path =
                format!("{}/../../tests/suite/snapshots/{release}/MANIFEST.json", env!("CARGO_MANIFEST_DIR"));
            let manifest = crate::Manifest::parse(&std::fs::read(path).expect("kept")).expect("sound");
            assert!((1..=MAX_NESTING / 4).contains(&levels(&manifest.recipe)), "{release}");
        }
    }
}
