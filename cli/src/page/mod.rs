//! The shared parts of the pages of all reports: the wording and layout of figures and tables, and the templates that show them.

pub(crate) mod facts;
pub(crate) mod plots;
pub(crate) mod tables;
pub(crate) mod words;

use crate::failure::Failure;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use minijinja::Environment;
use minijinja::value::{Serde, Value};
use serde::Serialize;
use std::borrow::Cow;

/// The templates that a page may include or import.
const SHARED: [(&str, &str); 4] = [
    ("style.css", include_str!("style.css")),
    ("plots.css", include_str!("plots.css")),
    ("dark.css", include_str!("dark.css")),
    ("parts.html", include_str!("parts.html")),
];

#[derive(Serialize)]
pub(crate) struct Figure<'a> {
    png: String,
    size: [u32; 2],
    head: Cow<'a, str>,
    line: Cow<'a, str>,
}

impl<'a> Figure<'a> {
    /// A PNG of this size, with its caption.
    pub(crate) fn new(
        png: &[u8],
        size: [u32; 2],
        head: impl Into<Cow<'a, str>>,
        line: impl Into<Cow<'a, str>>,
    ) -> Figure<'a> {
        Figure { png: STANDARD.encode(png), size, head: head.into(), line: line.into() }
    }

    /// Returns the size of its PNG in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.png.len()
    }
}

/// Renders the page of a template: one self-contained HTML file. The same arguments give the same bytes.
pub(crate) fn render(template: &'static str, page: &impl Serialize) -> Result<String, Failure> {
    render_with(&[], template, page)
}

/// Renders the page of a template that includes or imports these templates, by name, beside the shared ones.
pub(crate) fn render_with(
    parts: &[(&'static str, &'static str)],
    template: &'static str,
    page: &impl Serialize,
) -> Result<String, Failure> {
    let render = || {
        let mut environment = Environment::new();
        for (name, text) in SHARED.iter().chain(parts) {
            environment.add_template(name, text)?;
        }
        environment.add_template("page.html", template)?;
        environment.get_template("page.html")?.render(Value::from(Serde(page)))
    };
    render().map_err(|error: minijinja::Error| Failure::environment(error, "the page of the report"))
}
