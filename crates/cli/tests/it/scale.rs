//! Tests of `arcade study calibrate` and `arcade study scale`, as users run them.

use crate::arcade::{run, text};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use tempfile::TempDir;

const SMALL: [&str; 8] = ["--max-steps", "40", "--runs", "1", "--replicates", "3", "-q", "--json"];

fn calibrate(folder: &Path, more: &[&str], status: i32) -> std::process::Output {
    run(folder, &[&["study", "calibrate"], more, &SMALL].concat(), status)
}

/// A folder with two scales. The scale in `first` has three games, and the scale in `second` has two more.
static SCALES: LazyLock<TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().unwrap();
    let games = ["hailglass", "great-yawn", "bog-lantern", "--out", "first", "--name", "november"];
    calibrate(folder.path(), &games, 0);
    let more = ["dyepot-newt", "first-ice", "--out", "second", "--scale", "first/scale.json"];
    calibrate(folder.path(), &[&more[..], &["--name", "december"]].concat(), 0);
    folder
});

fn read(path: &Path) -> Value {
    serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn releases_are_added_to_a_scale() {
    let [first, second] = ["first", "second"].map(|name| read(&SCALES.path().join(name).join("scale.json")));
    assert_eq!(first["months"].as_array().unwrap().len(), 1);
    assert_eq!(second["months"].as_array().unwrap().len(), 2);
    assert_eq!((&first["format"], &first["months"][0]), (&1.into(), &second["months"][0]));
    assert_eq!(first["examinees"], second["examinees"]);
    let level = &second["months"][1]["games"][0]["levels"][0]["difficulty"][0];
    assert!(level["error"].as_f64().unwrap() > 0.0, "{level}");
    // Only the second month's position on the scale has an error.
    assert_eq!(second["months"][0]["link"][0], 0.0);
    assert!(second["months"][1]["link"][0].as_f64().unwrap() > 0.0);
}

/// Checks the actions of each examinee (reference player) on a level. Examinees never change, so a difference is either
/// a bug or requires a new examinee with a higher number (`docs/reference/examinees.md`). Changes to the game itself
/// also change the actions.
#[test]
fn examinees_play_as_ever() {
    let plays = SCALES.path().join("first/plays");
    let mut names: Vec<String> = fs::read_dir(&plays)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    let actions = |name: &String| {
        let log = plays.join(name).join("episodes/hailglass-lvl0-run0.jsonl");
        let log = fs::read_to_string(log).unwrap();
        let events = log.lines().map(|line| serde_json::from_str::<Value>(line).unwrap());
        let steps = events.filter(|event| event["event"] == "step");
        let initials = steps.map(|step| step["action"].as_str().unwrap()[..1].to_owned());
        format!("{name} {}\n", initials.collect::<String>())
    };
    let found: String = names.iter().map(actions).collect();
    assert_eq!(found, include_str!("../examinees.txt"), "found:\n{found}");
}

/// An interrupted calibration gives the same bytes as an uninterrupted one, on any number of threads.
#[test]
fn interrupted_calibrations_resume() {
    let folder = tempfile::tempdir().unwrap();
    let games = ["hailglass", "great-yawn", "bog-lantern", "--out", "first", "--name", "november"];
    calibrate(folder.path(), &[&games[..], &["--jobs", "1"]].concat(), 0);
    let whole = fs::read(folder.path().join("first/scale.json")).unwrap();
    assert_eq!(whole, fs::read(SCALES.path().join("first/scale.json")).unwrap());
    // The files look as if the calibration had been killed while a reference player was playing.
    fs::remove_file(folder.path().join("first/scale.json")).unwrap();
    fs::remove_dir_all(folder.path().join("first/plays/olets-1")).unwrap();
    fs::remove_file(folder.path().join("first/plays/mcts-1/episodes/hailglass-lvl0-run0.jsonl")).unwrap();
    let taken = calibrate(folder.path(), &games, 2);
    assert!(text(&taken.stdout).contains("--resume"), "{}", text(&taken.stdout));
    calibrate(folder.path(), &[&games[..], &["--resume"]].concat(), 0);
    assert_eq!(whole, fs::read(folder.path().join("first/scale.json")).unwrap());
}

/// On a full disk, a calibration ends by stating the next step.
#[cfg(unix)]
#[test]
fn full_disks_report_how_to_continue() {
    let home = tempfile::tempdir().unwrap();
    let script = "trap '' XFSZ; ulimit -f 1; exec \"$@\"";
    let mut command = std::process::Command::new("sh");
    command.current_dir(home.path()).args(["-c", script, "sh", env!("CARGO_BIN_EXE_arcade")]);
    let output =
        command.args(["study", "calibrate", "hailglass", "--out", "first"]).args(SMALL).output().unwrap();
    let said = text(&output.stdout);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(
        said.contains("the calibration was stopped") && said.contains("continue with --resume"),
        "{said}"
    );
}

#[test]
fn players_are_placed_or_refused() {
    let folder = SCALES.path();
    let play = |player: &str, game: &str, out: &str| {
        let steps = ["--max-steps", "40", "-q"];
        run(folder, &[&["evaluate", game, "--player", player, "--out", out], &steps[..]].concat(), 0);
    };
    play("olets:50", "hailglass", "planner");
    let found = run(folder, &["study", "scale", "planner", "--scale", "second/scale.json", "--json"], 0);
    let found: Value = serde_json::from_str(&text(&found.stdout)).unwrap();
    let month = &found["players"][0]["months"][0];
    assert_eq!((&month["month"], &found["players"][0]["is_reader"]), (&"november".into(), &false.into()));
    let part = |name: &str| month["error"][name].as_f64().unwrap();
    let square = ["sampling", "mismatch", "link"].iter().map(|name| part(name) * part(name)).sum::<f64>();
    assert!((square.sqrt() - part("total")).abs() < 1e-9, "{month}");
    // The player `reader` plays a month that only one anchor (an unchanging player that sees only prompts) has played.
    play("reflex", "first-ice", "reader");
    let refused = run(folder, &["study", "scale", "reader", "--scale", "second/scale.json"], 1);
    assert!(text(&refused.stdout).contains("two anchors"), "{}", text(&refused.stdout));
    // The scale has a different number of actions per decision, different prompt settings and a different step limit.
    let settings = [
        &["--commit", "3", "--max-steps", "40"],
        &["--track", "masked", "--max-steps", "40"],
        &["--max-steps", "30"][..],
    ];
    for (at, settings) in settings.into_iter().enumerate() {
        let out = format!("apart{at}");
        let play = ["evaluate", "hailglass", "--levels", "0", "--player", "reflex", "-q", "--out", &out];
        run(folder, &[&play[..], settings].concat(), 0);
        let left_out = run(folder, &["study", "scale", &out, "--scale", "second/scale.json"], 1);
        let expect = format!("1 episode with {} {}", settings[0], settings[1]);
        assert!(text(&left_out.stderr).contains(&expect), "{}", text(&left_out.stderr));
    }
    // None of the played levels is on the first scale.
    let unknown = run(folder, &["study", "scale", "reader", "--scale", "first/scale.json"], 2);
    assert!(text(&unknown.stderr).contains("november"), "{}", text(&unknown.stderr));
}

/// A program that presses the keys in turn.
#[cfg(unix)]
const ANCHOR: &str = "turn=0
while read -r line; do
  case \"$line\" in *'\"turn\"'*)
    turn=$((turn + 1))
    case $((turn % 5)) in 0) key=up ;; 1) key=left ;; 2) key=down ;; 3) key=right ;; *) key=use ;; esac
    echo '{\"action\": \"'$key'\"}' ;;
  esac
done
";

/// If two readers (players that see only prompts) play both months, the second month can be placed on the scale for
/// other readers. A reader that cannot play is rejected before any episode is played.
#[cfg(unix)]
#[test]
fn readers_take_part_as_anchors() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    fs::write(folder.join("anchor.sh"), ANCHOR).unwrap();
    let months = [&["hailglass", "great-yawn", "bog-lantern"][..], &["dyepot-newt", "first-ice"]];
    let play = |games: &[&str], player: &str, steps: &str, out: &str| {
        let more = ["--player", player, "--max-steps", steps, "-q", "--out", out];
        run(folder, &[&["evaluate"], games, &more].concat(), 0);
    };
    play(months[0], "cmd:sh anchor.sh", "40", "anchor-first");
    play(months[1], "cmd:sh anchor.sh", "40", "anchor-second");
    play(months[1], "cmd:sh ./anchor.sh", "40", "another");
    play(&["hailglass", "--levels", "0"], "cmd:sh anchor.sh", "30", "short");
    let first = |reader, out| [months[0], &["--readers", reader, "--out", out]].concat();
    let second = |reader, out| {
        [months[1], &["--scale", "first/scale.json", "--readers", reader, "--out", out]].concat()
    };
    calibrate(folder, &first("anchor-first", "first"), 0);
    let refusals = [
        (first("anchor-second", "none"), "has not played any level of this release"),
        (first("short", "none"), "1 episode with --max-steps 30 was left out"),
        (first("nowhere", "none"), "nowhere: this folder contains no evaluation results"),
        (second("another", "none"), "did not play the first release of the scale"),
    ];
    for (args, words) in refusals {
        let said = calibrate(folder, &args, 2);
        assert!(text(&said.stdout).contains(words), "{words}: {}", text(&said.stdout));
        assert!(!folder.join("none").exists());
    }
    calibrate(folder, &second("anchor-second", "second"), 0);
    let scale = read(&folder.join("second/scale.json"));
    assert_eq!(scale["months"][1]["anchors"], 2);
    play(&["first-ice"], "reflex", "40", "reader");
    let placed = run(folder, &["study", "scale", "reader", "--scale", "second/scale.json", "--json"], 0);
    let placed: Value = serde_json::from_str(&text(&placed.stdout)).unwrap();
    let player = &placed["players"][0];
    assert!(player["is_reader"] == true && player["months"][0]["ability"]["value"].is_f64(), "{player}");
}

/// The page shows two months, and the episodes with which they were calibrated.
#[test]
fn timelines_are_a_page_and_its_numbers() {
    let folder = SCALES.path();
    let plays = |scale: &str, name: &str| format!("{scale}/plays/{name}");
    let names = ["olets-1", "random-1", "reflex-5"];
    let results: Vec<String> =
        ["first", "second"].iter().flat_map(|scale| names.map(|name| plays(scale, name))).collect();
    let make = |out: &str, scale: &str, status| {
        let mut args = vec!["study", "timeline", "--scale", scale, "--out", out];
        args.extend(results.iter().map(String::as_str));
        run(folder, &args, status)
    };
    make("timeline", "second/scale.json", 0);
    let page = fs::read_to_string(folder.join("timeline/timeline.html")).unwrap();
    for part in [
        "november to december: 2 months on one scale",
        "olets-1",
        "Not placed",
        "reflex-5 is not placed in december",
        "</html>",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("NaN") && !page.contains("<script"));
    let found = read(&folder.join("timeline/timeline.json"));
    assert_eq!(
        (found["months"].as_array().unwrap().len(), found["players"].as_array().unwrap().len()),
        (2, 3)
    );
    assert!(found["players"].as_array().unwrap().iter().all(|player| player["is_examinee"] == true));
    let abilities = fs::read_to_string(folder.join("timeline/tables/abilities.csv")).unwrap();
    assert_eq!(abilities.lines().count(), 1 + 3 * 2, "{abilities}");
    make("timeline", "second/scale.json", 2);
}

fn logs(results: &Path) -> Vec<String> {
    let mut names: Vec<String> = fs::read_dir(results.join("episodes"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    names
}

const CHOICE: [&str; 10] = [
    "evaluate",
    "hailglass",
    "great-yawn",
    "bog-lantern",
    "--player",
    "reflex",
    "--max-steps",
    "40",
    "--scale",
    "first/scale.json",
];

#[test]
fn plans_choose_levels_for_a_target() {
    let folder = SCALES.path();
    let plan = |more: &[&str], status| {
        let found = run(folder, &[&CHOICE, more, &["--plan", "--json"][..]].concat(), status);
        serde_json::from_str::<Value>(&text(&found.stdout)).unwrap()
    };
    let found = plan(&["--episodes", "4"], 0);
    assert_eq!((&found["errors"]["episodes"], &found["errors"]["games"]), (&4.into(), &3.into()), "{found}");
    assert_eq!(plan(&["--target-error", "0.01", "--runs", "2"], 1)["runs"], 2);
    // Without --plan, the plan is played.
    run(folder, &[&CHOICE, &["--episodes", "4", "--out", "planned", "-q"][..]].concat(), 0);
    let chosen = found["games"].as_array().unwrap().iter().flat_map(|game| {
        let levels = game["levels"].as_array().unwrap().clone();
        levels.into_iter().map(|level| format!("{}-lvl{level}-run0.jsonl", game["game"].as_str().unwrap()))
    });
    let mut chosen: Vec<String> = chosen.collect();
    chosen.sort();
    assert_eq!(chosen, logs(&folder.join("planned")));
    for (wrong, words) in [
        (&["--episodes", "4", "--max-steps", "30"][..], "--max-steps 40"),
        (&["--episodes", "4", "--commit", "2"], "--commit 2"),
        (&["--plan"], "one target"),
        (&["--adaptive"], "needs a stopping condition"),
        (&["--target-error", "-1"], "from 0.001 to 100"),
    ] {
        let steps = if wrong.contains(&"--max-steps") { &[] } else { &CHOICE[6..8] };
        let refused = run(folder, &[&CHOICE[..6], steps, &CHOICE[8..], wrong].concat(), 2);
        assert!(text(&refused.stderr).contains(words), "{}", text(&refused.stderr));
    }
    // The player `reader` plays a month that only one anchor (an unchanging player that sees only prompts) has played.
    let month =
        ["evaluate", "first-ice", "--player", "reflex", "--max-steps", "40", "--scale", "second/scale.json"];
    let unlinked = run(folder, &[&month[..], &["--episodes", "1", "--plan"]].concat(), 0);
    assert!(text(&unlinked.stderr).contains("two anchors"), "{}", text(&unlinked.stderr));
    let unknown = [
        "evaluate",
        "first-ice",
        "--player",
        "reflex",
        "--max-steps",
        "40",
        "--scale",
        "first/scale.json",
        "--episodes",
        "1",
    ];
    let unknown = run(folder, &unknown, 2);
    assert!(
        text(&unknown.stderr).contains("level 0 of first-ice is not on the scale"),
        "{}",
        text(&unknown.stderr)
    );
}

/// The choices follow from the logs, so an evaluation that lost its end makes the same choices again.
#[test]
fn adaptive_choices_are_reproducible() {
    let folder = SCALES.path();
    let play = |more: &[&str]| {
        let adaptive = ["--adaptive", "--episodes", "6", "--batch", "2", "--out", "adaptive", "-q"];
        run(folder, &[&CHOICE, &adaptive[..], more].concat(), 0);
        fs::read_to_string(folder.join("adaptive/selection.json")).unwrap()
    };
    let first = play(&[]);
    let choices = serde_json::from_str::<Value>(&first).unwrap()["choices"].as_array().unwrap().clone();
    let mut names: Vec<String> = (choices.iter())
        .map(|one| format!("{}-lvl{}-run{}.jsonl", one["game"].as_str().unwrap(), one["level"], one["run"]))
        .collect();
    let last = names[5].clone();
    names.sort();
    assert_eq!(names, logs(&folder.join("adaptive")));
    fs::remove_file(folder.join("adaptive/selection.json")).unwrap();
    fs::remove_file(folder.join("adaptive/episodes").join(last)).unwrap();
    assert_eq!(play(&["--resume", "--jobs", "1"]), first);
    let placed = run(folder, &["study", "scale", "adaptive", "--scale", "first/scale.json", "--json"], 0);
    let placed: Value = serde_json::from_str(&text(&placed.stdout)).unwrap();
    assert!(placed["players"][0]["months"][0]["ability"].is_object(), "{placed}");
}

#[test]
fn malformed_scales_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for (content, words) in
        [("{}", "not a scale"), ("nothing", "not a scale"), ("{\"format\": 9}", "update arcade")]
    {
        fs::write(folder.path().join("scale.json"), content).unwrap();
        let found = run(folder.path(), &["study", "scale", "none", "--scale", "scale.json"], 2);
        assert!(text(&found.stderr).contains(words), "{}", text(&found.stderr));
    }
    let own = ["study", "calibrate", "hailglass", "--out", "x", "--seed", "evaluate"];
    run(folder.path(), &own, 2);
}

/// Values that no calibration produces are rejected when they are read, because plots and integrals would
/// need memory in proportion to them.
#[test]
fn damaged_scales_are_refused() {
    let home = tempfile::tempdir().unwrap();
    let folder = home.path();
    let whole = read(&SCALES.path().join("first/scale.json"));
    let plays = SCALES.path().join("first/plays/mcts-1").display().to_string();
    let check = |pointer: &str, value: Value| {
        let mut scale = whole.clone();
        *scale.pointer_mut(pointer).unwrap() = value;
        fs::write(folder.join("scale.json"), scale.to_string()).unwrap();
        for verb in [
            vec!["study", "scale", &plays, "--scale", "scale.json"],
            vec!["study", "timeline", &plays, "--scale", "scale.json", "--out", "t"],
        ] {
            let said = text(&run(folder, &verb, 2).stderr);
            assert!(said.contains("scale.json: the scale is damaged, because `"), "{pointer}: {said}");
            let key = pointer.split('/').nth(1).unwrap();
            assert!(said.contains(&format!("`{key}")), "{pointer}: {said}");
            assert!(!folder.join("t").exists());
        }
    };
    for pointer in [
        "/months/0/games/2/common/0",
        "/months/0/games/0/levels/0/difficulty/1/error",
        "/months/0/shifts/0/value",
        "/months/0/shifts/1/error",
        "/months/0/planners_shift/value",
        "/months/0/link/0",
        "/examinees/0/ability",
        "/examinees/0/on_scale/value",
        "/spreads/reader",
        "/origins/0",
        "/ease",
        "/covariance/0",
    ] {
        check(pointer, 1e9.into());
        check(pointer, 1e308.into());
    }
    check("/months/0/shifts/0/value", (-1e9).into());
    check("/months/0/games/0/misfit", 1e300.into());
    check("/months/0/games/2/common/0", (-1.0).into());
    check("/months/0/anchors", u64::MAX.into());
    for spread in ["game", "level", "family", "planner", "game_rest", "level_rest", "reader"] {
        check(&format!("/spreads/{spread}"), 0.into());
    }
    check("/covariance/0", (-1.0).into());
    check("/covariance/1", (-10.0).into());
    check("/covariance", Value::Array(Vec::new()));
    let twice = |pointer: &str| {
        let one = whole.pointer(pointer).unwrap()[0].clone();
        check(pointer, Value::Array(vec![one.clone(), one]));
    };
    ["/months", "/months/0/games", "/months/0/games/0/levels"].into_iter().for_each(twice);
    check("/months", Value::Array(Vec::new()));
    check("/max_steps", 0.into());
    // A larger file is not read.
    let large = format!("{}{}", " ".repeat(1 << 24), whole);
    fs::write(folder.join("scale.json"), large).unwrap();
    let said = text(&run(folder, &["study", "scale", &plays, "--scale", "scale.json"], 2).stderr);
    assert!(said.contains("larger than 16777216 bytes"), "{said}");
    // Readers (players that see only prompts) may find easy what planners find hard.
    let mut opposed = whole.clone();
    opposed["spreads"]["game_slope"] = (-0.5).into();
    fs::write(folder.join("scale.json"), opposed.to_string()).unwrap();
    run(folder, &["study", "scale", &plays, "--scale", "scale.json"], 0);
    fs::write(folder.join("scale.json"), whole.to_string()).unwrap();
    run(folder, &["study", "scale", &plays, "--scale", "scale.json"], 0);
}
