//! The state of an episode: a world, and the schedule of what its next ticks may leave out.

pub(crate) mod arrange;
pub(crate) mod recount;
pub(crate) mod search_key;

use crate::numbers::chance::Chance;
use crate::rules::{Outcome, SpriteType};
use crate::schedule::Schedule;
use crate::world::{StateHash, World, flag};

/// The state of an episode.
///
/// `clone` copies the random number generator too; planners use [`State::fork`]. `clone_from` reuses buffers and does not
/// allocate once they have grown.
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
    /// The number of ticks played, minus one: −1 at the start, 0 after the first step.
    pub fn tick(&self) -> i32 {
        self.world.tick()
    }

    /// The score.
    pub fn score(&self) -> f64 {
        self.world.score() as f64
    }

    /// The game's counters; `no_counters=` sets their number.
    pub fn counters(&self) -> &[i32] {
        self.world.counters()
    }

    /// The outcome of the episode so far.
    pub fn outcome(&self) -> Outcome {
        self.world.outcome()
    }

    /// Returns `true` once the episode is over.
    pub fn is_over(&self) -> bool {
        self.world.is_over()
    }

    /// The game's random number generator.
    pub fn chance(&self) -> Chance {
        self.world.chance()
    }

    /// Copies the state with another random future: for planners, which must not foresee random events.
    pub fn fork(&self, seed: base::Seed) -> State {
        let mut state = self.clone();
        state.world.reseed(Chance::from_seed(seed), Chance::from_seed(seed.child("jumps", 0)));
        state
    }

    /// Overwrites this state with `source` and another random future; keeps the buffers.
    pub fn fork_from(&mut self, source: &State, chance: Chance) {
        self.clone_from(source);
        self.world.reseed(chance, chance);
    }

    /// The number of bytes that a copy of the state copies.
    pub fn size_in_bytes(&self) -> usize {
        self.world.size_in_bytes() + self.schedule.size_in_bytes()
    }

    /// The size of a cell in pixels.
    pub fn block(&self) -> i32 {
        self.world.block()
    }

    /// The columns and rows of the board.
    pub fn size(&self) -> (i32, i32) {
        (self.world.columns(), self.world.rows())
    }

    /// The type of the player's avatar, if there is a living one.
    pub fn avatar_type(&self) -> Option<SpriteType> {
        let sprite = self.world.avatar_sprite()?;
        (!sprite.is(flag::DISABLED)).then_some(sprite.stype)
    }

    /// The hash of everything that can influence the future. Cost: O(sprites changed since [`State::settle_hash`]).
    pub fn state_hash(&self) -> StateHash {
        self.world.state_hash()
    }

    /// Updates the running sum, so that [`State::state_hash`] does not have to look at earlier changes.
    ///
    /// Stepping does not do this by itself: planners, which ask for few hashes, do not pay for all of them. Cost:
    /// O(sprites changed since the last time).
    pub fn settle_hash(&mut self) {
        self.world.settle_hash();
    }

    /// The same hash as [`State::state_hash`], computed from scratch: tests compare the two. Cost: O(sprites).
    pub fn state_hash_from_scratch(&self) -> StateHash {
        self.world.state_hash_from_scratch()
    }
}
