//! Reads a game file in reference mode (`spec/01` §1.1–§1.9). The indentation turns the lines into a tree,
//! faulty lines are dropped with one message per line, and only the direct children of each section are read.

use super::description::{
    Description, Header, InteractionLine, MappingLine, Param, ParameterLine, Section, SpriteLine,
    TerminationLine, Word,
};
use crate::diagnostic::{Diagnostic, Span};
use crate::limits::MAX_NESTING;
use crate::syntax::parse::bounds::{long_line, long_name, too_deep};
use crate::syntax::parse::layout;
use crate::syntax::parse::layout::Line;
use crate::syntax::parse::sections;

/// Returns the description as the reference uses it, or the fault on which the reference crashes.
pub(super) fn read(source: &str) -> Result<Description, Diagnostic> {
    if let Some(span) = layout::bare_hashes(source) {
        let problem = Diagnostic::error(
            "bare-comment",
            span,
            "a line that contains nothing but `#`, in the first column",
        );
        return Err(problem.help("the reference engine crashes on such a line; add a space or a word"));
    }
    let (lines, _) = layout::lines(source);
    if let Some(problem) = lines.iter().find_map(long_line) {
        return Err(problem);
    }
    let mut tree = Tree::default();
    let mut grammar = None;
    for line in &lines {
        let heading = sections::named(line.text);
        grammar = heading.or(grammar);
        tree.insert(Node { line, tokens: tokens(line), grammar, heading, parent: 0, children: Vec::new() });
    }
    tree.describe()
}

/// A line and its position in the tree.
struct Node<'a> {
    line: &'a Line<'a>,
    tokens: Vec<Word>,
    /// The line's grammar, as determined by the last section name before the line, wherever that name is in the tree.
    /// `None` if there is no such name.
    grammar: Option<Section>,
    /// The section whose name is on the line, ignoring case; `None` if the line is not a section name.
    heading: Option<Section>,
    parent: usize,
    children: Vec<usize>,
}

impl Node<'_> {
    /// Returns `true` if the line can be read. The reference drops all other lines.
    fn is_sound(&self) -> bool {
        let after = match self.grammar {
            Some(Section::LevelMapping) => return true,
            // A one-word line is accepted here, but stops the parser later.
            Some(Section::InteractionSet) if self.tokens.len() == 1 => return true,
            Some(Section::InteractionSet) => match self.arrow() {
                Some(at) => &self.tokens[at + 1..],
                None => return false,
            },
            _ => &self.tokens[1..],
        };
        let broken = |token: &&Word| token.text.contains('=') && param(token).is_none();
        let has_effect = after.iter().any(|token| !token.text.contains('='));
        !after.iter().any(|token| broken(&token))
            && (has_effect || self.grammar != Some(Section::InteractionSet))
    }

    /// Returns the index of the first `>` after the first word; `None` if there is none.
    fn arrow(&self) -> Option<usize> {
        self.tokens.iter().skip(1).position(|token| token.text == ">").map(|at| at + 1)
    }

    fn params(&self) -> Vec<Param> {
        self.tokens[1..].iter().filter_map(param).collect()
    }
}

#[derive(Default)]
struct Tree<'a> {
    nodes: Vec<Node<'a>>,
    description: Description,
}

impl<'a> Tree<'a> {
    fn insert(&mut self, node: Node<'a>) {
        if !node.is_sound() {
            return self.message();
        }
        let Some(mut parent) = self.nodes.len().checked_sub(1) else { return self.nodes.push(node) };
        while self.nodes[parent].line.indent >= node.line.indent {
            if parent == 0 {
                // The line is not indented below the first line.
                return self.message();
            }
            parent = self.nodes[parent].parent;
        }
        let number = self.nodes.len();
        let siblings = &self.nodes[parent].children;
        if siblings.first().is_some_and(|&first| self.nodes[first].line.indent != node.line.indent) {
            self.message();
        }
        self.nodes[parent].children.push(number);
        self.nodes.push(Node { parent, ..node });
    }

    fn message(&mut self) {
        self.description.messages += 1;
    }

    fn describe(mut self) -> Result<Description, Diagnostic> {
        let Some(root) = self.nodes.first() else {
            return Err(Diagnostic::error("empty-game", Span::new(0, 0), "the file contains no game"));
        };
        let class = root.tokens[0].clone();
        let is_space = class.text == "GameSpace";
        if root.grammar.is_some() || !is_space && class.text != "BasicGame" {
            let message = "a game starts with `BasicGame`, or with `GameSpace`";
            return Err(Diagnostic::error("unknown-game-class", class.span, message));
        }
        self.description.header = Header { class, params: root.params(), ..Header::default() };
        for at in root.children.clone() {
            let node = &self.nodes[at];
            let heading = node.heading.filter(|section| node.line.text == section.name());
            match heading {
                Some(Section::ParameterSet) if !is_space => {
                    let message = "only a GameSpace has a ParameterSet";
                    return Err(Diagnostic::error("stray-line", node.line.span, message));
                }
                Some(section) => self.section(section, at)?,
                // The reference searches these lines for a section name and finds none.
                None if node.grammar.is_none()
                    || node.grammar == Some(Section::InteractionSet) && node.heading.is_none() =>
                {
                    let problem =
                        Diagnostic::error("stray-line", node.line.span, "this line is not in any section");
                    return Err(problem
                        .help("the reference engine crashes on such a line; indent it below a section"));
                }
                None => {}
            }
        }
        let header = &self.description.header;
        if !self.description.has[Section::SpriteSet as usize] {
            let message = "the game has no SpriteSet";
            return Err(Diagnostic::error("missing-section", header.class.span, message));
        }
        Ok(self.description)
    }

    fn section(&mut self, section: Section, at: usize) -> Result<(), Diagnostic> {
        let children = std::mem::take(&mut self.nodes[at].children);
        let foreign = children.iter().position(|&child| self.nodes[child].grammar != Some(section));
        if section == Section::SpriteSet {
            let seen = std::mem::replace(&mut self.description.has[section as usize], true);
            if seen || foreign.is_some() {
                let span = self.nodes[foreign.map_or(at, |foreign| children[foreign])].line.span;
                let message = if seen { "a second SpriteSet" } else { "a section below the SpriteSet" };
                let problem = Diagnostic::error("unsupported", span, message);
                return Err(problem.help("the reference engine reads such a file incorrectly or not at all"));
            }
            let sprites = self.sprites(&children, 0)?;
            self.description.order.push((section, sprites.len()));
            self.description.sprites = sprites;
            return Ok(());
        }
        if let Some(has) = self.description.has.get_mut(section as usize) {
            *has = true;
        }
        let own = foreign.unwrap_or(children.len());
        for &child in &children[..own] {
            self.line(section, child);
        }
        self.description.order.push((section, own));
        if foreign.is_some() {
            // A line from another section stops the parser, just like an interaction without an effect.
            self.description.interactions.push(InteractionLine::default());
            self.description.order.push((Section::InteractionSet, 1));
        }
        Ok(())
    }

    fn line(&mut self, section: Section, at: usize) {
        let node = &self.nodes[at];
        let word = |at: usize| node.tokens.get(at).cloned().unwrap_or_default();
        match section {
            Section::SpriteSet => unreachable!("sprites are nested"),
            Section::ParameterSet => {
                let line = ParameterLine { name: word(0), params: node.params(), ..Default::default() };
                self.description.parameters.push(line);
            }
            Section::LevelMapping => {
                let span = node.tokens[0].span;
                let symbol = node.tokens[0].text.chars().next().expect("words are not empty");
                let names = node.tokens.iter().skip(2).cloned().collect();
                self.description.mapping.push(MappingLine { symbol, span, names, ..Default::default() });
            }
            Section::InteractionSet => {
                let arrow = node.arrow().unwrap_or(node.tokens.len());
                let (before, after) = node.tokens.split_at(arrow);
                let mut effects = after.iter().skip(1).filter(|token| !token.text.contains('='));
                let line = InteractionLine {
                    first: word(0),
                    second: before[1..].to_vec(),
                    effect: effects.next_back().cloned().unwrap_or_default(),
                    params: after.iter().filter_map(param).collect(),
                    ..Default::default()
                };
                self.description.interactions.push(line);
            }
            Section::TerminationSet => {
                let line = TerminationLine { class: word(0), params: node.params(), ..Default::default() };
                self.description.terminations.push(line);
            }
        }
    }

    /// Reads sprite lines. A line without `>` ends the list of siblings.
    fn sprites(&self, siblings: &[usize], depth: usize) -> Result<Vec<SpriteLine>, Diagnostic> {
        let mut lines = Vec::new();
        for &at in siblings {
            let node = &self.nodes[at];
            if depth == MAX_NESTING {
                return Err(too_deep(node.line));
            }
            if let Some(problem) = long_name(&node.tokens[0]) {
                return Err(problem);
            }
            let words = || node.tokens[1..].iter().filter(|token| !token.text.contains('='));
            if !words().any(|word| word.text == ">") {
                break;
            }
            lines.push(SpriteLine {
                name: node.tokens[0].clone(),
                class: words().rfind(|word| word.text != ">").cloned(),
                params: node.params(),
                children: self.sprites(&node.children, depth + 1)?,
                ..Default::default()
            });
        }
        Ok(lines)
    }
}

/// Returns the words on a line, separated only by spaces and control characters.
fn tokens(line: &Line<'_>) -> Vec<Word> {
    let words = line.text.split(|c: char| c <= ' ').filter(|word| !word.is_empty());
    words.map(|word| Word { text: word.to_owned(), span: line.span_of(word) }).collect()
}

/// Returns the parameter in a word with an equals sign; `None` if the word has no equals sign, or no text after it. The
/// key is the text before the first equals sign, and the value is the text up to the next equals sign.
fn param(token: &Word) -> Option<Param> {
    let parts: Vec<&str> = token.text.trim_end_matches('=').split('=').collect();
    let (&[key, value, ..], true) = (&parts[..], token.text.contains('=')) else { return None };
    let part =
        |text: &str, start: usize| Word { text: text.to_owned(), span: Span::new(start, start + text.len()) };
    Some(Param { key: part(key, token.span.start), value: part(value, token.span.start + key.len() + 1) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn sound(source: &str) -> Description {
        read(source).unwrap_or_else(|problem| panic!("{}: {}", problem.code, problem.message))
    }

    #[track_caller]
    fn dies(source: &str, code: &str) {
        assert_eq!(read(source).unwrap_err().code, code, "{source}");
    }

    const SMALL: &str = "BasicGame\n  SpriteSet\n    a > Missile\n      b > Bomber\n    c >\n";

    fn names(lines: &[SpriteLine]) -> Vec<&str> {
        lines.iter().map(|line| line.name.text.as_str()).collect()
    }

    #[test]
    fn words_and_parameters_are_read_as_they_come() {
        let game = sound("BasicGame\n  SpriteSet\n    a X > Missile x=1=2 y==3 Bomber =4\n");
        let sprite = &game.sprites[0];
        assert_eq!(sprite.class.as_ref().unwrap().text, "Bomber");
        let params = |param: &Param| (param.key.text.clone(), param.value.text.clone());
        let own = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        assert_eq!(
            sprite.params.iter().map(params).collect::<Vec<_>>(),
            [own("x", "1"), own("y", ""), own("", "4")]
        );
        let game = sound(&format!("{SMALL}  InteractionSet\n    a b c=d > x > k=v y\n"));
        let line = &game.interactions[0];
        assert_eq!((line.second.len(), line.effect.text.as_str(), line.params.len()), (2, "y", 1));
    }

    #[test]
    fn faulty_lines_are_dropped_with_a_message() {
        let game = sound(&SMALL.replace("b > Bomber", "b > Bomber speed="));
        assert_eq!((game.messages, game.sprites[0].children.len()), (1, 0));
        // The children of a dropped line belong to the line before it.
        let game = sound("BasicGame\n SpriteSet\n  a >\n  b = >\n   c >\n");
        assert_eq!(
            (game.messages, names(&game.sprites), names(&game.sprites[0].children)),
            (1, vec!["a"], vec!["c"])
        );
        for line in ["a b killSprite", "a b >", "a b > x=1", "a b > killSprite x="] {
            let game = sound(&format!("{SMALL}  InteractionSet\n    {line}\n    a b > killSprite\n"));
            assert_eq!((game.messages, game.interactions.len()), (1, 1), "{line}");
        }
        let game = sound(&format!("{SMALL}  TerminationSet\n    Timeout limit=\n    > Timeout limit=5\n"));
        assert_eq!((game.messages, game.terminations[0].class.text.as_str()), (1, ">"));
    }

    #[test]
    fn indentation_makes_a_tree() {
        // A line without an arrow ends the list of its siblings, but not the list of its parent's siblings.
        let game = sound("BasicGame\n SpriteSet\n  a >\n   b\n   c >\n  d >\n");
        assert_eq!((names(&game.sprites), game.sprites[0].children.len()), (vec!["a", "d"], 0));
        // Siblings with a different indent cause a message. More deeply indented lines of other sections are
        // dropped, including their names.
        let set = "  InteractionSet\n     a b > killSprite\n    a b > killBoth\n     a b > stepBack\n";
        let game = sound(&format!("{SMALL}{set}"));
        assert_eq!((game.messages, game.interactions.len()), (1, 2));
        assert_eq!(game.interactions[1].effect.text, "killBoth");
        // A tab is one column. The sprite is therefore at the same depth as its section, and the next section
        // is below the sprite.
        let game = sound("BasicGame\n    SpriteSet\n\ta >\n    LevelMapping\n");
        assert_eq!((game.messages, game.sprites.len(), game.order.len()), (1, 0, 1));
        // Lines that are not below the first line are dropped.
        let game = sound("  BasicGame\n     SpriteSet\n       a >\n  LevelMapping\n     TerminationSet\n");
        assert_eq!((game.messages, game.order.len()), (1, 2));
    }

    #[test]
    fn sections_have_one_spelling_and_may_come_again() {
        let set = "  InteractionSet\n    a b > killSprite\n";
        let game = sound(&format!("{SMALL}{set}  TerminationSet\n{set}  levelmapping\n    x > a\n"));
        let order = [
            (Section::SpriteSet, 2),
            (Section::InteractionSet, 1),
            (Section::TerminationSet, 0),
            (Section::InteractionSet, 1),
        ];
        assert_eq!((game.order.as_slice(), game.mapping.len()), (order.as_slice(), 0));
        let game = sound(&format!("{SMALL}  LevelMapping\n    xy b a\n    z b\n    =\n"));
        let mapped: Vec<_> = game.mapping.iter().map(|line| (line.symbol, line.names.len())).collect();
        assert_eq!(mapped, [('x', 1), ('z', 0), ('=', 0)]);
    }

    #[test]
    fn crashes_of_the_reference() {
        dies("", "empty-game");
        dies("##\nBasicGame\n", "bare-comment");
        sound(&format!("# ok\n #\n{SMALL}"));
        dies("BasicGame square_size = 10\n  SpriteSet\n", "unknown-game-class");
        dies("SpriteSet\n  a >\n", "unknown-game-class");
        dies("BasicGame\n  LevelMapping\n", "missing-section");
        dies("BasicGame\n  spriteset\n    a >\n", "missing-section");
        dies("BasicGame\n  speed=3\n  SpriteSet\n", "stray-line");
        dies(&format!("{SMALL}  InteractionSet\n  a b > killSprite\n"), "stray-line");
        dies(&format!("{SMALL}  ParameterSet\n"), "stray-line");
        dies(&format!("{SMALL}  SpriteSet\n"), "unsupported");
        dies("BasicGame\n  SpriteSet\n    a >\n    LevelMapping\n", "unsupported");
    }
}
