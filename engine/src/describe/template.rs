//! Templates of the sentences about interactions, for programs that parse these sentences.

use crate::analysis::{EffectSummary, Precondition};
use crate::rules::effects::{EffectFamily, Sentence, Summary, sentences};

/// A template of the sentences in [`Guide::meetings`](super::Guide::meetings).
///
/// ```
/// use infinite_arcade_engine::describe::{Part, templates};
/// let blocks = templates().into_iter().find(|template| template.family.name() == "block").unwrap();
/// assert_eq!(blocks.parts[0], Part::First);
/// assert_eq!(blocks.parts[1], Part::Text(" cannot enter "));
/// ```
#[derive(Clone, Debug)]
pub struct Template {
    /// The parts of the sentence, in order.
    pub parts: Vec<Part>,
    /// The family of effects that the sentence describes.
    pub family: EffectFamily,
    /// The consequences of the effects that the sentence describes, with placeholders for the types.
    pub effects: Vec<EffectSummary>,
    /// The effects' condition, with placeholders for its type and amount.
    pub precondition: Precondition,
}

/// A part of a template.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Literal text.
    Text(&'static str),
    /// The sprite acted upon.
    First,
    /// The partner of the sprite acted upon.
    Second,
    /// A word that agrees with a sprite. It has one form for the player and another for all other sprites.
    Agreeing {
        /// The form for the player.
        with_you: &'static str,
        /// The form for all other sprites.
        with_it: &'static str,
    },
    /// A value other than a sprite.
    Value {
        /// The name of the value. For example, the required amount of a resource is named `least`, and the
        /// resource itself `resource`.
        name: &'static str,
        /// The text with which the value starts, if the value can be empty.
        optional_start: Option<&'static str>,
    },
}

/// Returns the templates for sentences about interactions, without duplicates.
pub fn templates() -> Vec<Template> {
    let template = |(sentence, summary): (Sentence, Summary)| {
        let mut parts = Vec::new();
        let mut rest = sentence.meeting;
        while let Some((before, after)) = rest.split_once('{') {
            let (hole, after) = after.split_once('}').expect("a hole of a template ends");
            parts.extend((!before.is_empty()).then_some(Part::Text(before)));
            parts.push(match (hole, hole.split_once(':').and_then(|(_, forms)| forms.split_once('|'))) {
                (_, Some((with_you, with_it))) => Part::Agreeing { with_you, with_it },
                ("one", None) => Part::First,
                ("two", None) => Part::Second,
                (name, None) => Part::Value { name, optional_start: sentence.optional_start(name) },
            });
            rest = after;
        }
        parts.extend((!rest.is_empty()).then_some(Part::Text(rest)));
        Template {
            parts,
            family: summary.family,
            effects: summary.effects.into_vec(),
            precondition: summary.precondition,
        }
    };
    sentences().into_iter().map(template).collect()
}
