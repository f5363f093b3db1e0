//! The rules that follow from the bodies (the physical nature) of types: rules for pushing, blocking and picking up.

use super::{REMOVING, is_hero, name, own_name};
use crate::invention::genome::Invention;
use crate::invention::mechanic::Body;
use crate::invention::merge::Merged;
use engine::syntax::{InteractionLine, Param, Word};
use std::collections::BTreeSet;

/// A game's types, grouped by body.
pub(super) struct Bodies {
    pub(super) of: Vec<(String, Body)>,
    /// Types of self-moving sprites that turn around when stopped.
    pub(super) marching: BTreeSet<String>,
    /// Types that stand still until they turn into a different type.
    pub(super) still: BTreeSet<String>,
}

impl Bodies {
    pub(super) fn of(invention: &Invention, types: &[Merged]) -> Bodies {
        let merged = types.iter().enumerate().map(|(class, merged)| (name(class), merged.body));
        let own = invention.mechanics.iter().enumerate().flat_map(|(at, mechanic)| {
            let types = mechanic.types.iter().filter(|own| !is_hero(&own.origin));
            types.map(move |own| (own_name(at, &own.name), own.body))
        });
        Bodies { of: merged.chain(own).collect(), marching: BTreeSet::new(), still: BTreeSet::new() }
    }

    pub(super) fn with(&self, body: Body) -> impl Iterator<Item = &str> {
        self.of.iter().filter(move |(_, other)| *other == body).map(|(name, _)| name.as_str())
    }

    /// Returns the interactions by which the player pushes crates.
    pub(super) fn pushes(&self, before: &[InteractionLine]) -> Vec<InteractionLine> {
        let moving: Vec<&str> = self.with(Body::Mover).chain(self.with(Body::Flash)).collect();
        let push = |name: &str| {
            let stops: Vec<&str> = ["wall"]
                .into_iter()
                .chain(self.with(Body::Solid))
                .chain(self.with(Body::Crate))
                .chain(self.with(Body::Mover))
                .filter(|other| !is_settled(before, name, other))
                .collect();
            let mut undo = interaction(name, &stops, "undoAll");
            if !moving.is_empty() {
                undo.params.push(Param::new("notStype", moving.join(",")));
            }
            [interaction(name, &["hero"], "bounceForward"), undo]
        };
        let lines = self.with(Body::Crate).flat_map(push);
        lines.filter(|line| !line.second.is_empty()).collect()
    }

    /// Returns the interactions by which solid types stop other types.
    pub(super) fn stops(&self, before: &[InteractionLine]) -> Vec<InteractionLine> {
        let solid = |mover: &str| -> Vec<&str> {
            let all = ["wall"].into_iter().chain(self.with(Body::Solid));
            all.filter(|other| !is_settled(before, mover, other)).collect()
        };
        let mut lines = vec![interaction("hero", &solid("hero"), "stepBack")];
        for mover in self.with(Body::Mover).filter(|mover| !self.still.contains(*mover)) {
            let crates = self.with(Body::Crate).filter(|other| !is_settled(before, mover, other));
            let stops: Vec<&str> = solid(mover).into_iter().chain(crates).collect();
            if stops.is_empty() {
                continue;
            }
            if self.marching.contains(mover) {
                lines.push(interaction(mover, &stops, "reverseDirection"));
            }
            lines.push(interaction(mover, &stops, "stepBack"));
        }
        lines
    }

    /// Returns the rules for picking up the items that no mechanic's rule lets the avatar take.
    pub(super) fn picks_up(&self, taken: &BTreeSet<String>) -> Vec<InteractionLine> {
        let items = self.with(Body::Item).filter(|item| !taken.contains(*item));
        let pick = |item| {
            let mut line = interaction(item, &["hero"], "collectResource");
            line.params.push(Param::new("scoreChange", "1"));
            line
        };
        items.map(pick).collect()
    }
}

/// Returns `true` if a rule removes a sprite whenever sprites of the two types meet.
fn is_settled(before: &[InteractionLine], one: &str, other: &str) -> bool {
    let meet = |line: &InteractionLine, first: &str, second: &str| {
        line.first.text == first && line.second.iter().any(|word| word.text == second)
    };
    before.iter().any(|line| {
        REMOVING.contains(&line.effect.text.as_str()) && (meet(line, one, other) || meet(line, other, one))
    })
}

/// Returns `true` if two rules remove a type when the player touches it, so that one of them has no effect. Also
/// returns `true` if a type harms the player on touch although the player needs to touch it.
pub(super) fn is_contradictory(bodies: &Bodies, types: &[Merged], rules: &[InteractionLine]) -> bool {
    let meets = |line: &InteractionLine, first: &str, second: &str| {
        line.first.text == first && line.second.iter().any(|word| word.text == second)
    };
    // A sprite killed in the same tick is still harmful, except under `killIfAlive`.
    let taken_from = |harm: &str| match harm {
        "killSprite" => &["killSprite", "transformTo", "transformIfCount", "killIfOtherHasMore"][..],
        "killIfAlive" => &["killSprite", "transformTo"],
        _ => &[],
    };
    (0..types.len()).map(name).any(|stype| {
        let ends = |line: &&InteractionLine| {
            meets(line, &stype, "hero") && ["killSprite", "transformTo"].contains(&line.effect.text.as_str())
        };
        if rules.iter().filter(ends).count() > 1 {
            return true;
        }
        let mut harms = rules.iter().filter(|line| meets(line, "hero", &stype));
        harms.any(|line| {
            let taken = taken_from(&line.effect.text);
            let is_taken = rules
                .iter()
                .any(|line| meets(line, &stype, "hero") && taken.contains(&line.effect.text.as_str()));
            is_taken || (!taken.is_empty() && bodies.with(Body::Item).any(|item| item == stype))
        })
    })
}

/// Converts a rule that removes an item when the player touches it into a rule that makes the player collect it.
pub(super) fn collect_instead(line: &mut InteractionLine, items: &BTreeSet<&str>) {
    let is_taken = line.effect.text == "killSprite" && line.second.iter().all(|word| word.text == "hero");
    if is_taken && items.contains(line.first.text.as_str()) {
        line.effect = Word::from("collectResource");
    }
}

fn interaction(first: &str, second: &[&str], effect: &str) -> InteractionLine {
    InteractionLine {
        first: Word::from(first),
        second: second.iter().map(|name| Word::from(*name)).collect(),
        effect: Word::from(effect),
        ..InteractionLine::default()
    }
}
