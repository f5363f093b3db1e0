//! A flood fill from the sprites' positions over all cells that they can reach.

use super::cells::{Board, Cells, Directions};
use super::meetings::{End, Meeting, Order, With};
use super::mobility::is_stop;
use super::model::Model;
use crate::rules::SpriteType;
use crate::rules::effects::{Displacement, EffectSummary, Precondition, Side};

/// The maximum number of cells to examine. Beyond this limit, the result is coarse. Typical levels require
/// tens of thousands.
const BUDGET: u64 = 1 << 23;

/// The cells that sprites of a type can reach.
#[derive(Clone, Debug, Default)]
pub(super) struct Region {
    /// The cells that a sprite can overlap at some point in a tick.
    pub(super) touch: Cells,
    /// The cells in `touch` to which something other than a sprite's own update can move the sprite.
    late: Cells,
    /// The cells that a sprite can overlap between two ticks.
    pub(super) rest: Cells,
    /// The possible directions in each cell of `rest`, for types that keep their direction until something
    /// turns them.
    headings: Vec<Directions>,
    /// The cells in `rest` whose outgoing moves have all been followed or queued.
    spread: Cells,
    queue: Vec<usize>,
    /// `true` if the type is assumed to be everywhere.
    flooded: bool,
    /// The number of rows that a sprite can still rise from each cell, for types that fall and jump.
    rises: Vec<i32>,
    /// The region's version, which changes whenever the region changes.
    pub(super) version: u32,
}

/// A barrier: a type that keeps sprites of another type out of its cells or removes them there.
#[derive(Clone, Copy, Debug)]
struct Barrier {
    /// The type that forms the barrier, or `None` for the edge of the board.
    by: Option<SpriteType>,
    kills: bool,
    /// The first and last points in a tick at which the barrier keeps sprites out.
    first: Order,
    last: Order,
}

/// The state of the fixed point.
pub(super) struct Flood<'a> {
    pub(super) model: &'a Model<'a>,
    pub(super) board: Board,
    pub(super) regions: Vec<Region>,
    /// For each type, the cells that its sprites occupy from the start and, as far as is known, never leave.
    pub(super) permanent: Vec<Cells>,
    /// For each type, the cells where a sprite can be removed.
    pub(super) removable: Vec<Cells>,
    /// The number of times that sprites of some type became removable in additional cells.
    pub(super) ends: u64,
    /// For each type, whether its sprites can appear during an episode.
    pub(super) made: Vec<bool>,
    /// For each type, the barriers against its sprites.
    bars: Vec<Vec<Barrier>>,
    /// For each type, the other types for which its sprites are barriers.
    bars_to: Vec<Vec<SpriteType>>,
    /// For each type, whether its sprites may be removed in the middle of a tick. Until the end of the tick,
    /// other sprites still collide with removed ones.
    removed: Vec<bool>,
    /// The height of a jump in rows, for types that fall and jump.
    climbs: Vec<Option<i32>>,
    /// The number of cells examined so far.
    pub(super) work: u64,
}

impl<'a> Flood<'a> {
    pub(super) fn of(model: &'a Model<'a>) -> Flood<'a> {
        let board = model.board;
        let types = model.exists.len();
        let none = Cells::none(board);
        let [touch, late, rest, spread] = std::array::from_fn(|_| none.clone());
        let region = Region { touch, late, rest, spread, ..Region::default() };
        let for_each = |exists: &bool| if *exists { none.clone() } else { Cells::default() };
        let region_if = |exists: &bool| if *exists { region.clone() } else { Region::default() };
        let mut flood = Flood {
            model,
            board,
            regions: model.exists.iter().map(region_if).collect(),
            permanent: model.exists.iter().map(for_each).collect(),
            removable: model.exists.iter().map(for_each).collect(),
            ends: 0,
            made: vec![false; types],
            bars: vec![Vec::new(); types],
            bars_to: vec![Vec::new(); types],
            removed: vec![false; types],
            climbs: vec![None; types],
            work: 0,
        };
        for stype in model.types() {
            flood.removed[stype.index()] =
                crate::analysis::goals::attain::disappears_by_itself(model.rules, stype);
            let climb = super::jump::climb(model, stype);
            flood.climbs[stype.index()] = climb;
            if climb.is_some() {
                flood.regions[stype.index()].rises = vec![0; board.size()];
            }
            if model.of_type(stype).is_steady() {
                flood.regions[stype.index()].headings = vec![Directions::NONE; board.size()];
            }
        }
        let wraps = Flood::always_wraps(model);
        for meeting in model.meetings {
            flood.add_bars(meeting, &wraps);
            flood.note_removals(meeting);
        }
        flood
    }

    /// Records the types that a collision can remove. Killed avatars stay on the board.
    fn note_removals(&mut self, meeting: &Meeting<'_>) {
        for End { stype, for_good, .. } in meeting.ends(self.model.rules) {
            let avatar = self.model.info(stype).class.is_some_and(|class| class.is_avatar());
            self.removed[stype.index()] |= for_good || !avatar;
        }
    }

    /// Records the barriers that a collision creates.
    fn add_bars(&mut self, meeting: &Meeting<'_>, wraps: &[bool]) {
        let model = self.model;
        let (Some(one), summary) = (meeting.one, meeting.summary(model.rules)) else { return };
        if !meeting.certain || meeting.with == With::NoPartner {
            return;
        }
        let is_avatar = model.info(one).class.is_some_and(|class| class.is_avatar());
        let bar = |flood: &mut Flood<'_>, stype: SpriteType, by: Option<SpriteType>, kills: bool| {
            // A sprite that moves lets others pass sooner or later.
            if by.is_none_or(|by| flood.can_be_firm(by)) {
                flood.bar(stype, Barrier { by, kills, first: meeting.order, last: meeting.order });
            }
        };
        let own = model.of_type(one);
        if let Some(spare) = summary.undoes() {
            let undone = |stype: SpriteType| !spare.contains(&stype) && model.info(stype).order.is_some();
            if undone(one) {
                bar(self, one, meeting.two(), false);
            }
            if let Some(two) = meeting.two().filter(|&two| undone(two)) {
                bar(self, two, Some(one), false);
            }
            return;
        }
        let flush = matches!(summary.displacement, Some(Displacement::Flush | Displacement::Stop));
        let wraps_here = matches!(summary.displacement, Some(Displacement::OppositeEdge { .. }))
            && meeting.with == With::Edge
            && wraps[one.index()];
        let kills = summary.effects[..] == [EffectSummary::Kill(Side::First)]
            && summary.precondition == Precondition::Always;
        if wraps_here {
            bar(self, one, None, false);
        } else if kills && !is_avatar {
            bar(self, one, meeting.two(), true);
        } else if is_stop(meeting, summary) && !(flush && own.comes_from_far()) {
            // A sprite that can skip cells may stand in a third sprite's cell after it is placed flush with
            // its partner.
            bar(self, one, meeting.two(), false);
        }
    }

    fn bar(&mut self, stype: SpriteType, new: Barrier) {
        let bars = &mut self.bars[stype.index()];
        if let Some(bar) = bars.iter_mut().find(|bar| (bar.by, bar.kills) == (new.by, new.kills)) {
            (bar.first, bar.last) = (bar.first.min(new.first), bar.last.max(new.last));
            return;
        }
        bars.push(new);
        if let Some(by) = new.by {
            self.bars_to[by.index()].push(stype);
        }
    }

    /// Returns, for each type, whether its sprites always reappear at the opposite edge when they leave the
    /// board, because they only move straight ahead and nothing else moves them.
    fn always_wraps(model: &Model<'_>) -> Vec<bool> {
        let goes_ahead = |stype: SpriteType| {
            let own = model.of_type(stype);
            own.goes_ahead && !own.backwards && !own.facing.with(own.directions).meets(Directions::ASKEW)
        };
        let mut wraps: Vec<bool> =
            (0..model.exists.len()).map(|at| goes_ahead(SpriteType(at as u16))).collect();
        for meeting in model.meetings {
            let disturbs = match meeting.summary(model.rules).displacement {
                Some(Displacement::OppositeEdge { offset }) => !(0.0..=1.0).contains(&offset),
                Some(
                    Displacement::Pushed
                    | Displacement::Carried { .. }
                    | Displacement::OntoPartner
                    | Displacement::BackAndDown,
                ) => true,
                Some(
                    Displacement::Back
                    | Displacement::Flush
                    | Displacement::Stop
                    | Displacement::Apart
                    | Displacement::InLine
                    | Displacement::Exit,
                )
                | None => meeting.with == With::Edge,
            };
            match meeting.one {
                _ if meeting.with == With::NoPartner => wraps.fill(false),
                Some(one) if disturbs => wraps[one.index()] = false,
                _ => {}
            }
        }
        wraps
    }

    /// Returns `true` if sprites of the type, when placed by a level, fill their cells until something
    /// removes them.
    fn can_be_firm(&self, stype: SpriteType) -> bool {
        let info = self.model.info(stype);
        let traits = &info.traits;
        let singleton = info.path.iter().any(|&stype| self.model.info(stype).singleton);
        let whole = traits.width_factor == 1.0 && traits.height_factor == 1.0;
        let mortal = crate::analysis::goals::attain::disappears_by_itself(self.model.rules, stype);
        self.model.of_type(stype).fixed && whole && !singleton && !info.is_like_avatar() && !mortal
    }

    /// Adds a sprite placed by the level.
    pub(super) fn place(&mut self, stype: SpriteType, cell: usize) {
        if self.can_be_firm(stype) {
            self.permanent[stype.index()].insert(cell);
        }
        // A sprite larger than a cell extends to the right and down.
        let (columns, rows) = self.model.info(stype).traits.span();
        let (x, y) = self.board.place(cell);
        for y in y..y + rows as i32 {
            for x in x..x + columns as i32 {
                self.rest_at(stype, self.board.at(x, y), self.model.born(stype));
            }
        }
    }

    /// Returns the cells where a sprite of the type can be at the given point in a tick. If `first` is
    /// `true`, the sprite has not been removed in this tick. If `first` is `false`, the sprite may have been
    /// removed, in which case nothing stops it any longer.
    pub(super) fn present(&self, stype: SpriteType, at: Order, first: bool) -> Cells {
        let Region { touch, late, rest, .. } = &self.regions[stype.index()];
        let mut cells = touch.clone();
        let stopped = first || !self.removed[stype.index()];
        for bar in &self.bars[stype.index()] {
            if let (Some(by), true) = (bar.by, bar.first < at && stopped) {
                cells.drop_unless(&self.permanent[by.index()], [rest, late]);
            }
        }
        cells
    }

    /// Returns `true` if something keeps sprites of the type out of a cell after the given point in a tick,
    /// or removes them there.
    fn is_barred(&self, stype: SpriteType, cell: usize, after: Order, kills_only: bool) -> bool {
        let bars = self.bars[stype.index()].iter();
        bars.filter(|bar| bar.last > after && (bar.kills || !kills_only)).any(|bar| match bar.by {
            Some(by) => self.permanent[by.index()].contains(cell),
            None => self.board.is_ring(cell),
        })
    }

    /// Returns the types whose sprites permanently keep sprites of `stype` out of a cell, or remove them
    /// there.
    pub(super) fn barring(&self, stype: SpriteType, cell: usize) -> impl Iterator<Item = SpriteType> + '_ {
        let bars = self.bars[stype.index()].iter().filter_map(|bar| bar.by);
        bars.filter(move |by| self.permanent[by.index()].contains(cell))
    }

    /// Returns `true` if the work budget is exceeded.
    pub(super) fn is_over_budget(&self) -> bool {
        self.work > BUDGET
    }

    fn touch(&mut self, stype: SpriteType, cell: usize, at: Order) {
        self.work += 1 + self.bars[stype.index()].len() as u64 / 4;
        let region = &mut self.regions[stype.index()];
        region.version += u32::from(region.touch.insert(cell));
        if at > Order::UPDATE {
            region.version += u32::from(region.late.insert(cell));
        }
    }

    /// Adds a sprite that is in a cell between two ticks. `heading` contains the directions that it can have
    /// there, if sprites of its type keep their direction.
    fn rest_at(&mut self, stype: SpriteType, cell: usize, heading: Directions) {
        let region = &mut self.regions[stype.index()];
        let mut new = region.touch.insert(cell);
        new |= region.rest.insert(cell);
        let mut follow = region.spread.insert(cell);
        if let Some(known) = region.headings.get_mut(cell) {
            let turned = heading.without(*known) != Directions::NONE;
            *known = known.with(heading);
            (new, follow) = (new | turned, follow | turned);
        }
        region.version += u32::from(new);
        if follow {
            region.queue.push(cell);
        }
    }

    /// Turns sprites in the given cells between two ticks. `turn` maps the old directions to the new
    /// directions.
    pub(super) fn face(&mut self, stype: SpriteType, cells: &Cells, turn: impl Fn(Directions) -> Directions) {
        if self.regions[stype.index()].headings.is_empty() {
            return;
        }
        for cell in cells.shared(&self.regions[stype.index()].rest).iter() {
            let region = &self.regions[stype.index()];
            let heading = turn(region.headings[cell]);
            // A sprite that is about to be removed in its cell does not move on.
            if region.spread.contains(cell) {
                self.rest_at(stype, cell, heading);
            }
        }
    }

    /// Adds a sprite that enters a cell at the given point in a tick, facing one of the given directions.
    pub(super) fn come(&mut self, stype: SpriteType, cell: usize, at: Order, heading: Directions) {
        self.touch(stype, cell, at);
        if !self.is_barred(stype, cell, at, false) {
            self.rest_at(stype, cell, heading);
        }
    }

    /// Adds a sprite that appears in a cell at the given point in a tick, facing one of the given directions.
    pub(super) fn appear(&mut self, stype: SpriteType, cell: usize, at: Order, heading: Directions) {
        if !self.model.exists[stype.index()] {
            return;
        }
        if !std::mem::replace(&mut self.made[stype.index()], true) {
            self.regions[stype.index()].version += 1;
        }
        self.touch(stype, cell, at);
        let waits = self.model.of_type(stype).waits;
        if self.is_barred(stype, cell, at, true) && (waits || at > Order::UPDATE) {
            // The sprite is removed before the end of the tick.
            return;
        }
        if waits && self.is_barred(stype, cell, Order::UPDATE, true) {
            // The sprite does not move before it is removed in the next tick.
            let region = &mut self.regions[stype.index()];
            region.version += u32::from(region.rest.insert(cell));
            return;
        }
        self.rest_at(stype, cell, heading);
    }

    /// Records that sprites of the type can be removed in the given cells.
    pub(super) fn end(&mut self, stype: SpriteType, cells: &Cells) {
        if !self.model.exists[stype.index()] {
            return;
        }
        let at = stype.index();
        self.ends += u64::from(self.removable[at].add(cells));
        let opened = self.permanent[at].shared(cells);
        for cell in opened.iter() {
            self.permanent[at].remove(cell);
            for stype in self.bars_to[at].clone() {
                self.regions[stype.index()].version += 1;
                let region = &self.regions[stype.index()];
                let waiting = region.touch.contains(cell) && !region.spread.contains(cell);
                if waiting && !self.is_barred(stype, cell, Order::UPDATE, false) {
                    // It is unknown how the sprite got there, so assume a full jump.
                    if let Some(climb) = self.climbs[stype.index()] {
                        self.regions[stype.index()].rises[cell] = climb;
                    }
                    self.rest_at(stype, cell, self.model.of_type(stype).facing);
                }
            }
        }
    }

    /// Adds a falling and jumping sprite that enters a cell by its own movement. `rise` is the number of rows
    /// that the sprite can still rise from there, or `None` if the sprite only passes through.
    pub(super) fn rise_to(&mut self, stype: SpriteType, cell: usize, rise: Option<i32>, at: Order) {
        self.touch(stype, cell, Order::UPDATE);
        let Some(rise) = rise.filter(|_| !self.is_barred(stype, cell, at, false)) else { return };
        let region = &mut self.regions[stype.index()];
        if rise > region.rises[cell] {
            region.rises[cell] = rise;
            region.spread.remove(cell);
        }
        self.rest_at(stype, cell, Directions::NONE);
    }

    /// Adds the jumps of sprites on solid ground.
    fn ground(&mut self) {
        for stype in self.model.types() {
            let Some(climb) = self.climbs[stype.index()] else { continue };
            self.work += self.board.size() as u64;
            let footholds = self.footholds(stype);
            let stands = self.regions[stype.index()].rest.shared(&footholds);
            stands.iter().for_each(|cell| self.rise_to(stype, cell, Some(climb), Order::LAST));
        }
    }

    /// Follows all moves of all types.
    pub(super) fn spread(&mut self) {
        loop {
            self.ground();
            if !self.spread_once() || self.is_over_budget() {
                return;
            }
        }
    }

    /// Follows all queued moves. Returns `true` if any move was queued.
    fn spread_once(&mut self) -> bool {
        let mut any = false;
        for stype in self.model.types() {
            while let Some(cell) = self.regions[stype.index()].queue.pop() {
                self.follow(stype, cell);
                any = true;
                if self.is_over_budget() {
                    return false;
                }
            }
        }
        any
    }

    /// Adds the cells that a sprite can reach from its cell in its next update.
    fn follow(&mut self, stype: SpriteType, from: usize) {
        let own = *self.model.of_type(stype);
        let heading = self.regions[stype.index()].headings.get(from).copied();
        if own.boundless {
            if !std::mem::replace(&mut self.regions[stype.index()].flooded, true) {
                (0..self.board.size()).for_each(|cell| self.come(stype, cell, Order::UPDATE, own.facing));
            }
        } else if self.climbs[stype.index()].is_some() {
            let rise = self.regions[stype.index()].rises[from];
            self.leap(stype, from, rise);
        } else if own.directions.meets(Directions::ASKEW) {
            let (x, y) = self.board.place(from);
            for dy in -own.stride..=own.stride {
                for dx in -own.stride..=own.stride {
                    let cell = self.board.at(x + dx, y + dy);
                    if dx.abs().max(dy.abs()) <= own.leap + 1 {
                        self.come(stype, cell, Order::UPDATE, own.facing);
                    } else {
                        self.touch(stype, cell, Order::UPDATE);
                    }
                }
            }
        } else {
            let directions = heading.map_or(own.directions, |heading| {
                let back = if own.backwards { heading.mirrored() } else { Directions::NONE };
                heading.with(back).shared(own.directions)
            });
            for step in directions.steps() {
                // The sprite faces the direction of its move. If it can move backwards, it may also face the
                // opposite direction.
                let ahead =
                    if own.backwards { heading.unwrap_or(own.facing) } else { Directions::of_step(step) };
                self.go(stype, from, step, (own.stride, own.leap), (Order::UPDATE, ahead));
            }
        }
    }

    /// Moves a sprite in one direction by at most the given number of cells. The sprite then faces one of the
    /// given directions.
    pub(super) fn go(
        &mut self,
        stype: SpriteType,
        from: usize,
        step: (i32, i32),
        (stride, leap): (i32, i32),
        (at, heading): (Order, Directions),
    ) {
        for times in 1..=stride.max(leap + 1) {
            let cell = self.board.shifted(from, step, times);
            if times <= leap + 1 {
                self.come(stype, cell, at, heading);
            } else {
                self.touch(stype, cell, at);
            }
        }
    }
}
