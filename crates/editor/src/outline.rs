//! A game's outline: its sections and their declarations.

use crate::words::{Line, Place, Role, Words};
use engine::Span;
use engine::syntax::Section;

/// The kind of an outline entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EntryKind {
    /// A section.
    Section,
    /// A sprite type.
    Sprite,
    /// A level character.
    Symbol,
    /// An interaction.
    Interaction,
    /// A termination.
    Termination,
    /// A parameter of a `GameSpace`.
    Parameter,
}

/// An entry in an outline.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Entry {
    /// The entry's name. For an interaction, the name consists of its sprites and its effect.
    pub name: String,
    /// The type's class, or the names that the character places. May be empty.
    pub detail: String,
    /// The kind of the entry.
    pub kind: EntryKind,
    /// The span of the whole entry, including its children.
    pub span: Span,
    /// The span of the name.
    pub name_span: Span,
    /// The entries inside this entry.
    pub children: Vec<Entry>,
}

/// Returns the sections of a game's text with their lines. Subtypes are nested under their parents.
pub fn outline(source: &str) -> Vec<Entry> {
    let words = Words::of(source);
    let mut sections: Vec<Entry> = Vec::new();
    let mut sprites = words.sprites.iter().map(|sprite| sprite.parent);
    // The ancestors of the last sprite, each with its index among its siblings.
    let mut path: Vec<(usize, usize)> = Vec::new();
    for line in &words.lines {
        if let Place::Head(section) = line.place {
            let (name, detail) = (section.name().to_owned(), String::new());
            let (span, name_span) = (line.span, line.span);
            sections.push(Entry {
                name,
                detail,
                kind: EntryKind::Section,
                span,
                name_span,
                children: Vec::new(),
            });
            path.clear();
            continue;
        }
        let (Place::Body(section), Some(head)) = (line.place, sections.last_mut()) else { continue };
        let entry = entry(source, section, line);
        head.span.end = head.span.end.max(line.span.end);
        if section != Section::SpriteSet {
            head.children.push(entry);
            continue;
        }
        let parent = sprites.next().flatten();
        let number = words.sprites.len() - sprites.len() - 1;
        while path.last().is_some_and(|&(last, _)| Some(last) != parent) {
            path.pop();
        }
        let mut siblings = &mut head.children;
        for &(_, place) in &path {
            siblings[place].span.end = siblings[place].span.end.max(line.span.end);
            siblings = &mut siblings[place].children;
        }
        path.push((number, siblings.len()));
        siblings.push(entry);
    }
    sections
}

fn entry(source: &str, section: Section, line: &Line<'_>) -> Entry {
    let of = |role: Role| line.words.iter().filter(move |word| word.role == role).map(|word| word.text);
    let first = line.words.first();
    let before = |word: &&crate::words::Word<'_>| !matches!(word.role, Role::Key | Role::Value);
    let end = line.words.iter().take_while(before).last().map_or(line.span.end, |word| word.span.end);
    let head = Span::new(line.span.start, end);
    let name_span = first.map_or(line.span, |word| word.span);
    let text = |span: Span| source.get(span.start..span.end).unwrap_or_default().to_owned();
    let (kind, name, detail, name_span) = match section {
        Section::SpriteSet => {
            (EntryKind::Sprite, text(name_span), of(Role::Class).collect::<Vec<_>>().join(" "), name_span)
        }
        Section::LevelMapping => {
            (EntryKind::Symbol, text(name_span), of(Role::Sprite).collect::<Vec<_>>().join(" "), name_span)
        }
        Section::InteractionSet => (EntryKind::Interaction, text(head), String::new(), head),
        Section::TerminationSet => (EntryKind::Termination, text(line.span), String::new(), name_span),
        Section::ParameterSet => (EntryKind::Parameter, text(name_span), String::new(), name_span),
    };
    Entry { name, detail, kind, span: line.span, name_span, children: Vec::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn subtypes_stand_below_their_parents() {
        let source = "BasicGame\n SpriteSet\n  a > Immovable\n   b > color=RED\n    c > \n   d > \n  e > Missile\n LevelMapping\n  x > a e\n InteractionSet\n  a b > killSprite scoreChange=1\n TerminationSet\n  Timeout limit=5\n";
        fn told(entries: &[Entry]) -> String {
            let one = |entry: &Entry| format!("{}:{}[{}]", entry.name, entry.detail, told(&entry.children));
            entries.iter().map(one).collect::<Vec<_>>().join(" ")
        }
        let outline = outline(source);
        let text = told(&outline);
        assert_eq!(
            text,
            "SpriteSet:[a:Immovable[b:[c:[]] d:[]] e:Missile[]] LevelMapping:[x:a e[]] InteractionSet:[a b > killSprite:[]] TerminationSet:[Timeout limit=5:[]]"
        );
        let a = &outline[0].children[0];
        assert_eq!(&source[a.span.start..a.span.end], "a > Immovable\n   b > color=RED\n    c > \n   d >");
        assert!(
            a.children.iter().all(|child| a.span.start <= child.span.start && child.span.end <= a.span.end)
        );
    }
}
