//! Compares a study's players with a release's reference results on the same levels.

use crate::commitment::Commitment;
use crate::study::episodes::scores::Estimate;
use crate::study::games::ceilings;
use crate::study::{LEVEL, Player, Study};
use report::{Table, TableCell};
use serde::Serialize;
use statistics::{Z95, rate_over_games, wilson};
use std::collections::{BTreeMap, BTreeSet};

/// A player's results with one commitment (number of actions per decision) on the levels of one tier (difficulty
/// class). Only levels with reference results count. The player is either a reference player or a player in the study.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MarkRow {
    /// The tier (difficulty class) of the levels.
    pub tier: u8,
    /// The number of actions that the player commits to at each decision, or `all`.
    pub commit: String,
    /// A reference player's name, or the label (without the commitment) of a player in the study.
    pub player: String,
    /// `true` for a reference player, whose results come from the release.
    pub is_mark: bool,
    /// The number of the tier's levels on which the player has results.
    pub levels: u64,
    /// The number of episodes.
    pub episodes: u64,
    /// The number of won episodes.
    pub wins: u64,
    /// The win rate. Its interval applies to similar games, or to exactly the played levels if there is only
    /// one game.
    pub rate: Option<Estimate>,
}

/// The number of wins and the number of episodes, by game index and level index.
type Counts = BTreeMap<(usize, usize), (u64, u64)>;

/// Returns the rows, sorted by tier (difficulty class), commitment (actions per decision) and win rate.
pub(in crate::study) fn rows(study: &Study) -> Vec<MarkRow> {
    let mut found: BTreeMap<(u8, Commitment, bool, String), Counts> = BTreeMap::new();
    let mut tiers: BTreeMap<(usize, usize), u8> = BTreeMap::new();
    let played: BTreeSet<(usize, usize)> =
        study.episodes.iter().map(|episode| (episode.game, episode.metrics.level)).collect();
    for (game, of_game) in study.games.iter().enumerate() {
        for mark in of_game.marks.iter().filter(|mark| played.contains(&(game, mark.level))) {
            tiers.insert((game, mark.level), mark.tier);
            if !ceilings::counts(of_game, mark.level, mark.commit) {
                continue;
            }
            let counts = found.entry((mark.tier, mark.commit, true, mark.player.clone())).or_default();
            counts.insert((game, mark.level), (mark.wins, mark.plays));
        }
    }
    for episode in study.episodes.iter().filter(|episode| episode.metrics.counts()) {
        let place = (episode.game, episode.metrics.level);
        let Some(&tier) = tiers.get(&place) else { continue };
        let mut player: Player = study.players[episode.player].clone();
        let commit = episode.metrics.commit;
        player.aids.retain(|aid| Some(aid) != commit.aid().as_ref());
        let counts = found.entry((tier, commit, false, player.label())).or_default();
        let (wins, plays) = counts.entry(place).or_default();
        (*wins, *plays) = (*wins + u64::from(episode.metrics.won()), *plays + 1);
    }
    let mut rows: Vec<(Commitment, MarkRow)> = found
        .into_iter()
        .map(|((tier, commit, is_mark, player), counts)| {
            (commit, row(tier, commit, player, is_mark, &counts))
        })
        .collect();
    let rate = |row: &MarkRow| row.wins as f64 / row.episodes.max(1) as f64;
    rows.sort_by(|(a, one), (b, other)| {
        (one.tier, a).cmp(&(other.tier, b)).then(rate(other).total_cmp(&rate(one)))
    });
    rows.into_iter().map(|(_, row)| row).collect()
}

fn row(tier: u8, commit: Commitment, player: String, is_mark: bool, counts: &Counts) -> MarkRow {
    let mut games: BTreeMap<usize, (u64, u64)> = BTreeMap::new();
    for ((game, _), (wins, plays)) in counts {
        let own = games.entry(*game).or_default();
        *own = (own.0 + wins, own.1 + plays);
    }
    let games: Vec<(u64, u64)> = games.into_values().collect();
    let (wins, episodes) = games.iter().fold((0, 0), |(wins, plays), game| (wins + game.0, plays + game.1));
    let rate = match (rate_over_games(&games, LEVEL), &games[..]) {
        (Some(found), _) => Some(Estimate::new(found.rate, found.interval)),
        (None, [_]) => Some(Estimate::new(wins as f64 / episodes as f64, wilson(wins, episodes, Z95))),
        (None, _) => None,
    };
    MarkRow {
        tier,
        commit: commit.to_string(),
        player,
        is_mark,
        levels: counts.len() as u64,
        episodes,
        wins,
        rate,
    }
}

/// Returns the table of reference results, or `None` if there are no reference results.
pub(in crate::study) fn table(study: &Study) -> Option<Table> {
    if study.marks.is_empty() {
        return None;
    }
    let table = Table::of(
        "marks",
        "Compared with the marks of the release",
        "Reference players, which never change, played every level when the release was minted. The rows \
         marked `mark` give their results on the levels of this report. Tier: how much a level demands of its player, \
         from 1 to 4. Commitment: the number of actions chosen without looking again. The 95% intervals apply to \
         games like these (for a single game, to exactly its levels). Marks may have been played with a different \
         step limit, which the release states.",
        &study.marks,
        &[
            ("tier", &|row| TableCell::Count(u64::from(row.tier))),
            ("commitment", &|row| TableCell::text(&row.commit)),
            ("player", &|row| TableCell::text(&row.player)),
            ("mark", &|row| TableCell::text(if row.is_mark { "mark" } else { "" })),
            ("levels", &|row| TableCell::Count(row.levels)),
            ("episodes", &|row| TableCell::Count(row.episodes)),
            ("wins", &|row| TableCell::Count(row.wins)),
            ("win rate", &|row| Estimate::cell(row.rate, 2)),
        ],
    );
    Some(table)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::StudyGame;
    use crate::subject::LevelMark;

    #[test]
    fn marks_of_levels_that_nobody_played_are_left_out() {
        let mark = |level| LevelMark {
            level,
            tier: 3,
            player: "reflex".to_owned(),
            commit: Commitment::All,
            wins: 1,
            plays: 2,
        };
        let game = StudyGame { id: "pond".to_owned(), marks: vec![mark(0), mark(1)], ..StudyGame::default() };
        let study = Study::new(Vec::new(), vec![game]);
        assert!(study.marks.is_empty() && study.tables().iter().all(|table| table.id != "marks"));
    }
}
