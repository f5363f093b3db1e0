//! `arcade mailbox`: shows an evaluation's open prompts, and delivers the answers that the user types.

use crate::console::Console;
use crate::failure::{Answer, Failure};
use crate::paths;
use base::MessagePath;
use base::count;
use evaluation::player::mailbox::{Delivery, Desk, OpenPrompt, View};
use itertools::Itertools;
use serde_json::json;
use std::collections::BTreeSet;
use std::io::{BufRead, IsTerminal, Write};
use std::path::PathBuf;
use std::time::Duration;

/// The pause between checks of the mailbox.
const PAUSE: Duration = Duration::from_millis(100);

/// The number of checks for the same episode's next prompt before a different episode is shown. Together, the
/// checks take two seconds.
const PATIENCE: u32 = 20;

/// Shows the prompts that are waiting in an evaluation's mailbox, one at a time, and answers them with the lines that
/// you type.
///
/// A line is an action, such as `left`, its first letters or an arrow key, or a command: `list`, `rules`, `show`,
/// `skip`, `quit`, `help`; `say TEXT` sends the text verbatim. With --json, the waiting prompts are listed and
/// nothing is answered.
///
/// Exit status 0: listed, or the evaluation is over. 1: it is not over. 2: there is no mailbox. 3: the disk failed.
///
/// Example: arcade mailbox alice
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder passed to `arcade evaluate … --player mailbox:DIR`
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// Only list the waiting prompts
    #[arg(long)]
    list: bool,
    /// Answer only the prompts of this episode
    #[arg(long, value_name = "NAME")]
    episode: Option<String>,
}

pub(crate) fn run(args: &Args, console: &Console) -> Answer {
    let desk = Desk::open(&args.folder)?;
    let view = desk.view()?;
    console.document(&document(&desk, &view))?;
    if args.list || console.is_json() {
        console.say(listed(&desk, &view));
        return Ok(true);
    }
    let mut session = Session {
        desk,
        console,
        only: args.episode.clone(),
        introduced: BTreeSet::new(),
        skipped: BTreeSet::new(),
        current: None,
        is_waiting: false,
    };
    session.run()
}

/// An interactive session in which a person answers prompts.
struct Session<'a> {
    desk: Desk,
    console: &'a Console,
    /// The only episode to answer, or `None` for any episode.
    only: Option<String>,
    /// The episodes whose rules have been shown.
    introduced: BTreeSet<String>,
    /// The episodes postponed by the user.
    skipped: BTreeSet<String>,
    /// The most recently answered episode.
    current: Option<String>,
    /// `true` if the user has been informed that no prompt is waiting.
    is_waiting: bool,
}

/// The effect of a typed line.
enum Typed {
    /// The prompt has an answer, or will not be answered now.
    Done,
    /// The session needs another line.
    Again,
    Quit,
}

impl Session<'_> {
    /// Shows prompts until the user leaves or no more prompts arrive. The answer is yes if the evaluation is
    /// over.
    fn run(&mut self) -> Answer {
        while let Some(open) = self.next()? {
            self.is_waiting = false;
            self.show(&open);
            if self.ask(&open)? {
                break;
            }
        }
        let view = self.desk.view()?;
        self.console.say(listed(&self.desk, &view));
        Ok(view.finished.is_some())
    }

    /// Waits for the next prompt. Returns `None` if no more prompts will arrive.
    fn next(&mut self) -> Result<Option<OpenPrompt>, Failure> {
        let mut looks = 0;
        loop {
            let view = self.desk.view()?;
            self.tell_end(&view)?;
            let wanted = |open: &&OpenPrompt| {
                self.only.as_ref().is_none_or(|only| *only == open.prompt.episode)
                    && !self.skipped.contains(&open.prompt.episode)
            };
            let mut waiting = view.waiting.iter().filter(wanted);
            let is_current = |open: &&OpenPrompt| self.current.as_ref() == Some(&open.prompt.episode);
            if let Some(open) = waiting.clone().find(is_current) {
                return Ok(Some(open.clone()));
            }
            if self.current.is_none() || looks >= PATIENCE {
                if let Some(open) = waiting.next() {
                    return Ok(Some(open.clone()));
                }
                if !self.skipped.is_empty() {
                    // No other prompt is waiting, so the skipped prompts are shown again.
                    self.skipped.clear();
                    continue;
                }
                let is_over = |only: &String| view.ended.iter().any(|(episode, _)| episode == only);
                if view.finished.is_some() || !view.is_running || self.only.as_ref().is_some_and(is_over) {
                    return Ok(None);
                }
                if !self.is_waiting {
                    self.is_waiting = true;
                    self.console.remark("waiting for the next prompt; press Ctrl-C to leave");
                }
            }
            looks += 1;
            std::thread::sleep(PAUSE);
        }
    }

    /// Shows the last message of the most recently answered episode once that episode has ended.
    fn tell_end(&mut self, view: &View) -> Result<(), Failure> {
        let Some(current) = &self.current else { return Ok(()) };
        if !view.ended.iter().any(|(episode, _)| episode == current) {
            return Ok(());
        }
        if let Some(text) = self.desk.ending(current)? {
            self.console.say(format_args!("\n--- {current} has ended ---\n{}", text.trim_end()));
        }
        self.current = None;
        Ok(())
    }

    fn show(&mut self, open: &OpenPrompt) {
        let prompt = &open.prompt;
        let (episode, step) = (&prompt.episode, prompt.address.step);
        self.console.say(format_args!("\n--- {episode}, step {step} ---"));
        if self.introduced.insert(episode.clone()) && prompt.messages.len() > 1 {
            self.tell(&format!("{}\n", prompt.messages[0].text));
        }
        self.show_turn(open);
    }

    /// Shows the newest message.
    fn show_turn(&self, open: &OpenPrompt) {
        if let Some(message) = open.prompt.messages.last() {
            self.tell(&message.text);
        }
        if let Some(picture) = &open.prompt.picture {
            let path = self.desk.episode(&open.prompt.episode).join(picture);
            self.console.say(format_args!("The image is {}", path.in_message()));
        }
        if let Some(problem) = &open.problem {
            self.console.remark(problem);
        }
    }

    /// Prints part of a prompt, wrapped to the width of a terminal.
    fn tell(&self, text: &str) {
        match columns() {
            Some(columns) => self.console.say(wrapped(text, columns)),
            None => self.console.say(text),
        }
    }

    /// Reads lines until the prompt has an answer. Returns `true` if the user leaves.
    fn ask(&mut self, open: &OpenPrompt) -> Result<bool, Failure> {
        loop {
            self.invite(open);
            let mut line = Vec::new();
            let read = std::io::stdin().lock().read_until(b'\n', &mut line);
            let read = read.map_err(|error| Failure::environment(error, "cannot read standard input"))?;
            if read == 0 {
                return Ok(true);
            }
            let Ok(line) = String::from_utf8(line) else {
                self.console.remark("that line is not UTF-8; type it again");
                continue;
            };
            match self.typed(open, line.trim())? {
                Typed::Done => return Ok(false),
                Typed::Again => {}
                Typed::Quit => return Ok(true),
            }
        }
    }

    /// Prints an input prompt, if standard input is a terminal.
    fn invite(&self, open: &OpenPrompt) {
        if std::io::stdin().is_terminal() {
            let mut stderr = std::io::stderr();
            let asked = match open.prompt.actions.join(", ") {
                actions if actions.is_empty() => "KILLS: …; STOPS: …; GOES: …; SCORES: …".to_owned(),
                actions => actions,
            };
            let _ = write!(stderr, "\n{asked} (help)> ");
            let _ = stderr.flush();
        }
    }

    fn typed(&mut self, open: &OpenPrompt, line: &str) -> Result<Typed, Failure> {
        let actions = &open.prompt.actions;
        let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        if word == "say" {
            return self.deliver(open, rest.trim());
        }
        // A question without actions is answered with free text.
        if is_formatted(line) || (actions.is_empty() && line.contains(':')) {
            return self.deliver(open, line);
        }
        match (line.to_lowercase().as_str(), action(line, actions)) {
            ("", _) => {}
            (_, Some(action)) => return self.deliver(open, &formatted(open, action)),
            ("quit" | "q" | "exit", None) => return Ok(Typed::Quit),
            ("skip" | "next", None) => {
                self.skipped.insert(open.prompt.episode.clone());
                self.current = None;
                return Ok(Typed::Done);
            }
            ("show", None) => self.show_turn(open),
            ("rules", None) => {
                open.prompt.messages.first().iter().for_each(|message| self.tell(&message.text));
            }
            ("list", None) => self.console.say(listed(&self.desk, &self.desk.view()?)),
            ("help" | "?", None) => self.console.say(HELP),
            (_, None) => self.console.remark(format_args!(
                "`{line}` isn't one of {}; `say {line}` sends it verbatim, `help` lists the commands",
                actions.join(", ")
            )),
        }
        Ok(Typed::Again)
    }

    fn deliver(&mut self, open: &OpenPrompt, answer: &str) -> Result<Typed, Failure> {
        match self.desk.answer(&open.prompt, answer)? {
            Delivery::Delivered => {}
            Delivery::TooLate => self.console.remark("someone else has already answered this prompt"),
            Delivery::Refused(why) => {
                self.console.remark(format_args!("{why}; type a different answer"));
                return Ok(Typed::Again);
            }
        }
        self.current = Some(open.prompt.episode.clone());
        Ok(Typed::Done)
    }
}

const HELP: &str = "an action, its first letters, or an arrow key: answers the prompt
say TEXT: sends the text verbatim
show: shows the turn again; rules: the rules, the legend and the format
list: shows the prompts that are waiting; skip: moves on to another episode; quit: leaves, and the evaluation keeps waiting";

/// Returns the terminal's width in columns, or `None` if the output is not a terminal or the width is
/// unknown.
fn columns() -> Option<usize> {
    #[cfg(feature = "terminal")]
    if std::io::stdout().is_terminal() {
        return ratatui::crossterm::terminal::size().ok().map(|(columns, _)| usize::from(columns));
    }
    None
}

/// Breaks lines of more than `width` characters at spaces.
fn wrapped(text: &str, width: usize) -> String {
    let broken = |line: &str| {
        // Continuation lines align with the text of a list item.
        let indent = if line.starts_with("- ") { "  " } else { "" };
        let mut lines: Vec<String> = Vec::new();
        for word in line.split(' ') {
            match lines.last_mut() {
                Some(last) if last.chars().count() + 1 + word.chars().count() <= width => {
                    last.push(' ');
                    last.push_str(word);
                }
                Some(_) => lines.push(format!("{indent}{word}")),
                None => lines.push(word.to_owned()),
            }
        }
        lines.join("\n")
    };
    text.split('\n')
        .map(|line| if line.chars().count() > width { broken(line) } else { line.to_owned() })
        .join("\n")
}

/// Returns the action that a line specifies by its full name, its first letters or an arrow key; `None` if no action
/// fits, or more than one.
fn action<'a>(line: &str, actions: &'a [String]) -> Option<&'a str> {
    let typed = match line {
        // The escape sequences of a terminal's arrow keys.
        "\u{1b}[A" | "\u{1b}OA" => "up".to_owned(),
        "\u{1b}[B" | "\u{1b}OB" => "down".to_owned(),
        "\u{1b}[C" | "\u{1b}OC" => "right".to_owned(),
        "\u{1b}[D" | "\u{1b}OD" => "left".to_owned(),
        typed => typed.to_lowercase(),
    };
    let mut found = actions.iter().filter(|action| action.starts_with(&typed));
    let exact = actions.iter().find(|action| **action == typed);
    exact.or_else(|| found.next().filter(|_| found.next().is_none())).map(String::as_str)
}

/// Returns `true` if a line is already in the format that prompts request.
fn is_formatted(line: &str) -> bool {
    line.get(..7).is_some_and(|start| start.eq_ignore_ascii_case("action:"))
}

/// Returns an action in the format that the prompt requests.
fn formatted(open: &OpenPrompt, action: &str) -> String {
    // Prompts in the reference composition number their actions.
    let number = open.prompt.messages.iter().flat_map(|message| message.text.lines()).find_map(|line| {
        let (number, name) = line.split_once(": ACTION_")?;
        (name.eq_ignore_ascii_case(action)).then_some(number)
    });
    format!("ACTION: {}", number.unwrap_or(action))
}

fn listed(desk: &Desk, view: &View) -> String {
    let ended = |(episode, result): &(String, evaluation::player::mailbox::EpisodeResult)| {
        let (score, steps) = (result.score, count(result.steps as usize, "step"));
        format!("{episode}: {}, score {score}, {steps}", words(result.outcome))
    };
    let waiting = |open: &OpenPrompt| {
        let prompt = &open.prompt;
        let problem = open.problem.as_ref().map_or(String::new(), |problem| format!("; {problem}"));
        format!("{}: step {} is waiting for {}{problem}", prompt.episode, prompt.address.step, prompt.answer)
    };
    let state = match (&view.finished, view.waiting.len(), view.is_running) {
        (Some(finished), ..) => {
            format!("the evaluation is over: {} of {} episodes won", finished.won, finished.episodes)
        }
        (None, 0, true) => "no prompt is waiting; the evaluation is running".to_owned(),
        (None, 0, false) if view.answered == 0 => {
            "no prompt is waiting, and no evaluation is running here; continue it with --resume".to_owned()
        }
        (None, 0, false) => {
            "all prompts have answers, and no evaluation is running here; --resume reads the answers"
                .to_owned()
        }
        (None, waiting, running) => {
            let prompts = if waiting == 1 { "1 prompt is waiting" } else { "prompts are waiting" };
            let number = if waiting == 1 { String::new() } else { format!("{waiting} ") };
            let idle =
                if running { "" } else { "; no evaluation is running here: --resume reads the answers" };
            format!("{number}{prompts}{idle}")
        }
    };
    let lines = view.ended.iter().map(ended).chain(view.waiting.iter().map(waiting));
    let heading = format!("mailbox of the player `{}`", desk.player());
    [heading].into_iter().chain(lines).chain([state]).join("\n")
}

/// Returns a description of an outcome.
fn words(outcome: engine::Outcome) -> &'static str {
    match outcome {
        engine::Outcome::Won => "won",
        engine::Outcome::Lost => "lost",
        engine::Outcome::Ended => "over without a winner",
        engine::Outcome::Ongoing => "not won within the step limit",
        engine::Outcome::Stopped(_) => "stopped by an error in the rules",
    }
}

fn document(desk: &Desk, view: &View) -> serde_json::Value {
    let waiting = |open: &OpenPrompt| {
        let folder = desk.episode(&open.prompt.episode);
        json!({
            "episode": open.prompt.episode,
            "step": open.prompt.address.step,
            "attempt": open.prompt.address.attempt,
            "actions": open.prompt.actions,
            "prompt": paths::in_json(&folder.join(open.prompt.address.prompt_text())),
            "answer": paths::in_json(&folder.join(&open.prompt.answer)),
            "problem": open.problem,
        })
    };
    let ended = view.ended.iter().map(|(episode, result)| json!({ "episode": episode, "result": result }));
    json!({
        "player": desk.player(),
        "running": view.is_running,
        "unread": view.answered,
        "waiting": view.waiting.iter().map(waiting).collect_vec(),
        "ended": ended.collect_vec(),
        "finished": view.finished,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lines_are_broken_at_blanks() {
        let check = |text: &str, expect: &str| assert_eq!(wrapped(text, 12), expect);
        check("short\n\nw..@..w", "short\n\nw..@..w");
        check("- You cannot enter any wall.", "- You cannot\n  enter any\n  wall.");
        check("wwwwwwwwwwwwwwww\none two three", "wwwwwwwwwwwwwwww\none two\nthree");
    }

    #[test]
    fn actions_by_their_first_letters() {
        let actions = ["nil", "use", "up", "left"].map(str::to_owned);
        let check = |line: &str, expect: Option<&str>| assert_eq!(action(line, &actions), expect, "{line}");
        check("left", Some("left"));
        check("L", Some("left"));
        check("up", Some("up"));
        check("u", None);
        check("us", Some("use"));
        check("fly", None);
        check("\u{1b}[D", Some("left"));
        check("\u{1b}OA", Some("up"));
        check("\u{1b}[C", None);
    }
}
