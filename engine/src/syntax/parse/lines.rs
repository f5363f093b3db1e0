//! Reads the section lines into the tree, or reports the problems that prevent reading them.

use super::bounds::{long_name, too_deep};
use super::indents;
use super::layout::Line;
use super::reader::Reader;
use super::repair;
use super::tokens::{Token, span, word};
use crate::diagnostic::{Diagnostic, Edit, Span};
use crate::keywords::{CLASSES, EFFECTS};
use crate::limits::MAX_NESTING;
use crate::syntax::description::{
    InteractionLine, MappingLine, ParameterLine, SpriteLine, TerminationLine, Trivia, Word,
};
use crate::syntax::grammar::{Grammar, Rule};
use pest::Parser;
use std::collections::BTreeSet;

impl Reader {
    /// Reads the SpriteSet. Lines at the same depth are siblings. More deeply indented lines are children of
    /// the line above (`spec/01` §1.3).
    pub(crate) fn sprites(&mut self, lines: &[&Line<'_>], out: &mut Vec<SpriteLine>, depth: usize) {
        let Some(first) = lines.first() else { return };
        let indent = indents::of_siblings(lines);
        if depth == MAX_NESTING {
            self.problems.push(too_deep(first));
            return;
        }
        let mut at = 0;
        while at < lines.len() {
            let line = lines[at];
            let deeper = lines[at + 1..].iter().take_while(|child| child.indent > line.indent).count();
            if line.indent != indent && !self.columns {
                let of_tabs = indents::of_tabs(line);
                let message = format!("this line is not indented like its siblings{of_tabs}");
                let problem = Diagnostic::warning("uneven-indent", line.span, message)
                    .help(format!("indent this line by {indent} columns, like its siblings"));
                let title = format!("Indent it by {indent} columns");
                self.problems.push(problem.fix(title, vec![line.indented(indent)]));
            }
            let mut sprite = self.sprite(line);
            let children = &lines[at + 1..at + 1 + deeper];
            match &mut sprite {
                Some(sprite) => self.sprites(children, &mut sprite.children, depth + 1),
                None => self.sprites(children, &mut Vec::new(), depth + 1),
            }
            out.extend(sprite);
            at += 1 + deeper;
        }
    }

    pub(crate) fn sprite(&mut self, line: &Line<'_>) -> Option<SpriteLine> {
        let mut sprite = SpriteLine { trivia: trivia(line), ..SpriteLine::default() };
        let mut arrow = false;
        let mut strays = Vec::new();
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if sprite.name.text.is_empty() && !arrow => sprite.name = word,
                Token::Word(word) if arrow && sprite.class.is_none() && !glued(&word) => {
                    sprite.class = Some(word);
                }
                Token::Word(word) => strays.push(word),
                Token::Arrow(_) => arrow = true,
                Token::Param(param) => sprite.params.push(param),
            }
        }
        if !arrow || sprite.name.text.is_empty() {
            let fixed =
                self.mend_arrow(line, arrow, "a sprite is `name > Class key=value …`", "after the name");
            if let Some(name) = fixed.as_deref().and_then(|fixed| fixed.split_whitespace().next()) {
                sprite.name.text = name.trim_end_matches('>').to_owned();
            }
            // One of the words was meant as the arrow, or contains it. Among the other words, only a class
            // can be identified for certain.
            let known = |word: &Word| CLASSES.contains(&&*word.text);
            sprite.class = sprite.class.into_iter().chain(strays.drain(..)).find(known);
        }
        for word in strays {
            self.stray_word(&word, "a sprite has one class");
        }
        self.problems.extend(long_name(&sprite.name));
        (!sprite.name.text.is_empty()).then_some(sprite)
    }

    /// Reports a line whose arrow is missing or misspelt, at the faulty word if there is one. Returns the
    /// text to write instead. `place` describes where the arrow belongs.
    fn mend_arrow(&mut self, line: &Line<'_>, has_arrow: bool, shape: &str, place: &str) -> Option<String> {
        let mut words = line.text.split([' ', '\t']).filter(|word| !word.is_empty());
        let meant = words.find_map(|word| Some((word, repair::arrow(word)?))).filter(|_| !has_arrow);
        let Some((word, fixed)) = meant else {
            let (message, help) = match has_arrow {
                true => ("the name before the `>` is missing", "put the name before the `>`".to_owned()),
                false => ("this line has no ` > `", format!("put ` > ` {place}, with a space on both sides")),
            };
            let problem = Diagnostic::error("missing-arrow", line.span, format!("{message}: {shape}"));
            self.problems.push(problem.help(help));
            return None;
        };
        let span = line.span_of(word);
        let problem = Diagnostic::error("missing-arrow", span, format!("`{word}` is not ` > `: {shape}"));
        let problem = problem.help(format!("write ` {fixed} `, with spaces around the `>`"));
        self.problems.push(problem.replace(span, &fixed));
        Some(fixed)
    }

    /// Reads a LevelMapping line. `symbols` contains the characters of all LevelMapping lines, and those
    /// proposed so far.
    pub(crate) fn mapping(&mut self, line: &Line<'_>, symbols: &mut BTreeSet<char>) {
        let shape = "a mapping is `c > sprite sprite …`";
        let Ok(mut pairs) = Grammar::parse(Rule::mapping, line.text) else {
            let start = |text: &str| line.span_of(text).start;
            let mut words = line.text.split([' ', '\t', '\u{b}', '\u{c}']).filter(|word| !word.is_empty());
            let Some(arrow) = words.clone().find(|&word| word == ">") else {
                let problem = Diagnostic::error(
                    "missing-arrow",
                    line.span,
                    format!("`{}` has no ` > `: {shape}", line.text),
                );
                if let Some(fixed) = repair::mapping(line.text, symbols) {
                    self.problems.push(problem.help(format!("write `{fixed}`")).replace(line.span, &fixed));
                } else if words.clone().any(|word| repair::arrow(word).is_some()) {
                    self.mend_arrow(line, false, shape, "after the character");
                } else if line.text.chars().count() == 1 {
                    let help = format!(
                        "write the names of sprites after it, `{} > sprite`, or remove the line",
                        line.text
                    );
                    self.problems.push(problem.help(help));
                } else {
                    let symbol = repair::symbol(line.text, symbols);
                    let help = format!(
                        "write a character before it, `{symbol} > {}`, or remove the line",
                        line.text
                    );
                    self.problems.push(problem.help(help));
                }
                return;
            };
            if let Some(param) = words.find(|word| word.contains('=') && start(word) > start(arrow)) {
                self.stray_word(&Word { text: param.to_owned(), span: line.span_of(param) }, shape);
                return;
            }
            let before = line.text[..start(arrow) - line.span.start].trim_end();
            let rest = &line.text[start(arrow) - line.span.start..];
            let symbol = repair::symbol(if before.is_empty() { rest } else { before }, symbols);
            let (message, edit) = match before {
                "" => ("there is no character before the `>`".to_owned(), format!("{symbol} ")),
                _ => (format!("`{before}` is more than one character"), symbol.to_string()),
            };
            let place = Span::new(line.span.start, line.span.start + before.len());
            let shown = if before.is_empty() { Span::new(place.start, start(arrow) + 1) } else { place };
            let problem = Diagnostic::error("bad-mapping", shown, format!("{message}: {shape}"));
            let problem = problem.help(in_levels_too(symbol, rest));
            // A line that lacks its character may begin with the space that followed the character.
            self.problems.push(if before.is_empty() && line.indent % 2 == 1 {
                problem
            } else {
                problem.fix(format!("Write `{symbol}`"), vec![Edit::new(place, edit)])
            });
            return;
        };
        let mut mapping = MappingLine { trivia: trivia(line), ..MappingLine::default() };
        for pair in pairs.next().expect("the rule matched").into_inner() {
            match pair.as_rule() {
                Rule::symbol => {
                    mapping.span = span(line, &pair);
                    let mut characters = pair.as_str().chars();
                    mapping.symbol = characters.next().expect("a symbol is not empty");
                    let is_one = characters.next().is_none();
                    if !is_one || !mapping.symbol.is_ascii_graphic() {
                        let word = pair.as_str();
                        let fault = if is_one { "not a printable ASCII" } else { "more than one" };
                        let message = format!("`{word}` is {fault} character: {shape}");
                        let symbol = repair::symbol(word, symbols);
                        let rest = line.text[pair.as_span().end()..].trim_start();
                        let problem = Diagnostic::error("bad-mapping", mapping.span, message);
                        let problem = problem.help(in_levels_too(symbol, rest));
                        self.problems.push(problem.replace(mapping.span, &symbol.to_string()));
                    }
                }
                Rule::word => mapping.names.push(word(line, &pair)),
                _ => {}
            }
        }
        if mapping.names.is_empty() {
            let message = format!("`{}` places nothing", mapping.symbol);
            let problem = Diagnostic::warning("empty-mapping", line.span, message);
            self.problems.push(
                problem.help("write at least one sprite after `>`; a space in a level is an empty cell"),
            );
        }
        self.description.mapping.push(mapping);
    }

    pub(crate) fn interaction(&mut self, line: &Line<'_>) {
        let mut names = Vec::new();
        let mut after = Vec::new();
        let mut interaction = InteractionLine { trivia: trivia(line), ..InteractionLine::default() };
        let mut arrow = None;
        for token in self.tokens(line) {
            match token {
                Token::Arrow(span) => arrow = Some(span),
                Token::Word(word) if arrow.is_some() => after.push(word),
                Token::Word(word) => names.push(word),
                Token::Param(param) => interaction.params.push(param),
            }
        }
        let Some(arrow) = arrow else {
            let shape = "an interaction is `sprite partner … > effect key=value …`";
            self.mend_arrow(line, false, shape, "before the effect");
            return;
        };
        let is_effect = |word: &Word| EFFECTS.contains(&&*word.text);
        if let ([_, ..], [effect, extra, ..]) = (&names[..], &after[..]) {
            let extra = if is_effect(effect) || !is_effect(extra) { extra } else { effect }.clone();
            self.stray_word(&extra, "an interaction has one effect");
            after.retain(|effect| *effect != extra);
            after.truncate(1);
        }
        let partners = "write two sprites before `>`: the one acted upon, then its partner (or EOS)";
        let fault = match (&names[..], &after[..]) {
            ([], _) => Some((arrow, "there are no sprites before the `>`".to_owned(), partners)),
            ([one], _) => Some((one.span, format!("`{}` has no partner", one.text), partners)),
            (_, []) => {
                Some((arrow, "there is no effect after the `>`".to_owned(), "write the effect after `>`"))
            }
            _ => None,
        };
        if let Some((span, message, help)) = fault {
            self.problems.push(Diagnostic::error("bad-interaction", span, message).help(help));
            return;
        }
        interaction.first = names.remove(0);
        interaction.second = names;
        interaction.effect = after.remove(0);
        self.description.interactions.push(interaction);
    }

    pub(crate) fn termination(&mut self, line: &Line<'_>) {
        let mut termination = TerminationLine { trivia: trivia(line), ..TerminationLine::default() };
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if termination.class.text.is_empty() => termination.class = word,
                Token::Word(word) => self.stray_word(&word, "a termination is `Class key=value …`"),
                Token::Arrow(span) => {
                    let arrow = Word { text: ">".to_owned(), span };
                    self.stray_word(&arrow, "a termination is `Class key=value …`");
                }
                Token::Param(param) => termination.params.push(param),
            }
        }
        if termination.class.text.is_empty() {
            let has = |key: &str| termination.params.iter().any(|param| param.key.text == key);
            let class = match () {
                () if has("stype") => "SpriteCounter",
                () if has("subTypesNum") => "MultiSpriteCounterSubTypes",
                () if has("stype1") => "MultiSpriteCounter",
                () => "Timeout",
            };
            let message = "this termination has no class";
            let problem = Diagnostic::error("bad-termination", line.span, message);
            let insert = Edit::new(Span::new(line.span.start, line.span.start), format!("{class} "));
            let problem = problem.help(format!("put its class first, maybe `{class}`"));
            self.problems.push(problem.fix(format!("Put `{class}` first"), vec![insert]));
        } else {
            self.description.terminations.push(termination);
        }
    }

    pub(crate) fn parameter(&mut self, line: &Line<'_>) {
        let mut parameter = ParameterLine { trivia: trivia(line), ..ParameterLine::default() };
        let shape = "a parameter is `NAME > values=min:step:max`";
        let mut arrow = false;
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if parameter.name.text.is_empty() && !arrow => parameter.name = word,
                Token::Word(word) => self.stray_word(&word, shape),
                Token::Arrow(_) => arrow = true,
                Token::Param(param) => parameter.params.push(param),
            }
        }
        if !arrow || parameter.name.text.is_empty() {
            self.mend_arrow(line, arrow, shape, "after the name");
        } else {
            self.description.parameters.push(parameter);
        }
    }
}

/// Returns `true` if a word in a class's position is a parameter without its `=`.
fn glued(word: &Word) -> bool {
    !CLASSES.contains(&&*word.text) && repair::parameter(&word.text).is_some()
}

pub(crate) fn trivia(line: &Line<'_>) -> Trivia {
    let own = |text: &&str| (*text).to_owned();
    Trivia { above: line.above.iter().map(own).collect(), beside: line.beside.as_ref().map(own) }
}

/// Returns the advice to write a character before a mapping's arrow.
fn in_levels_too(symbol: char, rest: &str) -> String {
    format!("write `{symbol} {rest}`, and `{symbol}` in the levels")
}
