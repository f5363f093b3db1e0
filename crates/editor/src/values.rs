//! The kinds of values that parameters accept, and the possible values of enumerable kinds.

use engine::{ParameterKind, SpriteClass, effect_parameters};

/// The owner of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Owner<'a> {
    /// A game's first line.
    Game,
    /// A sprite type of the given class, which may be inherited.
    Sprite(Option<SpriteClass>),
    /// An effect, identified by its keyword. If the effect schedules a different effect, the second keyword
    /// identifies that effect.
    Effect(&'a str, Option<&'a str>),
    /// A termination, identified by its class.
    Termination(&'a str),
    /// A parameter of a `GameSpace`.
    Parameter,
    /// A line to which no owner can be assigned, such as a section name or an incomplete interaction.
    Nobody,
}

/// The kind of a parameter's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Sprite type names, separated by commas.
    Sprites,
    /// An effect keyword.
    Effect,
    /// The word `True` or `False`.
    Flag,
    /// The word `UP`, `DOWN`, `LEFT`, `RIGHT` or `NONE`.
    Direction,
    /// A colour name.
    Color,
    /// The word `GRID` or `CONT`.
    Physics,
    /// A value of any other kind.
    Open,
}

/// The parameters of the first line.
pub(crate) const HEADER: [&str; 5] = ["square_size", "key_handler", "no_players", "no_counters", "obs"];

/// The parameters that every effect accepts.
pub(crate) const OF_EFFECTS: [&str; 9] = [
    "scoreChange",
    "applyScore",
    "repeat",
    "enabled",
    "inBatch",
    "counter",
    "counterElse",
    "count",
    "countElse",
];

/// The parameters of effects that run on a timer.
pub(crate) const OF_CLOCKS: [&str; 3] = ["timer", "repeating", "nextExecution"];

/// The parameters that every termination accepts.
pub(crate) const OF_TERMINATIONS: [&str; 4] = ["limit", "win", "count_score", "canEnd"];

/// The parameters on a ParameterSet line.
pub(crate) const OF_PARAMETERS: [&str; 3] = ["values", "value", "string"];

/// Returns the parameters that a termination accepts in addition to the parameters of all terminations.
pub(crate) fn of_termination(class: &str) -> &'static [&'static str] {
    match class {
        "SpriteCounter" | "SpriteCounterMore" => &["stype"],
        "MultiSpriteCounter" | "StopCounter" => &["stype1", "stype2", "stype3", "min"],
        "MultiSpriteCounterSubTypes" => &["stype1", "subTypesNum"],
        "Timeout" => &["use_counter", "compare", "limits"],
        _ => &[],
    }
}

/// Returns the kind of a parameter's value, or `None` if the parameter is unknown.
pub(crate) fn kind(owner: Owner<'_>, key: &str) -> Option<Kind> {
    match owner {
        Owner::Game => HEADER.contains(&key).then_some(match key {
            "obs" => Kind::Sprites,
            _ => Kind::Open,
        }),
        Owner::Sprite(class) => of_sprite(class, key),
        Owner::Effect(keyword, planned) => of_effect(keyword, planned, key),
        Owner::Termination(_) => of_line(key).or(match key {
            "win" | "count_score" | "canEnd" | "min" | "use_counter" | "compare" => Some(Kind::Flag),
            "limit" | "limits" | "subTypesNum" => Some(Kind::Open),
            _ => None,
        }),
        Owner::Parameter => OF_PARAMETERS.contains(&key).then_some(Kind::Open),
        Owner::Nobody => of_line(key),
    }
}

/// Returns the kind of a parameter that refers to sprites, and may appear on lines of any kind; `None` for any other
/// parameter.
fn of_line(key: &str) -> Option<Kind> {
    (key.starts_with("stype") || ["ammo", "spawnBehind", "resource_name"].contains(&key))
        .then_some(Kind::Sprites)
}

fn of_sprite(class: Option<SpriteClass>, key: &str) -> Option<Kind> {
    let own = class.is_some_and(|class| class.parameters().contains(&key));
    let known = own || class.is_none() || engine::SPRITE_PARAMETERS.contains(&key);
    of_line(key).or(known.then_some(match key {
        "is_oriented" | "rotateInPlace" | "is_static" | "only_active" | "stationary" | "solid" | "portal"
        | "is_npc" | "is_resource" | "is_avatar" | "is_from_avatar" | "isFirstTick" | "on_ground"
        | "singleton" | "is_stochastic" | "draw_arrow" | "autotiling" | "hidden" | "invisible"
        | "airsteering" | "randomTarget" | "fleeing" => Kind::Flag,
        "orientation" | "facing_dir" | "spawnorientation" => Kind::Direction,
        "color" => Kind::Color,
        "physicstype" => Kind::Physics,
        _ => Kind::Open,
    }))
}

fn of_effect(keyword: &str, planned: Option<&str>, key: &str) -> Option<Kind> {
    let own = [Some(keyword), planned].into_iter().flatten().flat_map(effect_parameters);
    let found = own.into_iter().find(|(name, _)| *name == key).map(|(_, kind)| kind);
    match (found, key) {
        (Some(ParameterKind::Sprite | ParameterKind::OptionalSprite | ParameterKind::Sprites), _)
        | (_, "itype") => Some(Kind::Sprites),
        (Some(ParameterKind::Effect | ParameterKind::Planned), _) => Some(Kind::Effect),
        (Some(ParameterKind::Flag), _) => Some(Kind::Flag),
        (
            Some(
                ParameterKind::Int
                | ParameterKind::Number
                | ParameterKind::Scores
                | ParameterKind::TypeNumber,
            ),
            _,
        ) => Some(Kind::Open),
        (None, "applyScore" | "enabled" | "inBatch" | "count" | "countElse" | "repeating") => {
            Some(Kind::Flag)
        }
        (None, key) => (OF_EFFECTS.contains(&key) || OF_CLOCKS.contains(&key)).then_some(Kind::Open),
    }
}

/// Returns all values of an enumerable kind.
pub(crate) fn values(kind: Kind) -> &'static [&'static str] {
    match kind {
        Kind::Flag => &["True", "False"],
        Kind::Direction => &["UP", "DOWN", "LEFT", "RIGHT", "NONE"],
        Kind::Physics => &["GRID", "CONT"],
        Kind::Color => &COLORS,
        Kind::Sprites | Kind::Effect | Kind::Open => &[],
    }
}

/// The colour names.
pub const COLORS: [&str; 20] = [
    "GREEN",
    "BLUE",
    "RED",
    "GRAY",
    "WHITE",
    "BROWN",
    "BLACK",
    "ORANGE",
    "YELLOW",
    "PINK",
    "GOLD",
    "LIGHTRED",
    "LIGHTORANGE",
    "LIGHTBLUE",
    "LIGHTGREEN",
    "DARKGREEN",
    "LIGHTYELLOW",
    "LIGHTGRAY",
    "DARKGRAY",
    "DARKBLUE",
];

#[cfg(test)]
mod tests {
    use super::*;
    use engine::{Game, SPRITE_PARAMETERS};

    /// Returns `true` if the engine accepts a value for a class parameter.
    fn takes(class: SpriteClass, key: &str, value: &str) -> bool {
        let name = class.name();
        let source = format!(
            "BasicGame\n SpriteSet\n  x > {name} {key}={value}\n LevelMapping\n InteractionSet\n TerminationSet\n"
        );
        let problems = match Game::from_source(&source) {
            Ok(_) => return true,
            Err(problems) => problems.0,
        };
        !problems.iter().any(|problem| ["wrong-type", "unknown-parameter"].contains(&problem.code))
    }

    #[test]
    fn the_engine_takes_what_is_listed_and_nothing_else() {
        for &class in SpriteClass::ALL {
            for key in SPRITE_PARAMETERS.iter().copied().chain(class.parameters()) {
                let kind = kind(Owner::Sprite(Some(class)), key).unwrap();
                for value in values(kind) {
                    assert!(takes(class, key, value), "{} {key}={value}", class.name());
                }
                // An image can have any name, and some classes accept sprite names that they never read.
                let open = ["img", "orientedImg"].contains(&key) || kind == Kind::Sprites;
                for other in ["True", "UP", "PINK"].into_iter().filter(|_| !open) {
                    let listed = values(kind).contains(&other);
                    assert_eq!(takes(class, key, other), listed, "{} {key}={other}", class.name());
                }
            }
        }
    }

    #[test]
    fn terminations_take_what_is_listed() {
        for class in engine::TERMINATIONS {
            for key in OF_TERMINATIONS.iter().chain(of_termination(class)) {
                assert!(kind(Owner::Termination(class), key).is_some(), "{class} {key}");
                let source = format!(
                    "BasicGame\n SpriteSet\n  x > Immovable\n LevelMapping\n InteractionSet\n TerminationSet\n  {class} {key}=x\n"
                );
                let problems = Game::from_source(&source).map_or_else(|all| all.0, |_| Vec::new());
                let unknown = problems.iter().any(|problem| problem.code == "unknown-parameter");
                assert!(!unknown, "{class} {key}");
            }
        }
    }
}
