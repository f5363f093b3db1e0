//! The parts of the rules that decide wins and losses: terminations that can win, and encounters that lead to a win.
//! Only the first [`MAX_GOALS`] terminations are considered, which bounds the cost.

use super::glyph::is_avatar;
use engine::analysis::{
    Attainable, Condition, EffectSummary, Encounter, Goal, MAX_GOALS, Precondition, Side,
};
use engine::{Analysis, SpriteType};

/// The condition under which a touch leads to a win.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Terms {
    /// The touch always counts.
    Always,
    /// The avatar must hold at least this amount of the resource.
    Holds(SpriteType, i32),
    /// The avatar must hold one of these amounts.
    HoldsOneOf(Vec<(SpriteType, i32)>),
    /// The avatar must hold at most this amount of the resource.
    HoldsAtMost(SpriteType, i32),
    /// At most this number of sprites of the type may be left.
    Left(SpriteType, i32),
    /// At least this number of sprites of the type must exist.
    Exist(SpriteType, i32),
    /// The touch loses the game unless the condition holds.
    OrLose(Box<Terms>),
    /// The condition is too complex for a legend.
    Sometimes,
}

impl Terms {
    /// Returns the condition as an addition to a verb: ` with 3 gem`, ` once no vine is left`.
    pub(super) fn phrase(&self, analysis: &Analysis) -> String {
        match self {
            Terms::Holds(stype, amount) | Terms::Exist(stype, amount) => {
                format!(" with {}", counted(analysis, *stype, *amount))
            }
            Terms::HoldsOneOf(list) => format!(" with {}", alternatives(analysis, list)),
            Terms::Sometimes => " at times".to_owned(),
            Terms::Always | Terms::HoldsAtMost(..) | Terms::Left(..) | Terms::OrLose(_) => {
                self.note(analysis).trim_start_matches(',').to_owned()
            }
        }
    }

    /// Returns the condition as the end of a note: `, needs 3 gem`, `, once no vine is left`. Empty if there
    /// is no condition.
    pub(super) fn note(&self, analysis: &Analysis) -> String {
        let name = |stype: &SpriteType| analysis.game().name(*stype);
        match self {
            Terms::Always => String::new(),
            Terms::Holds(resource, amount) => format!(", needs {}", counted(analysis, *resource, *amount)),
            Terms::HoldsOneOf(list) => format!(", needs {}", alternatives(analysis, list)),
            Terms::OrLose(terms) => format!("{}, or lose", terms.note(analysis)),
            Terms::HoldsAtMost(resource, ..=0) => format!(", without {}", name(resource)),
            Terms::HoldsAtMost(resource, most) => format!(", with at most {most} {}", name(resource)),
            Terms::Left(stype, ..=0) => format!(", once no {} is left", name(stype)),
            Terms::Left(stype, most) => format!(", with at most {most} {} left", name(stype)),
            Terms::Exist(stype, least) => format!(", needs {}", counted(analysis, *stype, *least)),
            Terms::Sometimes => ", but not always".to_owned(),
        }
    }
}

/// Returns the type's name, preceded by the amount if it is not 1.
pub(super) fn counted(analysis: &Analysis, stype: SpriteType, amount: i32) -> String {
    let name = analysis.game().name(stype);
    if amount == 1 { name.to_owned() } else { format!("{amount} {name}") }
}

/// Returns the resources with their amounts, separated by `or`.
pub(super) fn alternatives(analysis: &Analysis, list: &[(SpriteType, i32)]) -> String {
    let names: Vec<String> =
        list.iter().map(|(resource, amount)| counted(analysis, *resource, *amount)).collect();
    names.join(" or ")
}

/// Returns `true` if the goal requires few sprites of its types, and `false` if it requires many.
fn wants_few(condition: &Condition) -> bool {
    matches!(condition, Condition::AtMost(..) | Condition::Exactly(_, ..=0))
}

/// Returns the limit in a condition on a number of sprites; `None` for a condition on the tick.
fn limit(condition: &Condition) -> Option<i32> {
    match condition {
        Condition::AtMost(_, limit) | Condition::AtLeast(_, limit) | Condition::Exactly(_, limit) => {
            Some(*limit)
        }
        Condition::Tick(_) => None,
    }
}

/// Returns `true` if a termination with the opposite result always ends the game before the termination at index `at`
/// can end it.
fn is_beaten(analysis: &Analysis, at: usize) -> bool {
    let goals = analysis.goals();
    let (own, wins) = (&goals[at].condition, goals[at].win);
    let Some(own_limit) = limit(own) else { return false };
    let within = |inner: &Condition, outer: &Condition| {
        !inner.types().is_empty() && inner.types().iter().all(|stype| outer.types().contains(stype))
    };
    let others = goals.iter().enumerate().take(MAX_GOALS);
    others.filter(|(_, goal)| goal.win != wins && !goal.is_open()).any(|(index, goal)| {
        let Some(limit) = limit(&goal.condition) else { return false };
        let first = |is_sooner: bool| is_sooner || (limit == own_limit && index < at);
        match (wants_few(own), &goal.condition) {
            (true, Condition::AtMost(..) | Condition::Exactly(_, ..=0)) => {
                within(&goal.condition, own) && first(limit > own_limit)
            }
            (false, Condition::AtLeast(..)) => within(own, &goal.condition) && first(limit < own_limit),
            _ => false,
        }
    })
}

/// Returns `true` if the termination at index `at` wins whenever it holds, regardless of the score, and no
/// losing termination always holds before it.
pub(super) fn is_plain_win(analysis: &Analysis, at: usize) -> bool {
    let goal = &analysis.goals()[at];
    goal.win && !goal.is_open() && !is_beaten(analysis, at)
}

/// Returns `true` if playing can make the termination at index `at` win, regardless of the score.
pub(super) fn can_win(analysis: &Analysis, at: usize) -> bool {
    is_plain_win(analysis, at) && analysis.goals()[at].attainable == Attainable::InPlay
}

/// Returns the winning terminations that count sprites of the type and can be fulfilled by playing.
fn winning(analysis: &Analysis, stype: SpriteType) -> impl Iterator<Item = &Goal> {
    let goals = analysis.goals().iter().enumerate().take(MAX_GOALS);
    let counted = goals.filter(move |(_, goal)| goal.condition.types().contains(&stype));
    counted.filter(|(at, _)| can_win(analysis, *at)).map(|(_, goal)| goal)
}

/// Returns `true` if a win requires that sprites of the type disappear.
pub(super) fn is_to_go(analysis: &Analysis, stype: SpriteType) -> bool {
    !is_avatar(analysis, stype) && winning(analysis, stype).any(|goal| wants_few(&goal.condition))
}

/// Returns `true` if a win requires that sprites of the type appear.
pub(super) fn is_to_come(analysis: &Analysis, stype: SpriteType) -> bool {
    winning(analysis, stype).any(|goal| !wants_few(&goal.condition))
}

/// Returns `true` if the type, or a type that touching it makes or changes, counts towards a termination that wins or
/// may win. A termination that is always preceded by a loss does not qualify.
pub(super) fn may_win(analysis: &Analysis, stype: SpriteType) -> bool {
    let touches = analysis.avatars().iter().map(|avatar| analysis.touch(avatar.stype, stype));
    let brought: Vec<SpriteType> =
        touches.flat_map(|touch| touch.makes.iter().chain(&touch.changes).copied()).collect();
    analysis.goals().iter().enumerate().take(MAX_GOALS).any(|(at, goal)| {
        let types = goal.condition.types();
        let is_counted = types.contains(&stype) || brought.iter().any(|made| types.contains(made));
        is_counted && (goal.is_open() || is_plain_win(analysis, at))
    })
}

/// Returns `true` if the type's sprites count towards a termination that wins or loses depending on the
/// score.
pub(super) fn is_open(analysis: &Analysis, stype: SpriteType) -> bool {
    let mut goals = analysis.goals().iter();
    goals.any(|goal| {
        goal.is_open() && goal.attainable == Attainable::InPlay && goal.condition.types().contains(&stype)
    })
}

/// Returns `true` if losing the type's sprites can lose the game.
pub(super) fn is_to_keep(analysis: &Analysis, stype: SpriteType) -> bool {
    let loses = |(at, goal): (usize, &Goal)| {
        !goal.win
            && goal.attainable == Attainable::InPlay
            && wants_few(&goal.condition)
            && goal.condition.types().contains(&stype)
            && !is_beaten(analysis, at)
    };
    !is_avatar(analysis, stype) && analysis.goals().iter().enumerate().take(MAX_GOALS).any(loses)
}

/// Returns `true` if the game is lost when no sprite of `stype` is left because all of them were removed, or
/// turned into `to`.
fn loses_without(analysis: &Analysis, stype: SpriteType, to: Option<SpriteType>) -> bool {
    let is_other = |other: &SpriteType| *other != stype && analysis.facts(*other).possible;
    let loses = |goal: &Goal| {
        let types = goal.condition.types();
        !goal.win
            && wants_few(&goal.condition)
            && types.contains(&stype)
            && !types.iter().any(is_other)
            && to.is_none_or(|to| !types.contains(&to))
    };
    is_to_keep(analysis, stype) && analysis.goals().iter().any(loses)
}

/// Returns `true` if turning other sprites into `to` counts as removing them. This is not the case if a win requires
/// removing sprites of `to`, or if their appearance loses the game.
pub(super) fn goes(analysis: &Analysis, to: SpriteType) -> bool {
    !analysis.aims().remove.contains(&to) && !analysis.aims().prevent.contains(&to)
}

/// Returns `true` if a losing termination counts both types together, so that turning one into the other
/// changes nothing.
pub(super) fn are_kept_together(analysis: &Analysis, stype: SpriteType, to: SpriteType) -> bool {
    let counts = |goal: &Goal, stype: SpriteType| goal.condition.types().contains(&stype);
    let losing = || analysis.goals().iter().filter(|goal| !goal.win && wants_few(&goal.condition));
    losing().filter(|goal| counts(goal, stype)).all(|goal| counts(goal, to))
}

/// Returns the encounters of an avatar type with sprites of `stype`, each with the avatar's side.
pub(super) fn met(
    analysis: &Analysis,
    avatar: SpriteType,
    stype: SpriteType,
) -> impl Iterator<Item = (&Encounter, Side)> {
    let first = analysis.between(avatar, stype).map(|encounter| (encounter, Side::First));
    first.chain(analysis.between(stype, avatar).map(|encounter| (encounter, Side::Second)))
}

/// Returns `true` if a collision of the two types loses the game, or leaves a type that must also disappear
/// for a win.
pub(super) fn is_in_vain(analysis: &Analysis, stype: SpriteType, partner: SpriteType) -> bool {
    let aims = analysis.aims();
    let bad = |encounter: &Encounter, own: Side, effect: &EffectSummary| match effect {
        EffectSummary::Become(to) if is_safe_by_count(analysis, encounter) => aims.remove.contains(to),
        EffectSummary::Become(to) => aims.prevent.contains(to) || aims.remove.contains(to),
        EffectSummary::Make(to) => aims.prevent.contains(to),
        EffectSummary::BecomeAll(from, to) => {
            aims.prevent.contains(to) || (*from != stype && loses_without(analysis, *from, Some(*to)))
        }
        EffectSummary::KillAll(of) => *of != stype && loses_without(analysis, *of, None),
        EffectSummary::Kill(side) if *side != own => {
            let dies = is_avatar(analysis, partner) && aims.avatar_must_live;
            let is_certain = encounter.precondition == Precondition::Always;
            (dies && is_certain) || is_to_keep(analysis, partner)
        }
        _ => false,
    };
    let own_first = analysis.between(stype, partner).map(|encounter| (encounter, Side::First));
    let own_second = analysis.between(partner, stype).map(|encounter| (encounter, Side::Second));
    own_first
        .chain(own_second)
        .any(|(encounter, own)| encounter.effects.iter().any(|effect| bad(encounter, own, effect)))
}

/// Returns the condition under which an effect of the avatar's touch happens.
fn terms(analysis: &Analysis, encounter: &Encounter, avatar: Side) -> Terms {
    match encounter.precondition {
        Precondition::Always => Terms::Always,
        Precondition::Holds(side, _, ..=0) if side == avatar => Terms::Always,
        Precondition::Holds(side, resource, amount) if side == avatar => Terms::Holds(resource, amount),
        Precondition::HoldsAtMost(side, resource, most) if side == avatar => {
            Terms::HoldsAtMost(resource, most)
        }
        Precondition::Movement => by_count(analysis, encounter).unwrap_or(Terms::Sometimes),
        Precondition::Chance(_) | Precondition::Holds(..) | Precondition::HoldsAtMost(..) => Terms::Sometimes,
    }
}

/// Returns the condition for a transformation that depends on a number of sprites; `None` for any other effect, and for
/// conditions that legends cannot express.
fn by_count(analysis: &Analysis, encounter: &Encounter) -> Option<Terms> {
    let game = analysis.game();
    let line = &game.description().interactions[encounter.line];
    if line.effect.text != "transformIfCount" {
        return None;
    }
    let value = |key: &str| {
        let param = line.params.iter().find(|param| param.key.text == key);
        param.map(|param| param.value.text.as_str())
    };
    let counted = value("stypeCount").and_then(|name| game.sprite_type(name))?;
    let least = value("geq").filter(|least| *least != "0");
    let terms = match (least, value("leq")) {
        (None, Some(most)) => Terms::Left(counted, most.parse().ok()?),
        (Some(least), None) => Terms::Exist(counted, least.parse().ok()?),
        _ => return None,
    };
    match value("estype") {
        None => Some(terms),
        Some(_) if is_safe_by_count(analysis, encounter) => Some(Terms::OrLose(Box::new(terms))),
        Some(_) => None,
    }
}

/// Returns `true` if a transformation that depends on a number of sprites loses the game only if the number is wrong.
fn is_safe_by_count(analysis: &Analysis, encounter: &Encounter) -> bool {
    let line = &analysis.game().description().interactions[encounter.line];
    let prevent = &analysis.aims().prevent;
    let named = |key: &str| {
        let param = line.params.iter().find(|param| param.key.text == key)?;
        analysis.game().sprite_type(&param.value.text)
    };
    let is_bad = |key: &str| named(key).is_some_and(|to| prevent.contains(&to));
    line.effect.text == "transformIfCount" && is_bad("estype") && !is_bad("stype")
}

/// Returns the condition under which touching a sprite contributes to a win, or `None` if no touch does.
pub(super) fn by_touch(analysis: &Analysis, avatar: SpriteType, stype: SpriteType) -> Option<Terms> {
    if is_in_vain(analysis, stype, avatar) {
        return None;
    }
    let (removes, is_kept) = (is_to_go(analysis, stype), is_to_keep(analysis, stype));
    let stays = |to: SpriteType| !is_kept || are_kept_together(analysis, stype, to);
    let helps = |own: Side, effect: &EffectSummary| match effect {
        EffectSummary::Kill(side) => removes && !is_kept && *side != own,
        EffectSummary::Become(to) if own == Side::First => is_to_come(analysis, *to),
        EffectSummary::Become(to) => {
            stays(*to) && (is_to_come(analysis, *to) || (removes && goes(analysis, *to)))
        }
        EffectSummary::KillAll(of) => removes && !is_kept && *of == stype,
        EffectSummary::BecomeAll(of, to) => {
            (removes && *of == stype && goes(analysis, *to) && stays(*to)) || is_to_come(analysis, *to)
        }
        EffectSummary::Make(to) => is_to_come(analysis, *to),
        EffectSummary::Health { of: None, by, .. } => removes && !is_kept && *by < 0 && own == Side::Second,
        _ => false,
    };
    let useful = met(analysis, avatar, stype)
        .filter(|(encounter, own)| encounter.effects.iter().any(|effect| helps(*own, effect)));
    let mut terms: Vec<Terms> = useful.map(|(encounter, own)| terms(analysis, encounter, own)).collect();
    let plain = terms.iter().position(|terms| *terms == Terms::Always);
    let best = plain.or_else(|| terms.iter().position(|terms| *terms != Terms::Sometimes));
    let mut held: Vec<(SpriteType, i32)> = Vec::new();
    for terms in &terms {
        let Terms::Holds(resource, amount) = terms else { continue };
        if !held.contains(&(*resource, *amount)) {
            held.push((*resource, *amount));
        }
    }
    if plain.is_none() && held.len() > 1 {
        return Some(Terms::HoldsOneOf(held));
    }
    (!terms.is_empty()).then(|| terms.swap_remove(best.unwrap_or(0)))
}

/// Returns the avatar types that contribute to a win by touching a sprite of `stype`, and the condition under which the
/// touch counts. If the touch always counts for some types, only these types are returned. If the conditions differ,
/// [`Terms::Sometimes`] is returned as the condition. Returns `None` if no avatar type contributes.
pub(super) fn able(analysis: &Analysis, stype: SpriteType) -> Option<(Vec<SpriteType>, Terms)> {
    let avatars = analysis.avatars().iter().map(|avatar| avatar.stype);
    let found: Vec<(SpriteType, Terms)> =
        avatars.filter_map(|avatar| Some((avatar, by_touch(analysis, avatar, stype)?))).collect();
    let free: Vec<SpriteType> =
        found.iter().filter(|(_, terms)| *terms == Terms::Always).map(|(avatar, _)| *avatar).collect();
    if !free.is_empty() {
        return Some((free, Terms::Always));
    }
    let (_, first) = found.first()?;
    let same = found.iter().all(|(_, terms)| terms == first);
    let terms = if same { first.clone() } else { Terms::Sometimes };
    Some((found.iter().map(|(avatar, _)| *avatar).collect(), terms))
}

/// Returns `true` if other types must disappear together with `stype` for a win.
pub(super) fn is_one_of_several(analysis: &Analysis, stype: SpriteType) -> bool {
    let is_other = |other: &SpriteType| {
        let facts = analysis.facts(*other);
        *other != stype && facts.possible && facts.concrete
    };
    let mut counted = winning(analysis, stype).filter(|goal| wants_few(&goal.condition));
    let is_shared = |goal: &Goal| goal.condition.types().iter().any(is_other);
    let first = counted.next();
    first.is_some_and(is_shared) && counted.all(is_shared)
}
