//! Tests the way from text to game descriptions and back.

mod parse;
mod print;
