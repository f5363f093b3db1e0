//! Reference designers. Their scores serve as a floor and as a comparison for the scores of language models.

mod grammar;
mod inventor;
mod kernels;

use base::Seed;

base::named_enum! {
    /// A designer that is a program. The same seed gives the same proposal on every machine. The grammar never changes.
    /// The kernels and the inventor change only with [`generators::GENERATION`].
    pub enum Reference {
        /// Draws rules and levels from a grammar of VGDL, without looking at their meaning.
        Grammar = "grammar",
        /// Draws a hand-written kernel, its numbers, and a map for each level, without any search.
        Kernels = "kernels",
        /// Merges mechanics, and searches for a board for each level.
        Inventor = "inventor",
    }
}

/// A game that has not been checked.
pub(crate) struct Proposal {
    /// The rules, as VGDL text.
    pub(crate) rules: String,
    /// The levels. There may be fewer than requested.
    pub(crate) levels: Vec<String>,
}

impl Reference {
    /// Proposes a game with `levels` levels. Returns `None` if the kernels or the inventor fail to produce a game.
    /// Costs microseconds for the grammar, milliseconds for the kernels, and up to four million forward-model calls per
    /// level for the inventor.
    pub(crate) fn propose(self, levels: usize, seed: Seed) -> Option<Proposal> {
        let seed = seed.child(self.name(), 1);
        match self {
            Reference::Grammar => Some(grammar::propose(levels, seed)),
            Reference::Kernels => kernels::propose(levels, seed),
            Reference::Inventor => inventor::propose(levels, seed),
        }
    }
}
