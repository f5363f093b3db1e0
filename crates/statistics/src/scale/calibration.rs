//! Calibration of a first release, and the addition of later months to the scale.

use super::maximise::maximise;
use super::plays::{Dimension, Examinee, GamePlays};
use super::posterior::{Functional, Model, Modes, Posterior};
use super::spreads::Spreads;
use nalgebra::DMatrix;

/// Both dimensions, in the order used for pairs of values.
const BOTH: [Dimension; 2] = [Dimension::Planner, Dimension::Reader];

/// An estimated value and its standard error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimated {
    /// The estimated value.
    pub value: f64,
    /// The value's standard error.
    pub error: f64,
}

impl Estimated {
    /// Returns the 95% confidence interval of the value.
    pub fn interval(&self) -> crate::Interval {
        let half = crate::Z95 * self.error;
        crate::Interval { low: self.value - half, high: self.value + half }
    }
}

/// The difficulties of a game's levels in one dimension, in logits above the mean difficulty of the first
/// release's levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Difficulties {
    /// The difficulty of each level, with its standard error.
    pub levels: Vec<Estimated>,
    /// The standard error that all of the game's levels share, excluding the error of the month's position on the scale
    /// ([`Month::link`]).
    pub common: f64,
}

impl Difficulties {
    /// Returns the error component that a level does not share with the game's other levels.
    pub fn own(&self, level: usize) -> f64 {
        let rest = self.levels[level].error * self.levels[level].error - self.common * self.common;
        rest.max(0.0).sqrt()
    }
}

/// The difficulties of a game's levels, and how well the episodes on the game fit the model.
#[derive(Clone, Debug, PartialEq)]
pub struct GameDifficulties {
    /// The difficulties for planners and for readers (players that see only prompts). The standard errors exclude the
    /// error of the month's position on the scale ([`Month::link`]).
    pub difficulties: [Difficulties; 2],
    /// The sum of squared residuals divided by the sum of their variances. It is about 1 if the episodes on the game
    /// fit the model, and greater if they do not.
    pub misfit: f64,
}

/// The levels of one month's release, placed on the scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Month {
    /// The release's games, in the order of the given results.
    pub games: Vec<GameDifficulties>,
    /// The difference in mean level difficulty between the month and the first release, for planners and for readers
    /// (players that see only prompts). The errors hold for arbitrary players in that dimension, not only for the
    /// calibration's players.
    pub shifts: [Estimated; 2],
    /// The shift in mean difficulty for exactly the planners in the calibration. The error holds only for these
    /// planners.
    pub planners_shift: Estimated,
    /// The error of the month's position on the scale: the standard error that the difficulties of all levels share,
    /// for planners and for readers (players that see only prompts). It is 0 for the first release.
    pub link: [f64; 2],
    /// The part of the month's difficulty for readers (players that see only prompts) that its difficulty for planners
    /// does not imply. `None` if no anchor (a reader from the calibration) played.
    pub drift: Option<Estimated>,
}

/// The result of a calibration, which places examinees (reference players that never change) and a first release on the
/// same scale.
#[derive(Clone, Debug, PartialEq)]
pub struct Calibration {
    /// The calibration's examinees, which are reference players that never change.
    pub examinees: Vec<Examinee>,
    /// The model's estimated standard deviations and slopes.
    pub spreads: Spreads,
    /// The abilities of the examinees (reference players that never change). An ability is the player's logit on an
    /// average game. The average is over the distribution from which the first release was drawn.
    pub abilities: Vec<f64>,
    /// The covariance matrix of the abilities, the two origins and the ease, in this order, stored by rows.
    pub covariance: Vec<f64>,
    /// The mean difficulties of the first release's levels for planners and for readers (players that see only
    /// prompts). These origins define the zero of the scale.
    pub origins: [f64; 2],
    /// The planners' mean logit on the first release.
    pub ease: f64,
}

impl Calibration {
    /// Calibrates a first release by estimating spreads (standard deviations), abilities and difficulties. Every
    /// examinee (a reference player that never changes) must have played at least one episode.
    ///
    /// Returns `None` if there are no episodes, if an entry is invalid, or if an examinee has no episodes. Cost: a few
    /// hundred evaluations of O(games · effects³) each.
    pub fn new(examinees: &[Examinee], games: &[GamePlays]) -> Option<(Calibration, Month)> {
        let model = checked(examinees, games, None)?;
        let spreads = spreads_of(&model, Spreads::default())?;
        Calibration::with_spreads(examinees, games, spreads)
    }

    /// Calibrates a first release with given spreads (standard deviations). Only abilities and difficulties are
    /// estimated. Returns `None` in the same cases as [`Calibration::new`], and if the estimation fails numerically.
    pub fn with_spreads(
        examinees: &[Examinee],
        games: &[GamePlays],
        spreads: Spreads,
    ) -> Option<(Calibration, Month)> {
        let model = checked(examinees, games, None)?;
        let posterior = model.expected_posterior(&spreads)?;
        let mut functionals: Vec<Functional> =
            (0..examinees.len()).map(|at| model.shared_functional(at)).collect();
        functionals.extend(BOTH.map(|dimension| model.mean_functional(&spreads, dimension)));
        functionals.push(model.planners_functional(&spreads));
        let size = functionals.len();
        let mut covariance = vec![0.0; size * size];
        for (i, one) in functionals.iter().enumerate() {
            for (j, other) in functionals.iter().enumerate().take(i + 1) {
                let (shared, games) = posterior.covariance(one, other);
                covariance[i * size + j] = shared + games;
                covariance[j * size + i] = shared + games;
            }
        }
        let values: Vec<f64> = functionals.iter().map(|one| posterior.value(one)).collect();
        let count = examinees.len();
        let calibration = Calibration {
            examinees: examinees.to_vec(),
            spreads,
            abilities: values[..count].to_vec(),
            covariance,
            origins: [values[count], values[count + 1]],
            ease: values[count + 2],
        };
        let games = calibration.difficulties(&model, &posterior);
        let nothing = Estimated { value: 0.0, error: 0.0 };
        let base =
            Month { games, shifts: [nothing; 2], planners_shift: nothing, link: [0.0; 2], drift: None };
        Some((calibration, base))
    }

    /// Returns the ability of an examinee (a reference player that never changes), relative to the mean difficulty of
    /// the first release's levels in the examinee's dimension.
    pub fn ability(&self, examinee: usize) -> Estimated {
        let side = side(self.examinees[examinee].dimension);
        let (count, at) = (self.examinees.len(), |i: usize, j: usize| self.covariance(i, j));
        let origin = count + side;
        let variance = at(examinee, examinee) + at(origin, origin) - 2.0 * at(examinee, origin);
        Estimated { value: self.abilities[examinee] - self.origins[side], error: variance.max(0.0).sqrt() }
    }

    /// Adds a release by fixed-parameter calibration. The difficulties of the new levels are estimated, while abilities
    /// and spreads (standard deviations) stay fixed.
    ///
    /// Returns `None` in the same cases as [`Calibration::new`], except that reference players without episodes are
    /// allowed.
    pub fn add(&self, games: &[GamePlays]) -> Option<Month> {
        let model = checked(&self.examinees, games, Some(&self.abilities))?;
        let posterior = model.expected_posterior(&self.spreads)?;
        let difficulties = self.difficulties(&model, &posterior);
        let count = self.examinees.len();
        let mut link = [0.0; 2];
        let shifts = BOTH.map(|dimension| {
            let side = side(dimension);
            let mean = model.mean_functional(&self.spreads, dimension);
            let (shared, own) = posterior.covariance(&mean, &mean);
            let mut moves = posterior.sensitivity(&mean, count);
            moves.extend([0.0; 3]);
            moves[count + side] = -1.0;
            let shared = shared + self.variance_of(&moves);
            link[side] = shared.max(0.0).sqrt();
            let value = posterior.value(&mean) - self.origins[side];
            Estimated { value, error: (shared + own).max(0.0).sqrt() }
        });
        let ease = model.planners_functional(&self.spreads);
        let (shared, own) = posterior.covariance(&ease, &ease);
        let mut moves = posterior.sensitivity(&ease, count);
        let planners = self.examinees.iter().filter(|one| one.dimension == Dimension::Planner).count();
        for (move_, examinee) in moves.iter_mut().zip(&self.examinees) {
            if examinee.dimension == Dimension::Planner {
                *move_ += 1.0 / planners as f64;
            }
        }
        moves.extend([0.0, 0.0, -1.0]);
        let error = (shared + own + self.variance_of(&moves)).max(0.0).sqrt();
        let planners_shift = Estimated { value: self.ease - posterior.value(&ease), error };
        let drift = model.has_readers().then(|| {
            let rest = model.shared_functional(1);
            let (shared, _) = posterior.covariance(&rest, &rest);
            let mut moves = posterior.sensitivity(&rest, count);
            moves.extend([0.0; 3]);
            let error = (shared + self.variance_of(&moves)).max(0.0).sqrt();
            Estimated { value: posterior.value(&rest), error }
        });
        Some(Month { games: difficulties, shifts, planners_shift, link, drift })
    }

    fn covariance(&self, i: usize, j: usize) -> f64 {
        self.covariance[i * (self.examinees.len() + 3) + j]
    }

    /// Returns the variance of a linear combination of the abilities, the origins and the ease.
    fn variance_of(&self, factors: &[f64]) -> f64 {
        let size = factors.len();
        let row = |i: usize| (0..size).map(|j| self.covariance(i, j) * factors[j]).sum::<f64>();
        (0..size).map(|i| factors[i] * row(i)).sum()
    }

    fn difficulties(&self, model: &Model<'_>, posterior: &Posterior) -> Vec<GameDifficulties> {
        let of_game = |game: usize| {
            let difficulties = BOTH.map(|dimension| {
                let functionals = model.game_functionals(&self.spreads, game, dimension);
                let within = posterior.within_game(game, &functionals);
                let levels = functionals.iter().enumerate().map(|(level, functional)| Estimated {
                    value: posterior.value(functional) - self.origins[side(dimension)],
                    error: within[(level, level)].max(0.0).sqrt(),
                });
                Difficulties { levels: levels.collect(), common: common(&within).sqrt() }
            });
            GameDifficulties { difficulties, misfit: model.misfit(&self.spreads, posterior, game) }
        };
        (0..model.games.len()).map(of_game).collect()
    }
}

/// Returns the mean covariance between two levels, clamped between 0 and the minimum variance of any level.
fn common(within: &DMatrix<f64>) -> f64 {
    let count = within.nrows();
    let least = (0..count).map(|at| within[(at, at)]).fold(f64::INFINITY, f64::min);
    if count < 2 {
        // If a game has only one level, all of the level's error is common.
        return if count == 1 { least.max(0.0) } else { 0.0 };
    }
    let pairs = (0..count).flat_map(|i| (0..i).map(move |j| (i, j)));
    let sum: f64 = pairs.map(|pair| within[pair]).sum();
    (sum / (count * (count - 1) / 2) as f64).clamp(0.0, least.max(0.0))
}

/// Returns a dimension's index in pairs of values.
pub(super) fn side(dimension: Dimension) -> usize {
    match dimension {
        Dimension::Planner => 0,
        Dimension::Reader => 1,
    }
}

fn checked<'a>(
    examinees: &'a [Examinee],
    games: &'a [GamePlays],
    abilities: Option<&'a [f64]>,
) -> Option<Model<'a>> {
    let is_valid = games.iter().all(|game| game.is_valid(examinees.len()) && game.levels > 0);
    let plays = |at: usize| {
        games.iter().flat_map(|game| &game.plays).any(|plays| plays.examinee == at && plays.of > 0.0)
    };
    let mut has_plays = (0..examinees.len()).map(plays);
    let is_enough = if abilities.is_some() { has_plays.any(|one| one) } else { has_plays.all(|one| one) };
    let is_enough = is_enough && !examinees.is_empty() && !games.is_empty();
    (is_valid && is_enough).then(|| Model::new(examinees, games, abilities))
}

/// Returns the spreads (standard deviations) with the maximum posterior density after integrating out all effects;
/// `None` if the density cannot be computed at `start`.
pub(super) fn spreads_of(model: &Model<'_>, start: Spreads) -> Option<Spreads> {
    let mut near: Option<Modes> = None;
    let mut density = |parameters: &[f64]| {
        let spreads = Spreads::from_parameters(parameters);
        let found = model.posterior(&spreads, near.as_ref())?;
        let (prior, mut slope) = Spreads::log_prior(parameters);
        slope.iter_mut().zip(model.slope(&spreads, &found)).for_each(|(slope, of)| *slope += of);
        let value = found.marginal + prior;
        near = Some(found.modes);
        Some((value, slope))
    };
    let found = maximise(&start.parameters(model.has_readers()), &mut density);
    found.map(|found| Spreads::from_parameters(&found))
}
