//! Tests that scores are not misleading. Each test covers a way in which numbers have been misleading in the
//! past.

use super::episode;
use super::folders::{evaluate, with_details};
use super::logs::{log, subject};
use base::Digest;
use engine::Action::{Left, Right};
use engine::Outcome;
use engine::Outcome::{Lost, Ongoing, Won};
use evaluation::metrics::{EpisodeMetrics, EpisodeStatus};
use evaluation::study::{Player, Study};
use evaluation::{Evaluation, Event, Subject, SubjectFacts};
use serde_json::json;
use std::collections::BTreeSet;

/// Returns `runs` episodes on each of the given games and levels. `wins` returns the number of wins on a
/// level.
fn episodes(
    games: usize,
    levels: usize,
    runs: u64,
    wins: impl Fn(usize, usize) -> u64,
) -> Vec<EpisodeMetrics> {
    let mut all = Vec::new();
    for (game, level) in (0..games).flat_map(|game| (0..levels).map(move |level| (game, level))) {
        for run in 0..runs {
            let outcome = if run < wins(game, level) { Won } else { Lost };
            all.push(episode(&format!("game{game}"), level, run, outcome, 0.0, 9));
        }
    }
    all
}

fn two(ours: Vec<EpisodeMetrics>, theirs: Vec<EpisodeMetrics>) -> Study {
    Study::new(vec![(Player::reference("a"), ours), (Player::reference("b"), theirs)], Vec::new())
}

#[test]
fn a_player_without_a_win_may_have_luck_elsewhere() {
    let study = two(episodes(6, 5, 5, |_, _| 0), episodes(6, 5, 5, |_, _| 5));
    let rates: Vec<_> = study.leaderboard.iter().filter_map(|row| row.scores.win_rate).collect();
    assert!(rates[0].value == 1.0 && rates[0].high == 1.0 && (0.4..0.5).contains(&rates[0].low), "{rates:?}");
    assert!(rates[1].value == 0.0 && rates[1].low == 0.0 && (0.5..0.6).contains(&rates[1].high), "{rates:?}");
    // With a single game, the interval applies to the game's levels.
    let study = two(episodes(1, 5, 5, |_, _| 0), episodes(1, 5, 5, |_, _| 5));
    assert!(study.leaderboard[1].scores.win_rate.is_some_and(|rate| rate.high < 0.14));
}

/// The second player is worse on both easy and hard levels, but most of its episodes on hard levels were
/// aborted.
#[test]
fn differences_and_tests_are_of_the_same_rates() {
    let ours = episodes(8, 2, 10, |game, level| if level == 0 { 8 } else { (game % 2) as u64 });
    let mut theirs = episodes(8, 2, 10, |game, level| if level == 0 { 7 - (game % 2) as u64 } else { 0 });
    for episode in theirs.iter_mut().filter(|episode| episode.level == 1 && episode.run >= 2) {
        episode.status = EpisodeStatus::Halted("infrastructure".to_owned());
        episode.outcome = Ongoing;
    }
    let study = two(ours, theirs);
    let found = &study.pairs.overall[0];
    let pooled = found.wins.map(|wins| wins as f64);
    let pooled = pooled[0] / found.episodes[0] as f64 - pooled[1] / found.episodes[1] as f64;
    assert!(pooled < -0.1, "pooled, the worse player seems better: {pooled}");
    let interval = found.over_games.expect("eight games");
    assert!((found.difference - 0.1).abs() < 1e-9 && (interval.value - found.difference).abs() < 1e-12);
    assert!((found.rates[0] - found.rates[1] - found.difference).abs() < 1e-12 && found.h > 0.0);
    assert!(found.p.is_some_and(|p| p < 0.05) && interval.low > 0.0, "{found:?}");
    // 64 of the episodes were aborted. All of them might have been wins of the second player, or all of them
    // losses.
    let [least, most] = found.bounds.expect("some were broken off");
    assert!((least + 0.3).abs() < 1e-9 && (most - 0.1).abs() < 1e-9, "{least} {most}");
    let row = study.leaderboard.iter().find(|row| row.player == 1).unwrap();
    let bounds = row.bounds.expect("some were broken off");
    assert!(
        (bounds[0] - 52.0 / 160.0).abs() < 1e-9 && (bounds[1] - 116.0 / 160.0).abs() < 1e-9,
        "{bounds:?}"
    );
    assert!(study.leaderboard.iter().any(|row| row.player == 0 && row.bounds.is_none()));
}

#[test]
fn five_games_prove_nothing_about_others() {
    let p = |games: usize| {
        let study = two(episodes(games, 5, 5, |_, _| 5), episodes(games, 5, 5, |_, _| 0));
        (study.pairs.overall[0].p, study.pairs.overall[0].within_levels.p)
    };
    assert_eq!((p(1).0, p(5).0, p(6).0), (None, Some(0.0625), Some(0.03125)));
    assert!(p(1).1 < 1e-10 && p(5).1 < 1e-10, "on exactly these levels there is no doubt");
}

#[test]
fn identical_episodes_are_one_observation() {
    let copies = |outcome: Outcome, name: &str| {
        let mut all = episodes(1, 1, 5, |_, _| if outcome == Won { 5 } else { 0 });
        all.iter_mut().for_each(|episode| episode.course = Some(Digest::of(name.as_bytes())));
        all
    };
    let study = two(copies(Won, "won"), copies(Lost, "lost"));
    let found = &study.pairs.by_level[0];
    assert_eq!((found.wins, found.episodes, found.p), ([1, 0], [1, 1], 1.0));
    assert_eq!(study.pairs.overall[0].within_levels.p, 1.0);
    let scores = &study.leaderboard[0].scores;
    assert_eq!((scores.episodes, scores.observations), (5, 1));
    assert!(scores.win_rate.is_some_and(|rate| rate.value == 1.0 && rate.low < 0.21));
    // Episodes with different steps count as different episodes, even if their results are equal.
    let mut different = copies(Won, "won");
    different.iter_mut().for_each(|episode| episode.course = Some(Digest::of(&[episode.run as u8])));
    assert_eq!(two(different, copies(Lost, "lost")).leaderboard[0].scores.observations, 5);
}

/// The first sentences of a report state which player is best, how certain this result is, and how players
/// fail.
#[test]
fn verdicts() {
    let said = |games: usize, theirs: u64| {
        let ours = episodes(games, 5, 5, |game, _| if game % 2 == 0 { 5 } else { 3 });
        two(ours, episodes(games, 5, 5, |_, _| theirs)).verdict()
    };
    let clear = said(12, 1);
    let expect = "a won the most: 80% (240 of 300 episodes); in games like these, 64 to 90%. This player is better than b in games like these \
                  (+60 points, +47 to +73, p < 0.001, 12 games)";
    assert!(clear[0].starts_with(expect), "{}", clear[0]);
    assert_eq!(clear[1], "a did not win 60 of 300 episodes: 60 were lost by the rules of the game.");
    assert!(clear[2].starts_with("b did not win 240 of 300"), "{}", clear[2]);
    assert!(said(12, 4)[0].contains("not shown"), "{:?}", said(12, 4));
    let even = two(
        episodes(12, 5, 5, |game, _| if game % 2 == 0 { 4 } else { 2 }),
        episodes(12, 5, 5, |game, _| if game % 2 == 0 { 2 } else { 4 }),
    );
    assert!(even.verdict()[0].contains("(0 points, −27 to +27, p = 1.000"), "{:?}", even.verdict());
    assert!(said(5, 0)[0].contains(" Fewer than six games cannot show"), "{:?}", said(5, 0));
    assert!(said(1, 0)[0].contains("on exactly these levels"), "{:?}", said(1, 0));
    assert!(said(1, 0)[0].contains(" A single game does not show"), "{:?}", said(1, 0));
    assert!(Study::new(vec![(Player::reference("a"), Vec::new())], Vec::new()).verdict().is_empty());
}

/// Identical episodes are recognised by the actions and boards in their logs.
#[test]
fn courses_of_episodes() {
    let subject = subject();
    let course = |actions: &[engine::Action]| {
        EpisodeMetrics::of(&subject, &log(&subject, 0, actions, 50)).unwrap().course.expect("it is known")
    };
    assert_eq!(course(&[Right, Left, Right]), course(&[Right, Left, Right]));
    let all = [course(&[Right]), course(&[Left]), course(&[Right, Left]), course(&[Right, Left, Left])];
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), 4);
}

/// One model at two temperatures counts as two persons, and their row labels state the difference.
#[test]
fn decoding_and_prompts_tell_persons_apart() {
    let home = tempfile::tempdir().unwrap();
    let folder = |name: &str, temperature: f64, server: &str| {
        let details = json!({
            "model": { "decoding": { "temperature": temperature, "top_p": 1 }, "server": server },
            "prompt_digest": "5fe01b2c9d",
        });
        with_details(&home.path().join(name), "random", vec![subject()], details)
    };
    let folders = [folder("cold", 0.0, "here"), folder("hot", 1.5, "there")];
    let study = Study::read(&folders).unwrap();
    let labels: Vec<String> = study.players.iter().map(Player::label).collect();
    assert_eq!(labels, ["random (temperature 0.0)", "random (temperature 1.5)"]);
    assert_eq!(study.pairs.overall.len(), 1, "and they are compared");
    // The same model on a different server is the same person, so the same episodes were played twice.
    let again = folder("again", 0.0, "there");
    let error = Study::read(&[folders[0].clone(), again]).unwrap_err().to_string();
    assert!(error.contains("also played run"), "{error}");
}

/// A renamed game has the same randomness in its episodes, and reaches the same states after the same
/// actions.
#[test]
fn twins_share_chance_and_states() {
    let own = subject();
    let rename = |text: &str| {
        ["door", "gem", "box", "guard"]
            .iter()
            .zip(["t1", "t2", "t3", "t4"])
            .fold(text.to_owned(), |text, (name, mask)| text.replace(name, mask))
    };
    let levels: Vec<(usize, String, Option<usize>)> = own
        .levels
        .iter()
        .map(|level| (level.number, level.text.replace('d', "q"), level.optimal_ticks))
        .collect();
    let source = rename(&own.source).replace("        d > t1", "        q > t1");
    let twin =
        Subject::read(&own.id, &source, &levels, SubjectFacts::default()).expect("renaming keeps it sound");
    assert_ne!(own.game.digest(), twin.game.digest());
    let home = tempfile::tempdir().unwrap();
    let folders = [("own", own), ("twin", twin)]
        .map(|(name, game)| evaluate(&home.path().join(name), "random", vec![game]));
    let hashes = |folder| {
        let evaluation = Evaluation::open(folder).unwrap();
        let tasks = evaluation.tasks();
        let logs = tasks.iter().map(|task| evaluation.events(task).unwrap());
        let of_event = |event: Event| match event {
            Event::Start { hash, seed, .. } => Some((hash, Some(seed))),
            Event::Step { hash, .. } => Some((hash, None)),
            _ => None,
        };
        logs.map(|log| log.into_iter().filter_map(of_event).collect()).collect::<Vec<Vec<_>>>()
    };
    let (ours, theirs) = (hashes(&folders[0]), hashes(&folders[1]));
    assert!(ours.len() == 4 && ours.iter().all(|log| log.len() > 5));
    assert_eq!(ours, theirs, "a player that heeds no names plays the same");
    let study = Study::read(&folders).unwrap();
    let labels: Vec<String> = study.players.iter().map(Player::label).collect();
    assert_eq!(labels, ["random", "random (games under other names)"]);
    assert_eq!((study.games.len(), study.pairs.overall.len()), (1, 1));
}

/// A game's left-right mirror image counts as the same game with different randomness. Games that differ in
/// other ways are rejected.
#[test]
fn mirrored_twins_are_reported_beside_originals() {
    let source = "BasicGame\n  SpriteSet\n    gem > Immovable\n    eastgust > Missile orientation=RIGHT\n    imp > Bomber stype=gem \
                  spawnorientation=LEFT prob=0.1\n    avatar > MovingAvatar\n  LevelMapping\n    g > gem\n    e > eastgust\n    i > imp\n  \
                  InteractionSet\n    avatar wall > stepBack\n    eastgust wall > reverseDirection\n    imp wall > turnAround\n    gem avatar > \
                  killSprite scoreChange=1\n    avatar eastgust > killSprite\n    imp EOS > spawnLeft stype=gem\n  TerminationSet\n    \
                  SpriteCounter stype=gem win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=50\n";
    let image = source
        .replace("eastgust", "westgust")
        .replace("orientation=RIGHT", "orientation=WEST")
        .replace("spawnorientation=LEFT", "spawnorientation=RIGHT")
        .replace("orientation=WEST", "orientation=LEFT")
        .replace("stype=gem spawn", "stype=gem orientation=LEFT spawn")
        .replace("spawnLeft", "spawnRight");
    let level = "wwwwwwww\nwA e  gw\nw  i   w\nwwwwwwww\n";
    let reversed: String = level.lines().map(|row| row.chars().rev().collect::<String>() + "\n").collect();
    let game = |source: &str, level: &str| {
        let levels = [(0, level.to_owned(), None)];
        Subject::read("gusts", source, &levels, SubjectFacts::default()).expect("the game is sound")
    };
    let home = tempfile::tempdir().unwrap();
    let folder = |name: &str, subject| evaluate(&home.path().join(name), "random", vec![subject]);
    let own = folder("own", game(source, level));
    let twin = folder("twin", game(&image, &reversed));
    let study = Study::read(&[own.clone(), twin.clone()]).unwrap();
    let labels: Vec<String> = study.players.iter().map(Player::label).collect();
    assert_eq!(labels, ["random", "random (games mirrored)"]);
    assert_eq!((study.games.len(), study.pairs.overall.len()), (1, 1));
    assert!(study.notes.iter().any(|note| note.starts_with("Mirrored games")), "{:?}", study.notes);
    assert!(Study::read(&[twin, own.clone()]).is_ok(), "either may come first");
    let others = [
        ("unmirrored level", game(&image, level)),
        ("unmirrored rules", game(source, &reversed)),
        (
            "one direction kept",
            game(&image.replace("spawnorientation=RIGHT", "spawnorientation=LEFT"), &reversed),
        ),
        ("one facing kept", game(&image.replace(" orientation=LEFT spawn", " spawn"), &reversed)),
        ("another score", game(&image.replace("scoreChange=1", "scoreChange=2"), &reversed)),
    ];
    for (name, other) in others {
        let error = Study::read(&[own.clone(), folder(name, other)]).expect_err(name).to_string();
        assert!(error.contains("differs from that in an earlier folder"), "{name}: {error}");
    }
}
