//! The numbers that a player knows but that no plane shows.

use crate::game::Rules;
use engine::State;
use engine::analysis::Resource;

/// The names of the numbers that every game has.
const COMMON: [&str; 4] = ["facing_x", "facing_y", "health", "ticks_left"];

/// The status of an episode: the avatar's facing and health, the remaining ticks, and the held resources.
/// Facing and health are 0 once the avatar is gone.
pub(crate) struct Status {
    /// The names of the resources that occur in the rules.
    resources: Vec<String>,
}

impl Status {
    /// Creates the status of a game.
    pub(crate) fn of(rules: &Rules) -> Status {
        let name = |resource: &Resource| rules.game.name(resource.stype).to_owned();
        Status { resources: rules.analysis.resources().iter().map(name).collect() }
    }

    /// Returns the length of the status.
    pub(crate) fn len(&self) -> usize {
        COMMON.len() + self.resources.len()
    }

    /// Returns the names of the numbers. The amount of a resource `coin` is `held_coin`.
    pub(crate) fn names(&self) -> Vec<String> {
        let held = self.resources.iter().map(|name| format!("held_{name}"));
        COMMON.iter().map(|&name| name.to_owned()).chain(held).collect()
    }

    /// Writes a state's numbers. The game's time limit and `steps_left` both bound the number of remaining
    /// ticks. Cost: O(resources).
    pub(crate) fn write(&self, rules: &Rules, state: &State, steps_left: u64, out: &mut [f32]) {
        out.fill(0.0);
        let (common, held) = out.split_at_mut(COMMON.len());
        if let Some(avatar) = rules.game.seen_avatar(state) {
            common[0] = avatar.facing.x as f32;
            common[1] = avatar.facing.y as f32;
            common[2] = avatar.health as f32;
        }
        let ticks = (state.tick() + 1).unsigned_abs().into();
        common[3] = rules.game.time_limit().saturating_sub(ticks).min(steps_left) as f32;
        for (resource, amount) in rules.game.held_by_avatar(state) {
            if let Some(at) = self.resources.iter().position(|name| *name == resource) {
                held[at] = amount as f32;
            }
        }
    }
}
