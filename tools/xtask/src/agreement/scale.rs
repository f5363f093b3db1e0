//! Simulates a calibration and its results for `tools/scripts/scale.py`.

use serde_json::{Value, json};
use statistics::scale::simulated::{AbilityCase, Plan, Simulator};
use statistics::scale::{
    Calibration, Dimension, Estimated, GamePlays, MismatchPrior, Month, PlayedGame, Spreads, ability,
};

/// Returns two months with a few games each, their calibration, and a player's ability.
pub(super) fn calibration(seed: u64) -> anyhow::Result<Value> {
    let spreads = Spreads { game: 1.6, level: 1.4, family: 1.2, ..Spreads::default() };
    let plan = Plan {
        games: 14,
        levels: 3,
        families: vec![1, 2, 1, 1],
        runs: 3,
        anchors: 2,
        anchor_runs: 3,
        replicates: 0,
        spreads,
    };
    let mut simulator = Simulator::new(plan, seed);
    let (first, second) = (simulator.month(0.0, 0.0), simulator.month(0.4, 0.3));
    let failed = || anyhow::anyhow!("the simulated months cannot be calibrated; use a different seed");
    let (found, base) = Calibration::new(&simulator.examinees, &first.plays).ok_or_else(failed)?;
    let month = found.add(&second.plays).ok_or_else(failed)?;
    let player = AbilityCase { ability: 0.5, mismatch: 1.0, episodes: 30 };
    let games = simulator.person(&second, &month, Dimension::Reader, player);
    let player = ability(&games, MismatchPrior::default(), 0.0).ok_or_else(failed)?;
    let examinees = simulator.examinees.iter().map(|one| {
        let family = (one.dimension == Dimension::Planner).then_some(one.family);
        json!({ "family": family })
    });
    let Spreads { game, level, family, planner, .. } = found.spreads;
    let Spreads { game_slope, level_slope, game_rest, level_rest, reader, .. } = found.spreads;
    let abilities = (0..simulator.examinees.len()).map(|at| pair(found.ability(at)));
    Ok(json!({
        "examinees": examinees.collect::<Vec<_>>(),
        "months": [plays(&first.plays), plays(&second.plays)],
        "spreads": [game, level, family, planner, game_slope, level_slope, game_rest, level_rest, reader],
        "correlation": found.spreads.correlation(),
        "abilities": abilities.collect::<Vec<_>>(),
        "difficulties": [difficulties(&base), difficulties(&month)],
        "shifts": month.shifts.map(pair),
        "planners_shift": pair(month.planners_shift),
        "drift": month.drift.map(pair),
        "person": played(&games),
        "ability": [player.value, player.error, player.interval.low, player.interval.high],
    }))
}

fn pair(found: Estimated) -> [f64; 2] {
    [found.value, found.error]
}

fn plays(games: &[GamePlays]) -> Value {
    let of_game = |game: &GamePlays| -> Vec<Value> {
        game.plays.iter().map(|one| json!([one.examinee, one.level, one.won, one.of])).collect()
    };
    games.iter().map(of_game).collect()
}

fn difficulties(month: &Month) -> Value {
    let levels = |side: usize| -> Vec<Vec<[f64; 2]>> {
        let of_game = |game: &statistics::scale::GameDifficulties| {
            game.difficulties[side].levels.iter().map(|level| pair(*level)).collect()
        };
        month.games.iter().map(of_game).collect()
    };
    json!([levels(0), levels(1)])
}

fn played(games: &[PlayedGame]) -> Value {
    let of_game = |game: &PlayedGame| {
        let levels: Vec<[f64; 4]> =
            game.levels.iter().map(|one| [one.difficulty, one.own, one.won, one.of]).collect();
        json!({ "common": game.common, "levels": levels })
    };
    games.iter().map(of_game).collect()
}
