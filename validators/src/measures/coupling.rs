//! The coupling of rules: opposed uses of the same thing.

use engine::analysis::{EffectSummary, Encounter, Harm, Side};
use engine::{Analysis, SpriteType};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The counts of rules that put the player's needs in conflict, derived from the rules alone.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coupling {
    /// The number of sprite types with opposed uses: one rule with the type helps the player, and another one harms.
    pub dual: usize,
    /// The number of rules that take a resource or points from the player.
    pub prices: usize,
    /// The number of rules by which the player, or something that it creates, ends a sprite that other rules use.
    pub irreversible: usize,
}

/// The amount of coupling that gives a strength of 1.
const ENOUGH: f64 = 6.0;

impl Coupling {
    /// Counts the couplings of a game. Cost: O(encounters × types).
    pub fn of(analysis: &Analysis) -> Coupling {
        let rules = Rules { analysis };
        let encounters = analysis.encounters();
        let types = || {
            let possible = |stype: &SpriteType| {
                let facts = analysis.facts(*stype);
                facts.concrete && facts.possible && !rules.is_avatar(*stype)
            };
            analysis.game().sprite_types().filter(possible)
        };
        let is_dual = |stype: &SpriteType| {
            let with = || encounters.iter().filter(|encounter| rules.involves(encounter, *stype));
            with().any(|encounter| rules.helps(encounter)) && with().any(|encounter| rules.harms(encounter))
        };
        let is_final = |encounter: &&Encounter| {
            let Some(second) = encounter.second else { return false };
            let ended = [(Side::First, encounter.first, second), (Side::Second, second, encounter.first)];
            ended.into_iter().any(|(side, victim, other)| {
                let uses = encounters.iter().filter(|other| rules.involves(other, victim));
                let uses: BTreeSet<usize> = uses.map(|other| other.line).collect();
                encounter.ends(side)
                    && !rules.is_avatar(victim)
                    && rules.is_of_player(other)
                    && uses.iter().any(|&line| line != encounter.line)
            })
        };
        let lines = |wanted: &dyn Fn(&&Encounter) -> bool| -> usize {
            encounters.iter().filter(wanted).map(|encounter| encounter.line).collect::<BTreeSet<_>>().len()
        };
        Coupling {
            dual: types().filter(is_dual).count(),
            prices: lines(&|encounter| rules.is_price(encounter)),
            irreversible: lines(&is_final),
        }
    }

    /// Returns the strength, from 0 to 1: opposed uses count twice, and each kind of coupling has a maximum, so that no
    /// kind makes up for all others.
    pub fn strength(self) -> f64 {
        let part = |count: usize| count.min(3) as f64;
        ((2.0 * part(self.dual) + part(self.prices) + part(self.irreversible)) / ENOUGH).min(1.0)
    }
}

/// The rules of a game, as good or bad for its player.
struct Rules<'a> {
    analysis: &'a Analysis,
}

impl Rules<'_> {
    fn is_avatar(&self, stype: SpriteType) -> bool {
        self.analysis.avatars().iter().any(|avatar| self.analysis.applies(stype, avatar.stype))
    }

    /// Returns `true` if a type is the avatar, or something that it shoots or puts down.
    fn is_of_player(&self, stype: SpriteType) -> bool {
        let shots = self.analysis.avatars().iter().flat_map(|avatar| avatar.shots.iter());
        self.is_avatar(stype) || shots.into_iter().any(|shot| self.analysis.applies(stype, *shot))
    }

    fn involves(&self, encounter: &Encounter, stype: SpriteType) -> bool {
        let sides = [Some(encounter.first), encounter.second];
        sides.into_iter().flatten().any(|written| self.analysis.applies(written, stype))
    }

    fn is_harmful(&self, stype: SpriteType) -> bool {
        self.analysis.harm(stype) != Harm::None
    }

    /// Returns `true` if a type is valuable: it is a resource, or the player has to protect it.
    fn is_wanted(&self, stype: SpriteType) -> bool {
        let held = self.analysis.resources().iter().any(|resource| resource.stype == stype);
        held || self.analysis.aims().protect.contains(&stype)
    }

    /// Returns the types that the rule removes or turns into others.
    fn ended(&self, encounter: &Encounter) -> impl Iterator<Item = SpriteType> {
        let first = encounter.ends(Side::First).then_some(encounter.first);
        let second = encounter.second.filter(|_| encounter.ends(Side::Second));
        first.into_iter().chain(second)
    }

    /// Returns the types that the rule creates.
    fn made(encounter: &Encounter) -> impl Iterator<Item = SpriteType> {
        encounter.effects.iter().filter_map(|effect| match effect {
            EffectSummary::Become(made) | EffectSummary::Make(made) | EffectSummary::BecomeAll(_, made) => {
                Some(*made)
            }
            _ => None,
        })
    }

    fn helps(&self, encounter: &Encounter) -> bool {
        let gains = |effect: &EffectSummary| match effect {
            EffectSummary::Collect => true,
            EffectSummary::Change { by, .. } | EffectSummary::Health { by, .. } => *by > 0,
            _ => false,
        };
        encounter.score > 0
            || encounter.does(gains)
            || self.ended(encounter).any(|stype| self.is_harmful(stype) && !self.is_avatar(stype))
    }

    fn harms(&self, encounter: &Encounter) -> bool {
        let makes_harm = Rules::made(encounter).any(|stype| self.is_harmful(stype));
        let takes = self.ended(encounter).any(|stype| self.is_avatar(stype) || self.is_wanted(stype))
            && !encounter.does(|effect| *effect == EffectSummary::Collect);
        encounter.score < 0 || makes_harm || takes || self.is_price(&encounter)
    }

    fn is_price(&self, encounter: &&Encounter) -> bool {
        let loses = |effect: &EffectSummary| match effect {
            EffectSummary::Change { by, .. } | EffectSummary::Health { by, .. } => *by < 0,
            _ => false,
        };
        encounter.score < 0 || encounter.does(loses)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::Game;

    fn coupling(interactions: &str) -> Coupling {
        let source = format!(
            "BasicGame\n    SpriteSet\n        coal > Resource limit=9\n        ash > Immovable\n        wolf > RandomNPC\n        \
             hut > Immovable\n        hero > MovingAvatar\n    LevelMapping\n        c > coal\n        x > ash\n        \
             f > wolf\n        h > hut\n        A > hero\n    InteractionSet\n{interactions}    TerminationSet\n        \
             SpriteCounter stype=hut limit=0 win=True\n"
        );
        Coupling::of(&Analysis::of(&Game::from_source(&source).unwrap()))
    }

    #[test]
    fn opposed_uses_prices_and_losses_for_good_count() {
        let plain = "        coal hero > collectResource scoreChange=1\n        hut hero > killSprite scoreChange=1\n";
        assert_eq!(coupling(plain), Coupling { dual: 0, prices: 0, irreversible: 0 });
        let coupled = format!(
            "{plain}        coal wolf > killSprite\n        hut hero > changeResource resource=coal value=-1\n"
        );
        let found = coupling(&coupled);
        assert!(found.dual >= 1, "coal is collected and eaten: {found:?}");
        assert!(found.strength() > coupling(plain).strength());
    }
}
