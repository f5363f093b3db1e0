//! Operations on the branches of a node, one branch per action. They are shared by the tree searches.

use base::Sampler;
use engine::Action;

/// The maximum number of actions of a game, and thus of branches of a node.
pub(crate) const WIDTH: usize = Action::ALL.len();
/// The index of a branch without a node.
pub(crate) const UNEXPANDED: u32 = u32::MAX;

/// Chooses a branch without a node, uniformly at random; `None` if every branch has a node.
pub(crate) fn unexpanded(children: &[u32], choices: &mut Sampler) -> Option<usize> {
    let open = children.iter().filter(|&&child| child == UNEXPANDED).count();
    if open == 0 {
        return None;
    }
    let drawn = choices.below(open);
    let mut branches = children.iter().enumerate().filter(|(_, child)| **child == UNEXPANDED);
    branches.nth(drawn).map(|(branch, _)| branch)
}

/// Applies the reference's tie-breaking noise, based on a draw in [0, 1). The noise is proportional to the value, so
/// it is zero for a value of 0, and several units for the value of a win.
pub(crate) fn blurred(value: f64, epsilon: f64, noise: f64) -> f64 {
    (value + epsilon) * (1.0 + epsilon * (noise - 0.5))
}

/// Returns the first branch with the greatest value.
pub(crate) fn best(width: usize, mut value: impl FnMut(usize) -> f64) -> usize {
    let mut best = (0, f64::NEG_INFINITY);
    for branch in 0..width {
        let value = value(branch);
        if value > best.1 {
            best = (branch, value);
        }
    }
    best.0
}

/// Copies the subtree under a node, breadth first, with that node as the root. Returns an empty tree if the node does
/// not exist.
pub(crate) fn subtree<N: Clone>(
    tree: &[N],
    root: u32,
    children: impl Fn(&mut N) -> &mut [u32; WIDTH],
) -> Vec<N> {
    let mut kept: Vec<N> = tree.get(root as usize).cloned().into_iter().collect();
    let mut at = 0;
    while at < kept.len() {
        for branch in 0..WIDTH {
            let child = children(&mut kept[at])[branch];
            if let Some(child) = tree.get(child as usize).cloned() {
                children(&mut kept[at])[branch] = kept.len() as u32;
                kept.push(child);
            }
        }
        at += 1;
    }
    kept
}
