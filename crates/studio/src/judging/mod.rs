//! Blind comparisons of games by people, who judge pairs of games from several folders without knowing their
//! origins.

mod measures;
mod record;
mod report;
mod watch;

pub use record::{Better, Judgement, Judgements, Played, Side, Watched, Which};
pub use report::{MeasureRow, Report, Share, SourceRow};

use crate::api::Replayed;
use crate::compiled::Cache;
use crate::refusal::Refusal;
use base::MessagePath;
use base::Seed;
use engine::syntax::print_bare;
use engine::{Game, Level};
use measures::Measures;
use record::Keeper;
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError, Weak};
use watch::{Hand, Play, Plays};

pub(crate) use watch::Wanted;

/// The games from one source, such as a folder.
#[derive(Clone, Debug)]
pub struct Source {
    /// The source's name in the record, which is hidden from the judge.
    pub name: String,
    /// The source's games.
    pub games: Vec<Candidate>,
}

/// A game to be judged.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// The game's name within its source.
    pub id: String,
    /// The title shown to the judge.
    pub title: String,
    /// The candidate's compiled game.
    pub game: Game,
    /// The game's first levels.
    pub levels: Vec<Level>,
}

/// A candidate, with the facts collected during the session.
struct Entry {
    source: usize,
    candidate: Candidate,
    measures: OnceLock<Measures>,
}

/// A judging session.
pub struct Judging {
    sources: Vec<String>,
    entries: Vec<Arc<Entry>>,
    seed: String,
    /// The pairs, each as the indices of its left and right entries.
    pairs: Vec<[usize; 2]>,
    keeper: Mutex<Keeper>,
    plays: Plays,
    /// `true` once the judge has requested the report before the end of the session. Later judgements are not blind.
    ended: AtomicBool,
}

/// The reason why games cannot be judged.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum JudgingError {
    /// There are no games to compare.
    #[error("{0}")]
    Games(String),
    /// The record cannot be read or written.
    #[error("cannot {action} `{file}`")]
    Io {
        /// The failed action.
        action: &'static str,
        /// The file's name.
        file: String,
        /// The cause of the failure.
        source: std::io::Error,
    },
    /// A line in the record is not a judgement.
    #[error("{file}, line {line}: not a judgement: {why}; choose another file, or remove the line")]
    Line {
        /// The file with the faulty line.
        file: String,
        /// The line number, counted from 1.
        line: usize,
        /// The problem with the line.
        why: String,
    },
}

impl JudgingError {
    fn io(action: &'static str, file: &Path) -> impl FnOnce(std::io::Error) -> JudgingError {
        let file = file.in_message().to_string();
        move |source| JudgingError::Io { action, file, source }
    }
}

/// The maximum number of pairs in a session.
pub const MOST_PAIRS: usize = 10_000;
/// The maximum number of levels to show and measure per game.
const LEVELS: usize = 5;
/// The maximum length of a comment on a pair, in characters.
const MOST_WORDS: usize = 4000;

impl Judging {
    /// Draws `pairs` pairs with a seed, and opens the record. The two games in a pair come from different
    /// sources. Pairs that are already in the record are not shown again. Also returns warnings about a
    /// damaged record.
    ///
    /// # Errors
    ///
    /// Returns an error if there are fewer than two sources, if a source has no games, or if the record cannot be
    /// read or written.
    pub fn open(
        sources: Vec<Source>,
        seed: &str,
        pairs: usize,
        record: &Path,
    ) -> Result<(Judging, Vec<String>), JudgingError> {
        if sources.len() < 2 {
            return Err(JudgingError::Games("comparing games requires two sources of games".to_owned()));
        }
        if let Some(empty) = sources.iter().find(|source| source.games.is_empty()) {
            return Err(JudgingError::Games(format!("{} contains no game with a level", empty.name)));
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
        let own = keeper.judgements.0.iter().filter(|judgement| judgement.seed == seed);
        let ended = AtomicBool::new(own.into_iter().any(|judgement| judgement.after_report));
        let (seed, keeper, plays) = (seed.to_owned(), Mutex::new(keeper), Plays::default());
        Ok((Judging { sources: names, entries, seed, pairs, keeper, plays, ended }, remarks))
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

    fn keeper(&self) -> MutexGuard<'_, Keeper> {
        self.keeper.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the indices of the pairs already judged.
    fn judged(&self) -> BTreeSet<usize> {
        let keeper = self.keeper();
        let own = keeper.judgements.0.iter().filter(|judgement| judgement.seed == self.seed);
        own.map(|judgement| judgement.pair).collect()
    }

    /// Returns the pair to judge next, without any information that reveals the sources.
    pub(crate) fn next(&self) -> Value {
        let judged = self.judged();
        let next = (0..self.pairs.len()).find(|pair| !judged.contains(pair));
        let of = self.pairs.len();
        match next {
            None => json!({ "pair": of, "of": of, "done": true, "left": null, "right": null }),
            Some(pair) => {
                let (both, levels) = self.both(self.pairs[pair]);
                let [left, right] = both.map(|candidate| shown(candidate, levels));
                json!({ "pair": pair, "of": of, "done": false, "left": left, "right": right })
            }
        }
    }

    /// Returns the two games in a pair, and the number of levels to show for each of them.
    fn both(&self, pair: [usize; 2]) -> ([&Candidate; 2], usize) {
        let both = pair.map(|at| &self.entries[at].candidate);
        // Both games show the same number of levels, because different numbers could reveal the sources.
        let levels = both.iter().map(|candidate| candidate.levels.len()).min().unwrap_or_default();
        (both, levels)
    }

    /// Returns a recording of an episode on a level, frame by frame. The episode is deterministic. Stops early and
    /// returns an error response once `gone` returns `true`.
    pub(crate) fn watch(
        &self,
        cache: &Cache,
        wanted: Wanted,
        gone: &(dyn Fn() -> bool + Sync),
    ) -> Result<Replayed, Refusal> {
        let pair = self.pair(wanted.pair)?;
        let ([left, right], levels) = self.both(pair);
        let candidate = match wanted.side {
            Hand::Left => left,
            Hand::Right => right,
        };
        let Some(level) = candidate.levels.get(wanted.level).filter(|_| wanted.level < levels) else {
            return Err(Refusal::bad("there is no such level").help("load the page again"));
        };
        // The compiled text must be the text that the page plays.
        let compiled = cache.need(&source_of(candidate))?;
        let level = compiled.level(&level.to_string())?;
        let number = u64::try_from(wanted.pair).unwrap_or_default();
        let seed = Seed::from_text(&self.seed).child("watch", number).child(&level.digest().to_string(), 0);
        let found = self.plays.find(wanted, || watch::play(&compiled, &level, seed, gone));
        let Some(play) = found.filter(|_| !gone()) else {
            return Err(Refusal::failed("the play was abandoned"));
        };
        let Play { episode, note } = &*play;
        Replayed::of(&compiled, &level, episode, true, note.map(str::to_owned))
    }

    fn pair(&self, number: usize) -> Result<[usize; 2], Refusal> {
        let found = self.pairs.get(number).copied();
        found.ok_or_else(|| Refusal::bad("there is no such pair").help("load the page again"))
    }

    /// Adds a judgement to the record.
    pub(crate) fn add(&self, asked: Asked) -> Result<(), Refusal> {
        let [left, right] = self.pair(asked.pair)?.map(|at| self.side(at));
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
            watched: asked.watched,
            after_report: self.ended.load(Ordering::Relaxed),
        };
        self.keeper().add(judgement).map_err(|error| {
            Refusal::failed(format_args!("the judgement could not be written: {error}"))
                .help("check the available disk space, and answer again")
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

    /// Returns the record's results. Until all pairs have been judged blindly, returns only the number of
    /// pairs judged.
    pub(crate) fn report(&self) -> Value {
        let (judged, of) = (self.judged().len(), self.pairs.len());
        if judged < of && !self.ended.load(Ordering::Relaxed) {
            return json!({ "blind": true, "judged": judged, "of": of });
        }
        let mut report = json!(Report::of(&self.keeper().judgements));
        report["blind"] = json!(false);
        report["of"] = json!(of);
        report
    }

    /// Shows the report from now on, and marks later judgements accordingly.
    pub(crate) fn end_blinding(&self) {
        self.ended.store(true, Ordering::Relaxed);
    }
}

impl Entry {
    fn measured(&self) -> &Measures {
        self.measures.get_or_init(|| measures::of(&self.candidate))
    }
}

/// Returns a game's text as shown to the judge. The text is reprinted, because spelling and comments could
/// reveal where the game comes from.
fn source_of(candidate: &Candidate) -> String {
    print_bare(candidate.game.description())
}

fn shown(candidate: &Candidate, levels: usize) -> Value {
    let source = source_of(candidate);
    let levels: Vec<String> = candidate.levels.iter().take(levels).map(ToString::to_string).collect();
    json!({
        "title": candidate.title,
        "describe": engine::describe(&candidate.game),
        "levels": levels,
        "source": source,
    })
}

/// A judgement as sent by the page.
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
    #[serde(default)]
    watched: Watched,
}

/// Draws pairs of games from different sources. All combinations of sources occur equally often, a source's
/// games occur about equally often, and the sides are random.
fn draw(counts: &[usize], seed: Seed, pairs: usize) -> Vec<[usize; 2]> {
    let first = |source: usize| counts[..source].iter().sum::<usize>();
    let mut draws = seed.child("pairs", 0).sampler();
    // The games of each source are in random order. The order is redrawn whenever every game has had its turn.
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
