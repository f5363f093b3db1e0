//! `arcade study contamination`: tests whether a player has seen a release's games or their solutions.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::shell;
use crate::verbs::releases::export;
use base::MessagePath;
use base::count;
use evaluation::contamination::{
    ALPHA, Coins, Contamination, Evidence, GameCoin, LevelCoin, PlayerMemory, Power, SideTest, contamination,
    design, episodes_by_player,
};
use serde_json::json;
use snapshots::ReleaseKind;
use snapshots::memory::MemoryPart;
use snapshots::released::{Released, ReleasedGame};
use std::ffi::OsStr;
use std::path::PathBuf;

/// Tests whether players have seen the games of a release, or their published solutions.
///
/// In a sealed release whose recipe has [memory], coin tosses decided which of two renamings of each game, and which of
/// two wins of each level, was published. The other one is withheld. A player that has never seen the published one
/// cannot tell the two apart, so the tests are exact. Does the player win more often on the published games than on
/// their siblings (the withheld renamings)? Do its episodes begin like the published wins rather than the withheld
/// ones? At most 1% of clean models are flagged. The tests are valid for models trained before the full reveal (see
/// `arcade docs memory`). An open release, such as `starter`, makes no such choices and cannot be tested. Without
/// RESULTS, prints what the tests could detect if every level were played once.
///
/// Exit status 0: consistent with not having seen the release, or too few pairs to tell. 1: a player has seen part of
/// the release. 2: malformed input, or nothing could be tested.
///
/// Example: arcade study contamination results/a-model results/a-model-siblings --release releases/2027-01
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Results folders written by `arcade evaluate`, for the release and for its siblings
    #[arg(value_name = "RESULTS")]
    results: Vec<PathBuf>,
    /// The folder or .tar.zst of the revealed release
    #[arg(long, value_name = "SNAPSHOT", value_parser = crate::paths::release_parser())]
    release: PathBuf,
}

/// The power below which a nonsignificant test is uninformative.
const SMALL: f64 = 0.8;

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let released = match Released::read(&args.release) {
        Ok(released) => released,
        Err(error) => return export::unsound(error, console),
    };
    let coins = coins(&released, args)?;
    let (name, root) = (&released.manifest.name, released.manifest.root);
    let (siblings, wins) = coins.counts();
    let (games, levels) = (count(siblings, "game"), count(wins, "level"));
    let has = format!("{name}: {games} with siblings, {levels} with two wins");
    if args.results.is_empty() {
        let (levels, pairs) = design(&coins);
        let power = Power::of(levels, &pairs, ALPHA / 2.0);
        console.document(&json!({ "release": name, "root": root, "alpha": ALPHA, "power": power }))?;
        console.say(has);
        console.say(format_args!(
            "power of the tests if every level is played once in its published and once in its withheld form, \
             at a significance level of {ALPHA} for both tests together:"
        ));
        say_power(&power, console);
        return Ok(true);
    }
    let players = episodes_by_player(&args.results)?;
    let found = contamination(&coins, &players);
    if found.tests == 0 {
        let mut unknown = found.players.iter().map(|player| player.unknown).zip(&players);
        let is_of_release = unknown.any(|(unknown, player)| unknown < player.episodes.len() as u64);
        let what = match is_of_release {
            true => "no player has played both a game and its renamed sibling, or a level with two wins",
            false => "these results contain no episode on any level of the release",
        };
        bail!("{name}: {what}; {}", next(args));
    }
    console.document(&json!({ "release": name, "root": root, "findings": &found }))?;
    console.say(has);
    let Contamination { tests, players, .. } = &found;
    let each = ALPHA / *tests as f64;
    console.say(format_args!(
        "significance level {ALPHA} for all {} together, {each:.5} for each (Bonferroni)",
        count(*tests as usize, "test")
    ));
    for player in players {
        say(player, found.needed, args, console);
    }
    Ok(!players.iter().any(|player| player.evidence.is_seen()))
}

/// Returns the secret random choices ("coins") of a revealed release, which decided which of two equivalent items was
/// published.
fn coins(released: &Released, args: &Args) -> Result<Coins, Failure> {
    let manifest = &released.manifest;
    let (name, place) = (&manifest.name, args.release.in_message());
    let how = "mint a sealed release whose recipe has `[memory]` (`arcade docs memory`)";
    if manifest.kind == ReleaseKind::Open {
        bail!("{place}: `{name}` is open, so nothing was withheld; {how}");
    }
    if MemoryPart::of(manifest).is_none() {
        bail!(
            "{place}: `{name}` has neither withheld siblings (renamed copies of games) nor withheld wins, because its recipe has no `[memory]`; {how}"
        );
    }
    let coins = Coins { games: released.games.iter().map(coin).collect() };
    if coins.counts() == (0, 0) {
        let has = |part: &str| manifest.items.iter().any(|item| item.path.starts_with(part));
        if manifest.is_hiding() || has("held/siblings/") || has("held/seconds/") {
            bail!(
                "{place}: the withheld parts of `{name}` are missing; reveal the release, or \
                 ask its publisher to: arcade release PUBLIC --reveal HELD --out DIR"
            );
        }
        bail!("{place}: `{name}` has no sibling (renamed copy) of any game and no second win of any level");
    }
    Ok(coins)
}

fn coin(released: &ReleasedGame) -> GameCoin {
    let sibling = released.sibling.as_ref();
    let level = |(number, level): (usize, &snapshots::released::ReleasedLevel)| LevelCoin {
        published: level.level.digest(),
        withheld: sibling.and_then(|sibling| Some(sibling.levels.get(number)?.1.digest())),
        beginnings: level.beginnings(),
    };
    GameCoin {
        id: released.card.id.clone(),
        published: released.game.digest(),
        withheld: sibling.map(|sibling| sibling.game.digest()),
        levels: released.levels.iter().enumerate().map(level).collect(),
    }
}

/// Returns the commands that play the episodes required by the tests.
fn next(args: &Args) -> String {
    let release = args.release.as_os_str();
    let word = OsStr::new;
    let export = shell::command(
        [word("export"), release]
            .into_iter()
            .chain(["--twin", "sibling", "--format", "games", "--out", "siblings"].map(word)),
    );
    let [published, siblings] = [release, word("siblings")].map(|games| {
        shell::command([
            word("evaluate"),
            games,
            word("--player"),
            word("PLAYER"),
            word("--out"),
            word("DIR"),
        ])
    });
    format!("play the release and its siblings: {published}; {export}; {siblings}")
}

fn say(player: &PlayerMemory, needed: u64, args: &Args, console: &Console) {
    let coins = player.solutions.iter().chain(&player.games).map(|test| test.coins).max().unwrap_or(0);
    let why = match player.evidence {
        Evidence::CannotTell => format!(": {}, at least {needed} needed", count(coins as usize, "coin")),
        _ => String::new(),
    };
    console.say(format_args!("\n{}: {}{why}", player.player, player.evidence.words()));
    if let Some(power) = weak(player) {
        console.say(format_args!(
            "  these episodes say little: a player that knows half of the levels would be detected with \
             probability {power:.2}"
        ));
    }
    if player.solutions.is_none() && player.games.is_none() {
        return console.say(format_args!("  {}", next(args)));
    }
    say_power(&player.power, console);
    if let Some(SideTest { coins, informative, episodes, published, withheld, p, .. }) = &player.solutions {
        let levels = count(*coins as usize, "level");
        console.say(format_args!(
            "  solutions: {published} of {} on {levels} begin like the published win, {withheld} like the \
             withheld \
             one; {informative} informative coins, p = {p:.6}",
            count(*episodes as usize, "episode")
        ));
    }
    if let Some(SideTest { coins, informative, episodes, published, withheld, p, .. }) = &player.games {
        let games = count(*coins as usize, "game");
        console.say(format_args!(
            "  games: in {} of episodes on {games}, {published} won as published, {withheld} as the sibling; \
             {informative} informative coins, p = {p:.6}",
            count(*episodes as usize, "pair")
        ));
    } else {
        console.say(format_args!("  games: not tested; {}", next(args)));
    }
    if player.unknown > 0 {
        console.remark(format_args!(
            "{}: left out {} on levels that the release does not have",
            player.player,
            count(player.unknown as usize, "episode")
        ));
    }
}

/// Returns the larger of the tests' powers against a player that knows half of the levels. Returns `None` if
/// evidence was found, or if that power is high enough.
fn weak(player: &PlayerMemory) -> Option<f64> {
    let half = player.power.iter().find(|power| power.share == 0.5)?;
    let greatest = half.solutions.into_iter().chain(half.games).reduce(f64::max)?;
    (!player.evidence.is_seen() && greatest < SMALL).then_some(greatest)
}

fn say_power(power: &[Power], console: &Console) {
    let row = |of: &dyn Fn(&Power) -> String| power.iter().map(of).collect::<Vec<_>>().join("  ");
    console.say(format_args!(
        "  power, if a player knows this fraction of the levels  {}",
        row(&|power| format!("{:>4.0}%", 100.0 * power.share))
    ));
    for (what, of) in [
        ("by its solutions", (|power| power.solutions) as fn(&Power) -> Option<f64>),
        ("by its games", |power| power.games),
    ] {
        if power.iter().any(|power| of(power).is_some()) {
            let shares = row(&|power| {
                of(power).map_or(String::new(), |found| {
                    // Sums of rounded terms may come out just below zero.
                    format!("{:>5.2}", if found < 0.005 { 0.0 } else { found })
                })
            });
            console.say(format_args!("    {what:<51} {shares}"));
        }
    }
}
