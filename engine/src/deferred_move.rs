//! Deferred moves: steps into a barrier that puts the sprite back before any other rule has looked at it.
//!
//! A character walks into a wall, and a rule steps it back. Until then the event phase does not look up its position, and
//! afterwards the character is where it was. So the sprite is not entered into the wall's cell and taken out again. Only
//! its rectangle changes, and when the rule's turn comes, one look at the cell decides that the rule is executed. If the
//! wall is gone by then, if another rule may apply first, or if something happens that may affect any sprite, the
//! deferred move is carried out: from then on it is a move like any other.
//!
//! The result is the same (`spec/01` §4, `spec/03` §4): no rule that involves the sprite's type is looked at while the
//! sprite is not entered at its position.

use crate::contacts::Contacts;
use crate::game::{EffectInfo, Pass, SpriteType, TypeInfo};
use crate::geometry::Rect;
use crate::occupancy::Located;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;
use crate::ontology::sprites::Mover;
use crate::state::{NONE, Slot, State, flag};
use crate::step::{Step, Watch};

/// The value of `next_deferred` without deferred moves.
pub(crate) const NEVER: usize = usize::MAX;
/// The maximum number of rules that a deferred move can wait for.
const MAX_GATES: usize = 8;

/// The effect of a rule on a sprite of the type whose [`Barriers`] it is among.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GateKind {
    /// It puts the sprite back to its last place.
    Back,
    /// It puts the sprite beside its partner.
    Flush,
    /// It kills sprites, and neither moves nor makes any.
    Deadly,
    /// Any other effect.
    Other,
}

/// A rule that involves a type, as a pass of the event phase.
#[derive(Clone, Copy, Debug)]
struct PassGate {
    pass: u16,
    kind: GateKind,
    /// The bits of the types with which the rule pairs this one (`contacts.rs`).
    bits: u64,
}

impl PassGate {
    fn bars(&self) -> bool {
        matches!(self.kind, GateKind::Back | GateKind::Flush)
    }
}

/// The rules that put sprites of a type back, and the rules that involve the type before them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Barriers {
    /// The bits of the partners that do not put it back.
    others: u64,
    /// The rules in the order of the event phase, up to the last one that puts the sprite back.
    gates: Vec<PassGate>,
}

/// A sprite that has stepped into a barrier in this tick and is still entered at its old position.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DeferredMove {
    slot: Slot,
    /// The next rule that involves it: one of the gates of its type.
    gate: u16,
    /// The cell of its new corner, and the flags of how it lies there.
    cell: u32,
    flags: u32,
}

/// Computes the barriers of each type, and notes them in its kind as well. Cost: O(passes × types).
pub(crate) fn barriers(
    types: &[TypeInfo],
    passes: &[Pass],
    effects: &[EffectInfo],
    contacts: &mut Contacts,
    movers: &[Mover],
) -> Vec<Barriers> {
    let walks = |info: &TypeInfo| {
        info.class.is_some_and(|class| class.is_avatar() || class.is_a(SpriteClass::RandomNPC))
    };
    let is_whole = |info: &TypeInfo| info.traits.width_factor == 1.0 && info.traits.height_factor == 1.0;
    let fills_its_cell = |stype: &SpriteType| {
        let info = &types[stype.index()];
        let is_still = !walks(info) && movers.iter().all(|mover| mover.stype != *stype);
        is_still && is_whole(info) && contacts.sole_bit(stype.index()) != 0
    };
    let kind = |stype: SpriteType, pass: &Pass| {
        let EffectInfo { effect, score_change, score_faults, counting, in_batch, steady, .. } =
            &effects[usize::from(pass.effect)];
        let free = *score_change == 0 && *score_faults == [false; 2] && counting.is_none();
        let (first, second) = (&types[pass.first.index()], &types[pass.second.index()]);
        let bars = first.in_tree(stype) && second.tree.iter().all(fills_its_cell);
        match effect {
            Effect::StepBack { pixel_perfect } if free && bars && !in_batch && !steady => {
                if *pixel_perfect {
                    GateKind::Flush
                } else {
                    GateKind::Back
                }
            }
            Effect::KillSprite | Effect::KillBoth => GateKind::Deadly,
            _ => GateKind::Other,
        }
    };
    let of_type = |(number, info): (u16, &TypeInfo)| {
        let stype = SpriteType(number);
        if !walks(info) || !is_whole(info) || info.traits.continuous {
            return (Barriers::default(), 0);
        }
        let gate = |&at: &u16| {
            let pass = &passes[usize::from(at)];
            let sides = contacts.sides(usize::from(at));
            let with =
                |side: SpriteType, bits: u64| if types[side.index()].in_tree(stype) { bits } else { 0 };
            let bits = with(pass.first, sides.1) | with(pass.second, sides.0);
            PassGate { pass: at, kind: kind(stype, pass), bits }
        };
        let mut gates: Vec<PassGate> = contacts.passes_of(stype).iter().take(MAX_GATES).map(gate).collect();
        gates.truncate(gates.iter().rposition(PassGate::bars).map_or(0, |last| last + 1));
        let bits =
            |bar: bool| gates.iter().filter(|gate| gate.bars() == bar).fold(0, |bits, gate| bits | gate.bits);
        let (bars, others) = (bits(true), bits(false));
        (Barriers { others, gates }, bars)
    };
    let (barriers, bits): (Vec<Barriers>, Vec<u64>) = (0u16..).zip(types).map(of_type).unzip();
    for (kind, bits) in contacts.kinds.iter_mut().zip(bits) {
        kind.barriers = bits;
    }
    barriers
}

impl State {
    /// The bits of all types in the cells that a small sprite covers.
    #[inline(always)]
    fn bits_under(&self, cell: usize, flags: u32) -> u64 {
        let bits = |cell: usize| self.masks[cell];
        let below = cell + (self.columns + 2) as usize;
        match (flags & flag::RIGHT != 0, flags & flag::BELOW != 0) {
            (false, false) => bits(cell),
            (true, false) => bits(cell) | bits(cell + 1),
            (false, true) => bits(cell) | bits(below),
            (true, true) => bits(cell) | bits(cell + 1) | bits(below) | bits(below + 1),
        }
    }
}

impl Step<'_> {
    /// Defers a move into a barrier. Returns `false` if there is none: the move is like any other.
    #[inline(always)]
    pub(crate) fn defer_move(&mut self, slot: Slot, aim: Rect, from: Located, to: Located) -> bool {
        let barriers = self.rules.contacts.kinds[self.state.sprite(slot).stype.index()].barriers;
        if barriers == 0 || from == to || (from.flags | to.flags) & (flag::BIG | flag::OFF) != 0 {
            return false;
        }
        let cell = self.state.cell(i32::from(to.column), i32::from(to.row));
        self.state.bits_under(cell, to.flags) & barriers != 0
            && self.defer_move_into(slot, aim, from, (cell, to.flags))
    }

    #[inline(never)]
    pub(crate) fn defer_move_into(
        &mut self,
        slot: Slot,
        aim: Rect,
        from: Located,
        (cell, flags): (usize, u32),
    ) -> bool {
        let sprite = self.state.sprite(slot);
        let barriers = &self.rules.barriers[sprite.stype.index()];
        let before = self.state.cell(i32::from(from.column), i32::from(from.row));
        if sprite.is(flag::MOVED) {
            return false;
        }
        if self.sleeps && (self.is_watched(before, from.flags) || self.is_watched(cell, flags)) {
            return false;
        }
        if barriers.others != 0 {
            // Two sprites in the same place might meet there before they are put back.
            let crowded = |deferred: &DeferredMove| self.state.sprite(deferred.slot).rect.intersects(aim);
            let under = self.state.bits_under(before, from.flags) | self.state.bits_under(cell, flags);
            let own = self.rules.contacts.kinds[sprite.stype.index()].own;
            if under & barriers.others & !own != 0 || self.state.deferred.iter().any(crowded) {
                return false;
            }
        }
        self.next_deferred = self.next_deferred.min(usize::from(barriers.gates[0].pass));
        self.state.deferred.push(DeferredMove { slot, gate: 0, cell: cell as u32, flags });
        let sprite = &mut self.state.sprites[usize::from(slot)];
        sprite.rect = aim;
        sprite.flags |= flag::DEFERRED;
        if sprite.flags & (flag::DIRTY | flag::NO_COOLDOWN) == 0 {
            sprite.flags |= flag::DIRTY;
            self.state.dirty.push(slot);
        }
        true
    }

    /// Tests whether a sleeping sprite watches a cell that a small sprite covers: it would be woken.
    fn is_watched(&self, cell: usize, flags: u32) -> bool {
        self.state.span(cell, flags).cells().any(|cell| self.state.watched[cell] > 0)
    }

    /// Settles the deferred moves that wait for the next pass. `looked_at` tells whether the pass is possible.
    #[inline(never)]
    pub(crate) fn settle_deferred(&mut self, looked_at: bool, watch: &mut impl Watch) {
        let rules = self.rules;
        let pass = std::mem::replace(&mut self.next_deferred, NEVER);
        self.pass = pass as i32;
        let mut at = 0;
        while let Some(&deferred) = self.state.deferred.get(at) {
            let sprite = self.state.sprite(deferred.slot);
            let gates = &rules.barriers[sprite.stype.index()].gates[..];
            let mut next = usize::from(deferred.gate);
            if sprite.is(flag::DEFERRED) && usize::from(gates[next].pass) == pass {
                match self.meets(&deferred, gates[next], looked_at) {
                    Some(true) => {
                        self.put_back(deferred.slot);
                        watch.interaction(rules.effects[usize::from(rules.passes[pass].effect)].line);
                        next = gates.len();
                    }
                    Some(false) => next += 1,
                    None => next = gates.len(),
                }
                if next == gates.len() {
                    self.carry_out(deferred.slot);
                }
            }
            if next < gates.len() && self.state.sprite(deferred.slot).is(flag::DEFERRED) {
                self.state.deferred[at].gate = next as u16;
                self.next_deferred = self.next_deferred.min(usize::from(gates[next].pass));
                at += 1;
            } else {
                self.state.deferred.swap_remove(at);
            }
        }
    }

    /// Tests whether a rule puts a sprite with a deferred move back; `Some(false)` if the rule does not apply to it,
    /// `None` if the move is to be carried out.
    fn meets(&self, deferred: &DeferredMove, gate: PassGate, looked_at: bool) -> Option<bool> {
        let state = &*self.state;
        let sprite = state.sprite(deferred.slot);
        let under = state.bits_under(deferred.cell as usize, deferred.flags) & gate.bits != 0;
        let unsure = state.big_bits & gate.bits != 0
            || state.avatar == NONE
            || !state.shields.is_empty()
            || sprite.is(flag::KILLED | flag::DISABLED);
        if unsure {
            return None;
        }
        match gate.kind {
            GateKind::Other => (!looked_at && !under).then_some(false),
            GateKind::Deadly => (!under).then_some(false),
            _ if state.multi_cell_bits & gate.bits != 0 => None,
            _ if !under => Some(false),
            GateKind::Back => Some(true),
            GateKind::Flush => {
                // The place beside a barrier that fills its cell is where the sprite was, if it crossed the border of its
                // own cell.
                let last = state.last(deferred.slot);
                let (x, y) = (sprite.rect.x - last.x, sprite.rect.y - last.y);
                let lay = if y == 0 { flag::RIGHT } else { flag::BELOW };
                let straight = (x == 0 || y == 0) && (x + y).abs() <= state.block && !sprite.is(lay);
                let beside = state.bits_under(state.cell_of(sprite), sprite.flags) & gate.bits == 0;
                (straight && beside && last.w == state.block && last.h == state.block).then_some(true)
            }
        }
    }

    fn put_back(&mut self, slot: Slot) {
        let last = self.state.last(slot);
        let sprite = &mut self.state.sprites[usize::from(slot)];
        sprite.rect = last;
        sprite.flags &= !flag::DEFERRED;
        self.work_of_effect();
    }

    /// Carries out all deferred moves.
    pub(crate) fn carry_out_deferred(&mut self) {
        if self.next_deferred != NEVER {
            self.next_deferred = NEVER;
            while let Some(deferred) = self.state.deferred.pop() {
                self.carry_out(deferred.slot);
            }
        }
    }

    /// Carries out the deferred move of a sprite, if it has one.
    #[inline(never)]
    pub(crate) fn carry_out(&mut self, slot: Slot) {
        let last = self.state.last(slot);
        let sprite = &mut self.state.sprites[usize::from(slot)];
        if sprite.is(flag::DEFERRED) {
            sprite.flags &= !flag::DEFERRED;
            let aim = std::mem::replace(&mut sprite.rect, last);
            self.place(slot, aim);
        }
    }
}
