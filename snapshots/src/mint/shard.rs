//! Shards: slices of the lots of a release that are made apart, on other machines or at another time, and joined again.
//!
//! A shard is a folder, complete or absent like a release:
//!
//! ```text
//! SHARD.json          which shard of which recipe, and the files of its lots with their digests
//! lots/<name>.json    a lot each
//! ```

use super::MintError;
use super::lot::LotResult;
use super::plan::{Lot, Plan};
use super::shelf::{LotFolder, Shelf};
use crate::canonical::to_canonical_json;
use crate::folder::{self, Limits};
use crate::manifest::{Item, MANIFEST_LIMIT};
use crate::recipe::Recipe;
use crate::version::{CURRENT, MintedBy};
use crate::{Digest, Draft, SnapshotError};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// The file that tells what a shard is, at its top.
pub const SHARD_FILE: &str = "SHARD.json";
/// Version of the shards' layout.
const SHARD_FORMAT: u32 = 1;

/// Which slice of the lots: `2/4` is the second of four. Lots are dealt out in turn, so that slices take about as long.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shard {
    /// From 1.
    number: u32,
    of: u32,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Shard, String> {
        let numbers =
            text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of && of <= 10_000 => Ok(Shard { number, of }),
            _ => Err("takes K/N: the K-th of N shards, K from 1 to N, N at most 10000".to_owned()),
        }
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// `SHARD.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct ShardFile {
    format: u32,
    semantics: u32,
    generation: u32,
    shard: Shard,
    plan: Digest,
    recipe: Recipe,
    lots: Vec<Item>,
}

/// All that `SHARD.json` of any version is sure to have.
#[derive(Deserialize)]
struct Version {
    format: u32,
}

impl Shard {
    /// The lots of a plan that are this shard's.
    pub fn lots(&self, plan: &Plan<'_>) -> Vec<Lot> {
        plan.lots().iter().copied().skip(self.number as usize - 1).step_by(self.of as usize).collect()
    }

    /// The shard, of any generation, in a folder and the name of its recipe, if the folder holds the files that its `SHARD.json` lists and nothing
    /// else. Their content is not read.
    pub fn at(folder: &Path) -> Option<(Shard, String)> {
        let bytes = folder::read(folder, SHARD_FILE, MANIFEST_LIMIT).ok()?;
        // Of whatever generation: shards of an earlier one can no longer be joined here, but are shards.
        let file: ShardFile = serde_json::from_slice(&bytes).ok()?;
        let listing = folder::list(folder, &Limits::SNAPSHOT).ok()?;
        let mut listed: Vec<&str> = file.lots.iter().map(|item| item.path.as_str()).collect();
        listed.push(SHARD_FILE);
        listed.sort_unstable();
        let is_whole = listing.problems.is_empty()
            && listing.entries.iter().map(|entry| entry.path.as_str()).eq(listed.iter().copied());
        is_whole.then_some((file.shard, file.recipe.name))
    }

    /// Writes the shard's folder from lots that are all on the shelf.
    ///
    /// # Errors
    /// A lot is missing, or the file system refuses.
    pub fn write(&self, plan: &Plan<'_>, shelf: &dyn Shelf, draft: &Draft) -> Result<(), MintError> {
        let digest = plan.digest()?;
        let mut lots = Vec::new();
        for lot in self.lots(plan) {
            let name = plan.name(lot);
            let Some(result) = shelf.get(&name)? else { return Err(MintError::Missing(name)) };
            let text = LotFolder::text(digest, &result)?;
            let path = path(&name);
            draft.write(&path, text.as_bytes())?;
            lots.push(Item::of(path, text.as_bytes()));
        }
        let file = ShardFile {
            format: SHARD_FORMAT,
            semantics: engine::SEMANTICS,
            generation: generators::GENERATION,
            shard: *self,
            plan: digest,
            recipe: plan.recipe.clone(),
            lots,
        };
        draft.write(SHARD_FILE, to_canonical_json(&file).map_err(SnapshotError::from)?.as_bytes())?;
        Ok(())
    }
}

/// Where a lot lies in a shard.
fn path(name: &str) -> String {
    format!("lots/{name}.json")
}

/// Why shards cannot be joined.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// There is no `SHARD.json`.
    #[error("{}: not a shard: there is no {SHARD_FILE}; one that is not finished goes on with `arcade release … --shard K/N --resume`", .0.display())]
    NotAShard(PathBuf),
    /// `SHARD.json` is not what it should be.
    #[error("{}: {what}", .path.display())]
    Unsound {
        /// The folder.
        path: PathBuf,
        /// What is wrong.
        what: String,
    },
    /// Two shards do not belong together.
    #[error("{} and {} do not belong together: {what}", .one.display(), .two.display())]
    Apart {
        /// A folder.
        one: PathBuf,
        /// Another.
        two: PathBuf,
        /// Where they differ.
        what: &'static str,
    },
    /// Shards are missing.
    #[error("shards are missing: {0}")]
    Missing(String),
    /// The file system refuses.
    #[error(transparent)]
    Snapshot(#[from] SnapshotError),
}

/// All shards of a release.
#[derive(Debug)]
pub struct Shards {
    recipe: Recipe,
    plan: Digest,
    /// By the lot's path: its folder, and what is to be there.
    lots: BTreeMap<String, (PathBuf, Item)>,
}

impl Shards {
    /// Opens the shards in some folders, which may be given in any order. Trusts nothing in them.
    ///
    /// # Errors
    /// A folder is no shard, is of another version or of another recipe than the first, or a shard is missing or there twice.
    pub fn open(folders: &[PathBuf]) -> Result<Shards, MergeError> {
        let mut read = Vec::new();
        for folder in folders {
            read.push((folder, shard_file(folder)?));
        }
        let Some((first, head)) = read.first() else {
            return Err(MergeError::Missing("none was given".to_owned()));
        };
        let mut numbers: BTreeMap<u32, &PathBuf> = BTreeMap::new();
        let mut lots = BTreeMap::new();
        for (folder, file) in &read {
            let apart = |two: &Path, what| MergeError::Apart {
                one: two.to_path_buf(),
                two: folder.to_path_buf(),
                what,
            };
            if file.recipe != head.recipe || file.plan != head.plan {
                return Err(apart(first, "they are of different recipes"));
            }
            if file.shard.of != head.shard.of {
                return Err(apart(first, "they are of different numbers of shards"));
            }
            if let Some(other) = numbers.insert(file.shard.number, folder) {
                return Err(apart(other, "they are the same shard"));
            }
            for item in &file.lots {
                lots.insert(item.path.clone(), (folder.to_path_buf(), item.clone()));
            }
        }
        let missing: Vec<String> = (1..=head.shard.of)
            .filter(|number| !numbers.contains_key(number))
            .map(|number| format!("{number}/{}", head.shard.of))
            .collect();
        if !missing.is_empty() {
            return Err(MergeError::Missing(missing.join(", ")));
        }
        head.recipe.check().map_err(|error| unsound(first, format!("its recipe: {error}")))?;
        Ok(Shards { recipe: head.recipe.clone(), plan: head.plan, lots })
    }

    /// What all of them are shards of.
    pub fn recipe(&self) -> &Recipe {
        &self.recipe
    }

    /// Whether their lots are those of this plan.
    pub fn are_of(&self, plan: &Plan<'_>) -> Result<bool, SnapshotError> {
        Ok(plan.digest()? == self.plan)
    }
}

fn unsound(folder: &Path, what: String) -> MergeError {
    MergeError::Unsound { path: folder.join(SHARD_FILE), what }
}

fn shard_file(folder: &Path) -> Result<ShardFile, MergeError> {
    let bytes = folder::read(folder, SHARD_FILE, MANIFEST_LIMIT).map_err(|error| match error {
        SnapshotError::Io { source, .. } if source.kind() == std::io::ErrorKind::NotFound => {
            MergeError::NotAShard(folder.to_path_buf())
        }
        other => other.into(),
    })?;
    let syntax = |error: serde_json::Error| unsound(folder, error.to_string());
    let Version { format } = serde_json::from_slice(&bytes).map_err(syntax)?;
    if format != SHARD_FORMAT {
        return Err(unsound(
            folder,
            format!("shard format {format} is not {SHARD_FORMAT}: use the arcade that made it"),
        ));
    }
    let file: ShardFile = serde_json::from_slice(&bytes).map_err(syntax)?;
    if (file.generation, file.semantics) != (generators::GENERATION, engine::SEMANTICS) {
        let made_by = MintedBy { version: None, generation: file.generation, semantics: file.semantics };
        let what = format!("made by {made_by}; this is arcade {CURRENT}: merge with the arcade that made it");
        return Err(unsound(folder, what));
    }
    let Shard { number, of } = file.shard;
    if number == 0 || number > of {
        return Err(unsound(folder, format!("there is no shard {number}/{of}")));
    }
    for item in &file.lots {
        if let Err(problem) = crate::check_path(&item.path) {
            return Err(unsound(folder, format!("`{}` is no path for a lot: {problem}", item.path)));
        }
    }
    Ok(file)
}

impl Shelf for Shards {
    fn get(&self, name: &str) -> Result<Option<LotResult>, SnapshotError> {
        let Some((folder, item)) = self.lots.get(&path(name)) else { return Ok(None) };
        let bytes = folder::read(folder, &item.path, Limits::SNAPSHOT.file_bytes)?;
        if Digest::of(&bytes) != item.digest {
            return Err(SnapshotError::Altered { path: folder.join(&item.path) });
        }
        LotFolder::parse(self.plan, &bytes)
    }

    fn put(&self, _: &str, _: &LotResult) -> Result<(), SnapshotError> {
        unreachable!("shards are read only")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_are_numbered_from_one() {
        for good in ["1/1", "2/4", "4/4"] {
            assert_eq!(good.parse::<Shard>().unwrap().to_string(), good);
        }
        for bad in ["", "1", "0/4", "5/4", "1/0", "a/b", "1/20000", "-1/3"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }
}
