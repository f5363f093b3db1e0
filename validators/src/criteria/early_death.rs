//! The `early-death` criterion: checks that the player can survive the first ticks.

use crate::allowance::Setting;
use crate::case::Case;
use crate::evidence::Evidence;
use crate::explain::ending::Ending;
use crate::validator::Validator;
use crate::verdict::{Finding, Verdict};
use base::{Seed, SeedPath};
use engine::{Action, Episode, Outcome, State};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// Passes if the player can survive the first ticks.
///
/// On a deterministic level, all action sequences are searched tick by tick, counting equivalent states once. If no
/// state survives, death is proven to be unavoidable. In a stochastic game, the search is repeated for several known
/// seeds. If even a player who knows the random draws dies, death is unavoidable. The finding also reports if doing
/// nothing is deadly, but this is not a failure.
#[derive(Clone, Copy, Debug)]
pub struct NoEarlyDeath {
    /// The number of ticks to survive.
    pub ticks: usize,
    /// The number of forward-model calls per seed.
    pub calls: u64,
    /// The number of random seeds in a stochastic game.
    pub seeds: u32,
    /// The maximum fraction of seeds for which death may be unavoidable.
    pub share: f64,
}

/// The maximum number of states to expand per tick. If there are more, a failure becomes unknown.
const MAX_STATES: usize = 2000;
/// The number of random episodes to try before a search.
const RANDOM_PLAYS: u64 = 24;

/// The result of the search with one random seed.
struct Survival {
    /// `true` if a sequence of actions survived.
    survived: bool,
    /// `true` if all sequences of actions were searched.
    complete: bool,
    /// The longest episode found. `idle` is the episode in which the player never acts.
    longest: Episode,
    idle: Episode,
    calls: u64,
}

pub(crate) const QUESTION: &str = "can the player survive the first ticks?";

pub(crate) fn judge(setting: &Setting<'_>) -> NoEarlyDeath {
    let criteria = setting.criteria;
    NoEarlyDeath {
        ticks: criteria.early_ticks,
        calls: setting.early_calls(),
        seeds: criteria.early_seeds,
        share: criteria.early_deaths,
    }
}

impl Validator for NoEarlyDeath {
    fn validate(&self, case: Case<'_>) -> Finding {
        let is_certain = case.analysis.is_deterministic_in(case.level);
        let seeds = if is_certain { 1 } else { u64::from(self.seeds.max(1)) };
        let results: Vec<Survival> = (0..seeds)
            .into_par_iter()
            .map(|run| self.survival(case, &case.seed.child("chance", run)))
            .collect();
        let doomed = results.iter().filter(|result| !result.survived && result.complete).count() as u64;
        let open = results.iter().filter(|result| !result.survived && !result.complete).count() as u64;
        let spent: u64 = results.iter().map(|result| result.calls).sum();
        let share = |count: u64| count as f64 / seeds as f64;
        let verdict = if share(doomed) > self.share {
            let shown = results.iter().filter(|result| !result.survived && result.complete);
            let longest =
                shown.max_by_key(|result| result.longest.actions.len()).expect("at least one seed is doomed");
            let reason = self.failure_reason(longest.longest.actions.len(), doomed, seeds);
            Verdict::fail_with(reason, longest.longest.clone())
        } else if share(doomed + open) > self.share {
            Verdict::Unknown { spent }
        } else {
            Verdict::pass()
        };
        let mut evidence = Vec::new();
        if let Verdict::Fail { witness: Some(witness), .. } = &verdict {
            let ending = Ending::of(case.analysis, case.level, witness);
            evidence.extend(ending.evidence(case.game));
            if let Some(last) = evidence.last_mut() {
                last.advice = Some("give the player room and time at the start".to_owned());
            }
        } else if let Some(note) = self.idle_note(case, &results) {
            evidence.push(note);
        }
        if seeds > 1 && verdict.is_pass() {
            let survived = results.iter().filter(|result| result.survived).count();
            evidence.push(Evidence::new(format!(
                "some sequence of actions survives the first {} ticks with {survived} of {seeds} random seeds",
                self.ticks
            )));
        }
        Finding::from(verdict).seen(evidence).played(results.into_iter().map(|result| result.longest))
    }
}

impl NoEarlyDeath {
    fn failure_reason(&self, ticks: usize, doomed: u64, seeds: u64) -> String {
        if seeds == 1 {
            return format!(
                "every sequence of actions loses within {}: all sequences were searched",
                base::count(ticks, "tick")
            );
        }
        let interval = statistics::wilson(doomed, seeds, statistics::Z95);
        let (low, high) = (100.0 * interval.low, 100.0 * interval.high);
        format!(
            "with {doomed} of {seeds} random seeds, no sequence of actions survives the first {} ticks (95%: \
             {low:.0} to {high:.0}%)",
            self.ticks
        )
    }

    /// Returns a note if doing nothing is deadly although survival is possible.
    fn idle_note(&self, case: Case<'_>, results: &[Survival]) -> Option<Evidence> {
        let dead: Vec<&Episode> =
            results.iter().map(|result| &result.idle).filter(|idle| idle.outcome == Outcome::Lost).collect();
        let first = dead.iter().min_by_key(|idle| idle.actions.len())?;
        let ticks = first.actions.len();
        let of = if results.len() == 1 {
            String::new()
        } else {
            format!(", with {} of {} random seeds", dead.len(), results.len())
        };
        let text = format!("doing nothing loses in tick {ticks}{of}; other actions survive");
        let ending = Ending::of(case.analysis, case.level, first).evidence(case.game);
        let cause = ending.into_iter().next().unwrap_or_default();
        Some(Evidence { text, board: None, ..cause })
    }

    /// Searches for a way to survive with one seed. Tries doing nothing, then random actions, and finally an exhaustive
    /// search.
    fn survival(&self, case: Case<'_>, seed: &SeedPath) -> Survival {
        let idle = self.play_start(case, seed, |_| Action::Nil);
        let mut calls = idle.actions.len() as u64;
        let mut longest = idle.clone();
        let survives = |episode: &Episode| !matches!(episode.outcome, Outcome::Lost | Outcome::Stopped(_));
        for number in 0..RANDOM_PLAYS {
            if survives(&longest) {
                break;
            }
            let mut sampler = seed.seed().child("keys", number).sampler();
            let tried = self.play_start(case, seed, |state| *sampler.choose(case.game.actions(state)));
            calls += tried.actions.len() as u64;
            if survives(&tried) || tried.actions.len() > longest.actions.len() {
                longest = tried;
            }
        }
        if survives(&longest) {
            return Survival { survived: true, complete: true, longest, idle, calls };
        }
        let (found, complete, spent) = self.search(case, seed.seed());
        let mut actions = found.iter();
        let found = self.play_start(case, seed, |_| actions.next().copied().unwrap_or(Action::Nil));
        let survived = survives(&found);
        if survived || found.actions.len() >= longest.actions.len() {
            longest = found;
        }
        Survival { survived, complete, longest, idle, calls: calls + spent }
    }

    /// Plays the first [`NoEarlyDeath::ticks`] ticks with the actions that `choose` selects.
    fn play_start(
        &self,
        case: Case<'_>,
        seed: &SeedPath,
        mut choose: impl FnMut(&State) -> Action,
    ) -> Episode {
        let (mut episode, mut state) = Episode::begin(case.game, case.level, seed);
        while !state.is_over() && episode.actions.len() < self.ticks {
            let action = choose(&state);
            episode.play(case.game, &mut state, action);
        }
        episode
    }

    /// Searches all action sequences, tick by tick, until one survives. Returns the longest sequence, `true`
    /// if all sequences were tried, and the number of calls.
    fn search(&self, case: Case<'_>, seed: Seed) -> (Vec<Action>, bool, u64) {
        let game = case.game;
        let mut layer = vec![(game.start(case.level, seed), Vec::new())];
        let (mut longest, mut complete, mut calls) = (Vec::new(), true, 0);
        for _ in 0..self.ticks {
            let mut next = Vec::new();
            let mut seen = BTreeSet::new();
            for (state, path) in &layer {
                let actions = game.actions(state);
                let idle = (!actions.contains(&Action::Nil)).then_some(&Action::Nil);
                for &action in actions.iter().chain(idle) {
                    if calls >= self.calls {
                        return (longest, false, calls);
                    }
                    let mut after = state.clone();
                    let outcome = game.step(&mut after, action);
                    calls += 1;
                    let mut path: Vec<Action> = path.clone();
                    path.push(action);
                    match outcome {
                        Outcome::Won | Outcome::Ended => return (path, true, calls),
                        Outcome::Lost | Outcome::Stopped(_) => {
                            if path.len() > longest.len() {
                                longest = path;
                            }
                        }
                        Outcome::Ongoing if !seen.insert(after.search_key(game)) => {}
                        Outcome::Ongoing if next.len() >= MAX_STATES => complete = false,
                        Outcome::Ongoing => next.push((after, path)),
                    }
                }
            }
            layer = next;
        }
        match layer.into_iter().next() {
            Some((_, path)) => (path, true, calls),
            None => (longest, complete, calls),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::{Analysis, Game};

    const GAME: &str = "BasicGame\n  SpriteSet\n    den > Door\n    rock > Missile orientation=LEFT speed=1\n    wolf > RandomNPC speed=1\n    avatar > MovingAvatar\n  LevelMapping\n    d > den\n    r > rock\n    o > wolf\n  InteractionSet\n    avatar wall > stepBack\n    wolf wall > stepBack\n    avatar rock wolf > killSprite\n    den avatar > killSprite\n  TerminationSet\n    SpriteCounter stype=den win=True\n    SpriteCounter stype=avatar win=False\n";

    #[track_caller]
    fn check(game: &str, level: &str, calls: u64) -> Finding {
        let game = Game::from_source(game).unwrap();
        let level = game.level(level).unwrap();
        let (analysis, seed) = (Analysis::of(&game), Seed::from_text("early").into());
        let case = Case { game: &game, level: &level, seed: &seed, analysis: &analysis, witness: None };
        let finding = NoEarlyDeath { ticks: 12, calls, seeds: 10, share: 0.05 }.validate(case);
        if let Verdict::Fail { witness: Some(witness), .. } = &finding.verdict {
            assert_eq!(witness.replay(&game, &level).unwrap().outcome(), Outcome::Lost);
        }
        finding
    }

    /// Returns the deterministic game without wolves.
    fn calm() -> String {
        GAME.replace("    wolf > RandomNPC speed=1\n", "")
            .replace("    o > wolf\n", "")
            .replace("    wolf wall > stepBack\n", "")
            .replace("rock wolf", "rock")
    }

    #[test]
    fn unavoidable_death_differs_from_idle_death() {
        let doomed = check(&calm(), "wwwwwwww\nwA  rr d\nwwwwwwww\n", 10_000);
        let Verdict::Fail { reason, .. } = &doomed.verdict else { panic!("{doomed:?}") };
        assert!(reason.0.contains("within 4 ticks: all sequences were searched"), "{reason:?}");
        assert_eq!(doomed.evidence[0].rule.as_ref().unwrap().text, "avatar rock > killSprite");
        let alive = check(&calm(), "wwwwwwww\nwA  rr d\nw      w\nwwwwwwww\n", 10_000);
        assert!(alive.verdict.is_pass());
        assert!(alive.evidence[0].text.starts_with("doing nothing loses in tick 4"), "{:?}", alive.evidence);
    }

    #[test]
    fn an_incomplete_search_is_unknown() {
        let found = check(&calm(), "wwwwwwww\nwA  rr d\nwwwwwwww\n", 2);
        assert!(matches!(found.verdict, Verdict::Unknown { spent: 2.. }), "{found:?}");
    }

    #[test]
    fn random_seeds_are_counted() {
        let doomed = check(GAME, "wwwwwd\nwAooow\nwwwwww\n", 10_000);
        let Verdict::Fail { reason, .. } = &doomed.verdict else { panic!("{doomed:?}") };
        assert!(reason.0.contains("of 10 random seeds"), "{reason:?}");
        assert!(check(GAME, "A       d\n         \n        o\n", 10_000).verdict.is_pass());
    }
}
