//! Episode outcomes.

use serde::{Deserialize, Serialize};
use std::fmt;

/// An episode's outcome.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// The episode is not over.
    Ongoing,
    /// The player has won.
    Won,
    /// The player has lost.
    Lost,
    /// The episode is over without a winner, because the reference logged too many messages (`spec/01` §4.9).
    Ended,
    /// The rules did something that crashes the reference engine, or a limit was exceeded.
    Stopped(Limit),
}

/// The reason for stopping an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// The number of sprites exceeded the limit for a state.
    Sprites,
    /// The work in one tick (effects executed, sprites and cells examined) exceeded
    /// [`MAX_WORK`](crate::limits::MAX_WORK).
    Work,
    /// A sprite was spawned while sprites of its type were being updated, which makes the reference throw an
    /// exception.
    SpawnIntoUpdatedType,
    /// A score changed after the avatar was removed permanently, which makes the reference throw an
    /// exception.
    NoAvatar,
    /// A sprite with height 0 moved. The reference divides by the sprite's height.
    FlatSprite,
    /// A path was requested in a game without `obs=`.
    NoPaths,
    /// A rule tried to create or look up a sprite whose type is undeclared or has no class.
    NoType,
    /// An effect ran without the sprites that it needs.
    NoSprite,
    /// A type turned into itself endlessly.
    EndlessTransform,
    /// A sprite's parameters are unsuitable for its class. The reference throws an exception when it creates
    /// the sprite, or when it uses the parameters.
    UnfitSprite,
    /// The number of pending timers exceeded [`MAX_TIMERS`](crate::limits::MAX_TIMERS).
    Timers,
    /// The resources held by sprites exceeded the limit for a state.
    Resources,
}

impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Limit::Sprites => "more sprites than a state can hold",
            Limit::Work => "one tick takes more work than the limit allows",
            Limit::SpawnIntoUpdatedType => "a sprite was spawned into the type that is being updated",
            Limit::NoAvatar => "the score changed after the avatar was removed permanently",
            Limit::FlatSprite => "a sprite of height 0 moved",
            Limit::NoPaths => "a path was requested in a game without `obs=`",
            Limit::NoType => "a sprite of an unknown type, or of a type without a class, was requested",
            Limit::NoSprite => "an effect was executed without the sprites that it needs",
            Limit::EndlessTransform => "a type was transformed into itself endlessly",
            Limit::UnfitSprite => "the parameters of a sprite do not fit its class",
            Limit::Timers => "more timers than a state can hold",
            Limit::Resources => "more resources held than a state can hold",
        })
    }
}
