//! A grid of elites. A candidate's measures determine its cell, and the best candidate of a cell is the cell's elite.

use crate::Evaluation;
use std::collections::BTreeMap;
use std::iter::repeat;

/// A candidate with its evaluation.
#[derive(Clone, Debug, PartialEq)]
pub struct Evaluated<C> {
    /// The candidate.
    pub candidate: C,
    /// The candidate's evaluation.
    pub evaluation: Evaluation,
}

/// A measure as a grid axis: a range divided into bins of equal width.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The name of the measure in reports.
    pub name: String,
    /// The range divided into bins, as (from, to). Values outside the range belong to the first or the last bin.
    pub range: (f64, f64),
    /// The number of bins into which the axis is divided.
    pub bins: usize,
}

impl Axis {
    /// Creates an axis with at least one bin.
    pub fn new(name: &str, range: (f64, f64), bins: usize) -> Axis {
        Axis { name: name.to_owned(), range, bins: bins.max(1) }
    }

    /// Returns the number of bins, at least one.
    fn len(&self) -> usize {
        self.bins.max(1)
    }

    /// Returns the bin of a value. NaN belongs to the lowest bin.
    pub fn bin(&self, value: f64) -> usize {
        let share = (value - self.range.0) / (self.range.1 - self.range.0);
        // The cast saturates at 0 and converts NaN to 0.
        ((share * self.bins as f64) as usize).min(self.len() - 1)
    }
}

/// The outcome of adding a candidate to an archive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum AddStatus {
    /// The candidate is the first in its cell.
    New,
    /// The candidate replaced a worse candidate in its cell.
    Improved,
    /// The archive does not store the candidate.
    Rejected,
}

/// A grid of measures with the best feasible candidate in each cell (the archive in Mouret and Clune, "Illuminating
/// search spaces by mapping elites", 2015). Each cell also has a pocket of nearly feasible candidates (Khalifa et al.,
/// "Talakat: Bullet Hell Generation through Constrained Map-Elites", 2018).
///
/// Cells are numbered in row-major order, with the last axis varying fastest. All iterators use this order.
#[derive(Clone, Debug)]
pub struct Archive<C> {
    axes: Vec<Axis>,
    /// The maximum number of infeasible candidates per cell.
    pocket_size: usize,
    elites: BTreeMap<usize, Evaluated<C>>,
    /// The infeasible candidates by cell, from least to most infeasible. Among equally infeasible candidates, the most
    /// recent comes first. Pockets are never empty.
    pockets: BTreeMap<usize, Vec<Evaluated<C>>>,
}

impl<C> Archive<C> {
    /// Creates an empty archive that stores up to `pocket_size` infeasible candidates per cell. The axes are the
    /// measures of the evaluations, in the same order.
    pub fn new(axes: Vec<Axis>, pocket_size: usize) -> Archive<C> {
        Archive { axes, pocket_size, elites: BTreeMap::new(), pockets: BTreeMap::new() }
    }

    /// Adds a candidate if it is good enough. Cost: O(log cells + pocket). A feasible candidate becomes its cell's
    /// elite if its objective is higher than the current elite's. An infeasible candidate is added to the pocket. If
    /// the pocket is full, its worst candidate is evicted. Among equally infeasible candidates, the oldest is evicted,
    /// so that candidates of equal feasibility can still drift.
    pub fn add(&mut self, candidate: C, evaluation: Evaluation) -> AddStatus {
        let cell = self.cell(&evaluation.measures);
        let judged = Evaluated { candidate, evaluation };
        if !judged.evaluation.is_feasible() {
            return self.pocket_in(cell, judged);
        }
        match self.elites.get(&cell) {
            Some(elite) if judged.evaluation.objective <= elite.evaluation.objective => AddStatus::Rejected,
            known => {
                let status = if known.is_some() { AddStatus::Improved } else { AddStatus::New };
                self.elites.insert(cell, judged);
                status
            }
        }
    }

    fn pocket_in(&mut self, cell: usize, judged: Evaluated<C>) -> AddStatus {
        if self.pocket_size == 0 {
            return AddStatus::Rejected;
        }
        let pocket = self.pockets.entry(cell).or_default();
        let better = |kept: &Evaluated<C>| kept.evaluation.feasibility > judged.evaluation.feasibility;
        let place = pocket.partition_point(better);
        if place == self.pocket_size {
            return AddStatus::Rejected;
        }
        let status = if pocket.is_empty() { AddStatus::New } else { AddStatus::Improved };
        pocket.insert(place, judged);
        pocket.truncate(self.pocket_size);
        status
    }

    /// Moves a cell's elite to the pocket because a more thorough evaluation found it infeasible. The cell is then free
    /// for a new elite. Has no effect if `feasibility` is at least 1, which means feasible.
    pub fn demote(&mut self, cell: usize, feasibility: f64) {
        if feasibility < 1.0
            && let Some(mut judged) = self.elites.remove(&cell)
        {
            judged.evaluation.feasibility = feasibility;
            self.pocket_in(cell, judged);
        }
    }

    /// Returns the grid's axes.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the number of cells, including empty cells.
    pub fn cells(&self) -> usize {
        self.axes.iter().map(Axis::len).product()
    }

    /// Returns the cell for a list of measures. A missing measure counts as the lowest value, and a measure without an
    /// axis is ignored.
    pub fn cell(&self, measures: &[f64]) -> usize {
        let bins = self.axes.iter().zip(measures.iter().chain(repeat(&f64::NAN)));
        bins.fold(0, |cell, (axis, &measure)| cell * axis.len() + axis.bin(measure))
    }

    /// Returns a cell's bins, one per axis.
    pub fn bins(&self, cell: usize) -> Vec<usize> {
        let mut rest = cell;
        let mut bins: Vec<usize> = Vec::with_capacity(self.axes.len());
        for axis in self.axes.iter().rev() {
            bins.push(rest % axis.len());
            rest /= axis.len();
        }
        bins.reverse();
        bins
    }

    /// Returns the cells that differ from `cell` by one bin on one axis, in axis order.
    pub fn neighbours(&self, cell: usize) -> Vec<usize> {
        let mut stride = self.cells();
        let mut cells = Vec::with_capacity(2 * self.axes.len());
        for (axis, bin) in self.axes.iter().zip(self.bins(cell)) {
            stride /= axis.len();
            cells.extend((bin > 0).then(|| cell - stride));
            cells.extend((bin + 1 < axis.bins).then(|| cell + stride));
        }
        cells
    }

    /// Returns the best candidate in a cell.
    pub fn elite(&self, cell: usize) -> Option<&Evaluated<C>> {
        self.elites.get(&cell)
    }

    /// Returns all elites with their cells, in cell order.
    pub fn elites(&self) -> impl ExactSizeIterator<Item = (usize, &Evaluated<C>)> {
        self.elites.iter().map(|(&cell, elite)| (cell, elite))
    }

    /// Returns a cell's infeasible candidates, from least to most infeasible.
    pub fn pocket(&self, cell: usize) -> &[Evaluated<C>] {
        self.pockets.get(&cell).map_or(&[], Vec::as_slice)
    }

    /// Returns all cells that contain infeasible candidates, each with its candidates, in cell order.
    pub fn pockets(&self) -> impl ExactSizeIterator<Item = (usize, &[Evaluated<C>])> {
        self.pockets.iter().map(|(&cell, pocket)| (cell, pocket.as_slice()))
    }

    /// Returns the fraction of cells with an elite.
    pub fn coverage(&self) -> f64 {
        self.elites.len() as f64 / self.cells() as f64
    }

    /// Returns the sum of the elites' objectives. An empty cell counts as 0, the worst objective.
    pub fn qd_score(&self) -> f64 {
        // `sum` would return -0.0 for an empty archive.
        self.elites.values().fold(0.0, |sum, elite| sum + elite.evaluation.objective)
    }

    /// Returns the elite with the highest objective. Ties go to the first cell.
    pub fn best(&self) -> Option<&Evaluated<C>> {
        self.elites.values().reduce(|best, elite| {
            if elite.evaluation.objective > best.evaluation.objective { elite } else { best }
        })
    }
}
