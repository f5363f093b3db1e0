//! Positions and recordings as text.

use crate::direction::direction_name;
use crate::encoding::{directions, grid, soon, stacks};
use crate::legend::Legend;
use engine::{Action, Game, Observation, Outcome, State};
use itertools::Itertools;

/// The visible part of a state, as text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct View {
    /// The board, with one character per cell and one line per row.
    pub(super) board: String,
    /// The facts that the board does not show, one sentence or list per line.
    notes: Vec<String>,
}

impl View {
    pub(super) fn of(game: &Game, state: &State, legend: &Legend) -> View {
        let observation = game.observe(state);
        View { board: grid(&observation, legend), notes: notes(&observation, legend) }
    }

    /// Returns the view with facts about the near future. They tell how sprites move, so questions about the
    /// rules must not show them.
    pub(super) fn foretelling(game: &Game, state: &State, legend: &Legend) -> View {
        let mut view = View::of(game, state, legend);
        let soon = soon(&game.observe(state), legend);
        view.notes.splice(0..0, soon.into_iter().map(|line| format!("Soon: {line}")));
        view
    }

    /// Returns the board and the notes.
    pub(super) fn text(&self) -> String {
        std::iter::once(&self.board).chain(&self.notes).join("\n")
    }
}

fn notes(observation: &Observation, legend: &Legend) -> Vec<String> {
    let mut notes = stacks(observation, legend);
    notes.extend(directions(observation, legend).into_iter().map(|line| format!("Moving: {line}")));
    match &observation.avatar {
        None => notes.push("You are gone.".to_owned()),
        Some(avatar) => {
            notes.extend(direction_name(avatar.facing).map(|facing| format!("You face {facing}.")));
            if avatar.health != 0 {
                notes.push(format!("Your health is {}.", avatar.health));
            }
        }
    }
    let held = observation.resources.iter().filter(|(_, amount)| *amount != 0);
    let held = held.map(|(name, amount)| format!("{amount} {name}")).join(", ");
    if !held.is_empty() {
        notes.push(format!("You hold {held}."));
    }
    notes.push(format!("Score {}.", observation.score));
    match observation.outcome {
        Outcome::Ongoing => {}
        Outcome::Won => notes.push("You have won.".to_owned()),
        Outcome::Lost => notes.push("You have lost.".to_owned()),
        Outcome::Ended | Outcome::Stopped(_) => notes.push("The game has ended.".to_owned()),
    }
    notes
}

/// Formats actions as a list, such as `right, right, up`.
pub(super) fn listed(actions: &[Action]) -> String {
    actions.iter().join(", ")
}

/// Formats a recording as text. The first view is complete. Every later view contains only the changed rows and the
/// changed notes.
pub(super) fn recording(views: &[View], actions: &[Action]) -> String {
    let Some(first) = views.first() else { return String::new() };
    let later = views.windows(2).zip(actions).zip(1..);
    let later =
        later.map(|((pair, action), tick)| format!("Tick {tick}, {action}: {}", changes(&pair[0], &pair[1])));
    std::iter::once(first.text()).chain(later).join("\n")
}

fn changes(before: &View, after: &View) -> String {
    let rows = before.board.lines().zip(after.board.lines()).enumerate();
    let rows =
        rows.filter(|(_, (old, new))| old != new).map(|(row, (_, new))| format!("\n  row {row}: {new}"));
    let notes =
        after.notes.iter().filter(|note| !before.notes.contains(note)).map(|note| format!("\n  {note}"));
    let gone = before.notes.iter().filter(|note| !after.notes.contains(note) && is_list(note));
    let gone = gone.map(|note| format!("\n  no longer: {note}"));
    let all: String = rows.chain(notes).chain(gone).collect();
    if all.is_empty() { "nothing changes".to_owned() } else { all.trim_start().to_owned() }
}

/// Returns `true` if a note lists cells or held resources. Such a note can disappear without a replacement.
fn is_list(note: &str) -> bool {
    note.contains(": ") || note.starts_with("You hold")
}
