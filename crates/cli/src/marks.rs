//! The reference players whose results a release stores (its *marks*). They are constructed in the same way as the
//! players in evaluations.

use base::Seed;
use evaluation::LevelMark;
use evaluation::reference::{ReferencePlayer, ReferencePlays, SEED};
use snapshots::marks::{MarkPlayers, Marks, MarksPart, Wins};

/// The reference players whose results a release stores, by the names that `arcade evaluate --player` accepts.
#[derive(Debug)]
pub(crate) struct Players;

impl MarkPlayers for Players {
    fn check(&self, player: &str) -> Result<(), String> {
        player.parse::<ReferencePlayer>().map(drop)
    }

    fn play(&self, game: &str, levels: &[String], asked: &MarksPart) -> Result<Vec<Wins>, String> {
        let plays =
            ReferencePlays { seed: Seed::from_text(SEED), runs: asked.plays, max_steps: asked.max_steps };
        plays.of_game(game, levels, &asked.players, asked.commits.iter().map(|commit| commit.name()))
    }
}

/// Returns the stored results of reference players on the game with the given ID, in the format used in results
/// folders.
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
