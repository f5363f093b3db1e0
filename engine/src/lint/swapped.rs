//! Rules whose two sides are swapped.

use crate::analysis::{Analysis, EffectSummary, Side};
use crate::diagnostic::{Diagnostic, Span};
use crate::game::Game;
use crate::rules::SpriteType;
use crate::rules::class::SpriteClass;
use crate::syntax::{Description, InteractionLine};
use std::fmt::Write;

/// An interaction whose two sides are most likely swapped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SwappedRule {
    /// The index of the interaction's line in [`Description::interactions`].
    pub line: usize,
    /// The span of the line's sprites and effect.
    pub span: Span,
    /// The rule that was most likely intended, with one line per partner.
    pub repaired: Vec<String>,
}

/// The maximum number of interactions in a game that is searched for a swapped rule. Each interaction
/// requires two analyses.
const MAX_LINES: usize = 128;
/// The maximum product of the numbers of interactions and sprite types in a game that is searched for a
/// swapped rule.
const MAX_TRIED: usize = 1 << 13;

/// Returns the only interaction for which swapping the two sides makes the game winnable, but removing the
/// interaction does not. Returns `None` if there is no such interaction or more than one. `wins` returns
/// whether a game can be won. Skips unusually large games. Cost: two compilations and two calls to `wins` per
/// line.
pub fn swapped_rule(game: &Game, wins: impl Fn(&Game) -> bool) -> Option<SwappedRule> {
    let description = game.description();
    let lines = &description.interactions;
    if lines.len() > MAX_LINES || lines.len() * game.sprite_types().count() > MAX_TRIED {
        return None;
    }
    let with = |at: usize, instead: Vec<InteractionLine>| {
        let mut lines = lines.clone();
        lines.splice(at..=at, instead);
        let changed = Description { interactions: lines, ..description.clone() };
        Game::compile(&changed).is_ok_and(|game| wins(&game))
    };
    let analysis = Analysis::of(game);
    let any = |name: &str, is: &dyn Fn(SpriteType) -> bool| {
        let written = game.sprite_type(name);
        written.is_some_and(|written| game.0.types[written.index()].tree.iter().any(|&stype| is(stype)))
    };
    let counts = |name: &str, of_wins: bool| {
        let mut goals = analysis.goals().iter().filter(|goal| goal.win || !of_wins);
        goals.any(|goal| any(name, &|stype| goal.condition.types().contains(&stype)))
    };
    let plays = |name: &str| any(name, &|stype| game.class(stype).is_some_and(SpriteClass::is_avatar));
    // A rule whose first sprite is counted by a termination is written as intended. A rule between two
    // unrelated sprites was probably not meant to win the game.
    let suspect = |line: &InteractionLine| {
        let first = line.first.text.as_str();
        let partner = line.second.iter().any(|word| plays(&word.text) || counts(&word.text, true));
        !counts(first, true) && (plays(first) || partner && !counts(first, false))
    };
    // If the game can be won without the line, the line is merely an obstacle, not a swapped rule.
    let repairs =
        |at: &usize| swapped(&lines[*at]).is_some_and(|swapped| with(*at, swapped)) && !with(*at, Vec::new());
    let mut found = (0..lines.len()).filter(|&at| suspect(&lines[at])).filter(repairs);
    let (line, None) = (found.next()?, found.next()) else { return None };
    let written = &lines[line];
    let span = Span::new(written.first.span.start, written.effect.span.end);
    let repaired = swapped(written)?.iter().map(in_words).collect();
    Some(SwappedRule { line, span, repaired })
}

/// Returns the only rule that meets two conditions: it removes a sprite that no termination counts, and it
/// would let the player lose if its two sides were swapped. The second string is the swapped rule. Returns
/// `None` if there is no such rule or more than one. Cost: one compilation and one analysis per candidate
/// rule.
pub(super) fn swapped_threat(game: &Game) -> Option<(String, String)> {
    let description = game.description();
    let lines = &description.interactions;
    if lines.len() > MAX_LINES || lines.len() * game.sprite_types().count() > MAX_TRIED {
        return None;
    }
    let analysis = Analysis::of(game);
    let tree = |stype: SpriteType| game.0.types[stype.index()].tree.iter();
    let counts = |stype: SpriteType| {
        let mut counted = analysis.goals().iter().flat_map(|goal| goal.condition.types());
        counted.any(|counted| tree(stype).any(|own| own == counted))
    };
    // A rule that gives points is meant to collect its sprite.
    let gives = |line: &InteractionLine| {
        let points = line.params.iter().filter(|param| param.key.text == "scoreChange");
        points.into_iter().any(|param| !param.value.text.starts_with('-') && param.value.text != "0")
    };
    let removes = |at: &usize| {
        let mut own = analysis.encounters().iter().filter(|encounter| encounter.line == *at);
        own.any(|encounter| {
            encounter.does(|effect| *effect == EffectSummary::Kill(Side::First)) && !counts(encounter.first)
        })
    };
    let loses = |changed: &Game| {
        let analysis = Analysis::of(changed);
        analysis.can_lose() && analysis.can_win()
    };
    let mut found = (0..lines.len()).filter(|at| !gives(&lines[*at])).filter(removes).filter_map(|at| {
        let [meant] = &swapped(&lines[at])?[..] else { return None };
        let mut changed = lines.clone();
        changed[at] = meant.clone();
        let game = Game::compile(&Description { interactions: changed, ..description.clone() }).ok()?;
        loses(&game).then(|| (in_words(&lines[at]), in_words(meant)))
    });
    found.next().filter(|_| found.next().is_none())
}

/// Returns the line with its sides swapped, as one line per partner. Returns `None` if a side is `EOS` or `TIME`, or if
/// both sides contain the same type.
fn swapped(line: &InteractionLine) -> Option<Vec<InteractionLine>> {
    let sides = || line.second.iter().chain([&line.first]);
    let is_sprite = |name: &str| !["EOS", "TIME"].contains(&name);
    let distinct = line.second.iter().all(|word| word.text != line.first.text);
    let swap = |second: &crate::syntax::Word| InteractionLine {
        first: second.clone(),
        second: vec![line.first.clone()],
        ..line.clone()
    };
    (distinct && sides().all(|word| is_sprite(&word.text))).then(|| line.second.iter().map(swap).collect())
}

fn in_words(line: &InteractionLine) -> String {
    let mut text = line.first.text.clone();
    for word in &line.second {
        let _ = write!(text, " {}", word.text);
    }
    let _ = write!(text, " > {}", line.effect.text);
    for param in &line.params {
        let _ = write!(text, " {}={}", param.key.text, param.value.text);
    }
    text
}

/// Returns the warning about a swapped rule that makes the game unwinnable, and the game with that rule repaired;
/// `None` if there is no such rule.
pub(super) fn swapped_rule_warning(game: &Game) -> Option<(Diagnostic, Game)> {
    let found = swapped_rule(game, |game| Analysis::of(game).can_win())?;
    let SwappedRule { line, span, repaired } = found;
    let message =
        "the game cannot be won with this rule as it stands, but may be winnable with its sides swapped";
    let meant: Vec<String> = repaired.iter().map(|line| format!("`{line}`")).collect();
    let help = format!("did you mean {}?", meant.join(" and "));
    let written = &game.description().interactions[line];
    let end = written.params.iter().map(|param| param.value.span.end).max().unwrap_or(span.end);
    let problem = Diagnostic::warning("swapped-rule", span, message)
        .label("acts on the sprite that is named first")
        .help(help);
    let problem = match &repaired[..] {
        [meant] => problem.replace(Span::new(span.start, end.max(span.end)), meant),
        _ => problem,
    };
    let mut description = game.description().clone();
    let lines = swapped(&description.interactions[line])?;
    description.interactions.splice(line..=line, lines);
    Some((problem, Game::compile(&description).ok()?))
}
