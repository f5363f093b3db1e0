//! Tests of `arcade validate`, `arcade describe` and `arcade fmt` on good, bad and hostile files.

mod files;

use crate::arcade::{run, text};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;
use validators::CriterionSet;

const GAME: &str = "\
BasicGame
    SpriteSet
        wall > Immovable color=BROWN
        floor > Immovable hidden=True
        nectar > Immovable color=ORANGE
        thorn > Immovable color=DARKGREEN
        avatar > MovingAvatar color=YELLOW
    LevelMapping
        w > wall
        . > floor
        n > floor nectar
        t > floor thorn
        A > floor avatar
    InteractionSet
        avatar wall > stepBack
        avatar thorn > killSprite scoreChange=-1
        nectar avatar > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=nectar limit=0 win=True
        SpriteCounter stype=avatar limit=0 win=False
        Timeout limit=300 win=False
";

const LEVEL: &str = "wwwwwwwwww\nwA.t...t.w\nw.....t..w\nw.t.....nw\nwn...t...w\nwwwwwwwwww\n";

/// Creates a folder with a game and a level.
fn folder(game: &str, level: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("game.vgdl"), game).unwrap();
    fs::write(folder.path().join("lvl0.txt"), level).unwrap();
    folder
}

#[test]
fn a_good_level_passes_and_its_witness_replays() {
    let folder = folder(GAME, LEVEL);
    let output = run(folder.path(), &["validate", ".", "--witness", "win.json"], 0);
    assert!(text(&output.stdout).contains("1 of 1 levels meet every criterion"));
    let witness: engine::Episode =
        serde_json::from_slice(&fs::read(folder.path().join("win.json")).unwrap()).unwrap();
    let game = engine::Game::from_source(GAME).unwrap();
    let level = game.level(LEVEL).unwrap();
    assert_eq!(witness.replay(&game, &level).unwrap().outcome(), engine::Outcome::Won);
    // The same works by file, and gives the same answer twice.
    let args = ["--json", "validate", "game.vgdl", "lvl0.txt"];
    let (one, two) = (run(folder.path(), &args, 0), run(folder.path(), &args, 0));
    assert_eq!(one.stdout, two.stdout);
    let document: Value = serde_json::from_slice(&one.stdout).unwrap();
    assert_eq!(document["passes"], true);
}

/// Returns the judgement on the first level for a criterion.
fn judgement(document: &Value, criterion: &str) -> Value {
    let judgements = document["levels"][0]["judgements"].as_array().unwrap();
    judgements.iter().find(|judgement| judgement["criterion"] == criterion).unwrap().clone()
}

#[test]
fn a_goal_walled_in_fails_with_its_line_and_cell() {
    let walled = "wwwwwwwwww\nwA.t...t.w\nw.....twww\nw.t....wnw\nwn...t.www\nwwwwwwwwww\n";
    let folder = folder(GAME, walled);
    let output = run(folder.path(), &["--json", "validate", ".", "--budget", "200000"], 1);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let winnable = judgement(&document, "winnable");
    assert_eq!(winnable["verdict"], "fail");
    let seen = &winnable["evidence"][0];
    assert_eq!(seen["cell"], serde_json::json!([9, 4]));
    assert_eq!(seen["rule"]["line"], 19);
    let output = run(folder.path(), &["validate", "."], 1);
    let said = text(&output.stdout);
    let first = said.lines().next().unwrap();
    assert!(
        first.contains("lvl0.txt") && first.contains("FAILS winnable: the level cannot be won"),
        "{said}"
    );
    assert!(said.contains("column 9, row 4; ./game.vgdl:19 `SpriteCounter stype=nectar"), "{said}");
}

#[test]
fn unfound_wins_are_unknown() {
    // There are thorns all around the nectar, and a bee makes the game stochastic.
    let game = GAME
        .replace("        avatar > Mov", "        bee > RandomNPC\n        avatar > Mov")
        .replace("        A > floor", "        b > floor bee\n        A > floor")
        .replace("        avatar thorn", "        bee wall > stepBack\n        avatar thorn");
    let folder = folder(&game, "wwwwwwwwww\nwA......bw\nw....ttttw\nw....tn..w\nw....ttttw\nwwwwwwwwww\n");
    let output = run(folder.path(), &["--json", "validate", ".", "--budget", "200000"], 1);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let winnable = judgement(&document, "winnable");
    assert_eq!(winnable["verdict"], "unknown", "{winnable}");
    assert!(winnable["spent"].as_u64().unwrap() >= 200_000, "{winnable}");
}

#[test]
fn game_criteria_cover_all_levels() {
    // Each level alone lacks a required element, but together the levels have all of them.
    let folder = folder(GAME, "wwwwwwwwww\nwA.t...t.w\nw.....t..w\nw.t.....nw\nwn...t...w\nwwwwwwwwww\n");
    fs::write(folder.path().join("lvl1.txt"), "wwwwwwwww\nwA..n...w\nw.n...n.w\nwwwwwwwww\n").unwrap();
    let judgements = |args: &[&str], status| {
        let output = run(folder.path(), args, status);
        let document: Value = serde_json::from_slice(&output.stdout).unwrap();
        document["judgements"].as_array().unwrap().iter().map(|judged| judged["verdict"].clone()).collect()
    };
    let together: Vec<Value> = judgements(&["--json", "validate", "."], 1);
    assert_eq!(together, ["pass", "pass"]);
    // Random keys win the second level, so that level alone cannot judge the game.
    let alone: Vec<Value> = judgements(&["--json", "validate", ".", "1"], 1);
    assert!(alone.is_empty());
}

#[test]
fn gates_are_asked_of_a_game_with_all_its_levels() {
    let folder = folder(GAME, "wwwwwwww\nwA...n.w\nwwwwwwww\n");
    fs::write(folder.path().join("lvl1.txt"), LEVEL).unwrap();
    let output = run(folder.path(), &["--json", "validate", ".", "--gates", "--budget", "20000"], 1);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let judged = document["judgements"].as_array().unwrap();
    let asked: Vec<&str> = judged.iter().filter_map(|judgement| judgement["criterion"].as_str()).collect();
    assert!(CriterionSet::GATES.iter().all(|gate| asked.contains(&gate.name())), "{asked:?}");
    let refused = run(folder.path(), &["validate", ".", "1", "--gates"], 2);
    let refused = text(&refused.stderr);
    assert!(refused.contains("only 1 of 2 were given: `arcade validate . --gates`"), "{refused}");
    let refused = text(&run(folder.path(), &["play", ".", "--text"], 2).stderr);
    assert!(refused.contains("use --ascii to play with plain characters"), "{refused}");
}

#[test]
fn the_number_of_threads_changes_no_byte_of_a_verdict() {
    let folder = folder(GAME, LEVEL);
    let args = ["--json", "validate", ".", "--budget", "100000"];
    let [one, two] = ["1", "2"].map(|threads| {
        let mut command = crate::arcade::arcade(folder.path());
        command.env("RAYON_NUM_THREADS", threads).args(args).output().unwrap().stdout
    });
    assert!(!one.is_empty());
    assert_eq!(text(&one), text(&two));
}

#[test]
fn unreachable_goals_are_reported_with_their_cell() {
    let walled = "wwwwwwwwww\nwA.t...t.w\nw.....twww\nw.t....wnw\nwn...t.www\nwwwwwwwwww\n";
    let told = "but here nothing can ever end the nectar in column 9, row 4";
    let folder = folder(GAME, walled);
    let output = run(folder.path(), &["validate", ".", "--budget", "2000"], 1);
    assert!(text(&output.stdout).contains(told), "{}", text(&output.stdout));
    let output = run(folder.path(), &["describe", ".", "0"], 0);
    assert!(text(&output.stdout).contains(told), "{}", text(&output.stdout));
    let output = run(folder.path(), &["--json", "describe", ".", "lvl0.txt"], 0);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(document["level"]["can_win"], false);
    assert_eq!((&document["can_win"], &document["level"]["can_lose"]), (&true.into(), &true.into()));
}

#[test]
fn wins_by_doing_nothing_do_not_pass() {
    let folder = folder(&GAME.replace("limit=300 win=False", "limit=30 win=True"), LEVEL);
    let output = run(folder.path(), &["validate", "."], 1);
    assert!(text(&output.stdout).contains("doing nothing wins"), "{}", text(&output.stdout));
}

#[test]
fn malformed_requests_name_the_next_move() {
    let folder = folder(GAME, LEVEL);
    let says = |args: &[&str], status, words: &str| {
        let output = run(folder.path(), args, status);
        assert!(text(&output.stderr).contains(words), "{}", text(&output.stderr));
    };
    says(&["validate", "nowhere.vgdl"], 2, "there is no such file");
    says(&["validate", ".", "7"], 2, "`7` is not a level of ., which has only level 0");
    says(&["validate"], 2, "GAME");
    says(&["validat", "."], 2, "validate");
    says(&["release", "stater"], 2, "did you mean `starter`?");
    says(&["run", ".", "--planner", "mtcs"], 2, "did you mean `mcts`?");
    says(&["verify", "."], 2, "`.` is a game's folder");
    says(&["verify", "nowhere"], 2, "nowhere");
}

#[test]
fn fmt_is_idempotent_and_checks() {
    let folder = folder(GAME, LEVEL);
    run(folder.path(), &["fmt", "game.vgdl", "--check"], 0);
    fs::write(
        folder.path().join("loose.vgdl"),
        GAME.replace(" > ", "  >  ").replace("    TerminationSet", "  TerminationSet"),
    )
    .unwrap();
    run(folder.path(), &["fmt", "loose.vgdl", "--check"], 1);
    let output = run(folder.path(), &["fmt", "loose.vgdl"], 0);
    assert_eq!(text(&output.stdout), GAME);
    fs::write(folder.path().join("broken.vgdl"), GAME.replace("n > floor", "n floor")).unwrap();
    let output = run(folder.path(), &["fmt", "broken.vgdl"], 2);
    assert!(text(&output.stderr).contains("broken.vgdl:11:"), "{}", text(&output.stderr));
}

#[test]
fn rules_are_described() {
    let folder = folder(GAME, LEVEL);
    let output = run(folder.path(), &["describe", "game.vgdl"], 0);
    let said = text(&output.stdout);
    for words in [
        "You are the avatar",
        "You win when no nectar is left",
        "You die on touching the thorn",
        "\nKind of game:\n  Genre: puzzle and collect.\n  Turn-based:",
    ] {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    let output = run(folder.path(), &["describe", "game.vgdl", "--json"], 0);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let taxonomy = serde_json::json!({
        "time": "turn-based",
        "spatiality": "grid",
        "genres": ["puzzle", "collect"],
        "chance": false,
        "hidden": false,
    });
    assert_eq!(document["taxonomy"], taxonomy);
}

#[test]
fn planners_play_and_report() {
    let folder = folder(GAME, LEVEL);
    let common = ["run", ".", "--planner", "random,mcts,olets:50", "--budget", "200", "--runs", "3"];
    let report = |more: &[&str]| run(folder.path(), &[&common[..], more].concat(), 0);
    let csv = |name: &str| fs::read_to_string(folder.path().join(name)).unwrap();

    let output = report(&["--csv", "one.csv", "--jobs", "1", "--by-level"]);
    let table = text(&output.stdout);
    assert!(table.contains(" lvl0 ") && table.contains("olets"), "{table}");
    let first = csv("one.csv");
    assert!(first.starts_with("game,planner,budget,level,run,outcome,score,ticks,calls\n"), "{first}");
    assert_eq!(first.lines().count(), 1 + 3 * 3, "{first}");
    // Speeds depend on this machine, so they are not part of the answer.
    assert!(text(&output.stderr).contains("olets:50: "), "{}", text(&output.stderr));

    let output = report(&["--csv", "two.csv", "--jobs", "2", "--json"]);
    assert_eq!(csv("two.csv"), first);
    assert_eq!(output.stdout, report(&["--jobs", "1", "--json"]).stdout);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let rows = document["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 3);
    assert_eq!((&rows[2]["planner"], &rows[2]["budget"]), (&"olets".into(), &50.into()));
    assert_eq!((&rows[1]["plays"], &rows[1]["level"]), (&3.into(), &Value::Null));

    // The results do not depend on the other planners in the run.
    let alone = run(folder.path(), &["run", ".", "--planner", "mcts:200", "--runs", "3", "--json"], 0);
    let alone: Value = serde_json::from_slice(&alone.stdout).unwrap();
    assert_eq!(alone["rows"][0], rows[1]);
    run(folder.path(), &["run", ".", "--jobs", "0"], 2);
}

/// A corridor in which the exit opens for two lamps.
const CORRIDOR: &str = "\
BasicGame
    SpriteSet
        wall > Immovable
        lamp > Resource limit=3
        exit > Door
        avatar > MovingAvatar
    LevelMapping
        w > wall
        L > lamp
        g > exit
    InteractionSet
        avatar wall > stepBack
        lamp avatar > collectResource
        exit avatar > killIfOtherHasMore resource=lamp limit=2
    TerminationSet
        SpriteCounter stype=exit win=True
        Timeout limit=100 win=False
";

#[test]
fn a_level_that_cannot_be_won_is_explained_as_a_chain() {
    let folder = folder(CORRIDOR, "wwwwwwwww\nwA  L  gw\nwwwwwwwww\n");
    let said = text(&run(folder.path(), &["validate", "."], 1).stdout);
    for words in [
        "FAILS winnable: the level cannot be won: the exit opens for 2 lamps; 1 lamp exists; no rule creates more\n",
        "column 8, row 2; ./game.vgdl:16 `SpriteCounter stype=exit win=True`",
        "- the exit opens for 2 lamps; ./game.vgdl:14 `exit avatar > killIfOtherHasMore resource=lamp limit=2`",
        "- 1 lamp exists; column 5, row 2; ./game.vgdl:13 `lamp avatar > collectResource`",
        "try: place 1 lamp more, or require only 1",
        // These criteria do not apply to the level.
        "-    length       skipped: the level cannot be won",
        "-    skill        skipped: the level cannot be won",
    ] {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    assert!(!said.contains("open a path") && !said.contains("pass skill"), "{said}");
    // The fields of the JSON document are unchanged.
    let output = run(folder.path(), &["--json", "validate", "."], 1);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let skill = judgement(&document, "skill");
    assert_eq!((&skill["verdict"], &skill["spent"]), (&"unknown".into(), &0.into()));
    assert_eq!(document["levels"][0]["out_of_reach"].as_array().unwrap().len(), 1);
}

#[test]
fn a_swapped_rule_is_named_with_its_repair() {
    let swapped = CORRIDOR.replace("lamp avatar >", "avatar lamp >");
    let folder = folder(&swapped, "wwwwwwwww\nwA L L gw\nwwwwwwwww\n");
    let said = text(&run(folder.path(), &["validate", "."], 1).stdout);
    for words in ["game.vgdl:13:9", "swapped-rule", "did you mean `lamp avatar > collectResource`?"] {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    assert!(!said.contains("never-fires"), "{said}");
    let headline = "FAILS well-formed: the game cannot be won with `avatar lamp > collectResource` as it stands, \
                    but may be winnable with the two sides swapped (./game.vgdl:13)\n";
    assert!(said.contains(headline), "{said}");
}

#[test]
fn no_verdict_contradicts_another() {
    // The search wins the level, but no reference player on the ladder does. Both facts are reported.
    let folder = folder(GAME, LEVEL);
    let said = text(&run(folder.path(), &["validate", "."], 0).stdout);
    assert!(said.contains("the witness wins in ") && said.contains("proven minimal"), "{said}");
    assert!(said.contains("ticks on average") && !said.contains(", unbeaten"), "{said}");
}

#[test]
fn counts_of_nothing_are_refused() {
    let folder = folder(GAME, LEVEL);
    for args in [
        &["validate", ".", "--budget", "0"][..],
        &["validate", ".", "--budget", "-5"],
        &["run", ".", "--runs", "0"],
        &["run", ".", "--max-ticks", "0"],
        &["run", ".", "--budget", "-5"],
    ] {
        let said = text(&run(folder.path(), args, 2).stderr);
        assert!(said.contains("invalid value") && !said.contains("'-- -5'"), "{said}");
    }
}

#[test]
fn a_small_budget_is_a_small_piece_of_work() {
    // No player needs fewer than 300 ticks, and no player decides with fewer calls than its minimum.
    let game = GAME
        .replace("        avatar > Mov", "        bee > RandomNPC\n        avatar > Mov")
        .replace("        A > floor", "        b > floor bee\n        A > floor")
        .replace("        avatar thorn", "        bee wall > stepBack\n        avatar thorn");
    let folder = folder(&game, "wwwwwwwwww\nwA......bw\nw....ttttw\nw....tn..w\nw....ttttw\nwwwwwwwwww\n");
    let output = run(folder.path(), &["--json", "validate", ".", "--budget", "1"], 1);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let skill = judgement(&document, "skill");
    assert_eq!(skill["verdict"], "unknown");
    let rungs = skill["ladder"]["rungs"].as_array().unwrap();
    let held_out = skill["ladder"]["held_out"].as_array().unwrap();
    let calls = rungs.iter().chain(held_out).map(|fared| fared["rate"]["calls"].as_u64().unwrap());
    assert!(calls.sum::<u64>() < 5_000, "{skill}");
}

/// A raft that carries a duckling over a pond.
const FERRY: &str = include_str!("../../../../../tests/suite/levels/good/one-ferry/game.vgdl");

const POND: &str = include_str!("../../../../../tests/suite/levels/good/one-ferry/lvl0.txt");

#[test]
fn a_rule_that_carries_is_not_called_idle() {
    let folder = folder(FERRY, POND);
    let output = run(folder.path(), &["--json", "validate", ".", "--budget", "100000"], 0);
    let document: Value = serde_json::from_slice(&output.stdout).unwrap();
    let ablation = &document["judgements"][1];
    assert_eq!((&ablation["criterion"], &ablation["verdict"]), (&"ablation".into(), &"pass".into()));
}

#[test]
fn the_line_that_keeps_a_level_from_being_won_is_named() {
    let shield = "        duckling raft > shieldFrom stype=pond ftype=killSprite\n";
    let kill = "        duckling pond > killSprite\n";
    let late = FERRY.replace(kill, "").replace(shield, &format!("{kill}{shield}"));
    let late = folder(&late, POND);
    let said = text(&run(late.path(), &["validate", ".", "--budget", "100000"], 1).stdout);
    for words in [
        "; the level can be won without `duckling pond > killSprite`: a search wins it in 13 ticks",
        "(./game.vgdl:20)\n",
        "where there is also a `raft`; tick ",
        "try: move `duckling pond > killSprite` below `duckling raft > shieldFrom",
        "the reachable state closest to a win: 1 nest left",
        // The author's own characters.
        "D duckling, ",
        "~ pond",
    ] {
        assert!(said.contains(words), "`{words}` is not in\n{said}");
    }
    assert!(!said.contains("the rules alone do not show the reason"), "{said}");
    // Not found, and not proved either.
    let hedge = POND.replace("nw\n", "nw\nwwwwwwwwwwwwww\n");
    let hedge = folder(FERRY, &hedge);
    let said = text(&run(hedge.path(), &["validate", ".", "--budget", "40000"], 1).stdout);
    let headline = "not shown to pass winnable: no win found with ";
    assert!(said.contains(headline), "{said}");
    assert!(
        said.contains("the level can be won without `duckling wall > stepBack`: a search wins it in"),
        "{said}"
    );
}

/// A quiet answer lists the failures, and nothing that passes.
#[test]
fn quiet_answers_say_what_fails() {
    let folder = folder(GAME, LEVEL);
    let said = |status: i32| {
        text(
            &run(folder.path(), &["-q", "validate", ".", "--witness", "win.json", "--seed", "x"][..], status)
                .stdout,
        )
    };
    assert_eq!(said(0), "");
    fs::write(folder.path().join("lvl1.txt"), LEVEL.replace("wA.t", "wAwt").replace("w.....t", "wwwwwwt"))
        .unwrap();
    let said = text(&run(folder.path(), &["-q", "validate", "."], 1).stdout);
    assert!(said.starts_with("./lvl1.txt   FAILS") && !said.contains("lvl0.txt"), "{said}");
    assert!(said.contains("./game.vgdl  does not pass: 1 of 2"), "{said}");
}
