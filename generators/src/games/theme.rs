//! Themes: the setting of a game, and the names of its things.

use super::role::{Role, Words};
use super::themes;
use base::Sampler;

pub(crate) struct Theme {
    /// The identifier, for configurations and provenance.
    pub(crate) name: &'static str,
    /// The place where the game is set, with its preposition.
    pub(crate) place: &'static str,
    /// Adjectives for titles, separated by blanks.
    pub(crate) adjectives: &'static str,
    /// Nouns for titles, separated by blanks.
    pub(crate) nouns: &'static str,
    /// The colour of the floor, a light one; things on it have other colours.
    pub(crate) floor: &'static str,
    /// The colour of walls.
    pub(crate) walls: &'static str,
    /// The words for the roles.
    pub(crate) words: Words,
}

impl Theme {
    /// All themes, in a fixed order that draws depend on.
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

    pub(crate) fn words(&self, role: Role) -> Vec<&'static str> {
        self.words.of(role).split(' ').collect()
    }

    /// Draws a title under the theme: one of the place, of the task there, or of the hero.
    pub(crate) fn title(&self, hero: &str, title_word: &str, sampler: &mut Sampler) -> String {
        let adjectives: Vec<&str> = self.adjectives.split(' ').collect();
        let nouns: Vec<&str> = self.nouns.split(' ').collect();
        let (adjective, noun) = (sampler.choose(&adjectives), sampler.choose(&nouns));
        match sampler.below(4) {
            0 | 1 => format!("The {adjective} {noun}"),
            2 => format!("{title_word} at the {adjective} {noun}"),
            _ => format!("The {hero}'s {title_word}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// Any patterns may be combined in one game, so each role has words of its own, valid as sprite types in VGDL.
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

    /// Sentences put an article before a word or make it plural ("bear traps lie in wait"), so plural words would be
    /// ungrammatical in them. The words for floor, walls and rubble are used unchanged.
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
