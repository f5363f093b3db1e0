//! Rules that can be added between parts of any patterns, as designers do to make two things of a game interact.

use super::draft::{Draft, Part, Phase, Rule};
use super::effect::Effect;
use super::role::Role;

/// Moving enemies.
const FOES: &[Role] =
    &[Role::Wanderer, Role::Chaser, Role::Patroller, Role::Rover, Role::Slug, Role::Pest, Role::Snuffer];
/// Moving enemies that do not stay on a line.
const STRAYS: &[Role] = &[Role::Wanderer, Role::Chaser, Role::Slug, Role::Pest, Role::Snuffer];
/// Things that are useful but not needed.
const TREATS: &[Role] = &[Role::Coin, Role::Berry, Role::Medicine];
/// Things that are harmful where they are.
const HAZARDS: &[Role] =
    &[Role::Trap, Role::Dart, Role::Drop, Role::Steam, Role::Creep, Role::Slime, Role::Blast];

/// A rule that can be added.
#[derive(Debug)]
pub(crate) struct Graft {
    /// Its name, with its family.
    pub(crate) name: &'static str,
    /// The relative weight in the draw.
    pub(crate) weight: u32,
    first: &'static [Role],
    second: &'static [Role],
    /// The roles for the third part; if empty, the second part is used again.
    third: &'static [Role],
    phase: Phase,
    /// `true` if an ending may count the first: the rule does not remove it.
    spares: bool,
    /// `true` if the two must be allowed to pass each other, since their bodies would keep them apart.
    passes: bool,
    score: i32,
    effect: fn([Part; 3]) -> Effect,
    /// The text about it, and which of the three parts it names.
    clause: (&'static str, &'static [usize]),
}

/// The common part of most grafts.
const GRAFT: Graft = Graft {
    name: "",
    weight: 3,
    first: FOES,
    second: STRAYS,
    third: &[],
    phase: Phase::Meet,
    spares: false,
    passes: false,
    score: 0,
    effect: |_| Effect::KillSprite,
    clause: ("", &[]),
};

pub(crate) const GRAFTS: &[Graft] = &[
    Graft {
        name: "graft/perish",
        weight: 5,
        first: FOES,
        second: HAZARDS,
        phase: Phase::Strike,
        score: 2,
        clause: ("<a name> harms <names> as well", &[1, 0]),
        ..GRAFT
    },
    Graft {
        name: "graft/crush",
        weight: 4,
        first: FOES,
        second: &[Role::Crate],
        phase: Phase::Push,
        passes: true,
        score: 2,
        clause: ("<names> do not survive <a name>", &[0, 1]),
        ..GRAFT
    },
    Graft {
        name: "graft/eat",
        weight: 3,
        first: TREATS,
        second: STRAYS,
        clause: ("<names> make off with <names>", &[1, 0]),
        ..GRAFT
    },
    Graft {
        name: "graft/breed",
        weight: 3,
        first: TREATS,
        second: STRAYS,
        effect: |[_, foe, _]| Effect::TransformTo { stype: foe, kill_second: false },
        clause: ("<a name> that comes upon <a name> becomes two", &[1, 0]),
        ..GRAFT
    },
    Graft {
        name: "graft/enrage",
        weight: 4,
        first: &[Role::Wanderer, Role::Slug, Role::Pest],
        second: &[Role::Trap, Role::Steam, Role::Creep, Role::Slime, Role::Coin, Role::Berry],
        third: &[Role::Chaser],
        effect: |[_, _, fury]| Effect::TransformTo { stype: fury, kill_second: false },
        clause: ("<a name> turns <names> into <names>", &[1, 0, 2]),
        ..GRAFT
    },
    Graft {
        name: "graft/brawl",
        weight: 3,
        first: FOES,
        second: FOES,
        score: 1,
        effect: |_| Effect::KillBoth,
        clause: ("<names> and <names> are the end of each other", &[0, 1]),
        ..GRAFT
    },
    Graft {
        name: "graft/portal",
        weight: 3,
        first: FOES,
        second: &[Role::PortalIn],
        third: &[Role::PortalOut],
        spares: true,
        effect: |_| Effect::TeleportToExit,
        clause: ("<names> take the <name> too", &[0, 1]),
        ..GRAFT
    },
    Graft {
        name: "graft/ride",
        weight: 2,
        first: STRAYS,
        second: &[Role::Cart],
        phase: Phase::Carry,
        spares: true,
        effect: |_| Effect::PullWithIt,
        clause: ("<names> ride on <names> too", &[0, 1]),
        ..GRAFT
    },
    Graft {
        name: "graft/shatter",
        weight: 3,
        first: &[Role::Soil, Role::Crate, Role::Rubble, Role::Dark],
        second: &[Role::Dart, Role::Drop, Role::Blast, Role::Steam],
        phase: Phase::Push,
        passes: true,
        effect: |_| Effect::KillBoth,
        clause: ("<a name> breaks <name>", &[1, 0]),
        ..GRAFT
    },
];

impl Graft {
    /// Returns the parts of a draft between which the rule makes sense.
    pub(crate) fn places(&self, draft: &Draft) -> Vec<[Part; 3]> {
        let of = |roles: &'static [Role]| {
            let parts = draft.parts().filter(|&part| !draft.sprite(part).removed);
            parts.filter(|&part| roles.contains(&draft.sprite(part).role)).collect::<Vec<_>>()
        };
        let (firsts, seconds, thirds) = (of(self.first), of(self.second), of(self.third));
        let mut places = Vec::new();
        for &first in &firsts {
            for &second in &seconds {
                if self.third.is_empty() {
                    places.push([first, second, second]);
                }
                places.extend(thirds.iter().map(|&third| [first, second, third]));
            }
        }
        places.retain(|&place| self.fits(draft, place));
        places
    }

    /// Tests whether the rule fits: a pair has at most one rule, and only the rules of the goal may remove what an ending
    /// counts.
    fn fits(&self, draft: &Draft, [first, second, third]: [Part; 3]) -> bool {
        let effect = (self.effect)([first, second, third]);
        let met = |rule: &Rule| {
            (rule.phase >= Phase::Strike || rule.effect == effect)
                && (rule.first == first && rule.second.contains(&second)
                    || rule.first == second && rule.second.contains(&first))
        };
        let all_differ = first != second && first != third;
        let taken_away = !self.spares && draft.is_counted(first);
        let partner_too = effect == Effect::KillBoth && draft.is_counted(second);
        all_differ && !taken_away && !partner_too && !draft.rules.iter().any(met)
    }

    /// Adds the rule; returns `None` if it does not make sense there.
    pub(crate) fn apply(&self, draft: &mut Draft, place: [Part; 3]) -> Option<()> {
        if !self.fits(draft, place) {
            return None;
        }
        let [first, second, _] = place;
        if self.passes {
            draft.allow_passing(first, second);
            draft.allow_passing(second, first);
        }
        let effect = (self.effect)(place);
        let rule =
            Rule { phase: self.phase, first, second: vec![second], effect, score: self.score, gene: None };
        let at = draft.rules.partition_point(|other| other.phase <= self.phase);
        draft.rules.insert(at, rule);
        draft.gene = None;
        let (text, named) = self.clause;
        draft.add_fact(text, &named.iter().map(|&part| place[part]).collect::<Vec<_>>());
        Some(())
    }
}
