//! Helpers that run the binary the way a user does.

use snapshots::{Recipe, Secret};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};
use std::sync::{LazyLock, Mutex, PoisonError};
use tempfile::TempDir;

/// A folder with one mint of the recipe `tiny`, in its subfolder `tiny`, and its output, in [`MINT_OUTPUT`]. Tests that
/// only read or copy the folder share it.
pub(crate) static TINY: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &["release", "tiny", "--out", "tiny", "--jobs", "2"], 0);
    fs::write(folder.path().join(MINT_OUTPUT), output.stdout).unwrap();
    folder
});

/// The file in [`TINY`] with the standard output of the mint.
pub(crate) const MINT_OUTPUT: &str = "mint.txt";

/// A recipe with four jobs that each take less than a second. With this seed, few candidates fail.
pub(crate) const SLICES_RECIPE: &str = "name = 'slices'\ndescription = 'x'\nseed = 'pieces'\n[generated]\ngames = 1\n\
    levels = 1\ncandidates = 2.0\n[corpus]\ngames = 1\nlevels = 1\ncandidates = 2.0\n[criteria]\ndecision = 100\n\
    budget = 80000\ndepths = [10, 25]\nrandom_plays = 10\n";

/// A folder with one uninterrupted mint of [`SLICES_RECIPE`] in its subfolder `slices`, shared like [`TINY`].
pub(crate) static SLICES: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("slices.toml"), SLICES_RECIPE).unwrap();
    run(folder.path(), &["release", "slices.toml", "--out", "slices", "--jobs", "2"], 0);
    folder
});

/// Returns a copy of the shared mint of `tiny` for tests that tamper with it.
pub(crate) fn copy_of_tiny() -> (TempDir, PathBuf) {
    copy_of(&TINY, "tiny")
}

/// Returns a copy of the shared mint of [`SLICES_RECIPE`].
pub(crate) fn copy_of_slices() -> (TempDir, PathBuf) {
    copy_of(&SLICES, "slices")
}

fn copy_of(minted: &TempDir, name: &str) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path().join(name);
    copy_tree(&minted.path().join(name), &root);
    (folder, root)
}

/// Returns `true` if the tests run at full size (`cargo xtask sweep`).
pub(crate) fn sweeping() -> bool {
    std::env::var_os("ARCADE_SWEEP").is_some()
}

/// Returns a command for the binary under test, in its own folder.
pub(crate) fn arcade(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_arcade"));
    command.current_dir(folder);
    command
}

/// Ends a program like the command `kill`, which gives the program the exit status 143. SIGINT would not
/// work, because a shell's background jobs ignore it.
#[cfg(unix)]
pub(crate) fn terminate(child: &Child) {
    let done = Command::new("kill").arg(child.id().to_string()).status().unwrap();
    assert!(done.success());
}

/// Runs the binary with the given arguments, and expects the given exit status. Shows the output if the
/// status differs.
#[track_caller]
pub(crate) fn run(folder: &Path, args: &[&str], status: i32) -> Output {
    let output = arcade(folder).args(args).output().expect("the binary starts");
    let (out, err) = (text(&output.stdout), text(&output.stderr));
    assert_eq!(output.status.code(), Some(status), "arcade {args:?}\n--- stdout\n{out}\n--- stderr\n{err}");
    if !args.contains(&"--json") {
        [out, err].iter().flat_map(|said| suggested(said)).for_each(|command| check_suggested(&command));
    }
    output
}

/// Returns the commands that an output suggests: text in backticks, or text from a colon to the end of the
/// line.
fn suggested(said: &str) -> Vec<Vec<String>> {
    let mut found = Vec::new();
    for line in said.lines() {
        for (at, _) in line.match_indices("arcade ") {
            let (before, rest) = line.split_at(at);
            let command = match before.chars().next_back() {
                Some('`') => rest.split('`').next(),
                // Several commands follow each other, separated as in a shell.
                _ if before.ends_with(": ") || before.ends_with("; ") => rest.split("; ").next(),
                _ => None,
            };
            // `arcade [OPTIONS] <COMMAND>` is a usage line, and excerpts from pages end with an ellipsis.
            let command = command.filter(|command| !command.contains('<') && !command.ends_with('…'));
            found.extend(command.and_then(shlex::split));
        }
    }
    found
}

/// Checks that a suggested command has an existing subcommand, valid flags of that subcommand, and existing
/// manual pages.
#[track_caller]
fn check_suggested(command: &[String]) {
    static HELP: Mutex<BTreeMap<String, String>> = Mutex::new(BTreeMap::new());
    let help = |verbs: &[&str]| {
        let mut known = HELP.lock().unwrap_or_else(PoisonError::into_inner);
        let text = known.entry(verbs.join(" ")).or_insert_with(|| {
            let output = arcade(Path::new(".")).arg("help").args(verbs).output().expect("the binary starts");
            assert!(output.status.success(), "no such verb is suggested: {command:?}");
            text(&output.stdout)
        });
        text.clone()
    };
    let words: Vec<&str> = command.iter().skip(1).map(String::as_str).collect();
    let Some((&verb, rest)) = words.split_first() else { return };
    if verb == "help" || verb.starts_with('-') {
        return;
    }
    let mut verbs = vec![verb];
    let mut flags = help(&verbs);
    while flags.contains("\nCommands:")
        && let Some(part) = rest.get(verbs.len() - 1).filter(|part| !part.starts_with('-'))
    {
        verbs.push(part);
        flags = help(&verbs);
    }
    for flag in rest.iter().filter_map(|word| word.strip_prefix("--")) {
        let name = flag.split('=').next().unwrap_or_default().trim_end_matches([',', ';', '.', ')', ':']);
        let is_known = flags.split_whitespace().any(|word| word.trim_end_matches(',') == format!("--{name}"));
        assert!(is_known || name.is_empty(), "no flag --{name}: {command:?}");
    }
    if let ("docs", [page, ..]) = (verb, rest)
        && !page.contains(char::is_uppercase)
    {
        let output = arcade(Path::new(".")).args(["docs", page]).output().expect("the binary starts");
        assert!(output.status.success(), "no such page is suggested: {command:?}");
    }
}

/// Commits to a recipe like `--commit`, but with the same secret in every run, because such a small recipe
/// finds enough levels only with some seeds. `recipe` returns the recipe for a commitment. The function
/// writes `NAME.toml` and `NAME.secret.json`.
pub(crate) fn commit(folder: &Path, recipe: &dyn Fn(&str) -> String) -> Secret {
    let open = Recipe::to_commit(&recipe(&"0".repeat(64))).unwrap();
    let secret = Secret::draw(&open.name, open.committed(), [7; 64]);
    let text = recipe(&secret.commitment().to_string());
    fs::write(folder.join(format!("{}.toml", open.name)), text).unwrap();
    let json = serde_json::to_vec(&secret).unwrap();
    fs::write(folder.join(format!("{}.secret.json", open.name)), json).unwrap();
    secret
}

pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Returns all files in a folder with their contents.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).unwrap().display().to_string();
                found.insert(name, fs::read(&path).unwrap());
            }
        }
    }
    found
}

/// Copies a folder, for a test that tampers with it.
pub(crate) fn copy_tree(from: &Path, to: &Path) {
    for (name, content) in files(from) {
        let path = to.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }
}
