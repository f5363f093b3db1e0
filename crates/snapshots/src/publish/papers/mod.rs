//! Papers: documents that accompany a release without belonging to it, such as the licence, the citation, the
//! datasheet, errata, and the publisher's additions.
//!
//! Papers are stored in `papers/`, outside the hashed tree and the manifest, because a DOI or an erratum is
//! added after the root is fixed. The root therefore proves nothing about papers. The size of papers is
//! bounded, and links and unsafe names are rejected, as in the rest of a release. Entries left by other
//! programs at the top of a folder (`.git`, `.DS_Store`) are skipped and reported.

mod datasheet;

use crate::contents::untracked::PAPERS;
use crate::format::manifest::Manifest;
use crate::format::manifest::item::ReleaseKind;
use crate::format::manifest::withheld::Reveal;
use crate::mint::Minted;
use crate::recipe::cited::Cited;
use serde::Deserialize;

impl Minted {
    /// Returns a release's initial papers (documents such as the licence), by path. The facts in them come from the
    /// manifest and the cards.
    pub fn papers(&self) -> Vec<(String, String)> {
        let manifest = &self.manifest;
        let papers = [
            ("CHANGELOG.md", errata(manifest)),
            ("CITATION.cff", citation(manifest)),
            ("DATASHEET.md", datasheet::datasheet(self)),
            ("LICENSE", licence(manifest)),
        ];
        papers.into_iter().map(|(name, text)| (format!("{PAPERS}{name}"), text)).collect()
    }
}

/// Returns the content of a sealed release's paper after the reveal.
pub(crate) fn revealed(path: &str, content: Vec<u8>, what: Reveal) -> Vec<u8> {
    match (path.strip_prefix(PAPERS), std::str::from_utf8(&content)) {
        (Some("DATASHEET.md"), Ok(text)) => datasheet::revealed(text, what).into_bytes(),
        _ => content,
    }
}

/// Returns the licence for the generated content.
fn licence(manifest: &Manifest) -> String {
    format!(
        "SPDX-License-Identifier: MIT OR Apache-2.0\n\n\
         The games, levels, cards, episodes and texts of the release `{}` were made by the programs of Infinite Arcade\n\
         from a recipe; those named after a corpus game are based on a game that the authors of Infinite Arcade wrote.\n\
         As far as anybody holds rights in any of it, you may use it under either of these licences, as you choose:\n\n\
         - the Apache License, Version 2.0: https://www.apache.org/licenses/LICENSE-2.0\n\
         - the MIT licence, which follows.\n\n\
         You need not ask, and you need not name the models that you evaluate. A citation is welcome: CITATION.cff.\n\n\
         ----\n\n{}",
        manifest.name,
        include_str!("../../../LICENSE-MIT")
    )
}

/// Returns a release's citation in [CFF 1.2.0](https://citation-file-format.github.io). The root identifies the
/// release's bytes.
fn citation(manifest: &Manifest) -> String {
    let names = Names::of(manifest);
    let cited = Cited::of(&manifest.name, &names.authors, names.publisher.as_deref());
    let authors: String =
        cited.authors().into_iter().map(|author| format!("  - name: {}\n", quoted(author))).collect();
    let description = manifest.recipe.get("description").and_then(|text| text.as_str()).unwrap_or_default();
    format!(
        "cff-version: 1.2.0\n\
         message: \"If you use this release, please cite it, and name its root.\"\n\
         type: dataset\n\
         title: {}\n\
         version: {}\n\
         abstract: {}\n\
         authors:\n{authors}\
         identifiers:\n  - type: other\n    value: \"blake3:{}\"\n    \
         description: \"Root digest, which covers every file of the release except those in papers/\"\n\
         license:\n  - MIT\n  - Apache-2.0\n\
         keywords:\n  - benchmark\n  - games\n  - planning\n  - VGDL\n",
        quoted(&cited.title()),
        quoted(&manifest.name),
        quoted(description.trim()),
        manifest.root,
    )
}

/// The recipe keys that identify people.
#[derive(Default, Deserialize)]
#[serde(default)]
struct Names {
    authors: Vec<String>,
    publisher: Option<String>,
}

impl Names {
    /// Reads the names in a manifest's recipe. Names that do not have the expected form are left empty.
    fn of(manifest: &Manifest) -> Names {
        serde_json::from_value(manifest.recipe.clone()).unwrap_or_default()
    }
}

/// Returns a release's title.
pub(crate) fn title(manifest: &Manifest) -> String {
    let names = Names::of(manifest);
    Cited::of(&manifest.name, &names.authors, names.publisher.as_deref()).title()
}

/// Quotes text for YAML with double quotes.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for character in text.chars() {
        match character {
            '"' | '\\' => quoted.extend(['\\', character]),
            // These characters are line breaks in YAML, or not allowed in YAML.
            '\u{2028}' | '\u{2029}' | '\u{feff}' => quoted += &format!("\\u{:04x}", character as u32),
            _ if character.is_control() => quoted += &format!("\\u{:04x}", character as u32),
            _ => quoted.push(character),
        }
    }
    quoted.push('"');
    quoted
}

/// Returns the errata page.
fn errata(manifest: &Manifest) -> String {
    let sealed = match manifest.kind {
        ReleaseKind::Open => "",
        ReleaseKind::Sealed => " The reveal adds files and changes no file.",
    };
    format!(
        "# Errata of `{}`\n\n\
         A release never changes: its root covers every byte.{sealed} This page lists the errors found in the release, newest \
         first: when and by whom each error was found, and which games, levels and scores it concerns.\n\n\
         No errors so far.\n",
        manifest.name
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_of_a_citation_stay_in_their_quotes() {
        assert_eq!(quoted("a \"b\" \\ é\n\u{2028}\u{7f}"), "\"a \\\"b\\\" \\\\ é\\u000a\\u2028\\u007f\"");
    }

    #[test]
    fn a_citation_names_the_root() {
        let manifest = crate::format::manifest::tests::example(&[]);
        let text = citation(&manifest);
        assert!(text.starts_with("cff-version: 1.2.0\nmessage: "), "{text}");
        assert!(text.contains(&format!("value: \"blake3:{}\"", manifest.root)), "{text}");
        assert!(text.contains("version: \"2026-12\"\n"), "{text}");
        assert!(text.contains("authors:\n  - name: \"The Infinite Arcade authors\"\nidentifiers:"), "{text}");
        let mut own = manifest;
        own.recipe = serde_json::json!({ "authors": ["Ada \"A\" L", "Bo"], "publisher": "Example Lab" });
        let text = citation(&own);
        assert!(text.contains("title: \"Example Lab 2026-12\"\n"), "{text}");
        assert!(
            text.contains("authors:\n  - name: \"Ada \\\"A\\\" L\"\n  - name: \"Bo\"\nidentifiers:"),
            "{text}"
        );
    }
}
