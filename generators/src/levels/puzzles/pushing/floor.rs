//! Floor plans for puzzles. They are drawn, varied, and rated by the distance between a solution and the position
//! farthest from it.

use super::floor_plan::{Cells, FloorPlan, Position, Pushing, bit, each};
use super::rules::{KINDS, Rules};
use crate::levels::grid::{Grid, WAYS};
use crate::levels::vary::edits::pick;
use crate::{Evaluation, Variation};
use base::{Sampler, Seed};

/// The maximum number of positions to examine when rating a floor plan.
pub(crate) const MAX_POSITIONS: usize = 100_000;
/// The maximum distance in cells between a target and the nearest other target.
const GROUP: usize = 2;
/// The number of pushes that is rated 1.0.
const PERFECT: f64 = 120.0;
/// The maximum number of sills, which are cells that the avatar can enter and objects cannot.
const MAX_SILLS: usize = 5;
/// The number of attempts at a change before a floor plan is returned unchanged.
const REDRAWS: usize = 40;

/// A generator of floor plans with a fixed size and for fixed numbers of objects.
pub(crate) struct FloorPlans<'a> {
    pub(crate) rules: &'a Rules,
    pub(crate) grid: Grid,
    pub(crate) counts: [usize; KINDS],
    /// The maximum number of positions to examine when rating a floor plan.
    pub(crate) most_positions: usize,
    /// `true` if floor plans have sills (cells that objects cannot enter), provided that the game declares such a type.
    pub(crate) sills: bool,
}

impl FloorPlans<'_> {
    fn inner(&self) -> Vec<usize> {
        (0..self.grid.len()).filter(|&cell| !self.grid.on_border(cell)).collect()
    }

    /// Returns the number of targets of the given kind.
    fn destinations(&self, kind: usize) -> usize {
        let has_targets = self.rules.targets.get(kind).is_some_and(Option::is_some);
        if has_targets { self.counts[kind] } else { 0 }
    }

    /// Returns the minimum number of open cells. It leaves enough room for all objects, and prevents floor plans that
    /// are only a closet in a block of walls.
    fn least(&self) -> usize {
        let things: usize = self.counts.iter().sum();
        let share = (self.grid.columns - 2) * (self.grid.rows - 2) * 2 / 5;
        (3 * things + 5).max(share.min(self.most()))
    }

    /// Returns the maximum number of open cells to start with. If objects may meet anywhere, a larger area has too many
    /// positions.
    fn most(&self) -> usize {
        if self.rules.in_pairs() { 22 } else { usize::MAX }
    }

    /// Draws connected rooms and corridors, with targets in a group.
    fn draw(&self, sampler: &mut Sampler) -> Option<FloorPlan> {
        let (columns, rows) = (self.grid.columns - 2, self.grid.rows - 2);
        let mut open: Cells = 0;
        let wanted = (columns * rows * sampler.between(52, 72) / 100).min(self.most());
        for _ in 0..60 {
            if open.count_ones() as usize >= wanted {
                break;
            }
            // Corridors are one cell wide, and rooms are two or three cells wide.
            let (long, wide) = if sampler.ratio(1, 2) { (5, 1) } else { (4, 3) };
            let (long, wide) = (sampler.between(2, long), sampler.between(wide.min(2), wide));
            let (width, height) = if sampler.ratio(1, 2) { (long, wide) } else { (wide, long) };
            let (width, height) = (width.min(columns), height.min(rows));
            let left = sampler.between(1, columns - width + 1);
            let top = sampler.between(1, rows - height + 1);
            let mut piece: Cells = 0;
            for y in top..top + height {
                (left..left + width).for_each(|x| piece |= bit(self.grid.at(x, y)));
            }
            let touches = each(piece).any(|cell| self.grid.beside(cell).any(|next| open & bit(next) != 0));
            if open == 0 || touches || piece & open != 0 {
                open |= piece;
            }
        }
        let wall = self.wall_of(open);
        let mut floor_plan =
            FloorPlan { grid: self.grid, wall, targets: [0; KINDS], sills: 0, counts: self.counts };
        for kind in 0..KINDS {
            for _ in 0..self.destinations(kind) {
                let free = each(open & !floor_plan.all_targets());
                let cells: Vec<usize> = free.filter(|&cell| self.joins(&floor_plan, cell)).collect();
                floor_plan.targets[kind] |= bit(pick(&cells, sampler)?);
            }
        }
        self.is_fair(&floor_plan).then_some(floor_plan)
    }

    fn wall_of(&self, open: Cells) -> Cells {
        (0..self.grid.len()).filter(|&cell| open & bit(cell) == 0).map(bit).sum()
    }

    /// Returns `true` if a target in the cell would be part of the group of targets.
    fn joins(&self, floor_plan: &FloorPlan, cell: usize) -> bool {
        floor_plan.all_targets() == 0
            || each(floor_plan.all_targets()).any(|other| self.grid.manhattan(cell, other) <= GROUP)
    }

    /// Returns `true` if the floor is connected and has enough room.
    fn is_fair(&self, floor_plan: &FloorPlan) -> bool {
        let pushing = Pushing { floor_plan, rules: self.rules };
        let open = pushing.stands(&Position::default());
        let first = open & open.wrapping_neg();
        let grouped = each(floor_plan.all_targets()).all(|cell| {
            let targets = floor_plan.targets.map(|targets| targets & !bit(cell));
            let others = FloorPlan { targets, ..floor_plan.clone() };
            self.joins(&others, cell)
        });
        open.count_ones() as usize >= self.least()
            && floor_plan.all_targets() & (floor_plan.wall | floor_plan.sills) == 0
            && floor_plan.targets[0] & floor_plan.targets[1] == 0
            && floor_plan.sills & floor_plan.wall == 0
            && (0..KINDS)
                .all(|kind| floor_plan.targets[kind].count_ones() as usize == self.destinations(kind))
            && grouped
            && pushing.flood(first, open) == open
    }

    /// Applies a small change: removes, adds or moves a wall, moves one or all targets, or adds or removes a sill (a
    /// cell that objects cannot enter).
    fn change(&self, floor_plan: &FloorPlan, sampler: &mut Sampler) -> Option<FloorPlan> {
        let mut next = floor_plan.clone();
        let inner = self.inner();
        let wall = |floor_plan: &FloorPlan, cell: usize| floor_plan.wall & bit(cell) != 0;
        // The cells along the boundary between walls and floor.
        let edge = |floor_plan: &FloorPlan, walls: bool| -> Vec<usize> {
            let meets = |&cell: &usize| {
                wall(floor_plan, cell) == walls
                    && (floor_plan.all_targets() | floor_plan.sills) & bit(cell) == 0
                    && self.grid.beside(cell).any(|next| wall(floor_plan, next) != walls)
            };
            inner.iter().copied().filter(meets).collect()
        };
        let has_sills = self.sills && self.rules.sill.is_some();
        let weights = [3, 3, 4, 3, 1, 2];
        let kind =
            if self.rules.kinds.len() > 1 && !self.rules.in_pairs() { sampler.below(KINDS) } else { 0 };
        match sampler.weighted(&weights[..weights.len() - usize::from(!has_sills)])? {
            0 => next.wall ^= bit(pick(&edge(floor_plan, true), sampler)?),
            1 => next.wall ^= bit(pick(&edge(floor_plan, false), sampler)?),
            2 => {
                next.wall ^= bit(pick(&edge(floor_plan, true), sampler)?);
                next.wall ^= bit(pick(&edge(floor_plan, false), sampler)?);
            }
            3 => {
                let targets: Vec<usize> = each(floor_plan.targets[kind]).collect();
                next.targets[kind] &= !bit(pick(&targets, sampler)?);
                let free = |&cell: &usize| {
                    !wall(floor_plan, cell) && (floor_plan.all_targets() | floor_plan.sills) & bit(cell) == 0
                };
                let cells: Vec<usize> = inner.iter().copied().filter(free).collect();
                next.targets[kind] |= bit(pick(&cells, sampler)?);
            }
            4 => {
                let way = *sampler.choose(&WAYS);
                for kind in 0..KINDS {
                    next.targets[kind] = 0;
                    for target in each(floor_plan.targets[kind]) {
                        next.targets[kind] |= bit(self.grid.shift(target, way)?);
                    }
                }
            }
            _ => {
                let free =
                    |&cell: &usize| !wall(floor_plan, cell) && floor_plan.all_targets() & bit(cell) == 0;
                let cells: Vec<usize> = inner.iter().copied().filter(free).collect();
                next.sills ^= bit(pick(&cells, sampler)?);
                if next.sills.count_ones() as usize > MAX_SILLS {
                    return None;
                }
            }
        }
        self.is_fair(&next).then_some(next)
    }

    /// Returns the number of pushes needed to solve a floor plan's farthest position.
    pub(crate) fn depth(&self, floor_plan: &FloorPlan) -> usize {
        let pushing = Pushing { floor_plan, rules: self.rules };
        let searched = pushing.by_pushes(self.most_positions);
        let starts = searched.iter().filter(|(position, _)| pushing.is_start(position));
        starts.map(|(_, pushes)| pushes).max().unwrap_or(0)
    }

    /// Returns the number of positions examined for a floor plan's depth.
    pub(crate) fn positions(&self, floor_plan: &FloorPlan) -> usize {
        Pushing { floor_plan, rules: self.rules }.by_pushes(self.most_positions).len()
    }

    /// Rates a floor plan by the number of pushes needed to solve its farthest position, with a penalty for halls and
    /// isolated wall blocks.
    pub(crate) fn rate(&self, floor_plan: &FloorPlan) -> Evaluation {
        let depth = self.depth(floor_plan);
        let objective = (depth as f64 - self.tidiness_penalty(floor_plan)).max(0.0) / PERFECT;
        Evaluation {
            feasibility: if depth > 0 { 1.0 } else { 0.5 },
            objective: objective.min(1.0),
            measures: Vec::new(),
        }
    }

    /// Returns `true` if a rating corresponds to at least `pushes` pushes after penalties.
    pub(crate) fn is_at_least(&self, rated: &Evaluation, pushes: usize) -> bool {
        rated.is_feasible() && rated.objective >= (pushes as f64 / PERFECT).min(1.0)
    }

    /// Returns the penalty for halls and isolated wall blocks, measured in pushes.
    fn tidiness_penalty(&self, floor_plan: &FloorPlan) -> f64 {
        let is_wall = |cell: Option<usize>| cell.is_none_or(|cell| floor_plan.wall & bit(cell) != 0);
        let inner = self.inner();
        let halls = inner.iter().filter(|&&cell| {
            !is_wall(Some(cell)) && self.grid.around(cell).into_iter().all(|next| !is_wall(next))
        });
        let crumbs = inner
            .iter()
            .filter(|&&cell| is_wall(Some(cell)) && self.grid.beside(cell).all(|next| !is_wall(Some(next))));
        1.5 * halls.count() as f64 + crumbs.count() as f64
    }

    /// Turns floor that is not needed for any solution into walls, and removes isolated walls, as long as the farthest
    /// position does not come closer to a solution.
    pub(crate) fn tidy(&self, floor_plan: &FloorPlan) -> FloorPlan {
        let mut best = floor_plan.clone();
        let mut depth = self.depth(&best);
        for cell in self.inner() {
            let beside = self.grid.beside(cell).filter(|&next| best.wall & bit(next) != 0).count();
            let is_wall = best.wall & bit(cell) != 0;
            let is_sill = best.sills & bit(cell) != 0;
            let idle = if is_wall { beside == 0 } else { beside >= 2 && best.all_targets() & bit(cell) == 0 };
            if !idle && !is_sill {
                continue;
            }
            let next = match is_sill {
                true => FloorPlan { sills: best.sills ^ bit(cell), ..best.clone() },
                false => FloorPlan { wall: best.wall ^ bit(cell), ..best.clone() },
            };
            if self.is_fair(&next) {
                let found = self.depth(&next);
                if found >= depth {
                    (best, depth) = (next, found);
                }
            }
        }
        best
    }

    /// Returns the number of objects of each kind. If objects are pushed onto each other in pairs, the numbers are
    /// equal.
    pub(crate) fn counts_of(rules: &Rules, things: usize) -> [usize; KINDS] {
        match rules.kinds.len() {
            1 => [things, 0],
            _ if rules.in_pairs() => [(things / 2).max(1); KINDS],
            _ => [things.div_ceil(2).max(1), (things / 2).max(1)],
        }
    }
}

impl Variation for FloorPlans<'_> {
    type Candidate = FloorPlan;

    fn create(&self, seed: Seed) -> Option<FloorPlan> {
        (0..20).find_map(|draw| self.draw(&mut seed.child("floor", draw).sampler()))
    }

    fn mutate(&self, parent: &FloorPlan, sampler: &mut Sampler) -> FloorPlan {
        let changes = if sampler.ratio(1, 3) { 2 } else { 1 };
        let mut floor_plan = parent.clone();
        for _ in 0..changes {
            let next = (0..REDRAWS).find_map(|_| self.change(&floor_plan, sampler));
            floor_plan = next.unwrap_or(floor_plan);
        }
        floor_plan
    }

    /// Combines halves of both parents.
    fn cross(&self, one: &FloorPlan, two: &FloorPlan, sampler: &mut Sampler) -> FloorPlan {
        for _ in 0..REDRAWS {
            let across = sampler.ratio(1, 2);
            let half = |&cell: &usize| {
                if across {
                    2 * self.grid.x(cell) < self.grid.columns
                } else {
                    2 * self.grid.y(cell) < self.grid.rows
                }
            };
            let mask: Cells = (0..self.grid.len()).filter(half).map(bit).sum();
            let wall = one.wall & mask | two.wall & !mask;
            let targets = if sampler.ratio(1, 2) { one.targets } else { two.targets };
            let taken = targets[0] | targets[1];
            let wall = wall & !taken;
            let sills = (one.sills & mask | two.sills & !mask) & !(taken | wall);
            let child = FloorPlan { wall, targets, sills, ..one.clone() };
            if self.is_fair(&child) {
                return child;
            }
        }
        self.mutate(one, sampler)
    }
}
