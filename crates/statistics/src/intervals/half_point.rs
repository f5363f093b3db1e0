//! Estimation of the dose at which half of the trials succeed. The trials are at several doses, on several items of
//! unequal difficulty.

use super::bootstrap::below;
use super::wilson::Interval;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// The trials on one item at one dose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DoseTrials {
    /// The dose, which must be positive.
    pub dose: f64,
    /// The number of successful trials.
    pub won: f64,
    /// The total number of trials.
    pub of: f64,
}

/// The estimated dose at which half of the trials on an average item succeed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HalfPoint {
    /// The estimated half point.
    pub dose: f64,
    /// The decrease in the logit of success per unit increase in the natural logarithm of the dose.
    pub slope: f64,
    /// The dose's confidence interval.
    pub interval: Interval,
}

/// The precision of the item effects, in logits: the reciprocal of the combined variance of games (1.3²) and levels
/// (1.0²).
const ITEM_PRECISION: f64 = 1.0 / (1.3 * 1.3 + 1.0);
/// The mean and the precision of the prior for the slope. The prior is weak, but it keeps the estimate defined if all
/// trials succeed or all trials fail.
const SLOPE: (f64, f64) = (1.0, 1.0);
/// The precision of the prior for the intercept. The mean of the prior is 0.
const INTERCEPT_PRECISION: f64 = 1.0 / (20.0 * 20.0);
/// The maximum number of Newton steps. Typically, 6 are needed.
const STEPS: usize = 60;
/// The maximum factor by which a reported dose may lie outside the range of doses tried. The data say nothing about
/// doses beyond that.
const BEYOND: f64 = 4.0;

/// Estimates the dose at which half of the trials succeed. `groups` contains the items of each group with their
/// trials. For example, a group can be a game, with its levels as the items.
///
/// The model is logit P = a + item − b ln dose with b ≥ 0.05 and normally distributed item effects. The parameters
/// are maximum a posteriori estimates. The interval comes from a hierarchical bootstrap, which draws groups with
/// replacement, and then items within each group. If the estimate is more than a factor of four below or above the
/// doses tried, that limit is reported instead.
///
/// Returns `None` if there are no trials, if a dose is not positive, or if `level` is not within 0..1. Cost:
/// O(resamples · trials).
///
/// ```
/// use infinite_arcade_statistics::{DoseTrials, half_point};
/// let item = |won: [f64; 3]| [1.0, 8.0, 64.0].into_iter().zip(won).map(|(dose, won)| DoseTrials { dose, won, of: 10.0 }).collect();
/// let groups = vec![vec![item([9.0, 5.0, 1.0])], vec![item([10.0, 6.0, 1.0]), item([9.0, 4.0, 0.0])]];
/// let found = half_point(&groups, 200, 0.95, [7; 32]).unwrap();
/// assert!((6.0..10.0).contains(&found.dose), "{found:?}");
/// ```
pub fn half_point(
    groups: &[Vec<Vec<DoseTrials>>],
    resamples: usize,
    level: f64,
    seed: [u8; 32],
) -> Option<HalfPoint> {
    let groups: Vec<&Vec<Vec<DoseTrials>>> = groups.iter().filter(|group| !group.is_empty()).collect();
    let trials = || groups.iter().copied().flatten().flatten().filter(|trials| trials.of > 0.0);
    let is_valid = trials().all(|trials| trials.dose > 0.0 && (0.0..=trials.of).contains(&trials.won));
    if trials().next().is_none() || !is_valid || !(0.0..1.0).contains(&level) {
        return None;
    }
    let least = trials().map(|trials| trials.dose).fold(f64::INFINITY, f64::min) / BEYOND;
    let most = trials().map(|trials| trials.dose).fold(0.0, f64::max) * BEYOND;
    let items: Vec<&[DoseTrials]> = groups.iter().copied().flatten().map(Vec::as_slice).collect();
    let dose = |(intercept, slope): (f64, f64)| libm::exp(intercept / slope).clamp(least, most);
    let fitted = fit(&items);
    let mut draws = ChaCha8Rng::from_seed(seed);
    let mut found: Vec<f64> = (0..resamples)
        .map(|_| {
            let mut sample = Vec::with_capacity(items.len());
            for _ in 0..groups.len() {
                let group = groups[below(&mut draws, groups.len())];
                sample.extend((0..group.len()).map(|_| group[below(&mut draws, group.len())].as_slice()));
            }
            dose(fit(&sample))
        })
        .collect();
    found.sort_by(f64::total_cmp);
    let rank = ((1.0 - level) / 2.0 * found.len().saturating_sub(1) as f64) as usize;
    let ends = found.get(rank).copied().zip(found.get(found.len().wrapping_sub(1 + rank)).copied());
    let (low, high) = ends.unwrap_or((least, most));
    Some(HalfPoint { dose: dose(fitted), slope: fitted.1, interval: Interval { low, high } })
}

/// Returns the intercept and the slope, computed by Newton's method. The item effects are eliminated one by
/// one, so that each step costs O(trials).
fn fit(items: &[&[DoseTrials]]) -> (f64, f64) {
    let (mut a, mut b) = (0.0, SLOPE.0);
    let mut effects = vec![0.0; items.len()];
    for _ in 0..STEPS {
        // The gradient and the information matrix of the two common parameters, after the elimination of the
        // item effects.
        let mut gradient = [-a * INTERCEPT_PRECISION, (SLOPE.0 - b) * SLOPE.1];
        let mut information = [INTERCEPT_PRECISION, 0.0, SLOPE.1];
        let mut parts = Vec::with_capacity(items.len());
        for (trials, effect) in items.iter().zip(&effects) {
            let (mut own, mut weight, mut cross) = (-effect * ITEM_PRECISION, ITEM_PRECISION, [0.0; 2]);
            for &DoseTrials { dose, won, of } in trials.iter() {
                let x = -libm::log(dose);
                let p = 1.0 / (1.0 + libm::exp(-(a + effect + b * x)));
                let (residual, w) = (won - of * p, of * p * (1.0 - p));
                gradient[0] += residual;
                gradient[1] += residual * x;
                information[0] += w;
                information[1] += w * x;
                information[2] += w * x * x;
                own += residual;
                weight += w;
                cross[0] += w;
                cross[1] += w * x;
            }
            parts.push((own, weight, cross));
        }
        for (own, weight, cross) in &parts {
            gradient[0] -= cross[0] * own / weight;
            gradient[1] -= cross[1] * own / weight;
            information[0] -= cross[0] * cross[0] / weight;
            information[1] -= cross[0] * cross[1] / weight;
            information[2] -= cross[1] * cross[1] / weight;
        }
        let [aa, ab, bb] = information;
        let determinant = aa * bb - ab * ab;
        let step = [
            (bb * gradient[0] - ab * gradient[1]) / determinant,
            (aa * gradient[1] - ab * gradient[0]) / determinant,
        ];
        // Long steps are shortened, because the likelihood is flat far from its maximum.
        let scale = 1.0_f64.min(2.0 / step[0].abs().max(step[1].abs()).max(1e-300));
        a += scale * step[0];
        let was = b;
        b = (b + scale * step[1]).max(0.05);
        let moved = [scale * step[0], b - was];
        for ((own, weight, cross), effect) in parts.iter().zip(&mut effects) {
            *effect += (own * scale - cross[0] * moved[0] - cross[1] * moved[1]) / weight;
        }
        if moved[0].abs().max(moved[1].abs()) < 1e-10 {
            break;
        }
    }
    (a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn trials(won: &[(f64, f64, f64)]) -> Vec<DoseTrials> {
        won.iter().map(|&(dose, won, of)| DoseTrials { dose, won, of }).collect()
    }

    fn point(groups: &[Vec<Vec<DoseTrials>>]) -> HalfPoint {
        half_point(groups, 300, 0.95, [1; 32]).unwrap()
    }

    #[test]
    fn the_half_point_is_found_among_items_of_unequal_difficulty() {
        // The items lie at −2, 0 and 2 logits around a half point of 10, with a slope of 1. Each has the number of
        // wins expected from 100 trials.
        let expected = |effect: f64| {
            let at = |dose: f64| {
                let logit = libm::log(10.0) - libm::log(dose) + effect;
                (dose, 100.0 / (1.0 + libm::exp(-logit)), 100.0)
            };
            trials(&[1.0, 3.0, 10.0, 30.0, 100.0].map(at))
        };
        let found = point(&[vec![expected(-2.0)], vec![expected(0.0)], vec![expected(2.0)]]);
        assert!((9.5..10.5).contains(&found.dose) && (0.95..1.05).contains(&found.slope), "{found:?}");
        assert!(found.interval.low < 10.0 && 10.0 < found.interval.high, "{found:?}");
    }

    #[test]
    fn nothing_is_claimed_beyond_the_doses_tried() {
        let always = trials(&[(1.0, 5.0, 5.0), (50.0, 5.0, 5.0)]);
        let found = point(&vec![vec![always]; 8]);
        assert_eq!((found.dose, found.interval.high), (200.0, 200.0));
        let never = trials(&[(1.0, 0.0, 5.0), (50.0, 0.0, 5.0)]);
        let found = point(&vec![vec![never]; 8]);
        assert_eq!((found.dose, found.interval.low), (0.25, 0.25));
    }

    #[test]
    fn more_games_narrow_the_interval() {
        let game = |shift: f64| {
            vec![trials(&[(1.0, 9.0 - shift, 10.0), (10.0, 5.0, 10.0), (100.0, 1.0 + shift, 10.0)])]
        };
        let width = |games: usize| {
            let games: Vec<_> = (0..games).map(|at| game((at % 3) as f64)).collect();
            let found = point(&games);
            libm::log(found.interval.high) - libm::log(found.interval.low)
        };
        assert!(width(24) < width(3));
    }

    #[test]
    fn malformed_trials_have_no_half_point() {
        let none = |groups: &[Vec<Vec<DoseTrials>>]| half_point(groups, 10, 0.95, [0; 32]).is_none();
        assert!(none(&[]) && none(&[vec![]]) && none(&[vec![trials(&[(0.0, 1.0, 1.0)])]]));
        assert!(none(&[vec![trials(&[(1.0, 2.0, 1.0)])]]));
    }
}
