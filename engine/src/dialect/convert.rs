//! Converts games from py-vgdl and EMPA. Constructs with an exact equivalent are rewritten, and all others
//! are reported with their lines.

use super::python_file;
use crate::compile;
use crate::diagnostic::{Diagnostic, Diagnostics, Severity, Span, line_and_column};
use crate::rules::constants::{Constant, constant};
use crate::syntax::{self, Description, InteractionLine, Param, SpriteLine};

/// The width of a tab stop in py-vgdl, in columns.
const TAB: usize = 8;

/// A rewritten construct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// The line in the file, from 1.
    pub line: usize,
    /// The construct in the other dialect.
    pub from: String,
    /// The equivalent in VGDL, or the reason for omitting the construct.
    pub to: String,
}

/// A converted game.
#[derive(Clone, Debug)]
pub struct Conversion {
    /// The game in VGDL, in canonical form.
    pub text: String,
    /// The text that contains the spans of [`problems`](Self::problems), with the same line numbers as the
    /// file.
    pub source: String,
    /// The levels in the file.
    pub levels: Vec<String>,
    /// The rewritten constructs, by line.
    pub changes: Vec<Change>,
    /// The constructs without an exact equivalent, sorted by position.
    pub problems: Vec<Diagnostic>,
}

/// Converts a game from py-vgdl or EMPA. The file contains either the game's text or Python code, whose first
/// game is converted.
pub fn convert(file: &str) -> Conversion {
    let mut changes = Vec::new();
    let python = python_file(file);
    let (source, levels) = match &python {
        Some(python) => (python.game.as_str(), python.levels.clone()),
        None => (file, Vec::new()),
    };
    if let Some(python) = &python {
        let to = format!("the game in the string, and {} of its levels", levels.len());
        changes.push(Change { line: python.line, from: "a Python string".to_owned(), to });
    }
    let source = without_tabs(source, &mut changes);
    let (mut description, Diagnostics(mut problems)) = syntax::parse_all(&source);
    let line = |span: Span| line_and_column(&source, span.start).0;
    // Printing the description sorts the sections and indents all lines consistently.
    for moved in problems.iter().filter(|problem| problem.code == "section-order") {
        let (from, to) = (moved.message.clone(), "the SpriteSet comes first".to_owned());
        changes.push(Change { line: line(moved.span), from, to });
    }
    problems.retain(|problem| problem.code != "section-order" && problem.severity == Severity::Error);
    let mut noted = Changes { line: &line, list: &mut changes };
    header(&mut description, &mut noted);
    description.sprites.iter_mut().for_each(|sprite| sprite_line(sprite, &mut noted));
    scores(&mut description, &mut noted);
    effects(&mut description, &mut noted);
    terminations(&mut description, &mut noted);
    let left = compile::compile(&description).err().map_or(Vec::new(), |problems| problems.0);
    let left = left
        .into_iter()
        .filter(|problem| problem.severity == Severity::Error || problem.code == "ignored-class");
    problems.extend(left);
    for &other in python.iter().flat_map(|python| &python.others) {
        let at = source.len();
        let message =
            format!("the game that starts in line {other} is not converted, because only the first game is");
        problems.push(Diagnostic::error("other-dialect", Span::new(at, at), message));
    }
    changes.sort_by_key(|change| change.line);
    let problems = Diagnostics::sorted(problems).shortened(source.len()).0;
    Conversion { text: syntax::print(&description), source, levels, changes, problems }
}

/// The changes so far, with a function that converts spans to lines.
struct Changes<'a> {
    line: &'a dyn Fn(Span) -> usize,
    list: &'a mut Vec<Change>,
}

impl Changes<'_> {
    fn note(&mut self, span: Span, from: impl Into<String>, to: impl Into<String>) {
        self.list.push(Change { line: (self.line)(span), from: from.into(), to: to.into() });
    }

    /// Records that a parameter is omitted.
    fn without(&mut self, param: &Param, why: &str) {
        self.note(param.key.span, written(param), format!("left out: {why}"));
    }

    fn rename(&mut self, param: &mut Param, key: &str) {
        let from = written(param);
        param.key.text = key.to_owned();
        self.note(param.key.span, from, written(param));
    }
}

fn written(param: &Param) -> String {
    format!("{}={}", param.key.text, param.value.text)
}

/// Returns the text with its indentation converted from tabs to spaces.
fn without_tabs(source: &str, changes: &mut Vec<Change>) -> String {
    let mut text = String::with_capacity(source.len());
    let mut first = None;
    for (at, line) in source.split_inclusive('\n').enumerate() {
        let body = line.trim_start_matches([' ', '\t']);
        let indent = &line[..line.len() - body.len()];
        let columns = indent.chars().fold(0, |columns: usize, c| match c {
            '\t' => (columns / TAB + 1) * TAB,
            _ => columns + 1,
        });
        if indent.contains('\t') && !body.trim().is_empty() {
            first = first.or(Some(at + 1));
        }
        text.push_str(&" ".repeat(columns));
        text.push_str(body);
    }
    if let Some(line) = first {
        changes.push(Change {
            line,
            from: "tabs".to_owned(),
            to: format!("spaces up to the next multiple of {TAB} columns"),
        });
    }
    text
}

fn header(description: &mut Description, changes: &mut Changes<'_>) {
    description.header.params.retain_mut(|param| match param.key.text.as_str() {
        "block_size" => {
            changes.rename(param, "square_size");
            true
        }
        "frame_rate" | "title" | "name" | "MAX_SPRITES" | "seed" => {
            changes.without(param, "the parameter is not part of the rules");
            false
        }
        _ => true,
    });
}

fn sprite_line(sprite: &mut SpriteLine, changes: &mut Changes<'_>) {
    if let Some(class) = sprite.class.as_mut().filter(|class| class.text == "WalkJumper") {
        class.text = "WalkerJumper".to_owned();
        changes.note(class.span, "WalkJumper", "WalkerJumper");
    }
    sprite.params.retain_mut(|param| {
        let physics = match param.value.text.as_str() {
            "GridPhysics" => Some("GRID"),
            "ContinuousPhysics" => Some("CONT"),
            _ => None,
        };
        match (param.key.text.as_str(), physics) {
            ("physicstype", Some(physics)) => {
                let from = written(param);
                param.value.text = physics.to_owned();
                changes.note(param.key.span, from, written(param));
                true
            }
            ("color", _) if !matches!(constant(&param.value.text), Some(Constant::Color(_))) => {
                changes.without(param, "this colour has no name in VGDL, and affects only images");
                false
            }
            ("alternate_keys", _) => {
                changes.without(param, "the parameter is not part of the rules");
                false
            }
            _ => true,
        }
    });
    sprite.children.iter_mut().for_each(|child| sprite_line(child, changes));
}

/// Effects that run in every collision of their two sprites, so points can be attached to them.
const ALWAYS: [&str; 11] = [
    "killSprite",
    "killBoth",
    "stepBack",
    "undoAll",
    "bounceForward",
    "reverseDirection",
    "turnAround",
    "transformTo",
    "teleportToExit",
    "cloneSprite",
    "flipDirection",
];

/// Turns the points of `changeScore` into a parameter on a different rule for the same sprites.
fn scores(description: &mut Description, changes: &mut Changes<'_>) {
    let names = |line: &InteractionLine| {
        let second = line.second.iter().map(|word| word.text.clone());
        (line.first.text.clone(), second.collect::<Vec<_>>())
    };
    let mut at = 0;
    while at < description.interactions.len() {
        let line = &description.interactions[at];
        let value = match &line.params[..] {
            [param] if ["value", "scoreChange"].contains(&param.key.text.as_str()) => {
                Some(param.value.clone())
            }
            _ => None,
        };
        let value =
            value.filter(|value| line.effect.text == "changeScore" && value.text.parse::<i32>().is_ok());
        let (pair, effect) = (names(line), line.effect.clone());
        let takes = |other: &&mut InteractionLine| {
            let scores = other.params.iter().any(|param| param.key.text == "scoreChange");
            ALWAYS.contains(&other.effect.text.as_str()) && !scores && names(other) == pair
        };
        let Some(value) = value else {
            at += 1;
            continue;
        };
        let Some(other) = description.interactions.iter_mut().find(takes) else {
            at += 1;
            continue;
        };
        let points = format!("scoreChange={}", value.text);
        let to = format!("{points} on `{} {} > {}`", pair.0, pair.1.join(" "), other.effect.text);
        changes.note(effect.span, format!("changeScore value={}", value.text), to);
        other.params.push(Param { key: "scoreChange".into(), value });
        description.interactions.remove(at);
    }
}

fn effects(description: &mut Description, changes: &mut Changes<'_>) {
    description.interactions.retain_mut(|line| {
        if line.effect.text == "nothing" && line.params.is_empty() {
            changes.note(
                line.effect.span,
                "nothing",
                "no line: two sprites without a rule for each other do nothing",
            );
            return false;
        }
        let effect = line.effect.text.as_str();
        line.params.retain_mut(|param| match param.key.text.as_str() {
            "limitspeed" if ["killIfSlow", "killIfFast"].contains(&effect) => {
                changes.rename(param, "limspeed");
                true
            }
            "friction" if param.value.text.parse::<f64>() == Ok(0.0) => {
                changes.without(param, "effects have no friction");
                false
            }
            _ => true,
        });
        true
    });
}

fn terminations(description: &mut Description, changes: &mut Changes<'_>) {
    for line in &mut description.terminations {
        line.params.retain(|param| {
            let none = param.key.text == "bonus" && param.value.text.parse::<f64>() == Ok(0.0);
            if none {
                changes.without(param, "terminations give no points");
            }
            !none
        });
    }
}
