//! The similarity of two rule graphs: a Weisfeiler–Lehman kernel.
//!
//! After each of a few rounds of colour refinement the colours of the nodes are counted; a colour after h rounds stands for the
//! subtree of depth h below a node (Shervashidze et al., "Weisfeiler–Lehman graph kernels", JMLR 12, 2011). Counts are compared
//! by intersection, as in the optimal-assignment form of the kernel (Kriege, Giscard and Wilson, "On valid optimal assignment
//! kernels", NIPS 2016): with products of counts, ten walls would outweigh everything else. The intersection is divided by the
//! union, which makes the distance a metric on the counts, 0 for equal ones only.

use super::colours::{Colour, Neighbours, colour};
use super::graph::{Grain, RuleGraph};

/// Rounds of refinement, by grain, and the weight of a colour of each round. Early rounds weigh more: one changed
/// rule alters the late colours of everything near it.
const ROUNDS: [(Grain, &[u32]); 3] =
    [(Grain::Coarse, &[4, 4, 2]), (Grain::Medium, &[4, 4, 2]), (Grain::Fine, &[1, 1, 0, 1])];

/// The colours of a game with their weights, sorted by colour.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Features(Vec<(Colour, u32)>);

impl Features {
    /// Computes the features. Cost: 11 rounds of refinement, about a millisecond for large games.
    pub(super) fn of(graph: &RuleGraph) -> Features {
        let neighbours = Neighbours::of(graph);
        let mut counts: Vec<(Colour, u32)> = Vec::new();
        for (grain, rounds) in ROUNDS {
            let start = |label: &str| colour(format!("{grain:?} {label}").as_bytes());
            let mut colours: Vec<Colour> =
                graph.nodes.iter().map(|node| start(&node.labels[grain as usize])).collect();
            for (round, weight) in rounds.iter().enumerate() {
                if round > 0 {
                    colours = neighbours.refined(&colours);
                }
                let weighed = colours.iter().zip(&graph.nodes);
                counts.extend(weighed.map(|(&colour, node)| (colour, weight * node.weight)));
            }
        }
        counts.retain(|(_, weight)| *weight > 0);
        counts.sort_unstable_by_key(|(colour, _)| *colour);
        counts.dedup_by(|later, first| {
            let same = later.0 == first.0;
            first.1 += if same { later.1 } else { 0 };
            same
        });
        Features(counts)
    }

    /// Returns 1 − intersection / union, from 0 to 1. Cost: O(nodes).
    pub(super) fn distance(&self, other: &Features) -> f64 {
        let (mut common, mut all) = (0u64, 0u64);
        let (mut one, mut two) = (self.0.iter().peekable(), other.0.iter().peekable());
        loop {
            let (mine, theirs) = match (one.peek(), two.peek()) {
                (None, None) => break,
                (Some((a, _)), Some((b, _))) if a == b => (one.next(), two.next()),
                (Some((a, _)), Some((b, _))) if a > b => (None, two.next()),
                (None, Some(_)) => (None, two.next()),
                _ => (one.next(), None),
            };
            let weight =
                |feature: Option<&(Colour, u32)>| feature.map_or(0, |(_, weight)| u64::from(*weight));
            common += weight(mine).min(weight(theirs));
            all += weight(mine).max(weight(theirs));
        }
        if all == 0 { 0.0 } else { (all - common) as f64 / all as f64 }
    }
}
