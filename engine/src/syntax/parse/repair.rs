//! Guesses at the intended meaning of misplaced words.

use std::collections::BTreeSet;

/// Returns the parameter that a word was meant to be, if its `=` is missing or replaced by a different
/// character: `limit:5`, `scoreChange-1`, `winTrue`.
pub(crate) fn parameter(word: &str) -> Option<String> {
    let (key, value) = match word.split_once([':', ';', '-', '+', '~', '>', '<', '_']) {
        Some((key, value)) if is_value(value) => {
            // `scoreChange-1` lacks only its `=`.
            let number = |text: &str| text.bytes().all(|b| b.is_ascii_digit() || b == b'.');
            let signed = word.as_bytes()[key.len()] == b'-' && number(value) && value != "0";
            (key, if signed { &word[key.len()..] } else { value })
        }
        _ => glued(word)?,
    };
    let name = key.trim_end_matches(|c: char| c.is_ascii_digit());
    let is_key = name.len() > 1 && name.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
    is_key.then(|| format!("{key}={value}"))
}

fn is_value(text: &str) -> bool {
    let text = text.strip_prefix('-').unwrap_or(text);
    !text.is_empty() && text.chars().all(|c| c.is_ascii_alphanumeric() || c == '.')
}

/// Splits a word that has no separator between its key and its value, and returns both; `None` if the word does not
/// look like a key and a value.
fn glued(word: &str) -> Option<(&str, &str)> {
    let truth = ["True", "False", "true", "false"].into_iter().find(|truth| word.ends_with(truth));
    let at = match truth {
        Some(truth) => word.len() - truth.len(),
        None => named(word).or_else(|| word.find(|c: char| c.is_ascii_digit()))?,
    };
    let (key, value) = word.split_at(at);
    let fits = truth.is_some() || named(word).is_some() || value.parse::<f64>().is_ok();
    (!key.is_empty() && fits).then_some((key, value))
}

/// Returns the index at which a well-known parameter's value starts; `None` if the word does not begin with such a
/// parameter.
fn named(word: &str) -> Option<usize> {
    const KEYS: [&str; 12] = [
        "scoreChange",
        "stypeTo",
        "stype1",
        "stype2",
        "stype3",
        "stype",
        "color",
        "img",
        "orientation",
        "resource",
        "physicstype",
        "shrinkfactor",
    ];
    KEYS.into_iter().find(|key| word.starts_with(key) && word.len() > key.len()).map(str::len)
}

/// Returns the text to write instead of a word that stands for an arrow, or that contains an arrow with too few spaces
/// around it; `None` for any other word.
pub(crate) fn arrow(word: &str) -> Option<String> {
    const LIKE_ARROWS: [&str; 14] =
        ["<", "->", "-->", "=>", ">>", "<-", "-", "~", ":", "|", "=", "→", "»", "›"];
    if LIKE_ARROWS.contains(&word) {
        return Some(">".to_owned());
    }
    let (left, right) = word.split_once('>')?;
    let blank = |side: &str| if side.is_empty() { String::new() } else { " ".to_owned() };
    Some(format!("{left}{}>{}{right}", blank(left), blank(right)))
}

/// Returns a LevelMapping line with its missing arrow inserted. The arrow goes after the character, in place
/// of the sign that follows it, or after a new character if the first word cannot be one. Returns `None` for
/// a single word, and if a word resembles an arrow.
pub(crate) fn mapping(line: &str, symbols: &mut BTreeSet<char>) -> Option<String> {
    let mut words: Vec<&str> =
        line.split([' ', '\t', '\u{b}', '\u{c}']).filter(|word| !word.is_empty()).collect();
    if words.iter().any(|word| arrow(word).is_some()) {
        return None;
    }
    let key = words.remove(0);
    let mut characters = key.chars();
    let (first, sign, rest) = (characters.next()?, characters.next(), characters.as_str());
    let is_sign = matches!(sign, Some(':' | '=' | '-' | '|' | '~'));
    if is_sign && !rest.is_empty() {
        words.insert(0, rest);
    }
    // Signs in the position of the arrow are not names.
    while words.first().is_some_and(|word| !word.contains(char::is_alphanumeric)) {
        words.remove(0);
    }
    if words.is_empty() {
        return None;
    }
    let is_symbol = first.is_ascii_graphic() && (sign.is_none() || is_sign);
    let symbol = if is_symbol { first } else { symbol(key, symbols) };
    Some(format!("{symbol} > {}", words.join(" ")))
}

/// Returns the character on a LevelMapping line, if it is the only one before the line's arrow.
pub(crate) fn sole_character(line: &str) -> Option<char> {
    let words: Vec<&str> =
        line.split([' ', '\t', '\u{b}', '\u{c}']).filter(|word| !word.is_empty()).collect();
    let mut characters = words.first()?.chars();
    let arrow = words.iter().position(|&word| word == ">");
    characters.next().filter(|_| characters.next().is_none() && arrow.is_none_or(|arrow| arrow == 1))
}

/// Returns a character to write instead of a word in the LevelMapping: the word's first character that no
/// line uses or, failing that, a letter. `A` and `w` count as used, because they have a meaning even without
/// a line. Adds the returned character to `symbols`, so that it is proposed only once.
pub(crate) fn symbol(word: &str, symbols: &mut BTreeSet<char>) -> char {
    let is_free = |c: &char| c.is_ascii_graphic() && !matches!(c, '#' | '>') && !symbols.contains(c);
    let letters = ('a'..='z').chain('B'..='Z').chain('0'..='9').filter(|&c| c != 'w');
    let found = word.chars().chain(letters).find(is_free).unwrap_or('?');
    symbols.insert(found);
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_without_an_equals_sign() {
        let check =
            |word: &str, expect: Option<&str>| assert_eq!(parameter(word).as_deref(), expect, "{word}");
        check("limit:5", Some("limit=5"));
        check("limit5", Some("limit=5"));
        check("scoreChange-1", Some("scoreChange=-1"));
        check("scoreChange:-1", Some("scoreChange=-1"));
        check("limit-0", Some("limit=0"));
        check("stype1;gold", Some("stype1=gold"));
        check("winTrue", Some("win=True"));
        check("stypegold", Some("stype=gold"));
        check("stype-gold", Some("stype=gold"));
        check("stype1gold", Some("stype1=gold"));
        check("speed0.5", Some("speed=0.5"));
        check("Missile", None);
        check("gold", None);
    }

    #[test]
    fn arrows() {
        let check = |word: &str, expect: Option<&str>| assert_eq!(arrow(word).as_deref(), expect, "{word}");
        check("->", Some(">"));
        check("gold>Door", Some("gold > Door"));
        check("gold>", Some("gold >"));
        check("gold", None);
    }

    #[test]
    fn mappings_without_an_arrow() {
        let check = |line: &str, expect: Option<&str>| {
            assert_eq!(mapping(line, &mut BTreeSet::from(['a', 'b'])).as_deref(), expect, "{line}");
        };
        check("g goal wall", Some("g > goal wall"));
        check("g:goal", Some("g > goal"));
        check("g= goal", Some("g > goal"));
        check("ab goal", Some("c > goal"));
        check("axb goal", Some("x > goal"));
        check("é goal", Some("c > goal"));
        check("goal", None);
        check("g", None);
        check("g -> goal", None);
    }
}
