//! The two hashes of a state, 128 bits each (`docs/lab/decisions/0004-state-as-flat-data.md`).
//!
//! [`World::state_hash`] covers all data that can influence the future, including the random number generator
//! and the tick. The state hash consists of a sum over the sprites, which `step` updates as they change, and
//! a hash of the few other numbers. [`State::search_key`](crate::State::search_key) covers only the part that
//! can affect later steps, for transposition tables (`search_key.rs`).

pub(crate) mod contribution;

use super::{Extra, NONE, Target, World, flag};
use crate::rules::SpriteType;
use contribution::{Contribution, SideTables, Sum, exchange, minus, plus};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use smallvec::SmallVec;
use std::fmt;

/// A short list that is sorted before hashing.
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
                let number = u128::from_str_radix(&text, 16).ok();
                // Each hash has exactly one valid spelling.
                number.map($name).filter(|hash| hash.to_string() == text).ok_or_else(|| {
                    serde::de::Error::custom(format!("`{text}` is not 32 hexadecimal digits"))
                })
            }
        }
    };
}

hash_type! {
    /// A state's hash. Equal states have equal hashes. Omits values that matter only for images or
    /// bookkeeping.
    StateHash
}
hash_type! {
    /// A hash of the part of a state that can affect later steps. States with equal keys have equal keys and
    /// outcomes after the same actions.
    SearchKey
}

/// A hasher that absorbs 64-bit words into two accumulators of folded 128-bit products (the wyhash
/// construction, with two secrets).
pub(crate) struct Mixer {
    low: u64,
    high: u64,
}

pub(crate) const SECRET: [u64; 4] =
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

pub(crate) fn fold(a: u64, b: u64) -> u64 {
    let wide = u128::from(a) * u128::from(b);
    (wide as u64) ^ ((wide >> 64) as u64) ^ a.rotate_left(32)
}

pub(crate) fn two(a: i32, b: i32) -> u64 {
    u64::from(a as u32) << 32 | u64::from(b as u32)
}

/// Returns a double's bits. Every NaN is replaced by one fixed NaN, because NaN bits differ between machines.
pub(crate) fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}

/// A sum of products of words and keys (after NH by Black and others, "UMAC: fast and secure message
/// authentication", 1999), with half the multiplications of [`Mixer`]. The result must be mixed once more.
#[derive(Clone, Copy)]
pub(crate) struct Products(u128);

impl Products {
    pub(crate) const NONE: Products = Products(0);

    #[inline(always)]
    pub(crate) fn and(self, a: u64, b: u64, keys: [u64; 2]) -> Products {
        Products(self.0.wrapping_add(u128::from(a ^ keys[0]) * u128::from(b ^ keys[1])))
    }

    #[inline(always)]
    pub(crate) fn halves(self) -> (u64, u64) {
        (self.0 as u64, (self.0 >> 64) as u64)
    }
}

/// The keys for the products, by position. They are arbitrary constants: the fractional parts of the square
/// roots of the first primes.
pub(crate) const KEYS: [[u64; 2]; 4] = [
    [0x6A09_E667_F3BC_C908, 0xBB67_AE85_84CA_A73B],
    [0x3C6E_F372_FE94_F82B, 0xA54F_F53A_5F1D_36F1],
    [0x510E_527F_ADE6_82D1, 0x9B05_688C_2B3E_6C1F],
    [0x1F83_D9AB_FB41_BD6B, 0x5BE0_CD19_137E_2179],
];

impl World {
    /// Returns the hash of all data that can influence the future. Cost: O(sprites changed since
    /// [`World::settle_hash`]).
    pub(crate) fn state_hash(&self) -> StateHash {
        let mut sum = self.hash_classes.iter().fold(self.sum, |sum, class| plus(sum, class.at(self.tick)));
        for &slot in &self.dirty {
            let contribution = self.contributions[usize::from(slot)];
            let new = contribution.renewed(self.sprite(slot), slot, &self.side_tables());
            sum = plus(minus(sum, contribution.at(self.tick)), new.at(self.tick));
        }
        let memory = if self.memory_is_dirty { self.hash_memory() } else { self.memory_hash };
        self.with_globals(sum, memory)
    }

    /// Updates the running hash, so that [`World::state_hash`] does not have to process earlier changes
    /// again.
    ///
    /// Stepping does not update the running hash, because planners need few hashes and should not pay for one
    /// in every step. Cost: O(sprites changed since the last call).
    pub(crate) fn settle_hash(&mut self) {
        let World { sprites, contributions, dirty, sum, hash_classes, overrides, resized, .. } = self;
        let (sprites, contributions, mut running) = (&mut sprites[..], &mut contributions[..], *sum);
        let tables = SideTables { overrides, resized };
        for &slot in &*dirty {
            let (sprite, contribution) =
                (&mut sprites[usize::from(slot)], &mut contributions[usize::from(slot)]);
            if contribution.is_of_one_that_only_moved(sprite) {
                running = plus(running, contribution.follow(sprite));
            } else {
                let new = contribution.renewed(sprite, slot, &tables);
                let old = std::mem::replace(contribution, new);
                exchange(old, new, &mut running, hash_classes);
            }
            sprite.flags &= !(flag::DIRTY | flag::CHANGED);
        }
        *sum = running;
        dirty.clear();
        if self.memory_is_dirty {
            self.memory_hash = self.hash_memory();
            self.memory_is_dirty = false;
        }
    }

    /// Returns the slots of the sprites that have changed since the last call of [`World::settle_hash`]. Foreseen
    /// moves, which no tick computes one by one, are not recorded.
    #[inline(always)]
    pub(crate) fn dirty(&self) -> &[super::Slot] {
        &self.dirty
    }

    /// Computes the same hash as [`World::state_hash`] from scratch. Cost: O(sprites).
    pub(crate) fn state_hash_from_scratch(&self) -> StateHash {
        let types = || (0..self.groups.len() as u16).map(SpriteType);
        let slots = types().flat_map(|stype| self.slots(stype)).map(|slot| (slot, self.sprite(slot)));
        let scenery = types().flat_map(|stype| self.scenery_of(stype));
        let sprites = slots.chain(scenery.map(|sprite| (NONE, sprite)));
        let contributions = sprites
            .map(|(slot, sprite)| Contribution::fresh(sprite, slot, &self.side_tables()).at(self.tick));
        self.with_globals(contributions.fold([0; 2], plus), self.hash_memory())
    }

    /// Hashes the effects' memory, and the types that have ever had a sprite.
    fn hash_memory(&self) -> u64 {
        let mut mixer = Mixer::new(0x4D65_6D6F);
        for bytes in [&self.memory, &self.templates] {
            for (chunk, bytes) in bytes.chunks(8).enumerate() {
                mixer.pair(chunk as u64, bytes.iter().fold(0, |word, &byte| word << 8 | u64::from(byte)));
            }
        }
        mixer.finish() as u64
    }

    #[inline(always)]
    fn with_globals(&self, [low, high]: Sum, memory: u64) -> StateHash {
        // No sprite has the highest possible ID.
        let avatar = u64::from(self.avatar_id().unwrap_or(u32::MAX));
        let outcome = if self.is_over() { self.outcome_code() } else { 0 };
        let few = outcome << 1 | u64::from(self.can_end);
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
        use crate::rules::Outcome;
        match self.outcome {
            Outcome::Ongoing => 0,
            Outcome::Won => 1,
            Outcome::Lost => 2,
            Outcome::Ended => 3,
            Outcome::Stopped(limit) => 4 + limit as u64,
        }
    }
}
