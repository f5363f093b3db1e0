//! The data model shared by all reports: figures with intervals, and tables with one renderer per format.
//!
//! Each report on levels, games or evaluations is computed by a pure function that returns these types.
//! [`SetReport`] is written as JSON, and [`Table`] as Markdown, CSV and LaTeX. The `arcade` binary builds the
//! pages.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod figures;
mod set;
mod table;

pub use figures::{Mean, Quantiles, Share};
pub use set::{Figure, Section, SetReport, Value};
pub use table::{Column, Table, TableCell, in_csv, in_markdown, is_invisible, visible, visible_lines};
