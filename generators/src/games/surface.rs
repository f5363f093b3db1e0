//! A game's surface: names, level characters, images and comments. Changing the surface does not change the rules.

use engine::Description;
use engine::syntax::{MappingLine, SpriteLine, Trivia};
use std::collections::BTreeMap;

/// Returns the same rules with sprite types renamed and without comments and images. All lines keep their order, so
/// both games play identically, including their state hashes.
pub(super) fn without_surface(description: &Description, names: &BTreeMap<String, String>) -> Description {
    let mut bare = without_comments(description.renamed(names));
    strip_images(&mut bare.sprites);
    bare
}

/// Returns the same rules without comments.
pub(super) fn without_comments(description: Description) -> Description {
    let mut bare = description;
    bare.header.trivia = Trivia::default();
    strip_comments(&mut bare.sprites);
    bare.mapping.iter_mut().for_each(|line| line.trivia = Trivia::default());
    bare.interactions.iter_mut().for_each(|line| line.trivia = Trivia::default());
    bare.terminations.iter_mut().for_each(|line| line.trivia = Trivia::default());
    bare.parameters.iter_mut().for_each(|line| line.trivia = Trivia::default());
    bare.section_trivia = Default::default();
    bare.tail = Vec::new();
    bare
}

fn strip_comments(lines: &mut [SpriteLine]) {
    for line in lines {
        line.trivia = Trivia::default();
        strip_comments(&mut line.children);
    }
}

fn strip_images(lines: &mut [SpriteLine]) {
    for line in lines {
        line.params.retain(|param| !["img", "autotiling", "randomtiling"].contains(&param.key.text.as_str()));
        strip_images(&mut line.children);
    }
}

/// Returns the characters that the game's levels can use. The characters of the LevelMapping come first, in order. They
/// are followed by the unmapped built-in characters whose type the game declares.
pub(super) fn symbols(description: &Description) -> Vec<char> {
    let own = description.mapping.iter().map(|line| line.symbol);
    own.chain(['w', 'A'].into_iter().filter(|&symbol| builtin(symbol, description).is_some())).collect()
}

/// Returns the type that a built-in character places, if the game declares the type and does not map the character.
pub(super) fn builtin(symbol: char, description: &Description) -> Option<&'static str> {
    let name = unmapped(symbol, description)?;
    declares_sprites(&description.sprites, name, false).then_some(name)
}

/// Returns `true` if a line declares the type with a class, either its own or one inherited from a parent.
fn declares_sprites(lines: &[SpriteLine], name: &str, above: bool) -> bool {
    lines.iter().any(|line| {
        let class = above || line.class.is_some();
        (class && line.name.text == name) || declares_sprites(&line.children, name, class)
    })
}

/// Returns the built-in characters, each with its type, that the game does not map and whose type it does not
/// declare with a class. A renamed copy does not map them, because a mapping would add a rule.
pub(super) fn unmapped_builtins(description: &Description) -> impl Iterator<Item = (char, &'static str)> {
    let undeclared = |symbol: char| {
        let name = unmapped(symbol, description)?;
        builtin(symbol, description).is_none().then_some((symbol, name))
    };
    ['w', 'A'].into_iter().filter_map(undeclared)
}

/// Returns the built-in characters that this game maps itself. A renamed copy must map these characters too, or they
/// would acquire a built-in meaning that they do not have in this game.
pub(super) fn mapped_builtins(description: &Description) -> impl Iterator<Item = char> {
    ['w', 'A'].into_iter().filter(|&symbol| unmapped(symbol, description).is_none())
}

/// Returns a character's built-in type, unless the game itself maps the character.
fn unmapped(symbol: char, description: &Description) -> Option<&'static str> {
    let name = match symbol {
        'w' => "wall",
        'A' => "avatar",
        _ => return None,
    };
    (!description.mapping.iter().any(|line| line.symbol == symbol)).then_some(name)
}

/// The mapping from old to new level characters.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Symbols(pub(super) BTreeMap<char, char>);

impl Symbols {
    /// Translates a level to the new characters. Unmapped characters become spaces.
    pub(super) fn level(&self, text: &str) -> String {
        let symbol = |c: char| match self.0.get(&c) {
            Some(&new) => new,
            None if c.is_whitespace() => c,
            None => ' ',
        };
        text.chars().map(symbol).collect()
    }

    /// Writes the game's LevelMapping with the new characters. Each built-in character gets its own line.
    pub(super) fn write(&self, description: &mut Description) {
        let lines = self.0.iter().filter_map(|(&symbol, &new)| {
            let names = vec![builtin(symbol, description)?.into()];
            Some(MappingLine { symbol: new, names, ..MappingLine::default() })
        });
        let more: Vec<MappingLine> = lines.collect();
        for line in &mut description.mapping {
            line.symbol = *self.0.get(&line.symbol).unwrap_or(&line.symbol);
        }
        description.mapping.extend(more);
    }
}
