//! Tests that rethemed games play like the original games.

use super::{corpus, generated, play_alike};
use base::Seed;
use engine::describe::plural;
use engine::{Description, Game, syntax};
use generators::games::Rethemed;
use std::collections::BTreeSet;

fn seed() -> Seed {
    Seed::from_text("retold")
}

fn game(source: &str) -> Game {
    Game::from_source(source).unwrap_or_else(|problems| panic!("{problems}"))
}

/// Returns the words of a name as they appear in texts.
fn spaced(name: &str) -> String {
    let word = |letter: char| {
        if letter.is_ascii_uppercase() {
            format!(" {}", letter.to_ascii_lowercase())
        } else {
            letter.to_string()
        }
    };
    name.chars().map(word).collect()
}

/// Adds the indefinite article.
fn one(noun: &str) -> String {
    format!("{} {noun}", if noun.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" })
}

/// Capitalises the first letter.
fn capital(text: &str) -> String {
    text[..1].to_uppercase() + &text[1..]
}

/// Checks that no text contains a name from the original game.
fn forgets(name: &str, game: &Game, rethemed: &Rethemed) {
    let text = syntax::print(&rethemed.description);
    let texts = [text.as_str(), &rethemed.title, &rethemed.summary, &rethemed.goal];
    for old in game.description().own_names() {
        let told = |text: &&str| {
            text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').any(|word| word == old)
        };
        assert!(old.len() < 3 || !texts.iter().any(told), "{name}: {old} is told\n{texts:?}");
    }
    assert!(!text.contains('#') && !text.contains("img="), "{name}\n{text}");
    for sentence in [&rethemed.summary, &rethemed.goal] {
        assert!(sentence.ends_with('.') && sentence.matches('.').count() == 1, "{name}: {sentence}");
    }
}

fn check(name: &str, game: &Game, levels: &[String]) -> Rethemed {
    let seed = seed().child(name, 0);
    let rethemed = Rethemed::of(game, seed).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!(rethemed, Rethemed::of(game, seed).unwrap());
    let text = syntax::print(&rethemed.description);
    let twin = Game::from_source(&text).unwrap_or_else(|problems| panic!("{name}: {problems}\n{text}"));
    assert_eq!(twin.warnings().len(), game.warnings().len(), "{name}\n{text}");
    play_alike(name, game, &twin, levels, |level| rethemed.level(level));
    forgets(name, game, &rethemed);
    let colors = |description: &Description| {
        let lines = description.sprite_lines().into_iter().flat_map(|(_, line)| &line.params);
        let colors = lines.filter(|param| param.key.text == "color");
        colors.map(|param| param.value.text.clone()).collect::<BTreeSet<String>>().len()
    };
    assert!(colors(&rethemed.description) >= colors(game.description()), "{name}\n{text}");
    rethemed
}

#[test]
fn corpus_games_play_alike_under_other_names() {
    let (mut kept, mut all) = (0, 0);
    for (name, source, levels) in corpus() {
        let game = game(&source);
        let rethemed = check(&name, &game, &levels);
        // A different seed gives different names, except for general names.
        let other = Rethemed::of(&game, seed().child(&name, 1)).unwrap();
        let names = BTreeSet::from_iter(rethemed.description.own_names());
        let others = BTreeSet::from_iter(other.description.own_names());
        kept += names.intersection(&others).count();
        all += names.len();
    }
    assert!(kept * 5 < all, "{kept} of {all} names are drawn again");
}

#[test]
fn generated_games_play_alike_under_other_names() {
    for (name, source, levels) in generated() {
        check(&name, &Game::compile(&source).unwrap(), &levels);
    }
}

const ORCHARD: &str = "BasicGame # secret
  SpriteSet
    lawn > Immovable color=GREEN
    wall > Immovable
    fruit >
      pear > Immovable color=YELLOW img=pear
      plum > Immovable color=BLUE
    snail > Chaser stype=picker
    picker > MovingAvatar
  LevelMapping
    . > lawn
    p > lawn pear
    q > lawn plum
    s > lawn snail
    A > lawn picker
  InteractionSet
    picker wall > stepBack
    fruit picker > killSprite scoreChange=1
    picker snail > killSprite
  TerminationSet
    SpriteCounter stype=picker win=False
    SpriteCounter stype=fruit win=True
";

#[test]
fn texts_follow_from_the_rules() {
    let game = game(ORCHARD);
    let rethemed = Rethemed::of(&game, seed()).unwrap();
    let twin = Game::compile(&rethemed.description).unwrap();
    let name = |old: &str| spaced(twin.name(game.sprite_type(old).unwrap()));
    let [hero, pear, plum, snail] = ["picker", "pear", "plum", "snail"].map(name);
    let summary = format!("has to gather {} and {}; beware of the {snail}.", plural(&pear), plural(&plum));
    assert!(rethemed.summary.ends_with(&summary), "{}", rethemed.summary);
    assert!(rethemed.summary.starts_with(&capital(&one(&hero))), "{}", rethemed.summary);
    assert_eq!(rethemed.goal, format!("You win when no {pear} and no {plum} is left."));
    // The level keeps its floor, its avatar, and a wall without its own line in the LevelMapping.
    let level = rethemed.level("wwww\nwA.w\nwpsw\n");
    assert!(level.starts_with("wwww\nwA.w\nw") && !level.contains(['p', 's']), "{level}");
}

/// Parts of compounds get the names of the types that they refer to, and directions stay.
#[test]
fn compounds_are_named_by_their_parts() {
    let source = ORCHARD
        .replace("fruit >\n", "fruitUp > Immovable\n    fruitDown > Immovable\n    fruit >\n")
        .replace(
            "picker > MovingAvatar",
            "picker > MovingAvatar\n    pearPicker > MovingAvatar\n    oddPicker > MovingAvatar\n    settledPear > Immovable",
        )
        .replace("picker snail >", "picker pear > transformTo stype=pearPicker\n    picker snail >");
    let game = game(&source);
    let rethemed = Rethemed::of_compounds(&game, seed()).unwrap();
    let twin = Game::compile(&rethemed.description).unwrap();
    let name = |old: &str| twin.name(game.sprite_type(old).unwrap()).to_owned();
    let both = name("pear") + &capital(&name("picker"));
    assert_eq!(name("pearPicker"), both);
    assert!(!name("oddPicker").contains(&capital(&name("picker"))), "{}", name("oddPicker"));
    assert_eq!(name("settledPear"), "settled".to_owned() + &capital(&name("pear")));
    let [up, down] = ["fruitUp", "fruitDown"].map(name);
    assert_eq!(up.strip_suffix("Up"), down.strip_suffix("Down"), "{up} {down}");
    let other = Rethemed::of(&game, seed()).unwrap();
    assert!(!syntax::print(&other.description).contains(&both));
}

/// Games with the maximum numbers of types and characters get a word and a character for each.
#[test]
fn crowded_games_have_enough_words() {
    let symbols: Vec<char> = ('!'..='~').filter(|c| !"#wA".contains(*c)).collect();
    let sprites: String = (0..120).map(|number| format!("    p{number} > Immovable\n")).collect();
    let mapping: String =
        symbols.iter().enumerate().map(|(at, symbol)| format!("    {symbol} > p{at}\n")).collect();
    let rules: String = (0..120).map(|number| format!("    p{number} avatar > killSprite\n")).collect();
    let source = format!(
        "BasicGame\n  SpriteSet\n{sprites}    avatar > MovingAvatar\n  LevelMapping\n{mapping}  InteractionSet\n    avatar wall > stepBack\n{rules}  TerminationSet\n    SpriteCounter stype=p1 win=True\n"
    );
    let row: String = symbols.iter().collect();
    check("crowd", &game(&source), &[format!("A{row}w\n")]);
}
