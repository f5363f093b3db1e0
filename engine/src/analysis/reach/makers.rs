//! The sprites that types create on their own, and the cells in which those sprites appear.

use super::cells::{Cells, Directions};
use super::events::Events;
use super::meetings::Order;
use crate::numbers::geometry::Direction;
use crate::rules::SpriteType;
use crate::rules::class::{ClassFamily, SpriteClass};

impl Events<'_> {
    /// Adds the sprites that existing sprites create on their own.
    pub(super) fn make(&mut self) {
        for maker in self.flood.model.types() {
            if !self.can_occur(maker) || self.flood.is_over_budget() {
                continue;
            }
            let model = self.flood.model;
            let loaded = |ammo: Option<SpriteType>| ammo.is_none_or(|ammo| self.have[ammo.index()] > 0);
            let kinds = model.makes[maker.index()].iter();
            let kinds = kinds.filter(|(made, ammo)| model.exists[made.index()] && loaded(*ammo));
            let kinds: Vec<SpriteType> = kinds.map(|(made, _)| *made).collect();
            if kinds.is_empty() {
                continue;
            }
            let spawn_cells = self.spawn_cells(maker);
            self.flood.work += self.board().size() as u64;
            for made in kinds {
                for (from, facing) in &spawn_cells {
                    let heading = self.given(maker, made, *facing);
                    self.appear_in(made, from, Order::UPDATE, heading);
                }
            }
        }
    }

    /// Returns the directions that a maker facing in the given directions can pass on to a new sprite.
    fn given(&self, maker: SpriteType, made: SpriteType, facing: Directions) -> Directions {
        let model = self.flood.model;
        let born = model.born(made);
        let traits = &model.info(maker).traits;
        match model.info(maker).class {
            Some(SpriteClass::FlakAvatar | SpriteClass::Spreader | SpriteClass::OngoingTurningAvatar) => born,
            Some(class) if class.is_avatar() && model.info(made).traits.is_oriented => facing,
            Some(class) if class.is_avatar() => born,
            _ if traits.spawn_orientation != Direction::NONE => Directions::of(traits.spawn_orientation),
            _ if born.meets(Directions::UNSET) => facing,
            _ => born,
        }
    }

    /// Returns the cells in which new sprites appear when a type creates them, with the maker's orientation
    /// at that point.
    fn spawn_cells(&self, maker: SpriteType) -> Vec<(Cells, Directions)> {
        use ClassFamily as Family;
        use SpriteClass as C;
        let (board, model) = (self.board(), self.flood.model);
        let own = model.of_type(maker);
        let Some(class) = model.info(maker).class else { return Vec::new() };
        let grown = if own.off_grid { model.rules.reach.max(1) } else { 0 };
        let around = |distance: i32| vec![(board.around(self.touch(maker), distance), Directions::ALL)];
        match (class, class.family()) {
            // These avatars shoot only in ticks in which they do not move. All other avatars move before they
            // shoot.
            (C::ShootAvatar | C::ShootOnlyAvatar, _) if !model.info(maker).traits.continuous => {
                self.ahead(self.rest(maker), own.facing, grown)
            }
            (C::FlakAvatar, _) if !model.info(maker).traits.continuous => {
                vec![(self.rest(maker).clone(), own.facing)]
            }
            (C::ShootAvatar | C::ShootOnlyAvatar | C::OngoingShootAvatar, _) => {
                self.ahead(self.touch(maker), own.facing, grown)
            }
            (C::AimedAvatar | C::SpaceshipAvatar, _) => around(1 + grown),
            (C::WizardAvatar, _) => around(2 + grown),
            (C::OngoingTurningAvatar, _) => vec![(self.rest(maker).clone(), own.facing)],
            (C::Spreader, _) => self.ahead(self.touch(maker), Directions::FOUR, grown),
            // Other producers and avatars create sprites where they are. The remaining families create no
            // sprites.
            (_, Family::Producer | Family::Avatar | Family::Npc | Family::Walker)
            | (_, Family::Thing | Family::Resource | Family::Flicker | Family::Missile) => {
                vec![(self.touch(maker).clone(), own.facing)]
            }
        }
    }

    /// Returns, for each of the given directions, the cells one body length ahead in that direction.
    fn ahead(&self, from: &Cells, facing: Directions, grown: i32) -> Vec<(Cells, Directions)> {
        let board = self.board();
        if facing.meets(Directions::ASKEW) {
            return vec![(board.around(from, 1 + grown), Directions::ALL)];
        }
        // A maker that is larger or smaller than a cell shoots a little further or less far.
        let more = if self.flood.model.scales { grown } else { 0 };
        let shifted =
            |step: (i32, i32)| (board.around(&board.beside(from, step), more), Directions::of_step(step));
        let unset = facing.meets(Directions::UNSET).then(|| (board.around(from, more), Directions::UNSET));
        facing.steps().map(shifted).chain(unset).collect()
    }
}
