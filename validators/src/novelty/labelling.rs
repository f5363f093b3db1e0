//! Canonical labelling, which produces the same text for all games that differ only in names and order.
//!
//! After the colours are refined, one of the types that still share a colour is individualized. The colours are then
//! refined again, until no types share a colour. The smallest of all texts produced in this way is the canonical text
//! (McKay and Piperno, "Practical graph isomorphism, II", 2014). If several types can be exchanged without changing the
//! rules, only one of them is individualized. Branches found to be equivalent to an earlier branch are not searched.

use super::colours::{Colour, Neighbours, colour};
use super::graph::{Grain, RuleGraph};
use itertools::Itertools;

/// The maximum number of texts to write. Games whose types differ in colour, or can be exchanged, need far fewer texts.
///
/// Beyond the limit, the first type with a given colour represents all types with this colour. The result is
/// the same if these types are equivalent, as they are unless the rule graph is adversarial. In an
/// adversarial graph, two versions of the same rules may get different texts. Different rules never get the
/// same text.
const MAX_LABELLINGS: usize = 200;

/// The canonical text, with the types in text order. It is the same for all graphs that differ only in names
/// and order.
#[derive(Clone, Debug)]
pub(super) struct Labelled {
    pub(super) text: String,
    /// The graph's type nodes, in the order of the canonical text.
    pub(super) order: Vec<usize>,
}

impl Labelled {
    /// Returns the labelling with the smaller text, or `self` if the texts are equal.
    fn min(self, other: Labelled) -> Labelled {
        if other.text < self.text { other } else { self }
    }
}

/// Returns the canonical text of a graph. Cost: about 20 µs per node, and up to [`MAX_LABELLINGS`] times
/// that.
pub(super) fn canonical(graph: &RuleGraph) -> Labelled {
    let neighbours = Neighbours::of(graph);
    let first = graph.nodes.iter().map(|node| colour(node.labels[Grain::Fine as usize].as_bytes())).collect();
    let mut labelling = Labelling { graph, neighbours, left: MAX_LABELLINGS };
    let colours = labelling.neighbours.settled(first);
    labelling.smallest(&colours)
}

struct Labelling<'a> {
    graph: &'a RuleGraph,
    neighbours: Neighbours,
    left: usize,
}

impl Labelling<'_> {
    /// Returns the smallest text to which the given colours can be refined.
    fn smallest(&mut self, colours: &[Colour]) -> Labelled {
        let first_cell = self.first_cell(colours);
        let Some((&first, others)) = first_cell.split_first() else { return self.write(colours) };
        let mut best = self.smallest(&self.individualize(colours, first));
        let mut seen: Option<String> = None;
        for &other in others {
            if self.left == 0 {
                break;
            }
            let started = self.individualize(colours, other);
            let quick = self.first_text(started.clone());
            let known = seen.get_or_insert_with(|| best.text.clone());
            // An earlier choice gave the same text, so an automorphism of the rules maps one choice to the other.
            if quick.text == *known {
                continue;
            }
            best = best.min(quick).min(self.smallest(&started));
        }
        best
    }

    /// Returns the types with the first colour that several types share, without types that can be exchanged
    /// for an earlier one.
    fn first_cell(&self, colours: &[Colour]) -> Vec<usize> {
        let types = &colours[..self.graph.types];
        let Some(&twice) = types.iter().duplicates().min() else { return Vec::new() };
        let mut first_cell: Vec<usize> = Vec::new();
        for at in (0..types.len()).filter(|&at| types[at] == twice) {
            if first_cell.is_empty() || !first_cell.iter().any(|&other| self.can_be_exchanged(at, other)) {
                first_cell.push(at);
            }
        }
        first_cell
    }

    fn individualize(&self, colours: &[Colour], at: usize) -> Vec<Colour> {
        let mut colours = colours.to_vec();
        colours[at] = colour(&[&b"this one"[..], &colours[at].to_le_bytes()].concat());
        self.neighbours.settled(colours)
    }

    /// Returns the text that results if the first of the types with equal colours is always individualized.
    fn first_text(&mut self, mut colours: Vec<Colour>) -> Labelled {
        while let Some(&first) = self.first_cell(&colours).first() {
            colours = self.individualize(&colours, first);
        }
        self.write(&colours)
    }

    fn write(&mut self, colours: &[Colour]) -> Labelled {
        self.left = self.left.saturating_sub(1);
        let order = (0..self.graph.types).sorted_by_key(|&at| colours[at]).collect_vec();
        let mut place = vec![0; order.len()];
        order.iter().enumerate().for_each(|(to, &at)| place[at] = to);
        let (mut types, rules) = self.lines(&place);
        // The colours are part of the text and record the individualized types, so equal texts mean equal choices.
        types.iter_mut().zip(&order).for_each(|(line, &at)| *line = format!("{:016x} {line}", colours[at]));
        Labelled { text: types.join("\n") + "\n\n" + &rules.join("\n"), order }
    }

    /// Returns the nodes as text, with types named by position. Types are in the given order, and all other nodes are
    /// sorted.
    fn lines(&self, place: &[usize]) -> (Vec<String>, Vec<String>) {
        let line = |at: usize| {
            let node = &self.graph.nodes[at];
            let mut edges =
                node.edges.iter().map(|(role, to)| format!("{role}:{}", place[*to])).sorted_unstable();
            format!("{} | {}", node.labels[Grain::Fine as usize], edges.join(" "))
        };
        let mut types = vec![String::new(); self.graph.types];
        (0..self.graph.types).for_each(|at| types[place[at]] = line(at));
        let rules = (self.graph.types..self.graph.nodes.len()).map(line).sorted_unstable();
        (types, rules.collect())
    }

    /// Returns `true` if exchanging the two types leaves the rules unchanged.
    fn can_be_exchanged(&self, one: usize, two: usize) -> bool {
        let same: Vec<usize> = (0..self.graph.types).collect();
        let mut exchanged = same.clone();
        exchanged.swap(one, two);
        self.lines(&same) == self.lines(&exchanged)
    }
}
