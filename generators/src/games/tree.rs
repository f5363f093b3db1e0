//! The elements of a draft: sprite types, rules, endings and words, as typed data.

use super::body::Body;
use super::effect::Effect;
use super::role::Role;
use engine::SpriteClass;

/// A sprite type of the draft, by its index there.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Part(pub(crate) usize);

/// A reference to a sprite type that is valid in any draft: no two patterns of a game share a role, so other changes do
/// not affect it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Site {
    pub(crate) role: Role,
    /// The index among the types of that role, in the order of creation.
    pub(crate) nth: usize,
}

/// The floor.
pub(crate) const FLOOR: Part = Part(0);
/// The parent of the wall.
pub(crate) const WALL: Part = Part(1);
/// The parent of all states of the hero.
pub(crate) const AVATAR: Part = Part(2);
/// The hero as it starts.
pub(crate) const HERO: Part = Part(3);

/// The partner of rules that run on a timer.
pub(crate) const CLOCK: Part = Part(usize::MAX);

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Value {
    /// A number of things, ticks or points.
    Count(u32),
    /// Points, which may be negative.
    Score(i32),
    /// A fraction, in hundredths.
    Hundredths(u32),
    /// `True` or `False`.
    Flag(bool),
    /// A constant.
    Word(&'static str),
    /// A sprite type.
    Part(Part),
}

/// A sprite type.
#[derive(Debug)]
pub(crate) struct Sprite {
    pub(crate) name: String,
    pub(crate) role: Role,
    /// `None` inherits the parent's class.
    pub(crate) class: Option<SpriteClass>,
    pub(crate) params: Vec<(&'static str, Value)>,
    pub(crate) parent: Option<Part>,
    pub(crate) body: Body,
    /// `true` if levels can place it; otherwise it is created only during play.
    pub(crate) placed: bool,
    /// The number of the pattern that it belongs to; `None` for floor, wall and hero.
    pub(crate) gene: Option<usize>,
    /// `true` if an edit has removed it.
    pub(crate) removed: bool,
}

/// The phase of a tick in which a rule applies: the order of the InteractionSet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Phase {
    /// Carriers move what they carry.
    Carry,
    /// Pushed things move.
    Push,
    /// Locked things open, before they stop anyone.
    Open,
    /// Stopped things move back.
    Block,
    /// Things that were hit are killed.
    Strike,
    /// Sprites that meet change each other.
    Meet,
    /// The hero takes things.
    Take,
    /// The hero is harmed.
    Harm,
    /// The hero arrives.
    Arrive,
}

/// An interaction.
#[derive(Clone, Debug)]
pub(crate) struct Rule {
    pub(crate) phase: Phase,
    pub(crate) first: Part,
    pub(crate) second: Vec<Part>,
    pub(crate) effect: Effect,
    pub(crate) score: i32,
    /// The number of the pattern that it belongs to; `None` if it follows from bodies or was added by an edit.
    pub(crate) gene: Option<usize>,
}

/// A statement about the game, in words.
#[derive(Clone, Debug)]
pub(crate) struct Clause {
    pub(crate) text: String,
    /// The number of the pattern that it describes.
    pub(crate) gene: Option<usize>,
    pub(crate) claim: Claim,
}

/// The subject of a clause: clauses about a subject are removed when it changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Claim {
    /// The working of the pattern.
    Fact,
    /// The movement of a sprite type.
    Way(Part),
    /// The value of something in points.
    Points,
}

/// A termination.
#[derive(Clone, Debug)]
pub(crate) enum Ending {
    /// No sprite of these types is left.
    NoneLeft(Vec<Part>),
    /// The number of sprites of a type has reached this.
    Many(Part, u32),
    /// The time limit, in ticks.
    Timeout(u32),
}

impl Ending {
    /// The types that it counts.
    pub(crate) fn parts(&self) -> &[Part] {
        match self {
            Ending::NoneLeft(parts) => parts,
            Ending::Many(part, _) => std::slice::from_ref(part),
            Ending::Timeout(_) => &[],
        }
    }
}

/// The effect of a touch on a harmful sprite, if the hero survives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Harm {
    /// Nothing.
    Lasting,
    /// It is removed.
    Spent,
}

/// The amount of harm that the hero can survive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stamina {
    /// The first touch kills.
    Fragile,
    /// The hero has this many health points.
    Hearts(u32),
    /// A touch kills unless it uses up one of this resource.
    Warded(Part),
}

/// The hero's weapon: the part that hits, and its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weapon {
    /// Hits close by, and stays.
    Blade(Part),
    /// Flies, and is removed when it hits.
    Bolt(Part),
    /// Explodes, and hits all around.
    Blast(Part),
}
