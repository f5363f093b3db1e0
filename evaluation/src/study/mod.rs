//! A study: the results of several players read together, and every table of a report as plain data.
//!
//! ```
//! use evaluation::study::{Player, Study};
//!
//! // Players with what was measured of their episodes; here nobody has played yet.
//! let study = Study::new(vec![(Player::reference("random"), Vec::new())], Vec::new());
//! assert_eq!(study.leaderboard.len(), 1);
//! for table in study.tables() {
//!     assert!(table.to_markdown().starts_with("## "));
//! }
//! ```

mod contrast;
mod correlations;
mod difficulty;
mod failures;
mod leaderboard;
mod matrix;
mod player;
mod power;
mod read;
mod scores;
mod sweep;
mod table;
mod taxonomy;
mod times;

pub use contrast::{Comparison, Contrasts, OverallComparison};
pub use correlations::{CORRELATED, Correlation, Correlations, Test};
pub use difficulty::{DifficultyLabel, DifficultyRow};
pub use failures::{FailureMeasure, FailureMode, OscillationRow, WelchTest};
pub use leaderboard::LeaderRow;
pub use matrix::{Matrix, MatrixColumn, MatrixRow, Measure, Scope};
pub use player::{CONTEXTUAL, Player, ZERO_SHOT};
pub use power::{PowerRow, power, table as power_table};
pub use read::PlayedLogs;
pub use scores::{Estimate, Scores, StudyEpisode};
pub use sweep::{Sweep, SweepRow};
pub use table::{Table, TableCell, in_markdown};
pub use taxonomy::TaxonomyRow;
pub use times::TimeRow;

use crate::metrics::EpisodeMetrics;
use crate::subject::Subject;
use engine::Seed;
use serde::Serialize;

/// The level of all intervals.
const LEVEL: f64 = 0.95;
/// Resamples of an interval that draws whole games again.
const RESAMPLES: usize = 2000;
/// Rows of a table of comparisons in a report; the data has all.
const MOST_COMPARISONS: usize = 100;

/// The results of several players, and what follows from them. Indices named `player` and `game` lead into the first two lists.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Study {
    /// Who played, in the order in which their results were given.
    pub players: Vec<Player>,
    /// What was played.
    pub games: Vec<StudyGame>,
    /// All episodes, those that were broken off too: by player, game, level and run.
    pub episodes: Vec<StudyEpisode>,
    /// What a reader has to know before comparing: different step limits, episodes that are missing.
    pub notes: Vec<String>,
    /// Who wins how often; the best first.
    pub leaderboard: Vec<LeaderRow>,
    /// Heat maps by game, one for each [`Scope`] in which there are models (for both, if there are none).
    pub by_game: Vec<Matrix>,
    /// The same by level.
    pub by_level: Vec<Matrix>,
    /// Models with each other, and with players that are no models.
    pub pairs: Contrasts,
    /// The same model zero-shot and contextual.
    pub modes: Contrasts,
    /// The same model without and with an aid.
    pub aids: Contrasts,
    /// What goes with winning.
    pub correlations: Correlations,
    /// How won and lost episodes were walked.
    pub failures: Vec<FailureMode>,
    /// Where players go back and forth, the most first.
    pub oscillations: Vec<OscillationRow>,
    /// Every player game by game.
    pub sweeps: Vec<Sweep>,
    /// How hard games and levels are.
    pub difficulties: Vec<DifficultyRow>,
    /// How long decisions take.
    pub times: Vec<TimeRow>,
    /// Results by kind of game.
    pub taxonomy: Vec<TaxonomyRow>,
    /// What so many episodes can show.
    pub power: Vec<PowerRow>,
}

/// A game of a study.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StudyGame {
    /// The name of its folder.
    pub id: String,
    /// Its title in its own fiction.
    pub title: String,
    /// What kind of game it is, a sentence for each side.
    pub taxonomy: Vec<String>,
    /// Its levels.
    pub levels: Vec<StudyLevel>,
}

/// A level of a game of a study.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StudyLevel {
    /// Its number.
    pub number: usize,
    /// Ticks of its shortest win, where it is proved.
    pub optimal_ticks: Option<usize>,
}

impl From<&Subject> for StudyGame {
    fn from(subject: &Subject) -> StudyGame {
        let levels = subject.levels.iter();
        StudyGame {
            id: subject.id.clone(),
            title: subject.facts.title.clone(),
            taxonomy: subject.facts.taxonomy.clone(),
            levels: levels
                .map(|level| StudyLevel { number: level.number, optimal_ticks: level.optimal_ticks })
                .collect(),
        }
    }
}

impl Study {
    /// The study of these players' episodes. A game of an episode that is not among `games` is added, by its id alone; so are
    /// levels. Cost: O(episodes log episodes), a Fisher test for each pair of
    /// players and level, and 2000 resamples for each pair.
    pub fn new(results: Vec<(Player, Vec<EpisodeMetrics>)>, games: Vec<StudyGame>) -> Study {
        let mut study = Study {
            players: Vec::new(),
            games,
            episodes: Vec::new(),
            notes: Vec::new(),
            leaderboard: Vec::new(),
            by_game: Vec::new(),
            by_level: Vec::new(),
            pairs: Contrasts::default(),
            modes: Contrasts::default(),
            aids: Contrasts::default(),
            correlations: Correlations { episodes: 0, excluded: 0, pairs: Vec::new() },
            failures: Vec::new(),
            oscillations: Vec::new(),
            sweeps: Vec::new(),
            difficulties: Vec::new(),
            times: Vec::new(),
            taxonomy: Vec::new(),
            power: Vec::new(),
        };
        for (player, episodes) in results {
            let known = study.players.iter().position(|known| *known == player);
            let player = known.unwrap_or_else(|| {
                study.players.push(player);
                study.players.len() - 1
            });
            episodes.into_iter().for_each(|metrics| study.add(player, metrics));
        }
        study.episodes.sort_by_key(|episode| (place(episode), episode.metrics.run));
        scores::normalise(&mut study.episodes);
        study.note();
        let players = 0..study.players.len();
        study.leaderboard = leaderboard::leaderboard(&study);
        for scope in study.scopes() {
            study.by_game.push(Matrix::of(&study, scope, false));
            study.by_level.push(Matrix::of(&study, scope, true));
        }
        study.pairs = Contrasts::pairs(&study);
        study.modes = Contrasts::modes(&study);
        study.aids = Contrasts::aids(&study);
        study.correlations = Correlations::of(&study);
        study.failures = failures::failures(&study);
        study.oscillations = failures::oscillations(&study);
        study.sweeps = players.clone().map(|player| Sweep::of(&study, player)).collect();
        study.difficulties = difficulty::difficulties(&study);
        study.times = players.map(|player| TimeRow::of(&study, player)).collect();
        study.taxonomy = taxonomy::taxonomy(&study);
        study.power = power::of_study(&study);
        study
    }

    fn add(&mut self, player: usize, metrics: EpisodeMetrics) {
        let game = self.games.iter().position(|game| game.id == metrics.game).unwrap_or_else(|| {
            self.games.push(StudyGame { id: metrics.game.clone(), ..StudyGame::default() });
            self.games.len() - 1
        });
        let levels = &mut self.games[game].levels;
        if levels.iter().all(|level| level.number != metrics.level) {
            levels.push(StudyLevel { number: metrics.level, optimal_ticks: metrics.optimal_ticks });
            levels.sort_by_key(|level| level.number);
        }
        self.episodes.push(StudyEpisode { player, game, normalised_reward: None, most_steps: 0, metrics });
    }

    /// Notes what a reader has to know.
    fn note(&mut self) {
        let mut limits: Vec<u64> = self.episodes.iter().map(|episode| episode.metrics.max_steps).collect();
        limits.sort_unstable();
        limits.dedup();
        if limits.len() > 1 {
            let limits: Vec<String> = limits.iter().map(u64::to_string).collect();
            self.notes.push(format!(
                "Players had different limits of steps ({}): steps, wins and what follows from them do not compare.",
                limits.join(", ")
            ));
        }
        let broken = self.episodes.iter().filter(|episode| !episode.metrics.counts()).count();
        if broken > 0 {
            self.notes.push(format!(
                "{broken} of {} episodes were broken off or are not finished; they count in no number.",
                self.episodes.len()
            ));
        }
    }

    /// The scopes in which there are models; all together, if there are none.
    fn scopes(&self) -> Vec<Scope> {
        let has = |mode: &str| self.players.iter().any(|player| player.mode.as_deref() == Some(mode));
        let scopes = Scope::ALL.into_iter().filter(|scope| match scope {
            Scope::ZeroShot => has(ZERO_SHOT),
            Scope::Contextual => has(CONTEXTUAL),
            Scope::Both => has(ZERO_SHOT) == has(CONTEXTUAL),
        });
        scopes.collect()
    }

    /// The episodes of a player; on a game, if one is given, and on one of its levels. Cost: O(log episodes).
    pub fn on(&self, player: usize, game: Option<usize>, level: Option<usize>) -> &[StudyEpisode] {
        let first = (player, game.unwrap_or(0), level.unwrap_or(0));
        let last = (player, game.unwrap_or(usize::MAX), level.unwrap_or(usize::MAX));
        let from = self.episodes.partition_point(|episode| place(episode) < first);
        let to = self.episodes.partition_point(|episode| place(episode) <= last);
        &self.episodes[from..to]
    }

    /// The ended episodes of models; of all players, if there is no model.
    pub fn tested(&self) -> impl Iterator<Item = &StudyEpisode> + '_ {
        let models = self.players.iter().any(|player| !player.is_reference());
        let is_tested = move |player: usize| !models || !self.players[player].is_reference();
        self.episodes.iter().filter(move |episode| is_tested(episode.player) && episode.metrics.counts())
    }

    /// What a game or a level is called: `aliens`, `aliens-0`.
    pub fn place(&self, game: usize, level: Option<usize>) -> String {
        let id = &self.games[game].id;
        level.map_or_else(|| id.clone(), |level| format!("{id}-{level}"))
    }

    /// All tables of a report, in its order.
    pub fn tables(&self) -> Vec<Table> {
        let mut tables = leaderboard::tables(self);
        for (matrices, grain) in [(&self.by_game, "game"), (&self.by_level, "level")] {
            for measure in Measure::ALL {
                tables.extend(matrices.iter().map(|matrix| matrix.table(measure, grain)));
            }
        }
        tables.extend(self.pairs.tables(self, "pairs", "Players compared", MOST_COMPARISONS));
        tables.extend(self.modes.tables(self, "modes", "Zero-shot against contextual", MOST_COMPARISONS));
        tables.extend(self.aids.tables(self, "aids", "Without and with an aid", MOST_COMPARISONS));
        tables.push(self.correlations.table());
        tables.extend(failures::tables(self));
        tables.extend(sweep::tables(self));
        tables.push(difficulty::table(self));
        tables.push(times::table(self));
        tables.push(taxonomy::table(self));
        tables.push(power::table(&self.power));
        tables
    }
}

/// Player, game and level: the order of episodes.
fn place(episode: &StudyEpisode) -> (usize, usize, usize) {
    (episode.player, episode.game, episode.metrics.level)
}

/// The draws for an interval: the same for the same study.
fn seed(purpose: &str, index: usize) -> [u8; 32] {
    *Seed::from_text("intervals of a study").child(purpose, index as u64).as_bytes()
}
