//! Sealed releases, whose seed and witnesses are withheld: committing to a secret, and revealing it.

use super::progress::Remarks;
use super::summary::log_command;
use super::{find_recipe, is_file};
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::paths;
use crate::protected;
use crate::shell;
use base::Digest;
use base::MessagePath;
use disk::Access;
use serde_json::json;
use snapshots::{MANIFEST_FILE, Recipe, Reveal, RevealError, Secret, Tools, follow, read_secret};
use std::ffi::OsStr;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use trust::{Drawn, MAX_BEACON, check_source, read_bounded};

/// Draws a secret for a recipe, and writes it to a file that only its owner can read.
pub(super) fn commit(
    file: &Path,
    parent: Option<&Path>,
    out: Option<&Path>,
    tools: Tools<'_>,
    console: &Console,
) -> Answer {
    let mut recipe = find_recipe(file, Recipe::to_commit)?;
    check_beacon(&recipe)?;
    if let Some(parent) = parent {
        follow(&mut recipe, parent)?;
    }
    let name = &recipe.name;
    let out = out.map_or_else(|| secret_file(name), Path::to_path_buf);
    protected::check(&out)?;
    // The recipe was read without its commitment.
    let committed = find_recipe(file, Recipe::from_toml).ok().and_then(|recipe| recipe.commitment);
    let taken = || taken(&out, &recipe, committed, &mint_command(file, &out, parent));
    // This is checked before the work, and again when the file is created.
    if paths::metadata(&out)?.is_some() {
        return Err(taken());
    }
    let chance =
        entropy().map_err(|error| Failure::environment(error, "the system provides no random bytes"))?;
    let secret = snapshots::commit(&recipe, chance, tools, &Remarks(console))?;
    let commitment = secret.commitment();
    let text = serde_json::to_string_pretty(&secret).expect("a secret is plain data");
    let shown = out.in_message().to_string();
    disk::create(&out, text.as_bytes(), Access::Private).map_err(|error| match error.kind() {
        std::io::ErrorKind::AlreadyExists => taken(),
        _ => Failure::environment(error, format!("cannot write `{shown}`")),
    })?;
    let caveats = recipe.caveats();
    console.document(&json!({
        "name": name, "commitment": commitment, "recipe": recipe.committed(), "secret": shown, "caveats": caveats,
    }))?;
    // An embedded recipe cannot be changed, so it is copied to a file first.
    let copy = (!is_file(file)).then(|| PathBuf::from(format!("{}.toml", file.display())));
    if let Some(copy) = &copy {
        let show = shell::command([OsStr::new("recipes"), OsStr::new("show"), file.as_os_str()]);
        console.say(format_args!("copy the recipe:  {show} > {}", shell::quoted(copy)));
    }
    let recipe = copy.as_deref().unwrap_or(file);
    console.say(format_args!(
        "in {}, instead of `seed` or, if there is none, above the first [table]:\n\n    commitment = \
         \"{commitment}\"\n",
        recipe.in_message()
    ));
    if committed.is_some() {
        console.say("the recipe already has a `commitment` line: replace it with this one");
    }
    console.say("change nothing else there: the commitment covers the whole recipe");
    let mut entered = vec![OsStr::new("--commitment"), recipe.as_ref()];
    match parent {
        Some(parent) => entered.extend([OsStr::new("--parent"), parent.as_os_str()]),
        None if Path::new("log").exists() => entered.push(OsStr::new("--first")),
        None => {}
    }
    console.say(format_args!("if you keep a log, append the commitment first:  {}", log_command(entered)));
    console.say(format_args!("mint it with:  {}", mint_command(recipe, &out, parent)));
    console.say(format_args!(
        "keep {shown} private and do not lose it: the release cannot be minted without it",
    ));
    caveats.iter().for_each(|caveat| console.say(format_args!("note: {caveat}")));
    Ok(true)
}

/// Returns the command that mints a sealed release.
fn mint_command(recipe: &Path, secret: &Path, parent: Option<&Path>) -> String {
    let mut mint: Vec<&OsStr> =
        vec!["release".as_ref(), recipe.as_ref(), "--secret".as_ref(), secret.as_ref()];
    if let Some(parent) = parent {
        mint.extend(["--parent".as_ref(), parent.as_os_str()]);
    }
    shell::command(mint)
}

/// Returns the failure for a path that already contains a secret, with advice on how to continue. Secrets are
/// never overwritten.
fn taken(file: &Path, recipe: &Recipe, committed: Option<Digest>, mint: &str) -> Failure {
    let shown = format!("`{}` already exists, and secrets are never overwritten", file.in_message());
    let Ok(there) = read_secret(file) else {
        return malformed!("{shown}: choose another --out");
    };
    let (commitment, is_of_recipe) = (there.commitment(), there.recipe == Some(recipe.committed()));
    match committed {
        Some(committed) if committed == commitment && is_of_recipe => malformed!(
            "{shown}; the recipe already has its commitment, so no secret needs to be drawn: mint it with \
             `{mint}`"
        ),
        Some(committed) if committed == commitment => malformed!(
            "{shown}; the recipe contains this secret's commitment, but the recipe or its --parent has changed since: undo the change, or draw a new secret with a different --out and replace the commitment in the recipe"
        ),
        None if is_of_recipe => malformed!(
            "{shown}; it was drawn for this recipe: write `commitment = \"{commitment}\"` into the recipe, \
             instead of `seed` or, if there is none, above the first [table], and mint it with `{mint}`"
        ),
        _ => malformed!(
            "{shown}; this secret belongs to a different recipe or commitment, so choose a different --out"
        ),
    }
}

/// Returns the default path for a secret file.
pub(crate) fn secret_file(name: &str) -> PathBuf {
    PathBuf::from(format!("{name}.secret.json"))
}

/// Returns random bytes from the operating system.
fn entropy() -> std::io::Result<[u8; 64]> {
    let mut chance = [0; 64];
    File::open("/dev/urandom")?.read_exact(&mut chance)?;
    Ok(chance)
}

pub(crate) fn read(file: &Path) -> Result<Secret, Failure> {
    read_secret(file).map_err(Failure::from)
}

/// Checks the beacon source in a recipe, so that the beacon's value can be filled in later.
pub(crate) fn check_beacon(recipe: &Recipe) -> Result<(), Failure> {
    let Some(beacon) = &recipe.beacon else { return Ok(()) };
    check_source(&beacon.source).map_err(|fault| malformed!("`beacon.source` of the recipe: {fault}"))?;
    Ok(())
}

/// Fills in the value of the recipe's beacon.
pub(super) fn take_beacon(recipe: &mut Recipe, file: &Path) -> Result<(), Failure> {
    let shown = file.in_message().to_string();
    let drawn = Drawn::parse(&read_bounded(file, MAX_BEACON)?, &shown)?;
    let Some(beacon) = &mut recipe.beacon else {
        bail!(
            "the recipe has no beacon, so omit --beacon: a release has a beacon only if its commitment \
             covers it"
        );
    };
    beacon
        .take(&drawn.round.source, drawn.round.round, drawn.value)
        .map_err(|error| malformed!("`{shown}`: {error}"))
}

/// Joins a sealed release's public and withheld parts.
pub(super) fn reveal(
    public: Option<&Path>,
    held: &Path,
    what: Reveal,
    out: Option<&Path>,
    console: &Console,
) -> Answer {
    let usage = "arcade release PUBLIC --reveal HELD --out DIR";
    let Some(public) = public else {
        bail!("--reveal needs the public folder of the release as well as the withheld one: {usage}");
    };
    let Some(out) = out else {
        bail!("--reveal needs --out, a folder for the whole release: {usage}");
    };
    // If both parts lie in one folder, the error names that folder.
    for (folder, part, file) in [(public, "public", MANIFEST_FILE), (held, "held", "secret.json")] {
        if paths::metadata(&folder.join(file))?.is_some() {
            continue;
        }
        let inside = folder.join(part);
        let help = match paths::metadata(&inside.join(file))?.is_some() {
            true => format!("did you mean {}?", shell::quoted(&inside)),
            false => format!("pass the folder `{part}` that the release was minted into: {usage}"),
        };
        let folder = folder.in_message();
        bail!("`{folder}` is not the {part} part of a sealed release, because it has no {file}; {help}");
    }
    let draft = protected::draft(out)?;
    let place = out.in_message().to_string();
    match snapshots::reveal(public, held, what, &draft) {
        Ok(manifest) => {
            draft.commit()?;
            console.document(
                &json!({ "revealed": true, "out": place, "root": manifest.root, "problems": [] }),
            )?;
            let command = |verb: &str| shell::command([OsStr::new(verb), out.as_os_str()]);
            if what == Reveal::Solutions {
                console.say(format_args!(
                    "{}: one win of each level is revealed; the seed, the siblings and the second wins \
                     stay withheld",
                    manifest.name
                ));
                console.say(format_args!("root {}\nin   {place}", manifest.root));
                console.say(format_args!("check it:       {}", command("verify")));
                return Ok(true);
            }
            console.say(format_args!(
                "{}: revealed; seed, nonce, recipe and every file match the commitment",
                manifest.name
            ));
            console.say(format_args!("root {}\nin   {place}", manifest.root));
            console.say(format_args!("check it:       {}", command("verify")));
            console.say(format_args!("mint it again:  {}", command("regenerate")));
            console.say("only minting it again proves that the games come from the seed");
            Ok(true)
        }
        Err(RevealError::Problems(problems)) => {
            console.document(&json!({ "revealed": false, "problems": problems }))?;
            problems.iter().for_each(|problem| console.say(problem));
            console.say("NOT revealed: the two parts do not match the commitment");
            Ok(false)
        }
        Err(error) => Err(error.into()),
    }
}
