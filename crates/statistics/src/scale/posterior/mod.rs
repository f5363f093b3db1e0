//! The mode and the curvature of the model's posterior for given standard deviations (Laplace's method).
//!
//! The effects of different games interact only through a few parameters that all games share. Therefore, each step
//! costs one Cholesky factorisation of a small matrix per game, and one of a Schur complement.
//!
//! Game effects are measured in standard deviations, so that their prior is standard normal, and the spreads are part
//! of the loadings. The model therefore stays well-defined as a spread approaches zero.

mod functional;
mod slope;

pub(super) use functional::Functional;

use super::ability::nodes;
use super::logistic::{logistic, softplus};
use super::plays::{Dimension, Examinee, GamePlays};
use super::spreads::Spreads;
use arrayvec::ArrayVec;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// The precision of the prior for an ability or a month's shift. The prior is weak, but it keeps the estimate defined
/// if all episodes are lost.
const FIXED_PRECISION: f64 = 1.0 / (5.0 * 5.0);
/// The maximum number of Newton steps. Typically, 6 are needed, or 3 when starting from a nearby mode.
const STEPS: usize = 100;
/// The step length below which the mode counts as found. Newton's method converges quadratically near the mode.
const FOUND: f64 = 1e-5;
/// The step length below which the expected values count as found. Steps to expected values converge only
/// linearly.
const FOUND_EXPECTED: f64 = 1e-6;
/// The maximum number of steps to expected values. Typically, 15 to 60 are needed.
const EXPECTED_STEPS: usize = 200;
/// The fraction of each change in the variances that a step applies. Variances depend on the means, so applying full
/// changes can cause oscillation.
const DAMPING: f64 = 0.7;
/// The number of steps after which only half of the usual fraction is applied.
const SETTLING: f64 = 50.0;
/// The maximum change in an effect per step. A limit is needed because the likelihood is flat far from its
/// maximum.
const LONGEST: f64 = 3.0;

/// The results on some games, and the parameters shared by all games.
///
/// If the abilities are unknown, they are the shared parameters. If they are known, the shared parameter is the shift
/// in difficulty for planners. If readers (players that see only prompts) played, there is a second shared parameter:
/// the additional shift for readers, beyond the one implied by the shift for planners.
pub(super) struct Model<'a> {
    pub(super) examinees: &'a [Examinee],
    pub(super) games: &'a [GamePlays],
    pub(super) abilities: Option<&'a [f64]>,
    layouts: Vec<Layout>,
    has_readers: bool,
}

/// The positions of a game's effects in its vector of effects.
struct Layout {
    size: usize,
    levels: usize,
    /// The position of the first effect for readers (players that see only prompts), which is the game's effect. The
    /// effects of the levels follow. If no readers played, these effects keep their prior distribution.
    readers: usize,
    has_readers: bool,
    /// The positions of two match effects per examinee (reference player), which state how well the game suits it: the
    /// family's effect, and the examinee's additional effect. An examinee that is the only member of its family has
    /// only the family's effect. A reader (a player that sees only prompts) has only the additional effect.
    matches: Vec<(Option<usize>, Option<usize>)>,
}

/// A sparse row of a linear predictor.
type Terms = ArrayVec<(usize, f64), 6>;

impl<'a> Model<'a> {
    pub(super) fn new(
        examinees: &'a [Examinee],
        games: &'a [GamePlays],
        abilities: Option<&'a [f64]>,
    ) -> Model<'a> {
        let layouts: Vec<Layout> = games.iter().map(|game| Layout::new(examinees, game)).collect();
        let has_readers = layouts.iter().any(|layout| layout.has_readers);
        Model { examinees, games, abilities, layouts, has_readers }
    }

    /// Returns `true` if a reader (a player that sees only prompts) played.
    pub(super) fn has_readers(&self) -> bool {
        self.has_readers
    }

    /// Returns how many effects a game has.
    pub(super) fn effects(&self, game: usize) -> usize {
        self.layouts[game].size
    }

    /// Returns the number of parameters shared by all games.
    pub(super) fn shared(&self) -> usize {
        self.abilities.map_or(self.examinees.len(), |_| 1 + usize::from(self.has_readers))
    }

    /// Returns the shared terms in the linear predictor of an examinee (reference player), and the fixed part of the
    /// predictor.
    pub(super) fn shared_terms(&self, spreads: &Spreads, examinee: usize) -> (Terms, f64) {
        let Some(abilities) = self.abilities else { return (Terms::from_iter([(examinee, 1.0)]), 0.0) };
        let shift = self.shift_terms(spreads, self.examinees[examinee].dimension);
        (shift.into_iter().map(|(at, factor)| (at, -factor)).collect(), abilities[examinee])
    }

    /// Returns the shared terms in a level's difficulty.
    fn shift_terms(&self, spreads: &Spreads, dimension: Dimension) -> Terms {
        match (self.abilities, dimension) {
            (None, _) => Terms::new(),
            (Some(_), Dimension::Planner) => Terms::from_iter([(0, 1.0)]),
            (Some(_), Dimension::Reader) if self.has_readers => {
                Terms::from_iter([(0, spreads.game_slope), (1, 1.0)])
            }
            (Some(_), Dimension::Reader) => Terms::from_iter([(0, spreads.game_slope)]),
        }
    }

    /// Returns the game's terms in a level's difficulty.
    fn difficulty_terms(&self, spreads: &Spreads, game: usize, level: usize, dimension: Dimension) -> Terms {
        let layout = &self.layouts[game];
        match dimension {
            Dimension::Planner => Terms::from_iter([(0, spreads.game), (1 + level, spreads.level)]),
            Dimension::Reader => Terms::from_iter([
                (0, spreads.game_slope * spreads.game),
                (1 + level, spreads.level_slope * spreads.level),
                (layout.readers, spreads.game_rest),
                (layout.readers + 1 + level, spreads.level_rest),
            ]),
        }
    }

    /// Returns the game's terms in the linear predictor of an examinee (reference player) on a level.
    pub(super) fn terms(&self, spreads: &Spreads, game: usize, examinee: usize, level: usize) -> Terms {
        let dimension = self.examinees[examinee].dimension;
        let mut terms = self.difficulty_terms(spreads, game, level, dimension);
        terms.iter_mut().for_each(|(_, factor)| *factor = -*factor);
        match (self.layouts[game].matches[examinee], dimension) {
            ((Some(family), Some(own)), _) => {
                terms.extend([(family, spreads.family), (own, spreads.planner)])
            }
            ((Some(only), None), _) => {
                let both = spreads.family * spreads.family + spreads.planner * spreads.planner;
                terms.push((only, both.sqrt()));
            }
            ((None, Some(own)), _) => terms.push((own, spreads.reader)),
            ((None, None), _) => {}
        }
        terms
    }

    /// Returns the mode and the curvature at the mode. `start` is a nearby mode, if one is known. Returns `None` if
    /// the mode cannot be computed.
    pub(super) fn posterior(&self, spreads: &Spreads, start: Option<&Modes>) -> Option<Posterior> {
        let rows: Vec<Vec<Row>> = (0..self.games.len()).map(|game| self.rows(spreads, game)).collect();
        let mut modes = start.cloned().unwrap_or_else(|| Modes {
            shared: DVector::zeros(self.shared()),
            games: self.layouts.iter().map(|layout| DVector::zeros(layout.size)).collect(),
        });
        let mut height = self.height(&rows, &modes, None);
        for _ in 0..STEPS {
            let step = self.curvature(&rows, &modes, None)?.step();
            let longest;
            (modes, height, longest) = self.raised(&rows, (modes, height), None, step)?;
            if longest < FOUND {
                break;
            }
        }
        let curvature = self.curvature(&rows, &modes, None)?;
        Some(Posterior::new(modes, height - curvature.half_log_determinant(), curvature, &rows, None))
    }

    /// Returns the normal distribution that is nearest to the posterior in relative entropy, for the given spreads
    /// (J. T. Ormerod and M. P. Wand, "Gaussian variational approximate inference for generalized linear mixed
    /// models", 2012).
    ///
    /// The posterior is skewed, and its modes are biased towards the middle. The means of the normal
    /// distribution avoid this bias. The shared parameters solve the marginal likelihood equation with
    /// expected probabilities. Returns `None` if the distribution cannot be computed.
    pub(super) fn expected_posterior(&self, spreads: &Spreads) -> Option<Posterior> {
        let rows: Vec<Vec<Row>> = (0..self.games.len()).map(|game| self.rows(spreads, game)).collect();
        let start = self.posterior(spreads, None)?;
        let (mut modes, marginal) = (start.modes, start.marginal);
        let mut variances = start.curvature.variances(&rows);
        for step in 1..=EXPECTED_STEPS {
            let curvature = self.curvature(&rows, &modes, Some(&variances))?;
            let height = self.height(&rows, &modes, Some(&variances));
            let longest;
            (modes, _, longest) = self.raised(&rows, (modes, height), Some(&variances), curvature.step())?;
            let found = curvature.variances(&rows);
            let pairs = || variances.iter().flatten().zip(found.iter().flatten());
            let apart = pairs().map(|(old, new)| (new - old).abs() / (1.0 + new)).fold(0.0, f64::max);
            // If the data contain almost no information, the variances are so large that the quadrature is
            // inaccurate, and the variances do not converge.
            if longest.max(apart) < FOUND_EXPECTED || step == EXPECTED_STEPS {
                return Some(Posterior::new(modes, marginal, curvature, &rows, Some(&variances)));
            }
            let damping = DAMPING / (1.0 + step as f64 / SETTLING);
            for (old, new) in variances.iter_mut().flatten().zip(found.iter().flatten()) {
                *old += damping * (new - *old);
            }
        }
        None
    }

    /// Takes a step, which is halved until it does not decrease the log density. Returns the new modes, their log
    /// density, and an upper bound on the step length. Returns `None` if even a tiny step decreases the log density.
    fn raised(
        &self,
        rows: &[Vec<Row>],
        (modes, height): (Modes, f64),
        variances: Option<&[Vec<f64>]>,
        (shared, games): (DVector<f64>, Vec<DVector<f64>>),
    ) -> Option<(Modes, f64, f64)> {
        let longest = games.iter().map(|step| step.amax()).fold(shared.amax(), f64::max);
        let mut length = if longest > LONGEST { LONGEST / longest } else { 1.0 };
        while length > 1e-8 {
            let next = Modes {
                shared: &modes.shared + &shared * length,
                games: modes.games.iter().zip(&games).map(|(at, step)| at + step * length).collect(),
            };
            // Near the mode, a sum of thousands of terms is accurate only to within this tolerance.
            let there = self.height(rows, &next, variances);
            if there >= height - 1e-10 * height.abs() {
                return Some((next, there, longest * length));
            }
            length *= 0.5;
        }
        None
    }

    fn rows(&self, spreads: &Spreads, game: usize) -> Vec<Row> {
        let plays = self.games[game].plays.iter().filter(|plays| plays.of > 0.0);
        let row = |plays: &super::Plays| {
            let (shared, offset) = self.shared_terms(spreads, plays.examinee);
            let own = self.terms(spreads, game, plays.examinee, plays.level);
            let super::Plays { examinee, level, won, of } = *plays;
            Row { examinee, level, won, of, offset, shared, own }
        };
        plays.map(row).collect()
    }

    /// Returns the logarithm of the likelihood times the prior, up to a constant. If variances of the linear
    /// predictors are given, returns its expected value instead.
    fn height(&self, rows: &[Vec<Row>], modes: &Modes, variances: Option<&[Vec<f64>]>) -> f64 {
        let mut sum = -0.5 * FIXED_PRECISION * modes.shared.norm_squared();
        for (game, (rows, own)) in rows.iter().zip(&modes.games).enumerate() {
            sum -= 0.5 * own.norm_squared();
            for (at, row) in rows.iter().enumerate() {
                let logit = row.logit(&modes.shared, own);
                let softplus = match variances {
                    None => softplus(logit),
                    Some(variances) => {
                        let sd = variances[game][at].max(0.0).sqrt();
                        nodes().map(|(z, weight)| weight * softplus(logit + sd * z)).sum()
                    }
                };
                sum += row.won * logit - row.of * softplus;
            }
        }
        sum
    }

    /// Returns the curvature at the modes. If variances of the linear predictors are given, returns the expected
    /// curvature around the modes instead. Returns `None` if a matrix is not positive definite.
    fn curvature(
        &self,
        rows: &[Vec<Row>],
        modes: &Modes,
        variances: Option<&[Vec<f64>]>,
    ) -> Option<Curvature> {
        let shared = self.shared();
        let mut schur = DMatrix::identity(shared, shared) * FIXED_PRECISION;
        let mut gradient = &modes.shared * -FIXED_PRECISION;
        let mut games = Vec::with_capacity(rows.len());
        for (game, (rows, own)) in rows.iter().zip(&modes.games).enumerate() {
            let size = own.len();
            let (mut within, mut cross) =
                (DMatrix::identity(size, size), DMatrix::<f64>::zeros(size, shared));
            let mut slope = -own;
            for (at, row) in rows.iter().enumerate() {
                let logit = row.logit(&modes.shared, own);
                let (chance, spread) = match variances {
                    None => {
                        let chance = logistic(logit);
                        (chance, chance * (1.0 - chance))
                    }
                    Some(variances) => expected(logit, variances[game][at]),
                };
                let (rest, weight) = (row.won - row.of * chance, row.of * spread);
                for &(i, a) in &row.own {
                    slope[i] += a * rest;
                    // Only the lower triangle of the matrix is read.
                    for &(j, b) in row.own.iter().filter(|(j, _)| *j <= i) {
                        within[(i, j)] += weight * a * b;
                    }
                    for &(j, b) in &row.shared {
                        cross[(i, j)] += weight * a * b;
                    }
                }
                for &(i, a) in &row.shared {
                    gradient[i] += a * rest;
                    for &(j, b) in &row.shared {
                        schur[(i, j)] += weight * a * b;
                    }
                }
            }
            let within = Cholesky::new(within)?;
            // The solution of the triangular system suffices for the Schur complement.
            let cross = within.l_dirty().solve_lower_triangular(&cross)?;
            let slope = within.l_dirty().solve_lower_triangular(&slope)?;
            schur -= cross.tr_mul(&cross);
            gradient -= cross.tr_mul(&slope);
            games.push(GameCurvature { within, cross, slope });
        }
        Some(Curvature { schur: Cholesky::new(schur)?, gradient, games })
    }
}

impl Layout {
    fn new(examinees: &[Examinee], game: &GamePlays) -> Layout {
        let mut size = 1 + game.levels;
        let played =
            |examinee: usize| game.plays.iter().any(|plays| plays.examinee == examinee && plays.of > 0.0);
        let mut matches = vec![(None, None); examinees.len()];
        let mut families: Vec<(usize, usize)> = Vec::new();
        for (at, examinee) in examinees.iter().enumerate() {
            if !played(at) {
                continue;
            }
            let mut next = || {
                size += 1;
                size - 1
            };
            if examinee.dimension == Dimension::Reader {
                matches[at] = (None, Some(next()));
                continue;
            }
            let is_kin =
                |other: &Examinee| other.dimension == Dimension::Planner && other.family == examinee.family;
            let known = families.iter().find(|(family, _)| *family == examinee.family);
            let family = known.map_or_else(&mut next, |(_, place)| *place);
            families.push((examinee.family, family));
            let is_alone = examinees.iter().filter(|other| is_kin(other)).count() == 1;
            matches[at] = (Some(family), (!is_alone).then(next));
        }
        let has_readers =
            examinees.iter().enumerate().any(|(at, one)| one.dimension == Dimension::Reader && played(at));
        Layout { size: size + 1 + game.levels, levels: game.levels, readers: size, has_readers, matches }
    }
}

/// The results of an examinee (reference player) on a level, with the terms of the linear predictor for this level.
struct Row {
    examinee: usize,
    level: usize,
    won: f64,
    of: f64,
    offset: f64,
    shared: Terms,
    own: Terms,
}

impl Row {
    fn logit(&self, shared: &DVector<f64>, own: &DVector<f64>) -> f64 {
        let shared = self.shared.iter().map(|&(at, factor)| factor * shared[at]);
        let own = self.own.iter().map(|&(at, factor)| factor * own[at]);
        self.offset + shared.sum::<f64>() + own.sum::<f64>()
    }
}

/// Returns the expected win probability and the expected variance of a result, for a normally distributed
/// logit.
fn expected(mean: f64, variance: f64) -> (f64, f64) {
    let sd = variance.max(0.0).sqrt();
    nodes().fold((0.0, 0.0), |(chances, spreads), (z, weight)| {
        let chance = logistic(mean + sd * z);
        (chances + weight * chance, spreads + weight * chance * (1.0 - chance))
    })
}

/// The values of all effects and shared parameters.
#[derive(Clone)]
pub(super) struct Modes {
    pub(super) shared: DVector<f64>,
    pub(super) games: Vec<DVector<f64>>,
}

/// The negative second derivatives in factored form, and the gradient with respect to the shared parameters. The game
/// effects have been eliminated.
struct Curvature {
    schur: Cholesky<f64, Dyn>,
    gradient: DVector<f64>,
    games: Vec<GameCurvature>,
}

struct GameCurvature {
    /// The block of second derivatives for the game's own effects, in factored form.
    within: Cholesky<f64, Dyn>,
    /// The block between the game's effects and the shared parameters, by column. This block and `slope` have already
    /// been divided by the triangle of `within`.
    cross: DMatrix<f64>,
    slope: DVector<f64>,
}

impl GameCurvature {
    /// Divides a vector of the game's effects by the transposed triangle of `within`, which completes a solution.
    fn divided(&self, mut half: DVector<f64>) -> DVector<f64> {
        self.within.l_dirty().tr_solve_lower_triangular_unchecked_mut(&mut half);
        half
    }

    /// Returns the decrease in the game's effects per unit increase in each shared parameter.
    fn gain(&self) -> DMatrix<f64> {
        let mut gain = self.cross.clone();
        self.within.l_dirty().tr_solve_lower_triangular_unchecked_mut(&mut gain);
        gain
    }
}

impl Curvature {
    /// Returns the Newton step for the shared parameters and for each game's effects.
    fn step(&self) -> (DVector<f64>, Vec<DVector<f64>>) {
        let shared = self.schur.solve(&self.gradient);
        let games = self.games.iter().map(|game| game.divided(&game.slope - &game.cross * &shared)).collect();
        (shared, games)
    }

    /// Returns the variances of the linear predictors, given the shared parameters.
    fn variances(&self, rows: &[Vec<Row>]) -> Vec<Vec<f64>> {
        let of_game = |(game, rows): (&GameCurvature, &Vec<Row>)| {
            let inverse = game.within.inverse();
            let quadratic = |row: &Row| {
                let terms = row.own.iter().flat_map(|one| row.own.iter().map(move |other| (one, other)));
                terms.map(|((i, a), (j, b))| a * b * inverse[(*i, *j)]).sum::<f64>()
            };
            rows.iter().map(quadratic).collect()
        };
        self.games.iter().zip(rows).map(of_game).collect()
    }

    /// Returns half the logarithm of the determinant of the whole matrix.
    fn half_log_determinant(&self) -> f64 {
        let of = |factor: &Cholesky<f64, Dyn>| {
            let factor = factor.l_dirty();
            (0..factor.nrows()).map(|at| libm::log(factor[(at, at)])).sum::<f64>()
        };
        self.games.iter().map(|game| of(&game.within)).sum::<f64>() + of(&self.schur)
    }
}

/// The normal distribution that approximates the posterior.
pub(super) struct Posterior {
    pub(super) modes: Modes,
    /// The logarithm of the marginal likelihood, with all effects integrated out, up to a constant.
    pub(super) marginal: f64,
    curvature: Curvature,
    /// The decrease in each game's effects per unit increase in each shared parameter.
    gains: Vec<DMatrix<f64>>,
    /// The covariance matrix of the shared parameters.
    pub(super) covariance: DMatrix<f64>,
    /// The expected weight and the terms of each row, by game. Empty if the distribution is centred on a mode.
    weights: Vec<Vec<(usize, f64, Terms, Terms)>>,
}

impl Posterior {
    fn new(
        modes: Modes,
        marginal: f64,
        curvature: Curvature,
        rows: &[Vec<Row>],
        variances: Option<&[Vec<f64>]>,
    ) -> Posterior {
        let of_game = |((rows, own), variances): ((&Vec<Row>, &DVector<f64>), &Vec<f64>)| {
            let weight = |(row, variance): (&Row, &f64)| {
                let (_, spread) = expected(row.logit(&modes.shared, own), *variance);
                (row.examinee, row.of * spread, row.shared.clone(), row.own.clone())
            };
            rows.iter().zip(variances).map(weight).collect()
        };
        let games = rows.iter().zip(&modes.games).zip(variances.unwrap_or_default());
        let weights = games.map(of_game).collect();
        let covariance = curvature.schur.inverse();
        let gains = curvature.games.iter().map(GameCurvature::gain).collect();
        Posterior { modes, marginal, curvature, gains, covariance, weights }
    }

    pub(super) fn value(&self, functional: &Functional) -> f64 {
        let games = functional.games.iter().zip(&self.modes.games).map(|(terms, own)| terms.dot(own));
        functional.constant + functional.shared.dot(&self.modes.shared) + games.sum::<f64>()
    }

    /// Returns a functional's gradient with respect to the shared parameters, including the effect of these
    /// parameters on the game effects.
    fn slope(&self, functional: &Functional) -> DVector<f64> {
        let mut slope = functional.shared.clone();
        for (gain, terms) in self.gains.iter().zip(&functional.games) {
            slope -= gain.tr_mul(terms);
        }
        slope
    }

    /// Returns the covariance between two functionals as two components. The first component comes from the shared
    /// parameters, and the second from the games, given the shared parameters.
    pub(super) fn covariance(&self, one: &Functional, other: &Functional) -> (f64, f64) {
        let (left, right) = (self.slope(one), self.slope(other));
        let shared = left.dot(&(&self.covariance * right));
        let games = self.curvature.games.iter().zip(one.games.iter().zip(&other.games));
        let within = games.filter(|(_, (left, right))| left.amax() > 0.0 && right.amax() > 0.0);
        (shared, within.map(|(game, (left, right))| left.dot(&game.within.solve(right))).sum())
    }

    /// Returns the covariance matrix of a game's functionals, given the shared parameters.
    pub(super) fn within_game(&self, game: usize, functionals: &[Functional]) -> DMatrix<f64> {
        let columns: Vec<DVector<f64>> = functionals.iter().map(|one| one.games[game].clone()).collect();
        let terms = DMatrix::from_columns(&columns);
        terms.tr_mul(&self.curvature.games[game].within.solve(&terms))
    }

    /// Returns the change in a functional per unit increase in the fixed ability of each examinee (reference player).
    pub(super) fn sensitivity(&self, functional: &Functional, examinees: usize) -> Vec<f64> {
        let shared = &self.covariance * self.slope(functional);
        let mut moves = vec![0.0; examinees];
        let games = self.curvature.games.iter().zip(&self.gains);
        for ((game, gain), (terms, rows)) in games.zip(functional.games.iter().zip(&self.weights)) {
            let own = game.within.solve(terms) - gain * &shared;
            for (examinee, weight, shared_terms, own_terms) in rows {
                let by_shared: f64 = shared_terms.iter().map(|&(at, factor)| factor * shared[at]).sum();
                let by_own: f64 = own_terms.iter().map(|&(at, factor)| factor * own[at]).sum();
                moves[*examinee] -= weight * (by_shared + by_own);
            }
        }
        moves
    }
}

impl Model<'_> {
    /// Returns the misfit of the results on a game: the sum of squared residuals divided by the sum of their
    /// variances.
    pub(super) fn misfit(&self, spreads: &Spreads, posterior: &Posterior, game: usize) -> f64 {
        let (mut squares, mut variances) = (0.0, 0.0);
        for row in self.rows(spreads, game) {
            let chance = logistic(row.logit(&posterior.modes.shared, &posterior.modes.games[game]));
            let rest = row.won - row.of * chance;
            squares += rest * rest;
            variances += row.of * chance * (1.0 - chance);
        }
        squares / variances
    }
}
