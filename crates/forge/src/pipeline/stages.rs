//! The lists of stages, in the order in which `stage::walk` runs them. The tables in
//! `docs/explanation/generate-games.md` must agree.

use super::course::Begun;
use super::game::Trial;
use super::level::LevelTrial;
use super::request::RequestTrial;
use super::stage::Stage;

impl Trial<'_> {
    /// The stages for a game with generated rules.
    pub(super) const GENERATED: [Stage<Self>; 12] = [
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
    pub(super) const KNOWN_RULES: [Stage<Self>; 3] = [Self::LEVELS, Self::GATES, Self::CARD];
}

impl Begun<'_> {
    /// The stages that a game passes after each level found for it.
    pub(super) const STAGES: [Stage<Self>; 3] = [Self::INTRODUCTION, Self::OUTLINE, Self::SKILL];
}

impl LevelTrial<'_> {
    /// The stages of a level for one position of a game.
    pub(super) const STAGES: [Stage<Self>; 11] = [
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
    pub(super) const STAGES: [Stage<Self>; 4] =
        [Self::PANEL, Self::RANDOM_PLAY, Self::RULES_USED, Self::DIFFICULTY];
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
