//! The marks of releases: their players are those of evaluations.

use base::Seed;
use evaluation::marks::{MarkPlayer, MarkPlays};
use evaluation::{Commitment, LevelMark, Subject, SubjectFacts, SubjectLevel};
use itertools::iproduct;
use rayon::prelude::*;
use snapshots::marks::{MarkPlayers, Marks, MarksPart, Wins};

/// The text from which `arcade evaluate` derives the randomness of games unless told otherwise. Marks are episodes of
/// such an evaluation.
pub(crate) const SEED: &str = "evaluate";

/// The players of marks, by the names of `arcade evaluate --player`.
#[derive(Debug)]
pub(crate) struct Players;

impl MarkPlayers for Players {
    fn check(&self, player: &str) -> Result<(), String> {
        player.parse::<MarkPlayer>().map(drop)
    }

    fn play(&self, game: &str, levels: &[String], asked: &MarksPart) -> Result<Vec<Wins>, String> {
        let texts: Vec<_> = levels.iter().enumerate().map(|(at, text)| (at, text.clone(), None)).collect();
        let subject = Subject::read("game", game, &texts, SubjectFacts::default());
        let subject = subject.map_err(|error| error.to_string())?;
        let players: Vec<MarkPlayer> =
            asked.players.iter().map(|name| name.parse()).collect::<Result<_, _>>()?;
        let commits: Vec<Commitment> =
            asked.commits.iter().map(|commit| commit.name().parse()).collect::<Result<_, _>>()?;
        let plays = MarkPlays { seed: Seed::from_text(SEED), runs: asked.plays, max_steps: asked.max_steps };
        let each: Vec<(&SubjectLevel, &MarkPlayer)> = iproduct!(&subject.levels, &players).collect();
        let wins = each.into_par_iter().with_max_len(1).map(|(level, player)| {
            plays.wins(&subject, level, player, &commits).map_err(|error| error.to_string())
        });
        let wins: Vec<Vec<u64>> = wins.collect::<Result<_, _>>()?;
        Ok(wins.chunks(players.len()).map(<[_]>::to_vec).collect())
    }
}

/// Returns the marks of a game in the form of results.
pub(crate) fn of_game(marks: &Marks, id: &str) -> Vec<LevelMark> {
    let levels = marks.games.iter().find(|game| game.id == id).map_or(&[][..], |game| &game.levels);
    let asked = &marks.asked;
    let mut found = Vec::new();
    for (number, level) in levels.iter().enumerate() {
        for (player, own) in asked.players.iter().zip(&level.wins) {
            for (commit, &wins) in asked.commits.iter().zip(own) {
                let Ok(commit) = commit.name().parse() else { continue };
                let (tier, player, plays) = (u8::from(level.tier), player.clone(), asked.plays);
                found.push(LevelMark { level: number, tier, player, commit, wins, plays });
            }
        }
    }
    found
}
