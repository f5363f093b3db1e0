//! The report on a set of games.

use super::{MOST, Sheet, Shot, Showcase, cell, failed, files, made_in};
use crate::page::plots::{BarRow, Label};
use crate::page::{Figure, plots, words};
use crate::{File, PageError};
use base::Seed;
use engine::{Analysis, Level, State};
use forge::games::report::GameSetReport;
use forge::survey::SurveyedGame;
use forge::{JudgeCost, Tally};
use render::{Looks, Picture, Style, picture};
use validators::Difficulty;

/// The approximate length of a board's longer side, in pixels.
const SIDE: u32 = 380;

/// Returns the report files for a set of games. `games` must be in the order of the report's rows. The page
/// shows the title, the method and the elapsed time in seconds. Cost: O(pixels), plus half an episode per
/// game.
///
/// # Errors
///
/// Returns an error if an image or the page cannot be rendered.
pub fn game_report(
    report: &GameSetReport,
    games: &[SurveyedGame],
    cost: Option<&Tally>,
    (title, method, seconds): (&str, &str, Option<f64>),
) -> Result<Vec<File>, PageError> {
    let (mut entries, mut shots) = (Vec::new(), Vec::new());
    for ((at, game), entry) in games.iter().enumerate().zip(&report.games) {
        let drawn = if at < MOST { drawn(game)? } else { None };
        let figure = drawn.as_ref().map(|picture| Figure::of(picture, entry.title.clone()));
        let chips = entry.levels.iter().enumerate().map(|(number, level)| chip(number, level.label));
        shots.push(Shot {
            figure: figure.transpose().map_err(failed)?,
            head: entry.title.clone(),
            goal: entry.goal.clone(),
            line: entry.remark(),
            chips: chips.collect(),
        });
        entries.extend(drawn.map(|picture| (picture, format!("{}\n{}", entry.title, entry.goal))));
    }
    let showcase = Showcase {
        title: title.to_owned(),
        subtitle: format!(
            "{} · {method} · semantics {}, generation {}{}",
            words::many(games.len() as u64, "game"),
            engine::SEMANTICS,
            generators::GENERATION,
            made_in(seconds)
        ),
        manual: "game-report",
        items: ["The games".to_owned(), "A middle level, halfway through a win.".to_owned()],
        pictures: shots,
        examples: Vec::new(),
        ranges: Vec::new(),
        costs: cost.and_then(costs),
        grids: &["kinds", "difficulty"],
        sheet: Sheet(entries, 4, 340),
    };
    files(&report.set, &showcase)
}

/// Draws the judges' costs, largest first. Each cost is split into three parts: levels that were accepted, levels
/// that were rejected, and levels whose game was rejected.
fn costs(cost: &Tally) -> Option<(String, String)> {
    let mut judges: Vec<(&String, &JudgeCost)> =
        cost.judges.iter().filter(|(_, cost)| cost.calls() > 0).collect();
    judges.sort_by_key(|(name, cost)| (std::cmp::Reverse(cost.calls()), *name));
    let row = |(name, cost): (&String, &JudgeCost)| BarRow {
        label: Label { name: name.clone(), note: String::new() },
        parts: [cost.calls_accepted, cost.calls_refused, cost.calls_lost].map(|calls| calls as f64).to_vec(),
        amount: format!("{:.1} M", cost.calls() as f64 / 1e6),
    };
    let rows: Vec<BarRow> = judges.into_iter().map(row).collect();
    let key = ["accepted", "refused", "game rejected"];
    let caption = "Forward-model calls of each judge, by the outcome for the judged candidates.";
    (!rows.is_empty()).then(|| (plots::bars("Cost of the judges", &key, &rows), caption.to_owned()))
}

fn drawn(game: &SurveyedGame) -> Result<Option<Picture>, PageError> {
    let Some((level, state)) = middle(game) else { return Ok(None) };
    let looks = Looks::of(&Analysis::of(&game.game));
    picture(&looks, &state, &Style::bare(cell(level, SIDE, 40))).map(Some).map_err(failed)
}

/// Returns the level that is closest to the middle of the game among the levels with a known win, and its state
/// halfway through that win. If there are no known wins, returns the middle level in its initial state.
fn middle(surveyed: &SurveyedGame) -> Option<(&Level, State)> {
    let SurveyedGame { game, levels, report, .. } = surveyed;
    let half = levels.len() / 2;
    let won = |at: usize| Some((at, report.levels.get(at)?.witness.as_ref()?));
    let nearest = (0..levels.len()).filter_map(won).min_by_key(|(at, _)| at.abs_diff(half));
    let Some((at, witness)) = nearest else {
        let level = levels.get(half)?;
        return Some((level, game.start(level, Seed::from_text("picture"))));
    };
    let mut state = game.start(&levels[at], witness.seed);
    for &action in &witness.actions[..witness.actions.len() / 2] {
        game.step(&mut state, action);
    }
    Some((&levels[at], state))
}

/// Returns the class and the text for a level's difficulty label.
fn chip(number: usize, label: Option<Difficulty>) -> (String, String) {
    // The classes range from `d0` for very easy levels to `d5` for unbeaten levels.
    let class = label.map_or("dx".to_owned(), |label| format!("d{}", label as usize));
    let label = label.map_or("not measured".to_owned(), |label| label.to_string());
    (class, format!("level {number}: {label}"))
}
