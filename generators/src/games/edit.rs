//! Typed edits: the changes made to a game after its patterns are built.
//!
//! An edit refers to sprite types by [`Site`] and to rules by [`RuleAt`], so that it keeps its meaning when patterns are
//! added or removed and when it is passed to another game. If its target does not exist, it does nothing.

use super::draft::{AVATAR, Claim, Draft, FLOOR, HERO, Part, Phase, Site, Value, WALL};
use super::effect::Effect;
use super::grafts::Graft;
use super::ways;
use engine::SpriteClass;

/// A reference to a rule: the first one of that phase, effect and first sprite type that has that partner.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct RuleAt {
    phase: Phase,
    first: Site,
    second: Site,
    keyword: &'static str,
}

/// One change.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Edit {
    /// Gives a parameter of a sprite type another value.
    Param { of: Site, key: &'static str, value: Value },
    /// Gives a sprite type another class, with a target to chase if `after` is given.
    Class { of: Site, class: SpriteClass, after: Option<Site> },
    /// Gives a rule another score.
    Score { rule: RuleAt, score: i32 },
    /// Gives a rule another effect.
    Effect { rule: RuleAt, effect: Effect<Site> },
    /// Removes a rule.
    Drop { rule: RuleAt },
    /// Removes a partner from a rule.
    Spare { rule: RuleAt },
    /// Adds a rule.
    Graft { graft: &'static Graft, first: Site, second: Site, third: Site },
    /// Removes a sprite type, with the rules about it.
    Without { of: Site },
}

impl RuleAt {
    /// Returns the reference to a rule of a draft by one of its partners.
    pub(crate) fn of(draft: &Draft, rule: usize, partner: usize) -> RuleAt {
        let rule = &draft.rules[rule];
        RuleAt {
            phase: rule.phase,
            first: draft.site(rule.first),
            second: draft.site(rule.second[partner]),
            keyword: rule.effect.keyword(),
        }
    }

    /// Returns its index in a draft, if it is there.
    fn find(self, draft: &Draft) -> Option<usize> {
        let (first, second) = (draft.at(self.first)?, draft.at(self.second)?);
        draft.rules.iter().position(|rule| {
            rule.phase == self.phase
                && rule.first == first
                && rule.second.contains(&second)
                && rule.effect.keyword() == self.keyword
        })
    }
}

impl Edit {
    /// The name of the kind of change, for provenance.
    pub(crate) fn name(&self) -> &'static str {
        match self {
            Edit::Param { .. } => "edit/parameter",
            Edit::Class { .. } => "edit/class",
            Edit::Score { .. } => "edit/score",
            Edit::Effect { .. } => "edit/effect",
            Edit::Drop { .. } | Edit::Spare { .. } => "edit/without-rule",
            Edit::Graft { graft, .. } => graft.name,
            Edit::Without { .. } => "edit/without-type",
        }
    }

    /// Returns `true` if an earlier edit has no effect after this one.
    pub(crate) fn replaces(&self, earlier: &Edit) -> bool {
        match (self, earlier) {
            (Edit::Param { of, key, .. }, Edit::Param { of: other, key: same, .. }) => {
                of == other && key == same
            }
            (Edit::Class { of, .. }, Edit::Class { of: other, .. }) => of == other,
            (Edit::Score { rule, .. }, Edit::Score { rule: other, .. }) => rule == other,
            _ => false,
        }
    }

    /// Makes the change in a complete draft; returns `None`, and changes nothing, if its target does not exist.
    pub(crate) fn apply(self, draft: &mut Draft) -> Option<()> {
        match self {
            Edit::Param { of, key, value } => {
                let part = draft.at(of)?;
                let param = draft.sprites[part.0].params.iter_mut().find(|(name, _)| *name == key)?;
                param.1 = value;
            }
            Edit::Class { of, class, after } => {
                let part = draft.at(of)?;
                let after = after.map(|site| draft.at(site).ok_or(())).transpose().ok()?;
                ways::set_class(draft, part, class, after)?;
            }
            Edit::Score { rule, score } => {
                let rule = rule.find(draft)?;
                draft.rules[rule].score = score;
                draft.forget(rule, |claim| claim == Claim::Points);
            }
            Edit::Effect { rule, effect } => {
                let rule = rule.find(draft)?;
                let effect = effect.map(|site| draft.at(site))?;
                draft.forget(rule, |claim| !matches!(claim, Claim::Way(_)));
                draft.rules[rule].effect = effect;
                draft.gene = None;
                if let Effect::TransformTo { stype, .. } = effect {
                    let parts = [draft.rules[rule].first, stype];
                    draft.add_fact("<a name> that is hit turns into <a name>", &parts);
                }
            }
            Edit::Drop { rule } => {
                let rule = rule.find(draft)?;
                draft.forget(rule, |claim| !matches!(claim, Claim::Way(_)));
                draft.rules.remove(rule);
            }
            Edit::Spare { rule: address } => {
                let rule = address.find(draft)?;
                let partner = draft.at(address.second)?;
                if draft.rules[rule].second.len() < 2 {
                    return None;
                }
                draft.forget(rule, |claim| !matches!(claim, Claim::Way(_)));
                draft.rules[rule].second.retain(|&other| other != partner);
            }
            Edit::Graft { graft, first, second, third } => {
                let [first, second, third] = [first, second, third].map(|site| draft.at(site));
                graft.apply(draft, [first?, second?, third?])?;
            }
            Edit::Without { of } => {
                let part = draft.at(of)?;
                draft.remove(part)?;
            }
        }
        Some(())
    }
}

impl Draft {
    /// Removes the clauses of the pattern of a rule that `about` selects.
    fn forget(&mut self, rule: usize, about: impl Fn(Claim) -> bool) {
        if let Some(gene) = self.rules[rule].gene {
            self.clauses.retain(|clause| clause.gene != Some(gene) || !about(clause.claim));
        }
    }

    /// Lets two types pass each other, regardless of their bodies.
    pub(crate) fn allow_passing(&mut self, mover: Part, obstacle: Part) {
        let derived = [Phase::Carry, Phase::Push, Phase::Block];
        for rule in &mut self.rules {
            if rule.gene.is_none() && derived.contains(&rule.phase) && rule.first == mover {
                rule.second.retain(|&other| other != obstacle);
            }
        }
        self.rules.retain(|rule| !rule.second.is_empty());
    }

    /// Tests whether an ending counts the sprites of this type.
    pub(crate) fn is_counted(&self, part: Part) -> bool {
        self.endings.iter().any(|(ending, _)| ending.parts().contains(&part))
    }

    /// Removes a type with the rules about it; returns `None` if something else depends on it.
    fn remove(&mut self, part: Part) -> Option<()> {
        let named = |value: &Value| *value == Value::Part(part);
        let leans = |sprite: &super::draft::Sprite| {
            !sprite.removed
                && (sprite.parent == Some(part) || sprite.params.iter().any(|(_, value)| named(value)))
        };
        let needed = [FLOOR, WALL, AVATAR, HERO].contains(&part) || self.is_counted(part);
        let others = self.parts().filter(|&other| other != part);
        if needed || others.map(|other| self.sprite(other)).any(leans) {
            return None;
        }
        let about = |rule: &super::draft::Rule| rule.first == part || rule.effect.names().contains(&part);
        while let Some(rule) = self.rules.iter().position(about) {
            self.forget(rule, |_| true);
            self.rules.remove(rule);
        }
        self.rules.iter_mut().for_each(|rule| rule.second.retain(|&other| other != part));
        self.rules.retain(|rule| !rule.second.is_empty());
        let gene = self.sprite(part).gene;
        self.clauses.retain(|clause| gene.is_none() || clause.gene != gene);
        self.sprites[part.0].removed = true;
        Some(())
    }
}
