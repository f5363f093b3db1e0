//! Small, meaningful changes to a level, of the kind that a designer would make next.

use super::draft::{Draft, SymbolUse};
use crate::levels::construct::layout;
use crate::levels::construct::layout::Family;
use crate::levels::grid::{Grid, WAYS};
use base::Sampler;
use engine::analysis::{Motion, Role, Steering};

/// The maximum distance in cells of a small move.
const NEAR: usize = 2;
/// The maximum number of wall cells that move together.
const SEGMENT: usize = 6;
/// The minimum side length, in cells, of the part of a level to redraw.
const PART: usize = 4;

/// A kind of edit of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edit {
    /// Moves a sprite to a nearby cell. A straight mover stays in its row or column.
    Nudge,
    /// Moves a sprite anywhere.
    Carry,
    /// Adds a sprite. If the sprite is pushable, also adds a target.
    Add,
    /// Removes a sprite. If the sprite is a target, also removes one pushable object.
    Remove,
    /// Swaps two sprites of different kinds.
    Swap,
    /// Moves the avatar's start.
    Restart,
    /// Extends a line of walls at its end.
    Extend,
    /// Shortens a line of walls at its end.
    Shorten,
    /// Opens a gap in a wall between two open cells.
    Open,
    /// Closes a gap in a wall.
    Close,
    /// Moves a line of walls sideways.
    Shift,
    /// Copies the walls of one half to the other half.
    Mirror,
    /// Redraws the walls in a part of the level and leaves its sprites in place.
    Regrow,
}

/// All kinds of changes, with their weights.
const EDITS: [(Edit, u32); 13] = [
    (Edit::Nudge, 5),
    (Edit::Carry, 4),
    (Edit::Add, 3),
    (Edit::Remove, 3),
    (Edit::Swap, 2),
    (Edit::Restart, 2),
    (Edit::Extend, 4),
    (Edit::Shorten, 2),
    (Edit::Open, 2),
    (Edit::Close, 3),
    (Edit::Shift, 3),
    (Edit::Mirror, 1),
    (Edit::Regrow, 1),
];

/// A symmetry of the walls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Symmetry {
    LeftRight,
    UpDown,
    /// A rotation by 180 degrees.
    Turn,
}

impl Symmetry {
    const ALL: [Symmetry; 3] = [Symmetry::LeftRight, Symmetry::UpDown, Symmetry::Turn];

    fn image(self, grid: Grid, cell: usize) -> usize {
        let (x, y) = (grid.x(cell), grid.y(cell));
        let (across, down) = (grid.columns - 1 - x, grid.rows - 1 - y);
        match self {
            Symmetry::LeftRight => grid.at(across, y),
            Symmetry::UpDown => grid.at(x, down),
            Symmetry::Turn => grid.at(across, down),
        }
    }
}

impl Edit {
    pub(crate) fn draw(sampler: &mut Sampler) -> Edit {
        let weights = EDITS.map(|(_, weight)| weight);
        EDITS[sampler.weighted(&weights).unwrap_or(0)].0
    }
}

impl Draft<'_> {
    /// Applies a change of the given kind. Returns `None` if there is nothing to change, or if the drawn change does
    /// not work. The draft must then be discarded.
    pub(crate) fn edit(&mut self, edit: Edit, sampler: &mut Sampler) -> Option<()> {
        match edit {
            Edit::Nudge => self.nudge(sampler),
            Edit::Carry => self.carry(sampler),
            Edit::Add => self.add(sampler),
            Edit::Remove => self.remove(sampler),
            Edit::Swap => self.swap(sampler),
            Edit::Restart => self.restart(sampler),
            Edit::Extend => self.toggle(sampler, Draft::extends),
            Edit::Shorten => self.toggle(sampler, Draft::is_end),
            Edit::Open => self.toggle(sampler, |draft, cell| draft.is_wall(cell) && draft.is_between(cell)),
            Edit::Close => {
                self.toggle(sampler, |draft, cell| draft.is_ground(cell) && draft.is_between(cell))
            }
            Edit::Shift => self.shift(sampler),
            Edit::Mirror => self.mirror(sampler),
            Edit::Regrow => self.regrow(sampler),
        }
    }

    fn nudge(&mut self, sampler: &mut Sampler) -> Option<()> {
        let thing = pick(&self.things(), sampler)?;
        let grid = self.grid;
        let (line_of_motion, cluster) = (self.line_of_motion(thing), self.cluster(thing));
        let cells = self.cells_where(|draft, cell| {
            let in_lane = match line_of_motion {
                Some((_, 0)) => grid.y(cell) == grid.y(thing),
                Some(_) => grid.x(cell) == grid.x(thing),
                None => grid.manhattan(cell, thing) <= NEAR,
            };
            in_lane && draft.suits(draft.cells[thing], cell) && draft.joins(&cluster, cell)
        });
        self.exchange(thing, pick(&cells, sampler)?);
        Some(())
    }

    /// Returns the direction in which a sprite moves straight ahead; `None` for other sprites. The direction determines
    /// the sprite's line.
    fn line_of_motion(&self, cell: usize) -> Option<(i32, i32)> {
        let analysis = &self.levels.analysis;
        self.levels.game.places(self.cells[cell]).iter().find_map(|&stype| {
            match analysis.facts(stype).motion {
                Motion::Straight(direction) => crate::levels::construct::builder::way(direction),
                _ => None,
            }
        })
    }

    fn carry(&mut self, sampler: &mut Sampler) -> Option<()> {
        let thing = pick(&self.things(), sampler)?;
        let cluster = self.cluster(thing);
        let cells = self
            .cells_where(|draft, cell| draft.suits(draft.cells[thing], cell) && draft.joins(&cluster, cell));
        self.exchange(thing, pick(&cells, sampler)?);
        Some(())
    }

    /// Returns the cells of other sprites with the same character, if they provide shelter or are breakable. Such
    /// sprites form clusters.
    fn cluster(&self, thing: usize) -> Vec<usize> {
        let symbol = self.cells[thing];
        let lies = matches!(
            self.vocabulary.kind(symbol),
            SymbolUse::Thing(Role::Cover | Role::Breakable | Role::Refuge)
        );
        self.cells_where(|draft, cell| lies && cell != thing && draft.cells[cell] == symbol)
    }

    /// Returns `true` if a cell is next to a cell of the cluster, or if the cluster is empty.
    fn joins(&self, cluster: &[usize], cell: usize) -> bool {
        cluster.is_empty() || cluster.iter().any(|&other| self.grid.manhattan(other, cell) == 1)
    }

    fn add(&mut self, sampler: &mut Sampler) -> Option<()> {
        let vocabulary = self.vocabulary;
        let symbols: Vec<u8> =
            vocabulary.things().filter(|&symbol| self.count(symbol) < vocabulary.bounds(symbol).1).collect();
        let symbol = pick(&symbols, sampler)?;
        self.put(symbol, sampler)?;
        if vocabulary.kind(symbol) == SymbolUse::Thing(Role::Pushable) {
            let partners = self.partners(symbol);
            if let Some(partner) = pick(&partners, sampler) {
                self.put(partner, sampler)?;
            }
        }
        Some(())
    }

    /// Places one more sprite with the given character on the ground, either near sprites with the same character or
    /// anywhere.
    fn put(&mut self, symbol: u8, sampler: &mut Sampler) -> Option<()> {
        let like: Vec<usize> = self.cells_where(|draft, cell| draft.cells[cell] == symbol);
        let near = sampler.ratio(1, 2) && !like.is_empty();
        let cells = self.cells_where(|draft, cell| {
            let close = || like.iter().any(|&other| draft.grid.manhattan(other, cell) <= NEAR);
            draft.suits(symbol, cell) && (!near || close())
        });
        let cell = pick(&cells, sampler)?;
        self.cells[cell] = symbol;
        Some(())
    }

    fn remove(&mut self, sampler: &mut Sampler) -> Option<()> {
        let things = self.things();
        let spare = |&&cell: &&usize| {
            let symbol = self.cells[cell];
            self.count(symbol) > self.vocabulary.bounds(symbol).0
        };
        let things: Vec<usize> = things.iter().filter(spare).copied().collect();
        let cell = pick(&things, sampler)?;
        let symbol = self.cells[cell];
        self.clear(cell);
        // Removes a pushed thing as well, if it would otherwise lack a target.
        let pushed = self.cells_where(|draft, cell| draft.partners(draft.cells[cell]).contains(&symbol));
        let homes = self.count(symbol);
        if pushed.len() > homes {
            let cell = pick(&pushed, sampler)?;
            self.clear(cell);
        }
        Some(())
    }

    /// Returns the characters of the targets that a sprite with the given character fills when it is pushed onto them.
    fn partners(&self, symbol: u8) -> Vec<u8> {
        let (levels, mut partners) = (self.levels, Vec::new());
        for pushable in levels.analysis.pushables() {
            if levels.game.places(symbol).contains(&pushable.stype) {
                let filled = pushable.sinks.iter().filter(|sink| sink.fills);
                let merges =
                    |sink: &&engine::analysis::Sink| levels.analysis.role(sink.partner) == Role::Pushable;
                let filled = filled.filter(|sink| !merges(sink));
                partners.extend(filled.filter_map(|sink| levels.palette.symbol(sink.partner)));
            }
        }
        partners
    }

    fn swap(&mut self, sampler: &mut Sampler) -> Option<()> {
        let things = self.things();
        let one = pick(&things, sampler)?;
        let others: Vec<usize> =
            things.into_iter().filter(|&cell| self.cells[cell] != self.cells[one]).collect();
        let fit = |&cell: &usize| {
            self.is_in_place(self.cells[one], cell) && self.is_in_place(self.cells[cell], one)
        };
        let others: Vec<usize> = others.into_iter().filter(fit).collect();
        self.exchange(one, pick(&others, sampler)?);
        Some(())
    }

    /// Moves the avatar's start. An avatar that moves along a line stays on its line.
    fn restart(&mut self, sampler: &mut Sampler) -> Option<()> {
        let avatar = self.avatar().filter(|&cell| self.is_editable(cell))?;
        let steering = self.levels.analysis.start_avatar().map(|avatar| avatar.steering);
        let grid = self.grid;
        let cells = self.cells_where(|draft, cell| {
            let on_line = match steering {
                Some(Steering::Horizontal) => grid.y(cell) == grid.y(avatar),
                Some(Steering::Vertical) => grid.x(cell) == grid.x(avatar),
                _ => true,
            };
            on_line && draft.is_ground(cell)
        });
        self.exchange(avatar, pick(&cells, sampler)?);
        Some(())
    }

    /// Changes a cell accepted by `wanted` from wall to ground, or vice versa. If the walls are symmetric, also changes
    /// the cell's mirror image.
    fn toggle(&mut self, sampler: &mut Sampler, wanted: impl Fn(&Self, usize) -> bool) -> Option<()> {
        let wall = self.levels.palette.wall?;
        let symmetry = self.symmetry();
        let cell = pick(&self.cells_where(wanted), sampler)?;
        let opens = self.is_wall(cell);
        for cell in self.images(symmetry, cell) {
            if opens {
                self.clear(cell);
            } else if self.is_ground(cell) {
                self.cells[cell] = wall;
            } else if !self.is_wall(cell) {
                return None;
            }
        }
        Some(())
    }

    /// Returns a cell and its mirror image.
    fn images(&self, symmetry: Option<Symmetry>, cell: usize) -> Vec<usize> {
        let mut cells = vec![cell];
        let image = symmetry.map(|symmetry| symmetry.image(self.grid, cell));
        cells.extend(image.filter(|&image| image != cell && self.is_editable(image)));
        cells
    }

    /// Returns the walls' symmetry; `None` if there are too few walls to determine it.
    fn symmetry(&self) -> Option<Symmetry> {
        let inner = self.cells_where(Draft::is_wall).len();
        let holds = |symmetry: &Symmetry| {
            (0..self.grid.len())
                .all(|cell| self.is_wall(cell) == self.is_wall(symmetry.image(self.grid, cell)))
        };
        Symmetry::ALL.into_iter().find(holds).filter(|_| inner >= 4)
    }

    /// Returns `true` if a cell is ground ahead of the end of a line, with free cells at its sides.
    fn extends(&self, cell: usize) -> bool {
        self.is_ground(cell) && self.walls_beside(cell).iter().filter(|&&wall| wall).count() == 1
    }

    /// Returns `true` if a cell is the end of a line or an isolated block.
    fn is_end(&self, cell: usize) -> bool {
        self.is_wall(cell) && self.walls_beside(cell).iter().filter(|&&wall| wall).count() <= 1
    }

    fn shift(&mut self, sampler: &mut Sampler) -> Option<()> {
        let wall = self.levels.palette.wall?;
        let symmetry = self.symmetry();
        let cell = pick(&self.cells_where(Draft::is_wall), sampler)?;
        let (dx, dy) = *sampler.choose(&WAYS);
        // Collect the line in both directions from the cell, and then move it sideways.
        let mut line = vec![cell];
        for along in [(dy, dx), (-dy, -dx)] {
            let mut next = self.grid.shift(cell, along);
            while let Some(at) = next.filter(|&at| self.is_editable(at) && self.is_wall(at)) {
                line.push(at);
                next = self.grid.shift(at, along);
            }
        }
        if line.len() > SEGMENT {
            return None;
        }
        let images: Vec<usize> = line.iter().flat_map(|&cell| self.images(symmetry, cell)).collect();
        let mut targets = Vec::new();
        for &cell in &line {
            let to = self.grid.shift(cell, (dx, dy))?;
            targets.extend(self.images(symmetry, to));
        }
        for &cell in &images {
            self.clear(cell);
        }
        if !targets.iter().all(|&cell| self.is_editable(cell) && self.is_ground(cell)) {
            return None;
        }
        targets.into_iter().for_each(|cell| self.cells[cell] = wall);
        self.open_ways();
        Some(())
    }

    fn mirror(&mut self, sampler: &mut Sampler) -> Option<()> {
        let wall = self.levels.palette.wall?;
        let symmetry = *sampler.choose(&Symmetry::ALL);
        let swapped = sampler.ratio(1, 2);
        let grid = self.grid;
        let copied = |cell: usize| {
            let first = match symmetry {
                Symmetry::LeftRight => 2 * grid.x(cell) + 1 < grid.columns,
                Symmetry::UpDown | Symmetry::Turn => 2 * grid.y(cell) + 1 < grid.rows,
            };
            first != swapped
        };
        for cell in (0..grid.len()).filter(|&cell| copied(cell)) {
            let image = symmetry.image(grid, cell);
            if image == cell || !self.is_editable(image) || copied(image) {
                continue;
            }
            match (self.is_wall(cell), self.kind(image)) {
                (true, SymbolUse::Ground) => self.cells[image] = wall,
                (false, SymbolUse::Wall) => self.clear(image),
                _ => {}
            }
        }
        self.open_ways();
        Some(())
    }

    fn regrow(&mut self, sampler: &mut Sampler) -> Option<()> {
        let wall = self.levels.palette.wall?;
        let grid = self.grid;
        let side = |length: usize, sampler: &mut Sampler| {
            let most = (length * 2 / 3).min(length.checked_sub(2)?);
            let size = (most >= PART).then(|| sampler.between(PART, most))?;
            Some((sampler.between(1, length - size - 1), size))
        };
        let (left, columns) = side(grid.columns, sampler)?;
        let (top, rows) = side(grid.rows, sampler)?;
        let part = Grid { columns, rows };
        let family = match self.levels.family(sampler) {
            Family::Maze => Family::Rooms,
            family => family,
        };
        let walls = layout::walls(family, part, false, 0.5, sampler);
        let at = |inner: usize| grid.at(left + part.x(inner), top + part.y(inner));
        let mut things = Vec::new();
        for (inner, &is_wall) in walls.iter().enumerate() {
            let cell = at(inner);
            match self.kind(cell) {
                SymbolUse::Avatar => continue,
                SymbolUse::Thing(_) if is_wall => {
                    things.push(self.cells[cell]);
                    self.cells[cell] = wall;
                }
                SymbolUse::Thing(_) => {}
                _ if is_wall => self.cells[cell] = wall,
                SymbolUse::Wall => self.clear(cell),
                SymbolUse::Ground => {}
            }
        }
        for thing in things {
            let free: Vec<usize> = (0..part.len()).map(at).filter(|&cell| self.is_ground(cell)).collect();
            let cell = pick(&free, sampler)?;
            self.cells[cell] = thing;
        }
        self.open_ways();
        Some(())
    }
}

/// Picks one of the options; `None` if there are no options.
pub(crate) fn pick<T: Copy>(options: &[T], sampler: &mut Sampler) -> Option<T> {
    if options.is_empty() { None } else { Some(*sampler.choose(options)) }
}
