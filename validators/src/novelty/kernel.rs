//! The similarity of two rule graphs: a Weisfeiler–Lehman kernel.
//!
//! The node colours are counted after each of several rounds of colour refinement. A colour after h rounds
//! represents the subtree of depth h below a node (Shervashidze et al., "Weisfeiler–Lehman graph kernels",
//! JMLR 12, 2011). Counts are compared by intersection, as in the optimal-assignment form of the kernel
//! (Kriege, Giscard and Wilson, "On valid optimal assignment kernels", NIPS 2016).
//!
//! If counts were compared by products instead, ten walls would outweigh everything else. The intersection is divided
//! by the union, which makes the distance a metric on the counts. It is 0 only for equal counts.

use super::colours::{Colour, Neighbours, colour};
use super::graph::{Grain, RuleGraph};
use itertools::Itertools;

/// The refinement rounds for each grain, and a colour's weight in each round. Early rounds weigh more, because a single
/// changed rule alters the late colours of all nearby nodes.
const ROUNDS: [(Grain, &[u32]); 3] =
    [(Grain::Coarse, &[4, 4, 2]), (Grain::Medium, &[4, 4, 2]), (Grain::Fine, &[1, 1, 0, 1])];

/// A game's colours with their weights, sorted by colour.
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
        let merged = counts.into_iter().coalesce(|one, next| match one.0 == next.0 {
            true => Ok((one.0, one.1 + next.1)),
            false => Err((one, next)),
        });
        Features(merged.collect())
    }

    /// Returns 1 − intersection / union, from 0 to 1. Cost: O(nodes).
    pub(super) fn distance(&self, other: &Features) -> f64 {
        let (mut common, mut all) = (0u64, 0u64);
        let weight = |(_, weight): &(Colour, u32)| u64::from(*weight);
        for pair in self.0.iter().merge_join_by(&other.0, |(one, _), (two, _)| one.cmp(two)) {
            let (mine, theirs) = pair.map_any(weight, weight).or_default();
            common += mine.min(theirs);
            all += mine.max(theirs);
        }
        if all == 0 { 0.0 } else { (all - common) as f64 / all as f64 }
    }
}
