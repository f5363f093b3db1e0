//! The two hashes of a state, 128 bits each (`design.md` §4).
//!
//! [`State::state_hash`] covers all that can influence the future, chance and tick included. It is a sum over the sprites
//! that `step` keeps up to date as they change, plus a hash of the few numbers beside them.
//! [`State::search_key`] covers live behaviour only and is what transposition tables use (`search_key.rs`).

use crate::game::Game;
use crate::rest::mark;
use crate::state::{Extra, Share, Sprite, State, Target, flag};
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

    /// The two lanes as they are: where sums of hashes are hashed again.
    fn lanes(self) -> u128 {
        u128::from(self.high) << 64 | u128::from(self.low)
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

/// What seldom changes of a sprite, hashed.
#[inline(never)]
pub(crate) fn still_hash(sprite: &Sprite) -> u64 {
    let mut mixer = Mixer::new(u64::from(sprite.id));
    mixer.pair(two(sprite.rect.w, sprite.rect.h), two(sprite.last.w, sprite.last.h));
    mixer.pair(bits(sprite.orientation.x), bits(sprite.orientation.y));
    mixer.pair(bits(sprite.speed), two(sprite.health, sprite.max_health));
    mixer.pair(u64::from(sprite.spawns.0), sprite.start as u64);
    mixer.finish() as u64
}

/// The share of one sprite in the state hash, given its [`still_hash`].
///
/// A sprite that keeps moving as it moves has the same share tick after tick: with the tick, which is hashed by itself,
/// where it would have been at tick 0 says where it is.
#[inline(always)]
pub(crate) fn sprite_hash(sprite: &Sprite, still: u64, tick: i32) -> u128 {
    let &Sprite { rect, last, .. } = sprite;
    let tick = if sprite.rest == mark::FLYING { sprite.moved_at } else { tick };
    // Of the flags, those that are not transient are the lowest eight bits; headings are less than eight.
    let flags = sprite.flags & !flag::TRANSIENT & 0xFF;
    let kind = u32::from(sprite.stype.0) << 16 | u32::from(sprite.heading) << 8 | flags;
    // When it moved last matters only where a cooldown may hold it up, or where that is its age.
    let moved_at = if sprite.is(flag::BRISK) && !sprite.is(flag::FROZEN) { 0 } else { sprite.moved_at };
    let (dx, dy) = (rect.x.wrapping_sub(last.x), rect.y.wrapping_sub(last.y));
    let origin = |at: i32, by: i32| at.wrapping_sub(by.wrapping_mul(tick));
    let mut mixer = Mixer::new(still);
    mixer.pair(two(origin(rect.x, dx), origin(rect.y, dy)), two(dx, dy));
    mixer.pair(two(moved_at, kind as i32), two(sprite.count, sprite.time_to_live));
    mixer.lanes()
}

/// The share of a sprite, given what it was of it that seldom changes.
#[inline(always)]
fn share_of(sprite: &Sprite, still: u64, tick: i32) -> Share {
    if sprite.is(flag::GONE) {
        return Share::new(0, still);
    }
    let still = if sprite.is(flag::CHANGED) { still_hash(sprite) } else { still };
    Share::new(sprite_hash(sprite, still, tick), still)
}

impl State {
    /// The hash of all that can influence the future. Cost: O(sprites changed since [`State::settle_hash`]).
    pub fn state_hash(&self) -> StateHash {
        let mut sum = self.sprite_hash;
        for &slot in &self.stale {
            let (sprite, share) = (self.sprite(slot), self.shares[usize::from(slot)]);
            sum =
                sum.wrapping_sub(share.hash()).wrapping_add(share_of(sprite, share.still, self.tick).hash());
        }
        let memory = if self.memory_is_stale { self.hash_memory() } else { self.memory_hash };
        self.with_globals(sum, memory)
    }

    /// Renews the running hash, so that [`State::state_hash`] need not look at what changed since the last time.
    ///
    /// Stepping does not do so by itself: planners, which ask for few hashes, do not pay for all. Cost: O(sprites changed
    /// since the last time).
    pub fn settle_hash(&mut self) {
        let State { sprites, shares, stale, sprite_hash, tick, .. } = self;
        let mut sum = *sprite_hash;
        for &slot in &*stale {
            let (sprite, share) = (&mut sprites[usize::from(slot)], &mut shares[usize::from(slot)]);
            let old = std::mem::replace(share, share_of(sprite, share.still, *tick));
            sprite.flags &= !(flag::STALE | flag::CHANGED);
            sum = sum.wrapping_sub(old.hash()).wrapping_add(share.hash());
        }
        *sprite_hash = sum;
        stale.clear();
        if self.memory_is_stale {
            self.memory_hash = self.hash_memory();
            self.memory_is_stale = false;
        }
    }

    /// The same, computed from nothing: what tests hold [`State::state_hash`] against. Cost: O(sprites).
    pub fn state_hash_from_scratch(&self, game: &Game) -> StateHash {
        let sprites = game.sprite_types().flat_map(|stype| self.slots(stype)).map(|slot| self.sprite(slot));
        let shares = sprites.map(|sprite| sprite_hash(sprite, still_hash(sprite), self.tick));
        self.with_globals(shares.fold(0u128, u128::wrapping_add), self.hash_memory())
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

    fn with_globals(&self, sprites: u128, memory: u64) -> StateHash {
        let mut mixer = Mixer::new(0x5374_6174);
        mixer.pair(sprites as u64, (sprites >> 64) as u64);
        mixer.pair(two(self.tick, self.messages as i32), self.score as u64);
        mixer.pair(self.chance.state(), two(self.next_id as i32, self.population));
        // No sprite has the largest number as its id.
        let avatar = u64::from(self.avatar_id().unwrap_or(u32::MAX));
        let few = self.outcome_code() << 1 | u64::from(self.can_end);
        mixer.pair(avatar << 32 | few << 24 | self.timers.len() as u64, memory);
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
