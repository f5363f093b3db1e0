//! Tests of examinations in which a player has to write a game (a world model) from recordings or from its own
//! exploration.

use evaluation::client::{ChatMessage, ChatReply, Finish};
use evaluation::player::mailbox::Address;
use evaluation::world_model::{
    Examined, Hints, TransitionKind, WorldModelSettings, WorldModelTask, examine, induce,
};
use evaluation::{Halt, Journal, Subject, SubjectFacts};

const GAME: &str = "BasicGame
    SpriteSet
        floor > Immovable hidden=True
        wall > Immovable
        crate > Passive
        gem > Immovable
        exit > Door
        rover > Missile orientation=RIGHT cooldown=2
        hero > MovingAvatar
    LevelMapping
        . > floor
        w > wall
        c > floor crate
        g > floor gem
        x > floor exit
        r > floor rover
        h > floor hero
    InteractionSet
        hero wall > stepBack
        crate hero > bounceForward
        crate wall > undoAll
        rover wall > reverseDirection
        rover wall > stepBack
        gem hero > killSprite scoreChange=2
        exit hero > killSprite
    TerminationSet
        SpriteCounter stype=exit limit=0 win=True
        Timeout limit=100 win=False
";

const LEVEL: &str = "wwwwwww\nwh.g..w\nw.c.c.w\nw.g...w\nwr....w\nw...x.w\nwwwwwww\n";

fn subject(source: &str) -> Subject {
    Subject::read("crates", source, &[(0, LEVEL.to_owned(), None)], SubjectFacts::default()).unwrap()
}

fn settings() -> WorldModelSettings {
    WorldModelSettings { hints: Hints::Used, episodes: 8, actions: 0, steps: 30, seed: "test".to_owned() }
}

fn task() -> WorldModelTask {
    WorldModelTask::new(&subject(GAME), &settings()).unwrap()
}

/// Examines a player that gives these answers in turn. Returns the result and the last message before each answer.
fn answered(task: &WorldModelTask, journal: &mut Journal, answers: &[&str]) -> (Examined, Vec<String>) {
    let mut asked = Vec::new();
    let mut ask = |_: Address, messages: &[ChatMessage]| {
        asked.push(messages.last().unwrap().text.clone());
        let answer = answers.get(asked.len() - 1).ok_or(Halt::Interrupted)?;
        Ok(ChatReply::new((*answer).to_owned(), Finish::Stop))
    };
    let examined = examine(task, journal, &mut ask).unwrap();
    (examined, asked)
}

fn examined(task: &WorldModelTask, answer: &str) -> Examined {
    answered(task, &mut Journal::in_memory(), &[answer, answer, answer]).0
}

/// The masked source without the line for the pair of types, which are given by their own names.
fn without(task: &WorldModelTask, effect: &str) -> String {
    let lines = task.true_game().lines().filter(|line| !line.contains(effect));
    lines.map(|line| format!("{line}\n")).collect()
}

#[test]
fn the_true_game_scores_everything() {
    let task = task();
    let examined = examined(&task, &format!("Here it is:\n```vgdl\n{}```\nDone.", task.true_game()));
    let total = examined.score.total();
    assert!(total.transitions > 100, "{total:?}");
    assert_eq!((total.board, total.state, total.first_deviations), (total.transitions, total.transitions, 0));
    assert_eq!((examined.attempts, examined.problems), (1, None));
    let planner = examined.score.planner;
    assert_eq!((planner.levels, planner.wins, planner.true_wins), (1, 1, 1));
    for kind in TransitionKind::ALL {
        // A rover moves in most steps, so that few transitions have no event or only the player's.
        let is_rare = matches!(kind, TransitionKind::Nothing | TransitionKind::Changed);
        assert!(is_rare || examined.score.kinds.contains_key(&kind), "{kind:?}: {:?}", examined.score);
    }
}

#[test]
fn a_missing_rule_shows_in_its_kind_of_event() {
    let task = task();
    let of = |effect: &str| examined(&task, &without(&task, effect)).score;
    let score = of("scoreChange=2");
    assert!(score.total().state < score.total().transitions);
    assert!(score.kinds[&TransitionKind::Result].first_deviations > 0);
    assert_eq!(score.kinds[&TransitionKind::Result].first_deviations, score.total().first_deviations);
    let score = of("bounceForward");
    assert!(score.kinds[&TransitionKind::SpriteMoved].first_deviations > 0);
    assert!(score.total().board < score.total().transitions);
}

/// A score that is missing changes the observable state, but not the board.
#[test]
fn the_board_is_scored_separately() {
    let task = task();
    let total = examined(&task, &task.true_game().replace(" scoreChange=2", "")).score.total();
    assert_eq!(total.board, total.transitions);
    assert!(total.state < total.transitions);
}

#[test]
fn a_broken_game_gets_two_more_attempts() {
    let task = task();
    let broken = task.true_game().replace("bounceForward", "bounceForwards");
    let sound = task.true_game();
    let (examined, asked) = answered(&task, &mut Journal::in_memory(), &["no idea", &broken, sound]);
    assert_eq!((examined.attempts, examined.problems), (3, None));
    assert!(asked[1].contains("`BasicGame`"), "{}", asked[1]);
    assert!(asked[2].contains("bounceForwards") && asked[2].contains("line "), "{}", asked[2]);
    let (examined, asked) = answered(&task, &mut Journal::in_memory(), &[&broken, &broken, &broken, sound]);
    assert_eq!((examined.attempts, asked.len()), (3, 3));
    assert!(examined.problems.unwrap().contains("bounceForwards"));
    assert_eq!((examined.score.total().state, examined.score.planner.wins), (0, 0));
}

#[test]
fn a_level_that_does_not_fit_is_reported() {
    let task = task();
    let mapping = task.true_game().lines().skip_while(|line| !line.contains("LevelMapping")).nth(1).unwrap();
    let (_, asked) = answered(
        &task,
        &mut Journal::in_memory(),
        &[&task.true_game().replace(&format!("{mapping}\n"), ""), task.true_game()],
    );
    assert!(asked[1].contains("Level 0:"), "{}", asked[1]);
}

#[test]
fn a_log_replaces_the_examinee() {
    let task = task();
    let mut journal = Journal::in_memory();
    let (first, _) = answered(&task, &mut journal, &["no idea", task.true_game()]);
    let events = journal.events().len();
    let (again, asked) = answered(&task, &mut journal, &[]);
    assert_eq!((again, asked.len(), journal.events().len()), (first, 0, events));
    let other = WorldModelSettings { hints: Hints::None, ..settings() };
    let other = WorldModelTask::new(&subject(GAME), &other).unwrap();
    let mut ask = |_: Address, _: &[ChatMessage]| Err(Halt::Interrupted);
    assert!(matches!(examine(&other, &mut journal, &mut ask), Err(Halt::Log(_))));
}

#[test]
fn hostile_answers_are_bounded() {
    let task = task();
    let huge = "BasicGame\n".repeat(10 << 20);
    assert!(examined(&task, &huge).problems.unwrap().contains("limit"));
    let many: String = (0..5_000).map(|number| format!("        s{number} > Immovable\n")).collect();
    let many = task.true_game().replace("    SpriteSet\n", &format!("    SpriteSet\n{many}"));
    assert!(examined(&task, &many).problems.is_some());
    let lists: String = (0..40).map(|number| format!("        s{number} > Missile\n")).collect();
    let spread = task.true_game().replace("    SpriteSet\n", &format!("    SpriteSet\n{lists}"));
    assert_eq!(examined(&task, &spread).problems, None);
}

/// A game that fills the board with sprites, and one that transforms sprites for ever, end within the engine's limits.
#[test]
fn games_that_grow_or_loop_are_bounded() {
    let task = task();
    let growing = task.true_game().replace("Immovable hidden=True", "Spreader spreadprob=1 limit=9999");
    assert_ne!(growing, task.true_game());
    let total = examined(&task, &growing).score.total();
    assert!(total.board < total.transitions);
    let looping = task.true_game().replace("undoAll", "cloneSprite").replace("stepBack", "cloneSprite");
    let total = examined(&task, &looping).score.total();
    assert!(total.state < total.transitions);
}

#[test]
fn games_with_randomness_are_refused() {
    let random = subject(&GAME.replace("Missile orientation=RIGHT cooldown=2", "RandomNPC"));
    let problem = WorldModelTask::new(&random, &settings()).unwrap_err().to_string();
    assert!(problem.contains("deterministic"), "{problem}");
}

#[test]
fn help_has_three_levels() {
    let question = |hints: Hints| {
        let task = WorldModelTask::new(&subject(GAME), &WorldModelSettings { hints, ..settings() }).unwrap();
        answered(&task, &mut Journal::in_memory(), &[task.true_game()]).1.remove(0)
    };
    let (used, candidates, none) =
        (question(Hints::Used), question(Hints::Candidates), question(Hints::None));
    assert!(used.contains("- bounceForward") && !used.contains("- killBoth"));
    assert!(candidates.contains("- killBoth") && !none.contains("bounceForward"));
    for question in [used, candidates, none] {
        assert!(!question.contains("hero") && !question.contains("rover") && !question.contains("> Missile"));
    }
}

#[test]
fn an_examinee_may_explore() {
    let settings = WorldModelSettings { actions: 10, ..settings() };
    let task = WorldModelTask::new(&subject(GAME), &settings).unwrap();
    let answers = [
        "PLAY 0: right right\n",
        "PLAY 1: right",
        "PLAY 0: right, jump",
        "PLAY 0: down down down nil nil up up up up up",
    ];
    let answers = [&answers[..], &[task.true_game()]].concat();
    let (examined, asked) = answered(&task, &mut Journal::in_memory(), &answers);
    assert!(asked[0].contains("PLAY 0:") && !asked[0].contains("Episode 1"), "{}", asked[0]);
    assert!(asked[1].starts_with("1 right: ") && asked[1].contains("8 actions left"), "{}", asked[1]);
    assert!(asked[2].contains("no level `1`") && asked[3].contains("`jump`"), "{asked:?}");
    assert!(asked[4].contains("no actions left"), "{}", asked[4]);
    assert_eq!((examined.attempts, examined.explored), (3, 10));
    assert_eq!(examined.score.total().state, examined.score.total().transitions);
}

/// The reference player finds the rules of all events in the recordings of a small game. One rule concerns an event
/// that occurs only in the held-out recordings.
#[test]
fn the_reference_examinee_learns_a_small_game() {
    let task = task();
    let game = induce(&task);
    assert_eq!(game, induce(&task));
    let examined = examined(&task, &game);
    let total = examined.score.total();
    assert!(4 * total.state > 3 * total.transitions, "{game}");
}
