//! Sentences with placeholders for a game's nouns: `<hero>`, `<a hero>`, `<heroes>`, `<Hero>`.

use crate::games::english;
use std::collections::BTreeMap;

/// The nouns for a game's types, written as VGDL names.
pub(crate) type Nouns = BTreeMap<String, String>;

/// Inserts nouns into a sentence. The noun for `<Hero>` is capitalised.
///
/// # Errors
/// Returns an error if a name is not a type, or if a bracket is unmatched.
pub(crate) fn fill(text: &str, nouns: &Nouns) -> Result<String, String> {
    filled(text, nouns, english::capital)
}

/// Inserts nouns into a title. Every word in the noun for `<Hero>` is capitalised.
pub(crate) fn title(text: &str, nouns: &Nouns) -> Result<String, String> {
    filled(text, nouns, english::headline)
}

fn filled(text: &str, nouns: &Nouns, capital: fn(&str) -> String) -> Result<String, String> {
    let mut filled = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('<') {
        let (inside, after) =
            after.split_once('>').ok_or_else(|| format!("a `<` without a matching `>` in `{text}`"))?;
        filled.push_str(before);
        filled.push_str(
            &phrase(inside, nouns, capital)
                .ok_or_else(|| format!("`<{inside}>` does not name a type in `{text}`"))?,
        );
        rest = after;
    }
    filled.push_str(rest);
    Ok(filled)
}

fn phrase(inside: &str, nouns: &Nouns, headline: fn(&str) -> String) -> Option<String> {
    let (article, word) = match inside.split_once(' ') {
        Some(("a" | "an" | "A" | "An", word)) => (true, word),
        Some((the @ ("the" | "The"), word)) => {
            return Some(format!("{the} {}", phrase(word, nouns, headline)?));
        }
        Some(_) => return None,
        None => (false, inside),
    };
    let capital = inside.starts_with(|c: char| c.is_ascii_uppercase());
    let mut letters = word.chars();
    let small: String = letters.next()?.to_lowercase().chain(letters).collect();
    let noun = |name: &str| nouns.get(name).map(|noun| english::spaced(noun));
    let phrase = match noun(&small) {
        Some(noun) if article => english::one(&noun),
        Some(noun) => noun,
        None => {
            let plural_of = |stype: &&String| english::plural(stype) == small;
            english::plural(&noun(nouns.keys().find(plural_of)?)?)
        }
    };
    Some(if capital { headline(&phrase) } else { phrase })
}

/// Returns `true` if a sentence contains a placeholder for a type, in any form.
pub(crate) fn tells_of(sentence: &str, stype: &str) -> bool {
    let only = Nouns::from([(stype.to_owned(), stype.to_owned())]);
    sentence
        .split('<')
        .skip(1)
        .filter_map(|rest| rest.split_once('>'))
        .any(|(inside, _)| fill(&format!("<{inside}>"), &only).is_ok())
}

/// Capitalises a sentence, and adds a full stop if it lacks final punctuation.
pub(crate) fn sentence(text: &str) -> String {
    let text = english::capital(text.trim());
    if text.ends_with(['.', '?', '!']) { text } else { text + "." }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nouns_take_the_form_that_is_asked_for() {
        let nouns = Nouns::from([("key".into(), "ironKey".into()), ("wolf".into(), "otter".into())]);
        let check = |text: &str, expect: &str| assert_eq!(fill(text, &nouns).as_deref(), Ok(expect));
        check("take <a key> to every <wolf>", "take an iron key to every otter");
        check("<wolves> steal <keys>", "otters steal iron keys");
        check(
            "<Wolves> swim; <A wolf> is <the wolf> of <the keys>",
            "Otters swim; An otter is the otter of the iron keys",
        );
        assert_eq!(title("The Last <Key>", &nouns).as_deref(), Ok("The Last Iron Key"));
        assert_eq!(title("<A key> for the <Wolf>", &nouns).as_deref(), Ok("An Iron Key for the Otter"));
        check("<A wolf> is after you", "An otter is after you");
        assert!(fill("<fox>", &nouns).is_err() && fill("<key", &nouns).is_err());
    }
}
