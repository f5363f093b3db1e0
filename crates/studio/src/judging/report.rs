//! The results of judging: how often games from each source are preferred, and how well the measures agree
//! with these preferences.

use super::record::{Better, Judgement, Judgements};
use serde::Serialize;
use statistics::{Z95, wilson};
use std::collections::BTreeMap;

/// A fraction, with its counts and its 95% interval.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Share {
    /// The number of cases in which a statement holds.
    pub count: u64,
    /// The total number of cases.
    pub of: u64,
    /// The fraction `count / of`, or `None` if there are no cases.
    pub rate: Option<f64>,
    /// The lower end of Wilson's interval.
    pub low: f64,
    /// The upper end of Wilson's interval.
    pub high: f64,
}

impl Share {
    fn of(count: u64, of: u64) -> Share {
        let interval = wilson(count, of, Z95);
        let rate = (of > 0).then(|| count as f64 / of as f64);
        Share { count, of, rate, low: interval.low, high: interval.high }
    }
}

/// A source's results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SourceRow {
    /// The source's name.
    pub name: String,
    /// The number of pairs in which the source's game is better.
    pub wins: u64,
    /// The number of pairs in which the other game is better.
    pub losses: u64,
    /// The number of pairs in which neither game is better.
    pub ties: u64,
    /// The fraction of wins among wins and losses, or `None` if there are neither wins nor losses.
    pub rate: Option<f64>,
    /// The lower end of Wilson's 95% interval.
    pub low: f64,
    /// The upper end of Wilson's 95% interval.
    pub high: f64,
    /// The fraction of games that the judge would play again.
    pub again: Share,
    /// The fraction of games that the judge believes were made by a machine, among the games for which the
    /// judge answered this question.
    pub machine: Share,
}

/// A measure's agreement with the preferences.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MeasureRow {
    /// The measure's name.
    pub name: String,
    /// The number of pairs in which the better game has the larger value.
    pub agrees: u64,
    /// The number of pairs in which one game is better and the values differ.
    pub pairs: u64,
    /// The fraction `agrees / pairs`, or `None` if `pairs` is 0. A fraction near 0 means that better games
    /// tend to have smaller values.
    pub rate: Option<f64>,
    /// The lower end of Wilson's 95% interval.
    pub low: f64,
    /// The upper end of Wilson's 95% interval.
    pub high: f64,
}

/// The results from a record.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Report {
    /// The number of judgements.
    pub judged: usize,
    /// The results of each source, sorted by name.
    pub sources: Vec<SourceRow>,
    /// The results of each measure, sorted by name.
    pub measures: Vec<MeasureRow>,
}

/// A source's counts.
#[derive(Clone, Copy, Default)]
struct Counts {
    wins: u64,
    losses: u64,
    ties: u64,
    again: u64,
    machine: [u64; 2],
}

impl Report {
    /// Counts the judgements. Pairs are treated as independent, although pairs that share a game are not. If there
    /// are few games, the intervals are therefore too narrow.
    pub fn of(Judgements(judgements): &Judgements) -> Report {
        let mut sources: BTreeMap<&str, Counts> = BTreeMap::new();
        let mut measures: BTreeMap<&str, (u64, u64)> = BTreeMap::new();
        for judgement in judgements {
            let Judgement { left, right, better, again, machine, .. } = judgement;
            for (number, side) in [left, right].into_iter().enumerate() {
                let counts = sources.entry(&side.source).or_default();
                match (better, number) {
                    (Better::Same, _) => counts.ties += 1,
                    (Better::Left, 0) | (Better::Right, 1) => counts.wins += 1,
                    _ => counts.losses += 1,
                }
                counts.again += u64::from(again.sides()[number]);
                if let Some(machine) = machine {
                    counts.machine[0] += u64::from(machine.sides()[number]);
                    counts.machine[1] += 1;
                }
            }
            let (winner, loser) = match better {
                Better::Left => (left, right),
                Better::Right => (right, left),
                Better::Same => continue,
            };
            for (name, value) in &winner.measures {
                let Some(other) = loser.measures.get(name).filter(|other| *other != value) else { continue };
                let (agrees, pairs) = measures.entry(name).or_default();
                *pairs += 1;
                *agrees += u64::from(value > other);
            }
        }
        let source = |(name, counts): (&str, Counts)| {
            let Counts { wins, losses, ties, again, machine } = counts;
            let Share { rate, low, high, .. } = Share::of(wins, wins + losses);
            let (again, machine) =
                (Share::of(again, wins + losses + ties), Share::of(machine[0], machine[1]));
            SourceRow { name: name.to_owned(), wins, losses, ties, rate, low, high, again, machine }
        };
        let measure = |(name, (agrees, pairs)): (&str, (u64, u64))| {
            let Share { rate, low, high, .. } = Share::of(agrees, pairs);
            MeasureRow { name: name.to_owned(), agrees, pairs, rate, low, high }
        };
        Report {
            judged: judgements.len(),
            sources: sources.into_iter().map(source).collect(),
            measures: measures.into_iter().map(measure).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::record::{Played, Side, Watched, Which};
    use super::*;
    use base::Digest;

    fn judgement(better: Better, again: Which, machine: Option<Which>, drama: [f64; 2]) -> Judgement {
        let side = |source: &str, drama: f64| Side {
            source: source.to_owned(),
            game: "game".to_owned(),
            digest: Digest::of(source.as_bytes()),
            measures: BTreeMap::from([("drama".to_owned(), drama), ("pace".to_owned(), 1.0)]),
        };
        Judgement {
            seed: String::new(),
            pair: 0,
            left: side("ours", drama[0]),
            right: side("theirs", drama[1]),
            better,
            again,
            machine,
            words: String::new(),
            played: Played::default(),
            watched: Watched::default(),
            after_report: false,
        }
    }

    #[test]
    fn preferences_and_agreement_are_counted() {
        let report = Report::of(&Judgements(vec![
            judgement(Better::Left, Which::Both, Some(Which::Right), [0.5, 0.25]),
            judgement(Better::Left, Which::Left, None, [0.25, 0.5]),
            judgement(Better::Right, Which::Neither, Some(Which::Both), [0.25, 0.5]),
            judgement(Better::Same, Which::Right, None, [0.25, 0.5]),
            judgement(Better::Left, Which::Left, None, [0.5, 0.5]),
        ]));
        let [ours, theirs] = &report.sources[..] else { panic!("{report:?}") };
        assert_eq!((ours.wins, ours.losses, ours.ties), (3, 1, 1));
        assert_eq!((theirs.wins, theirs.losses, theirs.ties), (1, 3, 1));
        assert_eq!((ours.rate, theirs.rate), (Some(0.75), Some(0.25)));
        assert!(ours.low < 0.75 && ours.high > 0.75);
        assert_eq!((ours.again.count, ours.again.of), (3, 5));
        assert_eq!((theirs.again.count, theirs.again.of), (2, 5));
        assert_eq!((ours.machine.count, ours.machine.of), (1, 2));
        assert_eq!((theirs.machine.count, theirs.machine.of), (2, 2));
        // The pace is the same in all games, so no pair provides evidence about it.
        let [drama] = &report.measures[..] else { panic!("{report:?}") };
        assert_eq!((drama.name.as_str(), drama.agrees, drama.pairs), ("drama", 2, 3));
    }
}
