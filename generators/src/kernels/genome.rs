//! Genomes of games: the choices from which a game is built.

use super::compose::{Choices, Course};
use super::habits::{Habits, STILL};
use super::turns::Turns;
use crate::GenerateError;
use crate::games::{GeneratedGame, Kind};
use crate::kernels::file::kernel::Kernel;
use crate::kernels::words::scene::Scene;
use base::{Sampler, Seed};
use engine::{Description, Game, syntax};
use std::collections::BTreeSet;

/// The tick limit of a game whose levels have not been played yet.
const LONG: u32 = 400;

/// The weight of a form (a variation of a kernel) relative to the kernel itself. It is greater than 1 because the forms
/// were written to vary the endings of similar kernels.
const OTHER_FORM: u32 = 2;

/// A game and the maps for its levels.
#[derive(Clone, Debug)]
pub struct KernelGame {
    /// The game. Its patterns are the kernel (the hand-written design), the variants and the scene (the theme).
    pub game: GeneratedGame,
    /// The maps for the game's levels.
    pub course: Course,
}

/// A game as a list of choices: a kernel (a hand-written design) with its variants and numbers, and a scene (a theme)
/// with its nouns.
///
/// The same genome builds the same game on every machine.
#[derive(Clone, Debug)]
pub struct KernelGenome {
    pub(crate) kernel: &'static Kernel,
    /// The indices of the kernel variants used in the game, in order.
    pub(crate) variants: Vec<usize>,
    /// The values for the kernel's numbers.
    pub(crate) values: Vec<u32>,
    pub(crate) scene: &'static Scene,
    pub(crate) nouns: Seed,
    pub(crate) habits: Habits,
    /// The number of ticks after which the game is lost; `None` if there is no limit.
    pub(crate) time: Option<u32>,
}

impl KernelGenome {
    /// Draws a kernel of one of the given kinds, with its numbers and a scene, which supplies the nouns.
    ///
    /// # Errors
    /// Returns an error if no kernel of these kinds has a scene.
    pub fn draw(kinds: &[Kind], seed: Seed) -> Result<KernelGenome, GenerateError> {
        let kernel = Turns::draw(kinds, seed)
            .any(&mut seed.child("place", 0).sampler())
            .ok_or_else(|| GenerateError::Unsuitable("no kernel belongs to the allowed kinds".to_owned()))?;
        Ok(KernelGenome::of(kernel, &mut seed.child("genome", 0).sampler()))
    }

    /// Draws a game from the kernel `name`, in a form accepted by `is_open` and a scene that is not in `taken`. If all
    /// fitting scenes are taken, one of them is reused. Returns `None` if the kernel does not exist, or if `is_open`
    /// accepts none of its forms.
    pub fn of_kernel(
        name: &str,
        is_open: impl Fn(Option<&str>) -> bool,
        taken: &BTreeSet<String>,
        seed: Seed,
    ) -> Option<KernelGenome> {
        let kernel = Kernel::all().iter().find(|kernel| kernel.name == name)?;
        let sampler = &mut seed.child("genome", 0).sampler();
        let open = kernel.in_all_forms().filter(|form| is_open(form.form.as_deref())).collect();
        let drawn = KernelGenome::in_form(drawn(open, sampler)?, sampler);
        let free: Vec<_> = Scene::of(drawn.kernel).filter(|scene| !taken.contains(&scene.name)).collect();
        let scene = if free.is_empty() { drawn.scene } else { free[sampler.below(free.len())] };
        Some(KernelGenome { scene, ..drawn })
    }

    /// Returns, for each form of a kernel, a game without variants and, if the form has variants, a game with all of
    /// them. Returns no games if the kernel does not exist.
    pub fn all_of(kernel: &str) -> Vec<KernelGenome> {
        let named = Kernel::all().iter().filter(|other| other.name == kernel);
        let mut sampler = Seed::from_text("all").sampler();
        let mut all = Vec::new();
        for form in named.flat_map(Kernel::in_all_forms) {
            let plain = KernelGenome { variants: Vec::new(), ..KernelGenome::in_form(form, &mut sampler) };
            let variants: Vec<usize> = (0..form.variants.len()).collect();
            if !variants.is_empty() {
                all.push(KernelGenome { variants, ..plain.clone() });
            }
            all.push(plain);
        }
        all
    }

    /// Returns the same rules with different numbers, points and sizes.
    #[must_use]
    pub fn redrawn(&self, seed: Seed) -> KernelGenome {
        let values = self.kernel.numbers.draw(&mut seed.child("genome", 0).sampler());
        let Habits { edge, has_clock, .. } = self.habits;
        let habits = Habits { edge, has_clock, ..Habits::draw(seed) };
        KernelGenome { values, habits, ..self.clone() }
    }

    /// Returns the same rules with the nouns of a scene; `None` if the scene lacks a noun.
    pub fn named(&self, scene: &str, nouns: Seed) -> Option<KernelGenome> {
        let scene = Scene::of(self.kernel).find(|other| other.name == scene)?;
        let genome = KernelGenome { scene, nouns, ..self.clone() };
        genome.build().is_ok().then_some(genome)
    }

    /// Draws a game from a kernel that has scenes, in one of its forms.
    pub(crate) fn of(kernel: &'static Kernel, sampler: &mut Sampler) -> KernelGenome {
        let form = drawn(kernel.in_all_forms().collect(), sampler).unwrap_or(kernel);
        KernelGenome::in_form(form, sampler)
    }

    /// Draws a game in a given form. The form must have a scene.
    pub(crate) fn in_form(kernel: &'static Kernel, sampler: &mut Sampler) -> KernelGenome {
        let scenes: Vec<&'static Scene> = Scene::of(kernel).collect();
        let variants = (0..kernel.variants.len()).filter(|_| sampler.ratio(1, 3)).collect();
        let values = kernel.numbers.draw(sampler);
        let scene = scenes[sampler.below(scenes.len())];
        let nouns = Seed::from_text("nouns").child("draw", sampler.bits());
        KernelGenome { kernel, variants, values, scene, nouns, habits: Habits::draw(nouns), time: Some(LONG) }
    }

    /// Returns the names of the scenes with nouns for everything in the game.
    pub fn scenes(&self) -> Vec<&'static str> {
        Scene::of(self.kernel).map(|scene| scene.name.as_str()).collect()
    }

    /// Returns the kind of game.
    pub fn kind(&self) -> Kind {
        self.kernel.kind
    }

    /// Returns the name of the game's kernel.
    pub fn kernel(&self) -> &str {
        &self.kernel.name
    }

    /// Returns the name of the form of the game's kernel; `None` for the unmodified kernel.
    pub fn form(&self) -> Option<&str> {
        self.kernel.form.as_deref()
    }

    /// Returns the name of the game's scene.
    pub fn scene(&self) -> &'static str {
        &self.scene.name
    }

    /// Returns the kernel that represents the family of the given kernel. A family consists of kernels that hardly
    /// differ from each other.
    pub fn family(kernel: &str) -> &str {
        let named = Kernel::all().iter().find(|other| other.name == kernel);
        named.and_then(|kernel| kernel.like.as_deref()).unwrap_or(kernel)
    }

    /// Returns the names of a kernel's forms, starting with `None` for the unmodified kernel.
    pub fn forms(kernel: &str) -> Vec<Option<&'static str>> {
        let named = Kernel::all().iter().find(|other| other.name == kernel);
        let forms =
            |kernel: &'static Kernel| kernel.in_all_forms().map(|form| form.form.as_deref()).collect();
        named.map_or_else(Vec::new, forms)
    }

    /// Returns the names of all kernels, grouped by kind.
    pub fn kernels() -> impl Iterator<Item = &'static str> {
        let of_kind = |kind: Kind| Kernel::all().iter().filter(move |kernel| kernel.kind == kind);
        Kind::ALL.iter().copied().flat_map(of_kind).map(|kernel| kernel.name.as_str())
    }

    /// Returns `true` if the game always has a tick limit. Otherwise, it has a limit only if it might never end without
    /// one.
    pub fn has_clock(&self) -> bool {
        self.habits.has_clock
    }

    /// Returns the same game with a different tick limit, or without one. A goal of surviving for some ticks is
    /// unaffected.
    #[must_use]
    pub fn timed(&self, ticks: Option<u32>) -> KernelGenome {
        KernelGenome { time: ticks, ..self.clone() }
    }

    /// Builds the game. Cost: well under a millisecond.
    ///
    /// # Errors
    /// Returns an error if the rules do not compile, or if the compiler or the analysis warns about them. For example,
    /// the analysis warns about games that cannot be won.
    pub fn build(&self) -> Result<KernelGame, GenerateError> {
        let composed = self.choices().compose()?;
        let rules = Game::from_source(&syntax::print(&composed.description)).map_err(|problems| {
            GenerateError::Unlucky(format!(
                "kernel {}: the rules do not compile: {problems}",
                self.kernel.name
            ))
        })?;
        if let Some(warning) = rules.warnings().first() {
            let message =
                format!("kernel {}: the rules compile with a warning: {}", self.kernel.name, warning.message);
            return Err(GenerateError::Unlucky(message));
        }
        let variants = self.variants.iter().map(|&at| format!("variant/{}", self.kernel.variants[at].name));
        let form = self.kernel.form.iter().map(|form| format!("form/{form}"));
        let kernel = [format!("kernel/{}", self.kernel.name)].into_iter().chain(form);
        let patterns = kernel.chain(variants);
        let game = GeneratedGame {
            real_time: has_movers(&composed.description),
            rules,
            title: composed.title,
            summary: composed.summary,
            goal: composed.goal,
            kind: self.kernel.kind,
            patterns: patterns.chain([format!("scene/{}", self.scene.name)]).collect(),
        };
        Ok(KernelGame { game, course: composed.course })
    }

    fn choices(&self) -> Choices<'_> {
        Choices {
            kernel: self.kernel,
            variants: &self.variants,
            values: &self.values,
            scene: self.scene,
            nouns: self.nouns,
            habits: self.habits,
            time: self.time,
        }
    }
}

/// Draws one of the given forms; `None` if there are none.
fn drawn(forms: Vec<&'static Kernel>, sampler: &mut Sampler) -> Option<&'static Kernel> {
    let weight = |form: &&Kernel| if form.form.is_some() { OTHER_FORM } else { 1 };
    let weights: Vec<u32> = forms.iter().map(weight).collect();
    Some(forms[sampler.weighted(&weights)?])
}

/// Builds a game from a kernel file for its author. The game uses one of the kernel's forms, with or without variants,
/// and either a scene's nouns or the type names.
///
/// # Errors
/// Returns the errors in the file or in its rules. Also returns an error if the form does not exist or the scene does
/// not suit the kernel.
pub fn preview(
    name: &str,
    text: &str,
    form: Option<&str>,
    scene: Option<&str>,
    variants: bool,
    seed: Seed,
) -> Result<(String, Course), GenerateError> {
    let kernel = Kernel::read(name, text).map_err(|fault| GenerateError::Unsuitable(fault.to_string()))?;
    let kernel: &'static Kernel = Box::leak(Box::new(kernel));
    let kernel = kernel.in_all_forms().find(|kernel| kernel.form.as_deref() == form).ok_or_else(|| {
        let forms: Vec<&str> = kernel.in_all_forms().filter_map(|kernel| kernel.form.as_deref()).collect();
        let message =
            format!("kernel {name} has no form {}: try {}", form.unwrap_or_default(), forms.join(", "));
        GenerateError::Unsuitable(message)
    })?;
    let scene: &'static Scene = match scene {
        None => Box::leak(Box::new(Scene::plain(kernel))),
        Some(wanted) => Scene::of(kernel).find(|scene| scene.name == wanted).ok_or_else(|| {
            let fitting: Vec<&str> = Scene::of(kernel).map(|scene| scene.name.as_str()).collect();
            let message = format!("scene {wanted} does not fit kernel {name}: try {}", fitting.join(", "));
            GenerateError::Unsuitable(message)
        })?,
    };
    let variants = if variants { (0..kernel.variants.len()).collect() } else { Vec::new() };
    let values = kernel.numbers.draw(&mut seed.sampler());
    let genome = KernelGenome {
        kernel,
        variants,
        values,
        scene,
        nouns: seed,
        habits: Habits::draw(seed),
        time: Some(LONG),
    };
    let KernelGame { game, course } = genome.build()?;
    let mut description = game.rules.description().clone();
    description.header.trivia.above.extend([game.title, game.summary, game.goal]);
    Ok((syntax::print(&description), course))
}

/// Returns `true` if any sprite moves, appears or disappears by itself.
pub(crate) fn has_movers(description: &Description) -> bool {
    let moves = |class: &str| !STILL.contains(&class) && !class.ends_with("Avatar");
    description
        .sprite_lines()
        .iter()
        .filter_map(|(_, line)| line.class.as_ref())
        .any(|class| moves(&class.text))
}
