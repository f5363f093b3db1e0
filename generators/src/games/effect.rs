//! The effects of rules that the patterns use, with only the parameters that they need.

use super::draft::{Part, Value};

/// An effect of an interaction; `P` is the type of references to sprite types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Effect<P = Part> {
    /// Kills the first.
    KillSprite,
    /// Kills both.
    KillBoth,
    /// Kills all of a type.
    KillAll { stype: P },
    /// Kills the first if the second holds enough of a resource, which the second may have to pay.
    KillIfOtherHasMore { resource: P, limit: u32, subtract: bool },
    /// Kills the first unless it holds more than `limit` of a resource.
    KillIfHasLess { resource: P, limit: u32 },
    /// Moves the first back.
    StepBack,
    /// Turns the first round.
    ReverseDirection,
    /// Turns the first in a random direction.
    FlipDirection,
    /// Lets the second push the first.
    BounceForward,
    /// Lets the second carry the first.
    PullWithIt,
    /// Moves the first to an exit of the second.
    TeleportToExit,
    /// Turns the first into another type; the second may be killed.
    TransformTo { stype: P, kill_second: bool },
    /// Turns all sprites of one type into another.
    TransformToAll { stype: P, into: P },
    /// Spawns a sprite at the first if the first holds enough of a resource, which it pays.
    SpawnIfHasMore { resource: P, limit: u32, stype: P },
    /// Spawns a sprite where the second was.
    SpawnBehind { stype: P },
    /// Adds the first to the resources of the second; the first may stay on the board.
    CollectResource { stays: bool },
    /// Takes one of a resource from the first, and kills the second.
    Spend { resource: P },
    /// Takes a health point from the first every `timer` ticks.
    Wane { timer: u32 },
    /// Takes a health point from the first; losing the last one kills it, with a score of its own.
    SubtractHealthPoints { score_if_killed: i32 },
    /// Gives health points to the first, and kills the second.
    AddHealthPointsToMax { value: u32 },
}

impl<P: Copy> Effect<P> {
    /// Turns the first into another type, and spares the second.
    pub(crate) fn becomes(stype: P) -> Effect<P> {
        Effect::TransformTo { stype, kill_second: false }
    }

    /// The keyword.
    pub(crate) fn keyword(self) -> &'static str {
        match self {
            Effect::KillSprite => "killSprite",
            Effect::KillBoth => "killBoth",
            Effect::KillAll { .. } => "killAll",
            Effect::KillIfOtherHasMore { .. } => "killIfOtherHasMore",
            Effect::KillIfHasLess { .. } => "killIfHasLess",
            Effect::StepBack => "stepBack",
            Effect::ReverseDirection => "reverseDirection",
            Effect::FlipDirection => "flipDirection",
            Effect::BounceForward => "bounceForward",
            Effect::PullWithIt => "pullWithIt",
            Effect::TeleportToExit => "teleportToExit",
            Effect::TransformTo { .. } => "transformTo",
            Effect::TransformToAll { .. } => "transformToAll",
            Effect::SpawnIfHasMore { .. } => "spawnIfHasMore",
            Effect::SpawnBehind { .. } => "spawnBehind",
            Effect::CollectResource { .. } => "collectResource",
            Effect::Spend { .. } => "changeResource",
            Effect::Wane { .. } | Effect::SubtractHealthPoints { .. } => "subtractHealthPoints",
            Effect::AddHealthPointsToMax { .. } => "addHealthPointsToMax",
        }
    }

    /// Returns the same effect with its references to sprite types mapped; `None` if one of them cannot be mapped.
    pub(crate) fn map<Q>(self, mut name: impl FnMut(P) -> Option<Q>) -> Option<Effect<Q>> {
        Some(match self {
            Effect::KillSprite => Effect::KillSprite,
            Effect::KillBoth => Effect::KillBoth,
            Effect::KillAll { stype } => Effect::KillAll { stype: name(stype)? },
            Effect::KillIfOtherHasMore { resource, limit, subtract } => {
                Effect::KillIfOtherHasMore { resource: name(resource)?, limit, subtract }
            }
            Effect::KillIfHasLess { resource, limit } => {
                Effect::KillIfHasLess { resource: name(resource)?, limit }
            }
            Effect::StepBack => Effect::StepBack,
            Effect::ReverseDirection => Effect::ReverseDirection,
            Effect::FlipDirection => Effect::FlipDirection,
            Effect::BounceForward => Effect::BounceForward,
            Effect::PullWithIt => Effect::PullWithIt,
            Effect::TeleportToExit => Effect::TeleportToExit,
            Effect::TransformTo { stype, kill_second } => {
                Effect::TransformTo { stype: name(stype)?, kill_second }
            }
            Effect::TransformToAll { stype, into } => {
                Effect::TransformToAll { stype: name(stype)?, into: name(into)? }
            }
            Effect::SpawnIfHasMore { resource, limit, stype } => {
                Effect::SpawnIfHasMore { resource: name(resource)?, limit, stype: name(stype)? }
            }
            Effect::SpawnBehind { stype } => Effect::SpawnBehind { stype: name(stype)? },
            Effect::CollectResource { stays } => Effect::CollectResource { stays },
            Effect::Spend { resource } => Effect::Spend { resource: name(resource)? },
            Effect::Wane { timer } => Effect::Wane { timer },
            Effect::SubtractHealthPoints { score_if_killed } => {
                Effect::SubtractHealthPoints { score_if_killed }
            }
            Effect::AddHealthPointsToMax { value } => Effect::AddHealthPointsToMax { value },
        })
    }

    /// The sprite types that it refers to.
    pub(crate) fn names(self) -> Vec<P> {
        let mut names = Vec::new();
        self.map(|part| {
            names.push(part);
            Some(part)
        });
        names
    }
}

impl Effect {
    /// The parameters, besides the score.
    pub(crate) fn params(self) -> Vec<(&'static str, Value)> {
        let flag = |key: &'static str, on: bool| on.then_some((key, Value::Flag(true)));
        match self {
            Effect::KillAll { stype } | Effect::SpawnBehind { stype } => vec![("stype", Value::Part(stype))],
            Effect::KillIfOtherHasMore { resource, limit, subtract } => {
                let wants = [("resource", Value::Part(resource)), ("limit", Value::Count(limit))];
                wants.into_iter().chain(flag("subtract", subtract)).collect()
            }
            Effect::KillIfHasLess { resource, limit } => {
                vec![("resource", Value::Part(resource)), ("limit", Value::Count(limit))]
            }
            Effect::TransformTo { stype, kill_second } => {
                [("stype", Value::Part(stype))].into_iter().chain(flag("killSecond", kill_second)).collect()
            }
            Effect::TransformToAll { stype, into } => {
                vec![("stype", Value::Part(stype)), ("stypeTo", Value::Part(into))]
            }
            Effect::SpawnIfHasMore { resource, limit, stype } => vec![
                ("resource", Value::Part(resource)),
                ("limit", Value::Count(limit)),
                ("stype", Value::Part(stype)),
                ("spend", Value::Count(limit)),
            ],
            Effect::CollectResource { stays } => {
                stays.then_some(("killResource", Value::Flag(false))).into_iter().collect()
            }
            Effect::Spend { resource } => vec![
                ("resource", Value::Part(resource)),
                ("value", Value::Score(-1)),
                ("killResource", Value::Flag(true)),
            ],
            Effect::SubtractHealthPoints { score_if_killed } => {
                let score = ("scoreChangeIfKilled", Value::Score(score_if_killed));
                (score_if_killed != 0).then_some(score).into_iter().collect()
            }
            // The first execution waits as long as the others.
            Effect::Wane { timer } => vec![
                ("timer", Value::Count(timer)),
                ("repeating", Value::Flag(true)),
                ("nextExecution", Value::Count(0)),
            ],
            Effect::AddHealthPointsToMax { value } => {
                vec![("value", Value::Count(value)), ("killSecond", Value::Flag(true))]
            }
            _ => Vec::new(),
        }
    }
}
