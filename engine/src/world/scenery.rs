//! Scenery: sprites of types that no rule, no other sprite and no termination refers to, and that do nothing by
//! themselves.
//!
//! They stay where the level has put them for the whole episode: half of all sprites of a typical game are its floor. All
//! states of a level share them. They have no slots, a copy of a state does not copy them, and the running hash contains
//! their contributions from the start.

use super::contribution::{Contribution, exchange};
use super::{NONE, Sprite, World};
use crate::rules::SpriteType;
use std::sync::Arc;

/// The scenery sprites, by type, in order of creation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scenery(Vec<(SpriteType, Vec<Sprite>)>);

impl Scenery {
    fn of(&self, stype: SpriteType) -> &[Sprite] {
        self.0.iter().find(|(other, _)| *other == stype).map_or(&[], |(_, sprites)| sprites)
    }
}

impl World {
    /// Makes a scenery sprite. If other states share the scenery, this one gets its own copy.
    pub(crate) fn add_scenery(&mut self, sprite: Sprite) {
        self.groups[sprite.stype.index()].count += 1;
        self.next_id += 1;
        self.population += 1;
        let contribution = Contribution::fresh(&sprite, NONE, &self.side_tables());
        exchange(Contribution::default(), contribution, &mut self.sum, &mut self.hash_classes);
        let Scenery(types) = Arc::make_mut(self.scenery.get_or_insert_default());
        match types.iter_mut().find(|(other, _)| *other == sprite.stype) {
            Some((_, sprites)) => sprites.push(sprite),
            None => types.push((sprite.stype, vec![sprite])),
        }
    }

    /// The scenery sprites of a type: all its sprites, or none.
    pub(crate) fn scenery_of(&self, stype: SpriteType) -> &[Sprite] {
        self.scenery.as_ref().map_or(&[], |scenery| scenery.of(stype))
    }

    /// The current sprites of a type, in order of creation: those with slots, and scenery. Between steps.
    pub(crate) fn sprites_of(&self, stype: SpriteType) -> impl Iterator<Item = Sprite> + '_ {
        self.scenery_of(stype).iter().copied().chain(self.slots(stype).map(|slot| self.present(slot)))
    }
}

#[cfg(test)]
mod tests {
    use crate::{Action, Game, Seed};

    const MEADOW: &str = "BasicGame square_size=10\n  SpriteSet\n    grass > Immovable\n    ground >\n      sand > Immovable\n      \
                          clay > Immovable\n    asleep > Immovable\n    bird > RandomNPC\n    nest > SpawnPoint stype=bird\n    \
                          cloud > Missile speed=0.5\n    tuft > Immovable wMult=0.5\n    hero > MovingAvatar\n  LevelMapping\n    \
                          . > grass\n    s > sand\n    z > asleep\n    n > nest\n    c > cloud\n    t > tuft\n    A > grass hero\n  \
                          InteractionSet\n    bird hero > transformTo stype=asleep\n    hero ground > stepBack\n  TerminationSet\n    \
                          Timeout limit=9 win=True\n";

    #[test]
    fn scenery_types_have_no_rules_and_never_move() {
        let game = Game::from_source(MEADOW).unwrap();
        let is_scenery = |name: &&str| game.0.scenery[game.sprite_type(name).unwrap().index()];
        let all = ["grass", "sand", "clay", "asleep", "bird", "nest", "cloud", "tuft", "hero"];
        assert_eq!(all.iter().filter(|name| is_scenery(name)).collect::<Vec<_>>(), [&"grass"]);
    }

    #[test]
    fn scenery_is_seen_and_counted_as_any_sprite_and_has_no_slots() {
        let game = Game::from_source(MEADOW).unwrap();
        let state = game.start(&game.level("A..\n.sz\n").unwrap(), Seed::from_text("meadow"));
        let grass = game.sprite_type("grass").unwrap();
        // The sand is a fixture: the hero meets it.
        assert_eq!((state.world.sprites.len(), state.world.fixture_count(), state.alive(grass)), (2, 1, 4));
        assert_eq!(state.places(grass).collect::<Vec<_>>(), [(0, 0), (10, 0), (20, 0), (0, 10)]);
        assert_eq!(
            game.records(&state).iter().map(|record| record.id).collect::<Vec<_>>(),
            [0, 1, 2, 3, 4, 5, 6]
        );
        let seen = game.observe(&state);
        assert_eq!(seen.cells[..2], [vec!["grass".to_owned(), "hero".to_owned()], vec!["grass".to_owned()]]);
        state.recount(&game).unwrap();
    }

    #[test]
    fn a_hash_knows_its_scenery() {
        let game = Game::from_source(MEADOW).unwrap();
        let start = |level: &str| game.start(&game.level(level).unwrap(), Seed::from_text("meadow"));
        let (mut one, mut other) = (start("A. .\n"), start("A .. \n"));
        for _ in 0..3 {
            assert_eq!(one.state_hash(), one.state_hash_from_scratch());
            assert_ne!(one.state_hash(), other.state_hash());
            game.step(&mut one, Action::Right);
            game.step(&mut other, Action::Right);
            one.settle_hash();
        }
    }

    #[test]
    fn copied_states_take_over_the_scenery() {
        let game = Game::from_source(MEADOW).unwrap();
        let start = |level: &str| game.start(&game.level(level).unwrap(), Seed::from_text("meadow"));
        let (meadow, mut desert) = (start("A....\n"), start("Asss.\n"));
        let grass = game.sprite_type("grass").unwrap();
        desert.clone_from(&meadow);
        assert_eq!(desert.rects(grass).count(), 5);
        assert_eq!(desert.state_hash(), meadow.state_hash());
    }
}
