//! The levels as pictures, with what is to be said under each.

use super::Pictures;
use crate::failure::Failure;
use crate::page::{Figure, words};
use engine::{Game, Level, Seed};
use forge::levels::report::{LevelRow, LevelSetReport};
use render::{Looks, Picture, RenderError, Style, picture, png, sheet};

/// Levels that are drawn at most; the tables tell of all.
const MOST: usize = 120;
/// Pixels of the longer side of a board, about.
const SIDE: u32 = 320;
/// Pictures in a row of the sheet.
const COLUMNS: usize = 5;
/// Pixels of a picture's place in the sheet.
const PLACE: u32 = 300;

/// The levels as pictures.
pub(super) struct Boards {
    /// All in one picture, PNG.
    pub(super) sheet: Vec<u8>,
    /// Each by itself, in the order of the report's rows.
    pub(super) levels: Vec<Board>,
    /// The game's own.
    pub(super) examples: Vec<Board>,
}

/// A level as a picture.
pub(super) struct Board {
    /// PNG.
    png: Vec<u8>,
    /// Of the picture.
    size: [u32; 2],
    /// What is most to be known: number and difficulty.
    head: String,
    /// The rest in a line.
    line: String,
}

impl Boards {
    /// Draws the levels as they are in the first tick. Cost: O(pixels).
    pub(super) fn draw(report: &LevelSetReport, pictures: &Pictures<'_>) -> Result<Boards, Failure> {
        let looks = Looks::of(pictures.analysis);
        let game = pictures.analysis.game();
        let drawn = |level: &Level| drawn(game, &looks, level);
        let rows = report.levels.iter().enumerate().zip(pictures.levels).take(MOST);
        let mut entries = Vec::new();
        let mut levels = Vec::new();
        for ((at, row), level) in rows {
            let picture = drawn(level)?;
            levels.push(Board::of(&picture, head(at, row), line(row, true))?);
            entries.push((picture, caption(at, row)));
        }
        let mut examples = Vec::new();
        for (at, level) in pictures.examples.iter().enumerate() {
            let (head, line) = (format!("level {at}"), format!("{} × {}", level.columns(), level.rows()));
            examples.push(Board::of(&drawn(level)?, head, line)?);
        }
        let sheet = sheet(&entries, COLUMNS, PLACE).and_then(|sheet| png(&sheet)).map_err(failed)?;
        Ok(Boards { sheet, levels, examples })
    }
}

impl Board {
    fn of(picture: &Picture, head: String, line: String) -> Result<Board, Failure> {
        Ok(Board {
            png: png(picture).map_err(failed)?,
            size: [picture.width(), picture.height()],
            head,
            line,
        })
    }

    /// In the page.
    pub(super) fn figure(&self) -> Figure<'_> {
        Figure::new(&self.png, self.size, &self.head, &self.line)
    }
}

fn drawn(game: &Game, looks: &Looks, level: &Level) -> Result<Picture, Failure> {
    let longest = u32::try_from(level.columns().max(level.rows())).unwrap_or(u32::MAX);
    let cell = (SIDE / longest.max(1)).clamp(8, 32);
    picture(looks, &game.start(level, Seed::from_text("picture")), &Style::bare(cell)).map_err(failed)
}

fn failed(error: RenderError) -> Failure {
    Failure::environment(error, "the pictures of the levels")
}

/// `7, hard`, with the difficulty that was asked for where it is another one.
fn head(at: usize, row: &LevelRow) -> String {
    let mut text = format!("{at}");
    match (row.label, row.asked) {
        (Some(label), Some(asked)) if label != asked => {
            text.push_str(&format!(", {label} (asked: {asked})"));
        }
        (Some(label), _) => text.push_str(&format!(", {label}")),
        (None, Some(asked)) => text.push_str(&format!(", asked: {asked}")),
        (None, None) => {}
    }
    text
}

/// What there is room for in the sheet: `7 medium, 34 ticks, 12 pushes`.
fn caption(at: usize, row: &LevelRow) -> String {
    let label = row.label.map_or(String::new(), |label| format!(" {label}"));
    format!("{at}{label}, {}", line(row, false))
}

/// `34 ticks (shortest), 12 pushes`; why it fails, if it does. `proofs`: say what is proved.
fn line(row: &LevelRow, proofs: bool) -> String {
    let mut parts = Vec::new();
    let value = |name: &str| row.measures.get(name).copied();
    match value("ticks") {
        Some(ticks) => {
            let sure = if proofs && row.shortest.is_some() { " (shortest)" } else { "" };
            parts.push(format!("{} ticks{sure}", words::short(ticks)));
        }
        None => {
            parts.push(if row.solved == "solved" { "solved".to_owned() } else { format!("{}!", row.solved) })
        }
    }
    parts.extend(value("pushes").filter(|pushes| *pushes > 0.0).map(|pushes| format!("{pushes:.0} pushes")));
    parts.extend(
        row.obstacle.iter().filter(|obstacle| *obstacle != "winnable").map(|name| words::not_passed(name)),
    );
    parts.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Digest;
    use std::collections::BTreeMap;
    use validators::Difficulty;

    #[test]
    fn captions_tell_what_matters() {
        let mut row = LevelRow {
            digest: Digest::of(b""),
            columns: 8,
            rows: 8,
            passes: true,
            obstacle: None,
            solved: "solved".to_owned(),
            asked: Some(Difficulty::Hard),
            label: Some(Difficulty::Medium),
            ease: None,
            shortest: Some(34),
            measures: BTreeMap::from([("ticks".to_owned(), 34.0), ("pushes".to_owned(), 12.0)]),
            nearest: None,
        };
        assert_eq!(head(7, &row), "7, medium (asked: hard)");
        assert_eq!(line(&row, true), "34 ticks (shortest), 12 pushes");
        assert_eq!(caption(7, &row), "7 medium, 34 ticks, 12 pushes");
        row.asked = row.label;
        row.obstacle = Some("length".to_owned());
        assert_eq!(
            (head(7, &row).as_str(), line(&row, true).as_str()),
            ("7, medium", "34 ticks (shortest), 12 pushes, length not passed")
        );
        row.measures.clear();
        (row.solved, row.obstacle) = ("impossible".to_owned(), Some("winnable".to_owned()));
        assert_eq!(line(&row, true), "impossible!");
    }
}
