//! The final decision on a game: levels for it, its time limit, and the panel.

use super::candidate::{Candidate, MadeGame};
use super::levels::{FoundLevel, LevelSource, Levels};
use super::order::GameOrder;
use crate::tally::Tally;
use base::{Seed, SeedPath};
use engine::{Analysis, Game};
use generators::kernels::{KernelGame, KernelGenome};
use std::collections::BTreeSet;
use validators::measures::Guards;
use validators::novelty::{GameForm, NEAR};
use validators::{CheckedCriteria, Cost, Criterion, CriterionSet, Effort, Panel, ended_share};

/// Makes the final decision on games, with fresh seeds.
pub(super) struct GameGate<'a> {
    order: &'a GameOrder,
    /// The games that others have to differ from.
    known: &'a [GameForm],
    canary: &'a str,
    /// Those of the order, with a margin for what chance has a say in.
    criteria: CheckedCriteria,
    /// All judges.
    panel: Panel,
    /// The cheap judges; the others run last.
    first: Panel,
}

/// The ticks at which games are lost: round numbers, as authors choose them.
const TIME_LIMITS: [u32; 9] = [150, 200, 250, 300, 400, 500, 600, 800, 1000];
/// The least time limit, as a multiple of the longest win that is known of the levels.
const TIME_PER_WIN: f64 = 2.5;

/// The share of careless plays that end by the rules, on average over the levels, for a game to go without a time limit.
const ENDED_PLAYS: f64 = 0.5;
/// The judges, in tallies, of a game that goes without a time limit if it passes so.
const NO_CLOCK: &str = "no time limit";

/// The reason for turning down a game in which too little happens.
const MEAGRE: &str = "meagre";
/// The reason for turning down a game that owes its first judges' verdict to luck.
const SECOND_JUDGES: &str = "second judges";
/// The reason for turning down a game that passes the gates with some dice, and with others does not.
const FURTHER_JUDGES: &str = "further judges";
/// The reason for turning down a game of which a type of another kernel is no part that matters.
const IDLE_GRAFT: &str = "idle graft";
/// The reason for turning down a game that is too much like another.
pub(super) const NEAR_KNOWN: &str = "near to a known game";

impl<'a> GameGate<'a> {
    pub(super) fn new(order: &'a GameOrder, known: &'a [GameForm], canary: &'a str) -> GameGate<'a> {
        let criteria = order.criteria.with_margin();
        let panel = Panel::new(criteria.clone(), Effort::Sequential);
        let cheap = criteria.without(CriterionSet::costing(Cost::Ladder));
        let first = Panel::new(cheap, Effort::Sequential);
        GameGate { order, known, canary, criteria, panel, first }
    }

    /// Finds a course of levels for a game, sets its time limit by the wins found if it needs one, and judges it; `None`, with the reason in
    /// the tally, if anything stands in its way. `number` is told in the card. A game that meets with an objection is refused
    /// before it costs a level.
    pub(super) fn judge(
        &self,
        genome: &KernelGenome,
        number: u32,
        seed: &SeedPath,
        objection: &dyn Fn(&Candidate) -> Option<&'static str>,
        tally: &mut Tally,
    ) -> Option<MadeGame> {
        tally.spend(Tally::of_lost, |tally| {
            let generator = self.order.method.name();
            let build = |genome: &KernelGenome| {
                let KernelGame { game, course } = genome.build().ok()?;
                Some((Candidate::generated(game, generator, number), course))
            };
            let Some((first, course)) = build(genome) else {
                tally.game_rejected("the rules do not compile");
                return None;
            };
            let known = self.is_known(&first).then_some(NEAR_KNOWN);
            if let Some(why) = known.or_else(|| objection(&first)) {
                tally.game_rejected(why);
                return None;
            }
            if interactions(&first.game) < self.order.least_interactions {
                tally.game_rejected(MEAGRE);
                return None;
            }
            let levels = Levels {
                count: self.order.levels,
                tries: self.order.level_tries,
                source: LevelSource::Course(&course),
                criteria: &self.criteria,
                panel: &self.first,
                seed,
            };
            let found = levels.find_each(&first.game, tally)?;
            let longest = found
                .iter()
                .filter_map(|found| found.report.witness.as_ref())
                .map(|win| win.actions.len())
                .max()?;
            if !genome.has_clock() {
                let mut spent = Tally::default();
                let made = build(&genome.timed(None)).and_then(|(candidate, _)| {
                    self.ends(&candidate, &found, seed.seed()).then_some(())?;
                    self.limited(candidate, &levels, &found, &mut spent)
                });
                if made.is_some() {
                    tally.add(&spent);
                    return made;
                }
                tally.judge(NO_CLOCK, false, spent.calls);
            }
            let (candidate, _) = build(&genome.timed(Some(time_limit(longest))))?;
            self.limited(candidate, &levels, &found, tally)
        })
    }

    /// Tests whether careless plays of a game without a time limit come to an end by its rules.
    fn ends(&self, candidate: &Candidate, found: &[FoundLevel], seed: Seed) -> bool {
        let share = |(number, found): (u64, &FoundLevel)| {
            let win = found.report.witness.as_ref()?;
            let seed = seed.child("ends", number);
            Some(ended_share(&candidate.game, &found.level, win, &self.criteria.gates, seed))
        };
        let shares: Option<Vec<f64>> = (0..).zip(found).map(share).collect();
        shares.is_some_and(|shares| shares.iter().sum::<f64>() >= ENDED_PLAYS * shares.len() as f64)
    }

    /// Judges a game with its time limit, or without one, on the levels that were found for it with another.
    fn limited(
        &self,
        candidate: Candidate,
        levels: &Levels<'_>,
        found: &[FoundLevel],
        tally: &mut Tally,
    ) -> Option<MadeGame> {
        let again = found.iter().map(|found| levels.rejudge(&candidate.game, found, tally));
        let Some(found) = again.collect::<Option<Vec<_>>>() else {
            tally.game_rejected("time limit");
            return None;
        };
        if mechanics(&candidate.game, &found) < self.order.least_mechanics {
            tally.game_rejected(MEAGRE);
            return None;
        }
        self.accept(candidate, levels, found, tally)
    }

    /// Judges a game over all its levels, by second judges too, and finishes it.
    fn accept(
        &self,
        candidate: Candidate,
        levels: &Levels<'_>,
        mut found: Vec<FoundLevel>,
        tally: &mut Tally,
    ) -> Option<MadeGame> {
        let (game, seed) = (&candidate.game, levels.seed.seed());
        let judges = seed.child("judges of the game", 0);
        let mut together = levels.judge_together(game, &found, judges, tally);
        let (first, later) = found.split_first()?;
        let later: Vec<(u32, FoundLevel)> = (1..).zip(later.iter().cloned()).collect();
        if together.as_ref().is_err_and(|obstacle| *obstacle == Criterion::Progression)
            && !levels.leaves_something(game, first, &later)
            && let Some(another) = levels.another_introduction(game, first, &later, tally)
        {
            found[0] = another;
            together = levels.judge_together(game, &found, judges, tally);
        }
        let of_ladder = self.criteria.ask.only(CriterionSet::costing(Cost::Ladder));
        if together.is_ok() && !of_ladder.is_empty() {
            found = levels.judge_by_ladder(game, found, tally)?;
            let all = Levels { panel: &self.panel, ..*levels };
            together = all.judge_together(game, &found, judges, tally);
        }
        let together = match together {
            Ok(together) => together,
            Err(obstacle) => {
                tally.game_rejected(obstacle.name());
                return None;
            }
        };
        let mut idle = together.iter().flat_map(|judgement| &judgement.finding.idle_types);
        if let LevelSource::Course(course) = levels.source
            && idle.any(|stype| course.is_grafted(stype))
        {
            tally.game_rejected(IDLE_GRAFT);
            return None;
        }
        let mut spent = Tally::default();
        let holds = levels.confirm(game, &found, seed.child("second judges", 0), &mut spent);
        tally.judge(SECOND_JUDGES, holds, spent.calls);
        if !holds {
            tally.game_rejected(SECOND_JUDGES);
            return None;
        }
        let mut spent = Tally::default();
        let (further, times) = (seed.child("further judges", 0), self.order.effort.judges);
        let holds = levels.confirm_gates(game, &found, further, times, &mut spent);
        tally.judge(FURTHER_JUDGES, holds, spent.calls);
        if !holds {
            tally.game_rejected(FURTHER_JUDGES);
            return None;
        }
        let found = levels.with_rates(game, found, together, tally);
        let made = candidate.finish(found, self.canary);
        if made.is_some() {
            tally.game_accepted();
        }
        made
    }

    fn is_known(&self, candidate: &Candidate) -> bool {
        let form = GameForm::of(&candidate.game);
        form.nearest(self.known).is_some_and(|(_, apart)| apart < NEAR)
    }
}

/// The time limit of a game whose longest known win takes so many ticks. The tick at which the game is lost comes one later, and is round.
fn time_limit(longest: usize) -> u32 {
    let least = longest as f64 * TIME_PER_WIN;
    let round = TIME_LIMITS.into_iter().find(|&limit| f64::from(limit) > least);
    round.unwrap_or_else(|| ((least / 1000.0).floor() as u32 + 1) * 1000) - 1
}

fn interactions(game: &Game) -> usize {
    game.description().interactions.len()
}

/// The interactions that the wins of the levels execute, guards apart.
fn mechanics(game: &Game, levels: &[FoundLevel]) -> usize {
    let guards = Guards::of(&Analysis::of(game));
    levels.iter().flat_map(|found| found.mechanics(game, &guards)).collect::<BTreeSet<usize>>().len()
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::card::Origin;
    use crate::games::make_games;
    use crate::levels::Method;
    use generators::Variation;
    use generators::games::Kind;
    use generators::kernels::KernelVariation;
    use generators::levels::LevelConfig;
    use validators::Criteria;

    /// Two levels, and few and weak players.
    pub(in crate::games) fn order() -> GameOrder {
        let criteria = Criteria {
            ask: CriterionSet::of(&[
                Criterion::WellFormed,
                Criterion::NotIdle,
                Criterion::NotRandom,
                Criterion::Winnable,
                Criterion::Length,
            ]),
            budget: 150_000,
            idle_plays: 4,
            random_plays: 10,
            ..GameOrder::criteria_by_default()
        };
        let order = GameOrder::new(Method::Constructive, 1);
        let criteria = criteria.check().unwrap();
        GameOrder { levels: 2, least_interactions: 4, least_mechanics: 1, criteria, ..order }
    }

    /// The order with other criteria.
    fn altered(order: GameOrder, alter: &dyn Fn(&mut Criteria)) -> GameOrder {
        let mut criteria = (*order.criteria).clone();
        alter(&mut criteria);
        GameOrder { criteria: criteria.check().unwrap(), ..order }
    }

    fn judge(order: &GameOrder, known: &[GameForm], genome: &KernelGenome) -> (Option<MadeGame>, Tally) {
        let mut tally = Tally::default();
        let seed = Seed::from_text("gate");
        let made =
            GameGate::new(order, known, "canary").judge(genome, 0, &seed.into(), &|_| None, &mut tally);
        (made, tally)
    }

    #[test]
    fn a_game_that_fails_at_one_thing_is_refused_by_its_name() {
        let variation = KernelVariation::new(&[Kind::Demolition, Kind::Escape]);
        let seed = Seed::from_text("gate");
        let (genome, made) = (0..20)
            .filter_map(|number| variation.create(seed.child("game", number)))
            .find_map(|genome| {
                Some((judge(&order(), &[], &genome).0?, genome)).map(|(made, genome)| (genome, made))
            })
            .expect("one of them passes");
        assert!(made.levels.len() == 2 && made.witnesses.len() == 2);
        let check = |alter: &dyn Fn(GameOrder) -> GameOrder, known: &[GameForm], reason: &str| {
            let order = alter(order());
            let (made, tally) = judge(&order, known, &genome);
            assert!(made.is_none(), "{reason}");
            assert_eq!((tally.games_tried, tally.games_accepted), (1, 0), "{reason}");
            assert!(tally.rejections.contains_key(reason), "{reason}: {}", tally.reasons());
        };
        let same = |order| order;
        check(&same, &[GameForm::of(&genome_game(&genome))], NEAR_KNOWN);
        check(&same, &[GameForm::of(&made.game)], NEAR_KNOWN);
        let (order, mut tally) = (order(), Tally::default());
        let gate = GameGate::new(&order, &[], "canary");
        let objection = |_: &Candidate| Some("a cast twice");
        assert!(gate.judge(&genome, 0, &Seed::from_text("gate").into(), &objection, &mut tally).is_none());
        assert_eq!((tally.rejections.get("a cast twice"), tally.levels_tried), (Some(&1), 0));
        check(&|order| GameOrder { least_interactions: 100, ..order }, &[], MEAGRE);
        check(&|order| GameOrder { least_mechanics: 100, ..order }, &[], MEAGRE);
        let long = |criteria: &mut Criteria| (criteria.least_ticks, criteria.most_ticks) = (1000, 2000);
        check(&|order| altered(order, &long), &[], Criterion::Length.name());
        check(&|order| altered(order, &ask_for_drama), &[], Criterion::Drama.name());
        check(&|order| GameOrder { level_tries: 0, ..order }, &[], "no level 0");
    }

    #[test]
    fn a_game_has_a_course_and_time_for_it() {
        let order = GameOrder { kinds: vec![Kind::Tending], ..order() };
        let seed = Seed::from_text("course");
        let made = make_games(&order, &[], "canary", seed, &()).unwrap().games.remove(0);
        let Origin::Generated { generator, patterns, .. } = &made.card.origin else {
            panic!("{:?}", made.card.origin)
        };
        assert!(generator == "constructive" && patterns[0].starts_with("kernel/"), "{patterns:?}");
        assert!(made.card.levels.iter().all(|level| level.generator == "course"));
    }

    /// Kernels of this kind leave the time limit to the gate.
    #[test]
    fn a_game_has_a_limit_by_its_wins_unless_it_ends_without() {
        let variation = KernelVariation::new(&[Kind::Tending]);
        let seed = Seed::from_text("limits");
        let genomes = (0..40).filter_map(|number| variation.create(seed.child("game", number)));
        let (mut clocks, mut others) = (0, 0);
        for genome in genomes {
            let Some(made) = judge(&order(), &[], &genome).0 else { continue };
            let limit = made.game.description().terminations.iter().find(|line| line.class.text == "Timeout");
            let wins = made.witnesses.iter().map(|witness| witness.actions.len());
            match limit {
                Some(limit) => {
                    let limit: u32 = limit.params[0].value.text.parse().unwrap();
                    assert_eq!(limit, time_limit(wins.max().unwrap()));
                    clocks += 1;
                }
                None => {
                    assert!(!genome.has_clock());
                    others += 1;
                }
            }
            if clocks > 0 && others > 0 {
                return;
            }
        }
        panic!("{clocks} games with a limit, {others} without");
    }

    #[test]
    fn time_limits_are_round_and_generous() {
        for (longest, expect) in [(25, 149), (59, 149), (60, 199), (99, 249), (159, 399), (500, 1999)] {
            assert_eq!(time_limit(longest), expect, "{longest}");
        }
    }

    #[test]
    fn second_judges_ask_again_what_chance_has_a_say_in() {
        let (made, seed) = made();
        let hold = |alter: &dyn Fn(&mut Criteria)| {
            let order = altered(order(), alter);
            let GameOrder { levels: count, level_tries: tries, criteria, .. } = &order;
            let (config, panel) = (&LevelConfig::default(), &Panel::new(criteria.clone(), Effort::Full));
            let source = LevelSource::Rules(config);
            let levels = Levels { count: *count, tries: *tries, source, criteria, panel, seed: &seed };
            levels.confirm(&made.game, &made.levels, seed.seed().child("second", 0), &mut Tally::default())
        };
        assert!(hold(&|_| {}));
        let unskilled = |criteria: &mut Criteria| {
            criteria.ask = criteria.ask.with(CriterionSet::of(&[Criterion::Skill]));
            criteria.ladder = ["do-nothing", "random"].map(str::to_owned).to_vec();
            criteria.held_out.clear();
            (criteria.skill_wins, criteria.skill_scores) = (1.0, 1.0);
        };
        assert!(!hold(&unskilled), "levels");
        assert!(!hold(&ask_for_drama), "the game");
        assert!(
            hold(&|criteria| (criteria.budget, criteria.least_ticks, criteria.most_ticks) = (1, 1000, 2000)),
            "what is certain"
        );
    }

    /// A game of two levels, and the seed of its judges.
    fn made() -> (MadeGame, SeedPath) {
        let variation = KernelVariation::new(&[Kind::Demolition, Kind::Escape]);
        let seed = Seed::from_text("gate");
        let made = (0..20)
            .filter_map(|number| variation.create(seed.child("game", number)))
            .find_map(|genome| judge(&order(), &[], &genome).0);
        (made.expect("one of them passes"), seed.into())
    }

    #[test]
    fn the_ladder_comes_last_and_misfits_are_replaced() {
        let (made, seed) = made();
        let played = |alter: &dyn Fn(&mut Criteria), tries| {
            let order = altered(order(), &|criteria| {
                criteria.ask = criteria.ask.with(CriterionSet::of(&[Criterion::Skill]));
                alter(criteria);
            });
            let GameOrder { levels: count, criteria, .. } = &order;
            let (config, panel) = (&LevelConfig::default(), &Panel::new(criteria.clone(), Effort::Full));
            let count = *count;
            let source = LevelSource::Rules(config);
            let levels = Levels { count, tries, source, criteria, panel, seed: &seed };
            let mut tally = Tally { levels_accepted: count.into(), ..Tally::default() };
            (levels.judge_by_ladder(&made.game, made.levels.clone(), &mut tally), tally)
        };
        let lax = |criteria: &mut Criteria| {
            criteria.ladder = ["do-nothing", "olets:50"].map(str::to_owned).to_vec();
            criteria.held_out = vec!["olets:100".to_owned()];
            criteria.skill_wins = 0.0;
        };
        let unskilled = |criteria: &mut Criteria| {
            criteria.ladder = ["do-nothing", "random"].map(str::to_owned).to_vec();
            criteria.held_out.clear();
            (criteria.skill_wins, criteria.skill_scores) = (1.0, 1.0);
        };
        let (levels, tally) = played(&lax, 16);
        let levels = levels.unwrap_or_else(|| panic!("{}", tally.reasons()));
        for found in &levels {
            let last = found.report.judgements.last().unwrap();
            assert!(
                last.criterion == Criterion::Skill && last.finding.verdict.is_pass(),
                "{:?}",
                found.report
            );
        }
        let (levels, tally) = played(&unskilled, 0);
        assert!(levels.is_none());
        assert_eq!(tally.reasons(), "1 failed `skill`, 1 without level 1");
    }

    /// More than any game has.
    fn ask_for_drama(criteria: &mut Criteria) {
        criteria.ask = criteria.ask.with(CriterionSet::of(&[Criterion::Drama]));
        criteria.gates.drama = 1.0;
    }

    fn genome_game(genome: &KernelGenome) -> Game {
        genome.build().unwrap().game.rules
    }
}
