//! The verdicts on a set of games, and the episodes played on them.

use super::entry::Measured;
use crate::reported::{LABELS, PlayerRate, obstacles, rank};
use crate::survey::{Edge, SurveyedGame};
use report::{Mean, Quantiles, Section, Share, Table, TableCell};
use validators::Report;

/// The unit over which means are taken.
const GAME: &str = "game";

pub(super) fn validity(games: &[SurveyedGame]) -> Section {
    let levels = games.iter().flat_map(|game| &game.report.levels);
    let passing = Share::yes(games.iter().map(|game| game.report.passes()));
    let note = "`arcade docs validate` explains each criterion.";
    let first = obstacles(games.iter().filter_map(SurveyedGame::obstacle));
    Section::new("validity", "Do the games meet the criteria?", note)
        .share("games", "games (every level, and all levels together)", passing)
        .share("levels", "levels", Share::yes(levels.map(Report::passes)))
        .tally("obstacles", "first failure", &first, Some(games.len() as u64))
}

/// The difference between win rates that counts as significant.
const SURE: f64 = 0.25;

/// Describes the skill required by the games; `None` if no ladder (reference players of increasing strength) played.
pub(super) fn skill(measured: &[Measured<'_>]) -> Option<Section> {
    let edges: Vec<&Edge> = measured.iter().filter_map(|game| game.row.edge.as_ref()).collect();
    let held_out = measured.iter().filter_map(|game| game.held_out.as_ref()).map(|edge| edge.points);
    let points: Vec<f64> = edges.iter().map(|edge| edge.points).collect();
    Quantiles::of(&points)?;
    let orders: Vec<f64> = measured.iter().filter_map(|game| game.row.order).collect();
    let in_wins = |edge: &Edge| edge.points >= SURE && edge.interval[0] > 0.0;
    let paying = edges.iter().filter(|edge| edge.pays);
    let note = "The comparisons are between the strongest player and the best player that does not look ahead, \
                over all levels of a game. Below them are each player's results over all games.";
    let section = Section::new("skill", "Does skill pay?", note)
        .share("pays", "skill pays, in wins or in score", Share::yes(edges.iter().map(|edge| edge.pays)))
        .share("by_score_only", "skill pays in score only", Share::yes(paying.map(|edge| !in_wins(edge))))
        .share(
            "sure",
            "at least 25 points at the lower end of the interval",
            Share::yes(edges.iter().map(|edge| edge.interval[0] >= SURE)),
        )
        .gain("order", "players rank in ladder order (rank correlation)", Mean::over(GAME, &orders))
        .quantiles("points", "difference between win rates", &points)
        .quantiles(
            "held_out",
            "difference between win rates, held-out players",
            &held_out.collect::<Vec<f64>>(),
        );
    let levels = measured.iter().flat_map(|game| &game.surveyed.report.levels);
    Some(PlayerRate::add_all(section, levels.filter_map(Report::ladder)))
}

pub(super) fn rules(measured: &[Measured<'_>]) -> Section {
    let rows = || measured.iter().map(|game| &game.row);
    let executed = Share::new(rows().map(|row| row.executed).sum(), rows().map(|row| row.rules).sum());
    let counts: Vec<f64> = rows().map(|row| row.rules as f64).collect();
    let note =
        "Anything that occurs in at least one recorded episode counts as used. Guards do not count as rules.";
    Section::new("rules", "Is everything used?", note)
        .share(
            "all_used",
            "games in which every rule runs",
            Share::yes(rows().map(|row| row.executed == row.rules)),
        )
        .share("executed", "rules that run", executed)
        .share(
            "no_dead_sprites",
            "games without dead sprites",
            Share::yes(rows().map(|row| row.there == row.types)),
        )
        .quantiles("count", "rules of a game", &counts)
}

pub(super) fn play(measured: &[Measured<'_>]) -> Section {
    let rows = || measured.iter().map(|game| &game.row);
    let levels = measured.iter().flat_map(|game| &game.surveyed.report.levels);
    let wins = levels.filter_map(|found| found.witness.as_ref());
    let ticks: Vec<f64> = wins.map(|witness| witness.actions.len() as f64).collect();
    let mechanics: Vec<f64> = rows().filter_map(|row| row.mechanics).map(|count| count as f64).collect();
    let drama: Vec<f64> = rows().filter_map(|row| row.drama).collect();
    let won = Share::new(rows().map(|row| row.won).sum(), rows().map(|row| row.levels).sum());
    Section::new("play", "How are the games won?", "")
        .share("won", "levels with a known win", won)
        .quantiles("ticks", "ticks in the shortest win found", &ticks)
        .quantiles("mechanics", "mechanics that wins use", &mechanics)
        .quantiles("drama", "drama", &drama)
}

/// Describes the difficulty of levels by their position in the game, as a section and as a table; `None` if no ladder
/// (reference players of increasing strength) played.
pub(super) fn difficulty(measured: &[Measured<'_>]) -> Option<(Section, Table)> {
    let reports = || measured.iter().map(|game| &game.surveyed.report.levels);
    let most = reports().map(Vec::len).max()?;
    let mut counts = vec![vec![0u64; LABELS.len()]; most];
    for levels in reports() {
        for (at, ladder) in levels.iter().enumerate().filter_map(|(at, found)| Some((at, found.ladder()?))) {
            counts[at][rank(ladder.difficulty)] += 1;
        }
    }
    if counts.iter().flatten().all(|count| *count == 0) {
        return None;
    }
    let rising = reports().filter_map(|levels| {
        let eases = levels.iter().enumerate();
        let eases = eases.filter_map(|(at, found)| Some((at as f64, 1.0 - found.ladder()?.ease?)));
        statistics::spearman(&eases.collect::<Vec<(f64, f64)>>())
    });
    let rising = Mean::over(GAME, &rising.collect::<Vec<f64>>());
    let section = Section::new("difficulty", "Do the levels get harder?", "")
        .data("labels", &LABELS)
        .data("table", &counts)
        .gain("rising", "levels get harder (rank correlation of position and difficulty)", rising);
    let labels = LABELS.map(|label| label.to_string());
    let columns: Vec<&str> = [""].into_iter().chain(labels.iter().map(String::as_str)).collect();
    let mut table = Table::new("difficulty", "Difficulty", "Levels by their position in the game.", &columns);
    for (place, counts) in counts.into_iter().enumerate() {
        let cells = [TableCell::text(format!("level {place}"))].into_iter();
        table.push(cells.chain(counts.into_iter().map(TableCell::Count)).collect());
    }
    Some((section, table))
}
