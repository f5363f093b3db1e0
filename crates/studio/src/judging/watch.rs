//! Episodes for the judge to watch. They are produced in the same way for both sides, so that they do not
//! reveal a game's source. Recorded wins are not shown, because only some sources have them.

use crate::compiled::Compiled;
use crate::verdict::look_for_win;
use agents::{Budget, Planner, PlannerSpec, Solution};
use base::Seed;
use engine::{Episode, Level};
use serde::Deserialize;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, PoisonError};

/// The maximum number of forward-model calls per search for a win.
const SEARCH: u64 = 400_000;
/// The planner that plays if no win is found.
const PLANNER: &str = "olets";
/// The planner's number of calls per decision.
const DECISION: Budget = Budget(400);
/// The maximum number of ticks that the planner plays.
const TICKS: usize = 300;
/// The maximum number of episodes stored in a session.
const KEPT: usize = 256;

/// One side of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Hand {
    Left,
    Right,
}

/// A request to watch an episode on a level of a game in a pair.
#[derive(Clone, Copy, PartialEq, Eq, Deserialize)]
pub(crate) struct Wanted {
    pub(super) pair: usize,
    pub(super) side: Hand,
    pub(super) level: usize,
}

/// An episode to watch.
pub(crate) struct Play {
    pub(crate) episode: Episode,
    pub(crate) note: Option<&'static str>,
}

/// Plays a level. Returns the win found by a search or, if there is none, an episode played by a planner. Returns
/// `None` once `gone` returns `true`. The same seed yields the same episode.
pub(super) fn play(
    compiled: &Compiled,
    level: &Level,
    seed: Seed,
    gone: &(dyn Fn() -> bool + Sync),
) -> Option<Play> {
    let (solution, _) = look_for_win(&compiled.analysis, level, SEARCH, seed, gone, &mut |_| true);
    if let Solution::Won { episode, .. } = solution {
        return Some(Play { episode: *episode, note: None });
    }
    let spec: PlannerSpec = PLANNER.parse().expect("the planner is known");
    let mut player = spec.player(seed.child("planner", 0));
    let (mut episode, mut state) = Episode::begin(&compiled.game, level, seed.child("chance", 0));
    while !state.is_over() && episode.actions.len() < TICKS {
        if gone() {
            return None;
        }
        let (action, ..) = player.plan(&compiled.game, &state, DECISION);
        episode.play(&compiled.game, &mut state, action);
    }
    Some(Play {
        episode,
        note: Some("A short search found no win here, so a planner plays as well as it can."),
    })
}

/// The most recently played episodes.
#[derive(Default)]
pub(super) struct Plays(Mutex<VecDeque<(Wanted, Arc<Play>)>>);

impl Plays {
    /// Returns an episode that is already stored, or plays it now. Returns `None` if the work was cancelled.
    pub(super) fn find(&self, wanted: Wanted, make: impl FnOnce() -> Option<Play>) -> Option<Arc<Play>> {
        let lock = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let known = lock().iter().find(|(known, _)| *known == wanted).map(|(_, play)| play.clone());
        if known.is_some() {
            return known;
        }
        let play = Arc::new(make()?);
        let mut kept = lock();
        if kept.len() == KEPT {
            kept.pop_front();
        }
        kept.push_back((wanted, play.clone()));
        Some(play)
    }
}
