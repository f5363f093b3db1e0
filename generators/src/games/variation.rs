//! Variation of games for search: typed edits, and crossover.

use super::changes::{Change, edit, pick};
use super::composition::{self, family};
use super::constructive::GameConfig;
use super::genome::{GameGenome, Gene, ThemeDraw};
use super::goals;
use super::mechanics;
use super::movement::MOVEMENTS;
use super::pattern::{Goal, Pattern};
use crate::Variation;
use engine::{Sampler, Seed};

/// The number of draws of a change, or of a crossover, before a candidate is returned unchanged.
const ATTEMPTS: usize = 40;
/// The number of seeds to try for a candidate from nothing.
const SEEDS: u64 = 8;
/// The maximum number of edits of a game: beyond that, one has to be removed before another is added.
const MAX_EDITS: usize = 12;

/// Games as candidates of a search: drawn like those of [`ConstructiveGames`](super::ConstructiveGames), changed by typed
/// edits, crossed by their patterns.
///
/// All results build: their rules compile without errors or warnings, with one avatar, a way to win by the rules, and
/// texts that are true of them. Nothing is evaluated here: other code judges whether the games are winnable in play, and
/// fun. Cost: about a millisecond for a mutation.
#[derive(Clone, Debug, Default)]
pub struct GameVariation {
    config: GameConfig,
}

impl GameVariation {
    /// Creates a variation of games of these kinds.
    pub fn new(config: GameConfig) -> GameVariation {
        GameVariation { config }
    }

    /// Returns a genome with one change of that kind; `None` if this draw finds nothing to change.
    fn changed(&self, parent: &GameGenome, change: Change, sampler: &mut Sampler) -> Option<GameGenome> {
        let mut genome = parent.clone();
        match change {
            Change::Add => {
                let number = pick(&composition::companions().collect::<Vec<_>>(), sampler)?;
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
            Change::Theme => genome.theme_draw = ThemeDraw::draw(genome.kind(), fresh(sampler)),
            Change::Undo => {
                let at = pick(&(0..genome.edits.len()).collect::<Vec<_>>(), sampler)?;
                genome.edits.remove(at);
            }
            _ => {
                if genome.edits.len() >= MAX_EDITS {
                    return None;
                }
                let edit = edit(&genome.draft().0, change, sampler)?;
                genome.edits.retain(|earlier| !edit.replaces(earlier));
                genome.edits.push(edit);
            }
        }
        Some(genome)
    }

    /// Replaces a pattern by another of the same family. With another goal, patterns that do not go with it are removed.
    fn replace(&self, genome: &mut GameGenome, sampler: &mut Sampler) -> Option<()> {
        let at = sampler.below(genome.genes.len());
        let old = genome.genes[at].pattern;
        if at == 1 {
            let goals: Vec<&'static Goal> =
                goals::all().into_iter().filter(|goal| self.allows(goal)).collect();
            let goal = pick(&goals, sampler)?;
            genome.goal = goal;
            genome.theme_draw.title_word = goal.kind.title_word(sampler);
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
                MOVEMENTS.iter().chain(composition::companions()).filter(family).collect();
            genome.genes[at] = Gene { pattern: pick(&others, sampler)?, seed: fresh(sampler) };
        }
        Some(())
    }

    fn allows(&self, goal: &Goal) -> bool {
        self.config.kinds.contains(&goal.kind)
    }

    /// Takes the way of moving, the goal and the theme of one; other patterns and edits come from both.
    fn crossed(&self, one: &GameGenome, two: &GameGenome, sampler: &mut Sampler) -> GameGenome {
        let mut child = one.clone();
        let mut rest: Vec<Gene> = child.genes.split_off(2);
        rest.extend(&two.genes[2..]);
        sampler.shuffle(&mut rest);
        rest.retain(|_| sampler.ratio(2, 3));
        join(&mut child, rest);
        child.edits.extend(&two.edits);
        child.edits.retain(|_| sampler.ratio(2, 3));
        child.edits.truncate(MAX_EDITS);
        child
    }
}

/// The ways of moving with which a goal can be reached.
fn fitting(goal: &Goal) -> Vec<&'static Pattern> {
    let fits = |pattern: &&'static Pattern| goal.hero.iter().all(|feature| pattern.gives.contains(feature));
    MOVEMENTS.iter().filter(fits).collect()
}

/// Adds those genes that the others go with; in two passes, for those that need a later one.
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

    /// Makes one change; returns the parent itself if none of many draws gives a game.
    fn mutate(&self, parent: &GameGenome, sampler: &mut Sampler) -> GameGenome {
        let key = parent.key();
        let changed = (0..ATTEMPTS).find_map(|_| {
            let change = Change::draw(sampler);
            let child = self.changed(parent, change, sampler)?;
            validated(child, |child| *child != key)
        });
        changed.unwrap_or_else(|| parent.clone())
    }

    /// Returns a game with the goal of one parent and patterns from both; a mutation of the first parent if none of
    /// several draws gives one.
    fn cross(&self, one: &GameGenome, two: &GameGenome, sampler: &mut Sampler) -> GameGenome {
        let keys = [one.key(), two.key()];
        let crossed = (0..ATTEMPTS).find_map(|_| {
            let (one, two) = if sampler.ratio(1, 2) { (one, two) } else { (two, one) };
            let child = self.crossed(one, two, sampler);
            validated(child, |child| !keys.contains(child))
        });
        crossed.unwrap_or_else(|| self.mutate(one, sampler))
    }
}

/// Returns the genome without the edits that have no effect any more, if it is coherent, new and builds.
fn validated(mut genome: GameGenome, is_new: impl Fn(&engine::Digest) -> bool) -> Option<GameGenome> {
    if !composition::is_coherent(genome.goal, &genome.patterns()) {
        return None;
    }
    let (draft, made) = genome.draft();
    genome.edits = made;
    let linked = mechanics::dependencies(&draft) > 0 && mechanics::is_whole(&draft);
    (linked && is_new(&genome.key()) && genome.build().is_ok()).then_some(genome)
}

fn fresh(sampler: &mut Sampler) -> Seed {
    Seed::from_text("gene").child("draw", sampler.bits())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::edit::Edit;
    use crate::games::grafts::GRAFTS;
    use engine::{Analysis, Game};
    use std::collections::BTreeSet;

    fn seed(name: &str) -> Seed {
        Seed::from_text("game variation").child(name, 0)
    }

    /// Checks that a genome builds a game that can be won by the rules, with one avatar and well-formed sentences.
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
    fn varied_games_are_games() {
        let variation = GameVariation::default();
        let (mut same, mut total, mut keys) = (0, 0, BTreeSet::new());
        let mut names = BTreeSet::new();
        for chain in 0..100 {
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
    fn equal_draws_give_equal_games() {
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
