//! Checks that every template has a row.

use super::{Row, rows};
use engine::describe::texts;

#[test]
fn every_template_has_a_row() {
    let told: Vec<Row> = rows().filter(|row| !row.plays.is_empty()).collect();
    let held: Vec<&str> = told.iter().flat_map(|row| row.of.iter().copied()).collect();
    let missing: Vec<&str> = texts().into_iter().filter(|text| !held.contains(text)).collect();
    assert!(missing.is_empty(), "without a row: {missing:#?}");
    let unknown: Vec<&str> = held.into_iter().filter(|text| !texts().contains(text)).collect();
    assert!(unknown.is_empty(), "no template: {unknown:#?}");
}

/// Returns `true` if a sentence contains a template with its holes filled.
pub(crate) fn fits(template: &str, sentence: &str) -> bool {
    let mut rest = sentence.to_lowercase();
    let mut template = template.to_lowercase();
    // Compare the words in order, with one form of each agreeing word.
    loop {
        let (text, hole, after) = match template.split_once('{') {
            Some((text, after)) => {
                let (hole, after) = after.split_once('}').expect("a hole of a template ends");
                (text.to_owned(), hole.to_owned(), after.to_owned())
            }
            None => (template.clone(), String::new(), String::new()),
        };
        let Some(at) = rest.find(&text) else { return false };
        rest = rest[at + text.len()..].to_owned();
        let forms = hole.split_once(':').and_then(|(_, forms)| forms.split_once('|'));
        if let Some((with_you, with_it)) = forms {
            let found = [with_you, with_it].into_iter().filter_map(|form| Some((rest.find(form)?, form)));
            let Some((at, form)) = found.min() else { return false };
            rest = rest[at + form.len()..].to_owned();
        }
        if hole.is_empty() {
            return true;
        }
        template = after;
    }
}

#[test]
fn templates_fit_their_sentences_only() {
    assert!(fits("{one} {one:die|disappears} on touching {two}", "You die on touching the wasp."));
    assert!(!fits("{one} {one:die|disappears} on touching {two}", "You cannot enter the wasp."));
    assert!(!fits("{two} {two:push|pushes} {one}", "You carry the crate along."));
}
