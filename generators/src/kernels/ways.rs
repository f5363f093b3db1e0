//! Obstacles for path-finding types (`PathChaser`), which a game's first line must list.

use super::habits::STILL;
use engine::Description;
use engine::syntax::{Param, SpriteLine};

/// Lists the obstacles in the game's header. They are all types that stop every path-finding type and that never move
/// or disappear, because the path map is computed only once, when a level begins (spec page 01, section 8). Games
/// without path-finding types are unchanged.
pub(crate) fn set_obstacles(description: &mut Description) {
    let mut seekers = Vec::new();
    find_seekers(&description.sprites, &[], &mut seekers);
    if seekers.is_empty() {
        return;
    }
    let interactions = &description.interactions;
    let stops = |names: &[&str], stype: &str| {
        interactions.iter().any(|line| {
            line.effect.text == "stepBack"
                && names.contains(&line.first.text.as_str())
                && line.second.iter().any(|word| word.text == stype)
        })
    };
    let stays = |stype: &str| {
        interactions.iter().all(|line| {
            let is_met = line.second.iter().any(|word| word.text == stype);
            let is_named =
                line.params.iter().any(|param| param.key.text == "stype" && param.value.text == stype);
            let goes = match line.effect.text.as_str() {
                "killBoth" => is_met,
                "killAll" | "transformToAll" => is_named,
                _ => false,
            };
            let keeps = ["killAll", "spawn", "spawnIfHasMore", "transformToAll"];
            let is_kept = line.first.text != stype || keeps.contains(&line.effect.text.as_str());
            is_kept && !goes
        })
    };
    let lines = description.sprite_lines();
    let is_still =
        |line: &SpriteLine| line.class.as_ref().is_some_and(|class| STILL.contains(&class.text.as_str()));
    let still = lines.iter().filter(|(_, line)| is_still(line)).map(|(_, line)| line.name.text.as_str());
    let obstacles = still.filter(|stype| stays(stype) && seekers.iter().all(|names| stops(names, stype)));
    let obstacles: Vec<&str> = obstacles.collect();
    let obstacles = if obstacles.is_empty() { "wall".to_owned() } else { obstacles.join(",") };
    description.header.params.push(Param::new("obs", obstacles));
}

/// Adds, for each path-finding type, the names by which rules can refer to it: its own name and the names of the groups
/// above it.
fn find_seekers<'a>(lines: &'a [SpriteLine], above: &[&'a str], seekers: &mut Vec<Vec<&'a str>>) {
    for line in lines {
        let names = [above, &[line.name.text.as_str()]].concat();
        if line.class.as_ref().is_some_and(|class| class.text == "PathChaser") {
            seekers.push(names.clone());
        }
        find_seekers(&line.children, &names, seekers);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use engine::syntax::{parse, print_bare};

    #[test]
    fn what_stops_all_seekers_and_stays_is_an_obstacle() {
        let game = "BasicGame\n  SpriteSet\n    floor > Immovable\n    wall > Immovable\n    pond > Immovable\n    gate > Immovable\n    fence > Immovable\n    lever > Immovable\n    hedge > Immovable\n    foe >\n      wolf > PathChaser stype=hero\n      fox > PathChaser stype=hero\n    hero > MovingAvatar\n  LevelMapping\n    w > wall\n  InteractionSet\n    hero wall pond fence hedge lever > stepBack\n    lever hero > transformToAll stype=fence stypeTo=floor\n    foe wall fence pond gate lever > stepBack\n    wolf hedge > stepBack\n    fence hero > killSprite\n    hero TIME > transformToAll stype=gate stypeTo=floor timer=9\n  TerminationSet\n    SpriteCounter stype=fence win=True\n";
        let mut description = parse(game).0;
        set_obstacles(&mut description);
        assert!(
            print_bare(&description).starts_with("BasicGame obs=wall,pond,lever\n"),
            "{}",
            print_bare(&description)
        );
        let mut straight = parse(&game.replace("PathChaser", "Chaser")).0;
        let before = straight.clone();
        set_obstacles(&mut straight);
        assert_eq!(straight, before);
    }
}
