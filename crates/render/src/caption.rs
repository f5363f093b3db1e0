//! The strip under a board, with the tick, the score, the avatar's resources and the outcome.

use crate::looks::colour::{Colour, INK, PAPER};
use crate::looks::look::Looks;
use crate::picture::{ADVANCE, Picture, Place, shortened, text_width};
use crate::style::Style;
use engine::{Outcome, State};

/// The number of characters for the outcome, including the gap before it.
const ENDING: usize = 9;

/// Returns the height of the strip, which is the same for all states. There is always one row. Resources or health,
/// sprite counts that decide a win, and countdowns each add a row if the game has them.
pub(crate) fn height(looks: &Looks, style: &Style) -> u32 {
    let prospects = looks.prospects();
    let more = [looks.has_holdings(), prospects.has_goals(), prospects.counts_down()];
    let rows = 1 + more.into_iter().filter(|&row| row).count() as u32;
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
    let prospects = looks.prospects();
    let time = prospects.time(state).filter(|_| word.is_empty());
    let time = time.map_or(String::new(), |time| format!(" ({time})"));
    let first = format!("tick {}{time}  score {}", state.tick() + 1, state.score());
    let room = letters.saturating_sub(1);
    // On a narrow board, the outcome takes precedence over the score.
    let whole = first.chars().count() + if word.is_empty() { 0 } else { ENDING } <= room;
    if whole || word.is_empty() {
        picture.text((x, y), size, PAPER, &shortened(&first, room));
    }
    let at = if whole { width - text_width(word, size) - size * 0.4 } else { x };
    picture.text((at, y), size, PAPER, word);
    let mut rows = Vec::new();
    if prospects.has_goals() {
        rows.push(format!("to win: {}", prospects.goals(state)));
    }
    if looks.has_holdings() {
        let held = holdings(looks, state);
        rows.push(if held.is_empty() { "nothing held".to_owned() } else { held });
    }
    if prospects.counts_down() {
        rows.push(prospects.countdowns(looks.game(), state));
    }
    let mut y = y;
    for text in rows {
        y += row;
        picture.text((x, y), size, PAPER, &shortened(&text, room));
    }
}

/// The texts for outcomes, each with its background colour.
pub(crate) const ENDINGS: [(&str, Colour); 2] =
    [("WON", Colour([0x08, 0x80, 0x62])), ("LOST", Colour([0xa8, 0x50, 0x0c]))];

fn ending(outcome: Outcome) -> (&'static str, Colour) {
    match outcome {
        Outcome::Ongoing => ("", INK),
        Outcome::Won => ENDINGS[0],
        Outcome::Lost => ENDINGS[1],
        Outcome::Ended => ("ENDED", INK),
        Outcome::Stopped(_) => ("STOPPED", INK),
    }
}

/// Returns the avatar's resources and health, with the amounts required: `key 2  prize 1 of 3  health 3`.
pub fn holdings(looks: &Looks, state: &State) -> String {
    let (game, prospects) = (looks.game(), looks.prospects());
    let mut held = game.held_by_avatar(state);
    held.retain(|(_, amount)| *amount != 0);
    for (resource, _) in prospects.required() {
        let name = game.name(resource);
        if held.iter().all(|(known, _)| known != name) {
            held.push((name.to_owned(), 0));
        }
    }
    let part = |(name, amount): &(String, i32)| match prospects.needed(name, game) {
        Some(number) => format!("{name} {amount} of {number}"),
        None => format!("{name} {amount}"),
    };
    let mut parts: Vec<String> = held.iter().map(part).collect();
    let avatar = state.avatar_id();
    let record = game.records(state).into_iter().find(|record| Some(record.id) == avatar);
    if let Some(record) = record.filter(|record| record.health > 0) {
        parts.push(format!("health {}", record.health));
    }
    parts.join("  ")
}
