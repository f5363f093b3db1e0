//! `arcade validate` on malformed and hostile files.

use super::*;

/// Expects exit status 2, and a message that contains the file, the line and the given words.
#[track_caller]
fn malformed(game: &str, level: &str, place: &str, words: &[&str]) {
    let folder = folder(game, level);
    let output = run(folder.path(), &["validate", "."], 2);
    let message = text(&output.stderr);
    for part in words.iter().chain([&place]) {
        assert!(message.contains(part), "`{part}` is not in\n{message}");
    }
}

#[test]
fn malformed_games_are_named_with_line_and_help() {
    malformed(
        &GAME.replace("stepBack", "stepBakc"),
        LEVEL,
        "game.vgdl:15:",
        &["unknown-effect", "`stepBack`?"],
    );
    malformed(&GAME.replace("avatar thorn >", "avatar thron >"), LEVEL, "game.vgdl:16:", &["`thorn`?"]);
    let (head, _) = GAME.split_once("    TerminationSet").unwrap();
    malformed(head, LEVEL, "game.vgdl:1:", &["missing-section", "TerminationSet"]);
    malformed(&GAME.replace("MovingAvatar", "MovnigAvatar"), LEVEL, "game.vgdl:7:", &["`MovingAvatar`?"]);
    malformed(&GAME.replace("limit=300", "limt=300"), LEVEL, "game.vgdl:21:", &["`limit`?"]);
    malformed("", LEVEL, "game.vgdl", &["contains no game"]);
    malformed("\u{1}\u{2}ELF", LEVEL, "game.vgdl", &["control character"]);
}

#[test]
fn malformed_levels_are_named_with_line_and_help() {
    malformed(GAME, &LEVEL.replace("..w\nww", "Q.w\nww"), "lvl0.txt:5:8", &["undefined-character", "`Q`"]);
    malformed(GAME, &LEVEL.replace("wn", "wA"), "lvl0.txt:5:2", &["extra-avatars", "2 avatars"]);
    malformed(GAME, &LEVEL.replace('A', "."), "lvl0.txt:1:1", &["no-avatar", "put `A`"]);
    malformed(GAME, "", "lvl0.txt", &["empty"]);
}

#[test]
fn all_problems_of_a_file_come_in_one_run() {
    let broken =
        GAME.replace("stepBack", "stepBakc").replace("stype=nectar", "stype=necta").replace("BROWN", "BRWN");
    let folder = folder(&broken, LEVEL);
    let output = run(folder.path(), &["--json", "validate", "."], 2);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let lines: Vec<u64> = document["problems"]
        .as_array()
        .unwrap()
        .iter()
        .map(|problem| problem["line"].as_u64().unwrap())
        .collect();
    assert_eq!(lines, [3, 15, 19]);
}

#[test]
fn hostile_files_get_a_limit_message_promptly() {
    let folder = folder(GAME, LEVEL);
    let path = |name: &str| folder.path().join(name);
    fs::write(path("binary.vgdl"), [0x7f, 0x45, 0x4c, 0x46, 0xff, 0xfe, 0x00]).unwrap();
    let output = run(folder.path(), &["validate", "binary.vgdl", "lvl0.txt"], 2);
    assert!(text(&output.stderr).contains("not a text file"));
    fs::File::create(path("huge.vgdl")).unwrap().set_len(50 << 20).unwrap();
    let output = run(folder.path(), &["validate", "huge.vgdl", "lvl0.txt"], 2);
    assert!(text(&output.stderr).contains("larger than"));
    fs::write(path("wide.txt"), format!("{}\n", "w".repeat(5000)).repeat(5000)).unwrap();
    let output = run(folder.path(), &["validate", "game.vgdl", "wide.txt"], 2);
    assert!(text(&output.stderr).contains("larger than"), "{}", text(&output.stderr));
    fs::write(path("tall.txt"), "A\n".repeat(5000)).unwrap();
    let output = run(folder.path(), &["validate", "game.vgdl", "tall.txt"], 2);
    assert!(text(&output.stderr).contains("5000 rows"), "{}", text(&output.stderr));
    let deep: String =
        (0..400).map(|depth| format!("{}a{depth} > Passive\n", " ".repeat(depth + 2))).collect();
    fs::write(path("deep.vgdl"), format!("BasicGame\n SpriteSet\n{deep}")).unwrap();
    let output = run(folder.path(), &["validate", "deep.vgdl", "lvl0.txt"], 2);
    assert!(text(&output.stderr).contains("nested"), "{}", text(&output.stderr));
}

#[test]
fn problems_of_the_game_hide_none_of_its_levels() {
    let broken = GAME.replace("stepBack", "stepBakc");
    let folder = folder(&broken, &LEVEL.replace('A', "X"));
    fs::write(folder.path().join("lvl1.txt"), LEVEL).unwrap();
    let output = run(folder.path(), &["validate", "."], 2);
    let said = text(&output.stderr);
    for words in
        ["unknown-effect", "lvl0.txt:2:2", "`X` is not in the LevelMapping", "the level places no avatar"]
    {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    assert!(!said.contains("lvl1.txt"), "{said}");
    let output = run(folder.path(), &["--json", "validate", "."], 2);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let codes: Vec<&str> = document["levels"][0]["problems"]
        .as_array()
        .unwrap()
        .iter()
        .map(|problem| problem["code"].as_str().unwrap())
        .collect();
    assert_eq!(codes, ["no-avatar", "undefined-character"]);
    assert_eq!(document["levels"][1]["problems"].as_array().unwrap().len(), 0);
    // Also of a sound game.
    malformed(
        GAME,
        &LEVEL.replace('A', "X"),
        "lvl0.txt:2:2",
        &["`X` is not", "no avatar", "did you mean `A`?"],
    );
}

#[test]
fn levels_named_as_games_are_reported() {
    let folder = folder(GAME, LEVEL);
    let said = text(&run(folder.path(), &["fmt", "lvl0.txt"], 2).stderr);
    assert!(said.contains("its game is game.vgdl: arcade fmt game.vgdl"), "{said}");
    fs::remove_file(folder.path().join("game.vgdl")).unwrap();
    for verb in ["validate", "describe", "fmt", "play"] {
        let output = run(folder.path(), &[verb, "lvl0.txt"], 2);
        let said = text(&output.stderr);
        let meant = "lvl0.txt: this is a level, not a game, and there is no game next to it; pass its game first: arcade validate GAME lvl0.txt";
        assert!(said.contains(meant), "{said}");
    }
}

#[test]
fn swapped_games_and_levels_are_reported() {
    let says = |game: &str, level: &str, words: &str| {
        let folder = folder(game, level);
        let said = text(&run(folder.path(), &["validate", "."], 2).stderr);
        assert!(said.contains(words), "{said}");
        assert!(said.lines().count() < 4, "{said}");
    };
    says(LEVEL, LEVEL, "game.vgdl: this is a level, not a game");
    says(GAME, GAME, "lvl0.txt: this is a game, not a level");
}

#[test]
fn levels_have_the_numbers_of_their_files() {
    let folder = folder(GAME, LEVEL);
    for name in ["lvl1.txt", "lvl3.txt"] {
        fs::write(folder.path().join(name), LEVEL.replace('A', "X")).unwrap();
    }
    fs::remove_file(folder.path().join("lvl0.txt")).unwrap();
    let said = text(&run(folder.path(), &["validate", ".", "1"], 2).stderr);
    assert!(said.contains("lvl1.txt:2:2"), "{said}");
    let said = text(&run(folder.path(), &["validate", ".", "0"], 2).stderr);
    assert!(said.contains("`0` is not a level of ., which has levels 1, 3"), "{said}");
}

#[test]
fn lines_without_the_avatar_are_reported_with_it() {
    let hidden = GAME.replace("A > floor avatar", "A > floor").replace("avatar", "bee");
    let line = "places the avatar `bee`: add it to a line, such as `A >";
    malformed(&hidden, LEVEL, "lvl0.txt", &[line]);
}

#[test]
fn consequences_of_other_faults_are_skipped() {
    let chased =
        GAME.replace("        avatar > Mov", "        wasp > PathChaser stype=avatar\n        avatar > Mov");
    let chased = chased.replace("        A > floor", "        c > floor wasp\n        A > floor");
    let said = folder(&chased, &LEVEL.replace("n...t", "nc..t"));
    let said = run(said.path(), &["validate", ".", "--budget", "2000"], 1);
    let said = text(&said.stdout);
    for words in ["`wasp > PathChaser stype=avatar`", "`BasicGame obs=wall`", "skipped: the game stops"] {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    assert!(!said.contains("remove the rule"), "{said}");
    // The level is lost in its first tick, regardless of the player's action.
    let over = folder(&GAME.replace("stype=avatar limit=0", "stype=avatar limit=1"), LEVEL);
    let said = text(&run(over.path(), &["validate", ".", "--budget", "2000"], 1).stdout);
    assert!(said.contains("FAILS well-formed: the game is lost in its first tick"), "{said}");
    let criteria = ["not-idle", "not-random", "early-death", "winnable", "length", "skill", "rule-use"];
    for criterion in criteria.into_iter().chain(["ablation"]) {
        let line = format!("  -    {criterion:<13}skipped: the game is over in its first tick\n");
        assert!(said.contains(&line), "`{line}` is not in\n{said}");
    }
    // Lost by waiting alone: there is play to judge.
    let pricked = folder(&GAME.replace("A > floor avatar", "A > floor thorn avatar"), LEVEL);
    let said = text(&run(pricked.path(), &["validate", ".", "--budget", "2000"], 1).stdout);
    assert!(said.contains("FAILS well-formed: the game is lost in its first tick"), "{said}");
    assert!(!said.contains("skipped: the game is over"), "{said}");
    let short = folder(&GAME.replace("limit=300", "limit=3"), LEVEL);
    let said = run(short.path(), &["validate", ".", "--budget", "20000"], 1);
    let said = text(&said.stdout);
    for words in [
        "the level cannot be won before `Timeout limit=3 win=False` ends the game",
        "raise its `limit=` beyond",
    ] {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    assert!(!said.contains("add a level that needs it"), "{said}");
}

#[test]
fn tabs_are_shown_and_reported() {
    let tabbed = GAME.replace("        avatar wall > stepBack", "\tavatar wall > stepBack");
    malformed(&tabbed, LEVEL, "game.vgdl:15:2", &["→avatar wall > stepBack", "a tab counts as one column"]);
}

#[test]
fn a_line_of_any_width_gets_a_message() {
    let folder = folder(GAME, LEVEL);
    let wide = [
        GAME.replace("        avatar thorn", &format!("{}avatar thorn", " ".repeat(66_000))),
        GAME.replace("    TerminationSet", &format!("    TerminationSet{}x", " ".repeat(66_000))),
        GAME.replace("stepBack", &format!("stepBack {}", "\t".repeat(70_000) + "=")),
        GAME.replace("stepBack", &"蟻".repeat(30_000)),
    ];
    for source in wide {
        fs::write(folder.path().join("wide.vgdl"), source).unwrap();
        for verb in ["validate", "describe", "fmt"] {
            let output = run(folder.path(), &[verb, "wide.vgdl"], 2);
            let said = text(&output.stderr);
            assert!(said.contains("wide.vgdl:") && said.len() < 9_000, "{} bytes of {said:.900}", said.len());
        }
    }
}

#[test]
fn duplicate_parameters_are_reported() {
    let folder = folder(&GAME.replace("color=YELLOW", "color=YELLOW speed=0.5 speed=1"), LEVEL);
    let said = text(&run(folder.path(), &["validate", "."], 0).stdout);
    assert!(
        said.contains("duplicate-parameter") && said.contains("`0.5` and `1`; the last value is used"),
        "{said}"
    );
}

#[cfg(unix)]
#[test]
fn non_unicode_paths_are_harmless() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = folder(GAME, LEVEL);
    let strange = OsStr::from_bytes(b"win-\xff.json");
    let command = |args: &[&str], more: &[&OsStr]| {
        crate::arcade::arcade(folder.path()).args(args).args(more).output().unwrap()
    };
    let output = command(&["validate", ".", "--witness"], &[strange]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(folder.path().join(strange).exists());
    let output = command(&["run", ".", "--planner", "random", "--runs", "1", "--csv"], &[strange]);
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    for verb in ["validate", "describe", "fmt", "play", "run"] {
        let output = command(&[verb], &[strange]);
        assert_eq!(output.status.code(), Some(2), "{verb}: {}", text(&output.stderr));
    }
}

#[test]
fn warnings_about_files_follow_the_verdict() {
    let game = GAME.replace("        SpriteCounter stype=avatar limit=0 win=False\n", "");
    let game = game.replace("        Timeout limit=300 win=False\n", "");
    let folder = folder(&game, &LEVEL.replace("t..w\n", "t..\n"));
    for arguments in
        [&["validate", ".", "--budget", "2000"][..], &["-q", "validate", ".", "--budget", "2000"]]
    {
        // Long lines of help are wrapped.
        let said =
            text(&run(folder.path(), arguments, 1).stdout).split_whitespace().collect::<Vec<_>>().join(" ");
        let place = |words: &str| said.find(words).unwrap_or_else(|| panic!("`{words}` is not in\n{said}"));
        let criteria = place("well-formed");
        assert!(place("game.vgdl does not pass") < place("no-lose") && place("no-lose") < criteria, "{said}");
        assert!(place("ragged-level") < criteria, "{said}");
        place(
            "removes the player's `avatar`, but the game continues: add `SpriteCounter stype=avatar win=False`",
        );
        // Each verdict other than a pass is shown with the requirement.
        place("asks: ");
    }
}
