//! Keys for the live part of a state, for planners' transposition tables.

use crate::SpriteClass;
use crate::analysis::StateAbstraction;
use crate::game::Game;
use crate::limits::MAX_TICKS;
use crate::rules::traits::BLOCK_PAUSE;
use crate::rules::{Rules, SpriteType, TypeInfo, memory};
use crate::state::State;
use crate::world::{Extra, Mixer, Replaced, SearchKey, Slot, Sprite, Target, World, bits, flag, two};

/// The flags that a later step can read. The other flags follow from the type or record the sprite's origin.
const LIVE: u32 = flag::DISABLED | flag::ON_GROUND | flag::FIRST_TICK | flag::ORIENTED | flag::FROZEN;

const TAG: u64 = 0x4B65_7900;

/// A sink for the words that make up a key.
trait Absorb {
    fn pair(&mut self, a: u64, b: u64);

    /// Absorbs the words for each slot, such that the order of the slots makes no difference.
    fn in_any_order(&mut self, slots: impl Iterator<Item = Slot>, words: impl Fn(Slot, &mut Self));
}

impl Absorb for Mixer {
    fn pair(&mut self, a: u64, b: u64) {
        self.pair(a, b);
    }

    fn in_any_order(&mut self, slots: impl Iterator<Item = Slot>, words: impl Fn(Slot, &mut Self)) {
        let hash = |slot: Slot| {
            let mut mixer = Mixer::new(TAG);
            words(slot, &mut mixer);
            mixer.finish()
        };
        let sum = slots.map(hash).fold(0, u128::wrapping_add);
        self.pair(sum as u64, (sum >> 64) as u64);
    }
}

/// Collects the words themselves in a vector.
impl Absorb for Vec<u64> {
    fn pair(&mut self, a: u64, b: u64) {
        self.extend([a, b]);
    }

    fn in_any_order(&mut self, slots: impl Iterator<Item = Slot>, words: impl Fn(Slot, &mut Self)) {
        let mut each: Vec<Vec<u64>> = slots
            .map(|slot| {
                let mut own = Vec::new();
                words(slot, &mut own);
                own
            })
            .collect();
        each.sort_unstable();
        self.extend(each.into_iter().flatten());
    }
}

impl State {
    /// Returns a hash of the part of the state that can affect later steps. Two states in the same game and
    /// level with equal keys have equal keys, outcomes and score changes after the same actions. The
    /// exceptions are:
    ///
    /// - states near the reference's tick limit, which planners do not reach
    /// - states near the engine's work limit, which planners do not reach
    /// - score changes by removeScore, which removes the whole score
    ///
    /// The key omits the score, the counters and the tick, unless a termination reads their values. Spawners
    /// depend only on the tick modulo their cooldown. The key also omits the random number generator, unless
    /// random draws are possible, and memory that is never read again.
    ///
    /// Ages are capped at the cooldown, timers are relative to the tick, and sprites are identified by their
    /// order instead of their IDs. Cost: O(sprites).
    pub fn search_key(&self, game: &Game) -> SearchKey {
        let mut mixer = Mixer::new(TAG);
        self.world.live_state(&game.0, None, &mut mixer);
        SearchKey(mixer.finish())
    }

    /// Computes [`StateAbstraction::key`].
    pub(crate) fn key_left_out(&self, rules: &Rules, abstraction: &StateAbstraction) -> SearchKey {
        let mut mixer = Mixer::new(TAG);
        self.world.live_state(rules, Some(abstraction), &mut mixer);
        SearchKey(mixer.finish())
    }

    /// Returns the words that [`State::key_left_out`] hashes.
    pub(crate) fn words_left_out(&self, rules: &Rules, abstraction: &StateAbstraction) -> Vec<u64> {
        let mut words = Vec::new();
        self.world.live_state(rules, Some(abstraction), &mut words);
        words
    }
}

impl World {
    fn live_state(&self, rules: &Rules, abstraction: Option<&StateAbstraction>, to: &mut impl Absorb) {
        to.pair(self.outcome_code(), u64::from(self.messages()) << 1 | u64::from(self.can_end()));
        if self.is_over() {
            return;
        }
        let reads_tick = abstraction.map_or(rules.reads_tick, |abstraction| abstraction.tick);
        to.pair(if reads_tick { self.tick() as u64 } else { 0 }, self.population() as u64);
        if rules.reads_score {
            to.pair(2, self.score() as u64);
        }
        for &counter in self.counters().iter().filter(|_| rules.reads_counters) {
            to.pair(3, counter as u64);
        }
        for &clock in abstraction.map_or(&rules.clocks, |abstraction| &abstraction.clocks) {
            to.pair(clock as u64, self.tick().rem_euclid(clock) as u64);
        }
        for &first in abstraction.map_or(&rules.wizard_ticks, |abstraction| &abstraction.wizard_ticks) {
            to.pair(1, self.wait(first));
        }
        if abstraction.map_or(rules.draws, |abstraction| abstraction.chance) {
            to.pair(self.chance().state(), self.jumps().state());
        }
        to.pair(self.rank(self.avatar()), self.timers().len() as u64);
        for timer in self.timers() {
            to.pair(u64::from(timer.timed), timer.due.saturating_sub(self.tick()) as u64);
        }
        for (stype, group) in (0u16..).map(SpriteType).zip(self.groups()) {
            let is = |left_out: fn(&StateAbstraction) -> &[bool]| {
                abstraction.is_some_and(|k| left_out(k)[stype.index()])
            };
            if group.count == 0 || is(|abstraction| &abstraction.constant) {
                continue;
            }
            to.pair(u64::from(stype.0), u64::from(group.count));
            let orientation_irrelevant = is(|abstraction| &abstraction.orientation_irrelevant);
            if group.count > 1 && is(|abstraction| &abstraction.interchangeable) {
                to.in_any_order(self.slots(stype), |slot, to| {
                    self.live_words(rules, slot, orientation_irrelevant, to)
                });
            } else {
                for slot in self.slots(stype) {
                    self.live_words(rules, slot, orientation_irrelevant, to);
                }
            }
        }
        self.remembered_words(rules, to);
    }

    /// Returns a sprite's identity: its type and its position among the sprites of that type.
    fn rank(&self, slot: Slot) -> u64 {
        let Some(sprite) = self.get(slot) else { return u64::MAX };
        let place = self.slots(sprite.stype).position(|other| other == slot);
        u64::from(sprite.stype.0) << 32 | place.map_or(u64::from(u32::MAX), |place| place as u64)
    }

    fn live_words(&self, rules: &Rules, slot: Slot, orientation_irrelevant: bool, to: &mut impl Absorb) {
        let sprite = &self.present(slot);
        let info = &rules.types[sprite.stype.index()];
        let (overrides, extra) = (self.overrides_of(sprite), self.extra_of(sprite));
        let held = self.held_by(slot).iter().filter(|held| held.amount != 0);
        // This word determines the number of words that follow for the sprite.
        let follows = (held.clone().count() as i32) << 1 | i32::from(extra.is_some());
        to.pair(two((sprite.flags & LIVE) as i32, follows), two(overrides.health, overrides.max_health));
        to.pair(two(sprite.rect.x, sprite.rect.y), two(sprite.rect.w, sprite.rect.h));
        if !orientation_irrelevant || sprite.is(flag::ORIENTED) {
            to.pair(bits(overrides.orientation.x), bits(overrides.orientation.y));
        }
        to.pair(bits(overrides.speed), two(self.live_age(sprite, info), self.phase(sprite, info)));
        to.pair(
            two(sprite.count, sprite.heading() as i32),
            two(sprite.time_to_live, i32::from(overrides.spawns.0)),
        );
        if sprite.is(flag::FROZEN) {
            // The last rectangle of any other sprite is overwritten at the start of the next step, so it
            // makes no difference.
            let last = self.last(slot);
            to.pair(two(last.x, last.y), two(last.w, last.h));
        }
        for held in held {
            to.pair(u64::from(held.resource.0), held.amount as u64);
        }
        let is_other = |one: &&Replaced| one.stype != info.traits.stypes[usize::from(one.place)];
        for one in self.replaced_by(slot).iter().filter(is_other) {
            to.pair(u64::from(one.place) | 1 << 32, u64::from(one.stype.0));
        }
        if let Some(extra) = extra {
            self.extra_words(extra, info, to);
        }
    }

    /// Returns a sprite's age as read by the next update or event. The age is capped at the type's cooldown, because
    /// greater ages have the same effect. Only an age that is about to overflow is not capped.
    fn live_age(&self, sprite: &Sprite, info: &TypeInfo) -> i32 {
        let age = if sprite.is(flag::FROZEN) {
            sprite.moved_at
        } else {
            self.tick().wrapping_sub(sprite.moved_at).wrapping_add(1)
        };
        // The reference's counter overflows to the smallest integer, which makes a very old sprite young
        // again.
        if age > i32::MAX - 2 * MAX_TICKS { age } else { age.min(info.traits.cooldown) }
    }

    /// Returns a spawner's phase. A spawner fires when the sum of its start and the tick is a multiple of its
    /// cooldown.
    fn phase(&self, sprite: &Sprite, info: &TypeInfo) -> i32 {
        match self.overrides_of(sprite).start {
            // The first update will set the start.
            -1 => -1,
            start if info.class.is_some_and(SpriteClass::is_spawner) => {
                start.wrapping_add(self.tick()).rem_euclid(info.traits.cooldown)
            }
            _ => 0,
        }
    }

    /// Returns the number of ticks until the tick `until`. The minimum is 1, because the next step treats the next tick
    /// and all earlier ticks alike.
    fn wait(&self, until: i32) -> u64 {
        (i64::from(until) - i64::from(self.tick())).max(1) as u64
    }

    fn extra_words(&self, extra: &Extra, info: &TypeInfo, to: &mut impl Absorb) {
        to.pair(bits(extra.rotation), bits(extra.gravity));
        to.pair(bits(extra.facing.x), bits(extra.facing.y));
        let makes_blocks = info.class == Some(SpriteClass::WizardAvatar);
        let wait = if makes_blocks { self.wait(extra.block_time.wrapping_add(BLOCK_PAUSE)) } else { 0 };
        let (kind, target) = match extra.target {
            Target::None => (0, (0, 0)),
            Target::Sprite(slot) => (1, (self.rank(slot), 0)),
            Target::Gone(rect) => (2, (two(rect.x, rect.y), two(rect.w, rect.h))),
        };
        let known = extra.last_known.map_or(0, |_| 4);
        to.pair(wait, kind | known);
        to.pair(target.0, target.1);
        let (x, y) = extra.last_known.unwrap_or_default();
        to.pair(two(x, y), 0);
    }

    /// Absorbs the memory that effects read before they write it and, if it makes a difference, the types
    /// whose first sprite has already been created.
    fn remembered_words(&self, rules: &Rules, to: &mut impl Absorb) {
        let credits = memory::APPLY_SCORE | memory::NO_COUNT | memory::NO_COUNT_ELSE;
        for &effect in &rules.remembering {
            to.pair(u64::from(effect), u64::from(self.memory(effect) & credits));
        }
        for (stype, info) in (0..).map(SpriteType).zip(&rules.types) {
            if info.first_differs && self.has_had(stype) {
                to.pair(u64::from(stype.0), 2);
            }
        }
    }
}
