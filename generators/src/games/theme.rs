//! A fiction: where games take place, and what things are called there.

use super::role::{Role, Words};
use super::themes;
use engine::Sampler;

/// One fiction.
pub(crate) struct Theme {
    /// One word, for configurations and provenance.
    pub(crate) name: &'static str,
    /// Where the game takes place, with its preposition.
    pub(crate) place: &'static str,
    /// Adjectives for titles, separated by blanks.
    pub(crate) adjectives: &'static str,
    /// Nouns for titles, separated by blanks.
    pub(crate) nouns: &'static str,
    /// The colour of the floor, a light one: what lies and moves on it has others.
    pub(crate) floor: &'static str,
    /// The colour of walls.
    pub(crate) walls: &'static str,
    /// What things are called.
    pub(crate) words: Words,
}

impl Theme {
    /// All fictions, in a fixed order: draws depend on it.
    pub(crate) const ALL: &[&Theme] = &[
        &themes::tidepool::THEME,
        &themes::library::THEME,
        &themes::beehive::THEME,
        &themes::harbour::THEME,
        &themes::cellar::THEME,
        &themes::railyard::THEME,
        &themes::observatory::THEME,
        &themes::bakery::THEME,
        &themes::glacier::THEME,
        &themes::swamp::THEME,
        &themes::theatre::THEME,
        &themes::caravan::THEME,
    ];

    /// The words for one role.
    pub(crate) fn words(&self, role: Role) -> Vec<&'static str> {
        self.words.of(role).split(' ').collect()
    }

    /// A title in the fiction: of the place, of what one does there, or of who does it.
    pub(crate) fn title(&self, hero: &str, deed: &str, sampler: &mut Sampler) -> String {
        let adjectives: Vec<&str> = self.adjectives.split(' ').collect();
        let nouns: Vec<&str> = self.nouns.split(' ').collect();
        let (adjective, noun) = (sampler.choose(&adjectives), sampler.choose(&nouns));
        match sampler.below(4) {
            0 | 1 => format!("The {adjective} {noun}"),
            2 => format!("{deed} at the {adjective} {noun}"),
            _ => format!("The {hero}'s {deed}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Any patterns may meet in one game: each role has a word of its own, fit to be a sprite type in VGDL.
    #[test]
    fn no_word_serves_two_roles() {
        let reserved = ["wall", "avatar", "eos", "time", "up", "down", "left", "right", "none", "nil"];
        for theme in Theme::ALL {
            let words: Vec<&str> = Role::ALL.iter().flat_map(|&role| theme.words(role)).collect();
            let distinct: BTreeSet<&str> = words.iter().copied().collect();
            assert_eq!(distinct.len(), words.len(), "{}", theme.name);
            for word in words {
                assert!(word.chars().all(|c| c.is_ascii_alphabetic()), "{}: {word}", theme.name);
                assert!(word.starts_with(|c: char| c.is_ascii_lowercase()), "{}: {word}", theme.name);
                assert!(!reserved.contains(&word), "{}: {word}", theme.name);
            }
        }
    }

    /// Sentences put an article before a word or make it plural ("bear traps lie in wait"): a word that is plural
    /// already reads wrong in them. Ground, walls and rubble are told as they stand.
    #[test]
    fn words_are_singular() {
        let singular = |word: &str| {
            !word.ends_with('s')
                || word == "lens"
                || ["ss", "us", "is", "as"].iter().any(|ending| word.ends_with(ending))
        };
        for theme in Theme::ALL {
            for &role in
                Role::ALL.iter().filter(|role| !matches!(role, Role::Floor | Role::Wall | Role::Rubble))
            {
                for word in theme.words(role) {
                    assert!(singular(word), "{}: {role:?} {word}", theme.name);
                }
            }
        }
    }
}
