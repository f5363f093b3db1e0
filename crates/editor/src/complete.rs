//! Completions: the words that can be inserted at a position.

use crate::hover::{of_section, of_setting};
use crate::pages;
use crate::values::Owner;
use crate::values::{self, Kind};
use crate::words::{EDGES, Line, Place, Role, SECTIONS, Words, code, is_blank};
use engine::syntax::Section;
use engine::{EFFECTS, Span, SpriteClass, TERMINATIONS};
use std::collections::BTreeMap;

/// The words that can be inserted at a position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Completion {
    /// The part of the word that has already been written. The chosen item replaces it.
    pub span: Span,
    /// The words, most likely first. Words that do not match the part already written are included.
    pub items: Vec<Item>,
}

/// A word that can be inserted at a position.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Item {
    /// The offered word.
    pub label: String,
    /// The kind of word.
    pub kind: ItemKind,
    /// A short description, which may be empty.
    pub detail: String,
    /// An explanation in Markdown, which may be empty.
    pub markdown: String,
    /// The text to insert.
    pub insert: String,
}

/// The kind of a word in a completion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ItemKind {
    /// A sprite class.
    Class,
    /// A sprite type in the game.
    Sprite,
    /// An effect.
    Effect,
    /// A termination.
    Termination,
    /// A parameter name.
    Parameter,
    /// A parameter value.
    Value,
    /// A section, or the keyword at the beginning of a game.
    Keyword,
}

impl Item {
    fn new(label: &str, kind: ItemKind, detail: String) -> Item {
        let (label, insert) = (label.to_owned(), label.to_owned());
        Item { label, kind, detail, markdown: String::new(), insert }
    }
}

/// Returns the words that can be inserted at byte `at` of a game's text.
pub fn complete(source: &str, at: usize) -> Completion {
    let nothing = |at: usize| Completion { span: Span::new(at, at), items: Vec::new() };
    let Some(before) = source.get(..at) else { return nothing(source.len()) };
    let line_start = before.rfind(['\n', '\r']).map_or(0, |newline| newline + 1);
    let written = before[line_start..].trim_start_matches('\u{feff}');
    if code(written).len() < written.len() {
        // The position is in a comment.
        return nothing(at);
    }
    let word_start = at - written.len() + written.rfind(is_blank).map_or(0, |blank| blank + 1);
    let word = &source[word_start..at];
    let words = Words::of(source);
    let line = words.lines.iter().find(|line| line_start <= line.span.start && line.span.start < at);
    let context = Context { words: &words, line, line_start, word_start };
    let (start, items) = match word.split_once('=') {
        Some((key, value)) if context.allows_parameters() => {
            let entry = value.rfind(',').map_or(0, |comma| comma + 1);
            (word_start + key.len() + 1 + entry, context.values(key))
        }
        _ => (word_start, context.words()),
    };
    Completion { span: Span::new(start, at), items }
}

/// The position at which words are completed.
struct Context<'a, 'b> {
    words: &'b Words<'a>,
    /// The line of the position, if it contains a word before the position.
    line: Option<&'b Line<'a>>,
    line_start: usize,
    word_start: usize,
}

impl<'a> Context<'a, '_> {
    /// Returns the line's role in the game.
    fn place(&self) -> Place {
        let above = self.words.lines.iter().take_while(|line| line.span.start < self.line_start).last();
        let above = above.map(|line| line.place);
        match (above, self.line.map(|line| line.place)) {
            (None, _) => Place::Header,
            // The line may look like a section name only because it is incomplete.
            (Some(Place::Head(section) | Place::Body(section)), _) => Place::Body(section),
            (Some(Place::Header | Place::Outside), own) => own.unwrap_or(Place::Outside),
        }
    }

    /// Returns the words on the line before the position, excluding the word being written.
    fn before(&self) -> impl Iterator<Item = &crate::words::Word<'a>> {
        let words = self.line.map_or(&[][..], |line| &line.words);
        words.iter().take_while(|word| word.span.start < self.word_start)
    }

    fn is_past_arrow(&self) -> bool {
        self.before().any(|word| word.role == Role::Arrow)
    }

    /// Returns `true` if lines of this kind accept parameters after their other words.
    fn allows_parameters(&self) -> bool {
        self.place() != Place::Body(Section::LevelMapping)
    }

    fn owner(&self) -> Owner<'a> {
        let of_line = self.line.and_then(|line| line.words.iter().map(|word| word.owner).next());
        match (self.place(), of_line) {
            (Place::Header, _) => Owner::Game,
            (_, Some(owner)) => owner,
            (_, None) => Owner::Nobody,
        }
    }

    fn words(&self) -> Vec<Item> {
        let seen = |role: Role| self.before().any(|word| word.role == role);
        let first = self.before().next().is_none();
        match self.place() {
            Place::Header if first => ["BasicGame", "GameSpace"]
                .map(|name| Item::new(name, ItemKind::Keyword, String::new()))
                .into(),
            Place::Header => self.parameters(),
            Place::Outside | Place::Head(_) => self.sections(),
            Place::Body(Section::SpriteSet) if first => self.sections(),
            Place::Body(Section::SpriteSet) if !self.is_past_arrow() => Vec::new(),
            Place::Body(Section::SpriteSet) if !seen(Role::Class) => [classes(), self.parameters()].concat(),
            Place::Body(Section::SpriteSet) => self.parameters(),
            Place::Body(Section::LevelMapping) if first => self.sections(),
            Place::Body(Section::LevelMapping) if self.is_past_arrow() => self.sprites(),
            Place::Body(Section::LevelMapping) => Vec::new(),
            Place::Body(Section::InteractionSet) if !self.is_past_arrow() => {
                let edges = EDGES.map(|edge| Item::new(edge, ItemKind::Keyword, String::new()));
                let sections = if first { self.sections() } else { Vec::new() };
                [self.sprites(), edges.into(), sections].concat()
            }
            Place::Body(Section::InteractionSet) if !seen(Role::Effect) => effects(),
            Place::Body(Section::InteractionSet) => self.parameters(),
            Place::Body(Section::TerminationSet) if first => {
                let all = TERMINATIONS.iter().map(|name| of_page(name, ItemKind::Termination));
                all.chain(self.sections()).collect()
            }
            Place::Body(Section::TerminationSet) => self.parameters(),
            Place::Body(Section::ParameterSet) if first => self.sections(),
            Place::Body(Section::ParameterSet) => self.parameters(),
        }
    }

    /// Returns the sections that the game does not contain yet.
    fn sections(&self) -> Vec<Item> {
        let in_space = self.words.all().next().is_some_and(|word| word.text == "GameSpace");
        let has = |section: Section| {
            self.words.lines.iter().any(|line| {
                line.place == Place::Head(section)
                    && !(self.line_start..=self.word_start).contains(&line.span.start)
            })
        };
        let missing = SECTIONS.into_iter().filter(|&section| !has(section));
        missing
            .filter(|section| in_space || *section != Section::ParameterSet)
            .map(|section| Item {
                markdown: of_section(section).to_owned(),
                ..Item::new(section.name(), ItemKind::Keyword, "section".to_owned())
            })
            .collect()
    }

    fn sprites(&self) -> Vec<Item> {
        let is_own = |name: &&str| !name.is_empty();
        let own = self.line.filter(|line| line.place == Place::Body(Section::SpriteSet));
        let own = own.and_then(|line| line.words.first()).map(|word| word.text);
        let names = self.words.sprite_names().into_iter().filter(is_own).filter(|name| Some(*name) != own);
        // If a type is declared twice, the first declaration counts, as everywhere in this crate.
        let classes: BTreeMap<&str, Option<SpriteClass>> =
            self.words.sprites.iter().rev().map(|sprite| (sprite.name, sprite.class)).collect();
        names
            .map(|name| {
                let class = classes.get(name).copied().flatten();
                let class = class.map_or(String::new(), |class| class.name().to_owned());
                Item::new(name, ItemKind::Sprite, class)
            })
            .collect()
    }

    /// Returns the parameters that the line does not contain yet.
    fn parameters(&self) -> Vec<Item> {
        let owner = self.owner();
        let given: Vec<&str> = self.line.map_or(Vec::new(), |line| {
            let others = line.words.iter().filter(|word| word.span.start != self.word_start);
            others.filter(|word| word.role == Role::Key).map(|word| word.text).collect()
        });
        let free = pages::parameters(owner).into_iter().filter(|key| !given.contains(key));
        free.map(|key| {
            let row = pages::row(owner, key);
            let detail = match (&row, owner) {
                (_, Owner::Game) => of_setting(key).unwrap_or_default().to_owned(),
                (Some(row), _) if !row.default.is_empty() => format!("default: {}", row.default),
                _ => String::new(),
            };
            let markdown = row.map_or(String::new(), |row| row.meaning);
            Item { markdown, insert: format!("{key}="), ..Item::new(key, ItemKind::Parameter, detail) }
        })
        .collect()
    }

    /// Returns a parameter's values.
    fn values(&self, key: &str) -> Vec<Item> {
        match values::kind(self.owner(), key) {
            Some(Kind::Sprites) => self.sprites(),
            Some(Kind::Effect) => effects(),
            Some(kind) => {
                let all = values::values(kind).iter();
                all.map(|value| Item::new(value, ItemKind::Value, String::new())).collect()
            }
            None => Vec::new(),
        }
    }
}

/// The most commonly used classes and effects, in suggestion order. All others follow.
const COMMON: [&str; 24] = [
    "Immovable",
    "MovingAvatar",
    "ShootAvatar",
    "FlakAvatar",
    "Missile",
    "Resource",
    "Passive",
    "RandomNPC",
    "Chaser",
    "SpawnPoint",
    "Door",
    "Portal",
    "stepBack",
    "killSprite",
    "killBoth",
    "collectResource",
    "killIfOtherHasMore",
    "bounceForward",
    "undoAll",
    "transformTo",
    "pullWithIt",
    "wrapAround",
    "turnAround",
    "teleportToExit",
];

fn classes() -> Vec<Item> {
    common_first(SpriteClass::ALL.iter().map(|class| of_page(class.name(), ItemKind::Class)).collect())
}

fn effects() -> Vec<Item> {
    common_first(EFFECTS.iter().map(|effect| of_page(effect, ItemKind::Effect)).collect())
}

fn common_first(mut items: Vec<Item>) -> Vec<Item> {
    let rank = |item: &Item| COMMON.iter().position(|word| *word == item.label).unwrap_or(COMMON.len());
    items.sort_by_key(rank);
    items
}

/// The maximum length of a word's description, in characters.
const SHORT: usize = 60;

fn of_page(word: &str, kind: ItemKind) -> Item {
    let summary = pages::summary(word).unwrap_or_default();
    let sentence = summary.split(['.', ':', ';']).next().unwrap_or_default().replace('`', "");
    let detail = match sentence.char_indices().nth(SHORT) {
        Some((end, _)) => format!("{}…", sentence[..end].trim_end()),
        None => sentence,
    };
    Item { markdown: summary, ..Item::new(word, kind, detail) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAME: &str = "BasicGame |\n    SpriteSet\n        fox > Missile orientation=RIGHT\n        den > SpawnPoint stype=fox\n    LevelMapping\n        f > fox\n    InteractionSet\n        fox wall > killSprite\n    TerminationSet\n        Timeout limit=9\n";

    /// Checks the completions at the `|` in `instead`, which replaces `part` in the game. `offered` are words that
    /// must be offered, and `others` are words that must not be offered.
    #[track_caller]
    fn check(part: &str, instead: &str, offered: &[&str], others: &[&str]) {
        let game = GAME.replace('|', "");
        assert!(game.contains(part), "{part}");
        let text = game.replace(part, instead);
        let at = text.find('|').unwrap();
        let text = text.replace('|', "");
        let completion = complete(&text, at);
        let has = |label: &str| completion.items.iter().any(|item| item.label == label);
        let labels: Vec<&str> = completion.items.iter().map(|item| item.label.as_str()).collect();
        assert!(offered.iter().all(|label| has(label)), "{offered:?} among {labels:?}");
        assert!(!others.iter().any(|label| has(label)), "{others:?} not among {labels:?}");
        assert!(completion.span.start <= at && completion.span.end == at);
    }

    #[test]
    fn what_can_stand_at_a_place_is_offered() {
        check("BasicGame ", "Ba|", &["BasicGame"], &["SpriteSet"]);
        check("BasicGame ", "BasicGame |", &["square_size"], &["BasicGame"]);
        check("fox > Missile", "fox > |", &["Missile", "RandomNPC", "speed"], &["killSprite", "orientation"]);
        check("fox > Missile", "fox > Mis|", &["Missile"], &["killSprite"]);
        check("stype=fox", "|", &["stype", "cooldown", "total"], &["Missile", "angle_diff"]);
        check("stype=fox", "stype=|", &["fox", "avatar"], &["den", "True"]);
        check("stype=fox", "orientation=R|", &["RIGHT"], &["fox"]);
        check("stype=fox", "color=|", &["PINK"], &["fox"]);
        check("stype=fox", "singleton=|", &["True", "False"], &["fox"]);
        check("f > fox", "f > |", &["fox", "den", "wall"], &["Missile"]);
        check("fox wall > killSprite", "|", &["fox", "EOS"], &["killSprite", "SpriteSet"]);
        check("fox wall > killSprite", "fox w|", &["wall"], &["killSprite"]);
        check("fox wall > killSprite", "fox wall > |", &["killSprite", "transformTo"], &["fox"]);
        check("fox wall > killSprite", "fox wall > transformTo |", &["stype", "scoreChange"], &["limit"]);
        check("fox wall > killSprite", "fox wall > transformTo stype=|", &["fox"], &["killSprite"]);
        check("fox wall > killSprite", "fox wall > addTimer ftype=|", &["killAll"], &["fox"]);
        check(
            "fox wall > killSprite",
            "fox wall > addTimer ftype=killAll |",
            &["stype", "timer"],
            &["ftype"],
        );
        check("Timeout limit=9", "|", &["Timeout", "SpriteCounter"], &["fox"]);
        check("Timeout limit=9", "SpriteCounter stype=|", &["fox"], &["Timeout"]);
        check("Timeout limit=9", "Timeout win=|", &["True"], &["fox"]);
        check(
            "    TerminationSet\n        Timeout limit=9\n",
            "    Ter|",
            &["TerminationSet", "fox"],
            &["SpriteSet"],
        );
    }

    #[test]
    fn common_words_come_first_with_their_meaning() {
        let game = GAME.replace('|', "").replace("fox wall > killSprite", "fox wall > ");
        let at = game.find("fox wall > ").unwrap() + "fox wall > ".len();
        let items = complete(&game, at).items;
        let first: Vec<_> =
            items.iter().take(2).map(|item| (item.label.as_str(), item.detail.as_str())).collect();
        assert_eq!(first[1], ("killSprite", "Removes the first sprite"));
        assert_eq!(first[0].0, "stepBack");
        assert!(items.iter().all(|item| !item.detail.is_empty() && item.detail.chars().count() <= SHORT + 1));
        assert_eq!(items.len(), EFFECTS.len());
        for word in COMMON {
            assert!(
                SpriteClass::ALL.iter().any(|class| class.name() == word) || EFFECTS.contains(&word),
                "{word}"
            );
        }
    }

    #[test]
    fn comments_have_no_completions() {
        check("f > fox", "f > fox # |", &[], &["fox"]);
        assert_eq!(complete("x", 9).items, []);
        assert_eq!(complete("", 0).items.len(), 2);
    }
}
