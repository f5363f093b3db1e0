//! `arcade stream`: verified levels for training.

use super::generate::size;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::flags::numbers::number;
use crate::input::game_input::GameInput;
use crate::input::{self, embedded};
use crate::interrupt;
use crate::protected;
use crate::verbs::releases::export::unsound;
use base::{MessagePath, Seed, count};
use engine::{Game, Level};
use forge::games::slug;
use forge::stream::{Stream, StreamConfig, StreamGame, StreamItem};
use rayon::prelude::*;
use serde_json::{Value, json};
use snapshots::released::Released;
use snapshots::{CorpusGame, Draft};
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Makes new levels of known games for training. Each level meets the criteria of a release, and comes with a win.
///
/// A stream is endless. Its item N depends only on SEED, the games, --difficulty, --size and --avoid, and is made without
/// the items before it. Items share no seed with any release. No item equals a level of the corpus or of a release given
/// with --avoid, not even mirrored, turned or renamed (see `arcade docs train`).
///
/// Each item is printed as one line of JSON as soon as all items before it are printed. After an interruption, continue
/// with --from.
///
/// Exit status 0: all items were made. 1: some indices have no level, or a release does not verify. 2: a game or a flag is
/// malformed.
///
/// Example: arcade stream lesson-1 --games hailglass,quiet-jars --count 100 --difficulty 0.3 > items.jsonl
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Text to derive the stream from
    #[arg(value_name = "SEED")]
    seed: String,
    /// Games to make levels for, separated by commas: files, folders and names of corpus games [default: the corpus]
    #[arg(long, value_name = "GAMES", value_delimiter = ',')]
    games: Vec<String>,
    /// Index of the first item
    #[arg(long, value_name = "N", default_value_t = 0)]
    from: u64,
    /// Number of items
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..))]
    count: u64,
    /// Difficulty from 0 (easiest) to 1 (hardest); by default, every item draws its own
    #[arg(long, value_name = "D", value_parser = number(0.0..=1.0))]
    difficulty: Option<f64>,
    /// Columns and rows, including the border, such as 12x9. By default, sizes similar to those of the game's own levels
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(usize, usize)>,
    /// A release whose levels no item may equal: its folder or .tar.zst. May be repeated
    #[arg(long, value_name = "RELEASE", value_parser = crate::paths::release_parser())]
    avoid: Vec<PathBuf>,
    /// The format of the items
    #[arg(long, value_enum, value_name = "FORMAT", default_value = "jsonl")]
    format: Format,
    /// Output folder for the format `folder` (new or empty)
    #[arg(long, value_name = "DIR", required_if_eq("format", "folder"))]
    out: Option<PathBuf>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// JSON Lines on standard output: one object per line
    Jsonl,
    /// A folder for each game, with its rules, levels and witnesses, and items.jsonl
    Folder,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.format == Format::Jsonl && args.out.is_some() {
        bail!("items in the format jsonl are printed: omit --out, or choose --format folder");
    }
    let draft = args.out.as_deref().map(protected::draft).transpose()?;
    let corpus = corpus()?;
    let sources = match args.games.is_empty() {
        true => corpus.clone(),
        false => input::named_games(&args.games)?.iter().map(Source::read).collect::<Result<_, _>>()?,
    };
    let mut rules = BTreeMap::new();
    for Source { rules: text, game } in &sources {
        let folder = slug(&game.name);
        if rules.insert(folder.clone(), text.clone()).is_some() && args.format == Format::Folder {
            bail!("two games would share the folder `{folder}`: rename the file of one of them");
        }
    }
    let config = StreamConfig { difficulty: args.difficulty, size: args.size, ..StreamConfig::default() };
    let games = sources.into_iter().map(|source| source.game).collect();
    let stream = Stream::new(games, config, Seed::from_text(&args.seed));
    let mut stream = stream.map_err(Failure::malformed)?;
    for Source { game, .. } in &corpus {
        stream.avoid(&game.game, &game.levels);
    }
    for release in &args.avoid {
        let released = match Released::read(release) {
            Ok(released) => released,
            Err(error) => return unsound(error, console),
        };
        for game in &released.games {
            let levels: Vec<Level> = game.levels.iter().map(|released| released.level.clone()).collect();
            stream.avoid(&game.game, &levels);
        }
    }
    let mut items = Items {
        args,
        console,
        draft,
        rules,
        folders: BTreeSet::new(),
        documents: Vec::new(),
        lines: String::new(),
    };
    let missing = items.make(&stream)?;
    items.finish()?;
    Ok(missing == 0)
}

/// A game, and the text of its rules.
#[derive(Clone)]
struct Source {
    rules: String,
    game: StreamGame,
}

impl Source {
    fn read(input: &GameInput) -> Result<Source, Failure> {
        let game = input.compile(false)?;
        let levels = input.checked_levels(&game)?;
        let game = StreamGame { name: input.title.clone(), game, levels };
        Ok(Source { rules: input.source.text.clone(), game })
    }
}

/// Returns the corpus games.
fn corpus() -> Result<Vec<Source>, Failure> {
    let read = |CorpusGame { name, source, levels, .. }: CorpusGame| {
        let broken = |problems| malformed!("in this binary: {name}: {problems}");
        let game = Game::from_source(&source).map_err(broken)?;
        let levels = levels.iter().map(|text| game.level(text)).collect::<Result<_, _>>().map_err(broken)?;
        Ok(Source { rules: source, game: StreamGame { name, game, levels } })
    };
    embedded::corpus()?.games.into_iter().map(read).collect()
}

/// The items of a run, in the order of their indices.
struct Items<'a> {
    args: &'a Args,
    console: &'a Console,
    draft: Option<Draft>,
    /// The rules of each game, by the name of its folder.
    rules: BTreeMap<String, String>,
    /// The folders of the games that have an item.
    folders: BTreeSet<String>,
    /// The items that become one document, if the user requested JSON.
    documents: Vec<Value>,
    /// The content of items.jsonl.
    lines: String,
}

impl Items<'_> {
    /// Generates the items on all threads, and outputs them in index order. Returns the number of indices for which
    /// no level was generated.
    fn make(&mut self, stream: &Stream) -> Result<u64, Failure> {
        let Args { from, count, .. } = *self.args;
        let hint = match self.draft {
            Some(_) => "interrupted; the output folder was not created, and the same command starts over",
            None => {
                "interrupted; to continue, add 1 to the index of the last complete line, and pass it with --from"
            }
        };
        interrupt::watch(|| (), hint.to_owned());
        let bar = self.console.progress(count, "levels");
        let (end, batch) = (from.saturating_add(count), rayon::current_num_threads() as u64);
        let mut missing = 0;
        let mut next = from;
        while next < end && !self.console.is_closed() {
            let after = end.min(next.saturating_add(batch));
            let made: Vec<_> = (next..after).into_par_iter().map(|index| stream.item(index, &())).collect();
            for item in made {
                interrupt::defer();
                match item {
                    Ok(item) => self.output(&item)?,
                    Err(error) => {
                        missing += 1;
                        bar.suspend(|| self.console.remark(error));
                    }
                }
                bar.inc(1);
            }
            next = after;
        }
        bar.finish_and_clear();
        Ok(missing)
    }

    fn output(&mut self, item: &StreamItem) -> Result<(), Failure> {
        let document = serde_json::to_value(item)
            .map_err(|error| Failure::environment(error, "the item cannot be written as JSON"))?;
        if let Some(draft) = &self.draft {
            let (folder, index) = (slug(&item.game), item.index);
            self.folders.insert(folder.clone());
            draft.write(&format!("{folder}/lvl{index}.txt"), item.level.to_string().as_bytes())?;
            let witness = super::generate::pretty(&item.witness)?;
            draft.write(&format!("{folder}/witness/lvl{index}.json"), &witness)?;
            self.lines.push_str(&format!("{document}\n"));
        }
        match (self.console.is_json(), &self.draft) {
            (true, _) => self.documents.push(document),
            (false, None) => self.console.line(&document),
            (false, Some(_)) => {}
        }
        Ok(())
    }

    /// Prints the document, if the user requested JSON, and completes the folder.
    fn finish(self) -> Result<(), Failure> {
        let Items { args, console, draft, rules, folders, documents, lines } = self;
        console.document(&json!({ "seed": args.seed, "items": documents }))?;
        let (Some(draft), Some(out)) = (draft, &args.out) else { return Ok(()) };
        for (folder, rules) in rules.iter().filter(|(folder, _)| folders.contains(*folder)) {
            draft.write(&format!("{folder}/game.vgdl"), rules.as_bytes())?;
        }
        draft.write_of_any_size("items.jsonl", lines.as_bytes())?;
        draft.commit()?;
        let (levels, games) = (lines.lines().count(), count(folders.len(), "game"));
        console.say(format_args!("{} of {games} in {}", count(levels, "level"), out.in_message()));
        Ok(())
    }
}
