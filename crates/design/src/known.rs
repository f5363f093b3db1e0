//! Games from which a new game must differ.

use base::Digest;
use engine::Game;
use generators::kernels::KernelGenome;
use serde::{Deserialize, Serialize};
use validators::GameForm;
use validators::novelty::{NEAR, distance};

/// A game with its rules.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownGame {
    /// The game's name in messages.
    pub name: String,
    /// The game's VGDL text.
    pub rules: String,
}

/// The known game nearest to a new one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Nearest {
    /// The known game's name.
    pub name: String,
    /// The distance between the rules, from 0 (the same rules) to 1 (nothing in common).
    pub distance: f64,
}

impl Nearest {
    /// Returns `true` if the new game and the known one do not count as the same game.
    pub fn is_far(&self) -> bool {
        self.distance >= NEAR
    }
}

/// The forms of all known games.
#[derive(Clone, Debug, Default)]
pub struct Known {
    forms: Vec<(String, GameForm)>,
}

impl Known {
    /// Adds a game, under the name that messages about it use.
    pub fn push(&mut self, name: &str, game: &Game) {
        self.forms.push((name.to_owned(), GameForm::of(game)));
    }

    /// Adds one game for each form of each kernel. Cost: a few milliseconds per kernel.
    pub fn push_kernels(&mut self) {
        for kernel in KernelGenome::kernels() {
            for built in KernelGenome::all_of(kernel).iter().filter_map(|genome| genome.build().ok()) {
                self.push(&format!("the kernel {kernel}"), &built.game.rules);
            }
        }
    }

    /// Returns the known game nearest to the given game, or `None` if no game is known. Cost: O(known games × rules).
    pub fn nearest(&self, game: &Game) -> Option<Nearest> {
        let form = GameForm::of(game);
        let apart = self.forms.iter().map(|(name, other)| (name, distance(&form, other)));
        let (name, distance) = apart.reduce(|best, next| if next.1 < best.1 { next } else { best })?;
        Some(Nearest { name: name.clone(), distance })
    }

    /// Returns a digest of all forms and names, in the order in which the games were added.
    pub fn digest(&self) -> Digest {
        let lines: String =
            self.forms.iter().map(|(name, form)| format!("{name} {}\n", form.digest())).collect();
        Digest::of(lines.as_bytes())
    }
}
