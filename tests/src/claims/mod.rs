//! The claims that the suite makes about a game or a level, and the episodes that could refute them.
//!
//! A claim of the form "cannot", "never" or "only" asserts a proof, and a false one is the worst possible bug
//! in the suite. [`read`] extracts the claims from the texts that users see (`describe`, warnings) and from
//! the proofs of the analysis (reachability, chains of causes). [`play`] records episodes tick by tick.
//! [`Fact::refuted_by`] searches an episode for a moment that contradicts a claim. [`games`] creates games,
//! most of which break an assumption, and [`shrink`] reduces games that refute a claim.

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

/// The policy under which a game is loaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Policy {
    /// Faults are errors.
    Strict,
    /// The loader recovers from faults as the reference does.
    Reference,
}

impl Policy {
    /// Loads a game under the policy. Returns `None` if loading fails.
    pub fn load(self, source: &str) -> Option<Game> {
        match self {
            Policy::Strict => Game::from_source(source).ok(),
            Policy::Reference => Game::from_source_as_reference(source).ok(),
        }
    }
}

/// A claim: its text and its meaning.
#[derive(Clone, Debug)]
pub struct Claim {
    /// The text of the claim, or the name of the proof.
    pub text: String,
    /// The claim's meaning.
    pub fact: Fact,
}

/// The condition of an ending, as stated in its sentence.
#[derive(Clone, Debug, PartialEq)]
pub enum When {
    /// There are at most the given number of sprites of the given types.
    AtMost(Vec<SpriteType>, i64),
    /// There are at least the given number of sprites of the given types.
    AtLeast(Vec<SpriteType>, i64),
    /// There are exactly the given number of sprites of the given types.
    Exactly(Vec<SpriteType>, i64),
    /// The given number of ticks have been played.
    Ticks(i64),
}

/// An additional condition of an ending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Provided {
    /// No additional condition applies.
    Always,
    /// The score is not 0.
    Score,
    /// The score is 0.
    NoScore,
    /// The counters have different values.
    Difference,
    /// All counters have the same value.
    NoDifference,
    /// The first counter has the given value.
    Value(i32),
    /// The first counter does not have the given value.
    OtherValue(i32),
}

/// An exception, under which an ending does not count.
#[derive(Clone, Debug, PartialEq)]
pub struct Unless {
    /// The condition of the exception.
    pub when: When,
    /// `true` if the condition must have held in the previous tick.
    pub before: bool,
    /// `true` if the ending does not count in the first tick either.
    pub not_first: bool,
}

/// A sentence about an ending, in parsed form.
#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    /// `true` if the ending wins.
    pub win: bool,
    /// The condition that triggers the ending.
    pub when: When,
    /// The number of distinct types required among the counted sprites; `None` if any number is allowed.
    pub kinds: Option<usize>,
    /// The additional condition of the ending.
    pub provided: Provided,
    /// The exception under which the ending does not count, if any.
    pub unless: Option<Unless>,
}

/// The result if several endings hold in the same tick.
#[derive(Clone, Debug, PartialEq)]
pub enum Tie {
    /// The game is lost.
    Lost,
    /// The game is won.
    Won,
    /// The claim is missing, or cannot be parsed.
    Open,
}

/// The meaning of a claim, as far as an episode can refute it.
#[derive(Clone, Debug)]
pub enum Fact {
    /// The given endings are the only ways to win or lose before the last tick, and each of them ends the
    /// game.
    Endings(Vec<Ending>, Tie),
    /// The game is never won (`true`) or never lost (`false`), except in its first tick.
    Unattainable(bool),
    /// The level is never won (`true`) or never lost (`false`), not even in its first tick.
    OutOfReach(bool),
    /// The episode is over in its first tick, with the given outcome if one is stated.
    OverAtOnce(Option<bool>),
    /// The interaction with the given index never happens.
    Silent(usize),
    /// No sprite ever holds more than the given amount of a resource.
    HeldAtMost(SpriteType, i64),
    /// There are never any sprites of the given type.
    Absent(SpriteType),
    /// Only sprites of the given types ever exist.
    OnlyTypes(Vec<SpriteType>),
    /// A rule about the given type applies only to sprites of the listed types.
    OnlyMembers(SpriteType, Vec<SpriteType>),
    /// Sprites of the first types never meet sprites of the second types, or never meet the edge if the
    /// second types are `None`.
    NeverMeet(Vec<SpriteType>, Option<Vec<SpriteType>>),
    /// All avatars have one of the given types.
    OnlyAvatars(Vec<SpriteType>),
    /// Sprites of the given type do not move by themselves.
    Stands(SpriteType),
    /// Sprites of the given type never change their position.
    Fixed(SpriteType),
    /// There is at most one sprite of the given types, or at most as many as the level places.
    Single(Vec<SpriteType>),
    /// There are never more sprites of the given types than there were at the start.
    OnlyFalls(Vec<SpriteType>),
    /// The number of sprites of the given types never exceeds the given number.
    CountAtMost(Vec<SpriteType>, i64),
    /// The sprites that the level places in the given cells stay there.
    Permanent(Vec<(SpriteType, usize)>),
    /// The termination with the given index among the goals never holds.
    GoalNeverHolds(usize),
    /// Sprites of the given type never reach the given cell.
    NeverAt(SpriteType, usize),
    /// Between ticks, sprites of each type are only in the given cells. The list is indexed by type and cell.
    Within(Vec<Vec<bool>>),
    /// The score never exceeds the given number.
    ScoreAtMost(i64),
    /// Avatars visit at most the given number of cells on the board.
    CellsVisited(usize),
    /// Sprites of the first types never move onto sprites of the second types, or never move off the board if
    /// the second types are `None`.
    CannotEnter(Vec<SpriteType>, Option<Vec<SpriteType>>),
    /// Observations never show sprites of the given type.
    Unseen(SpriteType),
    /// No key has any effect.
    DeadKeys,
    /// The given keys have no effect.
    IdleKeys(Vec<Action>),
    /// Nothing happens unless the player acts.
    TurnBased,
    /// The seed has no effect.
    NoChance,
    /// Only avatars move by themselves.
    OthersIdle,
    /// Observations show all sprites that take part in an interaction.
    AllShown,
    /// The game plays the same without the parameter at the given position in its text.
    Ignored(usize),
    /// According to an exhaustive search, no episode wins.
    SearchedInVain,
}

impl Fact {
    /// Returns the name of the fact's kind, for use in counts.
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
            Fact::ScoreAtMost(_) => "so many points at most",
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

/// A game and a level, loaded under a policy.
pub struct Case {
    /// The game's text.
    pub source: String,
    /// The level's text.
    pub text: String,
    /// The policy for loading the game.
    pub policy: Policy,
    /// The loaded game.
    pub game: Game,
    /// The loaded level.
    pub level: Level,
    /// The game's analysis.
    pub analysis: Analysis,
    /// The sprites' reach in the level.
    pub reach: Reach,
}

impl Case {
    /// Loads a game and a level. Returns `None` if loading fails.
    pub fn load(source: &str, text: &str, policy: Policy) -> Option<Case> {
        let game = policy.load(source)?;
        let level = game.level(text).ok()?;
        let analysis = Analysis::of(&game);
        let reach = analysis.reach(&level);
        let (source, text) = (source.to_owned(), text.to_owned());
        Some(Case { source, text, policy, game, level, analysis, reach })
    }
}

/// A claim that an episode refutes, with its game.
pub struct Fault {
    /// The refuted claim.
    pub claim: Claim,
    /// The observation that contradicts the claim.
    pub found: String,
    /// The game's text.
    pub source: String,
    /// The level's text.
    pub level: String,
    /// The policy for loading the game.
    pub policy: Policy,
    /// The seed and the actions of the episode that refutes the claim.
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

/// The counts of a run.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// The number of games loaded under each policy.
    pub games: [usize; 2],
    /// The number of episodes.
    pub plays: usize,
    /// The number of ticks.
    pub ticks: usize,
    /// The number of episodes won, and the number lost.
    pub ends: [usize; 2],
    /// The number of claims by kind, each counted once per game.
    pub claims: BTreeMap<&'static str, usize>,
}

impl Tally {
    /// Adds another run's counts.
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

    /// Counts a case and its claims and episodes.
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

/// Returns those of a case's claims that its episodes refute, each claim once.
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
