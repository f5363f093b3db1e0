//! The difficulty of games and levels for a study's players (`spec/06` §2.6).

use crate::study::Study;
use crate::study::episodes::scores::{Scores, mean};
use report::{Table, TableCell};
use serde::Serialize;

base::named_enum! {
    /// A difficulty class for a level or a game, based on its score.
    pub enum DifficultyLabel {
        /// The score is at least 0.8.
        VeryEasy = "very_easy",
        /// The score is at least 0.6 and below 0.8.
        Easy = "easy",
        /// The score is at least 0.4 and below 0.6.
        Medium = "medium",
        /// The score is at least 0.2 and below 0.4.
        Hard = "hard",
        /// The score is below 0.2.
        VeryHard = "very_hard",
        /// There are no wins, regardless of the score.
        Unbeaten = "unbeaten",
    }
}

impl DifficultyLabel {
    /// Returns the class for the score of a level or game with at least one win.
    fn of(ease: f64) -> DifficultyLabel {
        match ease {
            ease if ease >= 0.8 => DifficultyLabel::VeryEasy,
            ease if ease >= 0.6 => DifficultyLabel::Easy,
            ease if ease >= 0.4 => DifficultyLabel::Medium,
            ease if ease >= 0.2 => DifficultyLabel::Hard,
            _ => DifficultyLabel::VeryHard,
        }
    }
}

/// The difficulty of a level, or of a game over all its levels.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DifficultyRow {
    /// The game's index in the study.
    pub game: usize,
    /// The level number, or `None` for the entire game.
    pub level: Option<usize>,
    /// The players' mean win rate.
    pub win_rate: Option<f64>,
    /// The players' mean normalised reward.
    pub normalised_reward: Option<f64>,
    /// The mean step efficiency of the players with wins.
    pub efficiency: Option<f64>,
    /// The score `0.6 win rate + 0.2 normalised reward + 0.2 efficiency`. A higher score means an easier
    /// level. `None` if a component is missing.
    pub ease: Option<f64>,
    /// The class of the score. `None` if there is a win but no score.
    pub label: Option<DifficultyLabel>,
}

impl DifficultyRow {
    fn of(study: &Study, game: usize, level: Option<usize>) -> DifficultyRow {
        let player = |player: usize| {
            Some(Scores::of(study.on(player, Some(game), level))).filter(|scores| scores.episodes > 0)
        };
        let players: Vec<Scores> = study.on_first_track().filter_map(player).collect();
        let mean_of = |of: fn(&Scores) -> Option<f64>| mean(players.iter().filter_map(of));
        let win_rate = mean_of(|scores| scores.win_rate.map(|rate| rate.value));
        let normalised_reward = mean_of(|scores| scores.normalised_reward);
        let efficiency = mean_of(|scores| scores.efficiency);
        let ease = match (win_rate, normalised_reward, efficiency) {
            (Some(win), Some(reward), Some(efficiency)) => Some(0.6 * win + 0.2 * reward + 0.2 * efficiency),
            _ => None,
        };
        let unbeaten = win_rate == Some(0.0);
        let label = if unbeaten { Some(DifficultyLabel::Unbeaten) } else { ease.map(DifficultyLabel::of) };
        DifficultyRow { game, level, win_rate, normalised_reward, efficiency, ease, label }
    }
}

/// Returns all games' rows. Each game is followed by its levels.
pub(crate) fn difficulties(study: &Study) -> Vec<DifficultyRow> {
    let of_game = |(game, facts): (usize, &crate::study::StudyGame)| {
        let levels = facts.levels.iter().map(|level| Some(level.number));
        let rows = [None].into_iter().chain(levels).map(|level| DifficultyRow::of(study, game, level));
        rows.collect::<Vec<_>>()
    };
    study.games.iter().enumerate().flat_map(of_game).collect()
}

pub(crate) fn table(study: &Study) -> Table {
    Table::of(
        "difficulty",
        "Difficulty",
        "Ease: 0.6 win rate + 0.2 normalised reward + 0.2 step efficiency, each a mean over the players of \
         this study. A high value means easy. Ease is missing if a component is missing, such as the reward of a game \
         in which all scores are equal. Unbeaten: no player has won.",
        &study.difficulties,
        &[
            ("game or level", &|row| TableCell::text(study.place(row.game, row.level))),
            ("win rate", &|row| TableCell::number(row.win_rate, 2)),
            ("normalised reward", &|row| TableCell::number(row.normalised_reward, 3)),
            ("efficiency", &|row| TableCell::number(row.efficiency, 3)),
            ("ease", &|row| TableCell::number(row.ease, 3)),
            ("difficulty", &|row| {
                row.label.map_or(TableCell::Missing, |label| TableCell::text(label.name().replace('_', " ")))
            }),
        ],
    )
}
