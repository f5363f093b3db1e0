//! Tests of thinking horizons (the number of output tokens per answer at which a player wins half of its episodes), using
//! synthetic players whose horizons are known.

use super::episode;
use base::Seed;
use engine::Outcome::{Lost, Won};
use evaluation::metrics::EpisodeMetrics;
use evaluation::study::{Player, Study, StudyGame, ThinkingRow};
use evaluation::{Commitment, LevelMark, budget_aid};

/// The budgets of the synthetic players.
const BUDGETS: [u32; 5] = [100, 400, 1600, 6400, 25_600];

/// A synthetic player: its name, and its thinking horizon for each tier.
type Thinker<'a> = (&'a str, &'a dyn Fn(u8) -> f64);

/// Returns the episodes of a synthetic player with one budget. There are twelve games with one level per tier. The logit
/// of a win is 2 ln(budget / horizon), plus an effect of the game. An episode uses half of its budget.
fn episodes(name: &str, horizon: &dyn Fn(u8) -> f64, budget: u32) -> (Player, Vec<EpisodeMetrics>) {
    let mut sampler = Seed::from_text(name).child("budget", u64::from(budget)).sampler();
    let mut episodes = Vec::new();
    for (game, level, run) in
        (0..12).flat_map(|game| (0..2).flat_map(move |level| (0..8).map(move |run| (game, level, run))))
    {
        // The odds of a loss are those of the horizon, times e, 1 or 1/e.
        let effect = [2.7, 1.0, 0.37][game % 3];
        let ratio = horizon(level as u8 + 1) / f64::from(budget);
        let odds = effect * ratio * ratio;
        let is_won = sampler.unit() < 1.0 / (1.0 + odds);
        let outcome = if is_won { Won } else { Lost };
        let metrics = episode(&format!("game{game}"), level, run, outcome, 0.0, 40);
        let thought = Some(u64::from(budget / 2));
        episodes.push(EpisodeMetrics { max_output_tokens: Some(budget), thought, ..metrics });
    }
    (Player { aids: vec![budget_aid(budget), "json".to_owned()], ..Player::reference(name) }, episodes)
}

fn study(thinkers: &[Thinker<'_>]) -> Study {
    let mark = |level: usize| LevelMark {
        level,
        tier: level as u8 + 1,
        player: "mark".to_owned(),
        commit: Commitment::ONE,
        plays: 1,
        wins: 0,
    };
    let game = |number: usize| StudyGame {
        id: format!("game{number}"),
        marks: vec![mark(0), mark(1)],
        ..StudyGame::default()
    };
    let results = thinkers
        .iter()
        .flat_map(|(name, horizon)| BUDGETS.map(|budget| episodes(name, horizon, budget)))
        .collect();
    Study::new(results, (0..12).map(game).collect())
}

fn row<'a>(study: &'a Study, name: &str, tier: Option<u8>) -> &'a ThinkingRow {
    let row = study.thinking.iter().find(|row| row.player.name == name && row.tier == tier);
    row.expect("a row of this player and tier")
}

#[test]
fn known_horizons_are_recovered_by_tier() {
    let study = study(&[("p", &|tier| if tier == 1 { 800.0 } else { 4000.0 })]);
    assert_eq!(study.thinking.len(), 3, "two tiers, and all");
    for (tier, known) in [(1, 800.0), (2, 4000.0)] {
        let row = row(&study, "p", Some(tier));
        assert_eq!(row.player.label(), "p (json)", "budgets are no players of their own");
        let found = row.horizon.horizon.expect("a horizon");
        assert!((0.75..1.33).contains(&(found.value / known)), "{row:?}");
        assert!(found.low < known && known < found.high && found.high / found.low < 4.0, "{row:?}");
    }
    let all = row(&study, "p", None);
    assert_eq!((all.title(), all.rates.len()), ("p (json)".to_owned(), 5));
    let table =
        study.tables().into_iter().find(|table| table.id == "thinking").expect("a table").to_markdown();
    assert!(table.contains("| p (json) | 1 |") && table.contains("| p (json) | all |"), "{table}");
}

/// The intervals of players whose horizons differ by a factor of ten do not overlap.
#[test]
fn a_factor_of_ten_is_told_apart() {
    let study = study(&[("slow", &|_| 6000.0), ("quick", &|_| 600.0)]);
    let names: Vec<&str> =
        study.thinking.iter().filter(|row| row.tier == Some(1)).map(|row| row.player.name.as_str()).collect();
    assert_eq!(names, ["quick", "slow"], "the lowest horizon comes first");
    for tier in [Some(1), Some(2), None] {
        let [quick, slow] =
            ["quick", "slow"].map(|name| row(&study, name, tier).horizon.horizon.expect("a horizon"));
        assert!(quick.high < slow.low, "{quick:?} {slow:?}");
    }
}

#[test]
fn bounds_are_told_as_bounds() {
    let study = study(&[("never", &|_| 1e12), ("always", &|_| 1e-9)]);
    let told = |name: &str| {
        let Some(found) = study.thinking.iter().find(|row| row.player.name == name) else { panic!("{name}") };
        (found.horizon.told_value(), found.horizon.told_interval())
    };
    assert_eq!(told("never"), ("≥ 102400".to_owned(), "≥ 102400".to_owned()));
    assert_eq!(told("always"), ("≤ 25".to_owned(), "≤ 25".to_owned()));
    let never = row(&study, "never", None);
    assert!(never.rates.iter().all(|rate| rate.tokens_per_win.is_none()), "{never:?}");
    let always = row(&study, "always", None);
    assert!(always.rates.iter().all(|rate| rate.tokens_per_win == Some(f64::from(rate.budget / 2))));
}

/// Results without budgets, and players with one budget, have no thinking horizon.
#[test]
fn one_budget_has_no_horizon() {
    let (player, limited) = episodes("p", &|_| 800.0, 400);
    let unlimited = |episode: &EpisodeMetrics| EpisodeMetrics { max_output_tokens: None, ..episode.clone() };
    let free = (Player::reference("p"), limited.iter().map(unlimited).collect());
    let study = Study::new(vec![(player, limited), free], Vec::new());
    assert!(study.thinking.is_empty() && study.tables().iter().all(|table| table.id != "thinking"));
}
