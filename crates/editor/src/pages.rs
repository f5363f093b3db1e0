//! The manual pages on VGDL keywords (`docs/reference/ontology`) and problem codes
//! (`docs/reference/diagnostics`), and excerpts from them, in Markdown.

use crate::values;
use crate::values::Owner;
use engine::{ParameterKind, SPRITE_PARAMETERS, SpriteClass, effect_parameters};
use include_dir::{Dir, include_dir};

static ONTOLOGY: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/ontology");
static DIAGNOSTICS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/diagnostics");

/// Returns the page on a sprite class, an effect, a termination or a problem code, in Markdown; `None` if there is no
/// such page.
pub fn page(name: &str) -> Option<&'static str> {
    let of_code = || DIAGNOSTICS.get_file(format!("{name}.md"))?.contents_utf8();
    of_word(name).or_else(of_code)
}

fn of_word(word: &str) -> Option<&'static str> {
    ["sprites", "effects", "terminations"].into_iter().find_map(|folder| text(folder, word))
}

fn text(folder: &str, name: &str) -> Option<&'static str> {
    ONTOLOGY.get_file(format!("{folder}/{name}.md"))?.contents_utf8()
}

/// Returns the introduction from a keyword's page: its title, its first paragraph, and its parameters; `None` if the
/// word has no page.
pub fn introduction(word: &str) -> Option<String> {
    let page = of_word(word)?;
    let mut markdown = format!("**{word}**\n\n{}\n", summary(word)?);
    let rows: Vec<&str> = page.lines().skip_while(|line| !line.starts_with("| parameter")).collect();
    let rows = rows.into_iter().take_while(|line| line.starts_with('|'));
    let table: String = rows.map(|row| format!("{}\n", unlinked(row))).collect();
    if !table.is_empty() {
        markdown += &format!("\n{table}");
    }
    Some(markdown)
}

/// Returns the first paragraph of a keyword's page, as one line; `None` if the word has no page.
pub fn summary(word: &str) -> Option<String> {
    let body = of_word(word)?.split_once('\n')?.1.trim_start();
    let paragraph = body.split("\n\n").next()?;
    Some(unlinked(&paragraph.lines().collect::<Vec<_>>().join(" ")))
}

/// A table row for a parameter, with its default and its meaning.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    pub(crate) default: String,
    pub(crate) meaning: String,
}

/// Returns the table row for a parameter on a line. The row comes from the page of the line's keyword, from the pages
/// that this keyword extends, or from the page for all keywords of its kind. Returns `None` if none of these pages
/// lists the parameter.
pub(crate) fn row(owner: Owner<'_>, key: &str) -> Option<Row> {
    let found = |folder: &str, name: &str| text(folder, name).and_then(|page| row_of(page, key));
    match owner {
        Owner::Sprite(class) => class
            .and_then(|class| {
                let mut extended = SpriteClass::ALL.iter().rev().filter(|other| class.is_a(**other));
                found("sprites", class.name())
                    .or_else(|| extended.find_map(|other| found("sprites", other.name())))
            })
            .or_else(|| found("sprites", "README")),
        Owner::Effect(keyword, planned) => found("effects", keyword)
            .or_else(|| planned.and_then(|planned| found("effects", planned)))
            .or_else(|| found("effects", "README")),
        Owner::Termination(class) => found("terminations", class).or_else(|| found("terminations", "README")),
        Owner::Game | Owner::Parameter | Owner::Nobody => None,
    }
}

/// Returns the table row whose first column contains the parameter; `None` if there is no such row.
fn row_of(page: &str, key: &str) -> Option<Row> {
    let named = format!("`{key}`");
    page.lines().filter(|line| line.starts_with('|')).find_map(|line| {
        let mut columns = line.trim_matches('|').splitn(3, '|').map(str::trim);
        let (name, default, meaning) = (columns.next()?, columns.next()?, columns.next()?);
        name.split(", ")
            .any(|name| name == named)
            .then(|| Row { default: unlinked(default), meaning: unlinked(meaning) })
    })
}

/// Returns the parameters that a line accepts. The parameters of the line's own keyword come first.
pub(crate) fn parameters(owner: Owner<'_>) -> Vec<&'static str> {
    let mut keys: Vec<&'static str> = match owner {
        Owner::Game => values::HEADER.to_vec(),
        Owner::Sprite(class) => {
            let own = class.map_or(Vec::new(), SpriteClass::parameters);
            own.into_iter().chain(SPRITE_PARAMETERS.iter().copied()).collect()
        }
        Owner::Effect(keyword, planned) => {
            let own = [Some(keyword), planned].into_iter().flatten().flat_map(effect_parameters);
            // Type numbers matter only to the reference.
            let own = own.filter(|(_, kind)| *kind != ParameterKind::TypeNumber).map(|(key, _)| key);
            let clock: &[&str] = if keyword == "addTimer" { &values::OF_CLOCKS } else { &[] };
            own.chain(clock.iter().copied()).chain(values::OF_EFFECTS).collect()
        }
        Owner::Termination(class) => {
            values::of_termination(class).iter().copied().chain(values::OF_TERMINATIONS).collect()
        }
        Owner::Parameter => values::OF_PARAMETERS.to_vec(),
        Owner::Nobody => Vec::new(),
    };
    let mut seen = Vec::new();
    keys.retain(|key| {
        !seen.contains(key) && {
            seen.push(*key);
            true
        }
    });
    keys
}

/// Replaces links in Markdown with their texts, because an editor does not have the linked files.
fn unlinked(markdown: &str) -> String {
    let mut out = String::with_capacity(markdown.len());
    let mut rest = markdown;
    while let Some(open) = rest.find('[') {
        let link = rest[open..].find("](").and_then(|middle| {
            let middle = open + middle;
            let close = middle + rest[middle..].find(')')?;
            (!rest[open + 1..middle].contains('[')).then_some((middle, close))
        });
        let Some((middle, close)) = link else {
            out.push_str(&rest[..=open]);
            rest = &rest[open + 1..];
            continue;
        };
        out.push_str(&rest[..open]);
        out.push_str(&rest[open + 1..middle]);
        rest = &rest[close + 1..];
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_word_has_an_introduction() {
        let classes = SpriteClass::ALL.iter().map(|class| class.name());
        for word in classes.chain(engine::EFFECTS.iter().copied()).chain(engine::TERMINATIONS.iter().copied())
        {
            let introduction = introduction(word).unwrap();
            assert!(introduction.len() > word.len() + 20, "{introduction}");
            assert!(!introduction.contains(".md"), "{introduction}");
        }
    }

    #[test]
    fn every_parameter_has_a_row() {
        let mut missing = Vec::new();
        let classes = SpriteClass::ALL.iter().map(|&class| Owner::Sprite(Some(class)));
        let effects = engine::EFFECTS.iter().map(|&keyword| Owner::Effect(keyword, None));
        let terminations = engine::TERMINATIONS.iter().map(|&class| Owner::Termination(class));
        for owner in classes.chain(effects).chain(terminations) {
            let without = parameters(owner).into_iter().filter(|key| row(owner, key).is_none());
            missing.extend(without.map(|key| format!("{owner:?} {key}")));
        }
        assert!(missing.is_empty(), "{missing:#?}");
    }

    #[test]
    fn codes_have_pages() {
        let problems = crate::problems("BasicGame");
        assert!(!problems.is_empty());
        for problem in problems {
            assert!(page(problem.code).is_some_and(|page| page.starts_with(&format!("# {}", problem.code))));
        }
        assert_eq!(page("nonsense"), None);
        assert_eq!(page("../lsp"), None);
    }

    #[test]
    fn links_become_their_texts() {
        assert_eq!(unlinked("a [b](c.md) [d] [e](f)"), "a b [d] e");
        assert_eq!(unlinked("[[x](y)"), "[x");
    }
}
