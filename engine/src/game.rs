//! A compiled game: immutable, valid, cheap to clone.

use crate::Digest;
use crate::contacts::Contacts;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::ontology::class::SpriteClass;
use crate::ontology::effects::Effect;
use crate::ontology::terminations::Termination;
use crate::ontology::traits::Traits;
use crate::state::State;
use crate::syntax::Description;
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;
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
    /// More work of effects and chasers in one tick than [`MAX_EFFECTS`](crate::MAX_EFFECTS), or more timers than can be planned.
    Effects,
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
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Limit::Sprites => "more sprites than a state can hold",
            Limit::Effects => "the effects of one tick do not come to an end",
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
        })
    }
}

/// A compiled sprite type.
#[derive(Debug)]
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
    /// Lacks a parameter without which the reference dies of making such a sprite.
    pub(crate) incomplete: bool,
    /// Messages that the reference logs when it makes the first sprite: parameters that the class does not have.
    pub(crate) unknown_parameters: u32,
    /// Notices what it stands on when rules test what it meets.
    pub(crate) ground_aware: bool,
    /// What the player can do with it; [`Action::Nil`] alone if nothing.
    pub(crate) actions: &'static [Action],
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

    pub(crate) fn in_tree(&self, other: SpriteType) -> bool {
        self.rank[other.index()] != NOT_IN_TREE
    }
}

/// One interaction line, compiled. All its right-hand sprites share it and what it remembers.
#[derive(Debug)]
pub(crate) struct EffectInfo {
    pub(crate) effect: Effect,
    pub(crate) score_change: i32,
    pub(crate) apply_score: bool,
    /// Runs once on all partners of a sprite together.
    pub(crate) in_batch: bool,
    /// Index of the line in the description.
    pub(crate) line: usize,
}

/// An effect that runs by the clock: written with TIME, or planned by addTimer (`spec/03` §6).
#[derive(Debug)]
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
    pub(crate) score_change: i32,
    pub(crate) apply_score: bool,
    pub(crate) line: usize,
}

/// One pass of the event phase over all pairs of two types (`spec/03` §4.5).
#[derive(Debug)]
pub(crate) struct Pass {
    pub(crate) first: SpriteType,
    pub(crate) second: SpriteType,
    pub(crate) effect: u16,
    /// The effect's place among the keywords, for shields.
    pub(crate) keyword: u16,
    /// Hits can be found from the second side: executing the effect moves nothing that a later hit depends on.
    pub(crate) either_side: bool,
}

/// Everything that a game file says, resolved.
#[derive(Debug)]
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
    pub(crate) types: Vec<TypeInfo>,
    /// Drawing order; updates go through it backwards.
    pub(crate) order: Vec<SpriteType>,
    /// Types whose update does something, in update order.
    pub(crate) movers: Vec<SpriteType>,
    /// By ASCII code.
    pub(crate) mapping: Vec<SmallVec<[SpriteType; 4]>>,
    pub(crate) effects: Vec<EffectInfo>,
    /// Edge-of-screen passes, repeats expanded: the type and the effect.
    pub(crate) edge: Vec<(SpriteType, u16)>,
    pub(crate) passes: Vec<Pass>,
    /// Which passes can do something, by what stands together.
    pub(crate) contacts: Contacts,
    /// By type: whether its sprites may rest.
    pub(crate) rests: Vec<bool>,
    /// Whether one of them may.
    pub(crate) any_rests: bool,
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
    /// The largest sprite, in cells, rounded up.
    pub(crate) reach: i32,
    /// Whether the first sprite of a type can differ from later ones.
    pub(crate) first_differs: bool,
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
        let (description, problems) = crate::syntax::parse(source);
        if Diagnostics::has_errors(&problems) {
            // What does compile may have problems too; one run should show them all.
            let more = Game::compile(&description).err().map_or(Vec::new(), |more| more.0);
            // What could not be read may have declared what is missing then.
            let unread = ["missing-section", "missing-arrow", "stray-line", "bad-line", "too-deep"];
            let unread = problems.iter().any(|problem| unread.contains(&problem.code));
            let hidden =
                |problem: &Diagnostic| problem.code == "no-win" || unread && problem.code == "unknown-sprite";
            let more = more.into_iter().filter(|problem| !hidden(problem));
            return Err(Diagnostics::sorted(problems.into_iter().chain(more).collect()));
        }
        let mut rules = crate::compile::compile(&description)?;
        rules.warnings = Diagnostics::sorted(problems.into_iter().chain(rules.warnings).collect()).0;
        Ok(Game(Arc::new(rules)))
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

    /// All sprite types, in registry order.
    pub fn sprite_types(&self) -> impl Iterator<Item = SpriteType> + use<> {
        (0..self.0.types.len() as u16).map(SpriteType)
    }

    /// The name of a type.
    pub fn name(&self, stype: SpriteType) -> &str {
        &self.0.types[stype.index()].name
    }

    /// The type of that name.
    pub fn sprite_type(&self, name: &str) -> Option<SpriteType> {
        self.sprite_types().find(|&stype| self.name(stype) == name)
    }

    /// The class of a type; none for bare grouping nodes.
    pub fn class(&self, stype: SpriteType) -> Option<SpriteClass> {
        self.0.types[stype.index()].class
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
