//! Recorded episodes specified by the user: files written by `arcade validate --witness` and `arcade play
//! --record`, and snapshot witnesses.

use crate::diagnostics::Named;
use crate::failure::Failure;
use crate::input::game_input::GameInput;
use crate::input::text::read_text;
use crate::whole_file;
use base::MessagePath;
use engine::{Episode, Game, Level};
use serde::Deserialize;
use snapshots::Witness;
use std::path::Path;

/// The maximum size of an episode file. The longest episodes use about 100 bytes per tick.
const MAX_EPISODE: usize = 1 << 22;

/// An episode, stored alone or as a snapshot's witness.
#[derive(Deserialize)]
#[serde(untagged)]
enum Recorded {
    Witness(Witness),
    Episode(Episode),
}

pub(crate) fn read(path: &Path) -> Result<Episode, Failure> {
    let text = read_text(path, MAX_EPISODE)?;
    match serde_json::from_str(&text) {
        Ok(Recorded::Witness(witness)) => Ok(witness.episode),
        Ok(Recorded::Episode(episode)) => Ok(episode),
        Err(_) => {
            // The untagged enum's error says only that no variant matches. The error for an episode is more
            // helpful.
            let error = serde_json::from_str::<Episode>(&text).err();
            let why = error.map_or(String::new(), |error| format!(" ({error})"));
            Err(malformed!(
                "{}: not an episode{why}; `arcade play --record FILE` and `arcade validate --witness FILE` write such files",
                path.in_message()
            ))
        }
    }
}

/// Rejects a path to which an episode cannot be written, before the work starts. Also rejects the paths of
/// the game, its levels and all `others`, which the command reads.
pub(crate) fn check(path: &Path, input: &GameInput, others: &[&str]) -> Result<(), Failure> {
    let others = others.iter().map(Path::new);
    whole_file::check(path, &input.files().into_iter().chain(others).collect::<Vec<_>>())
}

/// Writes an episode. The file is either complete or unchanged.
pub(crate) fn write(path: &Path, episode: &Episode) -> Result<(), Failure> {
    let text = serde_json::to_string(episode)
        .map_err(|error| Failure::environment(error, "the episode cannot be written as JSON"))?;
    whole_file::write(path, text.as_bytes())
}

/// Reads the recorded episode, if any, and finds the level to show. The episode must be replayable on that
/// level.
pub(crate) fn recorded(
    input: &GameInput,
    game: &Game,
    level_name: Option<&str>,
    file: Option<&Path>,
) -> Result<(Named, Level, Option<Episode>), Failure> {
    let episode = file.map(read).transpose()?;
    let (named, level) = level(input, game, level_name, episode.as_ref())?;
    if let (Some(path), Some(episode)) = (file, &episode) {
        episode.replay(game, &level).map_err(|error| {
            malformed!(
                "{}: {error}; pass the game and level that it was recorded on, or record it again",
                path.in_message()
            )
        })?;
    }
    Ok((named, level, episode))
}

/// Finds the level to show: the level specified by the user, else the level on which the episode was
/// recorded, else the first level.
fn level(
    input: &GameInput,
    game: &Game,
    name: Option<&str>,
    episode: Option<&Episode>,
) -> Result<(Named, Level), Failure> {
    let checked = |named: Named| {
        let level = named.level(game)?;
        Ok((named, level))
    };
    if let Some(name) = name {
        return checked(input.level(name)?);
    }
    let levels = input.levels()?;
    let count = levels.len();
    let Some(episode) = episode else {
        let first = levels.into_iter().next().ok_or_else(|| {
            let name = &input.source.name;
            malformed!("{name}: there are no levels next to the game; pass a level file after it")
        })?;
        return checked(first);
    };
    // The episode cannot have been recorded on a level with problems.
    let mut fitting = levels.into_iter().filter_map(|named| Some((game.level(&named.text).ok()?, named)));
    let found = fitting.find(|(level, _)| level.digest() == episode.level);
    found.map(|(level, named)| (named, level)).ok_or_else(|| {
        malformed!(
            "the episode was recorded on level {}, which is not one of the {count} levels of {}; pass the \
             level's file after the game",
            episode.level,
            input.title
        )
    })
}
