//! The texts of an invented game: a setting, nouns that suit everything that their types do, a title, and sentences
//! that explain the rules.

mod nouns;
mod predicates;

pub(crate) use predicates::Predicates;

use super::emit;
use super::genome::Invention;
use super::mechanic::{Body, Mechanic, Origin, Tag};
use super::merge::Merged;
use super::soundness::is_opposed;
use crate::GenerateError;
use crate::games::palette;
use crate::kernels::file::kernel::Casting;
use crate::kernels::file::template;
use crate::kernels::ways;
use crate::kernels::words::dressing::{Palette, picture_lines};
use crate::kernels::words::naming;
use crate::kernels::words::phrase::{self, Nouns};
use base::Sampler;
use engine::Description;
use engine::syntax::{Param, Word};
use itertools::Itertools;
pub(super) use nouns::Noun;
use nouns::{Place, Words};
use std::collections::BTreeMap;

/// The colours available to avatars.
const HEROES: [&str; 2] = ["GREEN", "LIGHTGREEN"];

/// A game's texts.
pub(super) struct Fiction {
    place: &'static Place,
    hero: &'static str,
    castings: BTreeMap<String, Casting>,
    nouns: Nouns,
    names: BTreeMap<String, String>,
    pub(super) title: String,
    pub(super) summary: String,
    pub(super) goal: String,
}

/// A type that needs its own noun: its internal name, its body, and the predicates that the noun must satisfy.
type Wanted = (String, Body, Predicates);

impl Fiction {
    /// Returns `true` if some story setting has a noun for every type. Cost: about 20 microseconds.
    pub(super) fn can_name(types: &[Merged], mechanics: &[&'static Mechanic]) -> bool {
        let wanted = wanted(types, mechanics);
        Words::get().places.keys().any(|place| assign(&wanted, place, None).is_some())
    }

    /// Draws a game's texts.
    ///
    /// # Errors
    /// Returns an error if no setting has a noun for every type, or if a sentence contains an unknown type.
    pub(super) fn draw(invention: &Invention, types: &[Merged]) -> Result<Fiction, GenerateError> {
        let seed = invention.fiction;
        let wanted = wanted(types, &invention.mechanics);
        let mut places: Vec<(&String, &Place)> = Words::get().places.iter().collect();
        seed.child("places", 0).sampler().shuffle(&mut places);
        let sampler = &mut seed.child("nouns", 0).sampler();
        let drawn =
            places.into_iter().find_map(|(name, place)| Some((place, assign(&wanted, name, Some(sampler))?)));
        let none = || GenerateError::Unlucky("no place has a noun for every type".to_owned());
        let (place, mut nouns) = drawn.ok_or_else(none)?;
        let free = |word: &&String| !nouns.values().any(|noun| last_word(noun) == last_word(word));
        let heroes: Vec<&String> = place.heroes.iter().filter(free).collect();
        let walls: Vec<&String> = place.walls.iter().filter(free).collect();
        if heroes.is_empty() || walls.is_empty() {
            return Err(none());
        }
        let (hero, wall) = ((*sampler.choose(&heroes)).clone(), (*sampler.choose(&walls)).clone());
        nouns.extend([
            ("hero".to_owned(), hero),
            ("floor".to_owned(), place.floor.clone()),
            ("wall".to_owned(), wall),
        ]);
        let castings = castings(invention, types);
        add_states(&castings, &mut nouns);
        let declared = castings.keys().cloned().chain(["floor", "wall", "hero"].map(str::to_owned)).collect();
        let mut names = naming::names(&nouns, castings.iter(), declared, sampler);
        names.insert("wall".to_owned(), "wall".to_owned());
        let place_name = (*sampler.choose(&place.names)).clone();
        let unsuitable = GenerateError::Unsuitable;
        let fixed = |text: &str| text.replace("<name>", &place_name).replace("<Name>", &place_name);
        let reason = fixed(sampler.choose::<String>(&place.reasons));
        let mut sentences = vec![phrase::fill(&reason, &nouns).map_err(unsuitable)?];
        sentences.extend(dilemmas(types, &nouns, sampler));
        for (at, mechanic) in invention.mechanics.iter().enumerate() {
            let own = ports_in_words(mechanic, types, at, &nouns);
            for text in &mechanic.says {
                let text = template::filled(text, &mechanic.numbers, &invention.values[at]);
                sentences.push(phrase::fill(&text, &own).map_err(unsuitable)?);
            }
        }
        let summary = sentences.iter().map(|text| phrase::sentence(text)).unique().join(" ");
        let goal = goal(invention, types, &nouns)?;
        let title = title(types, &nouns, &place_name, sampler).map_err(unsuitable)?;
        let hero = HEROES[sampler.below(HEROES.len())];
        Ok(Fiction { place, hero, castings, nouns, names, title, summary, goal })
    }

    /// Returns the VGDL name of a type.
    pub(super) fn name(&self, internal: &str) -> &str {
        self.names.get(internal).map_or("", String::as_str)
    }

    /// Replaces internal names in rules with final names, colours, images and characters.
    pub(super) fn dress(&self, mut description: Description) -> Description {
        ways::set_obstacles(&mut description);
        let roles: BTreeMap<&str, &Casting> =
            self.castings.iter().map(|(stype, casting)| (stype.as_str(), casting)).collect();
        let ground = [self.place.floor_color.as_str(), self.place.wall_color.as_str()];
        Palette::new(ground, &self.nouns, self.hero).color_all(&mut description.sprites, &roles);
        picture_lines(&mut description.sprites, &roles, &self.nouns);
        if let Some(wall) = description.sprites.iter_mut().find(|line| line.name.text == "wall") {
            wall.params.push(Param::new("img", format!("wall/{}", self.nouns["wall"])));
            wall.params.push(Param::new("color", &self.place.wall_color));
        }
        self.give_characters(&mut description);
        description.renamed(&self.names)
    }

    fn give_characters(&self, description: &mut Description) {
        let mut taken = vec!['.', 'w', 'A'];
        for (at, line) in description.mapping.iter_mut().enumerate() {
            let own = line.names.last().map_or("", |word| self.name(&word.text));
            line.symbol = match at {
                0..3 => taken[at],
                _ => palette::symbol(own, &taken),
            };
            taken.push(line.symbol);
            line.names.dedup_by_key(|word: &mut Word| word.text.clone());
        }
    }
}

/// Returns the types that need a noun, from hardest to easiest to name.
fn wanted(types: &[Merged], mechanics: &[&'static Mechanic]) -> Vec<Wanted> {
    let merged =
        types.iter().enumerate().map(|(class, merged)| (emit::name(class), merged.body, merged.predicates()));
    let own = mechanics.iter().enumerate().flat_map(|(at, mechanic)| {
        mechanic.types.iter().filter_map(move |own| match &own.origin {
            Origin::Thing(predicates) => Some((emit::own_name(at, &own.name), own.body, *predicates)),
            Origin::State { .. } => None,
        })
    });
    let count =
        |(_, body, needs): &Wanted| Noun::all().iter().filter(|noun| noun.fits(*body, *needs)).count();
    let mut wanted: Vec<Wanted> = merged.chain(own).collect();
    wanted.sort_by_cached_key(count);
    wanted
}

/// Assigns a noun from the given setting to each type: a random fitting noun or, without a sampler, the first one.
fn assign(wanted: &[Wanted], place: &str, mut sampler: Option<&mut Sampler>) -> Option<Nouns> {
    let mut nouns = Nouns::new();
    for (stype, body, needs) in wanted {
        let is_taken = |word: &str| nouns.values().any(|taken: &String| last_word(taken) == last_word(word));
        let fits = |noun: &&Noun| noun.fits(*body, *needs) && noun.is_at(place) && !is_taken(noun.word);
        let mut fitting = Noun::all().iter().filter(fits);
        let noun = match &mut sampler {
            None => fitting.next()?,
            Some(sampler) => {
                let fitting: Vec<&Noun> = fitting.collect();
                if fitting.is_empty() {
                    return None;
                }
                *sampler.choose(&fitting)
            }
        };
        nouns.insert(stype.clone(), noun.word.to_owned());
    }
    Some(nouns)
}

/// Returns the last word of a noun. Objects with the same last word look similar.
fn last_word(noun: &str) -> String {
    let at = noun.rfind(|letter: char| letter.is_ascii_uppercase()).unwrap_or_default();
    noun[at..].to_ascii_lowercase()
}

/// Returns the casting of each type. A casting is either a role, which determines colours and images, or the type of
/// which this type is a state.
fn castings(invention: &Invention, types: &[Merged]) -> BTreeMap<String, Casting> {
    let mut castings = BTreeMap::from([("hero".to_owned(), Casting::Role("hero".to_owned()))]);
    for (class, merged) in types.iter().enumerate() {
        castings.insert(emit::name(class), Casting::Role(role(merged.predicates(), merged.body).to_owned()));
        if merged.is_kept_for(invention.mechanics.len() - 1) {
            let state = Casting::State { of: emit::name(class), adjective: "lost".to_owned() };
            castings.insert(emit::lost_name(class), state);
        }
    }
    for (at, mechanic) in invention.mechanics.iter().enumerate() {
        let names = emit::names_of(mechanic, types, at);
        for own in &mechanic.types {
            let casting = match &own.origin {
                Origin::Thing(predicates) => Casting::Role(role(*predicates, own.body).to_owned()),
                Origin::State { port, adjective, .. } => {
                    let of = names.get(port).cloned().unwrap_or_else(|| "hero".to_owned());
                    Casting::State { of, adjective: adjective.clone() }
                }
            };
            castings.insert(emit::own_name(at, &own.name), casting);
        }
    }
    castings
}

/// The vocabulary's roles by predicate, from most to least informative.
const ROLES: &[(&str, &str)] = &[
    ("hunts", "hunter"),
    ("steals", "thief"),
    ("marches", "patrol"),
    ("friend", "friend"),
    ("timid", "prey"),
    ("exit", "exit"),
    ("home", "haven"),
    ("den", "den"),
    ("hole", "pit"),
    ("water", "gulf"),
    ("hot", "fire"),
    ("spark", "embers"),
    ("plate", "plate"),
    ("bridge", "bridge"),
    ("lamp", "lamp"),
    ("lever", "lever"),
    ("target", "socket"),
    ("shop", "keeper"),
    ("bars", "gate"),
    ("opens", "key"),
    ("edible", "food"),
    ("valuable", "coin"),
    ("explodes", "ammo"),
    ("fuel", "fuel"),
    ("heavy", "crate"),
];

/// Returns the role that determines colours and images for a noun without its own colour or image.
fn role(predicates: Predicates, body: Body) -> &'static str {
    let told = ROLES.iter().find(|(word, _)| predicates.words().any(|other| other == *word));
    told.map_or_else(
        || match body {
            Body::Item => "prize",
            Body::Crate => "crate",
            Body::Solid => "gate",
            Body::Ground => "plate",
            Body::Mover => "stroller",
            Body::Flash => "embers",
        },
        |(_, role)| role,
    )
}

fn add_states(castings: &BTreeMap<String, Casting>, nouns: &mut Nouns) {
    for (stype, casting) in castings {
        if let Casting::State { of, adjective } = casting
            && let Some(noun) = nouns.get(of)
        {
            let state = format!("{adjective}{}", crate::games::english::capital(noun));
            nouns.insert(stype.clone(), state);
        }
    }
}

/// Returns the nouns for a mechanic's ports (open roles) and types, by their names in the mechanic.
fn ports_in_words(mechanic: &Mechanic, types: &[Merged], at: usize, nouns: &Nouns) -> Nouns {
    let names = emit::names_of(mechanic, types, at);
    let own = names.into_iter().filter_map(|(port, internal)| Some((port, nouns.get(&internal)?.clone())));
    own.chain([("hero".to_owned(), nouns["hero"].clone())]).collect()
}

fn goal(invention: &Invention, types: &[Merged], nouns: &Nouns) -> Result<String, GenerateError> {
    let last = invention.mechanics.len() - 1;
    let ending = invention.mechanics[last];
    let (text, _) =
        ending.ending.as_ref().ok_or_else(|| GenerateError::Unsuitable("no ending".to_owned()))?;
    let own = ports_in_words(ending, types, last, nouns);
    let text = template::filled(text, &ending.numbers, &invention.values[last]);
    Ok(phrase::sentence(&phrase::fill(&text, &own).map_err(GenerateError::Unsuitable)?))
}

/// Returns at most one sentence about a type with opposed uses, which is needed by one mechanic, and used up, removed,
/// feared or in the way in another.
fn dilemmas(types: &[Merged], nouns: &Nouns, sampler: &mut Sampler) -> Vec<String> {
    let mut said = Vec::new();
    for (class, merged) in types.iter().enumerate().filter(|(_, merged)| is_opposed(merged)) {
        let is_double_edged = merged.has(Tag::Harm) && (merged.has(Tag::Tool) || merged.has(Tag::Road));
        let patterns: &[&str] = if is_double_edged && !merged.has(Tag::Moves) {
            &[
                "<A x> helps you and harms you: choose the moment",
                "<The x> is both a danger and a help",
                "<A x> that is of use also brings trouble",
            ]
        } else if is_double_edged {
            &[
                "You need <the x> that you fear",
                "<The x> is what you run from and what you need",
                "Keep away from <the x>, but not too far",
            ]
        } else if merged.has(Tag::Spent) && merged.count(Tag::Tool) + merged.count(Tag::Goal) > 1 {
            &[
                "<A x> has more than one use and serves only once",
                "Every <x> is wanted twice, so choose",
                "Think before you give up <a x>",
            ]
        } else if merged.has(Tag::Bars) {
            &["<A x> is in your way and of use to you", "Not every <x> in your way should go"]
        } else if merged.has(Tag::Lost) {
            &[
                "What you need does not last: mind the <xes>",
                "Others can take <a x> from you before you use it",
            ]
        } else {
            continue;
        };
        let own = Nouns::from([("x".to_owned(), nouns[&emit::name(class)].clone())]);
        said.extend(phrase::fill(sampler.choose::<&str>(patterns), &own).ok());
    }
    said.truncate(1);
    said
}

/// Draws a title from the avatar's noun, the setting, and the two types that fill the most ports (open roles of
/// mechanics).
fn title(types: &[Merged], nouns: &Nouns, place: &str, sampler: &mut Sampler) -> Result<String, String> {
    let joint = |(_, merged): &(usize, &Merged)| std::cmp::Reverse(merged.ports.len());
    let things: Vec<&String> = types
        .iter()
        .enumerate()
        .sorted_by_key(joint)
        .filter_map(|(class, _)| nouns.get(&emit::name(class)))
        .collect();
    let thing = |at: usize| (*things.get(at).unwrap_or(&things[0])).clone();
    let own = Nouns::from([
        ("a".to_owned(), thing(0)),
        ("b".to_owned(), thing(1)),
        ("hero".to_owned(), nouns["hero"].clone()),
    ]);
    let pattern = sampler.choose(Words::get().titles()).replace("<Name>", place).replace("<name>", place);
    phrase::title(&pattern, &own)
}
