//! The games as pictures: each in the middle of a game.

use crate::failure::Failure;
use engine::{Analysis, Seed, State};
use forge::games::report::ReportedGame;
use render::{Looks, Picture, RenderError, Style, picture, png, sheet};

/// Games that are drawn at most; the tables tell of all.
const MOST: usize = 120;
/// Pixels of the longer side of a board, about.
const SIDE: u32 = 380;
/// Pictures in a row of the sheet.
const COLUMNS: usize = 4;
/// Pixels of a picture's place in the sheet.
const PLACE: u32 = 340;

/// The games as pictures.
pub(super) struct Frames {
    /// All in one picture with titles and goals, PNG.
    pub(super) sheet: Vec<u8>,
    /// Each by itself, in the order of the games; none of those past [`MOST`], or without a level.
    pub(super) each: Vec<Option<Frame>>,
}

/// A game as a picture.
pub(super) struct Frame {
    /// PNG.
    pub(super) png: Vec<u8>,
    /// Of the picture.
    pub(super) size: [u32; 2],
}

impl Frames {
    /// Draws a middle level of each game, halfway through the win that is known; in its first tick, if none is. Cost:
    /// O(pixels), and half an episode for each game.
    pub(super) fn draw(games: &[ReportedGame]) -> Result<Frames, Failure> {
        let mut entries = Vec::new();
        let mut each = Vec::new();
        for (at, game) in games.iter().enumerate() {
            let drawn = (at < MOST).then(|| drawn(game)).transpose()?.flatten();
            if let Some(picture) = &drawn {
                entries.push((picture.clone(), format!("{}\n{}", game.title, game.goal)));
            }
            each.push(drawn.map(|picture| Frame::of(&picture)).transpose()?);
        }
        let sheet = sheet(&entries, COLUMNS, PLACE).and_then(|sheet| png(&sheet)).map_err(failed)?;
        Ok(Frames { sheet, each })
    }
}

impl Frame {
    fn of(picture: &Picture) -> Result<Frame, Failure> {
        Ok(Frame { png: png(picture).map_err(failed)?, size: [picture.width(), picture.height()] })
    }
}

fn drawn(game: &ReportedGame) -> Result<Option<Picture>, Failure> {
    let Some((level, state)) = middle(game) else { return Ok(None) };
    let longest = u32::try_from(level.columns().max(level.rows())).unwrap_or(u32::MAX);
    let cell = (SIDE / longest.max(1)).clamp(8, 40);
    let looks = Looks::of(&Analysis::of(&game.game));
    picture(&looks, &state, &Style::bare(cell)).map(Some).map_err(failed)
}

/// A level with a known win, as near to the middle as there is, and its state halfway through; or else the middle level as it
/// begins.
fn middle(reported: &ReportedGame) -> Option<(&engine::Level, State)> {
    let ReportedGame { game, levels, report, .. } = reported;
    let half = levels.len() / 2;
    let won = |at: usize| Some((at, report.levels.get(at)?.witness.as_ref()?));
    let nearest = (0..levels.len()).filter_map(won).min_by_key(|(at, _)| at.abs_diff(half));
    let Some((at, witness)) = nearest else {
        let level = levels.get(half)?;
        return Some((level, game.start(level, Seed::from_text("picture"))));
    };
    let mut state = game.start(&levels[at], witness.seed);
    for &action in &witness.actions[..witness.actions.len() / 2] {
        game.step(&mut state, action);
    }
    Some((&levels[at], state))
}

fn failed(error: RenderError) -> Failure {
    Failure::environment(error, "the pictures of the games")
}
