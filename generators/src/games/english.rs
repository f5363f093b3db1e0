//! Conversion of sprite names to English: `seaGlass` becomes "sea glass", "a sea glass" or "sea glasses".

pub(crate) use engine::describe::plural;
use itertools::Itertools;

/// Replaces each capital letter with a space and the lower-case letter.
pub(crate) fn spaced(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars() {
        if letter.is_ascii_uppercase() {
            text.push(' ');
        }
        text.push(letter.to_ascii_lowercase());
    }
    text
}

/// Adds the indefinite article.
pub(crate) fn one(noun: &str) -> String {
    let vowel = noun.starts_with(['a', 'e', 'i', 'o', 'u']);
    format!("{} {noun}", if vowel { "an" } else { "a" })
}

/// Capitalises the first letter.
pub(crate) fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}

/// Capitalises every word.
pub(crate) fn headline(text: &str) -> String {
    text.split(' ').map(capital).join(" ")
}

/// Joins clauses: "a, b and c".
pub(crate) fn series(clauses: &[String]) -> String {
    match clauses {
        [] => String::new(),
        [only] => only.clone(),
        [rest @ .., last] => format!("{} and {last}", rest.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nouns() {
        assert_eq!(spaced("seaGlass"), "sea glass");
        assert_eq!(plural("sea glass"), "sea glasses");
        assert_eq!(plural("cherry"), "cherries");
        assert_eq!(plural("key"), "keys");
        assert_eq!(plural("silverfish"), "silverfish");
        assert_eq!(plural("floating leaf"), "floating leaves");
        assert_eq!(one("urn"), "an urn");
        assert_eq!(headline("the salt orchard"), "The Salt Orchard");
        assert_eq!(series(&["a".into(), "b".into(), "c".into()]), "a, b and c");
    }
}
