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
        self.memory_words(&mut mixer);
        self.template_words(&mut mixer);
        for (at, &counter) in self.counters.iter().enumerate() {
            mixer.pair(at as u64, u64::from(counter as u32) | 1 << 32);
        }
        StateHash(mixer.finish())
    }

    fn memory_words(&self, mixer: &mut Mixer) {
        for (chunk, bytes) in self.memory.chunks(8).enumerate() {
            mixer.pair(chunk as u64, bytes.iter().fold(0, |word, &byte| word << 8 | u64::from(byte)));
        }
    }

    fn template_words(&self, mixer: &mut Mixer) {
        for (stype, _) in self.templates.iter().enumerate().filter(|(_, made)| **made) {
            mixer.pair(stype as u64, 1);
        }
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

    /// The hash of live behaviour only: no score unless a rule reads it, no tick unless a rule reads it, no chance unless something can draw,
    /// ages saturated at the cooldown, the order of creation instead of ids. Cost: O(sprites).
    pub fn search_key(&self, game: &Game) -> SearchKey {
        let rules: &Rules = &game.0;
        let mut mixer = Mixer::new(0x4B65_7900);
        mixer.pair(self.outcome_code(), u64::from(self.messages) << 1 | u64::from(self.can_end));
        if self.is_over() {
            return SearchKey(mixer.finish());
        }
        if rules.reads_score {
            mixer.pair(3, self.score as u64);
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
        for &counter in self.counters.iter().filter(|_| rules.reads_counters) {
            mixer.pair(2, u64::from(counter as u32));
        }
        self.memory_words(&mut mixer);
        if rules.first_differs {
            self.template_words(&mut mixer);
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
        let kind = i32::from(sprite.flags & !(flag::TRANSIENT | flag::AVATAR | flag::FROM_AVATAR));
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
