//! The requested difficulty compared with the measured difficulty.

use crate::reported::{LABELS, rank};
use crate::survey::SurveyedLevel;
use report::{Section, Share, Table, TableCell, Value};
use serde::Serialize;
use validators::Difficulty;

/// The minimum fraction of levels with a label among levels without a requested difficulty. Below this fraction, the
/// game counts as unable to express the label.
const EXPRESSIBLE: f64 = 0.05;

/// The index of the requested label and the index of the measured label.
type Asked = (usize, Option<usize>);

/// The levels whose measured label equals the requested label.
#[derive(Serialize)]
struct Hits {
    /// The fraction of levels with exactly the requested label.
    exact: Share,
    /// The fraction of levels with the requested or a neighbouring label.
    within_one: Share,
    /// The expected value of `exact` if each level were picked at random from the pool, which contains levels without a
    /// requested difficulty. `None` without a pool.
    random_exact: Option<f64>,
    /// The expected value of `within_one` if each level were picked at random from the pool, which contains levels
    /// without a requested difficulty. `None` without a pool.
    random_within_one: Option<f64>,
}

/// Compares the requested and the measured difficulty, as a section and as a table. Returns `None` if no difficulty was
/// requested, or if no ladder (reference players of increasing strength) played. Levels that could not be measured
/// because no win is known count as misses.
pub(super) fn control(levels: &[SurveyedLevel], pool: &[Difficulty]) -> Option<(Section, Table)> {
    let asked = |level: &SurveyedLevel| Some((rank(level.asked?), level.label().map(rank)));
    let pairs: Vec<Asked> = levels.iter().filter_map(asked).collect();
    if pairs.iter().all(|(_, got)| got.is_none()) {
        return None;
    }
    let (mut table, mut unmeasured) = (vec![vec![0; LABELS.len()]; LABELS.len()], vec![0; LABELS.len()]);
    for &(asked, got) in &pairs {
        match got {
            Some(got) => table[asked][got] += 1,
            None => unmeasured[asked] += 1,
        }
    }
    let mut counts = vec![0u64; LABELS.len()];
    pool.iter().for_each(|label| counts[rank(*label)] += 1);
    let can_be_asked = |label: usize| LABELS[label].eases().is_some();
    let many = |label: usize| pool.is_empty() || counts[label] as f64 >= EXPRESSIBLE * pool.len() as f64;
    let can = |label: &usize| can_be_asked(*label) && many(*label);
    let asked_for: Vec<Asked> = pairs.iter().filter(|(asked, _)| can(asked)).copied().collect();
    let (all, of_expressible) = (Hits::of(&pairs, pool), Hits::of(&asked_for, pool));
    let expressible: Vec<Difficulty> = (0..LABELS.len()).filter(can).map(|label| LABELS[label]).collect();
    if pool.is_empty() {
        counts.clear();
    }
    let section = Section::new("control", "Are the levels as hard as requested?", note(pool, &expressible))
        .data("labels", &LABELS)
        .data("table", &table)
        .data("unmeasured", &unmeasured)
        .data("pool", &counts)
        .data("expressible", &expressible)
        .data("all", &all)
        .data("of_expressible", &of_expressible);
    let mut section = all.add(section, "exact", "all labels");
    if (1..all.exact.of).contains(&of_expressible.exact.of) {
        section = of_expressible.add(section, "", "labels that the game can express");
    }
    Some((section, confusion(&table, &unmeasured, &counts)))
}

fn note(pool: &[Difficulty], expressible: &[Difficulty]) -> String {
    let note = "Measured with seeds that did not guide the search.";
    if pool.is_empty() {
        return note.to_owned();
    }
    let labels: Vec<String> = expressible.iter().map(ToString::to_string).collect();
    let labels = if labels.is_empty() { "none".to_owned() } else { labels.join(", ") };
    let pool = pool.len();
    format!(
        "{note} Labels that the game can express (at least 5% of an unconstrained pool of {pool}): {labels}."
    )
}

/// Returns a table that counts the levels by measured label, with one row per requested label.
fn confusion(table: &[Vec<u64>], unmeasured: &[u64], pool: &[u64]) -> Table {
    let note = "One row for each requested label, with the number of its levels that were measured to have \
                each label.";
    let labels = LABELS.map(|label| label.to_string());
    let mut columns: Vec<&str> = ["asked"].into_iter().chain(labels.iter().map(String::as_str)).collect();
    let some_unmeasured = unmeasured.iter().any(|none| *none > 0);
    columns.extend(some_unmeasured.then_some("no win found"));
    let mut confusion = Table::new("asked", "Requested and measured difficulty", note, &columns);
    let row = |name: &str, counts: &[u64], last: TableCell| {
        let counts = counts.iter().map(|&count| TableCell::Count(count));
        let cells = [TableCell::text(name)].into_iter().chain(counts);
        cells.chain(some_unmeasured.then_some(last)).collect()
    };
    for ((label, counts), none) in labels.iter().zip(table).zip(unmeasured) {
        if counts.iter().sum::<u64>() + none > 0 {
            confusion.push(row(label, counts, TableCell::Count(*none)));
        }
    }
    if !pool.is_empty() {
        confusion.push(row("nothing (the pool)", pool, TableCell::text("")));
    }
    confusion
}

impl Hits {
    fn of(pairs: &[Asked], pool: &[Difficulty]) -> Hits {
        let hits = |apart: usize| {
            let share = Share::yes(
                pairs.iter().map(|(asked, got)| got.is_some_and(|got| asked.abs_diff(got) <= apart)),
            );
            let picked = |asked: usize| {
                Share::yes(pool.iter().map(|label| rank(*label).abs_diff(asked) <= apart)).share()
            };
            let sum: f64 = pairs.iter().map(|(asked, _)| picked(*asked)).sum();
            let some = !pool.is_empty() && !pairs.is_empty();
            (share, some.then(|| sum / pairs.len() as f64))
        };
        let ((exact, random_exact), (within_one, random_within_one)) = (hits(0), hits(1));
        Hits { exact, within_one, random_exact, random_within_one }
    }

    /// Adds the figures to a section. `key` identifies the fraction of exact hits in the page header.
    fn add(&self, section: Section, key: &'static str, which: &str) -> Section {
        let random = |section: Section, value: Option<f64>| match value {
            Some(value) => section.shown("— picked at random", Value::Expected(value)),
            None => section,
        };
        let section = section.figure(key, format!("measured as requested, {which}"), self.exact.into());
        let section = random(section, self.random_exact);
        let section = section.shown(format!("within one label, {which}"), self.within_one.into());
        random(section, self.random_within_one)
    }
}
