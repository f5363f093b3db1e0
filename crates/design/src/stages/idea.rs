//! Checks ideas.

use super::Problem;
use crate::answer::{self, Idea};
use crate::draft::Draft;

/// The minimum and maximum number of words in an idea. The prompt states a slightly smaller maximum.
const WORDS: (usize, usize) = (15, 200);
/// The maximum length of a name, in characters.
const MAX_NAME: usize = 40;

/// Checks an answer. The name must not be the name of an earlier draft.
pub(crate) fn check(text: &str, earlier: &[Draft]) -> Result<Idea, Problem> {
    let idea = answer::idea(text).map_err(Problem::plain)?;
    let name = &idea.name;
    let is_plain = |word: &str| {
        word.starts_with(|c: char| c.is_ascii_lowercase())
            && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
    };
    if name.len() > MAX_NAME || !name.split('-').all(is_plain) {
        let shown: String = name.chars().take(MAX_NAME).collect();
        return Err(Problem::plain(format!(
            "`{shown}` isn't a valid name: use lower-case words joined with dashes, such as `peat-fire`, with at most {MAX_NAME} characters."
        )));
    }
    if earlier.iter().any(|draft| draft.name.as_ref() == Some(name)) {
        return Err(Problem::plain(format!(
            "An earlier game has the name `{name}`: choose a different name."
        )));
    }
    let words = idea.text.split_whitespace().count();
    if words < WORDS.0 {
        return Err(Problem::plain(format!(
            "The idea has {}, which is too short: describe the goal, the dangers and the dilemma.",
            base::count(words, "word")
        )));
    }
    if words > WORDS.1 {
        return Err(Problem::plain(format!("The idea has {words} words; the limit is {}.", WORDS.1)));
    }
    Ok(idea)
}

#[cfg(test)]
mod tests {
    fn check(text: &str, expect: &str) {
        let problem = super::check(text, &[]).unwrap_err();
        assert!(problem.text.contains(expect), "{}", problem.text);
    }

    #[test]
    fn names_and_lengths() {
        check("NAME: Peat Fire\nIDEA: x", "isn't a valid name");
        check("NAME: ../peat\nIDEA: x", "isn't a valid name");
        check("NAME: peat-\nIDEA: x", "isn't a valid name");
        check("NAME: peat-fire\nIDEA: too short", "2 words");
        check(&format!("NAME: peat-fire\nIDEA: {}", "word ".repeat(300)), "300 words");
        assert!(super::check(&format!("NAME: peat-fire\nIDEA: {}", "word ".repeat(30)), &[]).is_ok());
    }
}
