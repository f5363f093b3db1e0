//! The formatting of figures as text.

use itertools::Itertools;
use report::TableCell;

/// Formats a count with its noun, such as `1 level` or `2 levels`.
pub(crate) fn many(count: u64, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{} {noun}s", grouped(count)) }
}

/// Formats a number with up to two decimal places, depending on its size, such as `12.2`.
pub(crate) fn short(value: f64) -> String {
    TableCell::short(value).plain()
}

/// Formats a number with grouped digits, such as `12 345 678`.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let first = digits.len() % 3;
    let (head, tail) = digits.split_at(first);
    let groups = (0..tail.len() / 3).map(|group| &tail[3 * group..3 * group + 3]);
    std::iter::once(head).filter(|head| !head.is_empty()).chain(groups).join("\u{202f}")
}

/// The text shown in place of a missing value.
pub(crate) const NONE: &str = "–";

/// Formats a fraction as a percentage with a non-breaking space, such as `95 %`.
pub(crate) fn whole_percent(share: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_grouped() {
        assert_eq!([7, 1000, 12_345_678].map(grouped), ["7", "1\u{202f}000", "12\u{202f}345\u{202f}678"]);
        assert_eq!([1, 2].map(|count| many(count, "level")), ["1 level", "2 levels"]);
    }
}
