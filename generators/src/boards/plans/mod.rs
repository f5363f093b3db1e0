//! Board plans. Each plan is a site with a landmark (its main feature), and its proportions are drawn at random.

mod courts;
mod halls;
mod mirrored;

use super::canvas::{Canvas, narrow};
use base::{Sampler, Seed};

/// The maximum number of plans to draw until one is sound.
const DRAWS: u64 = 6;
/// The maximum fraction of a plan's floor that may consist of narrow passages.
const MAX_NARROW: f64 = 0.3;

/// A kind of plan.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum PlanKind {
    /// A court with rows of pillars and an open corner.
    Courtyard,
    /// A path around a block with a niche.
    Ring,
    /// A court inside a moat.
    Moat,
    /// A hall with long partitions.
    Aisles,
    /// Two wide avenues that cross between four blocks.
    Cross,
    /// Two banks with a winding river between them.
    Banks,
    /// A walled keep in a corner.
    Keep,
    /// Blocks of one or two shapes, scattered over open ground.
    Islands,
    /// Walls from alternating sides, each with a hook.
    Staggered,
    /// Terraces one above the other, with gates.
    Terraces,
    /// Chambers around a hall.
    Chambers,
    /// A cloister: a wall around three sides of a court.
    Cloister,
    /// A hall between two wings.
    Wings,
    /// A room in the middle of the board.
    Sanctum,
    /// Two halves with a gate between them.
    Gatehouse,
    /// Four rooms with gates between them.
    Quarters,
}

/// All kinds, with their weights.
const KINDS: [(PlanKind, u32); 16] = [
    (PlanKind::Courtyard, 8),
    (PlanKind::Ring, 8),
    (PlanKind::Moat, 6),
    (PlanKind::Aisles, 8),
    (PlanKind::Cross, 8),
    (PlanKind::Banks, 10),
    (PlanKind::Keep, 9),
    (PlanKind::Islands, 8),
    (PlanKind::Staggered, 8),
    (PlanKind::Terraces, 9),
    (PlanKind::Chambers, 9),
    (PlanKind::Cloister, 8),
    (PlanKind::Wings, 16),
    (PlanKind::Sanctum, 14),
    (PlanKind::Gatehouse, 14),
    (PlanKind::Quarters, 14),
];

impl PlanKind {
    fn draw(sampler: &mut Sampler) -> PlanKind {
        let weights = KINDS.map(|(_, weight)| weight);
        KINDS[sampler.weighted(&weights).expect("the weights are positive")].0
    }

    /// Returns `true` if the plan's walls are mirror-symmetric.
    fn is_mirrored(self) -> bool {
        matches!(self, PlanKind::Wings | PlanKind::Sanctum | PlanKind::Gatehouse | PlanKind::Quarters)
    }

    fn sketch(self, canvas: &mut Canvas, sampler: &mut Sampler) {
        match self {
            PlanKind::Courtyard => courts::courtyard(canvas, sampler),
            PlanKind::Ring => courts::ring(canvas, sampler),
            PlanKind::Moat => courts::moat(canvas, sampler),
            PlanKind::Aisles => halls::aisles(canvas, sampler),
            PlanKind::Cross => halls::cross(canvas, sampler),
            PlanKind::Banks => halls::banks(canvas, sampler),
            PlanKind::Keep => courts::keep(canvas, sampler),
            PlanKind::Islands => courts::islands(canvas, sampler),
            PlanKind::Staggered => halls::staggered(canvas, sampler),
            PlanKind::Terraces => halls::terraces(canvas, sampler),
            PlanKind::Chambers => halls::chambers(canvas, sampler),
            PlanKind::Cloister => courts::cloister(canvas, sampler),
            PlanKind::Wings => mirrored::wings(canvas, sampler),
            PlanKind::Sanctum => mirrored::sanctum(canvas, sampler),
            PlanKind::Gatehouse => mirrored::gatehouse(canvas, sampler),
            PlanKind::Quarters => mirrored::quarters(canvas, sampler),
        }
    }
}

/// Draws a number in a range. Returns the lower end if the range is empty because the board is too small.
fn between(sampler: &mut Sampler, low: usize, high: usize) -> usize {
    sampler.between(low, high.max(low))
}

/// Draws a plan of a given size: a kind, its proportions, an outline and an orientation. Returns `None` if no draw
/// is sound.
pub(crate) fn draw_plan((columns, rows): (usize, usize), seed: Seed) -> Option<(PlanKind, Canvas)> {
    (0..DRAWS).find_map(|draw| {
        let sampler = &mut seed.child("plan", draw).sampler();
        let kind = PlanKind::draw(sampler);
        let symmetry = sampler.below(8);
        let sides = if symmetry & 4 == 0 { (columns, rows) } else { (rows, columns) };
        let mut canvas = Canvas::new(sides.0, sides.1);
        kind.sketch(&mut canvas, sampler);
        if !kind.is_mirrored() && sampler.ratio(3, 4) {
            canvas.bite(sampler);
        }
        let mut canvas = canvas.turned(symmetry);
        let is_sound = canvas.settle();
        let narrow = narrow(canvas.grid, |cell| !canvas.wall[cell]);
        (is_sound && narrow <= MAX_NARROW).then_some((kind, canvas))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_has_sound_plans_of_every_size() {
        for (columns, rows) in [(9, 7), (7, 9), (12, 9), (8, 13), (16, 11), (11, 16)] {
            for (kind, _) in KINDS {
                let drawn = (0..24).filter_map(|at| {
                    let sampler = &mut Seed::from_text("kinds").child("draw", at).sampler();
                    let mut canvas = Canvas::new(columns, rows);
                    kind.sketch(&mut canvas, sampler);
                    let lines_are_inside = canvas
                        .dividers
                        .iter()
                        .flat_map(|divider| &divider.line)
                        .all(|&cell| !canvas.grid.on_border(cell));
                    assert!(lines_are_inside, "{kind:?}");
                    let is_sound = canvas.settle();
                    (is_sound && narrow(canvas.grid, |cell| !canvas.wall[cell]) <= MAX_NARROW).then_some(())
                });
                let drawn = drawn.count();
                assert!(drawn >= 3, "{kind:?} at {columns} x {rows}: {drawn} of 24 are sound");
            }
        }
    }

    #[test]
    fn a_plan_follows_from_its_seed() {
        let draw = |text: &str| {
            let canvas = draw_plan((13, 9), Seed::from_text(text)).unwrap().1;
            let lines = canvas.dividers.into_iter().map(|divider| (divider.line, divider.gaps));
            (canvas.wall, lines.collect::<Vec<_>>())
        };
        assert_eq!(draw("one"), draw("one"));
        assert_ne!(draw("one"), draw("two"));
    }
}
