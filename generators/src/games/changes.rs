//! Small, meaningful changes to a game, such as a designer would make next.

use super::draft::{AVATAR, Draft, Part, Value};
use super::edit::{Edit, RuleAt};
use super::grafts::GRAFTS;
use super::ways;
use engine::Sampler;

/// A kind of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Adds a pattern.
    Add,
    /// Removes a pattern.
    Remove,
    /// Replaces a pattern by one of the same family; the goal and the way of moving included.
    Replace,
    /// Builds a pattern with another seed.
    Redraw,
    /// Changes a parameter of a sprite type.
    Parameter,
    /// Changes the class of a sprite type.
    Class,
    /// Adds a rule between parts of any patterns.
    Graft,
    /// Changes the effect of a rule.
    Effect,
    /// Removes a rule.
    Drop,
    /// Changes a score.
    Score,
    /// Changes the time limit.
    Time,
    /// Changes the theme.
    Theme,
    /// Takes back an earlier edit.
    Undo,
}

/// All kinds, with their weights in the draw.
const CHANGES: [(Change, u32); 13] = [
    (Change::Add, 5),
    (Change::Remove, 2),
    (Change::Replace, 4),
    (Change::Redraw, 4),
    (Change::Parameter, 5),
    (Change::Class, 2),
    (Change::Graft, 6),
    (Change::Effect, 2),
    (Change::Drop, 1),
    (Change::Score, 1),
    (Change::Time, 1),
    (Change::Theme, 1),
    (Change::Undo, 2),
];

impl Change {
    pub(crate) fn draw(sampler: &mut Sampler) -> Change {
        let weights = CHANGES.map(|(_, weight)| weight);
        CHANGES[sampler.weighted(&weights).unwrap_or(0)].0
    }
}

/// Draws an edit of that kind; `None` if this draw finds nothing to edit.
pub(crate) fn edit(draft: &Draft, change: Change, sampler: &mut Sampler) -> Option<Edit> {
    let parts: Vec<Part> = draft.parts().filter(|&part| !draft.sprite(part).removed).collect();
    match change {
        Change::Parameter => {
            let mut options: Vec<(Part, &'static str, Value, (u32, u32))> = Vec::new();
            for &part in &parts {
                let params = draft.sprite(part).params.iter();
                options
                    .extend(params.filter_map(|&(key, value)| {
                        Some((part, key, value, ways::range(draft, part, key)?))
                    }));
            }
            let (part, key, value, range) = pick(&options, sampler)?;
            Some(Edit::Param { of: draft.site(part), key, value: moved(value, range, sampler)? })
        }
        Change::Class => {
            // The parts that the goal is about move as the goal says.
            let free = |&&part: &&Part| draft.sprite(part).gene != Some(1);
            let part = *pick(&parts.iter().filter(free).collect::<Vec<_>>(), sampler)?;
            let class = pick(&ways::siblings(draft, part), sampler)?;
            let after = ways::has_target(class).then(|| draft.site(AVATAR));
            Some(Edit::Class { of: draft.site(part), class, after })
        }
        Change::Graft => {
            let places = GRAFTS
                .iter()
                .flat_map(|graft| graft.places(draft).into_iter().map(move |place| (graft, place)));
            let places: Vec<_> = places.collect();
            let weights: Vec<u32> = places.iter().map(|(graft, _)| graft.weight).collect();
            let (graft, place) = places[sampler.weighted(&weights)?];
            let [first, second, third] = place.map(|part| draft.site(part));
            Some(Edit::Graft { graft, first, second, third })
        }
        Change::Effect => {
            let rules = draft.rules.iter().enumerate();
            let options = rules.flat_map(|(at, rule)| {
                ways::effects(draft, rule).into_iter().map(move |effect| (at, effect))
            });
            let (at, effect) = pick(&options.collect::<Vec<_>>(), sampler)?;
            let effect = effect.map(|part| Some(draft.site(part)))?;
            Some(Edit::Effect { rule: RuleAt::of(draft, at, 0), effect })
        }
        Change::Drop => {
            // The rules derived from bodies keep the board together, and the goal depends on its own rules.
            let free = |&at: &usize| draft.rules[at].gene.is_some_and(|gene| gene > 1);
            let at = pick(&(0..draft.rules.len()).filter(free).collect::<Vec<_>>(), sampler)?;
            Some(Edit::Drop { rule: RuleAt::of(draft, at, 0) })
        }
        Change::Score => {
            let scores = |&at: &usize| draft.rules[at].score != 0;
            let at = pick(&(0..draft.rules.len()).filter(scores).collect::<Vec<_>>(), sampler)?;
            let old = draft.rules[at].score;
            let size = sampler.between(1, 10) as i32;
            let score = if old < 0 { -(size.min(5)) } else { size };
            (score != old).then(|| Edit::Score { rule: RuleAt::of(draft, at, 0), score })
        }
        _ => None,
    }
}

/// Draws a nearby value within the range: up to a third away, or up to 1 (for hundredths 5) if that is more.
fn moved(value: Value, (least, most): (u32, u32), sampler: &mut Sampler) -> Option<Value> {
    let near = |old: u32, step: u32, sampler: &mut Sampler| {
        let reach = (old / 3).max(step);
        let new =
            sampler.between(old.saturating_sub(reach).max(least) as usize, (old + reach).max(least) as usize);
        let new = (new as u32).min(most);
        (new != old).then_some(new)
    };
    match value {
        Value::Count(old) => near(old, 1, sampler).map(Value::Count),
        Value::Hundredths(old) => near(old, 5, sampler).map(Value::Hundredths),
        _ => None,
    }
}

/// Picks one of the options, if there are any.
pub(crate) fn pick<T: Copy>(options: &[T], sampler: &mut Sampler) -> Option<T> {
    if options.is_empty() { None } else { Some(*sampler.choose(options)) }
}
