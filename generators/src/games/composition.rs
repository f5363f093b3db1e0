//! The choice of patterns that go together: every pattern has what it needs and meets nothing that it bars.

use super::boons::BOONS;
use super::goals;
use super::kind::Kind;
use super::movement::MOVEMENTS;
use super::obstacles::OBSTACLES;
use super::pattern::{Feature, Goal, Pattern};
use super::threats::THREATS;
use engine::Sampler;

/// The maximum number of boons in a game.
const MAX_BOONS: usize = 2;

/// The patterns of one game, in the order in which they are built.
pub(crate) struct Composition {
    pub(crate) goal: &'static Goal,
    pub(crate) patterns: Vec<&'static Pattern>,
}

impl Composition {
    /// Draws a goal of one of these kinds, a way of moving that can reach it, and further patterns; `None` if the draws
    /// so far leave no fitting pattern.
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
        // A weapon needs something to be used on.
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
        let boons = sampler.weighted(&[1, 4, 2]).unwrap_or(0);
        for _ in 0..boons {
            if let Some(boon) = composition.pick(BOONS.iter(), sampler) {
                composition.patterns.push(boon);
            }
        }
        // Something has to stand in the way.
        is_challenge(&composition.patterns).then_some(composition)
    }

    /// Returns `true` if some pattern has this feature.
    pub(crate) fn gives(&self, feature: Feature) -> bool {
        self.patterns.iter().any(|pattern| pattern.gives.contains(&feature))
    }

    /// Draws one of the patterns that go with those drawn so far.
    fn pick(
        &self,
        from: impl Iterator<Item = &'static Pattern>,
        sampler: &mut Sampler,
    ) -> Option<&'static Pattern> {
        let fitting: Vec<&'static Pattern> = from.filter(|pattern| self.admits(pattern)).collect();
        let weights: Vec<u32> = fitting.iter().map(|pattern| pattern.weight).collect();
        sampler.weighted(&weights).map(|at| fitting[at])
    }

    fn admits(&self, pattern: &'static Pattern) -> bool {
        goes_with(&self.patterns, pattern)
    }
}

/// Tests whether the others provide what a pattern needs, and neither it nor they bar the other.
fn goes_with(patterns: &[&'static Pattern], pattern: &Pattern) -> bool {
    let gives = |feature: &Feature| patterns.iter().any(|other| other.gives.contains(feature));
    pattern.needs.iter().all(gives) && patterns.iter().all(|other| go_together(other, pattern))
}

/// Tests whether a game with these patterns can take one more besides its goal and way of moving.
pub(crate) fn admits(goal: &Goal, patterns: &[&'static Pattern], pattern: &Pattern) -> bool {
    let most = match family(pattern) {
        "threat" => goal.threats.1 + 1,
        "obstacle" => goal.obstacles.1 + 1,
        _ => MAX_BOONS,
    };
    let like = patterns.iter().filter(|other| family(other) == family(pattern)).count();
    like < most && goes_with(patterns, pattern)
}

/// Tests whether two patterns can be in one game: they share no role, and neither has a feature that the other bars.
fn go_together(one: &Pattern, two: &Pattern) -> bool {
    let bars = |one: &Pattern, two: &Pattern| one.bars.iter().any(|feature| two.gives.contains(feature));
    !one.roles.iter().any(|role| two.roles.contains(role)) && !bars(one, two) && !bars(two, one)
}

/// Tests whether something endangers the hero, works against it, or stands in its way.
pub(crate) fn is_challenge(patterns: &[&'static Pattern]) -> bool {
    let companions = |pattern: &&&Pattern| ["threat", "obstacle"].contains(&family(pattern));
    let works_against = |feature: &Feature| [Feature::Harm, Feature::Movers].contains(feature);
    patterns.iter().any(|pattern| companions(&pattern))
        || patterns.get(1).is_some_and(|goal| goal.gives.iter().any(works_against))
}

/// The family of a pattern: `threat` of `threat/patrol`.
pub(crate) fn family(pattern: &Pattern) -> &'static str {
    pattern.name.split_once('/').map_or(pattern.name, |(family, _)| family)
}

/// The patterns that can accompany a goal: threats, obstacles and boons.
pub(crate) fn companions() -> impl Iterator<Item = &'static Pattern> {
    THREATS.iter().chain(OBSTACLES).chain(BOONS)
}

/// Tests whether these patterns make a game: a way of moving and the goal first, then as many others as the goal allows
/// and at most one more of a family. Every pattern must have what it needs and meet nothing that it bars.
pub(crate) fn is_coherent(goal: &'static Goal, patterns: &[&'static Pattern]) -> bool {
    let [movement, aim, rest @ ..] = patterns else { return false };
    let gives = |feature: &Feature| patterns.iter().any(|pattern| pattern.gives.contains(feature));
    let count = |name: &str| rest.iter().filter(|pattern| family(pattern) == name).count();
    let within = |name: &str, (least, most): (usize, usize)| (least..=most + 1).contains(&count(name));
    let pairs = (0..patterns.len()).flat_map(|at| (0..at).map(move |before| (before, at)));
    family(movement) == "movement"
        && aim.name == goal.pattern.name
        && goal.hero.iter().all(|feature| movement.gives.contains(feature))
        && count("threat") + count("obstacle") + count("boon") == rest.len()
        && within("threat", goal.threats)
        && within("obstacle", goal.obstacles)
        && count("boon") <= MAX_BOONS
        && patterns.iter().all(|pattern| pattern.needs.iter().all(gives))
        && is_challenge(patterns)
        && (!gives(&Feature::Strikes) || gives(&Feature::Prey))
        && pairs.into_iter().all(|(one, two)| go_together(patterns[one], patterns[two]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All patterns.
    fn all() -> Vec<&'static Pattern> {
        let goals = goals::all().into_iter().map(|goal| &goal.pattern);
        MOVEMENTS.iter().chain(goals).chain(companions()).collect()
    }

    /// The documentation page lists every pattern, with the features it gives, needs and bars.
    #[test]
    fn the_page_documents_every_pattern() {
        let page = include_str!("../../../docs/generate-games.md");
        for pattern in all() {
            let words = |features: &[Feature]| {
                let names: Vec<String> =
                    features.iter().map(|feature| format!("{feature:?}").to_lowercase()).collect();
                if names.is_empty() { "–".to_owned() } else { names.join(", ") }
            };
            let [gives, needs, bars] = [pattern.gives, pattern.needs, pattern.bars].map(words);
            let row = format!("| `{}` |", pattern.name);
            let line = page.lines().find(|line| line.starts_with(&row));
            let end = format!("| {gives} | {needs} | {bars} |");
            assert!(line.is_some_and(|line| line.ends_with(&end)), "{row} … {end}");
        }
    }

    #[test]
    fn names_are_different() {
        let names: std::collections::BTreeSet<&str> = all().iter().map(|pattern| pattern.name).collect();
        assert_eq!(names.len(), all().len());
    }
}
