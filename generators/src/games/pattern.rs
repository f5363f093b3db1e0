//! Patterns: named fragments of games, with what they need and what they rule out.

use super::draft::Draft;
use super::kind::Kind;
use super::role::Role;
use engine::Sampler;

/// What a pattern brings into a game, needs of it, or does not go with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Feature {
    /// The hero walks in four directions.
    Four,
    /// The hero moves along one row.
    Row,
    /// The hero moves along one column.
    Column,
    /// What the hero can take is settled.
    Health,
    /// The hero strikes or shoots.
    Armed,
    /// What it strikes with flies or swings: no explosions.
    Strikes,
    /// It blows things up.
    Blasts,
    /// Its ammunition is limited.
    Scarce,
    /// Something moves by itself.
    Movers,
    /// Something harms the hero.
    Harm,
    /// Something is there for a weapon to hit.
    Prey,
    /// The hero changes its state.
    States,
    /// Something is pushed.
    Crates,
    /// Someone walks who must arrive.
    Followers,
    /// The hero comes back to the same places.
    Errands,
    /// A foe must not vanish but by the hero's weapon.
    Precious,
    /// Touching a foe may make it vanish.
    Wards,
    /// There is something to blow up.
    Ruins,
    /// Lanes of traffic, which leave no room to shut anything away.
    Lanes,
    /// Harm that no touch ends.
    Stains,
}

/// A fragment of a game.
pub(crate) struct Pattern {
    /// Its name, with its family: `threat/patrol`.
    pub(crate) name: &'static str,
    /// How often it is drawn, relative to others.
    pub(crate) weight: u32,
    /// The roles of the sprite types it may introduce; no two patterns of a game share one.
    pub(crate) roles: &'static [Role],
    /// What it brings.
    pub(crate) gives: &'static [Feature],
    /// What must be there.
    pub(crate) needs: &'static [Feature],
    /// What must not be there, before or after.
    pub(crate) bars: &'static [Feature],
    /// Adds it to a draft.
    pub(crate) build: fn(&mut Draft, &mut Sampler),
}

/// A pattern that says how the game is won, and what goes with that.
pub(crate) struct Goal {
    /// The fragment.
    pub(crate) pattern: Pattern,
    /// The sort of game that it makes.
    pub(crate) kind: Kind,
    /// What the hero must be able to do.
    pub(crate) hero: &'static [Feature],
    /// Threats besides its own: at least, at most.
    pub(crate) threats: (usize, usize),
    /// Obstacles: at least, at most.
    pub(crate) obstacles: (usize, usize),
    /// Ticks until time is up: at least, at most.
    pub(crate) ticks: (u32, u32),
}
