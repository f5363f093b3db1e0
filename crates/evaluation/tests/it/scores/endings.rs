//! Tests of the causes of endings, and of the order of the most informative episodes.

use super::episode;
use super::logs::log;
use engine::Action::{self, Left, Nil, Right};
use engine::Outcome::{Lost, Ongoing, Won};
use evaluation::metrics::{Ending, EndingKind, EpisodeMetrics};
use evaluation::study::{Player, Study, StudyGame};
use evaluation::{Subject, SubjectFacts};

const GAME: &str = "
BasicGame
    SpriteSet
        gem > Immovable
        pit > Immovable
        flower > Immovable
        arrow > Missile orientation=LEFT
        seed > Immovable
        weed > Immovable
        avatar > MovingAvatar
    LevelMapping
        g > gem
        p > pit
        f > flower
        a > arrow
        s > seed
    InteractionSet
        avatar wall > stepBack
        gem avatar > killSprite
        avatar pit >   killSprite   # it is deep
        flower arrow > killSprite scoreChange=-1
        avatar EOS > killSprite
        seed avatar > transformTo stype=weed
    TerminationSet
        SpriteCounter stype=gem win=True
        SpriteCounter stype=flower win=False
        SpriteCounterMore stype=weed limit=1 win=False
        SpriteCounter stype=avatar win=False
        Timeout limit=6 win=False
";

const LEVELS: [&str; 3] =
    ["wwwwwwwww\nwgAgp  fw\nwwwwwwwww", "wwwwwwwww\nwgA    fa\nwwwwwwwww", "wwwwwwwww\nAs   g fw\nwwwwwwwww"];

fn subject() -> Subject {
    let levels: Vec<_> =
        LEVELS.iter().enumerate().map(|(number, text)| (number, (*text).to_owned(), None)).collect();
    Subject::read("garden", GAME, &levels, SubjectFacts::default()).expect("the game is sound")
}

fn ending(level: usize, actions: &[Action], max_steps: u64) -> Option<Ending> {
    let subject = subject();
    EpisodeMetrics::of(&subject, &log(&subject, level, actions, max_steps)).unwrap().ending
}

#[test]
fn causes() {
    let check = |level, actions: &[Action], expect: (EndingKind, &str, Option<&str>, &str)| {
        let found = ending(level, actions, 20).expect("it was not won");
        let left = found.distance.as_ref().expect("gems are counted").words();
        assert_eq!((found.kind, found.words().as_str(), found.rule.as_deref(), left.as_str()), expect);
    };
    let pit = (EndingKind::Died, "died of touching pit", Some("avatar pit > killSprite"), "1 of 2 gem left");
    check(0, &[Right, Right], pit);
    let late =
        (EndingKind::OutOfTime, "ran out of time", Some("Timeout limit=6 win=False"), "2 of 2 gem left");
    check(0, &[Nil; 9], late);
    let rule = Some("flower arrow > killSprite scoreChange=-1");
    check(1, &[Nil; 9], (EndingKind::Lost, "lost flower to arrow", rule, "1 of 1 gem left"));
    let rule = Some("avatar EOS > killSprite");
    check(2, &[Left; 3], (EndingKind::Died, "died at the edge of the screen", rule, "1 of 1 gem left"));
    let rule = Some("SpriteCounterMore stype=weed limit=1 win=False");
    check(2, &[Right], (EndingKind::Appeared, "lost when weed appeared", rule, "1 of 1 gem left"));
}

/// An avatar that has changed its type is alive. The lost sprite is reported under the type that the
/// termination counts.
#[test]
fn another_form_is_no_death() {
    let forms = "me >\n            avatar > MovingAvatar\n            frog > MovingAvatar";
    let source = GAME
        .replace("avatar > MovingAvatar", forms)
        .replace("avatar pit >   killSprite   # it is deep", "avatar pit > transformTo stype=frog");
    let level = "wwwwwwwww\nwgApg  fw\nwwwwwwwww".to_owned();
    let subject = Subject::read("pond", &source, &[(0, level, None)], SubjectFacts::default()).unwrap();
    let found = EpisodeMetrics::of(&subject, &log(&subject, 0, &[Right], 9)).unwrap().ending.unwrap();
    assert_eq!((found.kind, found.words().as_str()), (EndingKind::Lost, "lost avatar to pit"));
}

/// If several interactions in the last tick could have killed the avatar, the one that killed it is reported,
/// rather than the last one. A dead avatar continues to touch sprites, and conditions may or may not hold.
#[test]
fn the_interaction_that_killed_is_named() {
    let check = |rules: &str, sprites: &str, expect: &str, rule: &str| {
        let source = GAME
            .replace(
                "        gem > Immovable\n",
                &format!("        gem > Immovable\n        rust > Resource limit=3\n{sprites}"),
            )
            .replace("        g > gem\n", "        g > gem\n        x > pit seed\n")
            .replace("        avatar pit >   killSprite   # it is deep\n", rules)
            .replace("        seed avatar > transformTo stype=weed\n", "");
        let level = "wwwwwwwww\nwgAx   fw\nwwwwwwwww".to_owned();
        let subject = Subject::read("garden", &source, &[(0, level, None)], SubjectFacts::default());
        let subject = subject.expect("the game is sound");
        let ending = EpisodeMetrics::of(&subject, &log(&subject, 0, &[Right], 20)).unwrap().ending;
        let ending = ending.expect("it was not won");
        assert_eq!((ending.words().as_str(), ending.rule.as_deref()), (expect, Some(rule)));
    };
    let kill = "        avatar pit > killSprite\n";
    let never = "        avatar seed > killIfHasLess resource=rust limit=-1\n";
    check(&format!("{kill}{never}"), "", "died of touching pit", kill.trim());
    check(&format!("{never}{kill}"), "", "died of touching pit", kill.trim());
    let less = "        avatar seed > killIfHasLess resource=rust limit=1\n";
    check(&format!("{less}{kill}"), "", "died of touching seed", less.trim());
    let both = "        pit avatar > killBoth\n";
    check(&format!("{both}{less}"), "", "died of touching pit", both.trim());
    let ghost = "        avatar seed > transformTo stype=ghost\n";
    let ghostly = "        ghost > MovingAvatar\n";
    check(&format!("{ghost}{kill}"), ghostly, "lost avatar to seed", ghost.trim());
}

#[test]
fn limits_wins_and_aborted_episodes() {
    let limited = ending(0, &[Left, Nil], 2).expect("it was not won");
    assert_eq!((limited.kind, limited.rule), (EndingKind::StepLimit, None));
    assert_eq!(limited.distance.map(|left| (left.left, left.of)), Some((1, 2)));
    assert_eq!(ending(0, &[Left, Right, Right], 20), None, "a win");
    assert_eq!(ending(0, &[Left], 20), None, "the player was cut off");
}

/// The order contains one episode of each cause, then second episodes, then wins. The most frequent cause
/// comes first, with its episode nearest to a win.
#[test]
fn telling_episodes() {
    let subject = subject();
    let play = |run: u64, actions: &[Action]| {
        let metrics = EpisodeMetrics::of(&subject, &log(&subject, 0, actions, 20)).unwrap();
        EpisodeMetrics { run, ..metrics }
    };
    let episodes = vec![
        play(0, &[Left, Right, Right]),
        play(1, &[Nil; 9]),
        play(2, &[Right, Right]),
        play(3, &[Left, Nil, Nil, Nil, Nil, Nil, Nil]),
        // A second cause of a known kind comes after the first cause of a different kind.
        EpisodeMetrics::of(&subject, &log(&subject, 2, &[Left; 3], 20))
            .map(|lost| EpisodeMetrics { run: 4, ..lost })
            .unwrap(),
        play(5, &[Right, Right]),
    ];
    let game = StudyGame { kind: "maze".to_owned(), ..StudyGame::from(&subject) };
    let study = Study::new(vec![(Player::reference("a"), episodes)], vec![game]);
    let runs =
        |count| study.telling(0, count).iter().map(|episode| episode.metrics.run).collect::<Vec<u64>>();
    assert_eq!(runs(9), [2, 3, 4, 5, 1, 0]);
    assert_eq!(runs(1), [2]);
    let rows: Vec<_> = study.endings.iter().map(|row| (row.cause.as_str(), row.episodes)).collect();
    assert_eq!(
        rows,
        [("died of touching pit", 2), ("ran out of time", 2), ("died at the edge of the screen", 1)]
    );
    let expect = "a did not win 5 of 6 episodes: 3 died (most often of touching pit in garden, 2 times), 2 ran out of time. Closest to a \
                  win: 1 of 2 (gem) remaining.";
    assert_eq!(study.verdict()[1], expect);
}

#[test]
fn results_by_kind() {
    let kinds = ["maze", "shooter", "maze", ""];
    let games: Vec<StudyGame> = kinds
        .iter()
        .zip(0..)
        .map(|(kind, at)| StudyGame {
            id: format!("g{at}"),
            kind: (*kind).to_owned(),
            ..StudyGame::default()
        })
        .collect();
    let played = |wins: [bool; 4]| {
        let outcome = |won| if won { Won } else { Lost };
        let episodes = wins.iter().zip(0..);
        episodes.map(|(&won, at)| episode(&format!("g{at}"), 0, 0, outcome(won), 0.0, 9)).collect::<Vec<_>>()
    };
    let results = vec![
        (Player::reference("a"), played([true, false, true, false])),
        (Player::reference("b"), played([false; 4])),
    ];
    let study = Study::new(results.clone(), games);
    let table = study.tables().into_iter().find(|table| table.id == "kinds").expect("a table of kinds");
    assert_eq!(table.columns, ["kind", "games", "a", "b"]);
    let rows: Vec<String> =
        table.rows.iter().map(|row| format!("{} {}", row[0].plain(), row[1].plain())).collect();
    assert_eq!(rows, ["maze 2", "not recorded 1", "shooter 1"]);
    assert!(table.rows[0][2].plain().starts_with("1.00 ["), "{:?}", table.rows[0]);
    assert!(
        study.verdict()[0].contains("the player won most in maze (2 of 2) and least in"),
        "{:?}",
        study.verdict()
    );
    // If the results have no kinds, the report lists none.
    let unknown = Study::new(results, Vec::new());
    assert!(unknown.kinds.is_empty() && !unknown.verdict()[0].contains("kind"), "{:?}", unknown.verdict());
}

/// A baseline may be better than the best other player, or there may be no best player.
#[test]
fn the_best_is_called_best_only_if_it_is() {
    let won = |wins: u64| {
        let outcome = |run| if run < wins { Won } else { Ongoing };
        (0..4).map(|run| episode("g", 0, run, outcome(run), 0.0, 9)).collect::<Vec<_>>()
    };
    let first = |ours: u64, baseline: u64| {
        let results =
            vec![(Player::model("m", "zero-shot"), won(ours)), (Player::reference("b"), won(baseline))];
        Study::new(results, Vec::new()).verdict().swap_remove(0)
    };
    assert!(first(2, 1).starts_with("m (zero-shot) won the most: 50%"), "{}", first(2, 1));
    assert!(first(1, 2).starts_with("m (zero-shot) won: 25%"), "{}", first(1, 2));
    assert!(first(0, 2).starts_with("m (zero-shot) won no episode: 0%"), "{}", first(0, 2));
    let ahead = "The baseline b won the most: 50% (2 of 4 episodes).";
    assert!(first(1, 2).contains(ahead) && first(0, 2).contains(ahead), "{}", first(1, 2));
    assert!(!first(2, 2).contains("The baseline") && !first(2, 1).contains("The baseline"));
    // The higher rate comes from one additional easy level. On the levels that both players played, the
    // baseline won more often.
    let on = |wins: &[(&str, bool)]| {
        let outcome = |won: bool| if won { Won } else { Lost };
        wins.iter().map(|&(game, won)| episode(game, 0, 0, outcome(won), 0.0, 9)).collect::<Vec<_>>()
    };
    let ours = on(&[("f", true), ("g", true), ("h", false), ("i", true)]);
    let baseline = on(&[("g", true), ("h", true), ("j", false), ("k", false)]);
    let results = vec![(Player::model("m", "zero-shot"), ours), (Player::reference("b"), baseline)];
    let lead = Study::new(results, Vec::new()).verdict().swap_remove(0);
    assert!(lead.starts_with("m (zero-shot) won: 75%"), "{lead}");
}
