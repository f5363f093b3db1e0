//! Tests of all kernels and scenes.

mod turns;

use base::Seed;
use engine::{Game, Rect, syntax};
use generators::games::Kind;
use generators::kernels::{KernelGame, KernelGenome, Slot, preview};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// The minimum number of scenes for a kernel.
const SCENES: usize = 3;
/// The minimum number of kernels for a scene.
const KERNELS: usize = 4;

/// The number of draws to find a game of a form whose levels have no ring of walls. One of four games has no ring if
/// its rules allow that.
const DRAWS: u64 = 40;

/// A form of a kernel; `None` for the kernel itself.
type Form = Option<&'static str>;

/// Returns all kernels in all their forms.
fn forms() -> impl Iterator<Item = (&'static str, Form)> {
    KernelGenome::kernels()
        .flat_map(|kernel| KernelGenome::forms(kernel).into_iter().map(move |form| (kernel, form)))
}

/// Draws a game of a form in a scene that is not in `taken`.
fn drawn_beside(taken: &BTreeSet<String>, kernel: &str, form: Form, seed: Seed) -> KernelGenome {
    KernelGenome::of_kernel(kernel, |other| other == form, taken, seed).expect("a form of a kernel")
}

fn drawn(kernel: &str, form: Form, seed: Seed) -> KernelGenome {
    drawn_beside(&BTreeSet::new(), kernel, form, seed)
}

/// Returns the scenes that fit a form.
fn scenes_of(kernel: &str, form: Form) -> Vec<&'static str> {
    drawn(kernel, form, Seed::from_text(kernel)).scenes()
}

/// Returns the scene files of kernels, with their names.
fn scenes() -> Vec<(String, toml::Table)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let files = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("a file").path());
    let files = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    let read = |path: &Path| fs::read_to_string(path).expect("a text").parse().expect("a scene");
    let name = |path: &Path| path.file_stem().expect("a name").to_string_lossy().into_owned();
    let scenes = files.map(|path| (name(&path), read(&path)));
    scenes.filter(|(_, scene): &(String, toml::Table)| scene.contains_key("kernels")).collect()
}

#[test]
fn there_are_enough_kernels_and_scenes() {
    let (kernels, scenes) = (KernelGenome::kernels().count(), scenes());
    assert!(kernels >= 30 && scenes.len() >= 40, "{kernels} and {}", scenes.len());
    for (kernel, form) in forms() {
        let scenes = scenes_of(kernel, form).len();
        assert!(scenes >= SCENES, "{kernel}, form {form:?}: {scenes} scenes");
    }
    let fitting: Vec<_> = KernelGenome::kernels().map(|kernel| (kernel, scenes_of(kernel, None))).collect();
    for (scene, file) in &scenes {
        let fit = || fitting.iter().filter(|(_, scenes)| scenes.contains(&scene.as_str()));
        let kernels = fit().count();
        assert!(kernels >= KERNELS, "{scene}: {kernels} kernels");
        let named = file["kernels"].as_table().expect("the kernels of a scene");
        let known = |name: &String| fit().any(|(kernel, _)| kernel == name);
        assert!(named.keys().all(known), "{scene}: a kernel that is none, or a role without a noun");
    }
}

#[test]
fn no_title_of_a_scene_is_taken_twice() {
    let mut taken: BTreeMap<String, String> = BTreeMap::new();
    for (scene, file) in scenes() {
        let titles = file["titles"].as_array().expect("the titles of a scene");
        for title in titles {
            let title = title.as_str().expect("a title");
            let other = taken.insert(title.to_owned(), scene.clone());
            assert_eq!(other, None, "{title} of {scene}");
        }
    }
}

/// In every scene, with every noun, the rules compile without warnings and the words name only known types.
#[test]
fn every_kernel_builds_in_every_scene() {
    for (kernel, form) in forms() {
        let scenes = scenes_of(kernel, form);
        for (number, &scene) in (0..).zip(&scenes) {
            let seed = Seed::from_text(kernel).child("scene", number);
            let others = scenes.iter().filter(|other| **other != scene).map(|other| (*other).to_owned());
            let genome = drawn_beside(&others.collect(), kernel, form, seed);
            assert_eq!(genome.scene(), scene);
            let game = genome.build().unwrap_or_else(|error| panic!("{kernel} in {scene}: {error}")).game;
            let text = syntax::print(game.rules.description());
            for text in [&game.title, &game.summary, &game.goal] {
                assert!(!text.contains(['<', '>', '{', '}']) && !text.contains("  "), "{text}");
            }
            assert!(Game::from_source(&text).unwrap().warnings().is_empty());
        }
    }
}

/// Every map of each slot (position in the sequence of levels) can be laid out with its own game.
#[test]
fn every_map_becomes_levels() {
    for (kernel, form) in forms() {
        let seed = Seed::from_text(kernel);
        let built = drawn(kernel, form, seed).build().unwrap();
        let game = built.game.rules;
        for slot in Slot::ALL {
            let levels = (0..12).map(|number| built.course.level(slot, seed.child("level", number)));
            let asked: BTreeSet<String> = levels
                .filter_map(Result::ok)
                .map(|level| {
                    game.level(&level.text).unwrap_or_else(|problems| panic!("{kernel}: {problems}"));
                    level.asks
                })
                .collect();
            assert!(!asked.is_empty(), "{kernel}: no level of slot {slot:?}");
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_game_and_levels() {
    let draw = || {
        let seed = Seed::from_text("twice");
        let genome = KernelGenome::draw(Kind::ALL, seed).unwrap();
        let KernelGame { game, course } = genome.build().unwrap();
        let level = course.level(Slot::Exam, seed).map(|level| level.text).ok();
        (syntax::print(game.rules.description()), game.title, game.summary, level)
    };
    assert_eq!(draw(), draw());
}

#[test]
fn a_faulty_kernel_is_refused_with_its_fault() {
    let file = include_str!("../../../kernels/bridges-burn-behind.toml");
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
    check(": draw threeIsles", ": hero@nowhere", "there is no place `@nowhere`");
    check("TerminationSet", "", "the rules have no TerminationSet");
    let form = "[[form]]\nname = \"other\"\ngoal = \"Leave\"\nterminations = \"\"\n\n";
    check("[[level]]", &format!("{form}{form}[[level]]"), "two forms are called `other`");
}

/// A kernel's facts may be false in a form.
#[test]
fn a_form_can_have_facts_of_its_own_only() {
    let file = include_str!("../../../kernels/bridges-burn-behind.toml");
    let without_facts: String =
        file.lines().filter(|line| !line.starts_with("facts = ")).map(|line| format!("{line}\n")).collect();
    // The rules follow comments with the title, the summary and the goal.
    let summary = |file: &str, form: Option<&str>| {
        let (text, _) = preview("other", file, form, None, false, Seed::from_text("facts")).unwrap();
        text.lines().nth(1).unwrap().to_owned()
    };
    let with_form = |file: &str, own: &str| {
        let form = format!(
            "[[form]]\nname = \"other\"\ngoal = \"Leave\"\nfacts = [\"It rains\"]\n{own}terminations = \"\"\"\n    \
             SpriteCounter stype=hero limit=0 win=False\n    SpriteCounter stype=exit limit=0 win=True\n\"\"\"\n\n"
        );
        summary(&file.replacen("[[level]]", &format!("{form}[[level]]"), 1), Some("other"))
    };
    let [of_kernel, bare] = [file, &without_facts].map(|file| summary(file, None));
    assert!(of_kernel.len() > bare.len(), "{of_kernel}");
    assert_eq!(with_form(file, ""), format!("{of_kernel} It rains."));
    assert_eq!(with_form(file, "own_facts = true\n"), format!("{bare} It rains."));
}

/// Draws a game of a form whose levels have no ring of walls. Returns `None` if no draw leads to such a game, because
/// the rules of the form do not allow it.
fn without_ring(kernel: &str, form: Form) -> Option<KernelGenome> {
    let seed = Seed::from_text(kernel);
    let mut genomes = (0..DRAWS).map(|number| drawn(kernel, form, seed.child("edge", number)));
    genomes.find(|genome| genome.build().is_ok_and(|built| stops_at_edge(&built.game.rules)))
}

/// Returns `true` if rules stop something at the edge of the screen. Kernels leave that to walls.
fn stops_at_edge(game: &Game) -> bool {
    let mut partners = game.description().interactions.iter().flat_map(|line| &line.second);
    partners.any(|word| word.text == "EOS")
}

/// Nothing stays beyond the edge of a board without a ring of walls. Sprites that appear there, such as a shot off the
/// edge, are gone in the next tick.
#[test]
fn nothing_leaves_a_board_without_a_ring() {
    let mut open = 0;
    for genome in forms().filter_map(|(kernel, form)| without_ring(kernel, form)) {
        let Ok(KernelGame { game, course }) = genome.build() else { continue };
        let (kernel, game) = (genome.kernel(), game.rules);
        let seed = Seed::from_text(kernel);
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
                assert!(stayed.is_none(), "{kernel} {slot:?} tick {}: {stayed:?}", state.tick());
                outside = now;
            }
        }
    }
    assert!(open > 20, "{open} forms");
}
