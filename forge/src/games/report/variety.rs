//! How many kinds of games are they?

use super::entry::Judged;
use report::Share;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use validators::game_measures::{AvatarKind, GoalKind};

/// How many kinds of games are they?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Variety {
    /// Kinds of avatar × kinds of goal that there are, with their games; the most frequent first.
    pub kinds: Vec<Kind>,
    /// The share of the most frequent; none of no games.
    pub largest: Option<Share>,
    /// Families of effects with the games that have such an interaction, the most frequent first.
    pub effects: Vec<Counted>,
    /// Classes of what moves by itself, with the games that have such a sprite.
    pub npcs: Vec<Counted>,
    /// Classes of what makes others.
    pub producers: Vec<Counted>,
}

/// A kind of games.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Kind {
    /// What the avatar can do.
    pub avatar: AvatarKind,
    /// What a win asks for.
    pub goal: GoalKind,
    /// Games of this kind.
    pub games: u64,
}

/// How many games have something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Counted {
    /// What.
    pub name: String,
    /// How many.
    pub games: Share,
}

impl Variety {
    pub(super) fn of(judged: &[Judged<'_>]) -> Variety {
        let mut kinds: BTreeMap<(AvatarKind, GoalKind), u64> = BTreeMap::new();
        for kind in judged.iter().map(|judged| &judged.kind) {
            *kinds.entry((kind.avatar, kind.goal)).or_default() += 1;
        }
        let mut kinds: Vec<Kind> =
            kinds.into_iter().map(|((avatar, goal), games)| Kind { avatar, goal, games }).collect();
        kinds.sort_by_key(|kind| std::cmp::Reverse(kind.games));
        let of = judged.len() as u64;
        let kind = || judged.iter().map(|judged| &judged.kind);
        Variety {
            largest: kinds.first().map(|kind| Share::new(kind.games, of)),
            kinds,
            effects: counted(of, kind().flat_map(|kind| &kind.effects).map(|family| family.name())),
            npcs: counted(of, kind().flat_map(|kind| &kind.npcs).map(String::as_str)),
            producers: counted(of, kind().flat_map(|kind| &kind.producers).map(String::as_str)),
        }
    }
}

/// The names, each with how often it comes; the most frequent first.
fn counted<'a>(of: u64, names: impl Iterator<Item = &'a str>) -> Vec<Counted> {
    let mut counts: BTreeMap<&str, u64> = BTreeMap::new();
    names.for_each(|name| *counts.entry(name).or_default() += 1);
    let mut counted: Vec<Counted> = counts
        .into_iter()
        .map(|(name, count)| Counted { name: name.to_owned(), games: Share::new(count, of) })
        .collect();
    counted.sort_by_key(|counted| std::cmp::Reverse(counted.games.count));
    counted
}
