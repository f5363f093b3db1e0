//! Parses lines into a syntax tree. Parsing never fails: a faulty line yields one diagnostic, and the rest of
//! the file is still read.

pub(crate) mod bounds;
pub(crate) mod indents;
pub(crate) mod layout;
pub(crate) mod lines;
mod reader;
pub(crate) mod repair;
pub(crate) mod sections;
pub(crate) mod tokens;

use super::description::{Description, Header, Section, Word};
use super::reference;
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Span};
use crate::meanings::Place;
use bounds::{long_line, unreadable};
use layout::Line;
use lines::trivia;
use reader::Reader;
use sections::Part;
use std::collections::BTreeSet;
use tokens::Token;

/// Reads a game file in reference mode: faulty lines are dropped with one message per line, and lines
/// indented more deeply than the first line of their section are ignored (`spec/01` §1.3–§1.9). The
/// diagnostics contain only the fault on which the reference crashes, or an exceeded limit.
pub fn parse_as_reference(source: &str) -> (Description, Vec<Diagnostic>) {
    let read = unreadable(source).map_or_else(|| reference::read(source), Err);
    match read {
        Ok(description) => (description, Vec::new()),
        Err(problem) => (Description::default(), vec![problem]),
    }
}

/// Reads a game file. The tree contains every line that could be read. The diagnostics, sorted by position,
/// cover all other lines.
///
/// Cost: linear in the text's length. A text longer than [`MAX_SOURCE`](crate::MAX_SOURCE) bytes yields one
/// diagnostic and an empty tree.
pub fn parse(source: &str) -> (Description, Vec<Diagnostic>) {
    let (description, problems) = parse_all(source);
    (description, problems.shortened(source.len()).0)
}

/// Reads a game file like [`parse`], but returns all problems, without a limit on their number.
pub(crate) fn parse_all(source: &str) -> (Description, Diagnostics) {
    let mut reader = Reader::default();
    match unreadable(source) {
        Some(problem) => reader.problems.push(problem),
        None => reader.read(source),
    }
    (reader.description, Diagnostics::sorted(reader.problems))
}

impl Reader {
    fn read(&mut self, source: &str) {
        let (mut lines, tail) = layout::lines(source);
        self.problems.extend(lines.iter().filter_map(long_line));
        lines.retain(|line| long_line(line).is_none());
        lines.retain_mut(|line| self.without_foreign_comment(line));
        self.description.tail = tail.into_iter().map(str::to_owned).collect();
        let Some((header, rest)) = lines.split_first() else {
            let problem = Diagnostic::error("empty-game", Span::new(0, 0), "the file contains no game")
                .help("a game starts with a line `BasicGame`, then SpriteSet, LevelMapping, InteractionSet, TerminationSet");
            self.problems.push(problem);
            return;
        };
        let headless = sections::named(header.text).is_some();
        if headless {
            let message = "the game has no first line `BasicGame`";
            let problem = Diagnostic::error("unknown-game-class", header.span, message);
            let problem = problem.help("add a line `BasicGame` above, indented less than the sections");
            let start = header.indentation().start;
            let insert = Edit::new(Span::new(start, start), "BasicGame\n");
            self.problems.push(match header.indent {
                0 => problem,
                _ => problem.fix("Add a line `BasicGame`", vec![insert]),
            });
        } else {
            self.header(header);
        }
        let rest = if headless { &lines[..] } else { rest };
        let parts = self.mended_parts(header, rest);
        let heads: Vec<usize> = parts.iter().map(|part| part.head.indent).collect();
        for part in parts {
            if let Some(has) = self.description.has.get_mut(part.section as usize) {
                *has = true;
            }
            self.description.section_trivia[part.section as usize] = trivia(part.head);
            self.body(&part);
        }
        for (has, section) in self.description.has.into_iter().zip(Section::ALL) {
            let reported = |problem: &Diagnostic| {
                problem.code == "missing-section" && problem.message.contains(section.name())
            };
            if !has && !self.problems.iter().any(reported) {
                let message = format!("the game has no {}", section.name());
                let help = format!("add a line `{}`, indented below the first line", section.name());
                let problem = Diagnostic::error("missing-section", header.span, message).help(help);
                self.problems.push(problem.fix(
                    format!("Add a line `{}`", section.name()),
                    vec![missing_section(source, header, section, &heads)],
                ));
            }
        }
    }

    /// Cuts off the text after `//`, which starts a comment in other languages. Returns `true` if any text is left.
    fn without_foreign_comment(&mut self, line: &mut Line<'_>) -> bool {
        let starts = |at: &(usize, &str)| at.0 == 0 || line.text[..at.0].ends_with([' ', '\t']);
        let Some((at, mark)) = line.text.match_indices("//").find(starts) else { return true };
        let span = Span::new(line.span.start + at, line.span.start + at + mark.len());
        let problem = Diagnostic::error("bad-comment", span, "`//` does not start a comment");
        self.problems.push(problem.help("comments start with `#`").replace(span, "#"));
        line.text = line.text[..at].trim_end();
        line.span.end = line.span.start + line.text.len();
        !line.text.is_empty()
    }

    fn header(&mut self, line: &Line<'_>) {
        let mut header = Header { trivia: trivia(line), ..Header::default() };
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if header.class.text.is_empty() => header.class = word,
                Token::Param(param) => header.params.push(param),
                Token::Word(word) => self.stray_word(&word, "the first line takes only `key=value`"),
                Token::Arrow(span) => {
                    let arrow = Word { text: ">".to_owned(), span };
                    self.stray_word(&arrow, "the first line takes only `key=value`");
                }
            }
        }
        if !["BasicGame", "GameSpace"].contains(&header.class.text.as_str()) {
            let span = if header.class.text.is_empty() { line.span } else { header.class.span };
            let message = match header.class.text.as_str() {
                "" => "the first line has no game class".to_owned(),
                class => format!("`{class}` is not a game class"),
            };
            let problem = Diagnostic::error("unknown-game-class", span, message);
            let problem =
                problem.help("the first line that is not a comment must be `BasicGame key=value …`");
            self.problems.push(problem.mean(Place::Game, &header.class.text, ["BasicGame", "GameSpace"]));
        }
        self.description.header = header;
    }

    /// Returns the sections as they were intended, and reports a problem for each deviation.
    fn mended_parts<'a, 'b>(&mut self, header: &'b Line<'a>, lines: &'b [Line<'a>]) -> Vec<Part<'a, 'b>> {
        let parts = sections::mended(header, lines, &mut self.problems);
        for (at, part) in parts.iter().enumerate() {
            if parts[..at].iter().any(|other| other.section == part.section) {
                let message = format!("the game has a second {}", part.section.name());
                let problem = Diagnostic::error("duplicate-section", part.head.span, message);
                self.problems.push(problem.help("move its lines to the first section of that name"));
            }
        }
        let in_space = self.description.header.class.text == "GameSpace";
        for part in parts.iter().filter(|part| part.section == Section::ParameterSet && !in_space) {
            let message = "only a GameSpace has a ParameterSet";
            let problem = Diagnostic::error("stray-line", part.head.span, message);
            self.problems.push(problem.help("begin the file with `GameSpace`, or write the values out"));
        }
        let sprites = parts.iter().position(|part| part.section == Section::SpriteSet).unwrap_or(0);
        let needs =
            |part: &&Part<'_, '_>| matches!(part.section, Section::InteractionSet | Section::TerminationSet);
        let early: Vec<_> = parts[..sprites].iter().filter(needs).collect();
        if let Some(first) = early.first() {
            let names: Vec<_> = early.iter().map(|part| part.section.name()).collect();
            let stand = if names.len() == 1 { "stands" } else { "stand" };
            let message = format!("{} {stand} before the SpriteSet", names.join(" and "));
            let problem = Diagnostic::error("section-order", first.head.span, message);
            self.problems.push(
                problem.help("put the SpriteSet first: sprites are unknown before their declaration is read"),
            );
        }
        parts
    }

    fn body(&mut self, part: &Part<'_, '_>) {
        let section = part.section;
        indents::outside(section, part.indent, &part.body, &mut self.problems);
        if section == Section::SpriteSet {
            let (lines, outside): (Vec<_>, Vec<_>) =
                part.body.iter().partition(|line| line.indent > part.indent);
            // Lines outside the section are read as well, so that their names are known.
            for line in outside {
                let sprite = self.sprite(line);
                self.description.sprites.extend(sprite);
            }
            self.columns = indents::off_grid(part.indent, &lines, &mut self.problems);
            let mut forest = Vec::new();
            self.sprites(&lines, &mut forest, 0);
            self.description.sprites.append(&mut forest);
            return;
        }
        indents::uneven(section, part.indent, &part.body, &mut self.problems);
        let mut symbols: BTreeSet<char> =
            part.body.iter().filter_map(|line| repair::sole_character(line.text)).collect();
        for &line in &part.body {
            match section {
                Section::SpriteSet => unreachable!("read above"),
                Section::LevelMapping => self.mapping(line, &mut symbols),
                Section::InteractionSet => self.interaction(line),
                Section::TerminationSet => self.termination(line),
                Section::ParameterSet => self.parameter(line),
            }
        }
    }

    /// Reports a misplaced word. `rule` states what belongs in its place.
    pub(super) fn stray_word(&mut self, word: &Word, rule: &str) {
        let message = format!("`{}` does not belong here: {rule}", word.text);
        let problem = Diagnostic::error("stray-word", word.span, message);
        self.problems.push(match repair::parameter(&word.text) {
            Some(param) => problem.help(format!("did you mean `{param}`?")).replace(word.span, &param),
            None => problem.help(format!("remove `{}`", word.text)).remove(word.span, &word.text),
        });
    }
}

/// Returns the edit that adds an empty section. The SpriteSet goes below the first line, because other
/// sections depend on it, and all other sections go at the end. `heads` are the indents of the existing
/// sections.
fn missing_section(source: &str, header: &Line<'_>, section: Section, heads: &[usize]) -> Edit {
    let below = heads.iter().copied().filter(|&indent| indent > header.indent);
    let indent = if below.clone().next().is_some() { indents::usual(below) } else { header.indent + 4 };
    let line = format!("{}{}", " ".repeat(indent), section.name());
    let rest = &source[header.span.end..];
    let end = match section {
        Section::SpriteSet => header.span.end + rest.find(['\n', '\r']).unwrap_or(rest.len()),
        _ => source.len(),
    };
    let text = if source[..end].ends_with(['\n', '\r']) { format!("{line}\n") } else { format!("\n{line}") };
    Edit::new(Span::new(end, end), text)
}
