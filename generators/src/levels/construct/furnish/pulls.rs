//! Backward construction of levels with pushable objects. Starting from the solved state, the avatar pulls the objects
//! away from their destinations, so that pushing them back is a solution.

use crate::levels::construct::jobs::{Job, Jobs};
use crate::levels::grid::{FAR, Grid, WAYS};
use base::Sampler;
use engine::SpriteType;
use std::collections::VecDeque;

/// A push that moves the object in a cell by one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Push {
    pub(crate) from: usize,
    pub(crate) way: (i32, i32),
}

/// A floor plan with pushable objects, in the state before the pushes found so far.
#[derive(Clone, Debug)]
pub(crate) struct Pulls {
    pub(crate) grid: Grid,
    pub(crate) wall: Vec<bool>,
    /// The pushable object in each cell; `None` for cells without one.
    pub(crate) things: Vec<Option<SpriteType>>,
    /// For each cell with a job's partner, the partner, and `true` if the avatar can currently enter the cell.
    pub(crate) partners: Vec<Option<(SpriteType, bool)>>,
    /// For each cell, `true` if pushing objects into it is forbidden.
    pub(crate) barred: Vec<bool>,
    /// For each cell, `true` if the avatar cannot enter it.
    pub(crate) closed: Vec<bool>,
    /// The avatar's cell; `None` if the avatar may be anywhere.
    pub(crate) avatar: Option<usize>,
    /// The pushes of the solution, in reverse order.
    pub(crate) pushes: Vec<Push>,
}

/// The state immediately after a pull, given by the cells of the object and the avatar.
#[derive(Clone, Copy)]
struct Node {
    thing: usize,
    avatar: usize,
    /// The number of pulls so far.
    depth: usize,
    /// The index of the node before this pull.
    before: usize,
    /// The number of cells that the avatar can reach.
    room: usize,
}

impl Pulls {
    pub(crate) fn new(grid: Grid, wall: Vec<bool>) -> Pulls {
        let size = grid.len();
        Pulls {
            grid,
            wall,
            things: vec![None; size],
            partners: vec![None; size],
            barred: vec![false; size],
            closed: vec![false; size],
            avatar: None,
            pushes: Vec::new(),
        }
    }

    /// Returns `true` if the avatar can stand in the cell.
    pub(crate) fn stands(&self, cell: usize) -> bool {
        let partner = self.partners[cell].is_none_or(|(_, walkable)| walkable);
        !self.wall[cell] && !self.closed[cell] && self.things[cell].is_none() && partner
    }

    /// Returns `true` if an object can lie in the cell between pushes.
    fn lies(&self, cell: usize) -> bool {
        let free = !self.wall[cell] && !self.closed[cell] && !self.barred[cell];
        free && self.things[cell].is_none() && self.partners[cell].is_none()
    }

    /// Returns the number of steps from the avatar to each cell, or [`FAR`] for unreachable cells.
    pub(crate) fn reachable(&self) -> Vec<u32> {
        match self.avatar {
            Some(cell) => self.grid.flood(&[cell], |next| self.stands(next)),
            None => (0..self.grid.len()).map(|cell| if self.stands(cell) { 0 } else { FAR }).collect(),
        }
    }

    /// Undoes the last push of a job, which moved an object onto the partner at `cell`. Then pulls the object away by
    /// about `pulls` pulls.
    pub(crate) fn undo(&mut self, job: &Job, cell: usize, pulls: usize, sampler: &mut Sampler) -> Option<()> {
        let reachable = self.reachable();
        let reaches = |cell: usize| reachable[cell] != FAR;
        let options: Vec<((i32, i32), usize, usize)> = WAYS
            .into_iter()
            .filter_map(|way| {
                // The avatar pushed the thing to this cell from `near`, standing at `far`.
                let near = self.grid.shift(cell, (-way.0, -way.1))?;
                let far = self.grid.shift(near, (-way.0, -way.1))?;
                (self.lies(near) && self.stands(near) && reaches(near) && self.stands(far))
                    .then_some((way, near, far))
            })
            .collect();
        if options.is_empty() || (job.merges && !self.lies(cell)) {
            return None;
        }
        let (way, near, far) = *sampler.choose(&options);
        if job.merges {
            self.things[cell] = Some(job.partner);
        } else {
            self.partners[cell] = Some((job.partner, job.walkable));
        }
        self.things[near] = Some(job.pushed);
        self.avatar = Some(far);
        self.pushes.push(Push { from: near, way });
        self.pull(near, pulls, sampler);
        if job.merges {
            self.pull(cell, pulls, sampler);
        }
        Some(())
    }

    /// Pulls the object in a cell to a position about `pulls` pulls away, or as far as possible.
    pub(crate) fn pull(&mut self, from: usize, pulls: usize, sampler: &mut Sampler) {
        let Some(stype) = self.things[from] else { return };
        let Some(first) = self.avatar else { return };
        let mut nodes: Vec<Node> = vec![Node { thing: from, avatar: first, depth: 0, before: 0, room: 0 }];
        let mut seen: Vec<(usize, usize)> = Vec::new();
        let mut queue: VecDeque<usize> = VecDeque::from([0]);
        while let Some(at) = queue.pop_front() {
            let Node { thing, avatar, depth, .. } = nodes[at];
            self.things[from] = None;
            self.things[thing] = Some(stype);
            let reachable = self.grid.flood(&[avatar], |cell| self.stands(cell));
            nodes[at].room = reachable.iter().filter(|&&steps| steps != FAR).count();
            for way in WAYS {
                let Some(near) = self.grid.shift(thing, way) else { continue };
                let Some(far) = self.grid.shift(near, way) else { continue };
                let new = depth < pulls + 2 && !seen.contains(&(near, far));
                if new && reachable[near] != FAR && self.lies(near) && self.stands(far) {
                    seen.push((near, far));
                    nodes.push(Node { thing: near, avatar: far, depth: depth + 1, before: at, room: 0 });
                    queue.push_back(nodes.len() - 1);
                }
            }
            self.things[thing] = None;
            self.things[from] = Some(stype);
        }
        // Avoid states in which the avatar is confined, because it may have more objects to pull, and because levels
        // start in the open.
        let widest = nodes.iter().map(|node| node.room).max().unwrap_or(0);
        let wide = |node: &Node| node.room * 2 >= widest;
        let deepest = nodes.iter().filter(|node| wide(node)).map(|node| node.depth).max().unwrap_or(0);
        let wanted = pulls.min(deepest);
        let ends: Vec<usize> =
            (0..nodes.len()).filter(|&at| wide(&nodes[at]) && nodes[at].depth + 1 >= wanted).collect();
        let mut at = *sampler.choose(&ends);
        let end = nodes[at];
        let mut steps: Vec<Push> = Vec::new();
        while at != 0 {
            let Node { thing, before, .. } = nodes[at];
            let to = nodes[before].thing;
            steps.push(Push { from: thing, way: self.grid.offset(thing, to) });
            at = before;
        }
        self.pushes.extend(steps.into_iter().rev());
        self.things[from] = None;
        self.things[end.thing] = Some(stype);
        self.avatar = Some(end.avatar);
    }

    /// Walks the avatar backwards to a cell, so that it sometimes pulls an adjacent object along.
    pub(crate) fn wander(&mut self, to: usize, eager: usize, sampler: &mut Sampler) {
        for _ in 0..self.grid.len() {
            let Some(at) = self.avatar.filter(|&at| at != to) else { return };
            let Some(way) = self.grid.way(at, to, |cell| self.stands(cell)) else { return };
            let next = way[1];
            let step = self.grid.offset(at, next);
            let behind = self.grid.shift(at, (-step.0, -step.1));
            let thing = behind.and_then(|behind| self.things[behind].map(|stype| (behind, stype)));
            if let Some((behind, stype)) = thing.filter(|_| self.lies(at) && sampler.ratio(eager, 10)) {
                self.things[behind] = None;
                self.things[at] = Some(stype);
                self.pushes.push(Push { from: at, way: (-step.0, -step.1) });
            }
            self.avatar = Some(next);
        }
    }

    /// Returns the avatar's steps from `start` that carry out the pushes and then visit the cells in `visits` in turn.
    /// Returns `None` if the pushes do not work.
    pub(crate) fn solution(
        &self,
        plan: &Jobs,
        start: usize,
        opens: Option<usize>,
        visits: &[usize],
    ) -> Option<Vec<(i32, i32)>> {
        let mut now = self.clone();
        let mut ways = Vec::new();
        let mut avatar = start;
        let mut done = 0;
        for push in self.pushes.iter().rev() {
            let stand = now.grid.shift(push.from, (-push.way.0, -push.way.1))?;
            walk(&now, avatar, stand, &mut ways)?;
            let stype = now.things[push.from].take()?;
            let to = now.grid.shift(push.from, push.way)?;
            let job =
                |other: SpriteType| plan.jobs.iter().find(|job| job.pushed == stype && job.partner == other);
            if let Some((partner, _)) = now.partners[to] {
                let job = job(partner)?;
                done += 1;
                now.partners[to] = if job.fills && !job.stays { None } else { now.partners[to] };
                now.closed[to] |= job.stays;
            } else if let Some(other) = now.things[to] {
                job(other)?;
                done += 1;
                now.things[to] = None;
            } else {
                now.things[to] = Some(stype);
            }
            ways.push(push.way);
            avatar = push.from;
        }
        // A door opens with the last job, and a gate opens after the visits to its keys.
        let mut opened = plan.keys == 0 && done == plan.jobs.len();
        for (at, &cell) in visits.iter().enumerate() {
            opened |= plan.keys > 0 && at >= plan.keys;
            if let Some(door) = opens.filter(|_| opened) {
                now.closed[door] = false;
            }
            now.closed[cell] = false;
            walk(&now, avatar, cell, &mut ways)?;
            avatar = cell;
        }
        Some(ways)
    }
}

/// Adds the steps of a shortest walk from `from` to `to` to `ways`; `None` if there is no such walk.
fn walk(now: &Pulls, from: usize, to: usize, ways: &mut Vec<(i32, i32)>) -> Option<()> {
    let way = now.grid.way(from, to, |cell| now.stands(cell))?;
    ways.extend(way.windows(2).map(|pair| now.grid.offset(pair[0], pair[1])));
    now.stands(to).then_some(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::Seed;

    #[test]
    fn pulled_things_can_be_pushed_back() {
        let grid = Grid { columns: 9, rows: 8 };
        let wall: Vec<bool> = (0..grid.len()).map(|cell| grid.on_border(cell)).collect();
        let job = Job {
            pushed: SpriteType(3),
            partner: SpriteType(4),
            merges: false,
            stays: false,
            fills: false,
            walkable: true,
        };
        let plan = Jobs { jobs: vec![job.clone(), job.clone()], ..Jobs::default() };
        for seed in 0..40 {
            let mut sampler = Seed::from_text("pulls").child("seed", seed).sampler();
            let mut pulls = Pulls::new(grid, wall.clone());
            let sockets = [grid.at(3, 3), grid.at(5, 4)];
            for socket in sockets {
                pulls.partners[socket] = Some((job.partner, true));
            }
            for socket in sockets {
                pulls.undo(&job, socket, 6, &mut sampler).unwrap();
            }
            assert!(pulls.pushes.len() >= 8);
            let start = pulls.avatar.unwrap();
            let ways = pulls.solution(&plan, start, None, &[]).unwrap();
            assert!(ways.len() >= pulls.pushes.len());
        }
    }
}
