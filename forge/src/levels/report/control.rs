//! Are the levels as hard as was asked for?

use super::Judged;
use report::Share;
use serde::{Deserialize, Serialize};
use validators::Difficulty;

/// All labels, the easiest first.
const LABELS: [Difficulty; 6] = [
    Difficulty::VeryEasy,
    Difficulty::Easy,
    Difficulty::Medium,
    Difficulty::Hard,
    Difficulty::VeryHard,
    Difficulty::Unbeaten,
];

/// A label that at least this share of an unconstrained pool has can be expressed by the game.
const EXPRESSIBLE: f64 = 0.05;

/// Asked difficulty against measured difficulty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Control {
    /// The labels, the easiest first: the order of rows and columns.
    pub labels: Vec<Difficulty>,
    /// `[asked][measured]`: levels.
    pub table: Vec<Vec<u64>>,
    /// `[asked]`: levels that could not be measured, because nobody found a win. They count as misses.
    pub unmeasured: Vec<u64>,
    /// Levels with each label in a pool for which nothing was asked; empty if there is none.
    pub pool: Vec<u64>,
    /// Which labels that can be asked for the game can express: at least 5 % of the pool have them. All of these, if there is
    /// no pool.
    pub expressible: Vec<Difficulty>,
    /// Over all levels.
    pub all: Hits,
    /// Over levels whose asked label the game can express.
    pub of_expressible: Hits,
}

/// The places of the labels that were asked for, and measured.
type Asked = (usize, Option<usize>);

/// How often the asked label was met.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hits {
    /// Levels with the label that was asked for.
    pub exact: Share,
    /// Levels with it or a neighbouring one.
    pub within_one: Share,
    /// What picking at random from the pool would give, each level for the same question: the expected share; none without a
    /// pool.
    pub random_exact: Option<f64>,
    /// As that, with neighbouring labels.
    pub random_within_one: Option<f64>,
}

impl Control {
    pub(super) fn of(levels: &[Judged], pool: &[Difficulty]) -> Option<Control> {
        let asked = |judged: &Judged| Some((rank(judged.asked?), judged.label().map(rank)));
        let pairs: Vec<Asked> = levels.iter().filter_map(asked).collect();
        if pairs.iter().all(|(_, got)| got.is_none()) {
            return None;
        }
        let (mut table, mut unmeasured) = (vec![vec![0; LABELS.len()]; LABELS.len()], vec![0; LABELS.len()]);
        for &(asked, got) in &pairs {
            match got {
                Some(got) => table[asked][got] += 1,
                None => unmeasured[asked] += 1,
            }
        }
        let mut counts = vec![0u64; LABELS.len()];
        pool.iter().for_each(|label| counts[rank(*label)] += 1);
        let can_be_asked = |label: usize| LABELS[label].eases().is_some();
        let many = |label: usize| pool.is_empty() || counts[label] as f64 >= EXPRESSIBLE * pool.len() as f64;
        let can = |label: &usize| can_be_asked(*label) && many(*label);
        let asked_for: Vec<Asked> = pairs.iter().filter(|(asked, _)| can(asked)).copied().collect();
        Some(Control {
            all: Hits::of(&pairs, pool),
            of_expressible: Hits::of(&asked_for, pool),
            expressible: (0..LABELS.len()).filter(can).map(|label| LABELS[label]).collect(),
            labels: LABELS.to_vec(),
            pool: if pool.is_empty() { Vec::new() } else { counts },
            table,
            unmeasured,
        })
    }
}

impl Hits {
    fn of(pairs: &[Asked], pool: &[Difficulty]) -> Hits {
        let hits = |apart: usize| {
            let share = Share::yes(
                pairs.iter().map(|(asked, got)| got.is_some_and(|got| asked.abs_diff(got) <= apart)),
            );
            let picked = |asked: usize| {
                Share::yes(pool.iter().map(|label| rank(*label).abs_diff(asked) <= apart)).share()
            };
            let sum: f64 = pairs.iter().map(|(asked, _)| picked(*asked)).sum();
            let some = !pool.is_empty() && !pairs.is_empty();
            (share, some.then(|| sum / pairs.len() as f64))
        };
        let ((exact, random_exact), (within_one, random_within_one)) = (hits(0), hits(1));
        Hits { exact, within_one, random_exact, random_within_one }
    }
}

fn rank(label: Difficulty) -> usize {
    LABELS.iter().position(|known| *known == label).expect("all labels are listed")
}
