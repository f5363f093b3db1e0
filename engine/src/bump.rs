//! Bumps: steps into what puts the sprite back before any other rule has noticed.
//!
//! A character walks into a wall, and a rule steps it back. Until then the event phase has not asked where it is, and when it
//! goes on, the character is where it was. So it is not entered in the wall's cell and taken out again: it stands there for
//! those who read its place, and when the rule's turn comes, one look at the cell tells that it is executed. If the wall is
//! gone by then, if a rule before it is looked at at all, or if something happens that may concern all, the step is made up
//! for: from then on it is a move like any other.
//!
//! No one can tell the difference (`spec/01` §4, `spec/03` §4): a rule that is about the sprite's type is never looked at while
//! the sprite is not entered where it is.

use crate::contacts::Contacts;
use crate::game::{EffectInfo, Pass, SpriteType, TypeInfo};
use crate::geometry::Rect;
use crate::occupancy::Located;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;
use crate::ontology::sprites::Mover;
use crate::state::{NONE, Slot, State, flag};
use crate::step::{Step, Watch};

/// The pass of no bump.
pub(crate) const NEVER: usize = usize::MAX;
/// Rules that a bump waits for, at most.
const MAX_GATES: usize = 8;

/// What a rule does to a sprite of the type whose [`Barriers`] it is among.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum GateKind {
    /// It puts the sprite where it was.
    Back,
    /// It puts the sprite beside its partner.
    Flush,
    /// It ends sprites, and moves and makes none.
    Deadly,
    /// Anything.
    Other,
}

/// A rule that is about a type, in a pass of the event phase.
#[derive(Clone, Copy, Debug)]
struct Gate {
    pass: u16,
    kind: GateKind,
    /// The bits of the types with which it is about this one (`contacts.rs`).
    bits: u64,
}

impl Gate {
    fn bars(&self) -> bool {
        matches!(self.kind, GateKind::Back | GateKind::Flush)
    }
}

/// What puts sprites of a type back, and what else is about them before.
#[derive(Clone, Debug, Default)]
pub(crate) struct Barriers {
    /// The bits of those that do not put it back.
    others: u64,
    /// In the order of the event phase, up to the last that puts it back.
    gates: Vec<Gate>,
}

/// A sprite that has stepped into a barrier in this tick, and is entered where it comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bump {
    slot: Slot,
    /// The next rule that is about it: one of the gates of its type.
    gate: u16,
    /// The cell of its corner, and how it lies there.
    cell: u32,
    flags: u32,
}

/// The barriers of each type, noted in its kind as well. Cost: O(passes × types).
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
            Gate { pass: at, kind: kind(stype, pass), bits }
        };
        let mut gates: Vec<Gate> = contacts.passes_of(stype).iter().take(MAX_GATES).map(gate).collect();
        gates.truncate(gates.iter().rposition(Gate::bars).map_or(0, |last| last + 1));
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
    /// The bits of all that cover cells that a small sprite covers.
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
    /// Steps into a barrier, if there is one where the sprite is about to go; false: it is a move like any other.
    #[inline(always)]
    pub(crate) fn bump(&mut self, slot: Slot, aim: Rect, from: Located, to: Located) -> bool {
        let barriers = self.rules.contacts.kinds[self.state.sprite(slot).stype.index()].barriers;
        if barriers == 0 || from == to || (from.flags | to.flags) & (flag::BIG | flag::OFF) != 0 {
            return false;
        }
        let cell = self.state.cell(i32::from(to.column), i32::from(to.row));
        self.state.bits_under(cell, to.flags) & barriers != 0
            && self.bump_into(slot, aim, from, (cell, to.flags))
    }

    #[inline(never)]
    pub(crate) fn bump_into(
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
        if self.rests && (self.is_watched(before, from.flags) || self.is_watched(cell, flags)) {
            return false;
        }
        if barriers.others != 0 {
            // Two that are in the same place might meet there before they are put back.
            let crowded = |bump: &Bump| self.state.sprite(bump.slot).rect.intersects(aim);
            let under = self.state.bits_under(before, from.flags) | self.state.bits_under(cell, flags);
            let own = self.rules.contacts.kinds[sprite.stype.index()].own;
            if under & barriers.others & !own != 0 || self.state.bumps.iter().any(crowded) {
                return false;
            }
        }
        self.next_bump = self.next_bump.min(usize::from(barriers.gates[0].pass));
        self.state.bumps.push(Bump { slot, gate: 0, cell: cell as u32, flags });
        let sprite = &mut self.state.sprites[usize::from(slot)];
        sprite.rect = aim;
        sprite.flags |= flag::BUMPING;
        if sprite.flags & (flag::STALE | flag::BRISK) == 0 {
            sprite.flags |= flag::STALE;
            self.state.stale.push(slot);
        }
        true
    }

    /// Whether something at rest has an eye on cells that a small sprite covers: it would be woken.
    fn is_watched(&self, cell: usize, flags: u32) -> bool {
        self.state.span(cell, flags).cells().any(|cell| self.state.watched[cell] > 0)
    }

    /// The turn of the next pass that is about somebody who has bumped. `looked_at`: whether the pass is possible.
    #[inline(never)]
    pub(crate) fn settle_bumps(&mut self, looked_at: bool, watch: &mut impl Watch) {
        let rules = self.rules;
        let pass = std::mem::replace(&mut self.next_bump, NEVER);
        self.pass = pass as i32;
        let mut at = 0;
        while let Some(&bump) = self.state.bumps.get(at) {
            let sprite = self.state.sprite(bump.slot);
            let gates = &rules.barriers[sprite.stype.index()].gates[..];
            let mut next = usize::from(bump.gate);
            if sprite.is(flag::BUMPING) && usize::from(gates[next].pass) == pass {
                match self.meets(&bump, gates[next], looked_at) {
                    Some(true) => {
                        self.put_back(bump.slot);
                        watch.interaction(rules.effects[usize::from(rules.passes[pass].effect)].line);
                        next = gates.len();
                    }
                    Some(false) => next += 1,
                    None => next = gates.len(),
                }
                if next == gates.len() {
                    self.carry_out(bump.slot);
                }
            }
            if next < gates.len() && self.state.sprite(bump.slot).is(flag::BUMPING) {
                self.state.bumps[at].gate = next as u16;
                self.next_bump = self.next_bump.min(usize::from(gates[next].pass));
                at += 1;
            } else {
                self.state.bumps.swap_remove(at);
            }
        }
    }

    /// Whether a rule puts a sprite back that has bumped, or is not about it; None: it is to be entered where it is.
    fn meets(&self, bump: &Bump, gate: Gate, looked_at: bool) -> Option<bool> {
        let state = &*self.state;
        let sprite = state.sprite(bump.slot);
        let under = state.bits_under(bump.cell as usize, bump.flags) & gate.bits != 0;
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
            _ if state.loose_bits & gate.bits != 0 => None,
            _ if !under => Some(false),
            GateKind::Back => Some(true),
            GateKind::Flush => {
                // Beside a barrier that fills its cell is where the sprite was, if it came over the border of its own.
                let last = state.last(bump.slot);
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
        sprite.flags &= !flag::BUMPING;
        self.work_of_effect();
    }

    /// All bumps become moves like any other.
    pub(crate) fn carry_out_bumps(&mut self) {
        if self.next_bump != NEVER {
            self.next_bump = NEVER;
            while let Some(bump) = self.state.bumps.pop() {
                self.carry_out(bump.slot);
            }
        }
    }

    /// Enters a sprite where it has stepped, if it has bumped.
    #[inline(never)]
    pub(crate) fn carry_out(&mut self, slot: Slot) {
        let last = self.state.last(slot);
        let sprite = &mut self.state.sprites[usize::from(slot)];
        if sprite.is(flag::BUMPING) {
            sprite.flags &= !flag::BUMPING;
            let aim = std::mem::replace(&mut sprite.rect, last);
            self.place(slot, aim);
        }
    }
}
