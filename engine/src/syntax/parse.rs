//! Lines to a syntax tree. Never fails: a bad line costs one diagnostic, not the file.

use super::description::{
    Description, Header, InteractionLine, MappingLine, Param, Section, SpriteLine, TerminationLine, Trivia,
    Word,
};
use super::layout::{self, Line};
use crate::diagnostic::{Diagnostic, Span, nearest};
use pest::Parser;
use pest::iterators::Pair;

/// Bytes of game text that are read; a game is a few kilobytes.
pub const MAX_SOURCE: usize = 1 << 20;
/// Levels of indentation in a SpriteSet; the games of the reference have four at most.
const MAX_DEPTH: usize = 32;
/// Problems reported before the rest is summed up in one line.
const MAX_DIAGNOSTICS: usize = 100;

#[derive(pest_derive::Parser)]
#[grammar = "syntax/vgdl.pest"]
struct Grammar;

/// Reads a game file as the reference does: faulty lines are dropped, with a message each; lines indented deeper than
/// their section's first are ignored (`spec/01` §1.3–§1.9). The diagnostics are those that the reference dies of.
pub fn parse_as_reference(source: &str) -> (Description, Vec<Diagnostic>) {
    read(source, true)
}

/// Reads a game file. The tree holds every line that could be read; the diagnostics, sorted by place, name the rest.
///
/// Cost: linear in the text. Texts above [`MAX_SOURCE`] bytes give one diagnostic and an empty tree.
pub fn parse(source: &str) -> (Description, Vec<Diagnostic>) {
    read(source, false)
}

fn read(source: &str, as_reference: bool) -> (Description, Vec<Diagnostic>) {
    let mut reader = Reader { as_reference, ..Reader::default() };
    if source.len() > MAX_SOURCE {
        let message = format!("the game is {} bytes long; at most {MAX_SOURCE} are read", source.len());
        reader
            .problems
            .push(Diagnostic::error("too-large", Span::new(0, 0), message).help("is this a VGDL file?"));
    } else if let Some(at) = source.find(|c: char| c.is_control() && !"\t\n\r\u{b}\u{c}".contains(c)) {
        let message = "the file holds a control character; VGDL is plain text";
        reader
            .problems
            .push(Diagnostic::error("not-text", Span::new(at, at + 1), message).help("is this a VGDL file?"));
    } else {
        reader.read(source);
    }
    if as_reference {
        let fatal =
            ["too-large", "not-text", "empty-game", "unknown-game-class", "missing-section", "too-deep"];
        reader.problems.retain(|problem| fatal.contains(&problem.code));
    }
    let mut problems = crate::diagnostic::Diagnostics::sorted(reader.problems).0;
    if problems.len() > MAX_DIAGNOSTICS {
        let rest = problems.len() - MAX_DIAGNOSTICS;
        problems.truncate(MAX_DIAGNOSTICS);
        let message = format!("{rest} more problems are not shown");
        problems.push(Diagnostic::error("too-many-problems", Span::new(source.len(), source.len()), message));
    }
    (reader.description, problems)
}

#[derive(Default)]
struct Reader {
    description: Description,
    problems: Vec<Diagnostic>,
    as_reference: bool,
    /// The line being read has a token that the reference drops the whole line for.
    broken: bool,
}

enum Token {
    Word(Word),
    Arrow(Span),
    Param(Param),
}

impl Reader {
    fn read(&mut self, source: &str) {
        let (lines, tail) = layout::lines(source);
        self.description.tail = tail.into_iter().map(str::to_owned).collect();
        let Some((header, rest)) = lines.split_first() else {
            let problem = Diagnostic::error("empty-game", Span::new(0, 0), "the file holds no game")
                .help("a game starts with a line `BasicGame`, then SpriteSet, LevelMapping, InteractionSet, TerminationSet");
            self.problems.push(problem);
            return;
        };
        self.header(header);
        let mut at = 0;
        while at < rest.len() {
            let line = &rest[at];
            at += 1;
            let Some(section) = self.section(line) else { continue };
            let body: &[Line<'_>] = &rest[at..];
            let end =
                body.iter().position(|line| Self::names_section(line.text).is_some()).unwrap_or(body.len());
            at += end;
            if !(self.as_reference && line.text != section.name()) {
                self.description.order.push(section);
                self.body(section, line, &body[..end]);
            }
        }
        for (has, section) in self.description.has.into_iter().zip(Section::ALL) {
            let wanted = !self.as_reference || section == Section::SpriteSet;
            if !has && wanted {
                let problem = Diagnostic::error(
                    "missing-section",
                    header.span,
                    format!("the game has no {}", section.name()),
                )
                .help(format!("add a line `{}`, indented below the first line", section.name()));
                self.problems.push(problem);
            }
        }
    }

    fn header(&mut self, line: &Line<'_>) {
        let mut header = Header { trivia: trivia(line), ..Header::default() };
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if header.class.text.is_empty() => header.class = word,
                Token::Param(param) => header.params.push(param),
                Token::Word(Word { span, .. }) | Token::Arrow(span) => {
                    let problem =
                        Diagnostic::error("stray-word", span, "the first line takes `key=value` only");
                    self.problems.push(problem);
                }
            }
        }
        if header.class.text != "BasicGame" {
            let span = if header.class.text.is_empty() { line.span } else { header.class.span };
            let problem = Diagnostic::error("unknown-game-class", span, "a game starts with `BasicGame`");
            let help = match header.class.text.as_str() {
                "GameSpace" => "GameSpace, the reference's parameter spaces, is not supported".to_owned(),
                _ => "the first line that is not a comment must be `BasicGame key=value …`".to_owned(),
            };
            self.problems.push(problem.help(help));
        }
        self.description.header = header;
    }

    fn names_section(text: &str) -> Option<Section> {
        Section::ALL.into_iter().find(|section| section.name().eq_ignore_ascii_case(text))
    }

    /// The section that `line` opens; anything else at this place is a problem.
    fn section(&mut self, line: &Line<'_>) -> Option<Section> {
        let Some(section) = Self::names_section(line.text) else {
            let names = Section::ALL.map(Section::name);
            let problem = Diagnostic::error("stray-line", line.span, "this line is in no section");
            self.problems.push(match nearest(line.text, names) {
                Some(name) => problem.help(format!("did you mean `{name}`?")),
                None => {
                    problem.help("sections are SpriteSet, LevelMapping, InteractionSet and TerminationSet")
                }
            });
            return None;
        };
        if line.text != section.name() {
            let message = format!("`{}` is not a section; names are case-sensitive", line.text);
            let problem = Diagnostic::error("unknown-section", line.span, message);
            self.problems.push(problem.help(format!("write `{}`", section.name())));
        }
        let seen = &mut self.description.has[section as usize];
        if *seen {
            let message = format!("a second {}", section.name());
            let problem = Diagnostic::error("duplicate-section", line.span, message);
            self.problems.push(problem.help("merge the two sections"));
        }
        *seen = true;
        Some(section)
    }

    fn body(&mut self, section: Section, head: &Line<'_>, lines: &[Line<'_>]) {
        let mut inside = Vec::new();
        for line in lines {
            let words = line.text.split([' ', '\t']).count();
            if line.indent <= head.indent {
                let message = format!("this line is not indented below {}", section.name());
                let problem = Diagnostic::error("stray-line", line.span, message);
                self.problems.push(match nearest(line.text, Section::ALL.map(Section::name)) {
                    Some(name) if words == 1 => problem.help(format!("did you mean `{name}`?")),
                    _ => problem.help("indent it deeper than the section's name"),
                });
                if words == 1 && nearest(line.text, Section::ALL.map(Section::name)).is_some() {
                    // A misspelt section: what follows belongs to it, and would only repeat the problem.
                    break;
                }
                continue;
            }
            inside.push(line);
        }
        if section == Section::SpriteSet {
            let mut forest = Vec::new();
            self.sprites(&inside, &mut forest, 0);
            self.description.sprites.append(&mut forest);
            return;
        }
        let indent = inside.first().map_or(0, |line| line.indent);
        for line in inside {
            if self.as_reference && line.indent != indent {
                if line.indent > indent {
                    continue;
                }
                self.description.messages += 1;
            } else if line.indent != indent {
                let problem =
                    Diagnostic::error("stray-indent", line.span, "this line is indented unlike the others")
                        .label("the reference engine ignores such a line")
                        .help(format!(
                            "indent every line of {} by the same {indent} columns",
                            section.name()
                        ));
                self.problems.push(problem);
            }
            match section {
                Section::SpriteSet => unreachable!("read above"),
                Section::LevelMapping => self.mapping(line),
                Section::InteractionSet => self.interaction(line),
                Section::TerminationSet => self.termination(line),
            }
        }
    }

    /// Siblings are the lines at one depth; deeper lines are children of the line above (`spec/01` §1.3).
    fn sprites(&mut self, lines: &[&Line<'_>], out: &mut Vec<SpriteLine>, depth: usize) {
        let Some(first) = lines.first() else { return };
        if depth == MAX_DEPTH {
            let message = format!("sprites are nested more than {MAX_DEPTH} deep");
            self.problems.push(Diagnostic::error("too-deep", first.span, message));
            return;
        }
        let mut at = 0;
        while at < lines.len() {
            let line = lines[at];
            let deeper = lines[at + 1..].iter().take_while(|child| child.indent > line.indent).count();
            if line.indent != first.indent {
                let problem =
                    Diagnostic::warning("uneven-indent", line.span, "siblings are indented differently")
                        .help(format!("indent them all by {} columns", first.indent));
                self.problems.push(problem);
            }
            let mut sprite = self.sprite(line);
            if self.as_reference && sprite.is_none() {
                // A line without `>` ends its list of siblings.
                return;
            }
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
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if sprite.name.text.is_empty() => sprite.name = word,
                Token::Word(word) if sprite.class.is_none() => sprite.class = Some(word),
                Token::Word(word) => {
                    let message = format!("`{}`: a sprite has one class", word.text);
                    self.problems.push(Diagnostic::error("stray-word", word.span, message));
                }
                Token::Arrow(_) => arrow = true,
                Token::Param(param) => sprite.params.push(param),
            }
        }
        if !arrow || sprite.name.text.is_empty() {
            let problem =
                Diagnostic::error("missing-arrow", line.span, "a sprite line is `name > Class key=value …`")
                    .help("put ` > ` after the name, with a blank on both sides");
            self.problems.push(problem);
        }
        if self.as_reference && !arrow {
            return None;
        }
        (!sprite.name.text.is_empty()).then_some(sprite)
    }

    fn mapping(&mut self, line: &Line<'_>) {
        let Ok(mut pairs) = Grammar::parse(Rule::mapping, line.text) else {
            let problem =
                Diagnostic::error("bad-mapping", line.span, "a mapping line is `c > sprite sprite …`")
                    .help("one character, ` > `, then the names of sprites");
            self.problems.push(problem);
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
                        self.problems.push(Diagnostic::error("bad-mapping", mapping.span, message));
                    }
                }
                Rule::word => mapping.names.push(word(line, &pair)),
                _ => {}
            }
        }
        if mapping.names.is_empty() {
            let problem = Diagnostic::warning("empty-mapping", line.span, "this character places nothing");
            self.problems.push(problem.help("name at least one sprite after `>`"));
        }
        self.description.mapping.push(mapping);
    }

    fn interaction(&mut self, line: &Line<'_>) {
        let mut names = Vec::new();
        let mut effects = Vec::new();
        let mut interaction = InteractionLine { trivia: trivia(line), ..InteractionLine::default() };
        let mut arrow = false;
        for token in self.tokens(line) {
            match token {
                Token::Arrow(_) => arrow = true,
                Token::Word(word) if arrow => effects.push(word),
                Token::Word(word) => names.push(word),
                Token::Param(param) => interaction.params.push(param),
            }
        }
        if self.as_reference {
            if self.broken || !arrow || effects.is_empty() || names.is_empty() {
                self.description.messages += 1;
                return;
            }
            interaction.first = names.remove(0);
            interaction.second = names;
            interaction.effect = effects.pop().expect("there is one");
            self.description.interactions.push(interaction);
            return;
        }
        let shape = "an interaction is `sprite partner … > effect key=value …`";
        if !arrow || names.len() < 2 || effects.len() != 1 {
            let help = match (arrow, names.len(), effects.len()) {
                (false, ..) => "put ` > ` before the effect, with a blank on both sides",
                (_, 0 | 1, _) => "name two sprites before `>`: the one acted upon, then its partner (or EOS)",
                (_, _, 0) => "name the effect after `>`",
                _ => "name one effect only",
            };
            self.problems.push(Diagnostic::error("bad-interaction", line.span, shape).help(help));
            return;
        }
        interaction.first = names.remove(0);
        interaction.second = names;
        interaction.effect = effects.remove(0);
        self.description.interactions.push(interaction);
    }

    fn termination(&mut self, line: &Line<'_>) {
        let mut termination = TerminationLine { trivia: trivia(line), ..TerminationLine::default() };
        for token in self.tokens(line) {
            match token {
                Token::Word(word) if termination.class.text.is_empty() => termination.class = word,
                Token::Word(Word { span, .. }) | Token::Arrow(span) => {
                    let message = "a termination is `Class key=value …`";
                    self.problems.push(Diagnostic::error("stray-word", span, message));
                }
                Token::Param(param) => termination.params.push(param),
            }
        }
        if self.as_reference && self.broken {
            self.description.messages += 1;
            return;
        }
        if termination.class.text.is_empty() {
            let message = "a termination is `Class key=value …`";
            self.problems.push(Diagnostic::error("bad-termination", line.span, message));
        } else {
            self.description.terminations.push(termination);
        }
    }

    fn tokens(&mut self, line: &Line<'_>) -> Vec<Token> {
        let mut pairs = match Grammar::parse(Rule::tokens, line.text) {
            Ok(pairs) => pairs,
            Err(_) => {
                self.problems.push(Diagnostic::error("bad-line", line.span, "this line cannot be read"));
                return Vec::new();
            }
        };
        let mut tokens = Vec::new();
        self.broken = false;
        for pair in pairs.next().expect("the rule matched").into_inner() {
            match pair.as_rule() {
                Rule::word => tokens.push(Token::Word(word(line, &pair))),
                Rule::arrow => tokens.push(Token::Arrow(span(line, &pair))),
                Rule::param => {
                    let mut parts = pair.into_inner();
                    let mut part = || word(line, &parts.next().expect("a parameter has a key and a value"));
                    tokens.push(Token::Param(Param { key: part(), value: part() }));
                }
                Rule::broken => {
                    self.broken = true;
                    let message = format!("`{}` is not `key=value`", pair.as_str());
                    let problem = Diagnostic::error("bad-parameter", span(line, &pair), message);
                    self.problems
                        .push(problem.help("write it without blanks around the `=`, and with a value"));
                }
                _ => {}
            }
        }
        tokens
    }
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
        _ => Literal::Bool(text.eq_ignore_ascii_case("true")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(source: &str) -> Vec<&'static str> {
        parse(source).1.into_iter().map(|problem| problem.code).collect()
    }

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
        assert_eq!(codes(&SMALL.replace("a b EOS > killSprite", "a b EOS killSprite")), ["bad-interaction"]);
        assert_eq!(codes(&SMALL.replace("a > Missile", "a Missile")), ["missing-arrow"]);
        assert_eq!(codes(&SMALL.replace("limit=5", "limit=")), ["bad-parameter"]);
        assert_eq!(
            codes(&SMALL.replace("  LevelMapping", "  LevelMaping")),
            ["missing-section", "stray-line"]
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
        assert_eq!(literal("1/3"), Literal::Text);
        assert_eq!(literal(""), Literal::Text);
    }
}
