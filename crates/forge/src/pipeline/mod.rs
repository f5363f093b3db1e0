//! The stages that a candidate passes through. Each stage is defined as data: its question, its cost, its reasons for
//! rejecting a candidate, and the part that it can replace.
//!
//! The lists below define the order in which `stage::walk` runs the stages. Each stage is defined in a file of this
//! folder, with its tuning constants next to its code. To add a stage, write a `Stage` there and add it to a list. The
//! table in `docs/explanation/generate-games.md` must agree.
//!
//! The stages do not depend on a candidate's source. `sources.rs` contains the traits for sources of rules and
//! boards.

mod clock;
mod course;
mod game;
mod gates;
mod invented;
mod joint;
mod ladder;
mod level;
mod place;
mod recheck;
mod request;
mod rules;
mod sources;
mod stage;

use course::Begun;
use level::LevelTrial;
use request::RequestTrial;
use stage::Stage;

#[cfg(test)]
pub(crate) use game::tests;
pub(crate) use game::{GameGate, Trial};
pub(crate) use request::{DIFFICULTY, LevelGate};
pub(crate) use rules::NEAR_KNOWN;
pub(crate) use sources::Rules;
pub use sources::{Board, BoardSource, Boards, PlaceBrief};

impl Trial<'_> {
    /// The stages for a game with generated rules.
    const GENERATED: [Stage<Self>; 12] = [
        Self::NEW_RULES,
        Self::INTERACTIONS,
        Self::QUICK_LOOK,
        Self::LEVELS,
        Self::TIME_LIMIT,
        Self::MECHANICS,
        Self::JOINT,
        Self::GATES,
        Self::LADDER,
        Self::SECOND_JUDGES,
        Self::FURTHER_JUDGES,
        Self::CARD,
    ];

    /// The stages for a game with known rules: a corpus game or a puzzle game.
    const KNOWN_RULES: [Stage<Self>; 3] = [Self::LEVELS, Self::GATES, Self::CARD];
}

impl Begun<'_> {
    /// The stages that a game passes after each level found for it.
    const STAGES: [Stage<Self>; 3] = [Self::INTRODUCTION, Self::OUTLINE, Self::SKILL];
}

impl LevelTrial<'_> {
    /// The stages of a level for one position of a game.
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
    /// The stages of a requested level.
    const STAGES: [Stage<Self>; 4] = [Self::PANEL, Self::RANDOM_PLAY, Self::RULES_USED, Self::DIFFICULTY];
}

/// Returns a list of stages as a Markdown table.
fn table<T>(stages: &[Stage<T>]) -> String {
    let head = "| Stage | What the stage does | Cost | Rejects for | Replaces |\n|---|---|---|---|---|\n";
    stages.iter().map(Stage::row).fold(head.to_owned(), |table, row| table + &row)
}

/// Returns the tables for the documentation, each with its heading: the stages of a generated game, the stages after
/// each of its levels, the stages of each level, and the stages of a requested level.
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
        let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/explanation/generate-games.md");
        let page = std::fs::read_to_string(page).unwrap();
        let tables = super::tables().map(|(heading, table)| format!("### {heading}\n\n{table}"));
        let missing: Vec<String> = tables.into_iter().filter(|table| !page.contains(table)).collect();
        assert!(
            missing.is_empty(),
            "docs/explanation/generate-games.md should contain:\n{}",
            missing.join("\n")
        );
    }
}
