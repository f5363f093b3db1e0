//! The shared model of all reports: figures with their intervals, and tables as data with one renderer for each format.
//!
//! A report on levels, on games or on evaluations is a pure function that ends in these types: [`SetReport`] is written as JSON,
//! [`Table`] as Markdown, CSV and LaTeX. Pages are put together by the binary.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod figures;
mod set;
mod table;

pub use figures::{Mean, Quantiles, Share};
pub use set::{Figure, Section, SetReport, Value};
pub use table::{Column, Table, TableCell, in_csv, in_markdown, is_invisible, visible, visible_lines};
