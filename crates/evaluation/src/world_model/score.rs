//! The score of a game written by the player under test.

use super::planner::{self, PlannerScore};
use super::recording::TransitionKind;
use super::seen::Viewer;
use super::task::WorldModelTask;
use engine::Game;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::iter::Sum;

/// The numbers of transitions that a game reproduces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Reproduced {
    /// The number of transitions.
    pub transitions: u64,
    /// The number of transitions after which the visible board is the same.
    pub board: u64,
    /// The number of transitions after which the whole observable state is the same: the board, the score, the
    /// resources, the health and the outcome.
    pub state: u64,
    /// The number of episodes in which the predicted observable state first differs from the real one after a
    /// transition of this kind.
    pub first_deviations: u64,
}

/// The score of a game that an examined player wrote.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WorldModelScore {
    /// The held-out transitions, by kind of event. Kinds without transitions are missing.
    pub kinds: BTreeMap<TransitionKind, Reproduced>,
    /// The results of the fixed planner.
    pub planner: PlannerScore,
}

impl WorldModelScore {
    /// Scores a game. A missing game reproduces nothing. Cost: one forward-model call for each held-out transition, and
    /// two searches for each level ([`PlannerScore`]).
    pub(super) fn of(task: &WorldModelTask, game: Option<&Game>) -> WorldModelScore {
        let mut kinds: BTreeMap<TransitionKind, Reproduced> = BTreeMap::new();
        for kind in task.held_out.iter().flat_map(|recording| &recording.kinds) {
            kinds.entry(*kind).or_default().transitions += 1;
        }
        if let Some(game) = game {
            reproduce(task, game, &mut kinds);
        }
        WorldModelScore { kinds, planner: planner::score(task, game) }
    }

    /// Returns the sums over all kinds of transition.
    pub fn total(&self) -> Reproduced {
        self.kinds.values().copied().sum()
    }
}

impl Sum for Reproduced {
    fn sum<I: Iterator<Item = Reproduced>>(all: I) -> Reproduced {
        all.fold(Reproduced::default(), |sum, one| Reproduced {
            transitions: sum.transitions + one.transitions,
            board: sum.board + one.board,
            state: sum.state + one.state,
            first_deviations: sum.first_deviations + one.first_deviations,
        })
    }
}

/// Counts the transitions that a game reproduces.
fn reproduce(task: &WorldModelTask, game: &Game, kinds: &mut BTreeMap<TransitionKind, Reproduced>) {
    let viewer = Viewer::new(game, &task.names);
    for recording in &task.held_out {
        let Ok(level) = game.level(&task.masked.levels[recording.level].text) else { continue };
        let mut has_deviated = false;
        recording.replay(&viewer, &level, |number, seen| {
            let expected = &recording.seen[number + 1];
            let count = kinds.get_mut(&recording.kinds[number]).expect("all kinds were counted");
            let is_same = seen == expected;
            count.board += u64::from(seen.board == expected.board);
            count.state += u64::from(is_same);
            count.first_deviations += u64::from(!is_same && !has_deviated);
            has_deviated |= !is_same;
            true
        });
    }
}
