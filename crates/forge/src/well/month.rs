//! Chains of monthly releases, and the games drawn in each month.

use crate::games::Cast;
use serde::Serialize;
use validators::novelty::GameForm;

/// A chain of monthly releases to simulate.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WellOrder {
    /// The number of months.
    pub months: u32,
    /// The number of invented games per month.
    pub games: u32,
    /// The number of candidates per game in a month.
    pub candidates: f64,
    /// The maximum number of rule sets drawn for one candidate.
    pub tries: u32,
    /// The assumed fraction of new rule sets for which a board search succeeds and all judges pass. The seed selects
    /// these rule sets.
    pub passing: f64,
}

impl Default for WellOrder {
    fn default() -> WellOrder {
        WellOrder { months: 24, games: 100, candidates: 2.0, tries: 16, passing: 0.1 }
    }
}

/// The months of a chain of releases, with the number of rule sets to draw from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Well {
    /// The order that was simulated.
    pub order: WellOrder,
    /// The estimated number of buildable combinations of mechanics and an ending.
    pub sets: f64,
    /// The buildable fraction of all combinations of mechanics and an ending.
    pub sound: f64,
    /// The months in chronological order.
    pub months: Vec<WellMonth>,
}

/// A month in a chain of releases. Fractions and unseen probability masses cover all months up to and including this
/// one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WellMonth {
    /// The month's number, from 1.
    pub month: u32,
    /// The estimated number of rule sets that are not near any game from before this month.
    pub available: f64,
    /// The number of rule sets drawn for candidates.
    pub drawn: u64,
    /// The number of drawn rule sets for which the simulation assumes that no board is found. The seed selects these
    /// rule sets.
    pub failed: u64,
    /// The number of drawn rule sets near a known game or an earlier month's game.
    pub near: u64,
    /// The number of candidates near another candidate in the month.
    pub near_in_month: u64,
    /// The number of candidates that share two mechanics, or one mechanic and the ending, with another candidate in the
    /// same month.
    pub same_idea: u64,
    /// The number of candidates that share the title or most type names of another candidate in the month.
    pub same_words: u64,
    /// The number of new games.
    pub games: u32,
    /// The number of new games in all months up to this one.
    pub used: u32,
    /// The number of candidates per drawn rule set.
    pub yielded: f64,
    /// The distances between the new games and their nearest predecessors, including known games; `None` if the month
    /// has no new games.
    pub nearest: Option<Nearest>,
    /// The estimated unseen probability mass of rules (Good–Turing): the probability that the next rules are at a
    /// distance of at least 0.3 from all rules drawn so far. `None` if no rules have passed.
    pub unseen_near: Option<f64>,
    /// Like [`WellMonth::unseen_near`], but for a distance of at least 0.4.
    pub unseen_far: Option<f64>,
    /// The estimated probability mass of unseen couplings, which are merged pairs of ports (roles of mechanics).
    pub unseen_couplings: Option<f64>,
    /// The estimated probability mass of unseen mechanics, not counting endings.
    pub unseen_mechanics: Option<f64>,
    /// The mechanic that occurs in the most games.
    pub top_mechanic: Option<Top>,
    /// The ending that occurs in the most games.
    pub top_ending: Option<Top>,
    /// The coupling (merged pair of ports) that occurs in the most games.
    pub top_coupling: Option<Top>,
    /// The texts of the new games that were already used within the preceding year.
    pub again: Again,
}

/// The distances between new games and their nearest predecessors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Nearest {
    /// The minimum distance.
    pub least: f64,
    /// The 5% quantile of the distances.
    pub low: f64,
    /// The median distance.
    pub median: f64,
}

/// The part that occurs in the most games.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Top {
    /// The part's name.
    pub name: String,
    /// The fraction of games that contain the part.
    pub share: f64,
}

/// The repeated texts in a month's games: texts that an earlier game of the same month or the preceding eleven months
/// had used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Again {
    /// The number of games with a repeated title.
    pub titles: u32,
    /// The number of games that have exactly the same type names as an earlier game.
    pub casts: u32,
    /// The number of games whose summary repeats the first sentence of another summary. That sentence is the story that
    /// introduces the rules.
    pub openings: u32,
    /// The number of repeated sentences in all summaries.
    pub sentences: u32,
    /// The total number of sentences in the month's summaries.
    pub all_sentences: u32,
}

/// A drawn game's rules and texts.
#[derive(Clone, Debug)]
pub(crate) struct Sketch {
    pub(crate) form: GameForm,
    pub(crate) title: String,
    pub(crate) summary: String,
    pub(crate) cast: Cast,
    pub(crate) patterns: Vec<String>,
}
