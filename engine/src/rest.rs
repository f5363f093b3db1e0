//! Sprites at rest: those that try to move in every tick, and are stepped back by the same thing every time.
//!
//! A boulder on the ground falls a little, meets the dirt below and is put back, tick after tick. As long as nothing comes
//! to, or leaves, the cells that it stands in and falls into, each tick does to it what the last one did: nothing. Such a
//! sprite is passed over. As soon as anything touches those cells, it is woken; if the tick is already past its own
//! movement, but not past the rule that puts it back, it is moved then as it would have been.
//!
//! What may rest is decided so that no one can tell the difference (`spec/01` §4, `spec/03` §4): its movement draws nothing,
//! counts nothing and does not wait; the rule that puts it back costs no points; nothing else happens to it in the tick; no
//! rule is about anything that it stands on; no one looks for its type. An effect that reaches sprites from afar wakes all.

use crate::flight::LONGEST_PERIOD;
use crate::game::{EffectInfo, Pass, SpriteType, TypeInfo};
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;
use crate::ontology::physics;
use crate::ontology::sprites::is_idle;
use crate::state::{NONE, Slot, Sprite, State, flag};
use crate::step::Step;

/// Values of [`Sprite::rest`]: what has happened to the sprite in this tick.
pub(crate) mod mark {
    /// It has not moved by itself, or not as those that rest do.
    pub(crate) const NOTHING: u16 = 0;
    /// It has moved by itself, and nothing else happened.
    pub(crate) const TRIED: u16 = 0x7FFF;
    /// Something else happened too.
    pub(crate) const SPOILED: u16 = 0x7FFE;
    /// Set for those that are not updated. Without this bit, other values are one more than the pass that put it back.
    pub(crate) const ASLEEP: u16 = 0x8000;
    /// It is at rest. With this bit, other values are the ticks between moves of what is in flight (`flight.rs`).
    pub(crate) const RESTING: u16 = ASLEEP;
}

/// The largest sprite of a game in which sprites rest, in cells along a side.
const LARGEST: f64 = 4.0;

/// The cells around a sprite at rest, and the pass that would put it back.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rest {
    pub(crate) slot: Slot,
    pub(crate) pass: u16,
    pub(crate) left: i16,
    pub(crate) top: i16,
    pub(crate) right: i16,
    pub(crate) bottom: i16,
}

impl Rest {
    fn holds(&self, column: i16, row: i16) -> bool {
        self.left <= column && column <= self.right && self.top <= row && row <= self.bottom
    }
}

/// What may be foreseen of the sprites of a type.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Foresight {
    /// They may fly.
    pub(crate) flies: bool,
    /// They may rest.
    pub(crate) rests: bool,
}

/// What may be foreseen, by type.
pub(crate) fn foresight(types: &[TypeInfo], passes: &[Pass], effects: &[EffectInfo]) -> Vec<Foresight> {
    use SpriteClass as C;
    let large = |factor: f64| factor.is_nan() || factor > LARGEST;
    let large = |info: &TypeInfo| large(info.traits.width_factor) || large(info.traits.height_factor);
    if types.iter().any(|info| info.ground_aware) {
        return vec![Foresight::default(); types.len()];
    }
    let any_large = types.iter().any(large);
    let is_put_back = |stype: SpriteType| {
        passes.iter().any(|pass| {
            let effect = &effects[usize::from(pass.effect)].effect;
            matches!(effect, Effect::StepBack { pixel_perfect: false })
                && types[pass.first.index()].in_tree(stype)
        })
    };
    let sought = |stype: SpriteType| {
        types.iter().any(|info| {
            let seeks = info.class.is_some_and(|class| class.is_a(C::RandomNPC));
            seeks
                && info
                    .traits
                    .stypes
                    .iter()
                    .filter_map(|target| types.get(target.index()))
                    .any(|family| family.in_tree(stype))
        })
    };
    let draws = |info: &TypeInfo| matches!(info.class, Some(C::SpawnPoint | C::Bomber));
    let may = |(number, info): (u16, &TypeInfo)| {
        let traits = &info.traits;
        let plain = matches!(
            info.class,
            Some(
                C::Immovable
                    | C::Door
                    | C::Passive
                    | C::Conveyor
                    | C::Resource
                    | C::ResourcePack
                    | C::Missile
                    | C::ErraticMissile
                    | C::RandomMissile
            )
        );
        let is_idle = info.class.is_some_and(|class| is_idle(class, info));
        (plain || draws(info) && !traits.oriented_image)
            // What never moves by itself has nothing to be foreseen.
            && !is_idle
            && !traits.continuous
            // What waits, and comes to another cell with every move, costs less as it is.
            && (traits.cooldown <= 1 || traits.cooldown <= LONGEST_PERIOD && traits.speed.abs() < 1.0)
            && traits.last_move == 0
            && traits.time_to_live < 0
            && info.order.is_some()
            && !sought(SpriteType(number))
    };
    let foreseen = |(number, info)| {
        let flies = may((number, info));
        let tries_always = info.traits.cooldown <= 1 && !draws(info);
        Foresight { flies, rests: flies && tries_always && !any_large && is_put_back(SpriteType(number)) }
    };
    (0u16..).zip(types).map(foreseen).collect()
}

impl State {
    /// Someone came to, or left, what a sprite covers: wakes are due if anything rests there.
    pub(crate) fn touch(&mut self, slot: Slot) {
        let sprite = self.sprite(slot);
        if !sprite.is(flag::LOOSE) {
            let cell = self.cell_of(sprite);
            if self.watched[cell] > 0 {
                self.touched.push(cell as u32);
            }
            return;
        }
        let mut touched = std::mem::take(&mut self.touched);
        let sprite = self.sprite(slot);
        self.covered_by(sprite, |cell| {
            if self.watched[cell] > 0 {
                touched.push(cell as u32);
            }
        });
        self.touched = touched;
    }

    /// Nothing is at rest any more. Between steps only.
    fn wake_all(&mut self) {
        for rest in self.rests.drain(..) {
            let sprite = &mut self.sprites[usize::from(rest.slot)];
            sprite.rest = mark::NOTHING;
            self.groups[sprite.stype.index()].asleep -= 1;
        }
        self.watched.fill(0);
    }
}

impl Step<'_> {
    /// Before a tick: nothing rests in one in which a rule that is executed stops the game.
    #[inline]
    pub(crate) fn begin_rest(&mut self, plainly: bool) {
        self.flies = self.rules.any_flies && !plainly;
        self.rests = self.rules.any_rests && !plainly && self.state.avatar != NONE;
        if !self.rests && !self.state.rests.is_empty() {
            self.state.wake_all();
        }
        if !self.flies && !self.state.flights.is_empty() {
            self.state.land_all(self.rules);
        }
    }

    /// An effect is about to be executed on a sprite.
    pub(crate) fn prepare(&mut self, effect: &Effect, one: Slot) {
        self.land_one(one);
        if effect.reaches_afar() {
            self.rouse_all();
        } else if matches!(effect, Effect::ShieldFrom { .. }) {
            self.rouse_resting();
        }
    }

    /// An effect is executed on a sprite.
    pub(crate) fn note(&mut self, effect: &Effect, free: bool, one: Slot, two: Option<Slot>) {
        let pass = self.pass;
        let first = &mut self.state.sprites[usize::from(one)].rest;
        if *first != mark::NOTHING {
            let back = matches!(effect, Effect::StepBack { pixel_perfect: false });
            *first = if back && free && *first == mark::TRIED && pass >= 0 {
                pass as u16 + 1
            } else {
                mark::SPOILED
            };
        }
        if let Some(two) = two {
            let second = &mut self.state.sprites[usize::from(two)].rest;
            // Being in another's way changes nothing, unless it is worth points.
            let harmless = free && matches!(effect, Effect::StepBack { .. });
            if *second != mark::NOTHING && !harmless {
                *second = mark::SPOILED;
            }
        }
    }

    /// After a tick: what was put back, in a place where nothing else changed, rests from now on; what has moved, and will
    /// go on so, flies.
    #[inline]
    pub(crate) fn settle_down(&mut self) {
        if self.tried && self.stopped.is_none() {
            self.settle_tried();
        }
    }

    #[inline(never)]
    fn settle_tried(&mut self) {
        if self.rests {
            self.stamp_moved();
        }
        let mut kept = 0;
        for at in 0..self.state.moved.len() {
            let slot = self.state.moved[at];
            let sprite = self.state.sprite(slot);
            let (rest, back) = (sprite.rest, sprite.is_back());
            if rest == mark::TRIED && !back && self.take_off(slot) {
                continue;
            }
            let sprite = self.state.sprite(slot);
            let may_rest = || self.rests && self.rules.foresight[sprite.stype.index()].rests;
            if rest < mark::SPOILED && rest != mark::NOTHING && back && may_rest() {
                self.try_rest(slot, rest - 1);
            }
            self.state.moved[kept] = slot;
            kept += 1;
        }
        self.state.moved.truncate(kept);
    }

    /// All other changes were noted when they happened; of a try, it shows now that it was none.
    fn stamp_moved(&mut self) {
        for at in 0..self.state.moved.len() {
            let slot = self.state.moved[at];
            let (sprite, last) = (*self.state.sprite(slot), self.state.last(slot));
            if sprite.rest != mark::NOTHING && !sprite.is_back() {
                self.state.stamp(&sprite, self.state.tick);
                let (column, row) = self.state.place_of(last);
                let before = Sprite { rect: last, flags: sprite.flags | flag::BIG, column, row, ..sprite };
                self.state.stamp(&before, self.state.tick);
            }
        }
    }

    fn try_rest(&mut self, slot: Slot, pass: u16) {
        let sprite = *self.state.sprite(slot);
        let Some(aim) = physics::aim(self, slot) else { return };
        let around = |a: i32, b: i32, size: i32| (a.min(b), a.max(b).saturating_add(size - 1));
        let (left, right) = around(sprite.rect.x, aim.x, sprite.rect.w);
        let (top, bottom) = around(sprite.rect.y, aim.y, sprite.rect.h);
        let (left, top) = self.state.place_of(sprite.rect.at(left, top));
        let (right, bottom) = self.state.place_of(sprite.rect.at(right, bottom));
        if (right - left) > 2 || (bottom - top) > 2 {
            return;
        }
        let rest = Rest { slot, pass, left, top, right, bottom };
        let now = stamp_of(self.state.tick);
        let quiet = self
            .state
            .cells_in(&rest)
            .all(|cell| self.state.stamps[cell] < now && self.state.watched[cell] < u8::MAX);
        // Where it rests, an effect of the edge may be executed on it, which it has left when it is not at rest.
        if !quiet || sprite.is(flag::OFF) || self.stands_on_rules(slot) {
            return;
        }
        for cell in self.state.cells_in(&rest) {
            self.state.watched[cell] += 1;
        }
        self.state.sprites[usize::from(slot)].rest = mark::RESTING;
        self.state.groups[sprite.stype.index()].asleep += 1;
        self.state.rests.push(rest);
    }

    /// Whether a rule is about the sprite and anything that it overlaps where it stands.
    fn stands_on_rules(&self, slot: Slot) -> bool {
        let rules = self.rules;
        let rect = self.state.sprite(slot).rect;
        let stype = self.state.sprite(slot).stype;
        let mut found = false;
        self.state.near_rect(rules, rect, |other| {
            let sprite = self.state.sprite(other);
            found |=
                other != slot && rules.contacts.has_rule(stype, sprite.stype) && sprite.rect.intersects(rect);
        });
        found
    }

    /// Wakes what rests around the touched cells.
    #[inline]
    pub(crate) fn wake(&mut self) {
        if !self.state.touched.is_empty() {
            self.wake_touched();
        }
    }

    fn wake_touched(&mut self) {
        while let Some(cell) = self.state.touched.pop() {
            if self.state.watched[cell as usize] == 0 {
                continue;
            }
            self.work(self.state.rests.len() / 64);
            let stride = (self.state.columns + 2) as u32;
            let (column, row) = ((cell % stride) as i16, (cell / stride) as i16);
            let mut at = 0;
            while at < self.state.rests.len() {
                if self.state.rests[at].holds(column, row) {
                    let rest = self.state.rests.swap_remove(at);
                    self.rouse(rest);
                } else {
                    at += 1;
                }
            }
        }
    }

    /// Wakes one sprite; makes up for its movement in this tick if that is past, and its way back is not.
    fn rouse(&mut self, rest: Rest) {
        let slot = rest.slot;
        for cell in self.state.cells_in(&rest) {
            self.state.watched[cell] -= 1;
        }
        let sprite = &mut self.state.sprites[usize::from(slot)];
        sprite.rest = mark::NOTHING;
        self.state.groups[sprite.stype.index()].asleep -= 1;
        if sprite.is(flag::GONE) {
            return;
        }
        if self.has_moved(slot)
            && self.pass < i32::from(rest.pass)
            && let Some(aim) = physics::aim(self, slot)
        {
            self.state.sprites[usize::from(slot)].rest = mark::TRIED;
            self.tried = true;
            self.place(slot, aim);
            self.set_age(slot, 0);
        }
    }

    /// Whether a sprite's own update in this tick is past.
    pub(crate) fn has_moved(&self, slot: Slot) -> bool {
        let Sprite { id, stype, .. } = *self.state.sprite(slot);
        let order = self.rules.types[stype.index()].order.map_or(-1, i32::from);
        self.updating < order || self.updating == order && id < self.updating_id
    }

    /// Nothing rests or flies any more: something is about to happen that may concern all.
    pub(crate) fn rouse_all(&mut self) {
        self.carry_out_bumps();
        self.rouse_resting();
        self.land_midway();
    }

    pub(crate) fn rouse_resting(&mut self) {
        while let Some(rest) = self.state.rests.pop() {
            self.rouse(rest);
        }
        self.wake();
    }
}

impl State {
    fn cells_in(&self, rest: &Rest) -> impl Iterator<Item = usize> + use<> {
        let stride = self.columns + 2;
        let Rest { left, top, right, bottom, .. } = *rest;
        (i32::from(top)..i32::from(bottom) + 1).flat_map(move |row| {
            (i32::from(left)..i32::from(right) + 1).map(move |column| (row * stride + column) as usize)
        })
    }

    /// Notes that something changed for good in the cells that a sprite covers.
    pub(crate) fn stamp(&mut self, sprite: &Sprite, tick: i32) {
        let stamp = stamp_of(tick);
        if !sprite.is(flag::LOOSE) {
            let cell = self.cell_of(sprite);
            self.stamps[cell] = self.stamps[cell].max(stamp);
            return;
        }
        let mut stamps = std::mem::take(&mut self.stamps);
        self.covered_by(sprite, |cell| stamps[cell] = stamps[cell].max(stamp));
        self.stamps = stamps;
    }
}

/// A tick as stamps hold it; games end long before it overflows.
fn stamp_of(tick: i32) -> i16 {
    tick.clamp(-1, i32::from(i16::MAX)) as i16
}
