//! The choice of layout family for a game.

use super::constructive::ConstructiveLevels;
use super::layout::Family;
use super::plan::furnishable;
use base::Sampler;
use engine::analysis::{Motion, Role, Steering};

impl ConstructiveLevels<'_> {
    /// Draws a layout family suitable for the game.
    pub(crate) fn family(&self, sampler: &mut Sampler) -> Family {
        let has = |role: Role| !furnishable(&self.analysis, &self.palette, role).is_empty();
        let mover = |role: Role| {
            furnishable(&self.analysis, &self.palette, role)
                .into_iter()
                .any(|stype| self.analysis.facts(stype).motion != Motion::Still)
        };
        let straight = furnishable(&self.analysis, &self.palette, Role::Enemy)
            .into_iter()
            .any(|stype| matches!(self.analysis.facts(stype).motion, Motion::Straight(_)));
        let steering = self.analysis.start_avatar().map(|avatar| avatar.steering);
        let free = !matches!(steering, Some(Steering::FourWay));
        if self.palette.wall.is_none() {
            return Family::Field;
        }
        let moving = mover(Role::Enemy) || mover(Role::Prey);
        let launches = furnishable(&self.analysis, &self.palette, Role::Spawner)
            .into_iter()
            .any(|stype| self.analysis.launches(stype).is_some());
        let families: &[(Family, u32)] = if steering == Some(Steering::Jumping) {
            &[(Family::Platforms, 1)]
        } else if free || (!self.palette.ring && launches) {
            &[(Family::Field, 2), (Family::Arena, 1)]
        } else if has(Role::Soil) {
            &[(Family::Arena, 2), (Family::Rooms, 1), (Family::Cave, 1)]
        } else if has(Role::Gate) {
            &[(Family::Rooms, 4), (Family::Cave, 1)]
        } else if has(Role::Breakable) && moving {
            &[(Family::Pillars, 4), (Family::Arena, 1)]
        } else if straight || launches {
            &[(Family::Rooms, 3), (Family::Arena, 3)]
        } else if moving || has(Role::Spawner) {
            &[(Family::Arena, 3), (Family::Cave, 3), (Family::Rooms, 2), (Family::Pillars, 2)]
        } else {
            &[(Family::Maze, 4), (Family::Cave, 2), (Family::Rooms, 2)]
        };
        let weights: Vec<u32> = families.iter().map(|(_, weight)| *weight).collect();
        families[sampler.weighted(&weights).unwrap_or(0)].0
    }
}
