//! Placement of sprites in levels with pushable objects, along with the solutions of these levels.

use super::pulls::Pulls;
use crate::levels::construct::builder::Builder;
use crate::levels::construct::jobs::Jobs;
use crate::levels::construct::plan::round;
use crate::levels::grid::FAR;
use crate::levels::palette::Walk;
use engine::SpriteType;
use engine::analysis::Role;

impl Builder<'_> {
    /// Adds a puzzle to a board that contains only walls, and returns the solution as steps of the avatar.
    pub(crate) fn warehouse(&mut self, plan: &Jobs) -> Option<Vec<(i32, i32)>> {
        let grid = self.board.grid;
        let mut pulls = Pulls::new(grid, self.board.wall.clone());
        // The bottleneck of a bridge, a door or a gate, with the cells behind it.
        let barrier = if plan.is_barred() {
            let cells: Vec<usize> = self.board.free().collect();
            if cells.is_empty() {
                return None;
            }
            self.board.start = *self.sampler.choose(&cells);
            let bottleneck = self.bottleneck(plan.bridge).or_else(|| self.build_vault(plan.bridge))?;
            pulls.wall.clone_from(&self.board.wall);
            Some(bottleneck)
        } else {
            None
        };
        let behind = |cell: usize| barrier.as_ref().is_some_and(|barrier| barrier.behind.contains(&cell));
        let door = barrier.as_ref().filter(|_| !plan.bridge).map(|barrier| barrier.cell);
        let visits =
            self.place_visits(plan, &mut pulls, &behind, barrier.as_ref().map(|barrier| barrier.cell))?;
        if let Some(door) = door {
            pulls.closed[door] = true;
        }
        // The puzzle is on the near side of the barrier.
        for &cell in barrier.iter().flat_map(|barrier| &barrier.behind) {
            pulls.barred[cell] = true;
        }
        let mut sockets = Vec::new();
        for (at, job) in plan.jobs.iter().enumerate() {
            let last = at + 1 == plan.jobs.len();
            let cell = match &barrier {
                Some(barrier) if plan.bridge && last => barrier.cell,
                _ => self.choose_socket(&pulls, &sockets, &behind, job.merges)?,
            };
            sockets.push(cell);
            if !job.merges {
                pulls.barred[cell] = true;
                // Filled partners are gone at the end. Partners that stay are obstacles.
                let walkable = job.walkable && !job.stays;
                pulls.partners[cell] =
                    if job.fills && !job.stays { None } else { Some((job.partner, walkable)) };
            }
        }
        // In reverse, the avatar reaches the last push from the first visit. If the plan has a door, which is closed
        // again in reverse, the avatar may come from any cell.
        pulls.avatar = if plan.door.is_some() { None } else { visits.first().copied() };
        self.scatter(plan, &sockets, &mut pulls);
        let depth = 3.0 + 7.0 * self.difficulty();
        for (job, &cell) in plan.jobs.iter().zip(&sockets).rev() {
            let depth = round(depth * (0.7 + 0.6 * self.sampler.unit()), &mut self.sampler);
            pulls.undo(job, cell, depth, &mut self.sampler)?;
        }
        if !plan.loose.is_empty() {
            self.stray(&mut pulls);
        }
        let start = self.choose_stand(&pulls, &behind)?;
        let mut check = pulls.clone();
        check.avatar = Some(start);
        let ways = check.solution(plan, start, door, &visits)?;
        self.finish(plan, &pulls, start, door, &ways)
    }

    /// Places keys and exits, behind the barrier if there is one.
    fn place_visits(
        &mut self,
        plan: &Jobs,
        pulls: &mut Pulls,
        behind: &dyn Fn(usize) -> bool,
        barrier: Option<usize>,
    ) -> Option<Vec<usize>> {
        let mut visits: Vec<usize> = Vec::new();
        for (at, &stype) in plan.visits.iter().enumerate() {
            let last = at + 1 == plan.visits.len();
            let grid = self.board.grid;
            let cell = self.put_where(stype, |builder, cell| {
                let inside = behind(cell);
                let cut = builder.board.would_cut(builder.palette, cell);
                let near = barrier.is_some_and(|barrier| grid.manhattan(cell, barrier) < 1);
                let side = if at < plan.keys { !inside } else { inside || barrier.is_none() || !last };
                let walls = builder.board.walls_around(cell) as u32;
                let apart = visits.iter().map(|&other| grid.manhattan(cell, other)).min().unwrap_or(9) as u32;
                if !side || cut || near || Some(cell) == barrier { 0 } else { (1 + walls) * apart.min(9) }
            })?;
            pulls.barred[cell] = true;
            let blocked = self.board.placed[cell]
                .is_some_and(|symbol| !matches!(self.palette.walk(symbol), Walk::Open | Walk::Breakable));
            pulls.closed[cell] = blocked;
            visits.push(cell);
        }
        Some(visits)
    }

    /// Draws a socket, which is a cell onto which an object is to be pushed. The cell has enough room on at least one
    /// side, and is near the other sockets.
    fn choose_socket(
        &mut self,
        pulls: &Pulls,
        chosen: &[usize],
        behind: &dyn Fn(usize) -> bool,
        merges: bool,
    ) -> Option<usize> {
        let grid = self.board.grid;
        let free = |cell: usize| {
            !pulls.wall[cell]
                && !pulls.closed[cell]
                && !behind(cell)
                && !chosen.contains(&cell)
                && !pulls.barred[cell]
        };
        let cells: Vec<usize> = (0..grid.len()).filter(|&cell| free(cell)).collect();
        let weight = |&cell: &usize| {
            let lines = crate::levels::grid::WAYS.into_iter().filter(|&way| {
                let near = grid.shift(cell, way);
                let far = near.and_then(|near| grid.shift(near, way));
                near.is_some_and(free) && far.is_some_and(free)
            });
            let lines = lines.count() as u32;
            let close = chosen.iter().map(|&other| grid.manhattan(cell, other)).min().unwrap_or(2);
            // Sockets stand in groups next to a wall, and never in a bottleneck.
            let group = if merges { 2 } else { [0, 6, 4, 2, 1][close.min(4)] };
            let cut = grid.is_cut(cell, |next| !pulls.wall[next]);
            if lines == 0 || cut { 0 } else { (5 - lines.min(4)) * group }
        };
        let weights: Vec<u32> = cells.iter().map(weight).collect();
        self.sampler.weighted(&weights).map(|at| cells[at])
    }

    /// Scatters loose objects in the final state of the solution, from which the backward construction starts.
    fn scatter(&mut self, plan: &Jobs, sockets: &[usize], pulls: &mut Pulls) {
        let grid = self.board.grid;
        for &stype in &plan.loose {
            let reachable = pulls.reachable();
            let cells: Vec<usize> = (0..grid.len())
                .filter(|&cell| {
                    let clear = pulls.stands(cell) && !pulls.barred[cell] && pulls.partners[cell].is_none();
                    let open = |next: usize| pulls.stands(next);
                    let aside = !sockets.iter().any(|&socket| grid.manhattan(socket, cell) <= 2);
                    clear
                        && aside
                        && Some(cell) != pulls.avatar
                        && reachable[cell] != FAR
                        && !grid.is_cut(cell, open)
                })
                .collect();
            if let Some(&cell) = cells.get(self.sampler.below(cells.len().max(1))) {
                pulls.things[cell] = Some(stype);
            }
        }
    }

    /// Walks the avatar backwards among the loose objects, so that it drags some of them into its own path.
    fn stray(&mut self, pulls: &mut Pulls) {
        let goal = pulls.avatar;
        let least = 3 + round(3.0 * self.difficulty(), &mut self.sampler);
        for turn in 0..14 {
            let reachable = pulls.reachable();
            // Stop once the way to the goal is blocked.
            if turn >= least && goal.is_none_or(|goal| reachable[goal] == FAR) {
                return;
            }
            let weights: Vec<u32> =
                reachable.iter().map(|&steps| if steps == FAR { 0 } else { steps * steps }).collect();
            let Some(to) = self.sampler.weighted(&weights) else { return };
            pulls.wander(to, 8, &mut self.sampler);
        }
    }

    /// Draws the avatar's start from the reachable cells, preferably far from the first push.
    fn choose_stand(&mut self, pulls: &Pulls, behind: &dyn Fn(usize) -> bool) -> Option<usize> {
        let reachable = pulls.reachable();
        let weight = |cell: usize| {
            let free = pulls.partners[cell].is_none() && self.board.placed[cell].is_none() && !behind(cell);
            match reachable[cell] {
                steps if steps == FAR || !free => 0,
                // Prefer positions that match the avatar's positions in the examples, and positions far from the last
                // pull and from the exit.
                steps if self.target.is_some() => {
                    let exit = self.apart_from(cell, Role::Exit).min(12) as u32;
                    let far = (1 + steps * steps).saturating_mul(1 + exit * exit);
                    far.saturating_mul(self.example_weight(cell, self.palette.avatars[0].0))
                }
                steps => 1 + steps.min(12),
            }
        };
        let weights: Vec<u32> = (0..reachable.len()).map(weight).collect();
        // If no cell is suitable, the avatar stays at the end of the last pull.
        self.sampler.weighted(&weights).or(pulls.avatar)
    }

    /// Places the puzzle on the board, fills unused corners with walls, and reserves the cells of the solution.
    fn finish(
        &mut self,
        plan: &Jobs,
        pulls: &Pulls,
        start: usize,
        door: Option<usize>,
        ways: &[(i32, i32)],
    ) -> Option<Vec<(i32, i32)>> {
        let grid = self.board.grid;
        let mut cell = start;
        let mut used = vec![false; grid.len()];
        used[start] = true;
        for &way in ways {
            cell = grid.shift(cell, way)?;
            used[cell] = true;
            if let Some(ahead) = grid.shift(cell, way) {
                used[ahead] = true;
            }
        }
        if let (Some(cell), Some(stype)) = (door, plan.door.or(plan.gate)) {
            self.put(cell, stype);
        }
        for cell in 0..grid.len() {
            let partner = pulls.partners[cell].map(|(stype, _)| stype);
            for stype in partner.into_iter().chain(pulls.things[cell]) {
                self.put(cell, stype);
            }
        }
        self.put_avatar(start);
        self.tighten(&used);
        for (kept, used) in self.board.kept.iter_mut().zip(used) {
            *kept = used;
        }
        Some(ways.to_vec())
    }

    /// Turns some cells that are not needed for the solution into walls, without cutting off other cells.
    fn tighten(&mut self, used: &[bool]) {
        if self.sampler.unit() > 0.3 + 0.5 * self.difficulty() {
            return;
        }
        let grid = self.board.grid;
        for _ in 0..2 {
            for (cell, &used) in used.iter().enumerate() {
                let beside = grid.beside(cell).filter(|&next| self.board.wall[next]).count();
                let idle = !used && self.board.is_free(cell) && beside >= 2;
                let open = |next: usize| !self.board.wall[next];
                if idle && !grid.is_cut(cell, open) && self.sampler.ratio(1, 2) {
                    self.board.wall[cell] = true;
                }
            }
        }
    }

    /// Adds the game's other sprites after the puzzle, without obstructing the solution.
    pub(crate) fn furnish_rest(&mut self, plan: &Jobs) {
        self.board.pushing = true;
        if plan.gate.is_none() {
            let gates = self.gates();
            self.keys(&gates);
        }
        let wishes = self.wishes();
        let used: Vec<SpriteType> = plan.jobs.iter().flat_map(|job| [job.pushed, job.partner]).collect();
        for wish in wishes {
            let puzzle = matches!(wish.role, Role::Pushable | Role::Socket | Role::Exit);
            let visited = plan.visits.contains(&wish.stype);
            if !puzzle && !visited && !used.contains(&wish.stype) {
                self.fulfil(wish);
            }
        }
        self.other_walls();
        self.soil();
    }
}
