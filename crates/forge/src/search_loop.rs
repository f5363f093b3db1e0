//! The common parts of the searches for levels and for games. Candidates are evaluated on all threads. The best are
//! kept, and candidates that are far apart in an archive can be picked from it.

use base::Digest;
use generators::{Archive, Evaluated, Evaluation, Search};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Runs a search for a number of candidates, `batch` at a time, and evaluates the candidates on all threads.
/// `evaluation_of` derives the evaluation to report to the search from each result. Returns `false` if the search runs
/// out of proposals early.
pub(crate) fn run_search<S: Search<Candidate: Sync>, L: Send>(
    search: &mut S,
    (looks, batch): (usize, usize),
    look: impl Fn(&S::Candidate) -> L + Sync,
    mut evaluation_of: impl FnMut(&S::Candidate, L) -> Evaluation,
) -> bool {
    let mut asked = 0;
    while asked < looks {
        let candidates = search.ask(batch.min(looks - asked));
        if candidates.is_empty() {
            return false;
        }
        asked += candidates.len();
        let looks: Vec<L> = candidates.par_iter().map(&look).collect();
        let evaluated = candidates.into_iter().zip(looks).map(|(candidate, look)| {
            let evaluation = evaluation_of(&candidate, look);
            (candidate, evaluation)
        });
        search.tell(evaluated.collect());
    }
    true
}

/// The maximum number of candidates to pass to the final judges after a search.
const FINALISTS: usize = 3;

/// The best feasible candidates from a search, from best to worst.
pub(crate) struct Finalists<C> {
    best: Vec<(C, Digest, f64)>,
}

impl<C: Clone> Finalists<C> {
    pub(crate) fn new() -> Finalists<C> {
        Finalists { best: Vec::new() }
    }

    /// Adds a candidate if it is feasible and good enough, and no candidate with the same key has been added.
    pub(crate) fn note(&mut self, candidate: &C, key: Digest, evaluation: &Evaluation) {
        if !evaluation.is_feasible() || self.best.iter().any(|(_, known, _)| *known == key) {
            return;
        }
        let place = self.best.partition_point(|(.., objective)| *objective >= evaluation.objective);
        if place < FINALISTS {
            self.best.insert(place, (candidate.clone(), key, evaluation.objective));
            self.best.truncate(FINALISTS);
        }
    }

    pub(crate) fn into_candidates(self) -> impl Iterator<Item = C> {
        self.best.into_iter().map(|(candidate, ..)| candidate)
    }
}

/// An archive's elite, with its cell and the cell's bins.
type Elite<'a, C> = (usize, Vec<usize>, &'a Evaluated<C>);

/// Picks candidates from an archive, except those in `shown`, and returns them with their cells. The picked candidates
/// are spread as far apart as possible and added to `shown`. Each step picks the candidate farthest from all taken or
/// picked cells. Ties go to the better candidate, so the first pick is the best candidate if no cells are taken.
/// Candidates near a taken or picked candidate are skipped, and may be picked later.
pub(crate) fn spread<C: Clone>(
    archive: &Archive<C>,
    wanted: usize,
    taken: &[(usize, C)],
    is_near: impl Fn(&C, &C) -> bool,
    shown: &mut BTreeSet<Digest>,
    key: impl Fn(&C) -> Digest,
) -> Vec<(usize, C)> {
    let mut left: Vec<Elite<'_, C>> = archive
        .elites()
        .filter(|(_, elite)| !shown.contains(&key(&elite.candidate)))
        .map(|(cell, elite)| (cell, archive.bins(cell), elite))
        .collect();
    left.retain(|(.., elite)| !taken.iter().any(|(_, taken)| is_near(taken, &elite.candidate)));
    let taken: Vec<Vec<usize>> = taken.iter().map(|&(cell, _)| archive.bins(cell)).collect();
    let mut picked: Vec<Elite<'_, C>> = Vec::new();
    while picked.len() < wanted && !left.is_empty() {
        let apart = |bins: &[usize]| {
            let steps =
                |other: &Vec<usize>| bins.iter().zip(other).map(|(a, b)| a.abs_diff(*b)).sum::<usize>();
            taken.iter().chain(picked.iter().map(|(_, bins, _)| bins)).map(steps).min().unwrap_or(0)
        };
        let better = |(_, a, one): &Elite<'_, C>, (_, b, two): &Elite<'_, C>| {
            let objectives = one.evaluation.objective.total_cmp(&two.evaluation.objective);
            apart(a).cmp(&apart(b)).then(objectives)
        };
        let at = (0..left.len()).max_by(|&a, &b| better(&left[a], &left[b]).then(b.cmp(&a)));
        let next = left.swap_remove(at.expect("candidates are left"));
        left.retain(|(.., elite)| !is_near(&next.2.candidate, &elite.candidate));
        picked.push(next);
    }
    let candidates: Vec<(usize, C)> =
        picked.into_iter().map(|(cell, _, elite)| (cell, elite.candidate.clone())).collect();
    shown.extend(candidates.iter().map(|(_, candidate)| key(candidate)));
    candidates
}

#[cfg(test)]
mod tests {
    use super::*;
    use generators::Axis;

    #[test]
    fn picked_candidates_lie_far_apart() {
        let mut archive = Archive::new(vec![Axis::new("place", (0.0, 10.0), 10)], 0);
        for place in [0u8, 4, 5, 9] {
            let objective = if place == 5 { 0.9 } else { 0.5 };
            let measures = vec![f64::from(place)];
            archive.add(place, Evaluation { feasibility: 1.0, objective, measures });
        }
        let key = |place: &u8| Digest::of(&[*place]);
        let picked = |wanted: usize, taken: &[(usize, u8)], near: u8, shown: &mut BTreeSet<Digest>| {
            let is_near = |one: &u8, other: &u8| one.abs_diff(*other) < near;
            let picked = spread(&archive, wanted, taken, is_near, shown, key);
            picked.into_iter().map(|(_, place)| place).collect::<Vec<u8>>()
        };
        let mut shown = BTreeSet::new();
        assert_eq!(picked(2, &[], 0, &mut shown), [5, 0], "the best one first");
        assert_eq!(
            picked(1, &[(5, 5), (0, 0)], 0, &mut shown),
            [9],
            "what has been shown is not shown again"
        );
        assert_eq!(picked(9, &[(9, 9)], 1, &mut BTreeSet::new()), [0, 5, 4]);
        assert_eq!(picked(9, &[(9, 9)], 2, &mut BTreeSet::new()), [0, 5], "what is near is left");
    }
}
