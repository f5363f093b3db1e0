//! A game's compiled rules: types, effects, passes and terminations, resolved from its text. Compiled rules
//! are immutable.

mod action;
pub(crate) mod class;
pub(crate) mod constants;
pub(crate) mod effects;
mod outcome;
mod sprite_type;
pub(crate) mod terminations;
pub(crate) mod traits;

use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::Description;
pub use action::Action;
use base::Digest;
use class::{ClassFamily, SpriteClass};
use effects::{Effect, Summary, TickSummary};
pub use outcome::{Limit, Outcome};
use smallvec::SmallVec;
pub use sprite_type::SpriteType;
use std::collections::BTreeSet;
use std::sync::OnceLock;
use terminations::Termination;
use traits::Traits;

/// A compiled sprite type.
#[derive(Clone, Debug)]
pub(crate) struct TypeInfo {
    pub(crate) name: String,
    /// The class, or `None` for a grouping node without a class.
    pub(crate) class: Option<SpriteClass>,
    pub(crate) traits: Traits,
    /// The ancestors, starting with the root, followed by the type itself.
    pub(crate) path: Box<[SpriteType]>,
    /// The ancestors, the type itself and its descendants: the types to which rules on this type apply
    /// (`spec/01` §1.6.3).
    pub(crate) tree: Box<[SpriteType]>,
    /// Each type's position in `tree`, or `NOT_IN_TREE`, indexed by type.
    pub(crate) rank: Box<[u16]>,
    /// The position in the update order, or `None` for types whose sprites are never updated.
    pub(crate) order: Option<u16>,
    /// `true` if the type's own line declares a singleton (`spec/01` §1.6.4).
    pub(crate) singleton: bool,
    /// The maximum amount of the type that a sprite can hold as a resource.
    pub(crate) resource_limit: i32,
    /// `true` for a leaf of the SpriteSet, and for an undeclared `wall` or `avatar`.
    pub(crate) leaf: bool,
    /// `true` if a termination may count sprites of the type.
    pub(crate) counted: bool,
    /// `true` if some effect can give a speed to sprites that have none.
    pub(crate) given_speed: bool,
    /// The parameter that selects among the type's images, if the type has no images. The reference crashes
    /// on a level that places sprites of such a type.
    pub(crate) lacks_image: Option<Span>,
    /// `true` if the type lacks a parameter without which the reference crashes when it creates a sprite of
    /// the type.
    pub(crate) incomplete: bool,
    /// The number of messages that the reference logs when it creates the first sprite of the type: one for
    /// each parameter that the class does not accept.
    pub(crate) unknown_parameters: u32,
    /// `true` if sprites of the type detect the ground when rules test their overlaps.
    pub(crate) ground_aware: bool,
    /// `true` if the first sprite of the type differs from later ones, which are copies. Unlike the first
    /// sprite, copies have the scaled size from the start and leave walls behind, and their unknown
    /// parameters have already been reported.
    pub(crate) first_differs: bool,
    /// The actions available to an avatar of this type, except [`Action::Nil`]. If there are none, the slice
    /// contains only [`Action::Nil`].
    pub(crate) actions: &'static [Action],
    /// The available actions as a bit mask.
    pub(crate) keys: u8,
}

pub(crate) const NOT_IN_TREE: u16 = u16::MAX;

impl TypeInfo {
    /// Returns the type to which teleportToExit leads from a sprite of this type (`spec/03` §8.3); `None` if it leads
    /// nowhere.
    pub(crate) fn leads_to(&self) -> Option<SpriteType> {
        use SpriteClass as C;
        let class = self.class?;
        let leading = [C::Portal, C::SpawnPoint, C::Chaser, C::PathChaser, C::FlakAvatar, C::Spreader];
        let has = leading.iter().any(|&other| class.is_a(other));
        self.traits.stypes.first().copied().filter(|_| has)
    }

    /// Returns `true` if sprites of the type count as avatars when a level starts.
    pub(crate) fn is_like_avatar(&self) -> bool {
        self.traits.is_avatar || self.class.is_some_and(SpriteClass::is_avatar)
    }

    /// Returns `true` if the search for the player's avatar at the start of a level includes sprites of the
    /// type. It excludes parent types and the type drawn first (`spec/01` §4.2). `wall` and `avatar` are
    /// always in the update order.
    pub(crate) fn is_sought(&self) -> bool {
        self.is_like_avatar() && self.order.is_some_and(|order| order > 0)
    }

    /// Returns `true` if the tree contains a type twice, as it does if a type is declared below itself
    /// (`spec/01` §1.6.3).
    pub(crate) fn repeats(&self) -> bool {
        self.tree.iter().enumerate().any(|(at, stype)| usize::from(self.rank[stype.index()]) != at)
    }

    /// Returns the type's class and its position in the update order; `None` if its sprites never do anything in their
    /// updates.
    pub(crate) fn updated(&self) -> Option<(SpriteClass, i32)> {
        let class = self.class.filter(|_| !self.is_idle())?;
        Some((class, i32::from(self.order?)))
    }

    /// Returns `true` if the type's sprites never do anything in their updates. Such updates cost nothing in a tick.
    /// The player's avatar does not count, because it is updated separately.
    pub(crate) fn is_idle(&self) -> bool {
        let (Some(class), traits) = (self.class, &self.traits) else { return true };
        match (class, class.family()) {
            (_, ClassFamily::Thing | ClassFamily::Resource) | (SpriteClass::SpriteProducer, _) => {}
            (_, ClassFamily::Avatar) => return true,
            (
                _,
                ClassFamily::Flicker
                | ClassFamily::Missile
                | ClassFamily::Npc
                | ClassFamily::Walker
                | ClassFamily::Producer,
            ) => return false,
        }
        let stands = traits.speed == 0.0 && !traits.continuous && !self.given_speed;
        let stays = traits.is_static || traits.only_active || stands;
        stays && traits.time_to_live < 0 && !traits.oriented_image
    }

    pub(crate) fn in_tree(&self, other: SpriteType) -> bool {
        self.rank[other.index()] != NOT_IN_TREE
    }
}

/// One compiled interaction line. All right-hand sprites on the line share this entry and its memory.
#[derive(Clone, Debug)]
pub(crate) struct EffectInfo {
    pub(crate) effect: Effect,
    pub(crate) in_tick: TickSummary,
    pub(crate) summary: Box<Summary>,
    pub(crate) score_change: i32,
    pub(crate) apply_score: bool,
    /// For each of `scoreChange` and `scoreChangeIfKilled`, `true` if the value is not a number. Such a value
    /// counts as 0, and the reference logs a message each time it is used.
    pub(crate) score_faults: [bool; 2],
    /// The changes that an execution makes to the game's counters, if any.
    pub(crate) counting: Option<Box<Counting>>,
    /// `true` if the effect runs only once on all partners of a sprite together.
    pub(crate) in_batch: bool,
    /// `true` if the line also runs as a timed effect. The line's score and counters then apply regardless of
    /// the effect's result.
    pub(crate) steady: bool,
    /// The line's index in the description.
    pub(crate) line: usize,
}

/// The memory that an effect keeps between executions (`spec/03` §13), as the bits of one byte per effect.
pub(crate) mod memory {
    /// The score changes when the effect runs. Many effects set this bit at run time.
    pub(crate) const APPLY_SCORE: u8 = 1;
    /// The last execution of subtractHealthPoints killed a sprite.
    pub(crate) const KILLED: u8 = 2;
    /// The changes in `counter` do not apply. Some effects set this bit at run time.
    pub(crate) const NO_COUNT: u8 = 4;
    /// The changes in `counterElse` do not apply.
    pub(crate) const NO_COUNT_ELSE: u8 = 8;
}

/// The values of `counter` and `counterElse` on a line (`spec/03` §3), with one amount per counter in the
/// game. `None` stands for text that is not a number, which counts as 0 and for which the reference logs a
/// message at each use.
#[derive(Clone, Debug)]
pub(crate) struct Counting {
    pub(crate) count: bool,
    pub(crate) count_else: bool,
    pub(crate) counter: Box<[Option<i32>]>,
    pub(crate) counter_else: Box<[Option<i32>]>,
}

impl EffectInfo {
    /// Returns the entry for a standalone effect, without a score, counters or its own line.
    pub(crate) fn of(effect: Effect) -> EffectInfo {
        let summary = effect.summary();
        EffectInfo {
            effect,
            in_tick: summary.in_tick(),
            summary: Box::new(summary),
            score_change: 0,
            apply_score: true,
            score_faults: [false; 2],
            counting: None,
            in_batch: false,
            steady: false,
            line: 0,
        }
    }

    /// Returns the effect's initial [`memory`].
    pub(crate) fn initial_memory(&self) -> u8 {
        let off = |counts: fn(&Counting) -> bool| self.counting.as_deref().is_some_and(|c| !counts(c));
        let bits = [
            (memory::APPLY_SCORE, self.apply_score),
            (memory::NO_COUNT, off(|counting| counting.count)),
            (memory::NO_COUNT_ELSE, off(|counting| counting.count_else)),
        ];
        bits.into_iter().map(|(bit, on)| if on { bit } else { 0 }).sum()
    }
}

/// A timed effect, either written with TIME or scheduled by addTimer (`spec/03` §6).
#[derive(Clone, Debug)]
pub(crate) struct Timed {
    /// The effect, with its own memory.
    pub(crate) effect: u16,
    /// The type of the sprites on which the effect runs, or `None` if the effect runs once, on no sprite.
    pub(crate) target: Option<SpriteType>,
    /// The number of ticks between scheduling and execution.
    pub(crate) timer: i32,
    pub(crate) repeating: bool,
    /// The tick of the first execution, or `None` if addTimer schedules the effect.
    pub(crate) first_due: Option<i32>,
    /// The effect whose line sets the score change: either this effect or the addTimer that schedules it.
    pub(crate) wrapper: u16,
    pub(crate) score_change: i32,
    pub(crate) apply_score: bool,
    pub(crate) line: usize,
}

/// One pass of the event phase over all pairs of sprites of two types (`spec/03` §4.5).
#[derive(Clone, Debug)]
pub(crate) struct Pass {
    pub(crate) first: SpriteType,
    pub(crate) second: SpriteType,
    pub(crate) effect: u16,
    /// The keyword index of the effect, for matching shields.
    pub(crate) keyword: u16,
    /// `true` if the second tree contains a type twice, so that its sprites are visited twice.
    pub(crate) repeats: bool,
    /// `true` if overlapping sprites can be searched for from the second side, because the effect moves
    /// nothing that affects later overlaps.
    pub(crate) either_side: bool,
}

/// The non-ASCII characters in a LevelMapping. The reference looks up UTF-16 code units. Each mapped
/// non-ASCII unit gets an ASCII code that the game does not use otherwise, so that level cells always contain
/// ASCII codes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Aliases(pub(crate) Vec<Alias>);

/// A non-ASCII character and the code that represents it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Alias {
    pub(crate) code: u8,
    /// The character's first code unit, by which the reference looks it up.
    pub(crate) unit: u16,
    pub(crate) character: char,
}

impl Aliases {
    pub(crate) fn of_unit(&self, unit: u16) -> Option<u8> {
        self.0.iter().find(|alias| alias.unit == unit).map(|alias| alias.code)
    }

    pub(crate) fn of_code(&self, code: u8) -> Option<Alias> {
        self.0.iter().find(|alias| alias.code == code).copied()
    }
}

/// The resolved contents of a game file.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    pub(crate) description: Description,
    pub(crate) digest: Digest,
    /// The warnings that depend on the text alone.
    pub(crate) warnings: Vec<Diagnostic>,
    /// All warnings, including those about the rules' meaning. Computed on first use.
    pub(crate) all_warnings: OnceLock<Vec<Diagnostic>>,
    /// `true` if the game was loaded in reference mode. The game's levels are then loaded in reference mode,
    /// too.
    pub(crate) as_reference: bool,
    /// The number of messages that the reference logs while it loads the rules.
    pub(crate) messages: u32,
    /// The cell size in pixels, if the game sets one.
    pub(crate) square_size: Option<i32>,
    /// The value of `no_counters=`.
    pub(crate) counters: usize,
    /// `true` if counters can end the game, as set by `canEnd=` in the terminations.
    pub(crate) can_end: bool,
    pub(crate) types: Vec<TypeInfo>,
    /// The drawing order. Updates run in reverse drawing order.
    pub(crate) order: Vec<SpriteType>,
    /// For each type, `true` if anything other than its own line, its parents' lines and the LevelMapping
    /// refers to the type.
    pub(crate) referenced: Vec<bool>,
    /// For each type, `true` if its sprites are scenery, which no rule involves (`scenery.rs`).
    pub(crate) scenery: Vec<bool>,
    /// For each type, `true` if its sprites are fixtures, which never change (`fixtures.rs`).
    pub(crate) fixtures: Vec<bool>,
    /// The sprites that each character places, by ASCII code.
    pub(crate) mapping: Vec<SmallVec<[SpriteType; 4]>>,
    /// The codes of the mapped non-ASCII characters, in games loaded in reference mode.
    pub(crate) aliases: Aliases,
    /// The codes of level characters that stand for an undeclared sprite. The reference crashes on a level
    /// that uses such a character.
    pub(crate) unusable: BTreeSet<u8>,
    pub(crate) effects: Vec<EffectInfo>,
    /// The passes at the edge of the screen, each with its type and effect, with repetitions expanded.
    pub(crate) edge: Vec<(SpriteType, u16)>,
    /// `true` if an edge pass of the game refers to an undeclared type. The reference then crashes in the first
    /// tick, after the passes in `edge`.
    pub(crate) undeclared_at_edge: bool,
    pub(crate) passes: Vec<Pass>,
    pub(crate) timed: Vec<Timed>,
    /// `true` if the game sets `obs=`, and therefore uses path finding.
    pub(crate) finds_paths: bool,
    /// The types that paths avoid, from `obs=`.
    pub(crate) obstacles: Vec<SpriteType>,
    pub(crate) terminations: Vec<Termination>,
    /// `true` if anything can draw random numbers.
    pub(crate) draws: bool,
    /// `true` if anything except the reference's own limit reads the tick.
    pub(crate) reads_tick: bool,
    /// The first tick in which a Timeout holds.
    pub(crate) first_timeout: i32,
    /// `true` if a termination reads the counters.
    pub(crate) reads_counters: bool,
    /// `true` if a termination reads the score.
    pub(crate) reads_score: bool,
    /// The size of the largest sprite in cells, rounded up.
    pub(crate) reach: i32,
    /// The cooldowns of spawners. Spawners that are created later fire at multiples of their cooldown.
    pub(crate) clocks: Vec<i32>,
    /// The ticks before which wizards, including those created later, create no block.
    pub(crate) wizard_ticks: Vec<i32>,
    /// `true` if there is a type whose first sprite can differ from its later sprites.
    pub(crate) first_differs: bool,
    /// The effects whose score may depend on their earlier executions.
    pub(crate) remembering: Vec<u16>,
}
