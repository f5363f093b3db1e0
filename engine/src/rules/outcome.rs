//! The outcomes of an episode.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The outcome of an episode.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// The episode is not over.
    Ongoing,
    /// The player has won.
    Won,
    /// The player has lost.
    Lost,
    /// The episode is over without a winner, because there were too many messages (`spec/01` §4.9).
    Ended,
    /// The rules did something on which the reference engine crashes, or a limit was exceeded.
    Stopped(Limit),
}

/// The reason why an episode was stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Limit {
    /// There were more sprites than a state can hold.
    Sprites,
    /// One tick needed more work (effects, and examined sprites and cells) than [`MAX_WORK`](crate::limits::MAX_WORK).
    Work,
    /// A sprite was spawned of the type whose sprites were being updated, which makes the reference throw an
    /// exception.
    SpawnIntoUpdatedType,
    /// A score changed after the avatar was removed permanently, which makes the reference throw an
    /// exception.
    NoAvatar,
    /// A sprite of height 0 moved. The reference divides by the height.
    FlatSprite,
    /// A path was requested in a game without `obs=`.
    NoPaths,
    /// A rule tried to make or look up a sprite whose type is undeclared or has no class.
    NoType,
    /// An effect was executed without the sprites that it needs.
    NoSprite,
    /// A type turned into itself endlessly.
    EndlessTransform,
    /// A sprite's parameters do not fit its class. The reference throws an exception when it makes the
    /// sprite, or when it uses the parameters.
    UnfitSprite,
    /// More timers were pending than [`MAX_TIMERS`](crate::limits::MAX_TIMERS).
    Timers,
    /// Sprites held more resources than a state can hold.
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
