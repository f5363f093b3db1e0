//! An episode's state: a world, and a schedule of the work that its next ticks may skip.

pub(crate) mod arrange;
pub(crate) mod recount;
pub(crate) mod search_key;

use crate::numbers::chance::Chance;
use crate::rules::{Outcome, SpriteType};
use crate::schedule::Schedule;
use crate::world::{StateHash, World, flag};

/// An episode's state.
///
/// `clone` also copies the random number generator, so planners use [`State::fork`] instead. `clone_from`
/// reuses buffers and does not allocate once they have grown.
#[derive(Debug)]
pub struct State {
    pub(crate) world: World,
    pub(crate) schedule: Schedule,
}

impl Clone for State {
    fn clone(&self) -> State {
        State { world: self.world.clone(), schedule: self.schedule.clone() }
    }

    fn clone_from(&mut self, source: &State) {
        self.world.clone_from(&source.world);
        self.schedule.clone_from(&source.schedule);
    }
}

impl State {
    /// Returns the number of ticks played, minus one: −1 at the start and 0 after the first step.
    pub fn tick(&self) -> i32 {
        self.world.tick()
    }

    /// Returns the player's score.
    pub fn score(&self) -> f64 {
        self.world.score() as f64
    }

    /// Returns the game's counters. The game's `no_counters=` sets their number.
    pub fn counters(&self) -> &[i32] {
        self.world.counters()
    }

    /// Returns the episode's outcome so far.
    pub fn outcome(&self) -> Outcome {
        self.world.outcome()
    }

    /// Returns `true` once the episode is over.
    pub fn is_over(&self) -> bool {
        self.world.is_over()
    }

    /// Returns the game's random number generator.
    pub fn chance(&self) -> Chance {
        self.world.chance()
    }

    /// Returns a copy of the state with a different random future. Planners use such copies so that they
    /// cannot foresee random events.
    pub fn fork(&self, seed: base::Seed) -> State {
        let mut state = self.clone();
        state.world.reseed(Chance::from_seed(seed), Chance::from_seed(seed.child("jumps", 0)));
        state
    }

    /// Overwrites this state with a copy of `source` that has a different random future, reusing the buffers.
    pub fn fork_from(&mut self, source: &State, chance: Chance) {
        self.clone_from(source);
        self.world.reseed(chance, chance);
    }

    /// Returns the number of bytes copied when the state is copied.
    pub fn size_in_bytes(&self) -> usize {
        self.world.size_in_bytes() + self.schedule.size_in_bytes()
    }

    /// Returns the cell size in pixels.
    pub fn block(&self) -> i32 {
        self.world.block()
    }

    /// Returns the numbers of columns and rows on the board.
    pub fn size(&self) -> (i32, i32) {
        (self.world.columns(), self.world.rows())
    }

    /// Returns the type of the player's avatar, if the avatar is alive.
    pub fn avatar_type(&self) -> Option<SpriteType> {
        let sprite = self.world.avatar_sprite()?;
        (!sprite.is(flag::DISABLED)).then_some(sprite.stype)
    }

    /// Returns the hash of all data that can influence the future. Cost: O(sprites changed since
    /// [`State::settle_hash`]).
    pub fn state_hash(&self) -> StateHash {
        self.world.state_hash()
    }

    /// Updates the running hash, so that [`State::state_hash`] does not have to process earlier changes
    /// again.
    ///
    /// Stepping does not update the running hash, because planners need few hashes and should not pay for one
    /// in every step. Cost: O(sprites changed since the last call).
    pub fn settle_hash(&mut self) {
        self.world.settle_hash();
    }

    /// Computes the same hash as [`State::state_hash`] from scratch. Tests compare the two hashes. Cost:
    /// O(sprites).
    pub fn state_hash_from_scratch(&self) -> StateHash {
        self.world.state_hash_from_scratch()
    }
}
