//! The problems in a text, each with fixes that can be applied automatically.

use engine::{Diagnostic, Edit, Fix, Game, LevelMapping, Severity, Span};

/// A problem in a game or a level.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The stable code, such as `unknown-sprite`, which is also the name of a manual page.
    pub code: &'static str,
    /// The severity: error or warning.
    pub severity: Severity,
    /// The message, which quotes the faulty word. It is in lower case, without a full stop.
    pub message: String,
    /// A note about the position. May be empty.
    pub label: String,
    /// The suggested next step, or `None` if there is no suggestion.
    pub help: Option<String>,
    /// The problem's position.
    pub span: Span,
    /// The possible fixes, most likely first.
    pub fixes: Vec<Fix>,
}

impl Problem {
    /// Converts the engine's diagnostic about a text.
    pub fn of(problem: Diagnostic, source: &str) -> Problem {
        let Diagnostic { code, severity, message, span, label, help, fix } = problem;
        let fixes = fix.map(|fix| tidied(*fix, source)).into_iter().collect();
        Problem { code, severity, message, label, help, span, fixes }
    }
}

/// Returns the errors and warnings about a game's text, sorted by position. Problems with the rules as a whole are
/// found only if there are no errors.
pub fn problems(source: &str) -> Vec<Problem> {
    let found = match Game::from_source(source) {
        Ok(game) => game.warnings().to_vec(),
        Err(problems) => problems.0,
    };
    found.into_iter().map(|problem| Problem::of(problem, source)).collect()
}

/// Returns the problems in a level's text under a game's rules. If the game has errors, returns only the
/// problems that do not depend on these errors. To check several levels of one game, use [`LevelRules`],
/// which parses the game only once.
pub fn level_problems(source: &str, level: &str) -> Vec<Problem> {
    LevelRules::of(source).problems(level)
}

/// A game's rules for its levels, as far as they can be parsed from the game's text.
#[derive(Clone, Debug)]
pub struct LevelRules(Rules);

#[derive(Clone, Debug)]
enum Rules {
    Game(Game),
    Mapping(LevelMapping),
    Unknown,
}

impl LevelRules {
    /// Parses the rules in a game's text.
    pub fn of(source: &str) -> LevelRules {
        LevelRules(match Game::from_source(source) {
            Ok(game) => Rules::Game(game),
            Err(_) => LevelMapping::of_source(source).map_or(Rules::Unknown, Rules::Mapping),
        })
    }

    /// Returns the problems in a level's text, sorted by position.
    pub fn problems(&self, level: &str) -> Vec<Problem> {
        let found = match &self.0 {
            Rules::Game(game) => {
                game.level(level).map_or_else(|problems| problems.0, |level| level.warnings().to_vec())
            }
            Rules::Mapping(mapping) => mapping.problems(level),
            Rules::Unknown => Vec::new(),
        };
        found.into_iter().map(|problem| Problem::of(problem, level)).collect()
    }
}

/// Applies edits to a text, and returns the result. The edits' ranges must be disjoint. Edits outside the
/// text or inside a character are ignored.
pub fn applied(text: &str, edits: &[Edit]) -> String {
    let mut sorted: Vec<&Edit> = edits.iter().collect();
    sorted.sort_by_key(|edit| edit.span);
    let (mut out, mut done) = (String::with_capacity(text.len()), 0);
    for edit in sorted {
        let Some(before) = text.get(done..edit.span.start) else { continue };
        if text.get(edit.span.start..edit.span.end).is_none() {
            continue;
        }
        out.push_str(before);
        out.push_str(&edit.text);
        done = edit.span.end;
    }
    out.push_str(&text[done..]);
    out
}

/// Adjusts a fix so that removing a word also removes the spaces before it, unless they indent the line or
/// separate words.
fn tidied(mut fix: Fix, source: &str) -> Fix {
    for edit in fix.edits.iter_mut().filter(|edit| edit.text.is_empty()) {
        let (Some(before), Some(after)) = (source.get(..edit.span.start), source.get(edit.span.end..)) else {
            continue;
        };
        let kept = before.trim_end_matches([' ', '\t']);
        let indents = kept.is_empty() || kept.ends_with(['\n', '\r']);
        let is_word = !source[edit.span.start..edit.span.end].starts_with(char::is_whitespace);
        let separated = after.is_empty() || after.starts_with([' ', '\t', '\n', '\r', '#']);
        if !indents && is_word && separated {
            edit.span.start = kept.len();
        }
    }
    fix
}

#[cfg(test)]
mod tests {
    use super::*;

    const GAME: &str = "BasicGame\n    SpriteSet\n        nut > Immovable flavour=3\n        hero > MovingAvatar\n    LevelMapping\n        n > nut\n        h > hero\n    InteractionSet\n        nut hero > killSprite\n    TerminationSet\n        SpriteCounter stype=nut win=True\n        Timeout limit=99\n";

    #[test]
    fn a_repair_removes_its_problem() {
        let found = problems(GAME);
        assert_eq!((found.len(), found[0].code), (1, "unknown-parameter"));
        let repaired = applied(GAME, &found[0].fixes[0].edits);
        assert!(repaired.contains("nut > Immovable\n"), "{repaired}");
        assert_eq!(problems(&repaired), []);
    }

    #[test]
    fn levels_are_checked_under_faulty_games_too() {
        assert_eq!(
            level_problems(GAME, "nxh\n").iter().map(|p| p.code).collect::<Vec<_>>(),
            ["undefined-character"]
        );
        assert_eq!(level_problems("", "nxh\n"), []);
        let short = level_problems(&GAME.replace(" flavour=3", ""), "hn\nn\n");
        assert_eq!(applied("hn\nn\n", &short[0].fixes[0].edits), "hn\nn \n");
    }

    #[test]
    fn edits_outside_the_text_are_left_out() {
        let edits = [
            Edit::new(Span::new(1, 2), "x"),
            Edit::new(Span::new(0, 1), "y"),
            Edit::new(Span::new(7, 9), "z"),
        ];
        assert_eq!(applied("abc", &edits), "yxc");
        assert_eq!(applied("é", &[Edit::new(Span::new(1, 2), "x")]), "é");
    }
}
