//! Effect parameters. They are recorded from the calls that [`build`] makes, so that no second table needs to
//! be maintained.

use super::EffectFamily;
use super::build::{Arguments, Undeclared, build};
use crate::rules::SpriteType;

/// The kind of value that an effect parameter accepts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterKind {
    /// An integer.
    Int,
    /// A number.
    Number,
    /// `True` or `False`.
    Flag,
    /// A list of scores, one per player.
    Scores,
    /// The name of a required sprite type.
    Sprite,
    /// The name of an optional sprite type.
    OptionalSprite,
    /// A list of sprite type names.
    Sprites,
    /// A sprite type, given by its index in the registry.
    TypeNumber,
    /// The required keyword of an effect.
    Effect,
    /// The required keyword of an effect to schedule, which is followed by the scheduled effect's parameters.
    Planned,
}

/// Returns the parameters that an effect accepts in addition to the common parameters of all effects. Empty
/// for an unknown keyword.
pub fn effect_parameters(keyword: &str) -> Vec<(&'static str, ParameterKind)> {
    let mut recorder = Recorder::default();
    build(keyword, &mut recorder);
    recorder.asked
}

/// Arguments that record the requested parameters and return default values.
#[derive(Default)]
pub(super) struct Recorder {
    asked: Vec<(&'static str, ParameterKind)>,
    /// `true` to return values other than the defaults: flags that are `true`, negative numbers, and optional
    /// types.
    contrary: bool,
}

impl Recorder {
    pub(super) fn contrary(contrary: bool) -> Recorder {
        Recorder { contrary, ..Recorder::default() }
    }
}

impl Arguments for Recorder {
    fn int(&mut self, key: &'static str, default: i32) -> i32 {
        self.asked.push((key, ParameterKind::Int));
        if self.contrary { -1 } else { default }
    }

    fn number(&mut self, key: &'static str, default: f64) -> f64 {
        self.asked.push((key, ParameterKind::Number));
        default
    }

    fn flag(&mut self, key: &'static str, default: bool) -> bool {
        self.asked.push((key, ParameterKind::Flag));
        self.contrary || default
    }

    fn score(&mut self, key: &'static str) -> i32 {
        self.asked.push((key, ParameterKind::Scores));
        0
    }

    fn sprite(&mut self, key: &'static str) -> SpriteType {
        self.asked.push((key, ParameterKind::Sprite));
        SpriteType::NONE
    }

    fn sprite_or_none(&mut self, key: &'static str) -> SpriteType {
        self.sprite(key)
    }

    fn numbered(&mut self, key: &'static str) -> Option<SpriteType> {
        self.asked.push((key, ParameterKind::TypeNumber));
        None
    }

    fn optional_sprite(&mut self, key: &'static str, _: Undeclared) -> Option<SpriteType> {
        self.asked.push((key, ParameterKind::OptionalSprite));
        self.contrary.then_some(SpriteType::NONE)
    }

    fn sprites(&mut self, key: &'static str) -> Vec<SpriteType> {
        self.asked.push((key, ParameterKind::Sprites));
        Vec::new()
    }

    fn keyword(&mut self, key: &'static str) -> u16 {
        self.asked.push((key, ParameterKind::Effect));
        0
    }

    fn timed(&mut self) -> u16 {
        self.asked.push(("ftype", ParameterKind::Planned));
        0
    }

    fn relatives(&self, _: SpriteType) -> Box<[SpriteType]> {
        Box::default()
    }
}

impl EffectFamily {
    /// Returns the family of the effect with this keyword, or `None` for an unknown keyword.
    pub fn of(keyword: &str) -> Option<EffectFamily> {
        Some(build(keyword, &mut Recorder::default())?.summary().family)
    }
}

#[cfg(test)]
mod tests {
    use super::super::build::BUILT;
    use super::*;
    use crate::keywords::EFFECTS;

    #[test]
    fn every_keyword_has_its_row() {
        assert!(EFFECTS.is_sorted());
        assert_eq!(EFFECTS, BUILT);
    }

    #[test]
    fn parameters_are_those_that_the_effect_reads() {
        assert_eq!(effect_parameters("killSprite"), []);
        assert_eq!(
            effect_parameters("killIfOtherHasMore"),
            [
                ("resource", ParameterKind::Sprite),
                ("limit", ParameterKind::Int),
                ("subtract", ParameterKind::Flag)
            ]
        );
        assert_eq!(effect_parameters("killsprite"), []);
    }
}
