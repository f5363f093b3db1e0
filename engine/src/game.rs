//! A compiled game: immutable, valid and cheap to clone.

use crate::contacts::Contacts;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::geometry::Direction;
use crate::limits::MAX_TICKS;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;
use crate::ontology::sprites::Mover;
use crate::ontology::terminations::Termination;
use crate::ontology::traits::Traits;
use crate::overrides::Overrides;
use crate::sleep::Shortcuts;
use crate::state::{Sprite, State, memory};
use crate::syntax::Description;
use crate::{Digest, causes};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
use std::collections::BTreeSet;
use std::fmt;
use std::sync::{Arc, OnceLock};

/// A sprite type of one game, by its place in the game's registry: `wall` is 0 and `avatar` is 1 in every game.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SpriteType(pub u16);

impl SpriteType {
    /// No type: the value of an undeclared name in games that are loaded as the reference does.
    pub(crate) const NONE: SpriteType = SpriteType(u16::MAX);

    /// The index into tables with one entry per type.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// An action of a player in a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Action {
    /// Nothing.
    Nil,
    /// The up key.
    Up,
    /// The left key.
    Left,
    /// The down key.
    Down,
    /// The right key.
    Right,
    /// The use key: shoot, hit, put.
    Use,
}

impl Action {
    /// All actions, in order.
    pub const ALL: [Action; 6] =
        [Action::Nil, Action::Up, Action::Left, Action::Down, Action::Right, Action::Use];

    /// Parses the reference's spelling, `ACTION_LEFT`, which traces use.
    pub fn from_reference(name: &str) -> Option<Action> {
        let name = name.strip_prefix("ACTION_")?;
        Action::ALL.into_iter().find(|action| action.to_string().eq_ignore_ascii_case(name))
    }
}

impl fmt::Display for Action {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Action::Nil => "nil",
            Action::Up => "up",
            Action::Left => "left",
            Action::Down => "down",
            Action::Right => "right",
            Action::Use => "use",
        })
    }
}

/// The outcome of an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Not over.
    Ongoing,
    /// Over, won.
    Won,
    /// Over, lost.
    Lost,
    /// Over without a winner (too many messages, see `spec/01` §4.9).
    Ended,
    /// The rules did something on which the reference engine crashes, or a limit was exceeded.
    Stopped(Limit),
}

/// The reason why an episode was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// More sprites than a state can hold.
    Sprites,
    /// More work in one tick than [`MAX_WORK`](crate::limits::MAX_WORK): effects, and sprites and cells looked at.
    Work,
    /// A sprite of the type whose sprites are being updated was spawned: the reference throws.
    SpawnIntoUpdatedType,
    /// A score changed after the avatar was removed permanently: the reference throws.
    NoAvatar,
    /// A sprite of height 0 moved: the reference divides by it.
    FlatSprite,
    /// A path was requested in a game without `obs=`.
    NoPaths,
    /// A sprite of a type without a class, or of an undeclared type, was to be made or looked up.
    NoType,
    /// An effect was executed without the sprites that it needs.
    NoSprite,
    /// A type turned into itself without end.
    EndlessTransform,
    /// A sprite's parameters do not fit its class: the reference throws when it makes the sprite, or when it relies on
    /// them.
    UnfitSprite,
    /// More timers than can be planned.
    Timers,
    /// More resources held than a state can hold.
    Resources,
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Limit::Sprites => "more sprites than a state can hold",
            Limit::Work => "one tick is more work than is allowed",
            Limit::SpawnIntoUpdatedType => "a sprite was spawned into the type that is being updated",
            Limit::NoAvatar => "the score changed after the avatar was removed permanently",
            Limit::FlatSprite => "a sprite of height 0 moved",
            Limit::NoPaths => "a path was requested in a game without `obs=`",
            Limit::NoType => {
                "a sprite of an unknown type, or of a type without a class, was to be made or looked up"
            }
            Limit::NoSprite => "an effect was executed without the sprites that it needs",
            Limit::EndlessTransform => "a type was transformed into itself endlessly",
            Limit::UnfitSprite => "the parameters of a sprite do not fit its class",
            Limit::Timers => "more timers than can be planned",
            Limit::Resources => "more resources held than a state can hold",
        })
    }
}

/// A compiled sprite type.
#[derive(Clone, Debug)]
pub(crate) struct TypeInfo {
    pub(crate) name: String,
    /// `None` for a bare grouping node.
    pub(crate) class: Option<SpriteClass>,
    pub(crate) traits: Traits,
    /// Ancestors from the root down, then the type itself.
    pub(crate) path: Box<[SpriteType]>,
    /// Ancestors, the type and its descendants: the types that rules on this type apply to (`spec/01` §1.6.3).
    pub(crate) tree: Box<[SpriteType]>,
    /// The place of every type in `tree`, or `NOT_IN_TREE`; indexed by type.
    pub(crate) rank: Box<[u16]>,
    /// The place in the update order; `None` for types whose sprites are never updated.
    pub(crate) order: Option<u16>,
    /// The flag of its own line (`spec/01` §1.6.4).
    pub(crate) singleton: bool,
    /// The number of units of it, as a resource, that a sprite can hold.
    pub(crate) resource_limit: i32,
    /// `true` for a leaf of the SpriteSet (or an undeclared `wall` or `avatar`).
    pub(crate) leaf: bool,
    /// `true` if a termination may count its sprites.
    pub(crate) counted: bool,
    /// `true` if some effect can give speed to sprites that have none.
    pub(crate) given_speed: bool,
    /// `true` if a parameter is missing without which the reference crashes when it makes such a sprite.
    pub(crate) incomplete: bool,
    /// The number of messages that the reference logs when it makes the first sprite: one for each parameter that the
    /// class does not have.
    pub(crate) unknown_parameters: u32,
    /// `true` if its sprites detect the ground when rules test what they overlap.
    pub(crate) ground_aware: bool,
    /// `true` if the first sprite of the type differs from later ones, which are copies: they have the scaled size from
    /// the start, their unknown parameters have been reported, and they leave walls behind.
    pub(crate) first_differs: bool,
    /// The actions besides [`Action::Nil`] with it as the avatar; [`Action::Nil`] alone if there are none.
    pub(crate) actions: &'static [Action],
    /// The same actions as a bit mask.
    pub(crate) keys: u8,
}

pub(crate) const NOT_IN_TREE: u16 = u16::MAX;

impl TypeInfo {
    /// The type to which teleportToExit leads from a sprite of this type (`spec/03` §8.3).
    pub(crate) fn leads_to(&self) -> Option<SpriteType> {
        use SpriteClass as C;
        let class = self.class?;
        let leading = [C::Portal, C::SpawnPoint, C::Chaser, C::PathChaser, C::FlakAvatar, C::Spreader];
        let has = leading.iter().any(|&other| class.is_a(other));
        self.traits.stypes.first().copied().filter(|_| has)
    }

    /// Tests whether its sprites are taken for avatars when a level starts.
    pub(crate) fn is_like_avatar(&self) -> bool {
        self.traits.is_avatar || self.class.is_some_and(SpriteClass::is_avatar)
    }

    /// Tests whether the tree names a type twice, as it does for a type that is declared below itself (`spec/01` §1.6.3).
    pub(crate) fn repeats(&self) -> bool {
        self.tree.iter().enumerate().any(|(at, stype)| usize::from(self.rank[stype.index()]) != at)
    }

    pub(crate) fn in_tree(&self, other: SpriteType) -> bool {
        self.rank[other.index()] != NOT_IN_TREE
    }
}

/// One compiled interaction line. All its right-hand sprites share it and its memory.
#[derive(Clone, Debug)]
pub(crate) struct EffectInfo {
    pub(crate) effect: Effect,
    pub(crate) score_change: i32,
    pub(crate) apply_score: bool,
    /// `true` for each of `scoreChange` and `scoreChangeIfKilled` that is not a number: it counts 0 and costs a message
    /// each time.
    pub(crate) score_faults: [bool; 2],
    /// The changes of the game's counters by an execution, if there are any.
    pub(crate) counting: Option<Box<Counting>>,
    /// `true` if it runs once on all partners of a sprite together.
    pub(crate) in_batch: bool,
    /// `true` if the line also runs by the clock, and its score and counters apply whatever the effect decides as it
    /// runs.
    pub(crate) steady: bool,
    /// Index of the line in the description.
    pub(crate) line: usize,
}

/// `counter` and `counterElse` of a line (`spec/03` §3): an amount for each counter of the game; `None` for a text that
/// is not a number, which counts 0 and costs a message each time.
#[derive(Clone, Debug)]
pub(crate) struct Counting {
    pub(crate) count: bool,
    pub(crate) count_else: bool,
    pub(crate) counter: Box<[Option<i32>]>,
    pub(crate) counter_else: Box<[Option<i32>]>,
}

impl EffectInfo {
    /// The effect alone: without a score, counters or a line of its own.
    pub(crate) fn of(effect: Effect) -> EffectInfo {
        EffectInfo {
            effect,
            score_change: 0,
            apply_score: true,
            score_faults: [false; 2],
            counting: None,
            in_batch: false,
            steady: false,
            line: 0,
        }
    }

    /// The initial memory of the effect; see [`memory`].
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

/// An effect that runs by the clock: written with TIME, or planned by addTimer (`spec/03` §6).
#[derive(Clone, Debug)]
pub(crate) struct Timed {
    /// The effect, with a memory of its own.
    pub(crate) effect: u16,
    /// The type of the sprites on which it runs; `None` to run once, on no sprite.
    pub(crate) target: Option<SpriteType>,
    /// The number of ticks from planning to running.
    pub(crate) timer: i32,
    pub(crate) repeating: bool,
    /// The tick of the first run; `None` if addTimer plans it.
    pub(crate) first_due: Option<i32>,
    /// The effect whose line sets the score change: this one, or the addTimer.
    pub(crate) wrapper: u16,
    pub(crate) score_change: i32,
    pub(crate) apply_score: bool,
    pub(crate) line: usize,
}

/// One pass of the event phase over all pairs of two types (`spec/03` §4.5).
#[derive(Clone, Debug)]
pub(crate) struct Pass {
    pub(crate) first: SpriteType,
    pub(crate) second: SpriteType,
    pub(crate) effect: u16,
    /// The number of the effect's keyword, for shields.
    pub(crate) keyword: u16,
    /// `true` if the second tree names a type twice: its sprites are met twice.
    pub(crate) repeats: bool,
    /// `true` if hits can be found from the second side: executing the effect moves nothing that a later hit depends on.
    pub(crate) either_side: bool,
}

/// The resolved contents of a game file.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    pub(crate) description: Description,
    pub(crate) digest: Digest,
    /// The warnings about the text alone.
    pub(crate) warnings: Vec<Diagnostic>,
    /// All warnings, including those about the meaning of the rules; computed on first use.
    pub(crate) all_warnings: OnceLock<Vec<Diagnostic>>,
    /// `true` if the game was loaded as the reference does: its levels are loaded in the same way.
    pub(crate) as_reference: bool,
    /// The number of messages that the reference has logged when the rules are loaded.
    pub(crate) messages: u32,
    /// The size of a cell in pixels, if the game sets it.
    pub(crate) square_size: Option<i32>,
    /// `no_counters=`.
    pub(crate) counters: usize,
    /// The flag that lets counters end the game, as the terminations set it: `canEnd=`.
    pub(crate) can_end: bool,
    pub(crate) types: Vec<TypeInfo>,
    /// By type: the prototype of its sprites.
    pub(crate) prototypes: Vec<Sprite>,
    /// By type: the values that its sprites share.
    pub(crate) base_overrides: Vec<Overrides>,
    /// Drawing order; updates go through it backwards.
    pub(crate) order: Vec<SpriteType>,
    /// Types whose update does something, in update order.
    pub(crate) movers: Vec<Mover>,
    /// By type: `true` if anything but its own line, its parents' and the LevelMapping refers to it.
    pub(crate) referenced: Vec<bool>,
    /// By type: `true` if its sprites are scenery (`scenery.rs`).
    pub(crate) scenery: Vec<bool>,
    /// The sprites that each character places, by ASCII code.
    pub(crate) mapping: Vec<SmallVec<[SpriteType; 4]>>,
    /// Level characters that stand for an undeclared sprite: the reference crashes on a level that uses one.
    pub(crate) unusable: BTreeSet<char>,
    pub(crate) effects: Vec<EffectInfo>,
    /// Edge-of-screen passes, repeats expanded: the type and the effect.
    pub(crate) edge: Vec<(SpriteType, u16)>,
    /// `true` if one of them names an undeclared type: the reference crashes in the first tick.
    pub(crate) undeclared_at_edge: bool,
    pub(crate) passes: Vec<Pass>,
    /// The tables of possible passes, by the types that share cells.
    pub(crate) contacts: Contacts,
    /// By type.
    pub(crate) shortcuts: Vec<Shortcuts>,
    /// `true` if sprites of some type may sleep, and if some may fly.
    pub(crate) any_sleep: bool,
    pub(crate) any_fly: bool,
    pub(crate) timed: Vec<Timed>,
    /// `true` if the game has `obs=`, and thereby path finding.
    pub(crate) finds_paths: bool,
    /// `obs=`: the types that paths avoid.
    pub(crate) obstacles: Vec<SpriteType>,
    pub(crate) terminations: Vec<Termination>,
    /// `true` if anything can draw random numbers.
    pub(crate) draws: bool,
    /// `true` if anything reads the tick, apart from the reference's own limit.
    pub(crate) reads_tick: bool,
    /// The first tick in which a Timeout holds.
    pub(crate) first_timeout: i32,
    /// `true` if a termination reads the counters.
    pub(crate) reads_counters: bool,
    /// `true` if a termination reads the score.
    pub(crate) reads_score: bool,
    /// The largest sprite, in cells, rounded up.
    pub(crate) reach: i32,
    /// The cooldowns of spawners: spawners that are made later fire at ticks that are multiples of these.
    pub(crate) clocks: Vec<i32>,
    /// The ticks before which wizards, those made later included, make no block.
    pub(crate) wizard_ticks: Vec<i32>,
    /// `true` if the first sprite of some type can differ from later ones.
    pub(crate) first_differs: bool,
    /// The effects whose score may depend on an earlier execution of theirs.
    pub(crate) remembering: Vec<u16>,
}

/// A game, ready to play.
#[derive(Clone, Debug)]
pub struct Game(pub(crate) Arc<Rules>);

impl Game {
    /// Resolves and checks a description.
    ///
    /// # Errors
    /// All problems of the description, sorted by place.
    pub fn compile(description: &Description) -> Result<Game, Diagnostics> {
        crate::compile::compile(description).map(|rules| Game(Arc::new(rules)))
    }

    /// Parses and compiles.
    ///
    /// # Errors
    /// All problems of the text, sorted by place.
    pub fn from_source(source: &str) -> Result<Game, Diagnostics> {
        let (description, Diagnostics(read)) = crate::syntax::parse_all(source);
        match crate::compile::compile(&description) {
            Ok(mut rules) if !Diagnostics::has_errors(&read) => {
                rules.warnings = causes::reported(read, rules.warnings, source).0;
                Ok(Game(Arc::new(rules)))
            }
            // A description that compiles may have problems too; one run should show all problems.
            compiled => {
                let compiled = compiled.err().map_or(Vec::new(), |problems| problems.0);
                Err(causes::reported(read, compiled, source))
            }
        }
    }

    /// BLAKE3 of the canonical print without comments.
    pub fn digest(&self) -> Digest {
        self.0.digest
    }

    /// The syntax tree that the game was compiled from.
    pub fn description(&self) -> &Description {
        &self.0.description
    }

    /// Parses and compiles as the reference does: it drops, ignores or overlooks faults where it can, and counts messages
    /// (`spec/01` §1). For comparisons with the reference; everywhere else an error is an error.
    ///
    /// # Errors
    /// The fault on which the reference crashes.
    pub fn from_source_as_reference(source: &str) -> Result<Game, Diagnostics> {
        let (description, problems) = crate::syntax::parse_as_reference(source);
        if Diagnostics::has_errors(&problems) {
            return Err(Diagnostics(problems));
        }
        crate::compile::compile_as_reference(&description).map(|rules| Game(Arc::new(rules)))
    }

    /// The warnings: parts of the file that are legal but surely not intended, sorted by place. Empty for games that are
    /// loaded as the reference does.
    ///
    /// Cost: the first call analyses the rules ([`Analysis::of`](crate::Analysis::of)).
    pub fn warnings(&self) -> &[Diagnostic] {
        self.0.all_warnings.get_or_init(|| {
            let meant = if self.0.as_reference { Vec::new() } else { crate::lint::lint(self) };
            Diagnostics::sorted(self.0.warnings.iter().cloned().chain(meant).collect()).0
        })
    }

    /// The available actions besides [`Action::Nil`], sorted; [`Action::Nil`] alone if there is no avatar.
    pub fn actions(&self, state: &State) -> &'static [Action] {
        state.avatar_type().map_or(&[Action::Nil], |stype| self.0.types[stype.index()].actions)
    }

    /// Tests whether an action is among [`Game::actions`].
    pub(crate) fn allows(&self, state: &State, action: Action) -> bool {
        state.avatar_type().is_some_and(|stype| self.0.types[stype.index()].keys >> action as u8 & 1 != 0)
    }

    /// The actions besides [`Action::Nil`] of an avatar of that type, sorted.
    pub fn actions_of(&self, avatar: SpriteType) -> &'static [Action] {
        self.0.types[avatar.index()].actions
    }

    /// All sprite types, in registry order.
    pub fn sprite_types(&self) -> impl Iterator<Item = SpriteType> + use<> {
        (0..self.0.types.len() as u16).map(SpriteType)
    }

    /// The name of a type; `#-1` for an undeclared type, which games loaded as the reference does may count.
    pub fn name(&self, stype: SpriteType) -> &str {
        self.0.types.get(stype.index()).map_or("#-1", |info| &info.name)
    }

    /// The type of that name.
    pub fn sprite_type(&self, name: &str) -> Option<SpriteType> {
        self.sprite_types().find(|&stype| self.name(stype) == name)
    }

    /// The class of a type; `None` for bare grouping nodes.
    pub fn class(&self, stype: SpriteType) -> Option<SpriteClass> {
        self.0.types[stype.index()].class
    }

    /// The initial orientation of a type's sprites, written, inherited or set by their class; [`Direction::NONE`] for
    /// none, [`Direction::NIL`] for sprites that draw it.
    pub fn orientation(&self, stype: SpriteType) -> Direction {
        self.0.types[stype.index()].traits.orientation
    }

    /// The maximum number of ticks of an episode: the lowest `limit=` of a Timeout, or that of the reference.
    pub fn time_limit(&self) -> u64 {
        // The reference's own limit takes effect one tick after a Timeout with the same limit.
        self.0.first_timeout.clamp(1, MAX_TICKS + 1).unsigned_abs().into()
    }

    /// Returns `true` if the game draws no random numbers: the same actions always give the same episode.
    pub fn is_deterministic(&self) -> bool {
        !self.0.draws
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actions_have_the_reference_spelling() {
        assert_eq!(Action::from_reference("ACTION_LEFT"), Some(Action::Left));
        assert_eq!(Action::from_reference("ACTION_ESCAPE"), None);
        assert_eq!(Action::from_reference("LEFT"), None);
    }
}
