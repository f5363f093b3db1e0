//! Sections of a recipe that add something to its games: each is a folder here and a line in [`SECTIONS`].

pub(crate) mod frozen;
pub mod marks;
pub mod memory;
pub(crate) mod puzzles;
pub(crate) mod section;
pub(crate) mod tiers;

use crate::format::manifest::Manifest;
use puzzles::PuzzleKind;
use section::Section;

/// The sections, in the order in which they act on a game: players of marks meet the names that coins have published.
pub(crate) const SECTIONS: [&dyn Section; 7] = [
    &tiers::TiersSection,
    &PuzzleKind::Pushing,
    &PuzzleKind::Locks,
    &PuzzleKind::Yards,
    &PuzzleKind::Strays,
    &memory::MemorySection,
    &marks::MarksSection,
];

/// The paths of the files about a release as a whole that sections have added.
pub(crate) fn summary_paths(manifest: &Manifest) -> Vec<String> {
    SECTIONS.iter().filter_map(|section| section.summary_path(manifest)).collect()
}
