//! Parameter values: converts text to the field's type (`spec/01` §1.10).

use crate::diagnostic::{Diagnostic, Span, nearest};
use crate::limits::MAX_PROBLEMS;
use crate::meanings::Place;
use crate::numbers::geometry::Direction;
use crate::rules::class::SpriteClass;
use crate::rules::constants::{COLORS, Constant, constant, direction_names};
use crate::rules::traits::Traits;
use crate::syntax::{Literal, Param, literal};

/// A converted value, not yet checked against the field's type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Value<'a> {
    Int(i32),
    Double(f64),
    Bool(bool),
    Direction(Direction),
    Color([u8; 3]),
    Text(&'a str),
    Unusable,
}

/// Converts a value to the first type that fits, in the reference's order: constant, integer, double,
/// boolean, text.
pub(super) fn convert<'a>(key: &str, text: &'a str) -> Value<'a> {
    match constant(text) {
        Some(Constant::Direction(direction)) => return Value::Direction(direction),
        Some(Constant::Int(value)) => return Value::Int(value),
        Some(Constant::Color(rgb)) => return Value::Color(rgb),
        Some(Constant::Unusable) => return Value::Unusable,
        None => {}
    }
    let is = |name: &str| key.eq_ignore_ascii_case(name);
    if is("scoreChange") || is("scoreChangeIfKilled") {
        return Value::Text(text);
    }
    match literal(text) {
        Literal::Int(value) => Value::Int(value),
        Literal::Double(value) => Value::Double(value),
        Literal::Bool(value) if !(is("win") || is("hidden") || is("invisible")) => Value::Bool(value),
        Literal::Bool(_) | Literal::Text => Value::Text(text),
    }
}

/// Returns `true` if a value looks like a name rather than a number, a colour or the like.
pub(super) fn is_name(text: &str) -> bool {
    matches!(convert("", text), Value::Text(_))
}

/// A field's type, with a description for messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Expected {
    Int,
    Number,
    Bool,
    Direction,
    Color,
    Text,
}

impl Expected {
    fn words(self) -> &'static str {
        match self {
            Expected::Int => "a whole number",
            Expected::Number => "a number",
            Expected::Bool => "`True` or `False`",
            Expected::Direction => "a direction: UP, DOWN, LEFT, RIGHT or NONE",
            Expected::Color => "the name of a colour, such as RED or LIGHTBLUE",
            Expected::Text => "a name",
        }
    }
}

/// Returns the diagnostic for a value of the wrong type. The reference silently ignores such a value.
pub(super) fn wrong_type(param: &Param, expected: Expected) -> Diagnostic {
    let value = param.value.text.as_str();
    let message = format!("`{}` takes {}, not `{value}`", param.key.text, expected.words());
    let problem = Diagnostic::error("wrong-type", param.value.span, message);
    let fixed = match (expected, convert("", value)) {
        (Expected::Int, Value::Double(double)) => Some(format!("{}", double as i32)),
        (Expected::Int, _) => leading_number(value).map(str::to_owned),
        (Expected::Number, _) => leading_number(value).map(str::to_owned),
        (Expected::Bool, Value::Int(int)) => Some(if int == 0 { "False".into() } else { "True".into() }),
        (Expected::Bool, _) => match value.to_lowercase().as_str() {
            "yes" | "on" | "y" | "t" => Some("True".to_owned()),
            "no" | "off" | "n" | "f" => Some("False".to_owned()),
            _ => nearest(value, ["True", "False"]).map(str::to_owned),
        },
        (Expected::Direction, _) => nearest(value, direction_names()).map(str::to_owned),
        (Expected::Color, _) => nearest(value, COLORS.iter().map(|(name, _)| *name)).map(str::to_owned),
        _ => None,
    };
    let key = param.key.text.as_str();
    match fixed {
        Some(fixed) => problem.help(format!("write `{key}={fixed}`")).replace(param.value.span, &fixed),
        None => problem.help(format!(
            "write `{key}=` and {}; the reference engine ignores any other value",
            expected.words()
        )),
    }
}

/// Returns the diagnostic for a missing parameter, which should name something that the subject needs.
pub(super) fn missing_name(subject: &str, span: Span, key: &str, thing: &str) -> Diagnostic {
    let message = format!("{subject} needs `{key}=`, the name of {thing}");
    Diagnostic::error("missing-parameter", span, message).help(format!("add `{key}=` and the name"))
}

/// Returns the number at the start of a value, such as `5` in `5x`; `None` if the value does not start with a number.
fn leading_number(value: &str) -> Option<&str> {
    let end = value.find(|c: char| !(c.is_ascii_digit() || c == '-')).unwrap_or(value.len());
    Some(&value[..end]).filter(|number| number.parse::<i32>().is_ok())
}

/// The parameters that every sprite accepts, regardless of its class. Parameters that only affect images are
/// read and ignored.
pub const BASE: &[&str] = &[
    "speed",
    "cooldown",
    "physicstype",
    "orientation",
    "is_oriented",
    "rotateInPlace",
    "is_static",
    "only_active",
    "stationary",
    "mass",
    "gravity",
    "friction",
    "max_speed",
    "jump_strength",
    "solid",
    "wMult",
    "hMult",
    "healthPoints",
    "maxHealthPoints",
    "limitHealthPoints",
    "timeToLive",
    "singleton",
    "portal",
    "is_npc",
    "is_resource",
    "is_avatar",
    "hidden",
    "invisible",
    "is_stochastic",
    "rotation",
    "img",
    "orientedImg",
    "color",
    "shrinkfactor",
    "autotiling",
    "randomtiling",
    "frameRate",
    "draw_arrow",
    "is_from_avatar",
    "lastmove",
    "isFirstTick",
    "on_ground",
];

/// Fields of the reference that a parameter can set without effect, because they are overwritten or only used
/// for drawing.
const BOOK_KEEPING: &[&str] =
    &["spriteID", "bucket", "bucketSharp", "name", "images", "frameRemaining", "currentFrame"];

/// Returns `true` if sprites of the class accept a parameter.
pub(super) fn takes(class: SpriteClass, key: &str) -> bool {
    BASE.contains(&key) || BOOK_KEEPING.contains(&key) || class.parameters().contains(&key)
}

/// Returns the diagnostic for a parameter that the class does not accept. `found` is the number of earlier
/// problems.
pub(super) fn unknown_parameter(class: SpriteClass, param: &Param, found: usize) -> Diagnostic {
    let key = param.key.text.as_str();
    let message = format!("{} has no parameter `{key}`", class.name());
    let problem = Diagnostic::error("unknown-parameter", param.key.span, message);
    let problem = problem.help(format!("remove the parameter: {} does not use it", class.name()));
    let problem = problem.mean_after(
        found,
        Place::SpriteParameter,
        key,
        BASE.iter().copied().chain(class.parameters()),
    );
    if found < MAX_PROBLEMS { problem.or_remove(param.span(), key) } else { problem }
}

/// Sets one class parameter in a sprite type's traits. The caller resolves sprite names (`stype`, `ammo`).
pub(super) fn set_trait(class: SpriteClass, traits: &mut Traits, param: &Param) -> Result<(), Diagnostic> {
    let key = param.key.text.as_str();
    if BOOK_KEEPING.contains(&key) {
        let message = format!("`{key}` is set by the engine");
        let problem =
            Diagnostic::error("bad-parameter", param.key.span, message).help("remove the parameter");
        return Err(problem.remove(param.span(), key));
    }
    let value = convert(key, &param.value.text);
    let fail = |expected| wrong_type(param, expected);
    let int = || if let Value::Int(int) = value { Ok(int) } else { Err(fail(Expected::Int)) };
    let number = || match value {
        Value::Int(int) => Ok(f64::from(int)),
        Value::Double(double) => Ok(double),
        _ => Err(fail(Expected::Number)),
    };
    let boolean = || if let Value::Bool(bool) = value { Ok(bool) } else { Err(fail(Expected::Bool)) };
    let direction = || if let Value::Direction(d) = value { Ok(d) } else { Err(fail(Expected::Direction)) };
    // `hidden` and `invisible` are lists with one entry per player, but this engine has only one player.
    let switch = || {
        let text = param.value.text.as_str();
        let first = text.split(',').next().unwrap_or_default();
        if first.eq_ignore_ascii_case("true") || first.eq_ignore_ascii_case("false") {
            Ok(first.eq_ignore_ascii_case("true"))
        } else {
            Err(fail(Expected::Bool))
        }
    };
    match key {
        "speed" => traits.speed = number()?,
        "cooldown" => traits.cooldown = int()?,
        "physicstype" => {
            let physics = int()?;
            (traits.continuous, traits.off_grid) = (physics == 1, physics != 0);
            if !(0..=1).contains(&physics) {
                let message = format!("`physicstype` takes GRID or CONT, not `{}`", param.value.text);
                let problem = Diagnostic::error("wrong-type", param.value.span, message);
                let problem = problem.help("write `physicstype=GRID`, or leave it out");
                return Err(problem.replace(param.value.span, "GRID"));
            }
        }
        "orientation" => traits.orientation = direction()?,
        "is_oriented" => traits.is_oriented = boolean()?,
        "rotateInPlace" => traits.rotate_in_place = boolean()?,
        "is_static" => traits.is_static = boolean()?,
        "only_active" => traits.only_active = boolean()?,
        "stationary" => traits.stationary = boolean()?,
        "solid" => traits.solid = boolean()?,
        "wMult" => traits.width_factor = number()?,
        "hMult" => traits.height_factor = number()?,
        "healthPoints" => traits.health = int()?,
        "maxHealthPoints" => traits.max_health = int()?,
        "limitHealthPoints" => traits.limit_health = int()?,
        "timeToLive" => traits.time_to_live = int()?,
        "portal" => traits.portal = boolean()?,
        "is_npc" => traits.is_npc = boolean()?,
        "is_resource" | "is_avatar" => {
            let (field, fits) = match key {
                "is_avatar" => (&mut traits.is_avatar, class.is_avatar()),
                _ => (&mut traits.is_resource, class.is_a(SpriteClass::Resource)),
            };
            *field = boolean()?;
            if *field != fits {
                let message = format!("`{key}` does not fit the class {}", class.name());
                return Err(
                    Diagnostic::error("bad-parameter", param.span(), message).help("choose another class")
                );
            }
        }
        "is_from_avatar" => traits.is_from_avatar = boolean()?,
        "lastmove" => traits.last_move = int()?,
        "isFirstTick" => traits.is_first_tick = boolean()?,
        "on_ground" => traits.on_ground = boolean()?,
        // Only text is used: a number, a boolean or a constant is dropped.
        "orientedImg" => traits.oriented_image = matches!(value, Value::Text(_)),
        "singleton" | "is_stochastic" | "draw_arrow" | "autotiling" => drop(boolean()?),
        "hidden" => traits.hidden = switch()?,
        "invisible" => traits.invisible = switch()?,
        "mass" => traits.mass = number()?,
        "gravity" => traits.gravity = number()?,
        "friction" => traits.friction = number()?,
        "max_speed" => traits.max_speed = number()?,
        "jump_strength" => traits.jump_strength = number()?,
        "rotation" => traits.rotation = number()?,
        "angle_diff" => traits.angle_diff = number()?,
        "facing" => traits.facing = number()?,
        "facing_dir" => traits.facing_dir = direction()?,
        "last_block_time" => traits.last_block_time = int()?,
        "ground_speedup_factor" => traits.ground_speedup = number()?,
        "air_slowdown_factor" => traits.air_slowdown = number()?,
        "airsteering" => traits.air_steering = boolean()?,
        "probability" => traits.probability = number()?,
        "epsilon" => traits.epsilon = number()?,
        "randomTarget" => traits.random_target = boolean()?,
        "shrinkfactor" | "randomtiling" => drop(number()?),
        "frameRate" => drop(int()?),
        "color" => match value {
            Value::Color(rgb) => traits.color = Some(rgb),
            Value::Unusable => {}
            _ => return Err(fail(Expected::Color)),
        },
        "limit" => traits.limit = int()?,
        "value" => traits.value = int()?,
        "age" => traits.age = int()?,
        "spreadprob" => traits.spread_probability = number()?,
        "cons" => traits.cons = int()?,
        "fleeing" => traits.fleeing = boolean()?,
        // The reference's field has 32 bits.
        "maxDistance" => traits.max_distance = f64::from(int()? as f32),
        "prob" => traits.prob = number()?,
        "total" => traits.total = int()?,
        "spawnorientation" => traits.spawn_orientation = direction()?,
        "counter" => drop(int()?),
        "minAmmo" => traits.min_ammo = int()?,
        "ammoCost" => traits.ammo_cost = int()?,
        "stype" | "stype1" | "stype2" | "stypes" | "stypeMissile" | "spawnBehind" | "ammo" | "img"
        | "resource_name" => {}
        _ => unreachable!("every parameter of the tables is matched: {key}"),
    }
    match value {
        // The reference accepts such a value.
        Value::Double(double) if !double.is_finite() => Err(fail(Expected::Number)),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(class: SpriteClass, key: &str, value: &str) -> Result<Traits, &'static str> {
        let mut traits = Traits::of_class(class);
        set_trait(class, &mut traits, &Param::new(key, value)).map_err(|problem| problem.code)?;
        Ok(traits)
    }

    #[test]
    fn every_parameter_of_every_class_is_matched() {
        for &class in SpriteClass::ALL {
            for key in BASE.iter().copied().chain(class.parameters()) {
                let _ = set(class, key, "1");
            }
        }
    }

    #[test]
    fn values_must_fit_the_field() {
        assert_eq!(set(SpriteClass::Missile, "speed", "0.5").unwrap().speed, 0.5);
        assert_eq!(set(SpriteClass::Missile, "cooldown", "2.0").unwrap_err(), "wrong-type");
        assert!(!takes(SpriteClass::Missile, "sped") && takes(SpriteClass::Missile, "speed"));
        assert_eq!(set(SpriteClass::Missile, "orientation", "up").unwrap_err(), "wrong-type");
        assert_eq!(set(SpriteClass::Missile, "orientation", "DUP").unwrap().orientation, Direction::UP);
        assert_eq!(set(SpriteClass::Missile, "singleton", "1").unwrap_err(), "wrong-type");
        assert!(set(SpriteClass::Passive, "hidden", "TRUE").unwrap().hidden);
    }
}
