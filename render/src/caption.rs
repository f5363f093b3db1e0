//! The strip under a board: tick, score, resources of the avatar, outcome.

use crate::board::Style;
use crate::colour::{Colour, GREEN, INK, PAPER, VERMILION};
use crate::look::Looks;
use crate::picture::{ADVANCE, Picture, Place, shortened, text_width};
use engine::{Outcome, State};

/// Letters of the outcome and the gap before it.
const ENDING: usize = 9;

/// Returns the height of the strip: one row, and another if avatars can have resources or health. The same for all
/// states.
pub(crate) fn height(looks: &Looks, style: &Style) -> u32 {
    let rows = if looks.has_holdings() { 2 } else { 1 };
    if style.caption { rows * row(style) + row(style) / 2 } else { 0 }
}

fn row(style: &Style) -> u32 {
    (style.cell * 6 / 10).clamp(14, 28)
}

pub(crate) fn draw(picture: &mut Picture, looks: &Looks, state: &State, style: &Style, top: u32) {
    let (width, row) = (picture.width() as f32, row(style) as f32);
    let size = row * 0.82;
    let (word, colour) = ending(state.outcome());
    let strip = Place { x: 0.0, y: top as f32, w: width, h: height(looks, style) as f32 };
    picture.rect(strip, colour);
    let letters = (width / (size * ADVANCE)) as usize;
    let (x, y) = (size * 0.4, top as f32 + row * 0.35);
    let first = format!("tick {}  score {}", state.tick() + 1, state.score());
    let room = letters.saturating_sub(1);
    // On a narrow board the outcome is more important than the score.
    let whole = first.chars().count() + if word.is_empty() { 0 } else { ENDING } <= room;
    if whole || word.is_empty() {
        picture.text((x, y), size, PAPER, &shortened(&first, room));
    }
    let at = if whole { width - text_width(word, size) - size * 0.4 } else { x };
    picture.text((at, y), size, PAPER, word);
    if looks.has_holdings() {
        let held = holdings(looks, state);
        let held = if held.is_empty() { "nothing held" } else { &held };
        picture.text((x, y + row), size, PAPER, &shortened(held, room));
    }
}

/// Returns the word for an outcome, and the colour behind it.
fn ending(outcome: Outcome) -> (&'static str, Colour) {
    match outcome {
        Outcome::Ongoing => ("", INK),
        Outcome::Won => ("WON", GREEN.mixed(INK, 25)),
        Outcome::Lost => ("LOST", VERMILION.mixed(INK, 25)),
        Outcome::Ended => ("ENDED", INK),
        Outcome::Stopped(_) => ("STOPPED", INK),
    }
}

/// Returns the avatar's resources and health: `key 2  health 3`.
pub fn holdings(looks: &Looks, state: &State) -> String {
    let game = looks.game();
    let held = game.held_by_avatar(state).into_iter().filter(|(_, amount)| *amount != 0);
    let mut parts: Vec<String> = held.map(|(name, amount)| format!("{name} {amount}")).collect();
    let avatar = state.avatar_id();
    let record = game.records(state).into_iter().find(|record| Some(record.id) == avatar);
    if let Some(record) = record.filter(|record| record.health > 0) {
        parts.push(format!("health {}", record.health));
    }
    parts.join("  ")
}
