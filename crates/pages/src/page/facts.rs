//! The figures on a page. Each figure answers a question and includes an interval.

use super::tables::Shown;
use super::words;
use report::{Figure, Mean, Quantiles, Share, Table, TableCell, Value};
use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Section {
    title: &'static str,
    note: String,
    facts: Vec<Fact>,
    tables: Vec<Shown>,
}

#[derive(Serialize)]
pub(crate) struct Fact {
    name: String,
    value: String,
    /// The bar as SVG. Empty if there is nothing to draw.
    bar: String,
    band: String,
    /// A phrase stating the size of the figure's sample.
    of: String,
}

impl Section {
    /// Converts a report section to a page section. Quantiles of several samples get a separate table.
    pub(crate) fn of(section: &report::Section) -> Section {
        let columns = ["", "least", "¼", "median", "¾", "most", "of"];
        let mut quantiles = Table::new("quantiles", "", "", &columns);
        for figure in &section.figures {
            let Value::Quantiles(Quantiles { count, min, lower, median, upper, max }) = figure.value else {
                continue;
            };
            let five = [min, lower, median, upper, max].map(TableCell::short);
            let cells = [TableCell::text(&*figure.name)].into_iter().chain(five);
            quantiles.push(cells.chain([TableCell::Count(count)]).collect());
        }
        let facts = section.figures.iter().filter(|figure| !matches!(figure.value, Value::Quantiles(_)));
        let tables = section.tables.iter().chain([&quantiles]).filter(|table| !table.rows.is_empty());
        Section {
            title: section.title,
            note: section.note.clone(),
            facts: facts.map(Fact::headline).collect(),
            tables: tables.map(Shown::of).collect(),
        }
    }
}

impl Fact {
    /// Converts a report figure to a fact on a page. Quantiles are represented by the median.
    pub(crate) fn headline(figure: &Figure) -> Fact {
        let name = &*figure.name;
        match &figure.value {
            Value::Share(share) => Fact::share(name, share),
            Value::Mean(Mean { mean, interval, count, item }) => {
                let [low, high] = *interval;
                let band = format!("{low:.2} to {high:.2}");
                Fact { bar: bar(*mean, *interval), ..Fact::plain(name, format!("{mean:.2}")) }
                    .within(band)
                    .of(words::many(*count, item))
            }
            Value::Gain(Mean { mean, interval: [low, high], count, item }) => {
                let band = format!("{low:+.2} to {high:+.2}");
                Fact::plain(name, format!("{mean:+.2}")).within(band).of(words::many(*count, item))
            }
            Value::Quantiles(found) => Fact::plain(name, words::short(found.median)),
            Value::Count(count) => Fact::plain(name, words::grouped(*count)),
            Value::CountOf(count, of, item) => {
                Fact::plain(name, words::grouped(*count)).of(words::many(*of, item))
            }
            Value::Expected(share) => Fact::plain(name, words::whole_percent(*share)),
            Value::Missing => Fact::plain(name, words::NONE.to_owned()),
        }
    }

    /// Returns a fact about a fraction, such as `95 %`, with its interval `76 to 99 %` and its sample
    /// `19 of 20`. If the sample is empty, the value is a dash.
    fn share(name: &str, share: &Share) -> Fact {
        let of = format!("{} of {}", share.count, share.of);
        if share.of == 0 {
            return Fact::plain(name, words::NONE.to_owned()).of(of);
        }
        let [low, high] = share.interval.map(|end| 100.0 * end);
        let band = format!("{low:.0} to {high:.0}\u{a0}%");
        let fact = Fact::plain(name, words::whole_percent(share.share())).within(band).of(of);
        Fact { bar: bar(share.share(), share.interval), ..fact }
    }

    pub(crate) fn plain(name: impl Into<String>, value: String) -> Fact {
        Fact { name: name.into(), value, bar: String::new(), band: String::new(), of: String::new() }
    }

    #[must_use]
    pub(crate) fn of(self, of: String) -> Fact {
        Fact { of, ..self }
    }

    #[must_use]
    pub(crate) fn within(self, band: String) -> Fact {
        Fact { band, ..self }
    }
}

/// Draws a fraction between 0 and 1 as a bar, and its interval as a line.
fn bar(share: f64, [low, high]: [f64; 2]) -> String {
    const LENGTH: f64 = 90.0;
    let at = |share: f64| number(LENGTH * share.clamp(0.0, 1.0));
    let (end, low, high) = (at(share), at(low), at(high));
    format!(
        "<svg class=\"bar\" width=\"{LENGTH}\" height=\"12\" viewBox=\"0 0 {LENGTH} 12\" aria-hidden=\"true\">\
         <rect width=\"{LENGTH}\" height=\"12\" class=\"track\"/><rect width=\"{end}\" height=\"12\" class=\"fill\"/>\
         <path d=\"M{low} 6H{high}M{low} 3V9M{high} 3V9\" class=\"whisker\"/></svg>"
    )
}

/// Formats a length in pixels with at most one decimal place.
pub(crate) fn number(value: f64) -> String {
    let tenths = (value * 10.0).round() as i64;
    if tenths % 10 == 0 { format!("{}", tenths / 10) } else { format!("{:.1}", tenths as f64 / 10.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bars_stay_within_their_track() {
        let text = bar(0.5, [-0.1, 1.2]);
        assert!(text.contains("<rect width=\"45\"") && text.contains("M0 6H90"), "{text}");
    }

    #[test]
    fn shares_are_told_in_words() {
        let told = |count, of| {
            let Fact { value, band, of, .. } =
                Fact::share("", &Share { count, of, interval: [0.764, 0.991] });
            [value, band, of]
        };
        assert_eq!(told(19, 20), ["95\u{a0}%", "76 to 99\u{a0}%", "19 of 20"]);
        assert_eq!(told(0, 0), [words::NONE, "", "0 of 0"]);
    }
}
