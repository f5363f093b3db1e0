//! The file `scale.json`, which contains the examinees (reference players that never change), the spreads (the model's
//! standard deviations), and the levels of each release with their difficulties.

use crate::error::EvaluationError;
use crate::run::text::read_text;
use crate::run::{MAX_DECISIONS, Settings};
use base::Digest;
use itertools::Itertools;
use serde::{Deserialize, Serialize};
use statistics::Interval;
use statistics::scale::{
    Calibration, Correlated, Difficulties, Dimension, Estimated, Examinee, GamePlays, MismatchPrior, Month,
    Spreads,
};
use std::fmt::{self, Debug};
use std::hash::Hash;
use std::ops::RangeInclusive;
use std::path::Path;

/// The version of the scale file format.
pub const SCALE_FORMAT: u32 = 1;
/// The maximum size of the file, in bytes. A level occupies about 300 bytes, so this suffices for a hundred
/// months of 500 levels each.
const MAX_SCALE: usize = 1 << 24;

/// The maximum absolute value of a logit on a scale. At this value, a player wins (or loses) all but one in
/// 10⁴³⁴ episodes.
const MAX_LOGIT: f64 = 1000.0;
/// The maximum misfit for a game, which measures how badly its results fit the model.
const MAX_MISFIT: f64 = 1e12;
/// The minimum standard deviation in the model. Calibrations estimate the logarithms of standard deviations,
/// so 0 is not allowed.
const LEAST_SPREAD: f64 = 1e-6;
/// The maximum number of bootstrap replicates.
const MAX_REPLICATES: f64 = 10_000.0;

/// The next step in error messages about files that are not scales.
const NEXT_STEP: &str = "pass the scale.json that `arcade study calibrate` wrote";

/// A scale, with the releases placed on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScaleFile {
    /// The format version ([`SCALE_FORMAT`]).
    pub format: u32,
    /// The version of the suite that calibrated the first release.
    pub suite: String,
    /// The maximum number of actions per episode.
    pub max_steps: u64,
    /// The examinees, which are the unchanging reference players whose results place releases on the scale.
    pub examinees: Vec<ExamineeEntry>,
    /// The standard deviations and slopes in the statistical model.
    pub spreads: SpreadsEntry,
    /// The covariance matrix of three groups of parameters, stored row by row. The groups are the examinees' abilities,
    /// the origins for planners and for readers (players that see only prompts), and the planners' ease (their mean
    /// logit on the first release).
    pub covariance: Vec<f64>,
    /// The mean difficulties of the first release for planners and for readers (players that see only prompts), in the
    /// coordinates of the abilities.
    pub origins: [f64; 2],
    /// The planners' mean logit on the first release.
    pub ease: f64,
    /// The correlation between the difficulties for planners and for readers (players that see only prompts).
    pub correlation: Option<Span>,
    /// The number of parametric bootstrap replicates used to estimate the spreads (the model's standard deviations) and
    /// the correlation.
    pub replicates: u64,
    /// The releases on the scale, in chronological order.
    pub months: Vec<MonthEntry>,
}

/// An examinee (a reference player that never changes) of a scale, with its ability.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExamineeEntry {
    /// The examinee's name.
    pub name: String,
    /// The family of the examinee.
    pub family: String,
    /// `true` if the examinee is a reader, which is a player that sees only prompts.
    pub is_reader: bool,
    /// The examinee's ability in the coordinates of the model.
    pub ability: f64,
    /// The examinee's ability relative to the mean difficulty of the first release.
    pub on_scale: Estimate,
}

/// An estimate and its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Estimate {
    /// The estimated value, in logits.
    pub value: f64,
    /// The estimate's standard error.
    pub error: f64,
}

/// An estimate and its 95% interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Span {
    /// The estimated value.
    pub value: f64,
    /// The interval's lower bound.
    pub low: f64,
    /// The interval's upper bound.
    pub high: f64,
}

/// A release on the scale.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MonthEntry {
    /// The release's name.
    pub name: String,
    /// The root digest of the release, if it is a snapshot.
    pub snapshot: Option<Digest>,
    /// The text from which the seeds of the release's episodes were derived.
    pub seed: String,
    /// The mean difficulty relative to the first release, for planners and for readers (players that see only prompts).
    /// The standard errors hold for arbitrary players in the dimension, not only for the scale's players.
    pub shifts: [Estimate; 2],
    /// The shift in mean difficulty for exactly the scale's planners.
    pub planners_shift: Estimate,
    /// The standard error shared by the difficulties of all levels, for planners and for readers (players that see only
    /// prompts).
    pub link: [f64; 2],
    /// The number of anchors that played the release. Anchors are players that see only prompts and never change.
    pub anchors: u64,
    /// The release's additional difficulty for readers (players that see only prompts) compared with planners,
    /// estimated from the anchors (unchanging readers).
    pub drift: Option<Estimate>,
    /// The release's games.
    pub games: Vec<GameEntry>,
}

/// A game on the scale.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameEntry {
    /// The game's ID.
    pub id: String,
    /// The game's digest.
    pub digest: Digest,
    /// The standard errors shared by all of the game's levels, for planners and for readers (players that see only
    /// prompts).
    pub common: [f64; 2],
    /// The mean squared standardised residual over the game's episodes.
    pub misfit: f64,
    /// The game's levels.
    pub levels: Vec<LevelEntry>,
}

/// A level on the scale.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelEntry {
    /// The level number.
    pub number: usize,
    /// The level's digest.
    pub digest: Digest,
    /// The level's difficulty for planners and for readers (players that see only prompts). The standard errors exclude
    /// the error of the release's position on the scale ([`MonthEntry::link`]).
    pub difficulty: [Estimate; 2],
}

/// The standard deviations and slopes in the statistical model.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs, reason = "the fields are those of `Spreads`")]
pub struct SpreadsEntry {
    pub game: f64,
    pub level: f64,
    pub family: f64,
    pub planner: f64,
    pub game_slope: f64,
    pub level_slope: f64,
    pub game_rest: f64,
    pub level_rest: f64,
    pub reader: f64,
}

impl From<Estimated> for Estimate {
    fn from(Estimated { value, error }: Estimated) -> Estimate {
        Estimate { value, error }
    }
}

impl From<Correlated> for Span {
    fn from(Correlated { value, interval: Interval { low, high } }: Correlated) -> Span {
        Span { value, low, high }
    }
}

impl From<Spreads> for SpreadsEntry {
    fn from(found: Spreads) -> SpreadsEntry {
        let Spreads { game, level, family, planner, game_slope, level_slope, .. } = found;
        let Spreads { game_rest, level_rest, reader, .. } = found;
        SpreadsEntry { game, level, family, planner, game_slope, level_slope, game_rest, level_rest, reader }
    }
}

impl From<SpreadsEntry> for Spreads {
    fn from(found: SpreadsEntry) -> Spreads {
        let SpreadsEntry { game, level, family, planner, game_slope, level_slope, .. } = found;
        let SpreadsEntry { game_rest, level_rest, reader, .. } = found;
        Spreads { game, level, family, planner, game_slope, level_slope, game_rest, level_rest, reader }
    }
}

impl ScaleFile {
    /// Creates a scale from a calibration, without any releases. `names` contains the name and family of each examinee
    /// (a reference player that never changes).
    pub fn new(found: &Calibration, names: &[(String, String)], max_steps: u64) -> ScaleFile {
        let entry = |(at, (name, family)): (usize, &(String, String))| ExamineeEntry {
            name: name.clone(),
            family: family.clone(),
            is_reader: found.examinees[at].dimension == Dimension::Reader,
            ability: found.abilities[at],
            on_scale: found.ability(at).into(),
        };
        ScaleFile {
            format: SCALE_FORMAT,
            suite: env!("CARGO_PKG_VERSION").to_owned(),
            max_steps,
            examinees: names.iter().enumerate().map(entry).collect(),
            spreads: found.spreads.into(),
            covariance: found.covariance.clone(),
            origins: found.origins,
            ease: found.ease,
            correlation: None,
            replicates: 0,
            months: Vec::new(),
        }
    }

    /// Reads a scale file.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, has a newer format, or is not a scale.
    pub fn read(path: &Path) -> Result<ScaleFile, EvaluationError> {
        let text = read_text(path, MAX_SCALE, NEXT_STEP)?;
        let wrong = |what: String| EvaluationError::malformed(path, what);
        let format = serde_json::from_str::<Version>(&text).ok().and_then(|version| version.format);
        if let Some(format) = format.filter(|&format| format > u64::from(SCALE_FORMAT)) {
            return Err(wrong(format!(
                "the scale has format {format}, but this version of arcade reads formats up to \
                 {SCALE_FORMAT}: update arcade"
            )));
        }
        let scale: ScaleFile = serde_json::from_str(&text)
            .map_err(|error| wrong(format!("not a scale: {error}; {NEXT_STEP}")))?;
        match scale.check() {
            Err(what) => Err(wrong(format!("the scale is damaged, because {what}: calibrate again"))),
            Ok(()) => Ok(scale),
        }
    }

    /// Checks for values that no calibration produces, and returns an error with the key of the first such
    /// value. Without the check, some of these values could exhaust memory in plots and integrals, and others
    /// would make results undefined.
    fn check(&self) -> Result<(), String> {
        within(format_args!("max_steps"), self.max_steps as f64, 1.0..=MAX_DECISIONS as f64)?;
        within(format_args!("replicates"), self.replicates as f64, 0.0..=MAX_REPLICATES)?;
        let SpreadsEntry { game, level, family, planner, game_slope, level_slope, .. } = self.spreads;
        let SpreadsEntry { game_rest, level_rest, reader, .. } = self.spreads;
        for (key, sd) in [
            ("game", game),
            ("level", level),
            ("family", family),
            ("planner", planner),
            ("game_rest", game_rest),
            ("level_rest", level_rest),
            ("reader", reader),
        ] {
            within(format_args!("spreads.{key}"), sd, LEAST_SPREAD..=MAX_LOGIT)?;
        }
        logit(format_args!("spreads.game_slope"), game_slope)?;
        logit(format_args!("spreads.level_slope"), level_slope)?;
        for (at, &origin) in self.origins.iter().enumerate() {
            logit(format_args!("origins[{at}]"), origin)?;
        }
        logit(format_args!("ease"), self.ease)?;
        self.check_covariance()?;
        if let Some(Span { value, low, high }) = self.correlation {
            for (key, number) in [("value", value), ("low", low), ("high", high)] {
                within(format_args!("correlation.{key}"), number, -1.0..=1.0)?;
            }
        }
        for (at, one) in self.examinees.iter().enumerate() {
            logit(format_args!("examinees[{at}].ability"), one.ability)?;
            estimate(format_args!("examinees[{at}].on_scale"), &one.on_scale)?;
        }
        once("examinees", self.examinees.iter().map(|one| &one.name))?;
        if self.months.is_empty() {
            return Err("`months` is empty".to_owned());
        }
        once("months", self.months.iter().map(|month| &month.name))?;
        for (at, month) in self.months.iter().enumerate() {
            month.check(at, self.examinees.len())?;
        }
        Ok(())
    }

    /// Checks that the covariance matrix is symmetric, and that no covariance exceeds the bound implied by
    /// the variances.
    fn check_covariance(&self) -> Result<(), String> {
        let size = self.examinees.len() + 3;
        let found = self.covariance.len();
        if found != size * size {
            return Err(format!("`covariance` has {found} numbers, not {}", size * size));
        }
        let at = |row: usize, column: usize| self.covariance[row * size + column];
        for row in 0..size {
            let place = row * size + row;
            within(format_args!("covariance[{place}]"), at(row, row), 0.0..=MAX_LOGIT * MAX_LOGIT)?;
            for column in 0..row {
                let (one, other, most) =
                    (at(row, column), at(column, row), at(row, row) * at(column, column));
                if one != other || one * one > most * (1.0 + 1e-6) + 1e-12 {
                    let place = row * size + column;
                    return Err(format!(
                        "`covariance[{place}]` is {one}, which is asymmetric or too large for the variances"
                    ));
                }
            }
        }
        Ok(())
    }

    /// Returns the scale as file content.
    pub fn to_text(&self) -> String {
        serde_json::to_string_pretty(self).expect("a scale is plain data") + "\n"
    }

    /// Returns the calibration from which the scale was created.
    pub fn calibration(&self) -> Calibration {
        let mut families: Vec<&str> = self.examinees.iter().map(|one| one.family.as_str()).collect();
        families.sort_unstable();
        families.dedup();
        let examinee = |one: &ExamineeEntry| Examinee {
            dimension: if one.is_reader { Dimension::Reader } else { Dimension::Planner },
            family: families.binary_search(&one.family.as_str()).expect("the family is in the list"),
        };
        Calibration {
            examinees: self.examinees.iter().map(examinee).collect(),
            spreads: self.spreads.into(),
            abilities: self.examinees.iter().map(|one| one.ability).collect(),
            covariance: self.covariance.clone(),
            origins: self.origins,
            ease: self.ease,
        }
    }

    /// Adds a release that was played with the given settings. `plays` contains the results used in its
    /// calibration.
    pub fn add(&mut self, name: &str, settings: &Settings, month: &Month, plays: &[GamePlays]) {
        let played = |at: usize| {
            plays.iter().flat_map(|game| &game.plays).any(|plays| plays.examinee == at && plays.of > 0.0)
        };
        let readers = (0..self.examinees.len()).filter(|&at| self.examinees[at].is_reader && played(at));
        let anchors = readers.count() as u64;
        let games = settings.games.iter().zip(&month.games).map(|(entry, found)| GameEntry {
            id: entry.id.clone(),
            digest: entry.digest,
            common: [found.difficulties[0].common, found.difficulties[1].common],
            misfit: found.misfit,
            levels: entry
                .levels
                .iter()
                .enumerate()
                .map(|(at, level)| LevelEntry {
                    number: level.number,
                    digest: level.digest,
                    difficulty: [0, 1].map(|side| found.difficulties[side].levels[at].into()),
                })
                .collect(),
        });
        self.months.push(MonthEntry {
            name: name.to_owned(),
            snapshot: settings.snapshot,
            seed: settings.seed.clone(),
            shifts: month.shifts.map(Estimate::from),
            planners_shift: month.planners_shift.into(),
            link: month.link,
            anchors,
            drift: month.drift.map(Estimate::from),
            games: games.collect(),
        });
    }

    /// Returns the prior for the standard deviation of a player's mismatches with games.
    pub fn mismatch_prior(&self, is_reader: bool) -> MismatchPrior {
        let SpreadsEntry { family, planner, reader, .. } = self.spreads;
        let median = if is_reader { reader } else { (family * family + planner * planner).sqrt() };
        MismatchPrior { median, ..MismatchPrior::default() }
    }

    /// Returns the indices of a level's release, of its game and of the level itself, if the level is on the
    /// scale.
    pub fn place(&self, game: Digest, level: Digest) -> Option<(usize, usize, usize)> {
        let months = self.months.iter().enumerate();
        let mut games = months
            .flat_map(|(month, of)| of.games.iter().enumerate().map(move |(at, game)| (month, at, game)));
        games.find_map(|(month, at, entry)| {
            let found = (entry.digest == game).then_some(&entry.levels)?;
            found.iter().position(|known| known.digest == level).map(|level| (month, at, level))
        })
    }
}

/// The part of a scale file that is read first, in order to detect newer formats.
#[derive(Deserialize)]
struct Version {
    format: Option<u64>,
}

fn within(key: fmt::Arguments<'_>, value: f64, range: RangeInclusive<f64>) -> Result<(), String> {
    match range.contains(&value) {
        true => Ok(()),
        false => Err(format!("`{key}` is {value}, not between {} and {}", range.start(), range.end())),
    }
}

fn logit(key: fmt::Arguments<'_>, value: f64) -> Result<(), String> {
    within(key, value, -MAX_LOGIT..=MAX_LOGIT)
}

fn estimate(key: fmt::Arguments<'_>, one: &Estimate) -> Result<(), String> {
    logit(format_args!("{key}.value"), one.value)?;
    within(format_args!("{key}.error"), one.error, 0.0..=MAX_LOGIT)
}

fn once<T: Eq + Hash + Debug>(key: &str, names: impl Iterator<Item = T>) -> Result<(), String> {
    match names.duplicates().next() {
        Some(twice) => Err(format!("`{key}` contains {twice:?} twice")),
        None => Ok(()),
    }
}

impl MonthEntry {
    /// Checks a month's values, in the same way as [`ScaleFile::check`]. `at` is the month's index.
    fn check(&self, at: usize, examinees: usize) -> Result<(), String> {
        for (side, shift) in self.shifts.iter().enumerate() {
            estimate(format_args!("months[{at}].shifts[{side}]"), shift)?;
        }
        estimate(format_args!("months[{at}].planners_shift"), &self.planners_shift)?;
        if let Some(drift) = &self.drift {
            estimate(format_args!("months[{at}].drift"), drift)?;
        }
        for (side, &link) in self.link.iter().enumerate() {
            within(format_args!("months[{at}].link[{side}]"), link, 0.0..=MAX_LOGIT)?;
        }
        within(format_args!("months[{at}].anchors"), self.anchors as f64, 0.0..=examinees as f64)?;
        once(&format!("months[{at}].games"), self.games.iter().map(|game| &game.id))?;
        for (number, game) in self.games.iter().enumerate() {
            let key = format!("months[{at}].games[{number}]");
            for (side, &common) in game.common.iter().enumerate() {
                within(format_args!("{key}.common[{side}]"), common, 0.0..=MAX_LOGIT)?;
            }
            within(format_args!("{key}.misfit"), game.misfit, 0.0..=MAX_MISFIT)?;
            once(&format!("{key}.levels"), game.levels.iter().map(|level| level.number))?;
            for (place, level) in game.levels.iter().enumerate() {
                for (side, difficulty) in level.difficulty.iter().enumerate() {
                    estimate(format_args!("{key}.levels[{place}].difficulty[{side}]"), difficulty)?;
                }
            }
        }
        Ok(())
    }
}

impl GameEntry {
    /// Returns a level's difficulty in a dimension, with the error component that it does not share with the
    /// game's other levels.
    pub(super) fn difficulty(&self, level: usize, side: usize) -> (f64, f64) {
        let levels = self.levels.iter().map(|one| {
            let Estimate { value, error } = one.difficulty[side];
            Estimated { value, error }
        });
        let known = Difficulties { levels: levels.collect(), common: self.common[side] };
        (known.levels[level].value, known.own(level))
    }
}
