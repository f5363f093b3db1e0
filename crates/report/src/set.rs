//! Reports on sets of levels or games, as data. A report consists of questions, which are answered by
//! figures, and of additional tables.
//!
//! Each figure is defined once, with a name for people and a key for programs. The page shows the name, and
//! [`SetReport::to_json`] writes the key. Programs that read the JSON can rely on the keys, whereas names may
//! be reworded.

use crate::{Mean, Quantiles, Share, Table};
use base::canonical::{CanonicalError, Node};
use serde::Serialize;
use std::collections::BTreeMap;

/// A report on a set of levels or games.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SetReport {
    /// The most important figures, each under a different name than in its section.
    pub headlines: Vec<Figure>,
    /// The questions, in page order.
    pub sections: Vec<Section>,
    /// The tables that belong to no question.
    pub tables: Vec<Table>,
    data: Data,
}

/// A question in a report, with its answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Section {
    /// The key of the section's object in the JSON.
    pub key: &'static str,
    /// The question that the section answers.
    pub title: &'static str,
    /// A note on the figures, which may be empty.
    pub note: String,
    /// The section's figures, in page order.
    pub figures: Vec<Figure>,
    /// The tables shown below the figures on the page.
    pub tables: Vec<Table>,
    data: Data,
}

/// A figure shown on a page.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The value's key in the JSON. Empty for figures shown only on the page.
    pub key: &'static str,
    /// The name shown on the page.
    pub name: String,
    /// The figure's value.
    pub value: Value,
}

/// A figure's value.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A fraction of a set of items, and its interval.
    Share(Share),
    /// A mean between 0 and 1.
    Mean(Mean),
    /// A mean that may be negative.
    Gain(Mean),
    /// The quantiles of a sample.
    Quantiles(Quantiles),
    /// A number of items.
    Count(u64),
    /// A number of items out of a total, with the name of the items in the total.
    CountOf(u64, u64, &'static str),
    /// A fraction between 0 and 1, without an interval.
    Expected(f64),
    /// An unknown value.
    Missing,
}

impl From<Share> for Value {
    fn from(share: Share) -> Value {
        Value::Share(share)
    }
}

/// The named values for programs, and the first error among them.
#[derive(Clone, Debug, Default, PartialEq)]
struct Data {
    fields: BTreeMap<String, Node>,
    fault: Option<CanonicalError>,
}

impl Data {
    fn put(&mut self, key: &str, value: &(impl Serialize + ?Sized)) {
        match Node::new(value) {
            Ok(node) => _ = self.fields.insert(key.to_owned(), node),
            Err(fault) => _ = self.fault.get_or_insert(fault.inside(key)),
        }
    }
}

impl SetReport {
    /// Adds a value to the JSON but not to the page.
    #[must_use]
    pub fn data(mut self, key: &str, value: &(impl Serialize + ?Sized)) -> SetReport {
        self.data.put(key, value);
        self
    }

    /// Adds a question. If the question does not apply, the value of its key in the JSON is `null`.
    #[must_use]
    pub fn section(self, key: &str, section: impl Into<Option<Section>>) -> SetReport {
        let Some(section) = section.into() else { return self.data(key, &()) };
        let mut report = self;
        report.data.fields.insert(key.to_owned(), Node::Object(section.data.fields.clone()));
        report.data.fault =
            report.data.fault.or_else(|| section.data.fault.clone().map(|fault| fault.inside(key)));
        report.sections.push(section);
        report
    }

    /// Adds a table that belongs to no question.
    #[must_use]
    pub fn table(mut self, table: impl Into<Option<Table>>) -> SetReport {
        self.tables.extend(table.into());
        self
    }

    /// Adds figures to the top of the page under different names. Each figure is identified by its section
    /// and key. Nonexistent figures are omitted.
    #[must_use]
    pub fn headlines(mut self, figures: &[(&str, &str, &str)]) -> SetReport {
        for (section, key, name) in figures {
            let found = self.figure(section, key).cloned();
            self.headlines.extend(found.map(|figure| Figure { name: (*name).to_owned(), ..figure }));
        }
        self
    }

    /// Returns the figure with the given section and key, if it exists.
    pub fn figure(&self, section: &str, key: &str) -> Option<&Figure> {
        let section = self.sections.iter().find(|found| found.key == section)?;
        section.figures.iter().find(|figure| figure.key == key)
    }

    /// Returns the fraction with the given section and key, if it exists.
    pub fn share(&self, section: &str, key: &str) -> Option<Share> {
        match self.figure(section, key)?.value {
            Value::Share(share) => Some(share),
            _ => None,
        }
    }

    /// Returns the report as canonical JSON, with a line feed at the end.
    ///
    /// # Errors
    /// Returns an error if a number is not finite. Only a game's scores can cause this.
    pub fn to_json(&self) -> Result<String, CanonicalError> {
        match &self.data.fault {
            Some(fault) => Err(fault.clone()),
            None => Ok(Node::Object(self.data.fields.clone()).to_text()),
        }
    }
}

impl Section {
    /// Creates a question without answers.
    pub fn new(key: &'static str, title: &'static str, note: impl Into<String>) -> Section {
        let (figures, tables) = (Vec::new(), Vec::new());
        Section { key, title, note: note.into(), figures, tables, data: Data::default() }
    }

    /// Adds a value to the JSON but not to the page.
    #[must_use]
    pub fn data(mut self, key: &str, value: &(impl Serialize + ?Sized)) -> Section {
        self.data.put(key, value);
        self
    }

    /// Adds a figure to the page but not to the JSON.
    #[must_use]
    pub fn shown(self, name: impl Into<String>, value: Value) -> Section {
        self.figure("", name, value)
    }

    /// Adds a fraction.
    #[must_use]
    pub fn share(self, key: &'static str, name: impl Into<String>, share: Share) -> Section {
        self.data(key, &share).figure(key, name, Value::Share(share))
    }

    /// Adds a mean between 0 and 1, if there is one.
    #[must_use]
    pub fn mean(self, key: &'static str, name: &str, mean: Option<Mean>) -> Section {
        self.data(key, &mean).known(key, name, mean.map(Value::Mean))
    }

    /// Adds a mean that may be negative, if there is one.
    #[must_use]
    pub fn gain(self, key: &'static str, name: &str, mean: Option<Mean>) -> Section {
        self.data(key, &mean).known(key, name, mean.map(Value::Gain))
    }

    /// Adds the quantiles of the given values, if there are any values.
    #[must_use]
    pub fn quantiles(self, key: &'static str, name: &str, values: &[f64]) -> Section {
        let found = Quantiles::of(values);
        self.data(key, &found).known(key, name, found.map(Value::Quantiles))
    }

    /// Adds a number of items.
    #[must_use]
    pub fn count(self, key: &'static str, name: &str, count: u64) -> Section {
        self.data(key, &count).figure(key, name, Value::Count(count))
    }

    /// Adds the number of times that each item occurs. If a total is given, the page shows fractions of it
    /// instead of the counts.
    #[must_use]
    pub fn tally(self, key: &str, name: &str, counts: &BTreeMap<String, u64>, of: Option<u64>) -> Section {
        counts.iter().fold(self.data(key, counts), |section, (thing, &count)| {
            let value = of.map_or(Value::Count(count), |of| Value::Share(Share::new(count, of)));
            section.shown(format!("{name}: {thing}"), value)
        })
    }

    /// Adds a table to the page but not to the JSON.
    #[must_use]
    pub fn table(mut self, table: Table) -> Section {
        self.tables.push(table);
        self
    }

    fn known(self, key: &'static str, name: &str, value: Option<Value>) -> Section {
        match value {
            Some(value) => self.figure(key, name, value),
            None => self,
        }
    }

    /// Adds a figure to the page but not to the JSON. [`SetReport::headlines`] can find the figure by its
    /// key.
    #[must_use]
    pub fn figure(mut self, key: &'static str, name: impl Into<String>, value: Value) -> Section {
        self.figures.push(Figure { key, name: name.into(), value });
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_is_stated_once_and_told_twice() {
        let validity = Section::new("validity", "Are the levels valid?", "")
            .share("passes", "every criterion met", Share::new(1, 2))
            .gain("order", "order", None)
            .tally("obstacles", "first failure", &BTreeMap::from([("length".to_owned(), 1)]), Some(2))
            .data("fit", &[1]);
        let report = SetReport::default()
            .data("count", &2)
            .section("validity", validity)
            .section("skill", None)
            .headlines(&[
                ("validity", "passes", "pass"),
                ("validity", "order", "order"),
                ("skill", "wins", "gain"),
            ]);
        let names: Vec<&str> = report.sections[0].figures.iter().map(|figure| figure.name.as_str()).collect();
        assert_eq!(names, ["every criterion met", "first failure: length"]);
        assert_eq!(report.headlines.iter().map(|figure| figure.name.as_str()).collect::<Vec<_>>(), ["pass"]);
        let json: serde_json::Value = serde_json::from_str(&report.to_json().unwrap()).unwrap();
        assert_eq!((&json["skill"], &json["count"]), (&serde_json::Value::Null, &2.into()));
        let validity = &json["validity"];
        assert_eq!((&validity["passes"]["count"], &validity["obstacles"]["length"]), (&1.into(), &1.into()));
        assert_eq!(
            (&validity["order"], &validity["fit"]),
            (&serde_json::Value::Null, &serde_json::json!([1]))
        );
    }

    #[test]
    fn a_number_that_json_lacks_is_named() {
        let skill = Section::new("skill", "Does skill pay?", "").data("points", &f64::NAN);
        let error = SetReport::default().section("skill", skill).to_json().unwrap_err();
        assert_eq!(error.at, "skill.points");
    }
}
