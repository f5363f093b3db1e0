//! Lints for terminations that end a game too early or never.

use super::{Linter, swapped};
use crate::analysis::{
    Analysis, Attainable, Condition as Counted, EffectSummary, Encounter, Goal, Precondition, Side,
};
use crate::diagnostic::{Diagnostic, Span};
use crate::game::Game;
use crate::level::Level;
use crate::limits::MAX_TICKS;
use crate::rules::class::SpriteClass;
use crate::rules::terminations::{Condition, Decision, Termination, can_be_held_up};
use crate::rules::{Action, Outcome, SpriteType};
use crate::syntax::{Param, TerminationLine};
use base::Seed;

/// The number of seeds for which a level's first tick is tested if the game is stochastic.
const SEEDS: u64 = 4;

/// Returns a warning about the termination that ends an episode of the level in its first tick; `None` if no
/// termination certainly does.
pub(crate) fn over_at_start(game: &Game, level: &Level) -> Option<Diagnostic> {
    let rules = &game.0;
    if can_be_held_up(rules) {
        return None;
    }
    let mut placed = vec![0_i64; rules.types.len()];
    for &stype in level.cells().iter().flat_map(|&symbol| game.places(symbol)) {
        placed[stype.index()] += 1;
    }
    let tree = |written: SpriteType| rules.types[written.index()].tree.iter().copied();
    let count = |written: SpriteType| tree(written).map(|stype| placed[stype.index()]).sum::<i64>();
    let holds = |end: &Termination| {
        let sum: i64 = end.counts().iter().map(|&stype| count(stype)).sum();
        match end.condition {
            Condition::SpriteCounter { limit, .. } => sum <= i64::from(limit),
            Condition::SpriteCounterMore { limit, .. } => sum >= i64::from(limit),
            Condition::MultiSpriteCounter { limit, min, .. } => {
                sum == i64::from(limit) || min && sum > i64::from(limit)
            }
            Condition::MultiSpriteCounterSubTypes { .. }
            | Condition::StopCounter { .. }
            | Condition::Timeout { .. } => false,
        }
    };
    let at = rules.terminations.iter().position(holds)?;
    let (end, line) = (&rules.terminations[at], &rules.description.terminations[at]);
    // Sprites may already appear or disappear in the first tick.
    let outcomes = first_outcomes(game, level);
    if outcomes.contains(&Outcome::Ongoing) {
        return None;
    }
    let analysis = Analysis::of(game);
    let certain = analysis.is_deterministic_in(level);
    let made = analysis.made_in(level);
    let never_made = || end.counts().iter().flat_map(|&stype| tree(stype)).all(|stype| !made[stype.index()]);
    let stays = match end.condition {
        Condition::SpriteCounter { .. } | Condition::MultiSpriteCounter { limit: 0, min: false, .. } => {
            never_made()
        }
        Condition::SpriteCounterMore { limit, .. } => limit <= 0,
        Condition::MultiSpriteCounter { .. }
        | Condition::MultiSpriteCounterSubTypes { .. }
        | Condition::StopCounter { .. }
        | Condition::Timeout { .. } => false,
    };
    // An earlier termination may end the episode first.
    let line_decides = |end: &Termination| end.decided_by == Decision::Line;
    let alike = |other: &Termination| line_decides(other) && other.win == end.win;
    let decided = line_decides(end) && (certain || rules.terminations[..at].iter().all(alike));
    let all = |outcome: Outcome| outcomes.iter().all(|&other| other == outcome);
    let outcome = match decided {
        true if end.win && all(Outcome::Won) => "won",
        true if !end.win && all(Outcome::Lost) => "lost",
        _ => "over",
    };
    let counts = end.counts().iter().map(|&stype| format!("{} `{}`", count(stype), game.name(stype)));
    let counts = counts.collect::<Vec<_>>().join(" and ");
    let class = &line.class.text;
    let message = match certain || stays {
        true => format!("the level is {outcome} in its first tick: with {counts}, a {class} holds"),
        false => format!(
            "the level is over in its first tick, unless this tick changes a count: with {counts}, a \
             {class} holds"
        ),
    };
    let problem = Diagnostic::warning("ends-at-once", Span::new(0, 0), message);
    let left = match end.condition {
        Condition::SpriteCounter { limit, .. } => {
            limit > 0 && end.counts().iter().any(|&stype| count(stype) > 0)
        }
        Condition::SpriteCounterMore { .. }
        | Condition::MultiSpriteCounter { .. }
        | Condition::MultiSpriteCounterSubTypes { .. }
        | Condition::StopCounter { .. }
        | Condition::Timeout { .. } => false,
    };
    Some(problem.help(match left {
        true => "a SpriteCounter holds while at most `limit=` sprites are left: with `limit=0`, it holds when all are gone",
        false => "place some of the counted sprites, or change the `limit=`",
    }))
}

/// Returns the outcomes of a level's first tick, with each action, and with several seeds if the game is
/// stochastic.
fn first_outcomes(game: &Game, level: &Level) -> Vec<Outcome> {
    let seeds = if game.is_deterministic() { 1 } else { SEEDS };
    let mut outcomes = Vec::new();
    for seed in 0..seeds {
        let start = game.start(level, Seed::from_text("first tick").child("seed", seed));
        for action in Action::ALL {
            outcomes.push(game.step(&mut start.clone(), action));
        }
    }
    outcomes
}

/// Returns the span of a termination's `limit`, or of its class if the termination has no limit.
fn limit_of(line: &TerminationLine) -> Span {
    let limit = line.params.iter().rfind(|param| param.key.text == "limit");
    limit.map_or(line.class.span, Param::span)
}

/// Returns `true` if a termination may lose a level in the first tick without the player changing the sprite
/// count, because the termination holds while some of its sprites exist.
fn may_lose_from_start(goal: &Goal) -> bool {
    let some = matches!(goal.condition, Counted::AtMost(_, 1..) | Counted::Exactly(_, 1..));
    goal.can_lose() && some && goal.attainable == Attainable::FromStart
}

impl Linter<'_> {
    /// Reports terminations that hold at the start or never hold, and games in which no termination can ever
    /// hold.
    pub(super) fn terminations(&self, problems: &mut Vec<Diagnostic>) {
        let lines = &self.game.description().terminations;
        let all = &self.game.0.terminations;
        let stoppable = can_be_held_up(&self.game.0);
        for (end, line) in all.iter().zip(lines) {
            let absent = || end.counts().iter().all(|&stype| !self.at_start(stype));
            let at_once = match end.condition {
                Condition::SpriteCounter { limit, .. } => limit >= 0 && absent(),
                Condition::SpriteCounterMore { limit, .. } => limit <= 0,
                Condition::MultiSpriteCounter { limit, min, .. } => {
                    (limit == 0 || min && limit < 0) && absent()
                }
                Condition::Timeout { limit } => {
                    if limit > MAX_TICKS {
                        let message =
                            format!("an episode has at most {MAX_TICKS} ticks, so this never happens");
                        let problem = Diagnostic::warning("never-ends", limit_of(line), message);
                        problems.push(problem.help(format!("write a limit below {MAX_TICKS}")));
                    }
                    limit <= 0
                }
                Condition::MultiSpriteCounterSubTypes { .. } | Condition::StopCounter { .. } => false,
            };
            if at_once && (!stoppable || matches!(end.condition, Condition::Timeout { .. })) {
                let counts =
                    !matches!(end.condition, Condition::Timeout { .. } | Condition::SpriteCounterMore { .. });
                let tree = |&stype: &SpriteType| self.game.0.types[stype.index()].tree.iter().copied();
                let mut counted = end.counts().iter().flat_map(tree);
                let unless = match counts && counted.any(|stype| self.analysis.can_exist(stype)) {
                    true => ", unless a rule makes such a sprite in that tick",
                    false => "",
                };
                let message = format!(
                    "this holds at the start of every level: the game is over in its first tick{unless}"
                );
                let problem = Diagnostic::warning("ends-at-once", limit_of(line), message);
                problems.push(problem.help(match (&end.condition, limit_of(line) == line.class.span) {
                    (Condition::Timeout { .. }, true) => "add `limit=` and a number of ticks",
                    (Condition::Timeout { .. }, false) => "set a `limit=` of at least a few ticks",
                    _ => "place some of the counted sprites in each level, or set a different `limit=`",
                }));
            }
        }
    }

    /// Reports that the rules cannot lead to a win, or to a loss, unless another warning already gives the
    /// reason.
    pub(super) fn unreachable_outcomes(&self, problems: &mut Vec<Diagnostic>) {
        if problems.iter().any(|problem| problem.code == "ends-at-once") {
            return;
        }
        if !self.analysis.can_win() {
            // Types that never occur already have a warning, and may well be the reason why the game cannot be won.
            let reported = self.game.0.warnings.iter().any(|problem| problem.code == "never-there");
            match Some(self.game).filter(|_| !reported).and_then(swapped::swapped_rule_warning) {
                Some((problem, repaired)) => {
                    // Rules that never fire only because of the swapped rule get no warnings of their own.
                    let mut left = Vec::new();
                    let linter = Linter { game: &repaired, analysis: &Analysis::of(&repaired) };
                    linter.rules_that_never_fire(&mut left);
                    problems.retain(|other| other.code != "never-fires" || left.contains(other));
                    problems.push(problem);
                }
                None => self.report_unreachable(true, "the game cannot be won", problems),
            }
        }
        if !self.analysis.can_lose() && !self.analysis.goals().iter().any(may_lose_from_start) {
            self.report_unreachable(false, "the game cannot be lost before its last tick", problems);
        }
    }

    fn report_unreachable(&self, win: bool, fault: &str, problems: &mut Vec<Diagnostic>) {
        let code = if win { "no-win" } else { "no-lose" };
        let lines = &self.game.description().terminations;
        let ends = |goal: &&Goal| if win { goal.win } else { goal.can_lose() };
        let mut goals = self.analysis.goals().iter().filter(ends).peekable();
        let (line, reason, help) = if goals.peek().is_some() {
            let reported = goals.find_map(|goal| Some((&lines[goal.line], self.unattained(goal)?)));
            let Some((line, (reason, help))) = reported else { return };
            (line, reason, help)
        } else {
            // The compiler reports games without a winning termination.
            let Some(first) = lines.first().filter(|_| !win) else { return };
            let reason = "no termination has `win=False`".to_owned();
            let help = match self.deadly_rule() {
                Some((avatar, rule)) => format!(
                    "`{rule}` removes the player's `{avatar}`, but the game continues: add \
                     `SpriteCounter stype={avatar} win=False`"
                ),
                None => "add a Timeout, or another termination with `win=False`".to_owned(),
            };
            (first, reason, help)
        };
        problems.push(Diagnostic::warning(code, line.class.span, format!("{fault}: {reason}")).help(help));
    }

    /// Returns the initial avatar type, and the first rule that removes avatars of that type; `None` if there is no
    /// such rule.
    fn deadly_rule(&self) -> Option<(String, String)> {
        let avatar = self.analysis.start_avatar()?.stype;
        let kills = |encounter: &&Encounter| {
            let first = self.analysis.applies(encounter.first, avatar);
            let second = encounter.second.is_some_and(|second| self.analysis.applies(second, avatar));
            encounter.does(|effect| {
                *effect == EffectSummary::Kill(Side::First) && first
                    || *effect == EffectSummary::Kill(Side::Second) && second
            })
        };
        let line = self.analysis.encounters().iter().find(kills)?.line;
        let written = &self.game.description().interactions[line];
        let partners: Vec<&str> = written.second.iter().map(|word| word.text.as_str()).collect();
        let rule = format!("{} {} > {}", written.first.text, partners.join(" "), written.effect.text);
        Some((self.game.name(avatar).to_owned(), rule))
    }

    /// Returns the reason why no player can attain a goal, and a suggestion. Returns `None` if another
    /// warning gives the reason.
    fn unattained(&self, goal: &Goal) -> Option<(String, String)> {
        let stypes = self.game.0.terminations[goal.line].counts();
        let names = || {
            let names = stypes.iter().map(|&stype| format!("`{}`", self.game.name(stype)));
            names.collect::<Vec<_>>().join(" and ")
        };
        let (verb, limit) = match (&goal.condition, goal.attainable) {
            (_, Attainable::InPlay | Attainable::AtOnce) => {
                let reason = "another termination holds at the start of every level".to_owned();
                return Some((reason, "place some of the counted sprites in each level".to_owned()));
            }
            (Counted::Tick(_), _) => return None,
            (Counted::AtMost(_, limit), _) | (Counted::Exactly(_, limit @ ..=0), _) => ("lowers", *limit),
            (Counted::AtLeast(_, limit), _) => ("raises", *limit),
            (Counted::Exactly(_, limit), _) => ("changes", *limit),
        };
        if limit < 0 {
            let reason = format!("the number of {} is never below 0", names());
            return Some((reason, "set a different `limit=`".to_owned()));
        }
        if verb == "lowers"
            && let Some(short) = stypes.iter().find_map(|&stype| self.unobtainable(stype))
        {
            return Some(short);
        }
        let there = stypes.iter().any(|&stype| !self.tree(stype).is_empty());
        let reported = !there || stypes.iter().any(|&stype| self.has_rules_that_never_fire(stype));
        let reason = format!("nothing {verb} the number of {}", names());
        (!reported).then(|| {
            let swapped = Some(self.game).filter(|_| verb == "lowers" && goal.can_lose());
            let help = match swapped.and_then(swapped::swapped_threat) {
                Some((rule, meant)) => format!("did you mean `{meant}` instead of `{rule}`?"),
                None => format!("add a rule that {verb} it, or a different termination"),
            };
            (reason, help)
        })
    }

    /// Describes the rule that would remove sprites of the type but requires more of a resource than any sprite can
    /// hold. Also returns a suggestion. Returns `None` if there is no such rule.
    fn unobtainable(&self, written: SpriteType) -> Option<(String, String)> {
        let lines = &self.game.description().interactions;
        let encounters = self.analysis.encounters();
        encounters.iter().find_map(|encounter| {
            let Precondition::Holds(_, resource, needed) = encounter.precondition else { return None };
            let on = |side: SpriteType| self.analysis.applies(written, side);
            let ends = encounter.ends(Side::First) && on(encounter.first)
                || encounter.ends(Side::Second) && encounter.second.is_some_and(on);
            let info = &self.game.0.types[resource.index()];
            // Effects other than collecting may exceed the limit.
            let given = encounters.iter().any(|other| {
                other.does(
                    |effect| matches!(effect, EffectSummary::Change { resource: of, .. } if *of == resource),
                )
            });
            if !ends || given || needed <= info.resource_limit {
                return None;
            }
            let (name, limit) = (self.game.name(resource), info.resource_limit);
            let line = &lines[encounter.line];
            let partners: Vec<&str> = line.second.iter().map(|word| word.text.as_str()).collect();
            let rule = format!("{} {} > {}", line.first.text, partners.join(" "), line.effect.text);
            let asks = format!("`{rule}` needs {needed} `{name}`, but");
            if info.traits.is_resource {
                let help = format!("raise the `limit=` of `{name}` to {needed}, or require fewer");
                return Some((format!("{asks} no sprite can hold more than {limit}"), help));
            }
            let class = info.class.map_or("no Resource", SpriteClass::name);
            let reason = format!("{asks} no sprite can hold any: `{name}` is {class}, not Resource");
            Some((reason, format!("make it a Resource: `{name} > Resource limit={needed}`")))
        })
    }

    /// Returns `true` if a rule that never fires would change sprites of the type or of related types in the SpriteSet.
    /// Such a rule has its own warning.
    fn has_rules_that_never_fire(&self, written: SpriteType) -> bool {
        let counts = |side: SpriteType| self.analysis.applies(side, written);
        let mut encounters = self.analysis.encounters().iter().filter(|encounter| !encounter.blocks());
        encounters.any(|encounter| {
            (counts(encounter.first) || encounter.second.is_some_and(counts))
                && self.never_fires_reason(encounter).is_some()
        })
    }

    /// Returns `true` if a level can place sprites of the type or of related types in the SpriteSet, or sprites that
    /// create such sprites, directly or in several steps.
    fn at_start(&self, written: SpriteType) -> bool {
        let types: Vec<SpriteType> = self.game.sprite_types().collect();
        let mut there: Vec<bool> =
            types.iter().map(|&stype| !self.analysis.facts(stype).symbols.is_empty()).collect();
        // Sprites created during a tick may be updated in the same tick and create further sprites.
        loop {
            let made = types.iter().filter(|stype| there[stype.index()]);
            let made: Vec<SpriteType> =
                made.flat_map(|&maker| self.analysis.facts(maker).makes.clone()).collect();
            let before = there.clone();
            made.into_iter().for_each(|stype| there[stype.index()] = true);
            if there == before {
                return types
                    .iter()
                    .any(|&stype| there[stype.index()] && self.analysis.applies(written, stype));
            }
        }
    }
}
