//! Pools of designs: folders that `arcade design` writes, read as untrusted input.

use super::DesignsPart;
use base::Digest;
use base::MessagePath;
use base::canonical::canonical_digest;
use engine::Game;
use serde::Deserialize;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The maximum number of designs in a pool.
const MAX_DESIGNS: usize = 10_000;
/// The maximum number of levels of a design.
const MAX_LEVELS: usize = 20;
/// The maximum size of a file, in bytes.
const MAX_FILE: u64 = 1 << 20;

/// The accepted games of a run of `arcade design`, sorted by name.
#[derive(Clone, Debug, PartialEq)]
pub struct DesignPool {
    /// The designs.
    pub designs: Vec<Design>,
    /// The digest of the names and the files of all designs.
    pub digest: Digest,
}

/// A game with finished levels.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// The name of the game's folder.
    pub name: String,
    /// The content of `game.vgdl`.
    pub source: String,
    /// The contents of `lvl0.txt`, `lvl1.txt` and so on.
    pub levels: Vec<String>,
    /// The origin of the game, from `design.json`.
    pub provenance: Provenance,
}

/// The part of `design.json` that releases repeat.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Provenance {
    /// The designer, such as a model.
    pub designer: String,
    /// The digest of the settings of the run.
    pub settings: Digest,
    /// The number of the draft in the run.
    pub draft: u64,
    /// The digest of all answers.
    pub answers: Digest,
}

/// A folder that is not a pool.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PoolError {
    /// A folder or file cannot be read.
    #[error("{}: {source}", .path.in_message())]
    Io {
        /// The folder or file.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
    /// The folder contains no designs, or malformed ones. The list contains one line per problem, each with the file.
    #[error("{}", .0.join("\n"))]
    Malformed(Vec<String>),
}

impl DesignPool {
    /// Reads the accepted games in a folder that `arcade design` wrote. Files that a run did not write are ignored.
    /// Follows no links below the folder.
    ///
    /// # Errors
    /// Returns all problems with the designs, or the first failure to read the folder.
    pub fn read(folder: &Path) -> Result<DesignPool, PoolError> {
        let games = folder.join("games");
        let failed = |path: &Path| {
            let path = path.to_owned();
            move |source| PoolError::Io { path, source }
        };
        let entries = match fs::read_dir(&games) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                let help =
                    "there are no designs here; `arcade design --out DIR` writes designs to the folder DIR";
                return Err(PoolError::Malformed(vec![format!("{}: {help}", games.in_message())]));
            }
            entries => entries.map_err(failed(&games))?,
        };
        let mut names: Vec<String> = Vec::new();
        for entry in entries.take(MAX_DESIGNS + 1) {
            let entry = entry.map_err(failed(&games))?;
            // The entry's own type is examined, so a link is not a folder.
            if entry.file_type().map_err(failed(&games))?.is_dir() {
                names.extend(entry.file_name().into_string());
            }
        }
        names.sort_unstable();
        let mut problems = Vec::new();
        if names.len() > MAX_DESIGNS {
            problems.push(format!("{}: the limit is {MAX_DESIGNS} designs", games.in_message()));
        }
        let mut designs = Vec::new();
        for name in names.into_iter().take(MAX_DESIGNS) {
            designs.extend(Design::read(&games.join(&name), name, &mut problems));
        }
        if problems.is_empty() && designs.is_empty() {
            problems.push(format!("{}: the folder contains no accepted design", games.in_message()));
        }
        if !problems.is_empty() {
            return Err(PoolError::Malformed(problems));
        }
        let contents: Vec<_> = designs
            .iter()
            .map(|design| {
                let Provenance { designer, settings, draft, answers } = &design.provenance;
                (&design.name, &design.source, &design.levels, (designer, settings, draft, answers))
            })
            .collect();
        let digest = canonical_digest(&contents).expect("the designs are plain texts and numbers");
        Ok(DesignPool { designs, digest })
    }

    /// Returns the indices of the designs that have the requested number of levels.
    pub(crate) fn fitting(&self, part: &DesignsPart) -> Vec<usize> {
        let fits = |(_, design): &(usize, &Design)| design.levels.len() == part.levels as usize;
        self.designs.iter().enumerate().filter(fits).map(|(at, _)| at).collect()
    }
}

impl Design {
    /// Reads a design. Returns `None` if the folder has no rules, because `arcade design` writes the rules last, or if
    /// the design has problems, which are added to the list.
    fn read(folder: &Path, name: String, problems: &mut Vec<String>) -> Option<Design> {
        let before = problems.len();
        let mut text = |file: &str| match read_text(&folder.join(file)) {
            Ok(text) => text,
            Err(problem) => {
                problems.push(format!("{}: {problem}", folder.join(file).in_message()));
                None
            }
        };
        let source = text("game.vgdl");
        let levels: Vec<String> = (0..MAX_LEVELS).map_while(|at| text(&format!("lvl{at}.txt"))).collect();
        let provenance = text("design.json");
        let is_plain = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        if name.is_empty() || name.len() > 60 || !name.chars().all(is_plain) {
            let help = "a design's name has up to 60 letters, digits, `-` and `_`";
            problems.push(format!("{}: {help}", folder.in_message()));
        }
        let Some(source) = source else {
            // Other files without rules belong to an interrupted run.
            return None;
        };
        match Game::from_source(&source) {
            Ok(game) => {
                for (at, level) in levels.iter().enumerate() {
                    if let Err(found) = game.level(level) {
                        problems
                            .push(format!("{}: {found}", folder.join(format!("lvl{at}.txt")).in_message()));
                    }
                }
            }
            Err(found) => problems.push(format!("{}: {found}", folder.join("game.vgdl").in_message())),
        }
        if levels.is_empty() {
            problems.push(format!("{}: missing", folder.join("lvl0.txt").in_message()));
        }
        let file = folder.join("design.json");
        let provenance = match provenance.as_deref().map(serde_json::from_str) {
            Some(Ok(provenance)) => Some(provenance),
            Some(Err(error)) => {
                problems.push(format!("{}: {error}", file.in_message()));
                None
            }
            None => {
                problems.push(format!("{}: missing", file.in_message()));
                None
            }
        };
        let provenance = provenance.filter(|_| problems.len() == before)?;
        Some(Design { name, source, levels, provenance })
    }

    /// Returns the design's origin as the patterns of a card.
    pub(super) fn patterns(&self) -> Vec<String> {
        let Provenance { designer, settings, draft, answers } = &self.provenance;
        vec![
            format!("design/{}", self.name),
            format!("designer/{designer}"),
            format!("settings/{settings}"),
            format!("draft/{draft}"),
            format!("answers/{answers}"),
        ]
    }
}

/// Reads a text file without following links; `None` if it does not exist.
fn read_text(path: &Path) -> Result<Option<String>, String> {
    let bytes = match disk::read_no_follow(path, MAX_FILE) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        read => read.map_err(|error| error.to_string())?,
    };
    let bytes = bytes.ok_or_else(|| format!("the file is larger than {MAX_FILE} bytes"))?;
    String::from_utf8(bytes).map(Some).map_err(|_| "the file is not UTF-8 text".to_owned())
}
