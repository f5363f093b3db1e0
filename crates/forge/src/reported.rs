//! The figures shared by the reports on levels and on games.

use report::{Section, Share};
use serde::Serialize;
use std::collections::BTreeMap;
use validators::{Difficulty, Judgement, Ladder};

/// All labels, from easiest to hardest.
pub(crate) const LABELS: [Difficulty; 6] = [
    Difficulty::VeryEasy,
    Difficulty::Easy,
    Difficulty::Medium,
    Difficulty::Hard,
    Difficulty::VeryHard,
    Difficulty::Unbeaten,
];

/// Returns the index of a label in [`LABELS`].
pub(crate) fn rank(label: Difficulty) -> usize {
    LABELS.iter().position(|known| *known == label).expect("all labels are listed")
}

/// Counts how often each criterion was the first to fail.
pub(crate) fn obstacles<'a>(first: impl Iterator<Item = &'a Judgement>) -> BTreeMap<String, u64> {
    counted(first.map(|judgement| judgement.criterion.name()))
}

/// Counts the occurrences of each name.
pub(crate) fn counted<'a>(names: impl Iterator<Item = &'a str>) -> BTreeMap<String, u64> {
    let mut counts = BTreeMap::new();
    names.for_each(|name| *counts.entry(name.to_owned()).or_default() += 1);
    counts
}

/// The win rate of a player over all levels.
#[derive(Serialize)]
pub(crate) struct PlayerRate {
    player: String,
    looks_ahead: bool,
    wins: Share,
}

impl PlayerRate {
    /// Adds each player's results over several levels to a section. The players of the ladder come first, from weakest
    /// to strongest, followed by the held-out players.
    pub(crate) fn add_all<'a>(section: Section, ladders: impl IntoIterator<Item = &'a Ladder>) -> Section {
        let mut players: Vec<PlayerRate> = Vec::new();
        for fared in ladders.into_iter().flat_map(|ladder| ladder.rungs.iter().chain(&ladder.held_out)) {
            let (wins, plays) = (fared.rate.wins, fared.rate.plays);
            match players.iter_mut().find(|known| known.player == fared.player) {
                Some(known) => known.wins = Share::new(known.wins.count + wins, known.wins.of + plays),
                None => players.push(PlayerRate {
                    player: fared.player.clone(),
                    looks_ahead: fared.looks_ahead,
                    wins: Share::new(wins, plays),
                }),
            }
        }
        let section = section.data("players", &players);
        players.iter().fold(section, |section, player| {
            section.shown(format!("{} wins", player.player), player.wins.into())
        })
    }
}

/// Returns Spearman's rank correlation between the reference players' positions on the ladder (from weak to strong) and
/// their results. Results are compared by wins first and then by score. The correlation is 1 if every stronger player
/// does better. Returns `None` if all players do equally well.
pub(crate) fn in_order(fares: &[(f64, f64)]) -> Option<f64> {
    let worse = |own: &(f64, f64)| fares.iter().filter(|other| *other < own).count() as f64;
    let pairs: Vec<(f64, f64)> = fares.iter().enumerate().map(|(at, own)| (at as f64, worse(own))).collect();
    statistics::spearman(&pairs)
}
