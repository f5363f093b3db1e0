//! The games of a set so far, from which later games must differ.

use super::cast::Cast;
use crate::games::candidate::{Candidate, MadeGame};
use crate::pipeline::NEAR_KNOWN;
use engine::Game;
use generators::invention::share_idea;
use generators::kernels::KernelGenome;
use std::collections::{BTreeMap, BTreeSet};
use validators::novelty::GameForm;

/// The games of a set so far. No two games have similar rules or share a title, most of their type names, or an idea.
#[derive(Default)]
pub(crate) struct Company {
    forms: Vec<GameForm>,
    titles: BTreeSet<String>,
    casts: Vec<Cast>,
    /// The patterns of each game.
    patterns: Vec<Vec<String>>,
    /// The scenes (themes) of the games.
    pub(crate) scenes: BTreeSet<String>,
    /// The number of games in each family of kernels (hand-written designs) that hardly differ from each other.
    pub(crate) families: Families,
}

/// The number of games in each family of kernels (hand-written designs) that hardly differ from each other.
#[derive(Clone, Default)]
pub(crate) struct Families(BTreeMap<String, usize>);

impl Families {
    /// Returns the number of games from a kernel (hand-written design) and from all kernels that are nearly the same.
    pub(crate) fn games_of(&self, kernel: &str) -> usize {
        self.0.get(KernelGenome::family(kernel)).copied().unwrap_or(0)
    }

    /// Counts a game from this kernel (hand-written design).
    pub(crate) fn count(&mut self, kernel: &str) {
        *self.0.entry(KernelGenome::family(kernel).to_owned()).or_default() += 1;
    }
}

impl Company {
    /// Returns the reason why a game must be rejected regardless of its levels, if there is one.
    pub(crate) fn objection(&self, candidate: &Candidate) -> Option<&'static str> {
        self.objection_to(&candidate.game, &candidate.title)
    }

    fn objection_to(&self, game: &Game, title: &str) -> Option<&'static str> {
        if self.forms.is_empty() {
            return None;
        }
        if self.titles.contains(title) {
            return Some("duplicate title");
        }
        let cast = Cast::of(game);
        if self.casts.iter().any(|other| cast.is_shared(other)) {
            return Some("duplicate cast");
        }
        let form = GameForm::of(game);
        self.forms.iter().any(|other| form.is_near(other)).then_some(NEAR_KNOWN)
    }

    /// Admits the game, or returns the reason why it is rejected.
    pub(crate) fn admit(&mut self, made: &MadeGame) -> Result<(), &'static str> {
        if let Some(why) = self.objection_to(&made.game, &made.card.title) {
            return Err(why);
        }
        let origin = &made.card.origin;
        if self.patterns.iter().any(|other| share_idea(other, origin.patterns())) {
            return Err("the idea of another game");
        }
        origin.kernel().into_iter().for_each(|kernel| self.families.count(kernel));
        self.titles.insert(made.card.title.clone());
        self.casts.push(Cast::of(&made.game));
        self.forms.push(GameForm::of(&made.game));
        self.patterns.push(origin.patterns().to_vec());
        self.scenes.extend(origin.scene().map(str::to_owned));
        Ok(())
    }
}
