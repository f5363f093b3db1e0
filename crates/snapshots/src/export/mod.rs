//! Exports a release for other tools, as a dataset or as plain game folders. A dataset has one row per level, as
//! JSON Lines or Parquet, and a dataset card for dataset hubs.
//!
//! Exporting the same release again produces identical bytes. Solutions are excluded by default.

mod columns;
mod item;
mod jsonl;
mod options;
mod page;
#[cfg(feature = "parquet")]
mod table;

pub use columns::{Column, ColumnKind, columns};
pub use options::{Export, Format, SPLIT};

use crate::released::Released;
use crate::twin::{self, TwinError};
use forge::card::Card;
use item::{ExportedGame, Item};
use page::Rows;
use rayon::prelude::*;
use serde_json::Value;

/// The result of an export.
#[derive(Debug)]
pub struct Exported {
    /// The files, as pairs of path and content.
    pub files: Vec<(String, Vec<u8>)>,
    /// The number of exported games.
    pub games: usize,
    /// The number of exported levels.
    pub levels: usize,
    /// The folders of games that cannot be changed into the requested kind of twin, with the reasons.
    pub left_out: Vec<(String, TwinError)>,
}

/// A reason why a release cannot be exported.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// The Parquet library failed.
    #[cfg(feature = "parquet")]
    #[error("the table cannot be written as Parquet: use --format jsonl")]
    Parquet(#[from] parquet::errors::ParquetError),
    /// No game can be changed into the requested kind of twin.
    #[error("no game of the release has this kind of twin: {}", .0.first().map_or_else(String::new, |(_, why)| why.to_string()))]
    NoTwin(Vec<(String, TwinError)>),
    /// Solutions were requested, but the release withholds them.
    #[error(
        "`{0}` is sealed, and its solutions are withheld: omit --solutions, or reveal it first with `arcade release \
         PUBLIC --reveal HELD --out DIR`"
    )]
    Held(String),
}

/// Exports a release as rows with a dataset card, or as folders of games.
///
/// Cost: an analysis of each game and, for twins, their creation ([`twin::of_game`]).
///
/// # Errors
/// See [`ExportError`].
pub fn export(released: &Released, export: &Export) -> Result<Exported, ExportError> {
    let mut levels = released.games.iter().flat_map(|game| &game.levels);
    if export.solutions && levels.any(|level| level.witness.is_none()) {
        return Err(ExportError::Held(released.manifest.name.clone()));
    }
    let exported = |game| match export.twin {
        None => Ok(ExportedGame::own(game)),
        Some(twin) => twin::of_released(twin, game).and_then(ExportedGame::of_twin),
    };
    let exported: Vec<_> = released.games.par_iter().map(exported).collect();
    let (mut shown, mut left_out) = (Vec::new(), Vec::new());
    for (game, exported) in released.games.iter().zip(exported) {
        match exported {
            Ok(exported) => shown.push((&game.card, exported)),
            Err(why) => left_out.push((game.card.id.clone(), why)),
        }
    }
    if shown.is_empty() && !left_out.is_empty() {
        return Err(ExportError::NoTwin(left_out));
    }
    let columns = columns(export.solutions);
    let rows = || {
        let manifest = &released.manifest;
        let of_game = |&(card, ref exported): &(&Card, ExportedGame<'_>)| {
            let row = |number| {
                let item = Item { manifest, card, exported, number, twin: export.twin };
                columns.iter().map(|column| column.value(&item)).collect()
            };
            (0..exported.levels.len()).map(row).collect::<Vec<Vec<Value>>>()
        };
        shown.par_iter().flat_map_iter(of_game).collect::<Vec<Vec<Value>>>()
    };
    let bytes = match export.format {
        Format::JsonLines => jsonl::write(&columns, &rows()),
        #[cfg(feature = "parquet")]
        Format::Parquet => table::write(&columns, &rows(), &released.manifest.canary)?,
        Format::Games => Vec::new(),
    };
    let (games, levels) = (shown.len(), shown.iter().map(|(_, exported)| exported.levels.len()).sum());
    let files = match export.format {
        Format::Games => shown.iter().flat_map(|(card, exported)| folder(card, exported)).collect(),
        _ => {
            let file = format!("data/{SPLIT}.{}", export.format);
            let rows = Rows { file: &file, bytes: bytes.len(), games: &shown, levels };
            let page = page::page(released, export, &columns, &rows);
            vec![("README.md".to_owned(), page.into_bytes()), (file, bytes)]
        }
    };
    Ok(Exported { files, games, levels, left_out })
}

/// Returns a game's rules and levels as the files of one folder, which is the form that players and other tools read.
fn folder(card: &Card, exported: &ExportedGame<'_>) -> Vec<(String, Vec<u8>)> {
    let file = |name: String, text: &str| (format!("{}/{name}", card.id), text.as_bytes().to_vec());
    let levels = exported.levels.iter().enumerate();
    let levels = levels.map(|(number, level)| file(format!("lvl{number}.txt"), &level.text));
    std::iter::once(file("game.vgdl".to_owned(), &exported.source)).chain(levels).collect()
}
