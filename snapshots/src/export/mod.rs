//! A release for other tools: a dataset with one row a level, as JSON Lines or Parquet, with a dataset card that hubs read; or
//! plain folders of games.
//!
//! The same release gives the same bytes. Solutions are left out unless asked for.

mod columns;
mod item;
mod jsonl;
mod page;
#[cfg(feature = "parquet")]
mod table;

pub use columns::{Column, Kind, Value, columns};

use crate::card::Card;
use crate::released::Released;
use crate::twin::{self, Twin, TwinError};
use item::{Dress, Item};
use page::Rows;
use rayon::prelude::*;
use std::fmt;

/// The one split. A release is there to evaluate with, and all of it: tools that find no split named take everything for
/// training data, and a division (by origin, by difficulty) is a column that whoever wants it filters by.
pub const SPLIT: &str = "test";

/// What the rows are written as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// An object a line.
    JsonLines,
    /// Apache Parquet.
    #[cfg(feature = "parquet")]
    Parquet,
    /// A folder for each game, with its rules and levels.
    Games,
}

impl fmt::Display for Format {
    /// As on the command line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Format::JsonLines => "jsonl",
            #[cfg(feature = "parquet")]
            Format::Parquet => "parquet",
            Format::Games => "games",
        })
    }
}

/// What is exported.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Export {
    /// As what.
    pub format: Format,
    /// With an episode that wins each level.
    pub solutions: bool,
    /// Which twin, if not the games themselves.
    pub twin: Option<Twin>,
}

/// What an export consists of.
#[derive(Debug)]
pub struct Exported {
    /// The files by path.
    pub files: Vec<(String, Vec<u8>)>,
    /// Games that are in it.
    pub games: usize,
    /// Levels of these.
    pub levels: usize,
    /// The folders of the games that have no such twin, and why.
    pub left_out: Vec<(String, TwinError)>,
}

/// Why there is no export.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The library that writes Parquet refuses.
    #[cfg(feature = "parquet")]
    #[error("the table cannot be written as Parquet: export it as jsonl")]
    Parquet(#[from] parquet::errors::ParquetError),
    /// No game has such a twin.
    #[error("no game of the release has such a twin: {}", .0.first().map_or_else(String::new, |(_, why)| why.to_string()))]
    NoTwin(Vec<(String, TwinError)>),
    /// Solutions are asked for, and the release has none to give.
    #[error(
        "`{0}` is sealed, and its solutions are held back: leave --solutions away, or reveal it first, as with `arcade release \
         PUBLIC --reveal HELD --out DIR`"
    )]
    Held(String),
}

/// Makes an export: rows with a dataset card, or folders of games. Cost: an analysis of each game; of a twin that of making it
/// ([`twin::of_game`](crate::twin::of_game)).
///
/// # Errors
/// See [`ExportError`].
pub fn export(released: &Released, export: &Export) -> Result<Exported, ExportError> {
    let mut levels = released.games.iter().flat_map(|game| &game.levels);
    if export.solutions && levels.any(|level| level.witness.is_none()) {
        return Err(ExportError::Held(released.manifest.name.clone()));
    }
    let dressed = |game| match export.twin {
        None => Ok(Dress::own(game)),
        Some(twin) => twin::of_released(twin, game).and_then(Dress::of_twin),
    };
    let dressed: Vec<_> = released.games.par_iter().map(dressed).collect();
    let (mut shown, mut left_out) = (Vec::new(), Vec::new());
    for (game, dress) in released.games.iter().zip(dressed) {
        match dress {
            Ok(dress) => shown.push((&game.card, dress)),
            Err(why) => left_out.push((game.card.id.clone(), why)),
        }
    }
    if shown.is_empty() && !left_out.is_empty() {
        return Err(ExportError::NoTwin(left_out));
    }
    let columns = columns(export.solutions);
    let rows = || {
        let manifest = &released.manifest;
        let of_game = |&(card, ref dress): &(&Card, Dress<'_>)| {
            let row = |number| {
                let item = Item { manifest, card, dress, number, twin: export.twin };
                columns.iter().map(|column| column.value(&item)).collect()
            };
            (0..dress.levels.len()).map(row).collect::<Vec<Vec<Value>>>()
        };
        shown.par_iter().flat_map_iter(of_game).collect::<Vec<Vec<Value>>>()
    };
    let bytes = match export.format {
        Format::JsonLines => jsonl::write(&columns, &rows()),
        #[cfg(feature = "parquet")]
        Format::Parquet => table::write(&columns, &rows(), &released.manifest.canary)?,
        Format::Games => Vec::new(),
    };
    let (games, levels) = (shown.len(), shown.iter().map(|(_, dress)| dress.levels.len()).sum());
    let files = match export.format {
        Format::Games => shown.iter().flat_map(|(card, dress)| folder(card, dress)).collect(),
        _ => {
            let file = format!("data/{SPLIT}.{}", export.format);
            let rows = Rows { file: &file, bytes: bytes.len(), games: &shown, levels };
            let page = page::page(released, export, &columns, &rows);
            vec![("README.md".to_owned(), page.into_bytes()), (file, bytes)]
        }
    };
    Ok(Exported { files, games, levels, left_out })
}

/// A game as players and other tools take it: rules and levels in a folder of their own.
fn folder(card: &Card, dress: &Dress<'_>) -> Vec<(String, Vec<u8>)> {
    let file = |name: String, text: &str| (format!("{}/{name}", card.id), text.as_bytes().to_vec());
    let levels = dress.levels.iter().enumerate();
    let levels = levels.map(|(number, level)| file(format!("lvl{number}.txt"), &level.text));
    std::iter::once(file("game.vgdl".to_owned(), &dress.source)).chain(levels).collect()
}
