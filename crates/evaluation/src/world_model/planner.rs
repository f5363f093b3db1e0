//! The fixed planner, which plans in one game and plays another.

use super::recording::start;
use super::seen::Viewer;
use super::task::WorldModelTask;
use agents::search::{Answer, Pushes, SearchLimits, best_first};
use engine::{Action, Analysis, Game, Level, Outcome};
use serde::{Deserialize, Serialize};

/// The limits of the search for a plan. Both are needed, because a game with thousands of sprites reaches the memory
/// limit first.
const LIMITS: SearchLimits = SearchLimits { calls: 10_000, bytes: 64 << 20 };

/// The results of the fixed planner: a best-first width search for any win, with at most 10,000 forward-model calls. It
/// plans from a level's start, and plays the plan in the true game without observing the true game in between.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlannerScore {
    /// The number of levels.
    pub levels: u64,
    /// The number of levels on which a plan made with the examined player's game wins the true game.
    pub wins: u64,
    /// The number of levels on which a plan made with the true game wins that game. More wins are not expected.
    pub true_wins: u64,
}

pub(super) fn score(task: &WorldModelTask, game: Option<&Game>) -> PlannerScore {
    let truth = Viewer::new(&task.masked.game, &task.names);
    let wins = |planned: &Game| {
        let (analysis, viewer) = (Analysis::of(planned), Viewer::new(planned, &task.names));
        let wins = task.masked.levels.iter().filter(|masked| {
            let plan = planned.level(&masked.text).ok().and_then(|level| plan(&analysis, &viewer, &level));
            plan.is_some_and(|plan| is_win(&truth, &masked.level, &plan))
        });
        wins.count() as u64
    };
    PlannerScore {
        levels: task.masked.levels.len() as u64,
        wins: game.map_or(0, wins),
        true_wins: wins(&task.masked.game),
    }
}

fn plan(analysis: &Analysis, viewer: &Viewer, level: &Level) -> Option<Vec<Action>> {
    let first = start(viewer, level);
    if first.is_over() {
        return None;
    }
    match best_first(analysis, &Pushes::of(analysis, level), &first, LIMITS).answer {
        Answer::Won { actions, .. } => Some(actions),
        _ => None,
    }
}

fn is_win(truth: &Viewer, level: &Level, plan: &[Action]) -> bool {
    let mut state = start(truth, level);
    plan.iter().any(|&action| truth.game.step(&mut state, action) == Outcome::Won)
}
