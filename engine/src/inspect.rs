//! Internal data of games and states, for people who study the engine and for this crate's tests, which play
//! whole games and therefore run against the library (`tests/it`). This data follows the engine's internal
//! design and may change at any time.

use crate::analysis::EffectSummary;
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use crate::rules::effects::Moves;
use crate::{Game, State};

/// The possible consequences of one execution of an effect.
#[derive(Clone, Debug)]
pub struct EffectRow {
    /// The changes that the effect makes, in the order of execution.
    pub effects: Vec<EffectSummary>,
    /// `true` if the first sprite may move.
    pub moves_first: bool,
    /// `true` if any sprite may move.
    pub moves_anything: bool,
    /// `true` if the first sprite's direction or speed may change.
    pub steers: bool,
    /// `true` if sprites that take no part in the interaction may change.
    pub affects_distant_sprites: bool,
    /// `true` if the effect leaves the second sprite unchanged, provided that nothing else moves that sprite
    /// and that no parameter refers to its type.
    pub spares_still_second: bool,
}

impl EffectRow {
    /// Returns the row for a game's first effect; `None` if the game has no effect.
    pub fn of_first(game: &Game) -> Option<EffectRow> {
        let summary = &game.0.effects.first()?.summary;
        Some(EffectRow {
            effects: summary.effects.to_vec(),
            moves_first: summary.moves != Moves::Nothing,
            moves_anything: summary.moves == Moves::Anything,
            steers: summary.turn.is_some() || summary.speed.is_some(),
            affects_distant_sprites: summary.affects_distant_sprites,
            spares_still_second: summary.spares_still_second(),
        })
    }
}

/// Returns `true` if the type's sprites never do anything in their updates, apart from the player's avatar.
pub fn is_idle(game: &Game, stype: SpriteType) -> bool {
    game.0.types[stype.index()].is_idle()
}

/// Returns `true` if the type's sprites are scenery: no rule involves them.
pub fn is_scenery(game: &Game, stype: SpriteType) -> bool {
    game.0.scenery[stype.index()]
}

/// Returns `true` if the type's sprites are fixtures: other sprites collide with them, but nothing changes
/// them.
pub fn is_fixture(game: &Game, stype: SpriteType) -> bool {
    game.0.fixtures[stype.index()]
}

/// Returns the number of sprites with their own slot, and the number of fixtures, which are sprites that never change.
pub fn stored_sprites(state: &State) -> (usize, usize) {
    (state.world.slot_count(), state.world.fixture_count())
}

/// Returns the number of sets of rarely changed values: one set per type, plus one per sprite with its own
/// set.
pub fn overrides(state: &State) -> usize {
    state.world.overrides_count()
}

/// Returns, for each sprite in flight, the number of ticks between two moves.
pub fn flight_periods(state: &State) -> impl Iterator<Item = u16> {
    state.schedule.flying().map(|slot| state.world.sprite(slot).period)
}

/// Returns the widths in pixels of the type's sprites, both now and before their last update.
pub fn widths(state: &State, stype: SpriteType) -> Vec<(i32, i32)> {
    let world = &state.world;
    world.slots(stype).map(|slot| (world.sprite(slot).rect.w, world.last(slot).w)).collect()
}

/// Returns the first step of the path between two pixels in a game with `obs=`, or `None` if there is no such
/// step.
pub fn first_step(state: &State, from: (i32, i32), to: (i32, i32)) -> Option<Direction> {
    state.world.first_step(from, to).0
}
