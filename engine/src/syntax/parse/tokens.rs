//! Splits a line into tokens, and recognises faulty parameters.

use super::layout::Line;
use super::reader::Reader;
use crate::diagnostic::{Diagnostic, Span};
use crate::keywords::{CLASSES, EFFECTS, TERMINATIONS};
use crate::syntax::description::{Param, Word};
use crate::syntax::grammar::{Grammar, Rule};
use pest::Parser;
use pest::iterators::{Pair, Pairs};
use std::iter::Peekable;

/// A token on a line in any section except the LevelMapping.
pub(crate) enum Token {
    Word(Word),
    Arrow(Span),
    Param(Param),
}

impl Reader {
    pub(crate) fn tokens(&mut self, line: &Line<'_>) -> Vec<Token> {
        let mut pairs = Grammar::parse(Rule::tokens, line.text).expect("anything but blanks is a token");
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

    /// Reports a word with an `=` that is not `key=value`: the `=` may have spaces around it, the key or
    /// value may be missing, or there may be several `=`. Reads the intended parameter, so that the mistake
    /// yields only one problem.
    fn broken_param<'a>(
        &mut self,
        line: &Line<'_>,
        whole: Word,
        tokens: &mut Vec<Token>,
        rest: &mut Peekable<Pairs<'a, Rule>>,
    ) {
        let next = rest.peek().filter(|next| next.as_rule() == Rule::word).map(|next| word(line, next));
        let known = |word: &Word| CLASSES.contains(&&*word.text) || EFFECTS.contains(&&*word.text);
        let has_arrow = line.text.split([' ', '\t']).any(|word| word == ">");
        // For example, `gold = color=RED` on a line that needs an arrow.
        let names_sprite = |word: &Word| word.text != "BasicGame" && !TERMINATIONS.contains(&&*word.text);
        let after_name = || matches!(&tokens[..], [Token::Word(first)] if names_sprite(first));
        let like_arrow = || next.as_ref().map_or_else(after_name, known);
        if whole.text == "=>" || whole.text == "=" && !has_arrow && like_arrow() {
            // The `=` was meant as the arrow, and the missing arrow is reported elsewhere.
            return;
        }
        let (key, value) = whole.text.split_once('=').expect("the text contains `=`");
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
                Some("") => problem
                    .help("remove the word, or write a parameter as one word")
                    .remove(whole.span, &whole.text),
                Some(key) => problem.help(format!("write a value after `{key}=`, without a space")),
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
        let problem = problem.help(format!("write `{}={}`", key.text, value.text));
        self.problems.push(problem.replace(span, &format!("{}={}", key.text, value.text)));
        tokens.push(Token::Param(Param { key, value }));
    }
}

pub(crate) fn span(line: &Line<'_>, pair: &Pair<'_, Rule>) -> Span {
    let inner = pair.as_span();
    Span::new(line.span.start + inner.start(), line.span.start + inner.end())
}

pub(crate) fn word(line: &Line<'_>, pair: &Pair<'_, Rule>) -> Word {
    Word { text: pair.as_str().to_owned(), span: span(line, pair) }
}
