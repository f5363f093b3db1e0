//! The one report of every generator of games: what the games of a set are like, each and together.
//!
//! A pure function of what was judged: the same games and verdicts give the same bytes. No clock and no path is in it. What each
//! figure means is in `docs/game-report.md`.

mod difficulty;
mod entry;
mod figures;
mod likeness;
mod quality;
mod variety;

pub use difficulty::Difficulties;
pub use entry::{GameEntry, LevelEntry, Nearest};
pub use figures::Mean;
pub use likeness::{Distances, Novelty};
pub use quality::{Play, Rules, Skill, Validity};
pub use variety::{Counted, Kind, Variety};

use super::survey::{GameRow, SurveyedGame};
use engine::{Analysis, Digest, Game, Level, Seed};
use entry::Judged;
use rayon::prelude::*;
use report::Share;
use report::canonical::{CanonicalError, to_canonical_json};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::{Criteria, GameForm, GameKind, GameReport};

/// The version of the report's form.
pub const GAME_REPORT_FORMAT: u32 = 1;

/// A game and all that its judges found.
#[derive(Clone, Debug)]
pub struct ReportedGame {
    /// Title in the game's own fiction.
    pub title: String,
    /// How to win, for people: a line.
    pub goal: String,
    /// The game.
    pub game: Game,
    /// Its levels, in their order.
    pub levels: Vec<Level>,
    /// What the panel found of each level, and of all together.
    pub report: GameReport,
}

/// What making the games cost. Time is no part of it: it differs from run to run. Nor is judging them for the report.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GamesCost {
    /// Forward-model calls of all that looked and judged, on what was turned down too.
    pub calls: u64,
    /// Candidates that were judged.
    pub tried: u64,
    /// Games that were accepted.
    pub accepted: u64,
    /// How often each criterion, or the generator, said no first.
    pub rejections: BTreeMap<String, u64>,
}

/// What a report is made from.
#[derive(Clone, Copy)]
pub struct GamesSample<'a> {
    /// Who made the games: `constructive`, `search`, `evolutionary`; or where they are from.
    pub method: &'a str,
    /// The games, in the order of their making.
    pub games: &'a [ReportedGame],
    /// The games that they are to differ from, by name; may be empty.
    pub corpus: &'a [(String, Game)],
    /// The criteria that the panel asked.
    pub criteria: &'a Criteria,
    /// What it cost; nothing is told of games that were not made.
    pub cost: Option<&'a GamesCost>,
    /// Where the dice of the measures come from.
    pub seed: Seed,
}

/// What the games of a set are like. Intervals of shares are Wilson's, those of means are bootstrapped over games; both 95 %.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GameSetReport {
    /// [`GAME_REPORT_FORMAT`].
    pub format: u32,
    /// [`engine::SEMANTICS`].
    pub semantics: u32,
    /// [`generators::GENERATION`].
    pub generation: u32,
    /// Who made the games.
    pub method: String,
    /// How many games.
    pub count: u64,
    /// Do they meet the criteria?
    pub validity: Validity,
    /// What did they cost? None for games that were not made.
    pub cost: Option<GamesCost>,
    /// Accepted games of the candidates that were judged.
    pub accepted: Option<Share>,
    /// Does skill pay? None if no ladder played.
    pub skill: Option<Skill>,
    /// Is every rule and sprite used?
    pub rules: Rules,
    /// What happens while they are won?
    pub play: Play,
    /// How many kinds of games are they?
    pub variety: Variety,
    /// How far apart are they, and from the corpus?
    pub novelty: Novelty,
    /// How hard are their levels? None if no ladder played.
    pub difficulty: Option<Difficulties>,
    /// A row for each game.
    pub games: Vec<GameEntry>,
}

impl GameSetReport {
    /// The report on a set. Cost: that of [`GameRow::of`] for each game and a comparison for each pair of games, on all threads.
    pub fn of(sample: &GamesSample<'_>) -> GameSetReport {
        let GamesSample { method, games, corpus, criteria, cost, seed } = *sample;
        let judged: Vec<Judged<'_>> = games.par_iter().map(|game| Judged::of(game, criteria, seed)).collect();
        let forms: Vec<GameForm> = corpus.par_iter().map(|(_, game)| GameForm::of(game)).collect();
        let names: Vec<&str> = corpus.iter().map(|(name, _)| name.as_str()).collect();
        let distances = Distances::of(&judged, &names, &forms);
        GameSetReport {
            format: GAME_REPORT_FORMAT,
            semantics: engine::SEMANTICS,
            generation: generators::GENERATION,
            method: method.to_owned(),
            count: games.len() as u64,
            validity: Validity::of(games),
            cost: cost.cloned(),
            accepted: cost.map(|cost| Share::new(cost.accepted, cost.tried.max(cost.accepted))),
            skill: Skill::of(&judged),
            rules: Rules::of(&judged),
            play: Play::of(&judged),
            variety: Variety::of(&judged),
            novelty: Novelty::of(&judged, &distances, &forms),
            difficulty: Difficulties::of(&judged),
            games: judged
                .iter()
                .zip(distances.each)
                .map(|(judged, near)| GameEntry::of(judged, near))
                .collect(),
        }
    }

    /// Its canonical JSON, with a line feed at the end.
    ///
    /// # Errors
    /// A number is not finite: a score that the game made so.
    pub fn to_json(&self) -> Result<String, CanonicalError> {
        to_canonical_json(self)
    }
}

impl<'a> Judged<'a> {
    fn of(reported: &'a ReportedGame, criteria: &Criteria, seed: Seed) -> Judged<'a> {
        let ReportedGame { title, game, levels, report, .. } = reported;
        let seed = seed.child(&game.digest().to_string(), 0);
        let surveyed = SurveyedGame { name: title.clone(), game: game.clone(), levels: levels.clone() };
        let row = GameRow::of(&surveyed, &report.levels, criteria, digest(reported), seed);
        let form = GameForm::of(game);
        let kind = GameKind::of(&Analysis::of(game));
        let held_out = super::survey::Edge::held_out(game, &report.levels, criteria);
        Judged { reported, row, form, kind, held_out }
    }
}

/// Of the rules and the levels.
fn digest(reported: &ReportedGame) -> Digest {
    let levels = reported.levels.iter().flat_map(|level| *level.digest().as_bytes());
    let bytes: Vec<u8> = reported.game.digest().as_bytes().iter().copied().chain(levels).collect();
    Digest::of(&bytes)
}

#[cfg(test)]
mod tests;
