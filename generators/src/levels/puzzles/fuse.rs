//! The row with a fuse above a level, which limits the time. A spark burns along the fuse to a keg.

/// The characters in a fuse's row.
pub(crate) struct FuseSymbols {
    pub(crate) spark: char,
    pub(crate) fuse: char,
    pub(crate) keg: char,
    pub(crate) wall: char,
}

/// Returns the row with a fuse of `cells` cells. The last cell contains the keg.
pub(crate) fn row(columns: usize, cells: usize, symbols: &FuseSymbols) -> String {
    let symbol = |column: usize| match column {
        0 => symbols.spark,
        _ if column < cells => symbols.fuse,
        _ if column == cells => symbols.keg,
        _ => symbols.wall,
    };
    (0..columns).map(symbol).collect::<String>() + "\n"
}
