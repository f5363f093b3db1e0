//! Tests games at the limits of the compiler. Their analysis is fast and needs little memory.

use super::*;
use std::fmt::Write;

/// Returns a flat family of 480 types of one class, each placed by some character.
fn family(class: &str) -> (String, String) {
    let (mut sprites, mut mapping) = ("root >\n".to_owned(), String::new());
    for number in 0..480 {
        writeln!(sprites, "  t{number} > {class}").unwrap();
    }
    let symbols = ('!'..='~').filter(|symbol| !"#A".contains(*symbol));
    for (symbol, names) in symbols.zip((0..480).collect::<Vec<_>>().chunks(8)) {
        let names: Vec<String> = names.iter().map(|number| format!("t{number}")).collect();
        writeln!(mapping, "{symbol} > {}", names.join(" ")).unwrap();
    }
    if class != "MovingAvatar" {
        sprites += "hero > MovingAvatar\n";
        mapping += "A > hero\n";
    }
    (sprites, mapping)
}

#[test]
fn everything_does_everything_to_everything() {
    for (class, hero) in [("MovingAvatar", "t7"), ("Passive", "hero"), ("Resource", "hero")] {
        let (sprites, mapping) = family(class);
        let effects = ["changeResource resource=t7", "spawn stype=t9", "bounceForward", "killAll stype=t3"];
        let mut rules = String::new();
        for number in 0..2_000 {
            let (one, two) =
                [("root", "root"), ("root", hero), (hero, "root"), ("t5", "root")][number / 5 % 4];
            writeln!(rules, "{one} {two} t1 t2 t3 t4 t5 > {}", effects[number % effects.len()]).unwrap();
        }
        let analysis = Analysis::of(&game(&sprites, &mapping, &rules, "SpriteCounter stype=root win=True"));
        assert!(analysis.encounters().len() > 10_000, "{}", analysis.encounters().len());
        // If there are too many interactions between two types, the remaining interactions are assumed to be
        // repetitions.
        let touch = analysis.touch(analysis.avatars()[0].stype, SpriteType(9));
        assert!(touch.makes.len() <= usize::from(MAX_RULES_PER_PAIR));
    }
}

#[test]
fn a_long_chain_and_many_terminations() {
    let (sprites, _) = family("Passive");
    let mut rules = String::new();
    for number in (1..480).rev() {
        writeln!(rules, "t{0} t{0} > spawn stype=t{1}", number - 1, number).unwrap();
    }
    let mut terminations = String::new();
    for limit in 0..500 {
        writeln!(terminations, "MultiSpriteCounter stype1=root stype2=root limit={limit} win=True").unwrap();
    }
    let analysis = Analysis::of(&game(&sprites, "0 > t0\nA > hero", &rules, &terminations));
    assert!(analysis.facts(named(&analysis, "t479")).possible);
    assert!(analysis.goals().len() == 500 && analysis.requirements().len() <= 2 * MAX_GOALS + 1);
}
