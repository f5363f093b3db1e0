//! Words that do not exist in VGDL, but that people, language models and other dialects use, each with the
//! VGDL words for its intended meaning. This table takes precedence over similar spelling, because a
//! similarly spelt word may have the opposite meaning.

mod meaning;
mod nouns;
mod parameters;
mod verbs;

use crate::limits::MAX_NAME;
pub(crate) use meaning::Meaning;
use meaning::means;
use nouns::{CLASSES, GAMES, SECTIONS, TERMINATIONS};
use parameters::{EFFECT_PARAMETERS, GAME_PARAMETERS, SPRITE_PARAMETERS, TERMINATION_PARAMETERS};
use verbs::EFFECTS;

/// The syntactic position of an unknown word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The first word of the file.
    Game,
    /// A parameter of the first line.
    GameParameter,
    /// A section name.
    Section,
    /// A sprite's class.
    Class,
    /// A sprite's parameter.
    SpriteParameter,
    /// An interaction's effect.
    Effect,
    /// An interaction's parameter.
    EffectParameter,
    /// A termination's class.
    Termination,
    /// A termination's parameter.
    TerminationParameter,
}

/// Returns the meaning of a word at a syntactic position, ignoring case and separators; `None` for an unknown word.
pub(crate) fn meaning(place: Place, word: &str) -> Option<&'static Meaning> {
    let plain: String =
        word.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect();
    // Words with letters outside ASCII have no entry in the tables.
    if plain.is_empty() || plain.len() < word.chars().filter(|c| c.is_alphanumeric()).count() {
        return None;
    }
    table(place).iter().find(|known| known.words.split(' ').any(|word| word == plain))
}

/// Returns the meaning of a word that differs by one letter from a word in the table. For any other class that ends
/// with `avatar`, returns the meaning for avatar classes. Returns `None` for all other words.
pub(crate) fn near_meaning(place: Place, word: &str) -> Option<&'static Meaning> {
    let plain = word.to_lowercase();
    if plain.len() > MAX_NAME {
        return None;
    }
    let near = |known: &str| known.len() > 4 && strsim::damerau_levenshtein(known, &plain) == 1;
    let found = table(place).iter().find(|known| known.words.split(' ').any(near));
    found.or_else(|| AVATAR.iter().find(|_| place == Place::Class && plain.ends_with("avatar")))
}

fn table(place: Place) -> &'static [Meaning] {
    match place {
        Place::Game => GAMES,
        Place::GameParameter => GAME_PARAMETERS,
        Place::Section => SECTIONS,
        Place::Class => CLASSES,
        Place::SpriteParameter => SPRITE_PARAMETERS,
        Place::Effect => EFFECTS,
        Place::EffectParameter => EFFECT_PARAMETERS,
        Place::Termination => TERMINATIONS,
        Place::TerminationParameter => TERMINATION_PARAMETERS,
    }
}

/// The meaning for all other avatar classes.
const AVATAR: &[Meaning] = &[means(
    "",
    &[],
    "use `MovingAvatar`, which walks in four directions; `arcade docs sprites` lists the other avatars",
)];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keywords;
    use std::collections::BTreeSet;

    const PLACES: [Place; 9] = [
        Place::Game,
        Place::GameParameter,
        Place::Section,
        Place::Class,
        Place::SpriteParameter,
        Place::Effect,
        Place::EffectParameter,
        Place::Termination,
        Place::TerminationParameter,
    ];

    #[test]
    fn a_word_has_one_meaning_at_a_place() {
        for place in PLACES {
            let mut seen = BTreeSet::new();
            for word in table(place).iter().flat_map(|known| known.words.split(' ')) {
                assert!(
                    !word.is_empty() && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit()),
                    "{word}"
                );
                assert!(seen.insert(word), "{word} has two meanings as {place:?}");
            }
        }
    }

    #[test]
    fn words_of_vgdl_are_not_foreign_and_words_to_write_are_of_vgdl() {
        for (place, known) in [
            (Place::Class, keywords::CLASSES),
            (Place::Effect, keywords::EFFECTS),
            (Place::Termination, keywords::TERMINATIONS),
        ] {
            for meaning in table(place) {
                assert!(meaning.write.iter().all(|word| known.contains(word)), "{meaning:?}");
                assert!(!meaning.write.is_empty() || !meaning.advice.is_empty(), "{meaning:?}");
            }
            let exact = |word: &&&str| {
                table(place).iter().any(|known| known.words.split(' ').any(|own| own == word.to_lowercase()))
            };
            assert_eq!(known.iter().find(exact), None);
        }
    }

    #[test]
    fn spelling_does_not_matter_and_avatars_are_avatars() {
        let writes = |place, word| meaning(place, word).map(|found| found.write);
        assert_eq!(writes(Place::Class, "Movable"), Some(&["Passive"][..]));
        assert_eq!(writes(Place::Effect, "remove_sprite"), Some(&["killSprite"][..]));
        assert_eq!(writes(Place::Class, "PlayerAvatar"), Some(&["MovingAvatar"][..]));
        assert!(
            near_meaning(Place::Class, "SwimmingAvatar")
                .is_some_and(|found| found.advice.contains("MovingAvatar"))
        );
        assert!(near_meaning(Place::Effect, "SwimmingAvatar").is_none());
        assert!(meaning(Place::Class, "Qüz").is_none() && meaning(Place::Class, "").is_none());
    }
}
