//! Colour refinement, which distinguishes nodes by their neighbours (Weisfeiler and Leman 1968).
//!
//! A colour is a hash of the structure that it represents, so colours are comparable across games.

use super::graph::RuleGraph;
use base::Digest;
use itertools::Itertools;

/// A node's colour.
pub(super) type Colour = u64;

/// Returns the colour that represents `bytes`.
pub(super) fn colour(bytes: &[u8]) -> Colour {
    let digest = Digest::of(bytes);
    Colour::from_le_bytes(digest.as_bytes()[..8].try_into().expect("eight of 32 bytes"))
}

/// A graph's adjacency lists, for refinement.
pub(super) struct Neighbours {
    /// For each node, its neighbours. Each comes with the role of the link between the two nodes, which includes the
    /// link's direction.
    of: Vec<Vec<(Colour, usize)>>,
}

impl Neighbours {
    pub(super) fn of(graph: &RuleGraph) -> Neighbours {
        let mut of = vec![Vec::new(); graph.nodes.len()];
        for (at, node) in graph.nodes.iter().enumerate() {
            for (role, to) in &node.edges {
                of[at].push((colour(format!("to {role}").as_bytes()), *to));
                of[*to].push((colour(format!("from {role}").as_bytes()), at));
            }
        }
        Neighbours { of }
    }

    /// Returns the colours after one more round of refinement. Cost: O(edges).
    pub(super) fn refined(&self, colours: &[Colour]) -> Vec<Colour> {
        let mut bytes = Vec::new();
        let mut refine = |(at, neighbours): (usize, &Vec<(Colour, usize)>)| {
            let seen =
                neighbours.iter().map(|&(role, to)| (role, colours[to])).sorted_unstable().collect_vec();
            bytes.clear();
            bytes.extend(colours[at].to_le_bytes());
            for (role, to) in seen {
                bytes.extend(role.to_le_bytes());
                bytes.extend(to.to_le_bytes());
            }
            colour(&bytes)
        };
        self.of.iter().enumerate().map(&mut refine).collect()
    }

    /// Refines the colours until another round would not distinguish any further nodes.
    pub(super) fn settled(&self, mut colours: Vec<Colour>) -> Vec<Colour> {
        let mut kinds = count(&colours);
        loop {
            colours = self.refined(&colours);
            let now = count(&colours);
            if now == kinds {
                return colours;
            }
            kinds = now;
        }
    }
}

fn count(colours: &[Colour]) -> usize {
    colours.iter().sorted_unstable().dedup().count()
}
