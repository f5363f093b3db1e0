//! The `rule-use` criterion: checks that every rule and every sprite type is used.

use crate::allowance::Setting;
use crate::evidence::{Evidence, Line};
use crate::measures::is_guard;
use crate::recording::{Recorded, Usage};
use crate::recording::{record, recorded};
use crate::report::Report;
use crate::validator::{GameCase, GameValidator};
use crate::verdict::{Finding, Verdict};
use base::Seed;
use engine::analysis::{Analysis, Reach};
use engine::{Game, Level, SpriteType};

/// Passes if recorded episodes of the game execute every interaction and contain a sprite of every type.
///
/// It is a failure if a rule or type never occurred and provably cannot occur on any of the levels. If it
/// might occur, the verdict is unknown. Rules on the screen edge are reported but never fail, because walls
/// can make these guards idle.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RuleUse;

/// The name of the screen edge in interactions.
const EDGE: &str = "EOS";

pub(crate) const QUESTION: &str =
    "does every rule run, and does every type appear, in at least one recorded episode?";

pub(crate) fn judge(_: &Setting<'_>) -> RuleUse {
    RuleUse
}

impl GameValidator for RuleUse {
    fn asks_for_usage(&self) -> bool {
        true
    }

    fn validate(&self, case: GameCase<'_>) -> Finding {
        let GameCase { game, analysis, recording, usage, .. } = case;
        let reaches: Vec<Reach> = recording.iter().map(|recorded| analysis.reach(recorded.level)).collect();
        let (mut dead, mut unseen, mut guards) = (Vec::new(), Vec::new(), Vec::new());
        for stype in unused_types(game, usage) {
            let name = game.name(stype);
            let text = format!("`{name}` never appears");
            let never = reaches.iter().all(|reach| reach.touched(stype).next().is_none());
            let rule = Line::sprite(game, name);
            let advice = format!("place `{name}` in a level, or remove the type and its rules");
            let seen = Evidence { text, rule, ..Evidence::default() }.advise(advice);
            if never { &mut dead } else { &mut unseen }.push(seen);
        }
        for line in (0..usage.lines.len()).filter(|&line| usage.lines[line].is_empty()) {
            let rule = Line::interaction(game, line);
            let written = &game.description().interactions[line];
            if written.second.iter().any(|word| word.text == EDGE) || written.first.text == EDGE {
                let text =
                    format!("`{}` never runs; the rule may only guard the edge of the board", rule.text);
                guards.push(Evidence::new(text).of_rule(rule));
                continue;
            }
            let (text, advice, list) = match meets(analysis, recording, &reaches, line) {
                false => (
                    format!("`{}` never runs: its sprites can never meet", rule.text),
                    "remove the rule, or add a level that needs it",
                    &mut dead,
                ),
                true => (
                    format!("`{}` was not seen to run", rule.text),
                    "play the game by hand; if the rule cannot run, remove it, or add a level that needs it",
                    &mut unseen,
                ),
            };
            list.push(Evidence::new(text).of_rule(rule).advise(advice));
        }
        let verdict = match (dead.first(), unseen.is_empty()) {
            (Some(first), _) => Verdict::fail(with_count(&first.text, dead.len() - 1)),
            (None, false) => Verdict::Unknown { spent: usage.ticks },
            (None, true) => Verdict::pass(),
        };
        let shown = Evidence::new(format!(
            "{} episodes of {} ticks in total were examined",
            usage.episodes, usage.ticks
        ));
        Finding::from(verdict).seen(dead).seen(unseen).seen(guards).seen([shown])
    }
}

/// The rules and types that occur in a game's recorded episodes, as counted by [`RuleUse`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RulesShown {
    /// The interactions executed in at least one episode, as indices into
    /// [`Description::interactions`](engine::Description), without interactions with the screen edge.
    pub executed: Vec<usize>,
    /// The interactions that no episode executed, without interactions with the screen edge.
    pub idle: Vec<usize>,
    /// The types that are declared, can have sprites of their own, and occurred on the board or as a resource.
    pub present: Vec<SpriteType>,
    /// The types that never occurred.
    pub absent: Vec<SpriteType>,
}

impl RulesShown {
    /// Counts the rules and types in the episodes recorded by the levels' validators, and in the panel's random walks
    /// in search of missing rules. The same arguments give the same result on any number of threads. Costs two replays
    /// of the episodes, with at most 100,000 ticks per level each, and up to 400 walks of 40 random actions per level.
    pub fn of(game: &Game, levels: &[Level], reports: &[Report], seed: Seed) -> RulesShown {
        let episodes = record(game, levels, reports, seed, u64::MAX);
        let usage = Usage::of(game, &recorded(levels, &episodes));
        let inner = (0..usage.lines.len()).filter(|&line| !is_guard(game, line));
        let (idle, executed) = inner.partition(|&line| usage.lines[line].is_empty());
        let (present, absent) = own_types(game).into_iter().partition(|stype| usage.types[stype.index()]);
        RulesShown { executed, idle, present, absent }
    }
}

/// Returns a reason, followed by the number of further reasons.
pub(crate) fn with_count(first: &str, others: usize) -> String {
    match others {
        0 => first.to_owned(),
        _ => format!("{first}, and {others} more"),
    }
}

/// Returns the declared types that can have sprites but never had one.
fn unused_types(game: &Game, usage: &Usage) -> Vec<SpriteType> {
    own_types(game).into_iter().filter(|stype| !usage.types[stype.index()]).collect()
}

/// Returns the declared types that can have sprites.
fn own_types(game: &Game) -> Vec<SpriteType> {
    let lines = game.description().sprite_lines();
    let declared =
        |name: &str| lines.iter().any(|(_, line)| line.name.text == name && line.children.is_empty());
    game.sprite_types().filter(|&stype| game.class(stype).is_some() && declared(game.name(stype))).collect()
}

/// Returns `true` unless the two sides of an interaction are proven never to meet in any level.
fn meets(analysis: &Analysis, recording: &[Recorded<'_>], reaches: &[Reach], line: usize) -> bool {
    let game = analysis.game();
    let of_line: Vec<_> = analysis.encounters().iter().filter(|encounter| encounter.line == line).collect();
    // Timed lines are not encounters.
    if of_line.is_empty() {
        return true;
    }
    let family = |written: SpriteType| game.sprite_types().filter(move |&s| analysis.applies(written, s));
    recording.iter().zip(reaches).any(|(recorded, reach)| {
        let cells = recorded.level.cells().len();
        let covered = |written: SpriteType| -> Vec<bool> {
            let mut cover = vec![false; cells];
            family(written).flat_map(|stype| reach.touched(stype)).for_each(|cell| cover[cell] = true);
            cover
        };
        of_line.iter().any(|encounter| {
            let Some(second) = encounter.second else { return true };
            let (first, second) = (covered(encounter.first), covered(second));
            first.iter().zip(&second).any(|(&first, &second)| first && second)
        })
    })
}
