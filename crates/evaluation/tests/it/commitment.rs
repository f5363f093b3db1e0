//! Tests of players that commit to several actions. The tests cover how plans are played, logged, resumed,
//! replayed and shown.

use crate::walk::game;
use base::Seed;
use engine::Action;
use evaluation::log::decisions;
use evaluation::metrics::{Replayed, replay, replay_course};
use evaluation::player::Choice;
use evaluation::prompt::{PromptSettings, PromptStyle, Prompter, Rules};
use evaluation::run::{Task, play};
use evaluation::serve::{PromptPlayer, Prompted};
use evaluation::{
    Agent, Commitment, Contestant, Event, Halt, Journal, Subject, SubjectFacts, Turn, Validity,
};
use std::fs;
use std::sync::{Arc, Mutex};

/// A game with a corridor and a door at its end. The avatar can shoot once it has taken the bow.
const GAME: &str = "
BasicGame
    SpriteSet
        wall > Immovable
        door > Immovable
        bow > Immovable
        arrow > Missile
        bare > MovingAvatar
        archer > ShootAvatar stype=arrow
    LevelMapping
        w > wall
        d > door
        b > bow
        A > bare
    InteractionSet
        bare wall > stepBack
        archer wall > stepBack
        arrow wall > killSprite
        bare bow > transformTo stype=archer killSecond=True scoreChange=1
        door bare > killSprite scoreChange=2
        door archer > killSprite scoreChange=2
    TerminationSet
        SpriteCounter stype=door win=True
";

fn subject() -> Subject {
    let levels = [(0, "wwwwwwwwww\nwA b    dw\nwwwwwwwwww".to_owned(), Some(7))];
    Subject::read("corridor", GAME, &levels, SubjectFacts::default()).expect("the game is sound")
}

fn task<'a>(subject: &'a Subject, commit: &str, max_steps: u64) -> Task<'a> {
    let commit = commit.parse().unwrap();
    let seed = Seed::from_text("commitment");
    Task {
        subject,
        level: &subject.levels[0],
        run: 0,
        seed,
        max_steps,
        commit,
        max_output_tokens: None,
        track: None,
        series: None,
    }
}

/// An agent that answers with the given plans, and records the turns that it is shown. A plan of `None` is an
/// unusable answer.
#[derive(Clone, Default)]
struct Planned {
    plans: Vec<Option<Vec<Action>>>,
    /// The number of actions before each decision, and the number of actions reported since the previous
    /// decision.
    looks: Arc<Mutex<Vec<(u64, usize)>>>,
}

impl Agent for Planned {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let mut looks = self.looks.lock().unwrap();
        let plan = self.plans.get(looks.len()).cloned().flatten();
        looks.push((turn.number, turn.played.len()));
        Ok(plan.map_or_else(|| Choice::nothing(Validity::Invalid), Choice::plan))
    }

    fn recall(&mut self, turn: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        self.looks.lock().unwrap().push((turn.number, turn.played.len()));
        Ok(())
    }
}

/// Parses plans such as `rr u -`, written as the initials of their actions. A `-` stands for an unusable
/// answer.
fn planned(plans: &str) -> Planned {
    let action = |initial: char| match initial {
        'r' => Action::Right,
        'l' => Action::Left,
        'u' => Action::Up,
        's' => Action::Use,
        _ => Action::Nil,
    };
    let plan = |word: &str| (word != "-").then(|| word.chars().map(action).collect());
    Planned { plans: plans.split(' ').map(plan).collect(), ..Planned::default() }
}

fn played(task: &Task<'_>, agent: impl Agent + 'static, journal: &mut Journal) {
    play(task, &mut Contestant::Agent(Box::new(agent)), journal).expect("it can be played");
}

/// Plays plans, and checks the played actions, the decisions and the outcome. `expect` contains the initials
/// of the actions, with a `|` before each decision.
#[track_caller]
fn check(commit: &str, max_steps: u64, plans: &str, actions: &str, looks: &[(u64, usize)], end: &str) {
    let (subject, agent) = (subject(), planned(plans));
    let (task, mut journal) = (task(&subject, commit, max_steps), Journal::in_memory());
    played(&task, agent.clone(), &mut journal);
    let told = |event: &Event| match event {
        Event::Plan { .. } => "|".to_owned(),
        Event::Step { action, .. } => action.to_string()[..1].to_owned(),
        _ => String::new(),
    };
    let got: String = journal.events().iter().map(told).collect();
    assert_eq!(got, actions);
    assert_eq!(*agent.looks.lock().unwrap(), looks);
    let replayed = replay(&subject, journal.events()).expect("the log is sound");
    assert_eq!(format!("{:?}", replayed.outcome), end);
    let course = replay_course(&subject, journal.events()).expect("the log is sound");
    assert!(course.meaningful.is_empty() && course.meaningful_as_code.is_empty());
    let (meaningful, meaningful_as_code) = (replayed.meaningful.clone(), replayed.meaningful_as_code.clone());
    assert_eq!(Replayed { meaningful, meaningful_as_code, ..course }, replayed);
}

#[test]
fn plans_are_played_without_another_look() {
    check("3", 50, "rrr rrr rrr", "|rrr|rrr|r", &[(0, 0), (3, 3), (6, 3)], "Won");
    check("all", 50, "rrrrrrr", "|rrrrrrr", &[(0, 0)], "Won");
    check(
        "1",
        50,
        "r r r r r r r",
        "rrrrrrr",
        &[(0, 0), (1, 1), (2, 1), (3, 1), (4, 1), (5, 1), (6, 1)],
        "Won",
    );
}

#[test]
fn plans_of_another_length_are_defined() {
    // Doing nothing replaces missing actions, and actions beyond the commitment are not played.
    check("4", 8, "r rrrrrr", "|rnnn|rrrr", &[(0, 0), (4, 4)], "Ongoing");
    check("all", 6, "rr", "|rrnnnn", &[(0, 0)], "Ongoing");
    check("all", 6, "rrrrrrrrr", "|rrrrrr", &[(0, 0)], "Ongoing");
    check("4", 6, "- rrrr", "|nnnn|rr", &[(0, 0), (4, 4)], "Ongoing");
}

#[test]
fn unavailable_actions_do_nothing() {
    // The avatar takes the bow in the second tick, and can shoot only afterwards.
    check("6", 6, "srrsrl", "|nrrurl", &[(0, 0)], "Ongoing");
}

/// An episode interrupted after any event continues to the same log.
#[test]
fn interrupted_plans_continue() {
    let subject = subject();
    let task = task(&subject, "3", 50);
    let folder = tempfile::tempdir().unwrap();
    let log = |name: &str| folder.path().join(name);
    played(&task, planned("rrl - rrr rrr rr"), &mut Journal::open(&log("whole")).unwrap());
    let text = fs::read_to_string(log("whole")).unwrap();
    let without_times = |text: &str| {
        let events = text.lines().map(|line| serde_json::from_str(line).unwrap());
        events.map(|event| evaluation::log::without_times(&event)).collect::<Vec<Event>>()
    };
    let lines: Vec<&str> = text.lines().collect();
    for kept in 0..lines.len() {
        let path = log(&format!("cut {kept}"));
        let part: String = lines[..kept].iter().map(|line| format!("{line}\n")).collect();
        fs::write(&path, part).unwrap();
        played(&task, planned("rrl - rrr rrr rr"), &mut Journal::open(&path).unwrap());
        assert_eq!(
            without_times(&fs::read_to_string(&path).unwrap()),
            without_times(&text),
            "after {kept} lines"
        );
    }
}

#[test]
fn decisions_are_counted_not_ticks() {
    let subject = subject();
    let (task, mut journal) = (task(&subject, "3", 9), Journal::in_memory());
    played(&task, planned("rrr - rl"), &mut journal);
    let found: Vec<Validity> = decisions(journal.events()).collect();
    assert_eq!(found, [Validity::Valid, Validity::Invalid, Validity::Valid]);
}

#[test]
fn changed_plans_are_refused() {
    let subject = subject();
    let (task, mut journal) = (task(&subject, "3", 50), Journal::in_memory());
    played(&task, planned("rrr rrr r"), &mut journal);
    let log = journal.events().to_vec();
    let refused = |change: &dyn Fn(&mut Vec<Event>), expect: &str| {
        let mut forged = log.clone();
        change(&mut forged);
        let error = replay(&subject, &forged).unwrap_err().to_string();
        assert!(error.contains(expect), "{error}");
    };
    refused(&|log| drop(log.remove(1)), "step 0 does not belong to a plan");
    refused(&|log| drop(log.remove(4)), "1 steps of the previous plan are missing");
    refused(
        &|log| {
            let Event::Plan { actions, .. } = &mut log[1] else { panic!("{:?}", log[1]) };
            actions[1] = Action::Left;
        },
        "step 1 plays right (valid), but the plan has left (valid)",
    );
    refused(
        &|log| {
            let Event::Start { commit, .. } = &mut log[0] else { panic!("{:?}", log[0]) };
            *commit = Commitment::ONE;
        },
        "the log contains a plan, but the player commits to one action at a time",
    );
}

/// Served players answer the prompts for all commitments in the requested format.
#[test]
fn served_players_read_what_is_due() {
    let subject = game("quiet-jars");
    for (commit, player, settings) in [
        ("5", "reflex", PromptSettings::default()),
        ("all", "reflex", PromptSettings::default()),
        ("5", "random", PromptSettings::default()),
        ("all", "planner:mcts:50", PromptSettings { rules: Rules::Vgdl, ..PromptSettings::default() }),
    ] {
        let player: PromptPlayer = player.parse().unwrap();
        let task = task(&subject, commit, 20);
        let prompter = Arc::new(Prompter::within(&subject, settings, 20, task.commit).unwrap());
        let mut journal = Journal::in_memory();
        played(&task, Prompted::new(player.clone(), prompter), &mut journal);
        let plans = journal.events().iter().filter_map(|event| match event {
            Event::Plan { actions, validity, .. } => Some((actions.len() as u64, *validity)),
            _ => None,
        });
        for (length, validity) in plans {
            assert_eq!(validity, Validity::Valid, "{player}, {commit}");
            assert!(
                length == task.commit.due(20) || player.to_string().starts_with("planner"),
                "{player}: {length}"
            );
        }
    }
}

#[test]
fn the_reference_asks_for_one_action() {
    let settings = PromptSettings { style: PromptStyle::Reference, ..PromptSettings::default() };
    let error = Prompter::within(&subject(), settings, 9, Commitment::All).unwrap_err().to_string();
    assert!(error.contains("the reference's prompts ask for one action"), "{error}");
}

/// The next decision shows the plan's result: its actions, positions, unavailable actions and points.
#[test]
fn plans_are_told_at_the_next_look() {
    let subject = subject();
    let prompter = Prompter::within(&subject, PromptSettings::default(), 50, "3".parse().unwrap()).unwrap();
    let shown = Arc::new(Mutex::new(Vec::new()));
    struct Shown(Prompter, Arc<Mutex<Vec<String>>>);
    impl Agent for Shown {
        fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
            self.1.lock().unwrap().push(self.0.prompt(turn, &[], &[]).shown);
            Ok(Choice::plan(vec![Action::Use, Action::Right, Action::Right]))
        }

        fn recall(&mut self, _: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
            Ok(())
        }
    }
    played(&task(&subject, "3", 50), Shown(prompter, shown.clone()), &mut Journal::in_memory());
    let shown = shown.lock().unwrap();
    assert!(!shown[0].contains("## Last plan"), "{}", shown[0]);
    let told = "## Last plan\nThe 3 actions played since the last look, each with your place after it:\nuse as nil (1,1); right (2,1); right (3,1), score +1\n";
    assert!(shown[1].contains(told), "{}", shown[1]);
}
