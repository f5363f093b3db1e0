//! What a draft is made of: sprite types, rules, endings and words, as typed data.

use super::body::Body;
use super::effect::Effect;
use super::role::Role;
use engine::SpriteClass;

/// A sprite type of the draft.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Part(pub(crate) usize);

impl Part {
    /// Its place among the sprite types of its draft.
    pub(crate) fn index(self) -> usize {
        self.0
    }
}

/// A sprite type of any draft that has it: no two patterns of a game share a role, so this holds whatever else changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Site {
    pub(crate) role: Role,
    /// Among the types of that role, in the order of their making.
    pub(crate) nth: usize,
}

/// The type under everything.
pub(crate) const FLOOR: Part = Part(0);
/// The parent of the wall.
pub(crate) const WALL: Part = Part(1);
/// The parent of all states of the hero.
pub(crate) const AVATAR: Part = Part(2);
/// The hero as it starts.
pub(crate) const HERO: Part = Part(3);

/// The partner of rules that run by the clock.
pub(crate) const CLOCK: Part = Part(usize::MAX);

/// The value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Value {
    /// A number of things, ticks, points.
    Count(u32),
    /// Points, which may be negative.
    Score(i32),
    /// A share of one, in hundredths.
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
    /// None: as the parent.
    pub(crate) class: Option<SpriteClass>,
    pub(crate) params: Vec<(&'static str, Value)>,
    pub(crate) parent: Option<Part>,
    pub(crate) body: Body,
    /// Whether levels can place it; else it comes into being during play.
    pub(crate) placed: bool,
    /// The number of the pattern that it belongs to; none for floor, wall and hero.
    pub(crate) gene: Option<usize>,
    /// An edit took it out again.
    pub(crate) gone: bool,
}

/// When in a tick a rule has its turn: the order of the InteractionSet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Phase {
    /// What carries moves what it carries.
    Carry,
    /// What is pushed moves.
    Push,
    /// What can be opened opens, before it stops anyone.
    Open,
    /// What cannot pass goes back.
    Block,
    /// What was hit falls.
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
    /// The number of the pattern that it belongs to; none if it follows from bodies, or was added by an edit.
    pub(crate) gene: Option<usize>,
}

/// Something to know, in words.
#[derive(Clone, Debug)]
pub(crate) struct Clause {
    pub(crate) text: String,
    /// The number of the pattern that says so.
    pub(crate) gene: Option<usize>,
    pub(crate) claim: Claim,
}

/// What a clause is about: when it changes, the words do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Claim {
    /// How the pattern works.
    Fact,
    /// How a sprite type moves.
    Way(Part),
    /// What something is worth.
    Points,
}

/// A termination.
#[derive(Clone, Debug)]
pub(crate) enum Ending {
    /// None of these is left.
    Gone(Vec<Part>),
    /// There are so many of these.
    Many(Part, u32),
    /// Time is up.
    Timeout(u32),
}

impl Ending {
    /// The types that it counts.
    pub(crate) fn parts(&self) -> &[Part] {
        match self {
            Ending::Gone(parts) => parts,
            Ending::Many(part, _) => std::slice::from_ref(part),
            Ending::Timeout(_) => &[],
        }
    }
}

/// What touching a sprite does to it, besides harming the hero, when the hero survives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Harm {
    /// Nothing.
    Lasting,
    /// It is gone.
    Spent,
}

/// What the hero can take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stamina {
    /// One touch is the end.
    Fragile,
    /// So many touches are.
    Hearts(u32),
    /// A touch is the end unless one of these wards it off.
    Warded(Part),
}

/// What the hero strikes with: the part that hits, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Weapon {
    /// Strikes close by, and stays.
    Blade(Part),
    /// Flies, and is gone when it hits.
    Bolt(Part),
    /// Goes off, and hits all around.
    Blast(Part),
}
