//! Sealed releases: committing to a secret, and revealing it.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::verbs::verify::failure;
use serde_json::json;
use snapshots::{Draft, Recipe, RevealError, Secret, read_secret};
use std::fs::{self, File, OpenOptions};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// Draws a secret and writes it to a file that only its owner reads.
pub(super) fn commit(recipe: &str, out: Option<&Path>, console: &Console) -> Answer {
    let name = Path::new(recipe).file_stem().map(|stem| stem.to_string_lossy().into_owned());
    let name = name.filter(|name| !name.is_empty()).ok_or_else(|| Failure::malformed("name the release"))?;
    let out = out.map_or_else(|| PathBuf::from(format!("{name}.secret.json")), Path::to_path_buf);
    let chance =
        entropy().map_err(|error| Failure::environment(error, "no chance to be had from the system"))?;
    let secret = Secret::draw(&name, chance);
    let commitment = secret.commitment();
    let text = serde_json::to_string_pretty(&secret).expect("a secret is plain data");
    let write = || {
        let mut options = OpenOptions::new();
        options.write(true).create_new(true);
        #[cfg(unix)]
        std::os::unix::fs::OpenOptionsExt::mode(&mut options, 0o600);
        fill(options.open(&out)?, &out, text.as_bytes())
    };
    write().map_err(|error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => Failure::malformed(format!(
            "`{}` exists: a secret is never overwritten; choose another --out",
            out.display()
        )),
        _ => Failure::environment(error, format!("cannot write `{}`", out.display())),
    })?;
    console.document(&json!({ "name": name, "commitment": commitment, "secret": out }))?;
    console.say(format_args!(
        "in the recipe of `{name}`, in the place of `seed`:\n\n    commitment = \"{commitment}\"\n"
    ));
    console.say(format_args!("mint it with:  arcade release {recipe} --secret {}", out.display()));
    console.say(format_args!(
        "keep {} to yourself, and keep it: without it the release cannot be minted",
        out.display()
    ));
    Ok(true)
}

/// Writes the new file at `place`; if not all of it can be written, no file is left that would be in the way.
fn fill(mut file: File, place: &Path, bytes: &[u8]) -> std::io::Result<()> {
    file.write_all(bytes).and_then(|()| file.sync_all()).inspect_err(|_| drop(fs::remove_file(place)))
}

/// Chance from the operating system.
fn entropy() -> std::io::Result<[u8; 64]> {
    let mut chance = [0; 64];
    File::open("/dev/urandom")?.read_exact(&mut chance)?;
    Ok(chance)
}

/// Reads a secret.
pub(crate) fn read(file: &Path) -> Result<Secret, Failure> {
    let parent = file.parent().filter(|parent| *parent != Path::new("")).unwrap_or(Path::new("."));
    let name = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    read_secret(parent, &name).map_err(failure)
}

/// Joins the two parts.
pub(super) fn reveal(public: &Path, held: &Path, out: Option<&Path>, console: &Console) -> Answer {
    let Some(out) = out else {
        return Err(Failure::malformed("--reveal needs --out: a folder for the whole release"));
    };
    let draft = Draft::create(out).map_err(failure)?;
    match snapshots::reveal(public, held, &draft) {
        Ok(manifest) => {
            draft.commit().map_err(failure)?;
            console
                .document(&json!({ "revealed": true, "out": out, "root": manifest.root, "problems": [] }))?;
            console.say(format_args!(
                "{}: revealed; seed, nonce and every file are those committed to",
                manifest.name
            ));
            console.say(format_args!("root {}\nin   {}", manifest.root, out.display()));
            console.say(format_args!("check it:       arcade verify {}", out.display()));
            console.say(format_args!("mint it again:  arcade regenerate {}", out.display()));
            Ok(true)
        }
        Err(RevealError::Problems(problems)) => {
            console.document(&json!({ "revealed": false, "problems": problems }))?;
            problems.iter().for_each(|problem| console.say(problem));
            console.say("NOT revealed: the two parts are not what was committed to");
            Ok(false)
        }
        Err(RevealError::Snapshot(error)) => Err(failure(error)),
        Err(other) => Err(Failure::Malformed(other.into())),
    }
}

/// What can be told of a sealed release without its secret.
pub(super) fn outline(recipe: &Recipe, console: &Console) -> Answer {
    console.document(&json!({ "recipe": recipe }))?;
    let games = recipe.generated.games + recipe.corpus.games;
    console.say(format_args!("recipe `{}`: {}", recipe.name, recipe.description.trim()));
    console.say(format_args!(
        "would mint {games} games with {} levels, sealed; give --secret FILE for the plan",
        recipe.levels()
    ));
    Ok(true)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An empty secret would have to be removed by hand, because none is ever overwritten.
    #[test]
    fn what_cannot_be_written_is_not_left() {
        let home = tempfile::tempdir().expect("temporary folder");
        let place = home.path().join("new.secret.json");
        fs::write(&place, "").expect("written");
        let unwritable = File::open(&place).expect("there");
        assert!(fill(unwritable, &place, b"secret").is_err());
        assert!(!place.exists());
        fill(File::create_new(&place).expect("vacant"), &place, b"secret").expect("written");
        assert_eq!(fs::read(&place).expect("there"), b"secret");
    }
}
