//! The `well-formed` criterion: checks that the game works at all.

use crate::allowance::Setting;
use crate::case::Case;
use crate::evidence::{Evidence, Line};
use crate::explain::ending::Ending;
use crate::validator::Validator;
use crate::verdict::{Finding, Verdict};
use base::Seed;
use engine::{Action, Diagnostic, Episode, Game, Level, Limit, Outcome, SpriteClass};

/// Passes if the game can be won in principle, is not over in its first tick, and does not stop the engine.
///
/// The types `Game` and `Level` already guarantee valid VGDL and a level that fits the game.
#[derive(Clone, Copy, Debug, Default)]
pub struct WellFormed;

pub(crate) const QUESTION: &str =
    "can the rules be won at all, and does the game go on after its first tick?";

pub(crate) fn judge(_: &Setting<'_>) -> WellFormed {
    WellFormed
}

impl Validator for WellFormed {
    fn validate(&self, case: Case<'_>) -> Finding {
        let Case { game, level, analysis, seed, .. } = case;
        if !analysis.can_win() {
            // If several rules seem to have swapped sides, report only the one that prevents every win.
            let told = game.warnings().iter().find(|warning| {
                warning.code == "no-win"
                    || warning.code == "swapped-rule" && warning.message.contains("cannot be won")
            });
            let swapped = told.and_then(|warning| swapped(game, warning));
            let reason = match (&swapped, told) {
                (Some(rule), _) => format!(
                    "the game cannot be won with `{}` as it stands, but may be winnable with the two sides swapped",
                    rule.text
                ),
                (None, Some(warning)) => warning.message.clone(),
                (None, None) => "the game cannot be won".to_owned(),
            };
            let help = told.and_then(|warning| warning.help.clone());
            let wins = analysis.goals().iter().filter(|goal| goal.win);
            let seen = wins.map(|goal| Evidence {
                text: "this can never hold".to_owned(),
                rule: Some(Line::termination(game, goal.line)),
                advice: help.clone(),
                ..Evidence::default()
            });
            let swapped = swapped
                .map(|rule| Evidence::new("this rule acts on the sprite that is named first").of_rule(rule));
            return Finding::from(Verdict::fail(reason)).seen(swapped.into_iter().chain(seen));
        }
        let (mut episode, mut state) = Episode::begin(game, level, seed);
        let reason = match episode.play(game, &mut state, Action::Nil) {
            Outcome::Ongoing => return Verdict::pass().into(),
            Outcome::Won => "the game is won in its first tick: a termination holds at the start".to_owned(),
            Outcome::Lost => "the game is lost in its first tick".to_owned(),
            Outcome::Ended => "the game ends in its first tick, without a winner".to_owned(),
            Outcome::Stopped(limit) => format!("the game stops in its first tick: {limit}"),
        };
        if episode.outcome == Outcome::Stopped(Limit::NoPaths) {
            let seen = Evidence { rule: path_finder(game), ..Evidence::new("this type searches for a path") };
            let seen = seen.advise("list the obstacles of paths in the first line: `BasicGame obs=wall`");
            return Finding::from(Verdict::fail_with(reason, episode)).seen([seen]);
        }
        let seen = Ending::of(analysis, level, &episode).evidence(game);
        Finding::from(Verdict::fail_with(reason, episode)).seen(seen)
    }
}

/// Returns the interaction to which a warning about swapped sides refers; `None` if it refers to none.
fn swapped(game: &Game, warning: &Diagnostic) -> Option<Line> {
    let mut lines = game.description().interactions.iter();
    let line = lines.position(|line| line.first.span.start == warning.span.start)?;
    (warning.code == "swapped-rule").then(|| Line::interaction(game, line))
}

/// Returns the line of the first sprite that uses path finding; `None` if no sprite does.
fn path_finder(game: &Game) -> Option<Line> {
    let seeks = |class: SpriteClass| {
        [SpriteClass::PathChaser, SpriteClass::PathAltChaser].iter().any(|&seeker| class.is_a(seeker))
    };
    let lines = game.description().sprite_lines();
    let mut names = lines.iter().map(|(_, line)| line.name.text.as_str());
    let name =
        names.find(|name| game.sprite_type(name).and_then(|stype| game.class(stype)).is_some_and(seeks))?;
    Line::sprite(game, name)
}

/// The number of seeds with which a game must end in its first tick in order to count as over at once.
const STARTS: u64 = 8;

/// Returns `true` if, with several seeds, every first action ends the game in its first tick. Such a level is
/// unplayable.
pub(crate) fn is_over_at_once(game: &Game, level: &Level, seed: Seed) -> bool {
    (0..STARTS).map(|start| seed.child("start", start)).all(|seed| {
        let (_, state) = Episode::begin(game, level, seed);
        game.actions(&state).iter().chain([&Action::Nil]).all(|&action| {
            let (mut episode, mut state) = Episode::begin(game, level, seed);
            episode.play(game, &mut state, action) != Outcome::Ongoing
        })
    })
}
