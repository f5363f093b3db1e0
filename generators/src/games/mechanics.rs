//! The graph of mechanics of a draft: which rule provides what another one lives on.

use super::draft::{Draft, Part, Phase, Rule, Stamina, Value, Weapon};
use super::effect::Effect;

/// A mechanic that provides something, and what it provides.
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

/// Whether a rule means something beyond who stops whom.
fn is_mechanic(rule: &Rule) -> bool {
    rule.gene.is_some() || rule.phase >= Phase::Strike
}

/// How many mechanics of a complete draft depend on another one: what is held is spent, what is made is used, what is
/// pushed fits somewhere, what is in the way is cleared, what wounds is healed, what goes wrong adds up.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::composition::is_challenge;
    use crate::games::{ConstructiveGames, GameConfig, Kind};
    use engine::Seed;

    /// Every constructive game of every kind: something in the way, and two mechanics that have to do with each other.
    #[test]
    fn mechanics_depend_on_each_other() {
        for &kind in Kind::ALL {
            let generator = ConstructiveGames::new(GameConfig { kinds: vec![kind] });
            for number in 0..60 {
                let seed = Seed::from_text("mechanics").child(kind.name(), number);
                let genome = generator.genome(seed).unwrap();
                assert!(dependencies(&genome.draft().0) > 0, "{genome:?}");
                assert!(is_challenge(&genome.patterns()), "{genome:?}");
            }
        }
    }
}
