//! A game file's sections, as written and as intended. A missing, misspelt or swapped name yields one problem
//! at its position, instead of one for every line below it.

use super::indents;
use super::layout::Line;
use crate::diagnostic::{Diagnostic, Edit, Span, nearest};
use crate::keywords::{CLASSES, EFFECTS, TERMINATIONS};
use crate::meanings::{Place, meaning};
use crate::syntax::description::Section;

/// A section: the line with its name, and the lines below it.
pub(crate) struct Part<'a, 'b> {
    pub(crate) section: Section,
    /// The line with the section's name or, if the name is missing, the line whose depth the name should
    /// have.
    pub(crate) head: &'b Line<'a>,
    /// The column beyond which the section's lines should be indented. This is the column of the section's
    /// name, if the name is in the right place.
    pub(crate) indent: usize,
    pub(crate) body: Vec<&'b Line<'a>>,
}

/// Returns the section whose name is on a line, ignoring case; `None` if the line is not a section name.
pub(crate) fn named(text: &str) -> Option<Section> {
    let mut all = Section::ALL.into_iter().chain([Section::ParameterSet]);
    all.find(|section| section.name().eq_ignore_ascii_case(text))
}

/// Returns a file's sections as they were intended. If a section's name is wrong, the lines below it
/// determine the section.
pub(crate) fn mended<'a, 'b>(
    header: &'b Line<'a>,
    lines: &'b [Line<'a>],
    problems: &mut Vec<Diagnostic>,
) -> Vec<Part<'a, 'b>> {
    let guess = Guess::new(lines);
    let (orphans, mut parts) = split(lines, problems);
    swapped(&guess, &mut parts, problems);
    missing(&guess, header, orphans, &mut parts, problems);
    depths(header, &mut parts, problems);
    moved(&guess, &mut parts, problems);
    parts
}

/// Returns the lines before the first section, and the sections by name, even if the name is misspelt.
fn split<'a, 'b>(
    lines: &'b [Line<'a>],
    problems: &mut Vec<Diagnostic>,
) -> (Vec<&'b Line<'a>>, Vec<Part<'a, 'b>>) {
    let exact = Section::ALL.map(|section| lines.iter().any(|line| named(line.text) == Some(section)));
    let all_named = exact.iter().all(|&is_there| is_there);
    let mut orphans = Vec::new();
    let mut parts: Vec<Part<'a, 'b>> = Vec::new();
    for line in lines {
        let misspelt = || {
            if all_named || line.text.contains([' ', '\t', '>', '=']) {
                return None;
            }
            let meant = meaning(Place::Section, line.text).and_then(|found| found.write.first().copied());
            let near = meant.or_else(|| nearest(line.text, Section::ALL.map(Section::name))).and_then(named);
            near.filter(|&section| !exact[section as usize])
        };
        let Some(section) = named(line.text).or_else(misspelt) else {
            parts.last_mut().map_or(&mut orphans, |part| &mut part.body).push(line);
            continue;
        };
        if line.text != section.name() {
            let message = match named(line.text) {
                Some(_) => format!("`{}` is not a section; names are case-sensitive", line.text),
                None => format!("no section named `{}`", line.text),
            };
            let problem = Diagnostic::error("unknown-section", line.span, message);
            let problem = problem.help(format!("did you mean `{}`?", section.name()));
            problems.push(problem.replace(line.span, section.name()));
        }
        parts.push(Part { section, head: line, indent: line.indent, body: Vec::new() });
    }
    (orphans, parts)
}

/// Reports swapped sections. A section is swapped if all its recognised lines belong to a different section
/// that has no recognised lines of its own.
fn swapped(guess: &Guess<'_>, parts: &mut [Part<'_, '_>], problems: &mut Vec<Diagnostic>) {
    let sound: Vec<Section> = parts
        .iter()
        .filter(|part| part.body.iter().any(|line| guess.section(line) == Some(part.section)))
        .map(|part| part.section)
        .collect();
    for part in parts {
        let mut guesses = part.body.iter().filter_map(|line| guess.section(line));
        let Some(meant) = guesses.next().filter(|meant| !sound.contains(meant)) else { continue };
        if meant != part.section && guesses.all(|other| other == meant) {
            let message = format!("the lines of this {} are {}", part.section.name(), lines_of(meant));
            let problem = Diagnostic::error("swapped-section", part.head.span, message);
            let problem = problem.help(format!("write `{}`", meant.name()));
            problems.push(problem.replace(part.head.span, meant.name()));
            part.section = meant;
        }
    }
}

/// Reports sections without a name. Their lines look like those of a missing section, and are at the end of
/// another section or before all sections.
fn missing<'a, 'b>(
    guess: &Guess<'_>,
    header: &'b Line<'a>,
    mut orphans: Vec<&'b Line<'a>>,
    parts: &mut Vec<Part<'a, 'b>>,
    problems: &mut Vec<Diagnostic>,
) {
    let heads = parts.iter().map(|part| part.head.indent).filter(|&indent| indent > header.indent);
    let indent = heads.clone().next().map_or(header.indent + 1, |_| indents::usual(heads));
    let mut tell = |section: Section, line: &Line<'_>| {
        let message = format!("the game has no {}, and this line is {}", section.name(), line_of(section));
        let problem = Diagnostic::error("missing-section", line.span, message);
        let problem = problem.help(format!("add a line `{}` above it", section.name()));
        let start = line.indentation().start;
        let insert =
            Edit::new(Span::new(start, start), format!("{}{}\n", " ".repeat(indent), section.name()));
        problems.push(problem.fix(format!("Add a line `{}`", section.name()), vec![insert]));
    };
    for section in Section::ALL {
        if parts.iter().any(|part| part.section == section) {
            continue;
        }
        let fits = |line: &&Line<'_>| guess.section(line).is_none_or(|found| found == section);
        let starts = |line: &&Line<'_>| guess.section(line) == Some(section);
        if let Some(at) = orphans.iter().position(&starts).filter(|&at| orphans[at..].iter().all(fits)) {
            tell(section, orphans[at]);
            let body = orphans.split_off(at);
            parts.insert(0, Part { section, head: header, indent: header.indent, body });
            continue;
        }
        let found = parts.iter().enumerate().find_map(|(place, part)| {
            let at = part.body.iter().position(&starts)?;
            part.body[at..].iter().all(fits).then_some((place, at))
        });
        if let Some((place, at)) = found {
            tell(section, parts[place].body[at]);
            let Part { head, indent, .. } = parts[place];
            let body = parts[place].body.split_off(at);
            parts.insert(place + 1, Part { section, head, indent, body });
        }
    }
    if let Some(first) = orphans.first() {
        let message = match orphans.len() {
            1 => "this line is not in any section".to_owned(),
            count => format!("these {count} lines are not in any section"),
        };
        let problem = Diagnostic::error("stray-line", first.span, message);
        let problem = problem.help("sections are SpriteSet, LevelMapping, InteractionSet and TerminationSet");
        problems.push(problem.suggest(first.text, Section::ALL.map(Section::name)));
    }
}

/// Reports section names that are not indented like the other section names. The reference reads a more
/// deeply indented name as a line of the section above.
fn depths(header: &Line<'_>, parts: &mut [Part<'_, '_>], problems: &mut Vec<Diagnostic>) {
    // The head of a section without a name is a line of another section.
    let is_own = |&(at, part): &(usize, &Part<'_, '_>)| {
        let same = |other: &Part<'_, '_>| std::ptr::eq(other.head, part.head);
        !std::ptr::eq(part.head, header) && !parts[..at].iter().any(same)
    };
    let own = parts.iter().enumerate().filter(is_own).map(|(_, part)| part);
    let (below, outside): (Vec<_>, Vec<_>) = own.partition(|part| part.head.indent > header.indent);
    if let [first, more @ ..] = &outside[..] {
        let message = match more.len() {
            0 => format!("{} is not indented below the first line", first.section.name()),
            _ => format!("{} sections are not indented below the first line", outside.len()),
        };
        let problem = Diagnostic::error("stray-indent", first.head.span, message);
        problems.push(problem.help("indent the names of sections deeper than `BasicGame`"));
    }
    let usual = indents::usual(below.iter().map(|part| part.head.indent));
    for part in below.iter().filter(|part| part.head.indent != usual) {
        let message = format!("{} is not indented like the other sections", part.section.name());
        let problem = match part.head.indent > usual {
            true => Diagnostic::error("stray-indent", part.head.span, message),
            false => Diagnostic::warning("uneven-indent", part.head.span, message),
        };
        let problem = problem.help(format!("indent the line by {usual} columns, like the other sections"));
        problems.push(problem.fix(format!("Indent it by {usual} columns"), vec![part.head.indented(usual)]));
    }
    if !below.is_empty() {
        for part in parts {
            let deeper = part.body.iter().all(|line| line.indent > usual);
            part.indent = if deeper { usual } else { part.indent.min(usual) };
        }
    }
}

/// Moves single lines from the wrong section to the right section.
fn moved<'a, 'b>(guess: &Guess<'_>, parts: &mut [Part<'a, 'b>], problems: &mut Vec<Diagnostic>) {
    let mut moved: Vec<(Section, &'b Line<'a>)> = Vec::new();
    // The end of each section, and its indent, according to the lines that certainly belong to it.
    let ends: Vec<(Section, usize, usize)> = parts
        .iter()
        .map(|part| {
            let own = part.body.iter().filter(|line| guess.section(line) == Some(part.section));
            let last = own.clone().next_back().unwrap_or(&part.head);
            let indent = own.map(|line| line.indent).min().unwrap_or(part.head.indent + 4);
            (part.section, last.whole.end, indent)
        })
        .collect();
    for part in parts.iter_mut() {
        let section = part.section;
        part.body.retain(|line| {
            let Some(meant) = guess.section(line).filter(|&meant| meant != section) else { return true };
            let message = format!("this line is {}, but is in the {}", line_of(meant), section.name());
            let problem = Diagnostic::error("wrong-section", line.span, message);
            let problem = problem.help(format!("move it to the {}", meant.name()));
            let end = ends.iter().find(|(section, ..)| *section == meant);
            problems.push(match end {
                Some(&(_, end, indent)) => move_to(problem, line, meant, end, indent),
                None => problem,
            });
            moved.push((meant, line));
            false
        });
    }
    for (section, line) in moved {
        // The line's indent fits its old section. Sprites are added nevertheless, because their names must be
        // known.
        let part = parts.iter_mut().find(|part| part.section == section && part.indent < line.indent);
        if let Some(part) = part.filter(|part| part.section == Section::SpriteSet) {
            part.body.push(line);
        }
    }
}

/// Adds the repair that moves a line to the position after the line that ends at `end`. A sprite becomes a
/// type without a parent.
fn move_to(problem: Diagnostic, line: &Line<'_>, section: Section, end: usize, indent: usize) -> Diagnostic {
    let comment = line.beside.map_or(String::new(), |comment| format!("  # {comment}"));
    let text = format!("\n{}{}{comment}", " ".repeat(indent), line.text);
    let gone = Span::new(line.whole.start.saturating_sub(1), line.whole.end);
    let mut edits = vec![Edit::new(Span::new(end, end), text), Edit::new(gone, "")];
    edits.sort_by_key(|edit| edit.span);
    problem.fix(format!("Move it to the {}", section.name()), edits)
}

fn lines_of(section: Section) -> &'static str {
    match section {
        Section::SpriteSet => "sprites",
        Section::LevelMapping => "mappings of characters",
        Section::InteractionSet => "interactions",
        Section::TerminationSet => "terminations",
        Section::ParameterSet => "parameters",
    }
}

fn line_of(section: Section) -> &'static str {
    match section {
        Section::SpriteSet => "a sprite",
        Section::LevelMapping => "a mapping of a character",
        Section::InteractionSet => "an interaction",
        Section::TerminationSet => "a termination",
        Section::ParameterSet => "a parameter",
    }
}

/// The data for recognising sections by their lines.
struct Guess<'a> {
    /// The names of the sprites, as far as they can be inferred from the lines.
    sprites: Vec<&'a str>,
}

impl<'a> Guess<'a> {
    fn new(lines: &[Line<'a>]) -> Guess<'a> {
        let nothing = Guess { sprites: Vec::new() };
        let is_sprite = |line: &&Line<'_>| nothing.section(line) == Some(Section::SpriteSet);
        let names = lines.iter().filter(is_sprite).filter_map(|line| line.text.split_whitespace().next());
        let mut sprites: Vec<&str> = names.chain(["wall", "avatar"]).collect();
        sprites.sort_unstable();
        Guess { sprites }
    }

    /// Returns the only section to which a line can belong, or `None` if several sections or no section is
    /// possible.
    fn section(&self, line: &Line<'_>) -> Option<Section> {
        let words: Vec<&str> = line.text.split_whitespace().filter(|word| !word.contains('=')).collect();
        let has_params = line.text.contains('=');
        let Some(arrow) = words.iter().position(|&word| word == ">") else {
            let first = words.first()?;
            return TERMINATIONS.contains(first).then_some(Section::TerminationSet);
        };
        let (left, right) = (&words[..arrow], &words[arrow + 1..]);
        if line.text.split_whitespace().any(|word| word.starts_with("values=")) {
            return Some(Section::ParameterSet);
        }
        let is_class = |word: &str| CLASSES.contains(&word);
        let is_sprite = |word: &str| self.sprites.binary_search(&word).is_ok();
        match (left, right) {
            ([_, _, ..], [effect]) if EFFECTS.contains(effect) => Some(Section::InteractionSet),
            ([_], []) if has_params => Some(Section::SpriteSet),
            ([_], [class]) if is_class(class) && !is_sprite(class) => Some(Section::SpriteSet),
            ([symbol], [_, ..]) if !has_params && symbol.chars().count() == 1 => {
                let places = right.iter().all(|word| is_sprite(word) && !is_class(word));
                places.then_some(Section::LevelMapping)
            }
            _ => None,
        }
    }
}
