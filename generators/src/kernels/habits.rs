//! The habits of a game's author: points, colours and clocks, which a kernel leaves open.

use base::Seed;
use engine::Description;
use engine::syntax::{InteractionLine, Param};

/// The habits of a game's author. They change how the game looks and counts points, but not its dilemma.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Habits {
    /// The factor by which all points are multiplied.
    pub(crate) unit: u32,
    /// The player's colour, unless the floor or the walls have the same one.
    pub(crate) hero: &'static str,
    /// `true` if the game always has a tick limit, and not only if it would not end without a limit.
    pub(crate) has_clock: bool,
}

/// The colours of players.
const HEROES: [&str; 8] = ["BLUE", "BLUE", "BLUE", "GREEN", "GREEN", "YELLOW", "WHITE", "PINK"];
/// The classes of types that stay where they are.
pub(super) const STILL: [&str; 6] = ["Immovable", "Passive", "Resource", "Door", "Conveyor", "Portal"];
impl Habits {
    pub(crate) fn draw(seed: Seed) -> Habits {
        let of = |name| seed.child(name, 0).sampler();
        let unit = *of("unit").choose(&[1, 1, 1, 2, 5, 10]);
        let hero = of("hero").choose(&HEROES);
        Habits { unit, hero, has_clock: of("clock").ratio(1, 4) }
    }

    /// Applies the habits to a game's rules.
    pub(crate) fn apply(&self, description: &mut Description) {
        for line in &mut description.interactions {
            drop_penalty_of_death(line);
            for param in line.params.iter_mut().filter(|param| param.key.text == "scoreChange") {
                if let Ok(points) = param.value.text.parse::<i64>() {
                    param.value = (points * i64::from(self.unit)).to_string().as_str().into();
                }
            }
        }
    }
}

/// Removes the penalty for the hero's death, because that death ends the game. Penalties for actions that can be
/// repeated are the price of these actions, and stay.
fn drop_penalty_of_death(line: &mut InteractionLine) {
    let is_penalty = |param: &Param| param.key.text == "scoreChange" && param.value.text.starts_with('-');
    if line.first.text == "hero" && line.effect.text.starts_with("kill") {
        line.params.retain(|param| !is_penalty(param));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::syntax::{parse, print_bare};

    const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable\n    plum > Immovable\n    foe >\n      cat > Chaser stype=hero\n      dog > Chaser stype=plum\n    hero > ShootAvatar stype=shot\n    shot > Missile\n  LevelMapping\n    p > plum\n  InteractionSet\n    hero wall cat > stepBack\n    foe wall > stepBack\n    shot wall > killSprite\n    plum hero > killSprite scoreChange=2\n    hero foe > killSprite scoreChange=-1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n";

    fn applied(source: &str, unit: u32) -> String {
        let mut description = parse(source).0;
        Habits { unit, hero: HEROES[0], has_clock: true }.apply(&mut description);
        print_bare(&description)
    }

    #[test]
    fn points_have_a_unit_and_a_death_costs_none() {
        let points = |unit| {
            let text = applied(GAME, unit);
            let values = text.split("scoreChange=").skip(1).map(|rest| rest.lines().next().unwrap());
            values.map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(points(10), ["20"]);
        let priced =
            GAME.replace("plum hero > killSprite scoreChange=2", "plum hero > stepBack scoreChange=-2");
        let text = applied(&priced, 1);
        assert!(text.contains("plum hero > stepBack scoreChange=-2"), "{text}");
    }
}
