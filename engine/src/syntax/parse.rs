//! Lines to a syntax tree. Never fails: a bad line costs one diagnostic, not the file.

use super::description::{
    Description, Header, InteractionLine, MappingLine, Param, ParameterLine, Section, SpriteLine,
    TerminationLine, Trivia, Word,
};
use super::indents;
use super::layout::{self, Line};
use super::reference;
use super::repair;
use super::sections::{self, Part};
use crate::diagnostic::{Diagnostic, Diagnostics, Span};
use crate::limits::{MAX_LINE, MAX_NAME, MAX_NESTING, MAX_SOURCE};
use crate::ontology::class::SpriteClass;
use crate::ontology::{effects, terminations};
use pest::Parser;
use pest::iterators::{Pair, Pairs};
use std::iter::Peekable;

#[derive(pest_derive::Parser)]
#[grammar = "syntax/vgdl.pest"]
struct Grammar;

/// Reads a game file as the reference does: faulty lines are dropped, with a message each; lines indented deeper than
/// their section's first are ignored (`spec/01` §1.3–§1.9). The diagnostic is what the reference dies of, or what is
/// beyond us.
pub fn parse_as_reference(source: &str) -> (Description, Vec<Diagnostic>) {
    let read = unreadable(source).map_or_else(|| reference::read(source), Err);
    match read {
        Ok(description) => (description, Vec::new()),
        Err(problem) => (Description::default(), vec![problem]),
    }
}

/// What keeps a text from being looked at as a game.
fn unreadable(source: &str) -> Option<Diagnostic> {
    if source.len() > MAX_SOURCE {
        let message = format!("the game is {} bytes long; at most {MAX_SOURCE} are read", source.len());
        let problem = Diagnostic::error("too-large", Span::new(0, 0), message);
        return Some(problem.help("is this a VGDL file?"));
    }
    let is_no_text = |c: char| c.is_control() && !"\t\n\r\u{b}\u{c}".contains(c);
    let (at, c) = source.char_indices().find(|&(_, c)| is_no_text(c))?;
    let message = format!("the file holds the control character `{}`", c.escape_default());
    let problem = Diagnostic::error("not-text", Span::new(at, at + c.len_utf8()), message);
    Some(problem.help("remove it, or is this no VGDL file? VGDL is plain text"))
}

/// Reads a game file. The tree holds every line that could be read; the diagnostics, sorted by place, name the rest.
///
/// Cost: linear in the text. Texts above [`MAX_SOURCE`] bytes give one diagnostic and an empty tree.
pub fn parse(source: &str) -> (Description, Vec<Diagnostic>) {
    let (description, problems) = parse_all(source);
    (description, problems.shortened(source.len()).0)
}

/// [`parse`] with all problems, however many there are.
pub(crate) fn parse_all(source: &str) -> (Description, Diagnostics) {
    let mut reader = Reader::default();
    match unreadable(source) {
        Some(problem) => reader.problems.push(problem),
        None => reader.read(source),
    }
    (reader.description, Diagnostics::sorted(reader.problems))
}

/// The problem of a line that is too long to be read.
pub(super) fn long_line(line: &Line<'_>) -> Option<Diagnostic> {
    let length = line.text.len();
    let message = format!("this line is {length} bytes long; at most {MAX_LINE} are read");
    let problem = Diagnostic::error("too-long", line.span, message).help("is this a VGDL file?");
    (length > MAX_LINE).then_some(problem)
}

/// The problem of a sprite's name that is too long.
pub(super) fn long_name(name: &Word) -> Option<Diagnostic> {
    let length = name.text.len();
    let message = format!("this name is {length} bytes long; the limit is {MAX_NAME}");
    let problem = Diagnostic::error("too-long", name.span, message).help("choose a shorter name");
    (length > MAX_NAME).then_some(problem)
}

/// The problem of sprites that are nested too deep.
pub(super) fn too_deep(line: &Line<'_>) -> Diagnostic {
    let message = format!("sprites are nested more than {MAX_NESTING} deep");
    let problem = Diagnostic::error("too-deep", line.span, message);
    problem.help("indent siblings alike: a line that is indented deeper is a subtype")
}

#[derive(Default)]
struct Reader {
    description: Description,
    problems: Vec<Diagnostic>,
    /// The lines of the SpriteSet stand in columns; those that do not have been told of.
    columns: bool,
}

enum Token {
    Word(Word),
    Arrow(Span),
    Param(Param),
}

impl Reader {
    fn read(&mut self, source: &str) {
        let (mut lines, tail) = layout::lines(source);
        self.problems.extend(lines.iter().filter_map(long_line));
        lines.retain(|line| long_line(line).is_none());
        lines.retain_mut(|line| self.without_foreign_comment(line));
        self.description.tail = tail.into_iter().map(str::to_owned).collect();
        let Some((header, rest)) = lines.split_first() else {
            let problem = Diagnostic::error("empty-game", Span::new(0, 0), "the file holds no game")
                .help("a game starts with a line `BasicGame`, then SpriteSet, LevelMapping, InteractionSet, TerminationSet");
            self.problems.push(problem);
            return;
        };
        let headless = sections::named(header.text).is_some();
        if headless {
            let message = "the game has no first line `BasicGame`";
            let problem = Diagnostic::error("unknown-game-class", header.span, message);
            self.problems.push(problem.help("add a line `BasicGame` above, indented less than the sections"));
        } else {
            self.header(header);
        }
        let rest = if headless { &lines[..] } else { rest };
        for part in self.mended_parts(header, rest) {
            if let Some(has) = self.description.has.get_mut(part.section as usize) {
                *has = true;
            }
            self.description.section_trivia[part.section as usize] = trivia(part.head);
            self.body(&part);
        }
        for (has, section) in self.description.has.into_iter().zip(Section::ALL) {
            let told = |problem: &Diagnostic| {
                problem.code == "missing-section" && problem.message.contains(section.name())
            };
            if !has && !self.problems.iter().any(told) {
                let message = format!("the game has no {}", section.name());
                let help = format!("add a line `{}`, indented below the first line", section.name());
                self.problems.push(Diagnostic::error("missing-section", header.span, message).help(help));
            }
        }
    }

    /// Cuts off what stands behind `//`, which starts a comment in other languages. Whether anything is left.
    fn without_foreign_comment(&mut self, line: &mut Line<'_>) -> bool {
        let starts = |at: &(usize, &str)| at.0 == 0 || line.text[..at.0].ends_with([' ', '\t']);
        let Some((at, mark)) = line.text.match_indices("//").find(starts) else { return true };
        let span = Span::new(line.span.start + at, line.span.start + at + mark.len());
        let problem = Diagnostic::error("bad-comment", span, "`//` does not start a comment");
        self.problems.push(problem.help("comments start with `#`"));
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
                Token::Word(word) => self.stray_word(&word, "the first line takes `key=value` only"),
                Token::Arrow(span) => {
                    let arrow = Word { text: ">".to_owned(), span };
                    self.stray_word(&arrow, "the first line takes `key=value` only");
                }
            }
        }
        if !["BasicGame", "GameSpace"].contains(&header.class.text.as_str()) {
            let span = if header.class.text.is_empty() { line.span } else { header.class.span };
            let message = match header.class.text.as_str() {
                "" => "the first line names no game class".to_owned(),
                class => format!("`{class}` is not a game class"),
            };
            let problem = Diagnostic::error("unknown-game-class", span, message);
            let problem =
                problem.help("the first line that is not a comment must be `BasicGame key=value …`");
            self.problems.push(problem.suggest(&header.class.text, ["BasicGame", "GameSpace"]));
        }
        self.description.header = header;
    }

    /// The sections as they were meant, with a problem for each that is not as it should be.
    fn mended_parts<'a, 'b>(&mut self, header: &'b Line<'a>, lines: &'b [Line<'a>]) -> Vec<Part<'a, 'b>> {
        let parts = sections::mended(header, lines, &mut self.problems);
        for (at, part) in parts.iter().enumerate() {
            if parts[..at].iter().any(|other| other.section == part.section) {
                let message = format!("the game has a second {}", part.section.name());
                let problem = Diagnostic::error("duplicate-section", part.head.span, message);
                self.problems.push(problem.help("move its lines to the first one"));
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
                problem.help("put the SpriteSet first: what it declares is not known before it is read"),
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
            // Read all the same, so that their names are known.
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
        for &line in &part.body {
            match section {
                Section::SpriteSet => unreachable!("read above"),
                Section::LevelMapping => self.mapping(line),
                Section::InteractionSet => self.interaction(line),
                Section::TerminationSet => self.termination(line),
                Section::ParameterSet => self.parameter(line),
            }
        }
    }

    /// A word where none belongs; `rule` says what does.
    fn stray_word(&mut self, word: &Word, rule: &str) {
        let message = format!("`{}` does not belong here: {rule}", word.text);
        let problem = Diagnostic::error("stray-word", word.span, message);
        self.problems.push(match repair::parameter(&word.text) {
            Some(param) => problem.help(format!("did you mean `{param}`?")),
            None => problem.help(format!("remove `{}`", word.text)),
        });
    }

    /// Siblings are the lines at one depth; deeper lines are children of the line above (`spec/01` §1.3).
    fn sprites(&mut self, lines: &[&Line<'_>], out: &mut Vec<SpriteLine>, depth: usize) {
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
                let problem = Diagnostic::warning(
                    "uneven-indent",
                    line.span,
                    "this line is indented unlike its siblings",
                )
                .help(format!("indent it by {indent} columns, like them"));
                self.problems.push(problem);
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

    fn sprite(&mut self, line: &Line<'_>) -> Option<SpriteLine> {
        let mut sprite = SpriteLine { trivia: trivia(line), ..SpriteLine::default() };
        let mut arrow = false;
        let mut strays = Vec::new();
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if sprite.name.text.is_empty() && !arrow => sprite.name = word,
                Token::Word(word) if sprite.class.is_none() && !glued(&word) => sprite.class = Some(word),
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
            // One of the words was meant as the arrow, or holds it: of the others only a class is sure.
            let known = |word: &Word| SpriteClass::from_name(&word.text).is_some();
            sprite.class = sprite.class.into_iter().chain(strays.drain(..)).find(known);
        }
        for word in strays {
            self.stray_word(&word, "a sprite has one class");
        }
        self.problems.extend(long_name(&sprite.name));
        (!sprite.name.text.is_empty()).then_some(sprite)
    }

    /// The problem of a line whose arrow is missing or something else: at that word, if there is one. What to write there.
    /// `place` says where an arrow belongs.
    fn mend_arrow(&mut self, line: &Line<'_>, has_arrow: bool, shape: &str, place: &str) -> Option<String> {
        let mut words = line.text.split([' ', '\t']).filter(|word| !word.is_empty());
        let meant = words.find_map(|word| Some((word, repair::arrow(word)?))).filter(|_| !has_arrow);
        let Some((word, fixed)) = meant else {
            let (message, help) = match has_arrow {
                true => ("nothing stands before the `>`", "put the name before the `>`".to_owned()),
                false => ("this line has no ` > `", format!("put ` > ` {place}, with a blank on both sides")),
            };
            let problem = Diagnostic::error("missing-arrow", line.span, format!("{message}: {shape}"));
            self.problems.push(problem.help(help));
            return None;
        };
        let start = line.span.start + (word.as_ptr() as usize - line.text.as_ptr() as usize);
        let span = Span::new(start, start + word.len());
        let problem = Diagnostic::error("missing-arrow", span, format!("`{word}` is no ` > `: {shape}"));
        self.problems.push(problem.help(format!("write ` {fixed} `, with blanks around the `>`")));
        Some(fixed)
    }

    fn mapping(&mut self, line: &Line<'_>) {
        let shape = "a mapping is `c > sprite sprite …`";
        let Ok(mut pairs) = Grammar::parse(Rule::mapping, line.text) else {
            let start = |text: &str| line.span.start + (text.as_ptr() as usize - line.text.as_ptr() as usize);
            let mut words = line.text.split([' ', '\t', '\u{b}', '\u{c}']).filter(|word| !word.is_empty());
            let Some(arrow) = words.clone().find(|&word| word == ">") else {
                self.mend_arrow(line, false, shape, "after the character");
                return;
            };
            if let Some(param) = words.find(|word| word.contains('=') && start(word) > start(arrow)) {
                let span = Span::new(start(param), start(param) + param.len());
                self.stray_word(&Word { text: param.to_owned(), span }, shape);
                return;
            }
            let before = line.text[..start(arrow) - line.span.start].trim_end();
            let (message, end) = match before {
                "" => ("no character stands before the `>`".to_owned(), start(arrow) + 1),
                _ => (format!("`{before}` is more than one character"), line.span.start + before.len()),
            };
            let problem = Diagnostic::error("bad-mapping", Span::new(line.span.start, end), message);
            self.problems.push(problem.help("put one character before the `>`, then the names of sprites"));
            return;
        };
        let mut mapping = MappingLine { trivia: trivia(line), ..MappingLine::default() };
        for pair in pairs.next().expect("the rule matched").into_inner() {
            match pair.as_rule() {
                Rule::symbol => {
                    mapping.span = span(line, &pair);
                    let mut characters = pair.as_str().chars();
                    mapping.symbol = characters.next().expect("a symbol is not empty");
                    if characters.next().is_some() || !mapping.symbol.is_ascii_graphic() {
                        let message = format!("`{}` is not one printable ASCII character", pair.as_str());
                        let problem = Diagnostic::error("bad-mapping", mapping.span, message);
                        self.problems.push(
                            problem.help("put one character before the `>`: a letter, a digit or a sign"),
                        );
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
                problem.help("name at least one sprite after `>`; for an empty cell levels have the blank"),
            );
        }
        self.description.mapping.push(mapping);
    }

    fn interaction(&mut self, line: &Line<'_>) {
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
        let is_effect = |word: &Word| effects::NAMES.contains(&word.text.as_str());
        if let ([_, ..], [effect, extra, ..]) = (&names[..], &after[..]) {
            let extra = if is_effect(effect) || !is_effect(extra) { extra } else { effect }.clone();
            self.stray_word(&extra, "an interaction has one effect");
            after.retain(|effect| *effect != extra);
            after.truncate(1);
        }
        let partners = "name two sprites before `>`: the one acted upon, then its partner (or EOS)";
        let fault = match (&names[..], &after[..]) {
            ([], _) => Some((arrow, "no sprites stand before the `>`".to_owned(), partners)),
            ([one], _) => Some((one.span, format!("`{}` has no partner", one.text), partners)),
            (_, []) => {
                Some((arrow, "no effect stands after the `>`".to_owned(), "name the effect after `>`"))
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

    fn termination(&mut self, line: &Line<'_>) {
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
            self.problems.push(problem.help(format!("put its class first, maybe `{class}`")));
        } else {
            self.description.terminations.push(termination);
        }
    }

    fn parameter(&mut self, line: &Line<'_>) {
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

    fn tokens(&mut self, line: &Line<'_>) -> Vec<Token> {
        let mut pairs = Grammar::parse(Rule::tokens, line.text).expect("whatever is no blank is a token");
        let mut tokens = Vec::new();
        let mut pairs = pairs.next().expect("the rule matched").into_inner().peekable();
        while let Some(pair) = pairs.next() {
            match pair.as_rule() {
                Rule::word => tokens.push(Token::Word(word(line, &pair))),
                Rule::arrow => tokens.push(Token::Arrow(span(line, &pair))),
                Rule::param => {
                    let whole = word(line, &pair);
                    let mut parts = pair.into_inner();
                    let mut part = || word(line, &parts.next().expect("a parameter has a key and a value"));
                    let param = Param { key: part(), value: part() };
                    if param.key.text.is_empty() {
                        self.broken_param(line, whole, &mut tokens, &mut pairs);
                    } else {
                        tokens.push(Token::Param(param));
                    }
                }
                Rule::broken => self.broken_param(line, word(line, &pair), &mut tokens, &mut pairs),
                _ => {}
            }
        }
        tokens
    }

    /// A word with an `=` that is no `key=value`: with blanks around the `=`, half of it missing, or several of them. What
    /// it was meant to be is read, so that it costs one problem.
    fn broken_param<'a>(
        &mut self,
        line: &Line<'_>,
        whole: Word,
        tokens: &mut Vec<Token>,
        rest: &mut Peekable<Pairs<'a, Rule>>,
    ) {
        let next = rest.peek().filter(|next| next.as_rule() == Rule::word).map(|next| word(line, next));
        let known = |word: &Word| {
            SpriteClass::from_name(&word.text).is_some() || effects::NAMES.contains(&word.text.as_str())
        };
        let has_arrow = line.text.split([' ', '\t']).any(|word| word == ">");
        // `gold = color=RED`, in a line that needs an arrow.
        let names_sprite =
            |word: &Word| word.text != "BasicGame" && !terminations::NAMES.contains(&word.text.as_str());
        let after_name = || matches!(&tokens[..], [Token::Word(first)] if names_sprite(first));
        let like_arrow = || next.as_ref().map_or_else(after_name, known);
        if whole.text == "=>" || whole.text == "=" && !has_arrow && like_arrow() {
            // Meant as the arrow; whoever misses that says so.
            return;
        }
        let (key, value) = whole.text.split_once('=').expect("it is broken at its `=`");
        let value = value.rsplit('=').next().unwrap_or_default();
        let key = match tokens.last() {
            Some(Token::Word(before)) if key.is_empty() => Some(before.clone()),
            _ => Some(Word { text: key.to_owned(), span: whole.span }).filter(|key| !key.text.is_empty()),
        };
        let value = match value {
            "" => next,
            value => Some(Word { text: value.to_owned(), span: whole.span }),
        };
        let message = |what: &str| format!("`{what}` is not `key=value`");
        let (Some(key), Some(value)) = (key, value) else {
            let message = message(&whole.text);
            let problem = Diagnostic::error("bad-parameter", whole.span, message);
            self.problems.push(match whole.text.strip_suffix('=') {
                Some("") => problem.help("remove it, or write a parameter as one word"),
                Some(key) => problem.help(format!("write a value after `{key}=`, without a blank")),
                None => problem.help(format!("write the parameter's name before `{}`", whole.text)),
            });
            return;
        };
        let taken = |word: &Word| word.span.start != whole.span.start;
        if taken(&key) {
            tokens.pop();
        }
        if taken(&value) {
            rest.next();
        }
        let span = Span::new(key.span.start, value.span.end);
        let written = &line.text[span.start - line.span.start..span.end - line.span.start];
        let problem = Diagnostic::error("bad-parameter", span, message(written));
        self.problems.push(problem.help(format!("write `{}={}`", key.text, value.text)));
        tokens.push(Token::Param(Param { key, value }));
    }
}

/// Whether a word where a class may stand is a parameter without its `=`.
fn glued(word: &Word) -> bool {
    SpriteClass::from_name(&word.text).is_none() && repair::parameter(&word.text).is_some()
}

fn span(line: &Line<'_>, pair: &Pair<'_, Rule>) -> Span {
    let inner = pair.as_span();
    Span::new(line.span.start + inner.start(), line.span.start + inner.end())
}

fn word(line: &Line<'_>, pair: &Pair<'_, Rule>) -> Word {
    Word { text: pair.as_str().to_owned(), span: span(line, pair) }
}

fn trivia(line: &Line<'_>) -> Trivia {
    let own = |text: &&str| (*text).to_owned();
    Trivia { above: line.above.iter().map(own).collect(), beside: line.beside.as_ref().map(own) }
}

/// What the value of a parameter reads as, before the field's type is looked at (`spec/01` §1.10, steps 2–5).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Literal {
    Int(i32),
    Double(f64),
    Bool(bool),
    Text,
}

pub(crate) fn literal(text: &str) -> Literal {
    let Ok(mut pairs) = Grammar::parse(Rule::literal, text) else { return Literal::Text };
    let pair = pairs.next().and_then(|pair| pair.into_inner().next()).expect("the rule has one part");
    let number =
        || text.trim_end_matches(['f', 'F', 'd', 'D']).parse().map_or(Literal::Text, Literal::Double);
    match pair.as_rule() {
        Rule::integer => text.parse().map_or_else(|_| number(), Literal::Int),
        Rule::double => number(),
        Rule::hex => Literal::Double(hexadecimal(text)),
        Rule::special if text.ends_with("NaN") => Literal::Double(f64::NAN),
        Rule::special if text.starts_with('-') => Literal::Double(f64::NEG_INFINITY),
        Rule::special => Literal::Double(f64::INFINITY),
        _ => Literal::Bool(text.eq_ignore_ascii_case("true")),
    }
}

/// The value of `0x1.8p3`: digits to the base of 16, times a power of two.
fn hexadecimal(text: &str) -> f64 {
    let negative = text.starts_with('-');
    let text = text.trim_start_matches(['+', '-']).trim_end_matches(['f', 'F', 'd', 'D']);
    let (digits, exponent) = text[2..].split_once(['p', 'P']).expect("the grammar asks for it");
    let mut exponent = exponent.parse().unwrap_or(if exponent.starts_with('-') { -5000 } else { 5000 });
    let point = digits.find('.').unwrap_or(digits.len());
    exponent = i32::clamp(exponent, -5000, 5000);
    let (mut mantissa, mut places) = (0u64, 0i64);
    for (at, digit) in digits.chars().filter_map(|digit| digit.to_digit(16)).enumerate() {
        // Digits beyond those that a double holds only say that there is more.
        if mantissa < 1 << 59 {
            mantissa = mantissa << 4 | u64::from(digit);
            places += i64::from(at >= point);
        } else {
            mantissa |= u64::from(digit != 0);
            places -= i64::from(at < point);
        }
    }
    let scaled = i64::from(exponent) - 4 * places;
    let value = libm::scalbn(mantissa as f64, scaled.clamp(-10_000, 10_000) as i32);
    if negative { -value } else { value }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(source: &str) -> Vec<&'static str> {
        parse(source).1.into_iter().map(|problem| problem.code).collect()
    }

    const NONE: [&str; 0] = [];
    const SMALL: &str = "BasicGame square_size=10\n  SpriteSet\n    a > Missile speed=1.5\n      b > color=RED\n  LevelMapping\n    x > a b\n  InteractionSet\n    a b EOS > killSprite scoreChange=-1\n  TerminationSet\n    Timeout limit=5 win=True\n";

    #[test]
    fn a_small_game_parses_without_problems() {
        let (game, problems) = parse(SMALL);
        assert_eq!(problems, []);
        assert_eq!(game.sprites[0].children[0].name.text, "b");
        assert_eq!(game.mapping[0].names.len(), 2);
        assert_eq!(game.interactions[0].second[1].text, "EOS");
        assert_eq!(game.terminations[0].params[1].value.text, "True");
        let speed = &game.sprites[0].params[0];
        assert_eq!(&SMALL[speed.span().start..speed.span().end], "speed=1.5");
    }

    #[test]
    fn a_bad_line_costs_one_problem() {
        assert_eq!(codes(&SMALL.replace("a b EOS > killSprite", "a b EOS killSprite")), ["missing-arrow"]);
        assert_eq!(codes(&SMALL.replace("a > Missile", "a Missile")), ["missing-arrow"]);
        assert_eq!(codes(&SMALL.replace("limit=5", "limit=")), ["bad-parameter"]);
        assert_eq!(codes(&SMALL.replace("  LevelMapping", "  LevelMaping")), ["unknown-section"]);
        assert_eq!(codes(&SMALL.replace("  LevelMapping\n", "")), ["missing-section"]);
        assert_eq!(codes(&SMALL.replace("    a b EOS", "   a b EOS")), NONE);
        assert_eq!(codes(&SMALL.replace("speed=1.5", "speed = 1.5")), ["bad-parameter"]);
        assert_eq!(codes(&SMALL.replace("speed=1.5", "speed1.5")), ["stray-word"]);
        assert_eq!(
            codes(&SMALL.replace("    x > a b\n", "    x > a b\n    Timeout limit=1\n")),
            ["wrong-section"]
        );
        assert_eq!(codes(&SMALL.replace("x > a b", "xy > a b")), ["bad-mapping"]);
        assert_eq!(codes(&SMALL.replace("BasicGame", "Basicgame")), ["unknown-game-class"]);
        assert_eq!(codes(""), ["empty-game"]);
        assert_eq!(codes("\u{0}"), ["not-text"]);
        assert_eq!(codes(&"x".repeat(MAX_SOURCE + 1)), ["too-large"]);
    }

    #[test]
    fn literals_follow_the_conversion_order() {
        assert_eq!(literal("-3"), Literal::Int(-3));
        assert_eq!(literal("99999999999"), Literal::Double(99_999_999_999.0));
        assert_eq!(literal("1e3"), Literal::Double(1000.0));
        assert_eq!(literal("2f"), Literal::Double(2.0));
        assert_eq!(literal("TRUE"), Literal::Bool(true));
        assert_eq!(literal("0x1.8p3"), Literal::Double(12.0));
        assert_eq!(literal("-0X.8P0f"), Literal::Double(-0.5));
        assert_eq!(literal("0x10000000000000001p-4"), Literal::Double((1u64 << 60) as f64));
        assert_eq!(literal("0x0.00001p0"), Literal::Double(1.0 / 1_048_576.0));
        assert_eq!(literal("0x10"), Literal::Text);
        assert_eq!(literal("-Infinity"), Literal::Double(f64::NEG_INFINITY));
        assert!(matches!(literal("NaN"), Literal::Double(number) if number.is_nan()));
        assert_eq!(literal("nan"), Literal::Text);
        assert_eq!(literal("1/3"), Literal::Text);
        assert_eq!(literal(""), Literal::Text);
    }
}
