//! Placement of sprites on boards that the avatar walks through, with exits, keys, goods and dangers.

use crate::levels::construct::builder::{Builder, back};
use crate::levels::construct::plan;
use crate::levels::construct::plan::Wish;
use crate::levels::grid::FAR;
use engine::analysis::{Key, Motion, Role};
use engine::{Direction, SpriteType};

impl Builder<'_> {
    /// Places the sprites on a board that contains only walls.
    pub(crate) fn adventure(&mut self) {
        let start = self.choose_start();
        self.put_avatar(start);
        let gates = self.gates();
        self.furnish(&gates);
    }

    /// Places everything except the avatar, the gates and the types that have already been placed.
    pub(crate) fn furnish(&mut self, gates: &[SpriteType]) {
        let wishes = self.wishes();
        let done: Vec<SpriteType> = self.log.iter().map(|(_, stype)| *stype).collect();
        let (exits, rest): (Vec<Wish>, Vec<Wish>) = wishes
            .into_iter()
            .filter(|wish| {
                !done.contains(&wish.stype)
                    || self.config.counts.iter().any(|(asked, _)| *asked == wish.stype)
            })
            .partition(|wish| wish.role == Role::Exit);
        for wish in exits {
            self.fulfil(wish);
        }
        self.keys(gates);
        for wish in rest.iter().filter(|wish| wish.role != Role::Collectable) {
            self.fulfil(*wish);
        }
        self.other_walls();
        self.fuel();
        for wish in rest.iter().filter(|wish| wish.role == Role::Collectable) {
            self.fulfil(*wish);
        }
        self.soil();
    }

    /// Places as many of the desired sprites as possible.
    pub(crate) fn fulfil(&mut self, wish: Wish) {
        // Exact numbers and numbers of keys include the sprites that have already been placed.
        let exact =
            wish.role == Role::Key || self.config.counts.iter().any(|(asked, _)| *asked == wish.stype);
        let before = if exact { 0 } else { self.board.count(self.analysis, wish.stype) };
        let mut tries = 0;
        while self.board.count(self.analysis, wish.stype) < before + wish.count && tries < wish.count {
            tries += 1;
            let Some(cell) = self.place(wish.stype, wish.role) else { return };
            let left = before + wish.count > self.board.count(self.analysis, wish.stype);
            if let Some(twin) = self.twin(cell, wish.stype).filter(|_| left) {
                self.put(twin, wish.stype);
            }
        }
    }

    /// Places one sprite, first by the strict rules for its role, and then by relaxed rules. Returns the cell.
    pub(crate) fn place(&mut self, stype: SpriteType, role: Role) -> Option<usize> {
        let steps = self.steps();
        let radius = self.radius(&steps);
        if let Some(grouped) = self.draw_group(stype) {
            let beside = |builder: &Self, cell: usize| {
                builder.board.grid.beside(cell).any(|next| builder.log.contains(&(next, stype)))
            };
            let put = self.put_where(stype, |builder, cell| {
                if beside(builder, cell) != grouped {
                    0
                } else if grouped {
                    // The role's distances apply to a group as a whole, so further members need not keep them.
                    let from_start = builder.board.grid.manhattan(cell, builder.board.start);
                    u32::from(steps[cell] != FAR && from_start > 2 && !builder.cuts(cell, stype))
                } else {
                    builder.ground(cell, role) * builder.weigh(cell, stype, role, &steps, radius)
                }
            });
            if put.is_some() {
                return put;
            }
        }
        let strict = self.put_where(stype, |builder, cell| {
            builder.ground(cell, role) * builder.weigh(cell, stype, role, &steps, radius)
        });
        if strict.is_some() {
            return strict;
        }
        self.put_where(stype, |builder, cell| {
            let harmful = builder.analysis.harm(stype) != engine::analysis::Harm::None;
            let close = builder.board.grid.manhattan(cell, builder.board.start) < if harmful { 3 } else { 1 };
            u32::from(!close && steps[cell] != FAR && !builder.cuts(cell, stype))
        })
    }

    /// Returns the weight of a cell according to what is below it. If the avatar falls, most sprites stand on the
    /// ground, but goods may hang in the air.
    fn ground(&self, cell: usize, role: Role) -> u32 {
        match role {
            _ if !self.avatar_falls() => 1,
            Role::Spawner | Role::Cover | Role::Neutral => 1,
            _ if self.has_footing(cell) => 4,
            Role::Collectable => 1,
            _ => 0,
        }
    }

    /// Returns a cell's suitability for a sprite; 0 means unsuitable.
    fn weigh(&self, cell: usize, stype: SpriteType, role: Role, steps: &[u32], radius: u32) -> u32 {
        let zone = self.board.zone[cell];
        let reached = steps[cell] != FAR;
        let from_start = self.board.grid.manhattan(cell, self.board.start);
        if self.cuts(cell, stype) || (!reached && zone == 0) {
            return 0;
        }
        let share = if reached { steps[cell] * 100 / radius } else { 100 };
        let own_kind = self.apart(cell, |other| other == stype).min(8) as u32;
        let walls = self.board.walls_around(cell) as u32;
        match role {
            Role::Exit => {
                // The exit lies behind the first gate, if there is one. Otherwise, it lies far away, and farther at
                // higher difficulty.
                let wanted = u8::from(self.board.zone.contains(&1));
                let far = share >= 55 + (30.0 * self.difficulty()) as u32;
                if zone != wanted || !(far || zone > 0) { 0 } else { (1 + walls) * share / 10 }
            }
            Role::Enemy | Role::Boulder if from_start < self.min_distance(stype) => 0,
            Role::Enemy | Role::Prey | Role::Spawner
                if self.apart_from(cell, Role::Ward) < self.ward_distance() =>
            {
                0
            }
            Role::Enemy if self.is_on_prey(cell, stype) => 0,
            Role::Enemy => self.weigh_mover(cell, stype, share),
            Role::Prey if from_start < 3 => 0,
            Role::Prey => own_kind * (2 + share / 20),
            Role::Spawner => self.weigh_spawner(cell, stype, walls),
            Role::Hazard if from_start < 3 || self.apart_from(cell, Role::Exit) < 2 => 0,
            // Deadly things that spawn deadly things keep their distance from the avatar's start.
            Role::Hazard
                if self.target.is_some()
                    && self.analysis.makes_harm(stype)
                    && from_start < self.min_spawn_distance(stype) =>
            {
                0
            }
            Role::Hazard | Role::Cover | Role::Refuge | Role::Breakable => {
                if from_start < 2 {
                    0
                } else {
                    // Place these types in small groups.
                    match self.apart(cell, |other| other == stype) {
                        1 if self.crowd(cell, stype) <= 2 => 12,
                        1 => 0,
                        2 => 1,
                        _ => 2,
                    }
                }
            }
            Role::Boulder => u32::from(own_kind > 0),
            // Place protected sprites close together, so that there is room for the things that threaten them.
            Role::Ward => 1 + 12 / (1 + own_kind),
            Role::Pushable | Role::Socket if walls == 0 && from_start > 1 => own_kind,
            Role::Pushable | Role::Socket => 0,
            Role::Portal | Role::PortalExit => {
                let pair = self.apart_from(cell, Role::Portal).min(self.apart_from(cell, Role::PortalExit));
                if from_start < 3 || pair < 5 { 0 } else { share }
            }
            Role::Key => {
                // A key lies neither on the way to the exit nor next to the start.
                let apart = self.apart_from(cell, Role::Exit).min(8) as u32;
                if from_start < 3 { 0 } else { own_kind * apart * (1 + share) / 16 }
            }
            Role::Collectable => {
                let nook = if walls >= 5 { 3 } else { 1 };
                if from_start < 2 { 0 } else { own_kind * nook * (2 + share / 25) }
            }
            _ => u32::from(from_start >= 2) * own_kind,
        }
    }

    /// Returns the minimum distance in cells between a protected sprite and its threats.
    fn ward_distance(&self) -> usize {
        let grid = self.board.grid;
        if self.target.is_some() { ((grid.columns + grid.rows) / 5).max(4) } else { 4 }
    }

    /// Returns `true` if the cell is close to a target, other than the avatar, that the type chases. The player needs
    /// time to intervene.
    fn is_on_prey(&self, cell: usize, stype: SpriteType) -> bool {
        let Motion::Chasing(target) = self.analysis.facts(stype).motion else { return false };
        let hunted = |other: SpriteType| {
            self.analysis.applies(target, other) && self.analysis.role(other) != Role::Avatar
        };
        self.apart(cell, hunted) < self.min_distance(stype).max(4)
    }

    /// Returns the weight of a cell for a moving sprite. The sprite needs room to move, and must not head straight for
    /// the avatar.
    fn weigh_mover(&self, cell: usize, stype: SpriteType, share: u32) -> u32 {
        let others = self.apart_from(cell, Role::Enemy).min(6) as u32;
        let spread = 1 + others + share / 20;
        let Some(way) = self.heading(stype) else { return spread };
        let room = self.run(cell, way) + self.run(cell, back(way));
        if room < 2 || self.aims_at_start(cell, way) || self.aims_at_start(cell, back(way)) {
            return 0;
        }
        // A row or column contains at most one moving sprite.
        let lane = self.log.iter().any(|&(other, kind)| {
            let grid = self.board.grid;
            let same = if way.0 != 0 { grid.y(other) == grid.y(cell) } else { grid.x(other) == grid.x(cell) };
            same && self.heading(kind).is_some() && self.analysis.role(kind) == Role::Enemy
        });
        if lane { 0 } else { spread * room.min(12) as u32 }
    }

    /// Returns the weight of a cell for a spawner. Good cells are next to a wall or the board edge, with a free line of
    /// fire that does not hit the avatar.
    fn weigh_spawner(&self, cell: usize, stype: SpriteType, walls: u32) -> u32 {
        let from_start = self.board.grid.manhattan(cell, self.board.start);
        let others = self.apart_from(cell, Role::Spawner).min(8) as u32;
        match self.heading(stype) {
            Some(way) => {
                let ahead = self.run(cell, way);
                if ahead < 3 || self.aims_at_start(cell, way) || from_start < 3 {
                    return 0;
                }
                let backed = self.run(cell, back(way)) == 0;
                others * if backed { 20 } else { 1 }
            }
            None if from_start < self.min_spawn_distance(stype) => 0,
            None => others * (1 + walls),
        }
    }

    /// Returns the minimum distance between a spawner and the avatar's start. This distance prevents spawned sprites
    /// from reaching the avatar immediately.
    fn min_spawn_distance(&self, stype: SpriteType) -> usize {
        let made = self.analysis.facts(stype).makes.iter().map(|&made| self.min_distance(made));
        made.max().unwrap_or(2).max(4)
    }

    /// Returns the number of sprites of the given type in the eight cells around a cell.
    fn crowd(&self, cell: usize, stype: SpriteType) -> usize {
        let around = self.board.grid.around(cell).into_iter().flatten();
        around.filter(|&next| self.log.contains(&(next, stype))).count()
    }

    /// Chooses the avatar's start. The start is near an end of a longest path, or in the middle if the aim is to
    /// survive.
    fn choose_start(&mut self) -> usize {
        let grid = self.board.grid;
        let cells: Vec<usize> = self.board.free().collect();
        let open = |cell: usize| !self.board.wall[cell];
        let survives = self.analysis.aims().remove.is_empty() && self.analysis.aims().create.is_empty();
        let centre = grid.at(grid.columns / 2, grid.rows / 2);
        if self.target.is_some() {
            let avatar = self.palette.avatars[0].0;
            let suits = |cell: usize| !self.avatar_falls() || self.has_footing(cell);
            let weight = |&cell: &usize| if suits(cell) { self.example_weight(cell, avatar) } else { 0 };
            let weights: Vec<u32> = cells.iter().map(weight).collect();
            if let Some(at) = self.sampler.weighted(&weights) {
                return cells[at];
            }
        }
        let some = *self.sampler.choose(&cells);
        let target = if survives {
            centre
        } else {
            let steps = grid.flood(&[some], open);
            let far = cells.iter().copied().max_by_key(|&cell| (steps[cell], cell));
            far.unwrap_or(some)
        };
        // The start is near the end of the path, but not always exactly at the end. If the avatar falls, the start is
        // on the ground.
        let grounded = |cell: &usize| !self.avatar_falls() || self.has_footing(*cell);
        let near = |cell: &usize| grid.manhattan(*cell, target) <= 1;
        let close: Vec<usize> = cells.iter().copied().filter(|cell| near(cell) && grounded(cell)).collect();
        if !close.is_empty() {
            return *self.sampler.choose(&close);
        }
        let best =
            cells.into_iter().filter(grounded).min_by_key(|&cell| (grid.manhattan(cell, target), cell));
        best.unwrap_or(some)
    }

    /// Places the keys that the placed locks require, each in front of its lock.
    pub(crate) fn keys(&mut self, gates: &[SpriteType]) {
        let placed = self.log.iter().map(|(_, stype)| *stype);
        let exits: Vec<SpriteType> = placed.filter(|&stype| self.role(stype) == Role::Exit).collect();
        let keyed = plan::furnishable(self.analysis, self.palette, Role::Key);
        // Keys that are themselves locked, and spawners with a lock, also count as locked things.
        let chained: Vec<SpriteType> = self
            .analysis
            .locks()
            .iter()
            .map(|lock| lock.stype)
            .filter(|stype| self.analysis.facts(*stype).is_resource || self.role(*stype) == Role::Spawner)
            .collect();
        let mut needs: Vec<(Vec<(SpriteType, i32)>, i32)> = Vec::new();
        for &stype in gates.iter().chain(&exits).chain(&chained) {
            let Some(lock) = self.lock_of(stype).cloned() else { continue };
            let amount = match lock.key {
                Key::Resource { amount, .. } => amount.max(1),
                Key::Avatar(_) | Key::Switch(..) => 1,
            };
            let adds = matches!(lock.key, Key::Resource { spent: true, .. });
            match needs.iter_mut().find(|(givers, _)| *givers == lock.givers) {
                Some((_, total)) if adds => *total = total.saturating_add(amount),
                Some((_, total)) => *total = (*total).max(amount),
                None => needs.push((lock.givers, amount)),
            }
        }
        for (givers, needed) in needs {
            let givers: Vec<(SpriteType, i32)> = givers
                .into_iter()
                .filter(|(giver, _)| {
                    self.palette.symbol(*giver).is_some() && !self.palette.ground.contains(giver)
                })
                .collect();
            if givers.is_empty() {
                continue;
            }
            let spare = if needed > 3 {
                3.0 * (1.0 - self.difficulty()) + 1.0
            } else {
                0.8 * (1.0 - self.difficulty())
            };
            let spare = plan::round(spare, &mut self.sampler) as i32;
            let placed = |(giver, amount): &(SpriteType, i32)| {
                amount.saturating_mul(self.board.count(self.analysis, *giver) as i32)
            };
            let held = givers.iter().map(placed).fold(0, i32::saturating_add);
            let mut left = needed.saturating_sub(held);
            left = left.saturating_add(if keyed.is_empty() || held > 0 { 0 } else { spare });
            while left > 0 {
                let (giver, amount) = *self.sampler.choose(&givers);
                let held = self.board.count(self.analysis, giver);
                if self.analysis.facts(giver).singleton && held > 0 || self.place_key(giver).is_none() {
                    break;
                }
                left = left.saturating_sub(amount.max(1));
            }
        }
    }

    /// Places a key in front of the gates that it opens, in the part of the board without gates (zone 0), or behind a
    /// gate of a different kind. Returns the cell.
    fn place_key(&mut self, giver: SpriteType) -> Option<usize> {
        let steps = self.steps();
        let radius = self.radius(&steps);
        // The zones (parts of the board) behind the gates that this key opens. Zones are numbered in the order of
        // placement.
        let own = self.log.iter().filter_map(|&(cell, stype)| {
            let opened = self.lock_of(stype)?.givers.iter().any(|(key, _)| *key == giver);
            (opened && self.role(stype) == Role::Gate).then_some(self.board.zone[cell])
        });
        let first = own.min().unwrap_or(u8::MAX);
        self.put_where(giver, |builder, cell| {
            let zone = builder.board.zone[cell];
            // The key to a gate may lie behind a gate that was placed later, but not behind one that was placed
            // earlier.
            let before = zone == 0 || (zone > first && first != u8::MAX);
            let weight = builder.weigh(cell, giver, Role::Key, &steps, radius);
            if !before {
                0
            } else if zone > 0 {
                4 * weight.max(1)
            } else {
                weight
            }
        })
    }

    /// Places a few walls of a type other than the structural walls, as obstacles.
    pub(crate) fn other_walls(&mut self) {
        let structure = self.palette.wall;
        let types = plan::furnishable(self.analysis, self.palette, Role::Wall);
        for stype in types {
            let symbol = self.palette.symbol(stype);
            if symbol == structure {
                continue;
            }
            let count = match &self.target {
                Some(target) => target.counts[stype.index()].0,
                None => plan::round(self.board.area() as f64 * 0.03, &mut self.sampler),
            };
            for _ in 0..count {
                let steps = self.steps();
                let placed = self.put_where(stype, |builder, cell| {
                    let near = builder.board.grid.manhattan(cell, builder.board.start) < 2;
                    let free = !near && steps[cell] != FAR && !builder.cuts(cell, stype);
                    if !free {
                        0
                    } else if builder.apart(cell, |other| other == stype) == 1 {
                        6
                    } else {
                        1
                    }
                });
                if placed.is_none() {
                    break;
                }
            }
        }
    }

    /// Places refills for a resource that the ground drains. The refills are dense enough that the avatar never runs
    /// out of the resource on a path between two of them.
    fn fuel(&mut self) {
        let Some(start) = self.analysis.start_avatar() else { return };
        for resource in self.analysis.resources() {
            let drains = self.palette.ground.iter().map(|&under| {
                let touch = self.analysis.touch(start.stype, under);
                let gives = touch.gives.iter().filter(|(given, _)| *given == resource.stype);
                gives.map(|(_, by)| -by).sum::<i32>()
            });
            let drain: i32 = drains.sum();
            if drain <= 0 {
                continue;
            }
            let range = (resource.limit.max(1) / drain) as f64 * (0.45 - 0.15 * self.difficulty());
            let givers: Vec<SpriteType> = resource
                .givers
                .iter()
                .map(|(giver, _)| *giver)
                .filter(|giver| self.palette.symbol(*giver).is_some())
                .collect();
            for _ in 0..12 {
                let open = |cell: usize| self.board.is_walkable(self.palette, cell);
                let wells = |cell: &usize| {
                    let symbol = self.board.placed[*cell];
                    symbol.is_some_and(|symbol| {
                        self.analysis.game().places(symbol).iter().any(|stype| givers.contains(stype))
                    }) || *cell == self.board.start
                };
                let wells: Vec<usize> = (0..self.board.grid.len()).filter(wells).collect();
                let steps = self.board.grid.flood(&wells, open);
                let dry: Vec<usize> = self
                    .board
                    .free()
                    .filter(|&cell| steps[cell] != FAR && f64::from(steps[cell]) > range)
                    .collect();
                if dry.is_empty() || givers.is_empty() {
                    break;
                }
                let giver = *self.sampler.choose(&givers);
                let cell = *self.sampler.choose(&dry);
                self.put(cell, giver);
            }
        }
    }

    /// Fills most of the remaining cells with soil, leaving burrows around moving sprites.
    pub(crate) fn soil(&mut self) {
        let types = plan::furnishable(self.analysis, self.palette, Role::Soil);
        let Some(&stype) = types.first() else { return };
        let burrow = |builder: &Self, cell: usize| {
            builder.log.iter().any(|&(other, kind)| {
                let moves =
                    matches!(builder.analysis.facts(kind).motion, Motion::Wandering | Motion::Chasing(_));
                moves && builder.board.grid.manhattan(cell, other) <= 2
            })
        };
        let mut cells: Vec<usize> = self.board.free().collect();
        let (filled, of) = match &self.target {
            Some(target) => (target.counts[stype.index()].0.min(cells.len()), cells.len().max(1)),
            None => (78, 100),
        };
        cells.retain(|&cell| !burrow(self, cell));
        for cell in cells {
            if self.sampler.ratio(filled, of) && self.fits(cell, stype) {
                self.put(cell, stype);
            }
        }
        // At the start, no sprite hangs above the avatar or without support.
        let avatar_falls: Vec<usize> = self
            .log
            .iter()
            .filter(|(_, kind)| self.analysis.facts(*kind).motion == Motion::Straight(Direction::DOWN))
            .map(|(cell, _)| *cell)
            .collect();
        for cell in avatar_falls {
            let Some(under) = self.board.grid.shift(cell, (0, 1)) else { continue };
            if self.fits(under, stype) && self.sampler.ratio(4, 5) {
                self.put(under, stype);
            }
        }
    }
}
