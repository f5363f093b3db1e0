//! Single faults in otherwise valid files. Each fault must be reported at its line, in most cases with the
//! right fix.
//!
//! The faults are made in corpus games, chosen with a seed, with [`EACH`] faults of each kind.

use base::{Sampler, Seed};
use engine::{Diagnostic, Game, SpriteClass, line_and_column};
use std::fs;
use tests::workspace_root;

/// The number of faults of each kind.
const EACH: u32 = 40;

/// A corpus game and one of its levels, as texts.
struct Sound {
    game: String,
    level: String,
}

/// A file with one fault.
pub(crate) struct Fault {
    pub(crate) game: String,
    pub(crate) level: String,
    /// `true` if the fault is in the level rather than the game.
    pub(crate) in_level: bool,
    /// The acceptable line numbers, counted from 1.
    lines: Vec<usize>,
    /// The acceptable fixes, one of which the help must contain.
    repairs: Vec<String>,
    what: String,
}

/// A function that creates one kind of fault. Returns `None` if the randomly chosen item does not allow such
/// a fault.
type FaultMaker = fn(&Sound, &mut Sampler) -> Option<Fault>;

const KINDS: [(&str, FaultMaker); 6] = [
    ("typo", typo),
    ("missing token", missing_token),
    ("wrong indent", wrong_indent),
    ("swapped section", swapped_section),
    ("wrong type", wrong_type),
    ("wrong character", wrong_character),
];

/// Creates [`EACH`] faults of each kind.
pub(crate) fn each(mut see: impl FnMut(&'static str, &Fault)) {
    let corpus = corpus();
    for (name, kind) in KINDS {
        let mut made = 0;
        for draw in 0.. {
            let mut sampler = Seed::from_text("faults").child(name, draw).sampler();
            let sound = sampler.choose(&corpus);
            let Some(fault) = kind(sound, &mut sampler) else { continue };
            made += 1;
            see(name, &fault);
            if made == EACH {
                break;
            }
        }
    }
}

#[test]
fn faults_are_reported_at_their_line_with_a_repair() {
    let (mut placed, mut repaired, mut all) = (0, 0, 0);
    let mut untold = String::new();
    each(|name, fault| {
        let problems = problems(fault);
        let text = if fault.in_level { &fault.level } else { &fault.game };
        let at_line: Vec<&(bool, Diagnostic)> = problems
            .iter()
            .filter(|(in_level, problem)| {
                *in_level == fault.in_level
                    && fault.lines.contains(&line_and_column(text, problem.span.start).0)
            })
            .collect();
        let helps = |(_, problem): &&(bool, Diagnostic)| {
            problem.help.as_ref().is_some_and(|help| fault.repairs.iter().any(|repair| help.contains(repair)))
        };
        let (place, help) = (!at_line.is_empty(), at_line.iter().any(helps));
        placed += u64::from(place);
        repaired += u64::from(help);
        all += 1;
        if !help {
            untold += &told(name, fault, &problems);
        }
    });
    assert!(placed * 100 >= all * 95, "only {placed} of {all} faults are told at their line\n{untold}");
    assert!(
        repaired * 100 >= all * 80,
        "only {repaired} of {all} faults are told with their repair\n{untold}"
    );
}

fn told(kind: &str, fault: &Fault, problems: &[(bool, Diagnostic)]) -> String {
    let mut text = format!("{kind}: {} (line {:?}, {:?})\n", fault.what, fault.lines, fault.repairs);
    for (in_level, problem) in problems.iter().take(6) {
        let source = if *in_level { &fault.level } else { &fault.game };
        let line = line_and_column(source, problem.span.start).0;
        let file = if *in_level { "level" } else { "game" };
        let help = problem.help.as_deref().unwrap_or("-");
        text += &format!("    {file}:{line} {}: {} | {help}\n", problem.code, problem.message);
    }
    text
}

/// Returns the problems in the game and, if the game compiles, the problems in the level. The flag is `true` for
/// problems in the level.
fn problems(fault: &Fault) -> Vec<(bool, Diagnostic)> {
    let game = match Game::from_source(&fault.game) {
        Ok(game) => game,
        Err(problems) => return problems.0.into_iter().map(|problem| (false, problem)).collect(),
    };
    let level =
        game.level(&fault.level).map_or_else(|problems| problems.0, |level| level.warnings().to_vec());
    let own = game.warnings().iter().cloned().map(|problem| (false, problem));
    own.chain(level.into_iter().map(|problem| (true, problem))).collect()
}

fn corpus() -> Vec<Sound> {
    let mut folders: Vec<_> =
        fs::read_dir(workspace_root().join("corpora")).unwrap().map(|entry| entry.unwrap().path()).collect();
    folders.sort();
    let read = |path| fs::read_to_string(path).unwrap();
    folders
        .iter()
        .map(|folder| Sound { game: read(folder.join("game.vgdl")), level: read(folder.join("lvl0.txt")) })
        .collect()
}

/// A word in a file, with its position in the text, its line (counted from 1), and its section.
#[derive(Clone, Copy)]
struct Token<'a> {
    start: usize,
    text: &'a str,
    line: usize,
    /// The index of the word within its line.
    place: usize,
    section: &'a str,
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut section = "";
    for (row, number) in text.lines().zip(1..) {
        let code = row.split('#').next().unwrap_or_default();
        if ["SpriteSet", "LevelMapping", "InteractionSet", "TerminationSet"].contains(&code.trim()) {
            section = code.trim();
        }
        for (place, word) in code.split_whitespace().enumerate() {
            let start = word.as_ptr() as usize - text.as_ptr() as usize;
            tokens.push(Token { start, text: word, line: number, place, section });
        }
    }
    tokens
}

impl Token<'_> {
    fn is_head(&self) -> bool {
        self.text == self.section
    }
}

fn replaced(text: &str, start: usize, length: usize, with: &str) -> String {
    format!("{}{with}{}", &text[..start], &text[start + length..])
}

fn in_game(sound: &Sound, game: String, lines: Vec<usize>, repairs: &[&str], what: String) -> Option<Fault> {
    let repairs = repairs.iter().map(|repair| (*repair).to_owned()).collect();
    Some(Fault { game, level: sound.level.clone(), in_level: false, lines, repairs, what })
}

/// Removes, doubles, swaps or changes one letter in a word.
fn typo(sound: &Sound, sampler: &mut Sampler) -> Option<Fault> {
    let tokens = tokens(&sound.game);
    let token = *sampler.choose(&tokens);
    // Only names are changed. A parameter's name is its key, and lists stay unchanged.
    let word = token.text.split('=').next().unwrap_or_default();
    if word.len() < 4 || !word.chars().all(|c| c.is_ascii_alphanumeric()) {
        return None;
    }
    let mut letters: Vec<char> = word.chars().collect();
    let at = sampler.below(letters.len() - 1);
    match sampler.below(4) {
        0 => drop(letters.remove(at)),
        1 => letters.insert(at, letters[at]),
        2 => letters.swap(at, at + 1),
        _ => letters[at] = char::from(b'a' + sampler.below(26) as u8),
    }
    let wrong: String = letters.into_iter().collect();
    if tokens.iter().any(|token| token.text.split('=').next() == Some(wrong.as_str())) {
        return None;
    }
    let game = replaced(&sound.game, token.start, word.len(), &wrong);
    in_game(sound, game, vec![token.line], &[&format!("`{word}`")], format!("{word} → {wrong}"))
}

/// Removes a required word from a line, or the `=` or the value of a parameter.
fn missing_token(sound: &Sound, sampler: &mut Sampler) -> Option<Fault> {
    let tokens = tokens(&sound.game);
    let token = *sampler.choose(&tokens);
    let line: Vec<&Token<'_>> = tokens.iter().filter(|other| other.line == token.line).collect();
    let arrow = line.iter().position(|token| token.text == ">");
    let without = |start: usize, length: usize| replaced(&sound.game, start, length, "");
    if let Some((key, value)) = token.text.split_once('=') {
        let whole = format!("{key}={value}");
        return match sampler.below(3) {
            0 => {
                let game = without(token.start + key.len() + 1, value.len());
                in_game(sound, game, vec![token.line], &[&format!("{key}=")], format!("value of {whole}"))
            }
            1 => {
                let game = without(token.start + key.len(), 1);
                in_game(sound, game, vec![token.line], &[&whole], format!("`=` of {whole}"))
            }
            _ if ["stype", "stype1", "resource", "stypeTo"].contains(&key) => {
                let game = without(token.start, token.text.len());
                in_game(sound, game, vec![token.line], &[&format!("`{key}=")], format!("all of {whole}"))
            }
            _ => None,
        };
    }
    let game = without(token.start, token.text.len());
    let repairs: Vec<String> = if token.is_head() || token.line == 1 {
        vec![format!("`{}`", token.text)]
    } else if token.text == ">" {
        vec![">".to_owned()]
    } else {
        match (token.section, token.place, arrow?) {
            ("SpriteSet", 0, _) => vec!["name".to_owned()],
            ("SpriteSet", place, arrow) if place == arrow + 1 => vec!["after the `>`".to_owned()],
            ("LevelMapping", 0, _) => vec!["one character before".to_owned()],
            ("LevelMapping", _, 1) if line.len() == 3 => vec!["write at least one sprite".to_owned()],
            ("InteractionSet", place, 2) if place < 2 => vec!["two sprites".to_owned()],
            ("InteractionSet", place, arrow) if place == arrow + 1 => vec!["write the effect".to_owned()],
            ("TerminationSet", 0, _) => vec![format!("`{}`", token.text)],
            _ => return None,
        }
    };
    let repairs: Vec<&str> = repairs.iter().map(String::as_str).collect();
    let what = format!("{} in `{}`", token.text, sound.game.lines().nth(token.line - 1).unwrap().trim());
    in_game(sound, game, vec![token.line], &repairs, what)
}

/// Increases or decreases a line's indentation by some columns.
fn wrong_indent(sound: &Sound, sampler: &mut Sampler) -> Option<Fault> {
    let lines: Vec<&str> = sound.game.lines().collect();
    let at = 1 + sampler.below(lines.len() - 1);
    let line = lines[at];
    let indent = line.len() - line.trim_start().len();
    if line.trim().is_empty() {
        return None;
    }
    let change = *sampler.choose(&[-8_i64, -4, -2, -1, 1, 2, 4, 8]);
    let indented = " ".repeat(usize::try_from(indent as i64 + change).ok()?);
    let mut changed: Vec<String> = lines.iter().map(|line| (*line).to_owned()).collect();
    changed[at] = format!("{indented}{}", line.trim_start());
    let what = format!("`{}` by {change}", line.trim());
    in_game(sound, changed.join("\n") + "\n", vec![at + 1], &["indent"], what)
}

/// Swaps two section names, or moves a section before another section that it requires.
fn swapped_section(sound: &Sound, sampler: &mut Sampler) -> Option<Fault> {
    let tokens = tokens(&sound.game);
    let heads: Vec<&Token<'_>> = tokens.iter().filter(|token| token.is_head()).collect();
    let one = sampler.below(4);
    let two = sampler.below(4);
    if one >= two {
        return None;
    }
    let (one, two) = (heads[one], heads[two]);
    if sampler.below(3) > 0 {
        let game = replaced(&sound.game, two.start, two.text.len(), one.text);
        let game = replaced(&game, one.start, one.text.len(), two.text);
        let repairs = [format!("`{}`", one.text), format!("`{}`", two.text)];
        let repairs: Vec<&str> = repairs.iter().map(String::as_str).collect();
        return in_game(
            sound,
            game,
            vec![one.line, two.line],
            &repairs,
            format!("{} and {}", one.text, two.text),
        );
    }
    // Moves the SpriteSet to the end of the file.
    let sprites = heads.iter().position(|head| head.text == "SpriteSet")?;
    let next = heads.get(sprites + 1)?;
    let lines: Vec<&str> = sound.game.lines().collect();
    let (before, after) = (&lines[..heads[sprites].line - 1], &lines[next.line - 1..]);
    let own = &lines[heads[sprites].line - 1..next.line - 1];
    let game = [before, after, own].concat().join("\n") + "\n";
    let shift = next.line - heads[sprites].line;
    let needing = heads.iter().filter(|head| ["InteractionSet", "TerminationSet"].contains(&head.text));
    let moved: Vec<usize> = needing.map(|head| head.line - shift).collect();
    in_game(sound, game, moved, &["SpriteSet first"], "the SpriteSet last".to_owned())
}

/// Writes a value that the parameter does not accept.
fn wrong_type(sound: &Sound, sampler: &mut Sampler) -> Option<Fault> {
    let tokens = tokens(&sound.game);
    let params: Vec<&Token<'_>> = tokens.iter().filter(|token| token.text.contains('=')).collect();
    let token = **sampler.choose(&params);
    let (key, value) = token.text.split_once('=')?;
    let wrong = match value {
        _ if key == "img" => return None,
        _ if value.parse::<f64>().is_ok() => *sampler.choose(&["RED", "many", "True", "2x"]),
        "True" | "False" => *sampler.choose(&["1", "yes", "RED"]),
        _ => *sampler.choose(&["3", "0.5", "True"]),
    };
    let game = replaced(&sound.game, token.start + key.len() + 1, value.len(), wrong);
    in_game(sound, game, vec![token.line], &[&format!("{key}=")], format!("{key}={value} → {key}={wrong}"))
}

/// Replaces a valid character with an invalid one in a level, a mapping, an arrow or a parameter.
fn wrong_character(sound: &Sound, sampler: &mut Sampler) -> Option<Fault> {
    let tokens = tokens(&sound.game);
    match sampler.below(4) {
        0 | 1 => {
            let places: Vec<(usize, char)> =
                sound.level.char_indices().filter(|(_, c)| !c.is_whitespace()).collect();
            let (at, right) = *sampler.choose(&places);
            let wrong = char::from(b'!' + sampler.below(94) as u8);
            let mapped = |token: &Token<'_>| {
                token.section == "LevelMapping" && token.place == 0 && token.text == wrong.to_string()
            };
            if tokens.iter().any(mapped) || ['w', 'A'].contains(&wrong) {
                return None;
            }
            let line = sound.level[..at].matches('\n').count() + 1;
            Some(Fault {
                game: sound.game.clone(),
                level: replaced(&sound.level, at, 1, &wrong.to_string()),
                in_level: true,
                lines: vec![line],
                repairs: vec![format!("`{right}`")],
                what: format!("`{right}` → `{wrong}` in the level"),
            })
        }
        2 => {
            let arrows: Vec<&Token<'_>> = tokens.iter().filter(|token| token.text == ">").collect();
            let token = **sampler.choose(&arrows);
            let wrong = *sampler.choose(&["<", "-", "=", ":", "}", "."]);
            let game = replaced(&sound.game, token.start, 1, wrong);
            in_game(sound, game, vec![token.line], &[">"], format!("arrow `{wrong}`"))
        }
        _ => {
            let params: Vec<&Token<'_>> = tokens.iter().filter(|token| token.text.contains('=')).collect();
            let token = **sampler.choose(&params);
            let wrong = *sampler.choose(&[":", "-", ";", "+"]);
            let at = token.start + token.text.find('=')?;
            let game = replaced(&sound.game, at, 1, wrong);
            in_game(sound, game, vec![token.line], &[token.text], format!("`{wrong}` in {}", token.text))
        }
    }
}

#[test]
fn the_corpus_is_sound() {
    for sound in corpus() {
        let game = Game::from_source(&sound.game).unwrap();
        assert_eq!(game.warnings(), []);
        assert!(game.level(&sound.level).unwrap().warnings().is_empty());
        assert!(game.sprite_types().any(|stype| game.class(stype).is_some_and(SpriteClass::is_avatar)));
    }
}
