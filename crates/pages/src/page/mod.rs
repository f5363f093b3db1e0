//! The parts shared by all report pages: the wording and layout of figures and tables, and their templates.

pub(crate) mod facts;
pub(crate) mod plots;
pub(crate) mod tables;
pub(crate) mod words;

use crate::PageError;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, escape_formatter};
use render::{Picture, RenderError, png};
use report::visible_lines;
use serde::Serialize;

/// The templates that a page may include or import.
const SHARED: [(&str, &str); 4] = [
    ("style.css", include_str!("style.css")),
    ("plots.css", include_str!("plots.css")),
    ("dark.css", include_str!("dark.css")),
    ("parts.html", include_str!("parts.html")),
];

#[derive(Serialize)]
pub(crate) struct Figure {
    png: String,
    size: [u32; 2],
    head: String,
    /// An empty text. The field is kept because the page's nonce is computed over it.
    line: &'static str,
}

impl Figure {
    /// Creates a captioned PNG image of a drawing.
    pub(crate) fn of(picture: &Picture, head: String) -> Result<Figure, RenderError> {
        let size = [picture.width(), picture.height()];
        Ok(Figure { png: STANDARD.encode(png(picture)?), size, head, line: "" })
    }

    /// Returns the size of the PNG data, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        self.png.len()
    }
}

/// Renders a page from a template as a single self-contained HTML file. The template may include or import
/// the given `parts` by name, in addition to the shared parts. The same arguments give identical bytes.
pub(crate) fn render(
    parts: &[(&'static str, &'static str)],
    template: &'static str,
    page: &impl Serialize,
) -> Result<String, PageError> {
    let render = || {
        let mut environment = Environment::new();
        // Names in sentences come from files, so they are escaped. Safe strings contain markup from this
        // crate.
        environment.set_formatter(|out, state, value| match value.as_str() {
            Some(text) if !value.is_safe() => {
                escape_formatter(out, state, &Value::from(visible_lines(text).into_owned()))
            }
            _ => escape_formatter(out, state, value),
        });
        for (name, text) in SHARED.iter().chain(parts) {
            environment.add_template(name, text)?;
        }
        environment.add_template("page.html", template)?;
        environment.get_template("page.html")?.render(Value::from(Serde(page)))
    };
    render().map_err(PageError::failed("the page of the report"))
}
