//! Writes `docs/legend.svg`, the picture of all tiles: `cargo run -p infinite-arcade-render --example legend`.

use infinite_arcade_render::{gallery, svg};

fn main() -> std::io::Result<()> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/legend.svg");
    std::fs::write(file, svg(&gallery(3)))
}
