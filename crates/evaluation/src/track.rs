//! Tracks. A track is a named, versioned set of prompt settings. Results on different tracks are never mixed.

use crate::prompt::{Encodings, Mode, PromptSettings, PromptStyle, Rules};
use std::fmt;

base::named_enum! {
    /// A track: a bundle of prompt settings, which determines what players learn about a game
    /// ([docs/reference/tracks.md](../../../docs/reference/tracks.md)).
    pub enum Track {
        /// The default prompts, with the rules in English and the game's own names.
        Told = "told",
        /// The rules in English, with meaningless names and characters.
        Masked = "masked",
        /// Prompts without rules. Several levels of a game are played in one conversation, which shows the visible
        /// effects of each action and ends with a question about the rules. The first level is for practice.
        Discover = "discover",
        /// The rules in English, with the board only as an image.
        Vision = "vision",
    }
}

impl Track {
    /// Returns the version of the track (bundle of prompt settings). The version is incremented whenever the track's
    /// settings or its own prompt texts change.
    pub const fn version(self) -> u32 {
        match self {
            Track::Told | Track::Masked | Track::Discover | Track::Vision => 1,
        }
    }

    /// Returns the track's prompt settings. The mode and the token budget of a conversation can be
    /// overridden, except for the mode of [`Track::Discover`].
    pub fn settings(self) -> PromptSettings {
        let told = PromptSettings::default();
        match self {
            Track::Told => told,
            Track::Masked => PromptSettings { neutral_names: true, ..told },
            Track::Discover => PromptSettings {
                style: PromptStyle::Discover,
                mode: Mode::Contextual,
                rules: Rules::None,
                neutral_names: true,
                action_meanings: false,
                history_tokens: 60_000,
                ..told
            },
            Track::Vision => PromptSettings {
                legend: false,
                position: false,
                encodings: Encodings { grid: false, grounding: false, image: true, ..Encodings::default() },
                ..told
            },
        }
    }

    /// Returns the maximum number of levels of a game that are played in one conversation, or 1 if levels are played
    /// alone.
    pub const fn series(self) -> u64 {
        match self {
            Track::Discover => 3,
            Track::Told | Track::Masked | Track::Vision => 1,
        }
    }

    /// Returns the track's name and version as written in results, such as `masked@1`.
    pub fn id(self) -> String {
        format!("{}@{}", self.name(), self.version())
    }

    /// Returns the phrase that distinguishes the track's players from those on other tracks, as written in results,
    /// such as `track=masked@1`.
    pub fn aid(self) -> String {
        format!("{AID}{}", self.id())
    }
}

/// The prefix of the phrase that states a player's track.
pub(crate) const AID: &str = "track=";

impl fmt::Display for Track {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.id())
    }
}

/// A level's position in a series of levels played in one conversation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeriesPlace {
    /// The number of earlier levels in the series.
    pub index: u64,
    /// The number of levels in the series.
    pub of: u64,
}

impl SeriesPlace {
    /// Divides `levels` levels into series of at most `most` levels, and returns the position of each level.
    /// The series are as equal in length as possible, longer series first. The position is `None` for a level
    /// played alone.
    pub(crate) fn all(levels: usize, most: u64) -> Vec<Option<SeriesPlace>> {
        let count = (levels as u64).div_ceil(most.max(1)).max(1);
        let (each, more) = (levels as u64 / count, levels as u64 % count);
        let lengths = (0..count).map(|number| each + u64::from(number < more));
        let of_series = |of: u64| (0..of).map(move |index| (of > 1).then_some(SeriesPlace { index, of }));
        lengths.flat_map(of_series).collect()
    }

    /// Returns `true` if the level is for practice, in which case it does not count in results.
    pub fn is_practice(self) -> bool {
        self.index == 0
    }

    /// Returns `true` for the last level of the series.
    pub fn is_last(self) -> bool {
        self.index + 1 == self.of
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_are_shared_out_evenly() {
        for (levels, most, expect) in [
            (1, 3, "0/1"),
            (2, 3, "0/2 1/2"),
            (3, 3, "0/3 1/3 2/3"),
            (4, 3, "0/2 1/2 0/2 1/2"),
            (5, 3, "0/3 1/3 2/3 0/2 1/2"),
            (7, 3, "0/3 1/3 2/3 0/2 1/2 0/2 1/2"),
            (3, 1, "0/1 0/1 0/1"),
            (0, 3, ""),
        ] {
            let places = SeriesPlace::all(levels, most);
            let told = places.iter().map(|place| match place {
                Some(place) => format!("{}/{}", place.index, place.of),
                None => "0/1".to_owned(),
            });
            assert_eq!(told.collect::<Vec<_>>().join(" "), expect, "{levels} levels");
        }
    }
}
