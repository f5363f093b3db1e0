//! The answer of `arcade design`, for people and programs.

use super::designer::Connected;
use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::paths;
use base::MessagePath;
use design::{DesignError, DesignFolder, DesignerScore, Draft, GAMES_FOLDER, Results};
use evaluation::Halt;
use serde_json::json;
use std::path::{Path, PathBuf};

/// Describes a finished draft on one line.
pub(super) fn line(draft: &Draft) -> String {
    let name = draft.name.as_deref().unwrap_or("(no idea)");
    let repairs = match draft.repairs.values().sum::<u32>() {
        0 => "no corrections".to_owned(),
        count => base::count(count as usize, "correction"),
    };
    match &draft.problem {
        None => format!("draft {}: {name}: accepted, {repairs}", draft.number),
        Some(problem) => {
            format!("draft {}: {name}: given up in stage `{}`: {problem}", draft.number, draft.stage)
        }
    }
}

/// Prints the results of a run.
pub(super) fn print(
    out: &Path,
    folder: &DesignFolder,
    results: &Results,
    halt: Option<Halt>,
    connected: &Connected,
    console: &Console,
) -> Answer {
    let accepted = results.drafts.iter().filter(|draft| draft.is_accepted()).count();
    let spent = connected.caps.as_ref().map(|caps| caps.spent());
    let cost = spent.filter(|_| folder.settings.price.is_some()).map(|spent| spent.cost.dollars());
    console.document(&json!({
        "results": paths::in_json(out),
        "designer": folder.settings.designer,
        "drafts": folder.settings.drafts,
        "finished": results.drafts.len(),
        "accepted": accepted,
        "spent": spent.map(|spent| json!({ "requests": spent.requests, "tokens": spent.tokens, "cost": cost })),
        "halted": halt.as_ref().map(ToString::to_string),
    }))?;
    let (designer, finished) = (&folder.settings.designer, results.drafts.len());
    console.say(format_args!("{designer}: {accepted} of {} accepted", base::count(finished, "draft")));
    if let Some(spent) = spent {
        let cost = cost.map_or("cost unknown".to_owned(), |cost| format!("{cost:.4} USD"));
        console.say(format_args!("{} requests, {} tokens, {cost}", spent.requests, spent.tokens));
    }
    if accepted > 0 {
        console.say(format_args!("games in {}", out.join(GAMES_FOLDER).in_message()));
    }
    let open = base::count(folder.settings.drafts as usize - finished, "draft");
    match halt {
        None => Ok(true),
        Some(Halt::Budget(why)) => {
            let caps = ["--max-cost", "--max-tokens", "--max-requests"];
            let raised = caps.into_iter().find(|flag| why.contains(flag)).unwrap_or("cap");
            console
                .say(format_args!("{open} unfinished: {why}; continue with --resume and a higher {raised}"));
            Ok(false)
        }
        Some(why) => Err(Failure::environment(
            anyhow::anyhow!("{why}"),
            format_args!("{open} unfinished; continue with --resume"),
        )),
    }
}

/// Prints the result of a replay.
pub(super) fn replayed(results: &Results, differing: &[u64], console: &Console) -> Answer {
    let count = results.drafts.len();
    console.document(&json!({ "replayed": count, "differing": differing }))?;
    for number in differing {
        console.say(format_args!("draft {number} differs from the stored one"));
    }
    let same = count - differing.len();
    console.say(format_args!("{same} of {} reproduced exactly from their logs", base::count(count, "draft")));
    Ok(differing.is_empty())
}

/// Prints the scores of the drafts in several folders.
pub(super) fn report(folders: &[PathBuf], console: &Console) -> Answer {
    let read = |path: &PathBuf| DesignerScore::read(&DesignFolder::open(path)?);
    let scores = folders.iter().map(read).collect::<Result<Vec<_>, DesignError>>()?;
    console.document(&json!({ "scores": scores }))?;
    let table = design::table(&scores);
    console.say(table.to_markdown().trim_end());
    Ok(true)
}
