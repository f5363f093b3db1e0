//! The interactions that are currently possible: maintained as sprites appear and disappear, so that a tick looks only at
//! rules whose two sides share a cell somewhere.
//!
//! Every type that takes part in a rule has a bit. Each cell of the board stores the bits of the sprites in it. Each pair
//! of bits with a rule counts the cells that contain both. Each pass of the event phase counts its pairs that share a
//! cell anywhere, and a pass without any is skipped. Sprites larger than a cell are in the masks with one cell only, so a
//! pass with such a sprite on either side counts as possible too; the cells that they cover are stored separately.

use crate::game::{Pass, Rules, SpriteType, TypeInfo};
use crate::state::{NONE, Slot, State, flag};

/// No pair.
const NO: u16 = u16::MAX;
/// The number of bits. Further types share the last bit: their rules are tested more often than needed, with the same
/// results.
const BITS: usize = 64;

/// The bits of a type.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct TypeMask {
    /// Its bit; 0 for types without rules.
    pub(crate) own: u64,
    /// The bits of the types that a rule pairs it with.
    partners: u64,
}

impl TypeMask {
    fn bit(&self) -> usize {
        self.own.trailing_zeros() as usize
    }

    /// Tests whether a cell with this mask contains a type that a rule pairs this one with.
    pub(crate) fn has_partners_among(&self, mask: u64) -> bool {
        mask & self.partners != 0
    }
}

/// The fixed tables of one game.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contacts {
    /// By type.
    pub(crate) kinds: Vec<TypeMask>,
    bits: usize,
    /// By two bits: the pair's number.
    pair: Vec<u16>,
    /// By pair: the passes that involve it.
    passes: Vec<Box<[u16]>>,
    /// By pair: its two bits.
    ends: Vec<(u8, u8)>,
    /// By type: the passes that involve it.
    of_type: Vec<Box<[u16]>>,
    /// By pass: the bits of its first and second side.
    sides: Vec<(u64, u64)>,
    /// Passes that are always possible: for some classes, testing the ground below is an effect in itself.
    always: Vec<u16>,
}

impl Contacts {
    /// Computes the tables. Cost: O(types² + passes × the largest trees).
    pub(crate) fn of(types: &[TypeInfo], passes: &[Pass]) -> Contacts {
        let mut contacts = Contacts { kinds: vec![TypeMask::default(); types.len()], ..Contacts::default() };
        for pass in passes {
            for side in [pass.first, pass.second] {
                for stype in &types[side.index()].tree {
                    let own = &mut contacts.kinds[stype.index()].own;
                    if *own == 0 {
                        *own = 1 << contacts.bits.min(BITS - 1);
                        contacts.bits = (contacts.bits + 1).min(BITS);
                    }
                }
            }
        }
        let mut partners = vec![0; contacts.bits];
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
                tree.iter().fold(0, |bits: u64, stype| bits | contacts.kinds[stype.index()].own)
            };
            let sides = (bits(first), bits(second));
            for one in ones(sides.0) {
                for two in ones(sides.1) {
                    let (low, high) = (one.min(two), one.max(two));
                    let pair = &mut contacts.pair[low * contacts.bits + high];
                    if *pair == NO {
                        *pair = of_pair.len() as u16;
                        of_pair.push(Vec::new());
                        contacts.ends.push((low as u8, high as u8));
                    }
                    let pair = *pair;
                    contacts.pair[high * contacts.bits + low] = pair;
                    partners[one] |= 1 << two;
                    partners[two] |= 1 << one;
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
        for kind in contacts.kinds.iter_mut().filter(|kind| kind.own != 0) {
            kind.partners = partners[kind.bit()];
        }
        contacts.passes = of_pair.into_iter().map(Vec::into_boxed_slice).collect();
        contacts.of_type = of_type.into_iter().map(Vec::into_boxed_slice).collect();
        contacts
    }

    pub(crate) fn sides(&self, pass: usize) -> (u64, u64) {
        self.sides[pass]
    }

    /// Tests whether any rule pairs the two types.
    pub(crate) fn has_rule(&self, one: SpriteType, two: SpriteType) -> bool {
        self.kinds[one.index()].partners & self.kinds[two.index()].own != 0
    }

    /// The bit of a type if no other type has it.
    pub(crate) fn sole_bit(&self, stype: usize) -> u64 {
        self.kinds[stype].own & !(1 << (BITS - 1))
    }

    /// The number of pairs.
    pub(crate) fn pairs(&self) -> usize {
        self.passes.len()
    }

    fn pair(&self, one: usize, two: usize) -> usize {
        usize::from(self.pair[one * self.bits + two])
    }
}

/// The indices of the set bits, in ascending order.
fn ones(mut bits: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let bit = bits.trailing_zeros() as usize;
        bits &= bits.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}

impl State {
    /// Resets the tables to an empty board.
    pub(crate) fn empty_contacts(&mut self, contacts: &Contacts) {
        self.masks = vec![0; self.cells.len()];
        self.crowds.clear();
        self.together = vec![0; contacts.pairs()];
        self.meets = vec![0; contacts.bits];
        self.reasons = vec![0; contacts.sides.len()];
        self.possible = vec![0; contacts.sides.len().div_ceil(64)];
        for &pass in &contacts.always {
            self.allow(pass);
        }
    }

    /// Notes that a sprite has started to cover a cell.
    #[inline(always)]
    pub(crate) fn arrive(&mut self, contacts: &Contacts, kind: &TypeMask, cell: usize) {
        let mask = &mut self.masks[cell];
        let partners = if *mask & kind.own == 0 {
            let others = *mask & kind.partners;
            *mask |= kind.own;
            others
        } else {
            self.crowd(kind, cell);
            kind.partners & kind.own
        };
        if partners != 0 {
            ones(partners).for_each(|other| self.meet_more(contacts, contacts.pair(kind.bit(), other)));
        }
    }

    /// Notes that a sprite has stopped covering a cell; the chains are already up to date.
    #[inline(always)]
    pub(crate) fn depart(&mut self, contacts: &Contacts, kind: &TypeMask, cell: usize) {
        let partners = if self.crowds_in(cell) & kind.own == 0 {
            let mask = &mut self.masks[cell];
            *mask &= !kind.own;
            *mask & kind.partners
        } else {
            if self.count_in(contacts, cell, kind.own) < 2 {
                self.crowds[cell] &= !kind.own;
            }
            kind.partners & kind.own
        };
        if partners != 0 {
            ones(partners).for_each(|other| self.meet_less(contacts, contacts.pair(kind.bit(), other)));
        }
    }

    /// The bits of the types with several sprites in a cell.
    #[inline(always)]
    pub(crate) fn crowds_in(&self, cell: usize) -> u64 {
        self.crowds.get(cell).copied().unwrap_or(0)
    }

    /// Notes that several sprites of a type cover a cell.
    #[inline(never)]
    fn crowd(&mut self, kind: &TypeMask, cell: usize) {
        self.crowds.resize(self.masks.len(), 0);
        self.crowds[cell] |= kind.own;
    }

    /// The number of sprites with the bit that cover a cell; stops counting at two.
    #[inline(never)]
    fn count_in(&self, contacts: &Contacts, cell: usize, own: u64) -> u32 {
        let stride = (self.columns + 2) as usize;
        let mut count = 0;
        let reaches =
            [(0, 0), (1, flag::RIGHT), (stride, flag::BELOW), (stride + 1, flag::RIGHT | flag::BELOW)];
        for (back, reach) in reaches {
            let mut at = cell.checked_sub(back).map_or(NONE, |cell| self.cells[cell]);
            while at != NONE {
                let sprite = self.sprite(at);
                if sprite.flags & reach == reach && contacts.kinds[sprite.stype.index()].own == own {
                    count += 1;
                    if count == 2 {
                        return count;
                    }
                }
                at = sprite.cell_next;
            }
        }
        count
    }

    #[inline(never)]
    fn meet_more(&mut self, contacts: &Contacts, pair: usize) {
        self.together[pair] += 1;
        if self.together[pair] == 1 {
            self.toggle_meets(contacts, pair);
            for &pass in &contacts.passes[pair] {
                self.allow(pass);
            }
        }
    }

    #[inline(never)]
    fn meet_less(&mut self, contacts: &Contacts, pair: usize) {
        self.together[pair] -= 1;
        if self.together[pair] == 0 {
            self.toggle_meets(contacts, pair);
            for &pass in &contacts.passes[pair] {
                self.forbid(pass);
            }
        }
    }

    fn toggle_meets(&mut self, contacts: &Contacts, pair: usize) {
        let (one, two) = contacts.ends[pair];
        self.meets[usize::from(one)] ^= 1 << two;
        if one != two {
            self.meets[usize::from(two)] ^= 1 << one;
        }
    }

    /// Tests whether any sprite with this bit may share a cell with any of `others`.
    #[inline]
    pub(crate) fn may_meet(&self, own: u64, others: u64) -> bool {
        self.meets[own.trailing_zeros() as usize] & others != 0 || self.big_bits & (own | others) != 0
    }

    /// Notes the cells that a large sprite covers.
    pub(crate) fn cover(&mut self, kind: &TypeMask, slot: Slot) {
        let mut covered = std::mem::take(&mut self.covered);
        covered.resize(self.cells.len(), 0);
        if !self.covered_by(self.sprite(slot), |cell| covered[cell] |= kind.own) {
            self.vast |= kind.own;
        }
        self.covered = covered;
    }

    /// Recomputes the cells that large sprites cover, once they have left enough of them to make it worthwhile.
    #[inline]
    pub(crate) fn tidy_covered(&mut self, rules: &Rules) {
        if self.left_behind as usize > 4 * self.big as usize + self.cells.len() / 16 {
            self.cover_anew(rules);
        }
    }

    #[inline(never)]
    fn cover_anew(&mut self, rules: &Rules) {
        self.covered.fill(0);
        (self.vast, self.left_behind) = (0, 0);
        for stype in (0..rules.types.len() as u16).map(SpriteType) {
            let kind = &rules.contacts.kinds[stype.index()];
            if self.group(stype).big == 0 || kind.own == 0 {
                continue;
            }
            let mut slot = self.group(stype).head;
            while slot != NONE {
                let sprite = self.sprite(slot);
                let next = sprite.next;
                if sprite.is(flag::BIG) {
                    self.cover(kind, slot);
                }
                slot = next;
            }
        }
    }

    /// Notes that a type has its first sprite larger than a cell.
    pub(crate) fn enlarged(&mut self, contacts: &Contacts, stype: usize) {
        for &pass in &contacts.of_type[stype] {
            self.allow(pass);
        }
    }

    /// Notes that a type has no such sprite any more.
    pub(crate) fn reduced(&mut self, contacts: &Contacts, stype: usize) {
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

    /// The first possible pass from `from` on.
    pub(crate) fn next_possible(&self, from: usize) -> Option<usize> {
        let mut word = from / 64;
        let mut bits = self.possible.get(word)? & (u64::MAX << (from % 64));
        while bits == 0 {
            word += 1;
            bits = *self.possible.get(word)?;
        }
        Some(word * 64 + bits.trailing_zeros() as usize)
    }

    /// The same tables, computed from scratch: tests compare the incremental ones with these. Cost: O(sprites).
    pub(crate) fn contacts_from_scratch(&self, rules: &Rules) -> State {
        let mut state = self.clone();
        state.cells.fill(NONE);
        for group in &mut state.groups {
            (group.multi_cell, group.big, group.off) = (0, 0, 0);
        }
        state.covered.fill(0);
        (state.big, state.off, state.multi_cell_bits) = (0, 0, 0);
        (state.big_bits, state.vast, state.left_behind) = (0, 0, 0);
        state.empty_contacts(&rules.contacts);
        let slots: Vec<Slot> =
            (0..rules.types.len() as u16).flat_map(|t| self.slots(SpriteType(t))).collect();
        for slot in slots {
            match self.sprite(slot).flies() {
                true => state.enter_cell_again(rules, slot),
                false => state.enter_cell(rules, slot),
            }
        }
        state
    }
}
