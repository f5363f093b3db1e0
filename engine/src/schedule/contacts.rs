//! The currently possible interactions, updated as sprites enter and leave cells. A tick examines only rules
//! whose two sides share a cell somewhere.
//!
//! Every type that takes part in a rule has a bit, and each board cell has a mask with the bits of the types
//! in the cell (`occupancy.rs`). For each pair of bits with a rule, a counter stores the number of cells
//! whose mask contains both. For each pass in the event phase, another counter stores how many of its pairs
//! share a cell. The pass is skipped if there are none.
//!
//! A sprite larger than a cell is in the mask of only one cell, so a pass with such a sprite on either side
//! also counts as possible. The cells that large sprites cover are stored separately.

use super::Schedule;
use crate::rules::Rules;
use crate::world::{Models, World, ones};

/// The index that stands for no pair.
const NO: u16 = u16::MAX;

/// The lookup tables for the interactions of a game. They are computed once and never change during play.
#[derive(Clone, Debug, Default)]
pub(crate) struct Contacts {
    bits: usize,
    /// For each pair of bits, the pair's index.
    pair: Vec<u16>,
    /// For each pair, the passes that involve the pair.
    passes: Vec<Box<[u16]>>,
    /// For each type, the passes that involve the type.
    of_type: Vec<Box<[u16]>>,
    /// The number of passes.
    passes_in_all: usize,
    /// The passes that are always possible, because testing the ground below has an effect in itself for some
    /// classes.
    always: Vec<u16>,
}

impl Contacts {
    /// Computes the tables. Cost: O(types² + passes × size of the largest trees).
    pub(crate) fn of(rules: &Rules, models: &Models) -> Contacts {
        let (types, bits) = (&rules.types, models.used_bits);
        let mut contacts = Contacts {
            bits,
            pair: vec![NO; bits * bits],
            passes_in_all: rules.passes.len(),
            ..Contacts::default()
        };
        let mut of_pair: Vec<Vec<u16>> = Vec::new();
        let mut of_type: Vec<Vec<u16>> = vec![Vec::new(); types.len()];
        for (number, pass) in (0u16..).zip(&rules.passes) {
            let (first, second) = (&types[pass.first.index()].tree, &types[pass.second.index()].tree);
            for &stype in first.iter().chain(second) {
                let passes = &mut of_type[stype.index()];
                if passes.last() != Some(&number) {
                    passes.push(number);
                }
            }
            for one in ones(models.all(first)) {
                for two in ones(models.all(second)) {
                    let (low, high) = (one.min(two), one.max(two));
                    let pair = &mut contacts.pair[low * bits + high];
                    if *pair == NO {
                        *pair = of_pair.len() as u16;
                        of_pair.push(Vec::new());
                    }
                    let pair = *pair;
                    contacts.pair[high * bits + low] = pair;
                    let passes = &mut of_pair[usize::from(pair)];
                    if passes.last() != Some(&number) {
                        passes.push(number);
                    }
                }
            }
            if first.iter().any(|stype| types[stype.index()].ground_aware) {
                contacts.always.push(number);
            }
        }
        contacts.passes = of_pair.into_iter().map(Vec::into_boxed_slice).collect();
        contacts.of_type = of_type.into_iter().map(Vec::into_boxed_slice).collect();
        contacts
    }

    fn pair(&self, one: usize, two: usize) -> usize {
        usize::from(self.pair[one * self.bits + two])
    }
}

impl Schedule {
    /// Resets the tables to an empty board.
    pub(crate) fn empty_contacts(&mut self, contacts: &Contacts) {
        self.together = vec![0; contacts.passes.len()];
        self.meets = vec![0; contacts.bits];
        self.reasons = vec![0; contacts.passes_in_all];
        self.possible = vec![0; contacts.passes_in_all.div_ceil(64)];
        for &pass in &contacts.always {
            self.allow(pass);
        }
    }

    /// Records that sprites of two types, identified by their bits, now share a cell.
    #[inline(never)]
    fn begin_to_meet(&mut self, contacts: &Contacts, one: usize, two: usize) {
        self.meets[one] |= 1 << two;
        self.meets[two] |= 1 << one;
        for &pass in &contacts.passes[contacts.pair(one, two)] {
            self.allow(pass);
        }
    }

    /// Records that sprites of two types, identified by their bits, no longer share any cell.
    #[inline(never)]
    fn cease_to_meet(&mut self, contacts: &Contacts, one: usize, two: usize) {
        self.meets[one] &= !(1 << two);
        self.meets[two] &= !(1 << one);
        for &pass in &contacts.passes[contacts.pair(one, two)] {
            self.forbid(pass);
        }
    }

    /// Returns `true` if a sprite with the type bit `own` may share a cell with a sprite that has any of the
    /// type bits `others`.
    #[inline]
    pub(crate) fn may_meet(&self, world: &World, own: u64, others: u64) -> bool {
        self.meets[own.trailing_zeros() as usize] & others != 0 || world.is_big(own | others)
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

    /// Returns the first possible pass with an index of at least `from`; `None` if there is no such pass.
    pub(crate) fn next_possible(&self, from: usize) -> Option<usize> {
        let mut word = from / 64;
        let mut bits = self.possible.get(word)? & (u64::MAX << (from % 64));
        while bits == 0 {
            word += 1;
            bits = *self.possible.get(word)?;
        }
        Some(word * 64 + bits.trailing_zeros() as usize)
    }

    /// Implements [`Watcher::arrives`](crate::world::Watcher).
    #[inline(always)]
    pub(crate) fn arrives(&mut self, contacts: &Contacts, own: u64, partners: u64) {
        let own = own.trailing_zeros() as usize;
        for other in ones(partners) {
            let cells = &mut self.together[contacts.pair(own, other)];
            *cells += 1;
            if *cells == 1 {
                self.begin_to_meet(contacts, own, other);
            }
        }
    }

    #[inline(always)]
    pub(crate) fn departs(&mut self, contacts: &Contacts, own: u64, partners: u64) {
        let own = own.trailing_zeros() as usize;
        for other in ones(partners) {
            let cells = &mut self.together[contacts.pair(own, other)];
            *cells -= 1;
            if *cells == 0 {
                self.cease_to_meet(contacts, own, other);
            }
        }
    }

    pub(crate) fn enlarged(&mut self, contacts: &Contacts, stype: usize) {
        for &pass in &contacts.of_type[stype] {
            self.allow(pass);
        }
    }

    pub(crate) fn reduced(&mut self, contacts: &Contacts, stype: usize) {
        for &pass in &contacts.of_type[stype] {
            self.forbid(pass);
        }
    }
}
