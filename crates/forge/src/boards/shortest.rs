//! Layered breadth-first search for a shortest win, with layers that narrow as the calls run out.

use engine::analysis::{Goal, StateAbstraction};
use engine::{Action, Analysis, Outcome, SearchKey, State};
use std::collections::BTreeMap;
use std::mem;

/// The minimum number of states in a narrowed layer.
const LEAST_WIDTH: u64 = 40;
/// The maximum number of spare states. They take some tens of megabytes.
const MAX_SPARE: usize = 4096;

/// The limits of a search for a shortest win.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    /// The maximum number of forward-model calls.
    pub(super) calls: u64,
    /// The maximum number of ticks of a win.
    pub(super) ticks: usize,
}

/// The result of a search for a shortest win.
#[derive(Clone, Debug)]
pub(super) struct Found {
    /// The actions of the win found; `None` if no win was found.
    pub(super) win: Option<Vec<Action>>,
    /// `true` if the result is proved: either the win found is the shortest, or no win exists within the maximum
    /// number of ticks.
    pub(super) is_proved: bool,
    pub(super) calls: u64,
    /// The minimum number of sprites that must still be removed or created for a win, over all states found.
    pub(super) missing: u32,
}

/// The keys of the visited states.
#[expect(clippy::disallowed_types, reason = "the map is used for look-ups and never iterated")]
type Met = std::collections::HashSet<SearchKey>;

/// Searches for a shortest win layer by layer. Once half of the calls are spent, keeps only the most promising states
/// per layer, spread over the avatar's positions. In a stochastic game, the search considers only the start state's own
/// random future and ignores the random-number stream when it compares states. Such a search proves nothing.
pub(super) fn shortest_win(analysis: &Analysis, start: &State, limits: Limits) -> Found {
    let is_certain = analysis.is_deterministic_from(start);
    let abstraction = analysis.abstraction(start).without_chance();
    let goals: Vec<&Goal> = analysis.goals().iter().filter(|goal| goal.win).collect();
    let mut search = Search {
        analysis,
        abstraction,
        goals,
        steps: vec![(0, Action::Nil)],
        met: Met::default(),
        spare: Vec::new(),
        found: Found { win: None, is_proved: false, calls: 0, missing: u32::MAX },
        limits,
    };
    search.met.insert(search.abstraction.key(analysis, start));
    let (mut layer, mut is_whole) = (vec![(0, start.clone())], true);
    for tick in 0..limits.ticks {
        let Some(next) = search.expand(&layer) else {
            search.found.is_proved = is_whole && is_certain && search.found.win.is_some();
            return search.found;
        };
        search.recycle(layer.into_iter().map(|(_, state)| state));
        layer = next;
        if layer.is_empty() {
            break;
        }
        let width = search.width(limits.ticks - tick);
        if layer.len() as u64 > width {
            is_whole = false;
            layer = search.narrowed(layer, width as usize);
        }
    }
    search.found.is_proved = is_whole && is_certain;
    search.found
}

struct Search<'a> {
    analysis: &'a Analysis,
    abstraction: StateAbstraction,
    goals: Vec<&'a Goal>,
    /// For each node, the parent and the action that leads from the parent to the node.
    steps: Vec<(u32, Action)>,
    met: Met,
    /// The states of expanded layers, kept to reuse their buffers.
    spare: Vec<State>,
    found: Found,
    limits: Limits,
}

impl Search<'_> {
    /// Returns the next layer of states; `None` after a win, or when the calls are spent.
    fn expand(&mut self, layer: &[(u32, State)]) -> Option<Vec<(u32, State)>> {
        let game = self.analysis.game();
        let mut next: Vec<(u32, State)> = Vec::new();
        let mut child = layer.first()?.1.clone();
        for (node, parent) in layer {
            let keys = game.actions(parent).iter().filter(|&&action| action != Action::Nil);
            for &action in [Action::Nil].iter().chain(keys) {
                if self.found.calls >= self.limits.calls {
                    return None;
                }
                child.clone_from(parent);
                let outcome = game.step(&mut child, action);
                self.found.calls += 1;
                if outcome == Outcome::Won {
                    self.found.missing = 0;
                    self.found.win = Some(self.way(*node, action));
                    return None;
                }
                if outcome != Outcome::Ongoing
                    || !self.met.insert(self.abstraction.key(self.analysis, &child))
                {
                    continue;
                }
                self.steps.push((*node, action));
                self.found.missing = self.found.missing.min(self.missing(&child));
                let spare = self.spare.pop().unwrap_or_else(|| parent.clone());
                next.push(((self.steps.len() - 1) as u32, mem::replace(&mut child, spare)));
            }
        }
        Some(next)
    }

    /// Keeps a bounded number of states whose buffers can be used again.
    fn recycle(&mut self, states: impl Iterator<Item = State>) {
        let room = MAX_SPARE.saturating_sub(self.spare.len());
        self.spare.extend(states.take(room));
    }

    fn missing(&self, state: &State) -> u32 {
        self.goals.iter().map(|goal| self.analysis.missing(goal, state)).min().unwrap_or(u32::MAX)
    }

    /// Returns the maximum number of states in a layer if `ticks` ticks remain.
    fn width(&self, ticks: usize) -> u64 {
        let left = self.limits.calls.saturating_sub(self.found.calls);
        if left > self.limits.calls / 2 {
            return u64::MAX;
        }
        (left / (6 * ticks.max(1) as u64)).max(LEAST_WIDTH)
    }

    /// Returns the most promising states of a layer. States with the fewest missing sprites come first, and the
    /// avatar's positions alternate.
    fn narrowed(&mut self, layer: Vec<(u32, State)>, width: usize) -> Vec<(u32, State)> {
        let mut turns: BTreeMap<(u32, Option<(i32, i32)>), u32> = BTreeMap::new();
        let mut ranked: Vec<(u32, usize)> = Vec::with_capacity(layer.len());
        for (at, (_, state)) in layer.iter().enumerate() {
            let missing = self.missing(state);
            let turn = turns.entry((missing, state.avatar_place())).or_default();
            ranked.push((missing.saturating_mul(3).saturating_add(*turn), at));
            *turn += 1;
        }
        ranked.sort_unstable();
        let mut keep = vec![false; layer.len()];
        ranked.iter().take(width).for_each(|&(_, at)| keep[at] = true);
        let (kept, left): (Vec<_>, Vec<_>) = layer.into_iter().zip(keep).partition(|(_, keep)| *keep);
        self.recycle(left.into_iter().map(|((_, state), _)| state));
        kept.into_iter().map(|(state, _)| state).collect()
    }

    /// Returns the actions that lead to a node, followed by a final action.
    fn way(&self, mut node: u32, last: Action) -> Vec<Action> {
        let mut actions = vec![last];
        while node != 0 {
            let (parent, action) = self.steps[node as usize];
            actions.push(action);
            node = parent;
        }
        actions.reverse();
        actions
    }
}
