//! Fractional numbers on the command line.

use clap::builder::TypedValueParser;
use std::ops::RangeInclusive;

/// Returns a parser for numbers in a finite range, which also rejects `nan` and `inf`.
pub(crate) fn number(range: RangeInclusive<f64>) -> impl TypedValueParser<Value = f64> {
    move |text: &str| match text.parse::<f64>() {
        Ok(number) if range.contains(&number) => Ok(number),
        _ => Err(format!("expected a number from {} to {}", range.start(), range.end())),
    }
}
