//! The page sections. Each section answers a question with plots and tables.

use super::plots::{self, Group, Heats, Plot};
use crate::page::tables::{Column, Row, Shown};
use crate::page::words;
use evaluation::study::Study;
use report::Table;
use serde::Serialize;

#[derive(Default, Serialize)]
pub(super) struct Section {
    id: &'static str,
    title: &'static str,
    note: String,
    heats: Option<Heats>,
    plots: Vec<Plot>,
    groups: Vec<Group>,
    tables: Vec<Shown>,
}

impl Section {
    fn new(id: &'static str, title: &'static str, note: impl Into<String>) -> Section {
        Section { id, title, note: note.into(), ..Section::default() }
    }

    /// Returns the size of the section's heat maps, in bytes. Heat maps take up by far the largest part of the page.
    pub(super) fn bytes(&self) -> usize {
        self.heats.as_ref().map_or(0, Heats::bytes)
    }
}

/// Returns all page sections, and the style rules for the heat maps.
pub(super) fn all(study: &Study, tables: &[Table]) -> (Vec<Section>, String) {
    let of = |ids: &[&str]| -> Vec<Shown> {
        let found = ids.iter().flat_map(|id| tables.iter().filter(move |table| table.id == *id));
        found.map(|table| shown(study, table)).collect()
    };
    let mut leaders = Section::new("leaderboard", "Leaderboard", "");
    leaders.plots.push(plots::win_rates(study));
    leaders.tables = of(&["leaderboard"]);
    leaders.tables.iter_mut().for_each(|table| table.rows.extend(optimum(study, &table.columns)));

    let mut horizons = Section::new(
        "horizons",
        "How far players see ahead",
        "The win rate by commitment, which is the number of actions that a player chooses without looking \
         again. The mark below a curve is the horizon.",
    );
    horizons.plots = plots::horizons(study);
    horizons.tables = of(&["horizons"]);
    let horizons = Some(horizons).filter(|section| !section.tables.is_empty());

    let mut thinking = Section::new(
        "thinking",
        "How much players must think",
        "The win rate by the maximum number of output tokens per answer. The mark below a curve is the thinking \
         horizon.",
    );
    thinking.plots = plots::thinking(study);
    thinking.tables = of(&["thinking"]);
    let thinking = Some(thinking).filter(|section| !section.tables.is_empty());

    let mut ceilings = Section::new(
        "ceilings",
        "Compared with the ceilings of the levels",
        "Win rates relative to the highest known win rates at the same commitment.",
    );
    ceilings.tables = of(&["ceilings"]);
    let ceilings = Some(ceilings).filter(|section| !section.tables.is_empty());

    let mut marks = Section::new(
        "marks",
        "Compared with the marks of the release",
        "Win rates by tier and by commitment, compared with players that never change.",
    );
    marks.tables = of(&["marks"]);
    let marks = Some(marks).filter(|section| !section.tables.is_empty());

    let heats = Heats::of(study);
    let rules = heats.rules();
    let mut levels = Section::new(
        "levels",
        "Level by level",
        "One column for each level, grouped by game. Point at a cell to read it in full. Hatched cells \
         were not played, or have no known value.",
    );
    levels.heats = Some(heats);

    let mut games = Section::new("games", "Game by game", "");
    games.groups = plots::win_rates_by_game(study);
    games.tables = of(&["summary", "games", "difficulty"]);

    let mut losses = Section::new("endings", "Why episodes were not won", "");
    losses.tables = of(&["endings", "causes"]);

    let note = if study.kinds.is_empty() {
        "These results do not record the kinds of their games (they are from an earlier version, or the \
         games are from files), so only the taxonomy of the rules is shown."
    } else {
        ""
    };
    let mut kinds = Section::new("kinds", "Kinds of game", note);
    let shown: &[&str] = if study.kinds.is_empty() { &["taxonomy"] } else { &["kinds", "taxonomy"] };
    kinds.tables = of(shown);

    let mut pairs = Section::new(
        "pairs",
        "Players against each other",
        "Each pair of players is compared on the levels that both played. With few episodes on a level, \
         hardly any difference can be significant: the last table of this section shows which differences \
         could be detected.",
    );
    pairs.tables = of(&["pairs-overall", "pairs-by-game", "pairs-by-level", "power"]);

    let mut modes = Section::new("modes", "Zero-shot against contextual", "");
    modes.tables = of(&["modes-overall", "modes-by-game", "modes-by-level"]);
    if modes.tables.is_empty() {
        modes.note = "No model was evaluated in both modes.".to_owned();
    }
    let mut aids = Section::new("aids", "Without and with an aid", "");
    aids.tables = of(&["aids-overall", "aids-by-game", "aids-by-level"]);
    if aids.tables.is_empty() {
        aids.note = "No model was evaluated both with and without an aid.".to_owned();
    }

    let whose = if study.players.iter().any(|player| !player.is_reference()) {
        "All episodes, except those of baselines."
    } else {
        "All episodes, because all players are baselines."
    };
    let mut walked = Section::new("failures", "How players moved", whose);
    walked.plots = plots::failures(study);
    walked.tables = of(&["failure-modes", "oscillation"]);

    let mut correlations = Section::new("correlations", "What goes with winning", whose);
    correlations.plots = plots::correlations(study);
    correlations.tables = of(&["correlations"]);

    let mut answers = Section::new("answers", "Answers, failures and times", "");
    answers.tables = of(&["answers", "times"]);

    let first = std::iter::once(leaders).chain(horizons).chain(thinking).chain(ceilings).chain(marks);
    let others = [kinds, losses, levels, games, pairs, modes, aids, walked, correlations, answers];
    (first.chain(others).collect(), rules)
}

/// Returns a leaderboard row for perfect play: the mean length, in ticks, of the levels' shortest wins. Only levels
/// whose shortest win is proved optimal count; `None` if there are none.
fn optimum(study: &Study, columns: &[Column]) -> Option<Row> {
    let levels: Vec<Option<usize>> =
        study.games.iter().flat_map(|game| &game.levels).map(|level| level.optimal_ticks).collect();
    let known: Vec<f64> = levels.iter().flatten().map(|&ticks| ticks as f64).collect();
    let mean = known.iter().sum::<f64>() / known.len() as f64;
    let cell = |column: &Column| match column.name.as_str() {
        "player" => format!(
            "shortest wins, proven minimal on {} of {}",
            known.len(),
            words::many(levels.len() as u64, "level")
        ),
        "steps" => format!("{mean:.1}"),
        "optimality" => "1.000".to_owned(),
        _ => words::NONE.to_owned(),
    };
    (!known.is_empty()).then(|| Row { cells: columns.iter().map(cell).collect(), mark: true })
}

/// Returns a table from the study, marking rows whose player is not a model.
fn shown(study: &Study, table: &Table) -> Shown {
    let labels = |marks: bool| -> Vec<String> {
        let players = study.players.iter().filter(|player| player.is_reference() == marks);
        players.map(|player| player.label()).collect()
    };
    let (models, marks) = (labels(false), labels(true));
    let about = |cells: &[String], players: &[String]| cells.iter().any(|cell| players.contains(cell));
    let found = Shown::of(table);
    // In these tables, the important cells come after long texts.
    let is_long = ["causes", "taxonomy"].contains(&table.id.as_str())
        || ["pairs-", "modes-", "aids-"].iter().any(|start| table.id.starts_with(start));
    let found = if is_long { found.stacked() } else { found };
    found.cut(|cells| about(cells, &marks) && !about(cells, &models))
}
