//! Mechanics. A mechanic is a file with VGDL clauses about ports, which are roles that the mechanic leaves open.

use super::fiction::Predicates;
use crate::games::Kind;
use crate::kernels::file::template::{Numbers, Template};
use engine::{EFFECTS, SpriteClass, TERMINATIONS};
use include_dir::{Dir, include_dir};
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::str::FromStr;
use std::sync::OnceLock;

static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/mechanics");

/// A type's physical nature: the class of its sprites, and the rules that follow from this class.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Body {
    /// An object that the player picks up and holds.
    Item,
    /// An object that the player pushes.
    Crate,
    /// An object that stops the player, crates, and sprites that move by themselves.
    Solid,
    /// Ground that does not stop any sprite.
    Ground,
    /// An object that moves by itself.
    Mover,
    /// An object that exists for one tick.
    Flash,
}

impl FromStr for Body {
    type Err = String;

    fn from_str(word: &str) -> Result<Body, String> {
        Ok(match word {
            "item" => Body::Item,
            "crate" => Body::Crate,
            "solid" => Body::Solid,
            "ground" => Body::Ground,
            "mover" => Body::Mover,
            "flash" => Body::Flash,
            _ => return Err(format!("`{word}` is not a body")),
        })
    }
}

/// The use of a port (an open role of a mechanic) from the player's point of view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Tag {
    /// The player needs the object for the mechanic.
    Tool,
    /// The object is used up.
    Spent,
    /// The mechanic produces the object.
    Made,
    /// A player action removes the object.
    Removed,
    /// The object is removed, but not by the player.
    Lost,
    /// The object harms the player.
    Harm,
    /// The object is in the player's way.
    Bars,
    /// The object lets the player pass.
    Road,
    /// The mechanic moves the object.
    Moves,
    /// The player can control where the object goes.
    Led,
    /// The ending needs the object.
    Goal,
    /// The object acts on other objects.
    Foe,
    /// The player has to bring the object to a place.
    Brought,
    /// The object becomes a danger without any action by the player.
    Presses,
}

impl FromStr for Tag {
    type Err = String;

    fn from_str(word: &str) -> Result<Tag, String> {
        Ok(match word {
            "tool" => Tag::Tool,
            "spent" => Tag::Spent,
            "made" => Tag::Made,
            "removed" => Tag::Removed,
            "lost" => Tag::Lost,
            "harm" => Tag::Harm,
            "bars" => Tag::Bars,
            "road" => Tag::Road,
            "moves" => Tag::Moves,
            "led" => Tag::Led,
            "goal" => Tag::Goal,
            "foe" => Tag::Foe,
            "brought" => Tag::Brought,
            "presses" => Tag::Presses,
            _ => return Err(format!("`{word}` is not a tag")),
        })
    }
}

/// A role that a mechanic leaves open.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Port {
    pub(crate) name: String,
    /// The bodies (kinds of physical object) that can fill the port, from most to least suitable.
    pub(crate) bodies: Vec<Body>,
    pub(crate) tags: BTreeSet<Tag>,
    /// The properties that a noun must have for the rules to make sense.
    pub(crate) predicates: Predicates,
}

/// A type that belongs to a mechanic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct OwnType {
    pub(crate) name: String,
    pub(crate) body: Body,
    pub(crate) origin: Origin,
}

/// The source of the noun for a mechanic's own type.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Origin {
    /// A different state of the type that fills a port.
    State {
        port: String,
        adjective: String,
        /// `true` if the rules that other mechanics have for the port also apply to the state.
        is_still: bool,
    },
    /// A separate object whose noun has the given predicates.
    Thing(Predicates),
}

/// A few clauses about ports (open roles), and the sentences that explain the clauses.
#[derive(Clone, Debug)]
pub(crate) struct Mechanic {
    pub(crate) name: String,
    pub(crate) says: Vec<String>,
    pub(crate) ports: Vec<Port>,
    pub(crate) types: Vec<OwnType>,
    pub(crate) numbers: Numbers,
    pub(crate) sprites: Template,
    pub(crate) before: Template,
    pub(crate) rules: Template,
    pub(crate) heroes: Option<Template>,
    pub(crate) hero: Option<Template>,
    pub(crate) terminations: Template,
    /// The goal as text, and the kind of game; `None` if the mechanic is not an ending.
    pub(crate) ending: Option<(String, Kind)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[serde(default)]
    says: Vec<String>,
    #[serde(default)]
    ports: BTreeMap<String, String>,
    #[serde(default)]
    types: BTreeMap<String, String>,
    #[serde(default)]
    sprites: String,
    #[serde(default)]
    before: String,
    #[serde(default)]
    rules: String,
    hero: Option<String>,
    heroes: Option<String>,
    #[serde(default)]
    terminations: String,
    goal: Option<String>,
    kind: Option<Kind>,
}

impl Mechanic {
    /// Returns all mechanics, sorted by name.
    pub(crate) fn all() -> &'static [Mechanic] {
        static ALL: OnceLock<Vec<Mechanic>> = OnceLock::new();
        ALL.get_or_init(|| {
            let mut files: Vec<(&str, &str)> = FILES
                .files()
                .filter_map(|file| {
                    let name = file.path().to_str()?.strip_suffix(".toml")?;
                    (name != "places").then_some((name, file.contents_utf8()?))
                })
                .collect();
            files.sort_unstable();
            let read = |(name, text): (&str, &str)| {
                Mechanic::read(name, text).unwrap_or_else(|fault| panic!("mechanic {name}: {fault}"))
            };
            files.into_iter().map(read).collect()
        })
    }

    /// Returns the endings if `are` is `true`; otherwise, returns all other mechanics.
    pub(crate) fn endings(are: bool) -> impl Iterator<Item = &'static Mechanic> {
        Mechanic::all().iter().filter(move |mechanic| mechanic.ending.is_some() == are)
    }

    /// Returns `true` if the type that fills one of the mechanic's ports (open roles) becomes a danger by itself.
    pub(crate) fn presses(&self) -> bool {
        self.ports.iter().any(|port| port.tags.contains(&Tag::Presses))
    }

    /// Returns `true` if the mechanic requires its own avatar class.
    pub(crate) fn has_hero(&self) -> bool {
        self.hero.is_some() || self.heroes.is_some()
    }

    /// Parses a mechanic's file.
    ///
    /// # Errors
    /// Returns the first problem as a sentence.
    pub(crate) fn read(name: &str, text: &str) -> Result<Mechanic, String> {
        let file: File = toml::from_str(text).map_err(|error| error.to_string())?;
        let mut numbers = Numbers::default();
        let mut template = |text: &str| Template::read(text, &mut numbers);
        let mechanic = Mechanic {
            name: name.to_owned(),
            says: file.says,
            ports: file.ports.iter().map(|(name, text)| port(name, text)).collect::<Result<_, _>>()?,
            types: file.types.iter().map(|(name, text)| own_type(name, text)).collect::<Result<_, _>>()?,
            sprites: template(&file.sprites)?,
            before: template(&file.before)?,
            rules: template(&file.rules)?,
            heroes: file.heroes.as_deref().map(&mut template).transpose()?,
            hero: file.hero.as_deref().map(&mut template).transpose()?,
            terminations: template(&file.terminations)?,
            ending: file.goal.map(|goal| (goal, file.kind.unwrap_or(Kind::CollectAndAvoid))),
            numbers,
        };
        for own in &mechanic.types {
            if let Origin::State { port, .. } = &own.origin
                && !mechanic.ports.iter().any(|other| other.name == *port)
                && port != "hero"
            {
                return Err(format!("type {} is a state of {port}, which is not a port", own.name));
            }
        }
        Ok(mechanic)
    }
}

/// A mechanic in words, for people and models that write games by hand.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MechanicInWords {
    /// The sentences that players read, with example nouns.
    pub says: Vec<String>,
    /// The sprite classes, effects and terminations that the mechanic uses, sorted.
    pub keywords: Vec<String>,
}

impl MechanicInWords {
    /// Returns the names of all mechanics and endings, sorted.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Mechanic::all().iter().map(|mechanic| mechanic.name.as_str())
    }

    /// Returns a mechanic or an ending by its name, or `None` if there is none.
    pub fn of(name: &str) -> Option<MechanicInWords> {
        Mechanic::all().iter().find(|mechanic| mechanic.name == name)?;
        let text = FILES.get_file(format!("{name}.toml"))?.contents_utf8()?;
        let file: File = toml::from_str(text).ok()?;
        let parts = [Some(file.sprites), Some(file.before), Some(file.rules), file.hero, file.heroes];
        let parts: String = parts.into_iter().flatten().chain([file.terminations]).collect();
        let classes = SpriteClass::ALL.iter().map(|class| class.name());
        let known: Vec<&str> =
            classes.chain(EFFECTS.iter().copied()).chain(TERMINATIONS.iter().copied()).collect();
        let tokens = parts.split(|c: char| !c.is_ascii_alphanumeric());
        let mut keywords: Vec<String> =
            tokens.filter(|token| known.contains(token)).map(str::to_owned).collect();
        keywords.sort();
        keywords.dedup();
        let says = file.says.into_iter().chain(file.goal).map(|said| said.replace(['<', '>'], "")).collect();
        Some(MechanicInWords { says, keywords })
    }
}

fn words<T: FromStr<Err = String>>(text: &str) -> Result<Vec<T>, String> {
    text.split_whitespace().map(str::parse).collect()
}

/// Parses `bodies tags: predicates`.
fn port(name: &str, text: &str) -> Result<Port, String> {
    let (uses, needs) = text.split_once(':').unwrap_or((text, ""));
    let (bodies, tags) = uses.trim().split_once(' ').unwrap_or((uses.trim(), ""));
    Ok(Port {
        name: name.to_owned(),
        bodies: words(&bodies.replace('/', " "))?,
        tags: words(tags)?.into_iter().collect(),
        predicates: needs.parse()?,
    })
}

/// Parses `body of PORT ADJECTIVE`, `body still of PORT ADJECTIVE` or `body: predicates`.
fn own_type(name: &str, text: &str) -> Result<OwnType, String> {
    let fault = || format!("`{text}` is neither `body of PORT ADJECTIVE` nor `body: predicates`");
    let (body, origin) = match text.split_once(':') {
        Some((body, needs)) => (body.trim(), Origin::Thing(needs.parse()?)),
        None => {
            let words: Vec<&str> = text.split_whitespace().collect();
            let (body, is_still, port, adjective) = match words[..] {
                [body, "of", port, adjective] => (body, false, port, adjective),
                [body, "still", "of", port, adjective] => (body, true, port, adjective),
                _ => return Err(fault()),
            };
            let (port, adjective) = (port.to_owned(), adjective.to_owned());
            (body, Origin::State { port, adjective, is_still })
        }
    };
    Ok(OwnType { name: name.to_owned(), body: body.parse()?, origin })
}
