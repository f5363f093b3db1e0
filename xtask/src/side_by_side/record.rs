//! Rows of games as lines of a CSV file.

use anyhow::Context;
use engine::Digest;
use forge::games::survey::{Edge, GameRow};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, OpenOptions};
use std::path::Path;

/// The row of a game as flat data: the columns of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Record {
    group: String,
    game: String,
    levels: u64,
    won: u64,
    rules: u64,
    executed: u64,
    types: u64,
    there: u64,
    strongest: Option<String>,
    wins: Option<u64>,
    plays: Option<u64>,
    floor: Option<String>,
    floor_wins: Option<u64>,
    points: Option<f64>,
    points_low: Option<f64>,
    points_high: Option<f64>,
    score: Option<f64>,
    score_low: Option<f64>,
    score_high: Option<f64>,
    pays: Option<bool>,
    order: Option<f64>,
    mechanics: Option<u64>,
    drama: Option<f64>,
    calls: u64,
    digest: Digest,
}

impl Record {
    pub(super) fn of(group: &str, row: &GameRow) -> Record {
        let edge = row.edge.as_ref();
        let scores = edge.and_then(|edge| edge.score_interval);
        Record {
            group: group.to_owned(),
            game: row.name.clone(),
            levels: row.levels,
            won: row.won,
            rules: row.rules,
            executed: row.executed,
            types: row.types,
            there: row.there,
            strongest: edge.map(|edge| edge.strongest.clone()),
            wins: edge.map(|edge| edge.wins),
            plays: edge.map(|edge| edge.plays),
            floor: edge.map(|edge| edge.floor.clone()),
            floor_wins: edge.map(|edge| edge.floor_wins),
            points: edge.map(|edge| edge.points),
            points_low: edge.map(|edge| edge.interval[0]),
            points_high: edge.map(|edge| edge.interval[1]),
            score: edge.and_then(|edge| edge.score),
            score_low: scores.map(|interval| interval[0]),
            score_high: scores.map(|interval| interval[1]),
            pays: edge.map(|edge| edge.pays),
            order: row.order,
            mechanics: row.mechanics,
            drama: row.drama,
            calls: row.calls,
            digest: row.digest,
        }
    }

    fn edge(&self) -> Option<Edge> {
        Some(Edge {
            strongest: self.strongest.clone()?,
            wins: self.wins?,
            plays: self.plays?,
            floor: self.floor.clone()?,
            floor_wins: self.floor_wins?,
            points: self.points?,
            interval: [self.points_low?, self.points_high?],
            score: self.score,
            score_interval: self.score_low.zip(self.score_high).map(|(low, high)| [low, high]),
            pays: self.pays?,
        })
    }

    fn row(self) -> GameRow {
        GameRow {
            edge: self.edge(),
            name: self.game,
            digest: self.digest,
            levels: self.levels,
            won: self.won,
            rules: self.rules,
            executed: self.executed,
            types: self.types,
            there: self.there,
            order: self.order,
            mechanics: self.mechanics,
            drama: self.drama,
            calls: self.calls,
        }
    }
}

impl fmt::Display for Record {
    /// Writes a line of progress.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<18} {} of {} won", self.game, self.won, self.levels)?;
        if let (Some(strongest), Some(wins), Some(plays), Some(floor), Some(lost)) =
            (&self.strongest, self.wins, self.plays, &self.floor, self.floor_wins)
        {
            let pays = if self.pays == Some(true) { "pays" } else { "" };
            write!(f, ", {strongest:>9} {wins:>2} {floor:>10} {lost:>2} of {plays:>2} {pays:<4}")?;
        }
        write!(f, ", rules {:>2} of {:>2}", self.executed, self.rules)?;
        write!(f, ", sprites {:>2} of {:>2}", self.there, self.types)?;
        for (name, value) in [("score", self.score), ("order", self.order), ("drama", self.drama)] {
            if let Some(value) = value {
                write!(f, ", {name} {value:.2}")?;
            }
        }
        write!(f, ", {:.1} million calls", self.calls as f64 / 1e6)
    }
}

/// The rows of a file, by the digest of their inputs; empty if the file does not exist.
pub(super) fn read(path: &Path) -> anyhow::Result<BTreeMap<Digest, GameRow>> {
    if !path.exists() {
        return Ok(BTreeMap::new());
    }
    let mut reader = csv::Reader::from_path(path).with_context(|| path.display().to_string())?;
    let rows = reader.deserialize::<Record>().map(|record| {
        let row = record.with_context(|| path.display().to_string())?.row();
        Ok((row.digest, row))
    });
    rows.collect()
}

/// Appends a line to a file, and the column names first if it is new.
pub(super) fn append(path: &Path, record: &Record) -> anyhow::Result<()> {
    let new = fs::metadata(path).map_or(true, |found| found.len() == 0);
    let file = OpenOptions::new().create(true).append(true).open(path);
    let file = file.with_context(|| path.display().to_string())?;
    let mut writer = csv::WriterBuilder::new().has_headers(new).from_writer(file);
    writer.serialize(record)?;
    writer.flush().with_context(|| path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_as_they_were_written() {
        let edge = Edge {
            strongest: "olets:200".to_owned(),
            wins: 20,
            plays: 24,
            floor: "random".to_owned(),
            floor_wins: 1,
            points: 19.0 / 24.0,
            interval: [0.55, 0.9],
            score: Some(0.1),
            score_interval: Some([-0.1, 0.3]),
            pays: true,
        };
        let known = GameRow {
            name: "a, b".to_owned(),
            digest: Digest::of(b"1"),
            levels: 3,
            won: 2,
            rules: 9,
            executed: 8,
            types: 7,
            there: 7,
            edge: Some(edge),
            order: Some(0.9),
            mechanics: Some(5),
            drama: Some(1.0 / 3.0),
            calls: 12,
        };
        let unknown = GameRow {
            digest: Digest::of(b"2"),
            edge: None,
            order: None,
            mechanics: None,
            drama: None,
            ..known.clone()
        };
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in [&known, &unknown] {
            writer.serialize(Record::of("ours", row)).unwrap();
        }
        let bytes = writer.into_inner().unwrap();
        let read: Vec<GameRow> = csv::Reader::from_reader(&bytes[..])
            .deserialize::<Record>()
            .map(|record| record.unwrap().row())
            .collect();
        assert_eq!(read, [known, unknown]);
    }
}
