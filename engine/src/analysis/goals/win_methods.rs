//! Methods of winning a game, either through the player's actions or through other sprites.

use super::goal::Condition;
use crate::analysis::interactions::encounter::{EffectSummary, Encounter, Side};
use crate::analysis::interactions::lock::{Fate, Sink};
use crate::analysis::interactions::touch::{Harm, Touch};
use crate::analysis::types::facts::Motion;
use crate::analysis::types::role::Role;
use crate::analysis::{Analysis, Attainable};
use crate::rules::SpriteType;
use std::collections::BTreeSet;

/// A method of winning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum WinMethod {
    /// The avatar reaches an exit.
    Exit,
    /// The avatar touches sprites that do not move.
    Take,
    /// The avatar touches moving sprites.
    Catch,
    /// The avatar's shots remove sprites, and either these sprites or the shots move.
    Shoot,
    /// A sprite that the avatar places, and that stays in its cell, removes a sprite that does not move.
    Tool,
    /// A sprite that the avatar pushes reaches its destination.
    Push,
    /// Sprites other than the avatar, its shots and its tools achieve the win.
    Others,
    /// Time passes.
    Wait,
}

/// The methods by which sprites of each type can be removed or created.
pub(crate) struct WinMethods<'a> {
    analysis: &'a Analysis,
    /// For each type, whether a shot removes its sprites or turns them into something harmless.
    shot: Vec<bool>,
    /// For each type, whether a moving shot removes its sprites or turns them into something harmless.
    flown: Vec<bool>,
    /// For each type, whether touching some sprite removes all sprites of the type.
    opened: Vec<bool>,
    /// For each type, whether its sprites can be pushed onto something that removes or changes them, or can
    /// be filled by a pushed sprite.
    pushed: Vec<bool>,
    /// For each type, whether a collision with another sprite removes its sprites.
    met: Vec<bool>,
    /// For each type, the methods by which the player can create its sprites.
    made: Vec<BTreeSet<WinMethod>>,
}

impl Analysis {
    /// Returns the methods by which players can win, in the order of [`WinMethod`]. The list is empty if
    /// there is no such method. Cost: O(types × avatars + interactions × relatives).
    pub fn win_methods(&self) -> Vec<WinMethod> {
        WinMethods::of(self).methods().into_iter().collect()
    }
}

impl WinMethods<'_> {
    /// Computes the win methods for every type. Cost: O(types × avatars + interactions × relatives).
    pub(crate) fn of(analysis: &Analysis) -> WinMethods<'_> {
        let none = vec![false; analysis.facts.len()];
        let shots = projectiles(analysis);
        let flies = |shot: &SpriteType| analysis.facts(*shot).motion != Motion::Still;
        let flying: BTreeSet<SpriteType> = shots.iter().copied().filter(flies).collect();
        let mut methods = WinMethods {
            analysis,
            shot: shot_down(analysis, &shots),
            flown: shot_down(analysis, &flying),
            opened: none.clone(),
            pushed: none.clone(),
            met: none,
            made: vec![BTreeSet::new(); analysis.facts.len()],
        };
        for (at, touch) in analysis.touches.iter().flat_map(|row| row.iter().enumerate()) {
            touch.opens.iter().for_each(|stype| methods.opened[stype.index()] = true);
            let method = match analysis.roles[at] {
                Role::Exit => WinMethod::Exit,
                _ if analysis.facts[at].motion != Motion::Still => WinMethod::Catch,
                _ => WinMethod::Take,
            };
            for stype in touch.makes.iter().chain(&touch.changes) {
                methods.made[stype.index()].insert(method);
            }
        }
        for pushable in &analysis.pushables {
            for Sink { partner, fate, fills, .. } in &pushable.sinks {
                methods.pushed[partner.index()] |= *fills;
                methods.pushed[pushable.stype.index()] |= *fate != Fate::Stays;
                if let Fate::Becomes(to) = fate {
                    methods.made[to.index()].insert(WinMethod::Push);
                }
            }
        }
        for encounter in &analysis.encounters {
            let ends = |side: Side| encounter.ends(side);
            for (side, written) in [(Side::First, Some(encounter.first)), (Side::Second, encounter.second)] {
                if let (Some(written), true) = (written, ends(side) && encounter.second.is_some()) {
                    let tree = &analysis.game.0.types[written.index()].tree;
                    tree.iter().for_each(|stype| methods.met[stype.index()] = true);
                }
            }
        }
        methods
    }

    /// Returns the methods by which players can win.
    pub(crate) fn methods(&self) -> BTreeSet<WinMethod> {
        let mut methods = BTreeSet::new();
        let goals = self.analysis.goals.iter();
        for goal in goals.filter(|goal| goal.win && goal.attainable == Attainable::InPlay) {
            let types = goal.condition.types().iter();
            let types = types.filter(|stype| self.analysis.facts(**stype).possible);
            match goal.condition {
                Condition::Tick(_) => methods.extend([WinMethod::Wait]),
                Condition::AtMost(..) | Condition::Exactly(_, 0) => {
                    types.for_each(|&stype| methods.extend(self.methods_to_remove(stype)));
                }
                Condition::AtLeast(..) | Condition::Exactly(..) => {
                    types.for_each(|&stype| methods.extend(self.methods_to_make(stype)));
                }
            }
        }
        methods
    }

    fn methods_to_make(&self, stype: SpriteType) -> BTreeSet<WinMethod> {
        let made = &self.made[stype.index()];
        let is_met = || {
            let mut met = self.analysis.encounters.iter().filter(|encounter| encounter.second.is_some());
            met.any(|encounter| encounter.brings_one_of(&[stype]))
        };
        if made.is_empty() && is_met() { BTreeSet::from([WinMethod::Others]) } else { made.clone() }
    }

    fn methods_to_remove(&self, stype: SpriteType) -> BTreeSet<WinMethod> {
        let at = stype.index();
        let mut methods = BTreeSet::new();
        let moves = self.analysis.facts[at].motion != Motion::Still;
        if self.opened[at] || self.analysis.touches.iter().any(|row| row[at].ends_other()) {
            methods.insert(match self.analysis.role(stype) {
                Role::Exit => WinMethod::Exit,
                _ if moves => WinMethod::Catch,
                _ if self.is_like_an_exit(stype) => WinMethod::Exit,
                _ => WinMethod::Take,
            });
        }
        if self.shot[at] {
            methods.insert(if moves || self.flown[at] { WinMethod::Shoot } else { WinMethod::Tool });
        }
        methods.extend(self.pushed[at].then_some(WinMethod::Push));
        if methods.is_empty() && self.met[at] {
            methods.insert(WinMethod::Others);
        }
        methods
    }

    /// Returns `true` if a motionless type that the avatar touches to win is a destination, rather than one
    /// of many items to collect.
    fn is_like_an_exit(&self, stype: SpriteType) -> bool {
        let Analysis { game, aims, touches, .. } = self.analysis;
        let wanted = |stype: SpriteType| {
            aims.remove.binary_search(&stype).is_ok() && self.analysis.facts(stype).possible
        };
        let alone = || game.sprite_types().filter(|&stype| wanted(stype)).count() == 1;
        let gain = || {
            self.analysis.of_role(Role::Collectable).any(|other| {
                let positive = |row: &Vec<Touch>| row[other.index()].score > 0;
                !wanted(other) && touches.iter().any(positive)
            })
        };
        self.analysis.harm(stype) != Harm::None || (alone() && gain())
    }

    /// Returns `true` if a shot removes sprites of the type, or turns them into something harmless.
    pub(crate) fn is_shot_down(&self, stype: SpriteType) -> bool {
        self.shot[stype.index()]
    }

    /// Returns `true` if moving shots remove hostile sprites, or sprites that must be removed.
    pub(crate) fn shoots(&self) -> bool {
        let analysis = self.analysis;
        analysis.game.sprite_types().any(|stype| {
            let target =
                analysis.aims.remove.binary_search(&stype).is_ok() || is_hostile(analysis.role(stype));
            target && analysis.facts(stype).possible && self.flown[stype.index()]
        })
    }
}

fn is_hostile(role: Role) -> bool {
    matches!(role, Role::Enemy | Role::Spawner)
}

/// Returns the avatars' shots, and all moving types that these shots turn into or create.
fn projectiles(analysis: &Analysis) -> BTreeSet<SpriteType> {
    let shots = analysis.avatars.iter().flat_map(|avatar| avatar.shots.iter().copied());
    let mut found: BTreeSet<SpriteType> = shots.collect();
    let mut new: Vec<SpriteType> = found.iter().copied().collect();
    while let Some(shot) = new.pop() {
        let turns = analysis.turns(shot).into_iter().map(|(to, _)| to);
        for stype in analysis.facts(shot).makes.iter().copied().chain(turns) {
            if analysis.facts(stype).motion != Motion::Still && found.insert(stype) {
                new.push(stype);
            }
        }
    }
    found
}

/// Returns, for each type, whether one of `shots` removes its sprites or turns them into something harmless.
fn shot_down(analysis: &Analysis, shots: &BTreeSet<SpriteType>) -> Vec<bool> {
    let types = &analysis.game.0.types;
    let fires = |written: SpriteType| types[written.index()].tree.iter().any(|stype| shots.contains(stype));
    let fires: Vec<bool> = analysis.game.sprite_types().map(fires).collect();
    let tame = |encounter: &Encounter| {
        let hostile = |to: &SpriteType| is_hostile(analysis.role(*to));
        !encounter.does(|effect| matches!(effect, EffectSummary::Become(to) if hostile(to)))
    };
    let mut down = vec![false; types.len()];
    for encounter in &analysis.encounters {
        let Some(second) = encounter.second else { continue };
        if fires[second.index()] && encounter.ends(Side::First) && tame(encounter) {
            types[encounter.first.index()].tree.iter().for_each(|stype| down[stype.index()] = true);
        }
        if fires[encounter.first.index()] && encounter.ends(Side::Second) {
            types[second.index()].tree.iter().for_each(|stype| down[stype.index()] = true);
        }
    }
    down
}
