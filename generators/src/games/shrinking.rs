//! Smaller games: reductions of a game by one thing at a time.

use super::edit::{Edit, RuleAt};
use super::genome::GameGenome;
use super::{assemble, composition};
use std::collections::BTreeSet;

impl GameGenome {
    /// All genomes with one thing less that still build, without duplicates: one edit, one pattern, one sprite type with
    /// the rules about it, one rule, or one partner of a rule is removed. Every result is strictly smaller than this
    /// genome, so repeated shrinking terminates. Callers judge whether the removed thing was redundant. Cost: some tens
    /// of builds.
    pub fn shrunk_once(&self) -> Vec<GameGenome> {
        let mut smaller: Vec<GameGenome> = Vec::new();
        for at in (0..self.edits.len()).rev() {
            let mut genome = self.clone();
            genome.edits.remove(at);
            smaller.push(genome);
        }
        for at in (0..self.genes.len()).rev() {
            let mut genome = self.clone();
            genome.genes.remove(at);
            if composition::is_coherent(self.goal, &genome.patterns()) {
                smaller.push(genome);
            }
        }
        let draft = self.draft().0;
        let sites = draft.parts().filter(|&part| !draft.sprite(part).removed).map(|part| draft.site(part));
        let types = sites.map(|of| Edit::Without { of });
        let rules = (0..draft.rules.len()).map(|rule| Edit::Drop { rule: RuleAt::of(&draft, rule, 0) });
        let pairs = draft.rules.iter().enumerate().filter(|(_, rule)| rule.second.len() > 1);
        let pairs = pairs.flat_map(|(at, rule)| (0..rule.second.len()).map(move |partner| (at, partner)));
        let spared = pairs.map(|(at, partner)| Edit::Spare { rule: RuleAt::of(&draft, at, partner) });
        for edit in types.chain(rules).chain(spared) {
            let mut genome = self.clone();
            genome.edits.push(edit);
            smaller.push(genome);
        }
        let (mut seen, size) = (BTreeSet::from([self.key()]), self.size());
        smaller.retain_mut(|genome| {
            genome.edits = genome.draft().1;
            genome.size() < size && seen.insert(genome.key()) && genome.build().is_ok()
        });
        smaller
    }

    /// The number of sprite types and of pairs with a rule, then the number of genes and edits.
    fn size(&self) -> (usize, usize) {
        let game = assemble::describe(&self.draft().0);
        let pairs: usize = game.interactions.iter().map(|line| line.second.len()).sum();
        (game.sprite_lines().len() + pairs, self.genes.len() + self.edits.len())
    }
}

#[cfg(test)]
mod tests {
    use crate::Variation;
    use crate::games::GameVariation;
    use engine::Seed;

    #[test]
    fn shrunk_games_are_games() {
        let variation = GameVariation::default();
        let seed = Seed::from_text("shrinking");
        for number in 0..12 {
            let mut sampler = seed.child("edits", number).sampler();
            let mut genome = variation.create(seed.child("game", number)).unwrap();
            for _ in 0..10 {
                genome = variation.mutate(&genome, &mut sampler);
            }
            let lines = |genome: &crate::games::GameGenome| {
                let game = genome.build().unwrap().description;
                let seconds: usize = game.interactions.iter().map(|line| line.second.len()).sum();
                (game.sprites.len(), game.interactions.len(), seconds)
            };
            let smaller = genome.shrunk_once();
            assert!(smaller.len() >= 3, "{genome:?}");
            let (sprites, rules, pairs) = lines(&genome);
            let shrunk = smaller.iter().filter(|genome| {
                let (fewer, less, lighter) = lines(genome);
                fewer < sprites || less < rules || lighter < pairs
            });
            assert!(shrunk.count() >= 2, "{genome:?}");
        }
    }
}
