//! Blind comparisons of games by people: pairs from several folders, of which nobody sees which is which.

mod measures;
mod record;
mod report;

pub use record::{Better, Judgement, Judgements, Played, Side, Which};
pub use report::{MeasureRow, Report, Share, SourceRow};

use crate::refusal::Refusal;
use engine::syntax::print_bare;
use engine::{Game, Level, Seed};
use measures::Measures;
use record::Keeper;

use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

/// The games of one source, such as a folder.
#[derive(Clone, Debug)]
pub struct Source {
    /// The name in the record: the judge does not see it.
    pub name: String,
    /// The games.
    pub games: Vec<Candidate>,
}

/// A game to be judged.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Its name in the source.
    pub id: String,
    /// The title that the judge sees.
    pub title: String,
    /// The game.
    pub game: Game,
    /// Its levels, the first ones.
    pub levels: Vec<Level>,
}

/// A candidate with what is found out about it on the way.
struct Entry {
    source: usize,
    candidate: Candidate,
    measures: OnceLock<Measures>,
}

/// A session of judging.
pub struct Judging {
    sources: Vec<String>,
    entries: Vec<Arc<Entry>>,
    seed: String,
    /// By number: the entries on the left and on the right.
    pairs: Vec<[usize; 2]>,
    keeper: Mutex<Keeper>,
}

/// The reasons why games cannot be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JudgingError {
    /// There is nothing to compare.
    #[error("{0}")]
    Games(String),
    /// The record cannot be read or written.
    #[error("cannot {action} `{file}`")]
    Io {
        /// The failed action.
        action: &'static str,
        /// The file.
        file: String,
        /// The cause.
        source: std::io::Error,
    },
    /// The record is of something else.
    #[error("{file}, line {line}: not a judgement: {why}; name another file, or remove the line")]
    Line {
        /// The file.
        file: String,
        /// The line, from 1.
        line: usize,
        /// The problem.
        why: String,
    },
}

impl JudgingError {
    fn io(action: &'static str, file: &Path) -> impl FnOnce(std::io::Error) -> JudgingError {
        let file = file.display().to_string();
        move |source| JudgingError::Io { action, file, source }
    }
}

/// The most pairs of a session.
pub const MOST_PAIRS: usize = 10_000;
/// The most levels of a game that are shown and measured.
const LEVELS: usize = 5;
/// The most characters of the words on a pair.
const MOST_WORDS: usize = 4000;

impl Judging {
    /// Draws `pairs` pairs by a seed, each of two sources, and opens the record; pairs that it has are not asked again. Returns also
    /// remarks on the record, if it was damaged.
    ///
    /// # Errors
    /// Fewer than two sources, a source without a game, or a record that cannot be read or written.
    pub fn open(
        sources: Vec<Source>,
        seed: &str,
        pairs: usize,
        record: &Path,
    ) -> Result<(Judging, Vec<String>), JudgingError> {
        if sources.len() < 2 {
            return Err(JudgingError::Games("two sources of games are needed to compare them".to_owned()));
        }
        if let Some(empty) = sources.iter().find(|source| source.games.is_empty()) {
            return Err(JudgingError::Games(format!("{}: no game with a level", empty.name)));
        }
        let counts: Vec<usize> = sources.iter().map(|source| source.games.len()).collect();
        let names = sources.iter().map(|source| source.name.clone()).collect();
        let mut entries = Vec::new();
        for (number, source) in sources.into_iter().enumerate() {
            for mut candidate in source.games {
                candidate.levels.truncate(LEVELS);
                entries.push(Arc::new(Entry { source: number, candidate, measures: OnceLock::new() }));
            }
        }
        let (keeper, remarks) = Keeper::open(record)?;
        let pairs = draw(&counts, Seed::from_text(seed), pairs.min(MOST_PAIRS));
        let judging =
            Judging { sources: names, entries, seed: seed.to_owned(), pairs, keeper: Mutex::new(keeper) };
        Ok((judging, remarks))
    }

    /// Measures the games in the background, in the order of the pairs, until the session ends.
    pub(crate) fn measure_ahead(judging: &Arc<Judging>) {
        let order: Vec<usize> = judging.pairs.iter().flatten().copied().collect();
        let weak: Weak<Judging> = Arc::downgrade(judging);
        std::thread::spawn(move || {
            for at in order {
                let Some(judging) = weak.upgrade() else { return };
                let entry = judging.entries[at].clone();
                drop(judging);
                entry.measured();
            }
        });
    }

    /// Returns the numbers of the pairs that are judged.
    fn judged(&self) -> BTreeSet<usize> {
        let keeper = self.keeper.lock().unwrap_or_else(PoisonError::into_inner);
        let own = keeper.judgements.0.iter().filter(|judgement| judgement.seed == self.seed);
        own.map(|judgement| judgement.pair).collect()
    }

    /// Returns the pair to judge next, without anything that tells the sources.
    pub(crate) fn next(&self) -> Value {
        let judged = self.judged();
        let next = (0..self.pairs.len()).find(|pair| !judged.contains(pair));
        let of = self.pairs.len();
        match next {
            None => json!({ "pair": of, "of": of, "done": true, "left": null, "right": null }),
            Some(pair) => {
                let both = self.pairs[pair].map(|at| &self.entries[at].candidate);
                // As many levels of the one as of the other: their number tells sources apart.
                let levels = both.iter().map(|candidate| candidate.levels.len()).min().unwrap_or_default();
                let [left, right] = both.map(|candidate| shown(candidate, levels));
                json!({ "pair": pair, "of": of, "done": false, "left": left, "right": right })
            }
        }
    }

    /// Adds a judgement to the record.
    pub(crate) fn add(&self, asked: Asked) -> Result<(), Refusal> {
        let Some(&pair) = self.pairs.get(asked.pair) else {
            return Err(Refusal::bad("there is no such pair").help("load the page again"));
        };
        let [left, right] = pair.map(|at| self.side(at));
        let judgement = Judgement {
            seed: self.seed.clone(),
            pair: asked.pair,
            left,
            right,
            better: asked.better,
            again: asked.again,
            machine: asked.machine,
            words: asked.words.chars().take(MOST_WORDS).collect(),
            played: asked.played,
        };
        let mut keeper = self.keeper.lock().unwrap_or_else(PoisonError::into_inner);
        keeper.add(judgement).map_err(|error| {
            Refusal::failed(format_args!("the judgement was not written: {error}"))
                .help("check the space on the disk, and answer again")
        })
    }

    fn side(&self, at: usize) -> Side {
        let entry = &self.entries[at];
        Side {
            source: self.sources[entry.source].clone(),
            game: entry.candidate.id.clone(),
            digest: entry.candidate.game.digest(),
            measures: entry.measured().clone(),
        }
    }

    /// Returns the results of the record so far.
    pub(crate) fn report(&self) -> Report {
        Report::of(&self.keeper.lock().unwrap_or_else(PoisonError::into_inner).judgements)
    }
}

impl Entry {
    fn measured(&self) -> &Measures {
        self.measures.get_or_init(|| measures::of(&self.candidate))
    }
}

/// Returns a game as its judge sees it: printed anew, since spelling and comments would tell where it is from.
fn shown(candidate: &Candidate, levels: usize) -> Value {
    let source = print_bare(candidate.game.description());
    let levels: Vec<String> = candidate.levels.iter().take(levels).map(ToString::to_string).collect();
    json!({
        "title": candidate.title,
        "describe": engine::describe(&candidate.game),
        "levels": levels,
        "source": source,
        "episodes": [],
    })
}

/// A judgement as the page sends it.
#[derive(Deserialize)]
pub(crate) struct Asked {
    pair: usize,
    better: Better,
    again: Which,
    machine: Option<Which>,
    #[serde(default)]
    words: String,
    #[serde(default)]
    played: Played,
}

/// Draws pairs of games of different sources: each combination of sources as often as the others, each game of a source about as often
/// as its others, the sides by lot.
fn draw(counts: &[usize], seed: Seed, pairs: usize) -> Vec<[usize; 2]> {
    let first = |source: usize| counts[..source].iter().sum::<usize>();
    let mut draws = seed.child("pairs", 0).sampler();
    // The games of each source in an order that is drawn anew whenever all had their turn.
    let mut waiting: Vec<Vec<usize>> = vec![Vec::new(); counts.len()];
    let combinations: Vec<[usize; 2]> =
        (0..counts.len()).flat_map(|a| (a + 1..counts.len()).map(move |b| [a, b])).collect();
    let mut order: Vec<[usize; 2]> = Vec::new();
    let mut drawn = Vec::new();
    while drawn.len() < pairs {
        if order.is_empty() {
            order.clone_from(&combinations);
            draws.shuffle(&mut order);
        }
        let Some(sources) = order.pop() else { break };
        let mut pair = sources.map(|source| {
            if waiting[source].is_empty() {
                waiting[source] = (0..counts[source]).collect();
                draws.shuffle(&mut waiting[source]);
            }
            first(source) + waiting[source].pop().unwrap_or_default()
        });
        if draws.below(2) == 1 {
            pair.reverse();
        }
        drawn.push(pair);
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_are_balanced_and_drawn_by_the_seed() {
        let counts = [4, 3, 5];
        let seed = Seed::from_text("pairs");
        let pairs = draw(&counts, seed, 60);
        assert_eq!(pairs, draw(&counts, seed, 60));
        assert_ne!(pairs, draw(&counts, Seed::from_text("others"), 60));
        let source = |at: usize| {
            if at < 4 {
                0
            } else if at < 7 {
                1
            } else {
                2
            }
        };
        let mut used = [0; 12];
        let mut combinations = std::collections::BTreeMap::new();
        let mut lower_left = 0;
        for [left, right] in &pairs {
            let mut sources = [source(*left), source(*right)];
            assert_ne!(sources[0], sources[1]);
            lower_left += usize::from(sources[0] < sources[1]);
            sources.sort_unstable();
            *combinations.entry(sources).or_insert(0) += 1;
            used[*left] += 1;
            used[*right] += 1;
        }
        assert!(combinations.values().all(|&count| count == 20), "{combinations:?}");
        for (of, count) in counts.iter().enumerate() {
            let own: Vec<i32> = (0..12).filter(|&at| source(at) == of).map(|at| used[at]).collect();
            assert_eq!(own.len(), *count);
            assert!(own.iter().max().unwrap() - own.iter().min().unwrap() <= 1, "{own:?}");
        }
        assert!((15..=45).contains(&lower_left), "{lower_left} of 60 on the left");
    }
}
