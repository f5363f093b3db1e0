//! From sprite names to English: `seaGlass` is "sea glass", "a sea glass", "sea glasses".

use itertools::Itertools;

/// Replaces each capital by a space and the small letter.
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

pub(crate) fn plural(noun: &str) -> String {
    let ends = |endings: &[&str]| endings.iter().any(|ending| noun.ends_with(ending));
    if ends(&["fish"]) {
        noun.to_owned()
    } else if ends(&["ay", "ey", "oy", "uy"]) {
        format!("{noun}s")
    } else if let Some(stem) = noun.strip_suffix('y') {
        format!("{stem}ies")
    } else if ends(&["leaf", "sheaf", "loaf", "wolf", "shelf", "thief", "knife"]) {
        let stem = noun.trim_end_matches('e').trim_end_matches('f');
        format!("{stem}ves")
    } else if ends(&["s", "x", "z", "ch", "sh"]) {
        format!("{noun}es")
    } else {
        format!("{noun}s")
    }
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
