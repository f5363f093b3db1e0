//! The paper's failure-mode metrics (`spec/06` §2.7), computed from the meaningful steps and the avatar's
//! cells.

use serde::Serialize;
use std::collections::BTreeSet;

/// An episode's failure-mode metrics. The step metrics are `None` if there were no steps. The cell metrics
/// are `None` if there was never an avatar.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Movement {
    /// The fraction of steps that were not meaningful (one minus the meaningful step ratio), between 0 and 1.
    pub bump_rate: Option<f64>,
    /// The length of the longest sequence of steps that were not meaningful.
    pub max_bumps: Option<u64>,
    /// The bump rate in the last quarter of the steps. The length of the quarter is rounded up.
    pub late_bump_rate: Option<f64>,
    /// The fraction of steps that returned to the cell where the avatar was two steps before, as in A B A.
    pub oscillation_rate: Option<f64>,
    /// The fraction of steps that left the avatar in the same cell. Under the paper's alternative definition,
    /// such a step is a bump.
    pub still_rate: Option<f64>,
    /// The number of distinct cells visited by the avatar, including its first cell.
    pub unique_cells: Option<u64>,
    /// The number of distinct cells visited, divided by the area of their bounding rectangle, between 0 and
    /// 1.
    pub coverage: Option<f64>,
    /// The distance travelled in cells: the sum of the Manhattan distances over all steps.
    pub displacement: Option<u64>,
}

impl Movement {
    /// Computes the metrics from an episode's meaningful steps and the avatar's cells. `cells` contains the
    /// avatar's column and row before the first step and after each step. Cost: O(steps log steps).
    ///
    /// ```
    /// use infinite_arcade_evaluation::metrics::Movement;
    /// let movement = Movement::of(&[true, false], &[Some((1, 1)), Some((2, 1)), Some((2, 1))]);
    /// assert_eq!((movement.bump_rate, movement.unique_cells), (Some(0.5), Some(2)));
    /// ```
    pub fn of(flags: &[bool], cells: &[Option<(i32, i32)>]) -> Movement {
        let steps = flags.len();
        let share = |count: usize, of: usize| (of > 0).then(|| count as f64 / of as f64);
        let bumps = |flags: &[bool]| share(flags.iter().filter(|flag| !**flag).count(), flags.len());
        let longest = flags.split(|flag| *flag).map(<[bool]>::len).max().unwrap_or(0);

        let known: Vec<(i32, i32)> = cells.iter().copied().flatten().collect();
        let there = !known.is_empty();
        // Only steps between two known cells are considered. A step from or to an unknown cell is neither a
        // still step nor a return.
        let moves = || cells.windows(2).filter_map(|pair| Some((pair[0]?, pair[1]?)));
        let still = moves().filter(|(from, to)| from == to).count();
        let returns = cells.windows(3).filter(|three| three[0].is_some() && three[0] == three[2]);
        let returns = returns.filter(|three| three[1].is_some() && three[1] != three[2]).count();
        let walked =
            moves().map(|(from, to)| u64::from(from.0.abs_diff(to.0)) + u64::from(from.1.abs_diff(to.1)));
        let unique = known.iter().collect::<BTreeSet<_>>().len();
        Movement {
            bump_rate: bumps(flags),
            max_bumps: (steps > 0).then_some(longest as u64),
            late_bump_rate: bumps(&flags[steps - steps.div_ceil(4)..]),
            oscillation_rate: share(returns, steps).filter(|_| there),
            still_rate: share(still, steps).filter(|_| there),
            unique_cells: there.then_some(unique as u64),
            coverage: area(&known).map(|area| unique as f64 / area),
            displacement: there.then(|| walked.sum()),
        }
    }
}

/// Returns the area of the rectangle that bounds all cells; `None` without cells.
fn area(cells: &[(i32, i32)]) -> Option<f64> {
    let side = |of: fn(&(i32, i32)) -> i32| {
        let (least, most) = (cells.iter().map(of).min()?, cells.iter().map(of).max()?);
        Some(f64::from(most.abs_diff(least)) + 1.0)
    };
    Some(side(|cell| cell.0)? * side(|cell| cell.1)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The expected values were calculated by hand for the steps right, right, bump, back, bump, bump, down
    /// and up.
    #[test]
    fn worked_by_hand() {
        let flags = [true, true, false, true, false, false, false, false];
        let cells = [(0, 0), (1, 0), (2, 0), (2, 0), (1, 0), (1, 0), (1, 0), (1, 1), (1, 0)].map(Some);
        let expect = Movement {
            bump_rate: Some(5.0 / 8.0),
            max_bumps: Some(4),
            late_bump_rate: Some(1.0),
            // Only the last step is an immediate return, because there was a pause before the step back from
            // (2, 0).
            oscillation_rate: Some(1.0 / 8.0),
            still_rate: Some(3.0 / 8.0),
            unique_cells: Some(4),
            coverage: Some(4.0 / 6.0),
            displacement: Some(5),
        };
        assert_eq!(Movement::of(&flags, &cells), expect);
    }

    /// The last quarter of five steps is rounded up to two steps.
    #[test]
    fn quarters() {
        let late = |flags: &[bool]| Movement::of(flags, &vec![None; flags.len() + 1]).late_bump_rate;
        assert_eq!(late(&[false, false, false, true, false]), Some(0.5));
        assert_eq!(late(&[false, false, false, true]), Some(0.0));
        assert_eq!(late(&[false]), Some(1.0));
    }

    #[test]
    fn oscillation_counts_every_return() {
        let cells = [0, 1, 0, 1, 0].map(|column| Some((column, 3)));
        let found = Movement::of(&[false; 4], &cells);
        assert_eq!((found.oscillation_rate, found.displacement), (Some(0.75), Some(4)));
        assert_eq!((found.unique_cells, found.coverage), (Some(2), Some(1.0)));
    }

    #[test]
    fn short_episodes_have_missing_rates() {
        assert_eq!(Movement::of(&[], &[None]), Movement::default());
        let standing = Movement::of(&[], &[Some((4, 4))]);
        assert_eq!((standing.unique_cells, standing.displacement), (Some(1), Some(0)));
        assert_eq!((standing.bump_rate, standing.oscillation_rate), (None, None));
        let nobody = Movement::of(&[true], &[None, None]);
        assert_eq!((nobody.bump_rate, nobody.still_rate, nobody.coverage), (Some(0.0), None, None));
        // The avatar dies in the last step. The steps before its death still count.
        let dies = Movement::of(&[true, true], &[Some((0, 0)), Some((0, 1)), None]);
        assert_eq!((dies.displacement, dies.still_rate), (Some(1), Some(0.0)));
    }
}
