//! Writes `docs/reference/legend.svg` and `docs/reference/figures.svg`, which show all tiles. Run it with
//! `cargo run -p infinite-arcade-render --example legend`. If a folder is given, also writes the figures as
//! PNG files to that folder.

use infinite_arcade_render::{Picture, figures, gallery, png, svg};
use std::error::Error;
use std::fs;

fn main() -> Result<(), Box<dyn Error>> {
    let docs = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/reference");
    let pictures: [(&str, Picture); 2] = [("legend", gallery(3)), ("figures", figures(6))];
    let folder = std::env::args().nth(1);
    for (name, picture) in pictures {
        fs::write(format!("{docs}/{name}.svg"), svg(&picture))?;
        if let Some(folder) = &folder {
            fs::write(format!("{folder}/{name}.png"), png(&picture)?)?;
        }
    }
    Ok(())
}
