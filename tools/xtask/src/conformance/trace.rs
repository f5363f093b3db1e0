//! The trace format `vgdl-trace/1`: a gzipped file of JSON lines with one episode.

use engine::{Action, Rect, SpriteRecord};
use flate2::read::GzDecoder;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;

/// The maximum size of a line, in bytes. The longest lines in real traces occupy several hundred kilobytes.
const MAX_LINE: u64 = 64 << 20;

#[derive(Deserialize)]
pub(crate) struct Header {
    format: String,
    pub(crate) game: String,
    pub(crate) level: u32,
    pub(crate) seed: i64,
    #[serde(default)]
    pub(crate) block_size: i32,
    #[serde(default)]
    pub(crate) width: i32,
    #[serde(default)]
    pub(crate) height: i32,
    #[serde(default)]
    pub(crate) types: Vec<String>,
    #[serde(default)]
    pub(crate) sprite_order: Vec<u16>,
    #[serde(default)]
    pub(crate) actions: Vec<String>,
    pub(crate) avatar: Option<u32>,
    #[serde(default)]
    pub(crate) log: Vec<String>,
    pub(crate) engine_error: Option<String>,
}

#[derive(Deserialize)]
struct Initial {
    sprites: Vec<Value>,
    rng: u64,
}

/// A tick as recorded in a trace.
#[derive(Deserialize)]
pub(crate) struct Line {
    pub(crate) tick: i32,
    action: String,
    pub(crate) score: Option<f64>,
    pub(crate) winner: Option<String>,
    #[serde(default)]
    pub(crate) ended: bool,
    #[serde(default)]
    pub(crate) rng: u64,
    pub(crate) avatar: Option<u32>,
    #[serde(default)]
    pub(crate) resources: BTreeMap<String, i32>,
    #[serde(default)]
    pub(crate) counters: Vec<i32>,
    #[serde(default)]
    add: Vec<Value>,
    #[serde(default)]
    pub(crate) del: Vec<u32>,
    #[serde(rename = "mod", default)]
    modified: Vec<Value>,
    /// A note, present if the reference ended the game because it had logged too many messages.
    pub(crate) note: Option<String>,
    pub(crate) engine_error: Option<String>,
}

/// A tick, with its action and its new or changed sprites.
pub(crate) struct Tick {
    pub(crate) line: Line,
    pub(crate) action: Action,
    pub(crate) changed: Vec<SpriteRecord>,
}

pub(crate) struct Trace {
    pub(crate) header: Header,
    pub(crate) sprites: Vec<SpriteRecord>,
    pub(crate) rng: u64,
    pub(crate) ticks: Vec<Tick>,
}

impl Trace {
    /// Reads a trace, which may be compressed with gzip or plain.
    ///
    /// # Errors
    ///
    /// Returns a message with the problem and its line.
    pub(crate) fn read(path: &Path) -> Result<Trace, String> {
        let file = File::open(path).map_err(|error| error.to_string())?;
        let packed = path.extension().is_some_and(|extension| extension == "gz");
        let reader: Box<dyn Read> = if packed { Box::new(GzDecoder::new(file)) } else { Box::new(file) };
        let mut lines = numbered(BufReader::new(reader));
        let header: Header = parse(lines.next())?;
        if header.format != "vgdl-trace/1" {
            return Err(format!("line 1: the format is `{}`, not `vgdl-trace/1`", header.format));
        }
        if header.engine_error.is_some() {
            return Ok(Trace { header, sprites: Vec::new(), rng: 0, ticks: Vec::new() });
        }
        let initial: Initial = parse(lines.next())?;
        let sprites = records(2, initial.sprites.iter())?;
        let mut ticks = Vec::new();
        for line in lines {
            let number = line.as_ref().map_or(0, |(number, _)| *number);
            let line: Line = parse(Some(line))?;
            let action = Action::from_reference(&line.action)
                .ok_or_else(|| format!("line {number}: no action named `{}`", line.action))?;
            let changed = records(number, line.add.iter().chain(&line.modified))?;
            ticks.push(Tick { line, action, changed });
        }
        Ok(Trace { header, sprites, rng: initial.rng, ticks })
    }
}

type NumberedLine = Result<(usize, String), String>;

/// Returns a reader's lines with their numbers. Lines longer than [`MAX_LINE`] are errors.
fn numbered(mut reader: impl BufRead) -> impl Iterator<Item = NumberedLine> {
    let mut number = 0;
    std::iter::from_fn(move || {
        number += 1;
        let mut line = String::new();
        match reader.by_ref().take(MAX_LINE).read_line(&mut line) {
            Ok(0) => None,
            Ok(_) if line.ends_with('\n') || (line.len() as u64) < MAX_LINE => Some(Ok((number, line))),
            Ok(_) => Some(Err(format!("line {number}: longer than {MAX_LINE} bytes"))),
            Err(error) => Some(Err(format!("line {number}: {error}"))),
        }
    })
}

fn parse<T: for<'a> Deserialize<'a>>(line: Option<NumberedLine>) -> Result<T, String> {
    let (number, text) = line.ok_or("the file ends before the record is complete")??;
    serde_json::from_str(&text).map_err(|error| format!("line {number}: {error}"))
}

fn records<'a>(line: usize, values: impl Iterator<Item = &'a Value>) -> Result<Vec<SpriteRecord>, String> {
    let wrong = |value| format!("line {line}: not a sprite record: {value}");
    values.map(|value| record(value).ok_or_else(|| wrong(value))).collect()
}

/// Parses a number. Values that JSON numbers cannot represent are given as strings.
fn double(value: &Value) -> Option<f64> {
    match value.as_str() {
        Some("NaN") => Some(f64::NAN),
        Some("Infinity") => Some(f64::INFINITY),
        Some("-Infinity") => Some(f64::NEG_INFINITY),
        _ => value.as_f64(),
    }
}

/// A sprite, recorded in the form `[id, type, x, y, w, h, ox, oy, speed, hp, flags]`. An object `{"res": …,
/// "rot": …}` may follow.
#[derive(Deserialize)]
struct Record(u32, u16, i32, i32, i32, i32, Value, Value, Value, i32, u16, #[serde(default)] Extra);

#[derive(Default, Deserialize)]
struct Extra {
    #[serde(default)]
    res: BTreeMap<String, i32>,
    rot: Option<Value>,
}

fn record(value: &Value) -> Option<SpriteRecord> {
    let Record(id, stype, x, y, w, h, ox, oy, speed, health, flags, extra) =
        Record::deserialize(value).ok()?;
    let (rect, orientation, speed) = (Rect { x, y, w, h }, (double(&ox)?, double(&oy)?), double(&speed)?);
    // The trace records an undeclared type as −1.
    let stype_of = |text: &str| if text == "-1" { Some(u16::MAX) } else { text.parse().ok() };
    let resources = extra.res.iter().map(|(held, &amount)| Some((stype_of(held)?, amount)));
    let mut resources = resources.collect::<Option<Vec<(u16, i32)>>>()?;
    resources.sort_unstable();
    let rotation = extra.rot.as_ref().map_or(Some(0.0), double)?;
    Some(SpriteRecord { id, stype, rect, orientation, speed, health, flags, resources, rotation })
}
