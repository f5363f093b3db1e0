//! The maximum of a smooth function of a few parameters: the quasi-Newton method of Broyden, Fletcher, Goldfarb and Shanno with
//! central differences (J. Nocedal and S. J. Wright, *Numerical Optimization*, 2006, chapter 6).

use nalgebra::{DMatrix, DVector};

/// The distance of central differences.
const STEP: f64 = 1e-3;
/// The maximum number of steps; 10 to 20 are usual.
const STEPS: usize = 60;
/// The longest move of a parameter in one step.
const LONGEST: f64 = 1.0;
/// The gain of a step below which the search ends.
const GAIN: f64 = 1e-7;

/// Returns the place of a maximum near `start`. `value` may return NaN where it is not defined. Cost: for each step two calls for
/// each parameter, and a few for the length of the step.
pub(super) fn maximise(start: &[f64], value: &mut impl FnMut(&[f64]) -> f64) -> Vec<f64> {
    let n = start.len();
    let mut at = DVector::from_column_slice(start);
    let mut height = value(at.as_slice());
    let mut slope = gradient(&at, value);
    // The inverse of the negative matrix of second derivatives.
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
            let there = value(next.as_slice());
            if there >= height + 1e-4 * length * rise {
                break Some((next, there));
            }
            length *= 0.5;
            if length < 1e-6 {
                break None;
            }
        };
        let Some((next, there)) = found else {
            if is_fresh {
                break;
            }
            inverse = DMatrix::identity(n, n) * 0.01;
            is_fresh = true;
            continue;
        };
        let new_slope = gradient(&next, value);
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
    at.as_slice().to_vec()
}

fn gradient(at: &DVector<f64>, value: &mut impl FnMut(&[f64]) -> f64) -> DVector<f64> {
    let mut near = at.clone();
    DVector::from_fn(at.len(), |which, _| {
        near[which] = at[which] + STEP;
        let above = value(near.as_slice());
        near[which] = at[which] - STEP;
        let below = value(near.as_slice());
        near[which] = at[which];
        (above - below) / (2.0 * STEP)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_narrow_ridge_is_climbed() {
        // Rosenbrock's valley, upside down.
        let mut ridge = |x: &[f64]| {
            let (a, b) = (1.0 - x[0], x[1] - x[0] * x[0]);
            -(a * a + 20.0 * b * b)
        };
        let found = maximise(&[-1.0, 2.0], &mut ridge);
        assert!((found[0] - 1.0).abs() < 1e-2 && (found[1] - 1.0).abs() < 2e-2, "{found:?}");
    }

    #[test]
    fn a_flat_function_has_its_maximum_anywhere() {
        assert_eq!(maximise(&[0.5], &mut |_: &[f64]| 1.0), [0.5]);
    }
}
