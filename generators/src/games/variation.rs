//! Games varied by typed edits, and crossed: what search over games is made of.

use super::composition::{self, family};
use super::constructive::GameConfig;
use super::draft::{AVATAR, Draft, Part, Value};
use super::edit::{Edit, RuleAt};
use super::genome::{Fiction, GameGenome, Gene};
use super::goals;
use super::grafts::GRAFTS;
use super::movement::MOVEMENTS;
use super::pattern::{Goal, Pattern};
use super::ways;
use crate::Variation;
use engine::{Sampler, Seed};

/// Draws of a change, or of a crossing, before a candidate is given back as it was.
const ATTEMPTS: usize = 40;
/// Seeds that are tried for a candidate from nothing.
const SEEDS: u64 = 8;
/// Edits of one game at most: beyond that, one has to go before another comes.
const EDITS_AT_MOST: usize = 12;

/// A kind of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Change {
    /// One pattern more.
    Add,
    /// One pattern less.
    Remove,
    /// A pattern of the same family instead; the goal and the way of moving included.
    Replace,
    /// A pattern is built with another seed.
    Redraw,
    /// A parameter of a sprite type.
    Parameter,
    /// The class of a sprite type.
    Class,
    /// A rule between parts of any patterns.
    Graft,
    /// Another effect of a rule.
    Effect,
    /// One rule less.
    Drop,
    /// Another score.
    Score,
    /// More time, or less.
    Time,
    /// Another fiction.
    Fiction,
    /// An earlier edit is taken back.
    Undo,
}

/// All kinds, with how often each is drawn.
const CHANGES: [(Change, u32); 13] = [
    (Change::Add, 5),
    (Change::Remove, 2),
    (Change::Replace, 4),
    (Change::Redraw, 4),
    (Change::Parameter, 5),
    (Change::Class, 2),
    (Change::Graft, 6),
    (Change::Effect, 2),
    (Change::Drop, 1),
    (Change::Score, 1),
    (Change::Time, 1),
    (Change::Fiction, 1),
    (Change::Undo, 2),
];

/// Games as candidates of a search: drawn as [`ConstructiveGames`](super::ConstructiveGames) does, changed by typed edits,
/// crossed by their patterns.
///
/// Whatever comes out builds: rules that compile without problems or warnings, one avatar, a way to win by the rules, and
/// words that are true of them. Nothing is judged here: whether anyone wins, and whether it is any fun, is for others to
/// say. Cost: about a millisecond for a mutation.
#[derive(Clone, Debug, Default)]
pub struct GameVariation {
    config: GameConfig,
}

impl GameVariation {
    /// Games of these kinds.
    pub fn new(config: GameConfig) -> GameVariation {
        GameVariation { config }
    }

    /// A genome with one change of that kind; none if this draw finds nothing to change so.
    fn changed(&self, parent: &GameGenome, change: Change, sampler: &mut Sampler) -> Option<GameGenome> {
        let mut genome = parent.clone();
        match change {
            Change::Add => {
                let number = pick(&composition::company().collect::<Vec<_>>(), sampler)?;
                genome.genes.push(Gene { pattern: number, seed: fresh(sampler) });
            }
            Change::Remove => {
                let at = pick(&(2..genome.genes.len()).collect::<Vec<_>>(), sampler)?;
                genome.genes.remove(at);
            }
            Change::Replace => self.replace(&mut genome, sampler)?,
            Change::Redraw => {
                let at = sampler.below(genome.genes.len());
                genome.genes[at].seed = fresh(sampler);
            }
            Change::Time => {
                let (least, most) = genome.goal.ticks;
                genome.time = sampler.between((least * 2 / 3).max(2) as usize, most as usize * 3 / 2) as u32;
            }
            Change::Fiction => genome.fiction = Fiction::draw(genome.kind(), fresh(sampler)),
            Change::Undo => {
                let at = pick(&(0..genome.edits.len()).collect::<Vec<_>>(), sampler)?;
                genome.edits.remove(at);
            }
            _ => {
                if genome.edits.len() >= EDITS_AT_MOST {
                    return None;
                }
                let edit = edit(&genome.draft().0, change, sampler)?;
                genome.edits.push(edit);
            }
        }
        Some(genome)
    }

    /// Another pattern of the same family in the place of one; with another goal, the company that it does not go with
    /// leaves.
    fn replace(&self, genome: &mut GameGenome, sampler: &mut Sampler) -> Option<()> {
        let at = sampler.below(genome.genes.len());
        let old = genome.genes[at].pattern;
        if at == 1 {
            let goals: Vec<&'static Goal> =
                goals::all().into_iter().filter(|goal| self.allows(goal)).collect();
            let goal = pick(&goals, sampler)?;
            genome.goal = goal;
            genome.fiction.deed = goal.kind.deed(sampler);
            genome.genes[1] = Gene { pattern: &goal.pattern, seed: fresh(sampler) };
            let (least, most) = goal.ticks;
            genome.time = sampler.between(least as usize, most as usize) as u32;
            let rest = genome.genes.split_off(2);
            if !goal.hero.iter().all(|feature| genome.genes[0].pattern.gives.contains(feature)) {
                genome.genes[0] = Gene { pattern: pick(&fitting(goal), sampler)?, seed: fresh(sampler) };
            }
            join(genome, rest);
        } else {
            let family =
                |pattern: &&'static Pattern| family(pattern) == family(old) && pattern.name != old.name;
            let others: Vec<&'static Pattern> =
                MOVEMENTS.iter().chain(composition::company()).filter(family).collect();
            genome.genes[at] = Gene { pattern: pick(&others, sampler)?, seed: fresh(sampler) };
        }
        Some(())
    }

    fn allows(&self, goal: &Goal) -> bool {
        self.config.kinds.contains(&goal.kind)
    }

    /// The way of moving, the goal and the fiction of one; company and edits of both.
    fn crossed(&self, one: &GameGenome, two: &GameGenome, sampler: &mut Sampler) -> GameGenome {
        let mut child = one.clone();
        let mut rest: Vec<Gene> = child.genes.split_off(2);
        rest.extend(&two.genes[2..]);
        sampler.shuffle(&mut rest);
        rest.retain(|_| sampler.ratio(2, 3));
        join(&mut child, rest);
        child.edits.extend(&two.edits);
        child.edits.retain(|_| sampler.ratio(2, 3));
        child.edits.truncate(EDITS_AT_MOST);
        child
    }
}

/// The ways of moving with which a goal can be reached.
fn fitting(goal: &Goal) -> Vec<&'static Pattern> {
    let fits = |pattern: &&'static Pattern| goal.hero.iter().all(|feature| pattern.gives.contains(feature));
    MOVEMENTS.iter().filter(fits).collect()
}

/// Takes in those genes that the others go with; twice over, for those that need what comes later.
fn join(genome: &mut GameGenome, mut genes: Vec<Gene>) {
    for _ in 0..2 {
        genes.retain(|&gene| {
            let joins = composition::admits(genome.goal, &genome.patterns(), gene.pattern);
            if joins {
                genome.genes.push(gene);
            }
            !joins
        });
    }
}

impl Variation for GameVariation {
    type Candidate = GameGenome;

    fn create(&self, seed: Seed) -> Option<GameGenome> {
        let genomes =
            (0..SEEDS).filter_map(|number| GameGenome::draw(&self.config, seed.child("genome", number)).ok());
        genomes.into_iter().find(|genome| genome.build().is_ok())
    }

    /// One change; the parent itself if none of many draws gives a game.
    fn mutate(&self, parent: &GameGenome, sampler: &mut Sampler) -> GameGenome {
        let key = parent.key();
        let weights = CHANGES.map(|(_, weight)| weight);
        let changed = (0..ATTEMPTS).find_map(|_| {
            let change = CHANGES[sampler.weighted(&weights).unwrap_or(0)].0;
            let child = self.changed(parent, change, sampler)?;
            settled(child, |child| *child != key)
        });
        changed.unwrap_or_else(|| parent.clone())
    }

    /// A game with the goal of the first and company from both; a mutation of the first if none of several draws gives one.
    fn cross(&self, one: &GameGenome, two: &GameGenome, sampler: &mut Sampler) -> GameGenome {
        let keys = [one.key(), two.key()];
        let crossed = (0..ATTEMPTS).find_map(|_| {
            let (one, two) = if sampler.ratio(1, 2) { (one, two) } else { (two, one) };
            let child = self.crossed(one, two, sampler);
            settled(child, |child| !keys.contains(child))
        });
        crossed.unwrap_or_else(|| self.mutate(one, sampler))
    }
}

/// The genome without the edits that change nothing any more, if it makes sense, is new and builds.
fn settled(mut genome: GameGenome, is_new: impl Fn(&engine::Digest) -> bool) -> Option<GameGenome> {
    if !composition::is_coherent(genome.goal, &genome.patterns()) {
        return None;
    }
    genome.edits = genome.draft().1;
    (is_new(&genome.key()) && genome.build().is_ok()).then_some(genome)
}

fn fresh(sampler: &mut Sampler) -> Seed {
    Seed::from_text("gene").child("draw", sampler.bits())
}

/// One of them, if there are any.
fn pick<T: Copy>(options: &[T], sampler: &mut Sampler) -> Option<T> {
    if options.is_empty() { None } else { Some(*sampler.choose(options)) }
}

/// An edit of that kind; none if this draw finds nothing to edit so.
fn edit(draft: &Draft, change: Change, sampler: &mut Sampler) -> Option<Edit> {
    let parts: Vec<Part> = draft.parts().filter(|&part| !draft.sprite(part).gone).collect();
    match change {
        Change::Parameter => {
            let mut options: Vec<(Part, &'static str, Value, (u32, u32))> = Vec::new();
            for &part in &parts {
                let params = draft.sprite(part).params.iter();
                options
                    .extend(params.filter_map(|&(key, value)| {
                        Some((part, key, value, ways::range(draft, part, key)?))
                    }));
            }
            let (part, key, value, range) = pick(&options, sampler)?;
            Some(Edit::Param { of: draft.site(part), key, value: moved(value, range, sampler)? })
        }
        Change::Class => {
            // What the goal is about moves as the goal says.
            let free = |&&part: &&Part| draft.sprite(part).gene != Some(1);
            let part = *pick(&parts.iter().filter(free).collect::<Vec<_>>(), sampler)?;
            let class = pick(&ways::siblings(draft, part), sampler)?;
            let after = ways::has_target(class).then(|| draft.site(AVATAR));
            Some(Edit::Class { of: draft.site(part), class, after })
        }
        Change::Graft => {
            let places = GRAFTS
                .iter()
                .flat_map(|graft| graft.places(draft).into_iter().map(move |place| (graft, place)));
            let places: Vec<_> = places.collect();
            let weights: Vec<u32> = places.iter().map(|(graft, _)| graft.weight).collect();
            let (graft, place) = places[sampler.weighted(&weights)?];
            let [first, second, third] = place.map(|part| draft.site(part));
            Some(Edit::Graft { graft, first, second, third })
        }
        Change::Effect => {
            let rules = draft.rules.iter().enumerate();
            let options = rules.flat_map(|(at, rule)| {
                ways::effects(draft, rule).into_iter().map(move |effect| (at, effect))
            });
            let (at, effect) = pick(&options.collect::<Vec<_>>(), sampler)?;
            let effect = effect.map(|part| Some(draft.site(part)))?;
            Some(Edit::Effect { rule: RuleAt::of(draft, at, 0), effect })
        }
        Change::Drop => {
            // What follows from bodies keeps the board together, and the goal lives by its rules.
            let free = |&at: &usize| draft.rules[at].gene.is_some_and(|gene| gene > 1);
            let at = pick(&(0..draft.rules.len()).filter(free).collect::<Vec<_>>(), sampler)?;
            Some(Edit::Drop { rule: RuleAt::of(draft, at, 0) })
        }
        Change::Score => {
            let scores = |&at: &usize| draft.rules[at].score != 0;
            let at = pick(&(0..draft.rules.len()).filter(scores).collect::<Vec<_>>(), sampler)?;
            let old = draft.rules[at].score;
            let size = sampler.between(1, 10) as i32;
            let score = if old < 0 { -(size.min(5)) } else { size };
            (score != old).then(|| Edit::Score { rule: RuleAt::of(draft, at, 0), score })
        }
        _ => None,
    }
}

/// A value nearby, within the range; hundredths go by fives.
fn moved(value: Value, (least, most): (u32, u32), sampler: &mut Sampler) -> Option<Value> {
    let near = |old: u32, step: u32, sampler: &mut Sampler| {
        let reach = (old / 3).max(step);
        let new =
            sampler.between(old.saturating_sub(reach).max(least) as usize, (old + reach).max(least) as usize);
        let new = (new as u32).min(most);
        (new != old).then_some(new)
    };
    match value {
        Value::Count(old) => near(old, 1, sampler).map(Value::Count),
        Value::Hundredths(old) => near(old, 5, sampler).map(Value::Hundredths),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::{Analysis, Game};
    use std::collections::BTreeSet;

    fn seed(name: &str) -> Seed {
        Seed::from_text("game variation").child(name, 0)
    }

    /// Builds, can be won by the rules, has one avatar and words that are sentences.
    fn check(genome: &GameGenome) {
        let made = genome.build().unwrap_or_else(|error| panic!("{genome:?}: {error}"));
        let game = Game::compile(&made.description).unwrap();
        assert_eq!(game.warnings(), []);
        assert!(Analysis::of(&game).can_win() && Analysis::of(&game).can_lose(), "{genome:?}");
        let placed = made.description.mapping.iter().filter(|line| line.symbol == 'A').count();
        assert_eq!(placed, 1);
        for text in [&made.summary, &made.goal] {
            assert!(text.ends_with('.') && text.starts_with(|c: char| c.is_uppercase()), "{text}");
            assert!(!text.contains("  ") && !text.contains(" ,") && !text.contains(".."), "{text}");
        }
    }

    #[test]
    fn what_is_varied_stays_a_game() {
        let variation = GameVariation::default();
        let (mut same, mut total, mut keys) = (0, 0, BTreeSet::new());
        let mut names = BTreeSet::new();
        for chain in 0..60 {
            let mut sampler = seed("chain").child("chain", chain).sampler();
            let create =
                |number: u64| variation.create(seed("create").child("game", chain).child("n", number));
            let (mut genome, other) = (create(0).unwrap(), create(1).unwrap());
            for turn in 0..30 {
                let child = if turn % 6 == 5 {
                    variation.cross(&genome, &other, &mut sampler)
                } else {
                    variation.mutate(&genome, &mut sampler)
                };
                check(&child);
                same += u32::from(child.key() == genome.key());
                total += 1;
                keys.insert(child.key().to_string());
                names.extend(child.edits.iter().map(Edit::name));
                genome = child;
            }
        }
        assert!(same * 50 <= total, "{same} of {total} changed nothing");
        assert!(keys.len() * 10 >= total as usize * 9, "{} different games of {total}", keys.len());
        let missing: Vec<&str> =
            GRAFTS.iter().map(|graft| graft.name).filter(|name| !names.contains(name)).collect();
        assert_eq!(missing, Vec::<&str>::new());
    }

    #[test]
    fn the_same_draws_give_the_same() {
        let walk = || {
            let variation = GameVariation::default();
            let mut sampler = seed("walk").sampler();
            let mut genome = variation.create(seed("walk")).unwrap();
            for _ in 0..30 {
                genome = variation.mutate(&genome, &mut sampler);
            }
            genome.build().unwrap()
        };
        assert_eq!(walk(), walk());
    }
}
