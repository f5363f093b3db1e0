//! Where the sections of a game file are, and where they were meant to be: a missing, misspelt or swapped name costs one
//! problem at its place, not one for every line below it.

use super::description::Section;
use super::layout::Line;
use crate::diagnostic::{Diagnostic, nearest};
use crate::ontology::class::SpriteClass;
use crate::ontology::{effects, terminations};

/// A section: its name's line and the lines below it.
pub(super) struct Part<'a, 'b> {
    pub(super) section: Section,
    /// Of a section whose name is missing: the line that the name should stand at the depth of.
    pub(super) head: &'b Line<'a>,
    pub(super) body: Vec<&'b Line<'a>>,
}

/// The section that a line names, letter case aside.
pub(super) fn named(text: &str) -> Option<Section> {
    let mut all = Section::ALL.into_iter().chain([Section::ParameterSet]);
    all.find(|section| section.name().eq_ignore_ascii_case(text))
}

/// The most frequent indent; of several, the one that comes first.
pub(super) fn usual_indent(indents: impl Iterator<Item = usize>) -> usize {
    let mut counts: Vec<(usize, usize)> = Vec::new();
    for indent in indents {
        match counts.iter_mut().find(|(known, _)| *known == indent) {
            Some((_, count)) => *count += 1,
            None => counts.push((indent, 1)),
        }
    }
    let most = counts.iter().map(|&(_, count)| count).max();
    counts.iter().find(|(_, count)| Some(*count) == most).map_or(0, |&(indent, _)| indent)
}

/// Lines of a SpriteSet that stand between the columns of the others: children or siblings by accident. In a file without
/// such columns there is nothing to tell.
pub(super) fn off_grid(head: usize, lines: &[&Line<'_>], problems: &mut Vec<Diagnostic>) {
    let indents = || std::iter::once(head).chain(lines.iter().map(|line| line.indent));
    let mut steps: Vec<usize> =
        indents().zip(indents().skip(1)).map(|(a, b)| a.abs_diff(b)).filter(|&step| step > 0).collect();
    steps.push(usual_indent(lines.iter().map(|line| line.indent)).saturating_sub(head).max(1));
    steps.sort_unstable();
    steps.dedup();
    // Between columns, or more than one column to the right of the line above.
    let off = |step: usize| {
        let above = indents().zip(lines);
        let off = above.filter(move |(above, line)| {
            !(line.indent - head).is_multiple_of(step) || line.indent > above + step
        });
        off.map(|(_, line)| line).collect::<Vec<_>>()
    };
    // The widest columns that nearly all lines keep to.
    let found = steps.into_iter().rev().map(|step| (step, off(step)));
    let Some((step, off)) = found.into_iter().find(|(_, off)| off.len() * 4 <= lines.len()) else { return };
    for line in off {
        let below = head + (line.indent - head) / step * step;
        let near = if below == head { below + step } else { below };
        let message = "this line is indented unlike the others";
        let problem = Diagnostic::warning("uneven-indent", line.span, message);
        problems.push(problem.help(match near == below {
            true => format!("indent it by {near} columns, or by {} below its parent", near + step),
            false => format!("indent it by {near} columns, like them"),
        }));
    }
}

/// The usual indent of those lines that are no one's children.
pub(super) fn siblings_indent(lines: &[&Line<'_>]) -> usize {
    let mut sibling = usize::MAX;
    usual_indent(lines.iter().map(|line| line.indent).filter(|&indent| {
        let is_sibling = indent <= sibling;
        sibling = if is_sibling { indent } else { sibling };
        is_sibling
    }))
}

/// The sections of a file as they were meant, by what their lines look like where the names are not right.
pub(super) fn mended<'a, 'b>(
    header: &'b Line<'a>,
    lines: &'b [Line<'a>],
    problems: &mut Vec<Diagnostic>,
) -> Vec<Part<'a, 'b>> {
    let guess = Guess::new(lines);
    let (orphans, mut parts) = split(lines, problems);
    swapped(&guess, &mut parts, problems);
    missing(&guess, header, orphans, &mut parts, problems);
    depths(header, &parts, problems);
    moved(&guess, &mut parts, problems);
    parts
}

/// The lines before the first section, and the sections by their names, misspelt ones included.
fn split<'a, 'b>(
    lines: &'b [Line<'a>],
    problems: &mut Vec<Diagnostic>,
) -> (Vec<&'b Line<'a>>, Vec<Part<'a, 'b>>) {
    let exact = Section::ALL.map(|section| lines.iter().any(|line| named(line.text) == Some(section)));
    let mut orphans = Vec::new();
    let mut parts: Vec<Part<'a, 'b>> = Vec::new();
    for line in lines {
        let misspelt = || {
            let alone = !line.text.contains([' ', '\t', '>', '=']);
            let near = nearest(line.text, Section::ALL.map(Section::name)).and_then(named);
            near.filter(|&section| alone && !exact[section as usize])
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
            problems.push(problem.help(format!("did you mean `{}`?", section.name())));
        }
        parts.push(Part { section, head: line, body: Vec::new() });
    }
    (orphans, parts)
}

/// Sections all of whose telling lines belong in another one, which has none of its own.
fn swapped(guess: &Guess<'_>, parts: &mut [Part<'_, '_>], problems: &mut Vec<Diagnostic>) {
    let sound: Vec<Section> = parts
        .iter()
        .filter(|part| part.body.iter().any(|line| guess.section(line) == Some(part.section)))
        .map(|part| part.section)
        .collect();
    for part in parts {
        let mut told = part.body.iter().filter_map(|line| guess.section(line));
        let Some(meant) = told.next().filter(|meant| !sound.contains(meant)) else { continue };
        if meant != part.section && told.all(|other| other == meant) {
            let message = format!("the lines of this {} are {}", part.section.name(), lines_of(meant));
            let problem = Diagnostic::error("swapped-section", part.head.span, message);
            problems.push(problem.help(format!("write `{}`", meant.name())));
            part.section = meant;
        }
    }
}

/// Sections without a name: lines that look like one of them, at the end of another one or before all.
fn missing<'a, 'b>(
    guess: &Guess<'_>,
    header: &'b Line<'a>,
    mut orphans: Vec<&'b Line<'a>>,
    parts: &mut Vec<Part<'a, 'b>>,
    problems: &mut Vec<Diagnostic>,
) {
    let mut tell = |section: Section, line: &Line<'_>| {
        let message = format!("the game has no {}, and this line is {}", section.name(), line_of(section));
        let problem = Diagnostic::error("missing-section", line.span, message);
        problems.push(problem.help(format!("add a line `{}` above it", section.name())));
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
            parts.insert(0, Part { section, head: header, body });
            continue;
        }
        let found = parts.iter().enumerate().find_map(|(place, part)| {
            let at = part.body.iter().position(&starts)?;
            part.body[at..].iter().all(fits).then_some((place, at))
        });
        if let Some((place, at)) = found {
            tell(section, parts[place].body[at]);
            let (head, body) = (parts[place].head, parts[place].body.split_off(at));
            parts.insert(place + 1, Part { section, head, body });
        }
    }
    for line in orphans {
        let problem = Diagnostic::error("stray-line", line.span, "this line is in no section");
        problems.push(match nearest(line.text, Section::ALL.map(Section::name)) {
            Some(name) => problem.help(format!("did you mean `{name}`?")),
            None => problem.help("sections are SpriteSet, LevelMapping, InteractionSet and TerminationSet"),
        });
    }
}

/// Section names that are not indented like the others: deeper ones the reference takes for a line of the section above.
fn depths(header: &Line<'_>, parts: &[Part<'_, '_>], problems: &mut Vec<Diagnostic>) {
    let usual =
        usual_indent(parts.iter().map(|part| part.head.indent).filter(|&indent| indent > header.indent));
    for part in parts.iter().filter(|part| !std::ptr::eq(part.head, header)) {
        let (name, indent) = (part.section.name(), part.head.indent);
        if indent <= header.indent {
            let message = format!("{name} is not indented below the first line");
            let problem = Diagnostic::error("stray-indent", part.head.span, message);
            problems.push(problem.help("indent the names of sections deeper than `BasicGame`"));
        } else if indent != usual {
            let message = format!("{name} is indented unlike the other sections");
            let help = format!("indent it by {usual} columns, like them");
            let problem = match indent > usual {
                true => Diagnostic::error("stray-indent", part.head.span, message),
                false => Diagnostic::warning("uneven-indent", part.head.span, message),
            };
            problems.push(problem.help(help));
        }
    }
}

/// Single lines that stand in the wrong section: read where they belong.
fn moved<'a, 'b>(guess: &Guess<'_>, parts: &mut [Part<'a, 'b>], problems: &mut Vec<Diagnostic>) {
    let mut moved: Vec<(Section, &'b Line<'a>)> = Vec::new();
    for part in parts.iter_mut() {
        let section = part.section;
        part.body.retain(|line| {
            let Some(meant) = guess.section(line).filter(|&meant| meant != section) else { return true };
            let message = format!("this line is {}, and stands in the {}", line_of(meant), section.name());
            let problem = Diagnostic::error("wrong-section", line.span, message);
            problems.push(problem.help(format!("move it to the {}", meant.name())));
            moved.push((meant, line));
            false
        });
    }
    for (section, line) in moved {
        // Its indent fits the section that it came from; at least its name is to be known, so sprites are kept.
        let part = parts.iter_mut().find(|part| part.section == section && part.head.indent < line.indent);
        if let Some(part) = part.filter(|part| part.section == Section::SpriteSet) {
            part.body.push(line);
        }
    }
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

/// Tells sections by their lines.
struct Guess<'a> {
    /// The names of sprites, as far as lines show them to be.
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

    /// The section that a line can only belong to; None if it could belong to several, or to none.
    fn section(&self, line: &Line<'_>) -> Option<Section> {
        let words: Vec<&str> = line.text.split_whitespace().filter(|word| !word.contains('=')).collect();
        let has_params = line.text.contains('=');
        let Some(arrow) = words.iter().position(|&word| word == ">") else {
            let first = words.first()?;
            return terminations::NAMES.contains(first).then_some(Section::TerminationSet);
        };
        let (left, right) = (&words[..arrow], &words[arrow + 1..]);
        if line.text.split_whitespace().any(|word| word.starts_with("values=")) {
            return Some(Section::ParameterSet);
        }
        let is_class = |word: &str| SpriteClass::from_name(word).is_some();
        let is_sprite = |word: &str| self.sprites.binary_search(&word).is_ok();
        match (left, right) {
            ([_, _, ..], [effect]) if effects::NAMES.contains(effect) => Some(Section::InteractionSet),
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
