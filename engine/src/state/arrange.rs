//! Constructs states without playing up to them.

use crate::game::Game;
use crate::level::Level;
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use crate::state::State;
use base::Seed;

impl Game {
    /// Starts an episode like [`Game::start`], but the avatar faces `facing` and holds the resources `held`,
    /// in addition to its initial resources. Players use this to reconstruct a state from an observation.
    pub fn start_as(
        &self,
        level: &Level,
        seed: Seed,
        facing: Option<Direction>,
        held: &[(SpriteType, i32)],
    ) -> State {
        let mut state = self.start(level, seed);
        let world = &mut state.world;
        if world.has_avatar() {
            for &(resource, amount) in held {
                world.add_amount(world.avatar(), resource, amount);
            }
            if let Some(facing) = facing {
                world.edit_overrides(world.avatar()).orientation = facing;
            }
            world.settle_hash();
        }
        state
    }
}
