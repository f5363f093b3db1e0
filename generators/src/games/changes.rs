//! Small changes to a game, each with a meaning: what a designer would do next.

use super::draft::{AVATAR, Draft, Part, Value};
use super::edit::{Edit, RuleAt};
use super::grafts::GRAFTS;
use super::ways;
use engine::Sampler;

/// A kind of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// One pattern more.
    Add,
    /// One pattern less.
    Remove,
    /// A pattern of the same family instead; the goal and the way of moving included.
    Replace,
    /// A pattern is built with another seed.
    Redraw,
    /// A parameter of a sprite type.
    Parameter,
    /// The class of a sprite type.
    Class,
    /// A rule between parts of any patterns.
    Graft,
    /// Another effect of a rule.
    Effect,
    /// One rule less.
    Drop,
    /// Another score.
    Score,
    /// More time, or less.
    Time,
    /// Another fiction.
    Fiction,
    /// An earlier edit is taken back.
    Undo,
}

/// All kinds, with how often each is drawn.
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
    (Change::Fiction, 1),
    (Change::Undo, 2),
];

impl Change {
    pub(crate) fn draw(sampler: &mut Sampler) -> Change {
        let weights = CHANGES.map(|(_, weight)| weight);
        CHANGES[sampler.weighted(&weights).unwrap_or(0)].0
    }
}

/// An edit of that kind; none if this draw finds nothing to edit so.
pub(crate) fn edit(draft: &Draft, change: Change, sampler: &mut Sampler) -> Option<Edit> {
    let parts: Vec<Part> = draft.parts().filter(|&part| !draft.sprite(part).gone).collect();
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
            // What the goal is about moves as the goal says.
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
            // What follows from bodies keeps the board together, and the goal lives by its rules.
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

/// A value nearby, within the range; hundredths go by fives.
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

/// One of them, if there are any.
pub(crate) fn pick<T: Copy>(options: &[T], sampler: &mut Sampler) -> Option<T> {
    if options.is_empty() { None } else { Some(*sampler.choose(options)) }
}
