//! A compiled game: immutable, valid, cheap to clone.

use crate::bump::Barriers;
use crate::contacts::Contacts;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::form::Form;
use crate::geometry::Direction;
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;
use crate::ontology::sprites::Mover;
use crate::ontology::terminations::Termination;
use crate::ontology::traits::Traits;
use crate::rest::Foresight;
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
    /// No type: what an undeclared name stands for, in games loaded as the reference does.
    pub(crate) const NONE: SpriteType = SpriteType(u16::MAX);

    /// As an index into tables with one entry a type.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// What a player can do in a tick.
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
    /// All, in their order.
    pub const ALL: [Action; 6] =
        [Action::Nil, Action::Up, Action::Left, Action::Down, Action::Right, Action::Use];

    /// The reference's spelling, `ACTION_LEFT`, as traces have it.
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

/// How an episode stands.
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
    /// The rules did what the reference engine dies of, or a limit was met.
    Stopped(Limit),
}

/// Why an episode was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// More sprites than a state can hold.
    Sprites,
    /// More work in one tick than [`MAX_WORK`](crate::limits::MAX_WORK): effects, and sprites and cells looked at.
    Work,
    /// A sprite of the type whose sprites are being updated was spawned: the reference throws.
    SpawnIntoUpdatedType,
    /// A score changed after the avatar was removed for good: the reference throws.
    NoAvatar,
    /// A sprite of height 0 moved: the reference divides by it.
    FlatSprite,
    /// A path was asked for in a game without `obs=`.
    NoPaths,
    /// A sprite of a type without a class, or of an undeclared type, was to be made or sought.
    NoType,
    /// An effect ran without the sprites that it needs.
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
            Limit::NoAvatar => "the score changed after the avatar was removed for good",
            Limit::FlatSprite => "a sprite of height 0 moved",
            Limit::NoPaths => "a path was asked for in a game without `obs=`",
            Limit::NoType => {
                "a sprite of an unknown type, or of a type without a class, was to be made or sought"
            }
            Limit::NoSprite => "an effect ran without the sprites that it needs",
            Limit::EndlessTransform => "a type was transformed into itself without end",
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
    /// None: a bare grouping node.
    pub(crate) class: Option<SpriteClass>,
    pub(crate) traits: Traits,
    /// Ancestors from the root down, then the type itself.
    pub(crate) path: Box<[SpriteType]>,
    /// Ancestors, the type, its descendants: what rules on this type apply to (`spec/01` §1.6.3).
    pub(crate) tree: Box<[SpriteType]>,
    /// The place of every type in `tree`, or `NOT_IN_TREE`; indexed by type.
    pub(crate) rank: Box<[u16]>,
    /// Place in the update order; None for types whose sprites are never updated.
    pub(crate) order: Option<u16>,
    /// On its own line (`spec/01` §1.6.4).
    pub(crate) singleton: bool,
    /// How many of it, as a resource, a sprite can hold.
    pub(crate) resource_limit: i32,
    /// A leaf of the SpriteSet (or an undeclared `wall` or `avatar`).
    pub(crate) leaf: bool,
    /// A termination may count its sprites.
    pub(crate) counted: bool,
    /// Some effect can give speed to sprites that have none.
    pub(crate) given_speed: bool,
    /// Lacks a parameter without which the reference dies of making such a sprite.
    pub(crate) incomplete: bool,
    /// Messages that the reference logs when it makes the first sprite: parameters that the class does not have.
    pub(crate) unknown_parameters: u32,
    /// Notices what it stands on when rules test what it meets.
    pub(crate) ground_aware: bool,
    /// The first sprite of the type is not like later ones, which are copies: they have the size from the start, their
    /// parameters have been complained of, and what they leave behind is wall.
    pub(crate) first_differs: bool,
    /// What the player can do with it; [`Action::Nil`] alone if nothing.
    pub(crate) actions: &'static [Action],
    /// The same, a bit each.
    pub(crate) keys: u8,
}

pub(crate) const NOT_IN_TREE: u16 = u16::MAX;

impl TypeInfo {
    /// Where teleportToExit leads from a sprite of this type (`spec/03` §8.3).
    pub(crate) fn leads_to(&self) -> Option<SpriteType> {
        use SpriteClass as C;
        let class = self.class?;
        let leading = [C::Portal, C::SpawnPoint, C::Chaser, C::PathChaser, C::FlakAvatar, C::Spreader];
        let has = leading.iter().any(|&other| class.is_a(other));
        self.traits.stypes.first().copied().filter(|_| has)
    }

    /// Whether its sprites are taken for avatars when a level starts.
    pub(crate) fn is_like_avatar(&self) -> bool {
        self.traits.is_avatar || self.class.is_some_and(SpriteClass::is_avatar)
    }

    /// Whether the tree names a type twice: a type declared below itself does (`spec/01` §1.6.3).
    pub(crate) fn repeats(&self) -> bool {
        self.tree.iter().enumerate().any(|(at, stype)| usize::from(self.rank[stype.index()]) != at)
    }

    pub(crate) fn in_tree(&self, other: SpriteType) -> bool {
        self.rank[other.index()] != NOT_IN_TREE
    }
}

/// One interaction line, compiled. All its right-hand sprites share it and what it remembers.
#[derive(Clone, Debug)]
pub(crate) struct EffectInfo {
    pub(crate) effect: Effect,
    pub(crate) score_change: i32,
    pub(crate) apply_score: bool,
    /// `scoreChange` and `scoreChangeIfKilled` that are no numbers: 0, and a message each time.
    pub(crate) score_faults: [bool; 2],
    /// What an execution adds to the game's counters, if anything.
    pub(crate) counting: Option<Box<Counting>>,
    /// Runs once on all partners of a sprite together.
    pub(crate) in_batch: bool,
    /// The line runs by the clock as well, and its score and counters apply whatever the effect says as it runs.
    pub(crate) steady: bool,
    /// Index of the line in the description.
    pub(crate) line: usize,
}

/// `counter` and `counterElse` of a line (`spec/03` §3): an amount for each counter of the game; None for a text that is
/// no number, which counts 0 and is a message each time.
#[derive(Clone, Debug)]
pub(crate) struct Counting {
    pub(crate) count: bool,
    pub(crate) count_else: bool,
    pub(crate) counter: Box<[Option<i32>]>,
    pub(crate) counter_else: Box<[Option<i32>]>,
}

impl EffectInfo {
    /// What the effect remembers at the start; see [`memory`].
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
    /// The effect, with the memory of its own.
    pub(crate) effect: u16,
    /// On which sprites; None: once, on none.
    pub(crate) target: Option<SpriteType>,
    /// Ticks from planning to running.
    pub(crate) timer: i32,
    pub(crate) repeating: bool,
    /// The tick of the first run; None if addTimer plans it.
    pub(crate) first_due: Option<i32>,
    /// The effect whose line says what the score changes by: itself, or the addTimer.
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
    /// The effect's place among the keywords, for shields.
    pub(crate) keyword: u16,
    /// The second tree names a type twice: its sprites are met twice.
    pub(crate) repeats: bool,
    /// Hits can be found from the second side: executing the effect moves nothing that a later hit depends on.
    pub(crate) either_side: bool,
}

/// Everything that a game file says, resolved.
#[derive(Clone, Debug)]
pub(crate) struct Rules {
    pub(crate) description: Description,
    pub(crate) digest: Digest,
    /// What the text alone warns of.
    pub(crate) warnings: Vec<Diagnostic>,
    /// Those and what the meaning of the rules warns of; found when first asked for.
    pub(crate) all_warnings: OnceLock<Vec<Diagnostic>>,
    /// Loaded as the reference does: levels are, too.
    pub(crate) as_reference: bool,
    /// Messages that the reference has logged when the rules are loaded.
    pub(crate) messages: u32,
    /// Pixels of a cell, if the game says so.
    pub(crate) square_size: Option<i32>,
    /// `no_counters=`.
    pub(crate) counters: usize,
    /// What terminations say of the flag that lets counters end the game: `canEnd=`.
    pub(crate) can_end: bool,
    pub(crate) types: Vec<TypeInfo>,
    /// By type: its sprites as they are made.
    pub(crate) models: Vec<Sprite>,
    /// By type: their form.
    pub(crate) forms: Vec<Form>,
    /// Drawing order; updates go through it backwards.
    pub(crate) order: Vec<SpriteType>,
    /// Types whose update does something, in update order.
    pub(crate) movers: Vec<Mover>,
    /// By type: whether anything but its own line, its parents' and the LevelMapping speaks of it.
    pub(crate) spoken_of: Vec<bool>,
    /// By type: whether its sprites are scenery (`scenery.rs`).
    pub(crate) scenery: Vec<bool>,
    /// By ASCII code.
    pub(crate) mapping: Vec<SmallVec<[SpriteType; 4]>>,
    /// Level characters that stand for an undeclared sprite: the reference dies of a level that uses one.
    pub(crate) unusable: BTreeSet<char>,
    pub(crate) effects: Vec<EffectInfo>,
    /// Edge-of-screen passes, repeats expanded: the type and the effect.
    pub(crate) edge: Vec<(SpriteType, u16)>,
    /// One of them is about an undeclared type: the reference dies of it in the first tick.
    pub(crate) undeclared_at_edge: bool,
    pub(crate) passes: Vec<Pass>,
    /// Which passes can do something, by what stands together.
    pub(crate) contacts: Contacts,
    /// By type.
    pub(crate) foresight: Vec<Foresight>,
    /// Whether sprites of some type may rest, and fly.
    pub(crate) any_rests: bool,
    pub(crate) any_flies: bool,
    /// By type.
    pub(crate) barriers: Vec<Barriers>,
    /// Whether any type has some.
    pub(crate) any_barriers: bool,
    pub(crate) timed: Vec<Timed>,
    /// The game has `obs=`, and with it path finding.
    pub(crate) finds_paths: bool,
    /// `obs=`: types that path finding goes around.
    pub(crate) obstacles: Vec<SpriteType>,
    pub(crate) terminations: Vec<Termination>,
    /// Whether anything can draw from the chance.
    pub(crate) draws: bool,
    /// Whether anything reads the tick, apart from the reference's own limit.
    pub(crate) reads_tick: bool,
    /// The first tick in which a Timeout holds.
    pub(crate) first_timeout: i32,
    /// Whether a termination reads the counters.
    pub(crate) reads_counters: bool,
    /// Whether a termination reads the score.
    pub(crate) reads_score: bool,
    /// The largest sprite, in cells, rounded up.
    pub(crate) reach: i32,
    /// Cooldowns of spawners: those made later fire at ticks that are multiples of them.
    pub(crate) clocks: Vec<i32>,
    /// Ticks before which wizards, those made later included, make no block.
    pub(crate) wizard_ticks: Vec<i32>,
    /// Whether the first sprite of some type can differ from later ones.
    pub(crate) first_differs: bool,
    /// Effects that may credit by what an earlier execution of theirs found.
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
                rules.warnings = causes::told(read, rules.warnings, source).0;
                Ok(Game(Arc::new(rules)))
            }
            // What does compile may have problems too; one run should show them all.
            compiled => {
                let compiled = compiled.err().map_or(Vec::new(), |problems| problems.0);
                Err(causes::told(read, compiled, source))
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
    /// (`spec/01` §1). For comparing with it; everywhere else an error is an error.
    ///
    /// # Errors
    /// What the reference dies of.
    pub fn from_source_as_reference(source: &str) -> Result<Game, Diagnostics> {
        let (description, problems) = crate::syntax::parse_as_reference(source);
        if Diagnostics::has_errors(&problems) {
            return Err(Diagnostics(problems));
        }
        crate::compile::compile_as_reference(&description).map(|rules| Game(Arc::new(rules)))
    }

    /// What is legal in the file but surely not meant, sorted by place; nothing for games loaded as the reference does.
    ///
    /// Cost: the first call analyses the rules ([`Analysis::of`](crate::Analysis::of)).
    pub fn warnings(&self) -> &[Diagnostic] {
        self.0.all_warnings.get_or_init(|| {
            let meant = if self.0.as_reference { Vec::new() } else { crate::lint::lint(self) };
            Diagnostics::sorted(self.0.warnings.iter().cloned().chain(meant).collect()).0
        })
    }

    /// What the player can do now, besides nothing: sorted; only [`Action::Nil`] without an avatar.
    pub fn actions(&self, state: &State) -> &'static [Action] {
        state.avatar_type().map_or(&[Action::Nil], |stype| self.0.types[stype.index()].actions)
    }

    /// Whether that is among [`Game::actions`].
    pub(crate) fn allows(&self, state: &State, action: Action) -> bool {
        state.avatar_type().is_some_and(|stype| self.0.types[stype.index()].keys >> action as u8 & 1 != 0)
    }

    /// What the player can do, besides nothing, as an avatar of that type: sorted.
    pub fn actions_of(&self, avatar: SpriteType) -> &'static [Action] {
        self.0.types[avatar.index()].actions
    }

    /// All sprite types, in registry order.
    pub fn sprite_types(&self) -> impl Iterator<Item = SpriteType> + use<> {
        (0..self.0.types.len() as u16).map(SpriteType)
    }

    /// The name of a type; that of an undeclared one, which games loaded as the reference does may count, is `#-1`.
    pub fn name(&self, stype: SpriteType) -> &str {
        self.0.types.get(stype.index()).map_or("#-1", |info| &info.name)
    }

    /// The type of that name.
    pub fn sprite_type(&self, name: &str) -> Option<SpriteType> {
        self.sprite_types().find(|&stype| self.name(stype) == name)
    }

    /// The class of a type; none for bare grouping nodes.
    pub fn class(&self, stype: SpriteType) -> Option<SpriteClass> {
        self.0.types[stype.index()].class
    }

    /// Where new sprites of a type face, written, inherited or by their class; [`Direction::NONE`] for what faces nowhere,
    /// [`Direction::NIL`] for what draws it.
    pub fn orientation(&self, stype: SpriteType) -> Direction {
        self.0.types[stype.index()].traits.orientation
    }

    /// Whether chance plays no part: the same actions always give the same episode.
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
