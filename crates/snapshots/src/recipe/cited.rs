//! The title and authors of a release, for citations.

/// The names for citing a release.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cited<'a> {
    name: &'a str,
    authors: &'a [String],
    publisher: Option<&'a str>,
}

impl<'a> Cited<'a> {
    /// Collects the names of a release.
    pub(crate) fn of(name: &'a str, authors: &'a [String], publisher: Option<&'a str>) -> Cited<'a> {
        Cited { name, authors, publisher }
    }

    /// Returns the release's title.
    pub(crate) fn title(&self) -> String {
        match (self.publisher, self.authors) {
            (Some(publisher), _) => format!("{publisher} {}", self.name),
            (None, []) => format!("Infinite Arcade {}", self.name),
            (None, _) => format!("{}, made with Infinite Arcade", self.name),
        }
    }

    /// Returns the authors: the people if there are any, otherwise the publisher, and otherwise the authors of the
    /// programs.
    pub(crate) fn authors(&self) -> Vec<&str> {
        match (self.authors, self.publisher) {
            ([], Some(publisher)) => vec![publisher],
            ([], None) => vec!["The Infinite Arcade authors"],
            (authors, _) => authors.iter().map(String::as_str).collect(),
        }
    }

    /// Returns a sentence about the publisher and the authors; `None` if the recipe states neither.
    pub(crate) fn sentence(&self) -> Option<String> {
        match (self.publisher, self.authors) {
            (None, []) => None,
            (Some(publisher), []) => Some(format!("Published by {publisher}.")),
            (None, authors) => Some(format!("By {}.", authors.join(", "))),
            (Some(publisher), authors) => {
                Some(format!("By {}. Published by {publisher}.", authors.join(", ")))
            }
        }
    }
}
