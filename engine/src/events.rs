//! The event phase of a step: edge-of-screen effects, then pairs (`spec/03` §4).

use crate::game::{Limit, Pass, SpriteType, TypeInfo};
use crate::occupancy::Hits;
use crate::ontology::effects;
use crate::state::{NONE, Slot, flag, memory};
use crate::step::{Step, Watch};
use smallvec::SmallVec;

impl Step<'_> {
    pub(crate) fn events(&mut self, watch: &mut impl Watch) {
        for at in 0..self.rules.edge.len() {
            let (stype, effect) = self.rules.edge[at];
            self.edge_pass(stype, effect, watch);
            if self.stopped.is_some() {
                return;
            }
        }
        for at in 0..self.rules.passes.len() {
            self.pair_pass(&self.rules.passes[at], watch);
            if self.stopped.is_some() {
                return;
            }
        }
    }

    /// Every sprite of the tree that is not wholly on the screen. An effect that adds to the group being visited ends
    /// that visit, with a message.
    fn edge_pass(&mut self, stype: SpriteType, effect: u16, watch: &mut impl Watch) {
        let rules = self.rules;
        let screen = self.screen();
        for &stype in &rules.types[stype.index()].tree {
            let mut slot = self.state.group(stype).head;
            while slot != NONE {
                let sprite = self.state.sprite(slot);
                if !sprite.is(flag::KILLED | flag::DISABLED) && !screen.contains(sprite.rect) {
                    let tail = self.state.group(stype).tail;
                    self.execute(effect, slot, None, watch);
                    if self.stopped.is_some() {
                        return;
                    }
                    if self.state.group(stype).tail != tail {
                        self.message();
                        break;
                    }
                }
                slot = self.state.sprite(slot).next;
            }
        }
    }

    fn pair_pass(&mut self, pass: &Pass, watch: &mut impl Watch) {
        let rules = self.rules;
        let (first, second) = (&rules.types[pass.first.index()], &rules.types[pass.second.index()]);
        let size = |family: &TypeInfo| {
            family.tree.iter().map(|&t| u32::from(self.state.group(t).count)).sum::<u32>()
        };
        let (firsts, seconds) = (size(first), size(second));
        if firsts == 0 || seconds == 0 {
            return;
        }
        if !self.state.shields.is_empty() && effects::is_shielded(self, pass) {
            return;
        }
        // Sprites made from here on by this pass do not take part in it.
        let newborn = self.state.next_id;
        if pass.either_side && seconds < firsts {
            self.visit_second_side(pass, first, second, newborn, watch);
        } else {
            self.visit_first_side(pass, first, second, newborn, watch);
        }
    }

    fn visit_first_side(
        &mut self,
        pass: &Pass,
        first: &TypeInfo,
        second: &TypeInfo,
        newborn: u32,
        watch: &mut impl Watch,
    ) {
        let mut hits = Hits::new();
        for &stype in &first.tree {
            let mut slot = self.state.group(stype).head;
            while slot != NONE && self.state.sprite(slot).id < newborn {
                hits.clear();
                self.state.overlapping(self.rules, second, slot, newborn, &mut hits);
                if hits.len() > 1 {
                    hits.sort_unstable_by_key(|&hit| self.rank(second, hit));
                }
                for &hit in &hits {
                    self.meet(pass, slot, hit, watch);
                    if self.stopped.is_some() {
                        return;
                    }
                }
                slot = self.state.sprite(slot).next;
            }
        }
    }

    /// The same meetings in the same order, found from the second side because it has fewer sprites.
    fn visit_second_side(
        &mut self,
        pass: &Pass,
        first: &TypeInfo,
        second: &TypeInfo,
        newborn: u32,
        watch: &mut impl Watch,
    ) {
        let mut pairs: SmallVec<[(Slot, Slot); 16]> = SmallVec::new();
        let mut hits = Hits::new();
        for &stype in &second.tree {
            for slot in self.state.slots(stype) {
                hits.clear();
                self.state.overlapping(self.rules, first, slot, newborn, &mut hits);
                pairs.extend(hits.iter().map(|&hit| (hit, slot)));
            }
        }
        if pairs.len() > 1 {
            pairs.sort_unstable_by_key(|&(one, two)| (self.rank(first, one), self.rank(second, two)));
        }
        for (one, two) in pairs {
            self.meet(pass, one, two, watch);
            if self.stopped.is_some() {
                return;
            }
        }
    }

    /// The order of a sprite among those of a tree: by type in tree order, then by creation.
    fn rank(&self, family: &TypeInfo, slot: Slot) -> (u16, u32) {
        let sprite = self.state.sprite(slot);
        (family.rank[sprite.stype.index()], sprite.id)
    }

    /// The second check before a hit counts: the first sprite is not dead and still there.
    fn meet(&mut self, pass: &Pass, one: Slot, two: Slot, watch: &mut impl Watch) {
        let (first, second) = (self.state.sprite(one), self.state.sprite(two));
        if !first.is(flag::KILLED) && first.rect.intersects(second.rect) {
            self.execute(pass.effect, one, Some(two), watch);
        }
    }

    fn execute(&mut self, effect: u16, one: Slot, two: Option<Slot>, watch: &mut impl Watch) {
        let info = &self.rules.effects[usize::from(effect)];
        watch.interaction(info.line);
        effects::execute(self, effect, &info.effect, one, two);
        let remembered = self.state.memory[usize::from(effect)];
        if remembered & memory::APPLY_SCORE != 0 {
            let change = effects::score_change(info, remembered);
            if self.state.avatar == NONE {
                return self.stop(Limit::NoAvatar);
            }
            self.state.score += i64::from(change);
        }
    }
}
