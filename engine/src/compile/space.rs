//! GameSpace: games whose named parameters stand for values of a ParameterSet (`spec/01` §1.11).

use super::Policy;
use super::interactions::COMMON;
use crate::diagnostic::{Diagnostic, Span};
use crate::syntax::{Description, Literal, Param, ParameterLine, SpriteLine, literal, print_bare};
use base::Sampler;
use base::{Digest, Seed};
use std::borrow::Cow;

const KEYS: [&str; 3] = ["values", "value", "string"];

/// Returns the game with the parameter values filled in. In strict mode, each parameter must specify its
/// value with `value=`. The reference draws a missing value at random for each use, without a seed. This
/// engine draws the value with a seed derived from the game's text.
pub(super) fn settled<'a>(
    description: &'a Description,
    policy: Policy,
    problems: &mut Vec<Diagnostic>,
) -> Cow<'a, Description> {
    if description.header.class.text != "GameSpace" {
        return Cow::Borrowed(description);
    }
    let mut space = Space::default();
    for line in &description.parameters {
        let values = space.read(line, policy, problems);
        // If several lines define this name, the last one counts.
        space.parameters.retain(|(name, ..)| *name != line.name.text);
        space.parameters.push((&line.name.text, line.name.span, values));
    }
    space.sampler =
        Some(Seed::from_text(&Digest::of(print_bare(description).as_bytes()).to_string()).sampler());
    let mut game = description.clone();
    space.sprites(&mut game.sprites);
    for line in &mut game.interactions {
        // addTimer passes on the parameters that it does not use to the scheduled effect, as written.
        let own = |key: &str| COMMON.contains(&key) || ["timer", "repeating", "nextExecution"].contains(&key);
        let timer = line.effect.text == "addTimer";
        space.put_in(line.params.iter_mut().filter(|param| !timer || own(&param.key.text)));
    }
    for line in &mut game.terminations {
        space.put_in(line.params.iter_mut());
    }
    for (name, span, _) in space.parameters.iter().filter(|(name, ..)| !space.used.contains(name)) {
        let message = format!("`{name}` is never used as a value");
        let problem = Diagnostic::warning("unused-parameter", *span, message);
        problems.push(problem.help("use the parameter as a value, or remove it"));
    }
    Cow::Owned(game)
}

/// The possible values of a parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Values {
    /// A single value.
    Int(i32),
    Double(f64),
    Bool(bool),
    /// A range of `count` values, starting at `first`, in steps of `step`.
    Ints {
        first: i32,
        step: i32,
        count: i32,
    },
    Doubles {
        first: f64,
        step: f64,
        count: i32,
    },
    Bools {
        first: bool,
        count: i32,
    },
}

#[derive(Default)]
struct Space<'a> {
    parameters: Vec<(&'a str, Span, Values)>,
    used: Vec<&'a str>,
    sampler: Option<Sampler>,
}

impl<'a> Space<'a> {
    fn read(&mut self, line: &ParameterLine, policy: Policy, problems: &mut Vec<Diagnostic>) -> Values {
        let given = |key: &str| line.params.iter().rfind(|param| param.key.text == key);
        for param in line.params.iter().filter(|param| !KEYS.contains(&param.key.text.as_str())) {
            let message = format!("a parameter has no `{}`", param.key.text);
            let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
            problems.push(problem.suggest(&param.key.text, KEYS));
        }
        let range = given("values").and_then(|param| range(&param.value.text));
        let Some(range) = range else {
            let span = given("values").map_or(line.name.span, Param::span);
            let message = format!("`{}` needs `values=min:step:max`, or `values=True:False`", line.name.text);
            let problem = Diagnostic::error("bad-parameter-values", span, message);
            problems.push(
                problem.help("write three numbers with a step that leads from the first value to the last"),
            );
            return Values::Int(1);
        };
        // The reference fails only if it draws from an empty range. With `value=`, it does not draw.
        let is_drawn = policy == Policy::Strict || given("value").is_none();
        if range.count() <= 0 && is_drawn {
            let span = given("values").map_or(line.name.span, Param::span);
            let message = format!(
                "`{}` has no values: its step does not lead from the first value to the last",
                line.name.text
            );
            let problem = Diagnostic::error("bad-parameter-values", span, message);
            problems.push(problem.help("choose a step that leads from the first value to the last"));
            return Values::Int(1);
        }
        let Some(value) = given("value") else {
            if policy == Policy::Strict {
                let message =
                    format!("`{}` has no `value=`, so the game is not fully specified", line.name.text);
                let problem = Diagnostic::error("missing-parameter", line.name.span, message);
                problems.push(problem.help(format!("add `value={}`, or a different value", range.text(0))));
            }
            return range;
        };
        let text = value.value.text.as_str();
        let found = match range {
            Values::Ints { .. } => text.parse().ok().map(Values::Int),
            Values::Doubles { .. } => double(text).map(Values::Double),
            _ => boolean(text).map(Values::Bool),
        };
        found.unwrap_or_else(|| {
            let message = format!("`{text}` is not a value of this parameter");
            let problem = Diagnostic::error("bad-parameter-values", value.value.span, message);
            problems.push(problem.help(format!("write `value={}`, for example", range.text(0))));
            range
        })
    }

    fn sprites(&mut self, lines: &mut [SpriteLine]) {
        for line in lines {
            // The singleton flag is read from the text as written.
            self.put_in(line.params.iter_mut().filter(|param| param.key.text != "singleton"));
            self.sprites(&mut line.children);
        }
    }

    fn put_in<'b>(&mut self, params: impl Iterator<Item = &'b mut Param>) {
        for param in params {
            let entries = param.value.text.split(',').map(|entry| self.text_of(entry));
            let text = entries.collect::<Vec<String>>().join(",");
            param.value.text = text;
        }
    }

    fn text_of(&mut self, entry: &str) -> String {
        let Some(&(name, _, values)) = self.parameters.iter().find(|(name, ..)| *name == entry) else {
            return entry.to_owned();
        };
        self.used.push(name);
        let count = values.count();
        let drawn =
            self.sampler.as_mut().filter(|_| count > 1).map_or(0, |sampler| sampler.below(count as usize));
        values.text(drawn as i32)
    }
}

impl Values {
    fn count(self) -> i32 {
        match self {
            Values::Ints { count, .. } | Values::Doubles { count, .. } | Values::Bools { count, .. } => count,
            _ => 1,
        }
    }

    /// Returns the text of the value at an index, counted from 0.
    fn text(self, at: i32) -> String {
        match self {
            Values::Int(value) => value.to_string(),
            Values::Double(value) => format!("{value:?}"),
            Values::Bool(value) => value.to_string(),
            Values::Ints { first, step, .. } => first.wrapping_add(step.wrapping_mul(at)).to_string(),
            Values::Doubles { first, step, .. } => format!("{:?}", first + f64::from(at) * step),
            Values::Bools { first, .. } => (first ^ (at == 1)).to_string(),
        }
    }
}

/// Parses `min:step:max`: integers, decimals if any of them contains a point, or two booleans. The number of
/// values matches the reference: 1 for a zero step over a zero distance, and below 1 if the step does not
/// lead towards the last value.
fn range(text: &str) -> Option<Values> {
    let parts: Vec<&str> = text.split(':').collect();
    let range = match parts[..] {
        [first, last] => {
            let (first, last) = (boolean(first)?, boolean(last)?);
            Values::Bools { first, count: if first == last { 1 } else { 2 } }
        }
        [first, step, last] if text.contains('.') => {
            let (first, step, last) = (double(first)?, double(step)?, double(last)?);
            Values::Doubles { first, step, count: count((last - first) / step) }
        }
        [first, step, last] => {
            let (first, step, last): (i32, i32, i32) =
                (first.parse().ok()?, step.parse().ok()?, last.parse().ok()?);
            Values::Ints { first, step, count: count(f64::from(last.wrapping_sub(first)) / f64::from(step)) }
        }
        _ => return None,
    };
    Some(range)
}

/// Returns the number of values in a range with the given number of steps, as a 32-bit integer. The result is
/// positive only for NaN and for numbers in range.
fn count(steps: f64) -> i32 {
    (steps as i32).wrapping_add(1)
}

fn double(text: &str) -> Option<f64> {
    match literal(text) {
        Literal::Int(value) => Some(value.into()),
        Literal::Double(value) => Some(value),
        Literal::Bool(_) | Literal::Text => None,
    }
}

fn boolean(text: &str) -> Option<bool> {
    let is = |word: &str| text.eq_ignore_ascii_case(word);
    (is("true") || is("false")).then_some(is("true"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::parse;

    const GAME: &str = "GameSpace\n  ParameterSet\n    SPEED > values=0.1:0.3:1.0 value=0.4\n    LIMIT > values=2:3:9 value=5\n    WIN > values=True:False value=TRUE\n  SpriteSet\n    gold > Resource limit=LIMIT singleton=WIN\n    avatar > MovingAvatar speed=SPEED\n  LevelMapping\n    g > gold\n  InteractionSet\n    gold avatar > collectResource scoreChange=LIMIT,1\n    avatar wall > addTimer timer=LIMIT ftype=killAll stype=gold scoreChange=LIMIT\n  TerminationSet\n    SpriteCounter stype=gold win=WIN\n    Timeout limit=LIMIT win=False\n";

    fn settle(source: &str, policy: Policy) -> (Description, Vec<&'static str>) {
        let (description, problems) = parse(source);
        assert_eq!(problems, []);
        let mut problems = Vec::new();
        let game = settled(&description, policy, &mut problems).into_owned();
        (game, problems.iter().map(|problem| problem.code).collect())
    }

    fn values(params: &[Param]) -> Vec<&str> {
        params.iter().map(|param| param.value.text.as_str()).collect()
    }

    #[test]
    fn names_stand_for_values() {
        let (game, problems) = settle(GAME, Policy::Strict);
        assert_eq!(problems, [] as [&str; 0]);
        assert_eq!(values(&game.sprites[0].params), ["5", "WIN"], "singleton is read as written");
        assert_eq!(values(&game.sprites[1].params), ["0.4"]);
        assert_eq!(values(&game.interactions[0].params), ["5,1"]);
        assert_eq!(values(&game.interactions[1].params), ["5", "killAll", "gold", "5"]);
        assert_eq!(values(&game.terminations[0].params), ["gold", "true"]);
        let planned = GAME.replace("stype=gold scoreChange", "stype=LIMIT scoreChange");
        assert_eq!(values(&settle(&planned, Policy::Strict).0.interactions[1].params)[2], "LIMIT");
    }

    #[test]
    fn missing_values_are_drawn_or_required() {
        let source = GAME.replace("values=2:3:9 value=5", "values=2:3:9");
        assert_eq!(settle(&source, Policy::Strict).1, ["missing-parameter"]);
        let (game, problems) = settle(&source, Policy::Reference);
        assert_eq!(problems, [] as [&str; 0]);
        let drawn = &game.sprites[0].params[0].value.text;
        assert!(["2", "5", "8"].contains(&drawn.as_str()), "{drawn}");
        assert_eq!(settle(&source, Policy::Reference).0, game, "and always the same");
    }

    #[test]
    fn ranges() {
        assert_eq!(range("1:2:6"), Some(Values::Ints { first: 1, step: 2, count: 3 }));
        assert_eq!(range("0.5:0.25:1").map(Values::count), Some(3));
        assert_eq!(range("true:False"), Some(Values::Bools { first: true, count: 2 }));
        assert_eq!(range("5:-2:1").map(Values::count), Some(3));
        let codes = |values: &str, policy| {
            settle(&GAME.replace("values=2:3:9", &format!("values={values}")), policy).1
        };
        for bad in ["1", "1:2", "a:b:c", "1:2:3:4", "1.0:x:5", "1.0:inf:5", "1:0.5:x"] {
            for policy in [Policy::Strict, Policy::Reference] {
                assert_eq!(codes(bad, policy), ["bad-parameter-values"], "{bad}");
            }
        }
        // A zero step over a zero distance gives one value.
        for one in ["5:0:5", "5:1:5", "5:-1:5", "0:0:0"] {
            assert_eq!(range(one).map(Values::count), Some(1), "{one}");
            assert_eq!(codes(one, Policy::Strict), [] as [&str; 0], "{one}");
            let drawn = GAME.replace("values=2:3:9 value=5", &format!("values={one}"));
            assert_eq!(settle(&drawn, Policy::Reference).1, [] as [&str; 0], "{one}");
        }
        assert_eq!(range("0.5:0.0:0.5").map(Values::count), Some(1));
        assert_eq!(range("0.5:NaN:0.9").map(Values::count), Some(1));
        // A step that does not lead towards the last value gives no values, but the reference does not draw a
        // value if `value=` is given.
        for none in ["1:0:5", "5:1:1", "1:-1:5", "1.0:0:5.0", "0.5:0.0:1.0", "1.0:0.5:0.0"] {
            assert!(range(none).is_some_and(|range| range.count() <= 0), "{none}");
            let given = GAME.replace("values=0.1:0.3:1.0 value=0.4", &format!("values={none} value=1"));
            assert_eq!(settle(&given, Policy::Strict).1, ["bad-parameter-values"], "{none}");
            assert_eq!(settle(&given, Policy::Reference).1, [] as [&str; 0], "{none}");
            let drawn = given.replace(" value=1", "");
            assert_eq!(settle(&drawn, Policy::Reference).1, ["bad-parameter-values"], "{none}");
        }
    }

    #[test]
    fn mistakes() {
        let codes = |from: &str, to: &str| settle(&GAME.replace(from, to), Policy::Strict).1;
        assert_eq!(codes("value=5", "value=five"), ["bad-parameter-values"]);
        assert_eq!(codes("value=5", "value=5 vlaue=3"), ["unknown-parameter"]);
        assert_eq!(codes("speed=SPEED", "speed=1"), ["unused-parameter"]);
    }
}
