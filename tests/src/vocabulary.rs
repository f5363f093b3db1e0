//! The kinds of VGDL parameter values, with example values. Most of them are realistic, and some are extreme.

use crate::choices::Choices;

/// The kind of a sprite parameter's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ValueKind {
    /// An integer.
    Int,
    /// A number of ticks, rarely 0.
    Ticks,
    /// A real number.
    Number,
    /// A probability between 0 and 1.
    Probability,
    /// A size in cells.
    Size,
    /// The value `True` or `False`.
    Flag,
    /// A direction.
    Direction,
    /// The value `GRID` or `CONT`.
    Physics,
    /// A colour name.
    Color,
    /// A sprite type name.
    Sprite,
    /// The names of sprite types.
    Sprites,
    /// Text without meaning for the rules.
    Text,
    /// A value that the class fixes, so that any other value is an error.
    Fixed,
}

/// Returns a sprite parameter's kind, or `None` if the parameter does not exist.
pub fn sprite_parameter(key: &str) -> Option<ValueKind> {
    Some(match key {
        "cooldown" | "timeToLive" | "cons" | "age" | "limit" | "total" => ValueKind::Ticks,
        "healthPoints" | "maxHealthPoints" | "limitHealthPoints" | "value" | "maxDistance" | "start"
        | "counter" | "lastmove" | "minAmmo" | "ammoCost" | "last_block_time" | "frameRate" => ValueKind::Int,
        "speed"
        | "mass"
        | "gravity"
        | "friction"
        | "max_speed"
        | "jump_strength"
        | "rotation"
        | "angle_diff"
        | "facing"
        | "ground_speedup_factor"
        | "air_slowdown_factor"
        | "shrinkfactor"
        | "randomtiling" => ValueKind::Number,
        "spreadprob" | "prob" | "probability" | "epsilon" => ValueKind::Probability,
        "wMult" | "hMult" => ValueKind::Size,
        "is_oriented" | "rotateInPlace" | "is_static" | "only_active" | "stationary" | "solid"
        | "singleton" | "portal" | "is_npc" | "hidden" | "invisible" | "is_stochastic" | "draw_arrow"
        | "autotiling" | "is_from_avatar" | "isFirstTick" | "on_ground" | "airsteering" | "fleeing"
        | "randomTarget" => ValueKind::Flag,
        "orientation" | "spawnorientation" | "facing_dir" => ValueKind::Direction,
        "physicstype" => ValueKind::Physics,
        "color" => ValueKind::Color,
        "stype" | "spawnBehind" | "stypeMissile" | "resource_name" => ValueKind::Sprite,
        "stype1" | "stype2" | "stypes" | "ammo" => ValueKind::Sprites,
        "img" | "orientedImg" => ValueKind::Text,
        "is_resource" | "is_avatar" => ValueKind::Fixed,
        _ => return None,
    })
}

/// Returns an integer. One result in eight is extreme.
pub fn int(choices: &mut Choices<'_>) -> i32 {
    const TAME: [i32; 12] = [0, 1, 2, 3, 4, 5, 6, 8, 10, -1, -2, 20];
    const WILD: [i32; 6] = [i32::MAX, i32::MIN, i32::MAX - 1, -1000, 1_000_000, 1 << 16];
    if choices.once_in(8) { choices.pick(&WILD) } else { choices.pick(&TAME) }
}

/// Returns a number of ticks, which may be too large to matter in a short episode.
pub fn ticks(choices: &mut Choices<'_>) -> i32 {
    if choices.once_in(8) { int(choices) } else { choices.below(8) as i32 + 1 }
}

/// Returns a number as text. Some texts are not valid floats, and some numbers are infinite.
pub fn number(choices: &mut Choices<'_>) -> &'static str {
    const TAME: [&str; 12] = ["1", "0.5", "0", "2", "0.25", "0.1", "-1", "3.5", "10", "0.75", "5", "-0.5"];
    const WILD: [&str; 8] = ["1e300", "-1e300", "1e999", "1e-320", "-0.0", "2147483648", "1e9", "0.000001"];
    if choices.once_in(8) { choices.pick(&WILD) } else { choices.pick(&TAME) }
}

/// Returns a probability, which is rarely invalid.
pub fn probability(choices: &mut Choices<'_>) -> &'static str {
    choices.pick(&["1", "0.5", "0.1", "0.9", "0", "1.0", "0.3", "2"])
}

/// Returns a value for a parameter that does not refer to sprites. Returns `None` for kinds that refer to
/// sprites, and for [`ValueKind::Fixed`].
pub fn value(kind: ValueKind, choices: &mut Choices<'_>) -> Option<String> {
    Some(match kind {
        ValueKind::Int => int(choices).to_string(),
        ValueKind::Ticks => ticks(choices).to_string(),
        ValueKind::Number => number(choices).to_owned(),
        ValueKind::Probability => probability(choices).to_owned(),
        ValueKind::Size => choices.pick(&["1", "2", "0.5", "1.5", "0.1", "3", "0.01", "16"]).to_owned(),
        ValueKind::Flag => choices.pick(&["True", "False"]).to_owned(),
        ValueKind::Direction => {
            let names = ["RIGHT", "LEFT", "UP", "DOWN", "NONE", "NIL", "DUP"];
            choices.pick(&names).to_owned()
        }
        ValueKind::Physics => choices.pick(&["CONT", "GRID"]).to_owned(),
        ValueKind::Color => choices.pick(&["RED", "LIGHTBLUE", "GOLD"]).to_owned(),
        ValueKind::Text => choices.pick(&["dot", "a/b"]).to_owned(),
        ValueKind::Sprite | ValueKind::Sprites | ValueKind::Fixed => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::{SPRITE_PARAMETERS, SpriteClass};

    #[test]
    fn every_sprite_parameter_has_a_kind() {
        let own = SpriteClass::ALL.iter().flat_map(|class| class.parameters());
        let missing: Vec<&str> = SPRITE_PARAMETERS
            .iter()
            .copied()
            .chain(own)
            .filter(|key| sprite_parameter(key).is_none())
            .collect();
        assert_eq!(missing, Vec::<&str>::new());
    }
}
