//! State evaluations from observable features: the reference's two heuristics (`spec/04` §9), including their
//! quirks.

use engine::{Category, Game, Outcome, SpriteType, State};
use serde::{Deserialize, Serialize};

/// An evaluation of states, for players that look only a few ticks ahead.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Heuristic {
    /// The reference's `WinScoreHeuristic`: the score, or 1000 for a win and −1000 for a loss, regardless of the
    /// score. In a game with larger scores, it is therefore better to keep playing than to win.
    WinScore,
    /// The reference's `SimpleStateHeuristic`: the score minus a term for the distance to the nearest portal, or to
    /// the nearest NPC if there are no portals. Distances are in squared pixels. NPCs attract the player even if they
    /// are deadly, and each remaining NPC costs 100 points.
    Simple,
}

impl Heuristic {
    /// Returns the value of a state reached from `root`. Cost: O(1), or O(NPCs and portals).
    pub fn value(self, game: &Game, root: &State, state: &State) -> f64 {
        match (self, state.outcome()) {
            (Heuristic::WinScore, Outcome::Won) => 1000.0,
            (Heuristic::WinScore, Outcome::Lost | Outcome::Stopped(_)) => -1000.0,
            (Heuristic::WinScore, _) => state.score(),
            (Heuristic::Simple, Outcome::Lost | Outcome::Stopped(_)) => -999_999_999.0,
            (Heuristic::Simple, _) => simple(game, root, state),
        }
    }
}

fn simple(game: &Game, root: &State, state: &State) -> f64 {
    let won = if state.outcome() == Outcome::Won { 1e9 } else { 0.0 };
    let score = state.score();
    let portals = Sighting::of(game, root, state, Category::Portal);
    if portals.known {
        return match portals.nearest {
            Some(distance) => score + 1e6 * won - 10.0 * distance,
            None => score + 1e8 * won,
        };
    }
    let npcs = Sighting::of(game, root, state, Category::Npc);
    match npcs.nearest {
        Some(distance) => -distance / 100.0 - 100.0 * npcs.count as f64 + score + 1e8 * won,
        None => score + 1e8 * won,
    }
}

/// A summary of the observed sprites of one category.
struct Sighting {
    /// `true` if a type of the category exists now, or existed in the root state. In the reference, a copied state
    /// remembers the types of the original.
    known: bool,
    count: usize,
    /// The squared distance, in pixels, from the avatar to the nearest sprite of the last type that has any sprites.
    /// Sprites of other types may be nearer, because the reference iterates over the types and keeps only the last
    /// result. `None` if there is no such sprite.
    nearest: Option<f64>,
}

impl Sighting {
    fn of(game: &Game, root: &State, state: &State, category: Category) -> Sighting {
        // The reference places the avatar at (−1, −1) when the episode is over.
        let from = state.avatar_place().unwrap_or((-1, -1));
        let mut sighting = Sighting { known: false, count: 0, nearest: None };
        let seen = |stype: &SpriteType| game.category(*stype) == category && !game.is_hidden(*stype);
        for stype in game.sprite_types().filter(seen) {
            let distances = state.places(stype).map(|place| squared_distance(from, place));
            let (count, nearest) = distances
                .fold((0, f64::INFINITY), |(count, nearest), distance| (count + 1, distance.min(nearest)));
            sighting.known |= count > 0 || root.places(stype).next().is_some();
            sighting.count += count;
            if count > 0 {
                sighting.nearest = Some(nearest);
            }
        }
        sighting
    }
}

fn squared_distance(from: (i32, i32), to: (i32, i32)) -> f64 {
    let (x, y) = (f64::from(from.0) - f64::from(to.0), f64::from(from.1) - f64::from(to.1));
    x * x + y * y
}
