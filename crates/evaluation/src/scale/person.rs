//! The abilities of persons on a scale. A person is a player whose results are measured with the scale.

use super::file::{Estimate, ScaleFile, Span};
use super::played::PersonPlays;
use serde::Serialize;
use statistics::scale::{Ability, Dimension, PlayedGame, PlayedLevel, ability};
use std::collections::BTreeMap;

/// The smallest lower bound of the correlation between both difficulties at which planners alone can place a month on
/// the scale for readers, which are players that see only prompts.
const LEAST_CORRELATION: f64 = 0.5;
/// The minimum number of anchors (unchanging players that see only prompts) that place a month on the scale for other
/// such players. A single anchor would not show how much it has in common with the other players.
const ANCHORS: u64 = 2;

/// The abilities of a person (a player placed on the scale), one per release.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PersonAbility {
    /// The name of the person (the player placed on the scale).
    pub player: String,
    /// `true` if the person is a reader, which is a player that sees only prompts.
    pub is_reader: bool,
    /// The abilities on the releases that the person (player) has played, in the order of the scale.
    pub months: Vec<MonthAbility>,
    /// The number of distinct episodes on levels missing from the scale.
    pub unknown: u64,
    /// The number of episodes excluded because of their settings, by difference from the settings of the
    /// scale. The key lists the differing settings, such as `--commit 3`.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub left_out: BTreeMap<String, u64>,
}

/// The ability of a person (a player placed on the scale), estimated from one release.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MonthAbility {
    /// The release's name.
    pub month: String,
    /// The number of wins among the distinct episodes.
    pub won: u64,
    /// The number of distinct episodes.
    pub episodes: u64,
    /// The number of games played.
    pub games: u64,
    /// The ability in logits, relative to the first release's mean difficulty.
    pub ability: Option<Span>,
    /// For the lower and the upper end of the interval, `true` if the data determine that end.
    pub is_bounded: [bool; 2],
    /// The total standard error of the ability, and its components.
    pub error: Option<ErrorParts>,
    /// The standard deviation of the effects of how well or badly single games suit the person (player).
    pub mismatch_sd: Option<f64>,
    /// The reason why the ability could not be estimated, if any.
    pub refusal: Option<Refusal>,
    /// The release's additional difficulty for readers (players that see only prompts), estimated from the anchors
    /// (unchanging readers).
    pub drift: Option<Estimate>,
}

/// A standard error and its components, which satisfy total² = sampling² + mismatch² + link².
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ErrorParts {
    /// The total standard error.
    pub total: f64,
    /// The component caused by the limited number of episodes.
    pub sampling: f64,
    /// The component caused by errors in the difficulties, and by games that suit the person better or worse
    /// than others.
    pub mismatch: f64,
    /// The component caused by the error of the release's position relative to the first release.
    pub link: f64,
}

/// The reason why no ability could be estimated.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Refusal {
    /// The release was played by fewer than two anchors (unchanging players that see only prompts). Its position on the
    /// scale therefore depends only on planners, which are not informative enough about such players.
    FewAnchors {
        /// The number of anchors (unchanging players that see only prompts) that played the release.
        anchors: u64,
        /// The lower bound of the correlation between the difficulties for planners and for readers (players that see
        /// only prompts), if known.
        correlation_low: Option<f64>,
    },
}

/// Returns the abilities of the persons (players) on each of their releases.
pub fn abilities(scale: &ScaleFile, persons: &[PersonPlays]) -> Vec<PersonAbility> {
    persons.iter().map(|person| of_person(scale, person)).collect()
}

pub(super) fn of_person(scale: &ScaleFile, person: &PersonPlays) -> PersonAbility {
    let is_reader = person.dimension == Dimension::Reader;
    let (mut months, mut unknown) = (BTreeMap::<usize, BTreeMap<usize, PlayedGame>>::new(), 0);
    let side = usize::from(is_reader);
    for (&(game, level), &(won, of)) in &person.levels {
        let Some((month, at, place)) = scale.place(game, level) else {
            unknown += of;
            continue;
        };
        let entry = &scale.months[month].games[at];
        let (difficulty, own) = entry.difficulty(place, side);
        let played = months.entry(month).or_default().entry(at).or_default();
        played.common = entry.common[side];
        played.levels.push(PlayedLevel { difficulty, own, won: won as f64, of: of as f64 });
    }
    let months = months.into_iter().map(|(month, games)| of_month(scale, is_reader, month, games)).collect();
    let left_out = person.left_out.clone();
    PersonAbility { player: person.player.label(), is_reader, months, unknown, left_out }
}

impl ScaleFile {
    /// Returns `true` if the ability of a reader (a player that sees only prompts) can be estimated on the release with
    /// the given index. The release must have been placed on the scale by enough anchors (unchanging readers), or by
    /// planners whose difficulties correlate sufficiently with those for readers.
    pub fn links_readers(&self, month: usize) -> bool {
        let is_anchored = month == 0 || self.months[month].anchors >= ANCHORS;
        is_anchored || self.correlation.is_some_and(|found| found.low >= LEAST_CORRELATION)
    }
}

fn of_month(
    scale: &ScaleFile,
    is_reader: bool,
    month: usize,
    games: BTreeMap<usize, PlayedGame>,
) -> MonthAbility {
    let entry = &scale.months[month];
    let games: Vec<PlayedGame> = games.into_values().collect();
    let sum =
        |of: fn(&PlayedLevel) -> f64| games.iter().flat_map(|game| &game.levels).map(of).sum::<f64>() as u64;
    let low = scale.correlation.map(|found| found.low);
    let refused = is_reader && !scale.links_readers(month);
    let prior = scale.mismatch_prior(is_reader);
    let found: Option<Ability> =
        (!refused).then(|| ability(&games, prior, entry.link[usize::from(is_reader)])).flatten();
    MonthAbility {
        month: entry.name.clone(),
        won: sum(|level| level.won),
        episodes: sum(|level| level.of),
        games: games.len() as u64,
        ability: found.map(|found| Span {
            value: found.value,
            low: found.interval.low,
            high: found.interval.high,
        }),
        is_bounded: found.map_or([false; 2], |found| found.is_bounded),
        error: found.map(|found| ErrorParts {
            total: found.error,
            sampling: found.sampling,
            mismatch: found.mismatch,
            link: found.link,
        }),
        mismatch_sd: found.map(|found| found.mismatch_sd),
        refusal: refused.then_some(Refusal::FewAnchors { anchors: entry.anchors, correlation_low: low }),
        drift: entry.drift,
    }
}
