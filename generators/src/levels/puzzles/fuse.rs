//! The row of a fuse above a level, along which a spark runs to a keg.

/// The characters of a fuse's row.
pub(crate) struct FuseSymbols {
    pub(crate) spark: char,
    pub(crate) fuse: char,
    pub(crate) keg: char,
    pub(crate) wall: char,
}

/// The row of a fuse of so many cells, the last of which is the keg.
pub(crate) fn row(columns: usize, cells: usize, symbols: &FuseSymbols) -> String {
    let symbol = |column: usize| match column {
        0 => symbols.spark,
        _ if column < cells => symbols.fuse,
        _ if column == cells => symbols.keg,
        _ => symbols.wall,
    };
    (0..columns).map(symbol).collect::<String>() + "\n"
}
