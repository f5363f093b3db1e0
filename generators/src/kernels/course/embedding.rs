//! The embedding of a graph of rooms into a coarse grid, so that linked rooms share a border.

use super::cell::Cell;
use crate::kernels::file::map::Map;
use base::Sampler;

/// The number of embeddings to draw. The most compact embedding is used.
const DRAWS: usize = 48;
/// The maximum number of columns and rows that the rooms may occupy in the coarse grid.
const LARGEST: (i32, i32) = (4, 3);
/// The room sizes in the coarse grid. The most common size is listed several times. The other sizes are needed for
/// rings of three rooms.
const SIZES: [(i32, i32); 6] = [(1, 1), (1, 1), (1, 1), (1, 1), (2, 1), (1, 2)];

/// The rooms' rectangles on the board.
#[derive(Clone, Debug)]
pub(super) struct Embedding {
    pub(super) columns: usize,
    pub(super) rows: usize,
    /// The interiors of the rooms, without their borders.
    pub(super) rooms: Vec<Rectangle>,
}

/// A rectangle of cells, including its last column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Rectangle {
    pub(super) left: usize,
    pub(super) top: usize,
    pub(super) right: usize,
    pub(super) bottom: usize,
}

impl Rectangle {
    pub(super) fn width(self) -> usize {
        self.right + 1 - self.left
    }

    pub(super) fn height(self) -> usize {
        self.bottom + 1 - self.top
    }

    pub(super) fn cells(self) -> impl Iterator<Item = Cell> {
        (self.top..=self.bottom).flat_map(move |y| (self.left..=self.right).map(move |x| (x, y)))
    }

    pub(super) fn contains(self, (x, y): Cell) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }

    /// Returns the cells of the border between two rectangles.
    pub(super) fn border(self, other: Rectangle) -> Vec<Cell> {
        let (left, right) = (self.left.max(other.left), self.right.min(other.right));
        let (top, bottom) = (self.top.max(other.top), self.bottom.min(other.bottom));
        if self.right + 2 == other.left || other.right + 2 == self.left {
            let x = self.right.min(other.right) + 1;
            (top..=bottom).map(|y| (x, y)).collect()
        } else if self.bottom + 2 == other.top || other.bottom + 2 == self.top {
            let y = self.bottom.min(other.bottom) + 1;
            (left..=right).map(|x| (x, y)).collect()
        } else {
            Vec::new()
        }
    }
}

/// A rectangle in the coarse grid, given by its left, top, width and height.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Span {
    left: i32,
    top: i32,
    width: i32,
    height: i32,
}

impl Span {
    fn right(self) -> i32 {
        self.left + self.width
    }

    fn bottom(self) -> i32 {
        self.top + self.height
    }

    fn overlaps(self, other: Span) -> bool {
        self.left < other.right()
            && other.left < self.right()
            && self.top < other.bottom()
            && other.top < self.bottom()
    }

    /// Returns `true` if the two spans share at least one unit of an edge.
    fn touches(self, other: Span) -> bool {
        let beside = self.right() == other.left || other.right() == self.left;
        let above = self.bottom() == other.top || other.bottom() == self.top;
        let same_rows = self.top < other.bottom() && other.top < self.bottom();
        let same_columns = self.left < other.right() && other.left < self.right();
        (beside && same_rows) || (above && same_columns)
    }
}

impl Embedding {
    /// Draws an embedding that gives every room at least its required width and height, on a board with about `wanted`
    /// columns per row.
    pub(super) fn draw(
        map: &Map,
        needs: &[(usize, usize)],
        largest: (usize, usize),
        wanted: f64,
        sampler: &mut Sampler,
    ) -> Option<Embedding> {
        let mut best: Option<(f64, Embedding)> = None;
        for _ in 0..DRAWS {
            let Some(mut spans) = spans(map, sampler) else { continue };
            grow(&mut spans, sampler);
            let embedding = Embedding::of(&spans, needs);
            if embedding.columns > largest.0 || embedding.rows > largest.1 {
                continue;
            }
            let all = (embedding.columns * embedding.rows) as f64;
            let used: usize = embedding.rooms.iter().map(|room| room.width() * room.height()).sum();
            // Prefer boards of about the requested shape, with little solid wall and no more floor than necessary.
            let shape = embedding.columns as f64 / embedding.rows as f64;
            let needed: usize = needs.iter().map(|(width, height)| width * height).sum();
            let waste = used as f64 / needed as f64;
            let score =
                used as f64 / all - (shape - wanted).abs() * 0.1 - waste * 0.15 + sampler.unit() * 0.15;
            if best.as_ref().is_none_or(|(best, _)| score > *best) {
                best = Some((score, embedding));
            }
        }
        best.map(|(_, embedding)| embedding)
    }

    /// Converts spans of the coarse grid to rectangles of cells.
    fn of(spans: &[Span], needs: &[(usize, usize)]) -> Embedding {
        let across: Vec<(i32, i32, usize)> =
            spans.iter().zip(needs).map(|(span, need)| (span.left, span.width, need.0)).collect();
        let down: Vec<(i32, i32, usize)> =
            spans.iter().zip(needs).map(|(span, need)| (span.top, span.height, need.1)).collect();
        let (columns, rows) = (Lines::of(&across), Lines::of(&down));
        let rooms = spans.iter().map(|span| Rectangle {
            left: columns.start(span.left),
            top: rows.start(span.top),
            right: columns.start(span.right()) - 2,
            bottom: rows.start(span.bottom()) - 2,
        });
        Embedding { columns: columns.length(), rows: rows.length(), rooms: rooms.collect() }
    }
}

/// The columns or rows of the coarse grid.
struct Lines {
    first: i32,
    sizes: Vec<usize>,
}

impl Lines {
    /// Finds the sizes of lines such that all needs are met. A need consists of a first line, a number of lines, and
    /// the number of cells that these lines must span.
    fn of(needs: &[(i32, i32, usize)]) -> Lines {
        let first = needs.iter().map(|need| need.0).min().unwrap_or(0);
        let last = needs.iter().map(|need| need.0 + need.1).max().unwrap_or(1);
        let mut sizes = vec![2; (last - first) as usize];
        let mut by_length = needs.to_vec();
        by_length.sort_by_key(|need| need.1);
        for (start, count, need) in by_length {
            let lines = &mut sizes[(start - first) as usize..(start - first + count) as usize];
            // The borders between the lines of a room belong to the room's floor.
            while lines.iter().sum::<usize>() + lines.len() - 1 < need {
                if let Some(least) = lines.iter_mut().min() {
                    *least += 1;
                }
            }
        }
        Lines { first, sizes }
    }

    /// Returns the first cell of a line, after its border.
    fn start(&self, line: i32) -> usize {
        1 + self.sizes[..(line - self.first) as usize].iter().map(|size| size + 1).sum::<usize>()
    }

    fn length(&self) -> usize {
        1 + self.sizes.iter().map(|size| size + 1).sum::<usize>()
    }
}

/// Draws a span for each room such that linked rooms share a border; `None` if the draw fails.
fn spans(map: &Map, sampler: &mut Sampler) -> Option<Vec<Span>> {
    let mut spans: Vec<Option<Span>> = vec![None; map.rooms.len()];
    let (width, height) = size(map, 0, sampler);
    *spans.first_mut()? = Some(Span { left: 0, top: 0, width, height });
    for _ in 1..map.rooms.len() {
        // The next room is linked to a room that already has a span.
        let linked = |room: usize| -> Vec<Span> {
            map.links.iter().filter_map(|link| spans[link.from(room)?]).collect()
        };
        let next: Vec<usize> =
            (0..map.rooms.len()).filter(|&room| spans[room].is_none() && !linked(room).is_empty()).collect();
        let room = *next.get(sampler.below(next.len().max(1)))?;
        let linked = linked(room);
        let placed: Vec<Span> = spans.iter().flatten().copied().collect();
        let (width, height) = size(map, room, sampler);
        let around = |span: &Span| {
            let (lefts, tops) = (span.left - width..=span.right(), span.top - height..=span.bottom());
            lefts
                .flat_map(move |left| tops.clone().map(move |top| Span { left, top, width, height }))
                .collect::<Vec<_>>()
        };
        let fits = |span: &Span| {
            let all = || placed.iter().chain([span]);
            let columns = all().map(|span| span.right()).max()? - all().map(|span| span.left).min()?;
            let rows = all().map(|span| span.bottom()).max()? - all().map(|span| span.top).min()?;
            let free = !placed.iter().any(|other| other.overlaps(*span));
            let beside = linked.iter().all(|other| other.touches(*span));
            (free && beside && columns <= LARGEST.0 && rows <= LARGEST.1).then_some(())
        };
        let free: Vec<Span> = around(&linked[0]).into_iter().filter(|span| fits(span).is_some()).collect();
        if free.is_empty() {
            return None;
        }
        spans[room] = Some(*sampler.choose(&free));
    }
    spans.into_iter().collect()
}

/// Draws a room's size in the coarse grid. Rooms with a drawn piece are often large, so that several rooms fit along
/// one side.
fn size(map: &Map, room: usize, sampler: &mut Sampler) -> (i32, i32) {
    match map.rooms[room].piece {
        Some(_) if sampler.ratio(1, 4) => (2, 2),
        _ => *sampler.choose(&SIZES),
    }
}

/// Extends rooms into adjacent unused parts of the coarse grid, provided that the rooms remain rectangles.
fn grow(spans: &mut [Span], sampler: &mut Sampler) {
    let columns = (spans.iter().map(|span| span.left).min(), spans.iter().map(|span| span.right()).max());
    let rows = (spans.iter().map(|span| span.top).min(), spans.iter().map(|span| span.bottom()).max());
    let mut order: Vec<usize> = (0..spans.len()).collect();
    sampler.shuffle(&mut order);
    for room in order {
        let span = spans[room];
        let grown = [
            Span { left: span.left - 1, width: span.width + 1, ..span },
            Span { width: span.width + 1, ..span },
            Span { top: span.top - 1, height: span.height + 1, ..span },
            Span { height: span.height + 1, ..span },
        ];
        let fits = |grown: &&Span| {
            let within = Some(grown.left) >= columns.0
                && Some(grown.right()) <= columns.1
                && Some(grown.top) >= rows.0
                && Some(grown.bottom()) <= rows.1;
            within && spans.iter().enumerate().all(|(other, span)| other == room || !span.overlaps(**grown))
        };
        if let Some(grown) = grown.iter().find(fits) {
            spans[room] = *grown;
        }
    }
}
