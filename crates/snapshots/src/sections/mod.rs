//! Recipe sections that add something to a recipe's games. Each section is a module in this folder and an
//! entry in [`SECTIONS`].

pub mod ceilings;
pub(crate) mod designs;
pub(crate) mod frozen;
pub mod marks;
pub mod memory;
pub(crate) mod puzzles;
pub(crate) mod section;
pub(crate) mod tiers;

use crate::format::manifest::Manifest;
use puzzles::PuzzleKind;
use section::Section;

/// The sections, in the order in which they process a game. Reference players come last, because they must play the
/// games under the published names.
pub(crate) const SECTIONS: [&dyn Section; 9] = [
    &tiers::TiersSection,
    &designs::DesignsSection,
    &PuzzleKind::Pushing,
    &PuzzleKind::Locks,
    &PuzzleKind::Yards,
    &PuzzleKind::Strays,
    &memory::MemorySection,
    &marks::MarksSection,
    &ceilings::CeilingsSection,
];

/// Returns the paths of the files that sections add about the release as a whole.
pub(crate) fn summary_paths(manifest: &Manifest) -> Vec<String> {
    SECTIONS.iter().filter_map(|section| section.summary_path(manifest)).collect()
}
