//! What a word was meant to be, where none belongs.

/// The parameter that a word stands for whose `=` is missing or another character: `limit:5`, `scoreChange-1`, `winTrue`.
pub(super) fn parameter(word: &str) -> Option<String> {
    let (key, value) = match word.split_once([':', ';', '-', '+', '~', '>', '<', '_']) {
        Some((key, value))
            if !value.is_empty() && value.chars().all(|c| c.is_ascii_alphanumeric() || c == '.') =>
        {
            // `scoreChange-1` lacks its `=` only.
            let signed =
                word.as_bytes()[key.len()] == b'-' && value.bytes().all(|b| b.is_ascii_digit() || b == b'.');
            (key, if signed { &word[key.len()..] } else { value })
        }
        _ => glued(word)?,
    };
    let is_key = key.len() > 1 && key.chars().all(|c| c.is_ascii_alphabetic() || c == '_');
    is_key.then(|| format!("{key}={value}"))
}

/// Key and value of a word in which nothing stands between them.
fn glued(word: &str) -> Option<(&str, &str)> {
    let truth = ["True", "False", "true", "false"].into_iter().find(|truth| word.ends_with(truth));
    let at = match truth {
        Some(truth) => word.len() - truth.len(),
        None => word.find(|c: char| c.is_ascii_digit()).or_else(|| named(word))?,
    };
    let (key, value) = word.split_at(at);
    let fits = truth.is_some() || named(word).is_some() || value.parse::<f64>().is_ok();
    (!key.is_empty() && fits).then_some((key, value))
}

/// Where the value of a well-known parameter starts.
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

/// The arrow that a word stands for, or holds with too few blanks around it: what to write instead.
pub(super) fn arrow(word: &str) -> Option<String> {
    const LIKE_ARROWS: [&str; 14] =
        ["<", "->", "-->", "=>", ">>", "<-", "-", "~", ":", "|", "=", "→", "»", "›"];
    if LIKE_ARROWS.contains(&word) {
        return Some(">".to_owned());
    }
    let (left, right) = word.split_once('>')?;
    let blank = |side: &str| if side.is_empty() { String::new() } else { " ".to_owned() };
    Some(format!("{left}{}>{}{right}", blank(left), blank(right)))
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
        check("winTrue", Some("win=True"));
        check("stypegold", Some("stype=gold"));
        check("stype-gold", Some("stype=gold"));
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
}
