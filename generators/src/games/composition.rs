//! Which patterns go together: drawn so that every one has what it needs and none meets what it bars.

use super::boons::BOONS;
use super::goals;
use super::kind::Kind;
use super::movement::MOVEMENTS;
use super::obstacles::OBSTACLES;
use super::pattern::{Feature, Goal, Pattern};
use super::role::Role;
use super::threats::THREATS;
use engine::Sampler;

/// The patterns of one game, in the order in which they are built.
pub(crate) struct Composition {
    pub(crate) goal: &'static Goal,
    pub(crate) patterns: Vec<&'static Pattern>,
}

impl Composition {
    /// Draws a goal of one of these kinds, a way of moving that it can be reached with, and company for both; None if the
    /// draws so far leave no way on.
    pub(crate) fn draw(kinds: &[Kind], sampler: &mut Sampler) -> Option<Composition> {
        let goals: Vec<&'static Goal> =
            goals::all().into_iter().filter(|goal| kinds.contains(&goal.kind)).collect();
        let weights: Vec<u32> = goals.iter().map(|goal| goal.pattern.weight).collect();
        let goal = goals[sampler.weighted(&weights)?];
        let mut composition = Composition { goal, patterns: vec![&goal.pattern] };
        let fits =
            |pattern: &&'static Pattern| goal.hero.iter().all(|feature| pattern.gives.contains(feature));
        let movement = composition.pick(MOVEMENTS.iter().filter(fits), sampler)?;
        // The way of moving is built first: the others ask what the hero strikes with.
        composition.patterns.insert(0, movement);

        let threats = sampler.between(goal.threats.0, goal.threats.1);
        for _ in 0..threats {
            let threat = composition.pick(THREATS.iter(), sampler)?;
            composition.patterns.push(threat);
        }
        // A weapon is for something.
        if composition.gives(Feature::Strikes) && !composition.gives(Feature::Prey) {
            let prey = THREATS.iter().filter(|threat| threat.gives.contains(&Feature::Prey));
            let threat = composition.pick(prey, sampler)?;
            composition.patterns.push(threat);
        }
        let obstacles = sampler.between(goal.obstacles.0, goal.obstacles.1);
        for _ in 0..obstacles {
            if let Some(obstacle) = composition.pick(OBSTACLES.iter(), sampler) {
                composition.patterns.push(obstacle);
            }
        }
        if sampler.ratio(1, 2)
            && let Some(boon) = composition.pick(BOONS.iter(), sampler)
        {
            composition.patterns.push(boon);
        }
        Some(composition)
    }

    /// Whether some pattern brings this.
    pub(crate) fn gives(&self, feature: Feature) -> bool {
        self.patterns.iter().any(|pattern| pattern.gives.contains(&feature))
    }

    /// One of the patterns that go with those drawn so far.
    fn pick(
        &self,
        from: impl Iterator<Item = &'static Pattern>,
        sampler: &mut Sampler,
    ) -> Option<&'static Pattern> {
        let fitting: Vec<&'static Pattern> = from.filter(|pattern| self.admits(pattern)).collect();
        let weights: Vec<u32> = fitting.iter().map(|pattern| pattern.weight).collect();
        sampler.weighted(&weights).map(|at| fitting[at])
    }

    fn admits(&self, pattern: &Pattern) -> bool {
        let taken = |role: &Role| self.patterns.iter().any(|other| other.roles.contains(role));
        let barred = |other: &&'static Pattern| {
            other.bars.iter().any(|feature| pattern.gives.contains(feature))
                || pattern.bars.iter().any(|feature| other.gives.contains(feature))
        };
        !pattern.roles.iter().any(taken)
            && pattern.needs.iter().all(|&feature| self.gives(feature))
            && !self.patterns.iter().any(barred)
    }
}
