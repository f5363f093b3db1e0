//! An episode's world: sprites, cells and a few other numbers, as flat arrays without pointers to the rules
//! (`docs/lab/decisions/0004-state-as-flat-data.md`). The world is independent of the schedule's shortcuts.
//!
//! Sprites are stored in the slots of one array. Two kinds of linked lists (chains) run through the slots. A
//! type's chain, called a group in the reference, contains its sprites in order of creation. A cell's chain
//! contains the sprites in that cell (`occupancy.rs`). Effects read and write sprites only through methods of
//! this module, so that the layout can change independently of them.

mod board;
mod changes;
mod fixtures;
mod hash;
mod numbers;
mod paths;
mod recount;
mod scenery;
pub(crate) mod sprites;

use crate::flat::{bytes_of_fields, flat};
use crate::numbers::chance::Chance;
use crate::rules::{Action, EffectInfo, Outcome, Rules, SpriteType};
pub(crate) use board::overlap::{Hit, Hits, Partners, Side};
use board::placement::reciprocal;
use fixtures::Fixtures;
use hash::contribution::{Contribution, HashClass, Sum};
pub(crate) use hash::{Mixer, bits, two};
pub use hash::{SearchKey, StateHash};
use paths::Paths;
use scenery::Scenery;
pub(crate) use sprites::models::{Models, TypeBits, ones};
use sprites::moved::Resized;
pub(crate) use sprites::overrides::{Extra, Overrides, Target};
pub(crate) use sprites::side_tables::{Held, Replaced};
pub(crate) use sprites::sprite::{Group, NO_HEADING, NONE, Slot, Sprite, flag};

/// The length, in pixels, of the board's longer side in games that do not set `square_size`.
const SCREEN: i32 = 800;

/// A timer in the time phase: the timed effect, and the tick in which it is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Timer {
    pub(crate) due: i32,
    pub(crate) timed: u16,
}

bytes_of_fields! { Timer { due timed } }

/// An observer of a world, which is notified when types start or stop sharing cells.
pub(crate) trait Watcher {
    /// Called when a sprite of the type with the bit `own` has started to cover a cell. Sprites of the types
    /// with the bits `partners`, which rules pair with `own`, also cover the cell.
    fn arrives(&mut self, _own: u64, _partners: u64) {}

    /// Called when a sprite of the type with the bit `own` has stopped covering a cell. Sprites of the types
    /// with the bits `partners` still cover the cell.
    fn departs(&mut self, _own: u64, _partners: u64) {}

    /// Called when a type gets its first sprite larger than a cell.
    fn enlarged(&mut self, _stype: usize) {}

    /// Called when a type no longer has any sprite larger than a cell.
    fn reduced(&mut self, _stype: usize) {}
}

/// A watcher that ignores everything.
impl Watcher for () {}

flat! {
    /// An episode's world.
    pub(crate) struct World {
        copied {
            outcome: Outcome,
            last_action: Action,
        }
        numbers {
            tick: i32,
            score: i64,
            chance: Chance,
            avatar: Slot,
            next_id: u32,
            /// The reference's sprite counter, including its drift (`spec/03` §5.1).
            population: i32,
            /// The number of messages logged so far. More than 25 messages end the game.
            messages: u32,
            block: i32,
            /// The factor that divides by the cell size (`placement.rs`).
            reciprocal: u64,
            columns: i32,
            rows: i32,
            free: Slot,
            /// `true` if counters can end the game. StopCounter changes this flag.
            can_end: bool,
            /// The sum of `contributions`, without the growth of sprites in flight.
            sum: Sum,
            /// The number of sprites larger than a cell.
            big: u32,
            /// The number of sprites not completely on the screen.
            off: u32,
            /// The bits of the types with sprites that cover more than one cell.
            multi_cell_bits: u64,
            /// The bits of the types with sprites larger than a cell.
            big_bits: u64,
            /// `true` if the counts in `groups` have changed since terminations were last checked.
            census_changed: bool,
            /// The number of times that sprites larger than a cell have left cells since `covered` was
            /// recomputed.
            left_behind: u32,
            /// The bits of sprites so large that they count as being everywhere.
            vast: u64,
            /// The hash of `memory` and `templates` when the running hash was last settled.
            memory_hash: u64,
            memory_is_dirty: bool,
            /// The second random-number stream, for WalkerJumper and for choices that the reference makes without a
            /// seed.
            jumps: Chance,
        }
        buffers {
            sprites: Sprite,
            /// For each slot, the hash contribution of its sprite when the hash was last settled.
            contributions: Contribution,
            /// The linear hash classes of the sprites in flight when the hash was last settled.
            hash_classes: HashClass,
            groups: Group,
            cells: Slot,
            /// For each cell, the bits of the types that cover the cell (`models.rs`).
            masks: u64,
            /// For each cell, the bits of the types that have several sprites in the cell. Empty until a cell
            /// contains several sprites.
            crowds: u64,
            /// For each cell, the bits of the large sprites that cover the cell or covered it recently. Empty
            /// if there are no large sprites.
            covered: u64,
            moved: Slot,
            /// The sprites in `moved` whose size has changed, sorted by slot.
            resized: Resized,
            dirty: Slot,
            killed: Slot,
            /// The resources that sprites hold, sorted by holder and resource.
            held: Held,
            memory: u8,
            /// For each type, a value other than 0 if a sprite of the type has already been created. Later
            /// sprites are copies (`spec/02` §1.3).
            templates: u8,
            /// The shields of the current tick, sorted by type, partner and effect keyword (`spec/03` §5.7).
            shields: (SpriteType, SpriteType, u16),
            /// The sprites that each pullWithIt effect has carried in this tick, sorted.
            pulled: (u16, Slot),
            /// The types' overridable values, and the sprites' overrides (`overrides.rs`).
            overrides: Overrides,
            extras: Extra,
            /// The scheduled timed effects, with the next effect last (`spec/03` §6.2).
            timers: Timer,
            /// The entries that updateSpawnType has replaced in the lists of BomberRandomMissiles, sorted by
            /// holder and position.
            replaced: Replaced,
            /// The game's counters.
            counters: i32,
        }
        scratch {}
        shared {
            /// The path finding tables (`paths.rs`), or `None` without `obs=`.
            paths: Paths,
            /// The fixtures, which are sprites that never change (`fixtures.rs`), or `None` if there are none.
            fixtures: Fixtures,
            /// The scenery, which consists of sprites that no rule involves (`scenery.rs`), or `None` if there is none.
            scenery: Scenery,
        }
    }
}

impl World {
    /// Returns the world for a board of `columns` by `rows` cells before the first tick, without sprites.
    pub(crate) fn empty(
        rules: &Rules,
        models: &Models,
        (columns, rows): (i32, i32),
        chance: Chance,
    ) -> World {
        let cells = World::cell_count(columns, rows);
        let block = rules.square_size.unwrap_or_else(|| 2.max(SCREEN / columns.max(rows)));
        World {
            outcome: Outcome::Ongoing,
            last_action: Action::Nil,
            tick: -1,
            score: 0,
            chance,
            avatar: NONE,
            next_id: 0,
            population: 0,
            messages: rules.messages,
            block,
            reciprocal: reciprocal(block),
            columns,
            rows,
            free: NONE,
            can_end: rules.can_end,
            sum: [0; 2],
            big: 0,
            off: 0,
            multi_cell_bits: 0,
            big_bits: 0,
            census_changed: true,
            left_behind: 0,
            vast: 0,
            memory_hash: 0,
            memory_is_dirty: true,
            jumps: chance,
            sprites: Vec::new(),
            contributions: Vec::new(),
            hash_classes: Vec::new(),
            groups: vec![Group::EMPTY; rules.types.len()],
            cells: vec![NONE; cells],
            masks: vec![0; cells],
            crowds: Vec::new(),
            covered: Vec::new(),
            moved: Vec::new(),
            resized: Vec::new(),
            dirty: Vec::new(),
            killed: Vec::new(),
            held: Vec::new(),
            memory: rules.effects.iter().map(EffectInfo::initial_memory).collect(),
            templates: vec![0; rules.types.len()],
            shields: Vec::new(),
            pulled: Vec::new(),
            overrides: models.of_type.iter().map(|model| model.overrides).collect(),
            extras: Vec::new(),
            timers: Vec::new(),
            replaced: Vec::new(),
            counters: vec![0; rules.counters],
            paths: None,
            fixtures: None,
            scenery: None,
        }
    }

    /// Returns `true` once the episode is over.
    pub(crate) fn is_over(&self) -> bool {
        !matches!(self.outcome, Outcome::Ongoing)
    }

    /// Returns the creation number of the player's avatar, even if the avatar is disabled; `None` if there is no
    /// avatar.
    pub(crate) fn avatar_id(&self) -> Option<u32> {
        self.avatar_sprite().map(|sprite| sprite.id)
    }

    #[inline(always)]
    pub(crate) fn sprite(&self, slot: Slot) -> &Sprite {
        match self.sprites.get(usize::from(slot)) {
            Some(sprite) => sprite,
            None => self.fixture(slot),
        }
    }

    /// Returns the sprite in a slot. The slot must not contain a fixture (a sprite that never changes). This
    /// requirement saves a check.
    #[inline(always)]
    pub(crate) fn own(&self, slot: Slot) -> &Sprite {
        &self.sprites[usize::from(slot)]
    }

    /// Returns the sprite in a slot, or `None` for [`NONE`] and fixtures.
    pub(crate) fn get(&self, slot: Slot) -> Option<&Sprite> {
        self.sprites.get(usize::from(slot))
    }

    /// Returns the player's avatar, even if the avatar is disabled; `None` if there is no avatar.
    pub(crate) fn avatar_sprite(&self) -> Option<&Sprite> {
        self.get(self.avatar)
    }

    /// Returns the number of slots, including free slots but excluding the slots of fixtures (sprites that never
    /// change).
    pub(crate) fn slot_count(&self) -> usize {
        self.sprites.len()
    }

    /// Returns each type's group (the list of its sprites, with counts), indexed by type.
    pub(crate) fn groups(&self) -> &[Group] {
        &self.groups
    }

    pub(crate) fn group(&self, stype: SpriteType) -> &Group {
        &self.groups[stype.index()]
    }

    /// Returns the slots of a type's sprites, in order of creation. Scenery (sprites that no rule involves) has no
    /// slots.
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

    /// Returns the number of sprites of a type and of related types in the SpriteSet, including killed and disabled
    /// sprites.
    pub(crate) fn count(&self, rules: &Rules, stype: SpriteType) -> i32 {
        let tree = &rules.types[stype.index()].tree;
        tree.iter().map(|&stype| i32::from(self.group(stype).count)).sum()
    }

    /// Counts sprites like [`World::count`], but excludes disabled sprites, as terminations do.
    pub(crate) fn count_live(&self, rules: &Rules, stype: SpriteType) -> i32 {
        let tree = &rules.types[stype.index()].tree;
        tree.iter().map(|&stype| i32::from(self.group(stype).count - self.group(stype).disabled)).sum()
    }

    /// Returns the kill list, which may contain a sprite twice.
    #[inline(always)]
    pub(crate) fn killed(&self) -> &[Slot] {
        &self.killed
    }
}
