//! A release as a folder of static files. The files show the same page without the studio's server, from a disk or
//! any web server.
//!
//! The data files are scripts, because a page opened from `file://` can load only scripts. The release's
//! content cannot become code in these scripts, as [`script`] explains.

use crate::api::{CUT, game_of, release_of};
use crate::compiled::Compiled;
use crate::frames::{Frame, Frames, Tiles, action_name};
use crate::refusal::Refusal;
use crate::server::PAGE;
use crate::studio::Studio;
use crate::workspace::GameEntry;
use base::Seed;
use engine::Level;
use serde_json::{Value, json};

/// The tag after which the release data is loaded.
const APP: &str = "<script src=\"app.js\" defer></script>";

/// The reason why a gallery cannot be created.
#[derive(Debug, thiserror::Error)]
#[error("{0}")]
pub struct GalleryError(String);

impl From<Refusal> for GalleryError {
    fn from(refusal: Refusal) -> GalleryError {
        GalleryError(refusal.text())
    }
}

/// The gallery of the release that is open in a studio.
#[derive(Clone, Copy, Debug)]
pub struct Gallery<'a>(&'a Studio);

impl<'a> Gallery<'a> {
    /// Creates the gallery of the release that is open in `studio`.
    pub fn of(studio: &'a Studio) -> Gallery<'a> {
        Gallery(studio)
    }

    /// Returns the games' IDs, in the order in which the page lists the games.
    pub fn games(&self) -> Vec<String> {
        self.0.workspace.games().iter().map(|game| game.id.clone()).collect()
    }

    /// Returns the page's files and the release-wide data, each with its path.
    ///
    /// # Errors
    ///
    /// Returns an error if no release is open.
    pub fn page(&self) -> Result<Vec<(String, Vec<u8>)>, GalleryError> {
        let mut files = Vec::new();
        for file in PAGE.files() {
            let name = file.path().to_string_lossy().into_owned();
            let content = match name == "index.html" {
                true => {
                    let page = file.contents_utf8().unwrap_or_default();
                    let tag = format!("{APP}\n<script src=\"data/release.js\" defer></script>");
                    page.replace(APP, &tag).into_bytes()
                }
                false => file.contents().to_vec(),
            };
            files.push((name, content));
        }
        let release = release_of(self.0)?;
        files.push(("data/release.js".to_owned(), script("release", &release).into_bytes()));
        Ok(files)
    }

    /// Returns a game's file, with its path. The file contains the game's text, its levels, their boards, and
    /// every recorded win frame by frame. Cost: a replay of each win, with each tick drawn.
    ///
    /// # Errors
    ///
    /// Returns an error if the game does not exist or a board is too large to draw.
    pub fn game(&self, id: &str) -> Result<(String, Vec<u8>), GalleryError> {
        let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
        if id.is_empty() || !id.chars().all(plain) || id == "release" {
            return Err(GalleryError("the game's ID cannot be used as a file name".to_owned()));
        }
        let entry = self.0.workspace.game(id)?;
        let mut document = game_of(self.0, id)?;
        let (source, levels) = entry.read()?;
        let compiled = self.0.compiled.need(&source.text)?;
        let levels = levels
            .iter()
            .map(|level| compiled.level(&level.text))
            .collect::<Result<Vec<Level>, Refusal>>()?;
        let mut tiles = Tiles::default();
        let board = |level: &Level, tiles: &mut Tiles| {
            Frame::of(&compiled, &compiled.game.start(level, Seed::from_text("board")), 0, tiles)
        };
        let boards =
            levels.iter().map(|level| board(level, &mut tiles)).collect::<Result<Vec<Frame>, Refusal>>()?;
        document["witnesses"] = json!(witnesses(&entry, &compiled, &levels, &mut tiles)?);
        document["boards"] = json!(boards);
        document["tiles"] = json!(tiles.fresh());
        Ok((format!("data/{id}.js"), script(&format!("game/{id}"), &document).into_bytes()))
    }
}

fn witnesses(
    entry: &GameEntry,
    compiled: &Compiled,
    levels: &[Level],
    tiles: &mut Tiles,
) -> Result<Vec<Value>, Refusal> {
    let mut shown = Vec::new();
    for witness in &entry.witnesses {
        let Some(level) = levels.get(witness.level) else { continue };
        let mut state = compiled.game.start(level, witness.episode.seed);
        let mut frames = Frames::of_changes();
        frames.push(Frame::of(compiled, &state, 0, tiles)?);
        let mut actions = Vec::new();
        let mut note = None;
        for &action in &witness.episode.actions {
            compiled.game.step(&mut state, action);
            if !frames.push(Frame::of(compiled, &state, actions.len() + 1, tiles)?) {
                note = Some(CUT);
                break;
            }
            actions.push(action_name(action));
        }
        let frames = frames.finish();
        shown.push(
            json!({ "name": witness.name, "level": witness.level, "frames": frames, "actions": actions, "note": note }),
        );
    }
    Ok(shown)
}

/// Returns a script that passes data to the page. Characters that could end the script or a string in it are escaped,
/// so that data cannot become code.
fn script(name: &str, data: &Value) -> String {
    let plain = |value: &Value| {
        let mut text = String::new();
        for c in value.to_string().chars() {
            match c {
                '<' => text.push_str("\\u003c"),
                '>' => text.push_str("\\u003e"),
                '&' => text.push_str("\\u0026"),
                '\u{2028}' => text.push_str("\\u2028"),
                '\u{2029}' => text.push_str("\\u2029"),
                c => text.push(c),
            }
        }
        text
    };
    format!("arcadeGallery({}, {});\n", plain(&json!(name)), plain(data))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn data_stay_data() {
        let data = json!({ "title": "</script><script>alert(1)</script> & \u{2028}\u{2029} \"quoted\" \\" });
        let script = script("game/x", &data);
        for bad in ["<", ">", "&", "\u{2028}", "\u{2029}"] {
            assert!(!script.contains(bad), "{bad:?} in {script}");
        }
        let inner =
            script.strip_prefix("arcadeGallery(\"game/x\", ").and_then(|rest| rest.strip_suffix(");\n"));
        assert_eq!(serde_json::from_str::<Value>(inner.unwrap()).unwrap(), data);
    }

    #[test]
    fn the_page_has_the_tag_that_the_data_follow() {
        assert!(PAGE.get_file("index.html").unwrap().contents_utf8().unwrap().contains(APP));
    }
}
