//! Patterns: named fragments of games, with the features they need and bar.

use super::draft::Draft;
use super::kind::Kind;
use super::role::Role;
use engine::Sampler;

/// A feature that a pattern gives to a game, needs in it, or bars from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Feature {
    /// The hero walks in four directions.
    Four,
    /// The hero moves along one row.
    Row,
    /// The hero moves along one column.
    Column,
    /// The hero's stamina is determined.
    Health,
    /// The hero has a weapon.
    Armed,
    /// The weapon is a projectile or a blade, not an explosive.
    Strikes,
    /// The weapon is an explosive.
    Blasts,
    /// The ammunition is limited.
    Scarce,
    /// Something moves by itself.
    Movers,
    /// Something harms the hero.
    Harm,
    /// There is something for a weapon to hit.
    Prey,
    /// The hero changes its state, such as when it carries something.
    States,
    /// Crates are pushed.
    Crates,
    /// Moving friends must reach a place.
    Followers,
    /// The hero returns to the same places.
    Errands,
    /// A foe must not vanish except by the hero's weapon.
    Precious,
    /// Touching a foe may make it vanish.
    Wards,
    /// There is something to blow up.
    Ruins,
    /// Lanes of traffic, which leave no room to shut off a part of the level.
    Lanes,
    /// A hazard that stays when it is touched.
    Stains,
}

/// Features, for the tables of patterns.
pub(crate) type Features = &'static [Feature];
/// Roles, for the tables of patterns.
pub(crate) type Roles = &'static [Role];
/// Adds a pattern to a draft.
pub(crate) type Build = fn(&mut Draft, &mut Sampler);

/// A fragment of a game.
pub(crate) struct Pattern {
    /// Its name, with its family: `threat/patrol`.
    pub(crate) name: &'static str,
    /// The relative weight in the draw.
    pub(crate) weight: u32,
    /// The roles of the sprite types it may introduce; no two patterns of a game share one.
    pub(crate) roles: Roles,
    pub(crate) gives: Features,
    /// The features that other patterns must give.
    pub(crate) needs: Features,
    /// The features that no other pattern may give.
    pub(crate) bars: Features,
    /// Adds it to a draft.
    pub(crate) build: Build,
}

/// A pattern that goes with all others.
pub(crate) const fn pattern(
    name: &'static str,
    weight: u32,
    roles: Roles,
    gives: Features,
    build: Build,
) -> Pattern {
    Pattern { name, weight, roles, gives, needs: &[], bars: &[], build }
}

impl Pattern {
    pub(crate) const fn gives(self, gives: Features) -> Pattern {
        Pattern { gives, ..self }
    }

    pub(crate) const fn needs(self, needs: Features) -> Pattern {
        Pattern { needs, ..self }
    }

    pub(crate) const fn bars(self, bars: Features) -> Pattern {
        Pattern { bars, ..self }
    }
}

/// A pattern that defines how the game is won, with its requirements on the other patterns.
pub(crate) struct Goal {
    pub(crate) pattern: Pattern,
    /// The kind of game that it makes.
    pub(crate) kind: Kind,
    /// The features that the way of moving must give.
    pub(crate) hero: Features,
    /// Threats besides its own: minimum and maximum.
    pub(crate) threats: (usize, usize),
    /// Obstacles: minimum and maximum.
    pub(crate) obstacles: (usize, usize),
    /// Units of time until the game ends: minimum and maximum.
    pub(crate) ticks: (u32, u32),
}

impl Goal {
    pub(crate) const fn bars(self, bars: Features) -> Goal {
        Goal { pattern: self.pattern.bars(bars), ..self }
    }

    pub(crate) const fn hero(self, hero: Features) -> Goal {
        Goal { hero, ..self }
    }

    pub(crate) const fn threats(self, least: usize, most: usize) -> Goal {
        Goal { threats: (least, most), ..self }
    }

    pub(crate) const fn obstacles(self, least: usize, most: usize) -> Goal {
        Goal { obstacles: (least, most), ..self }
    }

    pub(crate) const fn ticks(self, least: u32, most: u32) -> Goal {
        Goal { ticks: (least, most), ..self }
    }
}
