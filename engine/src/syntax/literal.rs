//! The lexical types of parameter values.

use super::grammar::{Grammar, Rule};
use pest::Parser;

/// The lexical type of a parameter value, before the field's type is known (`spec/01` §1.10, steps 2–5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Literal {
    Int(i32),
    Double(f64),
    Bool(bool),
    Text,
}

pub(crate) fn literal(text: &str) -> Literal {
    let Ok(mut pairs) = Grammar::parse(Rule::literal, text) else { return Literal::Text };
    let pair = pairs.next().and_then(|pair| pair.into_inner().next()).expect("the rule has one part");
    let number =
        || text.trim_end_matches(['f', 'F', 'd', 'D']).parse().map_or(Literal::Text, Literal::Double);
    match pair.as_rule() {
        Rule::integer => text.parse().map_or_else(|_| number(), Literal::Int),
        Rule::double => number(),
        Rule::hex => Literal::Double(hexadecimal(text)),
        Rule::special if text.ends_with("NaN") => Literal::Double(f64::NAN),
        Rule::special if text.starts_with('-') => Literal::Double(f64::NEG_INFINITY),
        Rule::special => Literal::Double(f64::INFINITY),
        _ => Literal::Bool(text.eq_ignore_ascii_case("true")),
    }
}

/// Returns the value of a hexadecimal number such as `0x1.8p3`: hexadecimal digits, times a power of two.
fn hexadecimal(text: &str) -> f64 {
    let negative = text.starts_with('-');
    let text = text.trim_start_matches(['+', '-']).trim_end_matches(['f', 'F', 'd', 'D']);
    let (digits, exponent) = text[2..].split_once(['p', 'P']).expect("the grammar asks for it");
    let mut exponent = exponent.parse().unwrap_or(if exponent.starts_with('-') { -5000 } else { 5000 });
    let point = digits.find('.').unwrap_or(digits.len());
    exponent = i32::clamp(exponent, -5000, 5000);
    let (mut mantissa, mut places) = (0u64, 0i64);
    for (at, digit) in digits.chars().filter_map(|digit| digit.to_digit(16)).enumerate() {
        // Digits beyond the precision of a double matter only if one of them is not 0.
        if mantissa < 1 << 59 {
            mantissa = mantissa << 4 | u64::from(digit);
            places += i64::from(at >= point);
        } else {
            mantissa |= u64::from(digit != 0);
            places -= i64::from(at < point);
        }
    }
    let scaled = i64::from(exponent) - 4 * places;
    let value = libm::scalbn(mantissa as f64, scaled.clamp(-10_000, 10_000) as i32);
    if negative { -value } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn literals_follow_the_conversion_order() {
        assert_eq!(literal("-3"), Literal::Int(-3));
        assert_eq!(literal("99999999999"), Literal::Double(99_999_999_999.0));
        assert_eq!(literal("1e3"), Literal::Double(1000.0));
        assert_eq!(literal("2f"), Literal::Double(2.0));
        assert_eq!(literal("TRUE"), Literal::Bool(true));
        assert_eq!(literal("0x1.8p3"), Literal::Double(12.0));
        assert_eq!(literal("-0X.8P0f"), Literal::Double(-0.5));
        assert_eq!(literal("0x10000000000000001p-4"), Literal::Double((1u64 << 60) as f64));
        assert_eq!(literal("0x0.00001p0"), Literal::Double(1.0 / 1_048_576.0));
        assert_eq!(literal("0x10"), Literal::Text);
        assert_eq!(literal("-Infinity"), Literal::Double(f64::NEG_INFINITY));
        assert!(matches!(literal("NaN"), Literal::Double(number) if number.is_nan()));
        assert_eq!(literal("nan"), Literal::Text);
        assert_eq!(literal("1/3"), Literal::Text);
        assert_eq!(literal(""), Literal::Text);
    }
}
