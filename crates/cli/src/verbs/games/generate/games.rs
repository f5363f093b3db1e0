//! `arcade generate games`: generates new games.

use super::pretty;
use crate::console::{Console, Stopwatch};
use crate::failure::{Answer, Failure};
use crate::input::embedded;
use crate::interrupt;
use crate::protected;
use base::MessagePath;
use base::{Digest, Seed};
use engine::{Game, Level};
use forge::Progress;
use forge::card::Card;
use forge::games::report::{GameSetReport, GamesSample};
use forge::games::{GameOrder, GameSet, Kept, MadeGame, invent_games, make_games};
use forge::levels::Method;
use forge::survey::SurveyedGame;
use generators::games::Kind;
use generators::kernels::kinds;
use indicatif::ProgressBar;
use itertools::Itertools;
use rayon::prelude::*;
use serde_json::json;
use snapshots::mint::JobFolder;
use snapshots::{Draft, SnapshotError, Witness};
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use validators::{Criteria, Effort, GameForm, Judging, Panel};

/// Makes new games: invented rules, names for the sprites, and levels that range from introduction to exam. The same
/// flags give the same bytes, on any number of threads.
///
/// A game takes a few minutes on one core. With --kind, the rules are drawn from hand-written kernels instead, and a
/// game takes about half a minute.
///
/// Each game comes with an episode that wins each of its levels. It has been shown that neither idle nor random
/// players win, that the game passes all gates (`arcade docs gates`), and that it is not close to any corpus game or
/// to any other game in the set. Like a release, the output folder contains one folder per game, with game.vgdl,
/// lvl0.txt and so on, card.json and witness/; `arcade play DIR/GAME` and `arcade run DIR` accept it directly. The
/// folder is either complete or absent.
///
/// An interrupted run leaves its finished attempts in OUT.partial; --resume continues it and gives the same bytes.
///
/// Exit status 0: all requested games were made. 1: fewer, or none. 2: a flag is malformed. 128 + signal, such as 130 for Ctrl-C:
/// interrupted.
///
/// Example: arcade generate games --method search --count 5 --seed autumn --out new-games
#[derive(clap::Args)]
pub(crate) struct Args {
    /// constructive: rules drawn one after another; search: each game improved step by step; evolutionary: an archive of
    /// different games
    #[arg(long, value_name = "METHOD", default_value = "constructive")]
    method: Method,
    /// Number of games
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    count: u32,
    /// Text to derive the seeds from
    #[arg(long, value_name = "TEXT", default_value = "games")]
    seed: String,
    /// Make only games from hand-written kernels of this kind, such as shooter or rescue. May be repeated
    #[arg(long, value_name = "KIND", value_parser = kind)]
    kind: Vec<Kind>,
    /// Number of levels per game
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=20))]
    levels: u32,
    /// Judge the games again, and write a report to this folder (new or empty): report.html, report.json, sheet.png
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Output folder for the games (new or empty)
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Continue an interrupted run of the same command
    #[arg(long)]
    resume: bool,
}

impl Args {
    /// Returns `true` if the rules must come from kernels (hand-written designs). Only games from kernels have kinds.
    fn is_of_kernels(&self) -> bool {
        !self.kind.is_empty()
    }

    fn order(&self) -> GameOrder {
        if !self.is_of_kernels() {
            return GameOrder::of_inventions(self.method, self.count).with_levels(self.levels);
        }
        let order = GameOrder::new(self.count).with_levels(self.levels);
        GameOrder { kinds: self.kind.clone(), ..order }
    }

    /// Returns a digest of all inputs that affect the result's bytes. Stored attempts are reused only if the
    /// digest is the same.
    fn plan(&self, order: &GameOrder) -> Digest {
        let versions = (engine::SEMANTICS, generators::GENERATION);
        let kinds: Vec<&str> = match self.is_of_kernels() {
            true => order.kinds.iter().map(|kind| kind.name()).collect(),
            false => Vec::new(),
        };
        let plan = json!([self.method, self.seed, self.count, kinds, self.levels, versions]);
        Digest::of(plan.to_string().as_bytes())
    }
}

fn kind(text: &str) -> Result<Kind, String> {
    let names = || kinds().map(Kind::name);
    kinds().find(|kind| kind.name() == text).ok_or_else(|| {
        let all = || format!("the kinds are {}", names().join(", "));
        let help = engine::nearest(text, names()).map_or_else(all, |near| format!("did you mean `{near}`?"));
        format!("unknown kind; {help}")
    })
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    if args.is_of_kernels() && args.method != Method::Constructive {
        let method = args.method;
        bail!(
            "--kind selects hand-written kernels, which --method {method} does not use: leave out \
             --method or --kind"
        );
    }
    let order = args.order();
    let corpus = corpus_games()?;
    let known: Vec<GameForm> = corpus.iter().map(|(_, game)| GameForm::of(game)).collect();
    // Check the output path before minutes of work.
    let draft = if args.resume { protected::resumed(&args.out)? } else { protected::draft(&args.out)? };
    let store = JobFolder::open(&draft.jobs(), args.plan(&order))?;
    let report_draft = args.report.as_deref().map(protected::draft).transpose()?;
    let hint = "interrupted; finished work is kept: continue with the same command and --resume";
    interrupt::watch(|| (), hint.to_owned());
    let bar = console.progress(u64::from(args.count), "games");
    let bar = Bar { bar, console, store, failure: Mutex::new(None) };
    let started = Stopwatch::start();
    let seed = Seed::from_text(&args.seed).child(args.method.name(), 0);
    let canary = snapshots::canary(&Digest::of(seed.child("canary", 0).to_string().as_bytes()));
    let made = match args.is_of_kernels() {
        true => make_games(&order, &known, &canary, seed, &bar),
        false => invent_games(&order, &known, &canary, seed, &bar),
    };
    bar.bar.finish_and_clear();
    if let Some(failure) = bar.failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(failure.into());
    }
    let set = match made {
        Ok(set) => set,
        Err(error) => {
            console.document(&json!({ "games": [], "reason": error.to_string() }))?;
            console.remark(format_args!("{error}"));
            draft.discard()?;
            return Ok(false);
        }
    };
    for game in &set.games {
        write(&draft, game)?;
    }
    draft.write("games.json", &pretty(&document(args, &set))?)?;
    interrupt::defer();
    draft.commit()?;
    let seconds = started.seconds();
    if let Some(report_draft) = report_draft {
        let bar = console.progress(set.games.len() as u64, "report");
        report(args, report_draft, &corpus, &set, (seconds, &bar))?;
        bar.finish_and_clear();
    }
    console.document(&document(args, &set))?;
    console.say(summary(args, &set, seconds).trim_end());
    Ok(set.games.len() == args.count as usize)
}

/// Returns the corpus games, from which new games must be distinct.
fn corpus_games() -> Result<Vec<(String, Game)>, Failure> {
    let compile = |game: &snapshots::CorpusGame| {
        let compiled = Game::from_source(&game.source);
        compiled
            .map(|compiled| (game.name.clone(), compiled))
            .map_err(|problems| malformed!("the corpus game `{}` does not compile: {problems}", game.name))
    };
    embedded::corpus()?.games.iter().map(compile).collect()
}

/// Judges the games again, with different seeds and twice as many episodes as a release requires, and writes
/// the report on the games.
fn report(
    args: &Args,
    draft: Draft,
    corpus: &[(String, Game)],
    set: &GameSet,
    (seconds, bar): (f64, &ProgressBar),
) -> Result<(), Failure> {
    let plain = Criteria::of_generated_games();
    let criteria = Criteria {
        idle_plays: 2 * plain.idle_plays,
        random_plays: 2 * plain.random_plays,
        ladder_plays: 2 * plain.ladder_plays,
        ladder_calls: 2 * plain.ladder_calls,
        ..plain
    };
    let panel = Panel::new(criteria.check().map_err(Failure::malformed)?, Effort::Full);
    let seed = Seed::from_text(&args.seed).child("report", 0);
    let judge = |made: &MadeGame| {
        let levels: Vec<Level> = made.levels.iter().map(|found| found.level.clone()).collect();
        let seed = seed.child(&made.card.digest.to_string(), 0);
        let report = panel.judge(Judging::game(&made.game, &levels, seed));
        bar.inc(1);
        let Card { title: name, goal, .. } = made.card.clone();
        SurveyedGame { name, goal, game: made.game.clone(), levels, report }
    };
    let games: Vec<SurveyedGame> = set.games.par_iter().map(judge).collect();
    let report = GameSetReport::of(&GamesSample {
        method: args.method.name(),
        games: &games,
        corpus,
        criteria: &criteria,
        cost: Some(&set.tally),
        seed: seed.child("measures", 0),
    });
    let title = format!("{} games, seed {}", args.method, args.seed);
    let made = (title.as_str(), args.method.name(), Some(seconds));
    protected::publish(draft, pages::game_report(&report, &games, Some(&set.tally), made)?)?;
    Ok(())
}

/// The generation's progress, shown as a bar, or as one line per game if no bar can be drawn. Finished
/// attempts are stored.
struct Bar<'a> {
    bar: ProgressBar,
    console: &'a Console,
    store: JobFolder,
    /// The store's first failure, or `None` if every access succeeded.
    failure: Mutex<Option<SnapshotError>>,
}

impl Bar<'_> {
    /// Returns the value. If the store failed, records its first failure instead.
    fn noted<T>(&self, result: Result<T, SnapshotError>) -> Option<T> {
        let note = |failure| {
            let mut first = self.failure.lock().unwrap_or_else(PoisonError::into_inner);
            first.get_or_insert(failure);
        };
        result.map_err(note).ok()
    }
}

impl Progress for Bar<'_> {
    fn looked(&self) {
        self.bar.tick();
    }

    fn made(&self, title: &str) {
        self.bar.set_message(title.to_owned());
        self.bar.inc(1);
        if self.bar.is_hidden() {
            self.console.remark(format_args!("made: {title}"));
        }
    }

    fn kept(&self, attempt: &str) -> Option<Kept> {
        self.noted(self.store.stored(attempt)).flatten()
    }

    fn keep(&self, attempt: &str, result: &Kept) {
        self.noted(self.store.store(attempt, result));
    }
}

/// Writes a game, its card, its levels and the winning episodes.
fn write(draft: &Draft, made: &MadeGame) -> Result<(), Failure> {
    let folder = &made.card.id;
    draft.write(&format!("{folder}/game.vgdl"), made.text.as_bytes())?;
    draft.write(&format!("{folder}/card.json"), &pretty(&made.card)?)?;
    for (number, (level, episode)) in made.levels.iter().zip(&made.witnesses).enumerate() {
        let text = level.level.to_string();
        draft.write(&format!("{folder}/lvl{number}.txt"), text.as_bytes())?;
        let witness =
            Witness { canary: made.card.canary.clone(), episode: episode.clone(), path: Vec::new() };
        draft.write(&format!("{folder}/witness/lvl{number}.json"), &pretty(&witness)?)?;
    }
    Ok(())
}

/// Returns the machine-readable answer. The same flags give the same bytes.
fn document(args: &Args, set: &GameSet) -> serde_json::Value {
    let cards: Vec<&Card> = set.games.iter().map(|game| &game.card).collect();
    json!({
        "method": args.method,
        "seed": args.seed,
        "asked": { "count": args.count, "kinds": args.kind, "levels": args.levels },
        "generation": generators::GENERATION,
        "semantics": engine::SEMANTICS,
        "games": cards,
        "looks": set.tally.looks(),
        "tally": set.tally,
    })
}

/// Returns the summary of the generated games that the terminal shows.
fn summary(args: &Args, set: &GameSet, seconds: f64) -> String {
    let mut text = String::new();
    let width = set.games.iter().map(|game| game.card.title.chars().count()).max().unwrap_or(0);
    for Card { title, kind, goal, levels, id, .. } in set.games.iter().map(|game| &game.card) {
        let ticks: Vec<String> = levels.iter().map(|level| level.witness_ticks.to_string()).collect();
        let _ = writeln!(text, "  {title:<width$}  {kind:<18} won in {} ticks", ticks.join(", "));
        let _ = writeln!(text, "  {:<width$}  {goal}", "");
        let _ = writeln!(text, "  {:<width$}  {id}", "");
    }
    let GameSet { games, tally, .. } = set;
    let looks = tally.looks();
    let (made, asked, judged, tried) = (games.len(), args.count, tally.games_tried, tally.levels_tried);
    let millions = tally.calls as f64 / 1e6;
    let _ = writeln!(
        text,
        "\n{made} of {asked} games in {seconds:.1} s; {looks} candidates inspected, {judged} judged, {tried} levels tried; {millions:.1} million forward-model calls"
    );
    if !tally.rejections.is_empty() {
        let _ = writeln!(text, "rejected: {}", tally.reasons());
    }
    let missing = asked as usize - made;
    if missing > 0 {
        let _ = writeln!(
            text,
            "{missing} could not be made, because all attempts are used up: request fewer games or different \
             kinds, or use a different seed"
        );
    }
    let out = args.out.in_message();
    if let Some(first) = set.games.first() {
        let _ = writeln!(text, "in {out}; play: arcade play {out}/{} 0", first.card.id);
    }
    text
}
