//! The report on a set of games, covering each game and the set as a whole. It has the same form for every generator.
//!
//! The report is a pure function of the games and their verdicts, so the same input produces the same bytes. The report
//! contains no times or paths. For the meaning of each value, see `docs/reference/game-report.md`.

mod entry;
mod likeness;
mod quality;
mod variety;

pub use entry::{GameEntry, LevelEntry, Nearest};

use crate::Tally;
use crate::survey::SurveyedGame;
use base::Seed;
use engine::Game;
use entry::Measured;
use likeness::Distances;
use rayon::prelude::*;
use report::{Section, SetReport, Share, Value};
use validators::{Criteria, GameForm};

/// The version of the report's format.
pub const GAME_REPORT_FORMAT: u32 = 1;

/// The input for a report.
#[derive(Clone, Copy)]
pub struct GamesSample<'a> {
    /// The method that generated the games (`constructive`, `search`, `evolutionary`), or the games' origin.
    pub method: &'a str,
    /// The games, in the order of generation.
    pub games: &'a [SurveyedGame],
    /// The named games from which the games in the set should differ; may be empty.
    pub corpus: &'a [(String, Game)],
    /// The criteria that the panel of judges applied.
    pub criteria: &'a Criteria,
    /// The cost of generating the games, without the cost of judging them for the report; `None` if the games do not
    /// come from a generator.
    pub cost: Option<&'a Tally>,
    /// The seed for the measures.
    pub seed: Seed,
}

/// The report on a set of games. Intervals are 95% Wilson intervals for fractions, and 95% bootstrap intervals over
/// games for means.
#[derive(Clone, Debug, PartialEq)]
pub struct GameSetReport {
    /// The figures for the whole set.
    pub set: SetReport,
    /// One row per game.
    pub games: Vec<GameEntry>,
}

impl GameSetReport {
    /// Creates the report on a set, using all threads. Costs one survey row per game and one comparison per pair of
    /// games.
    pub fn of(sample: &GamesSample<'_>) -> GameSetReport {
        let GamesSample { method, games, corpus, criteria, cost, seed } = *sample;
        let measured: Vec<Measured<'_>> =
            games.par_iter().map(|game| Measured::of(game, criteria, seed)).collect();
        let forms: Vec<GameForm> = corpus.par_iter().map(|(_, game)| GameForm::of(game)).collect();
        let names: Vec<&str> = corpus.iter().map(|(name, _)| name.as_str()).collect();
        let distances = Distances::of(&measured, &names, &forms);
        let made = games.len() as u64;
        let accepted = cost.map(|cost| Share::new(made, cost.games_tried.max(made)));
        let (difficulty, places) = quality::difficulty(&measured).unzip();
        let set = SetReport::default()
            .data("format", &GAME_REPORT_FORMAT)
            .data("semantics", &engine::SEMANTICS)
            .data("generation", &generators::GENERATION)
            .data("method", method)
            .data("count", &games.len())
            .data("accepted", &accepted)
            .section("validity", quality::validity(games))
            .section("skill", quality::skill(&measured))
            .section("rules", quality::rules(&measured))
            .section("play", quality::play(&measured))
            .section("difficulty", difficulty)
            .section("variety", variety::variety(&measured))
            .section("novelty", likeness::novelty(&measured, &distances, &forms))
            .section("cost", cost.zip(accepted).map(|(cost, accepted)| price(cost, made, accepted)))
            .table(variety::kinds(&measured))
            .table(places)
            .table(cost.filter(|cost| !cost.judges.is_empty()).map(|cost| cost.judges_table(made)));
        let near = distances.each.into_iter();
        let games: Vec<GameEntry> =
            measured.iter().zip(near).map(|(measured, near)| GameEntry::of(measured, near)).collect();
        let set = set.data("games", &games).table(entry::table(&games)).headlines(&[
            ("validity", "games", "meet every criterion"),
            ("skill", "pays", "skill pays"),
            ("rules", "all_used", "every rule used"),
            ("variety", "kinds", "kinds of avatar × goal"),
            ("play", "mechanics", "mechanics in winning play, median"),
            ("novelty", "unique", "distinct games"),
            ("cost", "accepted", "accepted out of all judged"),
        ]);
        GameSetReport { set, games }
    }
}

fn price(cost: &Tally, made: u64, accepted: Share) -> Section {
    let each = cost.calls.checked_div(made).map_or(Value::Missing, Value::Count);
    Section::new("cost", "What was the cost?", "The cost of judging for this report is not included.")
        .data("accepted", &made)
        .data("tried", &cost.games_tried)
        .figure("accepted", "accepted out of all judged", accepted.into())
        .count("calls", "forward-model calls", cost.calls)
        .shown("calls per accepted item", each)
        .tally("rejections", "rejected", &cost.rejections, None)
}

#[cfg(test)]
mod tests;
