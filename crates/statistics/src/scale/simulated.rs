//! Simulated months under the model of the scale. All true values are known, so the simulations can measure the size
//! of errors and the coverage of intervals. `cargo xtask simulate` prints tables, and the tests of this crate run
//! small simulations.

use super::ability::{MismatchPrior, PlayedGame, PlayedLevel};
use super::calibration::{Calibration, Difficulties, Month, side};
use super::logistic::logistic;
use super::plays::{Dimension, Examinee, GamePlays, Plays};
use super::spreads::Spreads;
use crate::planning::draws::Draws;

/// The size of a simulated month, and its players.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The number of games.
    pub games: usize,
    /// The number of levels per game.
    pub levels: usize,
    /// The number of planners in each family.
    pub families: Vec<usize>,
    /// The number of episodes per planner and level.
    pub runs: u32,
    /// The number of readers (players that see only prompts) that play the month.
    pub anchors: usize,
    /// The number of episodes per reader (a player that sees only prompts) and level.
    pub anchor_runs: u32,
    /// The number of bootstrap replicates used to correct the bias of the spreads (standard deviations).
    pub replicates: u64,
    /// The model's true standard deviations and slopes.
    pub spreads: Spreads,
}

/// A simulated month, with its true values.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatedMonth {
    /// The results of the examinees (reference players), by game.
    pub plays: Vec<GamePlays>,
    /// The true difficulties for planners and for readers (players that see only prompts), indexed by game and level.
    pub difficulties: [Vec<Vec<f64>>; 2],
    /// The planners' true mean logit on all levels.
    pub ease: f64,
}

impl SimulatedMonth {
    /// Returns the true mean difficulty of the month's levels.
    pub fn mean(&self, dimension: Dimension) -> f64 {
        let games = &self.difficulties[side(dimension)];
        let count = games.iter().map(Vec::len).sum::<usize>() as f64;
        games.iter().flatten().sum::<f64>() / count
    }
}

/// A random sequence of months, determined by its seed.
pub struct Simulator {
    draws: Draws,
    plan: Plan,
    /// The examinees (reference players) who play the months.
    pub examinees: Vec<Examinee>,
    /// The true abilities of the examinees (reference players).
    pub abilities: Vec<f64>,
}

impl Simulator {
    /// Creates a simulator. The planners range from weak to strong. The readers (players that see only prompts) are
    /// weaker on average.
    pub fn new(plan: Plan, seed: u64) -> Simulator {
        let mut examinees = Vec::new();
        let mut abilities = Vec::new();
        let planners: usize = plan.families.iter().sum();
        for (family, &members) in plan.families.iter().enumerate() {
            for _ in 0..members {
                let place = examinees.len() as f64 / (planners.max(2) - 1) as f64;
                examinees.push(Examinee { dimension: Dimension::Planner, family });
                abilities.push(-1.5 + 3.5 * place);
            }
        }
        for anchor in 0..plan.anchors {
            examinees.push(Examinee { dimension: Dimension::Reader, family: 0 });
            abilities.push(-1.5 + anchor as f64 * 0.75);
        }
        Simulator { draws: Draws::new(seed), plan, examinees, abilities }
    }

    /// Draws a month. For planners, the month is harder than the mean of all games by `shift` logits. For readers
    /// (players that see only prompts), it is harder than the shift implies by `drift` logits.
    pub fn month(&mut self, shift: f64, drift: f64) -> SimulatedMonth {
        let Plan { games, levels, spreads, .. } = self.plan.clone();
        let planners = self.plan.families.iter().sum::<usize>();
        let (mut plays, mut difficulties, mut ease) = (Vec::new(), [Vec::new(), Vec::new()], 0.0);
        for _ in 0..games {
            let (game, rest) = (spreads.game * self.draws.normal(), spreads.game_rest * self.draws.normal());
            let pairs: Vec<[f64; 2]> = (0..levels)
                .map(|_| {
                    let (level, own) =
                        (spreads.level * self.draws.normal(), spreads.level_rest * self.draws.normal());
                    let readers = spreads.game_slope * (shift + game)
                        + spreads.level_slope * level
                        + rest
                        + own
                        + drift;
                    [shift + game + level, readers]
                })
                .collect();
            let families: Vec<f64> =
                self.plan.families.clone().iter().map(|_| spreads.family * self.draws.normal()).collect();
            let mut found = GamePlays { levels, plays: Vec::new() };
            for (at, examinee) in self.examinees.clone().iter().enumerate() {
                let (match_, of) = match examinee.dimension {
                    Dimension::Planner => {
                        (families[examinee.family] + spreads.planner * self.draws.normal(), self.plan.runs)
                    }
                    Dimension::Reader => (spreads.reader * self.draws.normal(), self.plan.anchor_runs),
                };
                for (level, pair) in pairs.iter().enumerate() {
                    let logit = self.abilities[at] - pair[side(examinee.dimension)] + match_;
                    if examinee.dimension == Dimension::Planner {
                        ease += logit / (games * levels * planners) as f64;
                    }
                    if of > 0 {
                        let won = self.wins(logit, of);
                        found.plays.push(Plays { examinee: at, level, won, of: f64::from(of) });
                    }
                }
            }
            plays.push(found);
            for (side, of) in difficulties.iter_mut().enumerate() {
                of.push(pairs.iter().map(|pair| pair[side]).collect());
            }
        }
        SimulatedMonth { plays, difficulties, ease }
    }

    /// Draws a player's results on the levels of a month. Each level is played once, and the episodes are spread over
    /// as many games as possible. `month` is the calibrated month.
    pub fn person(
        &mut self,
        truth: &SimulatedMonth,
        month: &Month,
        dimension: Dimension,
        AbilityCase { ability, mismatch, episodes }: AbilityCase,
    ) -> Vec<PlayedGame> {
        let side = side(dimension);
        let of_game = |this: &mut Simulator, game: usize| {
            let match_ = mismatch * this.draws.normal();
            let known: &Difficulties = &month.games[game].difficulties[side];
            let share = this.plan.games.min(episodes).max(1);
            let count = (episodes / share + usize::from(game < episodes % share)).min(this.plan.levels);
            let levels = (0..count).filter(|_| game < share).map(|level| PlayedLevel {
                difficulty: known.levels[level].value,
                own: known.own(level),
                won: this.wins(ability - truth.difficulties[side][game][level] + match_, 1),
                of: 1.0,
            });
            PlayedGame { common: known.common, levels: levels.collect() }
        };
        (0..self.plan.games).map(|game| of_game(self, game)).collect()
    }

    fn wins(&mut self, logit: f64, of: u32) -> f64 {
        self.draws.successes(logistic(logit), u64::from(of)) as f64
    }
}

/// A simulated player, and the number of episodes that it plays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbilityCase {
    /// The player's true ability.
    pub ability: f64,
    /// The standard deviation of the player's match effects, which state how well each game suits the player.
    pub mismatch: f64,
    /// The number of episodes that the player plays.
    pub episodes: usize,
}

/// The errors of a month's position on the scale (its *link* to the first month). Each pair contains the difference
/// between the estimate and the true value, and the stated error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkTrial {
    /// The error for exactly the planners in the calibration.
    pub to_these: (f64, f64),
    /// The error for arbitrary planners.
    pub to_any: (f64, f64),
    /// The error of the month's difficulties for readers, which are players that see only prompts.
    pub to_readers: (f64, f64),
    /// The error of the drift (the additional difficulty for readers, which see only prompts), estimated from the
    /// month's readers. Without readers, the pair is (0, ∞).
    pub drift: (f64, f64),
    /// The estimated spreads (standard deviations).
    pub spreads: Spreads,
}

/// A simulation result, which compares an estimated ability with the true ability.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AbilityTrial {
    /// The estimated ability minus the true ability.
    pub off: f64,
    /// The stated standard error.
    pub error: f64,
    /// `true` if the 95% interval of the estimate contains the true ability.
    pub is_covered: bool,
}

/// Two months on one scale: the first is calibrated, and the second is added to the scale.
struct Linked {
    simulator: Simulator,
    first: SimulatedMonth,
    second: SimulatedMonth,
    calibration: Calibration,
    /// The second month, after calibration.
    month: Month,
}

impl Linked {
    /// Draws and calibrates two months. The second month is harder by `shift` logits and has the drift `drift`.
    /// Returns `None` if a month cannot be calibrated.
    fn new(plan: &Plan, shift: f64, drift: f64, seed: u64) -> Option<Linked> {
        let mut simulator = Simulator::new(plan.clone(), seed);
        let (first, second) = (simulator.month(0.0, 0.0), simulator.month(shift, drift));
        let (mut calibration, _) = Calibration::new(&simulator.examinees, &first.plays)?;
        if plan.replicates > 0 {
            let replicate = |number| calibration.replicate(&first.plays, number);
            let replicates: Vec<Spreads> = (0..plan.replicates).filter_map(replicate).collect();
            let spreads = calibration.corrected(&replicates);
            (calibration, _) = Calibration::with_spreads(&simulator.examinees, &first.plays, spreads)?;
        }
        let month = calibration.add(&second.plays)?;
        Some(Linked { simulator, first, second, calibration, month })
    }

    /// Draws a player's results on the second month.
    fn person(&mut self, dimension: Dimension, case: AbilityCase) -> Vec<PlayedGame> {
        self.simulator.person(&self.second, &self.month, dimension, case)
    }

    /// Estimates an ability from results on the second month, and compares the estimate with the true ability; `None`
    /// if there are no episodes.
    fn trial(&self, games: &[PlayedGame], dimension: Dimension, ability: f64) -> Option<AbilityTrial> {
        let truth = ability - self.first.mean(dimension);
        let found = super::ability(games, MismatchPrior::default(), self.month.link[side(dimension)])?;
        Some(AbilityTrial {
            off: found.value - truth,
            error: found.error,
            is_covered: found.interval.low <= truth && truth <= found.interval.high,
        })
    }
}

/// Calibrates a first month, and adds a second month that is harder by `shift` logits and has the drift `drift`.
/// Returns `None` if a month cannot be calibrated.
pub fn link_trial(plan: &Plan, shift: f64, drift: f64, seed: u64) -> Option<LinkTrial> {
    let Linked { first, second, calibration, month, .. } = Linked::new(plan, shift, drift, seed)?;
    let apart = |dimension: Dimension| second.mean(dimension) - first.mean(dimension);
    let off = |found: super::Estimated, truth: f64| (found.value - truth, found.error);
    Some(LinkTrial {
        to_these: off(month.planners_shift, first.ease - second.ease),
        to_any: off(month.shifts[0], apart(Dimension::Planner)),
        to_readers: off(month.shifts[1], apart(Dimension::Reader)),
        drift: month.drift.map_or((0.0, f64::INFINITY), |found| (found.value, found.error)),
        spreads: calibration.spreads,
    })
}

/// Calibrates two months, and simulates `persons` players per case on the second month. Returns the results by case;
/// `None` if a month cannot be calibrated or an ability cannot be estimated.
pub fn ability_trials(
    plan: &Plan,
    dimension: Dimension,
    cases: &[AbilityCase],
    persons: usize,
    seed: u64,
) -> Option<Vec<Vec<AbilityTrial>>> {
    let mut months = Linked::new(plan, 0.0, 0.0, seed)?;
    let mut trial = |case: AbilityCase| {
        let games = months.person(dimension, case);
        months.trial(&games, dimension, case.ability)
    };
    cases.iter().map(|case| (0..persons).map(|_| trial(*case)).collect()).collect()
}

/// A player's ability, estimated by two designs from the same outcomes.
#[derive(Clone, Debug, PartialEq)]
pub struct AdaptiveTrial {
    /// The result with one episode per level, with episodes spread over as many games as possible.
    pub spread: AbilityTrial,
    /// The results after each of the given numbers of adaptively chosen episodes.
    pub adaptive: Vec<AbilityTrial>,
}

/// Calibrates two months, and simulates players with each ability and mismatch on the second month. Returns the results
/// by case; `None` if a month cannot be calibrated or an ability cannot be estimated.
///
/// The first design spreads `episodes` episodes over the games. The second design chooses episodes
/// adaptively, and yields a result for each number in `counts`. The numbers must be in ascending order.
pub fn adaptive_trials(
    plan: &Plan,
    cases: &[(f64, f64)],
    (episodes, counts): (usize, &[usize]),
    persons: usize,
    seed: u64,
) -> Option<Vec<Vec<AdaptiveTrial>>> {
    let mut months = Linked::new(plan, 0.0, 0.0, seed)?;
    let all = plan.games * plan.levels;
    let mut one = |(ability, mismatch): (f64, f64)| {
        // All levels are played, and each design uses the results on the levels that it chooses.
        let played = months.person(Dimension::Planner, AbilityCase { ability, mismatch, episodes: all });
        let trial = |games: &[PlayedGame]| months.trial(games, Dimension::Planner, ability);
        let mut spread = played.clone();
        for (game, of) in spread.iter_mut().enumerate() {
            of.levels.truncate(episodes / plan.games + usize::from(game < episodes % plan.games));
        }
        let mut selection = super::Selection::new(&played, MismatchPrior::default().median, 1);
        let mut chosen = played.clone();
        chosen.iter_mut().for_each(|game| game.levels.clear());
        let (mut adaptive, mut count) = (Vec::new(), 0);
        for &next in counts {
            while count < next.min(all) {
                let one = selection.choose()?;
                let level = played[one.game].levels[one.level];
                selection.record(one.game, one.level, level.won > 0.0);
                chosen[one.game].levels.push(level);
                count += 1;
            }
            adaptive.push(trial(&chosen)?);
        }
        Some(AdaptiveTrial { spread: trial(&spread)?, adaptive })
    };
    cases.iter().map(|case| (0..persons).map(|_| one(*case)).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(families: usize, anchors: usize) -> Plan {
        let spreads = Spreads { game: 1.6, level: 1.6, family: 1.5, ..Spreads::default() };
        let families = vec![1; families];
        Plan { games: 24, levels: 3, families, runs: 4, anchors, anchor_runs: 2, replicates: 0, spreads }
    }

    /// When small monthly releases are placed on a common scale, the stated errors of their shifts match the true
    /// errors. A shift for exactly the planners in the calibration has a smaller error than a shift for any planner.
    #[test]
    fn links_are_as_exact_as_stated() {
        let trials: Vec<LinkTrial> =
            (0..12).map(|seed| link_trial(&plan(5, 0), 0.4, 0.0, seed).unwrap()).collect();
        let mean_square = |of: fn(&LinkTrial) -> f64| {
            trials.iter().map(|trial| of(trial) * of(trial)).sum::<f64>() / trials.len() as f64
        };
        let these = mean_square(|trial| trial.to_these.0 / trial.to_these.1);
        let any = mean_square(|trial| trial.to_any.0 / trial.to_any.1);
        assert!((0.3..2.5).contains(&these) && (0.3..2.5).contains(&any), "{these}, {any}");
        assert!(trials.iter().all(|trial| trial.to_these.1 < trial.to_any.1), "{trials:?}");
    }

    #[test]
    fn spreads_are_found() {
        let found = link_trial(&Plan { games: 60, ..plan(5, 0) }, 0.0, 0.0, 7).unwrap().spreads;
        assert!((1.2..2.0).contains(&found.game) && (1.3..1.9).contains(&found.level), "{found:?}");
        let match_ = (found.family * found.family + found.planner * found.planner).sqrt();
        assert!((1.3..1.9).contains(&match_), "{found:?}");
    }

    #[test]
    fn abilities_are_covered() {
        let case = AbilityCase { ability: 0.3, mismatch: 1.0, episodes: 60 };
        let trials = ability_trials(&plan(5, 0), Dimension::Planner, &[case], 40, 3).unwrap().remove(0);
        let covered = trials.iter().filter(|trial| trial.is_covered).count();
        assert!(covered >= 33, "{covered} of 40");
        assert!(trials.iter().all(|trial| (0.2..0.8).contains(&trial.error)), "{trials:?}");
    }

    /// For players far from the mean difficulty, 65% of the episodes suffice if levels are chosen adaptively.
    #[test]
    fn adaptive_choices_save_episodes() {
        let trials = adaptive_trials(&plan(5, 0), &[(-3.0, 1.0)], (40, &[26]), 24, 3).unwrap().remove(0);
        let sum = |of: fn(&AdaptiveTrial) -> f64| trials.iter().map(of).sum::<f64>();
        let (spread, adaptive) = (sum(|trial| trial.spread.error), sum(|trial| trial.adaptive[0].error));
        assert!(adaptive <= spread, "{adaptive}, {spread}");
        let covered = trials.iter().filter(|trial| trial.adaptive[0].is_covered).count();
        assert!(covered >= 20, "{covered} of 24");
    }

    #[test]
    fn anchors_see_a_drift() {
        let found = link_trial(&plan(4, 2), 0.3, 2.0, 5).unwrap().drift;
        assert!(found.0 > 2.0 * found.1 && (found.0 - 2.0).abs() < 3.0 * found.1, "{found:?}");
        let found = link_trial(&plan(4, 2), 0.3, 0.0, 5).unwrap().drift;
        assert!(found.0.abs() < 2.0 * found.1, "{found:?}");
    }

    /// The estimated shift for a much harder month is not biased towards the middle.
    #[test]
    fn large_shifts_have_no_bias() {
        let plan = Plan { games: 60, ..plan(6, 0) };
        let off = (0..6).map(|seed| link_trial(&plan, 1.5, 0.0, seed).unwrap().to_these.0);
        let mean = off.sum::<f64>() / 6.0;
        assert!(mean.abs() < 0.1, "{mean}");
    }

    /// If all episodes are lost, or all are won, the calibration reflects the priors instead of failing.
    #[test]
    fn one_sided_months_are_calibrated() {
        for all in [false, true] {
            let mut simulator = Simulator::new(Plan { games: 3, runs: 1, ..plan(9, 1) }, 2);
            let mut plays = simulator.month(0.0, 0.0).plays;
            for one in plays.iter_mut().flat_map(|game| &mut game.plays) {
                one.won = if all { one.of } else { 0.0 };
            }
            let (found, _) = Calibration::new(&simulator.examinees, &plays).unwrap();
            assert!(found.abilities.iter().all(|ability| (*ability > 0.0) == all));
            assert!(found.add(&plays).is_some() && found.replicate(&plays, 1).is_some());
        }
    }

    /// The results are bit-identical on every machine.
    #[test]
    fn golden_bits() {
        let found = link_trial(&Plan { games: 6, ..plan(3, 1) }, 0.0, 0.0, 1).unwrap();
        assert_eq!(
            found.to_these.0.to_bits(),
            GOLDEN,
            "{:#x} {}",
            found.to_these.0.to_bits(),
            found.to_these.0
        );
    }

    const GOLDEN: u64 = 0x3fd0_2f2a_4aa5_3d18;
}
