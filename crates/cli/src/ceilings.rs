//! The ceilings of a release (the highest known win rates), in the format used in results folders.

use evaluation::LevelCeiling;
use snapshots::ceilings::Ceilings;

/// Returns the ceilings of the levels of the game with the given ID.
pub(crate) fn of_game(ceilings: &Ceilings, id: &str) -> Vec<LevelCeiling> {
    let levels = ceilings.games.iter().find(|game| game.id == id).map_or(&[][..], |game| &game.levels);
    let mut found = Vec::new();
    for (number, level) in levels.iter().enumerate() {
        for ceiling in &level.ceilings {
            let Ok(commit) = ceiling.commit.name().parse() else { continue };
            let (exact, wins, episodes) = (level.exact, ceiling.wins, ceiling.episodes);
            found.push(LevelCeiling { level: number, commit, exact, wins, episodes });
        }
    }
    found
}
