//! The sprite types and amounts that may be involved in a deviation.

use super::fit::{Deviation, difference};
use crate::world_model::task::WorldModelTask;
use engine::Outcome;
use std::collections::BTreeSet;

/// The facts that narrow down the changes to consider.
pub(super) struct Clues {
    /// The names of the types whose sprites differ between the guess and the recording or, if there are none, before
    /// and after the step. If nothing differs, the names of all types on the boards.
    pub(super) suspects: Vec<String>,
    /// The names of the types on the cells with differences and on neighbouring cells, including the suspects.
    pub(super) nearby: Vec<String>,
    /// The names of the types with sprites that appear in the recording, but not in the guess.
    pub(super) appearing: Vec<String>,
    /// The difference in score between the recording and the guess.
    pub(super) score: f64,
    /// The changes in health and in resources in the recording.
    pub(super) amounts: Vec<i32>,
    /// The outcome in the recording, if the guess has a different one.
    pub(super) outcome: Option<Outcome>,
    /// The names of types without sprites after the step.
    pub(super) absent: Vec<String>,
    /// The names of types whose last sprite disappears in the step.
    pub(super) vanishing: Vec<String>,
}

impl Clues {
    pub(super) fn of(
        task: &WorldModelTask,
        visible: &[String],
        columns: u32,
        deviation: &Deviation<'_>,
    ) -> Clues {
        let Deviation { before, after, guessed } = deviation;
        let wrong = difference(&guessed.board, &after.board);
        let changed = difference(&before.board, &after.board);
        let name =
            |number: u16| task.names.get(usize::from(number)).filter(|name| visible.contains(name)).cloned();
        let names = |entries: &mut dyn Iterator<Item = (u32, u16)>| -> Vec<String> {
            let numbers: BTreeSet<u16> = entries.map(|entry| entry.1).collect();
            numbers.into_iter().filter_map(name).collect()
        };
        let main = if wrong.is_empty() { &changed } else { &wrong };
        let mut cells: BTreeSet<u32> = wrong.iter().chain(&changed).map(|entry| entry.0).collect();
        for &(cell, _) in main {
            cells.extend([cell.wrapping_sub(1), cell + 1, cell.wrapping_sub(columns), cell + columns]);
        }
        let all = || before.board.iter().chain(&after.board).copied();
        let suspects = match main.is_empty() {
            true => names(&mut all()),
            false => names(&mut main.iter().copied()),
        };
        let nearby = names(&mut all().filter(|entry| main.is_empty() || cells.contains(&entry.0)));
        let appearing =
            names(&mut after.board.iter().copied().filter(|entry| !guessed.board.contains(entry)));
        let present = names(&mut after.board.iter().copied());
        let absent: Vec<String> = visible.iter().filter(|name| !present.contains(name)).cloned().collect();
        let earlier = names(&mut before.board.iter().copied());
        let vanishing = absent.iter().filter(|name| earlier.contains(name)).cloned().collect();
        let held = |resources: &[(u16, i32)]| resources.iter().map(|(_, amount)| amount).sum::<i32>();
        let amounts = [after.health - before.health, held(&after.resources) - held(&before.resources)];
        Clues {
            suspects,
            nearby,
            appearing,
            score: after.score - guessed.score,
            amounts: amounts.into_iter().filter(|amount| *amount != 0).collect(),
            outcome: (after.outcome != guessed.outcome).then_some(after.outcome),
            absent,
            vanishing,
        }
    }
}
