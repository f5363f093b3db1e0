//! Maximises a smooth function of a few parameters with the Broyden–Fletcher–Goldfarb–Shanno (BFGS) quasi-Newton
//! method (J. Nocedal and S. J. Wright, *Numerical Optimization*, 2006, chapter 6).

use nalgebra::{DMatrix, DVector};

/// The maximum number of steps. Typically, 10 to 20 are needed.
const STEPS: usize = 60;
/// The maximum change in a parameter per step.
const LONGEST: f64 = 1.0;
/// The minimum gain of a step. The search ends when the gain is smaller.
const GAIN: f64 = 1e-7;

/// Returns the position of a local maximum near `start`. `function` returns its value and its derivatives, or `None`
/// where it is undefined. Returns `None` if `function` is undefined at `start`. Cost: one call of `function` for most
/// steps, and a few calls for the others.
pub(super) fn maximise(
    start: &[f64],
    function: &mut impl FnMut(&[f64]) -> Option<(f64, Vec<f64>)>,
) -> Option<Vec<f64>> {
    let n = start.len();
    let mut value = |at: &DVector<f64>| {
        let (height, slope) = function(at.as_slice())?;
        let is_finite = height.is_finite() && slope.iter().all(|one| one.is_finite());
        is_finite.then(|| (height, DVector::from_vec(slope)))
    };
    let mut at = DVector::from_column_slice(start);
    let (mut height, mut slope) = value(&at)?;
    // The inverse of the negative Hessian.
    let mut inverse = DMatrix::identity(n, n) * 0.01;
    let mut is_fresh = true;
    for _ in 0..STEPS {
        let mut direction = &inverse * &slope;
        let longest = direction.amax();
        if longest > LONGEST {
            direction *= LONGEST / longest;
        }
        let rise = direction.dot(&slope);
        let mut length = 1.0;
        let found = loop {
            let next = &at + &direction * length;
            if let Some((there, new_slope)) = value(&next)
                && there >= height + 1e-4 * length * rise
            {
                break Some((next, there, new_slope));
            }
            length *= 0.5;
            if length < 1e-6 {
                break None;
            }
        };
        let Some((next, there, new_slope)) = found else {
            if is_fresh {
                break;
            }
            inverse = DMatrix::identity(n, n) * 0.01;
            is_fresh = true;
            continue;
        };
        let (moved, fell) = (&next - &at, &slope - &new_slope);
        let curvature = moved.dot(&fell);
        if curvature > 1e-12 {
            if is_fresh {
                inverse = DMatrix::identity(n, n) * (curvature / fell.norm_squared());
            }
            let rho = 1.0 / curvature;
            let left = DMatrix::identity(n, n) - (&moved * fell.transpose()) * rho;
            inverse = &left * &inverse * left.transpose() + (&moved * moved.transpose()) * rho;
            is_fresh = false;
        }
        let gain = there - height;
        (at, height, slope) = (next, there, new_slope);
        if gain < GAIN && slope.amax() < 1e-3 {
            break;
        }
    }
    Some(at.as_slice().to_vec())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_ridge_is_climbed() {
        // The function is an inverted Rosenbrock valley.
        let mut ridge = |x: &[f64]| {
            let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
            Some((-(a * a + 20.0 * b * b), vec![2.0 * a + 80.0 * b * x[0], -40.0 * b]))
        };
        let found = maximise(&[-1.0, 2.0], &mut ridge).unwrap();
        assert!((found[0] - 1.0).abs() < 1e-2 && (found[1] - 1.0).abs() < 2e-2, "{found:?}");
    }

    #[test]
    fn a_flat_function_has_its_maximum_anywhere() {
        assert_eq!(maximise(&[0.5], &mut |_: &[f64]| Some((1.0, vec![0.0]))), Some(vec![0.5]));
    }

    #[test]
    fn an_undefined_start_has_no_maximum() {
        assert_eq!(maximise(&[0.5], &mut |_: &[f64]| None), None);
    }
}
