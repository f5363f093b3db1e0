//! The part of a game that its levels depend on: the characters that place sprites, and whether the placed
//! sprites are avatars.

use crate::diagnostic::{Diagnostic, nearest};
use crate::meanings::{Place, meaning};
use crate::rules::class::SpriteClass;
use crate::syntax::{Description, Header, MappingLine, Param, Section, SpriteLine, TerminationLine, Word};
use std::collections::BTreeSet;

/// Problem codes that make the characters in the LevelMapping uncertain.
const HIDES_MAPPING: [&str; 9] = [
    "bad-mapping",
    "missing-arrow",
    "missing-section",
    "swapped-section",
    "unknown-section",
    "wrong-section",
    "stray-line",
    "stray-indent",
    "too-long",
];

/// A faulty game, reduced to its level characters and the sprites that they place.
pub(crate) struct Outline {
    pub(crate) description: Description,
    /// `true` if the outline contains all characters that the game maps.
    pub(crate) knows_characters: bool,
    /// `true` if it is certain which characters place avatars.
    pub(crate) knows_avatars: bool,
}

/// Returns the outline of a description with the given parsing problems, or `None` if the description has no
/// LevelMapping.
pub(crate) fn outline(description: &Description, problems: &[Diagnostic]) -> Option<Outline> {
    if !description.has[Section::LevelMapping as usize] || description.mapping.is_empty() {
        return None;
    }
    let knows_characters = !problems.iter().any(|problem| HIDES_MAPPING.contains(&problem.code));
    let mut sprites = Sprites { lines: Vec::new(), names: BTreeSet::new(), sure: true };
    for line in &description.sprites {
        sprites.add(line, None);
    }
    // `wall` and `avatar` exist even if nothing declares them.
    let known = |name: &str| sprites.names.contains(name) || ["wall", "avatar"].contains(&name);
    let mut symbols = BTreeSet::new();
    let mut sure = sprites.sure;
    let mut mapping = Vec::new();
    for line in description.mapping.iter().filter(|line| symbols.insert(line.symbol)) {
        sure &= line.names.iter().all(|name| known(&name.text));
        let names = line.names.iter().filter(|name| known(&name.text)).cloned().collect();
        mapping.push(MappingLine { names, ..line.clone() });
    }
    let end = TerminationLine {
        class: "Timeout".into(),
        params: vec![Param::new("limit", 9)],
        ..TerminationLine::default()
    };
    let description = Description {
        header: Header { class: "BasicGame".into(), ..Header::default() },
        sprites: sprites.lines,
        mapping,
        terminations: vec![end],
        has: [true; 4],
        ..Description::default()
    };
    Some(Outline { description, knows_characters, knows_avatars: sure && knows_characters })
}

/// The sprites in an outline, without their hierarchy.
struct Sprites {
    lines: Vec<SpriteLine>,
    names: BTreeSet<String>,
    /// `true` if it is certain which sprites are avatars.
    sure: bool,
}

impl Sprites {
    fn add(&mut self, line: &SpriteLine, inherited: Option<SpriteClass>) {
        let read = |class: &Word| {
            let names = || SpriteClass::ALL.iter().map(|class| class.name());
            let meant = || match meaning(Place::Class, &class.text) {
                Some(_) if class.text.to_lowercase().ends_with("avatar") => Some("MovingAvatar"),
                Some(found) => found.write.first().copied(),
                None => nearest(&class.text, names())
                    .or(Some("MovingAvatar").filter(|_| class.text.to_lowercase().ends_with("avatar"))),
            };
            SpriteClass::from_name(&class.text).or_else(|| meant().and_then(SpriteClass::from_name))
        };
        let class = line.class.as_ref().map_or(inherited, read);
        self.sure &= class.is_some() || line.class.is_none() && !line.children.is_empty();
        if self.names.insert(line.name.text.clone()) {
            let class = if class.is_some_and(SpriteClass::is_avatar) { "MovingAvatar" } else { "Immovable" };
            let class = Some(class.into());
            self.lines.push(SpriteLine { name: line.name.clone(), class, ..SpriteLine::default() });
        }
        for child in &line.children {
            self.add(child, class);
        }
    }
}
