//! The `README.md` of an export: a dataset card in the form that dataset hubs read, with YAML between two
//! `---` lines followed by Markdown.

use super::columns::{Column, ColumnKind};
use super::item::ExportedGame;
use super::options::{Export, Format, SPLIT};
use crate::publish::papers;
use crate::released::Released;
use forge::card::{Card, Origin};
use std::fmt::Write;

/// The rows that a card describes.
pub(super) struct Rows<'a> {
    /// The path of the file with the rows.
    pub(super) file: &'a str,
    /// The size of the file in bytes.
    pub(super) bytes: usize,
    pub(super) games: &'a [(&'a Card, ExportedGame<'a>)],
    /// The number of levels, which is also the number of rows.
    pub(super) levels: usize,
}

/// Returns an export's dataset card.
pub(super) fn page(released: &Released, export: &Export, columns: &[Column], rows: &Rows<'_>) -> String {
    let mut text = front(released, export, columns, rows);
    text += &body(released, export, rows);
    text
}

/// Quotes text for YAML in JSON style, which is valid YAML.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn title(released: &Released, export: &Export) -> String {
    let twin = export.twin.map(|twin| format!(", {twin}")).unwrap_or_default();
    format!("{}{twin}", papers::title(&released.manifest))
}

fn front(released: &Released, export: &Export, columns: &[Column], rows: &Rows<'_>) -> String {
    let Rows { file, bytes, levels: rows, .. } = *rows;
    let size = match rows {
        0..1_000 => "n<1K",
        1_000..10_000 => "1K<n<10K",
        10_000..100_000 => "10K<n<100K",
        _ => "100K<n<1M",
    };
    let mut text = format!(
        "---\npretty_name: {}\nlicense:\n- mit\n- apache-2.0\nlanguage:\n- en\nannotations_creators:\n- machine-generated\n\
         language_creators:\n- machine-generated\nsource_datasets:\n- original\nsize_categories:\n- {size}\n\
         task_categories:\n- reinforcement-learning\n- text-generation\ntags:\n- games\n- vgdl\n- planning\n- benchmark\n- evaluation\n",
        quoted(&title(released, export)),
    );
    let _ = write!(
        text,
        "configs:\n- config_name: default\n  data_files:\n  - split: {SPLIT}\n    path: {file}\ndataset_info:\n  features:\n"
    );
    for Column { name, kind, .. } in columns {
        let _ = match kind {
            ColumnKind::Texts => writeln!(text, "  - name: {name}\n    list: string"),
            ColumnKind::Records(fields) => {
                let _ = writeln!(text, "  - name: {name}\n    list:");
                fields.iter().try_for_each(|(name, kind)| {
                    writeln!(text, "    - name: {name}\n      dtype: {}", kind.data_type())
                })
            }
            kind => writeln!(text, "  - name: {name}\n    dtype: {}", kind.data_type()),
        };
    }
    let _ = write!(
        text,
        "  splits:\n  - name: {SPLIT}\n    num_bytes: {bytes}\n    num_examples: {rows}\n  download_size: {bytes}\n  \
         dataset_size: {bytes}\n---\n\n"
    );
    text
}

fn body(released: &Released, export: &Export, rows: &Rows<'_>) -> String {
    let manifest = &released.manifest;
    let Rows { file, levels, .. } = *rows;
    let games = rows.games.len();
    let new = rows.games.iter().filter(|(card, _)| matches!(card.origin, Origin::Generated { .. })).count();
    // The winning episodes of a sealed release are withheld until the release is revealed.
    let is_withheld =
        released.games.iter().flat_map(|game| &game.levels).any(|level| level.witness.is_none());
    let mut text = format!(
        "# {}\n\n{levels} levels of {games} arcade games, {new} of them with new rules, made and verified by Infinite Arcade: every level has been won, and no level is won by doing nothing. Each row of `{file}` is one level together with its game: rules in plain \
         English and in VGDL, the board as text, what each of its characters stands for, and how hard it is.\n\n",
        title(released, export),
    );
    let _ = write!(
        text,
        "**Please keep this dataset out of training data.** Its only split is `{SPLIT}`. Canary: `{}`\n\n",
        manifest.canary
    );
    if let Some(twin) = export.twin {
        let _ = write!(
            text,
            "## A twin\n\nThis is the `{twin}` twin of the release: the same mechanics under a different surface, which shows whether a model understands a game or remembers it. `title`, `description`, `goal`, `rules`, `vgdl`, `level_text`, `legend` and \
             the digests are the twin's; the measurements (difficulty, ladder, win rates, witness) were \
             made on the original. `game_id` and `item_id` join the two, and do not belong in a prompt.\n\n"
        );
    }
    let solutions = match export.solutions {
        true => {
            "The columns `solution` and `solution_seed` contain an episode that wins the level: hide both \
             columns from evaluated players."
        }
        false if is_withheld => {
            "No row contains a solution, and the release withholds its winning episodes until the reveal."
        }
        false => "No row contains a solution; the release contains the solutions as winning episodes.",
    };
    let _ = write!(text, "{solutions}\n\n## Where it comes from\n\n");
    let _ = write!(
        text,
        "Release `{}`, root digest\n\n    {}\n\n(engine semantics {}, generation {}). This dataset is an excerpt of it; check the \
         release itself with\n\n    arcade verify DIR        # its digests{}\n    arcade regenerate DIR    # minted again \
         from its seed, bit for bit{}\n\nand make this dataset from it, byte for byte, with\n\n    arcade export DIR --format {}{}{} --out \
         dataset\n\n",
        manifest.name,
        manifest.root,
        manifest.semantics,
        manifest.generation,
        if is_withheld { "; wins are withheld until the reveal" } else { ", and every win replayed" },
        if is_withheld { ", once that is revealed" } else { "" },
        export.format,
        export.twin.map(|twin| format!(" --twin {twin}")).unwrap_or_default(),
        if export.solutions { " --solutions" } else { "" },
    );
    let load = match export.format {
        Format::JsonLines => format!("pandas.read_json(\"{file}\", lines=True)"),
        #[cfg(feature = "parquet")]
        Format::Parquet => format!("pandas.read_parquet(\"{file}\")"),
        Format::Games => unreachable!("folders of games have no rows to read"),
    };
    let _ = write!(
        text,
        "## Reading it\n\n```python\nimport datasets, pandas\n\nitems = datasets.load_dataset(\"DIR\", split=\"{SPLIT}\")   # DIR: this \
         folder\ntable = {load}\n```\n\nSee `arcade docs export` for what each column holds.\n"
    );
    text
}
