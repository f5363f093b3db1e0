//! The report page, a single self-contained HTML file.

use super::Showcase;
use crate::PageError;
use crate::page::facts::{Fact, Section};
use crate::page::tables::Shown;
use report::SetReport;
use serde::Serialize;

const TEMPLATE: &str = include_str!("page.html");

#[derive(Serialize)]
struct Page<'a> {
    showcase: &'a Showcase<'a>,
    headlines: Vec<Fact>,
    sections: Vec<Section>,
    /// The tables shown next to the images.
    grids: Vec<Shown>,
    every: Vec<Shown>,
}

/// Renders the page. The same arguments give identical bytes.
pub(super) fn render(report: &SetReport, showcase: &Showcase<'_>) -> Result<String, PageError> {
    let is_grid = |table: &&report::Table| showcase.grids.contains(&table.id.as_str());
    let (grids, every): (Vec<&report::Table>, Vec<_>) = report.tables.iter().partition(is_grid);
    let page = Page {
        showcase,
        headlines: report.headlines.iter().map(Fact::headline).collect(),
        sections: report
            .sections
            .iter()
            .filter(|section| !section.figures.is_empty())
            .map(Section::of)
            .collect(),
        grids: grids.into_iter().map(Shown::of).collect(),
        every: every.into_iter().map(Shown::of).collect(),
    };
    crate::page::render(&[], TEMPLATE, &page)
}
