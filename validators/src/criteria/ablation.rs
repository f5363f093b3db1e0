//! The `ablation` criterion: disables one rule at a time and checks whether play changes.

use crate::allowance::Setting;
use crate::criteria::with_count;
use crate::evidence::{Evidence, Line};
use crate::measures::comparison::{Comparison, compare};
use crate::recording::{Recorded, Use};
use crate::validator::{GameCase, GameValidator};
use crate::verdict::{Finding, Verdict};
use agents::{Budget, Limits, Mcts, MctsConfig, play};
use base::Seed;
use engine::analysis::{Motion, Role};
use engine::{Action, Analysis, Chance, Episode, Game, Outcome, SpriteRecord, SpriteType, State};
use itertools::Itertools;
use rayon::prelude::*;

/// Passes if every executed interaction matters: an outcome or score changes if its consequences are disabled
/// but its random draws are preserved ([`Game::without`]).
///
/// There are three tests, from cheapest to most expensive. First, recorded episodes that execute the rule are replayed
/// without it. Second, futures from just before the rule's execution are played with and without the rule, with the
/// same seeds. Third, a searching player plays an episode without the rule, and the episode is then replayed with the
/// rule.
///
/// One change suffices for a pass. If no test shows a change, the verdict is unknown. The criterion fails only if a
/// rule is proven superfluous: on every level, all sequences of actions have the same outcome and score without the
/// rule.
///
/// Rules on walls and the screen edge are guards. Guards are reported but never fail, because the sprites
/// that they remove far from the player may never matter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RulesMatter {
    /// The number of forward-model calls per interaction. A proof that an interaction is superfluous may take up to
    /// another quarter of this number.
    calls: u64,
    /// The maximum total number of forward-model calls for all interactions; `None` for no limit. Tests beyond the
    /// limit are skipped.
    total: Option<u64>,
}

/// The number of random futures to play from each execution.
const FUTURES: u64 = 8;
/// The length of each rollout, in ticks.
const DEPTH: usize = 60;
/// The searching player's number of calls per decision.
const DECISION: Budget = Budget(300);
/// The searching player's look-ahead, in ticks.
const LOOK_AHEAD: u32 = 20;
/// The maximum number of ticks per episode of the searching player.
const PLAY: usize = 400;
/// The number by which a rule's calls are divided to get the budget for proving the rule superfluous.
const PROOF: u64 = 4;

/// The result of disabling one interaction.
enum Effect {
    /// Without the interaction, an outcome or a score changes.
    Matters,
    /// No test shows a change in outcome or score. `differs` is `true` if a test shows a difference in the sprites.
    Unshown { differs: bool },
    /// All episodes are proven to have the same outcome and score. Contains the number of states in the
    /// proof.
    Idle(usize),
}

pub(crate) const QUESTION: &str =
    "does each rule matter: without the rule, does some episode end or score differently?";

pub(crate) fn judge(setting: &Setting<'_>) -> RulesMatter {
    RulesMatter { calls: setting.criteria.ablation_calls, total: setting.ablation_calls() }
}

impl GameValidator for RulesMatter {
    fn asks_for_usage(&self) -> bool {
        true
    }

    fn validate(&self, case: GameCase<'_>) -> Finding {
        let lines = case.usage.lines.iter().enumerate().filter(|(_, uses)| !uses.is_empty());
        let lines: Vec<(usize, &Vec<Use>)> = lines.collect();
        let found: Vec<(Effect, u64)> =
            lines.par_iter().map(|(line, uses)| self.try_without(case, *line, uses, lines.len())).collect();
        let spent = found.iter().map(|(_, spent)| spent).sum();
        let (mut idle, mut unshown, mut guards) = (Vec::new(), Vec::new(), Vec::new());
        for ((line, uses), (found, _)) in lines.iter().zip(&found) {
            let rule = Line::interaction(case.game, *line);
            let (text, advice, list) = match found {
                Effect::Matters => continue,
                _ if is_guard(case.analysis, *line) => {
                    let text = format!("no test shows that `{}` matters; the rule may be a guard", rule.text);
                    guards.push(Evidence::new(text).of_rule(rule));
                    continue;
                }
                Effect::Idle(states) => (
                    format!(
                        "`{}` runs, but changes nothing: without the rule, all {states} reachable states \
                         end and score the same",
                        rule.text
                    ),
                    "remove the rule, or make it matter for the score or the outcome",
                    &mut idle,
                ),
                Effect::Unshown { differs } => (
                    match differs {
                        true => format!(
                            "no test shows that `{}` matters: without the rule, the board differs, but no \
                             outcome or score does",
                            rule.text
                        ),
                        false => format!("no test shows that `{}` matters", rule.text),
                    },
                    "these tests are not a proof: play with and without the rule before you remove it",
                    &mut unshown,
                ),
            };
            let first = &uses[0];
            let seen = Evidence { text, tick: Some(first.tick + 1), rule: Some(rule), ..Evidence::default() };
            list.push(seen.advise(swapped(case, *line).unwrap_or_else(|| advice.to_owned())));
        }
        let verdict = match (idle.first(), unshown.is_empty()) {
            (Some(first), _) => Verdict::fail(with_count(&first.text, idle.len() - 1)),
            (None, false) => Verdict::Unknown { spent },
            (None, true) => Verdict::pass(),
        };
        Finding::from(verdict).seen(idle).seen(unshown).seen(guards)
    }
}

impl RulesMatter {
    /// Tests one rule. `lines` is the number of rules to test.
    fn try_without(&self, case: GameCase<'_>, line: usize, uses: &[Use], lines: usize) -> (Effect, u64) {
        let without = case.game.without(line);
        let share = self.total.map(|total| total / lines.max(1) as u64);
        let most = share.map_or(self.calls, |share| share.min(self.calls));
        let is_spent = |calls: u64| share.is_some() && calls >= most;
        let (mut calls, mut cut) = (0, false);
        let of = |at: &Use| (case.recording[at.level], &case.recording[at.level].episodes[at.episode]);
        for at in uses {
            let (recorded, episode) = of(at);
            cut |= is_spent(calls);
            if cut {
                break;
            }
            calls += episode.actions.len() as u64;
            if result_of(&without, recorded, episode.seed, &episode.actions)
                != (episode.outcome, episode.score)
            {
                return (Effect::Matters, calls);
            }
        }
        let mut differs = false;
        for (number, at) in uses.iter().enumerate() {
            let (recorded, episode) = of(at);
            cut |= is_spent(calls);
            if cut {
                break;
            }
            let seed = case.seed.child("line", line as u64).child("future", number as u64);
            let futures = Futures { with: case.game, without: &without, recorded, episode, tick: at.tick };
            let (matters, state, spent) = futures.compare(seed);
            calls += spent;
            differs |= state;
            if matters {
                return (Effect::Matters, calls);
            }
            // Half of the calls are reserved for the searching player.
            if calls >= most / 2 {
                break;
            }
        }
        let levels = uses.iter().map(|at| at.level).sorted_unstable().dedup().collect_vec();
        for (number, level) in levels.into_iter().enumerate() {
            if calls >= most {
                break;
            }
            let recorded = case.recording[level];
            let seed = case.seed.child("line", line as u64).child("play", number as u64);
            let mut planner = Mcts::new(MctsConfig::bold(LOOK_AHEAD), seed.child("planner", 0));
            let limits = Limits { ticks: PLAY, calls: most - calls };
            let played =
                play(&without, recorded.level, &mut planner, DECISION, seed.child("chance", 0), limits);
            calls += played.calls;
            let Episode { seed, actions, outcome, score, .. } = &played.episode;
            if result_of(case.game, recorded, *seed, actions) != (*outcome, *score) {
                return (Effect::Matters, calls);
            }
        }
        if differs {
            return (Effect::Unshown { differs }, calls);
        }
        let (found, spent) = self.prove(case, &without, most / PROOF);
        (found, calls + spent)
    }

    /// Compares play with and without the rule in all reachable states of every level, with at most `most` calls.
    fn prove(&self, case: GameCase<'_>, without: &Game, most: u64) -> (Effect, u64) {
        let unknown = Effect::Unshown { differs: false };
        let (mut pairs, mut calls) = (0, 0);
        let without = Analysis::of(without);
        for (number, recorded) in (0..).zip(case.recording) {
            let seed = case.seed.child("proof", number);
            let left = most.saturating_sub(calls);
            let (found, spent) = compare([case.analysis, &without], recorded.level, seed, left);
            calls += spent;
            match found {
                Comparison::Differs => return (Effect::Matters, calls),
                Comparison::Open => return (unknown, calls),
                Comparison::Equal(states) => pairs += states,
            }
        }
        (Effect::Idle(pairs), calls)
    }
}

/// Returns advice for a rule that moves sprites back, if these sprites never move and their partner in the
/// rule is the avatar.
fn swapped(case: GameCase<'_>, line: usize) -> Option<String> {
    let GameCase { game, analysis, .. } = case;
    let written = &game.description().interactions[line];
    let encounter = analysis.encounters().iter().find(|encounter| encounter.line == line)?;
    let family =
        |written: SpriteType| game.sprite_types().filter(move |&stype| analysis.applies(written, stype));
    let is_avatar = |stype: SpriteType| analysis.role(stype) == Role::Avatar;
    let stands = |stype: SpriteType| analysis.facts(stype).motion == Motion::Still && !is_avatar(stype);
    let is_swapped = encounter.blocks()
        && family(encounter.first).all(stands)
        && encounter.second.is_some_and(|second| family(second).any(is_avatar));
    let [second] = &written.second[..] else { return None };
    let (first, second) = (&written.first.text, &second.text);
    is_swapped.then(|| {
        format!("`{first}` never moves by itself; did you mean `{second} {first} > {}`?", written.effect.text)
    })
}

/// Returns `true` if a rule only keeps sprites on the board, because all of its partners are walls or the screen edge.
pub(crate) fn is_guard(analysis: &Analysis, line: usize) -> bool {
    let game = analysis.game();
    let is_wall = |written: SpriteType| {
        let mut family = game.sprite_types().filter(|&stype| analysis.applies(written, stype));
        family.all(|stype| !analysis.facts(stype).possible || analysis.role(stype) == Role::Wall)
    };
    let mut of_line = analysis.encounters().iter().filter(|encounter| encounter.line == line).peekable();
    of_line.peek().is_some() && of_line.all(|encounter| encounter.second.is_none_or(is_wall))
}

/// Returns the outcome and score of an episode with the given actions.
fn result_of(game: &Game, recorded: Recorded<'_>, seed: Seed, actions: &[Action]) -> (Outcome, f64) {
    let mut state = game.start(recorded.level, seed);
    for &action in actions {
        game.step(&mut state, action);
    }
    (state.outcome(), state.score())
}

/// The futures of an episode from just before a rule's first execution. They are played with and without the
/// rule, both with held keys and with random keys.
struct Futures<'a> {
    with: &'a Game,
    without: &'a Game,
    recorded: Recorded<'a>,
    episode: &'a Episode,
    tick: usize,
}

impl Futures<'_> {
    /// Returns two flags and the number of calls. The first flag is `true` if a future ends differently without the
    /// rule. The second is `true` if the board ever looks different.
    fn compare(&self, seed: Seed) -> (bool, bool, u64) {
        // A state contains predictions for its own game, so each of the two games replays the prefix to obtain its own
        // state.
        let before = [self.with, self.without].map(|game| {
            let mut state = game.start(self.recorded.level, self.episode.seed);
            self.episode.actions[..self.tick].iter().for_each(|&action| {
                game.step(&mut state, action);
            });
            state
        });
        let mut calls = 2 * self.tick as u64;
        let mut scratch = before.clone();
        let mut differs = false;
        for &action in &self.episode.actions[self.tick..] {
            let [with, without] = &mut scratch;
            self.with.step(with, action);
            self.without.step(without, action);
            calls += 2;
            if self.observable(with) != self.observable(without) {
                differs = true;
                break;
            }
        }
        // Holding a key, or no key, shows the effect of the rule on an avatar that keeps moving or waits.
        let held = self.held_keys(&before[0]);
        for number in 0..FUTURES + held.len() as u64 {
            let key = held.get(number as usize).copied();
            let number = number.saturating_sub(held.len() as u64);
            let mut choices = seed.child("keys", number).sampler();
            let chance = Chance::from_java(choices.bits() as i64);
            for (scratch, before) in scratch.iter_mut().zip(&before) {
                scratch.fork_from(before, chance);
            }
            let [with, without] = &mut scratch;
            for ahead in 0..DEPTH {
                let action = match (ahead, key) {
                    (0, _) => self.episode.actions[self.tick],
                    (_, Some(key)) => key,
                    (_, None) => *choices.choose(self.with.actions(with)),
                };
                self.with.step(with, action);
                self.without.step(without, action);
                calls += 2;
                if result(with) != result(without) {
                    return (true, true, calls);
                }
                if with.is_over() {
                    break;
                }
            }
        }
        (false, differs, calls)
    }

    /// Returns the keys to hold: no key, and each key that the avatar can use.
    fn held_keys(&self, state: &State) -> Vec<Action> {
        let keys = self.with.actions(state).iter().copied().filter(|&key| key != Action::Nil);
        [Action::Nil].into_iter().chain(keys).collect()
    }

    /// Returns the observable state, without the rules' internal memory.
    fn observable(&self, state: &State) -> (Vec<SpriteRecord>, Vec<i32>, (Outcome, f64)) {
        (self.with.records(state), state.counters().to_vec(), result(state))
    }
}

fn result(state: &State) -> (Outcome, f64) {
    (state.outcome(), state.score())
}

#[cfg(test)]
mod tests {
    use crate::{Criteria, Criterion, CriterionSet, Effort, Finding, Judging, Panel, Verdict};
    use base::Seed;
    use engine::Game;

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    fern > Immovable\n    mud > Immovable\n    dew > Resource limit=2\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    f > fern\n    m > mud\n  InteractionSet\n    avatar wall > stepBack\n    plum avatar > killSprite scoreChange=1\n    avatar fern > killIfHasMore resource=dew limit=2\n    mud avatar > transformTo stype=fern\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    Timeout limit=40 win=False\n";

    fn findings(source: &str) -> [Finding; 2] {
        let game = Game::from_source(source).unwrap();
        let level = game.level("wwwwww\nwAfmpw\nwwwwww\n").unwrap();
        let criteria = Criteria {
            ask: CriterionSet::of(&[
                Criterion::NotRandom,
                Criterion::Winnable,
                Criterion::RuleUse,
                Criterion::Ablation,
            ]),
            budget: 20_000,
            ..Criteria::full()
        };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::game(&game, &[level], Seed::from_text("ablation")));
        report
            .judgements
            .into_iter()
            .map(|judgement| judgement.finding)
            .collect::<Vec<_>>()
            .try_into()
            .unwrap()
    }

    #[test]
    fn ineffective_rules_are_idle_and_visible_differences_are_unknown() {
        let [used, matter] = findings(GAME);
        // The level lacks the dew that would give the rule an effect.
        let Verdict::Fail { reason, .. } = &used.verdict else { panic!("{used:?}") };
        assert_eq!(reason.0, "`dew` never appears");
        let Verdict::Fail { reason, .. } = &matter.verdict else { panic!("{matter:?}") };
        let proved = "`avatar fern > killIfHasMore resource=dew limit=2` runs, but changes nothing: \
                      without the rule, all 6 reachable states";
        assert!(reason.0.starts_with(proved), "{reason:?}");
        let texts: Vec<&str> = matter.evidence.iter().map(|seen| seen.text.as_str()).collect();
        assert!(texts[1].starts_with("no test shows that `mud avatar > transformTo"), "{texts:?}");
    }

    #[test]
    fn what_no_test_shows_is_unknown_where_nothing_is_proved() {
        let wild = GAME
            .replace("    avatar > Mov", "    bug > RandomNPC\n    avatar > Mov")
            .replace("    m > mud", "    m > mud\n    b > bug")
            .replace("    dew > Resource limit=2\n", "")
            .replace(
                "    avatar fern > killIfHasMore resource=dew limit=2\n",
                "    fern avatar > stepBack\n    bug wall > stepBack\n",
            );
        let game = Game::from_source(&wild).unwrap();
        let level = game.level("wwwwwwww\nwAfmpwbw\nwwwwwwww\n").unwrap();
        let criteria = Criteria {
            ask: CriterionSet::of(&[Criterion::NotRandom, Criterion::Winnable, Criterion::Ablation]),
            budget: 20_000,
            ablation_calls: 5_000,
            ..Criteria::full()
        };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::game(&game, &[level], Seed::from_text("ablation")));
        let finding = &report.judgements[0].finding;
        assert!(matches!(finding.verdict, Verdict::Unknown { .. }), "{finding:?}");
        assert_eq!(finding.evidence[0].text, "no test shows that `fern avatar > stepBack` matters");
        let advice: Vec<&str> = finding.evidence.iter().filter_map(|seen| seen.advice.as_deref()).collect();
        assert_eq!(advice[0], "`fern` never moves by itself; did you mean `avatar fern > stepBack`?");
        assert!(advice[1].starts_with("these tests are not a proof"), "{advice:?}");
    }

    /// A boat carries the avatar. Without the rule, a player that waits on the boat drowns, but players that hurry do
    /// not.
    #[test]
    fn a_carrier_matters_to_an_avatar_that_waits() {
        let source = "BasicGame\n  SpriteSet\n    wall > Immovable\n    pond > Immovable\n    raft > Missile orientation=RIGHT speed=0.2\n    nest > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    ~ > pond\n    r > pond raft\n    n > nest\n  InteractionSet\n    avatar wall > stepBack\n    avatar EOS > stepBack\n    raft EOS > wrapAround\n    avatar raft > shieldFrom stype=pond ftype=killSprite\n    avatar raft > pullWithIt\n    avatar pond > killSprite\n    nest avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=nest win=True\n    SpriteCounter stype=avatar win=False\n    Timeout limit=150 win=False\n";
        let level = "wwwwwwwwwwwwww\nw           nw\n~r~~~r~~~r~~r~\nw            w\nw A          w\nwwwwwwwwwwwwww\n";
        let game = Game::from_source(source).unwrap();
        let level = game.level(level).unwrap();
        let criteria = Criteria { budget: 100_000, ladder_calls: 100_000, ..Criteria::full() };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::game(&game, &[level], Seed::from_text("ablation")));
        let matter =
            report.judgements.iter().find(|judgement| judgement.criterion == Criterion::Ablation).unwrap();
        assert!(matter.finding.verdict.is_pass(), "{matter:?}");
    }

    #[test]
    fn rules_that_end_or_score_matter() {
        let deadly = GAME
            .replace("avatar fern > killIfHasMore resource=dew limit=2", "avatar fern > killSprite")
            .replace("    Timeout", "    SpriteCounter stype=avatar win=False\n    Timeout");
        let game = Game::from_source(&deadly).unwrap();
        let level = game.level("wwwwwww\nwA m pw\nw  f  w\nwwwwwww\n").unwrap();
        let criteria = Criteria { budget: 20_000, ladder_calls: 20_000, ..Criteria::full() };
        let panel = Panel::new(criteria.check().unwrap(), Effort::Full);
        let report = panel.judge(Judging::game(&game, &[level], Seed::from_text("ablation")));
        let matter = &report.judgements[1].finding;
        assert!(matter.verdict.is_pass(), "{matter:?}");
    }
}
