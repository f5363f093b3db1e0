//! Explanations of words.

use crate::navigate::{Subject, symbol_at};
use crate::pages;
use crate::values::Owner;
use crate::words::{BUILT_IN, EDGES, Role, Sprite, Word, Words};
use engine::describe::{Guide, plural};
use engine::syntax::Section;
use engine::{Game, Span, SpriteClass};
use std::fmt::Write;

/// The explanation of a word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hover {
    /// The position of the word.
    pub span: Span,
    /// The explanation in Markdown.
    pub markdown: String,
}

/// The maximum number of sentences about a sprite type.
const SENTENCES: usize = 12;

/// Returns the explanation of the word at byte `at`. VGDL keywords are explained by their manual pages, and sprite
/// types and level characters by their use in the game. Sentences about rules are available only if the game
/// compiles.
pub fn hover(source: &str, at: usize) -> Option<Hover> {
    let words = Words::of(source);
    let word = words.at(at)?;
    let markdown = match word.role {
        Role::GameClass => of_game_class(word.text).to_owned(),
        Role::Section(section) => format!("**{}**\n\n{}", section.name(), of_section(section)),
        Role::Class | Role::Effect | Role::Termination => pages::introduction(word.text)?,
        Role::Edge => of_edge(word.text)?.to_owned(),
        Role::Key => of_parameter(word.owner, word.text)?,
        Role::Value => of_parameter(word.owner, word.key?)?,
        Role::Declaration | Role::Sprite => of_sprite(source, &words, word.text)?,
        Role::Symbol => of_symbol(source, &words, word.text),
        Role::Parameter | Role::ParameterUse => of_space(&words, source, word)?,
        Role::Arrow | Role::Stray => return None,
    };
    Some(Hover { span: word.span, markdown })
}

/// Returns the explanation of the character at byte `at` in a level, which lists the sprites that the character places
/// in this game; `None` if the LevelMapping does not contain the character.
pub fn level_hover(source: &str, level: &str, at: usize) -> Option<Hover> {
    let (span, symbol) = symbol_at(level, at)?;
    let words = Words::of(source);
    let is_mapped = words.mapping().any(|(word, _)| word.text == symbol);
    is_mapped.then(|| Hover { span, markdown: of_symbol(source, &words, symbol) })
}

fn of_game_class(name: &str) -> &'static str {
    match name {
        "GameSpace" => {
            "**GameSpace**\n\nA game whose values may be names of parameters, which its ParameterSet declares."
        }
        _ => "**BasicGame**\n\nThe first line of a game. It may set options for the whole game.",
    }
}

pub(crate) fn of_section(section: Section) -> &'static str {
    match section {
        Section::SpriteSet => {
            "The sprite types: `name > Class key=value …`. Lines that are indented deeper are subtypes, which inherit class and parameters."
        }
        Section::LevelMapping => "The sprites that each level character places: `c > name name …`.",
        Section::InteractionSet => {
            "The effects of collisions: `first partner … > effect key=value …`. The effect acts on the \
             first sprite."
        }
        Section::TerminationSet => {
            "The conditions that end the game: `Class key=value …`. The first condition that holds \
             determines the outcome."
        }
        Section::ParameterSet => "The parameters of a GameSpace: `NAME > values=min:step:max value=x`.",
    }
}

fn of_edge(word: &str) -> Option<&'static str> {
    let all = [
        "**EOS**\n\nThe edge of the screen, as the partner of a sprite that leaves the board.",
        "**TIME**\n\nThe clock, as the partner of an effect that runs after `timer=` ticks.",
    ];
    EDGES.iter().position(|edge| *edge == word).map(|at| all[at])
}

/// Returns the explanation of a setting in a game's first line; `None` for an unknown setting.
pub(crate) fn of_setting(key: &str) -> Option<&'static str> {
    Some(match key {
        "square_size" => "the width and height of a cell in pixels",
        "key_handler" => "read by the reference engine only: `Pulse` or `Default`",
        "no_players" => "the number of players: 1",
        "no_counters" => "the number of counters, which interactions change by `counter=`",
        "obs" => "the sprite types that paths avoid, separated by commas",
        _ => return None,
    })
}

fn of_parameter(owner: Owner<'_>, key: &str) -> Option<String> {
    if owner == Owner::Game {
        return Some(format!("**{key}**: {}", of_setting(key)?));
    }
    let row = pages::row(owner, key)?;
    let of = match owner {
        Owner::Sprite(class) => class.map(|class| class.name()),
        Owner::Effect(keyword, _) => Some(keyword),
        Owner::Termination(class) => Some(class),
        Owner::Game | Owner::Parameter | Owner::Nobody => None,
    };
    let of = of.map_or(String::new(), |of| format!(" of {of}"));
    let default =
        if row.default.is_empty() { String::new() } else { format!("\n\nDefault: {}", row.default) };
    Some(format!("**{key}**{of}: {}{default}", row.meaning))
}

fn of_sprite(source: &str, words: &Words<'_>, name: &str) -> Option<String> {
    let sprite = words.sprite(name);
    let class = match sprite {
        Some(sprite) => sprite.class,
        None => Some(BUILT_IN.iter().find(|(known, _)| *known == name)?.1),
    };
    let mut markdown = format!("**{name}**");
    match class {
        Some(class) => {
            let _ = write!(markdown, ": {}", class.name());
            if let Some(summary) = pages::summary(class.name()) {
                let _ = write!(markdown, "\n\n{}: {summary}", class.name());
            }
        }
        None => markdown += ": no class",
    }
    if sprite.is_none() {
        markdown += "\n\nEvery game has this sprite type, declared or not.";
    }
    if let Some(sprite) = sprite {
        markdown += &of_declaration(words, sprite);
    }
    let placed: Vec<String> = words
        .mapping()
        .filter_map(|(symbol, mut names)| {
            names.any(|placed| placed == name).then(|| format!("`{}`", symbol.text))
        })
        .collect();
    if !placed.is_empty() {
        let _ = write!(markdown, "\n\nLevel characters: {}", placed.join(", "));
    }
    let told = Told::of(source);
    let sentences = told.iter().flat_map(|told| told.sentences(words, name)).take(SENTENCES);
    for (at, sentence) in sentences.enumerate() {
        let gap = if at == 0 { "\n" } else { "" };
        let _ = write!(markdown, "{gap}\n- {sentence}");
    }
    Some(markdown)
}

/// Returns a type's ancestors, subtypes and parameters. The origin of each parameter is stated.
fn of_declaration(words: &Words<'_>, sprite: &Sprite<'_>) -> String {
    let mut markdown = String::new();
    let names: Vec<String> = words.ancestors(sprite).map(|above| format!("`{}`", above.name)).collect();
    if !names.is_empty() {
        let _ = write!(markdown, "\n\nSubtype of {}", names.join(", of "));
    }
    let is_child = |other: &&Sprite<'_>| other.parent.is_some_and(|at| words.sprites[at].name == sprite.name);
    let below: Vec<String> =
        words.sprites.iter().filter(is_child).map(|child| format!("`{}`", child.name)).collect();
    if !below.is_empty() {
        let _ = write!(markdown, "\n\nSubtypes: {}", below.join(", "));
    }
    let params = words.params(sprite);
    if !params.is_empty() {
        markdown += "\n\nParameters:";
    }
    for (key, value, is_inherited) in params {
        let origin = if is_inherited { " (inherited)" } else { "" };
        let meaning = pages::row(Owner::Sprite(sprite.class), key).map(|row| row.meaning);
        let meaning = meaning.map_or(String::new(), |meaning| format!(": {meaning}"));
        let _ = write!(markdown, "\n- `{key}={value}`{origin}{meaning}");
    }
    markdown
}

/// A compiled game, with its rules in plain English.
struct Told {
    game: Game,
    lines: Vec<String>,
}

impl Told {
    fn of(source: &str) -> Option<Told> {
        let game = Game::from_source(source).ok()?;
        let guide = Guide::of(&game);
        let all =
            [guide.controls, guide.sprites, guide.winning, guide.losing, guide.timed_effects, guide.meetings];
        Some(Told { game, lines: all.concat() })
    }

    /// Returns the sentences that mention a type, or one of its ancestors or descendants.
    fn sentences<'a>(&'a self, words: &Words<'_>, name: &str) -> impl Iterator<Item = &'a str> {
        let mut names = vec![name.to_owned(), plural(name)];
        let above = words.sprite(name).into_iter().flat_map(|sprite| words.ancestors(sprite));
        let below =
            words.sprites.iter().filter(|other| words.ancestors(other).any(|above| above.name == name));
        for relative in above.chain(below) {
            names.extend([relative.name.to_owned(), plural(relative.name)]);
        }
        let class = self.game.sprite_type(name).and_then(|stype| self.game.class(stype));
        let is_avatar = class.is_some_and(SpriteClass::is_avatar);
        let said = |text: &str, is_meant: &dyn Fn(&str) -> bool| {
            text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(is_meant)
        };
        let speaks = move |line: &&str| {
            // In a line about the player, everything after the first sentence describes changes to the score.
            let first = line.split(". ").next().unwrap_or_default();
            let is_player = |word: &str| ["You", "you"].contains(&word);
            said(line, &|word| names.iter().any(|name| name == word)) || is_avatar && said(first, &is_player)
        };
        self.lines.iter().map(String::as_str).filter(speaks)
    }
}

fn of_symbol(source: &str, words: &Words<'_>, symbol: &str) -> String {
    let mut markdown = format!("**`{symbol}`** in a level places:");
    let told = Told::of(source);
    let mapped = words.mapping().find(|(word, _)| word.text == symbol);
    for name in mapped.map_or(Vec::new(), |(_, names)| names.collect()) {
        let class = words.sprite(name).and_then(|sprite| sprite.class);
        let class =
            class.or_else(|| BUILT_IN.iter().find(|(known, _)| *known == name).map(|(_, class)| *class));
        let _ = write!(
            markdown,
            "\n- `{name}`{}",
            class.map_or(String::new(), |class| format!(": {}", class.name()))
        );
        let sentence = told.as_ref().and_then(|told| told.sentences(words, name).next());
        if let Some(sentence) = sentence {
            let _ = write!(markdown, ". {sentence}");
        }
    }
    markdown
}

/// Returns the line that declares a parameter of a `GameSpace`; `None` for any other word.
fn of_space(words: &Words<'_>, source: &str, word: &Word<'_>) -> Option<String> {
    let subject = Subject::Parameter(word.text);
    let declared = |other: &Word<'_>| other.role == Role::Parameter && Subject::of(other) == Some(subject);
    let line = words.lines.iter().find(|line| line.words.iter().any(declared))?;
    Some(format!(
        "**{}**, a parameter of the GameSpace\n\n`{}`",
        word.text,
        &source[line.span.start..line.span.end]
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAME: &str = "BasicGame square_size=10\n    SpriteSet\n        fruit > Immovable color=RED\n            nut > hidden=False\n        hawk > Chaser stype=hero cooldown=2\n        hero > MovingAvatar\n    LevelMapping\n        n > nut\n        h > hawk\n        A > hero\n    InteractionSet\n        hero wall > stepBack\n        nut hero > killSprite scoreChange=1\n        hero hawk > killSprite\n        nut EOS > killSprite\n    TerminationSet\n        SpriteCounter stype=nut win=True\n        SpriteCounter stype=hero win=False\n        Timeout limit=99\n";

    #[track_caller]
    fn check(place: &str, expect: &[&str]) {
        let at = GAME.find(place).unwrap();
        let hover = hover(GAME, at).unwrap();
        for part in expect {
            assert!(hover.markdown.contains(part), "{part}: {}", hover.markdown);
        }
        assert!(!hover.markdown.contains(".md"), "{}", hover.markdown);
    }

    #[test]
    fn words_are_explained() {
        check("BasicGame", &["first line"]);
        check("square_size", &["pixels"]);
        check("SpriteSet", &["sprite types"]);
        check("Chaser", &["**Chaser**", "| `stype` |"]);
        check("cooldown", &["**cooldown** of Chaser", "Default: 1"]);
        check("RED", &["**color**"]);
        check("killSprite", &["**killSprite**"]);
        check("scoreChange", &["**scoreChange** of killSprite"]);
        check("EOS", &["edge"]);
        check("Timeout", &["**Timeout**"]);
        check("limit=", &["**limit** of Timeout"]);
    }

    #[test]
    fn sprites_and_characters_are_explained() {
        check(
            "nut >",
            &["**nut**: Immovable", "Subtype of `fruit`", "`color=RED` (inherited)", "`n`", "\n- "],
        );
        check("fruit", &["Subtypes: `nut`", "You win when no nut is left"]);
        check("hero >", &["**hero**: MovingAvatar", "arrow keys"]);
        let lines = |place: &str| -> Vec<String> {
            let markdown = hover(GAME, GAME.find(place).unwrap()).unwrap().markdown;
            markdown.lines().filter(|line| line.contains("edge")).map(str::to_owned).collect()
        };
        assert_eq!((lines("nut >").len(), lines("hero >").len()), (1, 0));
    }

    #[test]
    fn characters_of_levels_are_explained() {
        let hover = level_hover(GAME, "w A\n", 2).unwrap();
        assert!(
            hover.span == Span::new(2, 3) && hover.markdown.contains("- `hero`: MovingAvatar"),
            "{hover:?}"
        );
        assert_eq!(level_hover(GAME, "w A\n", 1), None);
    }

    #[test]
    fn nothing_is_said_of_nothing() {
        assert_eq!(hover("", 0), None);
        assert_eq!(hover(GAME, GAME.find("> Chaser").unwrap()), None);
        let faulty = GAME.replace("hawk > killSprite", "hawkk > killSprite");
        assert_eq!(hover(&faulty, faulty.find("hawkk").unwrap()), None);
        let nut = hover(&faulty, faulty.find("nut >").unwrap()).unwrap();
        assert!(nut.markdown.contains("Subtype of `fruit`"), "{}", nut.markdown);
    }
}
