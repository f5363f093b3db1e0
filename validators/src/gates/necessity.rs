//! The `necessity` gate: checks that a winner's plan depends on each rule and each placed type.

use super::elements::{Element, elements};
use super::{Gates, NO_WIN, WonLevel, finding, without_subject, won_levels};
use crate::allowance::Setting;
use crate::evidence::Evidence;
use crate::measures::{Guards, mechanics};
use crate::validator::{GameCase, GameValidator};
use crate::verdict::{Finding, Verdict};
use agents::Stopped;
use agents::search::{Answer, Pushes, SearchLimits, Searched, a_star, best_first};
use base::Seed;
use engine::{Action, Analysis, Episode, Game, Level, Outcome};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};

/// Passes if at least [`Gates::needed_share`] of the elements matter. Elements are rules, except guards (which only
/// keep sprites on the board), and placed types, except avatars, walls, the background and types that an ending counts.
/// An element matters if, on at least [`Gates::needed_levels`] of the levels on which it occurs, the game without it
/// meets one of the following conditions. The cheapest condition is tested first:
///
/// 1. the shortest known win no longer wins, or wins earlier by [`Gates::plan_change`], so that different actions are
///    needed;
/// 2. at least [`Gates::plan_change`] of the episodes of careless players (which press a random key in some ticks)
///    change between win and loss;
/// 3. a search that foresees the random draws of the win finds a much shorter win. It must be shorter by
///    [`Gates::plan_change`] than both the known win and the win that the search finds with the element.
///
/// If too few elements are shown to matter, the gate fails only if there would be too few even if every element that is
/// not proven idle mattered. Otherwise, the verdict is unknown. On deterministic levels, searches can prove an element
/// idle by proving the shortest wins with and without it.
///
/// Removing a moving type shifts the random draws of a stochastic game, so the known win is not replayed without the
/// type. Costs the replays and the careless players' episodes. For each element that they do not show to matter, also
/// costs a search with [`Gates::needed_calls`] calls on each of the element's levels until the answer is certain.
#[derive(Clone, Debug)]
pub(crate) struct Necessity(Gates);

pub(crate) const QUESTION: &str = "does winning depend on each rule and each placed type?";

pub(crate) fn judge(setting: &Setting<'_>) -> Necessity {
    Necessity(setting.criteria.gates.clone())
}

impl GameValidator for Necessity {
    fn asks_for_usage(&self) -> bool {
        true
    }

    fn validate(&self, case: GameCase<'_>) -> Finding {
        self.validate_until(case, &|| false)
    }

    fn validate_until(&self, case: GameCase<'_>, stopped: Stopped<'_>) -> Finding {
        let Some(wins) = won_levels(case) else { return without_subject(NO_WIN) };
        let gates = &self.0;
        let plays: Vec<&[Episode]> = wins.iter().map(|&won| case.careless.plays(won, gates)).collect();
        let guards = Guards::of(case.analysis);
        let lines = |(won, plays): (&WonLevel<'_>, &&[Episode])| {
            let episodes = plays.iter().chain([won.win]);
            let lines = episodes.flat_map(|episode| mechanics(case.game, &guards, won.level, episode));
            (won.number, lines.collect())
        };
        let executed: Vec<(usize, BTreeSet<usize>)> = wins.iter().zip(&plays).map(lines).collect();
        let subjects: Vec<Subject<'_>> = wins
            .iter()
            .zip(&plays)
            .map(|(&won, plays)| Subject {
                won,
                careless: plays,
                shortest: OnceLock::new(),
                spent: AtomicU64::new(0),
            })
            .collect();
        // Nothing is known about elements that occur only on levels without a known win.
        let is_open = |element: &Element| {
            !element.levels.is_empty() && !wins.iter().any(|won| element.levels.contains(&won.number))
        };
        let mut elements = elements(case, &executed);
        elements.retain(|element| !is_open(element));
        let judge = |element| match stopped() {
            true => (Need::NotShown, String::new()),
            false => self.matters(case, element, &subjects, stopped),
        };
        let matters: Vec<(Need, String)> = elements.par_iter().map(judge).collect();
        let count = |wanted: Need| matters.iter().filter(|(need, _)| *need == wanted).count();
        let (needed, open) = (count(Need::Shown), count(Need::NotShown));
        let share_of = |count: usize| match elements.len() {
            0 => 1.0,
            all => count as f64 / all as f64,
        };
        let share = share_of(needed);
        let idle = elements.iter().zip(&matters).filter(|(_, (need, _))| *need != Need::Shown);
        let idle_types =
            idle.clone().filter(|(element, _)| element.is_type).map(|(element, _)| element.text.clone());
        let idle_types = idle_types.collect();
        let idle: Vec<Evidence> = idle.map(|(element, (_, why))| element.problem(why.clone())).collect();
        let text = format!("{needed} of {} rules and types change how the game is won", elements.len());
        let note = Evidence::new(text);
        let spent = subjects.iter().map(|subject| subject.spent.load(Ordering::Relaxed)).sum();
        let found = if share >= gates.needed_share {
            finding(Vec::new(), [note].into_iter().chain(idle).collect(), Some(share))
        } else if share_of(needed + open) >= gates.needed_share {
            // Elements may matter even if no test shows it.
            let found = Finding::from(Verdict::Unknown { spent }).seen(idle).seen([note]);
            Finding { figure: Some(share), ..found }
        } else {
            finding(idle, vec![note], Some(share))
        };
        Finding { searched: Some(spent), idle_types, ..found }
    }
}

/// The result of testing whether one element (a rule or a type) matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Need {
    /// Tests show that the element matters.
    Shown,
    /// No test shows that the element matters, and the searches were not exhaustive.
    NotShown,
    /// The element is proven not to matter, as defined by the tests.
    Refuted,
}

/// The length of the shortest known win, if any. `sure` is `true` if that win is proven to be the shortest.
#[derive(Clone, Copy)]
struct Shortest {
    ticks: Option<usize>,
    sure: bool,
}

/// A level with its win, and with the episodes that careless players, who press a random key in some ticks, played on
/// it.
struct Subject<'a> {
    won: WonLevel<'a>,
    careless: &'a [Episode],
    /// The number of ticks in the shortest known win with all elements, once it has been searched for.
    shortest: OnceLock<Shortest>,
    /// The number of forward-model calls in searches on the level.
    spent: AtomicU64,
}

impl Necessity {
    /// Returns the answer for an element, and a sentence with the number of levels on which it matters.
    fn matters(
        &self,
        case: GameCase<'_>,
        element: &Element,
        subjects: &[Subject<'_>],
        stopped: Stopped<'_>,
    ) -> (Need, String) {
        let on = subjects.iter().filter(|subject| element.levels.contains(&subject.won.number));
        let on: Vec<&Subject<'_>> = on.collect();
        if on.is_empty() {
            let text =
                format!("no recorded episode contains `{}`, and no test shows that it matters", element.text);
            return (Need::NotShown, text);
        }
        let wanted = ((on.len() as f64 * self.0.needed_levels).ceil() as usize).max(1);
        let shown: Vec<bool> = on.iter().map(|subject| self.shows(element, subject)).collect();
        let mut count = shown.iter().filter(|shown| **shown).count();
        let open: Vec<&Subject<'_>> =
            on.iter().zip(&shown).filter(|(_, shown)| !**shown).map(|(subject, _)| *subject).collect();
        let mut refuted = 0;
        for (tried, subject) in open.iter().enumerate() {
            if count >= wanted || count + (open.len() - tried) < wanted || stopped() {
                break;
            }
            let (hinders, sure) = self.hinders(case, element, subject);
            count += usize::from(hinders);
            refuted += usize::from(!hinders && sure);
        }
        let need = if count >= wanted {
            Need::Shown
        } else if on.len() - refuted < wanted {
            Need::Refuted
        } else {
            Need::NotShown
        };
        let start = match need {
            Need::Refuted => "winning does not depend on",
            _ => "no test shows that winning depends on",
        };
        let (text, all) = (&element.text, on.len());
        (
            need,
            format!("{start} `{text}`: it matters on {count} of {all} levels (at least {wanted} required)"),
        )
    }

    /// Returns `true` if replays show that the element matters on a level.
    fn shows(&self, element: &Element, subject: &Subject<'_>) -> bool {
        let Some(level) = element.level(subject.won.level) else { return true };
        let win = subject.won.win;
        if !element.shifts {
            let (outcome, ticks) = replayed(&element.without, &level, win.seed, &win.actions);
            let early = (win.actions.len() as f64) * (1.0 - self.0.plan_change);
            if outcome != Outcome::Won || (ticks as f64) <= early {
                return true;
            }
        }
        let otherwise = |play: &&Episode| {
            let (outcome, _) = replayed(&element.without, &level, play.seed, &play.actions);
            let decided = |outcome: Outcome| (outcome == Outcome::Won, outcome == Outcome::Lost);
            decided(outcome) != decided(play.outcome)
        };
        let differing = subject.careless.iter().filter(otherwise).count();
        differing as f64 >= self.0.plan_change * subject.careless.len() as f64
    }

    /// Returns two flags. The first is `true` if a search shows that a level can be won much sooner without the
    /// element. The second is `true` if the result is proven.
    fn hinders(&self, case: GameCase<'_>, element: &Element, subject: &Subject<'_>) -> (bool, bool) {
        let WonLevel { level, win, .. } = subject.won;
        let known = win.actions.len();
        let shortest = *subject.shortest.get_or_init(|| {
            let found = self.search(case.analysis, level, subject);
            Shortest { ticks: Some(found.ticks.map_or(known, |ticks| ticks.min(known))), ..found }
        });
        let Some(level) = element.level(level) else { return (true, true) };
        let analysis = Analysis::of(&element.without);
        let found = self.search(&analysis, &level, subject);
        let most = shortest.ticks.unwrap_or(known) as f64 * (1.0 - self.0.plan_change);
        let hinders = found.ticks.is_some_and(|ticks| (ticks as f64) <= most);
        (hinders, found.sure && shortest.sure)
    }

    /// Returns the number of ticks in a win that a search finds with the known win's random draws. Searches
    /// first for the shortest win and then for any win.
    fn search(&self, analysis: &Analysis, level: &Level, subject: &Subject<'_>) -> Shortest {
        let start = analysis.game().start(level, subject.won.win.seed);
        if start.is_over() {
            return Shortest { ticks: None, sure: true };
        }
        let pushes = Pushes::of(analysis, level);
        let limits = SearchLimits { bytes: BYTES, ..SearchLimits::calls(self.0.needed_calls / 2) };
        let won = |searched: Searched| {
            subject.spent.fetch_add(searched.calls, Ordering::Relaxed);
            match searched.answer {
                Answer::Won { actions, shortest } => Shortest { ticks: Some(actions.len()), sure: shortest },
                answer => Shortest { ticks: None, sure: answer == Answer::Impossible },
            }
        };
        let found = won(a_star(analysis, &pushes, &start, limits));
        match found.ticks.is_none() {
            true => won(best_first(analysis, &pushes, &start, limits)),
            false => found,
        }
    }
}

/// The maximum memory of a search, in bytes.
const BYTES: usize = 1 << 27;

/// Returns the outcome of a sequence of actions, and the number of ticks until then.
fn replayed(game: &Game, level: &Level, seed: Seed, actions: &[Action]) -> (Outcome, usize) {
    let mut state = game.start(level, seed);
    for (tick, &action) in actions.iter().enumerate() {
        if state.is_over() {
            return (state.outcome(), tick);
        }
        game.step(&mut state, action);
    }
    (state.outcome(), actions.len())
}

#[cfg(test)]
mod tests {
    use crate::Criterion;
    use crate::gates::tests::judged;
    use crate::{Gates, Verdict};

    const GAME: &str = "BasicGame\n  SpriteSet\n    plum > Immovable\n    bead > Immovable\n    key > Resource limit=2\n    gate > Immovable\n    avatar > MovingAvatar\n  LevelMapping\n    p > plum\n    b > bead\n    k > key\n    g > gate\n  InteractionSet\n    avatar wall > stepBack\n    key avatar > collectResource\n    gate avatar > killIfOtherHasMore resource=key limit=1 subtract=True\n    avatar gate > stepBack\n    bead avatar > killSprite scoreChange=1\n    plum avatar > killSprite scoreChange=1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n    Timeout limit=200 win=False\n";
    const LEVEL: &str = "wwwwwwwww\nwAb   gpw\nw wwwwwww\nw      kw\nwwwwwwwww\n";

    #[test]
    fn a_key_is_needed_and_a_bead_is_not() {
        let all = |gates: &mut Gates| gates.needed_share = 1.0;
        let finding = judged(Criterion::Necessity, GAME, &[LEVEL], all);
        let Verdict::Fail { reason, .. } = &finding.verdict else { panic!("{finding:#?}") };
        assert!(reason.0.starts_with("winning does not depend on `bead avatar > killSprite"), "{reason:?}");
        let plain = GAME.replace("    bead avatar > killSprite scoreChange=1\n", "");
        let plain = plain.replace("    b > bead\n", "").replace("    bead > Immovable\n", "");
        assert_eq!(finding.idle_types, ["bead"]);
        let finding = judged(Criterion::Necessity, &plain, &[&LEVEL.replace('b', " ")], all);
        assert!(finding.verdict.is_pass(), "{finding:#?}");
        assert_eq!((finding.figure, finding.idle_types.len()), (Some(1.0), 0));
    }
}
