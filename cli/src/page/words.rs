//! Figures in words.

use report::{Quantiles, Share};
use validators::Difficulty;

/// `95 %`, with a non-breaking space; a dash if there are no cases.
pub(crate) fn percent(share: &Share) -> String {
    if share.of == 0 { NONE.to_owned() } else { whole_percent(share.share()) }
}

/// `19 of 20`.
pub(crate) fn counted(share: &Share) -> String {
    format!("{} of {}", share.count, share.of)
}

/// `76 to 99 %`; empty if there are no cases.
pub(crate) fn band(share: &Share) -> String {
    let [low, high] = share.interval.map(|end| 100.0 * end);
    if share.of == 0 { String::new() } else { format!("{low:.0} to {high:.0}\u{a0}%") }
}

/// `length not passed`: of a criterion.
pub(crate) fn not_passed(criterion: &str) -> String {
    format!("{criterion} not passed")
}

/// `+0.31`.
pub(crate) fn signed(mean: f64) -> String {
    format!("{mean:+.2}")
}

/// `+0.20 to +0.42`.
pub(crate) fn signed_band([low, high]: [f64; 2]) -> String {
    format!("{low:+.2} to {high:+.2}")
}

/// `0.31`.
pub(crate) fn mean(mean: f64) -> String {
    format!("{mean:.2}")
}

/// `0.20 to 0.42`.
pub(crate) fn mean_band([low, high]: [f64; 2]) -> String {
    format!("{low:.2} to {high:.2}")
}

/// `1 level`, `2 levels`.
pub(crate) fn many(count: u64, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{} {noun}s", grouped(count)) }
}

/// Least, lower quartile, median, upper quartile and greatest.
pub(crate) fn five(quantiles: &Quantiles) -> [String; 5] {
    let Quantiles { min, lower, median, upper, max, .. } = *quantiles;
    [min, lower, median, upper, max].map(short)
}

/// A count without decimals, or any other value with enough decimals to tell it from its neighbours.
pub(crate) fn short(value: f64) -> String {
    let decimals = if value.fract() == 0.0 || value.abs() >= 100.0 {
        0
    } else if value.abs() >= 1.0 {
        1
    } else {
        2
    };
    format!("{value:.decimals$}")
}

/// `12 345 678`.
pub(crate) fn grouped(count: u64) -> String {
    let digits = count.to_string();
    let first = digits.len() % 3;
    let (head, tail) = digits.split_at(first);
    let groups = (0..tail.len() / 3).map(|group| &tail[3 * group..3 * group + 3]);
    std::iter::once(head).filter(|head| !head.is_empty()).chain(groups).collect::<Vec<_>>().join("\u{202f}")
}

/// A difficulty, or a dash.
pub(crate) fn label(difficulty: Option<Difficulty>) -> String {
    difficulty.map_or(NONE.to_owned(), |label| label.to_string())
}

/// The placeholder for a missing value.
pub(crate) const NONE: &str = "–";

/// `95 %`.
pub(crate) fn whole_percent(share: f64) -> String {
    format!("{:.0}\u{a0}%", 100.0 * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_short() {
        let share = |count, of| Share { count, of, interval: [0.764, 0.991] };
        assert_eq!(
            (percent(&share(19, 20)), band(&share(19, 20))),
            ("95\u{a0}%".into(), "76 to 99\u{a0}%".into())
        );
        assert_eq!((percent(&share(0, 0)), band(&share(0, 0))), (NONE.into(), String::new()));
        assert_eq!([3.0, 0.3333, 9.5, 12.25, 123.4].map(short), ["3", "0.33", "9.5", "12.2", "123"]);
        assert_eq!([7, 1000, 12_345_678].map(grouped), ["7", "1\u{202f}000", "12\u{202f}345\u{202f}678"]);
    }
}
