//! Tests of behaviour common to all subcommands (exit statuses, messages about files, failures as JSON), and
//! of the subcommands about arcade itself.

use crate::arcade::{arcade, files, run, text};
use serde_json::Value;
use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::Stdio;

/// Returns the failure that a run with `--json` prints to standard output. It is a single document, while
/// standard error contains text.
#[track_caller]
fn failure(folder: &Path, args: &[&str], status: i32) -> Value {
    let output = run(folder, args, status);
    assert!(text(&output.stderr).starts_with("error: "), "{}", text(&output.stderr));
    let document: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|error| panic!("arcade {args:?}: {error}\n{}", text(&output.stdout)));
    assert_eq!(document["error"]["status"], status);
    document["error"].clone()
}

/// Runs the binary, and expects the given status and a message that contains the given words.
#[track_caller]
fn says(folder: &Path, args: &[&str], status: i32, words: &[&str]) {
    let message = text(&run(folder, args, status).stderr);
    for word in words {
        assert!(message.contains(word), "no `{word}` in: {message}");
    }
    assert!(!message.contains("may be accessed"), "{message}");
}

#[cfg(target_os = "linux")]
#[test]
fn full_devices_are_reported() {
    let home = tempfile::tempdir().unwrap();
    for args in
        [&["describe", "hailglass"][..], &["--json", "describe", "hailglass"], &["--help"], &["docs", "run"]]
    {
        let full = fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = arcade(home.path()).args(args).stdout(full).output().unwrap();
        let message = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{args:?}: {message}");
        assert!(message.contains("cannot write to standard output: No space left"), "{args:?}: {message}");
    }
    says(home.path(), &["render", "hailglass", "-o", "/dev/full"], 2, &["unknown image format"]);
}

/// A reader that leaves before anything is written causes no message, and the subcommand keeps its own exit
/// status.
#[test]
fn closed_pipes_are_ignored() {
    let home = tempfile::tempdir().unwrap();
    let loose = include_str!("../../../../corpora/hailglass/game.vgdl").replace("    ", "  ");
    fs::write(home.path().join("loose.vgdl"), loose).unwrap();
    let check = |args: &[&str], status: i32| {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = arcade(home.path()).args(args).stdout(writer).stderr(Stdio::piped()).output().unwrap();
        assert_eq!((output.status.code(), text(&output.stderr)), (Some(status), String::new()), "{args:?}");
    };
    check(&["describe", "hailglass"], 0);
    check(&["--json", "describe", "hailglass"], 0);
    check(&["--help"], 0);
    check(&["fmt", "loose.vgdl", "--check"], 1);
    // The work is done nevertheless.
    check(&["--json", "render", "hailglass", "-o", "board.svg"], 0);
    assert!(home.path().join("board.svg").exists());
}

#[cfg(unix)]
#[test]
fn unreadable_folders_are_not_reported_absent() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    std::os::unix::fs::symlink("loop", folder.join("loop")).unwrap();
    fs::write(folder.join("file.vgdl"), "").unwrap();
    let long = "x".repeat(300);
    for verb in ["describe", "validate", "run"] {
        says(folder, &[verb, "loop"], 3, &["cannot read `loop`", "symbolic links"]);
        says(folder, &[verb, "file.vgdl/game"], 2, &["no such file"]);
        says(folder, &[verb, &long], 2, &["no such file"]);
    }
    says(folder, &["describe", "hailglass", "loop"], 3, &["cannot read `loop`"]);
    says(folder, &["render", "hailglass", "-o", "nowhere/board.png"], 2, &["folder does not exist"]);
    says(folder, &["render", "hailglass", "-o", "file.vgdl/board.png"], 2, &["folder does not exist"]);
    fs::create_dir(folder.join("board.png")).unwrap();
    says(folder, &["render", "hailglass", "-o", "board.png"], 2, &["it is a folder"]);
}

/// A line break in a file name could forge a line of the message, so it is escaped.
#[test]
fn paths_are_spelt_out() {
    let home = tempfile::tempdir().unwrap();
    says(
        home.path(),
        &["describe", "./a\nerror: b"],
        2,
        &["error: ./a\\u{a}error: b: there is no such file"],
    );
}

#[test]
fn negative_numbers_are_refused_in_plain_words() {
    let home = tempfile::tempdir().unwrap();
    for args in [
        &["run", "hailglass", "--budget", "-5"][..],
        &["validate", "hailglass", "--budget", "-5"],
        &["diff", "a", "b", "--closest", "-5"],
        &["render", "hailglass", "--max-ticks", "-5", "-o", "x.png"],
        &["play", "hailglass", "--budget", "-5"],
    ] {
        says(home.path(), args, 2, &["'-5'", "must not be negative", "--help"]);
    }
    says(home.path(), &["generate", "games", "--count", "-5", "--out", "x"], 2, &["-5 is not in 1..=10000"]);
}

#[test]
fn planners_have_a_greatest_budget() {
    let home = tempfile::tempdir().unwrap();
    let refused = |args: &[&str], words: &str| says(home.path(), args, 2, &[words]);
    let most = "18446744073709551615";
    refused(&["play", "hailglass", "--budget", most], "18446744073709551615 is not in 0..=1000000000");
    let named = format!("mcts:{most}");
    refused(&["run", "hailglass", "--planner", &named], "write a number of calls up to 1000000000");
}

#[test]
fn failures_are_json_on_request() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("lame.vgdl"), "BasicGame\n    SpriteSet\n        hen > Chicken\n").unwrap();
    let usage = failure(folder, &["describe", "--json", "hailglass", "--spede"], 2);
    assert_eq!(usage["kind"], "malformed");
    assert!(usage["message"].as_str().unwrap().contains("--spede"), "{usage}");
    failure(folder, &["--json"], 2);
    let number = failure(folder, &["--json", "run", "hailglass", "--budget", "-5"], 2);
    assert!(number["message"].as_str().unwrap().contains("must not be negative"), "{number}");
    let absent = failure(folder, &["--json", "render", "no-such-game", "-o", "-"], 2);
    assert!(absent["problems"].is_null() && absent["message"].as_str().unwrap().contains("no-such-game"));
    for verb in ["describe", "run", "render"] {
        let args = ["--json", verb, "lame.vgdl", "-o", "-"];
        let lame = failure(folder, &args[..if verb == "render" { 5 } else { 3 }], 2);
        assert_eq!(lame["message"], "lame.vgdl has 4 problems");
        let problems = lame["problems"].as_array().unwrap();
        let class = problems.iter().find(|problem| problem["code"] == "unknown-class").unwrap();
        assert_eq!(
            (&class["file"], &class["line"], &class["column"]),
            (&"lame.vgdl".into(), &3.into(), &15.into())
        );
    }
    // Without the flag, standard output stays empty.
    assert!(run(folder, &["describe", "lame.vgdl"], 2).stdout.is_empty());
}

#[cfg(target_os = "linux")]
#[test]
fn non_utf8_paths_are_written_and_reported() {
    use std::os::unix::ffi::OsStrExt;
    let home = tempfile::tempdir().unwrap();
    let check = |args: &[&str], out: &[u8]| {
        let out = std::ffi::OsStr::from_bytes(out);
        let output = arcade(home.path()).arg("--json").args(args).arg(out).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", text(&output.stderr));
        assert!(home.path().join(out).exists(), "{args:?}");
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    assert_eq!(check(&["render", "hailglass", "-o"], b"caf\xe9.png")["file"], "caf\u{fffd}.png");
    assert_eq!(check(&["man", "--out"], b"m\xe9")["out"], "m\u{fffd}");
    check(
        &["generate", "levels", "--game", "hailglass", "--method", "constructive", "--count", "1", "--out"],
        b"l\xe9",
    );
    check(
        &["run", "hailglass", "--planner", "random", "--runs", "1", "--max-ticks", "5", "--csv"],
        b"r\xe9.csv",
    );
    check(&["validate", "foxglove-round", "0", "--witness"], b"w\xe9.json");
}

#[test]
fn excessive_thread_counts_are_bounded() {
    let home = tempfile::tempdir().unwrap();
    let mut command = arcade(home.path());
    command.env("RAYON_NUM_THREADS", "999999999999");
    let args = ["run", "hailglass", "--planner", "random", "--runs", "1", "--max-ticks", "5"];
    let output = command.args(args).output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    run(home.path(), &[&args[..], &["--jobs", "999999999999"]].concat(), 0);
}

#[test]
fn files_are_replaced_atomically() {
    let home = tempfile::tempdir().unwrap();
    fs::write(home.path().join("win.gif"), "old").unwrap();
    let args = ["render", "hailglass", "--planner", "random", "--max-ticks", "3", "-o", "win.gif"];
    run(home.path(), &args, 0);
    assert!(files(home.path())["win.gif"].starts_with(b"GIF89a"));
    assert_eq!(files(home.path()).len(), 1);
}

#[test]
fn misspelt_names_get_suggestions() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let game = folder.join("release/games/moth-hunt");
    fs::create_dir_all(&game).unwrap();
    fs::write(game.join("game.vgdl"), include_str!("../../../../corpora/hailglass/game.vgdl")).unwrap();
    fs::write(game.join("lvl0.txt"), include_str!("../../../../corpora/hailglass/lvl0.txt")).unwrap();
    run(folder, &["describe", "release/games/moth-hunt"], 0);
    for args in [
        &["describe", "release/games/moth-hnut"][..],
        &["play", "release/games/moth-hnut"],
        &["render", "release/games/moth-hnut", "-o", "-"],
        &["generate", "levels", "--game", "release/games/moth-hnut", "--out", "new"],
        &["validate", "release/games/moth-hnut"],
        &["run", "release/games/moth-hnut"],
    ] {
        says(folder, args, 2, &["no such file", "did you mean `release/games/moth-hunt`?"]);
    }
    says(folder, &["describe", "release"], 2, &["release/games/moth-hunt"]);
    says(folder, &["describe", "hailglas"], 2, &["did you mean the corpus game `hailglass`?"]);
    says(folder, &["run", "hailglass", "--planner", "mtcs"], 2, &["did you mean `mcts`?"]);
    let mut archive = fs::File::create(folder.join("release.tar.zst")).unwrap();
    archive.write_all(&[0x28, 0xb5, 0x2f, 0xfd, 0, 0]).unwrap();
    says(folder, &["describe", "release.tar.zst"], 2, &["an archive", "tar -xf release.tar.zst"]);
    says(folder, &["play", "release.tar.zst", "0"], 2, &["an archive"]);
}

#[test]
fn recipes_are_listed_and_printed() {
    let home = tempfile::tempdir().unwrap();
    let list = text(&run(home.path(), &["recipes"], 0).stdout);
    for name in ["tiny", "starter", "medium", "frontier", "2026-12"] {
        assert_eq!(list.lines().filter(|line| line.starts_with(name)).count(), 1, "{list}");
    }
    let shown = run(home.path(), &["recipes", "show", "starter"], 0).stdout;
    assert_eq!(text(&shown), include_str!("../../../../seeds/starter.toml"));
    let document: Value =
        serde_json::from_slice(&run(home.path(), &["--json", "recipes", "show", "tiny"], 0).stdout).unwrap();
    assert_eq!(document["text"], include_str!("../../../../seeds/tiny.toml"));
    assert_eq!(document["recipe"]["generated"]["games"], 2);
    let listed: Value = serde_json::from_slice(&run(home.path(), &["--json", "recipes"], 0).stdout).unwrap();
    assert!(listed["recipes"].as_array().unwrap().iter().any(|recipe| recipe["name"] == "2026-12"));
    says(home.path(), &["recipes", "show", "startr"], 2, &["did you mean `starter`?"]);
    // The printed text is a valid recipe.
    fs::write(home.path().join("mine.toml"), shown).unwrap();
    run(home.path(), &["release", "mine.toml", "--out", "new", "--dry-run"], 0);
}

#[test]
fn the_manual_is_in_the_binary() {
    let home = tempfile::tempdir().unwrap();
    let list = text(&run(home.path(), &["docs"], 0).stdout);
    for name in ["prompts", "no-avatar", "killSprite", "snapshots"] {
        assert!(list.contains(name), "no `{name}` in:\n{list}");
    }
    let page = text(&run(home.path(), &["docs", "no-avatar"], 0).stdout);
    assert!(page.starts_with("# no-avatar\n") && page.contains("```vgdl"), "{page}");
    let document: Value =
        serde_json::from_slice(&run(home.path(), &["--json", "docs", "killSprite"], 0).stdout).unwrap();
    assert!(document["text"].as_str().unwrap().contains("](README.md#"));
    says(home.path(), &["docs", "promts"], 2, &["did you mean `prompts`?"]);
}

/// Writes a file, and creates its missing parent folders.
fn put(path: &Path, content: &str) {
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, content).unwrap();
}

#[test]
fn only_leftovers_are_removed() {
    let home = tempfile::tempdir().unwrap();
    let (work, temporary) = (home.path().join("work"), home.path().join("tmp"));
    fs::create_dir_all(&temporary).unwrap();
    // The lock has the form that killed runs leave.
    let lock = "unfinished work of `arcade`, which replaces or removes it (infinite-arcade draft 1)\n";
    for name in ["new", "releases/deep/month"] {
        put(&work.join(format!("{name}.partial/.lock")), lock);
        put(&work.join(format!("{name}.partial/tree/games/a/game.vgdl")), "half");
    }
    // The run was killed at its start.
    put(&work.join("begun.partial/.lock"), "");
    put(&work.join("mint.partial/.lock"), lock);
    put(&work.join("mint.partial/jobs/game-1.json"), "{}");
    put(&work.join(".arcade-a1B2c3.partial"), "GIF8");
    // These are files of other programs.
    let foreign = [
        "results.partial/data.csv",
        "tree.partial/tree/a",
        "mine.partial/.lock",
        "notes.partial/.lock",
        "notes.partial/tree/a",
        "notes.partial/notes.txt",
        "movie.mp4.partial",
        ".arcade-notes.partial",
        ".arcade-a1B2c3.partials",
        "shard/SHARD.json",
        "jobs/game-1.json",
    ];
    foreign.iter().for_each(|path| put(&work.join(path), "precious"));
    put(&home.path().join("elsewhere.partial/.lock"), lock);
    put(&home.path().join("elsewhere.partial/tree/a"), "not in the folder that was named");
    #[cfg(unix)]
    std::os::unix::fs::symlink("../elsewhere.partial", work.join("link.partial")).unwrap();
    for name in ["arcade-player-a1B2c3", "arcade-player-fresh1", "arcade-player-notes", "other-player-a1B2c3"]
    {
        put(&temporary.join(name).join("log"), "said");
        if !name.contains("fresh") {
            let folder = fs::File::open(temporary.join(name)).unwrap();
            folder.set_modified(std::time::UNIX_EPOCH).unwrap();
        }
    }
    for name in ["arcade-studio-a1B2c3.html", "arcade-studio-fresh1.html", "arcade-studio-notes.html"] {
        put(&temporary.join(name), "a page");
        if !name.contains("fresh") {
            let page = fs::File::options().write(true).open(temporary.join(name)).unwrap();
            page.set_modified(std::time::UNIX_EPOCH).unwrap();
        }
    }
    let clean = |flags: &[&str]| {
        let mut command = arcade(home.path());
        let output =
            command.env("TMPDIR", &temporary).args(["--json", "clean", "work"]).args(flags).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        let found = document["found"].as_array().unwrap().clone();
        let of_kind = |kind: &str| found.iter().filter(|one| one["kind"] == kind).count();
        let removed = found.iter().filter(|one| one["removed"] == true).count();
        (["unfinished", "interrupted", "file", "scratch", "page", "shard"].map(of_kind), removed)
    };
    let before = files(home.path());
    let scratch = usize::from(cfg!(target_os = "linux"));
    assert_eq!(clean(&["--dry-run"]), ([3, 1, 1, scratch, scratch, 0], 0));
    assert!(files(home.path()) == before);
    assert_eq!(clean(&[]), ([3, 1, 1, scratch, scratch, 0], 4 + 2 * scratch));
    let after = files(home.path());
    assert!(after.keys().any(|name| name.starts_with("work/mint.partial")));
    assert_eq!(clean(&["--interrupted"]), ([0, 1, 0, 0, 0, 0], 1));
    let after = files(home.path());
    for path in foreign {
        assert_eq!(text(&after[&format!("work/{path}")]), "precious", "{path}");
    }
    assert!(after.contains_key("elsewhere.partial/tree/a"));
    assert!(!after.keys().any(|name| name.contains("new.partial") || name.contains("month.partial")));
    let left = ["arcade-player-fresh1", "arcade-player-notes", "other-player-a1B2c3"];
    assert!(left.iter().all(|name| after.contains_key(&format!("tmp/{name}/log"))));
    assert_eq!(clean(&[]), ([0, 0, 0, 0, 0, 0], 0));
    let left = ["arcade-studio-fresh1.html", "arcade-studio-notes.html"];
    assert!(left.iter().all(|name| after.contains_key(&format!("tmp/{name}"))));
    says(home.path(), &["clean", "nowhere"], 2, &["nowhere", "no such folder"]);
}

#[test]
fn completions_and_manual_pages() {
    let home = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(
            text(&run(home.path(), &["completions", shell], 0).stdout).contains("contamination"),
            "{shell}"
        );
    }
    run(home.path(), &["man", "--out", "man1"], 0);
    let pages = files(&home.path().join("man1"));
    assert!(text(&pages["arcade-generate-levels.1"]).contains("difficulty"));
    assert_eq!(text(&run(home.path(), &["man"], 0).stdout), text(&pages["arcade.1"]));
}

/// No subcommand writes through a link, waits for a pipe, or overwrites a file that it reads. Such paths are
/// rejected before the work starts.
#[cfg(unix)]
#[test]
fn files_are_written_where_they_were_named() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora/hailglass");
    fs::create_dir(folder.join("game")).unwrap();
    for file in ["game.vgdl", "lvl0.txt"] {
        fs::copy(corpus.join(file), folder.join("game").join(file)).unwrap();
    }
    fs::write(folder.join("victim"), "precious").unwrap();
    std::os::unix::fs::symlink("victim", folder.join("link.txt")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(folder.join("pipe.txt")).status().unwrap().success());
    let before = files(&folder.join("game"));
    for verb in [
        &["run", "game", "--planner", "random", "--runs", "1", "--csv"][..],
        &["render", "game", "game/lvl0.txt", "--out"],
        &["validate", "game", "--witness"],
        &["play", "game", "--record"],
    ] {
        for (out, words) in [
            ("link.txt", "it is a link; use its target"),
            ("pipe.txt", "it is not a file; choose a regular file"),
            ("game/lvl0.txt", "this command reads that file; choose another file"),
            ("game/../game/lvl0.txt", "this command reads that file; choose another file"),
        ] {
            says(folder, &[verb, &[out]].concat(), 2, &[&format!("cannot write `{out}`: {words}")]);
        }
    }
    assert_eq!(fs::read(folder.join("victim")).unwrap(), b"precious");
    assert_eq!(files(&folder.join("game")), before);
    let piped =
        run(folder, &["run", "game", "--planner", "random", "--runs", "1", "--csv", "/dev/stdout"], 0);
    assert!(text(&piped.stdout).contains("game,planner,budget"));
    let many = ["run", "game", "--planner", "random,do-nothing", "--runs", "1000000"];
    says(folder, &many, 2, &["2000000 episodes in total, exceed the limit of 1000000; lower --runs"]);
}

/// A pipe among a game's files is reported, and never opened for reading.
#[cfg(unix)]
#[test]
fn pipes_are_no_files_of_games() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let pipe = |name: &str| {
        let made = std::process::Command::new("mkfifo").arg(folder.join(name)).status().unwrap();
        assert!(made.success());
    };
    for game in ["levels", "rules"] {
        fs::create_dir(folder.join(game)).unwrap();
    }
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../corpora/hailglass");
    fs::copy(corpus.join("game.vgdl"), folder.join("levels/game.vgdl")).unwrap();
    pipe("levels/lvl0.txt");
    pipe("rules/game.vgdl");
    pipe("recipe.toml");
    pipe("secret.json");
    pipe("prices.toml");
    for (verb, name) in [
        (vec!["validate", "levels"], "levels/lvl0.txt"),
        (vec!["render", "levels", "0", "--out", "x.png"], "levels/lvl0.txt"),
        (vec!["validate", "rules"], "rules/game.vgdl"),
        (vec!["describe", "rules"], "rules/game.vgdl"),
        (vec!["fmt", "--check", "rules/game.vgdl"], "rules/game.vgdl"),
        (vec!["studio", "rules", "--no-open"], "rules/game.vgdl"),
        (vec!["release", "recipe.toml", "--out", "x"], "recipe.toml"),
        (vec!["release", "tiny", "--secret", "secret.json", "--out", "x"], "secret.json"),
    ] {
        says(folder, &verb, 2, &[name, "not a file"]);
    }
}

#[test]
fn old_spellings_of_moved_verbs_work_with_a_note() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    for (args, note) in [
        (&["keygen", "ada", "--no-password"][..], "`arcade keygen` is now `arcade trust keygen`"),
        (&["--json", "keys", "keys", "--add", "ada=ada.pub"], "`arcade keys` is now `arcade trust keys`"),
        (&["help", "scale"], "`arcade scale` is now `arcade study scale`"),
    ] {
        let output = arcade(folder).args(args).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", text(&output.stderr));
        assert_eq!(text(&output.stderr).matches(note).count(), 1, "{}", text(&output.stderr));
        assert!(!text(&output.stdout).contains("is now"), "{}", text(&output.stdout));
    }
    let [old, new] =
        [&["keys", "keys"][..], &["trust", "keys", "keys"]].map(|args| run(folder, args, 0).stdout);
    assert_eq!(old, new);
    let quiet = run(folder, &["keygen", "bo", "--no-password", "-q"], 0);
    assert_eq!(text(&quiet.stderr), "");
    says(folder, &["conformance", "--games", "x"], 2, &["is now `cargo xtask conformance`"]);
    assert_eq!(failure(folder, &["--json", "conformance"], 2)["kind"], "malformed");
}

#[test]
fn the_rarer_verbs_are_described_on_request() {
    let home = tempfile::tempdir().unwrap();
    let [short, all] =
        [&["--help"][..], &["help", "--all"]].map(|args| text(&run(home.path(), args, 0).stdout));
    assert!(short.contains("mailbox") && !short.contains("  mailbox "), "{short}");
    assert!(all.contains("\n  mailbox ") && all.contains("Exit status: 0"), "{all}");
}
