//! Rethemed games: the same rules under new names, characters, colours and texts.
//!
//! A player who knows a game by heart knows the purpose of its `conch`, but must read the rethemed game afresh. Each
//! type's new name is drawn at random from a scene's words for the type's use in the rules (`casting.rs`).

use super::blurb;
use super::casting;
use super::english::{capital, one, spaced};
use super::palette;
use super::surface::{self, Symbols};
use crate::GenerateError;
use crate::kernels::words::scene::{Retelling, Scene};
use base::{Sampler, Seed};
use engine::analysis::{Analysis, Role as Use};
use engine::syntax::{MappingLine, SpriteLine};
use engine::{Description, Game, SpriteType};
use std::collections::{BTreeMap, BTreeSet};

/// The direction suffixes of type names that differ only in direction.
const DIRECTIONS: [&str; 4] = ["Up", "Left", "Down", "Right"];
/// The name prefix of a type into which objects turn at their destination.
const SETTLED: &str = "settled";
/// Adjectives that distinguish types if a scene runs out of words for their role.
const ADJECTIVES: [&str; 8] = ["other", "old", "small", "great", "odd", "pale", "spare", "far"];

/// A game in a new scene, with its level characters.
#[derive(Clone, Debug, PartialEq)]
pub struct Rethemed {
    /// The rules. All lines keep their order, so both games play identically, including their state hashes.
    pub description: Description,
    /// The title in the new scene.
    pub title: String,
    /// A sentence about the avatar, the tasks and the dangers.
    pub summary: String,
    /// The instructions for winning, in one sentence.
    pub goal: String,
    /// The scene's name, such as `harbour`.
    pub scene: &'static str,
    symbols: Symbols,
}

impl Rethemed {
    /// Rethemes a game. Sprite types are named with words from one scene, according to their use. Level characters,
    /// colours, the title and the texts follow from the scene. None of the game's names is reused except `wall` and
    /// `avatar`, on which the engine depends. Images and comments are removed. Costs about two analyses of the game.
    ///
    /// # Errors
    /// Returns [`GenerateError::Unsuitable`], whatever the seed, if the game uses up all characters. Returns the same
    /// error if the game does not compile under other names, because it was loaded with the reference's error recovery.
    pub fn of(game: &Game, seed: Seed) -> Result<Rethemed, GenerateError> {
        Rethemed::retell(game, seed, false)
    }

    /// Rethemes a game like [`Rethemed::of`], but also translates compound names. A compound name consists of the names
    /// of other types, directions and states: `sackPorter`, `signUp` and `settledCrate` become `loafBaker`, `doormatUp`
    /// and `settledTrunk`.
    ///
    /// # Errors
    /// Returns the same errors as [`Rethemed::of`].
    pub fn of_compounds(game: &Game, seed: Seed) -> Result<Rethemed, GenerateError> {
        Rethemed::retell(game, seed, true)
    }

    fn retell(game: &Game, seed: Seed, keeps_compounds: bool) -> Result<Rethemed, GenerateError> {
        let analysis = Analysis::of(game);
        let old = OldNames::of(game.description());
        let mut sampler = seed.child("retold", 0).sampler();
        let (scene, retelling) = old.scene(&mut sampler);
        let (assigned, stems) = (BTreeMap::new(), keeps_compounds.then(BTreeMap::new));
        let mut casting = Assigner { analysis: &analysis, scene, old: &old, sampler, assigned, stems };
        casting.lines(&game.description().sprites);
        let Assigner { mut sampler, assigned, .. } = casting;
        let named = assigned.iter().filter(|(name, _)| !Description::RESERVED_NAMES.contains(&name.as_str()));
        let names = named.map(|(name, assignment)| (name.clone(), assignment.word.clone())).collect();
        let mut description = surface::without_surface(game.description(), &names);
        recolor(&mut description.sprites, scene, &assigned, &names_back(&names));
        let symbols = symbols(&analysis, &assigned)?;
        symbols.write(&mut description);
        let rethemed = Game::compile(&description).map_err(|problems| {
            GenerateError::Unsuitable(format!("it does not compile under other names: {problems}"))
        })?;
        let analysis = Analysis::of(&rethemed);
        let hero = blurb::hero(&analysis);
        let is_new = |text: &str| !old.mentions_old_name(text);
        let title = blurb::title(&analysis, retelling, &hero, is_new, &mut sampler);
        let summary = blurb::summary(&analysis, retelling, &hero);
        let summary = if is_new(&summary) { summary } else { format!("{}.", capital(&one(&hero))) };
        let goal = blurb::goal(&analysis);
        Ok(Rethemed { goal, title, summary, scene: &scene.name, symbols, description })
    }

    /// Returns the names of the scenes with words for any game.
    pub fn scenes() -> impl Iterator<Item = &'static str> {
        Scene::of_any_game().map(|(scene, _)| scene.name.as_str())
    }

    /// Translates a level of the original game to the new characters. Unmapped characters become spaces.
    pub fn level(&self, text: &str) -> String {
        self.symbols.level(text)
    }
}

/// The words that must not be reused, as stems: in lower case and without plural endings.
struct OldNames(BTreeSet<String>);

impl OldNames {
    fn of(description: &Description) -> OldNames {
        let parameters = description.parameters.iter().map(|line| line.name.text.as_str());
        let names = description.own_names().into_iter().chain(parameters);
        OldNames(names.flat_map(|name| words(name).chain([stem(name)])).collect())
    }

    /// Returns `true` if a text contains an old name.
    fn mentions_old_name(&self, text: &str) -> bool {
        words(text).any(|word| self.0.contains(&word)) || self.0.contains(&stem(text))
    }

    /// Draws a scene, preferring scenes that share few words with the old names.
    fn scene(&self, sampler: &mut Sampler) -> (&'static Scene, &'static Retelling) {
        let weight = |(scene, retelling): &(&Scene, &Retelling)| {
            let shared = scene.all_nouns().filter(|noun| self.mentions_old_name(noun)).count();
            let shared = u32::try_from(shared).unwrap_or(u32::MAX);
            if self.mentions_old_name(&retelling.place) {
                0
            } else {
                64 / (1 + shared.saturating_mul(shared))
            }
        };
        let scenes: Vec<_> = Scene::of_any_game().collect();
        let weights: Vec<u32> = scenes.iter().map(weight).collect();
        let drawn = sampler.weighted(&weights);
        scenes[drawn.unwrap_or_else(|| sampler.below(scenes.len()))]
    }
}

/// Returns the stems of the words in a name or text, for comparison.
fn words(text: &str) -> impl Iterator<Item = String> {
    let spaced = spaced(text);
    let words: Vec<String> =
        spaced.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| word.len() > 2).map(stem).collect();
    words.into_iter()
}

fn stem(word: &str) -> String {
    let word = word.to_ascii_lowercase();
    word.strip_suffix('s').filter(|stem| stem.len() > 2).unwrap_or(&word).to_owned()
}

/// A type's new name and role.
struct Assignment {
    word: String,
    role: &'static str,
}

/// Assigns a word to every type in a SpriteSet.
struct Assigner<'a> {
    analysis: &'a Analysis,
    scene: &'static Scene,
    old: &'a OldNames,
    sampler: Sampler,
    /// The assignments, by old name.
    assigned: BTreeMap<String, Assignment>,
    /// The new words for types that differ in direction, by old name without the direction; `None` if compound names
    /// are not translated.
    stems: Option<BTreeMap<String, String>>,
}

impl Assigner<'_> {
    fn lines(&mut self, lines: &[SpriteLine]) {
        for line in lines {
            let name = line.name.text.as_str();
            if !self.assigned.contains_key(name) {
                let assignment = self.assign(line);
                self.assigned.insert(name.to_owned(), assignment);
            }
            self.lines(&line.children);
        }
    }

    fn assign(&mut self, line: &SpriteLine) -> Assignment {
        let name = line.name.text.as_str();
        let roles = self.of_name(name).map_or(&["rubble"][..], |stype| casting::roles(self.analysis, stype));
        let role = roles[0];
        if Description::RESERVED_NAMES.contains(&name) {
            return Assignment { word: name.to_owned(), role };
        }
        if !line.children.is_empty() {
            let member =
                self.of_name(first_leaf(line)).map_or(Use::Neutral, |stype| self.analysis.role(stype));
            let words = casting::group(member).to_vec();
            return Assignment { word: self.word(words), role };
        }
        if let Some(word) = self.compound(name, roles) {
            return Assignment { word, role };
        }
        self.of_roles(roles)
    }

    /// Returns the translation of a compound name; `None` if it is not a compound. Directions and states are kept, and
    /// the name of each type is replaced with its new word.
    fn compound(&mut self, name: &str, roles: &[&'static str]) -> Option<String> {
        self.stems.as_ref()?;
        if let Some((stem, way)) = DIRECTIONS.iter().find_map(|way| Some((name.strip_suffix(way)?, way))) {
            let known = self.stems.as_ref().and_then(|stems| stems.get(stem)).cloned();
            let word = known.unwrap_or_else(|| self.of_roles(roles).word);
            self.stems.as_mut()?.insert(stem.to_owned(), word.clone());
            return Some(format!("{word}{way}"));
        }
        let parts = spaced(name);
        let word =
            |part| if part == SETTLED { Some(SETTLED) } else { Some(self.assigned.get(part)?.word.as_str()) };
        let words: Option<Vec<&str>> = parts.split(' ').map(word).collect();
        let (first, rest) = words.as_deref()?.split_first().filter(|(_, rest)| !rest.is_empty())?;
        Some(rest.iter().fold((*first).to_owned(), |name, word| name + &capital(word)))
    }

    fn of_roles(&mut self, roles: &[&'static str]) -> Assignment {
        for &role in roles {
            let words = self.free(self.scene.nouns_of(role));
            if !words.is_empty() {
                return Assignment { word: (*self.sampler.choose(&words)).to_owned(), role };
            }
        }
        Assignment { word: self.word(self.scene.nouns_of(roles[0])), role: roles[0] }
    }

    fn of_name(&self, name: &str) -> Option<SpriteType> {
        self.analysis.game().sprite_type(name)
    }

    /// Draws one of `words` that is free. If none of them is free, returns a word with an adjective or a number.
    fn word(&mut self, words: Vec<&'static str>) -> String {
        let free = self.free(words.clone());
        if !free.is_empty() {
            return (*self.sampler.choose(&free)).to_owned();
        }
        let told = |word: &&&'static str| !self.old.mentions_old_name(word);
        let word = words.iter().find(told).copied().unwrap_or("thing");
        let qualified = ADJECTIVES.iter().map(|adjective| format!("{adjective}{}", capital(word)));
        let numbered = (2..).map(|number: u32| format!("{word}{number}"));
        let fits = |word: &String| !self.is_taken(word) && !self.old.mentions_old_name(word);
        let numbered_fits = |word: &String| !self.is_taken(word) && !self.old.0.contains(&stem(word));
        let found = qualified.into_iter().find(fits).or_else(|| numbered.into_iter().find(numbered_fits));
        found.expect("the numbers are endless")
    }

    fn free(&self, mut words: Vec<&'static str>) -> Vec<&'static str> {
        words.retain(|word| !self.is_taken(word) && !self.old.mentions_old_name(word));
        words
    }

    fn is_taken(&self, word: &str) -> bool {
        let mut stems = self.stems.iter().flat_map(BTreeMap::values);
        self.assigned.values().any(|assignment| assignment.word == word) || stems.any(|stem| stem == word)
    }
}

/// Returns the name of the first leaf below a group.
fn first_leaf(line: &SpriteLine) -> &str {
    let mut line = line;
    while let Some(child) = line.children.first() {
        line = child;
    }
    &line.name.text
}

fn names_back(names: &BTreeMap<String, String>) -> BTreeMap<&str, &str> {
    names.iter().map(|(old, new)| (new.as_str(), old.as_str())).collect()
}

/// Recolours the game for the scene. Types whose role has a colour in the scene get that colour.
fn recolor(
    lines: &mut [SpriteLine],
    scene: &'static Scene,
    assigned: &BTreeMap<String, Assignment>,
    back: &BTreeMap<&str, &str>,
) {
    fn walk(lines: &mut [SpriteLine], color: &mut impl FnMut(&str) -> &'static str) {
        for line in lines {
            for param in line.params.iter_mut().filter(|param| param.key.text == "color") {
                param.value.text = color(&line.name.text).to_owned();
            }
            walk(&mut line.children, color);
        }
    }
    let mut taken = Vec::new();
    walk(lines, &mut |name| {
        let old = back.get(name).copied().unwrap_or(name);
        let role = assigned.get(old).map_or("rubble", |assignment| assignment.role);
        let own = palette::color(role, scene, &taken);
        // If there are several floors or walls, only the first gets the scene's colour.
        let color = if taken.contains(&own) { palette::color("rubble", scene, &taken) } else { own };
        taken.push(color);
        color
    });
}

/// Assigns new level characters. As in generated games, `.` replaces the first character that places only floor, `w`
/// the first that places a wall, and `A` the first that places an avatar. Every other character becomes a letter of the
/// new name of its type, if one is free.
fn symbols(analysis: &Analysis, assigned: &BTreeMap<String, Assignment>) -> Result<Symbols, GenerateError> {
    let description = analysis.game().description();
    let lines = description.mapping.iter().map(|line: &MappingLine| {
        (line.symbol, line.names.iter().map(|name| name.text.as_str()).collect::<Vec<_>>())
    });
    let builtin = ['w', 'A']
        .into_iter()
        .filter_map(|symbol| Some((symbol, vec![surface::builtin(symbol, description)?])));
    let lines: Vec<(char, Vec<&str>)> = lines.chain(builtin).collect();
    let uses = |name: &&str| analysis.game().sprite_type(name).map(|stype| analysis.role(stype));
    let last = |names: &[&str]| names.last().and_then(&uses);
    let needed = |symbol: char, name: &str| {
        let stype = analysis.game().sprite_type(name);
        stype.is_some_and(|stype| analysis.facts(stype).symbols.contains(&(symbol as u8)))
    };
    let unmapped_builtins =
        surface::unmapped_builtins(description).filter(|&(symbol, name)| needed(symbol, name));
    let mut symbols: BTreeMap<char, char> = unmapped_builtins.map(|(symbol, _)| (symbol, symbol)).collect();
    let mut taken: Vec<char> = symbols.values().copied().collect();
    let mut assign_symbol = |new: char, fits: &dyn Fn(&[&str]) -> bool| {
        let found = lines.iter().find(|(old, names)| !symbols.contains_key(old) && fits(names));
        if let Some((old, _)) = found.filter(|_| !taken.contains(&new)) {
            symbols.insert(*old, new);
            taken.push(new);
        }
    };
    assign_symbol('.', &|names| !names.is_empty() && names.iter().all(|name| uses(name) == Some(Use::Floor)));
    assign_symbol('w', &|names| names.last() == Some(&"wall"));
    assign_symbol('A', &|names| names.iter().any(|name| uses(name) == Some(Use::Avatar)));
    assign_symbol('w', &|names| last(names) == Some(Use::Wall));
    for symbol in surface::mapped_builtins(description) {
        assign_symbol(symbol, &|_| true);
    }
    for (old, names) in &lines {
        if symbols.contains_key(old) {
            continue;
        }
        let word = names
            .last()
            .and_then(|name| assigned.get(*name))
            .map_or("x", |assignment| assignment.word.as_str());
        // If possible, choose a character that differs from the old one.
        let avoided: Vec<char> = taken.iter().copied().chain([*old]).collect();
        let any = || ('!'..='~').find(|symbol| *symbol != '#' && !taken.contains(symbol));
        let new = palette::free_symbol(word, &avoided).or_else(any);
        let new = new
            .ok_or_else(|| GenerateError::Unsuitable("its LevelMapping uses up all characters".to_owned()))?;
        symbols.insert(*old, new);
        taken.push(new);
    }
    Ok(Symbols(symbols))
}
