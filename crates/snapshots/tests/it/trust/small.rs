//! The smallest possible release: one game, one level, and a witness that wins it.

use base::canonical::to_canonical_json;
use base::{Digest, Seed};
use engine::{Action, Episode, Game, Outcome};
use forge::Tally;
use forge::card::{Card, LevelCard, Origin};
use report::Quantiles;
use serde::Serialize;

use snapshots::{
    Draft, FORMAT, Item, MANIFEST_FILE, Manifest, Novelty, RELEASE_CARD_FILE, Recipe, ReleaseCard,
    ReleaseKind, Witness, canary, follow,
};
use statistics::{Z95, wilson};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use tempfile::TempDir;
use validators::Rate;

const GAME: &str = "\
BasicGame
    SpriteSet
        earth > Immovable color=BLACK
        wall > Immovable color=BROWN
        door > Immovable color=GREEN
        mole > MovingAvatar color=WHITE
    LevelMapping
        . > earth
        w > wall
        d > earth door
        m > earth mole
    InteractionSet
        mole wall > stepBack
        door mole > killSprite scoreChange=1
    TerminationSet
        SpriteCounter stype=door limit=0 win=True
";

/// Returns a tunnel from the mole to the door. Each release in a chain has a different tunnel, because no
/// release may repeat its ancestors.
fn tunnel(name: &str) -> String {
    let length = match name {
        "2027-01" => 3,
        "2027-02" => 4,
        "2027-01-b" => 5,
        "2027-02-b" => 6,
        _ => 2,
    };
    let wall = "w".repeat(length + 4);
    format!("{wall}\nwm{}dw\n{wall}\n", ".".repeat(length))
}

/// A release in memory.
#[derive(Clone)]
pub(crate) struct Small {
    pub(crate) manifest: Manifest,
    /// All files except the manifest, by path.
    pub(crate) files: Vec<(String, Vec<u8>)>,
}

/// Returns the release with the given name, following `parent`.
pub(crate) fn small(name: &str, parent: Option<&Small>) -> Small {
    let mut recipe = Recipe::from_toml(&format!(
        "name = '{name}'\ndescription = 'A mole.'\nseed = 'a mole in the dark'\n[corpus]\ngames = 1\nlevels = 1\n"
    ))
    .expect("a recipe");
    if let Some(parent) = parent {
        follow(&mut recipe, &parent.write_in(&home())).expect("a release");
    }
    let parent = recipe.parent;
    let (ancestors, known_items) = (recipe.known.releases.clone(), recipe.known.items.len() as u64);
    let recipe = serde_json::to_value(recipe).expect("plain data");
    let mark = canary(&Digest::of(&json(&recipe)));
    let game = Game::from_source(GAME).expect("a game");
    let level = game.level(&tunnel(name)).expect("a level");
    let episode = won(name, Seed::from_text("small"));
    let interval = wilson(0, 8, Z95);
    let never =
        Rate { wins: 0, plays: 8, interval: [interval.low, interval.high], calls: 0, mean_score: 0.0 };
    let id = format!("mole-{}", game.digest().short());
    let card = Card {
        canary: mark.clone(),
        id: id.clone(),
        title: "Mole".into(),
        description: "A mole.".into(),
        goal: engine::describe::Guide::of(&game).goal(),
        kind: "travel".into(),
        real_time: false,
        deterministic: true,
        digest: game.digest(),
        origin: Origin::Corpus { name: "mole".into() },
        rules: engine::describe(&game),
        levels: vec![LevelCard {
            file: "lvl0.txt".into(),
            digest: level.digest(),
            columns: level.columns(),
            rows: level.rows(),
            generator: "constructive".into(),
            asks: None,
            difficulty: 0.0,
            candidate: 0,
            witness_ticks: episode.actions.len(),
            witness_score: episode.score,
            optimal_ticks: Some(episode.actions.len()),
            search_calls: 3,
            mcts: never.clone(),
            random: never.clone(),
            idle: never,
            ladder: None,
            demand: None,
            tier: None,
        }],
    };
    let one = |what: &str| BTreeMap::from([(what.to_owned(), 1)]);
    let ticks = episode.actions.len() as f64;
    let release_card = ReleaseCard {
        canary: mark.clone(),
        games: 1,
        levels: 1,
        new_games: 0,
        planned: Vec::new(),
        difficulty: BTreeMap::new(),
        tiers: BTreeMap::new(),
        goals: one("reach"),
        avatars: one("walks"),
        generators: one("corpus"),
        ladder: Vec::new(),
        novelty: Novelty {
            ancestors,
            known_games: 0,
            known_items,
            nearest: None,
            nearest_corpus: None,
            nearest_known: None,
        },
        patterns: BTreeMap::new(),
        rules: None,
        witness_ticks: Some(Quantiles {
            count: 1,
            min: ticks,
            lower: ticks,
            median: ticks,
            upper: ticks,
            max: ticks,
        }),
        tally: Tally::default(),
    };
    let files = vec![
        (RELEASE_CARD_FILE.to_owned(), json(&release_card)),
        ("README.md".to_owned(), format!("# {name}\n\nCanary: `{mark}`\n").into_bytes()),
        (format!("games/{id}/card.json"), json(&card)),
        (format!("games/{id}/game.vgdl"), format!("# Mole\n# canary {mark}\n{GAME}").into_bytes()),
        (format!("games/{id}/lvl0.txt"), tunnel(name).into_bytes()),
        (format!("games/{id}/witness/lvl0.json"), json(&witness(&mark, episode, &[]))),
    ];
    let mut manifest = Manifest {
        format: FORMAT,
        name: name.into(),
        kind: ReleaseKind::Open,
        semantics: engine::SEMANTICS,
        generation: generators::GENERATION,
        version: Some(snapshots::version::CURRENT.number.to_owned()),
        parent,
        canary: mark,
        commitment: None,
        lockfile: Digest::of(b"the bytes of Cargo.lock"),
        recipe,
        items: files.iter().map(|(path, content)| Item::of(path.clone(), content)).collect(),
        withheld: None,
        root: Digest::of(b""),
        checksum: Digest::of(b""),
    };
    manifest.seal_root().expect("distinct paths");
    Small { manifest, files }
}

/// Returns an episode that wins the level of the named release under the given seed.
pub(crate) fn won(name: &str, seed: Seed) -> Episode {
    let game = Game::from_source(GAME).expect("a game");
    let level = game.level(&tunnel(name)).expect("a level");
    let (mut episode, mut state) = Episode::begin(&game, &level, seed);
    while episode.play(&game, &mut state, Action::Right) == Outcome::Ongoing {}
    assert_eq!(episode.outcome, Outcome::Won);
    episode
}

/// Returns a witness file.
pub(crate) fn witness(mark: &str, episode: Episode, path: &[(&str, u64)]) -> Witness {
    let path = path.iter().map(|&(purpose, index)| (purpose.to_owned(), index)).collect();
    Witness { canary: mark.to_owned(), episode, path }
}

impl Small {
    /// Writes the release to the given folder.
    pub(crate) fn write(&self, out: &Path) {
        let draft = Draft::create(out).expect("vacant");
        for (path, content) in &self.files {
            draft.write(path, content).expect("written");
        }
        draft.write(MANIFEST_FILE, &self.manifest.to_bytes().expect("sound")).expect("written");
        draft.commit().expect("published");
    }

    /// Writes the release to a folder in `home` that is named after it.
    pub(crate) fn write_in(&self, home: &TempDir) -> PathBuf {
        let out = home.path().join(&self.manifest.name);
        self.write(&out);
        out
    }

    /// Updates the manifest and its root to the current files, as a forger would.
    pub(crate) fn seal(&mut self) {
        self.manifest.items =
            self.files.iter().map(|(path, content)| Item::of(path.clone(), content)).collect();
        self.manifest.seal_root().expect("distinct paths");
    }
}

pub(crate) fn json(value: &impl Serialize) -> Vec<u8> {
    to_canonical_json(value).expect("plain data").into_bytes()
}

pub(crate) fn home() -> TempDir {
    tempfile::tempdir().expect("temporary folder")
}
