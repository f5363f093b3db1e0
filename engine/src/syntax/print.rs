//! Prints a syntax tree in canonical form, for `arcade fmt` and for digests.

use super::description::{Description, Param, Section, SpriteLine, Trivia};
use std::fmt::Write;

/// Returns the canonical text: sections in canonical order, four spaces per indent, and single spaces between
/// tokens. Comments are included.
pub fn print(description: &Description) -> String {
    Printer { out: String::new(), comments: true }.game(description)
}

/// Returns the canonical text without comments: the input for a game's digest.
pub fn print_bare(description: &Description) -> String {
    Printer { out: String::new(), comments: false }.game(description)
}

struct Printer {
    out: String,
    comments: bool,
}

impl Printer {
    fn game(mut self, game: &Description) -> String {
        self.line(0, &game.header.trivia, &with_params(&game.header.class.text, &game.header.params));
        let space = Section::ParameterSet;
        let has_space =
            !game.parameters.is_empty() || game.section_trivia[space as usize] != Trivia::default();
        for (section, has) in [(space, has_space)].into_iter().chain(Section::ALL.into_iter().zip(game.has)) {
            if !has {
                continue;
            }
            self.line(1, &game.section_trivia[section as usize], section.name());
            match section {
                Section::ParameterSet => {
                    for line in &game.parameters {
                        let head = format!("{} >", line.name.text);
                        self.line(2, &line.trivia, &with_params(&head, &line.params));
                    }
                }
                Section::SpriteSet => self.sprites(2, &game.sprites),
                Section::LevelMapping => {
                    for line in &game.mapping {
                        let names: Vec<&str> = line.names.iter().map(|name| name.text.as_str()).collect();
                        self.line(
                            2,
                            &line.trivia,
                            format!("{} > {}", line.symbol, names.join(" ")).trim_end(),
                        );
                    }
                }
                Section::InteractionSet => {
                    for line in &game.interactions {
                        let mut text = line.first.text.clone();
                        for second in &line.second {
                            let _ = write!(text, " {}", second.text);
                        }
                        let _ = write!(text, " > {}", line.effect.text);
                        self.line(2, &line.trivia, &with_params(&text, &line.params));
                    }
                }
                Section::TerminationSet => {
                    for line in &game.terminations {
                        self.line(2, &line.trivia, &with_params(&line.class.text, &line.params));
                    }
                }
            }
        }
        if self.comments {
            for comment in &game.tail {
                self.comment("", comment);
            }
        }
        self.out
    }

    fn sprites(&mut self, depth: usize, lines: &[SpriteLine]) {
        for line in lines {
            let class = line.class.as_ref().map_or(String::new(), |class| format!(" {}", class.text));
            self.line(
                depth,
                &line.trivia,
                &with_params(&format!("{} >{class}", line.name.text), &line.params),
            );
            self.sprites(depth + 1, &line.children);
        }
    }

    /// Prints a comment. The reference crashes on a line that starts in the first column and consists only of
    /// `#`.
    fn comment(&mut self, indent: &str, comment: &str) {
        let indent = if indent.is_empty() && comment.bytes().all(|byte| byte == b'#') { " " } else { indent };
        let _ = writeln!(self.out, "{}", format!("{indent}# {comment}").trim_end());
    }

    fn line(&mut self, depth: usize, trivia: &Trivia, text: &str) {
        let indent = "    ".repeat(depth);
        if self.comments {
            for comment in &trivia.above {
                self.comment(&indent, comment);
            }
        }
        let _ = match trivia.beside.as_ref().filter(|_| self.comments) {
            Some(comment) => writeln!(self.out, "{}", format!("{indent}{text}  # {comment}").trim_end()),
            None => writeln!(self.out, "{indent}{text}"),
        };
    }
}

fn with_params(head: &str, params: &[Param]) -> String {
    let mut text = head.to_owned();
    for param in params {
        let _ = write!(text, " {}={}", param.key.text, param.value.text);
    }
    text
}
