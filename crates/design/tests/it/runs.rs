//! Whole runs: accepted, repaired and given-up drafts, replays, interruptions and caps.

use crate::games::{
    LOST_LEVEL, PIT_LEVELS, PITS, PLUM_LEVELS, PLUMS, SHOT_LEVELS, SHOTS, idea, levels, rules,
};
use crate::scripted::{Scripted, settings};
use evaluation::Halt;
use infinite_arcade_design::{DesignFolder, Draft, Known, Outcome, Stage, Status, replay, run};
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// The answers of four drafts: a good one, one with a syntax error, one with a level that cannot be won, and one that
/// is given up.
fn answers() -> Vec<String> {
    let broken = PITS.replace("bounceForward", "bounceForwards");
    let mut answers = vec![idea("plum-walk"), rules(PLUMS), levels(&PLUM_LEVELS)];
    answers.extend([
        idea("owl-watch"),
        rules(&SHOTS.replace("Chaser", "Chasr")),
        rules(SHOTS),
        levels(&SHOT_LEVELS),
    ]);
    answers.extend([
        idea("pit-stop"),
        rules(PITS),
        levels(&[PIT_LEVELS[0], LOST_LEVEL]),
        levels(&PIT_LEVELS),
    ]);
    answers.extend([
        idea("never-done"),
        rules(&broken),
        rules(PLUMS),
        "I give up.".to_owned(),
        rules(&broken),
    ]);
    answers
}

fn begin(folder: &Path, model: &Arc<Scripted>) -> Outcome {
    let folder = DesignFolder::create(folder, settings(4)).unwrap();
    run(&folder, &model.designer(), &Known::default(), &mut |_| ()).unwrap()
}

#[test]
fn drafts_are_accepted_repaired_and_given_up() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("designs");
    let model = Scripted::new(&answers());
    let Outcome { results, halt } = begin(&path, &model);
    assert_eq!(halt, None);
    let drafts = &results.drafts;
    let of = |draft: &Draft| (draft.status, draft.stage, draft.repairs.values().sum::<u32>());
    assert_eq!(
        drafts.iter().map(of).collect::<Vec<_>>(),
        [
            (Status::Accepted, Stage::Levels, 0),
            (Status::Accepted, Stage::Levels, 1),
            (Status::Accepted, Stage::Levels, 1),
            (Status::GivenUp, Stage::Rules, 3),
        ]
    );
    assert_eq!((drafts[2].spending.answers, drafts[2].spending.input_tokens), (4, 400));
    assert!(drafts.iter().take(3).all(|draft| draft.measures.won == 2 && draft.measures.loads));

    let questions = model.questions();
    assert!(questions[0].contains("`Chaser`: ") && questions[1].contains("killBoth"), "{}", questions[0]);
    assert!(questions[3].contains("plum-walk: The player"), "earlier ideas are listed: {}", questions[3]);
    let told = &questions[5];
    assert!(told.contains("game.vgdl:") && told.contains("did you mean `Chaser`?"), "{told}");
    assert!(told.contains("3 corrections are left"), "{told}");
    let told = &questions[10];
    assert!(told.contains("FAILS winnable") && told.contains("wP     ow"), "{told}");
    assert!(told.contains("lvl1.txt: the best attempt") && told.contains("Its actions:"), "{told}");
    let told = &questions[14];
    assert!(told.contains("almost the same as those of your earlier game `plum-walk`"), "{told}");
    assert!(questions[15].contains("no block with rules"), "{}", questions[15]);
    assert!(questions[15].contains("This is the last correction."), "{}", questions[15]);

    let game = path.join("games/pit-stop");
    assert_eq!(fs::read_to_string(game.join("game.vgdl")).unwrap(), PITS);
    assert_eq!(fs::read_to_string(game.join("lvl1.txt")).unwrap(), PIT_LEVELS[1]);
    let provenance: serde_json::Value =
        serde_json::from_slice(&fs::read(game.join("design.json")).unwrap()).unwrap();
    assert_eq!((&provenance["designer"], &provenance["draft"]), (&"scripted".into(), &2.into()));
    assert!(!path.join("games/never-done").exists());
}

#[test]
fn a_log_replays_to_the_same_drafts() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("designs");
    let played = begin(&path, &Scripted::new(&answers()));
    let folder = DesignFolder::open(&path).unwrap();
    let (results, differing) = replay(&folder, &Known::default()).unwrap();
    assert_eq!((results, differing), (played.results, vec![]));
    // A changed answer no longer leads to the recorded questions.
    let log = folder.log(1);
    let changed = fs::read_to_string(&log).unwrap().replace("Chasr", "Chazer");
    fs::write(&log, changed).unwrap();
    let problem = replay(&folder, &Known::default()).unwrap_err().to_string();
    assert!(problem.contains("differs from the question that follows from the log's answers"), "{problem}");
}

#[test]
fn an_interrupted_run_resumes_without_asking_twice() {
    let home = tempfile::tempdir().unwrap();
    let (whole, broken) = (home.path().join("whole"), home.path().join("broken"));
    let all = answers();
    let undisturbed = begin(&whole, &Scripted::new(&all));
    for (at, answer) in all.iter().enumerate() {
        let model = Scripted::new(std::slice::from_ref(answer));
        let outcome = match at {
            0 => begin(&broken, &model),
            _ => {
                let folder = DesignFolder::resume(&broken, &settings(4)).unwrap();
                run(&folder, &model.designer(), &Known::default(), &mut |_| ()).unwrap()
            }
        };
        // The cap stops each run after one answer.
        let is_last = at + 1 == all.len();
        assert_eq!(outcome.halt.is_none(), is_last, "{at}");
        assert!(
            is_last || matches!(&outcome.halt, Some(Halt::Budget(why)) if why.contains("--max-requests"))
        );
    }
    for file in ["results.json", "drafts/draft-0002.json", "games/owl-watch/design.json"] {
        assert_eq!(fs::read(whole.join(file)).unwrap(), fs::read(broken.join(file)).unwrap(), "{file}");
    }
    let stored: Vec<Draft> =
        (0..4).map(|number| DesignFolder::open(&broken).unwrap().draft(number).unwrap().unwrap()).collect();
    assert_eq!(stored, undisturbed.results.drafts);
}

#[test]
fn folders_are_protected() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("designs");
    let problem = DesignFolder::open(&path).unwrap_err().to_string();
    assert!(problem.contains("there are no drafts here"), "{problem}");
    let open = DesignFolder::create(&path, settings(1)).unwrap();
    let problem = DesignFolder::resume(&path, &settings(1)).unwrap_err().to_string();
    assert!(problem.contains("another `arcade design`"), "{problem}");
    drop(open);
    let problem = DesignFolder::create(&path, settings(1)).unwrap_err().to_string();
    assert!(problem.contains("not empty"), "{problem}");
    let problem = DesignFolder::resume(&path, &settings(2)).unwrap_err().to_string();
    assert!(problem.contains("different value of `drafts`"), "{problem}");
}
