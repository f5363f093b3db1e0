//! Studies. A study combines the results of several players, and provides each of a report's tables as plain
//! data.
//!
//! ```
//! use infinite_arcade_evaluation::study::{Player, Study};
//!
//! // Players with the metrics of their episodes; here there are no episodes yet.
//! let study = Study::new(vec![(Player::reference("random"), Vec::new())], Vec::new());
//! assert_eq!(study.leaderboard.len(), 1);
//! for table in study.tables() {
//!     assert!(table.to_markdown().starts_with("## "));
//! }
//! ```

mod comparisons;
mod episodes;
mod games;
pub(crate) mod players;
mod read;

pub use comparisons::contrast::{Comparison, Contrasts, OverallComparison, WithinLevels};
pub use comparisons::correlations::{CORRELATED, Correlation, Correlations, Test};
pub use comparisons::matrix::{Matrix, MatrixColumn, MatrixRow, Measure, Scope};
pub use comparisons::power::{PowerRow, power, table as power_table};
pub use episodes::endings::{EndingRow, EndingSummary};
pub use episodes::failures::{FailureMeasure, FailureMode, OscillationRow, WelchTest};
pub use episodes::predictions::PredictionRow;
pub use episodes::scores::{Estimate, Scores, StudyEpisode};
pub use games::ceilings::{CeilingRow, LeftOut};
pub use games::difficulty::{DifficultyLabel, DifficultyRow};
pub use games::marks::MarkRow;
pub use games::taxonomy::TaxonomyRow;
pub use players::horizon::Horizon;
pub use players::horizon::commitment::{CommitmentRate, Foresight, HorizonRow};
pub use players::horizon::thinking::{BudgetRate, ThinkingRow};
pub use players::leaderboard::LeaderRow;
pub use players::player::{CONTEXTUAL, Player, ZERO_SHOT};
pub use players::sweep::{Sweep, SweepRow};
pub use players::times::TimeRow;
pub(crate) use read::persons;

use crate::metrics::EpisodeMetrics;
use crate::subject::{LevelCeiling, LevelMark, Subject};
use itertools::Itertools;
use report::Table;
use serde::Serialize;
use std::collections::BTreeMap;

const LEVEL: f64 = 0.95;
/// The maximum number of rows in a report's comparison tables. The study's data contain all rows.
const MAX_COMPARISONS: usize = 100;

/// The analysed results of several players. Indices named `player` and `game` refer to the lists `players`
/// and `games`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Study {
    /// The study's players, in the order in which their results were given.
    pub players: Vec<Player>,
    /// The study's games.
    pub games: Vec<StudyGame>,
    /// All episodes, including aborted episodes, sorted by player, game, level and run.
    pub episodes: Vec<StudyEpisode>,
    /// Notes on limitations of the comparisons, such as different step limits or missing episodes.
    pub notes: Vec<String>,
    /// The leaderboard, best player first.
    pub leaderboard: Vec<LeaderRow>,
    /// The heat maps by game, one per [`Scope`] with models. Without models, there is only one heat map, for
    /// both modes.
    pub by_game: Vec<Matrix>,
    /// The heat maps by level, one per [`Scope`] with models.
    pub by_level: Vec<Matrix>,
    /// The comparisons of models with each other and with other players.
    pub pairs: Contrasts,
    /// The comparisons between each model's zero-shot mode and its contextual mode.
    pub modes: Contrasts,
    /// The comparisons between each model without an aid (an optional part of the prompt) and the same model with the
    /// aid.
    pub aids: Contrasts,
    /// The correlations between winning and other variables.
    pub correlations: Correlations,
    /// The failure modes: comparisons of the movement in won episodes with the movement in all other
    /// episodes.
    pub failures: Vec<FailureMode>,
    /// The levels on which players move back and forth, highest oscillation rate first.
    pub oscillations: Vec<OscillationRow>,
    /// Each player's results by game.
    pub sweeps: Vec<Sweep>,
    /// The difficulty of games and levels.
    pub difficulties: Vec<DifficultyRow>,
    /// The durations of decisions.
    pub times: Vec<TimeRow>,
    /// The episodes without a win, by player, game and cause.
    pub endings: Vec<EndingRow>,
    /// The episodes without a win, summarised by player.
    pub ending_summaries: Vec<EndingSummary>,
    /// The results by kind of game, as stated by the release. The list is empty if no kinds are recorded.
    pub kinds: Vec<TaxonomyRow>,
    /// The results by kind of game, as derived from the rules.
    pub taxonomy: Vec<TaxonomyRow>,
    /// The horizons of players with results for several numbers of actions per decision, by kind of game. A horizon is
    /// the number of actions at which a player still wins half of its episodes.
    pub horizons: Vec<HorizonRow>,
    /// The thinking horizons of players with results for several budgets (maximum numbers of output tokens per answer), by
    /// tier (difficulty class).
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub thinking: Vec<ThinkingRow>,
    /// The reference results on the levels, with the players' results on the same levels. The list is empty
    /// if the releases contain no reference results.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<MarkRow>,
    /// The players' win rates relative to the ceilings (highest known win rates) of the levels. The list is empty if the
    /// releases contain no ceilings.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ceilings: Vec<CeilingRow>,
    /// The levels whose episodes are excluded from all numbers, because no player is known to win them often enough.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
    /// The players' predictions of the rules after series of levels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub predictions: Vec<PredictionRow>,
    /// The statistical power of the episodes.
    pub power: Vec<PowerRow>,
}

/// A game in a study.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StudyGame {
    /// The game's folder name.
    pub id: String,
    /// The game's title in its own theme.
    pub title: String,
    /// The kind of game stated by the release. The text is empty if the kind is not recorded.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub kind: String,
    /// The kind of game according to its rules, as one sentence per aspect of the taxonomy.
    pub taxonomy: Vec<String>,
    /// `true` for a stochastic game, or `None` if unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub is_stochastic: Option<bool>,
    /// The game's levels.
    pub levels: Vec<StudyLevel>,
    /// The release's reference results for the levels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub marks: Vec<LevelMark>,
    /// The release's ceilings (highest known win rates) for the levels.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub ceilings: Vec<LevelCeiling>,
}

/// A level of a game in a study.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StudyLevel {
    /// The level number.
    pub number: usize,
    /// The length of the shortest win in ticks, if it was proved to be optimal.
    pub optimal_ticks: Option<usize>,
}

impl From<&Subject> for StudyGame {
    fn from(subject: &Subject) -> StudyGame {
        let levels = subject.levels.iter();
        StudyGame {
            id: subject.id.clone(),
            title: subject.facts.title.clone(),
            kind: subject.facts.kind.clone(),
            taxonomy: subject.facts.taxonomy.clone(),
            is_stochastic: Some(subject.analysis.is_stochastic()),
            levels: levels
                .map(|level| StudyLevel { number: level.number, optimal_ticks: level.optimal_ticks })
                .collect(),
            marks: subject.facts.marks.clone(),
            ceilings: subject.facts.ceilings.clone(),
        }
    }
}

impl Study {
    /// Builds a study from the episodes of players. A game or level that occurs in an episode but is missing
    /// from `games` is added with only its ID or number. Cost: O(episodes log episodes), plus one Fisher test
    /// per pair of players and level.
    pub fn new(results: Vec<(Player, Vec<EpisodeMetrics>)>, games: Vec<StudyGame>) -> Study {
        let mut study = Study { games, ..Study::default() };
        let mut practice = 0;
        for (player, episodes) in results {
            let known = study.players.iter().position(|known| *known == player);
            let player = known.unwrap_or_else(|| {
                study.players.push(player);
                study.players.len() - 1
            });
            let (practised, counted): (Vec<_>, Vec<_>) =
                episodes.into_iter().partition(EpisodeMetrics::is_practice);
            practice += practised.len();
            let (counted, left_out) = games::ceilings::sorted(&study.games, player, counted);
            study.left_out.extend(left_out);
            counted.into_iter().for_each(|metrics| study.add(player, metrics));
        }
        if practice > 0 {
            study.notes.push(format!(
                "{practice} episodes on the first level of a series are for practice, and are excluded from all numbers."
            ));
        }
        study.notes.extend(games::ceilings::notes(&study));
        study.episodes.sort_by_key(|episode| (place(episode), episode.metrics.run));
        episodes::scores::normalise(&mut study.episodes);
        study.note();
        let players = 0..study.players.len();
        study.leaderboard = players::leaderboard::leaderboard(&study);
        for scope in study.scopes() {
            study.by_game.push(Matrix::of(&study, scope, false));
            study.by_level.push(Matrix::of(&study, scope, true));
        }
        study.pairs = Contrasts::pairs(&study);
        study.modes = Contrasts::modes(&study);
        study.aids = Contrasts::aids(&study);
        study.correlations = Correlations::of(&study);
        study.failures = episodes::failures::failures(&study);
        study.oscillations = episodes::failures::oscillations(&study);
        study.sweeps = players.clone().map(|player| Sweep::of(&study, player)).collect();
        study.difficulties = games::difficulty::difficulties(&study);
        study.times = players.map(|player| TimeRow::of(&study, player)).collect();
        study.endings = episodes::endings::endings(&study);
        study.ending_summaries = episodes::endings::summaries(&study);
        study.kinds = games::taxonomy::kinds(&study);
        study.taxonomy = games::taxonomy::taxonomy(&study);
        study.horizons = players::horizon::commitment::horizons(&study);
        study.thinking = players::horizon::thinking::rows(&study);
        study.marks = games::marks::rows(&study);
        study.ceilings = games::ceilings::rows(&study);
        study.predictions = episodes::predictions::rows(&study);
        study.power = comparisons::power::of_study(&study);
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

    fn note(&mut self) {
        let limits = self.episodes.iter().map(|episode| episode.metrics.max_steps);
        let limits = limits.sorted_unstable().dedup().collect_vec();
        if limits.len() > 1 {
            self.notes.push(format!(
                "Players had different step limits ({}): steps, wins and derived values are not comparable.",
                limits.iter().join(", ")
            ));
        }
        let tracks = self.players.iter().filter(|player| player.track().is_some() || !player.is_reference());
        let tracks = tracks.map(Player::track).dedup().unique().collect_vec();
        if let [first, _, ..] = tracks[..] {
            let first = first.map_or("no track".to_owned(), |track| format!("the track {track}"));
            self.notes.push(format!(
                "Players are on different tracks, whose results are not comparable: players are compared \
                 only within a track, and difficulty, correlations and failure modes are for {first}."
            ));
        }
        let mut stops: BTreeMap<(usize, String), u64> = BTreeMap::new();
        for episode in &self.episodes {
            let ending = episode.metrics.ending.as_ref().filter(|_| episode.metrics.counts());
            if let Some(limit) = ending.and_then(|ending| ending.stop) {
                *stops.entry((episode.game, limit.to_string())).or_default() += 1;
            }
        }
        for ((game, limit), episodes) in stops {
            let were = if episodes == 1 { "episode was" } else { "episodes were" };
            self.notes.push(format!(
                "{episodes} {were} stopped by the engine in {} ({limit}). Such episodes count as not won, but say nothing about the players. \
                 Repair the game; `arcade validate` shows the reason.",
                self.title(game)
            ));
        }
        let broken = self.episodes.iter().filter(|episode| !episode.metrics.counts()).count();
        if broken > 0 {
            self.notes.push(format!(
                "{broken} of {} episodes were aborted or are unfinished, and are excluded from all \
                 numbers except the bounds.",
                self.episodes.len()
            ));
        }
    }

    /// Returns the players that are included in figures over several players: the players with the same track (bundle
    /// of prompt settings) as the first player, and the baselines that read no prompts.
    pub(crate) fn on_first_track(&self) -> impl Iterator<Item = usize> + '_ {
        let first = self.players.iter().find(|player| player.track().is_some() || !player.is_reference());
        let first = first.or(self.players.first());
        let is_on = move |player: &Player| first.is_none_or(|first| first.is_comparable(player));
        (0..self.players.len()).filter(move |&player| is_on(&self.players[player]))
    }

    /// Returns the scopes with models, or the pooled scope if there are no models.
    fn scopes(&self) -> Vec<Scope> {
        let has = |mode: &str| self.players.iter().any(|player| player.mode.as_deref() == Some(mode));
        let scopes = Scope::ALL.into_iter().filter(|scope| match scope {
            Scope::ZeroShot => has(ZERO_SHOT),
            Scope::Contextual => has(CONTEXTUAL),
            Scope::Both => has(ZERO_SHOT) == has(CONTEXTUAL),
        });
        scopes.collect()
    }

    /// Returns a player's episodes, optionally restricted to a game or a level. Cost: O(log episodes).
    pub fn on(&self, player: usize, game: Option<usize>, level: Option<usize>) -> &[StudyEpisode] {
        let first = (player, game.unwrap_or(0), level.unwrap_or(0));
        let last = (player, game.unwrap_or(usize::MAX), level.unwrap_or(usize::MAX));
        let from = self.episodes.partition_point(|episode| place(episode) < first);
        let to = self.episodes.partition_point(|episode| place(episode) <= last);
        &self.episodes[from..to]
    }

    /// Returns the ended episodes of models, or of all players if there is no model.
    pub fn tested(&self) -> impl Iterator<Item = &StudyEpisode> + '_ {
        let models = self.players.iter().any(|player| !player.is_reference());
        let on_track: Vec<usize> = self.on_first_track().collect();
        let is_tested = move |player: usize| {
            on_track.contains(&player) && (!models || !self.players[player].is_reference())
        };
        self.episodes.iter().filter(move |episode| is_tested(episode.player) && episode.metrics.counts())
    }

    /// Returns the name of a game or a level, such as `aliens` or `aliens-0`.
    pub fn place(&self, game: usize, level: Option<usize>) -> String {
        let id = &self.games[game].id;
        level.map_or_else(|| id.clone(), |level| format!("{id}-{level}"))
    }

    /// Returns a game's title, or its ID if it has no title.
    pub fn title(&self, game: usize) -> &str {
        let StudyGame { id, title, .. } = &self.games[game];
        if title.is_empty() { id } else { title }
    }

    /// Returns all tables of a report, in the report's order.
    pub fn tables(&self) -> Vec<Table> {
        let mut tables = players::leaderboard::tables(self);
        tables.extend(players::horizon::commitment::table(self));
        tables.extend(players::horizon::thinking::table(self));
        tables.extend(games::ceilings::table(self));
        tables.extend(games::marks::table(self));
        tables.extend(episodes::predictions::table(self));
        tables.extend(episodes::endings::tables(self));
        for (matrices, grain) in [(&self.by_game, "game"), (&self.by_level, "level")] {
            for measure in Measure::ALL {
                tables.extend(matrices.iter().map(|matrix| matrix.table(measure, grain)));
            }
        }
        tables.extend(self.pairs.tables(self, "pairs", "Comparison of players", MAX_COMPARISONS));
        tables.extend(self.modes.tables(self, "modes", "Zero-shot against contextual", MAX_COMPARISONS));
        tables.extend(self.aids.tables(self, "aids", "Without and with an aid", MAX_COMPARISONS));
        tables.push(self.correlations.table());
        tables.extend(episodes::failures::tables(self));
        tables.extend(players::sweep::tables(self));
        tables.push(games::difficulty::table(self));
        tables.push(players::times::table(self));
        tables.extend(games::taxonomy::tables(self));
        tables.push(comparisons::power::table(&self.power));
        tables
    }
}

/// Returns an episode's player, game and level, which form the sort key.
fn place(episode: &StudyEpisode) -> (usize, usize, usize) {
    (episode.player, episode.game, episode.metrics.level)
}
