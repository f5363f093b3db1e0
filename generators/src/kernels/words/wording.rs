//! The goals and summaries that generators can write about given rules. They serve to check the texts of cards.
//!
//! A kernel's texts are sentences with placeholders for nouns and numbers. A game's images record its nouns
//! (`img=role/noun`), so every sentence about the game is known except for its numbers. The texts of rethemed games
//! follow from the rules alone.

use super::phrase::{self, Nouns};
use super::scene::Scene;
use crate::games::{blurb, english};
use crate::kernels::file::kernel::{Casting, Kernel};
use engine::syntax::SpriteLine;
use engine::{Analysis, Game};
use std::collections::BTreeMap;

/// The texts that can be written about a game, given the patterns used by its generator.
pub struct Wording {
    analysis: Analysis,
    kernel: Option<OfKernel>,
    /// `true` for inventions, and for games from older versions that contain types from a second kernel ("grafts").
    /// Texts about such games are not checked.
    is_unchecked: bool,
}

impl Wording {
    /// Reads a game's texts from its rules and from the patterns on its card. Costs about one analysis of the game.
    pub fn of(game: &Game, patterns: &[String]) -> Wording {
        let is_unchecked =
            |pattern: &String| pattern.starts_with("mechanic/") || pattern.starts_with("graft/");
        let is_unchecked = patterns.iter().any(is_unchecked);
        Wording { analysis: Analysis::of(game), kernel: OfKernel::read(game, patterns), is_unchecked }
    }

    /// Returns `true` if the goal follows from the rules, or if the goal is unchecked.
    pub fn has_goal(&self, goal: &str) -> bool {
        let of_kernel = |words: &OfKernel| words.says(&[(&words.kernel.goal, &words.nouns)], goal);
        self.is_unchecked
            || blurb::goal(&self.analysis) == goal
            || self.kernel.as_ref().is_some_and(of_kernel)
    }

    /// Returns `true` if the summary follows from the rules, or if the summary is unchecked.
    pub fn has_summary(&self, summary: &str) -> bool {
        let hero = blurb::hero(&self.analysis);
        let retold = |(_, retelling)| blurb::summary(&self.analysis, retelling, &hero) == summary;
        let shortest = || format!("{}.", english::capital(&english::one(&hero))) == summary;
        let of_kernel = |words: &OfKernel| words.says(&words.sentences(), summary);
        self.is_unchecked
            || self.kernel.as_ref().is_some_and(of_kernel)
            || shortest()
            || Scene::of_any_game().any(retold)
    }
}

/// The nouns that each type of a kernel can have in a game.
type Choices = BTreeMap<String, Vec<String>>;

/// A game's kernel, sentences and nouns.
struct OfKernel {
    kernel: &'static Kernel,
    variants: Vec<usize>,
    scene: &'static Scene,
    nouns: Choices,
}

impl OfKernel {
    /// Finds the kernel, form, scene and variants in the patterns; `None` if the patterns lack a known kernel or scene.
    fn read(game: &Game, patterns: &[String]) -> Option<OfKernel> {
        let named = |kind: &'static str| patterns.iter().filter_map(move |name| name.strip_prefix(kind));
        let (name, form) = (named("kernel/").next()?, named("form/").next());
        let kernel = Kernel::all().iter().find(|kernel| kernel.name == name)?;
        let kernel = kernel.in_all_forms().find(|kernel| kernel.form.as_deref() == form)?;
        let scene = named("scene/").next()?;
        let scene = Scene::all().iter().find(|known| known.name == scene)?;
        let variants = kernel.variants.iter().enumerate();
        let variants: Vec<usize> = variants
            .filter_map(|(at, variant)| named("variant/").any(|name| name == variant.name).then_some(at))
            .collect();
        let castings = kernel.roles.iter();
        let castings = castings.chain(variants.iter().flat_map(|&at| &kernel.variants[at].roles));
        let nouns = choices(&pictures(game), castings);
        Some(OfKernel { kernel, variants, scene, nouns })
    }

    /// Returns the summary's sentences, in order.
    fn sentences(&self) -> Vec<(&str, &Choices)> {
        let variants = self.variants.iter().map(|&at| &self.kernel.variants[at].fact);
        let own =
            [&self.scene.story, &self.kernel.dilemma].into_iter().chain(&self.kernel.facts).chain(variants);
        own.map(|sentence| (sentence.as_str(), &self.nouns)).collect()
    }

    /// Returns `true` if a text consists of the given sentences with the game's nouns inserted, separated by spaces.
    fn says(&self, sentences: &[(&str, &Choices)], text: &str) -> bool {
        let mut rests = vec![text];
        for (at, (sentence, nouns)) in sentences.iter().enumerate() {
            let starts = rests.into_iter().filter_map(|rest| match at {
                0 => Some(rest),
                _ => rest.strip_prefix(' '),
            });
            let sentence = phrase::sentence(sentence);
            rests = starts.flat_map(|rest| after(&sentence, nouns, rest, true)).collect();
        }
        rests.contains(&"")
    }
}

/// Returns the images of a game's types, split into parts: role and noun, or role, adjective and noun.
fn pictures(game: &Game) -> Vec<Vec<String>> {
    fn collect(lines: &[SpriteLine], found: &mut Vec<Vec<String>>) {
        for line in lines {
            let pictures = line.params.iter().filter(|param| param.key.text == "img");
            found.extend(pictures.map(|param| param.value.text.split('/').map(str::to_owned).collect()));
            collect(&line.children, found);
        }
    }
    let mut found = Vec::new();
    collect(&game.description().sprites, &mut found);
    found
}

/// Returns the nouns that each type can have according to the images.
fn choices<'a>(
    pictures: &[Vec<String>],
    castings: impl Iterator<Item = (&'a String, &'a Casting)>,
) -> Choices {
    let of_role = |role: &str| {
        let nouns = pictures.iter().filter_map(|parts| match &parts[..] {
            [own, noun] if own == role => Some(noun.clone()),
            _ => None,
        });
        nouns.collect::<Vec<String>>()
    };
    let in_state = |adjective: &str| {
        let nouns = pictures.iter().filter_map(|parts| match &parts[..] {
            [_, own, noun] if own == adjective => Some(format!("{adjective}{}", english::capital(noun))),
            _ => None,
        });
        nouns.collect::<Vec<String>>()
    };
    let own = castings.map(|(stype, casting)| match casting {
        Casting::Role(role) => (stype.clone(), of_role(role)),
        Casting::State { adjective, .. } => (stype.clone(), in_state(adjective)),
    });
    ["floor", "wall"].map(|role| (role.to_owned(), of_role(role))).into_iter().chain(own).collect()
}

/// Matches a sentence at the start of a text, with any of the nouns and any numbers filled in. Returns the rest of the
/// text after each possible match.
fn after<'t>(sentence: &str, nouns: &Choices, text: &'t str, is_start: bool) -> Vec<&'t str> {
    let Some(at) = sentence.find(['<', '{']) else {
        return text.strip_prefix(sentence).into_iter().collect();
    };
    let Some(text) = text.strip_prefix(&sentence[..at]) else { return Vec::new() };
    let closing = if sentence[at..].starts_with('<') { '>' } else { '}' };
    let Some((inside, rest)) = sentence[at + 1..].split_once(closing) else { return Vec::new() };
    let is_start = is_start && at == 0;
    let found: Vec<&str> = match closing {
        '>' => phrases(inside, nouns)
            .map(|phrase| if is_start { english::capital(&phrase) } else { phrase })
            .filter_map(|phrase| text.strip_prefix(phrase.as_str()))
            .collect(),
        _ => {
            let end = text.find(|c: char| !c.is_ascii_digit()).unwrap_or(text.len());
            (end > 0).then(|| &text[end..]).into_iter().collect()
        }
    };
    found.into_iter().flat_map(|text| after(rest, nouns, text, false)).collect()
}

/// Returns the phrases that can replace a noun placeholder.
fn phrases(inside: &str, nouns: &Choices) -> impl Iterator<Item = String> {
    let filled = |(stype, nouns): (&String, &Vec<String>)| {
        let fill = |noun: &String| {
            let only = Nouns::from([(stype.clone(), noun.clone())]);
            phrase::fill(&format!("<{inside}>"), &only).ok()
        };
        nouns.iter().filter_map(fill).collect::<Vec<String>>()
    };
    nouns.iter().flat_map(filled).collect::<Vec<String>>().into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::KernelGenome;

    #[test]
    fn kernels_say_what_their_rules_say_and_nothing_else() {
        for kernel in KernelGenome::kernels().step_by(5) {
            for genome in KernelGenome::all_of(kernel) {
                if let Ok(built) = genome.build() {
                    let game = built.game;
                    let wording = Wording::of(&game.rules, &game.patterns);
                    assert!(wording.has_goal(&game.goal), "{kernel}: {}", game.goal);
                    assert!(wording.has_summary(&game.summary), "{kernel}: {}", game.summary);
                    let other = game.goal.replace(" every ", " some ").replace("the ", "a ") + " Or not.";
                    assert!(!wording.has_goal(&other), "{kernel}: {other}");
                    assert!(!wording.has_summary(&format!("{} <b>", game.summary)), "{kernel}");
                }
            }
        }
    }
}
