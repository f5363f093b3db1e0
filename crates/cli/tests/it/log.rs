//! Tests of a sealed month's public log. The month is committed to, waits for its beacon, and is minted,
//! revealed and played.

use crate::arcade::{TINY, commit, copy_tree, files, run, text};
use serde_json::{Map, Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

#[track_caller]
fn says(folder: &Path, args: &[&str], status: i32, words: &str) {
    let output = run(folder, args, status);
    let said = text(&output.stdout) + &text(&output.stderr);
    assert!(said.contains(words), "no `{words}` in: {said}");
}

/// A recipe with one new game and one level.
const RECIPE: &str = "name = '2027-01'\ndescription = 'x'\ncommitment = 'COMMITMENT'\n[generated]\ngames = 1\n\
    levels = 1\ncandidates = 2.0\n[criteria]\ndecision = 200\nbudget = 240000\ndepths = [10, 25]\n\
    random_plays = 20\n[beacon]\nsource = 'drand quicknet'\nround = 1000\n";

/// Two rounds of drand quicknet, in the form in which drand serves them.
const ROUND_123: [&str; 2] = [
    "fb8f7bc29bf24db51871ec8c79f3a1e4bd0557bc0dfcee9ed1d924e69d1c60dc",
    "b75c69d0b72a5d906e854e808ba7e2accb1542ac355ae486d591aa9d43765482e26cd02df835d3546d23c4b13e0dfc92",
];
const ROUND_1000: [&str; 2] = [
    "fe290beca10872ef2fb164d2aa4442de4566183ec51c56ff3cd603d930e54fdd",
    "b44679b9a59af2ec876b1a6b1ad52ea9b1615fc3982b19576350f93447cb1125e342b73a8dd2bacbe47e4b6b63ed5e39",
];

fn drand(folder: &Path, name: &str, round: u64, [value, signature]: [&str; 2]) {
    let rest = format!("\"randomness\": \"{value}\", \"signature\": \"{signature}\"");
    let text = format!("{{ \"source\": \"drand quicknet\", \"round\": {round}, {rest} }}");
    fs::write(folder.join(name), text).unwrap();
}

fn beacon(folder: &Path, name: &str, source: &str, round: u64, value: &str) {
    let text = format!("{{ \"source\": \"{source}\", \"round\": {round}, \"value\": \"{value}\" }}");
    fs::write(folder.join(name), text).unwrap();
}

#[test]
fn a_sealed_month_waits_for_its_beacon() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let append = |more: &[&str], status: i32, words: &str| {
        says(
            folder,
            &[&["trust", "log", "append", "log", "--secret", "log.key"], more].concat(),
            status,
            words,
        );
    };
    let check = |more: &[&str], status: i32, words: &str| {
        says(folder, &[&["trust", "log", "check", "log", "--key", "log.pub"], more].concat(), status, words);
    };
    run(folder, &["trust", "keygen", "log", "--no-password"], 0);
    let unknown = RECIPE.replace("quicknet", "quiknet").replace("COMMITMENT", &"0".repeat(64));
    fs::write(folder.join("2027-01.toml"), unknown).unwrap();
    says(
        folder,
        &["release", "2027-01.toml", "--commit"],
        2,
        "isn't a drand network: write `drand quicknet`",
    );
    append(&["--commitment", "2027-01.toml"], 2, "isn't a drand network: write `drand quicknet`");
    commit(folder, &|commitment| RECIPE.replace("COMMITMENT", commitment));

    append(&["--commitment", "2027-01.toml"], 2, "a new log needs a name: --origin");
    append(&["--commitment", "2027-01.toml", "--origin", "x y"], 2, "isn't a valid name for a log");
    append(
        &["--commitment", "2027-01.toml", "--origin", "example.org/arcade"],
        0,
        "2027-01, with round 1000 of drand quicknet",
    );
    append(&["--commitment", "2027-01.toml"], 2, "a publisher may commit only once");
    run(folder, &["trust", "log", "check", "log", "--key", "log.pub", "--save", "seen"], 0);

    // Nothing is minted before the value is known, or with a different value.
    let mint = ["release", "2027-01.toml", "--secret", "2027-01.secret.json", "--out", "out"];
    says(folder, &mint, 2, "pass its value with --beacon FILE, once it is published");
    let minted = |file: &str, words: &str| {
        says(folder, &[&mint[..], &["--beacon", file]].concat(), 2, words);
    };
    drand(folder, "other.json", 123, ROUND_123);
    minted("other.json", "specifies round 1000 of drand quicknet");
    // A value that the publisher prefers lacks the network's signature.
    beacon(folder, "chosen.json", "drand quicknet", 1000, &"ab".repeat(32));
    minted("chosen.json", "has no `signature` of round 1000 of drand quicknet");
    drand(folder, "chosen.json", 1000, ROUND_123);
    minted("chosen.json", "its `signature` does not belong to round 1000 of drand quicknet");
    append(&["--beacon", "chosen.json"], 2, "its `signature` does not belong to round 1000");
    drand(folder, "round.json", 1000, ROUND_1000);
    run(folder, &[&mint[..], &["--beacon", "round.json"]].concat(), 0);
    run(folder, &["verify", "out/public"], 0);
    append(
        &["--release", "out/public"],
        2,
        "sign it first with `arcade trust sign out/public --secret NAME.key`, or append it without a \
         signature with --unsigned",
    );
    append(
        &["--release", "out/public", "--unsigned"],
        2,
        "uses round 1000 of drand quicknet, whose value is not in the log",
    );
    let copy = folder.join("copy");
    copy_tree(&folder.join("log"), &copy);
    append(&["--beacon", "round.json", "--release", "out/public", "--unsigned"], 0, "3 entries");
    let reveal = ["release", "out/public", "--reveal", "out/held", "--out", "revealed"];
    run(folder, &reveal, 0);
    run(folder, &["verify", "revealed"], 0);
    run(folder, &["regenerate", "revealed"], 0);
    append(&["--reveal", "revealed"], 0, "reveal       2027-01");
    check(
        &["--seen", "seen", "--save", "seen-2", "--month", "2027-01", "--release", "revealed"],
        0,
        "sound; 4 entries",
    );
    check(
        &["--month", "2027-01", "--release", "out"],
        0,
        "the release of 2027-01 is entry 2\n`out/public`: `2027-01` is entry 2",
    );
    says(
        folder,
        &["trust", "log", "show", "log"],
        0,
        "    3  reveal       2027-01\nexample.org/arcade: 4 entries, not checked",
    );
    append(
        &["--reveal", "out"],
        2,
        "join its two parts with `arcade release out/public --reveal out/held --out DIR`",
    );
    check(&["--month", "2027-02"], 1, "the log has no release of 2027-02 or later");
    check(&["--month", "2027-13"], 2, "not a month: write a year and a month, such as 2027-03");
    check(&["--proof", "proof", "--entry", "entry"], 2, "cannot be used with");

    // Proofs are checked without the log.
    let prove = |more: &[&str], status: i32, words: &str| {
        says(folder, &[&["trust", "log", "prove", "log"], more].concat(), status, words);
    };
    prove(&["--release", "2027-01", "--out", "proof", "--write-entry", "entry"], 0, "proof of entry 2 of 4");
    prove(&["--release", "2027-02", "--out", "x"], 2, "`2027-02` is not in the log");
    prove(&["--entry", "9", "--out", "x"], 2, "there is no entry 9");
    prove(&["--since", "seen", "--out", "growth"], 0, "from 1 to 4 entries");
    let proved = ["trust", "log", "check", "--key", "log.pub", "--proof", "proof", "--entry"];
    says(folder, &[&proved[..], &["entry"]].concat(), 0, "entry 2 of 4 in the log example.org/arcade");
    says(folder, &[&proved[..], &["2027-01.toml"]].concat(), 1, "NOT proven");
    let growth = ["trust", "log", "check", "--key", "log.pub", "--growth", "growth", "--seen"];
    says(folder, &[&growth[..], &["seen"]].concat(), 0, "has grown from 1 to 4 entries");
    says(folder, &[&growth[..], &["seen-2"]].concat(), 1, "NOT proven to be append-only");

    // A witness signs only extensions of the checkpoint that it signed before.
    run(folder, &["trust", "keygen", "w", "--no-password"], 0);
    let witness = [
        "trust",
        "log",
        "cosign",
        "log",
        "--key",
        "log.pub",
        "--witness",
        "w.example",
        "--secret",
        "w.key",
        "--time",
        "1",
    ];
    check(&["--witness", "w.example=w.pub"], 1, "the witness `w.example` has not signed");
    says(
        folder,
        &[&witness[..], &["--seen", "seen-2"]].concat(),
        2,
        "pass the checkpoint that the witness signed last",
    );
    run(folder, &witness, 0);
    check(&["--witness", "w.example=w.pub", "--seen", "seen-2", "--save", "witnessed"], 0, "sound");
    run(folder, &[&witness[..], &["--seen", "witnessed"]].concat(), 0);

    // The copy is rolled back to its first entry and continued in a different way.
    let rolled = ["trust", "log", "check", "copy", "--key", "log.pub", "--seen", "seen-2"];
    says(folder, &rolled, 1, "the log was rolled back: 4 entries were seen before, but now it has only 1");
    let forks =
        ["trust", "log", "append", "copy", "--secret", "log.key", "--beacon", "dice.json", "other.json"];
    beacon(folder, "dice.json", "dice", 1, &"ef".repeat(32));
    says(folder, &forks, 0, "round 1 of dice, as stated in the log");
    beacon(folder, "third.json", "dice", 2, &"01".repeat(32));
    run(folder, &["trust", "log", "append", "copy", "--secret", "log.key", "--beacon", "third.json"], 0);
    says(folder, &rolled, 1, "the log has forked: its first 4 entries differ from the entries seen before");
    says(
        folder,
        &["trust", "log", "check", "copy", "--key", "log.pub", "--release", "revealed"],
        1,
        "is not in the log",
    );
    says(folder, &["trust", "log", "check", "copy", "--key", "w.pub"], 1, "is not signed by the key");
    says(folder, &["trust", "log", "check", "revealed", "--key", "w.pub"], 2, "has no `checkpoint` file");
    // If files are damaged, that is an answer too.
    let entries = folder.join("copy/tile/entries/000.p/4");
    let bytes = fs::read(&entries).unwrap();
    let copy = ["trust", "log", "check", "copy", "--key", "log.pub"];
    fs::write(&entries, &bytes[..bytes.len() - 1]).unwrap();
    says(folder, &copy, 1, "does not hold 4 entries");
    fs::write(&entries, text(&bytes).replacen("\"commitment\"", "\"Commitment\"", 1)).unwrap();
    says(folder, &copy, 1, "the log is NOT sound");
    fs::remove_file(&entries).unwrap();
    says(folder, &copy, 1, "the log was truncated");
}

/// A commitment cannot be withdrawn. Therefore, a commitment after which its release's root could not be
/// appended is rejected.
#[test]
fn a_commitment_that_leads_nowhere_is_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let append = |more: &[&str], status: i32, words: &str| {
        says(
            folder,
            &[&["trust", "log", "append", "log", "--secret", "log.key"], more].concat(),
            status,
            words,
        );
    };
    run(folder, &["trust", "keygen", "log", "--no-password"], 0);
    copy_tree(&TINY.path().join("tiny"), &folder.join("tiny"));
    let february = |commitment: &str| {
        RECIPE
            .replace("2027-01", "2027-02")
            .replace("COMMITMENT", commitment)
            .split("[beacon]")
            .next()
            .unwrap()
            .to_owned()
    };
    fs::write(folder.join("2027-02.toml"), february(&"0".repeat(64))).unwrap();
    let said = text(&run(folder, &["release", "2027-02.toml", "--commit", "--parent", "tiny"], 0).stdout);
    let line = |words: &str| said.lines().find_map(|line| line.trim().strip_prefix(words)).unwrap().trim();
    let commitment = line("commitment =").trim_matches('"').to_owned();
    assert!(said.contains("instead of `seed` or, if there is none, above the first [table]"), "{said}");
    fs::write(folder.join("2027-02.toml"), february(&commitment)).unwrap();

    // The parent is not in the log, so the release could not be in it either.
    let first = ["--commitment", "2027-02.toml", "--parent", "tiny", "--origin", "example.org/arcade"];
    append(&first, 2, "which is not in the log, so its own root could not be appended later");
    append(&["--release", "tiny", "--unsigned", "--origin", "example.org/arcade"], 0, "after no release");
    // In the first case, the parent was forgotten. In the second, it was omitted on purpose, but the
    // commitment contains it. In the third, the recipe differs.
    append(
        &["--commitment", "2027-02.toml"],
        2,
        "the log already has `tiny`: pass the previous release with --parent DIR",
    );
    append(&["--commitment", "2027-02.toml", "--first"], 2, "did you forget --parent?");
    let changed = february(&commitment).replace("candidates = 2.0", "candidates = 3.0");
    fs::write(folder.join("2027-02.toml"), changed).unwrap();
    append(&["--commitment", "2027-02.toml", "--parent", "tiny"], 2, "more than that line was changed");
    fs::write(folder.join("2027-02.toml"), february(&commitment)).unwrap();
    assert!(text(&run(folder, &["trust", "log", "show", "log"], 0).stdout).contains("1 entry, not checked"));

    // The command that `--commit` printed works as printed.
    let command = shlex::split(line("if you keep a log, append the commitment first:")).unwrap();
    let arguments: Vec<&str> = command.iter().skip(1).map(String::as_str).collect();
    says(folder, &arguments, 0, "commitment   2027-02, after `tiny`");
}

/// If a log states a key set that is later created anew, the log can state no further key set.
#[test]
fn a_set_of_keys_that_nobody_follows_is_not_entered() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    for name in ["log", "ada", "bo"] {
        run(folder, &["trust", "keygen", name, "--no-password"], 0);
    }
    let keys =
        |more: &[&str], status: i32| run(folder, &[&["trust", "keys", "trust"], more].concat(), status);
    let append = |file: &str, status: i32, words: &str| {
        let log = ["trust", "log", "append", "log", "--secret", "log.key", "--origin", "x.org/y", "--keys"];
        says(folder, &[&log[..], &[file]].concat(), status, words);
    };
    keys(&["--add", "ada=ada.pub"], 0);
    append("trust/keys-1.json", 0, "keys         1");
    keys(&["--add", "bo=bo.pub"], 1);
    append("trust/keys-2.json", 2, "sign the set with `arcade trust keys trust --secret FILE...`");
    keys(&["--secret", "ada.key"], 0);
    append("trust/keys-2.json", 0, "keys         2");
}

/// Returns a scale with one release and without examinees (reference players).
fn scale_of(root: &Value) -> String {
    let none = json!({ "value": 0.0, "error": 1.0 });
    let names = ["game", "level", "family", "planner", "game_slope", "level_slope"];
    let names = names.into_iter().chain(["game_rest", "level_rest", "reader"]);
    let spreads: Value = names.map(|name| (name.to_owned(), json!(1.0))).collect::<Map<_, _>>().into();
    let month = json!({
        "name": "tiny", "snapshot": root, "seed": "x", "shifts": [none, none], "planners_shift": none,
        "link": [0.0, 0.0], "anchors": 0, "drift": null, "games": [],
    });
    let scale = json!({
        "format": 1, "suite": "0.13.0", "max_steps": 60, "examinees": [], "spreads": spreads,
        "covariance": [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], "origins": [0.0, 0.0], "ease": 0.0,
        "correlation": null, "replicates": 0, "months": [month],
    });
    scale.to_string()
}

/// For missing files and files of the wrong kind, each message states the file and the next step.
#[test]
fn wrong_files_are_named() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    copy_tree(&TINY.path().join("tiny"), &folder.join("tiny"));
    run(folder, &["trust", "keygen", "log", "--no-password"], 0);
    let log = ["trust", "log", "append", "log", "--secret", "log.key", "--origin", "example.org/arcade"];
    run(folder, &[&log[..], &["--release", "tiny", "--unsigned"]].concat(), 0);
    fs::write(folder.join("empty"), "").unwrap();
    fs::write(folder.join("binary"), [0xff, 0xfe, 0, 1]).unwrap();
    fs::write(folder.join("long"), vec![b'a'; 1 << 17]).unwrap();
    fs::create_dir(folder.join("folder")).unwrap();
    for file in ["empty", "binary", "long", "folder", "missing"] {
        let next = |of_content: &'static str| match file {
            "long" => "the limit for such a file: check the path",
            "folder" => "is a folder: pass a file in it",
            "missing" => "does not exist: check the path",
            _ => of_content,
        };
        let shown = format!("`{file}`");
        let cases: [(&[&str], &str); 8] = [
            (
                &["trust", "log", "check", "log", "--key", file],
                next("pass the NAME.pub from `arcade trust keygen`, or the keys-N.json from"),
            ),
            (
                &["trust", "log", "check", "log", "--key", "log.pub", "--seen", file],
                next("pass a log's `checkpoint` file"),
            ),
            (
                &["trust", "log", "check", "--key", "log.pub", "--proof", file, "--entry", "log.pub"],
                next("pass the file that `arcade trust log prove --out` wrote"),
            ),
            (
                &["trust", "log", "append", "log", "--secret", "log.key", "--beacon", file],
                next("write the source's answer together with its name"),
            ),
            (
                &["trust", "log", "append", "log", "--secret", file, "--release", "tiny", "--unsigned"],
                next("use the file `NAME.key`"),
            ),
            (&["trust", "sign", "tiny", "--secret", file], next("use the file `NAME.key`")),
            (
                &["verify", "tiny", "--key", file],
                next("pass the NAME.pub from `arcade trust keygen`, or the keys-N.json from"),
            ),
            (
                &[
                    "trust",
                    "log",
                    "cosign",
                    "log",
                    "--key",
                    "log.pub",
                    "--witness",
                    "w",
                    "--time",
                    "1",
                    "--secret",
                    file,
                ],
                next("use the file `NAME.key`"),
            ),
        ];
        for (args, words) in cases {
            says(folder, args, 2, words);
            says(folder, args, 2, &shown);
        }
    }
    fs::write(folder.join("other.json"), "{}").unwrap();
    let other = ["verify", "tiny", "--key", "other.json"];
    says(
        folder,
        &other,
        2,
        "`other.json`: cannot be read: missing field `format` at line 1 column 2; pass the",
    );
    let beside = ["trust", "sign", "tiny", "--secret", "log.key", "--out", "empty"];
    says(folder, &beside, 2, "there is a file where its folder should be; choose another folder");
    let slip = ["trust", "log", "append", "lag", "--secret", "log.key", "--release", "tiny", "--unsigned"];
    says(folder, &slip, 2, "`lag` contains no log, and a new log needs a name: --origin");
    assert!(!folder.join("lag").exists());
    says(
        folder,
        &["trust", "keygen", "k", "--password-file", "binary"],
        2,
        "save the password as a UTF-8 text file",
    );
    says(folder, &["trust", "keygen", "k", "--password-file", "empty"], 2, "the password is empty");
    let at_file = [
        "trust",
        "log",
        "append",
        "empty",
        "--secret",
        "log.key",
        "--release",
        "tiny",
        "--origin",
        "x.org/y",
    ];
    says(folder, &at_file, 2, "`empty` is a file: choose a folder for the log");
    let replay = ["trust", "log", "check", "log", "--key", "log.pub", "--replay", "empty"];
    says(folder, &replay, 2, "`empty` is a file: pass the folder that `arcade evaluate --out` wrote");
}

#[test]
fn rows_are_replayed() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    copy_tree(&TINY.path().join("tiny"), &folder.join("tiny"));
    run(folder, &["trust", "keygen", "log", "--no-password"], 0);
    run(
        folder,
        &["evaluate", "tiny", "--player", "nearest-goal", "--max-steps", "60", "--out", "results"],
        0,
    );
    let append = ["trust", "log", "append", "log", "--secret", "log.key", "--origin", "example.org/arcade"];
    says(folder, &[&append[..], &["--result", "results"]].concat(), 2, "which is not in the log");
    says(
        folder,
        &[&append[..], &["--release", "tiny", "--unsigned", "--result", "results"]].concat(),
        0,
        "nearest-goal, horizon 1",
    );
    let again = [&append[..], &["--result", "results"]].concat();
    says(folder, &again, 2, "are already in the log");
    let check = ["trust", "log", "check", "log", "--key", "log.pub", "--replay", "results"];
    says(folder, &check, 0, "sound; 2 entries");
    let calibrated = |given: &str, status: i32, words: &str| {
        says(folder, &[&append[..], &["--calibration", given]].concat(), status, words);
    };
    let manifest: Value =
        serde_json::from_slice(&fs::read(folder.join("tiny/MANIFEST.json")).unwrap()).unwrap();
    fs::write(folder.join("scale.json"), scale_of(&manifest["root"])).unwrap();
    fs::write(folder.join("other.json"), scale_of(&"ab".repeat(32).into())).unwrap();
    fs::write(folder.join("latin"), b"\xff").unwrap();
    calibrated("tiny=scale.json", 0, "calibration  tiny");
    calibrated("huge=scale.json", 2, "`huge` is not in the log");
    calibrated("tiny=other.json", 2, "the scale has no release with the root of `tiny`");
    calibrated("tiny=log.pub", 2, "pass the scale.json that `arcade study calibrate` wrote");
    calibrated("tiny=latin", 2, "is not UTF-8); pass the scale.json that `arcade study calibrate` wrote");

    // A link could lead in a circle.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(".", folder.join("results/games/again")).unwrap();
        says(folder, &check, 2, "`results/games/again` is a link, or not a file: restore the results folder");
        fs::remove_file(folder.join("results/games/again")).unwrap();
    }

    // An episode's log has an altered result. The results folder no longer matches the row, and the episode
    // does not replay.
    let episodes = folder.join("results/episodes");
    let episode = fs::read_dir(&episodes).unwrap().map(|entry| entry.unwrap().path()).min().unwrap();
    let honest = fs::read_to_string(&episode).unwrap();
    let altered = match honest.contains("\"outcome\":\"won\"") {
        true => honest.replace("\"outcome\":\"won\"", "\"outcome\":\"lost\""),
        false => {
            honest.replace("\"outcome\":\"lost\"", "\"outcome\":\"won\"").replace("\"ongoing\"", "\"won\"")
        }
    };
    assert_ne!(honest, altered);
    fs::write(&episode, altered).unwrap();
    says(folder, &check, 1, "no row in the log has the digest of these results");
    let said = text(&run(folder, &again, 2).stderr);
    assert!(!said.contains("are already in the log"), "{said}");
}

/// The Python program shares no code with `arcade`. If it cannot run, a note states this.
#[test]
#[allow(clippy::print_stdout, reason = "a skipped test says so")]
fn an_independent_program_agrees() {
    let python = |code: &str| Command::new("python3").args(["-c", code]).output();
    if !python("import cryptography").is_ok_and(|output| output.status.success()) {
        println!("SKIPPED: python3 with the package cryptography is not installed");
        return;
    }
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    copy_tree(&TINY.path().join("tiny"), &folder.join("releases/tiny"));
    for name in ["log", "ada"] {
        run(folder, &["trust", "keygen", name, "--no-password"], 0);
    }
    run(folder, &["trust", "keys", "keys", "--add", "ada=ada.pub"], 0);
    run(folder, &["trust", "sign", "releases/tiny", "--secret", "ada.key", "--keys", "keys/keys-1.json"], 0);
    let append = ["trust", "log", "append", "log", "--secret", "log.key", "--origin", "example.org/arcade"];
    fs::create_dir(folder.join("beacons")).unwrap();
    drand(folder, "beacons/round.json", 1000, ROUND_1000);
    let appended =
        ["--keys", "keys/keys-1.json", "--beacon", "beacons/round.json", "--release", "releases/tiny"];
    run(folder, &[&append[..], &appended].concat(), 0);
    let program = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tools/scripts/trust/check.py");
    let check = || {
        let flags = ["--log", "log", "--log-key", "log.pub", "--keys", "keys/keys-1.json"];
        let flags = [&flags[..], &["--releases", "releases", "--beacons", "beacons"]].concat();
        let output = Command::new("python3").arg(&program).args(flags).current_dir(folder).output().unwrap();
        (output.status.code(), text(&output.stdout) + &text(&output.stderr))
    };
    let (status, said) = check();
    let held = said.starts_with("3 entries, 1 releases, 1 sets of keys, 1 beacons");
    // Without py_ecc, the program states that the round's signature was not checked.
    assert!(status == Some(0) && held && said.ends_with(": sound\n"), "{said}");
    let level =
        files(&folder.join("releases/tiny")).into_keys().find(|name| name.ends_with("lvl0.txt")).unwrap();
    fs::write(folder.join("releases/tiny").join(&level), "w").unwrap();
    let (status, said) = check();
    assert!(status == Some(1) && said.contains("does not match the manifest"), "{said}");
}
