//! Plausibility checks for the numbers on a card.
//!
//! The checks replay nothing, so a plausible number may still differ from the judges' result. `regenerate`
//! detects such differences.

use engine::{Level, MAX_TICKS};
use forge::card::LevelCard;
use statistics::{Z95, wilson};
use validators::{Difficulty, Ladder, PlayerResult, Rate};

/// The maximum absolute value of scores and mean scores. The effects of an episode cannot add up to more.
const MAX_SCORE: f64 = 1e15;
/// The maximum number of episodes of one player on one level.
const MAX_PLAYS: u64 = 1_000_000;
/// The tolerance for a stated interval, compared with the interval computed from its counts, because other versions
/// may round differently.
const ROUNDING: f64 = 1e-9;

/// Returns the problems with the numbers on a level's card.
pub(crate) fn problems(card: &LevelCard, level: &Level) -> Vec<String> {
    let mut problems = Vec::new();
    let mut expect = |holds: bool, what: String| {
        if !holds {
            problems.push(what);
        }
    };
    let sides = (card.columns, card.rows);
    let found = (level.columns(), level.rows());
    expect(
        sides == found,
        format!(
            "the card states a board of {} by {}, but the board is {} by {}",
            sides.0, sides.1, found.0, found.1
        ),
    );
    expect(is_share(card.difficulty), format!("the difficulty {} is not between 0 and 1", card.difficulty));
    let ticks = card.witness_ticks;
    let possible = 1..=MAX_TICKS as usize;
    expect(
        possible.contains(&ticks),
        format!("the card states a witness of {ticks} ticks, but a witness has 1 to {MAX_TICKS} ticks"),
    );
    expect(
        is_score(card.witness_score),
        format!("the card states a score of {}, which no episode can have", card.witness_score),
    );
    if let Some(optimal) = card.optimal_ticks {
        expect(
            (1..=ticks).contains(&optimal),
            format!("the card states a shortest win of {optimal} ticks, but a witness of {ticks} ticks"),
        );
    }
    for (who, rate) in [("mcts", &card.mcts), ("random", &card.random), ("idle", &card.idle)] {
        problems.extend(of_rate(rate).map(|what| format!("`{who}` {what}")));
    }
    problems.extend(card.ladder.iter().flat_map(of_ladder));
    problems
}

fn is_share(number: f64) -> bool {
    (0.0..=1.0).contains(&number)
}

fn is_score(number: f64) -> bool {
    number.abs() <= MAX_SCORE
}

/// Returns the first problem with a player's results; `None` if there is no problem.
fn of_rate(rate: &Rate) -> Option<String> {
    let Rate { wins, plays, interval, mean_score, .. } = *rate;
    if plays > MAX_PLAYS {
        return Some(format!("has {plays} plays; the limit is {MAX_PLAYS}"));
    }
    if wins > plays {
        return Some(format!("has {wins} wins in {plays} plays"));
    }
    let due = wilson(wins, plays, Z95);
    if !((interval[0] - due.low).abs() <= ROUNDING && (interval[1] - due.high).abs() <= ROUNDING) {
        return Some(format!(
            "has the interval {} to {}, but {wins} wins in {plays} plays give {:.4} to {:.4}",
            interval[0], interval[1], due.low, due.high
        ));
    }
    (!is_score(mean_score)).then(|| format!("has a mean score of {mean_score}, which no episodes can have"))
}

fn of_ladder(ladder: &Ladder) -> Vec<String> {
    let mut problems = Vec::new();
    let Ladder { rungs, held_out, ease, difficulty } = ladder;
    for PlayerResult { player, rate, win_ticks, reward, .. } in rungs.iter().chain(held_out) {
        let name = player.escape_debug();
        problems.extend(of_rate(rate).map(|what| format!("`{name}` {what}")));
        let in_time = win_ticks.is_none_or(|ticks| (0.0..=f64::from(MAX_TICKS)).contains(&ticks));
        if win_ticks.is_some() != (rate.wins > 0) || !in_time {
            problems.push(format!("`{name}` has an impossible mean number of ticks for {} wins", rate.wins));
        }
        if !reward.is_none_or(is_share) {
            problems.push(format!("`{name}` has a reward that is not between 0 and 1"));
        }
    }
    if !ease.is_none_or(is_share) {
        problems.push("the ease is not between 0 and 1".to_owned());
    }
    let beaten = rungs.iter().any(|result| result.rate.wins > 0);
    let ease = ease.unwrap_or_default();
    let fits = match difficulty.eases() {
        None => !beaten,
        Some([from, below]) => {
            beaten && ease >= from && (ease < below || *difficulty == Difficulty::VeryEasy)
        }
    };
    if !fits {
        let wins = if beaten { "some player wins" } else { "no player wins" };
        problems.push(format!("the difficulty is `{difficulty}`, but the ease is {ease:.2} and {wins}"));
    }
    problems
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(wins: u64, plays: u64) -> Rate {
        let due = wilson(wins.min(plays), plays, Z95);
        Rate { wins, plays, interval: [due.low, due.high], calls: 0, mean_score: 0.0 }
    }

    #[track_caller]
    fn check(rate: &Rate, expect: Option<&str>) {
        match (of_rate(rate), expect) {
            (None, None) => {}
            (Some(found), Some(words)) => assert!(found.contains(words), "{found}"),
            (found, expect) => panic!("{found:?}, not {expect:?}"),
        }
    }

    #[test]
    fn rates() {
        check(&rate(2, 4), None);
        check(&rate(0, 0), None);
        check(&rate(99, 4), Some("99 wins in 4 plays"));
        check(&rate(0, u64::MAX), Some("the limit is 1000000"));
        check(&Rate { interval: [0.0, 0.3], ..rate(0, 8) }, Some("give 0.0000 to 0.3244"));
        check(&Rate { interval: [f64::NAN, 0.0], ..rate(0, 8) }, Some("has the interval"));
        check(&Rate { mean_score: 1e300, ..rate(0, 8) }, Some("mean score"));
        check(&Rate { mean_score: f64::NAN, ..rate(0, 8) }, Some("mean score"));
    }

    #[track_caller]
    fn check_ladder(ladder: &Ladder, expect: &[&str]) {
        let found = of_ladder(ladder);
        assert_eq!(found.len(), expect.len(), "{found:?}");
        for (problem, words) in found.iter().zip(expect) {
            assert!(problem.contains(words), "{problem}");
        }
    }

    #[test]
    fn ladders() {
        let result = |wins: u64| PlayerResult {
            player: "mcts:30".into(),
            looks_ahead: true,
            rate: rate(wins, 4),
            win_ticks: (wins > 0).then_some(20.0),
            reward: Some(0.5),
        };
        let ladder = Ladder {
            rungs: vec![result(2)],
            held_out: Vec::new(),
            ease: Some(0.5),
            difficulty: Difficulty::Medium,
        };
        check_ladder(&ladder, &[]);
        check_ladder(&Ladder { ease: Some(0.9), ..ladder.clone() }, &["the difficulty is `medium`"]);
        check_ladder(
            &Ladder { ease: Some(1e300), ..ladder.clone() },
            &["the ease is not between 0 and 1", "the difficulty"],
        );
        check_ladder(&Ladder { difficulty: Difficulty::Unbeaten, ..ladder.clone() }, &["some player wins"]);
        check_ladder(&Ladder { rungs: vec![result(0)], ..ladder.clone() }, &["no player wins"]);
        let odd = PlayerResult { reward: Some(2.0), win_ticks: None, ..result(2) };
        check_ladder(
            &Ladder { rungs: vec![odd], ..ladder },
            &["mean number of ticks", "a reward that is not between 0 and 1"],
        );
    }
}
