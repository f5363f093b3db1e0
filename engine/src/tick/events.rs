//! The event phase of a step: edge-of-screen effects, then pairs (`spec/03` §4).

use super::effects;
use super::{Meeting, Removal, Scheduler, Step, Watch};
use crate::limits::EFFECT_WORK;
use crate::numbers::geometry::Rect;
use crate::rules::{EffectInfo, Limit, Pass, SpriteType, Timed, memory};
use crate::world::{Hit, Hits, NONE, Partners, Side, Slot, Timer, flag};

impl<'a, S: Scheduler> Step<'a, S> {
    pub(crate) fn events(&mut self, watch: &mut (impl Watch + ?Sized)) {
        if !self.world.timers().is_empty() {
            self.timers(watch);
            if self.stopped.is_some() {
                return;
            }
        }
        if self.world.off() != 0 {
            for &(stype, effect) in &self.rules.edge {
                self.edge_pass(stype, effect, watch);
                if self.stopped.is_some() {
                    return;
                }
            }
        }
        if self.rules.undeclared_at_edge {
            return self.stop(Limit::NoType);
        }
        let rules = self.rules;
        let (mut from, mut is_tidy) = (0, false);
        while let Some(number) = S::next_pass(self, from) {
            if !is_tidy {
                self.world.tidy_covered(self.models);
                is_tidy = true;
            }
            self.pass = number as i32;
            self.pair_pass(&rules.passes[number], watch);
            if self.stopped.is_some() {
                break;
            }
            from = number + 1;
        }
    }

    /// Runs the due effects. Effects due in the same tick run in reverse order of scheduling (`spec/03`
    /// §6.3).
    fn timers(&mut self, watch: &mut (impl Watch + ?Sized)) {
        while let Some(Timer { timed: number, .. }) = self.world.take_due() {
            S::unsettles(self);
            // Count the work even if there is no sprite. Otherwise, a timer that repeats at once would run
            // forever.
            self.work_of_effect();
            let timed = &self.rules.timed[usize::from(number)];
            match timed.target {
                None => {
                    watch.interaction(timed.line);
                    let info = &self.rules.effects[usize::from(timed.effect)];
                    effects::execute_alone(self, timed.effect, &info.effect);
                    let wrapper = &self.rules.effects[usize::from(timed.wrapper)];
                    self.score(wrapper, wrapper.initial_memory(), 1);
                }
                Some(stype) => self.timed_group(timed, stype, watch),
            }
            if self.stopped.is_some() {
                return;
            }
            if timed.repeating {
                let due = self.world.tick().saturating_add(timed.timer);
                self.plan(Timer { due, timed: number });
            }
        }
    }

    /// Schedules a timer with [`World::plan`](crate::world::World::plan), and counts the work of moving other
    /// timers in memory.
    pub(crate) fn plan(&mut self, timer: Timer) {
        self.work(self.world.timers().len() / 64);
        self.world.plan(timer);
    }

    /// Executes a timed effect on every sprite of a type and of related types in the SpriteSet. The line's score change
    /// applies, regardless of the effect's outcome.
    fn timed_group(&mut self, timed: &Timed, stype: SpriteType, watch: &mut (impl Watch + ?Sized)) {
        let rules = self.rules;
        let info = &rules.effects[usize::from(timed.effect)];
        for &stype in &rules.types[stype.index()].tree {
            let mut slot = self.world.group(stype).head;
            while slot != NONE {
                if !self.world.sprite(slot).is(flag::KILLED | flag::DISABLED) {
                    let tail = self.world.group(stype).tail;
                    watch.interaction(timed.line);
                    if watch.wants_meetings() {
                        self.tell(watch, timed.line, slot, None);
                    }
                    self.work_of_effect();
                    if watch.wants_removals() {
                        let standing = self.standing(slot, &[]);
                        effects::execute(self, timed.effect, &info.effect, slot, None);
                        self.tell_removals(watch, timed.line, &standing);
                    } else {
                        effects::execute(self, timed.effect, &info.effect, slot, None);
                    }
                    self.credit(info, info.initial_memory(), 1);
                    if self.world.group(stype).tail != tail {
                        self.stop(Limit::SpawnIntoUpdatedType);
                    }
                    if self.stopped.is_some() {
                        return;
                    }
                }
                slot = self.world.sprite(slot).next;
            }
        }
    }

    /// Updates the score and the counters after an execution. `remembered` determines which of these changes
    /// apply.
    fn credit(&mut self, info: &EffectInfo, remembered: u8, times: i32) {
        self.score(info, remembered, times);
        if let Some(counting) = &info.counting {
            if remembered & memory::NO_COUNT == 0 {
                self.count(&counting.counter, times);
            }
            if remembered & memory::NO_COUNT_ELSE == 0 {
                self.count(&counting.counter_else, times);
            }
        }
    }

    fn score(&mut self, info: &EffectInfo, remembered: u8, times: i32) {
        if remembered & memory::APPLY_SCORE == 0 {
            return;
        }
        if self.world.avatar() == NONE {
            return self.stop(Limit::NoAvatar);
        }
        let (change, fault) = effects::score_change(info, remembered);
        if fault {
            self.message();
        }
        self.world.add_score(i64::from(change) * i64::from(times));
    }

    fn count(&mut self, amounts: &[Option<i32>], times: i32) {
        for (at, amount) in amounts.iter().enumerate() {
            if amount.is_none() {
                self.message();
            }
            let change = amount.unwrap_or(0).wrapping_mul(times);
            self.world.add_to_counter(at, change);
        }
    }

    /// Visits every sprite in the tree that is not completely on the screen. An effect that adds a sprite to
    /// the group being visited ends the visit with a message.
    fn edge_pass(&mut self, stype: SpriteType, effect: u16, watch: &mut (impl Watch + ?Sized)) {
        let rules = self.rules;
        for &stype in &rules.types[stype.index()].tree {
            if self.world.group(stype).off == 0 {
                continue;
            }
            self.work(1 + usize::from(self.world.group(stype).count));
            let mut slot = self.world.group(stype).head;
            while slot != NONE {
                let sprite = self.world.own(slot);
                if sprite.is(flag::OFF) && !sprite.is(flag::KILLED | flag::DISABLED) {
                    let tail = self.world.group(stype).tail;
                    self.execute(effect, slot, None, watch);
                    if self.stopped.is_some() {
                        return;
                    }
                    if self.world.group(stype).tail != tail {
                        self.message();
                        break;
                    }
                }
                slot = self.world.own(slot).next;
            }
        }
    }

    fn pair_pass(&mut self, pass: &Pass, watch: &mut (impl Watch + ?Sized)) {
        let tree = |side: SpriteType| &self.rules.types[side.index()].tree;
        self.work(tree(pass.first).len() + tree(pass.second).len());
        // Shields compare exact types and keywords (`spec/03` §5.7).
        if self.world.is_shielded((pass.first, pass.second, pass.keyword)) {
            return;
        }
        // Sprites that this pass creates do not take part in it.
        let newborn = self.world.next_id();
        S::run_pass(self, pass, newborn, watch);
    }

    /// Returns one side of a pass, which consists of a type and the related types in the SpriteSet.
    pub(crate) fn side(&self, stype: SpriteType) -> Side<'a> {
        Side { family: &self.rules.types[stype.index()], bits: self.models.trees[stype.index()] }
    }

    /// Visits the sprites of the first side in order, and processes the partners of each sprite in order
    /// (`spec/03` §4).
    pub(crate) fn visit_first_side(&mut self, pass: &Pass, newborn: u32, watch: &mut (impl Watch + ?Sized)) {
        let (first, second) = (self.side(pass.first), self.side(pass.second));
        let mut hits = Hits::new();
        let mut visited = 0;
        let in_batch = self.rules.effects[usize::from(pass.effect)].in_batch;
        for &stype in &first.family.tree {
            let aware = self.rules.types[stype.index()].ground_aware;
            let own = self.models.bit(stype);
            if !aware && !self.scheduler.may_meet(self.world, own, second.bits) {
                continue;
            }
            let mut slot = self.world.group(stype).head;
            while slot != NONE {
                let sprite = self.world.own(slot);
                if sprite.id >= newborn {
                    break;
                }
                visited += 1;
                if !aware && !self.world.may_overlap(own, second, sprite) {
                    slot = sprite.next;
                    continue;
                }
                hits.clear();
                let looked = if aware {
                    self.look_down(slot, second, newborn, &mut hits)
                } else {
                    self.world.overlapping(self.rules.reach, second, slot, newborn, &mut hits)
                };
                self.work(looked);
                if hits.len() > 1 {
                    hits.sort_unstable();
                }
                if pass.repeats {
                    let once = std::mem::take(&mut hits);
                    self.work(second.family.tree.len() * once.len() / 8);
                    for &stype in &second.family.tree {
                        let of_type = |hit: &&Hit| self.world.sprite(hit.slot()).stype == stype;
                        hits.extend(once.iter().filter(of_type).copied());
                    }
                }
                if in_batch && !hits.is_empty() {
                    let mut partners = hits.iter().map(|hit| hit.slot()).collect();
                    self.execute_batch(pass.effect, slot, &mut partners, watch);
                    if self.stopped.is_some() {
                        return;
                    }
                    hits.clear();
                }
                for hit in &hits {
                    self.meet(pass, slot, hit.slot(), watch);
                    if self.stopped.is_some() {
                        return;
                    }
                }
                if self.stopped.is_some() {
                    return;
                }
                slot = self.world.own(slot).next;
            }
        }
        self.work(visited);
    }

    /// Processes an overlap of two sprites, after checking again that the first sprite is not dead and still
    /// overlaps the second.
    pub(crate) fn meet(&mut self, pass: &Pass, one: Slot, two: Slot, watch: &mut (impl Watch + ?Sized)) {
        if self.rules.types[self.world.own(one).stype.index()].ground_aware {
            self.notice_ground(one, two);
        }
        S::meets(self, one, two);
        let (first, second) = (self.world.own(one), self.world.sprite(two));
        if !first.is(flag::KILLED) && first.rect.intersects(second.rect) {
            self.execute(pass.effect, one, Some(two), watch);
        }
    }

    /// Executes an effect on one or two sprites, and reports the removed sprites if `watch` asks for
    /// removals.
    #[inline(always)]
    fn execute(&mut self, effect: u16, one: Slot, two: Option<Slot>, watch: &mut (impl Watch + ?Sized)) {
        if !watch.wants_removals() {
            return self.execute_pair(effect, one, two, watch);
        }
        let standing = self.standing(one, two.as_slice());
        self.execute_pair(effect, one, two, watch);
        self.tell_removals(watch, self.rules.effects[usize::from(effect)].line, &standing);
    }

    fn execute_pair(&mut self, effect: u16, one: Slot, two: Option<Slot>, watch: &mut (impl Watch + ?Sized)) {
        let info = &self.rules.effects[usize::from(effect)];
        watch.interaction(info.line);
        if watch.wants_meetings() {
            self.tell(watch, info.line, one, two);
        }
        self.work_of_effect();
        S::executes(self, info, one, two.as_slice());
        effects::execute(self, effect, &info.effect, one, two);
        let remembered = self.world.memory(effect);
        self.credit(info, if info.steady { info.initial_memory() } else { remembered }, 1);
    }

    /// Reports the sprites that are about to take part in a rule's execution.
    #[cold]
    fn tell(&self, watch: &mut (impl Watch + ?Sized), line: usize, one: Slot, two: Option<Slot>) {
        let first = self.world.present(one);
        let cell = (first.rect.x.div_euclid(self.world.block()), first.rect.y.div_euclid(self.world.block()));
        let second = two.map(|two| self.world.sprite(two).stype);
        watch.meeting(Meeting { line, first: first.stype, second, cell });
    }

    /// Returns the sprites that are alive before a rule executes, each with its partner's type.
    #[cold]
    fn standing(&self, one: Slot, partners: &[Slot]) -> Vec<(Slot, Option<SpriteType>)> {
        let stype = |slot: Slot| self.world.sprite(slot).stype;
        let first = (one, partners.first().map(|&partner| stype(partner)));
        let seconds = partners.iter().map(|&partner| (partner, Some(stype(one))));
        std::iter::once(first).chain(seconds).filter(|(slot, _)| !self.is_gone(*slot)).collect()
    }

    /// Reports the sprites that were alive before the execution and no longer are.
    #[cold]
    fn tell_removals(
        &self,
        watch: &mut (impl Watch + ?Sized),
        line: usize,
        standing: &[(Slot, Option<SpriteType>)],
    ) {
        for &(slot, by) in standing.iter().filter(|(slot, _)| self.is_gone(*slot)) {
            watch.removal(Removal { line, sprite: self.world.sprite(slot).stype, by });
        }
    }

    fn is_gone(&self, slot: Slot) -> bool {
        self.world.sprite(slot).is(flag::KILLED | flag::DISABLED)
    }

    /// Executes an effect like [`Step::execute`], but on all partners together. The effect determines how
    /// many times the score is added.
    #[inline(always)]
    fn execute_batch(
        &mut self,
        effect: u16,
        one: Slot,
        partners: &mut Partners,
        watch: &mut (impl Watch + ?Sized),
    ) {
        if !watch.wants_removals() {
            return self.execute_all(effect, one, partners, watch);
        }
        let standing = self.standing(one, partners);
        self.execute_all(effect, one, partners, watch);
        self.tell_removals(watch, self.rules.effects[usize::from(effect)].line, &standing);
    }

    fn execute_all(
        &mut self,
        effect: u16,
        one: Slot,
        partners: &mut Partners,
        watch: &mut (impl Watch + ?Sized),
    ) {
        let info = &self.rules.effects[usize::from(effect)];
        watch.interaction(info.line);
        if watch.wants_meetings() {
            partners.iter().for_each(|&partner| self.tell(watch, info.line, one, Some(partner)));
        }
        self.work(EFFECT_WORK * partners.len());
        S::executes(self, info, one, partners);
        let times = effects::execute_batch(self, info, one, partners);
        self.credit(info, self.world.memory(effect), times);
    }

    /// Collects the partners of a sprite whose class detects the ground, by testing for a solid sprite
    /// immediately below. Returns the number of examined cells and sprites.
    fn look_down(&mut self, slot: Slot, second: Side<'_>, newborn: u32, hits: &mut Hits) -> usize {
        if !self.world.may_stand_on(second, self.world.sprite(slot), GROUND) {
            return 1;
        }
        let rect = self.world.sprite(slot).rect;
        let around = Rect { h: rect.h.saturating_add(GROUND), ..rect };
        let looked = self.world.overlapping_rect(self.rules.reach, second, (slot, around), newborn, hits);
        for hit in hits.iter() {
            self.notice_ground(slot, hit.slot());
        }
        hits.retain(|hit| self.world.sprite(hit.slot()).rect.intersects(rect));
        looked
    }

    /// Detects solid ground below a sprite (`spec/02` §2.5).
    fn notice_ground(&mut self, one: Slot, two: Slot) {
        let (sprite, other) = (*self.world.sprite(one), *self.world.sprite(two));
        let solid = self.rules.types[other.stype.index()].traits.solid;
        if sprite.is(flag::ON_GROUND) || !solid {
            return;
        }
        let shifted = sprite.rect.at(sprite.rect.x, sprite.rect.y.wrapping_add(GROUND));
        let last = self.world.last(one);
        let below = self.world.last(two).y > last.y.wrapping_add(sprite.rect.h / 2);
        let falling = sprite.rect.y > last.y;
        if shifted.intersects(other.rect) && below && falling {
            self.world.edit_motion(one).set(flag::ON_GROUND, true);
        }
    }
}

/// The maximum distance in pixels below a sprite at which solid ground is detected.
const GROUND: i32 = 3;
