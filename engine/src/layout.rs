//! The names of a game's files, which determine the levels that belong to the game. The engine itself reads
//! no files; this module is for programs that do.
//!
//! A level file is named `lvl3.txt` and is next to `game.vgdl` or `game.txt`, or next to the only game in a
//! folder. Alternatively, as in the public games, it is named `zelda_lvl3.txt` and is next to `zelda.vgdl` or
//! `zelda.txt`. Names are case-insensitive, and numbers may have gaps.

/// The names of a game's file and its level files, all in the same folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GameFiles {
    /// The file with the rules.
    pub source: String,
    /// The levels with their numbers, in ascending order.
    pub levels: Vec<(usize, String)>,
}

/// The maximum number of digits in a level's number.
const MAX_DIGITS: usize = 6;

/// Returns the number in a level's file name: 3 for `lvl3.txt` and for `zelda_lvl3.txt`; `None` for any other name.
pub fn level_number(name: &str) -> Option<usize> {
    level(name).map(|(_, number)| number)
}

/// Returns the games in a folder that contains the given files, sorted by name. If `game.vgdl` or `game.txt`
/// exists, it is the only game. If neither exists, every file with its own levels is a game. If no file has
/// its own levels, every `.vgdl` file is a game.
pub fn games<'a>(names: impl IntoIterator<Item = &'a str>) -> Vec<GameFiles> {
    let mut names: Vec<&str> = names.into_iter().collect();
    names.sort_unstable();
    let whole = |ending: &str| {
        names.iter().copied().find(|name| name.eq_ignore_ascii_case(&format!("game.{ending}")))
    };
    let mut sources: Vec<&str> = match whole("vgdl").or_else(|| whole("txt")) {
        Some(whole) => vec![whole],
        None => sources(&names),
    };
    let preferred = |source: &&str| {
        let twin = |other: &&str| stem(other) == stem(source) && has_ending(other, "vgdl");
        has_ending(source, "vgdl") || !sources.iter().any(twin)
    };
    let kept: Vec<&str> = sources.iter().copied().filter(preferred).collect();
    sources = kept;
    sources
        .into_iter()
        .map(|source| GameFiles { source: source.to_owned(), levels: levels(source, names.iter().copied()) })
        .collect()
}

/// Returns, sorted by number, the level files that belong to the game `source`. `names` contains the files in
/// the game's folder.
pub fn levels<'a>(source: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<(usize, String)> {
    let names: Vec<&str> = names.into_iter().collect();
    let takes_plain = takes_plain(source, &names);
    let of_game = |name: &str| match level(name)? {
        (Some(owner), number) => owner.eq_ignore_ascii_case(stem(source)).then_some(number),
        (None, number) => takes_plain.then_some(number),
    };
    let own = names.iter().filter(|name| **name != source);
    let mut levels: Vec<(usize, String)> =
        own.filter_map(|name| Some((of_game(name)?, (*name).to_owned()))).collect();
    levels.sort();
    levels
}

/// Returns the files in a folder that look like levels of the game `source` but are misnamed, such as
/// `level0.txt`, each with its correct name.
pub fn misnamed<'a>(source: &str, names: impl IntoIterator<Item = &'a str>) -> Vec<(String, String)> {
    let names: Vec<&str> = names.into_iter().collect();
    let taken = levels(source, names.iter().copied());
    let takes_plain = takes_plain(source, &names);
    let is_of_other = |owner: &str| {
        names.iter().any(|name| {
            (is_source(name) && has_ending(name, "vgdl") || owns_levels(name, &names))
                && stem(name).eq_ignore_ascii_case(owner)
        })
    };
    let mut used: Vec<usize> = taken.iter().map(|(number, _)| *number).collect();
    let mut found = Vec::new();
    for name in names.iter().copied().filter(|name| *name != source && !owns_levels(name, &names)) {
        let Some((owner, number)) = like_level(name) else { continue };
        let is_own = owner.eq_ignore_ascii_case(stem(source));
        if taken.iter().any(|(_, own)| own == name)
            || !is_own && (!takes_plain && !owner.is_empty() || is_of_other(owner))
        {
            continue;
        }
        let number = (number..).find(|number| !used.contains(number)).unwrap_or(number);
        used.push(number);
        let prefix = if takes_plain && !is_own { String::new() } else { format!("{}_", stem(source)) };
        found.push((name.to_owned(), format!("{prefix}lvl{number}.txt")));
    }
    found
}

/// Returns the game file to which a level belongs, among the files in its folder. A file whose name does not identify
/// its game belongs to the only game in its folder. Returns `None` if the folder contains no game, or several.
pub fn game_of<'a>(file: &str, names: impl IntoIterator<Item = &'a str>) -> Option<String> {
    let names: Vec<&str> = names.into_iter().filter(|name| *name != file).collect();
    let owner = level(file).map(|(owner, _)| owner.unwrap_or("game"));
    let called = |ending: &str| {
        let wanted = format!("{}.{ending}", owner?);
        names.iter().copied().find(|name| name.eq_ignore_ascii_case(&wanted))
    };
    let named = called("vgdl").or_else(|| called("txt")).map(str::to_owned);
    named.or_else(|| match &games(names.iter().copied())[..] {
        [only] => Some(only.source.clone()),
        _ => None,
    })
}

/// Returns the game files in a folder that has neither `game.vgdl` nor `game.txt`, judging by their own names
/// or by the names of level files.
fn sources<'a>(names: &[&'a str]) -> Vec<&'a str> {
    let candidates = || names.iter().copied().filter(|name| is_source(name));
    let with_levels: Vec<&str> = candidates().filter(|name| owns_levels(name, names)).collect();
    if !with_levels.is_empty() {
        return with_levels;
    }
    let rules: Vec<&str> = candidates().filter(|name| has_ending(name, "vgdl")).collect();
    let plain_levels = names.iter().any(|name| matches!(level(name), Some((None, _))));
    match &candidates().collect::<Vec<_>>()[..] {
        [only] if rules.is_empty() && plain_levels => vec![*only],
        _ => rules,
    }
}

/// Returns `true` if levels whose file names do not include a game's name belong to the game `source`.
fn takes_plain(source: &str, names: &[&str]) -> bool {
    let other = |name: &&str| has_ending(name, "vgdl") || is_game(name) || owns_levels(name, names);
    is_game(source) || !names.iter().filter(|name| stem(name) != stem(source)).any(other)
}

/// The file name extensions of text files, in lower case.
const TEXTS: [&str; 4] = ["txt", "text", "lvl", "level"];
/// The words that stand for a level in file names.
const WORDS: [&str; 4] = ["level", "lvl", "lev", "lv"];

/// Returns the game's name and the number in a file name that resembles a level's, such as `level_3.txt` or `lvl3`. The
/// game's name is empty if the file name does not include one. Returns `None` for any other file name.
fn like_level(name: &str) -> Option<(&str, usize)> {
    let is_text = |ending: &str| TEXTS.iter().any(|text| ending.eq_ignore_ascii_case(text));
    let mut stem = name;
    while let Some((rest, _)) = stem.rsplit_once('.').filter(|(_, ending)| is_text(ending)) {
        stem = rest;
    }
    let is_gap = |c: char| matches!(c, '_' | '-' | '.' | ' ');
    let unnumbered = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &stem[unnumbered.len()..];
    let number = match digits {
        "" => 0,
        digits => digits.parse().ok().filter(|_| digits.len() <= MAX_DIGITS)?,
    };
    let unnumbered = unnumbered.trim_end_matches(is_gap);
    let ends = |word: &&&str| {
        let at = unnumbered.len().checked_sub(word.len());
        at.and_then(|at| unnumbered.get(at..)).is_some_and(|end| end.eq_ignore_ascii_case(word))
    };
    let owner = &unnumbered[..unnumbered.len() - WORDS.iter().find(ends)?.len()];
    let game = owner.trim_end_matches(is_gap);
    (owner.is_empty() || game.len() < owner.len() && !game.is_empty()).then_some((game, number))
}

fn owns_levels(source: &str, names: &[&str]) -> bool {
    let own = |name: &&str| {
        level(name).and_then(|(owner, _)| owner).is_some_and(|owner| owner.eq_ignore_ascii_case(stem(source)))
    };
    is_source(source) && names.iter().any(own)
}

fn is_source(name: &str) -> bool {
    (has_ending(name, "vgdl") || has_ending(name, "txt")) && level(name).is_none()
}

fn is_game(name: &str) -> bool {
    is_source(name) && stem(name).eq_ignore_ascii_case("game")
}

/// Returns the game's name in a level's file name, if any, and the level's number; `None` if the file is not named like
/// a level.
fn level(name: &str) -> Option<(Option<&str>, usize)> {
    let stem = stem(name);
    let numbered = stem.trim_end_matches(|c: char| c.is_ascii_digit());
    let digits = &stem[numbered.len()..];
    let at = numbered.len().checked_sub("lvl".len())?;
    let is_level = has_ending(name, "txt") && numbered.get(at..)?.eq_ignore_ascii_case("lvl");
    let number = digits.parse().ok().filter(|_| is_level && digits.len() <= MAX_DIGITS)?;
    match &numbered[..at] {
        "" => Some((None, number)),
        owner => Some((Some(owner.strip_suffix('_').filter(|owner| !owner.is_empty())?), number)),
    }
}

fn has_ending(name: &str, ending: &str) -> bool {
    name.rsplit_once('.').is_some_and(|(stem, own)| !stem.is_empty() && own.eq_ignore_ascii_case(ending))
}

fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(names: &[&str], expect: &[(&str, &[&str])]) {
        let found = games(names.iter().copied());
        let found: Vec<(&str, Vec<&str>)> = found
            .iter()
            .map(|game| (game.source.as_str(), game.levels.iter().map(|(_, name)| name.as_str()).collect()))
            .collect();
        let expect: Vec<(&str, Vec<&str>)> =
            expect.iter().map(|(source, levels)| (*source, levels.to_vec())).collect();
        assert_eq!(found, expect, "{names:?}");
    }

    #[test]
    fn games_of_a_folder() {
        check(
            &["game.vgdl", "lvl10.txt", "lvl2.txt", "notes.txt"],
            &[("game.vgdl", &["lvl2.txt", "lvl10.txt"])],
        );
        check(&["GAME.TXT", "LVL1.TXT"], &[("GAME.TXT", &["LVL1.TXT"])]);
        check(
            &["game.txt", "game.vgdl", "zelda_lvl0.txt", "game_lvl0.txt"],
            &[("game.vgdl", &["game_lvl0.txt"])],
        );
        check(
            &[
                "aliens.txt",
                "aliens_lvl0.txt",
                "aliens_glvl.txt",
                "x-racer.txt",
                "x-racer_lvl7.txt",
                "x-racer_LVL3.TXT",
                "readme.txt",
            ],
            &[
                ("aliens.txt", &["aliens_lvl0.txt"]),
                ("x-racer.txt", &["x-racer_LVL3.TXT", "x-racer_lvl7.txt"]),
            ],
        );
        check(&["pond.txt", "pond.vgdl", "pond_lvl0.txt"], &[("pond.vgdl", &["pond_lvl0.txt"])]);
        check(&["pond.vgdl", "lvl0.txt"], &[("pond.vgdl", &["lvl0.txt"])]);
        check(&["pond.txt", "lvl0.txt"], &[("pond.txt", &["lvl0.txt"])]);
        check(&["pond.txt", "notes.txt", "lvl0.txt"], &[]);
        check(&["a.vgdl", "b.vgdl", "lvl0.txt"], &[("a.vgdl", &[]), ("b.vgdl", &[])]);
        check(&["notes.txt", "lvl.txt", "_lvl0.txt", ".txt", "lvl12345678901234567890.txt"], &[]);
    }

    #[test]
    fn levels_find_their_game() {
        let check = |file: &str, names: &[&str], expect: Option<&str>| {
            assert_eq!(game_of(file, names.iter().copied()).as_deref(), expect, "{file} in {names:?}");
        };
        check("lvl0.txt", &["game.txt", "lvl0.txt"], Some("game.txt"));
        check(
            "zelda_lvl0.txt",
            &["zelda.txt", "aliens.txt", "aliens_lvl0.txt", "zelda_lvl0.txt"],
            Some("zelda.txt"),
        );
        check("Zelda_lvl0.TXT", &["zelda.vgdl", "Zelda_lvl0.TXT", "aliens.vgdl"], Some("zelda.vgdl"));
        check("map.txt", &["map.txt", "game.vgdl"], Some("game.vgdl"));
        check("map.txt", &["map.txt", "a.vgdl", "b.vgdl"], None);
        check("lvl0.txt", &["lvl0.txt"], None);
        assert_eq!(
            [level_number("lvl07.txt"), level_number("a_lvl3.TXT"), level_number("alvl3.txt")],
            [Some(7), Some(3), None]
        );
    }

    #[test]
    fn names_that_look_like_levels_are_told_with_the_right_name() {
        let check = |source: &str, names: &[&str], expect: &[(&str, &str)]| {
            let found = misnamed(source, names.iter().copied());
            let found: Vec<(&str, &str)> =
                found.iter().map(|(file, wanted)| (file.as_str(), wanted.as_str())).collect();
            assert_eq!(found, expect, "{names:?}");
        };
        check(
            "game.vgdl",
            &[
                "game.vgdl",
                "level0.txt",
                "lvl_1.txt",
                "Level-2.TXT",
                "lvl3",
                "lvl4.txt.txt",
                "x_lvl5.txt",
                "lvl6.TXT",
            ],
            &[
                ("level0.txt", "lvl0.txt"),
                ("lvl_1.txt", "lvl1.txt"),
                ("Level-2.TXT", "lvl2.txt"),
                ("lvl3", "lvl3.txt"),
                ("lvl4.txt.txt", "lvl4.txt"),
                ("x_lvl5.txt", "lvl5.txt"),
            ],
        );
        // A suggested name never replaces an existing level.
        check("game.vgdl", &["game.vgdl", "lvl0.txt", "level0.txt"], &[("level0.txt", "lvl1.txt")]);
        check("pond.txt", &["pond.txt", "pond-level1.txt"], &[("pond-level1.txt", "pond_lvl1.txt")]);
        let two = ["a.vgdl", "b.vgdl", "b_level1.txt", "lvl0.txt", "map.txt", "notes.txt", "travel.txt"];
        check("a.vgdl", &two, &[("lvl0.txt", "a_lvl0.txt")]);
        check("b.vgdl", &two, &[("b_level1.txt", "b_lvl1.txt"), ("lvl0.txt", "b_lvl0.txt")]);
        let public = ["a.txt", "a_lvl0.txt", "a_glvl.txt", "b.txt", "b_lvl0.txt"];
        check("a.txt", &public, &[]);
        check("b.txt", &public, &[]);
    }

    #[test]
    fn a_named_file_takes_plain_levels_unless_another_game_may_own_them() {
        let names = ["a.vgdl", "lvl0.txt", "a_lvl1.txt"];
        assert_eq!(levels("a.vgdl", names).len(), 2);
        assert_eq!(levels("a.vgdl", names.into_iter().chain(["b.vgdl"])).len(), 1);
        assert_eq!(levels("a.vgdl", names.into_iter().chain(["game.txt"])).len(), 1);
    }
}
