//! The words in a game's text and their roles, line by line. An incomplete line affects only its own words, and roles
//! are known even if the game does not compile.

use crate::values;
use crate::values::Owner;
use engine::limits::MAX_LINE;
use engine::syntax::Section;
use engine::{EFFECTS, MAX_SOURCE, Span, SpriteClass, TERMINATIONS, nearest};
use std::collections::BTreeSet;

/// The built-in sprite types, which exist in every game, with their classes.
pub(crate) const BUILT_IN: [(&str, SpriteClass); 2] =
    [("wall", SpriteClass::Immovable), ("avatar", SpriteClass::MovingAvatar)];

/// The words in interactions that do not refer to a sprite.
pub(crate) const EDGES: [&str; 2] = ["EOS", "TIME"];

/// All sections, in canonical order.
pub(crate) const SECTIONS: [Section; 5] = [
    Section::ParameterSet,
    Section::SpriteSet,
    Section::LevelMapping,
    Section::InteractionSet,
    Section::TerminationSet,
];

/// A line's location in the game.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Place {
    /// The first line of the game.
    Header,
    /// A section name.
    Head(Section),
    /// A line in a section.
    Body(Section),
    /// A line before all sections.
    Outside,
}

/// A word's role.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Role {
    /// The word `BasicGame` or `GameSpace`.
    GameClass,
    /// A section name.
    Section(Section),
    /// A sprite type's name in its declaration.
    Declaration,
    /// A reference to a sprite type.
    Sprite,
    /// A sprite class.
    Class,
    /// An effect keyword.
    Effect,
    /// The word `EOS` or `TIME`.
    Edge,
    /// A termination class.
    Termination,
    /// A level character in its declaration.
    Symbol,
    /// A parameter name.
    Key,
    /// A parameter value that refers to neither a sprite nor an effect.
    Value,
    /// A `GameSpace` parameter's name in its declaration.
    Parameter,
    /// A reference to a `GameSpace` parameter as a value.
    ParameterUse,
    /// The arrow `>`.
    Arrow,
    /// A misplaced word.
    Stray,
}

/// A word, an entry in a list of names, or one half of a parameter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Word<'a> {
    pub(crate) text: &'a str,
    pub(crate) span: Span,
    pub(crate) role: Role,
    pub(crate) owner: Owner<'a>,
    /// The parameter whose value contains the word; `None` for a word outside parameter values.
    pub(crate) key: Option<&'a str>,
}

/// A line with at least one word.
#[derive(Clone, Debug)]
pub(crate) struct Line<'a> {
    pub(crate) place: Place,
    /// The span of the line, excluding indentation, comment and trailing spaces.
    pub(crate) span: Span,
    pub(crate) words: Vec<Word<'a>>,
}

/// A SpriteSet line.
#[derive(Clone, Debug)]
pub(crate) struct Sprite<'a> {
    pub(crate) name: &'a str,
    /// The class of the sprites. An inherited class takes precedence over a class on the line.
    pub(crate) class: Option<SpriteClass>,
    /// The index of the parent type; `None` for a type without a parent.
    pub(crate) parent: Option<usize>,
    /// The parameters on the line.
    pub(crate) params: Vec<(&'a str, &'a str)>,
}

/// A game's text, split into words.
#[derive(Clone, Debug)]
pub(crate) struct Words<'a> {
    pub(crate) lines: Vec<Line<'a>>,
    pub(crate) sprites: Vec<Sprite<'a>>,
}

/// Returns `true` if the engine treats a character as a word separator.
pub(crate) fn is_blank(c: char) -> bool {
    c <= ' '
}

/// Returns the part of a line before its comment. A comment starts with `#`, or with `//` as in other
/// languages.
pub(crate) fn code(raw: &str) -> &str {
    let code = raw.split('#').next().unwrap_or_default();
    let foreign = |&(at, _): &(usize, &str)| code[..at].chars().next_back().is_none_or(is_blank);
    match code.match_indices("//").find(foreign) {
        Some((at, _)) => &code[..at],
        None => code,
    }
}

/// Returns the section named on a line, even if its name is misspelt.
fn section(text: &str) -> Option<Section> {
    let exact = SECTIONS.into_iter().find(|section| section.name() == text);
    exact.or_else(|| {
        let is_word = !text.contains(|c: char| is_blank(c) || c == '=') && !TERMINATIONS.contains(&text);
        let name = nearest(text, SECTIONS.map(Section::name)).filter(|_| is_word)?;
        SECTIONS.into_iter().find(|section| section.name() == name)
    })
}

impl<'a> Words<'a> {
    /// Splits a text into words. A text that is too long to parse yields no words, and lines that are too long are
    /// omitted.
    pub(crate) fn of(source: &'a str) -> Words<'a> {
        if source.len() > MAX_SOURCE {
            return Words { lines: Vec::new(), sprites: Vec::new() };
        }
        let mut raw = Vec::new();
        let mut start = 0;
        let mut place = Place::Outside;
        for line in source.split(['\n', '\r']) {
            let own = start;
            start += line.len() + 1;
            let marked = line.starts_with('\u{feff}') && own == 0;
            let skipped = if marked { '\u{feff}'.len_utf8() } else { 0 };
            let code = code(&line[skipped..]);
            let text = code.trim_matches(is_blank);
            if text.is_empty() || text.len() > MAX_LINE {
                continue;
            }
            let at = own + skipped + (code.len() - code.trim_start_matches(is_blank).len());
            let found = section(text);
            place = match (found, place) {
                (Some(section), _) => Place::Head(section),
                (None, Place::Outside) if raw.is_empty() => Place::Header,
                (None, Place::Header | Place::Outside) => Place::Outside,
                (None, Place::Head(section) | Place::Body(section)) => Place::Body(section),
            };
            raw.push((place, at - own - skipped, at, text));
        }
        let sprites = sprites(raw.iter().filter(|line| line.0 == Place::Body(Section::SpriteSet)));
        let in_space = |line: &&(Place, usize, usize, &'a str)| line.0 == Place::Body(Section::ParameterSet);
        let parameters: BTreeSet<&str> =
            raw.iter().filter(in_space).filter_map(|line| line.3.split(is_blank).next()).collect();
        let mut declared = sprites.iter();
        let lines = raw.iter().map(|&(place, _, at, text)| {
            let class = match place {
                Place::Body(Section::SpriteSet) => declared.next().and_then(|sprite| sprite.class),
                _ => None,
            };
            let reader = Reader { place, class, parameters: &parameters };
            Line { place, span: Span::new(at, at + text.len()), words: reader.words(at, text) }
        });
        Words { lines: lines.collect(), sprites }
    }

    /// Returns all words, in the order of the text.
    pub(crate) fn all(&self) -> impl Iterator<Item = &Word<'a>> {
        self.lines.iter().flat_map(|line| &line.words)
    }

    /// Returns the word at byte `at`, or the word that ends at that byte; `None` if there is no such word.
    pub(crate) fn at(&self, at: usize) -> Option<&Word<'a>> {
        let mut around = self.all().filter(|word| word.span.start <= at && at <= word.span.end);
        let first = around.next()?;
        Some(around.next().filter(|next| next.span.start == at).unwrap_or(first))
    }

    /// Returns the first sprite line with this name; `None` if there is no such line.
    pub(crate) fn sprite(&self, name: &str) -> Option<&Sprite<'a>> {
        self.sprites.iter().find(|sprite| sprite.name == name)
    }

    /// Returns a type's ancestors, starting with its parent.
    pub(crate) fn ancestors<'b>(&'b self, sprite: &'b Sprite<'a>) -> impl Iterator<Item = &'b Sprite<'a>> {
        std::iter::successors(Some(sprite), |sprite| self.sprites.get(sprite.parent?)).skip(1)
    }

    /// Returns a type's parameters, each with `true` if it is inherited. The type's own parameters come
    /// first.
    pub(crate) fn params(&self, sprite: &Sprite<'a>) -> Vec<(&'a str, &'a str, bool)> {
        let mut seen = BTreeSet::new();
        let own = sprite.params.iter().map(|&(key, value)| (key, value, false));
        let above = self.ancestors(sprite).flat_map(|above| &above.params);
        let all = own.chain(above.map(|&(key, value)| (key, value, true)));
        all.filter(|(key, ..)| seen.insert(*key)).collect()
    }

    /// Returns the distinct names of all sprite types: the declared types in the order of their lines, then the
    /// built-in types.
    pub(crate) fn sprite_names(&self) -> Vec<&'a str> {
        let mut seen = BTreeSet::new();
        let declared = self.sprites.iter().map(|sprite| sprite.name);
        declared.chain(BUILT_IN.map(|(name, _)| name)).filter(|name| seen.insert(*name)).collect()
    }

    /// Returns the LevelMapping lines, each as a character and the names that it places.
    pub(crate) fn mapping(&self) -> impl Iterator<Item = (&Word<'a>, impl Iterator<Item = &'a str>)> {
        let own = self.lines.iter().filter(|line| line.place == Place::Body(Section::LevelMapping));
        own.filter_map(|line| {
            let symbol = line.words.first().filter(|word| word.role == Role::Symbol)?;
            let names = line.words.iter().filter(|word| word.role == Role::Sprite).map(|word| word.text);
            Some((symbol, names))
        })
    }
}

/// Returns the sprite types declared on the lines of a SpriteSet.
fn sprites<'a, 'b>(lines: impl Iterator<Item = &'b (Place, usize, usize, &'a str)>) -> Vec<Sprite<'a>>
where
    'a: 'b,
{
    let mut sprites: Vec<Sprite<'a>> = Vec::new();
    // The indices of the ancestors, each with its indentation and the class that its subtypes inherit.
    let mut above: Vec<(usize, usize, Option<&'a str>)> = Vec::new();
    for &(_, indent, _, text) in lines {
        while above.last().is_some_and(|&(_, outer, _)| outer >= indent) {
            above.pop();
        }
        let parent = above.last().copied();
        let mut words = text.split(is_blank).filter(|word| !word.is_empty());
        let name =
            words.clone().next().filter(|word| *word != ">" && !word.contains('=')).unwrap_or_default();
        let written = words.clone().skip_while(|word| *word != ">").skip(1).find(|word| !word.contains('='));
        let params: Vec<(&str, &str)> = words
            .by_ref()
            .filter_map(|word| word.split_once('='))
            .filter(|(key, _)| !key.is_empty())
            .collect();
        let inherited = parent.and_then(|(_, _, class)| class);
        above.push((sprites.len(), indent, written.or(inherited)));
        sprites.push(Sprite {
            name,
            class: inherited.or(written).and_then(SpriteClass::from_name),
            parent: parent.map(|(parent, ..)| parent),
            params,
        });
    }
    sprites
}

/// A parser that assigns roles to a line's words.
struct Reader<'b> {
    place: Place,
    /// The class of the line's sprite type.
    class: Option<SpriteClass>,
    /// The names of the `GameSpace` parameters.
    parameters: &'b BTreeSet<&'b str>,
}

impl Reader<'_> {
    fn words<'a>(&self, start: usize, text: &'a str) -> Vec<Word<'a>> {
        let mut at = start;
        let mut tokens = Vec::new();
        for token in text.split(is_blank) {
            if !token.is_empty() {
                tokens.push((at, token));
            }
            // A separator is one byte long.
            at += token.len() + 1;
        }
        let is_arrow = |&(_, token): &(usize, &str)| token == ">";
        let symbol = self.place == Place::Body(Section::LevelMapping);
        let arrow =
            tokens.iter().skip(usize::from(symbol)).position(is_arrow).map(|at| at + usize::from(symbol));
        let plain = |(at, token): (usize, &'a str)| (!token.contains('=')).then_some((at, token));
        let after =
            |arrow: usize| tokens[arrow + 1..].iter().copied().find_map(plain).map(|(_, token)| token);
        let key = |key: &str| {
            tokens.iter().filter_map(|(_, token)| token.split_once('=')).find(|(own, _)| *own == key)
        };
        let owner = match self.place {
            Place::Header => Owner::Game,
            Place::Body(Section::SpriteSet) => Owner::Sprite(self.class),
            Place::Body(Section::InteractionSet) => match arrow.and_then(after) {
                Some(effect) => Owner::Effect(effect, key("ftype").map(|(_, planned)| planned)),
                None => Owner::Nobody,
            },
            Place::Body(Section::TerminationSet) => tokens
                .iter()
                .copied()
                .find_map(plain)
                .map_or(Owner::Nobody, |(_, class)| Owner::Termination(class)),
            Place::Body(Section::ParameterSet) => Owner::Parameter,
            Place::Body(Section::LevelMapping) | Place::Head(_) | Place::Outside => Owner::Nobody,
        };
        let mut words = Vec::new();
        let mut seen = [0; 2];
        for (index, &(at, token)) in tokens.iter().enumerate() {
            let is_past = arrow.is_some_and(|arrow| index > arrow);
            let word =
                |role| Word { text: token, span: Span::new(at, at + token.len()), role, owner, key: None };
            if arrow == Some(index) {
                words.push(word(Role::Arrow));
                continue;
            }
            if let Some((key, value)) = token.split_once('=').filter(|_| !(symbol && index == 0)) {
                self.param(at, key, value, owner, &mut words);
                continue;
            }
            let count = &mut seen[usize::from(is_past)];
            let role = self.role(token, is_past, *count);
            *count += 1;
            words.push(word(role));
        }
        words
    }

    /// Returns the role of a word that is preceded by `count` words on the same side of the arrow.
    fn role(&self, token: &str, is_past: bool, count: usize) -> Role {
        use Section as S;
        match (self.place, is_past, count) {
            (Place::Header, false, 0) => Role::GameClass,
            (Place::Head(section), ..) => Role::Section(section),
            (Place::Body(S::SpriteSet), false, 0) => Role::Declaration,
            (Place::Body(S::SpriteSet), true, 0) => Role::Class,
            (Place::Body(S::LevelMapping), false, 0) => Role::Symbol,
            (Place::Body(S::LevelMapping), true, _) => Role::Sprite,
            (Place::Body(S::InteractionSet), true, 0) => Role::Effect,
            (Place::Body(S::InteractionSet), false, _) if EDGES.contains(&token) => Role::Edge,
            // The arrow is not written yet.
            (Place::Body(S::InteractionSet), false, 2..) if EFFECTS.contains(&token) => Role::Effect,
            (Place::Body(S::InteractionSet), false, _) => Role::Sprite,
            (Place::Body(S::TerminationSet), _, 0) => Role::Termination,
            (Place::Body(S::ParameterSet), false, 0) => Role::Parameter,
            _ => Role::Stray,
        }
    }

    fn param<'a>(
        &self,
        at: usize,
        key: &'a str,
        value: &'a str,
        owner: Owner<'a>,
        words: &mut Vec<Word<'a>>,
    ) {
        let span = Span::new(at, at + key.len());
        words.push(Word { text: key, span, role: Role::Key, owner, key: None });
        let mut start = span.end + 1;
        let kind = values::kind(owner, key);
        let role = match kind {
            Some(values::Kind::Sprites) => Role::Sprite,
            Some(values::Kind::Effect) => Role::Effect,
            _ if self.parameters.contains(value) => Role::ParameterUse,
            _ => Role::Value,
        };
        let parts = if role == Role::Sprite { value.split(',').collect() } else { vec![value] };
        for part in parts {
            let span = Span::new(start, start + part.len());
            start = span.end + 1;
            if !part.is_empty() {
                words.push(Word { text: part, span, role, owner, key: Some(key) });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn roles(source: &str) -> Vec<(&str, Role)> {
        Words::of(source).all().map(|word| (word.text, word.role)).collect()
    }

    #[test]
    fn every_word_has_its_part() {
        let source = "\u{feff}BasicGame obs=a,b # game\n SpriteSet\n  den > SpawnPoint stype=fox color=RED\n LevelMapping\n  = > den\n InteractionSet\n  fox EOS > addTimer ftype=killAll stype=den\n TerminationSet\n  Timeout limit=5\n";
        use Role as R;
        assert_eq!(
            roles(source),
            [
                ("BasicGame", R::GameClass),
                ("obs", R::Key),
                ("a", R::Sprite),
                ("b", R::Sprite),
                ("SpriteSet", R::Section(Section::SpriteSet)),
                ("den", R::Declaration),
                (">", R::Arrow),
                ("SpawnPoint", R::Class),
                ("stype", R::Key),
                ("fox", R::Sprite),
                ("color", R::Key),
                ("RED", R::Value),
                ("LevelMapping", R::Section(Section::LevelMapping)),
                ("=", R::Symbol),
                (">", R::Arrow),
                ("den", R::Sprite),
                ("InteractionSet", R::Section(Section::InteractionSet)),
                ("fox", R::Sprite),
                ("EOS", R::Edge),
                (">", R::Arrow),
                ("addTimer", R::Effect),
                ("ftype", R::Key),
                ("killAll", R::Effect),
                ("stype", R::Key),
                ("den", R::Sprite),
                ("TerminationSet", R::Section(Section::TerminationSet)),
                ("Timeout", R::Termination),
                ("limit", R::Key),
                ("5", R::Value),
            ]
        );
        for word in Words::of(source).all() {
            assert_eq!(&source[word.span.start..word.span.end], word.text);
        }
    }

    #[test]
    fn subtypes_inherit_classes_and_parameters() {
        let source = "BasicGame\n SpriteSet\n  beast > Missile speed=2 color=RED\n   fox > RandomNPC color=BLUE\n  rock > Immovable\n";
        let words = Words::of(source);
        let fox = words.sprite("fox").unwrap();
        assert_eq!(fox.class, Some(SpriteClass::Missile));
        assert_eq!(words.params(fox), [("color", "BLUE", false), ("speed", "2", true)]);
        assert_eq!(words.sprite("rock").unwrap().parent, None);
    }

    #[test]
    fn half_written_lines_have_words_too() {
        let source = "BasicGame\n SpritSet\n  fox > \n InteractionSet\n  fox wall";
        let found = roles(source);
        assert_eq!(found[2], ("fox", Role::Declaration));
        assert_eq!(found[5..], [("fox", Role::Sprite), ("wall", Role::Sprite)]);
    }
}
