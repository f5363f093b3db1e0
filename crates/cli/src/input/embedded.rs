//! The corpus and the recipes embedded in the binary, so that an installed `arcade` works in an empty directory.

use crate::failure::Failure;
use base::Digest;
use include_dir::{Dir, include_dir};
use itertools::Itertools;
use snapshots::{Corpus, CorpusGame};

static CORPORA: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/corpora");
static SEEDS: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/seeds");
static LOCKFILE: &[u8] = include_bytes!("../../workspace.lock");

/// Returns the corpus games and their names.
pub(crate) fn corpus() -> Result<Corpus, Failure> {
    let mut games = Vec::new();
    for folder in CORPORA.dirs() {
        let name = folder.path().to_string_lossy().into_owned();
        let text = |file: &str| folder.get_file(folder.path().join(file))?.contents_utf8();
        let (Some(source), Some(card)) = (text("game.vgdl"), text("CARD.toml")) else { continue };
        let levels = (0..).map_while(|number| text(&format!("lvl{number}.txt"))).map(str::to_owned).collect();
        let game = CorpusGame::read(name, source.to_owned(), levels, card);
        games.push(game.map_err(|error| malformed!("in this binary: {error}"))?);
    }
    games.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(Corpus { games, designs: None })
}

/// Returns the text of the recipe with the given name in `seeds/`; `None` if there is no such recipe.
pub(crate) fn recipe(name: &str) -> Option<&'static str> {
    SEEDS.get_file(format!("{name}.toml"))?.contents_utf8()
}

/// Returns the names of the recipes in `seeds/`.
pub(crate) fn recipe_names() -> Vec<String> {
    let name = |file: &include_dir::File<'_>| Some(file.path().file_stem()?.to_string_lossy().into_owned());
    SEEDS.files().filter_map(name).sorted().collect_vec()
}

/// Returns the digest of the Cargo.lock used to build this binary.
pub(crate) fn lockfile() -> Digest {
    Digest::of(LOCKFILE)
}
