//! Sets of criteria.

use crate::criteria::{Cost, Criterion};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt;

/// A set of criteria, in the order of checking.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
pub struct CriterionSet(u32);

impl CriterionSet {
    /// Returns the set of these criteria.
    pub const fn of(criteria: &[Criterion]) -> CriterionSet {
        let (mut bits, mut at) = (0, 0);
        while at < criteria.len() {
            bits |= 1 << criteria[at] as u32;
            at += 1;
        }
        CriterionSet(bits)
    }

    /// Returns the criteria of a cost.
    pub fn costing(cost: Cost) -> CriterionSet {
        Criterion::ALL.iter().copied().filter(|criterion| criterion.cost() == cost).collect()
    }

    /// Returns `true` if the criterion is in the set.
    pub const fn contains(self, criterion: Criterion) -> bool {
        self.0 & 1 << criterion as u32 != 0
    }

    /// Returns `true` for the empty set.
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Returns the set with all criteria of another one.
    #[must_use]
    pub const fn with(self, others: CriterionSet) -> CriterionSet {
        CriterionSet(self.0 | others.0)
    }

    /// Returns the criteria that are in both sets.
    #[must_use]
    pub const fn only(self, others: CriterionSet) -> CriterionSet {
        CriterionSet(self.0 & others.0)
    }

    /// Returns the set without the criteria of another one.
    #[must_use]
    pub const fn without(self, others: CriterionSet) -> CriterionSet {
        CriterionSet(self.0 & !others.0)
    }

    /// Returns the criteria, in the order of checking.
    pub fn iter(self) -> impl Iterator<Item = Criterion> {
        Criterion::ALL.iter().copied().filter(move |&criterion| self.contains(criterion))
    }
}

impl FromIterator<Criterion> for CriterionSet {
    fn from_iter<I: IntoIterator<Item = Criterion>>(criteria: I) -> CriterionSet {
        criteria
            .into_iter()
            .fold(CriterionSet::default(), |set, criterion| set.with(CriterionSet::of(&[criterion])))
    }
}

impl fmt::Debug for CriterionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_set().entries(self.iter()).finish()
    }
}

impl Serialize for CriterionSet {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl<'de> Deserialize<'de> for CriterionSet {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<CriterionSet, D::Error> {
        Ok(Vec::<Criterion>::deserialize(deserializer)?.into_iter().collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_keeps_the_order_of_checking() {
        let set: CriterionSet = serde_json::from_str(r#"["drama", "winnable", "drama"]"#).unwrap();
        assert_eq!(serde_json::to_string(&set).unwrap(), r#"["winnable","drama"]"#);
        assert_eq!(set.only(CriterionSet::GATES), CriterionSet::of(&[Criterion::Drama]));
        assert_eq!(set.without(CriterionSet::GATES), CriterionSet::of(&[Criterion::Winnable]));
        assert!(set.without(set).is_empty() && set.with(CriterionSet::LEVEL).contains(Criterion::Skill));
    }

    #[test]
    fn the_dearest_criteria_are_those_of_the_ladder() {
        let of_ladder = CriterionSet::of(&[Criterion::Skill, Criterion::SkillOverall]);
        assert_eq!(CriterionSet::costing(Cost::Ladder), of_ladder);
    }
}
