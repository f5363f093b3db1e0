//! The row above a level with a fuse, along which a spark burns to a keg.

/// The characters in the row of a fuse.
pub(crate) struct FuseSymbols {
    pub(crate) spark: char,
    pub(crate) fuse: char,
    pub(crate) keg: char,
    pub(crate) wall: char,
}

/// Returns the row for a fuse of `cells` cells. The last cell is the keg.
pub(crate) fn row(columns: usize, cells: usize, symbols: &FuseSymbols) -> String {
    let symbol = |column: usize| match column {
        0 => symbols.spark,
        _ if column < cells => symbols.fuse,
        _ if column == cells => symbols.keg,
        _ => symbols.wall,
    };
    (0..columns).map(symbol).collect::<String>() + "\n"
}
