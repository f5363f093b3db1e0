//! The two hashes of a state, 128 bits each (`design.md` §4).
//!
//! [`State::state_hash`] covers all that can influence the future, chance and tick included. It is a sum over the sprites
//! that `step` keeps up to date as they change, plus a hash of the few numbers beside them.
//! [`State::search_key`] covers live behaviour only and is what transposition tables use (`search_key.rs`).

use crate::game::Game;
use crate::state::{Extra, Sprite, State, Target, flag};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

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

/// The share of one sprite in the state hash.
pub(crate) fn sprite_hash(sprite: &Sprite) -> u128 {
    let mut mixer = Mixer::new(u64::from(sprite.id));
    let kind = i32::from(sprite.stype.0) << 16 | i32::from(sprite.flags & !flag::TRANSIENT);
    mixer.pair(two(sprite.rect.x, sprite.rect.y), two(sprite.rect.w, sprite.rect.h));
    mixer.pair(two(sprite.last.x, sprite.last.y), two(sprite.last.w, sprite.last.h));
    mixer.pair(bits(sprite.orientation.x), bits(sprite.orientation.y));
    mixer.pair(bits(sprite.speed), two(sprite.moved_at, kind));
    mixer.pair(two(sprite.health, sprite.max_health), two(sprite.time_to_live, i32::from(sprite.heading)));
    mixer.pair(two(sprite.count, sprite.start), u64::from(sprite.spawns.0));
    mixer.finish()
}

impl State {
    /// The hash of all that can influence the future. Cost: a few numbers; the sprites are kept up to date by `step`.
    pub fn state_hash(&self) -> StateHash {
        self.with_globals(self.sprite_hash)
    }

    /// The same, computed from nothing: what tests hold [`State::state_hash`] against. Cost: O(sprites).
    pub fn state_hash_from_scratch(&self, game: &Game) -> StateHash {
        let slots = game.sprite_types().flat_map(|stype| self.slots(stype));
        let sum = slots.map(|slot| sprite_hash(self.sprite(slot))).fold(0u128, u128::wrapping_add);
        self.with_globals(sum)
    }

    fn with_globals(&self, sprites: u128) -> StateHash {
        debug_assert!(self.stale.is_empty(), "a state is hashed between steps");
        let mut mixer = Mixer::new(0x5374_6174);
        mixer.pair(sprites as u64, (sprites >> 64) as u64);
        mixer.pair(two(self.tick, self.messages as i32), self.score as u64);
        mixer.pair(self.chance.state(), two(self.next_id as i32, self.population));
        mixer.pair(self.avatar_id().map_or(u64::MAX, u64::from), self.outcome_code());
        let mut held: Vec<_> = self.held.iter().map(|held| (self.sprite(held.holder).id, *held)).collect();
        held.sort_unstable_by_key(|(id, held)| (*id, held.resource));
        for (id, held) in held {
            mixer.pair(u64::from(id), two(i32::from(held.resource.0), held.amount));
        }
        let mut extras: Vec<_> =
            self.extras.iter().map(|extra| (self.sprite(extra.holder).id, extra)).collect();
        extras.sort_unstable_by_key(|(id, _)| *id);
        for (id, extra) in extras {
            mixer.pair(u64::from(id), u64::from(extra.block_time as u32));
            self.all_words_of_extra(extra, &mut mixer);
        }
        let mut replaced: Vec<_> =
            self.replaced.iter().map(|one| (self.sprite(one.holder).id, one.place, one.stype.0)).collect();
        replaced.sort_unstable();
        for (id, place, stype) in replaced {
            mixer.pair(u64::from(id) << 32 | u64::from(place), u64::from(stype));
        }
        for timer in self.timers.iter().rev() {
            mixer.pair(u64::from(timer.timed), timer.due as u64);
        }
        mixer.pair(self.jumps.state(), (self.timers.len() as u64) << 1 | u64::from(self.can_end));
        for (chunk, bytes) in self.memory.chunks(8).enumerate() {
            mixer.pair(chunk as u64, bytes.iter().fold(0, |word, &byte| word << 8 | u64::from(byte)));
        }
        for (stype, _) in self.templates.iter().enumerate().filter(|(_, made)| **made) {
            mixer.pair(stype as u64, 1);
        }
        for (at, &counter) in self.counters.iter().enumerate() {
            mixer.pair(at as u64, u64::from(counter as u32) | 1 << 32);
        }
        StateHash(mixer.finish())
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
