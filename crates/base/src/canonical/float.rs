//! The canonical text of floats.
//!
//! `serde_json` also prints the shortest digits, but its layout has changed within version 1 (`1e21` became
//! `1e+21`). Printers also differ when two shortest texts are equally close to the value: 824108109772659.25
//! becomes `….2` in one printer and `….3` in another. This module fixes both the layout and the digits for
//! snapshot format 1, as in `serde_json` 1.0.154.

/// Returns the shortest decimal text that parses back to the same bits. If there are several, returns the one
/// closest to the value; if two are equally close, returns the one whose last digit is even. The text is in
/// plain notation from 0.00001 up to 10^16, has an exponent outside that range, and always contains a `.` or
/// an exponent. `value` must be finite.
pub(super) fn shortest(value: f64) -> String {
    let text = shortest_scientific(value);
    let (mantissa, exponent) =
        text.split_once('e').expect("scientific text of a finite number has an exponent");
    let exponent: i32 = exponent.parse().expect("the exponent of an f64 is a small integer");
    let (sign, mantissa) = match mantissa.strip_prefix('-') {
        Some(mantissa) => ("-", mantissa),
        None => ("", mantissa),
    };
    let digits = mantissa.replace('.', "");
    match usize::try_from(exponent) {
        Ok(whole) if whole < 16 => {
            let digits = format!("{digits:0<width$}", width = whole + 2);
            let (integer, fraction) = digits.split_at(whole + 1);
            format!("{sign}{integer}.{fraction}")
        }
        Err(_) if exponent >= -5 => {
            let zeros = "0".repeat(exponent.unsigned_abs() as usize - 1);
            format!("{sign}0.{zeros}{digits}")
        }
        _ => format!("{sign}{mantissa}e{exponent:+}"),
    }
}

/// Returns the shortest text in scientific notation: `-1.25e-7`, `5e-324`, `0e0`.
fn shortest_scientific(value: f64) -> String {
    // Rust does not specify which of two equally close texts it prints as the shortest form. With an explicit
    // precision, however, it rounds correctly, half to even. Just below a power of two, floats lie closer
    // together than above it, so the rounded text may parse back to a different number.
    let shortest = format!("{value:e}");
    let digits = shortest.bytes().take_while(|byte| *byte != b'e').filter(u8::is_ascii_digit).count();
    let rounded = format!("{value:.precision$e}", precision = digits - 1);
    match rounded.parse() {
        Ok(read) if f64::to_bits(read) == value.to_bits() => rounded,
        _ => shortest,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden() {
        for (value, expect) in [
            (0.0, "0.0"),
            (-0.0, "-0.0"),
            (1.0, "1.0"),
            (-2.5, "-2.5"),
            (100.0, "100.0"),
            (0.1, "0.1"),
            (0.1 + 0.2, "0.30000000000000004"),
            (1.0 / 3.0, "0.3333333333333333"),
            (1234.5678, "1234.5678"),
            (0.00012345675, "0.00012345675"),
            (0.00001, "0.00001"),
            (0.000009, "9e-6"),
            (-1.25e-7, "-1.25e-7"),
            (9007199254740993.0, "9007199254740992.0"),
            (9999999999999998.0, "9999999999999998.0"),
            (824108109772659.0 + 0.25, "824108109772659.2"),
            (747225688189297.0 + 0.25, "747225688189297.2"),
            (5.684341886080802e-14, "5.684341886080802e-14"),
            (7.120236347223045e-307, "7.120236347223045e-307"),
            (1e16, "1e+16"),
            (123456789012345680.0, "1.2345678901234568e+17"),
            (-1e21, "-1e+21"),
            (5e-324, "5e-324"),
            (f64::MIN_POSITIVE, "2.2250738585072014e-308"),
            (f64::MAX, "1.7976931348623157e+308"),
        ] {
            assert_eq!(shortest(value), expect);
        }
    }

    /// Checks floats with all exponents and many digits, drawn from a small generator.
    #[test]
    fn every_text_reads_back_as_the_same_bits() {
        let mut bits = 0x9e37_79b9_7f4a_7c15_u64;
        for _ in 0..20_000 {
            bits ^= bits << 13;
            bits ^= bits >> 7;
            bits ^= bits << 17;
            for value in [f64::from_bits(bits), (bits >> 40) as f64 / 1000.0] {
                if value.is_finite() {
                    let text = shortest(value);
                    assert_eq!(text.parse().map(f64::to_bits), Ok(value.to_bits()), "{text}");
                    assert!(text.contains(['.', 'e']), "{text}");
                    let read: f64 = serde_json::from_str(&text).expect("a JSON number");
                    assert_eq!(read.to_bits(), value.to_bits(), "{text}");
                }
            }
        }
    }
}
