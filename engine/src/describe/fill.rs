//! Fills the placeholders in effect templates.

use super::words::{Party, a, count, list, percent, plural};
use crate::analysis::Analysis;
use crate::rules::effects::{CHANCE, Sentence, Value};
use crate::rules::{SpriteType, Timed};

/// Returns the sentence for an effect that applies when `one` and `two` collide.
pub(super) fn when_they_meet(analysis: &Analysis, sentence: &Sentence, one: &Party, two: &Party) -> String {
    let both = Party { you: one.you || two.you, ..one.clone() };
    let filler =
        Filler { analysis, sentence, one: Some(one), two: Some(two), both: Some(&both), target: None };
    filler.fill(sentence.meeting)
}

/// Returns the words that introduce the points awarded when an effect applies to `one` and `two`.
pub(super) fn if_scored(analysis: &Analysis, sentence: &Sentence, one: &Party, two: &Party) -> String {
    let filler = Filler { analysis, sentence, one: Some(one), two: Some(two), both: None, target: None };
    filler.fill(sentence.if_scored)
}

/// Returns the sentence for a timed effect, which runs either on every sprite of a type or on no particular
/// sprite.
pub(super) fn by_the_clock(analysis: &Analysis, timed: &Timed) -> String {
    let sentence = analysis.game().0.effects[usize::from(timed.effect)].effect.sentence();
    let target = timed.target;
    Filler { analysis, sentence: &sentence, one: None, two: None, both: None, target }.fill(sentence.alone)
}

struct Filler<'a> {
    analysis: &'a Analysis,
    sentence: &'a Sentence,
    one: Option<&'a Party>,
    two: Option<&'a Party>,
    both: Option<&'a Party>,
    /// The type on whose sprites the effect runs, if the effect is timed.
    target: Option<SpriteType>,
}

impl Filler<'_> {
    fn fill(&self, template: &str) -> String {
        let mut text = String::new();
        let mut rest = template;
        while let Some((before, after)) = rest.split_once('{') {
            let (hole, after) = after.split_once('}').expect("a hole of a template ends");
            text += before;
            text += &self.hole(hole);
            rest = after;
        }
        text + rest
    }

    fn hole(&self, hole: &str) -> String {
        let (name, forms) = hole.split_once(':').unwrap_or((hole, ""));
        let every = self.target.map(|target| Party::of(self.analysis, target)).filter(|party| party.you);
        let party = match name {
            "one" => self.one,
            "two" => self.two,
            "both" => self.both,
            "every" => every.as_ref(),
            _ => None,
        };
        if let Some(party) = party {
            return match forms.split_once('|') {
                Some((with_you, with_it)) => party.verb(with_you, with_it).to_owned(),
                None => party.name.clone(),
            };
        }
        match name {
            "every" if !forms.is_empty() => {
                forms.split_once('|').map_or(forms, |(_, with_it)| with_it).to_owned()
            }
            "alone" => self.fill(self.sentence.alone),
            "every" => match self.target {
                Some(stype) => format!("every {}", self.name(stype)),
                None => "everything".to_owned(),
            },
            name => self.value(self.sentence.value(name).expect("a hole of a template has a value")),
        }
    }

    fn value(&self, value: &Value) -> String {
        let rules = &self.analysis.game().0;
        match value {
            Value::Name(stype) => self.name(*stype).to_owned(),
            Value::Many(stype, 1) => self.name(*stype).to_owned(),
            Value::Many(stype, _) => plural(self.name(*stype)),
            Value::A(stype) => a(self.name(*stype)),
            Value::AnyOf(types) => {
                let names: Vec<String> = types.iter().map(|&stype| a(self.name(stype))).collect();
                list(&names, "or")
            }
            Value::Party(stype) => Party::of(self.analysis, *stype).name,
            Value::Number(number) => number.to_string(),
            Value::Decimal(number) => number.to_string(),
            Value::Count(number, noun) => count(*number, noun),
            Value::Chance(prob) if *prob < 1.0 => format!("{CHANCE}{}", percent(*prob)),
            Value::Chance(_) => String::new(),
            Value::Text(text) => text.clone(),
            Value::Part { text, present: true } => self.fill(text),
            Value::Part { present: false, .. } => String::new(),
            Value::Delay(timed) => count(i64::from(rules.timed[usize::from(*timed)].timer), "tick"),
            Value::Planned(timed) => by_the_clock(self.analysis, &rules.timed[usize::from(*timed)]),
        }
    }

    fn name(&self, stype: SpriteType) -> &str {
        self.analysis.game().name(stype)
    }
}
