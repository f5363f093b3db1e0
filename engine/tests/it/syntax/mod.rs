//! From text to game descriptions and back.

mod parse;
mod print;
