//! The state of an episode: flat arrays without pointers to the rules (`docs/decisions/0004-state-as-flat-data.md`).
//!
//! Sprites live in the slots of one array. Two linked lists (chains) run through the slots: the sprites of one type in
//! the order of their creation (a group in the reference), and the sprites in one cell of the board (`occupancy.rs`).
//! Effects read and write sprites only through the methods here and in `population.rs` and `motion.rs`, so that the
//! layout can change without them.

use crate::chance::Chance;
use crate::contribution::{Contribution, HashClass, Sum};
use crate::flight::Flight;
use crate::game::{Action, Outcome, Rules, SpriteType};
use crate::geometry::Rect;
use crate::limits::MAX_SLOTS;
use crate::moved::Resized;
use crate::overrides::{Extra, Overrides, Target};
use crate::paths::Paths;
use crate::scenery::Scenery;
use crate::side_tables::{Held, Replaced};
use crate::sleep::{Sleeper, mark};
use std::sync::Arc;

/// An index into the sprites of a state.
pub(crate) type Slot = u16;
/// No sprite.
pub(crate) const NONE: Slot = u16::MAX;

/// Bits of [`Sprite::flags`]; the first four are those that traces record.
pub(crate) mod flag {
    /// A killed avatar: it stays in its group but is no longer updated.
    pub(crate) const DISABLED: u32 = 1;
    pub(crate) const AVATAR: u32 = 2;
    pub(crate) const FROM_AVATAR: u32 = 4;
    /// The sprite stands on something solid; only for classes that detect it.
    pub(crate) const ON_GROUND: u32 = 8;
    /// The bits that traces record.
    pub(crate) const RECORDED: u32 = 15;
    pub(crate) const FIRST_TICK: u32 = 16;
    pub(crate) const ORIENTED: u32 = 32;
    /// The sprite is in the kill list.
    pub(crate) const KILLED: u32 = 64;
    /// The sprite is not updated, and `moved_at` holds its age: its type is not in the update order, or it is of an avatar
    /// class and not the player's, or disabled.
    pub(crate) const FROZEN: u32 = 128;
    /// The sprite is in `State::moved`: its last rectangle differs from its rectangle, or may.
    pub(crate) const MOVED: u32 = 256;
    /// The dirty flag. The sprite is in `State::dirty`: the running hash may contain an older version of it.
    pub(crate) const DIRTY: u32 = 512;
    /// The slot is free.
    pub(crate) const FREE: u32 = 1024;
    /// The sprite is not wholly on the screen.
    pub(crate) const OFF: u32 = 2048;
    /// The sprite is no larger than a cell, and covers the cell to the right too.
    pub(crate) const RIGHT: u32 = 4096;
    /// The sprite is no larger than a cell, and covers the cell below too.
    pub(crate) const BELOW: u32 = 8192;
    /// The sprite is larger than a cell.
    pub(crate) const BIG: u32 = 16_384;
    /// The sprite covers more than one cell, or may.
    pub(crate) const MULTI_CELL: u32 = RIGHT | BELOW | BIG;
    /// The cooldown never delays the sprite, so the tick of its last move does not matter.
    pub(crate) const NO_COOLDOWN: u32 = 32_768;
    /// More of the hash contribution has changed than what comes with moving.
    pub(crate) const CHANGED: u32 = 65_536;
    /// The sprite is in `State::resized`: it had another size at the start of its update.
    pub(crate) const RESIZED: u32 = 262_144;
    /// The bits of how a sprite lies in its cell.
    pub(crate) const PLACEMENT: u32 = MULTI_CELL | OFF;
    /// Spawner: it has been updated, and `Overrides::start` is the tick of the first update.
    pub(crate) const STARTED: u32 = 524_288;
    /// NPC: the position of the highest bits, with the last drawn direction as an index into the base directions, 4 for
    /// none.
    pub(crate) const HEADING: u32 = 29;
    /// The bits that are part of the state; the others are bookkeeping, in which two equal states may differ.
    pub(crate) const LASTING: u32 = 0xFF;
}

/// One sprite: the size of a cache line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sprite {
    pub(crate) rect: Rect,
    /// The corner at the start of its own update in this tick (`moved.rs`).
    pub(crate) last_corner: (i32, i32),
    /// The creation number, never reused.
    pub(crate) id: u32,
    /// The tick of the last move; the reference's `lastmove` is the tick minus this.
    pub(crate) moved_at: i32,
    pub(crate) time_to_live: i32,
    /// Flicker: its age. NPC: the number of repetitions of the last direction. Spawner: the number of sprites that it has
    /// spawned.
    pub(crate) count: i32,
    pub(crate) flags: u32,
    pub(crate) stype: SpriteType,
    /// Index into `State::overrides`: the entry of its type, or one of its own.
    pub(crate) overrides: u16,
    /// The events of this tick that matter for sleep, and the period in flight (`sleep.rs`).
    pub(crate) activity: u16,
    /// The chain of the type.
    pub(crate) next: Slot,
    pub(crate) previous: Slot,
    /// The chain of the cell.
    pub(crate) cell_next: Slot,
    pub(crate) cell_previous: Slot,
    /// The cell's column and row, counted with the ring around the board.
    pub(crate) column: i16,
    pub(crate) row: i16,
}

const _: () = assert!(size_of::<Sprite>() == 64);

impl Sprite {
    pub(crate) fn is(&self, flag: u32) -> bool {
        self.flags & flag != 0
    }

    /// NPC: the last drawn direction as an index into the base directions, 4 for none.
    #[inline(always)]
    pub(crate) fn heading(&self) -> u32 {
        self.flags >> flag::HEADING
    }

    #[inline(always)]
    pub(crate) fn set_heading(&mut self, heading: u32) {
        self.flags = self.flags & !(7 << flag::HEADING) | heading << flag::HEADING;
    }

    /// Tests whether it is in flight (`flight.rs`).
    #[inline(always)]
    pub(crate) fn flies(&self) -> bool {
        self.activity > mark::SLEEPING
    }

    /// The number of ticks between its moves in flight.
    #[inline(always)]
    pub(crate) fn period(&self) -> u16 {
        self.activity & !mark::SKIPPED
    }

    pub(crate) fn set(&mut self, flag: u32, on: bool) {
        if on {
            self.flags |= flag;
        } else {
            self.flags &= !flag;
        }
    }
}

/// The sprites of one type, in order of creation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Group {
    pub(crate) head: Slot,
    pub(crate) tail: Slot,
    pub(crate) count: u16,
    pub(crate) disabled: u16,
    /// The number of sprites that cover more than one cell, or may.
    pub(crate) multi_cell: u16,
    /// The number of sprites that are larger than a cell.
    pub(crate) big: u16,
    /// The number of sprites that are not wholly on the screen.
    pub(crate) off: u16,
    /// The number of sprites that are asleep or in flight.
    pub(crate) skipped: u16,
}

impl Group {
    pub(crate) const EMPTY: Group =
        Group { head: NONE, tail: NONE, count: 0, disabled: 0, multi_cell: 0, big: 0, off: 0, skipped: 0 };
}

/// A timer of the time phase: the timed effect, and the tick in which it is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Timer {
    pub(crate) due: i32,
    pub(crate) timed: u16,
}

/// The memory of an effect between executions (`spec/03` §13), as bits of one byte per effect.
pub(crate) mod memory {
    /// The score changes when the effect runs; many effects set this as they go.
    pub(crate) const APPLY_SCORE: u8 = 1;
    /// subtractHealthPoints: the last execution killed.
    pub(crate) const KILLED: u8 = 2;
    /// `counter` does not count; some effects set this as they go.
    pub(crate) const NO_COUNT: u8 = 4;
    /// `counterElse` does not count.
    pub(crate) const NO_COUNT_ELSE: u8 = 8;
}

/// The state of an episode.
///
/// `clone` copies the random number generator too; planners use [`State::fork`]. `clone_from` reuses buffers and does not
/// allocate once they have grown.
#[derive(Debug)]
pub struct State {
    pub(crate) tick: i32,
    pub(crate) score: i64,
    pub(crate) outcome: Outcome,
    pub(crate) chance: Chance,
    pub(crate) last_action: Action,
    pub(crate) avatar: Slot,
    pub(crate) next_id: u32,
    /// The reference's sprite counter, including its drift (`spec/03` §5.1).
    pub(crate) population: i32,
    /// Messages logged so far: more than 25 end the game.
    pub(crate) messages: u32,
    pub(crate) block: i32,
    pub(crate) columns: i32,
    pub(crate) rows: i32,
    pub(crate) free: Slot,
    /// The flag that lets counters end the game; StopCounter writes it.
    pub(crate) can_end: bool,
    /// The sum of `contributions`, without the growth of sprites in flight.
    pub(crate) sum: Sum,
    /// The number of sprites that are larger than a cell.
    pub(crate) big: u32,
    /// The number of sprites that are not wholly on the screen.
    pub(crate) off: u32,
    /// The bits of the types with sprites that cover more than one cell.
    pub(crate) multi_cell_bits: u64,
    /// The bits of the types with sprites that are larger than a cell.
    pub(crate) big_bits: u64,
    pub(crate) sprites: Vec<Sprite>,
    /// By slot: the hash contribution of the sprite when the hash was last settled.
    pub(crate) contributions: Vec<Contribution>,
    /// The linear hash classes of the sprites in flight, when the hash was last settled.
    pub(crate) hash_classes: Vec<HashClass>,
    pub(crate) groups: Vec<Group>,
    /// `true` if the counts of `groups` have changed since terminations looked at them.
    pub(crate) census_changed: bool,
    pub(crate) cells: Vec<Slot>,
    /// By cell: the bits of the types that cover it (`contacts.rs`).
    pub(crate) masks: Vec<u64>,
    /// By cell: the bits of the types with several sprites in it; empty as long as there are none.
    pub(crate) crowds: Vec<u64>,
    /// By cell: the bits of the large sprites that cover it, or did so recently; empty if there are none.
    pub(crate) covered: Vec<u64>,
    /// The number of times that such a sprite has left cells since `covered` was recomputed.
    pub(crate) left_behind: u32,
    /// The bits of sprites so large that they count as being everywhere.
    pub(crate) vast: u64,
    /// By pair of bits: the number of cells that contain both.
    pub(crate) together: Vec<u16>,
    /// By bit: the bits that share a cell with it anywhere.
    pub(crate) meets: Vec<u64>,
    /// By pass: the number of reasons to look at it.
    pub(crate) reasons: Vec<u16>,
    /// The passes with a reason, as a bit set.
    pub(crate) possible: Vec<u64>,
    pub(crate) moved: Vec<Slot>,
    /// The sprites in `moved` that have another size now, sorted by slot.
    pub(crate) resized: Vec<Resized>,
    pub(crate) dirty: Vec<Slot>,
    pub(crate) killed: Vec<Slot>,
    /// The resources that sprites hold, sorted by holder and resource.
    pub(crate) held: Vec<Held>,
    pub(crate) memory: Vec<u8>,
    /// The hash of `memory` and `templates` when last settled.
    pub(crate) memory_hash: u64,
    pub(crate) memory_is_dirty: bool,
    /// By type: not 0 if a sprite has been made before; later ones are copies (`spec/02` §1.3).
    pub(crate) templates: Vec<u8>,
    /// This tick's shields, sorted: type, partner, effect keyword (`spec/03` §5.7).
    pub(crate) shields: Vec<(SpriteType, SpriteType, u16)>,
    /// Sprites that a pullWithIt effect has carried in this tick, sorted.
    pub(crate) pulled: Vec<(u16, Slot)>,
    /// The overridable values of the types, and the overrides of sprites (`overrides.rs`).
    pub(crate) overrides: Vec<Overrides>,
    pub(crate) extras: Vec<Extra>,
    /// The sleeping sprites (`sleep.rs`).
    pub(crate) sleepers: Vec<Sleeper>,
    /// By cell: the number of sleeping sprites that watch it.
    pub(crate) watched: Vec<u8>,
    /// By cell: the tick of the last permanent change, or the tick up to which a sprite flies there.
    pub(crate) stamps: Vec<i16>,
    /// The sprites in flight (`flight.rs`), and the tick in which the next one is due.
    pub(crate) flights: Vec<Flight>,
    pub(crate) next_due: i32,
    /// Watched cells that a sprite has entered or left, within a step.
    pub(crate) touched: Vec<u32>,
    /// Scheduled timed effects, the next one last (`spec/03` §6.2).
    pub(crate) timers: Vec<Timer>,
    /// The path finding tables (`paths.rs`); `None` without `obs=`. All states of a level share them.
    pub(crate) paths: Option<Arc<Paths>>,
    /// The scenery (`scenery.rs`); `None` if there is none. All states of a level share it.
    pub(crate) scenery: Option<Arc<Scenery>>,
    /// Entries of BomberRandomMissiles' lists that updateSpawnType has replaced, sorted by holder and place.
    pub(crate) replaced: Vec<Replaced>,
    /// The game's counters.
    pub(crate) counters: Vec<i32>,
    /// The second random stream, for WalkerJumper and for choices that the reference makes without a seed.
    pub(crate) jumps: Chance,
}

macro_rules! clone_fields {
    ($to:ident, $from:ident; copy $($scalar:ident)*; buffers $($buffer:ident)*; empty $($empty:ident)*; shared $($shared:ident)*) => {
        impl Clone for State {
            fn clone(&self) -> State {
                let $from = self;
                State {
                    $($scalar: $from.$scalar,)*
                    $($buffer: $from.$buffer.clone(),)*
                    $($empty: Vec::new(),)*
                    $($shared: $from.$shared.clone(),)*
                }
            }

            fn clone_from(&mut self, $from: &State) {
                let $to = self;
                $($to.$scalar = $from.$scalar;)*
                $(if $from.$buffer.is_empty() {
                    // Many buffers are empty: copying nothing would cost a call.
                    $to.$buffer.clear();
                } else {
                    $to.$buffer.clone_from(&$from.$buffer);
                })*
                // These hold nothing between steps.
                $($to.$empty.clear();)*
                // Updating the reference count has a cost, and is seldom needed.
                $(if $to.$shared.as_ref().map(Arc::as_ptr) != $from.$shared.as_ref().map(Arc::as_ptr) {
                    $to.$shared.clone_from(&$from.$shared);
                })*
            }
        }
    };
}

clone_fields! { to, from;
    copy tick score outcome chance last_action avatar next_id population messages block columns rows free can_end sum memory_hash memory_is_dirty big off multi_cell_bits big_bits next_due census_changed jumps vast left_behind;
    buffers sprites contributions hash_classes groups cells masks crowds covered together meets reasons possible moved resized dirty killed held memory templates shields pulled overrides extras sleepers watched stamps flights timers replaced counters;
    empty touched;
    shared paths scenery
}

impl State {
    /// The number of ticks played, minus one: −1 at the start, 0 after the first step.
    pub fn tick(&self) -> i32 {
        self.tick
    }

    /// The score.
    pub fn score(&self) -> f64 {
        self.score as f64
    }

    /// The game's counters; `no_counters=` sets their number.
    pub fn counters(&self) -> &[i32] {
        &self.counters
    }

    /// The outcome of the episode so far.
    pub fn outcome(&self) -> Outcome {
        self.outcome
    }

    /// Returns `true` once the episode is over.
    pub fn is_over(&self) -> bool {
        !matches!(self.outcome, Outcome::Ongoing)
    }

    /// The game's random number generator.
    pub fn chance(&self) -> Chance {
        self.chance
    }

    /// Copies the state with another random future: for planners, which must not foresee random events.
    pub fn fork(&self, seed: crate::Seed) -> State {
        State { chance: seed.chance(), jumps: seed.child("jumps", 0).chance(), ..self.clone() }
    }

    /// Overwrites this state with `source` and another random future; keeps the buffers.
    pub fn fork_from(&mut self, source: &State, chance: Chance) {
        self.clone_from(source);
        (self.chance, self.jumps) = (chance, chance);
    }

    /// The number of bytes that a copy of the state copies.
    pub fn size_in_bytes(&self) -> usize {
        fn bytes<T>(buffer: &[T]) -> usize {
            size_of_val(buffer)
        }
        size_of::<State>()
            + bytes(&self.sprites)
            + bytes(&self.groups)
            + bytes(&self.contributions)
            + bytes(&self.hash_classes)
            + bytes(&self.cells)
            + bytes(&self.masks)
            + bytes(&self.crowds)
            + bytes(&self.covered)
            + bytes(&self.together)
            + bytes(&self.meets)
            + bytes(&self.reasons)
            + bytes(&self.possible)
            + bytes(&self.moved)
            + bytes(&self.resized)
            + bytes(&self.dirty)
            + bytes(&self.killed)
            + bytes(&self.held)
            + bytes(&self.memory)
            + bytes(&self.templates)
            + bytes(&self.shields)
            + bytes(&self.pulled)
            + bytes(&self.overrides)
            + bytes(&self.extras)
            + bytes(&self.sleepers)
            + bytes(&self.watched)
            + bytes(&self.stamps)
            + bytes(&self.flights)
            + bytes(&self.timers)
    }

    /// The size of a cell in pixels.
    pub fn block(&self) -> i32 {
        self.block
    }

    /// The columns and rows of the board.
    pub fn size(&self) -> (i32, i32) {
        (self.columns, self.rows)
    }

    /// The type of the player's avatar, if there is a living one.
    pub fn avatar_type(&self) -> Option<SpriteType> {
        let sprite = self.sprites.get(usize::from(self.avatar))?;
        (!sprite.is(flag::DISABLED)).then_some(sprite.stype)
    }

    pub(crate) fn sprite(&self, slot: Slot) -> &Sprite {
        &self.sprites[usize::from(slot)]
    }

    pub(crate) fn group(&self, stype: SpriteType) -> &Group {
        &self.groups[stype.index()]
    }

    /// The slots of a type's sprites, in order of creation; scenery has none.
    pub(crate) fn slots(&self, stype: SpriteType) -> impl Iterator<Item = Slot> + Clone + '_ {
        let mut at = self.group(stype).head;
        std::iter::from_fn(move || {
            let slot = at;
            (slot != NONE).then(|| {
                at = self.sprite(slot).next;
                slot
            })
        })
    }

    /// The number of sprites of a type and its relatives, including killed and disabled ones.
    pub(crate) fn count(&self, rules: &Rules, stype: SpriteType) -> i32 {
        let tree = &rules.types[stype.index()].tree;
        tree.iter().map(|&stype| i32::from(self.group(stype).count)).sum()
    }

    /// [`State::count`] without disabled sprites: the count for terminations.
    pub(crate) fn count_live(&self, rules: &Rules, stype: SpriteType) -> i32 {
        let tree = &rules.types[stype.index()].tree;
        tree.iter().map(|&stype| i32::from(self.group(stype).count - self.group(stype).disabled)).sum()
    }

    /// A sprite for modification: marks its whole hash contribution as dirty.
    pub(crate) fn edit(&mut self, slot: Slot) -> &mut Sprite {
        let sprite = self.edit_motion(slot);
        sprite.flags |= flag::CHANGED;
        sprite
    }

    /// A sprite for modification of flags, place, age, time to live, count and heading only.
    pub(crate) fn edit_motion(&mut self, slot: Slot) -> &mut Sprite {
        let sprite = &mut self.sprites[usize::from(slot)];
        if sprite.flags & flag::DIRTY == 0 {
            sprite.flags |= flag::DIRTY;
            self.dirty.push(slot);
        }
        sprite
    }

    /// Takes a slot out of its chains and frees it. The caller calls [`State::forget_gone`] after the last one.
    pub(crate) fn release(&mut self, rules: &Rules, slot: Slot) {
        let Sprite { stype, next, previous, flags, .. } = *self.sprite(slot);
        self.leave_cell(rules, slot);
        self.census_changed |= rules.types[stype.index()].counted;
        let group = &mut self.groups[stype.index()];
        group.count -= 1;
        if flags & flag::DISABLED != 0 {
            group.disabled -= 1;
        }
        match previous {
            NONE => group.head = next,
            previous => self.sprites[usize::from(previous)].next = next,
        }
        match next {
            NONE => self.groups[stype.index()].tail = previous,
            next => self.sprites[usize::from(next)].previous = previous,
        }
        self.release_side_tables(slot);
        self.release_overrides(slot);
        let next = std::mem::replace(&mut self.free, slot);
        let sprite = self.edit(slot);
        // It stays in the list of dirty sprites, once.
        (sprite.next, sprite.flags) = (next, flag::FREE | flag::DIRTY);
    }

    /// Clears references to slots that have been freed. Pursuers keep the last rectangle of their target.
    pub(crate) fn forget_gone(&mut self) {
        self.forget_moved();
        let State { extras, sprites, .. } = self;
        for extra in extras {
            if let Target::Sprite(slot) = extra.target
                && sprites[usize::from(slot)].is(flag::FREE)
            {
                extra.target = Target::Gone(sprites[usize::from(slot)].rect);
            }
        }
    }

    /// Schedules a timer before all others that are due at the same tick (`spec/03` §6.2).
    pub(crate) fn plan(&mut self, timer: Timer) {
        let at = self.timers.partition_point(|other| other.due >= timer.due);
        self.timers.insert(at, timer);
    }

    /// Takes a slot for `sprite`, at the end of its type's chain; `None` if there is no slot left.
    pub(crate) fn admit(&mut self, rules: &Rules, sprite: &Sprite) -> Option<Slot> {
        let group = &mut self.groups[sprite.stype.index()];
        let slot = match self.free {
            NONE => {
                let slot =
                    Slot::try_from(self.sprites.len()).ok().filter(|&slot| usize::from(slot) < MAX_SLOTS)?;
                self.sprites.push(*sprite);
                self.contributions.push(Contribution::default());
                slot
            }
            slot => slot,
        };
        let tail = std::mem::replace(&mut group.tail, slot);
        group.count += 1;
        if tail == NONE {
            group.head = slot;
        } else {
            self.sprites[usize::from(tail)].next = slot;
        }
        self.census_changed |= rules.types[sprite.stype.index()].counted;
        let place = &mut self.sprites[usize::from(slot)];
        if self.free == slot {
            self.free = place.next;
        }
        // A slot that was freed in this tick may be in the list of dirty sprites already.
        let dirty = place.is(flag::DIRTY);
        *place = *sprite;
        place.previous = tail;
        place.flags |= flag::DIRTY | flag::CHANGED;
        if !dirty {
            self.dirty.push(slot);
        }
        self.enter_cell(rules, slot);
        Some(slot)
    }
}
