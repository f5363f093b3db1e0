//! The judgement record, with one line of JSON per judgement. Lines are appended and flushed.

use super::JudgingError;
use base::Digest;
use base::MessagePath;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Write};
use std::path::Path;

/// The maximum size of a record that can be read, in bytes.
const MOST_BYTES: u64 = 64 << 20;

/// The better game in a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Better {
    /// The game on the left is better.
    Left,
    /// The game on the right is better.
    Right,
    /// Neither game is better.
    Same,
}

/// The games in a pair to which a statement applies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Which {
    /// The statement applies to the game on the left.
    Left,
    /// The statement applies to the game on the right.
    Right,
    /// The statement applies to both games.
    Both,
    /// The statement applies to neither game.
    Neither,
}

impl Which {
    /// Returns `true` for each side to which the statement applies, in the order left, right.
    pub fn sides(self) -> [bool; 2] {
        [matches!(self, Which::Left | Which::Both), matches!(self, Which::Right | Which::Both)]
    }
}

/// The number of ticks played in each of the two games.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Played {
    /// The number of ticks played in the game on the left.
    pub left: u64,
    /// The number of ticks played in the game on the right.
    pub right: u64,
}

/// The games for which the judge has watched an episode played by a program.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Watched {
    /// `true` for the game on the left.
    pub left: bool,
    /// `true` for the game on the right.
    pub right: bool,
}

/// A game in a pair.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Side {
    /// The source's name.
    pub source: String,
    /// The game's name in the source.
    pub game: String,
    /// The game's digest.
    pub digest: Digest,
    /// The game's measures, by name.
    pub measures: BTreeMap<String, f64>,
}

/// A person's judgement of a pair.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// The text of the seed with which the pairs were drawn.
    pub seed: String,
    /// The index of the pair.
    pub pair: usize,
    /// The game on the left.
    pub left: Side,
    /// The game on the right.
    pub right: Side,
    /// The better game, according to the judge.
    pub better: Better,
    /// The games that the judge would play again.
    pub again: Which,
    /// The games that the judge believes were made by a machine, or `None` if the judge was not asked.
    #[serde(default)]
    pub machine: Option<Which>,
    /// The judge's comment.
    #[serde(default)]
    pub words: String,
    /// The number of ticks played in each game.
    #[serde(default)]
    pub played: Played,
    /// The games for which the judge has watched an episode.
    #[serde(default)]
    pub watched: Watched,
    /// `true` if the judge had already requested the report, so the judgement is not blind.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub after_report: bool,
}

/// The judgements in a record. For each pair, only the last judgement counts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Judgements(pub Vec<Judgement>);

impl Judgements {
    /// Reads a record. A truncated last line is omitted, with a warning.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be read, or if a complete line is not a judgement.
    pub fn read(file: &Path) -> Result<(Judgements, Vec<String>), JudgingError> {
        let bytes = disk::read_start(file, MOST_BYTES + 1).map_err(JudgingError::io("read", file))?;
        if bytes.len() as u64 > MOST_BYTES {
            let large = io::Error::other(format!("the file is larger than {MOST_BYTES} bytes"));
            return Err(JudgingError::io("read", file)(large));
        }
        let (judgements, _, remarks) = parse(&bytes, file)?;
        Ok((judgements, remarks))
    }

    fn add(&mut self, judgement: Judgement) {
        self.0.retain(|known| (&known.seed, known.pair) != (&judgement.seed, judgement.pair));
        self.0.push(judgement);
    }
}

/// Returns the judgements, the number of bytes in complete lines, and warnings.
fn parse(bytes: &[u8], file: &Path) -> Result<(Judgements, usize, Vec<String>), JudgingError> {
    let (mut judgements, mut sound) = (Judgements::default(), 0);
    for (number, line) in bytes.split_inclusive(|&byte| byte == b'\n').enumerate() {
        let is_whole = line.ends_with(b"\n");
        let text = line.trim_ascii();
        if text.is_empty() {
            sound += line.len();
            continue;
        }
        match serde_json::from_slice(text) {
            Ok(judgement) => judgements.add(judgement),
            Err(_) if !is_whole => {
                let remark = format!("{}: the last line was cut off and is ignored", file.in_message());
                return Ok((judgements, sound, vec![remark]));
            }
            Err(error) => {
                let (file, line) = (file.in_message().to_string(), number + 1);
                return Err(JudgingError::Line { file, line, why: error.to_string() });
            }
        }
        sound += line.len();
    }
    Ok((judgements, sound, Vec::new()))
}

/// A record to which judgements are appended.
#[derive(Debug)]
pub(super) struct Keeper {
    pub(super) judgements: Judgements,
    file: File,
    /// `true` if the last line does not end with a newline.
    open: bool,
}

impl Keeper {
    /// Opens a record, which may be new. A truncated last line is removed, with a warning.
    pub(super) fn open(path: &Path) -> Result<(Keeper, Vec<String>), JudgingError> {
        let file = disk::append_no_follow(path).map_err(JudgingError::io("open", path))?;
        let bytes = disk::start(&file, MOST_BYTES + 1).map_err(JudgingError::io("read", path))?;
        if bytes.len() as u64 > MOST_BYTES {
            let large = io::Error::other(format!("the file is larger than {MOST_BYTES} bytes"));
            return Err(JudgingError::io("read", path)(large));
        }
        let (judgements, sound, remarks) = parse(&bytes, path)?;
        if sound < bytes.len() {
            file.set_len(sound as u64).map_err(JudgingError::io("repair", path))?;
        }
        let open = sound > 0 && bytes[sound - 1] != b'\n';
        Ok((Keeper { judgements, file, open }, remarks))
    }

    /// Appends a judgement, and waits until it is on disk.
    pub(super) fn add(&mut self, judgement: Judgement) -> io::Result<()> {
        let mut line = serde_json::to_string(&judgement)?;
        if self.open {
            line.insert(0, '\n');
        }
        line.push('\n');
        // If this line is cut off, the next one still starts on a new line.
        self.open = true;
        self.file.write_all(line.as_bytes())?;
        self.file.sync_data()?;
        self.open = false;
        self.judgements.add(judgement);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn judgement(pair: usize, better: Better) -> Judgement {
        let side = |source: &str| Side {
            source: source.to_owned(),
            game: format!("{source}-game"),
            digest: Digest::of(source.as_bytes()),
            measures: BTreeMap::new(),
        };
        Judgement {
            seed: "seed".to_owned(),
            pair,
            left: side("a"),
            right: side("b"),
            better,
            again: Which::Both,
            machine: None,
            words: "two\nlines \u{2028} </script>".to_owned(),
            played: Played { left: 3, right: 4 },
            watched: Watched { left: true, right: false },
            after_report: false,
        }
    }

    #[test]
    fn judgements_are_kept_and_the_last_on_a_pair_counts() {
        let home = tempfile::tempdir().unwrap();
        let file = home.path().join("judged.jsonl");
        let (mut keeper, remarks) = Keeper::open(&file).unwrap();
        assert!(remarks.is_empty());
        for (pair, better) in [(0, Better::Left), (1, Better::Same), (0, Better::Right)] {
            keeper.add(judgement(pair, better)).unwrap();
        }
        drop(keeper);
        assert_eq!(fs::read_to_string(&file).unwrap().lines().count(), 3);
        let (read, _) = Judgements::read(&file).unwrap();
        assert_eq!(read.0, [judgement(1, Better::Same), judgement(0, Better::Right)]);
    }

    #[test]
    fn records_of_earlier_versions_are_read() {
        let home = tempfile::tempdir().unwrap();
        let file = home.path().join("judged.jsonl");
        let mut line = serde_json::to_value(judgement(0, Better::Left)).unwrap();
        for later in ["watched", "after_report"] {
            line.as_object_mut().unwrap().remove(later);
        }
        fs::write(&file, format!("{line}\n")).unwrap();
        let (read, remarks) = Judgements::read(&file).unwrap();
        let before = Judgement { watched: Watched::default(), ..judgement(0, Better::Left) };
        assert_eq!((read.0, remarks.len()), (vec![before], 0));
    }

    #[test]
    fn torn_lines_are_repaired() {
        let home = tempfile::tempdir().unwrap();
        let file = home.path().join("judged.jsonl");
        let whole = serde_json::to_string(&judgement(0, Better::Left)).unwrap();
        for cut in [1, whole.len() / 2, whole.len() - 1] {
            fs::write(&file, format!("{whole}\n{}", &whole[..cut])).unwrap();
            let (read, remarks) = Judgements::read(&file).unwrap();
            assert_eq!((read.0.len(), remarks.len()), (1, 1), "{cut}");
            let (mut keeper, remarks) = Keeper::open(&file).unwrap();
            assert_eq!(remarks.len(), 1);
            keeper.add(judgement(1, Better::Right)).unwrap();
            let (read, remarks) = Judgements::read(&file).unwrap();
            assert_eq!((read.0.len(), remarks.len()), (2, 0), "{cut}");
        }
        // Only the newline is missing.
        fs::write(&file, &whole).unwrap();
        let (mut keeper, remarks) = Keeper::open(&file).unwrap();
        assert!(remarks.is_empty());
        keeper.add(judgement(1, Better::Right)).unwrap();
        assert_eq!(Judgements::read(&file).unwrap().0.0.len(), 2);
    }

    #[test]
    fn other_files_are_refused_and_left_alone() {
        let home = tempfile::tempdir().unwrap();
        let file = home.path().join("notes.txt");
        fs::write(&file, "my notes\nof today\n").unwrap();
        let error = Keeper::open(&file).unwrap_err().to_string();
        assert!(error.contains("line 1"), "{error}");
        assert_eq!(fs::read_to_string(&file).unwrap(), "my notes\nof today\n");
    }
}
