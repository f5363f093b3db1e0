//! The texts shared by a year's games.

use super::month::{Again, Sketch};
use crate::games::Cast;
use std::collections::BTreeMap;

/// The number of months within which no text should be repeated.
const YEAR: u32 = 12;

/// The last month in which each title, each set of type names and each sentence was used.
#[derive(Debug, Default)]
pub(super) struct Words {
    titles: BTreeMap<String, u32>,
    casts: BTreeMap<Cast, u32>,
    openings: BTreeMap<String, u32>,
    sentences: BTreeMap<String, u32>,
}

impl Words {
    /// Records the texts of a game in a month, and counts the texts already used within a year.
    pub(super) fn note(&mut self, month: u32, game: &Sketch, again: &mut Again) {
        again.titles += u32::from(is_again(&mut self.titles, game.title.clone(), month));
        again.casts += u32::from(is_again(&mut self.casts, game.cast.clone(), month));
        for (at, sentence) in sentences(&game.summary).enumerate() {
            if at == 0 {
                again.openings += u32::from(is_again(&mut self.openings, sentence.to_owned(), month));
            }
            again.sentences += u32::from(is_again(&mut self.sentences, sentence.to_owned(), month));
            again.all_sentences += 1;
        }
    }
}

/// Records a use in a month. Returns `true` if the last use was less than a year earlier.
fn is_again<K: Ord>(uses: &mut BTreeMap<K, u32>, key: K, month: u32) -> bool {
    uses.insert(key, month).is_some_and(|last| month < last + YEAR)
}

/// Returns the sentences of a text.
fn sentences(text: &str) -> impl Iterator<Item = &str> {
    text.split_inclusive(['.', '!', '?']).map(str::trim).filter(|sentence| !sentence.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_year_is_twelve_months() {
        let mut uses = BTreeMap::new();
        assert!(!is_again(&mut uses, "The Toll", 1));
        assert!(is_again(&mut uses, "The Toll", 1));
        assert!(is_again(&mut uses, "The Toll", 12));
        assert!(!is_again(&mut uses, "The Toll", 24));
        assert!(!is_again(&mut uses, "The Dam", 24));
    }

    #[test]
    fn sentences_end_with_their_mark() {
        let found: Vec<&str> = sentences("Run! The bear wakes. Feed it.").collect();
        assert_eq!(found, ["Run!", "The bear wakes.", "Feed it."]);
    }
}
