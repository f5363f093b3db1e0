//! Hash contributions: the terms that sprites add to their state's hash, and how these terms grow while
//! sprites fly.
//!
//! A state's hash is a sum over its sprites. Each sprite adds the product of a number and its own keys
//! (`mod.rs`). The number is linear in the sprite's position and the tick of its last move, so sprites in
//! flight need no update. All sprites that move in the same ticks form one linear hash class. Each of their
//! moves adds the class's growth to the sum.

use super::{KEYS, Products, SECRET, bits, fold, two};
use crate::flat::bytes_of_fields;
use crate::flat::bytes_of_wrapper;
use crate::numbers::geometry::Rect;
use crate::world::sprites::moved::{Resized, last_of};
use crate::world::{Overrides, Slot, Sprite, World, flag};

/// The tables with data that is not stored in the sprites themselves.
#[derive(Clone, Copy)]
pub(crate) struct SideTables<'a> {
    pub(crate) overrides: &'a [Overrides],
    pub(crate) resized: &'a [Resized],
}

impl World {
    pub(crate) fn side_tables(&self) -> SideTables<'_> {
        SideTables { overrides: &self.overrides, resized: &self.resized }
    }
}

/// Returns the hash of a sprite's rarely changed values.
///
/// The last rectangle is included only for sprites that are not updated. For all others, the current
/// rectangle replaces it before the next tick reads it.
#[inline(always)]
fn still_hash(sprite: &Sprite, slot: Slot, tables: &SideTables<'_>) -> u64 {
    let last = sprite.is(flag::FROZEN).then(|| last_of(sprite, slot, tables.resized));
    hash_of(sprite, &tables.overrides[usize::from(sprite.overrides)], last.as_ref())
}

#[inline(never)]
fn hash_of(sprite: &Sprite, overrides: &Overrides, last: Option<&Rect>) -> u64 {
    let spawns = u64::from(overrides.spawns.0) << 32 | u64::from(sprite.id);
    let mut products = Products::NONE
        .and(two(sprite.rect.w, sprite.rect.h), spawns, KEYS[0])
        .and(bits(overrides.orientation.x), bits(overrides.orientation.y), KEYS[1])
        .and(bits(overrides.speed), two(overrides.health, overrides.max_health), KEYS[2]);
    if overrides.start != 0 {
        products = products.and(overrides.start as u64, 0, KEYS[3]);
    }
    if let Some(last) = last {
        products = products.and(two(last.x, last.y), two(last.w, last.h), [KEYS[3][1], KEYS[0][0]]);
    }
    let (low, high) = products.halves();
    fold(low ^ SECRET[0], high ^ SECRET[1])
}

/// A sprite's hash contribution when the hash was last settled. It is the sum of `word` and its growth since
/// then, multiplied by the sprite's keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Contribution {
    /// The position and all other values that change with movement, as one number. For a sprite in flight,
    /// this is the value before the first move from tick 0 on. It is 0 if the slot is free.
    pub(crate) word: u64,
    /// The growth of the word during flight.
    pub(crate) motion: FlightMotion,
    /// The hash of the sprite's rarely changed values, which differs for every sprite.
    pub(crate) still: u64,
}

bytes_of_fields! { Contribution { word motion still } }

/// The weights in [`Contribution::word`] of a pixel downwards and of a tick. A pixel to the right has a
/// weight of 1.
const DOWN: u64 = 0x9FB2_1C65_1E98_DF25;
const LATER: u64 = 0xD1B5_4A32_D192_ED03;

fn point(x: i32, y: i32) -> u64 {
    (x as u64).wrapping_add((y as u64).wrapping_mul(DOWN))
}

/// The motion of a sprite in flight as one number, which contains the displacement in pixels to the right and
/// down, the period, the phase, and the `AGES` bit. It is 0 for all other sprites.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct FlightMotion(pub(crate) u64);

bytes_of_wrapper! { FlightMotion }

impl FlightMotion {
    const NONE: FlightMotion = FlightMotion(0);
    /// The bit that is set if the tick of the last move matters.
    const AGES: u64 = 1 << 63;

    fn of(sprite: &Sprite, ages: bool) -> FlightMotion {
        let phase = match sprite.period {
            1 => 0,
            period => sprite.moved_at.rem_euclid(i32::from(period)) as u64,
        };
        let ages = if ages { FlightMotion::AGES } else { 0 };
        let ticks = ages | phase << 48 | u64::from(sprite.period) << 32;
        let by = |at: i32, was: i32| u64::from(at.wrapping_sub(was) as u16);
        FlightMotion(
            ticks | by(sprite.rect.y, sprite.last_corner.1) << 16 | by(sprite.rect.x, sprite.last_corner.0),
        )
    }

    fn period(self) -> u16 {
        (self.0 >> 32) as u16
    }

    fn phase(self) -> u16 {
        ((self.0 & !FlightMotion::AGES) >> 48) as u16
    }

    /// Returns the amount by which the word grows with each move of the sprite.
    fn growth(self) -> u64 {
        let by = point(i32::from(self.0 as i16), i32::from((self.0 >> 16) as i16));
        let later =
            if self.0 & FlightMotion::AGES == 0 { 0 } else { LATER.wrapping_mul(u64::from(self.period())) };
        by.wrapping_add(later)
    }
}

/// Returns `true` if the tick of a sprite's last move matters, either as the sprite's age or for a cooldown
/// that may delay the sprite.
#[inline(always)]
fn ages(sprite: &Sprite) -> bool {
    sprite.flags & (flag::NO_COOLDOWN | flag::FROZEN) != flag::NO_COOLDOWN
}

/// Returns a sprite's position and all other values that change with movement, as one number.
#[inline(always)]
fn word(sprite: &Sprite) -> u64 {
    let look = u64::from(sprite.stype.0) << 48 | u64::from(sprite.heading()) << 32 | u64::from(sprite.flags);
    let kind = look & (!0 << 32 | u64::from(flag::LASTING));
    let rest = fold(kind ^ SECRET[3], two(sprite.count, sprite.time_to_live) ^ SECRET[1]);
    let moved_at = if ages(sprite) { LATER.wrapping_mul(sprite.moved_at as u64) } else { 0 };
    point(sprite.rect.x, sprite.rect.y).wrapping_add(moved_at).wrapping_add(rest)
}

/// Returns the number of moves from tick 0 to `tick`, with one move every `period` ticks.
fn moves(tick: i32, period: u16, phase: u16) -> u64 {
    match period {
        1 => tick as u64,
        period => (tick - i32::from(phase)).div_euclid(i32::from(period)) as u64,
    }
}

impl Contribution {
    /// Returns a sprite's hash contribution, given its previous contribution.
    #[inline(always)]
    pub(crate) fn renewed(self, sprite: &Sprite, slot: Slot, tables: &SideTables<'_>) -> Contribution {
        if sprite.flags & (flag::FREE | flag::CHANGED) == 0 {
            return Contribution::of(sprite, self.still);
        }
        match sprite.is(flag::FREE) {
            true => Contribution { word: 0, motion: FlightMotion::NONE, still: self.still },
            false => Contribution::fresh(sprite, slot, tables),
        }
    }

    /// Returns `true` if [`Contribution::follow`] suffices, which is the most frequent case. The sprite then
    /// neither was nor is in flight, and only values that change with movement have changed.
    #[inline(always)]
    pub(crate) fn is_of_one_that_only_moved(&self, sprite: &Sprite) -> bool {
        let on_foot = self.motion == FlightMotion::NONE && !sprite.flies();
        on_foot && sprite.flags & (flag::FREE | flag::CHANGED) == 0
    }

    /// Renews the contribution in place, like [`Contribution::renewed`]. Returns the sum's growth.
    #[inline(always)]
    pub(crate) fn follow(&mut self, sprite: &Sprite) -> Sum {
        let word = word(sprite);
        let by = word.wrapping_sub(std::mem::replace(&mut self.word, word));
        times(self.keys(), by)
    }

    /// Returns a sprite's hash contribution, computed from scratch.
    #[inline(never)]
    pub(crate) fn fresh(sprite: &Sprite, slot: Slot, tables: &SideTables<'_>) -> Contribution {
        Contribution::of(sprite, still_hash(sprite, slot, tables))
    }

    /// Returns a sprite's hash contribution, given its [`still_hash`].
    #[inline(always)]
    fn of(sprite: &Sprite, still: u64) -> Contribution {
        let word = word(sprite);
        if !sprite.flies() {
            return Contribution { word, motion: FlightMotion::NONE, still };
        }
        let motion = FlightMotion::of(sprite, ages(sprite));
        let moves = moves(sprite.moved_at, motion.period(), motion.phase());
        Contribution { word: word.wrapping_sub(motion.growth().wrapping_mul(moves)), motion, still }
    }

    /// Returns the sprite's keys. They are odd, so that no difference between two words is lost.
    #[inline(always)]
    fn keys(self) -> Sum {
        [self.still | 1, (self.still ^ self.still >> 32).wrapping_mul(SECRET[0]) | 1]
    }

    /// Returns the contribution to the sum at a tick.
    pub(crate) fn at(self, tick: i32) -> Sum {
        let grown = match self.motion {
            FlightMotion::NONE => 0,
            motion => motion.growth().wrapping_mul(moves(tick, motion.period(), motion.phase())),
        };
        times(self.keys(), self.word.wrapping_add(grown))
    }
}

/// Two numbers modulo 2⁶⁴, used instead of one number modulo 2¹²⁸.
pub(crate) type Sum = [u64; 2];

#[inline(always)]
fn times([low, high]: Sum, word: u64) -> Sum {
    [low.wrapping_mul(word), high.wrapping_mul(word)]
}

#[inline(always)]
pub(crate) fn plus(one: Sum, other: Sum) -> Sum {
    [one[0].wrapping_add(other[0]), one[1].wrapping_add(other[1])]
}

#[inline(always)]
pub(crate) fn minus(one: Sum, other: Sum) -> Sum {
    [one[0].wrapping_sub(other[0]), one[1].wrapping_sub(other[1])]
}

/// A linear hash class: the growth of all sprites in flight that move in the same ticks, times their keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct HashClass {
    pub(crate) period: u16,
    pub(crate) phase: u16,
    /// The number of sprites in the class.
    pub(crate) flights: u16,
    pub(crate) growth: Sum,
}

bytes_of_fields! { HashClass { period phase flights growth } }

impl HashClass {
    /// Returns the growth up to a tick.
    pub(crate) fn at(self, tick: i32) -> Sum {
        times(self.growth, moves(tick, self.period, self.phase))
    }
}

/// Replaces a hash contribution with a new contribution.
#[inline(always)]
pub(crate) fn exchange(
    old: Contribution,
    new: Contribution,
    sum: &mut Sum,
    hash_classes: &mut Vec<HashClass>,
) {
    if old.still == new.still {
        *sum = plus(*sum, times(new.keys(), new.word.wrapping_sub(old.word)));
    } else {
        *sum = plus(minus(*sum, times(old.keys(), old.word)), times(new.keys(), new.word));
    }
    if old.motion.0 | new.motion.0 != 0 && (old.still, old.motion) != (new.still, new.motion) {
        update_classes(old, new, hash_classes);
    }
}

/// Updates the linear hash classes, as part of [`exchange`].
#[inline(never)]
fn update_classes(old: Contribution, new: Contribution, hash_classes: &mut Vec<HashClass>) {
    if old.motion != FlightMotion::NONE {
        let at = class_of(old.motion, hash_classes);
        let class = &mut hash_classes[at];
        class.flights -= 1;
        class.growth = minus(class.growth, times(old.keys(), old.motion.growth()));
        if class.flights == 0 {
            hash_classes.swap_remove(at);
        }
    }
    if new.motion != FlightMotion::NONE {
        let at = class_of(new.motion, hash_classes);
        let class = &mut hash_classes[at];
        class.flights += 1;
        class.growth = plus(class.growth, times(new.keys(), new.motion.growth()));
    }
}

/// Returns the index of a motion's linear hash class, adding the class if it does not exist yet.
fn class_of(motion: FlightMotion, hash_classes: &mut Vec<HashClass>) -> usize {
    let (period, phase) = (motion.period(), motion.phase());
    hash_classes.iter().position(|class| (class.period, class.phase) == (period, phase)).unwrap_or_else(
        || {
            hash_classes.push(HashClass { period, phase, ..HashClass::default() });
            hash_classes.len() - 1
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::geometry::Direction;
    use crate::rules::SpriteType;
    use crate::world::NONE;
    use std::collections::BTreeSet;

    /// Returns the hash contribution of a sprite with this ID, which is at (x, y) and moves by (dx, dy) every three
    /// ticks, most recently in tick 5.
    fn contribution(id: u32, (x, y): (i32, i32), (dx, dy): (i32, i32)) -> Contribution {
        let sprite = Sprite {
            rect: Rect { x, y, w: 10, h: 10 },
            last_corner: (x - dx, y - dy),
            id,
            moved_at: 5,
            time_to_live: 0,
            count: 0,
            flags: 0,
            stype: SpriteType(0),
            overrides: 0,
            activity: 0,
            period: if (dx, dy) == (0, 0) { 0 } else { 3 },
            next: NONE,
            previous: NONE,
            cell_next: NONE,
            cell_previous: NONE,
            column: 0,
            row: 0,
        };
        let overrides = Overrides {
            orientation: Direction::NONE,
            speed: 1.0,
            health: 0,
            max_health: 0,
            start: 0,
            spawns: SpriteType(0),
            extra: NONE,
            holder: NONE,
        };
        Contribution::fresh(&sprite, 0, &SideTables { overrides: &[overrides], resized: &[] })
    }

    fn of(contributions: &[Contribution]) -> (Sum, Vec<HashClass>) {
        let (mut sum, mut hash_classes) = ([0; 2], Vec::new());
        contributions.iter().for_each(|&contribution| {
            exchange(Contribution::default(), contribution, &mut sum, &mut hash_classes)
        });
        (sum, hash_classes)
    }

    #[test]
    fn two_sprites_on_other_places_have_other_sums() {
        let places = || (0..8).flat_map(|x| (0..8).map(move |y| (10 * x, 10 * y)));
        let of_two = |one, other| of(&[contribution(1, one, (0, 0)), contribution(2, other, (0, 0))]).0;
        let both: Vec<Sum> = places().flat_map(|one| places().map(move |other| of_two(one, other))).collect();
        for half in [0, 1] {
            let distinct: BTreeSet<u64> = both.iter().map(|sum| sum[half]).collect();
            assert_eq!(distinct.len(), both.len());
        }
    }

    #[test]
    fn sums_do_not_depend_on_removed_contributions() {
        let (before, after) = (contribution(1, (3, 4), (0, 0)), contribution(1, (3, 4), (2, 0)));
        let (other, newborn) = (contribution(2, (-7, 50), (0, -3)), contribution(3, (0, 0), (0, 0)));
        let (mut sum, mut hash_classes) = of(&[before, other]);
        for (old, new) in [(before, after), (other, newborn)] {
            exchange(old, new, &mut sum, &mut hash_classes);
        }
        assert_eq!((sum, hash_classes), of(&[newborn, after]));
    }

    #[test]
    fn sprites_in_flight_contribute_their_extrapolated_position() {
        let flying = contribution(1, (30, 40), (-4, 2));
        for tick in 5..50 {
            let moves = (tick - 5) / 3;
            let landed = contribution(1, (30 - 4 * moves, 40 + 2 * moves), (0, 0));
            let later = LATER.wrapping_mul(3 * moves as u64);
            assert_eq!(
                flying.at(tick),
                Contribution { word: landed.word.wrapping_add(later), ..landed }.at(tick)
            );
        }
    }
}
