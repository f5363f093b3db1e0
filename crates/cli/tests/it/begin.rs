//! Tests of the first steps of new users: `arcade new`, `arcade recipes new`, the tutorials of the book, and the book's
//! search.

use crate::arcade::{MINT_OUTPUT, TINY, arcade, copy_of_tiny, files, run, text};
use serde_json::{Value, json};
use snapshots::{Recipe, Secret, follow};
use std::fs;
use std::io::Read;
use std::path::Path;

#[track_caller]
fn says(folder: &Path, args: &[&str], status: i32, words: &[&str]) {
    let output = run(folder, args, status);
    let said = text(&output.stdout) + &text(&output.stderr);
    for word in words {
        assert!(said.contains(word), "no `{word}` in: {said}");
    }
}

#[track_caller]
fn answer(folder: &Path, args: &[&str]) -> Value {
    serde_json::from_slice(&run(folder, &[&["--json"], args].concat(), 0).stdout).unwrap()
}

/// Returns the commands that an output proposes, each as a list of arguments.
fn proposed(output: &str) -> Vec<Vec<String>> {
    let commands = output.lines().filter_map(|line| line.split_once(" arcade ")).map(|(_, command)| command);
    commands.map(|command| command.split_whitespace().map(str::to_owned).collect()).collect()
}

#[test]
fn every_new_game_is_sound_and_can_be_won() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    for genre in ["collect", "crossing", "maze", "puzzle", "shooter"] {
        let name = format!("my-{genre}");
        let said = text(&run(folder, &["new", &name, "--like", genre], 0).stdout);
        let next = proposed(&said);
        assert_eq!(
            next,
            ["play", "validate", "studio"].map(|verb| [verb.to_owned(), name.clone()]),
            "{said}"
        );
        let verdict = answer(folder, &["validate", &name]);
        assert_eq!(verdict["problems"], json!([]), "{name}");
        let levels = verdict["levels"].as_array().unwrap();
        assert!(levels.len() == 2 && levels.iter().all(|level| level["problems"] == json!([])), "{name}");
        run(folder, &["fmt", "--check", &format!("{name}/game.vgdl")], 0);
        run(folder, &["render", &name, "0", "-o", "board.svg"], 0);
        let game = fs::read_to_string(folder.join(&name).join("game.vgdl")).unwrap();
        let rules =
            game.lines().filter(|line| !line.trim().is_empty() && !line.trim().starts_with('#')).count();
        assert!((18..=36).contains(&rules) && game.matches('#').count() >= 10, "{rules}: {game}");
    }
    assert_eq!(answer(folder, &["new", "usual"])["genre"], "collect");
    assert_eq!(files(&folder.join("usual")), files(&folder.join("my-collect")));
}

#[test]
fn new_games_overwrite_nothing() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::create_dir_all(folder.join("empty")).unwrap();
    fs::create_dir_all(folder.join("full")).unwrap();
    fs::write(folder.join("full/notes.md"), "mine").unwrap();
    fs::write(folder.join("file"), "mine").unwrap();
    assert_eq!(text(&run(folder, &["-q", "new", "empty"], 0).stdout), "");
    run(folder, &["new", "full/inside"], 0);
    says(folder, &["new", "empty"], 2, &["`empty` exists and is not empty", "arcade studio empty"]);
    says(folder, &["new", "full"], 2, &["choose another name"]);
    says(folder, &["new", "file"], 2, &["`file` is a file"]);
    says(folder, &["new", "nowhere/game"], 2, &["the folder above `nowhere/game` does not exist"]);
    says(folder, &["new", "river.vgdl"], 2, &["a game is a folder: arcade new river"]);
    says(folder, &["new", "my game"], 0, &["arcade play 'my game'"]);
    for bad in [".", "..", "/", "...", "a\nb"] {
        says(folder, &["new", bad], 2, &["arcade new river-post"]);
    }
    says(folder, &["new", "x", "--like", "puzle"], 2, &["puzzle", "shooter", "crossing"]);
    says(
        folder,
        &["new", "--help"],
        0,
        &["arcade new river-post --like crossing", "cross the river on boats"],
    );
    assert_eq!(fs::read_to_string(folder.join("file")).unwrap(), "mine");
    assert_eq!(files(&folder.join("full")).len(), 4);
    let failed = run(folder, &["--json", "new", "file"], 2);
    let failure: Value = serde_json::from_slice(&failed.stdout).unwrap();
    assert_eq!(failure["error"]["status"], 2);
}

#[test]
fn new_recipes_are_accepted_as_they_are() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let said = text(&run(folder, &["recipes", "new", "2027-01"], 0).stdout);
    let next = proposed(&said);
    assert_eq!(next.len(), 3, "{said}");
    assert!(said.contains("add --parent with the previous release's folder"), "{said}");
    assert_eq!(text(&run(folder, &["-q", "recipes", "new", "quiet"], 0).stdout), "");
    let dry: Vec<&str> = next[0].iter().map(String::as_str).collect();
    assert_eq!(dry, ["release", "2027-01.toml", "--dry-run"]);
    says(folder, &dry, 0, &["8 new games of 4 levels"]);
    let recipe = Recipe::from_toml(&fs::read_to_string(folder.join("2027-01.toml")).unwrap()).unwrap();
    let asked = serde_json::to_value(&recipe).unwrap()["criteria"]["ask"].to_string();
    assert!(asked.contains("skill") && asked.contains("necessity"), "{asked}");
    // The line that `--commit` prints is inserted where the comment says that it belongs.
    let said = text(&run(folder, &["release", "2027-01.toml", "--commit"], 0).stdout);
    let line = said.lines().map(str::trim).find(|line| line.starts_with("commitment = ")).unwrap();
    // Committing again does not help, and the message states what does help.
    let commit = ["release", "2027-01.toml", "--commit"];
    says(folder, &commit, 2, &["was drawn for this recipe: write `commitment = ", "instead of `seed`"]);
    let text_of = fs::read_to_string(folder.join("2027-01.toml")).unwrap();
    let seed = text_of.lines().find(|line| line.starts_with("seed = ")).unwrap();
    fs::write(folder.join("2027-01.toml"), text_of.replace(seed, line)).unwrap();
    let mint = "no secret needs to be drawn: mint it with `arcade release 2027-01.toml --secret 2027-01.secret.json`";
    says(folder, &commit, 2, &[mint]);
    let committed = fs::read_to_string(folder.join("2027-01.toml")).unwrap();
    fs::write(folder.join("2027-01.toml"), committed.replace("games = 8", "games = 7")).unwrap();
    says(folder, &commit, 2, &["changed since: undo the change, or draw a new secret"]);
    let again = text(&run(folder, &[&commit[..], &["--out", "other.json"]].concat(), 0).stdout);
    assert!(again.contains("already has a `commitment` line: replace it"), "{again}");
    fs::write(folder.join("2027-01.toml"), &committed).unwrap();
    let secret = ["--secret", "2027-01.secret.json", "--dry-run"];
    says(folder, &[&["release", "2027-01.toml"], &secret[..]].concat(), 0, &["8 new games"]);

    says(folder, &["recipes", "new", "2027-01"], 2, &["`2027-01.toml` already exists"]);
    assert_eq!(answer(folder, &["recipes", "new", "b.toml"])["file"], "b.toml");
    for bad in ["My Month", "a\"\nseed='x", "..", "é", &"a".repeat(41)] {
        says(folder, &["recipes", "new", bad], 2, &["isn't a valid release name"]);
    }
    says(folder, &["recipes", "new", "nowhere/month"], 2, &["its folder does not exist"]);
}

#[test]
fn words_that_are_not_pages_are_looked_for() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    for (word, page) in [
        ("push", "bounceForward"),
        ("boat", "first-game"),
        ("tutorial", "first-game"),
        ("getting-started", "first-game"),
        ("release", "first-month"),
        ("sign", "trust"),
        ("log", "trust"),
        ("play", "first-game"),
        ("generate", "generate-levels"),
        ("contamination", "memory"),
    ] {
        let said = text(&run(folder, &["docs", word], 0).stdout);
        assert!(said.lines().any(|line| line.starts_with(page)), "{word}: {said}");
        assert!(said.lines().count() < 16, "{word}: {said}");
    }
    assert_eq!(answer(folder, &["docs", "release"])["found"][0]["page"], "first-month");
    says(folder, &["docs", "gallery"], 0, &["arcade docs studio", "# Ten generated games"]);
    says(folder, &["docs", "qwertzuiop"], 2, &["there is no page `qwertzuiop`"]);
    let list = text(&run(folder, &["docs"], 0).stdout);
    assert!(
        list.starts_with("Start:\n") && list.contains("\nfirst-game ") && list.contains("\nLab notes:\n"),
        "{list}"
    );
    let moved = run(folder, &["docs", "decision"], 0);
    assert!(text(&moved.stderr).contains("is now part of `arcade docs decisions`"), "{moved:?}");
    assert!(text(&moved.stdout).starts_with("# Decisions"), "{moved:?}");
}

/// Returns a page's code blocks in the given language.
fn blocks<'a>(page: &'a str, language: &str) -> Vec<&'a str> {
    let begin = format!("```{language}\n");
    page.split(begin.as_str()).skip(1).filter_map(|rest| rest.split("```").next()).collect()
}

/// Returns a page's commands, each as a list of arguments.
fn commands(page: &str) -> Vec<Vec<&str>> {
    let lines = blocks(page, "sh").into_iter().flat_map(str::lines);
    lines.filter_map(|line| Some(line.strip_prefix("arcade ")?.split_whitespace().collect())).collect()
}

/// A command on a page, with the output that the page shows for it.
struct Shown<'a> {
    command: Vec<&'a str>,
    output: Option<&'a str>,
}

/// Returns a page's commands in order. The output of a command is shown below it, in a `text` block that begins with
/// `$ arcade`, or in the `text` block that follows the command's own block.
fn shown(page: &str) -> Vec<Shown<'_>> {
    fn words(line: &str) -> Option<Vec<&str>> {
        Some(line.strip_prefix("arcade ")?.split_whitespace().collect())
    }
    let mut found: Vec<Shown<'_>> = Vec::new();
    let mut follows_commands = false;
    for block in page.split("```").skip(1).step_by(2) {
        let (language, text) = block.split_once('\n').unwrap_or((block, ""));
        let with_output = |part| {
            let (line, output): (&str, &str) = str::split_once(part, '\n')?;
            Some(Shown { command: words(line)?, output: Some(output) })
        };
        match language {
            "sh" => {
                found.extend(text.lines().filter_map(words).map(|command| Shown { command, output: None }))
            }
            "text" if text.starts_with("$ ") => {
                found.extend(text.split("$ ").skip(1).filter_map(with_output));
            }
            "text" if follows_commands => found.last_mut().expect("there was a command").output = Some(text),
            _ => {}
        }
        follows_commands = language == "sh" && text.contains("arcade ");
    }
    found
}

/// Checks the output on a page, in which `…` stands for any text.
#[track_caller]
fn check_output(shown: &str, output: &str) {
    let (shown, mut rest) = (shown.trim_end(), output.trim_end());
    let mut parts = shown.split('…');
    let first = parts.next().unwrap_or_default();
    rest = rest.strip_prefix(first).unwrap_or_else(|| panic!("not `{first}`:\n{output}"));
    let parts: Vec<&str> = parts.collect();
    for (at, part) in parts.iter().enumerate() {
        let place = if at + 1 == parts.len() { rest.rfind(part) } else { rest.find(part) };
        rest = &rest[place.unwrap_or_else(|| panic!("no `{part}`:\n{output}")) + part.len()..];
    }
    assert!(rest.is_empty() || shown.ends_with('…'), "the page does not show `{rest}`");
}

impl Shown<'_> {
    /// Runs the command, and compares its output, in the order of a terminal, with the page.
    #[track_caller]
    fn check(&self, folder: &Path) -> String {
        let is_no = |output: &str| output.contains("FAILS") || output.contains("does NOT verify");
        let (mut reader, writer) = std::io::pipe().unwrap();
        let mut command = arcade(folder);
        command.args(&self.command).stdout(writer.try_clone().unwrap()).stderr(writer);
        let mut child = command.spawn().unwrap();
        // The reader sees the end only after the command, which owns the other end, is dropped.
        drop(command);
        let mut output = String::new();
        reader.read_to_string(&mut output).unwrap();
        let status = child.wait().unwrap().code();
        let expect = i32::from(self.output.is_some_and(is_no));
        assert_eq!(status, Some(expect), "arcade {:?}\n{output}", self.command);
        self.output.iter().for_each(|shown| check_output(shown, &output));
        output
    }
}

#[test]
fn the_first_game_works_as_printed() {
    let page = include_str!("../../../../docs/start/first-game.md");
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let mut validated = 0;
    for shown in shown(page) {
        match shown.command[..] {
            // These commands wait for a person.
            ["play", game, ..] | ["studio", game, ..] => {
                run(folder, &["describe", game], 0);
                continue;
            }
            ["validate", _, "0"] => {
                // At this point, the page has asked the person following it to write a game.
                let [game] = blocks(page, "vgdl")[..] else { panic!("one game") };
                let [level] = blocks(page, "level")[..] else { panic!("one level") };
                fs::write(folder.join("shell-beach/game.vgdl"), game).unwrap();
                fs::write(folder.join("shell-beach/lvl0.txt"), level).unwrap();
            }
            _ => {}
        }
        let output = shown.check(folder);
        validated += usize::from(shown.command[0] == "validate" && output.contains("passes: won in"));
    }
    assert_eq!(validated, 4);
}

/// Runs a page's commands in a folder with the release `tiny`, and compares their outputs with the page. Does not mint
/// again, and skips commands that wait for a person. Returns the number of commands and of compared outputs.
fn work_as_printed(page: &str) -> (usize, usize) {
    let (home, root) = copy_of_tiny();
    let folder = home.path();
    fs::create_dir(folder.join("releases")).unwrap();
    fs::rename(root, folder.join("releases/tiny")).unwrap();
    let (commands, mut compared) = (shown(page), 0);
    for shown in &commands {
        match (shown.command[0], shown.output) {
            ("regenerate" | "play", _) | ("release", None) => continue,
            ("release", Some(output)) => {
                // The shared mint is in a different folder.
                let minted = fs::read_to_string(TINY.path().join(MINT_OUTPUT)).unwrap();
                check_output(&output.replace("releases/tiny", "tiny"), &minted);
            }
            ("verify", Some(output)) if output.contains("altered") => {
                // At this point, the page has asked the person following it to change a character.
                let path = output.split(':').next().unwrap();
                let level = folder.join("releases/tiny").join(path);
                let text = fs::read_to_string(&level).unwrap();
                fs::write(&level, text.replacen("\nw.", "\nww", 1)).unwrap();
                shown.check(folder);
                fs::write(&level, text).unwrap();
            }
            _ => drop(shown.check(folder)),
        }
        compared += usize::from(shown.output.is_some());
    }
    (commands.len(), compared)
}

#[test]
fn the_first_release_works_as_printed() {
    let page = include_str!("../../../../docs/start/first-release.md");
    assert_eq!(work_as_printed(page), (10, 3));
}

#[test]
fn the_first_evaluation_works_as_printed() {
    let page = include_str!("../../../../docs/start/first-evaluation.md");
    assert_eq!(work_as_printed(page), (4, 4));
}

#[test]
fn the_readme_shows_real_output() {
    let readme = include_str!("../../../../README.md");
    let (tried, _) = readme.split_once("## What to do next").unwrap();
    assert_eq!(work_as_printed(tried), (2, 2));
}

/// Returns the recipe for a month that is minted in seconds. `seed` is the line that replaces the seed.
fn small(name: &str, seed: &str) -> String {
    format!(
        "name = '{name}'\ndescription = 'x'\n{seed}\n[generated]\ngames = 1\nlevels = 1\ncandidates = 3.0\n[corpus]\n\
         games = 1\nlevels = 1\ncandidates = 2.0\n[criteria]\ndecision = 100\nbudget = 80000\ndepths = [10, 25]\n\
         random_plays = 10\n"
    )
}

/// Runs every command on the page. Before they are committed to, the recipes are replaced by small ones, and
/// the secrets by secrets that are the same in every run. Such a small recipe finds enough levels only with
/// some seeds.
#[test]
fn the_first_month_works_as_printed() {
    let page = include_str!("../../../../docs/how-to/first-month.md");
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let mut run_commands = 0;
    for command in commands(page) {
        if let ["release", file, "--commit", parent @ ..] = &command[..] {
            let name = file.strip_suffix(".toml").unwrap();
            let recipe = small(name, "seed = 'x'");
            fs::write(folder.join(file), &recipe).unwrap();
            let said = text(&run(folder, &command, 0).stdout);
            assert!(said.contains("    commitment = \""), "{said}");
            let mut open = Recipe::to_commit(&recipe).unwrap();
            if let [_, parent] = parent {
                follow(&mut open, &folder.join(parent)).unwrap();
            }
            let secret = Secret::draw(name, open.committed(), [u8::try_from(run_commands).unwrap() + 40; 64]);
            let line = format!("commitment = \"{}\"", secret.commitment());
            fs::write(folder.join(file), small(name, &line)).unwrap();
            let json = serde_json::to_vec(&secret).unwrap();
            fs::write(folder.join(format!("{name}.secret.json")), json).unwrap();
        } else {
            run(folder, &command, 0);
        }
        run_commands += 1;
    }
    assert!(run_commands >= 20, "{run_commands}");
    says(
        folder,
        &["trust", "log", "check", "log", "--key", "log.pub", "--month", "2027-02"],
        0,
        &["2027-02"],
    );
}
