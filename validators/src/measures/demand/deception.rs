//! Greedy players, which go for nearby goals, and the distance by which these goals lead them away from the win.

use super::patience;
use super::route::{Route, avatar_cell};
use agents::{Budget, Limits, NearestGoal, OneStep, OneStepConfig, Planner, play};
use base::Seed;
use engine::{Analysis, Episode, Level, Outcome};
use serde::{Deserialize, Serialize};

/// The results of the nearest-goal player and of one-step look-ahead.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Deception {
    /// The total number of episodes of both players.
    pub plays: u64,
    /// The number of episodes not won within twice the known win's ticks plus twenty.
    pub lost: u64,
    /// The avatar's maximum distance from the route of the win, in cells, averaged over the episodes.
    pub astray: f64,
}

/// The number of episodes per player, each with its own random seed.
const PLAYS: u64 = 4;

impl Deception {
    /// Plays the episodes. Cost in calls: the number of ticks in eight episodes times the number of actions.
    pub(super) fn of(
        analysis: &Analysis,
        level: &Level,
        win: &Episode,
        route: &Route,
        seed: Seed,
    ) -> Deception {
        let game = analysis.game();
        let limits = Limits { ticks: patience(win), ..Limits::default() };
        let mut found = Deception { plays: 0, lost: 0, astray: 0.0 };
        let mut farthest = 0;
        for number in 0..PLAYS {
            let seed = seed.child("play", number);
            let mut nearest = NearestGoal::new(0.0, seed.child("nearest goal", 0));
            let mut greedy = OneStep::new(OneStepConfig::default(), seed.child("one step", 0));
            let players: [&mut dyn Planner; 2] = [&mut nearest, &mut greedy];
            for player in players {
                let played = play(game, level, player, Budget(0), seed.child("chance", 0), limits).episode;
                found.plays += 1;
                found.lost += u64::from(played.outcome != Outcome::Won);
                let mut state = game.start(level, played.seed);
                let mut far = 0;
                for &action in &played.actions {
                    game.step(&mut state, action);
                    far = avatar_cell(&state).map_or(far, |cell| far.max(route.distance(cell)));
                }
                farthest += far;
            }
        }
        found.astray = f64::from(farthest) / found.plays as f64;
        found
    }

    /// Returns the fraction of episodes not won.
    pub fn share(&self) -> f64 {
        self.lost as f64 / self.plays.max(1) as f64
    }
}
