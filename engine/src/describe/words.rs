//! The words that make up sentences: names, numbers and verbs.

use crate::analysis::Analysis;
use crate::rules::SpriteType;
use std::fmt::Display;

/// A subject or object of a sentence.
#[derive(Clone, Debug)]
pub(super) struct Party {
    /// The name as a subject or object: `you`, `the crate`, `any beast`, `the edge of the board`.
    pub(super) name: String,
    /// `true` if the party is the player.
    pub(super) you: bool,
}

impl Party {
    pub(super) fn of(analysis: &Analysis, stype: SpriteType) -> Party {
        let game = analysis.game();
        let name = game.name(stype);
        let covered = |other: SpriteType| analysis.applies(stype, other);
        let avatars = analysis.avatars();
        let own: Vec<_> = avatars.iter().filter(|avatar| covered(avatar.stype)).collect();
        let possible = game.sprite_types().filter(|&other| covered(other) && analysis.facts(other).possible);
        let all_you = !own.is_empty() && possible.count() == own.len();
        if all_you && own.len() == avatars.len() {
            return Party { name: "you".to_owned(), you: true };
        }
        if all_you {
            let forms: Vec<&str> = own.iter().map(|avatar| game.name(avatar.stype)).collect();
            return Party { name: format!("you as {}", list(&forms, "or")), you: true };
        }
        let article = if members(analysis, stype).is_empty() { "the" } else { "any" };
        Party { name: format!("{article} {name}"), you: false }
    }

    pub(super) fn edge() -> Party {
        Party { name: "the edge of the board".to_owned(), you: false }
    }

    /// Combines several parties into one: `the crab or butterfly`, `you or the sword`.
    pub(super) fn any(parties: &[Party]) -> Party {
        let mut names: Vec<&str> = parties.iter().map(|party| party.name.as_str()).collect();
        for at in (1..names.len()).rev() {
            if names[at - 1].starts_with("the ") {
                names[at] = names[at].strip_prefix("the ").unwrap_or(names[at]);
            }
        }
        Party { name: list(&names, "or"), you: parties.len() == 1 && parties[0].you }
    }

    /// Returns the matching form of the verb: `you die`, `the crate dies`.
    pub(super) fn verb<'a>(&self, with_you: &'a str, with_it: &'a str) -> &'a str {
        if self.you { with_you } else { with_it }
    }
}

/// Returns the possible types below `group` in the SpriteSet. The result is empty for a leaf type.
pub(super) fn members(analysis: &Analysis, group: SpriteType) -> Vec<SpriteType> {
    let game = analysis.game();
    let below = |stype: SpriteType| {
        let path = &game.0.types[group.index()].path;
        stype != group
            && analysis.applies(group, stype)
            && !path.contains(&stype)
            && analysis.facts(stype).possible
    };
    game.sprite_types().filter(|&stype| below(stype)).collect()
}

/// Returns a name with its article: `a crate`, `an eel`.
pub(super) fn a(name: &str) -> String {
    let vowel = name.starts_with(['a', 'e', 'i', 'o', 'u', 'A', 'E', 'I', 'O', 'U']);
    format!("{} {name}", if vowel { "an" } else { "a" })
}

/// Returns the plural of a type's name: `keys`, `berries`. Names that do not end like an English word are returned
/// unchanged.
///
/// ```
/// use infinite_arcade_engine::describe::plural;
/// assert_eq!([plural("lamp"), plural("berry"), plural("t7")], ["lamps", "berries", "t7"]);
/// ```
pub fn plural(noun: &str) -> String {
    let ends = |endings: &[&str]| endings.iter().any(|ending| noun.ends_with(ending));
    if !noun.ends_with(|last: char| last.is_ascii_lowercase()) || is_the_same_for_several(noun) {
        noun.to_owned()
    } else if let Some(several) = irregular_plural(noun) {
        several
    } else if ends(&["ay", "ey", "oy", "uy"]) {
        format!("{noun}s")
    } else if let Some(stem) = noun.strip_suffix('y') {
        format!("{stem}ies")
    } else if ends(&["leaf", "sheaf", "loaf", "wolf", "shelf", "thief", "knife", "calf"]) {
        let stem = noun.trim_end_matches('e').trim_end_matches('f');
        format!("{stem}ves")
    } else if ends(&["s", "x", "z", "ch", "sh"]) {
        format!("{noun}es")
    } else {
        format!("{noun}s")
    }
}

/// Returns `true` if a noun ends with one of the given words, ignoring case: both `mouse` and `stageMouse`
/// end with `mouse`.
fn ends_with_any(noun: &str, endings: &[&str]) -> bool {
    let small = noun.to_ascii_lowercase();
    endings.iter().any(|ending| small.ends_with(ending))
}

/// Returns `true` if `word` is the last word of a noun: `ox` is the last word of `ox`, `wild ox` and `wildOx`, but not
/// of `box`.
fn has_last_word(noun: &str, word: &str) -> bool {
    noun.len().checked_sub(word.len()).is_some_and(|at| {
        let starts_there = at == 0 || !noun.as_bytes()[at - 1].is_ascii_alphanumeric();
        ends_with_any(noun, &[word]) && (starts_there || noun.as_bytes()[at].is_ascii_uppercase())
    })
}

/// Returns `true` if a noun's singular and plural are identical, as with many animals that are fished or
/// hunted.
fn is_the_same_for_several(noun: &str) -> bool {
    ends_with_any(noun, &["fish", "sheep", "folk", "deer", "moose", "trout", "salmon", "bream"])
        || ["carp", "pike"].iter().any(|word| has_last_word(noun, word))
}

/// Returns the plural of a noun that changes its vowel or ends in `en`; `None` for regular nouns.
fn irregular_plural(noun: &str) -> Option<String> {
    /// Nouns that end in `man` without being compounds of `man`.
    const NO_MAN: &[&str] =
        &["human", "shaman", "talisman", "caiman", "ottoman", "roman", "german", "norman", "pacman"];
    let altered = |ending: &str, several: &str| Some(noun.strip_suffix(ending)?.to_owned() + several);
    if ends_with_any(noun, &["mouse"]) {
        altered("ouse", "ice")
    } else if ends_with_any(noun, &["goose"]) && !ends_with_any(noun, &["mongoose"]) {
        altered("oose", "eese")
    } else if ends_with_any(noun, &["man"]) && !ends_with_any(noun, NO_MAN) {
        altered("an", "en")
    } else if has_last_word(noun, "ox") || ends_with_any(noun, &["muskox"]) {
        Some(format!("{noun}en"))
    } else {
        None
    }
}

/// Joins names: `a`, `a or b`, `a, b or c`.
pub(super) fn list(names: &[impl Display], word: &str) -> String {
    match names {
        [] => String::new(),
        [one] => one.to_string(),
        [rest @ .., last] => {
            let rest: Vec<String> = rest.iter().map(ToString::to_string).collect();
            format!("{} {word} {last}", rest.join(", "))
        }
    }
}

/// Capitalises a text and ends it with a full stop.
pub(super) fn sentence(text: &str) -> String {
    let mut characters = text.chars();
    let first: String = characters.next().into_iter().flat_map(char::to_uppercase).collect();
    format!("{first}{}.", characters.as_str())
}

/// Returns a number with its noun: `1 point`, `2 points`.
pub(super) fn count(number: i64, noun: &str) -> String {
    let ending = if number == 1 { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

/// Returns a probability as a percentage with as few digits as possible.
pub(super) fn percent(probability: f64) -> String {
    let thousandths = (probability * 100_000.0 + 0.5) as i64;
    let (whole, rest) = (thousandths / 1000, thousandths % 1000);
    let digits = format!("{whole}.{rest:03}");
    format!("{}%", digits.trim_end_matches('0').trim_end_matches('.'))
}

/// Returns, as text, the speed of sprites that move by `speed` cells every `cooldown` ticks.
pub(super) fn pace(speed: f64, cooldown: i32) -> String {
    let cooldown = i64::from(cooldown);
    let per_cell = (1.0 / speed + 0.5) as i64;
    let divides = (1.0 / speed - per_cell as f64).abs() < 1e-9;
    let (cells, ticks) = if speed <= 1.0 && divides {
        ("a cell".to_owned(), per_cell.saturating_mul(cooldown))
    } else if speed < 1.0 {
        (format!("{} of a cell", percent(speed)), cooldown)
    } else {
        (format!("{speed} cells"), cooldown)
    };
    if ticks == 1 { format!("{cells} a tick") } else { format!("{cells} every {ticks} ticks") }
}

/// Returns, as text, the speed of sprites that move by less than a cell every `cooldown` ticks. `block` is
/// the cell size, if the game sets one.
pub(super) fn glide(speed: f64, cooldown: i32, block: Option<i32>) -> String {
    let whole = |ticks: f64| (ticks - (ticks + 0.5).floor()).abs() < 1e-9;
    // Sprites move by whole pixels.
    let steps = match block {
        Some(block) => f64::from(block) / f64::from(((speed * f64::from(block)) as i32).max(1)),
        None => 1.0 / speed,
    };
    let ticks = steps * f64::from(cooldown);
    let about = if block.is_some() && whole(steps) { "" } else { "about " };
    format!("gliding, a cell in {about}{} ticks", (ticks + 0.5).floor())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plurals_are_those_of_english() {
        for (one, several) in [
            ("lamp", "lamps"),
            ("mouse", "mice"),
            ("dormouse", "dormice"),
            ("stageMouse", "stageMice"),
            ("mousehole", "mouseholes"),
            ("goose", "geese"),
            ("mongoose", "mongooses"),
            ("man", "men"),
            ("swordsman", "swordsmen"),
            ("toll woman", "toll women"),
            ("human", "humans"),
            ("talisman", "talismans"),
            ("ox", "oxen"),
            ("musk ox", "musk oxen"),
            ("muskox", "muskoxen"),
            ("wildOx", "wildOxen"),
            ("box", "boxes"),
            ("fox", "foxes"),
            ("calf", "calves"),
            ("reindeer", "reindeer"),
            ("brook trout", "brook trout"),
            ("salmon", "salmon"),
            ("bream", "bream"),
            ("moose", "moose"),
            ("carp", "carp"),
            ("scarp", "scarps"),
            ("pike", "pike"),
            ("spike", "spikes"),
            ("é", "é"),
        ] {
            assert_eq!(plural(one), several);
        }
    }

    #[test]
    fn numbers_read_well() {
        assert_eq!(
            (percent(0.5), percent(0.025), percent(1.0)),
            ("50%".into(), "2.5%".into(), "100%".into())
        );
        assert_eq!((pace(1.0, 1), pace(0.25, 1)), ("a cell a tick".into(), "a cell every 4 ticks".into()));
        assert_eq!((pace(0.5, 6), pace(2.0, 1)), ("a cell every 12 ticks".into(), "2 cells a tick".into()));
        assert_eq!(pace(0.8, 3), "80% of a cell every 3 ticks");
        assert_eq!((count(1, "point"), count(2, "point")), ("1 point".into(), "2 points".into()));
        assert_eq!(list(&["a", "b", "c"], "or"), "a, b or c");
        assert_eq!(sentence("you win"), "You win.");
    }
}
