//! Names for one game: each role gets a word of the theme, and no word is used twice.

use super::role::Role;
use super::theme::Theme;
use engine::Sampler;

/// Assigns the names.
pub(crate) struct Naming {
    theme: &'static Theme,
    sampler: Sampler,
    taken: Vec<&'static str>,
}

impl Naming {
    pub(crate) fn new(theme: &'static Theme, sampler: Sampler) -> Naming {
        Naming { theme, sampler, taken: Vec::new() }
    }

    pub(crate) fn theme(&self) -> &'static Theme {
        self.theme
    }

    /// Draws a word for the role that the game does not use yet.
    ///
    /// # Panics
    /// If all are in use: a game gives no role to more sprite types than a theme has words for it.
    pub(crate) fn word(&mut self, role: Role) -> String {
        let mut free = self.theme.words(role);
        free.retain(|word| !self.taken.contains(word));
        let word = *self.sampler.choose(&free);
        self.taken.push(word);
        word.to_owned()
    }

    pub(crate) fn title(&mut self, hero: &str, title_word: &str) -> String {
        self.theme.title(hero, title_word, &mut self.sampler)
    }
}
