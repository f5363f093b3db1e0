//! Figures for named sprites: a table of drawings, with the words and roles that each drawing represents.
//!
//! A game specifies an image with `img=`. Composed games write `img=role/noun`, or `img=role/adjective/noun`
//! for a type that represents a different state of a sprite. Other games write a file path whose last part is
//! a noun. The noun determines the figure. If the noun is unknown, the role determines it. If the role is
//! unknown too, the rules determine a [`Glyph`].

use super::colour::{Colour, GROUND, INK, PAPER};
use super::glyph::Glyph;
use super::shape::{Outline, Paint, Segment};
use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The table of figures, one figure per line: `name | words | drawing`.
///
/// A name ends with one of these signs:
///
/// - `#` if the figure fills its cell.
/// - `=` if walls can have this figure.
/// - `!` if the figure looks dangerous without any additions.
/// - `>` if the figure turns with the sprite.
///
/// A name that starts with `+` belongs to a mark, which is drawn over a figure to show its state.
///
/// Words are nouns in lower case. `@role` selects the figure by role, and `.adjective` selects it by state.
///
/// A drawing is the name of a glyph, or a list of parts. Each part has a paint, a colour, a form, and numbers in
/// hundredths of a tile. The paint `S` means filled with a dark rim, `F` means filled, and a number means a line of
/// that width. `=` adds the mirror image.
const FIGURES: &str = include_str!("art/figures.txt");

/// The figures of people.
const PEOPLE: [&str; 19] = [
    "person",
    "keeper",
    "customer",
    "knight",
    "thief",
    "king",
    "chef",
    "nurse",
    "dwarf",
    "clown",
    "diver",
    "mage",
    "strongman",
    "pedlar",
    "foreman",
    "smith",
    "shopkeeper",
    "pirate",
    "porter",
];

/// The figures that are replaced by an open door in the state `open`. Other sprites that can be open get a sign for the
/// state instead.
const DOORS: [&str; 11] = [
    "door",
    "gate",
    "grille",
    "fence",
    "house",
    "opendoor",
    "turnstile",
    "shutter",
    "trapdoor",
    "boom",
    "wardrobe",
];

/// The minimum length, in letters, of a word that is recognised as the end of a longer word.
const SHORTEST_END: usize = 4;

/// A tile's drawing, without its colour and details.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Form {
    /// The drawing of a glyph, which is the symbol for a kind of sprite.
    Glyph(Glyph),
    /// The figure on the line with this index in the table of figures.
    Figure(u16),
}

/// The expression on a figure with a face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mood {
    /// The figure smiles.
    #[default]
    Calm,
    /// The figure frowns and shows its teeth, because the type is harmful.
    Angry,
    /// The figure's eyes are closed.
    Asleep,
}

/// The colour of a figure part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Tint {
    Main,
    Shade,
    Light,
    Fixed(Colour),
}

/// A part of a figure.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Part {
    /// An outline with a tint. An outline without a paint is filled and has a dark rim.
    Outline(Outline, Tint, Option<Paint>),
    /// Two eyes: the point midway between them, their distance from each other, and their radius.
    Eyes([f32; 2], f32, f32),
    /// One eye, seen from the side, with its centre and radius.
    Eye([f32; 2], f32),
    /// A mouth, with its centre and width.
    Mouth([f32; 2], f32),
}

/// An entry in the table.
#[derive(Clone, Debug)]
pub(crate) struct Figure {
    pub(crate) name: &'static str,
    words: Vec<&'static str>,
    pub(crate) is_ground: bool,
    is_wall: bool,
    pub(crate) is_dangerous: bool,
    pub(crate) turns: bool,
    is_mark: bool,
    /// The glyph (the symbol for a kind of sprite) whose drawing the figure uses, if any.
    glyph: Option<Glyph>,
    pub(crate) parts: Vec<Part>,
}

impl Figure {
    /// Returns `true` if the drawing shows the type's colour.
    fn is_coloured(&self) -> bool {
        let shows = |part: &Part| matches!(part, Part::Outline(_, Tint::Main | Tint::Shade | Tint::Light, _));
        self.parts.iter().any(shows)
    }
}

static TABLE: LazyLock<Vec<Figure>> = LazyLock::new(|| FIGURES.lines().map(parsed).collect());

static WORDS: LazyLock<BTreeMap<&'static str, u16>> = LazyLock::new(|| {
    let entries = TABLE.iter().zip(0..=u16::MAX);
    entries.flat_map(|(figure, at)| figure.words.iter().map(move |&word| (word, at))).collect()
});

impl Form {
    /// Returns the figure, or `None` if the form is the drawing of a glyph (the symbol for a kind of sprite).
    pub(crate) fn figure(self) -> Option<&'static Figure> {
        match self {
            Form::Glyph(_) => None,
            Form::Figure(at) => Some(&TABLE[usize::from(at)]),
        }
    }

    /// Returns all figures except marks (signs for states), in table order.
    pub fn figures() -> impl Iterator<Item = Form> {
        let own = |(figure, at): (&Figure, u16)| {
            (!figure.is_mark && figure.glyph.is_none()).then_some(Form::Figure(at))
        };
        TABLE.iter().zip(0..=u16::MAX).filter_map(own)
    }

    /// Returns `true` if the form has eyes or a mouth.
    pub(crate) fn has_face(self) -> bool {
        self.figure().is_some_and(|figure| figure.parts.iter().any(|part| !matches!(part, Part::Outline(..))))
    }

    fn is_person(self) -> bool {
        self.figure().is_some_and(|figure| PEOPLE.contains(&figure.name))
    }

    /// Returns the form's name, a single word.
    pub fn name(self) -> &'static str {
        match self {
            Form::Glyph(glyph) => glyph.form(),
            Form::Figure(at) => TABLE[usize::from(at)].name,
        }
    }

    /// Returns the number of variants of the form.
    pub(crate) fn variants(self) -> usize {
        match self {
            Form::Glyph(glyph) => glyph.variants(),
            Form::Figure(_) => 1,
        }
    }

    /// Returns `true` if the tile fills its cell. Adjacent tiles of this kind join, and other sprites in the cell are
    /// drawn over them.
    pub(crate) fn is_ground(self) -> bool {
        match self {
            Form::Glyph(glyph) => glyph.is_ground(),
            Form::Figure(at) => TABLE[usize::from(at)].is_ground,
        }
    }

    /// Returns `true` if the drawing shows the type's colour.
    pub(crate) fn is_coloured(self) -> bool {
        self.figure().is_none_or(Figure::is_coloured)
    }

    fn of_entry(at: u16) -> Form {
        TABLE[usize::from(at)].glyph.map_or(Form::Figure(at), Form::Glyph)
    }
}

/// Returns the parts of a mark, which is the sign for a state.
pub(crate) fn mark(at: u16) -> &'static [Part] {
    &TABLE[usize::from(at)].parts
}

/// The image that a game specifies for a type, or that the type's name suggests.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hint<'a> {
    /// The type's role, in composed games; `None` in other games.
    pub(crate) role: Option<&'a str>,
    /// The adjective, if the type represents a different state of a sprite.
    adjective: Option<&'a str>,
    noun: &'a str,
}

impl<'a> Hint<'a> {
    /// Parses the value of `img=`.
    pub(crate) fn of(img: &'a str) -> Hint<'a> {
        let parts: Vec<&str> = img.split('/').collect();
        let known =
            |role: &str| role == "hero" || role == "floor" || role == "wall" || named("@", role).is_some();
        match parts[..] {
            [role, noun] if known(role) => Hint { role: Some(role), adjective: None, noun },
            [role, adjective, noun] if known(role) => {
                Hint { role: Some(role), adjective: Some(adjective), noun }
            }
            _ => Hint { role: None, adjective: None, noun: parts.last().copied().unwrap_or("") },
        }
    }

    /// Returns the hint given by the name of a type without `img=`. Returns `None` if the glyph (the symbol chosen from
    /// the rules) shows a direction, as the glyphs of portals and signs do, because a noun cannot express a direction.
    pub(crate) fn of_name(name: &'a str, glyph: Glyph) -> Option<Hint<'a>> {
        use Glyph as G;
        let shows_way = matches!(glyph, G::Portal | G::PortalExit | G::Pointer | G::Sign | G::Conveyor);
        let hint = Hint { role: None, adjective: None, noun: name };
        // Items that the avatar holds have no face, and types that are dug away are ground.
        let form = hint.form(glyph);
        let is_apt = match glyph {
            G::Token | G::Key => !form.has_face(),
            G::Soil => form.is_ground(),
            _ => true,
        };
        (!shows_way && is_apt).then_some(hint)
    }

    /// Returns the form (figure or glyph) for a type whose rules suggest the symbol `glyph`.
    pub(crate) fn form(self, glyph: Glyph) -> Form {
        let drawn = Form::Glyph(glyph);
        let noun = || noun(self.noun).map(Form::of_entry);
        let is_wall = |form: &Form| form.figure().is_some_and(|figure| figure.is_wall);
        match (self.role, glyph) {
            // An avatar that is an animal looks like that animal. A person gets the figure of the symbol chosen from
            // the rules.
            (_, Glyph::Avatar) => noun().filter(|form| form.has_face() && !form.is_person()).unwrap_or(drawn),
            (_, Glyph::Craft) | (None, Glyph::Floor) => drawn,
            (Some("floor"), _) => Form::Glyph(Glyph::Floor),
            // Walls stay walls, whatever their material.
            (Some("wall"), _) | (None, Glyph::Wall) => noun().filter(is_wall).unwrap_or(drawn),
            (None, _) => noun().unwrap_or(drawn),
            (Some(role), _) => {
                let state = self.state();
                let by_role = || named("@", role).map(Form::of_entry);
                state.map(Form::of_entry).or_else(noun).or_else(by_role).unwrap_or(drawn)
            }
        }
    }

    /// Returns the figure for the type's state; `None` if the type keeps its own figure. A prize keeps its own figure
    /// and gets a sign for the state instead, because a fallen prize does not look like a fallen bridge. Open objects
    /// other than doors are treated in the same way.
    fn state(self) -> Option<u16> {
        let is_door = || noun(self.noun).is_none_or(|at| DOORS.contains(&TABLE[usize::from(at)].name));
        let adjective = self.adjective.filter(|_| self.role != Some("prize"))?;
        if adjective == "open" && !is_door() { None } else { named(".", adjective) }
    }

    /// Returns the mark (the sign) for the type's state; `None` if the state has its own figure, or the table has no
    /// mark for it.
    pub(crate) fn mark(self) -> Option<u16> {
        let adjective = self.adjective?;
        if self.state().is_some() {
            return None;
        }
        let position =
            |is: &dyn Fn(&Figure) -> bool| TABLE.iter().position(|figure| figure.is_mark && is(figure));
        let known = position(&|figure| figure.words.contains(&adjective));
        known.or_else(|| position(&|figure| figure.words.is_empty())).and_then(|at| u16::try_from(at).ok())
    }

    /// Returns the expression on the type's face.
    pub(crate) fn mood(self, glyph: Glyph) -> Mood {
        use Glyph as G;
        match (self.role, self.adjective) {
            (Some("sleeper"), None | Some("dazed")) => Mood::Asleep,
            _ if matches!(glyph, G::Enemy | G::Charger | G::Hazard | G::Peril | G::HostileShot | G::Nest) => {
                Mood::Angry
            }
            _ => Mood::Calm,
        }
    }
}

/// Returns the table entry for a role (`@`) or an adjective (`.`); `None` if the table has no such entry.
fn named(sign: &str, word: &str) -> Option<u16> {
    WORDS.get(format!("{sign}{}", word.to_lowercase()).as_str()).copied()
}

/// Returns the table entry for a noun in camel case. Tries the whole noun, then its last word, and then the longest
/// suffix of that word that is in the table. Returns `None` if the table contains none of them.
fn noun(noun: &str) -> Option<u16> {
    let noun = noun.trim_end_matches(|letter: char| letter.is_ascii_digit() || letter == '_');
    let last = noun.rfind(|letter: char| letter.is_ascii_uppercase()).unwrap_or(0);
    let (whole, last) = (noun.to_lowercase(), noun[last..].to_lowercase());
    let ends = last.char_indices().map(|(at, _)| &last[at..]).filter(|end| end.len() >= SHORTEST_END);
    let mut names = [whole.as_str(), last.as_str()].into_iter().chain(ends);
    names.find_map(|name| {
        let &at = WORDS.get(name)?;
        (!TABLE[usize::from(at)].is_mark).then_some(at)
    })
}

/// Parses a line of the table. A test checks that the table is correct.
fn parsed(line: &'static str) -> Figure {
    let fields: Vec<&str> = line.splitn(3, '|').map(str::trim).collect();
    let &[head, words, drawing] = &fields[..] else { unreachable!("`{line}` has three fields") };
    let name = head.trim_matches(['+', '#', '=', '!', '>']);
    let glyph = drawing.strip_prefix("glyph ").map(|wanted| {
        let is = |glyph: &&Glyph| format!("{glyph:?}") == wanted;
        *Glyph::ALL.iter().find(is).unwrap_or_else(|| unreachable!("`{wanted}` is not a glyph"))
    });
    let parts = if glyph.is_some() { Vec::new() } else { drawing.split(';').flat_map(part).collect() };
    Figure {
        name,
        words: words.split_whitespace().collect(),
        is_ground: head.contains('#'),
        is_wall: head.contains('='),
        is_dangerous: head.contains('!'),
        turns: head.contains('>'),
        is_mark: head.starts_with('+'),
        glyph,
        parts,
    }
}

/// Parses a part of a drawing, and adds its mirror image if requested.
fn part(text: &str) -> Vec<Part> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let hundredths = |words: &[&str]| -> Vec<f32> {
        let number = |word: &&str| word.parse::<f32>().map(|number| number / 100.0);
        words.iter().map(number).collect::<Result<_, _>>().unwrap_or_default()
    };
    match (words[0], &hundredths(&words[1..])[..]) {
        ("eyes", &[x, y, apart, radius]) => return vec![Part::Eyes([x, y], apart, radius)],
        ("eye", &[x, y, radius]) => return vec![Part::Eye([x, y], radius)],
        ("mouth", &[x, y, width]) => return vec![Part::Mouth([x, y], width)],
        _ => {}
    }
    let [paint, tint, form, numbers @ ..] = &words[..] else { unreachable!("`{text}` is not a part") };
    let (paint, mirrored) = (paint.trim_end_matches('='), paint.ends_with('='));
    let paint = match paint {
        "S" => None,
        "F" => Some(Paint::Fill),
        width => Some(Paint::Stroke(width.parse::<f32>().unwrap_or(1.0) / 100.0)),
    };
    let outline = outline(form, &hundredths(numbers));
    let tint = tint_of(tint);
    let mirror = mirrored.then(|| Part::Outline(outline.clone().mirrored(), tint, paint));
    mirror.into_iter().chain([Part::Outline(outline, tint, paint)]).collect()
}

/// Parses an outline: a circle, ellipse, rectangle, rounded rectangle, star, polygon, line, or an open or closed
/// Bézier curve.
fn outline(form: &str, numbers: &[f32]) -> Outline {
    let points = || numbers.chunks_exact(2).map(|pair| [pair[0], pair[1]]).collect::<Vec<_>>();
    match (form, numbers) {
        ("c", &[x, y, radius]) => Outline::circle(x, y, radius),
        ("e", &[x, y, rx, ry]) => Outline::ellipse(x, y, rx, ry),
        ("r", &[x, y, w, h]) => Outline::rect(x, y, w, h),
        ("R", &[x, y, w, h, r]) => Outline::rounded(x, y, w, h, r),
        ("s", &[x, y, tips, outer, inner]) => {
            Outline::star(x, y, (tips * 100.0).round() as u16, outer, inner)
        }
        ("p", _) => Outline::polygon(&points()),
        ("l", _) => Outline::line(&points()),
        ("b" | "q", [_, _, _, ..]) => {
            let points = points();
            let curve = |part: &[[f32; 2]]| Segment::Cubic(part[0], part[1], part[2]);
            let curves = points[1..].chunks_exact(3).map(curve);
            let end = (form == "b").then_some(Segment::Close);
            Outline([Segment::Move(points[0])].into_iter().chain(curves).chain(end).collect())
        }
        _ => unreachable!("`{form}` {numbers:?} is not an outline"),
    }
}

fn tint_of(letter: &str) -> Tint {
    let [red, green, blue] = match letter {
        "m" => return Tint::Main,
        "d" => return Tint::Shade,
        "l" => return Tint::Light,
        "k" => INK.0,
        "w" => PAPER.0,
        "f" => GROUND.0,
        "g" => [0xff, 0xd2, 0x3f],
        "n" => [0x4c, 0x9a, 0x4a],
        "b" => [0x8a, 0x5a, 0x33],
        "s" => [0xb4, 0xba, 0xc6],
        "x" => [0x5b, 0x62, 0x70],
        "y" => [0xff, 0xe0, 0xbd],
        "c" => [0xf3, 0xe3, 0xbd],
        "r" => [0xd0, 0x40, 0x2f],
        "o" => [0xff, 0x8c, 0x2e],
        "u" => [0x3f, 0x7f, 0xd0],
        "p" => [0xff, 0x9f, 0xb0],
        _ => unreachable!("`{letter}` is not a colour"),
    };
    Tint::Fixed(Colour([red, green, blue]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn the_table_is_sound() {
        let mut words = BTreeSet::new();
        for (figure, line) in TABLE.iter().zip(FIGURES.lines()) {
            assert!(figure.glyph.is_some() || !figure.parts.is_empty(), "{line}");
            for word in &figure.words {
                assert!(words.insert(word), "`{word}` occurs twice");
                assert_eq!(word.to_lowercase(), **word);
            }
        }
        assert!(TABLE.len() <= usize::from(u16::MAX));
    }

    #[test]
    fn curves_have_whole_segments() {
        for line in FIGURES.lines() {
            for part in line.rsplit('|').next().unwrap_or("").split(';') {
                let words: Vec<&str> = part.split_whitespace().collect();
                match &words[..] {
                    [_, _, "b" | "q", numbers @ ..] => assert_eq!(numbers.len() % 6, 2, "{line}: {part}"),
                    [_, _, "p" | "l", numbers @ ..] => assert_eq!(numbers.len() % 2, 0, "{line}: {part}"),
                    _ => {}
                }
            }
        }
    }

    #[test]
    fn the_noun_is_stronger_than_the_role_and_the_role_than_the_rules() {
        let check = |img: &str, glyph: Glyph, expect: &str| {
            assert_eq!(Hint::of(img).form(glyph).name(), expect, "{img}");
        };
        check("food/honeyLoaf", Glyph::Gem, "bread");
        check("food/wug", Glyph::Gem, "apple");
        check("lever/churchBell", Glyph::Switch, "bell");
        check("pit/floorHole", Glyph::Hazard, "hole");
        check("gate/open/portcullis", Glyph::Neutral, "opendoor");
        check("oryx/cheese2", Glyph::Gem, "cheese");
        check("oryx/wug1", Glyph::Gem, "a gem");
        check("hero/cat", Glyph::Avatar, "cat");
        check("hero/clockmaker", Glyph::Avatar, "a figure in a bright ring");
        check("floor/grass", Glyph::Neutral, "a plain tile");
        check("wall/boxHedge", Glyph::Wall, "hedge");
        check("wall/toolbox", Glyph::Wall, "bricks");
        check("wall/roofBeam", Glyph::Wall, "bricks");
        check("key/rustyKey", Glyph::Key, "a key");
        check("", Glyph::Gem, "a gem");
    }

    /// Checks that objects that look different have distinct figures.
    #[test]
    fn similar_words_do_not_share_a_figure() {
        let name = |word: &str| noun(word).map(|at| TABLE[usize::from(at)].name);
        let groups: [&[&str]; 8] = [
            &["boneKnife", "stageSword", "fireAxe", "hammer", "pickaxe", "magicWand", "cleaver"],
            &["yeti", "polarBear", "walrus", "badger", "moonGiant"],
            &["paperDragon", "frog", "caveNewt", "crocodile"],
            &["snowman", "caveIdol", "nephew", "king", "headCook", "nurse", "clown", "diver"],
            &["snail", "tortoise", "stagBeetle", "horseFly", "wasp", "moonMoth", "kelpSpore"],
            &["mole", "mouse", "suitcase", "shield", "reedRaft", "barge", "trapdoor"],
            &["iceCrystal", "saltHeap", "dust", "leaf", "splinter", "twig", "log", "clayBrick"],
            &["strawBundle", "goldSack", "strawHeap", "hayBale", "brambleBush", "bone", "skull", "lever"],
        ];
        for group in groups {
            let names: Vec<_> = group.iter().filter_map(|word| name(word)).collect();
            let distinct: BTreeSet<_> = names.iter().collect();
            assert_eq!(distinct.len(), group.len(), "{names:?}");
        }
    }

    #[test]
    fn states_have_marks_or_figures_of_their_own() {
        let mark = |img: &str| Hint::of(img).mark().map(|at| TABLE[usize::from(at)].name);
        assert_eq!(mark("friend/sick/mole"), Some("ill"));
        assert_eq!(mark("friend/wug/mole"), Some("other"));
        assert_eq!(mark("gate/open/portcullis"), None);
        assert_eq!(mark("gate/open/raft"), Some("open"));
        assert_eq!(mark("crate/falling/boulder"), Some("fall"));
        assert_eq!(mark("friend/mole"), None);
        assert_eq!(mark("oryx/sick/mole"), None);
    }
}
