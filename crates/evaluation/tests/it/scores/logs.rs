//! Tests of scripted episodes whose metrics were calculated by hand.

use base::Seed;
use engine::Action::{self, Left, Nil, Right, Up, Use};
use engine::Outcome;
use evaluation::client::{Finish, Usage};
use evaluation::log::{Reply, ReplyClass};
use evaluation::metrics::{Choices, EpisodeMetrics, EpisodeStatus, Movement, replay};
use evaluation::player::{Agent, Choice, Halt};
use evaluation::run::{Task, play};
use evaluation::{Commitment, Contestant, Event, Journal, Subject, SubjectFacts, Turn, Validity};

/// A game with gems to take and a door to reach. A guard moves by itself, regardless of the player.
const GAME: &str = "
BasicGame
    SpriteSet
        wall > Immovable
        door > Immovable
        gem > Immovable
        box > Passive
        guard > Missile orientation=RIGHT
        avatar > MovingAvatar
    LevelMapping
        d > door
        g > gem
        b > box
        m > guard
    InteractionSet
        avatar wall > stepBack
        guard wall > reverseDirection
        box wall > undoAll
        box avatar > bounceForward
        gem avatar > killSprite scoreChange=2
        door avatar > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=door win=True
";

const HALL: &str = "wwwwwww\nwA g dw\nwwwwwww\nwm    w\nwwwwwww";
const STORE: &str = "wwwwwwww\nwA b  dw\nwwwwwwww";

pub(crate) fn subject() -> Subject {
    let levels = [(0, HALL.to_owned(), Some(4)), (3, STORE.to_owned(), None)];
    Subject::read("hall", GAME, &levels, SubjectFacts::default()).expect("the game is sound")
}

/// An agent that plays the given actions. The episode is aborted after the last action.
struct Script(Vec<Action>);

impl Agent for Script {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let action = self.0.get(turn.number as usize).copied();
        action.map(Choice::of).ok_or_else(|| Halt::Infrastructure("the wire was cut".to_owned()))
    }

    fn recall(&mut self, _: &Turn<'_>, _: &Journal, _: &Choice) -> Result<(), Halt> {
        Ok(())
    }
}

pub(super) fn log(subject: &Subject, level: usize, actions: &[Action], max_steps: u64) -> Vec<Event> {
    let level = subject.levels.iter().find(|found| found.number == level).expect("a level of the game");
    let task = Task {
        subject,
        level,
        run: 2,
        seed: Seed::from_text("by hand"),
        max_steps,
        commit: Commitment::ONE,
        max_output_tokens: None,
        track: None,
        series: None,
    };
    let mut journal = Journal::in_memory();
    play(&task, &mut Contestant::Agent(Box::new(Script(actions.to_vec()))), &mut journal)
        .expect("it can be played");
    journal.events().to_vec()
}

/// The avatar bumps into a wall, moves away and returns, pauses, takes the gem, moves back and forth, and
/// goes through the door.
#[test]
fn worked_by_hand() {
    let subject = subject();
    let actions = [Up, Right, Left, Nil, Right, Right, Left, Right, Right, Right];
    let log = log(&subject, 0, &actions, 50);
    let replayed = replay(&subject, &log).unwrap();
    let columns: Vec<i32> = replayed.cells.iter().map(|cell| cell.expect("the avatar lives").0).collect();
    assert_eq!(columns, [1, 1, 2, 1, 1, 2, 3, 2, 3, 4, 5]);
    assert_eq!(replayed.rewards, [0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0]);
    let flags = |text: &str| text.chars().map(|flag| flag == '1').collect::<Vec<bool>>();
    assert_eq!(replayed.meaningful, flags("0000110011"));
    // The reference's code counts the move away before each return, and loses the last step.
    assert_eq!(replayed.meaningful_as_code, flags("010011001"));

    let found = EpisodeMetrics::of(&subject, &log).unwrap();
    let movement = Movement {
        bump_rate: Some(6.0 / 10.0),
        max_bumps: Some(4),
        late_bump_rate: Some(1.0 / 3.0),
        oscillation_rate: Some(3.0 / 10.0),
        still_rate: Some(2.0 / 10.0),
        unique_cells: Some(5),
        coverage: Some(1.0),
        displacement: Some(8),
    };
    assert_eq!(found.movement, movement);
    assert_eq!((found.meaningful, found.meaningful_as_code), (Some(0.4), Some(4.0 / 9.0)));
    assert_eq!((found.status, found.outcome, found.score), (EpisodeStatus::Over, Outcome::Won, 3.0));
    assert_eq!((found.game.as_str(), found.level, found.run, found.steps), ("hall", 0, 2, 10));
    assert_eq!((found.decision_ms.len(), found.calls.len()), (10, 0));
}

#[test]
fn the_shortest_win() {
    let subject = subject();
    let log = log(&subject, 0, &[Right; 4], 50);
    let found = EpisodeMetrics::of(&subject, &log).unwrap();
    assert!(found.won() && found.counts());
    assert_eq!(
        (found.meaningful, found.optimality(), found.unused_steps()),
        (Some(1.0), Some(1.0), Some(0.92))
    );
    // The shortest win of level 3 is unknown.
    let log = self::log(&subject, 3, &[Right; 9], 50);
    let found = EpisodeMetrics::of(&subject, &log).unwrap();
    assert_eq!((found.level, found.optimality()), (3, None));
}

/// Pushing a box and returning has changed the state. Pressing a key that the avatar does not have has not
/// changed it.
#[test]
fn moving_things_is_meaningful() {
    let subject = subject();
    let replayed = replay(&subject, &log(&subject, 3, &[Right, Right, Left, Use, Up], 5)).unwrap();
    assert_eq!(replayed.meaningful, [true, true, true, false, false]);
    let pushed = replay(&subject, &log(&subject, 3, &[Right, Right, Right], 3)).unwrap();
    assert_eq!((pushed.outcome, pushed.score), (Outcome::Ongoing, 0.0));
}

#[test]
fn end_events() {
    let subject = subject();
    let status = |log: &[Event]| EpisodeMetrics::of(&subject, log).unwrap().status;
    let limited = log(&subject, 0, &[Nil; 5], 5);
    assert_eq!(status(&limited), EpisodeStatus::StepLimit);
    let idle = EpisodeMetrics::of(&subject, &limited).unwrap();
    assert_eq!(
        (idle.meaningful, idle.movement.still_rate, idle.unused_steps()),
        (Some(0.0), Some(1.0), Some(0.0))
    );
    assert!(idle.counts() && !idle.won());

    let halted = log(&subject, 0, &[Right, Right], 5);
    assert_eq!(status(&halted), EpisodeStatus::Halted("infrastructure".to_owned()));
    assert_eq!(status(&halted[..2]), EpisodeStatus::Interrupted);
    let none = EpisodeMetrics::of(&subject, &halted[..1]).unwrap();
    assert_eq!((none.meaningful, none.movement.bump_rate, none.steps), (None, None, 0));
    assert_eq!(none.movement.unique_cells, Some(1));
    assert!(!none.counts());
}

#[track_caller]
fn check_fault(change: impl Fn(&mut Vec<Event>), expect: &str) {
    let subject = subject();
    let mut log = log(&subject, 0, &[Right, Left, Right, Right, Right], 5);
    change(&mut log);
    let error = EpisodeMetrics::of(&subject, &log).unwrap_err().to_string();
    assert!(error.contains(expect), "{error}");
}

/// The error for a log that does not replay states the step.
#[test]
fn damaged_logs_are_rejected() {
    let at = |log: &mut [Event], number: u64, change: &dyn Fn(&mut Event)| {
        let is_it = |event: &&mut Event| matches!(event, Event::Step { step, .. } if *step == number);
        change(log.iter_mut().find(is_it).expect("there is such a step"));
    };
    let alter = |event: &mut Event| {
        if let Event::Step { action, .. } = event {
            *action = Nil;
        }
    };
    check_fault(|log| at(log, 1, &alter), "line 3: step 1 leads to");
    let gain = |event: &mut Event| {
        if let Event::Step { score, .. } = event {
            *score += 1.0;
        }
    };
    check_fault(|log| at(log, 3, &gain), "step 3 leads to");
    check_fault(|log| drop(log.remove(1)), "step 0 is recorded as step 1");
    check_fault(|log| drop(log.remove(0)), "line 1 is not the start of an episode");
    let win = |log: &mut Vec<Event>| {
        if let Some(Event::End { outcome, .. }) = log.last_mut() {
            *outcome = Outcome::Won;
        }
    };
    check_fault(win, "the log records won");
    let older = |log: &mut Vec<Event>| {
        if let Some(Event::Start { semantics, .. }) = log.first_mut() {
            *semantics -= 1;
        }
    };
    check_fault(older, "read the log with the version that wrote it");
}

/// A step is classified by its last answer.
#[test]
fn answers() {
    let reply = |step: u64, attempt: u32, class: ReplyClass, output_tokens: Option<u64>| {
        Event::Reply(Reply {
            step,
            attempt,
            class,
            text: String::new(),
            reasoning: None,
            action: None,
            plan: None,
            stage: None,
            finish: Finish::Stop,
            usage: Usage { input_tokens: Some(100), output_tokens, ..Usage::default() },
            served_by: None,
            failures: Vec::new(),
            cached: false,
            latency_ms: 0.0,
        })
    };
    use ReplyClass::{Invalid, Refused, Strict, Tolerant, Truncated};
    let subject = subject();
    let steps = log(&subject, 0, &[Right, Nil, Right, Nil, Nil], 5);
    let answered = |classes: &[(&[ReplyClass], Validity)]| {
        let mut log = vec![steps[0].clone()];
        for (step, (event, (classes, came))) in steps[1..].iter().zip(classes).enumerate() {
            for (attempt, class) in classes.iter().enumerate() {
                let (step, attempt) = (step as u64, attempt as u32);
                log.push(Event::Request { step, attempt, messages: Vec::new(), tokens: 90 });
                let mut answer = reply(step, attempt, *class, Some(7));
                if let (Event::Reply(reply), Event::Step { action, .. }, Strict | Tolerant) =
                    (&mut answer, event, class)
                {
                    reply.action = Some(*action);
                }
                log.push(answer);
            }
            let mut event = event.clone();
            if let Event::Step { validity, .. } = &mut event {
                *validity = *came;
            }
            log.push(event);
        }
        log
    };
    let mut log = answered(&[
        (&[Strict], Validity::Valid),
        (&[Invalid, Invalid], Validity::Invalid),
        (&[Invalid, Tolerant], Validity::Valid),
        (&[Refused], Validity::Refused),
        (&[Truncated], Validity::Truncated),
    ]);
    // A step that contradicts its answers is rejected.
    for (at, came) in [(3, Validity::Invalid), (8, Validity::Valid), (13, Validity::Invalid)] {
        let mut forged = log.clone();
        let Event::Step { validity, .. } = &mut forged[at] else { panic!("{:?}", forged[at]) };
        *validity = came;
        let error = EpisodeMetrics::of(&subject, &forged).unwrap_err().to_string();
        assert!(error.contains(&format!("line {}: ", at + 1)) && error.contains("is recorded as"), "{error}");
    }
    let found = EpisodeMetrics::of(&subject, &log).unwrap();
    assert_eq!(found.choices, Choices { valid: 1, tolerant: 1, invalid: 1, refused: 1, truncated: 1 });
    assert_eq!((found.spending.requests, found.spending.replies), (7, 7));
    assert_eq!((found.spending.input_tokens, found.spending.output_tokens), (Some(700), Some(49)));
    assert_eq!(found.spending.reasoning_tokens, None);
    // A reply without a token count makes the sum of tokens unknown.
    log.push(reply(5, 0, Strict, None));
    assert_eq!(EpisodeMetrics::of(&subject, &log).unwrap().spending.output_tokens, None);
    let silent = EpisodeMetrics::of(&subject, &steps).unwrap().spending;
    assert_eq!((silent.requests, silent.input_tokens), (0, None));
}
