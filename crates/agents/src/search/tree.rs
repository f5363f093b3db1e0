//! The tree shared by the systematic searches: the states found so far, the actions that led to them, and the
//! generation of their successors.

use super::memory::Lease;
use super::{Answer, Pushes, SearchLimits, Searched};
use crate::guides::progress::Progress;
use crate::play::Stopped;
use arrayvec::ArrayVec;
use engine::analysis::{Analysis, StateAbstraction};
use engine::{Action, Outcome, Packed, SearchKey, State};
use std::hash::{BuildHasherDefault, Hasher};
use std::rc::Rc;

/// A node's index in the tree.
pub(super) type NodeId = u32;
/// The initial state's node.
const ROOT: NodeId = 0;

/// A node: the step that led to a state.
#[derive(Clone, Copy)]
struct Node {
    parent: NodeId,
    depth: u32,
    action: Action,
    expanded: bool,
}

/// A hasher that returns its input, because the keys are already hashes.
#[derive(Default)]
struct KeyHasher(u64);

impl Hasher for KeyHasher {
    fn finish(&self) -> u64 {
        self.0
    }

    fn write(&mut self, bytes: &[u8]) {
        for (at, byte) in bytes.iter().enumerate() {
            self.0 ^= u64::from(*byte) << (at % 8 * 8);
        }
    }

    fn write_u128(&mut self, key: u128) {
        self.0 = key as u64;
    }
}

/// The node for each state found so far.
#[expect(clippy::disallowed_types, reason = "the map is used for look-ups and never iterated")]
type Met = std::collections::HashMap<SearchKey, NodeId, BuildHasherDefault<KeyHasher>>;

/// The maximum number of steps to replay in order to restore a state. It is chosen so that replaying is rarely more
/// expensive than storing the whole state.
const MAX_REPLAYED: usize = 7;

/// An open state, stored as a packed earlier state and the few actions that lead from there to the open state.
pub(super) struct StoredState {
    whole: Rc<Packed>,
    steps: ArrayVec<Action, MAX_REPLAYED>,
}

/// The open states of a search, in order of expansion.
pub(super) trait Frontier {
    /// `true` if this order guarantees that the first win found is the shortest one.
    const SHORTEST: bool;

    /// Adds a state. `depth` is the number of ticks to reach the state, and `least` is a lower bound on the pushes
    /// that the state needs.
    fn push(&mut self, state: &State, node: NodeId, depth: u32, least: u32, kept: StoredState);

    fn pop(&mut self) -> Option<(NodeId, StoredState)>;
}

/// A search tree.
pub(super) struct Tree<'a> {
    analysis: &'a Analysis,
    pub(super) abstraction: StateAbstraction,
    pushes: &'a Pushes,
    progress: Progress<'a>,
    /// The node closest to a win, with its distance.
    nearest: (u32, NodeId),
    /// The state against which packed states are stored as differences.
    base: State,
    nodes: Vec<Node>,
    met: Met,
    actions: Vec<Action>,
    limits: SearchLimits,
    calls: u64,
    /// The total size in bytes of the packed states in memory.
    packed: usize,
    /// The reservation of memory for the search.
    lease: Lease,
    /// Buffers for a state and its successor.
    buffers: Option<(State, State)>,
    /// A function that returns `true` once the result is no longer needed.
    stopped: Stopped<'a>,
}

/// The number of calls between two checks of [`Tree::stopped`].
const STOP_STRIDE: u64 = 256;

/// The result of an expansion.
enum Expanded {
    /// The search continues. The new successors were passed to the frontier.
    On,
    /// A successor wins.
    Won(NodeId),
    /// The call budget is spent.
    OutOfCalls,
    /// The memory limit was reached.
    OutOfMemory,
}

impl<'a> Tree<'a> {
    pub(super) fn new(
        analysis: &'a Analysis,
        pushes: &'a Pushes,
        start: &State,
        limits: SearchLimits,
    ) -> Tree<'a> {
        let game = analysis.game();
        let abstraction = analysis.abstraction(start);
        // Waiting and the actions of every avatar type are included, whichever avatar the level starts with.
        let mut actions = vec![Action::Nil];
        for stype in game.sprite_types() {
            actions.extend(game.actions_of(stype));
        }
        actions.sort_unstable();
        actions.dedup();
        let met = Met::from_iter([(abstraction.key(analysis, start), ROOT)]);
        Tree {
            analysis,
            pushes,
            progress: Progress::of(analysis),
            nearest: (u32::MAX, ROOT),
            abstraction,
            base: start.clone(),
            nodes: vec![Node { parent: ROOT, depth: 0, action: Action::Nil, expanded: false }],
            met,
            actions,
            limits,
            calls: 0,
            packed: 0,
            lease: Lease::default(),
            buffers: Some((start.clone(), start.clone())),
            stopped: &|| false,
        }
    }

    /// Returns a tree whose search ends once `stopped` returns `true`, as if the call budget were spent.
    pub(super) fn until(self, stopped: Stopped<'a>) -> Tree<'a> {
        Tree { stopped, ..self }
    }

    /// Expands states in a frontier's order until a state wins, no open states are left, or a limit is reached. In
    /// stochastic games, the keys include the random state. Covering all states then proves nothing, so it results in
    /// [`Answer::OutOfCalls`].
    pub(super) fn search<F: Frontier>(mut self, frontier: impl FnOnce(&Tree<'_>, &State) -> F) -> Searched {
        let start = self.base.clone();
        if start.is_over() {
            return self.answer(Answer::OutOfCalls);
        }
        let is_certain = self.analysis.is_deterministic_from(&start);
        let mut open = frontier(&self, &start);
        if let Some(least) = self.pushes.least(&start) {
            let root = self.keep(&start);
            open.push(&start, ROOT, 0, least, root);
        }
        while let Some((node, kept)) = open.pop() {
            let expanded = self.expand(node, &kept, &mut |tree, id, state, least, kept| {
                open.push(state, id, tree.depth(id), least, kept);
            });
            match expanded {
                Expanded::On => {}
                Expanded::Won(node) => {
                    let shortest = F::SHORTEST && is_certain;
                    return self.answer(Answer::Won { actions: self.way(node), shortest });
                }
                Expanded::OutOfCalls => return self.answer(Answer::OutOfCalls),
                Expanded::OutOfMemory => return self.answer(Answer::OutOfMemory),
            }
        }
        self.answer(if is_certain { Answer::Impossible } else { Answer::OutOfCalls })
    }

    fn keep(&mut self, state: &State) -> StoredState {
        let packed = state.pack(&self.base);
        self.packed += packed.size_in_bytes();
        StoredState { whole: Rc::new(packed), steps: ArrayVec::new() }
    }

    /// Generates all successors of a state. New successors are passed to `open` unless they are finished or dead
    /// ends. The state itself is dropped.
    fn expand(
        &mut self,
        node: NodeId,
        kept: &StoredState,
        open: &mut impl FnMut(&Tree<'_>, NodeId, &State, u32, StoredState),
    ) -> Expanded {
        if std::mem::replace(&mut self.nodes[node as usize].expanded, true) {
            self.forget(kept);
            return Expanded::On;
        }
        let (mut parent, mut child) = self.buffers.take().expect("the buffers are returned below");
        parent.unpack_from(&kept.whole, &self.base);
        for &action in &kept.steps {
            self.analysis.game().step(&mut parent, action);
        }
        let expanded = self.successors(node, kept, &parent, &mut child, open);
        self.buffers = Some((parent, child));
        self.forget(kept);
        expanded
    }

    fn forget(&mut self, kept: &StoredState) {
        if Rc::strong_count(&kept.whole) == 1 {
            self.packed -= kept.whole.size_in_bytes();
        }
    }

    fn successors(
        &mut self,
        node: NodeId,
        kept: &StoredState,
        parent: &State,
        child: &mut State,
        open: &mut impl FnMut(&Tree<'_>, NodeId, &State, u32, StoredState),
    ) -> Expanded {
        let game = self.analysis.game();
        let possible = game.actions(parent);
        for at in 0..self.actions.len() {
            let action = self.actions[at];
            if action != Action::Nil && !possible.contains(&action) {
                continue;
            }
            let is_stopped = self.calls.is_multiple_of(STOP_STRIDE) && (self.stopped)();
            if self.calls >= self.limits.calls || is_stopped {
                return Expanded::OutOfCalls;
            }
            child.clone_from(parent);
            let outcome = game.step(child, action);
            self.calls += 1;
            match outcome {
                Outcome::Won => return Expanded::Won(self.add(node, action)),
                Outcome::Ongoing => {}
                Outcome::Lost | Outcome::Ended | Outcome::Stopped(_) => continue,
            }
            let next = self.nodes.len() as NodeId;
            let id = *self.met.entry(self.abstraction.key(self.analysis, child)).or_insert(next);
            if id == next {
                self.add(node, action);
                self.nearest = self.nearest.min((self.progress.missing(child), id));
            } else if !self.shorten(id, node, action) {
                continue;
            }
            let Some(least) = self.pushes.least(child) else { continue };
            let mut steps = kept.steps.clone();
            let kept = match steps.try_push(action) {
                Ok(()) => StoredState { whole: kept.whole.clone(), steps },
                Err(_) => self.keep(child),
            };
            open(self, id, child, least, kept);
            let bytes = self.bytes();
            if bytes > self.limits.bytes || id == NodeId::MAX {
                return Expanded::OutOfMemory;
            }
            if !self.lease.grow(bytes, self.limits.bytes, self.stopped) {
                return Expanded::OutOfCalls;
            }
        }
        Expanded::On
    }

    fn add(&mut self, parent: NodeId, action: Action) -> NodeId {
        let depth = self.depth(parent) + 1;
        self.nodes.push(Node { parent, depth, action, expanded: false });
        (self.nodes.len() - 1) as NodeId
    }

    /// Replaces the path to a node if the path through `parent` is shorter. Returns `true` if the path was
    /// replaced.
    fn shorten(&mut self, node: NodeId, parent: NodeId, action: Action) -> bool {
        let depth = self.depth(parent) + 1;
        let known = &mut self.nodes[node as usize];
        let is_shorter = depth < known.depth && !known.expanded;
        if is_shorter {
            (known.parent, known.action, known.depth) = (parent, action, depth);
        }
        is_shorter
    }

    /// Returns the length in ticks of the shortest known path to a node.
    fn depth(&self, node: NodeId) -> u32 {
        self.nodes[node as usize].depth
    }

    /// Returns an estimate of the number of bytes in use. The estimate is deterministic, because it depends neither
    /// on the clock nor on the allocator.
    fn bytes(&self) -> usize {
        // A hash table is at least 7/16 full and needs one extra byte per slot. Queues hold the packed states.
        let keys = self.met.len() * (size_of::<(SearchKey, NodeId)>() + 1) * 16 / 7;
        keys + self.nodes.len() * (size_of::<Node>() + size_of::<StoredState>()) + self.packed
    }

    /// Returns the actions that lead from the start to a node.
    fn way(&self, mut node: NodeId) -> Vec<Action> {
        let mut actions = Vec::new();
        while node != ROOT {
            let Node { parent, action, .. } = self.nodes[node as usize];
            actions.push(action);
            node = parent;
        }
        actions.reverse();
        actions
    }

    fn answer(&self, answer: Answer) -> Searched {
        let states = self.met.len() as u64;
        Searched { answer, calls: self.calls, states, nearest: self.way(self.nearest.1) }
    }
}
