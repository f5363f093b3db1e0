//! The choices that depend on an author's habits: the points, board edges, sizes and tick limits that a kernel leaves
//! open.

use super::course::Space;
use base::Seed;
use engine::Description;
use engine::syntax::{InteractionLine, Param, SpriteLine};
use std::collections::BTreeMap;

/// An author's habits in a game, drawn at random. They affect the game's appearance and scoring, but not its dilemma.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Habits {
    /// The factor by which all points are multiplied.
    pub(crate) unit: u32,
    pub(crate) edge: Edge,
    pub(crate) space: Space,
    /// The player's colour, unless the floor or walls have the same colour.
    pub(crate) hero: &'static str,
    /// `true` if the game always has a tick limit. Otherwise, it has a limit only if it might never end without one.
    pub(crate) has_clock: bool,
}

/// The board's border.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Edge {
    /// A ring of walls.
    Walls,
    /// Only the edge of the screen, if the rules allow it.
    Screen,
}

/// The colours available to avatars.
const HEROES: [&str; 8] = ["BLUE", "BLUE", "BLUE", "GREEN", "GREEN", "YELLOW", "WHITE", "PINK"];
/// The classes of stationary types.
pub(super) const STILL: [&str; 6] = ["Immovable", "Passive", "Resource", "Door", "Conveyor", "Portal"];
/// The wall effects that return a sprite to the screen or remove it.
const ENDING: [&str; 2] = ["stepBack", "killSprite"];
/// The wall effects that may precede an effect in `ENDING`, and that need no partner.
const TURNING: [&str; 1] = ["reverseDirection"];
/// The effects that can leave a sprite off the screen, because they move or create a sprite other than the one that
/// moved.
const ASTRAY: [&str; 6] = ["bounceForward", "undoAll", "spawnAbove", "spawnBelow", "spawnLeft", "spawnRight"];

impl Habits {
    pub(crate) fn draw(seed: Seed) -> Habits {
        let of = |name| seed.child(name, 0).sampler();
        let unit = *of("unit").choose(&[1, 1, 1, 2, 5, 10]);
        let edge = if of("edge").ratio(1, 4) { Edge::Screen } else { Edge::Walls };
        let hero = of("hero").choose(&HEROES);
        Habits { unit, edge, space: Space::draw(&mut of("space")), hero, has_clock: of("clock").ratio(1, 4) }
    }

    /// Applies the habits to a game's rules. Returns the kind of edge that the game's levels have.
    pub(crate) fn apply(&self, description: &mut Description) -> Edge {
        for line in &mut description.interactions {
            drop_penalty_of_death(line);
            for param in line.params.iter_mut().filter(|param| param.key.text == "scoreChange") {
                if let Ok(points) = param.value.text.parse::<i64>() {
                    param.value = (points * i64::from(self.unit)).to_string().as_str().into();
                }
            }
        }
        match self.edge {
            Edge::Screen if stop_at_edge(description).is_some() => Edge::Screen,
            _ => Edge::Walls,
        }
    }
}

/// Removes the penalty for the avatar's death, because that death ends the game anyway. A penalty for a repeatable
/// action is preserved as the price of that action.
fn drop_penalty_of_death(line: &mut InteractionLine) {
    let is_penalty = |param: &Param| param.key.text == "scoreChange" && param.value.text.starts_with('-');
    if line.first.text == "hero" && line.effect.text.starts_with("kill") {
        line.params.retain(|param| !is_penalty(param));
    }
}

/// Gives the screen edge the effects of walls. Returns `None` without any change if a sprite could then leave the
/// screen.
///
/// While a sprite is beyond the edge, its edge rules apply in turn, and this is repeated once per rule (spec page 03,
/// section 4.4). Only the last rule may therefore return the sprite to the screen.
fn stop_at_edge(description: &mut Description) -> Option<()> {
    if description.interactions.iter().any(|line| ASTRAY.contains(&line.effect.text.as_str())) {
        return None;
    }
    let mut stopped = BTreeMap::new();
    let mut interactions = Vec::new();
    for line in &description.interactions {
        interactions.push(line.clone());
        if line.second.iter().any(|word| word.text == "wall") {
            let effect = line.effect.text.as_str();
            let ends = ENDING.contains(&effect);
            let is_known = line.params.is_empty() && (ends || TURNING.contains(&effect));
            if !is_known || stopped.insert(line.first.text.clone(), ends) == Some(true) {
                return None;
            }
            let at_edge = InteractionLine { second: vec!["EOS".into()], ..line.clone() };
            interactions.push(InteractionLine { trivia: Default::default(), ..at_edge });
        }
    }
    let all_stop = stopped.values().all(|&ends| ends)
        && description.sprites.iter().all(|line| all_stop(line, None, false, &stopped));
    // A sprite that the avatar creates at the edge appears beyond it, so it has no position to step back to.
    let dies = |stype: &str| {
        let of_edge = |line: &&InteractionLine| line.first.text == stype && line.second[0].text == "EOS";
        let mut effects = interactions.iter().filter(of_edge).map(|line| line.effect.text.as_str());
        effects.next() == Some("killSprite") && effects.next().is_none()
    };
    let all_stop = all_stop && made_by_hero(description).all(dies);
    all_stop.then(|| description.interactions = interactions)
}

/// Returns the types that avatars create, such as shots or dropped objects.
fn made_by_hero(description: &Description) -> impl Iterator<Item = &str> {
    let is_avatar =
        |line: &&SpriteLine| line.class.as_ref().is_some_and(|class| class.text.ends_with("Avatar"));
    let avatars = description.sprite_lines().into_iter().map(|(_, line)| line).filter(is_avatar);
    let params = avatars.flat_map(|line| &line.params).filter(|param| param.key.text == "stype");
    params.map(|param| param.value.text.as_str())
}

/// Returns `true` if each moving type has edge rules, given either for the type itself or for exactly one group above
/// it.
fn all_stop(line: &SpriteLine, class: Option<&str>, above: bool, stopped: &BTreeMap<String, bool>) -> bool {
    let class = line.class.as_ref().map(|class| class.text.as_str()).or(class);
    let own = stopped.contains_key(&line.name.text);
    if own && above {
        return false;
    }
    let stops = own || above;
    if line.children.is_empty() {
        return stops || class.is_some_and(|class| STILL.contains(&class) || class == "SpawnPoint");
    }
    line.children.iter().all(|child| all_stop(child, class, stops, stopped))
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::syntax::{parse, print_bare};

    const GAME: &str = "BasicGame\n  SpriteSet\n    floor > Immovable\n    plum > Immovable\n    foe >\n      cat > Chaser stype=hero\n      dog > Chaser stype=plum\n    hero > ShootAvatar stype=shot\n    shot > Missile\n  LevelMapping\n    p > plum\n  InteractionSet\n    hero wall cat > stepBack\n    foe wall > stepBack\n    shot wall > killSprite\n    plum hero > killSprite scoreChange=2\n    hero foe > killSprite scoreChange=-1\n  TerminationSet\n    SpriteCounter stype=plum win=True\n";

    fn habits(unit: u32, edge: Edge) -> Habits {
        Habits { unit, edge, space: Space::default(), hero: HEROES[0], has_clock: true }
    }

    fn applied(source: &str, habits: Habits) -> (String, Edge) {
        let mut description = parse(source).0;
        let edge = habits.apply(&mut description);
        (print_bare(&description), edge)
    }

    #[test]
    fn everything_that_moves_stops_at_the_edge_of_the_screen() {
        let (text, edge) = applied(GAME, habits(1, Edge::Screen));
        assert_eq!(edge, Edge::Screen);
        for rule in ["hero EOS > stepBack", "foe EOS > stepBack", "shot EOS > killSprite"] {
            assert!(text.contains(rule), "{text}");
        }
        assert_eq!(text.matches("EOS").count(), 3, "{text}");
        let turned =
            GAME.replace("foe wall > stepBack", "foe wall > reverseDirection\n    foe wall > stepBack");
        let (text, edge) = applied(&turned, habits(1, Edge::Screen));
        assert_eq!((edge, text.matches("foe EOS").count()), (Edge::Screen, 2), "{text}");
    }

    #[test]
    fn rules_by_which_something_could_leave_the_screen_keep_their_walls() {
        let pushed = GAME.replace("plum hero > killSprite", "plum hero > bounceForward");
        let loose = GAME.replace("    shot wall > killSprite\n", "");
        let twice = GAME.replace("    foe wall", "    cat wall > stepBack\n    foe wall");
        let turned = GAME.replace("foe wall > stepBack", "foe wall > reverseDirection");
        let late = GAME.replace(
            "    foe wall > stepBack\n",
            "    foe wall > stepBack\n    foe wall > reverseDirection\n",
        );
        let kept = GAME.replace("shot wall > killSprite", "shot wall > stepBack");
        let priced = GAME.replace("shot wall > killSprite", "shot wall > killSprite scoreChange=-1");
        for source in [pushed, loose, twice, turned, late, kept, priced] {
            let (text, edge) = applied(&source, habits(1, Edge::Screen));
            assert_eq!(edge, Edge::Walls, "{text}");
            assert!(!text.contains("EOS"), "{text}");
        }
    }

    #[test]
    fn points_have_a_unit_and_a_death_costs_none() {
        let points = |habits| {
            let text = applied(GAME, habits).0;
            let values = text.split("scoreChange=").skip(1).map(|rest| rest.lines().next().unwrap());
            values.map(str::to_owned).collect::<Vec<_>>()
        };
        assert_eq!(points(habits(10, Edge::Walls)), ["20"]);
        let priced =
            GAME.replace("plum hero > killSprite scoreChange=2", "plum hero > stepBack scoreChange=-2");
        let text = applied(&priced, habits(1, Edge::Walls)).0;
        assert!(text.contains("plum hero > stepBack scoreChange=-2"), "{text}");
    }
}
