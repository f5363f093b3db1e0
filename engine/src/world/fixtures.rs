//! Fixtures: sprites that others meet, and that no rule makes, moves, changes or removes. Walls, mostly.
//!
//! They stay where the level has put them for the whole episode, so all states of a level share them, and a copy of a state
//! does not copy them. Their slots count down from the last one. The running hash contains their contributions from the
//! start. In the chain of a cell, fixtures come last, so that no other sprite is linked to by one.

use super::contribution::{Contribution, exchange};
use super::{Models, NONE, Slot, Sprite, Watcher, World};
use std::sync::Arc;

/// The fixtures, in order of creation.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fixtures(Vec<Sprite>);

/// The place of a slot among the fixtures, and the slot of a place.
pub(super) fn mirrored(number: usize) -> usize {
    usize::from(NONE) - 1 - number
}

impl World {
    /// The fixture in a slot.
    #[inline]
    pub(crate) fn fixture(&self, slot: Slot) -> &Sprite {
        let Fixtures(sprites) =
            self.fixtures.as_deref().expect("slots without a sprite are those of fixtures");
        &sprites[mirrored(usize::from(slot))]
    }

    /// The number of fixtures.
    pub(crate) fn fixture_count(&self) -> usize {
        self.all_fixtures().len()
    }

    /// The fixtures, in order of creation.
    pub(super) fn all_fixtures(&self) -> &[Sprite] {
        self.fixtures.as_ref().map_or(&[], |fixtures| &fixtures.0)
    }

    fn edit_fixture(&mut self, slot: Slot) -> &mut Sprite {
        let Fixtures(sprites) = Arc::make_mut(self.fixtures.get_or_insert_default());
        &mut sprites[mirrored(usize::from(slot))]
    }

    /// Makes a fixture. If other states share the fixtures, this one gets its own copy.
    pub(crate) fn add_fixture(&mut self, models: &Models, mut sprite: Sprite, watcher: &mut impl Watcher) {
        let slot = mirrored(self.fixture_count()) as Slot;
        (sprite.column, sprite.row) = self.place_of(sprite.rect);
        self.census_changed |= models.of_type[sprite.stype.index()].counted;
        let group = &mut self.groups[sprite.stype.index()];
        group.count += 1;
        let tail = std::mem::replace(&mut group.tail, slot);
        if tail == NONE {
            group.head = slot;
        } else {
            self.edit_fixture(tail).next = slot;
        }
        sprite.previous = tail;
        Arc::make_mut(self.fixtures.get_or_insert_default()).0.push(sprite);
        self.next_id += 1;
        self.population += 1;
        let contribution = Contribution::fresh(&sprite, slot, &self.side_tables());
        exchange(Contribution::default(), contribution, &mut self.sum, &mut self.hash_classes);
        if models.bit(sprite.stype) == 0 {
            return;
        }
        // Behind the sprites that are no fixtures.
        let cell = self.cell_of(&sprite);
        let (mut last, mut next) = (NONE, self.cells[cell]);
        while usize::from(next) < self.sprites.len() {
            (last, next) = (next, self.sprite(next).cell_next);
        }
        self.edit_fixture(slot).cell_next = next;
        match last {
            NONE => self.cells[cell] = slot,
            last => self.sprites[usize::from(last)].cell_next = slot,
        }
        self.arrive(models.bits[sprite.stype.index()], cell, watcher);
    }

    /// Enters all fixtures into empty cells again.
    pub(super) fn reenter_fixtures(&mut self, models: &Models, watcher: &mut impl Watcher) {
        for slot in (0..self.fixture_count()).map(|number| mirrored(number) as Slot) {
            let sprite = *self.fixture(slot);
            if models.bit(sprite.stype) != 0 {
                let cell = self.cell_of(&sprite);
                self.cells[cell] = slot;
                self.arrive(models.bits[sprite.stype.index()], cell, watcher);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Action, Game, Seed, State};

    const START: &str = "BasicGame square_size=10\n  SpriteSet\n    wall > Immovable\n    brick > Immovable\n    gem > \
                         Immovable\n    ball > Missile\n    hero > MovingAvatar\n  LevelMapping\n    w > wall\n    b > \
                         brick\n    g > gem\n    o > ball\n    A > hero\n  TerminationSet\n    Timeout limit=99\n  \
                         InteractionSet\n";

    fn game(rules: &str) -> Game {
        Game::from_source(&format!("{START}    {rules}\n")).unwrap_or_else(|problems| panic!("{problems}"))
    }

    #[test]
    fn fixtures_are_met_and_never_touched() {
        let cases = [
            ("hero brick > stepBack", true),
            ("hero brick > killSprite scoreChange=1", true),
            ("ball brick > transformTo stype=gem", true),
            ("hero brick > undoAll", true),
            ("ball brick > wallBounce", true),
            ("brick hero > undoAll", false),
            ("brick hero > killSprite", false),
            ("brick EOS > stepBack", false),
            ("brick TIME > killSprite timer=3", false),
            ("hero brick > killBoth", false),
            ("hero brick > transformTo stype=gem killSecond=True", false),
            ("gem hero > transformTo stype=brick", false),
            ("gem hero > killAll stype=brick", false),
            ("gem hero > spawn stype=brick", false),
        ];
        for (rule, is_fixture) in cases {
            let game = game(rule);
            assert_eq!(game.0.fixtures[game.sprite_type("brick").unwrap().index()], is_fixture, "{rule}");
            assert!(!game.0.fixtures[game.sprite_type("hero").unwrap().index()]);
        }
    }

    fn start(game: &Game, level: &str) -> State {
        game.start(&game.level(level).unwrap(), Seed::from_text("fixtures"))
    }

    #[test]
    fn copies_share_fixtures() {
        let game = game("hero brick wall > stepBack");
        let size = |level: &str| start(&game, level).size_in_bytes();
        assert_eq!(size("Abbbb\nwwwww\n"), size("A    \n     \n"));
        let mut state = start(&game, "A b\n");
        let (copy, brick) = (state.clone(), game.sprite_type("brick").unwrap());
        for _ in 0..3 {
            game.step(&mut state, Action::Right);
        }
        assert_eq!((state.avatar_place(), state.places(brick).next()), (Some((10, 0)), Some((20, 0))));
        assert_eq!((copy.avatar_place(), copy.alive(brick)), (Some((0, 0)), 1));
        assert_eq!(state.state_hash(), state.state_hash_from_scratch());
        state.recount(&game).unwrap();
    }

    #[test]
    fn fixtures_follow_all_others_in_a_cell() {
        let game = Game::from_source(&format!("{START}    hero brick > killSprite scoreChange=1\n").replace(
            "A > hero",
            "A > hero\n    x > hero brick\n    y > brick hero\n    z > brick gem brick hero",
        ))
        .unwrap();
        for level in ["x \n", "y \n", "z \n"] {
            let mut state = start(&game, level);
            state.recount(&game).unwrap();
            game.step(&mut state, Action::Nil);
            assert!(state.score() >= 1.0, "{level}");
            state.recount(&game).unwrap();
        }
    }
}
