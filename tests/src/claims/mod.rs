//! The claims that the suite makes about a game or a level, and plays that could refute them.
//!
//! A claim of the form "cannot", "never" or "only" is a proof, and a false one is the worst fault that the suite can have.
//! [`read`] reads the claims off the texts that users see (`describe`, warnings) and off the proofs of the analysis
//! (reachability, chains of causes). [`play`] records plays tick by tick. [`Fact::refuted_by`] looks for the moment of a play
//! that contradicts a claim. [`games`] makes games of which most break some assumption, and [`shrink`] makes a fault small.

pub mod games;
pub mod play;
pub mod read;
mod refute;
pub mod shrink;

use base::Seed;
use engine::analysis::Reach;
use engine::{Action, Analysis, Game, Level, Outcome, SpriteType};
use play::Play;
use std::collections::BTreeMap;
use std::fmt;

/// The way in which a file is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Policy {
    /// Faults are errors.
    Strict,
    /// Faults are recovered from, as by the reference.
    Reference,
}

impl Policy {
    /// Loads a game under the policy; none if it does not load.
    pub fn load(self, source: &str) -> Option<Game> {
        match self {
            Policy::Strict => Game::from_source(source).ok(),
            Policy::Reference => Game::from_source_as_reference(source).ok(),
        }
    }
}

/// A claim: a text with its meaning.
#[derive(Clone, Debug)]
pub struct Claim {
    /// The words, or the name of the proof.
    pub text: String,
    /// The meaning.
    pub fact: Fact,
}

/// The condition of an ending, in the words of its sentence.
#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// At most so many sprites of these types.
    AtMost(Vec<SpriteType>, i64),
    /// At least so many.
    AtLeast(Vec<SpriteType>, i64),
    /// Exactly so many.
    Exactly(Vec<SpriteType>, i64),
    /// The number of ticks played.
    Ticks(i64),
}

/// The further condition of an ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Provided {
    /// None.
    Always,
    /// The score is not 0.
    Score,
    /// The score is 0.
    NoScore,
    /// The counters are not all the same.
    Difference,
    /// The counters are all the same.
    NoDifference,
    /// The first counter has this value.
    Value(i32),
    /// The first counter has another value.
    OtherValue(i32),
}

/// The condition under which an ending does not count.
#[derive(Clone, Debug, PartialEq)]
pub struct Unless {
    /// The condition.
    pub when: When,
    /// `true` if it is that of the tick before.
    pub before: bool,
    /// `true` if the ending does not count in the first tick either.
    pub not_first: bool,
}

/// A sentence about an ending.
#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    /// `true` if it wins.
    pub win: bool,
    /// The condition.
    pub when: When,
    /// The number of types that the counted sprites must have, if it matters.
    pub kinds: Option<usize>,
    /// The further condition.
    pub provided: Provided,
    /// The condition under which it does not count.
    pub unless: Option<Unless>,
}

/// The order of endings that hold in one tick.
#[derive(Clone, Debug, PartialEq)]
pub enum Tie {
    /// Such a tick is lost.
    Lost,
    /// Such a tick is won.
    Won,
    /// Nothing is said, or something that is not understood here.
    Open,
}

/// The meaning of a claim, as far as a play can refute it.
#[derive(Clone, Debug)]
pub enum Fact {
    /// These are all ways to win and lose before the last tick, and each of them ends the game.
    Endings(Vec<Ending>, Tie),
    /// The game is not won (first) or lost, except in its first tick.
    Unattainable(bool),
    /// The level is not won (first) or lost, even in its first tick.
    OutOfReach(bool),
    /// The episode is over in its first tick; with this outcome, if there is one.
    OverAtOnce(Option<bool>),
    /// The interaction with this index never happens.
    Silent(usize),
    /// No sprite ever holds more than this amount of a resource.
    HeldAtMost(SpriteType, i64),
    /// There is never a sprite of the type.
    Absent(SpriteType),
    /// Sprites of these types are the only ones.
    OnlyTypes(Vec<SpriteType>),
    /// A rule on the first type concerns sprites of these types only.
    OnlyMembers(SpriteType, Vec<SpriteType>),
    /// Sprites of the first types never meet those of the second; none: the edge.
    NeverMeet(Vec<SpriteType>, Option<Vec<SpriteType>>),
    /// All avatars are of these types.
    OnlyAvatars(Vec<SpriteType>),
    /// Sprites of the type do not move by themselves.
    Stands(SpriteType),
    /// Sprites of the type stay where they are, whatever happens.
    Fixed(SpriteType),
    /// There is at most one sprite of these types, or as many as the level placed.
    Single(Vec<SpriteType>),
    /// There are never more sprites of these types than at the start.
    OnlyFalls(Vec<SpriteType>),
    /// There are never more sprites of these types.
    CountAtMost(Vec<SpriteType>, i64),
    /// The sprites that the level places there stay there.
    Permanent(Vec<(SpriteType, usize)>),
    /// The termination with this index among the goals never holds.
    GoalNeverHolds(usize),
    /// The sprites never get to a cell.
    NeverAt(SpriteType, usize),
    /// Between two ticks, sprites of each type are in these cells only, by type.
    Within(Vec<Vec<bool>>),
    /// Avatars are in at most so many cells of the board.
    CellsVisited(usize),
    /// A sprite of the first types does not move onto one of the second; none: off the board.
    CannotEnter(Vec<SpriteType>, Option<Vec<SpriteType>>),
    /// Observations do not show sprites of the type.
    Unseen(SpriteType),
    /// No key changes anything.
    DeadKeys,
    /// These keys change nothing.
    IdleKeys(Vec<Action>),
    /// Nothing happens unless the player acts.
    TurnBased,
    /// The seed changes nothing.
    NoChance,
    /// Nothing but avatars moves by itself.
    OthersIdle,
    /// Sprites that interactions concern are shown.
    AllShown,
    /// Without the parameter at this position of the text, the game plays alike.
    Ignored(usize),
    /// No play at all wins: all states were searched.
    SearchedInVain,
}

impl Fact {
    /// The name of the kind, for counts.
    pub fn kind(&self) -> &'static str {
        match self {
            Fact::Endings(..) => "endings: these win and lose, and nothing else",
            Fact::Unattainable(true) => "the game cannot be won",
            Fact::Unattainable(false) => "the game cannot be lost",
            Fact::OutOfReach(true) => "the level cannot be won",
            Fact::OutOfReach(false) => "the level cannot be lost",
            Fact::OverAtOnce(_) => "over in the first tick",
            Fact::Silent(_) => "a rule never fires",
            Fact::HeldAtMost(..) => "no more can be held",
            Fact::Absent(_) => "no such sprite ever exists",
            Fact::OnlyTypes(_) => "only these types exist",
            Fact::OnlyMembers(..) => "a group means only these",
            Fact::NeverMeet(..) => "two never meet",
            Fact::OnlyAvatars(_) => "you are only these",
            Fact::Stands(_) => "it only stands there",
            Fact::Fixed(_) => "it never moves",
            Fact::Single(_) => "only one at a time",
            Fact::OnlyFalls(_) => "only so many are left",
            Fact::CountAtMost(..) => "there can never be more",
            Fact::Permanent(_) => "nothing can ever end it",
            Fact::GoalNeverHolds(_) => "a termination never holds",
            Fact::NeverAt(..) => "cannot reach a cell",
            Fact::Within(_) => "every type within its reach",
            Fact::CellsVisited(_) => "so many cells at most",
            Fact::CannotEnter(..) => "cannot enter",
            Fact::Unseen(_) => "cannot be seen",
            Fact::DeadKeys => "no key does anything",
            Fact::IdleKeys(_) => "keys that change nothing",
            Fact::TurnBased => "nothing happens unless you act",
            Fact::NoChance => "chance plays no part",
            Fact::OthersIdle => "nothing else acts",
            Fact::AllShown => "everything that matters is shown",
            Fact::Ignored(_) => "a parameter does nothing",
            Fact::SearchedInVain => "all states were searched",
        }
    }
}

/// A game with a level, under a policy.
pub struct Case {
    /// The text of the game.
    pub source: String,
    /// The text of the level.
    pub text: String,
    /// The way of loading.
    pub policy: Policy,
    /// The game.
    pub game: Game,
    /// The level.
    pub level: Level,
    /// The analysis of the game.
    pub analysis: Analysis,
    /// The reach of the level.
    pub reach: Reach,
}

impl Case {
    /// Loads a game and a level; none if they do not load.
    pub fn load(source: &str, text: &str, policy: Policy) -> Option<Case> {
        let game = policy.load(source)?;
        let level = game.level(text).ok()?;
        let analysis = Analysis::of(&game);
        let reach = analysis.reach(&level);
        let (source, text) = (source.to_owned(), text.to_owned());
        Some(Case { source, text, policy, game, level, analysis, reach })
    }
}

/// A false claim.
pub struct Fault {
    /// The claim.
    pub claim: Claim,
    /// The contradiction.
    pub found: String,
    /// The text of the game.
    pub source: String,
    /// The text of the level.
    pub level: String,
    /// The way of loading.
    pub policy: Policy,
    /// The seed and the actions of the play.
    pub play: (Seed, Vec<Action>),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault { claim, found, source, level, policy, play: (_, actions) } = self;
        let keys: Vec<String> = actions.iter().map(ToString::to_string).collect();
        writeln!(f, "FALSE ({}, {policy:?}): {}\n  {found}", claim.fact.kind(), claim.text)?;
        writeln!(f, "{}\n{}\nplayed: {}", source.trim_end(), level.trim_end_matches('\n'), keys.join(" "))
    }
}

/// The numbers of a run.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Games, each under one policy.
    pub games: [usize; 2],
    /// Plays.
    pub plays: usize,
    /// Ticks.
    pub ticks: usize,
    /// Won, lost.
    pub ends: [usize; 2],
    /// Claims by kind, each game's once.
    pub claims: BTreeMap<&'static str, usize>,
}

impl Tally {
    /// Adds the numbers of another run.
    #[must_use]
    pub fn and(mut self, other: Tally) -> Tally {
        (0..2).for_each(|at| self.games[at] += other.games[at]);
        (0..2).for_each(|at| self.ends[at] += other.ends[at]);
        self.plays += other.plays;
        self.ticks += other.ticks;
        for (kind, count) in other.claims {
            *self.claims.entry(kind).or_default() += count;
        }
        self
    }

    /// Counts a case with its claims and plays.
    pub fn count(&mut self, case: &Case, claims: &[Claim], plays: &[Play]) {
        self.games[usize::from(case.policy == Policy::Reference)] += 1;
        self.plays += plays.len();
        for play in plays {
            self.ticks += play.actions.len();
            let outcome = play.frames.last().map(|frame| frame.outcome);
            self.ends[0] += usize::from(outcome == Some(Outcome::Won));
            self.ends[1] += usize::from(outcome == Some(Outcome::Lost));
        }
        for claim in claims {
            *self.claims.entry(claim.fact.kind()).or_default() += 1;
        }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Tally { games: [strict, reference], plays, ticks, ends: [won, lost], claims } = self;
        writeln!(f, "{strict} games strictly, {reference} as the reference reads them")?;
        writeln!(f, "{plays} plays, {ticks} ticks, {won} won, {lost} lost")?;
        let all: usize = claims.values().sum();
        writeln!(f, "{all} claims")?;
        claims.iter().try_for_each(|(kind, count)| writeln!(f, "{count:9}  {kind}"))
    }
}

/// Returns the claims of a case that its plays refute, each once.
pub fn faults(case: &Case, claims: &[Claim], plays: &[Play]) -> Vec<Fault> {
    let fault = |claim: &Claim| {
        let refuted = plays.iter().find_map(|play| Some((claim.fact.refuted_by(case, play)?, play)));
        refuted.map(|(found, play)| Fault {
            claim: claim.clone(),
            found,
            source: case.source.clone(),
            level: case.text.clone(),
            policy: case.policy,
            play: (play.seed, play.actions.clone()),
        })
    };
    claims.iter().filter_map(fault).collect()
}
