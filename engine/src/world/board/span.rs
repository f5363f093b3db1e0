//! The few cells covered by a sprite no larger than a cell.

/// The cells that a small sprite covers within a square that is [`SPAN`] cells wide. There are at most four.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Span {
    /// The cell at the square's corner.
    cell: usize,
    stride: usize,
    /// One bit for each cell in the square, row by row.
    bits: u32,
}

/// The width of the square that contains two small sprites whose corners are in neighbouring cells.
const SPAN: u32 = 3;

impl Span {
    /// Returns the cell of a sprite's corner, and the cells to the right and below into which the sprite
    /// reaches.
    #[inline(always)]
    pub(crate) fn new(cell: usize, stride: usize, right: bool, below: bool) -> Span {
        Span { cell, stride, bits: (1 | u32::from(right) << 1) * (1 | u32::from(below) << SPAN) }
    }

    #[inline(always)]
    pub(crate) fn cells(self) -> impl Iterator<Item = usize> {
        let Span { cell, stride, mut bits } = self;
        std::iter::from_fn(move || {
            if bits == 0 {
                return None;
            }
            let at = bits.trailing_zeros();
            bits &= bits - 1;
            Some(cell + (at % SPAN) as usize + (at / SPAN) as usize * stride)
        })
    }

    /// Returns the cells that are only in this span, and the cells that are only in `other`. The corner of
    /// `other` is `columns` and `rows` away.
    #[inline(always)]
    pub(crate) fn apart(self, other: Span, columns: i32, rows: i32) -> (Span, Span) {
        if !(-1..2).contains(&columns) || !(-1..2).contains(&rows) {
            return (self, other);
        }
        // Both spans fit into one square, whose corner combines the smaller column and the smaller row of the
        // two corners.
        let back = |by: i32| by.min(0).unsigned_abs() as usize;
        let cell = self.cell - back(columns) - back(rows) * self.stride;
        let shift = |columns: i32, rows: i32| columns.max(0) as u32 + rows.max(0) as u32 * SPAN;
        let (mine, others) = (self.bits << shift(-columns, -rows), other.bits << shift(columns, rows));
        (Span { cell, bits: mine & !others, ..self }, Span { cell, bits: others & !mine, ..self })
    }

    /// Returns the number of columns by which a span created by [`Span::new`] extends to the right.
    pub(crate) fn right(self) -> i32 {
        i32::from(self.bits & 0b0010 != 0)
    }

    /// Returns the number of rows by which a span created by [`Span::new`] extends downwards.
    pub(crate) fn below(self) -> i32 {
        i32::from(self.bits & 1 << SPAN != 0)
    }
}

#[cfg(test)]
mod tests {
    use super::Span;

    #[test]
    fn span_differences_equal_those_of_lists_of_cells() {
        const STRIDE: usize = 7;
        let spans = || {
            let cells = (1..6).flat_map(|row| (1..6).map(move |column| (column, row)));
            cells.flat_map(|(column, row): (i32, i32)| {
                [(false, false), (true, false), (false, true), (true, true)].map(|(right, below)| {
                    let cell = row as usize * STRIDE + column as usize;
                    (Span::new(cell, STRIDE, right, below), column, row)
                })
            })
        };
        for ((one, x, y), (two, to_x, to_y)) in spans().flat_map(|one| spans().map(move |two| (one, two))) {
            let (gone, new) = one.apart(two, to_x - x, to_y - y);
            let list = |span: Span| span.cells().collect::<Vec<usize>>();
            let without = |span: Span, other: Span| {
                let other = list(other);
                list(span).into_iter().filter(|cell| !other.contains(cell)).collect::<Vec<usize>>()
            };
            assert_eq!((list(gone), list(new)), (without(one, two), without(two, one)), "{one:?} {two:?}");
        }
    }
}
