//! A game as it passes through the stages of the pipeline.

use super::sources::Rules;
use super::stage::{Refusal, Stage, walk};
use crate::games::{Candidate, FoundLevel, GameOrder, Levels, MadeGame};
use crate::levels::Method;
use crate::tally::Tally;
use base::SeedPath;
use validators::novelty::GameForm;
use validators::{CheckedCriteria, Cost, CriterionSet, Effort, Judgement, Panel};

/// A game and the stages' findings.
pub(crate) struct Trial<'a> {
    pub(super) candidate: Candidate,
    /// The request for the game's levels, including the judges that run first.
    pub(super) levels: Levels<'a>,
    pub(super) demands: Demands<'a>,
    pub(super) found: Vec<FoundLevel>,
    /// The findings about the levels as a whole.
    pub(super) together: Vec<Judgement>,
    pub(super) made: Option<MadeGame>,
}

/// The requirements for generated rules, in addition to the criteria, and facts about the rules.
#[derive(Clone, Copy)]
pub(crate) struct Demands<'a> {
    /// The known games from which new games must differ.
    pub(super) known: &'a [GameForm],
    /// Returns the reason why a set rejects a game regardless of its levels, if there is one.
    pub(super) objection: &'a dyn Fn(&Candidate) -> Option<&'static str>,
    pub(super) least_interactions: usize,
    pub(super) least_mechanics: usize,
    /// `true` if the rules need a time limit.
    pub(super) has_clock: bool,
    /// Returns the same game with a different time limit, or without one.
    pub(super) with_limit: &'a dyn Fn(Option<u32>) -> Option<Candidate>,
    /// The judges of all criteria.
    pub(super) panel: &'a Panel,
    pub(super) further_judges: u64,
    pub(super) canary: &'a str,
}

impl<'a> Trial<'a> {
    pub(super) fn new(candidate: Candidate, levels: Levels<'a>, demands: Demands<'a>) -> Trial<'a> {
        Trial { candidate, levels, demands, found: Vec::new(), together: Vec::new(), made: None }
    }

    /// Takes the game through the stages. If a stage rejects the game, counts the reason in `tally` and returns `None`.
    pub(super) fn pass(mut self, stages: &[Stage<Self>], tally: &mut Tally) -> Option<MadeGame> {
        match walk(stages, &mut self, tally) {
            Ok(()) => tally.game_accepted(),
            Err(Refusal::Because(why)) => tally.game_rejected(&why),
            Err(Refusal::Counted) => {}
        }
        self.made
    }
}

impl Levels<'_> {
    /// Builds a game from known rules by finding levels that meet the criteria, both individually and together. If a
    /// stage rejects the game, counts the reason in `tally` and returns `None`.
    pub fn make(&self, candidate: Candidate, tally: &mut Tally) -> Option<MadeGame> {
        let demands = Demands {
            known: &[],
            objection: &|_| None,
            least_interactions: 0,
            least_mechanics: 0,
            has_clock: true,
            with_limit: &|_| None,
            panel: self.panel,
            further_judges: 0,
            canary: "",
        };
        let trial = Trial::new(candidate, *self, demands);
        tally.spend(Tally::of_lost, |tally| trial.pass(&Trial::KNOWN_RULES, tally))
    }
}

/// The final decision on games, made with fresh seeds.
pub(crate) struct GameGate<'a> {
    order: &'a GameOrder,
    /// The method recorded on cards.
    method: Method,
    /// The known games from which new games must differ.
    known: &'a [GameForm],
    canary: &'a str,
    /// The order's criteria, with a margin for verdicts that depend on randomness.
    criteria: CheckedCriteria,
    /// The judges of all criteria.
    panel: Panel,
    /// The cheap judges, which run before the more expensive ones.
    cheap: Panel,
}

impl<'a> GameGate<'a> {
    pub(crate) fn new(
        order: &'a GameOrder,
        method: Method,
        known: &'a [GameForm],
        canary: &'a str,
    ) -> GameGate<'a> {
        let criteria = order.criteria.with_margin();
        let panel = Panel::new(criteria.clone(), Effort::Sequential);
        let cheap = criteria.without(CriterionSet::costing(Cost::Ladder));
        let cheap = Panel::new(cheap, Effort::Sequential);
        GameGate { order, method, known, canary, criteria, panel, cheap }
    }

    /// Takes a game through the stages. If a stage rejects the game, counts the reason in `tally` and returns `None`.
    /// `number` is recorded on the card.
    pub(crate) fn judge<R: Rules>(
        &self,
        rules: &R,
        number: u32,
        seed: &SeedPath,
        objection: &dyn Fn(&Candidate) -> Option<&'static str>,
        tally: &mut Tally,
    ) -> Option<MadeGame> {
        let order = self.order;
        let build = |rules: &R| {
            let (game, boards) = rules.build()?;
            Some((Candidate::generated(game, self.method.name(), number), boards))
        };
        let Some((candidate, boards)) = build(rules) else {
            tally.game_rejected("the rules do not compile");
            return None;
        };
        let levels = Levels {
            count: order.levels,
            tries: order.level_tries,
            source: &boards,
            criteria: &self.criteria,
            panel: &self.cheap,
            seed,
        };
        let demands = Demands {
            known: self.known,
            objection,
            least_interactions: order.least_interactions,
            least_mechanics: order.least_mechanics,
            has_clock: rules.has_clock(),
            with_limit: &|limit| Some(build(&rules.timed(limit))?.0),
            panel: &self.panel,
            further_judges: order.effort.judges,
            canary: self.canary,
        };
        let trial = Trial::new(candidate, levels, demands);
        tally.spend(Tally::of_lost, |tally| trial.pass(&Trial::GENERATED, tally))
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::super::clock::time_limit;
    use super::super::rules::{MEAGRE, NEAR_KNOWN};
    use super::*;
    use crate::card::Origin;
    use crate::games::make_games;
    use base::Seed;
    use engine::{Analysis, Game};
    use generators::games::Kind;
    use generators::kernels::KernelGenome;
    use generators::levels::LevelConfig;
    use validators::{Criteria, Criterion};

    /// Returns an order for games with two levels, judged with few and weak players.
    pub(crate) fn order() -> GameOrder {
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
        let order = GameOrder::new(1);
        let criteria = criteria.check().unwrap();
        GameOrder { levels: 2, least_interactions: 4, least_mechanics: 1, criteria, ..order }
    }

    /// Returns the order with modified criteria.
    fn altered(order: GameOrder, alter: &dyn Fn(&mut Criteria)) -> GameOrder {
        let mut criteria = (*order.criteria).clone();
        alter(&mut criteria);
        GameOrder { criteria: criteria.check().unwrap(), ..order }
    }

    /// Returns games whose rules compile.
    fn drawn(kinds: &[Kind], seed: &str) -> impl Iterator<Item = KernelGenome> {
        let seed = Seed::from_text(seed);
        let all = (0..).map(move |number| KernelGenome::draw(kinds, seed.child("game", number)).unwrap());
        all.filter(|genome| genome.build().is_ok())
    }

    fn judge(order: &GameOrder, known: &[GameForm], genome: &KernelGenome) -> (Option<MadeGame>, Tally) {
        let mut tally = Tally::default();
        let seed = Seed::from_text("gate");
        let gate = GameGate::new(order, Method::Constructive, known, "canary");
        let made = gate.judge(genome, 0, &seed.into(), &|_| None, &mut tally);
        (made, tally)
    }

    #[test]
    fn a_game_that_fails_at_one_thing_is_refused_by_its_name() {
        let (genome, made) = drawn(&[Kind::Demolition, Kind::Escape], "gate")
            .take(20)
            .find_map(|genome| {
                Some((judge(&order(), &[], &genome).0?, genome)).map(|(made, genome)| (genome, made))
            })
            .expect("a candidate passes");
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
        let gate = GameGate::new(&order, Method::Constructive, &[], "canary");
        let objection = |_: &Candidate| Some("duplicate cast");
        assert!(gate.judge(&genome, 0, &Seed::from_text("gate").into(), &objection, &mut tally).is_none());
        assert_eq!((tally.rejections.get("duplicate cast"), tally.levels_tried), (Some(&1), 0));
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

    /// For kernels of this kind, the gate determines the time limit.
    #[test]
    fn a_game_has_a_limit_by_its_wins_unless_it_ends_without() {
        let (mut clocks, mut others) = (0, 0);
        for genome in drawn(&[Kind::Tending], "limits").take(40) {
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
    fn second_judges_ask_again_what_chance_has_a_say_in() {
        let (made, seed) = made();
        let hold = |alter: &dyn Fn(&mut Criteria)| {
            let order = altered(order(), alter);
            let GameOrder { levels: count, level_tries: tries, criteria, .. } = &order;
            let (config, panel) = (&LevelConfig::default(), &Panel::new(criteria.clone(), Effort::Full));
            let source = config;
            let levels = Levels { count: *count, tries: *tries, source, criteria, panel, seed: &seed };
            levels.passes_with(
                &made.game,
                &made.levels,
                seed.seed().child("second", 0),
                &mut Tally::default(),
            )
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

    /// Returns a stochastic game with two levels, and its judges' seed.
    fn made() -> (MadeGame, SeedPath) {
        // In deterministic games, a player that knows the win counts as a skilled player.
        let has_chance = |made: &MadeGame| {
            let analysis = Analysis::of(&made.game);
            made.levels.iter().all(|found| !analysis.is_deterministic_in(&found.level))
        };
        let made = drawn(Kind::ALL, "gate")
            .take(60)
            .filter(|genome| Analysis::of(&genome_game(genome)).is_stochastic())
            .filter_map(|genome| judge(&order(), &[], &genome).0)
            .find(has_chance);
        (made.expect("a candidate passes"), Seed::from_text("gate").into())
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
            let levels = Levels { count, tries, source: config, criteria, panel, seed: &seed };
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
        let levels = levels.unwrap_or_else(|refusal| panic!("{refusal:?}: {}", tally.reasons()));
        for found in &levels {
            let last = found.report.judgements.last().unwrap();
            assert!(
                last.criterion == Criterion::Skill && last.finding.verdict.is_pass(),
                "{:?}",
                found.report
            );
        }
        let (levels, tally) = played(&unskilled, 0);
        assert!(matches!(levels, Err(Refusal::Because(why)) if why == "no level 1"));
        assert_eq!(tally.reasons(), "1 failed `skill`");
    }

    /// Requires more drama than any game can have.
    fn ask_for_drama(criteria: &mut Criteria) {
        criteria.ask = criteria.ask.with(CriterionSet::of(&[Criterion::Drama]));
        criteria.gates.drama = 1.0;
    }

    fn genome_game(genome: &KernelGenome) -> Game {
        genome.build().unwrap().game.rules
    }
}
