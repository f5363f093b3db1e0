//! The dependency graph of the mechanics of a draft: rules that use what other rules provide.

use super::body::Body;
use super::draft::{Draft, Part, Phase, Rule, Stamina, Value, Weapon};
use super::effect::Effect;
use engine::SpriteClass;

/// The mechanics that provide something, with the part that each provides.
fn provisions(draft: &Draft) -> Vec<(Option<usize>, Part)> {
    let mut provided = Vec::new();
    for (at, rule) in draft.rules.iter().enumerate() {
        let parts = match rule.effect {
            Effect::CollectResource { .. } | Effect::BounceForward | Effect::PullWithIt => vec![rule.first],
            Effect::TransformTo { stype, .. }
            | Effect::SpawnIfHasMore { stype, .. }
            | Effect::SpawnBehind { stype } => vec![stype],
            Effect::TransformToAll { into, .. } => vec![into],
            Effect::KillAll { stype } => vec![stype],
            _ => Vec::new(),
        };
        provided.extend(parts.into_iter().map(|part| (Some(at), part)));
    }
    if let Some(Weapon::Bolt(hit) | Weapon::Blade(hit) | Weapon::Blast(hit)) = draft.weapon {
        provided.push((None, hit));
    }
    provided
}

/// Returns `true` if a rule is more than one about obstacles.
fn is_mechanic(rule: &Rule) -> bool {
    rule.gene.is_some() || rule.phase >= Phase::Strike
}

/// Counts the mechanics of a complete draft that another one depends on: for example, collected things are spent, created
/// ones are used, pushed ones fit somewhere, wounds are healed and losses are counted.
pub(crate) fn dependencies(draft: &Draft) -> usize {
    let mut count = usize::from(matches!(draft.stamina, Stamina::Hearts(_)));
    for (from, part) in provisions(draft) {
        let uses = |rule: &Rule| {
            rule.first == part || rule.second.contains(&part) || rule.effect.names().contains(&part)
        };
        let opens = from.is_some_and(|from| matches!(draft.rules[from].effect, Effect::KillAll { .. }));
        let used = draft
            .rules
            .iter()
            .enumerate()
            .any(|(at, rule)| Some(at) != from && uses(rule) && (opens || is_mechanic(rule)));
        let fuels = draft.parts().any(|other| {
            draft.sprite(other).params.iter().any(|&(key, value)| key == "ammo" && value == Value::Part(part))
        });
        count += usize::from(used || fuels || draft.is_counted(part));
    }
    count
}

/// Tests whether everything in a draft is connected: collected things have a use, required ones can be obtained, shut
/// ones can be opened, and everything that levels place plays a part.
pub(crate) fn is_whole(draft: &Draft) -> bool {
    let parts = || draft.parts().filter(|&part| !draft.sprite(part).removed);
    let mechanics = || draft.rules.iter().filter(|rule| is_mechanic(rule));
    let named = |part: Part| mechanics().any(|rule| rule.effect.names().contains(&part));
    let held = |part: Part| {
        mechanics().any(|rule| rule.first == part && matches!(rule.effect, Effect::CollectResource { .. }))
    };
    let shot =
        |part: Part| parts().any(|other| draft.sprite(other).params.contains(&("ammo", Value::Part(part))));
    let wanted = |part: Part| named(part) || shot(part);
    let spent = |part: Part| {
        mechanics().any(|rule| match rule.effect {
            Effect::KillIfOtherHasMore { resource, .. }
            | Effect::KillIfHasLess { resource, .. }
            | Effect::Spend { resource }
            | Effect::SpawnIfHasMore { resource, .. } => resource == part,
            _ => false,
        }) || shot(part)
    };
    let met =
        |part: Part| mechanics().any(|rule| rule.first == part || rule.second.contains(&part)) || named(part);
    let opens = |part: Part| mechanics().any(|rule| rule.first == part) || named(part);
    let makes = |part: Part| {
        draft
            .sprite(part)
            .params
            .iter()
            .any(|&(key, value)| key == "stype" && matches!(value, Value::Part(_)))
    };
    let leads =
        |part: Part| parts().any(|other| draft.sprite(other).params.contains(&("stype", Value::Part(part))));
    let is_thing = |&part: &Part| !matches!(draft.sprite(part).body, Body::Floor | Body::Wall | Body::Hero);
    parts().filter(is_thing).all(|part| {
        let sprite = draft.sprite(part);
        let is_door = sprite.class == Some(SpriteClass::Door) && sprite.body == Body::Solid;
        (held(part) <= wanted(part))
            && (spent(part) <= held(part))
            && (is_door <= opens(part))
            && (sprite.placed <= (met(part) || makes(part) || leads(part) || draft.is_counted(part)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::composition::is_challenge;
    use crate::games::{ConstructiveGames, GameConfig, Kind};
    use engine::Seed;

    /// Every constructive game of every kind has an obstacle and two mechanics that interact.
    #[test]
    fn mechanics_depend_on_each_other() {
        for &kind in Kind::ALL {
            let generator = ConstructiveGames::new(GameConfig { kinds: vec![kind] });
            for number in 0..60 {
                let seed = Seed::from_text("mechanics").child(kind.name(), number);
                let genome = generator.genome(seed).unwrap();
                assert!(dependencies(&genome.draft().0) > 0, "{genome:?}");
                assert!(is_whole(&genome.draft().0), "{genome:?}");
                assert!(is_challenge(&genome.patterns()), "{genome:?}");
            }
        }
    }
}
