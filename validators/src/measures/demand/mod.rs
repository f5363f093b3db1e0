//! Measures of a level's demands on a player, and the tier (difficulty class) derived from them.

mod commitment;
mod dead_ends;
mod deception;
mod route;
mod shorter;
mod tier;

pub use commitment::Commitment;
pub use dead_ends::DeadEnds;
pub use deception::Deception;
pub use shorter::shorter_win;
pub use tier::{TIERS, Tier, TierBounds};

use crate::measures::pushes_of;
use base::Seed;
use engine::{Action, Analysis, Episode, Level, Outcome};
use route::Route;
use serde::{Deserialize, Serialize};

/// A level's demands on its player, measured on a known win. The same arguments give the same numbers on
/// every machine, with any number of threads. All counts are exact for that win, and all other values are
/// sampled with a seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Demand {
    /// The number of ticks in the win.
    pub ticks: usize,
    /// The number of ticks in the win in which a key is pressed, that is, whose action is not nil.
    pub decisions: usize,
    /// The number of pushes in the win that move or remove a sprite.
    pub pushes: usize,
    /// `true` if the win is proven to be the shortest.
    pub shortest: bool,
    /// The longest commitment (number of actions per decision) with which a planner still wins.
    pub commitment: Commitment,
    /// The dead ends near the win, or `None` for a stochastic level, on which no search can prove dead ends.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dead_ends: Option<DeadEnds>,
    /// The number of self-moving sprites that enter or come next to a cell on the win's route.
    pub movers: usize,
    /// The results of players that go for nearby goals.
    pub deception: Deception,
}

impl Demand {
    /// Measures a level with a win. Returns `None` if the episode does not win. `shortest` means that the win
    /// is proven to be the shortest.
    ///
    /// Cost: at most 2.1 million forward-model calls for commitments, 1 million for dead ends, and the ticks of a few
    /// episodes. The typical cost is a tenth of the maximum.
    pub fn of(
        analysis: &Analysis,
        level: &Level,
        win: &Episode,
        shortest: bool,
        seed: Seed,
    ) -> Option<Demand> {
        if win.outcome != Outcome::Won {
            return None;
        }
        let route = Route::of(analysis, level, win);
        Some(Demand {
            ticks: win.actions.len(),
            decisions: win.actions.iter().filter(|&&action| action != Action::Nil).count(),
            pushes: pushes_of(analysis, level, win),
            shortest,
            commitment: Commitment::of(analysis, level, win, seed.child("commitment", 0)),
            dead_ends: DeadEnds::of(analysis, level, win, seed.child("dead ends", 0)),
            movers: route.movers,
            deception: Deception::of(analysis, level, win, &route, seed.child("deception", 0)),
        })
    }

    /// Returns the level's tier, which is a difficulty class.
    pub fn tier(&self) -> Tier {
        Tier::of(self)
    }
}

/// Returns the maximum number of ticks in an episode on a level with a known win: twice the win's ticks plus
/// twenty.
fn patience(win: &Episode) -> usize {
    2 * win.actions.len() + 20
}

#[cfg(test)]
mod tests {
    use super::*;
    use agents::{PortfolioConfig, Solution, solve};
    use engine::Game;

    /// A game in which crates go into pits, and cannot be moved away from a wall. The wasp flies along its row.
    const GAME: &str = "BasicGame\n  SpriteSet\n    pit > Immovable\n    crate > Passive\n    wasp > Missile orientation=LEFT speed=1\n    avatar > MovingAvatar\n  LevelMapping\n    o > pit\n    c > crate\n    s > wasp\n  InteractionSet\n    avatar wall > stepBack\n    avatar pit > stepBack\n    crate avatar > bounceForward\n    crate wall > undoAll\n    crate crate > undoAll\n    crate pit > killSprite scoreChange=1\n    avatar wasp > killSprite\n    wasp wall > reverseDirection\n  TerminationSet\n    SpriteCounter stype=crate win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=200 win=False\n";

    fn check(level: &str) -> Demand {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level(level).unwrap();
        let analysis = Analysis::of(&game);
        let seed = Seed::from_text("demand");
        let solved = solve(&analysis, &level, &PortfolioConfig::default(), seed);
        let Solution::Won { episode, shortest } = solved.solution else { panic!("a win: {level}") };
        let demand = Demand::of(&analysis, &level, &episode, shortest, seed).unwrap();
        assert_eq!(Some(demand.clone()), Demand::of(&analysis, &level, &episode, shortest, seed));
        demand
    }

    #[test]
    fn a_corridor_demands_two_pushes() {
        let demand = check("wwwwww\nwAc ow\nwwwwww\n");
        assert_eq!((demand.ticks, demand.decisions, demand.pushes, demand.shortest), (2, 2, 2, true));
        assert_eq!((demand.movers, demand.commitment, demand.tier()), (0, Commitment::All, Tier::One));
        assert_eq!(demand.dead_ends.unwrap().dead, 0);
        assert_eq!((demand.deception.plays, demand.deception.lost, demand.deception.astray), (8, 0, 0.0));
    }

    #[test]
    fn pushes_that_cannot_be_undone_are_dead_ends() {
        // The path to the winning push starts to the left of the avatar. A push to the right or downwards ends at the
        // wall.
        let demand = check("wwwwwww\nw     w\nw oc  w\nw  A  w\nwwwwwww\n");
        let found = demand.dead_ends.unwrap();
        assert!(found.dead > 0 && found.won > 0 && found.states >= found.dead + found.won, "{found:?}");
    }

    #[test]
    fn wasps_on_the_route_are_counted_and_others_are_not() {
        let near = check("wwwwwwww\nw     ow\nw     cw\nw   s  w\nw    A w\nwwwwwwww\n");
        assert_eq!(near.movers, 1);
        let far = check("wwwwwwww\nws     w\nwwwwwwww\nwA c o w\nwwwwwwww\n");
        assert_eq!(far.movers, 0);
    }

    #[test]
    fn an_episode_that_does_not_win_demands_nothing() {
        let game = Game::from_source(GAME).unwrap();
        let level = game.level("wwwwww\nwAc ow\nwwwwww\n").unwrap();
        let (episode, _) = Episode::begin(&game, &level, Seed::from_text("lost"));
        let analysis = Analysis::of(&game);
        assert_eq!(Demand::of(&analysis, &level, &episode, false, Seed::from_text("x")), None);
    }
}
