//! The assignment for a designer.

use crate::known::KnownGame;
use engine::{EFFECTS, SpriteClass, TERMINATIONS, nearest};
use generators::invention::MechanicInWords;
use serde::{Deserialize, Serialize};
use validators::Tier;

/// The maximum number of levels per game.
pub const MAX_LEVELS: usize = 20;
/// The maximum length of a theme, in bytes.
pub const MAX_THEME: usize = 500;

/// The assignment for a designer, which is the same for all drafts in a run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Brief {
    /// The number of levels per game.
    pub levels: usize,
    /// The theme of the games, in the user's words; `None` if the designer may choose a theme.
    pub theme: Option<String>,
    /// The minimum tier (difficulty class from 1 to 4) of each game's last level; `None` if no tier is required.
    pub tier: Option<Tier>,
    /// The sprite classes, effects, terminations and mechanics that each game must use. A game uses a mechanic if it
    /// uses all keywords of the mechanic.
    pub required: Vec<String>,
    /// The games from which each game must differ, in addition to the corpus, the kernels and earlier drafts.
    pub unlike: Vec<KnownGame>,
}

impl Brief {
    /// Checks the values that a user typed.
    ///
    /// # Errors
    /// Returns a message that states the first problem and suggests a solution.
    pub fn check(&self) -> Result<(), String> {
        if !(1..=MAX_LEVELS).contains(&self.levels) {
            return Err(format!("a game must have 1 to {MAX_LEVELS} levels, not {}", self.levels));
        }
        if let Some(theme) = &self.theme {
            if theme.trim().is_empty() {
                return Err("the theme is empty; describe it in a few words, or leave it out".to_owned());
            }
            if theme.len() > MAX_THEME {
                return Err(format!("the theme has {} bytes; the limit is {MAX_THEME}", theme.len()));
            }
        }
        self.required.iter().try_for_each(|word| check_word(word))
    }
}

/// Rejects a word that is not a sprite class, an effect, a termination or a mechanic.
fn check_word(word: &str) -> Result<(), String> {
    let classes = SpriteClass::ALL.iter().map(|class| class.name());
    let keywords = classes.chain(EFFECTS.iter().copied()).chain(TERMINATIONS.iter().copied());
    let words: Vec<&str> = keywords.chain(MechanicInWords::names()).collect();
    if words.contains(&word) {
        return Ok(());
    }
    let help = match nearest(word, words) {
        Some(near) => format!("did you mean `{near}`?"),
        None => "`arcade docs ontology` and `arcade docs mechanics` list them".to_owned(),
    };
    Err(format!("`{word}` is not a sprite class, an effect, a termination or a mechanic; {help}"))
}

/// Returns the keywords that a required word stands for: those of a mechanic, or the word itself if it is not a
/// mechanic.
pub(crate) fn keywords(word: &str) -> Vec<String> {
    MechanicInWords::of(word).map_or_else(|| vec![word.to_owned()], |mechanic| mechanic.keywords)
}

/// Returns `true` if the rules use a word outside comments.
pub(crate) fn uses(rules: &str, word: &str) -> bool {
    let is_in = |line: &str| {
        let code = line.split('#').next().unwrap_or_default();
        code.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').any(|token| token == word)
    };
    rules.lines().any(is_in)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn brief(required: &str) -> Brief {
        let required = vec![required.to_owned()];
        Brief { levels: 3, theme: None, tier: None, required, unlike: Vec::new() }
    }

    #[test]
    fn words_of_the_language_are_required() {
        for word in ["Chaser", "bounceForward", "SpriteCounterMore"] {
            assert_eq!(brief(word).check(), Ok(()), "{word}");
        }
        assert!(brief("chaser").check().unwrap_err().contains("did you mean `Chaser`?"));
        assert!(Brief { levels: 0, ..brief("Chaser") }.check().unwrap_err().contains("1 to 20 levels"));
        let theme = Some(" ".to_owned());
        assert!(Brief { theme, ..brief("Chaser") }.check().unwrap_err().contains("the theme is empty"));
    }

    #[test]
    fn mechanics_stand_for_their_keywords() {
        assert_eq!(brief("ignite").check(), Ok(()));
        assert_eq!(keywords("ignite"), ["killSprite", "spawnIfHasMore"]);
        assert_eq!(keywords("Chaser"), ["Chaser"]);
    }

    #[test]
    fn comments_use_no_words() {
        assert!(uses("  owl > Chaser stype=mouse\n", "Chaser"));
        assert!(!uses("  owl > PathChaser # Chaser\n", "Chaser"));
    }
}
