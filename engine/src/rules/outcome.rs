//! The outcomes of an episode.

use serde::{Deserialize, Serialize};
use std::fmt;

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
