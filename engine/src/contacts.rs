//! Which interactions can happen at all at the moment: kept as sprites come and go, so that a tick looks only at rules whose
//! two sides share a cell somewhere.
//!
//! Every type that takes part in a rule has a bit. Each cell of the board knows the bits of the sprites in it; each pair of
//! bits that a rule is about knows in how many cells both are; each pass of the event phase knows how many of its pairs are
//! together anywhere. A pass without any is skipped. Sprites that are not aligned to one cell may overlap others without
//! sharing a cell, so a pass with such a sprite on either side counts as possible too.

use crate::game::{Pass, Rules, SpriteType, TypeInfo};
use crate::state::{NONE, Slot, State, flag};

/// No bit, no pair.
const NO: u16 = u16::MAX;
/// Types beyond share the last bit: their rules are looked at more often than needed, and found right all the same.
const BITS: usize = 64;

/// The fixed tables of one game.
#[derive(Debug, Default)]
pub(crate) struct Contacts {
    /// By type: its bit, or `NO` for types of no rule.
    bit: Vec<u16>,
    bits: usize,
    /// By bit: the bits that a rule pairs it with.
    partners: Vec<u64>,
    /// By two bits: the pair's number.
    pair: Vec<u16>,
    /// By pair: the passes that are about it.
    passes: Vec<Box<[u16]>>,
    /// By type: the passes that are about it.
    of_type: Vec<Box<[u16]>>,
    /// By pass: the bits of its first and second side.
    sides: Vec<(u64, u64)>,
    /// Passes that are always looked at: testing what lies below is an effect of its own for some classes.
    always: Vec<u16>,
}

impl Contacts {
    /// Cost: O(types² + passes × the largest trees).
    pub(crate) fn of(types: &[TypeInfo], passes: &[Pass]) -> Contacts {
        let mut contacts = Contacts { bit: vec![NO; types.len()], ..Contacts::default() };
        for pass in passes {
            for side in [pass.first, pass.second] {
                for stype in &types[side.index()].tree {
                    let bit = &mut contacts.bit[stype.index()];
                    if *bit == NO {
                        *bit = contacts.bits.min(BITS - 1) as u16;
                        contacts.bits = (contacts.bits + 1).min(BITS);
                    }
                }
            }
        }
        contacts.partners = vec![0; contacts.bits];
        contacts.pair = vec![NO; contacts.bits * contacts.bits];
        let mut of_pair: Vec<Vec<u16>> = Vec::new();
        let mut of_type: Vec<Vec<u16>> = vec![Vec::new(); types.len()];
        for (number, pass) in (0u16..).zip(passes) {
            let (first, second) = (&types[pass.first.index()].tree, &types[pass.second.index()].tree);
            for &stype in first.iter().chain(second) {
                let passes = &mut of_type[stype.index()];
                if passes.last() != Some(&number) {
                    passes.push(number);
                }
            }
            let bits = |tree: &[SpriteType]| {
                tree.iter().fold(0, |bits: u64, stype| bits | 1 << contacts.bit[stype.index()])
            };
            let sides = (bits(first), bits(second));
            for one in ones(sides.0) {
                for two in ones(sides.1) {
                    let (low, high) = (one.min(two), one.max(two));
                    let pair = &mut contacts.pair[low * contacts.bits + high];
                    if *pair == NO {
                        *pair = of_pair.len() as u16;
                        of_pair.push(Vec::new());
                    }
                    let pair = *pair;
                    contacts.pair[high * contacts.bits + low] = pair;
                    contacts.partners[one] |= 1 << two;
                    contacts.partners[two] |= 1 << one;
                    let passes = &mut of_pair[usize::from(pair)];
                    if passes.last() != Some(&number) {
                        passes.push(number);
                    }
                }
            }
            contacts.sides.push(sides);
            if first.iter().any(|stype| types[stype.index()].ground_aware) {
                contacts.always.push(number);
            }
        }
        contacts.passes = of_pair.into_iter().map(Vec::into_boxed_slice).collect();
        contacts.of_type = of_type.into_iter().map(Vec::into_boxed_slice).collect();
        contacts
    }

    pub(crate) fn sides(&self, pass: usize) -> (u64, u64) {
        self.sides[pass]
    }

    /// Whether any rule is about sprites of the two types.
    pub(crate) fn has_rule(&self, one: SpriteType, two: SpriteType) -> bool {
        let (one, two) = (self.bit[one.index()], self.bit[two.index()]);
        one != NO && two != NO && self.partners[usize::from(one)] & 1 << two != 0
    }

    /// How many pairs there are.
    pub(crate) fn pairs(&self) -> usize {
        self.passes.len()
    }

    fn pair(&self, one: usize, two: usize) -> usize {
        usize::from(self.pair[one * self.bits + two])
    }
}

/// The numbers of the bits that are set, upwards.
fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}

impl State {
    /// Nothing is anywhere yet.
    pub(crate) fn empty_contacts(&mut self, contacts: &Contacts) {
        self.masks = vec![0; self.cells.len()];
        self.together = vec![0; contacts.pairs()];
        self.reasons = vec![0; contacts.sides.len()];
        self.possible = vec![0; contacts.sides.len().div_ceil(64)];
        for &pass in &contacts.always {
            self.allow(pass);
        }
    }

    /// A sprite of the type has come to a cell.
    pub(crate) fn join(&mut self, contacts: &Contacts, stype: usize, cell: usize) {
        let bit = contacts.bit[stype];
        if bit == NO {
            return;
        }
        let bit = usize::from(bit);
        let (mask, own) = (self.masks[cell], 1 << bit);
        let partners = contacts.partners[bit];
        if mask & own == 0 {
            self.masks[cell] = mask | own;
            for other in ones(mask & partners) {
                self.meet_more(contacts, contacts.pair(bit, other));
            }
        } else if partners & own != 0 {
            self.meet_more(contacts, contacts.pair(bit, bit));
        }
    }

    /// A sprite of the type has left a cell, and is out of its chain.
    pub(crate) fn part(&mut self, contacts: &Contacts, stype: usize, cell: usize) {
        let bit = contacts.bit[stype];
        if bit == NO {
            return;
        }
        let partners = contacts.partners[usize::from(bit)];
        let own = 1 << bit;
        let mut at = self.cells[cell];
        while at != NONE {
            let sprite = self.sprite(at);
            if contacts.bit[sprite.stype.index()] == bit {
                if partners & own != 0 {
                    self.meet_less(contacts, contacts.pair(usize::from(bit), usize::from(bit)));
                }
                return;
            }
            at = sprite.cell_next;
        }
        let mask = self.masks[cell] & !own;
        self.masks[cell] = mask;
        for other in ones(mask & partners) {
            self.meet_less(contacts, contacts.pair(usize::from(bit), other));
        }
    }

    fn meet_more(&mut self, contacts: &Contacts, pair: usize) {
        self.together[pair] += 1;
        if self.together[pair] == 1 {
            for &pass in &contacts.passes[pair] {
                self.allow(pass);
            }
        }
    }

    fn meet_less(&mut self, contacts: &Contacts, pair: usize) {
        self.together[pair] -= 1;
        if self.together[pair] == 0 {
            for &pass in &contacts.passes[pair] {
                self.forbid(pass);
            }
        }
    }

    /// Notes which cells the sprites cover that are not aligned to one, until [`State::uncover`].
    pub(crate) fn cover(&mut self, rules: &Rules) {
        self.meeting = true;
        if self.loose == 0 {
            return;
        }
        for stype in (0..rules.types.len() as u16).map(SpriteType) {
            if self.group(stype).loose == 0 {
                continue;
            }
            let mut slot = self.group(stype).head;
            while slot != NONE {
                let sprite = self.sprite(slot);
                let next = sprite.next;
                if sprite.is(flag::LOOSE) {
                    self.cover_cells(&rules.contacts, slot);
                }
                slot = next;
            }
        }
    }

    /// Notes the cells of one such sprite.
    pub(crate) fn cover_cells(&mut self, contacts: &Contacts, slot: Slot) {
        let bit = contacts.bit[self.sprite(slot).stype.index()];
        if bit == NO {
            return;
        }
        let (mut covered, mut cells) =
            (std::mem::take(&mut self.covered), std::mem::take(&mut self.covered_cells));
        let few = self.covered_by(self.sprite(slot), |cell| {
            if covered[cell] == 0 {
                cells.push(cell as u32);
            }
            covered[cell] |= 1 << bit;
        });
        (self.covered, self.covered_cells) = (covered, cells);
        if !few {
            self.vast |= 1 << bit;
        }
    }

    pub(crate) fn uncover(&mut self) {
        self.meeting = false;
        self.vast = 0;
        for cell in self.covered_cells.drain(..) {
            self.covered[cell as usize] = 0;
        }
    }

    /// The first sprite of the type that is not aligned to one cell.
    pub(crate) fn loosened(&mut self, contacts: &Contacts, stype: usize) {
        for &pass in &contacts.of_type[stype] {
            self.allow(pass);
        }
    }

    /// There is no such sprite any more.
    pub(crate) fn aligned(&mut self, contacts: &Contacts, stype: usize) {
        for &pass in &contacts.of_type[stype] {
            self.forbid(pass);
        }
    }

    fn allow(&mut self, pass: u16) {
        let pass = usize::from(pass);
        self.reasons[pass] += 1;
        self.possible[pass / 64] |= 1 << (pass % 64);
    }

    fn forbid(&mut self, pass: u16) {
        let pass = usize::from(pass);
        self.reasons[pass] -= 1;
        if self.reasons[pass] == 0 {
            self.possible[pass / 64] &= !(1 << (pass % 64));
        }
    }

    /// The first pass from `from` on that can do something.
    pub(crate) fn next_possible(&self, from: usize) -> Option<usize> {
        let mut word = from / 64;
        let mut bits = self.possible.get(word)? & (u64::MAX << (from % 64));
        while bits == 0 {
            word += 1;
            bits = *self.possible.get(word)?;
        }
        Some(word * 64 + bits.trailing_zeros() as usize)
    }

    /// The same, computed from nothing: what tests hold the running counts against. Cost: O(sprites).
    #[cfg(test)]
    pub(crate) fn contacts_from_scratch(&self, rules: &Rules) -> State {
        let mut state = self.clone();
        state.cells.fill(NONE);
        for group in &mut state.groups {
            (group.loose, group.off) = (0, 0);
        }
        state.loose = 0;
        state.empty_contacts(&rules.contacts);
        let slots: Vec<Slot> =
            (0..rules.types.len() as u16).flat_map(|t| self.slots(SpriteType(t))).collect();
        for slot in slots {
            state.enter_cell(rules, slot);
        }
        state
    }
}
