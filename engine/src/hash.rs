//! The two hashes of a state, 128 bits each (`design.md` §4).
//!
//! [`State::state_hash`] covers all that can influence the future, chance and tick included. It is a sum over the sprites
//! that `step` keeps up to date as they change, plus a hash of the few numbers beside them.
//! [`State::search_key`] covers live behaviour only and is what transposition tables use (`search_key.rs`).

use crate::game::Game;
use crate::rest::mark;
use crate::state::{Extra, Sprite, State, Target, flag};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use smallvec::SmallVec;
use std::fmt;

/// What is sorted before it is hashed; seldom more than a few.
type Few<T> = SmallVec<[T; 4]>;

macro_rules! hash_type {
    ($(#[$doc:meta])* $name:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub u128);

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "{:032x}", self.0)
            }
        }

        impl fmt::Debug for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                fmt::Display::fmt(self, f)
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                serializer.collect_str(self)
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<$name, D::Error> {
                let text = String::deserialize(deserializer)?;
                let bytes: [u8; 16] = crate::digest::parse_hex(&text)
                    .map_err(|_| serde::de::Error::custom(format!("`{text}` is not 32 hexadecimal digits")))?;
                Ok($name(u128::from_be_bytes(bytes)))
            }
        }
    };
}

hash_type! {
    /// Equal states have equal hashes; what is only picture or book-keeping is left out.
    StateHash
}
hash_type! {
    /// Equal keys mean equal keys, and equal outcomes, after any same actions.
    SearchKey
}

/// Absorbs 64-bit words; two lanes of folded 128-bit products (the construction of wyhash, two secrets).
pub(crate) struct Mixer {
    low: u64,
    high: u64,
}

const SECRET: [u64; 4] =
    [0x9E37_79B9_7F4A_7C15, 0xC2B2_AE3D_27D4_EB4F, 0x1656_67B1_9E37_79F9, 0xD6E8_FEB8_6659_FD93];

impl Mixer {
    pub(crate) fn new(tag: u64) -> Mixer {
        Mixer { low: SECRET[0] ^ tag, high: SECRET[1] ^ tag }
    }

    pub(crate) fn pair(&mut self, a: u64, b: u64) {
        self.low = fold(self.low ^ a, SECRET[2] ^ b);
        self.high = fold(self.high ^ b, SECRET[3] ^ a);
    }

    pub(crate) fn finish(self) -> u128 {
        let low = fold(self.low ^ SECRET[3], self.high ^ SECRET[2]);
        let high = fold(self.high ^ SECRET[0], self.low ^ SECRET[1]);
        u128::from(high) << 64 | u128::from(low)
    }
}

fn fold(a: u64, b: u64) -> u64 {
    let wide = u128::from(a) * u128::from(b);
    (wide as u64) ^ ((wide >> 64) as u64) ^ a.rotate_left(32)
}

pub(crate) fn two(a: i32, b: i32) -> u64 {
    u64::from(a as u32) << 32 | u64::from(b as u32)
}

/// The bits of a double; what is no number has other bits on other machines.
pub(crate) fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}

/// Sums of products of words with keys in them (after NH of Black and others, "UMAC: fast and secure message authentication",
/// 1999): half the multiplications of [`Mixer`]. What comes out is to be mixed once more.
#[derive(Clone, Copy)]
struct Products(u128);

impl Products {
    const NONE: Products = Products(0);

    #[inline(always)]
    fn and(self, a: u64, b: u64, keys: [u64; 2]) -> Products {
        Products(self.0.wrapping_add(u128::from(a ^ keys[0]) * u128::from(b ^ keys[1])))
    }

    #[inline(always)]
    fn halves(self) -> (u64, u64) {
        (self.0 as u64, (self.0 >> 64) as u64)
    }
}

/// Keys of products, by their place: the fractions of the square roots of the first primes, as good as drawn.
const KEYS: [[u64; 2]; 4] = [
    [0x6A09_E667_F3BC_C908, 0xBB67_AE85_84CA_A73B],
    [0x3C6E_F372_FE94_F82B, 0xA54F_F53A_5F1D_36F1],
    [0x510E_527F_ADE6_82D1, 0x9B05_688C_2B3E_6C1F],
    [0x1F83_D9AB_FB41_BD6B, 0x5BE0_CD19_137E_2179],
];

/// What seldom changes of a sprite, hashed.
///
/// The last rectangle becomes the rectangle before the next tick looks at it, but for sprites that are not updated.
#[inline(never)]
fn still_hash(sprite: &Sprite) -> u64 {
    let spawns = u64::from(sprite.spawns.0) << 32 | u64::from(sprite.id);
    let mut products = Products::NONE
        .and(two(sprite.rect.w, sprite.rect.h), spawns, KEYS[0])
        .and(bits(sprite.orientation.x), bits(sprite.orientation.y), KEYS[1])
        .and(bits(sprite.speed), two(sprite.health, sprite.max_health), KEYS[2]);
    if sprite.start != 0 {
        products = products.and(sprite.start as u64, 0, KEYS[3]);
    }
    if sprite.is(flag::FROZEN) {
        let last = sprite.last;
        products = products.and(two(last.x, last.y), two(last.w, last.h), [KEYS[3][1], KEYS[0][0]]);
    }
    let (low, high) = products.halves();
    fold(low ^ SECRET[0], high ^ SECRET[1])
}

/// What a sprite adds to the hash of its state when it was last settled: `word`, and what it has grown by since, times keys of
/// the sprite's own.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Share {
    /// Where it is and what changes with moving, as one number; of a sprite in flight, before its first move from tick 0 on.
    /// 0 if the slot is free.
    pub(crate) word: u64,
    /// How the word grows by itself.
    pub(crate) steady: Steady,
    /// What seldom changes of the sprite, hashed: no other sprite has the same.
    pub(crate) still: u64,
}

/// What a pixel down, and a tick later, are in [`Share::word`], when a pixel to the right is 1.
const DOWN: u64 = 0x9FB2_1C65_1E98_DF25;
const LATER: u64 = 0xD1B5_4A32_D192_ED03;

fn point(x: i32, y: i32) -> u64 {
    (x as u64).wrapping_add((y as u64).wrapping_mul(DOWN))
}

/// How a sprite in flight goes on, in one number: pixels right and down that it moves, every so many ticks, in which of them, and
/// whether it matters when. 0 for all others.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Steady(pub(crate) u64);

impl Steady {
    const NONE: Steady = Steady(0);
    /// The bit that says that it matters when the sprite moved last.
    const AGES: u64 = 1 << 63;

    fn of(sprite: &Sprite, ages: bool) -> Steady {
        let by = |at: i32, last: i32| u64::from(at.wrapping_sub(last) as u16);
        let phase = match sprite.period {
            1 => 0,
            period => sprite.moved_at.rem_euclid(i32::from(period)) as u64,
        };
        let ages = if ages { Steady::AGES } else { 0 };
        let ticks = ages | phase << 48 | u64::from(sprite.period) << 32;
        Steady(ticks | by(sprite.rect.y, sprite.last.y) << 16 | by(sprite.rect.x, sprite.last.x))
    }

    fn period(self) -> u16 {
        (self.0 >> 32) as u16
    }

    fn phase(self) -> u16 {
        ((self.0 & !Steady::AGES) >> 48) as u16
    }

    /// By how much the word grows in a move.
    fn growth(self) -> u64 {
        let by = point(i32::from(self.0 as i16), i32::from((self.0 >> 16) as i16));
        let later = if self.0 & Steady::AGES == 0 { 0 } else { LATER.wrapping_mul(u64::from(self.period())) };
        by.wrapping_add(later)
    }
}

/// How many moves there were from tick 0 to `tick`, of one every `period` ticks.
fn moves(tick: i32, period: u16, phase: u16) -> u64 {
    match period {
        1 => tick as u64,
        period => (tick - i32::from(phase)).div_euclid(i32::from(period)) as u64,
    }
}

impl Share {
    /// The share of a sprite, given what it was.
    #[inline(always)]
    fn renewed(self, sprite: &Sprite) -> Share {
        if sprite.flags & (flag::GONE | flag::CHANGED) == 0 {
            return Share::of(sprite, self.still);
        }
        match sprite.is(flag::GONE) {
            true => Share { word: 0, steady: Steady::NONE, still: self.still },
            false => Share::of(sprite, still_hash(sprite)),
        }
    }

    /// The share of a sprite, given its [`still_hash`].
    #[inline(always)]
    fn of(sprite: &Sprite, still: u64) -> Share {
        let look =
            u64::from(sprite.stype.0) << 48 | u64::from(sprite.heading) << 32 | u64::from(sprite.flags);
        let kind = look & (!0 << 32 | u64::from(flag::LASTING));
        let rest = fold(kind ^ SECRET[3], two(sprite.count, sprite.time_to_live) ^ SECRET[1]);
        // When it moved last matters only where a cooldown may hold it up, or where that is its age.
        let ages = sprite.flags & (flag::BRISK | flag::FROZEN) != flag::BRISK;
        let moved_at = if ages { LATER.wrapping_mul(sprite.moved_at as u64) } else { 0 };
        let word = point(sprite.rect.x, sprite.rect.y).wrapping_add(moved_at).wrapping_add(rest);
        if sprite.rest != mark::FLYING {
            return Share { word, steady: Steady::NONE, still };
        }
        let steady = Steady::of(sprite, ages);
        let moves = moves(sprite.moved_at, steady.period(), steady.phase());
        Share { word: word.wrapping_sub(steady.growth().wrapping_mul(moves)), steady, still }
    }

    /// The keys: odd, so that no difference of two words is lost.
    #[inline(always)]
    fn keys(self) -> [u64; 2] {
        [self.still | 1, (self.still ^ self.still >> 32).wrapping_mul(SECRET[0]) | 1]
    }

    /// Its part of the sum of a tick.
    fn at(self, tick: i32) -> [u64; 2] {
        let grown = match self.steady {
            Steady::NONE => 0,
            steady => steady.growth().wrapping_mul(moves(tick, steady.period(), steady.phase())),
        };
        times(self.keys(), self.word.wrapping_add(grown))
    }
}

/// Two numbers modulo 2⁶⁴ that take the place of one modulo 2¹²⁸.
type Sum = [u64; 2];

#[inline(always)]
fn times(keys: Sum, word: u64) -> Sum {
    keys.map(|key| key.wrapping_mul(word))
}

#[inline(always)]
fn plus(one: Sum, other: Sum) -> Sum {
    [one[0].wrapping_add(other[0]), one[1].wrapping_add(other[1])]
}

#[inline(always)]
fn minus(one: Sum, other: Sum) -> Sum {
    [one[0].wrapping_sub(other[0]), one[1].wrapping_sub(other[1])]
}

/// The growth of all sprites in flight that move in the same ticks, times their keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Tide {
    pub(crate) period: u16,
    pub(crate) phase: u16,
    /// How many sprites.
    pub(crate) flights: u16,
    pub(crate) growth: Sum,
}

/// Puts a share in the place of another.
#[inline(always)]
fn exchange(old: Share, new: Share, sum: &mut Sum, tides: &mut Vec<Tide>) {
    if old.still == new.still {
        *sum = plus(*sum, times(new.keys(), new.word.wrapping_sub(old.word)));
    } else {
        *sum = plus(minus(*sum, times(old.keys(), old.word)), times(new.keys(), new.word));
    }
    if old.steady.0 | new.steady.0 != 0 && (old.still, old.steady) != (new.still, new.steady) {
        turn(old, new, tides);
    }
}

/// The part of it that is about the tides.
#[inline(never)]
fn turn(old: Share, new: Share, tides: &mut Vec<Tide>) {
    if old.steady != Steady::NONE {
        let at = tide_of(old.steady, tides);
        let tide = &mut tides[at];
        tide.flights -= 1;
        tide.growth = minus(tide.growth, times(old.keys(), old.steady.growth()));
        if tide.flights == 0 {
            tides.swap_remove(at);
        }
    }
    if new.steady != Steady::NONE {
        let at = tide_of(new.steady, tides);
        let tide = &mut tides[at];
        tide.flights += 1;
        tide.growth = plus(tide.growth, times(new.keys(), new.steady.growth()));
    }
}

/// The place of a tide, made if there is none yet.
fn tide_of(steady: Steady, tides: &mut Vec<Tide>) -> usize {
    let (period, phase) = (steady.period(), steady.phase());
    tides.iter().position(|tide| (tide.period, tide.phase) == (period, phase)).unwrap_or_else(|| {
        tides.push(Tide { period, phase, ..Tide::default() });
        tides.len() - 1
    })
}

impl State {
    /// The hash of all that can influence the future. Cost: O(sprites changed since [`State::settle_hash`]).
    pub fn state_hash(&self) -> StateHash {
        let mut sum = self.tides.iter().fold(self.sum, |sum, tide| {
            plus(sum, times(tide.growth, moves(self.tick, tide.period, tide.phase)))
        });
        for &slot in &self.stale {
            let share = self.shares[usize::from(slot)];
            let new = share.renewed(self.sprite(slot));
            sum = plus(minus(sum, share.at(self.tick)), new.at(self.tick));
        }
        let memory = if self.memory_is_stale { self.hash_memory() } else { self.memory_hash };
        self.with_globals(sum, memory)
    }

    /// Renews the running sum, so that [`State::state_hash`] need not look at what changed since the last time.
    ///
    /// Stepping does not do so by itself: planners, which ask for few hashes, do not pay for all. Cost: O(sprites changed
    /// since the last time).
    pub fn settle_hash(&mut self) {
        let State { sprites, shares, stale, sum, tides, .. } = self;
        let (sprites, shares, mut running) = (&mut sprites[..], &mut shares[..], *sum);
        for &slot in &*stale {
            let (sprite, share) = (&mut sprites[usize::from(slot)], &mut shares[usize::from(slot)]);
            let new = share.renewed(sprite);
            let old = std::mem::replace(share, new);
            exchange(old, new, &mut running, tides);
            sprite.flags &= !(flag::STALE | flag::CHANGED);
        }
        *sum = running;
        stale.clear();
        if self.memory_is_stale {
            self.memory_hash = self.hash_memory();
            self.memory_is_stale = false;
        }
    }

    /// The same, computed from nothing: what tests hold [`State::state_hash`] against. Cost: O(sprites).
    pub fn state_hash_from_scratch(&self, game: &Game) -> StateHash {
        let sprites = game.sprite_types().flat_map(|stype| self.slots(stype)).map(|slot| self.sprite(slot));
        let shares = sprites.map(|sprite| Share::of(sprite, still_hash(sprite)).at(self.tick));
        self.with_globals(shares.fold([0; 2], plus), self.hash_memory())
    }

    /// What effects remember, and of which types there was a sprite.
    fn hash_memory(&self) -> u64 {
        let mut mixer = Mixer::new(0x4D65_6D6F);
        for bytes in [&self.memory, &self.templates] {
            for (chunk, bytes) in bytes.chunks(8).enumerate() {
                mixer.pair(chunk as u64, bytes.iter().fold(0, |word, &byte| word << 8 | u64::from(byte)));
            }
        }
        mixer.finish() as u64
    }

    fn with_globals(&self, [low, high]: Sum, memory: u64) -> StateHash {
        // No sprite has the largest number as its id.
        let avatar = u64::from(self.avatar_id().unwrap_or(u32::MAX));
        let few = self.outcome_code() << 1 | u64::from(self.can_end);
        let (low, high) = Products::NONE
            .and(low, high, KEYS[0])
            .and(two(self.tick, self.messages as i32), self.score as u64, KEYS[1])
            .and(self.chance.state(), two(self.next_id as i32, self.population), KEYS[2])
            .and(avatar << 32 | few << 24 | self.timers.len() as u64, memory, KEYS[3])
            .halves();
        let mut mixer = Mixer { low, high };
        if self.jumps != self.chance {
            mixer.pair(self.jumps.state(), 0);
        }
        let others = self.held.len() | self.extras.len() | self.replaced.len();
        if others | self.timers.len() | self.counters.len() != 0 {
            self.words_of_others(&mut mixer);
        }
        StateHash(mixer.finish())
    }

    #[inline(never)]
    fn words_of_others(&self, mixer: &mut Mixer) {
        if !self.held.is_empty() {
            self.held_words(mixer);
        }
        if !self.extras.is_empty() || !self.replaced.is_empty() {
            self.words_of_extras(mixer);
        }
        for timer in self.timers.iter().rev() {
            mixer.pair(u64::from(timer.timed), timer.due as u64);
        }
        for (at, &counter) in self.counters.iter().enumerate() {
            mixer.pair(at as u64, u64::from(counter as u32) | 1 << 32);
        }
    }

    fn held_words(&self, mixer: &mut Mixer) {
        let held = self.held.iter().map(|held| (self.sprite(held.holder).id, held.resource.0, held.amount));
        let mut held: Few<_> = held.collect();
        held.sort_unstable();
        for (id, resource, amount) in held {
            mixer.pair(u64::from(id), two(i32::from(resource), amount));
        }
    }

    fn words_of_extras(&self, mixer: &mut Mixer) {
        if !self.extras.is_empty() {
            let extras = self.extras.iter().map(|extra| (self.sprite(extra.holder).id, extra));
            let mut extras: Few<_> = extras.collect();
            extras.sort_unstable_by_key(|(id, _)| *id);
            for (id, extra) in extras {
                mixer.pair(u64::from(id), u64::from(extra.block_time as u32));
                self.all_words_of_extra(extra, mixer);
            }
        }
        if !self.replaced.is_empty() {
            let replaced =
                self.replaced.iter().map(|one| (self.sprite(one.holder).id, one.place, one.stype.0));
            let mut replaced: Few<_> = replaced.collect();
            replaced.sort_unstable();
            for (id, place, stype) in replaced {
                mixer.pair(u64::from(id) << 32 | u64::from(place), u64::from(stype));
            }
        }
    }

    fn all_words_of_extra(&self, extra: &Extra, mixer: &mut Mixer) {
        mixer.pair(bits(extra.rotation), bits(extra.gravity));
        mixer.pair(bits(extra.facing.x), bits(extra.facing.y));
        let target = match extra.target {
            Target::None => (0, 0),
            Target::Sprite(slot) => (1, u64::from(self.sprite(slot).id)),
            Target::Gone(rect) => (two(rect.x, rect.y) | 1 << 63, two(rect.w, rect.h)),
        };
        mixer.pair(target.0, target.1);
        let known = extra.last_known.map_or((0, 0), |(x, y)| (1, two(x, y)));
        mixer.pair(known.0, known.1);
    }

    pub(crate) fn outcome_code(&self) -> u64 {
        use crate::game::Outcome;
        match self.outcome {
            Outcome::Ongoing => 0,
            Outcome::Won => 1,
            Outcome::Lost => 2,
            Outcome::Ended => 3,
            Outcome::Stopped(limit) => 4 + limit as u64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SpriteType;
    use crate::geometry::Rect;
    use crate::population::model;
    use std::collections::BTreeSet;
    use std::sync::LazyLock;

    static GAME: LazyLock<Game> = LazyLock::new(|| {
        let source = "BasicGame\n  SpriteSet\n    avatar > MovingAvatar\n  LevelMapping\n  InteractionSet\n  \
                      TerminationSet\n    Timeout limit=9 win=False\n";
        Game::from_source(source).unwrap()
    });

    /// A share of a sprite with that number, which is at (x, y) and moves by (dx, dy) every three ticks, the last time in tick 5.
    fn share(id: u32, (x, y): (i32, i32), (dx, dy): (i32, i32)) -> Share {
        let mut sprite = model(SpriteType(0), &GAME.0.types[0]);
        (sprite.id, sprite.moved_at, sprite.period, sprite.flags) = (id, 5, 3, 0);
        (sprite.rect, sprite.last) =
            (Rect { x, y, w: 10, h: 10 }, Rect { x: x - dx, y: y - dy, w: 10, h: 10 });
        if (dx, dy) != (0, 0) {
            sprite.rest = mark::FLYING;
        }
        Share::of(&sprite, still_hash(&sprite))
    }

    fn of(shares: &[Share]) -> (Sum, Vec<Tide>) {
        let (mut sum, mut tides) = ([0; 2], Vec::new());
        shares.iter().for_each(|&share| exchange(Share::default(), share, &mut sum, &mut tides));
        (sum, tides)
    }

    #[test]
    fn two_sprites_on_other_places_have_other_sums() {
        let places = || (0..8).flat_map(|x| (0..8).map(move |y| (10 * x, 10 * y)));
        let of_two = |one, other| of(&[share(1, one, (0, 0)), share(2, other, (0, 0))]).0;
        let both: Vec<Sum> = places().flat_map(|one| places().map(move |other| of_two(one, other))).collect();
        for half in [0, 1] {
            let distinct: BTreeSet<u64> = both.iter().map(|sum| sum[half]).collect();
            assert_eq!(distinct.len(), both.len());
        }
    }

    #[test]
    fn a_sum_does_not_remember_what_was_taken_out() {
        let (before, after) = (share(1, (3, 4), (0, 0)), share(1, (3, 4), (2, 0)));
        let (other, newborn) = (share(2, (-7, 50), (0, -3)), share(3, (0, 0), (0, 0)));
        let (mut sum, mut tides) = of(&[before, other]);
        for (old, new) in [(before, after), (other, newborn)] {
            exchange(old, new, &mut sum, &mut tides);
        }
        assert_eq!((sum, tides), of(&[newborn, after]));
    }

    #[test]
    fn what_flies_is_in_the_sum_where_it_has_come_to() {
        let flying = share(1, (30, 40), (-4, 2));
        for tick in 5..50 {
            let moves = (tick - 5) / 3;
            let landed = share(1, (30 - 4 * moves, 40 + 2 * moves), (0, 0));
            let later = LATER.wrapping_mul(3 * moves as u64);
            assert_eq!(flying.at(tick), Share { word: landed.word.wrapping_add(later), ..landed }.at(tick));
        }
    }
}
