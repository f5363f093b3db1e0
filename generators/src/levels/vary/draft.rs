//! A level being edited, with its characters, their uses, and the problems that an edit may have caused.

use crate::Generator;
use crate::levels::config::LevelConfig;
use crate::levels::construct::constructive::ConstructiveLevels;
use crate::levels::examples::is_cover;
use crate::levels::grid::{FAR, Grid, WAYS};
use crate::levels::palette::holds_avatar;
use base::{Sampler, Seed};
use engine::analysis::{Harm, Reason, Role, Steering};
use engine::{Level, SpriteType};
use std::collections::VecDeque;

/// The number of sample levels from which the normal numbers of characters are derived.
const SAMPLES: u64 = 16;
/// The minimum distance in cells between harmful sprites and the avatar's start.
const MIN_DISTANCE: usize = 3;
/// The size, in cells, below which an unreachable empty region is filled with walls.
const POCKET: usize = 4;

/// A level character's use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SymbolUse {
    /// Ground that can occur anywhere, such as the empty cell, floor or soil.
    Ground,
    /// An obstacle that always blocks the avatar.
    Wall,
    /// A character that places the avatar.
    Avatar,
    /// A character that places any other sprite, with the first of its roles.
    Thing(Role),
}

/// The uses of a game's characters, and the numbers in which they occur in levels.
#[derive(Clone, Debug)]
pub(crate) struct Vocabulary {
    /// Each character's use.
    kinds: Vec<SymbolUse>,
    /// For each character, `true` if its sprites are harmful or create harmful sprites.
    harmful: Vec<bool>,
    /// The minimum and maximum number of each character. The two are equal if all sample levels agree.
    bounds: Vec<(usize, usize)>,
    /// For each character, the range of its positions across the avatar's line of movement, in thousandths. Empty if
    /// the avatar is not bound to a line.
    bands: Vec<(usize, usize)>,
    /// The requested minimum and maximum fraction of cells that contain more than floor.
    cover: Option<(f64, f64)>,
}

impl Vocabulary {
    /// Derives the vocabulary from sample levels. Costs as much as generating 16 levels.
    pub(crate) fn of(levels: &ConstructiveLevels<'_>, config: &LevelConfig) -> Vocabulary {
        let (game, analysis, palette) = (levels.game, &levels.analysis, &levels.palette);
        let kind = |symbol: u8| {
            if holds_avatar(analysis, symbol) {
                return SymbolUse::Avatar;
            }
            let types = game.places(symbol).iter().filter(|stype| !palette.ground.contains(stype));
            match types.map(|&stype| analysis.role(stype)).min() {
                _ if palette.wall == Some(symbol) => SymbolUse::Wall,
                None | Some(Role::Soil | Role::Floor) => SymbolUse::Ground,
                Some(Role::Wall) => SymbolUse::Wall,
                Some(role) => SymbolUse::Thing(role),
            }
        };
        let harmful = |symbol: u8| {
            let types = || game.places(symbol).iter().copied();
            let harms = |stype: SpriteType| analysis.harm(stype) != Harm::None || analysis.makes_harm(stype);
            matches!(kind(symbol), SymbolUse::Thing(_)) && types().any(harms)
        };
        let mut bounds: Option<Vec<(usize, usize)>> = None;
        let steering = analysis.start_avatar().map(|avatar| avatar.steering);
        let mut bands = match steering {
            Some(Steering::Horizontal | Steering::Vertical) => vec![(usize::MAX, 0); 128],
            _ => Vec::new(),
        };
        let seed = Seed::from_text("usual numbers");
        for level in (0..SAMPLES).filter_map(|index| levels.generate(seed.child("level", index)).ok()) {
            let mut counts = vec![0; 128];
            let grid = Grid { columns: level.columns(), rows: level.rows() };
            for (cell, &symbol) in level.cells().iter().enumerate() {
                counts[usize::from(symbol)] += 1;
                if let Some((low, high)) = bands.get_mut(usize::from(symbol)) {
                    let place = across(levels, grid, cell);
                    (*low, *high) = ((*low).min(place), (*high).max(place));
                }
            }
            match &mut bounds {
                None => bounds = Some(counts.into_iter().map(|count| (count, count)).collect()),
                Some(bounds) => {
                    for ((low, high), count) in bounds.iter_mut().zip(counts) {
                        (*low, *high) = ((*low).min(count), (*high).max(count));
                    }
                }
            }
        }
        let mut bounds = bounds.unwrap_or_else(|| vec![(0, usize::MAX); 128]);
        for (low, high) in bounds.iter_mut().filter(|(low, high)| low < high) {
            (*low, *high) = (low.div_ceil(2), high.saturating_add(*high / 2));
        }
        for &(stype, count) in &config.counts {
            if let Some(symbol) = palette.symbol(stype) {
                bounds[usize::from(symbol)] = (count, count);
            }
        }
        Vocabulary {
            kinds: (0..128).map(kind).collect(),
            harmful: (0..128).map(harmful).collect(),
            bounds,
            bands,
            cover: config.cover,
        }
    }

    pub(crate) fn kind(&self, symbol: u8) -> SymbolUse {
        self.kinds[usize::from(symbol)]
    }

    /// Returns the minimum and maximum number of the given character.
    pub(crate) fn bounds(&self, symbol: u8) -> (usize, usize) {
        self.bounds[usize::from(symbol)]
    }

    /// Returns the characters of all other sprites ([`SymbolUse::Thing`]).
    pub(crate) fn things(&self) -> impl Iterator<Item = u8> + '_ {
        (b' '..=b'~').filter(|&symbol| matches!(self.kind(symbol), SymbolUse::Thing(_)))
    }
}

/// The problems of a level, as numbers. For each of them, 0 is the best value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Faults {
    /// The number of sprites by which the level deviates from the game's requirements or from the normal numbers.
    pub(crate) count_deviation: usize,
    /// The number of open cells that cannot be reached through open cells.
    pub(crate) stranded: usize,
    /// The total number of cells by which harmful sprites are too close to the avatar.
    pub(crate) crowded: usize,
    /// The number of isolated wall blocks, gates in the open, and sprites in unusual positions.
    pub(crate) misplaced: usize,
    /// The number of missing or excess cells that contain more than floor.
    pub(crate) cover_deviation: usize,
}

impl Faults {
    /// Returns `true` if every problem is at most as bad as in `other`.
    pub(crate) fn no_worse_than(&self, other: &Faults) -> bool {
        self.count_deviation <= other.count_deviation
            && self.stranded <= other.stranded
            && self.crowded <= other.crowded
            && self.misplaced <= other.misplaced
            && self.cover_deviation <= other.cover_deviation
    }

    /// Returns the worse of the two values for each problem.
    pub(crate) fn or(&self, other: &Faults) -> Faults {
        Faults {
            count_deviation: self.count_deviation.max(other.count_deviation),
            stranded: self.stranded.max(other.stranded),
            crowded: self.crowded.max(other.crowded),
            misplaced: self.misplaced.max(other.misplaced),
            cover_deviation: self.cover_deviation.max(other.cover_deviation),
        }
    }
}

/// A level being edited.
#[derive(Clone)]
pub(crate) struct Draft<'v> {
    pub(crate) levels: &'v ConstructiveLevels<'v>,
    pub(crate) vocabulary: &'v Vocabulary,
    pub(crate) grid: Grid,
    /// The characters in row-major order.
    pub(crate) cells: Vec<u8>,
    /// `true` if the whole border consists of walls, and must remain so.
    closed: bool,
}

impl<'v> Draft<'v> {
    pub(crate) fn of(
        levels: &'v ConstructiveLevels<'v>,
        vocabulary: &'v Vocabulary,
        level: &Level,
    ) -> Draft<'v> {
        let grid = Grid { columns: level.columns(), rows: level.rows() };
        let cells = level.cells().to_vec();
        let mut border = (0..grid.len()).filter(|&cell| grid.on_border(cell));
        let closed = border.all(|cell| vocabulary.kind(cells[cell]) == SymbolUse::Wall);
        Draft { levels, vocabulary, grid, cells, closed }
    }

    pub(crate) fn kind(&self, cell: usize) -> SymbolUse {
        self.vocabulary.kind(self.cells[cell])
    }

    pub(crate) fn is_wall(&self, cell: usize) -> bool {
        self.kind(cell) == SymbolUse::Wall
    }

    pub(crate) fn is_ground(&self, cell: usize) -> bool {
        self.kind(cell) == SymbolUse::Ground
    }

    /// Returns `true` if edits may change the cell. All cells except those of a closed border may be changed.
    pub(crate) fn is_editable(&self, cell: usize) -> bool {
        !(self.closed && self.grid.on_border(cell))
    }

    /// Returns the editable cells accepted by `wanted`.
    pub(crate) fn cells_where(&self, wanted: impl Fn(&Self, usize) -> bool) -> Vec<usize> {
        (0..self.grid.len()).filter(|&cell| self.is_editable(cell) && wanted(self, cell)).collect()
    }

    pub(crate) fn things(&self) -> Vec<usize> {
        self.cells_where(|draft, cell| matches!(draft.kind(cell), SymbolUse::Thing(_)))
    }

    pub(crate) fn avatar(&self) -> Option<usize> {
        (0..self.grid.len()).find(|&cell| self.kind(cell) == SymbolUse::Avatar)
    }

    /// Returns the number of cells that contain the given character.
    pub(crate) fn count(&self, symbol: u8) -> usize {
        self.cells.iter().filter(|&&other| other == symbol).count()
    }

    /// Returns the number of sprites of the given type in the level.
    fn sprites(&self, stype: SpriteType) -> usize {
        let places = self.cells.iter().flat_map(|&symbol| self.levels.game.places(symbol));
        places.filter(|&&placed| placed == stype).count()
    }

    /// Returns a ground character with which a cell can be cleared. If possible, it is the character of adjacent
    /// ground.
    pub(crate) fn ground_at(&self, cell: usize) -> u8 {
        let mut beside = self.grid.beside(cell).filter(|&next| self.is_ground(next));
        beside.next().map_or(self.levels.palette.base, |next| self.cells[next])
    }

    pub(crate) fn clear(&mut self, cell: usize) {
        self.cells[cell] = self.ground_at(cell);
    }

    /// Swaps the contents of two cells.
    pub(crate) fn exchange(&mut self, one: usize, two: usize) {
        self.cells.swap(one, two);
    }

    pub(crate) fn faults(&self) -> Faults {
        Faults {
            count_deviation: self.count_deviation(),
            stranded: self.stranded().len(),
            crowded: self.crowded(),
            misplaced: self.misplaced(),
            cover_deviation: self.cover_deviation(),
        }
    }

    fn count_deviation(&self) -> usize {
        let analysis = &self.levels.analysis;
        let mut count_deviation = 0;
        for requirement in analysis.requirements() {
            let asked = match requirement.reason {
                Reason::Avatar => false,
                Reason::Goal(_) | Reason::WinMethod(_) => true,
                Reason::Lock(stype) => {
                    matches!(analysis.role(stype), Role::Gate | Role::Exit) && self.sprites(stype) > 0
                }
                Reason::Portal(stype) => self.sprites(stype) > 0,
            };
            if asked {
                let count: usize = requirement.types.iter().map(|&stype| self.sprites(stype)).sum();
                count_deviation += (requirement.at_least as usize).saturating_sub(count);
                count_deviation += requirement.at_most.map_or(0, |most| count.saturating_sub(most as usize));
            }
        }
        count_deviation += self.pushables_without_target();
        let unusual = |symbol: u8| {
            let ((low, high), count) = (self.vocabulary.bounds(symbol), self.count(symbol));
            low.saturating_sub(count) + count.saturating_sub(high)
        };
        count_deviation + self.vocabulary.things().map(unusual).sum::<usize>()
    }

    /// Returns the number of pushable objects that must be removed and have no target.
    fn pushables_without_target(&self) -> usize {
        let analysis = &self.levels.analysis;
        let wanted = |stype: &SpriteType| analysis.aims().remove.contains(stype);
        let pushed = analysis.pushables().iter().filter(|pushable| wanted(&pushable.stype));
        let lacking = pushed.map(|pushable| {
            let merges = |partner: SpriteType| analysis.role(partner) == Role::Pushable;
            let endless = |sink: &&engine::analysis::Sink| !sink.fills || merges(sink.partner);
            if pushable.sinks.iter().filter(endless).any(|sink| self.sprites(sink.partner) > 0) {
                return 0;
            }
            let places: usize = pushable.sinks.iter().map(|sink| self.sprites(sink.partner)).sum();
            self.sprites(pushable.stype).saturating_sub(places)
        });
        lacking.sum()
    }

    /// Returns the open cells that the avatar cannot reach.
    fn stranded(&self) -> Vec<usize> {
        let Some(avatar) = self.avatar() else { return Vec::new() };
        let steps = self.grid.flood(&[avatar], |cell| !self.is_wall(cell));
        (0..self.grid.len()).filter(|&cell| steps[cell] == FAR && !self.is_wall(cell)).collect()
    }

    fn crowded(&self) -> usize {
        let Some(avatar) = self.avatar() else { return 0 };
        let harmful =
            (0..self.grid.len()).filter(|&cell| self.vocabulary.harmful[usize::from(self.cells[cell])]);
        harmful.map(|cell| MIN_DISTANCE.saturating_sub(self.grid.manhattan(cell, avatar))).sum()
    }

    fn misplaced(&self) -> usize {
        let lonely = |cell: usize| {
            let mut around = self.grid.around(cell).into_iter();
            around.all(|next| next.is_some_and(|next| !self.is_wall(next)))
        };
        let misplaced = |&cell: &usize| match self.kind(cell) {
            SymbolUse::Wall => lonely(cell),
            SymbolUse::Thing(_) => !self.is_in_place(self.cells[cell], cell),
            _ => false,
        };
        (0..self.grid.len()).filter(misplaced).count()
    }

    fn cover_deviation(&self) -> usize {
        let Some((low, high)) = self.vocabulary.cover else { return 0 };
        let covered = self.cells.iter().filter(|&&symbol| is_cover(&self.levels.analysis, symbol)).count();
        let at = |share: f64| share * self.grid.len() as f64;
        let over = (covered as f64 - at(high)).max(at(low) - covered as f64).max(0.0);
        over.ceil() as usize
    }

    /// Returns, for each side of a cell in [`WAYS`] order, `true` if there is a wall. Cells off the board count as
    /// walls.
    pub(crate) fn walls_beside(&self, cell: usize) -> [bool; 4] {
        WAYS.map(|way| self.grid.shift(cell, way).is_none_or(|next| self.is_wall(next)))
    }

    /// Returns `true` if a cell has walls on exactly two opposite sides.
    pub(crate) fn is_between(&self, cell: usize) -> bool {
        matches!(self.walls_beside(cell), [false, true, false, true] | [true, false, true, false])
    }

    /// Returns `true` if the given character belongs in the cell. Gates need walls on both sides. If the avatar moves
    /// along a line, every sprite keeps its normal distance from that line.
    pub(crate) fn is_in_place(&self, symbol: u8, cell: usize) -> bool {
        let gate = self.vocabulary.kind(symbol) == SymbolUse::Thing(Role::Gate);
        let place = || across(self.levels, self.grid, cell);
        let band = self.vocabulary.bands.get(usize::from(symbol));
        let in_band = band.is_none_or(|&(low, high)| low > high || (low..=high).contains(&place()));
        in_band && (!gate || self.is_between(cell))
    }

    /// Returns `true` if the cell is ground in which a character may be placed.
    pub(crate) fn suits(&self, symbol: u8, cell: usize) -> bool {
        self.is_ground(cell) && self.is_in_place(symbol, cell)
    }

    /// Connects unreachable regions by opening as few walls as possible, and fills small empty regions.
    pub(crate) fn open_ways(&mut self) {
        let Some(wall) = self.levels.palette.wall else { return };
        for _ in 0..self.grid.len() {
            let stranded = self.stranded();
            let Some(&first) = stranded.first() else { return };
            let region = self.grid.flood(&[first], |cell| !self.is_wall(cell));
            let region: Vec<usize> = stranded.into_iter().filter(|&cell| region[cell] != FAR).collect();
            let empty = region.iter().all(|&cell| self.is_ground(cell) && self.is_editable(cell));
            if empty && region.len() < POCKET {
                region.into_iter().for_each(|cell| self.cells[cell] = wall);
            } else if self.open_way(first).is_none() {
                return;
            }
        }
    }

    /// Connects the avatar and a cell by opening as few walls as possible.
    fn open_way(&mut self, to: usize) -> Option<()> {
        let avatar = self.avatar()?;
        let mut opened = vec![FAR; self.grid.len()];
        let mut before = vec![avatar; self.grid.len()];
        let mut queue = VecDeque::from([avatar]);
        opened[avatar] = 0;
        while let Some(cell) = queue.pop_front() {
            for next in self.grid.beside(cell) {
                let cost = u32::from(self.is_wall(next));
                let better = opened[cell] + cost < opened[next];
                if better && (cost == 0 || self.is_editable(next)) {
                    (opened[next], before[next]) = (opened[cell] + cost, cell);
                    if cost == 0 { queue.push_front(next) } else { queue.push_back(next) }
                }
            }
        }
        let mut cell = to;
        while opened[to] != FAR && cell != avatar {
            if self.is_wall(cell) {
                self.clear(cell);
            }
            cell = before[cell];
        }
        (opened[to] != FAR).then_some(())
    }

    /// Adds or removes sprites until their numbers are normal, as far as there is room.
    pub(crate) fn recount(&mut self, sampler: &mut Sampler) {
        for symbol in self.vocabulary.things() {
            let (low, high) = self.vocabulary.bounds(symbol);
            let mut count = self.count(symbol);
            while count < low || count > high {
                let surplus = count > high;
                let cells = self.cells_where(|draft, cell| {
                    if surplus { draft.cells[cell] == symbol } else { draft.suits(symbol, cell) }
                });
                if cells.is_empty() {
                    break;
                }
                let cell = *sampler.choose(&cells);
                if surplus {
                    self.clear(cell);
                    count -= 1;
                } else {
                    self.cells[cell] = symbol;
                    count += 1;
                }
            }
        }
    }

    /// Returns the level if it is valid and no termination holds at its start.
    pub(crate) fn level(&self) -> Option<Level> {
        let mut text = String::with_capacity(self.cells.len() + self.grid.rows);
        for row in self.cells.chunks(self.grid.columns) {
            text.extend(row.iter().map(|&symbol| char::from(symbol)));
            text.push('\n');
        }
        let level = self.levels.game.level(&text).ok()?;
        let state = self.levels.game.start(&level, Seed::from_text("draft"));
        self.levels.analysis.goal_met(&state).is_none().then_some(level)
    }
}

/// Returns the position of a cell across the avatar's line of movement, in thousandths of the board.
fn across(levels: &ConstructiveLevels<'_>, grid: Grid, cell: usize) -> usize {
    let steering = levels.analysis.start_avatar().map(|avatar| avatar.steering);
    let (place, length) = match steering {
        Some(Steering::Vertical) => (grid.x(cell), grid.columns),
        _ => (grid.y(cell), grid.rows),
    };
    place * 1000 / (length - 1).max(1)
}
