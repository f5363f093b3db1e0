//! The two hashes of a state, 128 bits each (`design.md` §4).
//!
//! [`State::state_hash`] covers all that can influence the future, chance and tick included. It is a sum over the sprites
//! that `step` keeps up to date as they change, plus a hash of the few numbers beside them.
//! [`State::search_key`] covers live behaviour only and is what transposition tables use.

use crate::game::{Game, Rules};
use crate::ontology::class::SpriteClass;
use crate::state::{Extra, Sprite, State, Target, flag};
use crate::step::MAX_TICKS;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use smallvec::SmallVec;
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
struct Mixer {
    low: u64,
    high: u64,
}

const SECRET: [u64; 4] =
    [0x9E37_79B9_7F4A_7C15, 0xC2B2_AE3D_27D4_EB4F, 0x1656_67B1_9E37_79F9, 0xD6E8_FEB8_6659_FD93];

impl Mixer {
    fn new(tag: u64) -> Mixer {
        Mixer { low: SECRET[0] ^ tag, high: SECRET[1] ^ tag }
    }

    fn pair(&mut self, a: u64, b: u64) {
        self.low = fold(self.low ^ a, SECRET[2] ^ b);
        self.high = fold(self.high ^ b, SECRET[3] ^ a);
    }

    /// Sixteen bytes at a time; the length of the whole is not part of it.
    fn bytes(&mut self, bytes: &[u8]) {
        let word = |bytes: &[u8]| {
            let mut word = [0; 8];
            word[..bytes.len()].copy_from_slice(bytes);
            u64::from_le_bytes(word)
        };
        let (chunks, rest) = bytes.as_chunks::<16>();
        for chunk in chunks {
            let wide = u128::from_le_bytes(*chunk);
            self.pair(wide as u64, (wide >> 64) as u64);
        }
        if !rest.is_empty() {
            let (low, high) = rest.split_at(rest.len().min(8));
            self.pair(word(low), word(high));
        }
    }

    fn finish(self) -> u128 {
        let low = fold(self.low ^ SECRET[3], self.high ^ SECRET[2]);
        let high = fold(self.high ^ SECRET[0], self.low ^ SECRET[1]);
        u128::from(high) << 64 | u128::from(low)
    }
}

fn fold(a: u64, b: u64) -> u64 {
    let wide = u128::from(a) * u128::from(b);
    (wide as u64) ^ ((wide >> 64) as u64) ^ a.rotate_left(32)
}

fn two(a: i32, b: i32) -> u64 {
    u64::from(a as u32) << 32 | u64::from(b as u32)
}

/// The bits of a double; what is no number has other bits on other machines.
fn bits(value: f64) -> u64 {
    if value.is_nan() { f64::NAN.to_bits() } else { value.to_bits() }
}

/// The share of one sprite in the state hash: a multilinear hash of its fields (Carter and Wegman 1979; Lemire and Kaser
/// 2014), folded, so that the sum over all sprites does not cancel.
///
/// A sprite that keeps moving as it moves has the same share tick after tick: with the tick, which is hashed by itself,
/// where it would have been at tick 0 says where it is.
pub(crate) fn sprite_hash(sprite: &Sprite, tick: i32) -> u128 {
    let Sprite { rect, last, .. } = *sprite;
    let kind = i32::from(sprite.stype.0) << 16 | (sprite.flags & !flag::TRANSIENT) as i32;
    // When it moved last matters only where a cooldown may hold it up, or where that is its age.
    let moved_at = if sprite.is(flag::BRISK) && !sprite.is(flag::FROZEN) { 0 } else { sprite.moved_at };
    let (dx, dy) = (rect.x.wrapping_sub(last.x), rect.y.wrapping_sub(last.y));
    let origin = |at: i32, by: i32| at.wrapping_sub(by.wrapping_mul(tick));
    let words = [
        two(origin(rect.x, dx), origin(rect.y, dy)),
        two(dx, dy),
        two(rect.w, rect.h),
        two(last.w, last.h),
        bits(sprite.orientation.x),
        bits(sprite.orientation.y),
        bits(sprite.speed),
        two(moved_at, kind),
        two(sprite.health, sprite.max_health),
        two(sprite.time_to_live, i32::from(sprite.heading)),
        two(sprite.count, sprite.start),
        u64::from(sprite.id) << 16 | u64::from(sprite.spawns.0),
    ];
    let mut sum = u128::from(SECRET[0]);
    for (word, key) in words.into_iter().zip(KEYS) {
        sum = sum.wrapping_add(u128::from(word).wrapping_mul(key));
    }
    let (low, high) = (sum as u64, (sum >> 64) as u64);
    let fine = |a: u64, b: u64| u128::from(fold(a ^ SECRET[2], b ^ SECRET[3]));
    fine(low, high) << 64 | fine(high.rotate_left(32) ^ SECRET[1], low)
}

/// One key a word of a sprite: odd, from the digits of π.
const KEYS: [u128; 12] = [
    0x243F_6A88_85A3_08D3_1319_8A2E_0370_7345,
    0xA409_3822_299F_31D0_082E_FA98_EC4E_6C89,
    0x4528_21E6_38D0_1377_BE54_66CF_34E9_0C6D,
    0xC0AC_29B7_C97C_50DD_3F84_D5B5_B547_0917,
    0x9216_D5D9_8979_FB1B_D131_0BA6_98DF_B5AD,
    0x2FFD_72DB_D01A_DFB7_B8E1_AFED_6A26_7E97,
    0xBA7C_9045_F12C_7F99_24A1_9947_B391_6CF7,
    0x0801_F2E2_858E_FC16_6369_20D8_7157_4E69,
    0xA458_FEA3_F493_3D7E_0D95_748F_728E_B659,
    0x718B_CD58_8215_4AEE_7B54_A41D_C25A_59B5,
    0x9C30_D539_2AF2_6013_C5D1_B023_2860_85F1,
    0xCA41_7918_B8DB_38EF_8E79_DCB0_603A_180F,
];

impl State {
    /// The hash of all that can influence the future. Cost: O(sprites changed since [`State::settle_hash`]).
    pub fn state_hash(&self) -> StateHash {
        let mut sum = self.sprite_hash;
        for &slot in &self.stale {
            let sprite = self.sprite(slot);
            let hash = if sprite.is(flag::GONE) { 0 } else { sprite_hash(sprite, self.tick) };
            sum = sum.wrapping_add(hash).wrapping_sub(self.hashes[usize::from(slot)]);
        }
        self.with_globals(sum)
    }

    /// The same, computed from nothing: what tests hold [`State::state_hash`] against. Cost: O(sprites).
    pub fn state_hash_from_scratch(&self, game: &Game) -> StateHash {
        let slots = game.sprite_types().flat_map(|stype| self.slots(stype));
        let sum = slots.map(|slot| sprite_hash(self.sprite(slot), self.tick)).fold(0u128, u128::wrapping_add);
        self.with_globals(sum)
    }

    fn with_globals(&self, sprites: u128) -> StateHash {
        let mut mixer = Mixer::new(0x5374_6174);
        mixer.pair(sprites as u64, (sprites >> 64) as u64);
        mixer.pair(two(self.tick, self.messages as i32), self.score as u64);
        mixer.pair(self.chance.state(), two(self.next_id as i32, self.population));
        mixer.pair(self.avatar_id().map_or(u64::MAX, u64::from), self.outcome_code());
        let mut held: SmallVec<[_; 8]> =
            self.held.iter().map(|held| (self.sprite(held.holder).id, *held)).collect();
        held.sort_unstable_by_key(|(id, held)| (*id, held.resource));
        for (id, held) in held {
            mixer.pair(u64::from(id), two(i32::from(held.resource.0), held.amount));
        }
        let mut extras: SmallVec<[_; 4]> =
            self.extras.iter().map(|extra| (self.sprite(extra.holder).id, extra)).collect();
        extras.sort_unstable_by_key(|(id, _)| *id);
        for (id, extra) in extras {
            mixer.pair(u64::from(id), u64::from(extra.block_time as u32));
            self.extra_words(extra, &mut mixer);
        }
        let mut replaced: Vec<_> =
            self.replaced.iter().map(|one| (self.sprite(one.holder).id, one.place, one.stype.0)).collect();
        replaced.sort_unstable();
        for (id, place, stype) in replaced {
            mixer.pair(u64::from(id) << 32 | u64::from(place), u64::from(stype));
        }
        for timer in &self.timers {
            mixer.pair(u64::from(timer.timed), timer.due as u64);
        }
        mixer.pair(self.jumps.state(), (self.timers.len() as u64) << 1 | u64::from(self.can_end));
        mixer.bytes(&self.memory);
        mixer.bytes(&self.templates);
        StateHash(mixer.finish())
    }

    fn extra_words(&self, extra: &Extra, mixer: &mut Mixer) {
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

    fn outcome_code(&self) -> u64 {
        use crate::game::Outcome;
        match self.outcome {
            Outcome::Ongoing => 0,
            Outcome::Won => 1,
            Outcome::Lost => 2,
            Outcome::Ended => 3,
            Outcome::Stopped(limit) => 4 + limit as u64,
        }
    }

    /// The hash of live behaviour only: no score, no tick unless a rule reads it, no chance unless something can draw,
    /// ages saturated at the cooldown, the order of creation instead of ids. Cost: O(sprites).
    pub fn search_key(&self, game: &Game) -> SearchKey {
        let rules: &Rules = &game.0;
        let mut mixer = Mixer::new(0x4B65_7900);
        mixer.pair(self.outcome_code(), u64::from(self.messages) << 1 | u64::from(self.can_end));
        if self.is_over() {
            return SearchKey(mixer.finish());
        }
        // The reference ends every game at its tick limit; a search that deep is not what keys are for.
        mixer.pair(if rules.reads_tick { self.tick as u64 } else { 0 }, self.population as u64);
        for timer in &self.timers {
            mixer.pair(u64::from(timer.timed), timer.due.saturating_sub(self.tick) as u64);
        }
        mixer.pair(
            if rules.draws { self.chance.state() ^ self.jumps.state().rotate_left(16) } else { 0 },
            self.avatar_rank(),
        );
        for stype in game.sprite_types() {
            if self.group(stype).count > 0 {
                mixer.pair(u64::from(stype.0), u64::from(self.group(stype).count));
            }
            for slot in self.slots(stype) {
                self.live_words(rules, self.sprite(slot), &mut mixer);
                let held = self.held.iter().filter(|held| held.holder == slot && held.amount > 0);
                let mut held: Vec<_> =
                    held.map(|held| two(i32::from(held.resource.0), held.amount)).collect();
                held.sort_unstable();
                held.into_iter().for_each(|word| mixer.pair(1, word));
                let count = rules.types[stype.index()].traits.stypes.len();
                if self.replaced.iter().any(|one| one.holder == slot) {
                    let list = (0..count).map(|place| self.missile(rules, slot, place));
                    list.for_each(|missile| mixer.pair(2, u64::from(missile.0)));
                }
            }
        }
        mixer.bytes(&self.memory);
        if rules.first_differs {
            mixer.bytes(&self.templates);
        }
        SearchKey(mixer.finish())
    }

    fn avatar_rank(&self) -> u64 {
        let Some(avatar) = self.sprites.get(usize::from(self.avatar)) else { return u64::MAX };
        let rank = self.slots(avatar.stype).position(|slot| slot == self.avatar);
        u64::from(avatar.stype.0) << 32 | rank.unwrap_or(0) as u64
    }

    fn live_words(&self, rules: &Rules, sprite: &Sprite, mixer: &mut Mixer) {
        let info = &rules.types[sprite.stype.index()];
        let frozen = sprite.is(flag::FROZEN);
        let age = if frozen { sprite.moved_at } else { self.tick.wrapping_sub(sprite.moved_at) };
        // The age is read at the earliest in the sprite's next update, one tick on.
        let age = if frozen { age } else { age.wrapping_add(1) };
        // All ages from the cooldown on are alike, except that the reference's overflow in the end.
        let age = if age > i32::MAX - 2 * MAX_TICKS { age } else { age.min(info.traits.cooldown) };
        let kind = (sprite.flags & !(flag::TRANSIENT | flag::AVATAR | flag::FROM_AVATAR)) as i32;
        mixer.pair(two(sprite.rect.x, sprite.rect.y), two(sprite.rect.w, sprite.rect.h));
        mixer.pair(two(age, kind), two(sprite.health, sprite.max_health));
        mixer.pair(bits(sprite.orientation.x), bits(sprite.orientation.y));
        // Spawners fire when the tick of their first update plus this one is a multiple of the cooldown.
        let spawns = |class: SpriteClass| {
            class.is_a(SpriteClass::SpawnPoint) || class == SpriteClass::SpawnPointMultiSprite
        };
        let phase = match sprite.start {
            _ if !info.class.is_some_and(spawns) => 0,
            -1 => -1 - self.tick.rem_euclid(info.traits.cooldown),
            start => start.wrapping_add(self.tick).rem_euclid(info.traits.cooldown),
        };
        mixer.pair(bits(sprite.speed), two(phase, sprite.time_to_live));
        mixer.pair(two(sprite.count, i32::from(sprite.heading)), u64::from(sprite.spawns.0));
        if let Some(extra) = self.extras.get(usize::from(sprite.extra)) {
            mixer.pair(1, u64::from(self.tick.saturating_sub(extra.block_time).min(6) as u32));
            self.extra_words(extra, mixer);
        }
        if frozen {
            // Only sprites without updates keep their last rectangle beyond this tick.
            mixer.pair(two(sprite.last.x, sprite.last.y), two(sprite.last.w, sprite.last.h));
        }
    }
}
