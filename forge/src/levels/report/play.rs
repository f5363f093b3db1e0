//! What the judges' verdicts and plays say of a set.

use super::Judged;
use engine::Game;
use report::{Estimate, Quantiles, Share};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::{Fared, Ladder, Line, Verdict, is_guard};

/// The greatest share of wins that is still not won for nothing.
pub(super) const FOR_NOTHING: f64 = 0.1;

/// Are they levels at all?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Validity {
    /// Well-formed: not over in the first tick, nothing that the engine stops at.
    pub well_formed: Share,
    /// Without warnings of the engine.
    pub clean: Share,
    /// Every criterion that was asked is met.
    pub passes: Share,
    /// What the others fail first: how many levels, by criterion.
    pub obstacles: BTreeMap<String, u64>,
    /// How many lie within what the game's own levels span; empty if it has none.
    pub fit: Vec<Fit>,
}

/// A measure beside that of the game's own levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fit {
    /// `columns`, `rows`, or a measure of the layout.
    pub measure: String,
    /// The least and the greatest of the game's own levels.
    pub examples: [f64; 2],
    /// The least and the greatest of the set.
    pub levels: [f64; 2],
    /// Levels within the range of the game's own.
    pub within: Share,
}

impl Validity {
    pub(super) fn of(levels: &[Judged], examples: &[Judged]) -> Validity {
        let asked =
            |judged: &Judged| judged.report.finding("well-formed").map(|found| found.verdict.is_pass());
        let mut obstacles = BTreeMap::new();
        for obstacle in levels.iter().filter_map(|judged| judged.report.first_obstacle()) {
            *obstacles.entry(obstacle.criterion.to_owned()).or_default() += 1;
        }
        Validity {
            well_formed: Share::yes(levels.iter().filter_map(asked)),
            clean: Share::yes(levels.iter().map(|judged| judged.level.warnings().is_empty())),
            passes: Share::yes(levels.iter().map(|judged| judged.report.passes())),
            obstacles,
            fit: fits(levels, examples),
        }
    }
}

fn fits(levels: &[Judged], examples: &[Judged]) -> Vec<Fit> {
    let layout = examples.first().map_or(&[][..], |judged| &judged.layout);
    let names = ["columns", "rows"].into_iter().chain(layout.iter().map(|(name, _)| name.as_str()));
    let values = |of: &[Judged], name: &str| -> Vec<f64> {
        let value = |judged: &Judged| match name {
            "columns" => Some(judged.level.columns() as f64),
            "rows" => Some(judged.level.rows() as f64),
            _ => judged.measure(name),
        };
        of.iter().filter_map(value).collect()
    };
    let fit = |name: &str| {
        let (ours, own) = (values(levels, name), values(examples, name));
        let (set, [low, high]) = (span(&ours)?, span(&own)?);
        let within = Share::yes(ours.iter().map(|value| (low..=high).contains(value)));
        Some(Fit { measure: name.to_owned(), examples: [low, high], levels: set, within })
    };
    names.filter_map(fit).collect()
}

fn span(values: &[f64]) -> Option<[f64; 2]> {
    let found = Quantiles::of(values)?;
    Some([found.min, found.max])
}

/// Can they be won?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Solvability {
    /// There is a witness: an episode that wins.
    pub solved: Share,
    /// It is proved that there is no way to win.
    pub impossible: Share,
    /// Neither, within the budget.
    pub unknown: Share,
}

impl Solvability {
    pub(super) fn of(levels: &[Judged]) -> Solvability {
        let solved = |judged: &Judged| judged.report.witness.is_some();
        let impossible = |judged: &Judged| {
            let found = judged.report.finding("winnable");
            found.is_some_and(|found| matches!(found.verdict, Verdict::Fail { .. }))
        };
        Solvability {
            solved: Share::yes(levels.iter().map(solved)),
            impossible: Share::yes(levels.iter().map(impossible)),
            unknown: Share::yes(levels.iter().map(|judged| !solved(judged) && !impossible(judged))),
        }
    }
}

/// Are they won for nothing?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Triviality {
    /// Episodes of doing nothing that won, over all levels.
    pub idle: Share,
    /// Episodes of random play that won, over all levels.
    pub random: Share,
    /// Levels of which doing nothing wins at most 10 %.
    pub idle_levels: Share,
    /// Levels of which random play wins at most 10 %.
    pub random_levels: Share,
    /// Levels of which each wins at most 10 %.
    pub both_levels: Share,
}

impl Triviality {
    pub(super) fn of(levels: &[Judged]) -> Triviality {
        let rate = |judged: &Judged, criterion: &str| {
            let measured = judged.report.finding(criterion)?.measured.as_ref()?;
            Some((measured.wins, measured.plays))
        };
        let pooled = |criterion: &str| {
            let rates = levels.iter().filter_map(|judged| rate(judged, criterion));
            let (wins, plays) = rates.fold((0, 0), |sum, one| (sum.0 + one.0, sum.1 + one.1));
            Share::new(wins, plays)
        };
        let few = |(wins, plays): (u64, u64)| wins as f64 <= FOR_NOTHING * plays as f64;
        let of_few = |judged: &Judged, criterion: &str| rate(judged, criterion).map(few);
        let of_levels =
            |criterion: &str| Share::yes(levels.iter().filter_map(|judged| of_few(judged, criterion)));
        let both = |judged: &Judged| Some(of_few(judged, "not-idle")? && of_few(judged, "not-random")?);
        Triviality {
            idle: pooled("not-idle"),
            random: pooled("not-random"),
            idle_levels: of_levels("not-idle"),
            random_levels: of_levels("not-random"),
            both_levels: Share::yes(levels.iter().filter_map(both)),
        }
    }
}

/// How long is a win?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lengths {
    /// Ticks of the witnesses; none if there are none.
    pub ticks: Option<Quantiles>,
    /// Levels with a witness for which it is proved that no fewer ticks win.
    pub proved: Share,
    /// Ticks of those; none if there are none.
    pub shortest: Option<Quantiles>,
    /// Pushes of the witnesses; none where nothing is pushed.
    pub pushes: Option<Quantiles>,
}

impl Lengths {
    pub(super) fn of(levels: &[Judged]) -> Lengths {
        let measures = || levels.iter().filter_map(|judged| judged.measures.as_ref());
        let ticks: Vec<f64> = measures().map(|measures| measures.ticks as f64).collect();
        let shortest: Vec<f64> =
            measures().filter_map(|measures| measures.shortest).map(|ticks| ticks as f64).collect();
        let pushes: Vec<f64> = measures().map(|measures| measures.pushes as f64).collect();
        Lengths {
            ticks: Quantiles::of(&ticks),
            proved: Share::new(shortest.len() as u64, ticks.len() as u64),
            shortest: Quantiles::of(&shortest),
            pushes: Quantiles::of(&pushes).filter(|pushes| pushes.max > 0.0),
        }
    }
}

/// Does looking ahead pay?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skill {
    /// By how much those who look ahead win more often than those who do not, in the mean over levels.
    pub wins: Estimate,
    /// By how much they score more, as a share of the range of scores; none if no level has scores that differ.
    pub reward: Option<Estimate>,
    /// Spearman's rank correlation of a player's place in the ladder with how it fares, in the mean over levels where not all
    /// fare alike; none if there are no such levels.
    pub order: Option<Estimate>,
    /// The players, over all levels: those of the ladder from the weakest, then those held out.
    pub players: Vec<PlayerRate>,
}

/// How a player fared over all levels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlayerRate {
    /// Who: `mcts:500`.
    pub player: String,
    /// Whether it looks ahead.
    pub looks_ahead: bool,
    /// Episodes won.
    pub wins: Share,
}

impl Skill {
    pub(super) fn of(levels: &[Judged]) -> Option<Skill> {
        let gaps = || levels.iter().filter_map(|judged| judged.measures.as_ref()?.skill);
        let wins: Vec<f64> = gaps().map(|gap| gap.wins).collect();
        let reward: Vec<f64> = gaps().filter_map(|gap| gap.reward).collect();
        let ladders: Vec<&Ladder> = levels.iter().filter_map(|judged| judged.ladder.as_ref()).collect();
        let order: Vec<f64> = ladders.iter().filter_map(|ladder| order(&ladder.rungs)).collect();
        let mut players: Vec<PlayerRate> = Vec::new();
        for fared in ladders.iter().flat_map(|ladder| ladder.rungs.iter().chain(&ladder.held_out)) {
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
        Some(Skill {
            wins: Estimate::of(&wins)?,
            reward: Estimate::of(&reward),
            order: Estimate::of(&order),
            players,
        })
    }
}

/// The correlation of the place in a ladder with how a player fares there: whoever wins more fares better; of those who win
/// alike, whoever scores more.
fn order(rungs: &[Fared]) -> Option<f64> {
    let fares =
        |fared: &Fared| (fared.rate.wins as f64 / fared.rate.plays.max(1) as f64, fared.rate.mean_score);
    let worse = |fared: &Fared| rungs.iter().filter(|other| fares(other) < fares(fared)).count() as f64;
    let pairs: Vec<(f64, f64)> =
        rungs.iter().enumerate().map(|(at, fared)| (at as f64, worse(fared))).collect();
    statistics::spearman(&pairs)
}

/// What of the rules do they use?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Rules {
    /// Interactions that some witness executes; of those that are not with the edge of the screen.
    pub used: Share,
    /// The share that a witness executes, in the mean over levels; none without witnesses.
    pub each: Option<Estimate>,
    /// Every interaction, in the order of the game file.
    pub lines: Vec<LineUse>,
}

/// An interaction, and how many levels use it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LineUse {
    /// The line, in canonical spelling.
    pub rule: String,
    /// Whether it is with the edge of the screen.
    pub guard: bool,
    /// Levels whose witness executes it; of those with a witness.
    pub levels: Share,
}

impl Rules {
    pub(super) fn of(game: &Game, levels: &[Judged]) -> Rules {
        let measures = || levels.iter().filter_map(|judged| judged.measures.as_ref());
        let each: Vec<f64> = measures().map(|measures| measures.mechanics).collect();
        let line = |line: usize| LineUse {
            rule: Line::interaction(game, line).text,
            guard: is_guard(game, line),
            levels: Share::yes(measures().map(|measures| measures.rules.contains(&line))),
        };
        let lines: Vec<LineUse> = (0..game.description().interactions.len()).map(line).collect();
        let inner = lines.iter().filter(|line| !line.guard);
        Rules { used: Share::yes(inner.map(|line| line.levels.count > 0)), each: Estimate::of(&each), lines }
    }
}
