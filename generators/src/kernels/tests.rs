//! Properties of all kernels and scenes.

use super::genome::{KernelGame, KernelGenome};
use super::habits::Edge;
use super::kernel::Kernel;
use super::scene::Scene;
use super::{Slot, preview};
use engine::{Game, Rect, Seed, syntax};
use std::collections::{BTreeMap, BTreeSet};

/// The least number of scenes that a kernel can be set in.
const SCENES: usize = 3;
/// The least number of kernels that a scene is for.
const KERNELS: usize = 4;

#[test]
fn there_are_enough_kernels_and_scenes() {
    let kernels = Kernel::all();
    assert!(kernels.len() >= 30 && Scene::all().len() >= 40, "{} and {}", kernels.len(), Scene::all().len());
    for kernel in kernels.iter().flat_map(Kernel::in_all_forms) {
        let scenes = Scene::of(kernel).count();
        assert!(scenes >= SCENES, "{}: {scenes} scenes", kernel.name);
    }
    for scene in Scene::all() {
        let fitting = kernels.iter().filter(|kernel| scene.fits(kernel)).count();
        assert!(fitting >= KERNELS, "{}: {fitting} kernels", scene.name);
        let named: BTreeSet<&String> = scene.kernels.keys().collect();
        let known = |name: &&String| kernels.iter().any(|kernel| kernel.name == **name && scene.fits(kernel));
        assert!(named.iter().all(known), "{}: a kernel that is none, or a role without a noun", scene.name);
    }
}

#[test]
fn no_title_of_a_scene_is_taken_twice() {
    let mut taken: BTreeMap<&str, &str> = BTreeMap::new();
    for scene in Scene::all() {
        for title in &scene.titles {
            let other = taken.insert(title, &scene.name);
            assert_eq!(other, None, "{title} of {}", scene.name);
        }
    }
}

/// In every scene, with every noun: the rules compile without warnings, and the words name types only.
#[test]
fn every_kernel_builds_in_every_scene() {
    for kernel in Kernel::all().iter().flat_map(Kernel::in_all_forms) {
        for (number, scene) in (0..).zip(Scene::of(kernel)) {
            let seed = Seed::from_text(&kernel.name).child("scene", number);
            let genome = KernelGenome { scene, ..KernelGenome::in_form(kernel, &mut seed.sampler()) };
            let game = genome
                .build()
                .unwrap_or_else(|error| panic!("{} in {}: {error}", kernel.name, scene.name))
                .game;
            let text = syntax::print(game.rules.description());
            for text in [&game.title, &game.summary, &game.goal] {
                assert!(!text.contains(['<', '>', '{', '}']) && !text.contains("  "), "{text}");
            }
            assert!(Game::from_source(&text).unwrap().warnings().is_empty());
        }
    }
}

/// Each map of each slot can be laid out with its own game.
#[test]
fn every_map_becomes_levels() {
    for kernel in Kernel::all().iter().flat_map(Kernel::in_all_forms) {
        let seed = Seed::from_text(&kernel.name);
        let genome = KernelGenome::in_form(kernel, &mut seed.sampler());
        let built = genome.build().unwrap();
        let game = built.game.rules;
        for slot in Slot::ALL {
            let levels = (0..12).map(|number| built.course.level(slot, seed.child("level", number)));
            let asked: BTreeSet<String> = levels
                .filter_map(Result::ok)
                .map(|level| {
                    game.level(&level.text).unwrap_or_else(|problems| panic!("{}: {problems}", kernel.name));
                    level.asks
                })
                .collect();
            assert!(!asked.is_empty(), "{}: no level of slot {slot:?}", kernel.name);
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_game_and_levels() {
    let draw = || {
        let seed = Seed::from_text("twice");
        let genome = KernelGenome::draw(crate::games::Kind::ALL, seed).unwrap();
        let KernelGame { game, course } = genome.build().unwrap();
        let level = course.level(Slot::Exam, seed).map(|level| level.text).ok();
        (syntax::print(game.rules.description()), game.title, game.summary, level)
    };
    assert_eq!(draw(), draw());
}

#[test]
fn a_faulty_kernel_is_refused_with_its_fault() {
    let file = include_str!("../../kernels/bridges-burn-behind.toml");
    let seed = Seed::from_text("faults");
    assert!(preview("sound", file, None, None, false, seed).is_ok());
    let check = |from: &str, to: &str, said: &str| {
        let altered = file.replacen(from, to, 1);
        assert_ne!(altered, file, "{from}");
        let error = preview("faulty", &altered, None, None, false, seed).unwrap_err().to_string();
        assert!(error.contains("kernel faulty") && error.contains(said), "{error}");
    };
    check("kind =", "sort =", "unknown field `sort`");
    check("slot = \"exam\"", "slot = \"final\"", "unknown variant `final`");
    check(": hero", ": hero@nowhere", "there is no place `@nowhere`");
    check("TerminationSet", "", "the rules have no TerminationSet");
    let form = "[[form]]\nname = \"other\"\ngoal = \"Leave\"\nterminations = \"\"\n\n";
    check("[[level]]", &format!("{form}{form}[[level]]"), "two forms are called `other`");
}

/// Facts of the kernel may be false in a form.
#[test]
fn a_form_can_have_facts_of_its_own_only() {
    let file = include_str!("../../kernels/bridges-burn-behind.toml");
    let terminations = "SpriteCounter stype=hero limit=0 win=False";
    let form = |own: &str| {
        let form = format!(
            "[[form]]\nname = \"other\"\ngoal = \"Leave\"\nfacts = [\"It rains\"]\n{own}terminations = \"{terminations}\"\n\n"
        );
        let text = file.replacen("[[level]]", &format!("{form}[[level]]"), 1);
        let kernel = Kernel::read("other", &text).unwrap();
        let other = kernel.in_all_forms().find(|kernel| kernel.form.as_deref() == Some("other"));
        (kernel.facts.len(), other.unwrap().facts.clone())
    };
    let (of_kernel, facts) = form("");
    assert!(of_kernel > 0 && facts.len() == of_kernel + 1, "{facts:?}");
    assert_eq!(form("own_facts = true\n").1, ["It rains"]);
}

/// Drawn maps may have no room for a thing of another kernel; a game with one has levels nevertheless.
#[test]
fn games_with_grafts_have_a_level_in_every_slot() {
    let mut tried = 0;
    for kernel in Kernel::all() {
        let seed = Seed::from_text(&kernel.name);
        let genome = KernelGenome::in_form(kernel, &mut seed.sampler());
        let grafted = (0..8).filter_map(|number| genome.grafted(seed.child("graft", number)));
        for KernelGame { course, game } in grafted.filter_map(|genome| genome.build().ok()) {
            let lines = game.rules.description().sprite_lines();
            let brought = lines.iter().filter(|(_, line)| course.is_grafted(&line.name.text)).count();
            assert!((1..lines.len()).contains(&brought), "{}: {brought} types of grafts", kernel.name);
            for slot in Slot::ALL {
                let has_level = (0..4).any(|number| course.level(slot, seed.child("level", number)).is_ok());
                assert!(has_level, "{} {slot:?}", kernel.name);
            }
            tried += 1;
        }
    }
    assert!(tried > 100, "{tried} games");
}

/// Nothing stays beyond the edge of a board that has no ring of walls. What comes to be there, such as a shot off the edge, is gone in
/// the next tick.
#[test]
fn nothing_leaves_a_board_without_a_ring() {
    let mut open = 0;
    let genomes = Kernel::all().iter().flat_map(Kernel::in_all_forms).flat_map(|kernel| {
        let seed = Seed::from_text(&kernel.name);
        let genome = KernelGenome::in_form(kernel, &mut seed.sampler());
        let grafted = (0..3).filter_map(|number| genome.grafted(seed.child("graft", number)));
        grafted.chain([genome.clone()]).collect::<Vec<_>>()
    });
    for mut genome in genomes {
        genome.habits.edge = Edge::Screen;
        let Ok(KernelGame { game, course }) = genome.build() else { continue };
        let (kernel, game) = (genome.kernel, game.rules);
        let seed = Seed::from_text(&kernel.name);
        if !game
            .description()
            .interactions
            .iter()
            .any(|line| line.second.iter().any(|word| word.text == "EOS"))
        {
            continue;
        }
        open += 1;
        for (number, slot) in (0..).zip(Slot::ALL) {
            let Ok(level) = course.level(slot, seed.child("level", number)) else { continue };
            let level = game.level(&level.text).unwrap();
            let sampler = &mut seed.child("keys", number).sampler();
            let mut state = game.start(&level, seed);
            let mut outside = BTreeSet::new();
            while !state.is_over() && state.tick() < 150 {
                let action = *sampler.choose(game.actions(&state));
                game.step(&mut state, action);
                let (width, height) = (state.size().0 * state.block(), state.size().1 * state.block());
                let off = |rect: &Rect| {
                    rect.x < 0 || rect.y < 0 || rect.x + rect.w > width || rect.y + rect.h > height
                };
                let now: BTreeSet<_> = game
                    .sprite_types()
                    .flat_map(|stype| state.rects(stype).filter(off).map(move |rect| (stype, rect.x, rect.y)))
                    .collect();
                let stayed = now.intersection(&outside).next().copied();
                let stayed = stayed.map(|(stype, x, y)| (game.name(stype), x, y));
                assert!(stayed.is_none(), "{} {slot:?} tick {}: {stayed:?}", kernel.name, state.tick());
                outside = now;
            }
        }
    }
    assert!(open > 20, "{open} forms");
}
