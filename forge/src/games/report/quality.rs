//! What the judges' verdicts and plays say of a set of games.

use super::ReportedGame;
use super::entry::{Judged, obstacle};
use super::figures::Mean;
use crate::games::survey::Edge;
use crate::levels::report::PlayerRate;
use report::{Quantiles, Share};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Do they meet the criteria?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Validity {
    /// Games whose levels meet every criterion, each and together.
    pub games: Share,
    /// Levels that meet every criterion of a level.
    pub levels: Share,
    /// What the other games fail first: how many, by criterion.
    pub obstacles: BTreeMap<String, u64>,
}

impl Validity {
    pub(super) fn of(games: &[ReportedGame]) -> Validity {
        let mut obstacles = BTreeMap::new();
        for criterion in games.iter().filter_map(obstacle) {
            *obstacles.entry(criterion.to_owned()).or_default() += 1;
        }
        let levels = games.iter().flat_map(|game| &game.report.levels);
        Validity {
            games: Share::yes(games.iter().map(|game| game.report.passes())),
            levels: Share::yes(levels.map(|report| report.passes())),
            obstacles,
        }
    }
}

/// Does skill pay?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skill {
    /// Games in which the strongest player does better than those who do not look ahead, by the margin of the criteria and
    /// surely; see [`Edge::pays`].
    pub pays: Share,
    /// Of those, how many show it in scores only: not by a difference of win rates of at least [`SURE`], surely.
    pub by_score_only: Share,
    /// Games where the lower end of the interval of the difference of win rates is at least [`SURE`].
    pub sure: Share,
    /// The difference of win rates, over games.
    pub points: Option<Quantiles>,
    /// The same with the strongest of the players held out; none if none was.
    pub held_out: Option<Quantiles>,
    /// The rank correlation of a player's place in the ladder with how it fares, in the mean over games.
    pub order: Option<Mean>,
    /// Each player over all levels of all games: those of the ladder from the weakest, then those held out.
    pub players: Vec<PlayerRate>,
}

/// The difference of win rates that is called sure.
const SURE: f64 = 0.25;

impl Skill {
    pub(super) fn of(judged: &[Judged<'_>]) -> Option<Skill> {
        let edges: Vec<&Edge> = judged.iter().filter_map(|judged| judged.row.edge.as_ref()).collect();
        let points =
            |edges: &[&Edge]| Quantiles::of(&edges.iter().map(|edge| edge.points).collect::<Vec<f64>>());
        let held_out: Vec<&Edge> = judged.iter().filter_map(|judged| judged.held_out.as_ref()).collect();
        let orders: Vec<f64> = judged.iter().filter_map(|judged| judged.row.order).collect();
        let in_wins = |edge: &Edge| edge.points >= SURE && edge.interval[0] > 0.0;
        let paying = edges.iter().filter(|edge| edge.pays);
        Some(Skill {
            points: Some(points(&edges)?),
            pays: Share::yes(edges.iter().map(|edge| edge.pays)),
            by_score_only: Share::yes(paying.map(|edge| !in_wins(edge))),
            sure: Share::yes(edges.iter().map(|edge| edge.interval[0] >= SURE)),
            held_out: points(&held_out),
            order: Mean::of(&orders),
            players: players(judged),
        })
    }
}

fn players(judged: &[Judged<'_>]) -> Vec<PlayerRate> {
    let mut players: Vec<PlayerRate> = Vec::new();
    let ladders =
        judged.iter().flat_map(|judged| &judged.reported.report.levels).filter_map(|report| report.ladder());
    for fared in ladders.flat_map(|ladder| ladder.rungs.iter().chain(&ladder.held_out)) {
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
    players
}

/// Is every rule and sprite used?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rules {
    /// Games of which recorded play executes every interaction, guards apart.
    pub all_used: Share,
    /// Interactions that recorded play executes, of those of all games.
    pub executed: Share,
    /// Games of which every declared sprite type is there in recorded play.
    pub no_dead_sprites: Share,
    /// Interactions of a game, guards apart.
    pub count: Option<Quantiles>,
}

impl Rules {
    pub(super) fn of(judged: &[Judged<'_>]) -> Rules {
        let rows = || judged.iter().map(|judged| &judged.row);
        let counts: Vec<f64> = rows().map(|row| row.rules as f64).collect();
        Rules {
            all_used: Share::yes(rows().map(|row| row.executed == row.rules)),
            executed: Share::new(rows().map(|row| row.executed).sum(), rows().map(|row| row.rules).sum()),
            no_dead_sprites: Share::yes(rows().map(|row| row.there == row.types)),
            count: Quantiles::of(&counts),
        }
    }
}

/// What happens while they are won?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Play {
    /// Levels of which a win is known.
    pub won: Share,
    /// Ticks of the shortest win that was found, over levels.
    pub ticks: Option<Quantiles>,
    /// Mechanics that winning play uses, over games.
    pub mechanics: Option<Quantiles>,
    /// How open the outcome is, over games.
    pub drama: Option<Quantiles>,
}

impl Play {
    pub(super) fn of(judged: &[Judged<'_>]) -> Play {
        let rows = || judged.iter().map(|judged| &judged.row);
        let wins = judged
            .iter()
            .flat_map(|judged| &judged.reported.report.levels)
            .filter_map(|found| found.witness.as_ref());
        let ticks: Vec<f64> = wins.map(|witness| witness.actions.len() as f64).collect();
        let mechanics: Vec<f64> = rows().filter_map(|row| row.mechanics).map(|count| count as f64).collect();
        let drama: Vec<f64> = rows().filter_map(|row| row.drama).collect();
        Play {
            won: Share::new(rows().map(|row| row.won).sum(), rows().map(|row| row.levels).sum()),
            ticks: Quantiles::of(&ticks),
            mechanics: Quantiles::of(&mechanics),
            drama: Quantiles::of(&drama),
        }
    }
}
