//! The cost of minting: candidates, rejections, calls.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The candidates tried for one place or for a whole release, and the reasons why some failed.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tally {
    /// The number of games tried.
    pub games_tried: u64,
    /// The number of games accepted.
    pub games_accepted: u64,
    /// The number of levels tried.
    pub levels_tried: u64,
    /// The number of levels accepted, including those of games that failed later.
    pub levels_accepted: u64,
    /// The forward-model calls of all judges.
    pub calls: u64,
    /// The number of rejections by each criterion or generator.
    pub rejections: BTreeMap<String, u64>,
}

impl Tally {
    /// Counts a game that passed.
    pub fn game_accepted(&mut self) {
        self.games_tried += 1;
        self.games_accepted += 1;
    }

    /// Counts a game that failed, by its reason up to the first colon.
    pub fn game_rejected(&mut self, why: &str) {
        self.games_tried += 1;
        // After the colon the words of a generator differ with every seed.
        let kind = why.split(':').next().unwrap_or(why).to_owned();
        *self.rejections.entry(kind).or_default() += 1;
    }

    pub(crate) fn level(&mut self, calls: u64, obstacle: Option<&str>) {
        self.levels_tried += 1;
        self.calls += calls;
        match obstacle {
            None => self.levels_accepted += 1,
            Some(criterion) => *self.rejections.entry(criterion.to_owned()).or_default() += 1,
        }
    }

    /// Counts an accepted level as rejected.
    pub(crate) fn level_taken_back(&mut self, why: &str) {
        self.levels_accepted -= 1;
        *self.rejections.entry(why.to_owned()).or_default() += 1;
    }

    pub(crate) fn calls(&mut self, calls: u64) {
        self.calls += calls;
    }

    /// Counts an accepted game as rejected.
    pub(crate) fn taken_back(&mut self, why: &str) {
        self.games_accepted -= 1;
        *self.rejections.entry(why.to_owned()).or_default() += 1;
    }

    /// Adds the counts of another tally.
    pub fn add(&mut self, other: &Tally) {
        self.games_tried += other.games_tried;
        self.games_accepted += other.games_accepted;
        self.levels_tried += other.levels_tried;
        self.levels_accepted += other.levels_accepted;
        self.calls += other.calls;
        add_rejections(&mut self.rejections, &other.rejections);
    }

    /// The rejections in words, the most frequent first.
    pub fn reasons(&self) -> String {
        reasons(&self.rejections)
    }
}

/// Adds rejections to others.
pub(crate) fn add_rejections(rejections: &mut BTreeMap<String, u64>, others: &BTreeMap<String, u64>) {
    for (why, count) in others {
        *rejections.entry(why.clone()).or_default() += count;
    }
}

/// Rejections in words, the most frequent first.
pub fn reasons(rejections: &BTreeMap<String, u64>) -> String {
    let mut reasons: Vec<(&String, &u64)> = rejections.iter().collect();
    reasons.sort_by_key(|(why, count)| (std::cmp::Reverse(**count), *why));
    let words: Vec<String> = reasons.iter().map(|(why, count)| format!("{why} {count}")).collect();
    words.join(", ")
}
