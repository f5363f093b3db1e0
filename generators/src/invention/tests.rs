//! Tests for all mechanics, and for properties of inventions.

use super::draw::{Census, InventionConfig, share_idea};
use super::genome::{Invention, apart};
use super::mechanic::{Mechanic, Tag};
use super::merge::{Merged, ports};
use super::soundness::{self, Unsound};
use super::variation::InventionVariation;
use crate::Variation;
use base::Seed;
use engine::syntax;
use std::collections::BTreeSet;

pub(super) fn mechanics(names: &[&str]) -> Vec<&'static Mechanic> {
    let named = |name: &&str| Mechanic::all().iter().find(|mechanic| mechanic.name == **name).unwrap();
    names.iter().map(named).collect()
}

/// Returns the partition that merges the given pairs of ports (open roles of mechanics), such as `("feed.food",
/// "lock.key")`.
pub(super) fn partition(mechanics: &[&'static Mechanic], merges: &[(&str, &str)]) -> Vec<u8> {
    let names: Vec<String> = ports(mechanics)
        .iter()
        .map(|((mechanic, _), port)| format!("{}.{}", mechanics[*mechanic].name, port.name))
        .collect();
    let at = |name: &str| names.iter().position(|other| other == name).unwrap();
    let mut partition = apart(mechanics);
    for (one, other) in merges {
        let (into, from) = (partition[at(one)], partition[at(other)]);
        partition.iter_mut().filter(|class| **class == from).for_each(|class| *class = into);
    }
    partition
}

fn invention(names: &[&str], merges: &[(&str, &str)]) -> Result<Invention, Unsound> {
    let mechanics = mechanics(names);
    let seed = Seed::from_text("test");
    let partition = partition(&mechanics, merges);
    Invention::of(mechanics, partition, &mut seed.sampler(), seed)
}

#[test]
fn every_mechanic_can_be_read_and_says_its_rules() {
    assert!(Mechanic::all().len() >= 75);
    assert!(Mechanic::endings(true).count() >= 7);
    for mechanic in Mechanic::all() {
        assert!(!mechanic.ports.is_empty(), "{}", mechanic.name);
        assert!(mechanic.ending.is_some() || !mechanic.says.is_empty(), "{}", mechanic.name);
        for port in &mechanic.ports {
            let is_moved = port.tags.contains(&Tag::Moves);
            assert!(!port.bodies.is_empty(), "{}", mechanic.name);
            assert!(!is_moved || port.bodies.len() == 1, "{}", mechanic.name);
        }
    }
}

/// The rules of a sound draw might still fail to compile.
#[test]
fn every_mechanic_is_part_of_some_sound_draw() {
    let config = InventionConfig::default();
    let mut unused: BTreeSet<&str> = Mechanic::all().iter().map(|mechanic| mechanic.name.as_str()).collect();
    for at in 0..60_000 {
        let Ok(drawn) = Invention::sample(&config, Seed::from_text("use").child("sample", at)) else {
            continue;
        };
        for name in drawn.mechanics() {
            unused.remove(name);
        }
        if unused.is_empty() {
            return;
        }
    }
    panic!("in no draw: {unused:?}");
}

#[test]
fn one_food_for_two_mouths_is_a_game() {
    let merges = [("feed.food", "gather.prize"), ("feed.beast", "hunt.hunter")];
    let invented = invention(&["feed", "hunt", "gather"], &merges).unwrap().build().unwrap();
    let rules = syntax::print(invented.game.rules.description());
    assert!(rules.contains("PathChaser") && rules.contains("killIfOtherHasMore"), "{rules}");
    assert_eq!(
        invented.game.patterns,
        ["mechanic/feed", "mechanic/hunt", "ending/gather"]
            .into_iter()
            .map(str::to_owned)
            .chain(
                ["feed.beast+hunt.hunter", "feed.food+gather.prize"].map(|pair| format!("coupling/{pair}"))
            )
            .collect::<Vec<_>>()
    );
}

#[track_caller]
fn check(names: &[&str], merges: &[(&str, &str)], expect: Unsound) {
    assert_eq!(invention(names, merges).err(), Some(expect));
}

#[test]
fn what_is_not_sound_is_refused_by_its_reason() {
    check(&["feed", "hunt", "gather"], &[("feed.food", "gather.prize")], Unsound::Motion);
    check(&["lock", "hunt", "exit"], &[], Unsound::Unconnected);
    check(&["feed", "hunt", "gather"], &[("feed.food", "hunt.hunter")], Unsound::Body);
    check(&["armour", "disguise", "exit"], &[], Unsound::Avatar);
    let merges = [("boomerang.ammo", "use-up.burden"), ("boomerang.mark", "lock.gate")];
    check(&["boomerang", "lock", "use-up"], &merges, Unsound::Goal);
    let merges = [("flood.water", "bring-home.home"), ("hunt.hunter", "bring-home.friend")];
    check(&["flood", "hunt", "bring-home"], &merges, Unsound::NoAgency);
    check(&["lock", "gather"], &[("lock.key", "gather.prize")], Unsound::NoPressure);
}

#[test]
fn two_ports_of_one_mechanic_are_never_one_type() {
    let mechanics = mechanics(&["feed"]);
    assert!(Merged::of(ports(&mechanics)).is_none());
}

#[test]
fn what_is_drawn_changed_and_crossed_is_sound_and_builds() {
    let variation = InventionVariation::default();
    let seed = Seed::from_text("variation");
    let sampler = &mut seed.sampler();
    let mut parents: Vec<Invention> =
        (0..4).filter_map(|at| variation.create(seed.child("create", at))).collect();
    let mut changed = 0;
    for step in 0..24 {
        let at = step % parents.len();
        let next = variation.mutate(&variation.cross(&parents[at], &parents[0], sampler), sampler);
        next.check().unwrap();
        let invented = next.build().unwrap();
        assert!(invented.mechanics.iter().any(|lines| !lines.is_empty()));
        assert!(invented.game.rules.warnings().is_empty());
        changed += usize::from(next.key() != parents[at].key());
        parents[at] = next;
    }
    assert!(changed > 12, "{changed}");
}

#[test]
fn a_seed_draws_the_same_invention_and_others_draw_others() {
    let config = InventionConfig::default();
    let draw = |seed: &str| Invention::draw(&config, &Census::default(), Seed::from_text(seed)).unwrap();
    let text = |drawn: &Invention| syntax::print(drawn.build().unwrap().game.rules.description());
    assert_eq!(text(&draw("one")), text(&draw("one")));
    assert_ne!(draw("one").key(), draw("two").key());
}

#[test]
fn what_was_used_often_is_drawn_less() {
    let config = InventionConfig::default();
    let mut census = Census::default();
    for _ in 0..40 {
        assert!(census.count(["mechanic/hunt", "mechanic/lock"]));
    }
    let share = |census: &Census| {
        let seed = Seed::from_text("share");
        let draws = (0..60).filter_map(|at| Invention::draw(&config, census, seed.child("draw", at)));
        draws.filter(|drawn| drawn.mechanics().any(|name| name == "hunt")).count()
    };
    assert!(
        share(&census) * 2 < share(&Census::default()),
        "{} {}",
        share(&census),
        share(&Census::default())
    );
}

#[test]
fn a_type_is_opposed_if_its_uses_are() {
    let opposed = |names: &[&str], merges: &[(&str, &str)]| {
        let invention = invention(names, merges);
        let types = invention.map(|invention| invention.types().unwrap()).unwrap_or_default();
        types.iter().filter(|merged| soundness::is_opposed(merged)).count()
    };
    let merges = [("feed.food", "gather.prize"), ("feed.beast", "hunt.hunter")];
    assert!(opposed(&["feed", "hunt", "gather"], &merges) >= 1);
}

#[test]
fn two_parts_in_common_are_one_idea() {
    let game = |patterns: &[&str]| patterns.iter().map(|name| (*name).to_owned()).collect::<Vec<String>>();
    let one = game(&["mechanic/lock", "mechanic/hunt", "ending/gather"]);
    assert!(share_idea(&one, &game(&["mechanic/hunt", "mechanic/flood", "mechanic/lock", "ending/exit"])));
    assert!(share_idea(&one, &game(&["mechanic/hunt", "mechanic/flood", "ending/gather"])));
    assert!(!share_idea(&one, &game(&["mechanic/hunt", "mechanic/flood", "ending/exit"])));
    assert!(!share_idea(&one, &game(&["kernel/one-spark", "scene/docks"])));
}
