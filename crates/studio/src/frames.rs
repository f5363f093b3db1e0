//! States as frames. A frame consists of tiles, and of the rectangles (in cells) into which the tiles are stamped.

use crate::compiled::Compiled;
use crate::refusal::Refusal;
use engine::{Action, Game, Outcome, State};
use render::{Looks, MAX_PIXELS, MIN_CELL, Picture, Style, Tile, picture, svg_tile};
use serde::Serialize;
use serde::ser::{SerializeTuple, Serializer};
use similar::{Algorithm, DiffOp, capture_diff_slices};

/// The cell size for drawing frames, in pixels. It affects only the thickness of thin lines.
const CELL: u32 = 32;

/// A tile in the page's format.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct TileSvg {
    id: String,
    svg: String,
}

/// The tiles of a game or a session. Each tile is sent only once.
#[derive(Default)]
pub(crate) struct Tiles {
    known: Vec<Tile>,
    sent: usize,
}

impl Tiles {
    /// Returns the index of a tile, adding the tile if it is new.
    pub(crate) fn number(&mut self, tile: &Tile) -> usize {
        self.known.iter().position(|known| known.shapes == tile.shapes).unwrap_or_else(|| {
            // Sprite names are kept out of the images, which consist only of numbers and colours.
            self.known.push(Tile { shapes: tile.shapes.clone(), name: None });
            self.known.len() - 1
        })
    }

    /// Returns the tiles that have not been returned before.
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

/// A tile in a rectangle given by its left edge, top edge, width and height in thousandths of a cell.
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
            // Most values are whole numbers, which are shorter when written without a decimal point.
            match part % 1000 {
                0 => tuple.serialize_element(&(part / 1000))?,
                _ => tuple.serialize_element(&(f64::from(part) / 1000.0))?,
            }
        }
        tuple.end()
    }
}

/// A change to a list of marks (placed tiles): the index of the change, the number of marks to remove there, and the
/// marks to insert.
type Splice = (usize, usize, Vec<Mark>);

/// A state's board, and the texts beside it.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Frame {
    width: i32,
    height: i32,
    #[serde(skip_serializing_if = "Option::is_none")]
    marks: Option<Vec<Mark>>,
    /// The difference from the previous frame, stored instead of the marks (placed tiles).
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

    /// Draws a state with the given looks, which determine the drawing of each type.
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

/// The maximum number of marks (placed tiles) in a list of frames sent without differences.
const PLAIN: usize = 200_000;
/// The maximum number of marks (placed tiles) in a list of frames.
const MOST: usize = 1_000_000;
/// The maximum length of each of two lists of marks (placed tiles) for which a minimal difference is computed. The cost
/// grows with the product of the lengths.
const COMPARED: usize = 4_000;

/// The frames of an episode. If there are few frames, they are stored unchanged. If there are many, they are
/// stored as differences between successive frames, so that neither memory nor responses grow with the
/// product of the board size and the number of ticks.
pub(crate) struct Frames {
    all: Vec<Frame>,
    last: Vec<Mark>,
    /// The number of marks (placed tiles) in the list.
    marks: usize,
    /// The number of marks (placed tiles) beyond which differences are stored.
    plain: usize,
}

impl Frames {
    /// Creates an empty list for a response.
    pub(crate) fn new() -> Frames {
        Frames { all: Vec::new(), last: Vec::new(), marks: 0, plain: PLAIN }
    }

    /// Creates an empty list for a file. All frames except the first are stored as differences.
    pub(crate) fn of_changes() -> Frames {
        Frames { plain: 0, ..Frames::new() }
    }

    /// Adds a frame. If the list is full, returns `false` and adds nothing. Cost: O(marks · changes).
    pub(crate) fn push(&mut self, mut frame: Frame) -> bool {
        let marks = frame.marks.take().unwrap_or_default();
        let change = (!self.all.is_empty() && self.marks + marks.len() > self.plain)
            .then(|| change(&self.last, &marks));
        let size = match &change {
            Some(change) => change.iter().map(|(_, _, new)| new.len() + 1).sum(),
            None => marks.len(),
        };
        if self.marks + size > MOST {
            return false;
        }
        self.marks += size;
        self.last.clone_from(&marks);
        frame.marks = change.is_none().then_some(marks);
        frame.change = change;
        self.all.push(frame);
        true
    }

    /// Returns the frames in the list.
    pub(crate) fn finish(self) -> Vec<Frame> {
        self.all
    }
}

/// Returns the splices that turn one frame's marks (placed tiles) into the next frame's, from the end to the beginning.
fn change(from: &[Mark], to: &[Mark]) -> Vec<Splice> {
    let same = |(a, b): &(&Mark, &Mark)| a == b;
    let start = from.iter().zip(to).take_while(same).count();
    let end = from[start..].iter().rev().zip(to[start..].iter().rev()).take_while(same).count();
    let (old, new) = (&from[start..from.len() - end], &to[start..to.len() - end]);
    let splice = |at: usize, removed: usize, new: &[Mark]| (start + at, removed, new.to_vec());
    if old.len().max(new.len()) <= COMPARED {
        let ops = capture_diff_slices(Algorithm::Myers, old, new);
        let changed = ops.iter().rev().filter(|op| !matches!(op, DiffOp::Equal { .. }));
        return changed
            .map(|op| splice(op.old_range().start, op.old_range().len(), &new[op.new_range()]))
            .collect();
    }
    if old.len() != new.len() {
        return vec![splice(0, old.len(), new)];
    }
    let differing: Vec<usize> = (0..old.len()).filter(|&at| old[at] != new[at]).collect();
    let runs = differing.chunk_by(|one, other| one + 1 == *other);
    let mut splices: Vec<Splice> =
        runs.map(|run| splice(run[0], run.len(), &new[run[0]..=run[run.len() - 1]])).collect();
    splices.reverse();
    splices
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

/// Returns the lines that show the avatar's resources. If the game was stopped, also returns a line that
/// states the exceeded limit.
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

/// Returns the page's word for an outcome.
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

/// Returns the reference's name for an action.
pub(crate) fn action_name(action: Action) -> String {
    format!("ACTION_{}", action.name().to_ascii_uppercase())
}

/// Parses an action's name, which may be the reference's or this suite's.
pub(crate) fn action(name: &str) -> Result<Action, Refusal> {
    let ours = || Action::ALL.into_iter().find(|action| action.name() == name);
    Action::from_reference(name).or_else(ours).ok_or_else(|| {
        let names: Vec<String> = Action::ALL.into_iter().map(action_name).collect();
        Refusal::bad("there is no such action").help(format_args!("the actions are {}", names.join(", ")))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mark(tile: usize, x: i32) -> Mark {
        Mark { tile, place: [x, 0, 1000, 1000] }
    }

    #[track_caller]
    fn check(from: &[Mark], to: &[Mark]) -> usize {
        let (mut marks, change) = (from.to_vec(), change(from, to));
        let size = change.iter().map(|(_, _, new)| new.len()).sum();
        for (at, removed, new) in change {
            marks.splice(at..at + removed, new);
        }
        assert_eq!(marks, to);
        size
    }

    #[test]
    fn changes_lead_from_frame_to_frame() {
        let boards = [
            vec![],
            vec![mark(0, 0), mark(1, 1000), mark(2, 500)],
            vec![mark(0, 0), mark(1, 2000), mark(2, 500), mark(3, 0)],
            vec![mark(3, 0)],
            vec![mark(3, 0)],
            vec![mark(3, 0), mark(3, 0), mark(3, 0)],
        ];
        for (from, to) in boards.iter().flat_map(|from| boards.iter().map(move |to| (from, to))) {
            check(from, to);
        }
        assert_eq!(serde_json::to_string(&boards[1][2]).unwrap(), "[2,0.5,0,1,1]");
    }

    #[test]
    fn large_boards_change_by_little() {
        let large: Vec<Mark> = (0..50_000).map(|at| mark(0, at)).collect();
        let mut moved = large.clone();
        for at in [7, 8, 20_000, 49_000] {
            moved[at].tile = 1;
        }
        assert_eq!(check(&large, &moved), 4);
        let mut shorter = moved.clone();
        shorter.remove(30_000);
        check(&large, &shorter);
        check(&shorter, &large);
    }

    #[test]
    fn lists_of_frames_have_bounds() {
        let frame = |shift: i32, count: i32| Frame {
            width: 1,
            height: 1,
            marks: Some((0..count).map(|at| mark(0, at + shift)).collect()),
            change: None,
            caption: Vec::new(),
            tick: 0,
            score: 0.0,
            outcome: "playing",
            actions: Vec::new(),
        };
        let (mut few, mut many) = (Frames::new(), Frames::new());
        assert!((0..10).all(|at| few.push(frame(at, 10))));
        assert!(few.finish().iter().all(|frame| frame.marks.is_some()));
        // Every mark (placed tile) in every frame is different, so the list fills up before the memory does.
        let pushed = (0..1000).take_while(|&at| many.push(frame(at * 50_000, 50_000))).count();
        let frames = many.finish();
        assert_eq!((frames.len(), pushed), (pushed, frames.len()));
        assert!((15..=20).contains(&pushed), "{pushed}");
        assert!(frames[0].marks.is_some() && frames[pushed - 1].change.is_some());
    }
}
