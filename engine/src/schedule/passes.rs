//! The event-phase passes whose two sides share a cell somewhere, each visited from the side with fewer
//! sprites.

use super::Foresight;
use crate::rules::{Pass, SpriteType};
use crate::tick::{Scheduler, Step, Watch};
use crate::world::{Hit, Hits, NONE};
use smallvec::SmallVec;

impl Step<'_, Foresight<'_>> {
    /// Returns `true` if the second side of a pass has fewer sprites, and a search from that side finds the
    /// same pairs of sprites.
    #[inline(always)]
    pub(super) fn is_second_side_smaller(&self, pass: &Pass) -> bool {
        let size = |side: SpriteType| {
            let tree = &self.rules.types[side.index()].tree;
            tree.iter().map(|&t| u32::from(self.world.group(t).count)).sum::<u32>()
        };
        // The first side is often the avatar alone.
        pass.either_side && {
            let first = size(pass.first);
            first > 1 && size(pass.second) < first
        }
    }

    /// Processes the same pairs of sprites as [`Step::visit_first_side`] in the same order, but searches from
    /// the second side.
    pub(super) fn visit_second_side(&mut self, pass: &Pass, newborn: u32, watch: &mut (impl Watch + ?Sized)) {
        let (first, second) = (self.side(pass.first), self.side(pass.second));
        let mut pairs: SmallVec<[(Hit, Hit); 16]> = SmallVec::new();
        let mut hits = Hits::new();
        let mut visited = 0;
        for &stype in &second.family.tree {
            let own = self.models.bit(stype);
            if !self.scheduler.may_meet(self.world, own, first.bits) {
                continue;
            }
            let mut slot = self.world.group(stype).head;
            while slot != NONE {
                let sprite = self.world.sprite(slot);
                visited += 1;
                if !self.world.may_overlap(own, first, sprite) {
                    slot = sprite.next;
                    continue;
                }
                hits.clear();
                let looked = self.world.overlapping(self.rules.reach, first, slot, newborn, &mut hits);
                self.work(looked);
                let own = self.world.hit(second, slot);
                pairs.extend(hits.iter().map(|&hit| (hit, own)));
                if self.stopped.is_some() {
                    return;
                }
                slot = self.world.sprite(slot).next;
            }
        }
        self.work(visited);
        if pairs.len() > 1 {
            pairs.sort_unstable();
        }
        for (one, two) in pairs {
            self.meet(pass, one.slot(), two.slot(), watch);
            if self.stopped.is_some() {
                return;
            }
        }
    }
}
