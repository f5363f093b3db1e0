//! States as frames: tiles, and the places where they are stamped, in cells.

use crate::compiled::Compiled;
use crate::refusal::Refusal;
use engine::{Action, Game, Outcome, State};
use render::{Looks, MAX_PIXELS, MIN_CELL, Picture, Style, Tile, picture, svg_tile};
use serde::Serialize;
use serde::ser::{SerializeTuple, Serializer};
use similar::{Algorithm, DiffOp, capture_diff_slices};

/// Pixels of a cell while frames are drawn; they decide only how thin lines are.
const CELL: u32 = 32;

/// A tile as the page gets it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TileSvg {
    id: String,
    svg: String,
}

/// The tiles of a game or session, each sent once.
#[derive(Default)]
pub(crate) struct Tiles {
    known: Vec<Tile>,
    sent: usize,
}

impl Tiles {
    /// Returns the number of a tile, which is new or known.
    pub(crate) fn number(&mut self, tile: &Tile) -> usize {
        self.known.iter().position(|known| known.shapes == tile.shapes).unwrap_or_else(|| {
            // Names of sprites stay out of the pictures: they are numbers and colours only.
            self.known.push(Tile { shapes: tile.shapes.clone(), name: None });
            self.known.len() - 1
        })
    }

    /// Returns the tiles that were not returned before.
    pub(crate) fn fresh(&mut self) -> Vec<TileSvg> {
        let first = std::mem::replace(&mut self.sent, self.known.len());
        let fresh = self.known.iter().enumerate().skip(first);
        fresh.map(|(at, tile)| TileSvg { id: format!("t{at}"), svg: whole(tile) }).collect()
    }
}

fn whole(tile: &Tile) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"64\" height=\"64\" viewBox=\"0 0 1 1\" preserveAspectRatio=\"none\">{}</svg>",
        svg_tile("t", tile).trim_end()
    )
}

/// A tile at a place: left, top, width and height in thousandths of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct Mark {
    tile: usize,
    place: [i32; 4],
}

impl Serialize for Mark {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(5)?;
        tuple.serialize_element(&self.tile)?;
        for part in self.place {
            // Whole numbers are the rule, and shorter without a point.
            match part % 1000 {
                0 => tuple.serialize_element(&(part / 1000))?,
                _ => tuple.serialize_element(&(f64::from(part) / 1000.0))?,
            }
        }
        tuple.end()
    }
}

/// A replaced stretch of marks: its place, the number of marks removed, the marks put there.
type Splice = (usize, usize, Vec<Mark>);

/// The board of a state, and what is said beside it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Frame {
    width: i32,
    height: i32,
    #[serde(skip_serializing_if = "Option::is_none")]
    marks: Option<Vec<Mark>>,
    /// The difference from the frame before, instead of the marks.
    #[serde(skip_serializing_if = "Option::is_none")]
    change: Option<Vec<Splice>>,
    caption: Vec<String>,
    tick: usize,
    score: f64,
    outcome: &'static str,
    actions: Vec<String>,
}

impl Frame {
    /// Draws a state after `tick` ticks. Cost: O(sprites log sprites + cells).
    pub(crate) fn of(
        compiled: &Compiled,
        state: &State,
        tick: usize,
        tiles: &mut Tiles,
    ) -> Result<Frame, Refusal> {
        Frame::with_looks(&compiled.looks, state, tick, tiles)
    }

    /// Draws a state with these looks.
    pub(crate) fn with_looks(
        looks: &Looks,
        state: &State,
        tick: usize,
        tiles: &mut Tiles,
    ) -> Result<Frame, Refusal> {
        let (width, height) = state.size();
        let cells = u64::from(width.unsigned_abs()) * u64::from(height.unsigned_abs());
        let cell = if cells * u64::from(CELL * CELL) <= MAX_PIXELS { CELL } else { MIN_CELL };
        let drawn = picture(looks, state, &Style::bare(cell)).map_err(Refusal::failed)?;
        Ok(Frame {
            width,
            height,
            marks: Some(marks(&drawn, cell, tiles)),
            change: None,
            caption: caption(looks, state),
            tick,
            score: state.score(),
            outcome: outcome(state.outcome()),
            actions: actions(looks.game(), state),
        })
    }
}

/// Replaces the marks of each frame but the first by the difference from the frame before. Cost: O(marks · changes).
pub(crate) fn as_changes(frames: &mut [Frame]) {
    let mut before: Option<Vec<Mark>> = None;
    for frame in frames {
        let Some(marks) = frame.marks.take() else { continue };
        match &before {
            None => frame.marks = Some(marks.clone()),
            Some(before) => frame.change = Some(change(before, &marks)),
        }
        before = Some(marks);
    }
}

/// The most marks of a list of frames that are sent as they are.
const PLAIN: usize = 200_000;

/// Writes a list of frames as changes if it is large.
pub(crate) fn shortened(mut frames: Vec<Frame>) -> Vec<Frame> {
    let marks: usize = frames.iter().map(|frame| frame.marks.as_ref().map_or(0, Vec::len)).sum();
    if marks > PLAIN {
        as_changes(&mut frames);
    }
    frames
}

fn change(from: &[Mark], to: &[Mark]) -> Vec<Splice> {
    let ops = capture_diff_slices(Algorithm::Myers, from, to);
    let changed = ops.iter().rev().filter(|op| !matches!(op, DiffOp::Equal { .. }));
    changed.map(|op| (op.old_range().start, op.old_range().len(), to[op.new_range()].to_vec())).collect()
}

fn marks(drawn: &Picture, cell: u32, tiles: &mut Tiles) -> Vec<Mark> {
    let here: Vec<usize> = drawn.tiles().iter().map(|tile| tiles.number(tile)).collect();
    let thousandths = |pixels: f32| (f64::from(pixels) * 1000.0 / f64::from(cell)).round() as i32;
    let mark = |stamp: &render::Stamp| {
        let render::Place { x, y, w, h } = stamp.place;
        Mark { tile: here[stamp.tile], place: [x, y, w, h].map(thousandths) }
    };
    drawn.stamps().iter().map(mark).collect()
}

/// Returns what the avatar holds, and the limit at which the game was stopped.
fn caption(looks: &Looks, state: &State) -> Vec<String> {
    let mut lines = Vec::new();
    if looks.has_holdings() {
        let held = render::holdings(looks, state);
        lines.push(if held.is_empty() { "holds nothing".to_owned() } else { format!("holds {held}") });
    }
    if let Outcome::Stopped(limit) = state.outcome() {
        lines.push(format!("stopped: {limit}"));
    }
    lines
}

/// Returns the word for an outcome.
pub(crate) fn outcome(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Ongoing => "playing",
        Outcome::Won => "won",
        Outcome::Lost => "lost",
        Outcome::Ended => "draw",
        Outcome::Stopped(_) => "stopped",
    }
}

fn actions(game: &Game, state: &State) -> Vec<String> {
    if state.is_over() {
        return Vec::new();
    }
    let real = game.actions(state).iter().filter(|action| **action != Action::Nil);
    real.map(|action| action_name(*action)).collect()
}

/// Returns the reference's name of an action.
pub(crate) fn action_name(action: Action) -> String {
    format!("ACTION_{}", action.name().to_ascii_uppercase())
}

/// Reads an action, by the reference's name or by ours.
pub(crate) fn action(name: &str) -> Result<Action, Refusal> {
    let ours = || Action::ALL.into_iter().find(|action| action.name() == name);
    Action::from_reference(name).or_else(ours).ok_or_else(|| {
        let names: Vec<String> = Action::ALL.into_iter().map(action_name).collect();
        Refusal::bad("there is no such action").help(format_args!("there are {}", names.join(", ")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_lead_from_frame_to_frame() {
        let mark = |tile, x| Mark { tile, place: [x, 0, 1000, 1000] };
        let boards = [
            vec![],
            vec![mark(0, 0), mark(1, 1000), mark(2, 500)],
            vec![mark(0, 0), mark(1, 2000), mark(2, 500), mark(3, 0)],
            vec![mark(3, 0)],
            vec![mark(3, 0)],
        ];
        for pair in boards.windows(2) {
            let mut marks = pair[0].clone();
            for (at, removed, new) in change(&pair[0], &pair[1]) {
                marks.splice(at..at + removed, new);
            }
            assert_eq!(marks, pair[1]);
        }
        assert!(change(&boards[3], &boards[4]).is_empty());
        assert_eq!(serde_json::to_string(&boards[1][2]).unwrap(), "[2,0.5,0,1,1]");
    }
}
