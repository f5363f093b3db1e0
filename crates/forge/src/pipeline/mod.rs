//! The stages that a candidate passes, as data: what each asks, what it costs, and what it can refuse and replace.
//!
//! The lists below are the order: [`walk`] runs them. A stage stands in a file of this folder, with its tuning constants beside
//! its code. To add one, write a [`Stage`] there and name it in a list; the table in `docs/generate-games.md` must say the same.

mod clock;
mod course;
mod game;
mod gates;
mod ladder;
mod level;
mod place;
mod recheck;
mod request;
mod rules;

use crate::tally::Tally;
use course::Begun;
use level::LevelTrial;
use request::RequestTrial;
use std::borrow::Cow;
use validators::{Criterion, CriterionSet};

#[cfg(test)]
pub(crate) use game::tests;
pub(crate) use game::{GameGate, Trial};
pub(crate) use request::{DIFFICULTY, LevelGate};
pub(crate) use rules::NEAR_KNOWN;

impl Trial<'_> {
    /// The stages of a game whose rules were generated.
    pub(crate) const GENERATED: [Stage<Self>; 11] = [
        Self::NEW_RULES,
        Self::INTERACTIONS,
        Self::LEVELS,
        Self::TIME_LIMIT,
        Self::MECHANICS,
        Self::GATES,
        Self::LADDER,
        Self::GRAFTS,
        Self::SECOND_JUDGES,
        Self::FURTHER_JUDGES,
        Self::CARD,
    ];

    /// The stages of a game whose rules are known: of the corpus, or of puzzles.
    pub(crate) const KNOWN_RULES: [Stage<Self>; 3] = [Self::LEVELS, Self::GATES, Self::CARD];
}

impl Begun<'_> {
    /// The stages of a game after each level that is found for it.
    const STAGES: [Stage<Self>; 3] = [Self::INTRODUCTION, Self::OUTLINE, Self::SKILL];
}

impl LevelTrial<'_> {
    /// The stages of a level for a place of a game.
    const STAGES: [Stage<Self>; 11] = [
        Self::NEW_LEVEL,
        Self::NEW_BOARD,
        Self::OPEN_GROUND,
        Self::NEAREST_GOAL,
        Self::SHORTEST_WIN,
        Self::JUDGES,
        Self::ORDER,
        Self::LATER_MECHANIC,
        Self::LENGTH_OF_WIN,
        Self::DEAD_TIME,
        Self::TIER,
    ];
}

impl RequestTrial<'_> {
    /// The stages of a level on request.
    const STAGES: [Stage<Self>; 4] = [Self::PANEL, Self::RANDOM_PLAY, Self::RULES_USED, Self::DIFFICULTY];
}

/// A stage of candidates of type `T`.
pub struct Stage<T> {
    /// The name: in the documentation, and in tallies if the stage has judges of its own.
    pub name: &'static str,
    /// What it asks or does, as a phrase.
    pub purpose: &'static str,
    /// The usual cost, in words.
    pub cost: &'static str,
    /// The criteria that it can refuse a candidate by.
    pub criteria: CriterionSet,
    /// The other reasons that it can refuse a candidate for. A reason that ends with `N` stands for all numbers.
    pub reasons: &'static [&'static str],
    /// What it can replace instead of a refusal.
    pub replaces: Option<&'static str>,
    run: Run<T>,
}

/// The code of a stage.
enum Run<T> {
    /// Judges the candidate, and changes it where the stage replaces something.
    Once(fn(&mut T, &mut Tally) -> Passage),
    /// Makes versions of the candidate, and judges each by the later stages until one passes.
    Versions(fn(&mut T, &[Stage<T>], &mut Tally) -> Passage),
}

/// The refusal of a candidate by a stage.
#[derive(Debug)]
pub(crate) enum Refusal {
    /// The reason, which is still to be counted.
    Because(Cow<'static, str>),
    /// The stage has counted the reason itself.
    Counted,
}

/// Whether a candidate passes a stage.
pub(crate) type Passage = Result<(), Refusal>;

impl From<&'static str> for Refusal {
    fn from(why: &'static str) -> Refusal {
        Refusal::Because(why.into())
    }
}

impl From<Criterion> for Refusal {
    fn from(criterion: Criterion) -> Refusal {
        criterion.name().into()
    }
}

/// Takes a candidate through stages, until one refuses it.
fn walk<T>(stages: &[Stage<T>], candidate: &mut T, tally: &mut Tally) -> Passage {
    for (at, stage) in stages.iter().enumerate() {
        match stage.run {
            Run::Once(run) => run(candidate, tally).inspect_err(|refusal| stage.check(refusal))?,
            Run::Versions(run) => return run(candidate, &stages[at + 1..], tally),
        }
    }
    Ok(())
}

impl<T> Stage<T> {
    /// In tests: asserts that the description of the stage lists the reason.
    fn check(&self, refusal: &Refusal) {
        let Refusal::Because(why) = refusal else { return };
        let is_reason = |reason: &&str| match reason.strip_suffix('N') {
            Some(start) => why.starts_with(start),
            None => why == reason,
        };
        let is_criterion = self.criteria.iter().any(|criterion| criterion.name() == *why);
        debug_assert!(is_criterion || self.reasons.iter().any(is_reason), "{} refuses for {why}", self.name);
    }

    fn row(&self) -> String {
        let criteria = self.criteria.iter().map(|criterion| format!("`{criterion}`"));
        let refuses: Vec<String> =
            criteria.chain(self.reasons.iter().map(|reason| (*reason).to_owned())).collect();
        let refuses = if refuses.is_empty() { "nothing".to_owned() } else { refuses.join(", ") };
        let replaces = self.replaces.unwrap_or("nothing");
        format!("| {} | {} | {} | {refuses} | {replaces} |\n", self.name, self.purpose, self.cost)
    }
}

/// Returns the stages of a list as a Markdown table.
fn table<T>(stages: &[Stage<T>]) -> String {
    let head = "| Stage | What it asks or does | Cost | Refuses for | Replaces |\n|---|---|---|---|---|\n";
    stages.iter().map(Stage::row).fold(head.to_owned(), |table, row| table + &row)
}

/// Returns the tables of the documentation, each with its heading: the stages of a generated game, those after each of its
/// levels, those of each level, and those of a level on request.
pub fn tables() -> [(&'static str, String); 4] {
    [
        ("Stages of a game", table(&Trial::GENERATED)),
        ("Stages after each level that is found", table(&Begun::STAGES)),
        ("Stages of a level", table(&LevelTrial::STAGES)),
        ("Stages of a level on request", table(&RequestTrial::STAGES)),
    ]
}

#[cfg(test)]
mod documentation {
    use std::path::Path;

    #[test]
    fn the_page_about_games_lists_the_stages() {
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/generate-games.md");
        let page = std::fs::read_to_string(page).unwrap();
        let tables = super::tables().map(|(heading, table)| format!("### {heading}\n\n{table}"));
        let missing: Vec<String> = tables.into_iter().filter(|table| !page.contains(table)).collect();
        assert!(missing.is_empty(), "docs/generate-games.md should contain:\n{}", missing.join("\n"));
    }
}
