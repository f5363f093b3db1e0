//! A human player, who reads the same prompts as a language model and types actions.

use evaluation::prompt::{Past, Prompter};
use evaluation::{Agent, Choice, Halt, Journal, Turn};
use std::io::{BufRead, Write};
use std::sync::Arc;

/// A player that reads actions from standard input, one per line. Prompts are written to standard error, so
/// that the subcommand's answers can be piped.
pub(crate) struct Human {
    prompter: Arc<Prompter>,
    past: Vec<Past>,
}

impl Human {
    pub(crate) fn new(prompter: Arc<Prompter>) -> Human {
        Human { prompter, past: Vec::new() }
    }

    /// Returns the prompt for a turn. The first prompt starts with the rules.
    fn shown(&self, turn: &Turn<'_>) -> String {
        if turn.number == 0 {
            show(self.prompter.static_part());
        }
        self.prompter.prompt(turn, &self.past, &[]).shown
    }
}

impl Agent for Human {
    fn act(&mut self, turn: &Turn<'_>, _: &mut Journal) -> Result<Choice, Halt> {
        let shown = self.shown(turn);
        show(&format!("\n{shown}"));
        let mut line = String::new();
        loop {
            line.clear();
            let read = std::io::stdin().lock().read_line(&mut line);
            if !read.is_ok_and(|bytes| bytes > 0) {
                return Err(Halt::Interrupted);
            }
            let typed = line.trim().to_lowercase();
            let actions = match turn.commit.is_one() {
                true => {
                    turn.actions.iter().find(|action| action.to_string() == typed).map(|&action| vec![action])
                }
                false => self.prompter.read(&format!("PLAN: {typed}"), turn).choice(),
            };
            let Some(actions) = actions else {
                let words: Vec<String> = turn.actions.iter().map(ToString::to_string).collect();
                let (is, words) =
                    (if turn.commit.is_one() { "isn't one of" } else { "isn't a list of" }, words.join(", "));
                show(&format!("`{typed}` {is} {words}"));
                continue;
            };
            let choice = Choice::plan(actions);
            self.past.push(Past::new(shown, &[], choice.action(0)));
            return Ok(choice);
        }
    }

    fn recall(&mut self, turn: &Turn<'_>, _: &Journal, choice: &Choice) -> Result<(), Halt> {
        let shown = self.shown(turn);
        self.past.push(Past::new(shown, &[], choice.action(0)));
        Ok(())
    }

    fn end(&mut self, last: &Turn<'_>) {
        show(&format!("\n{}", self.prompter.ending(last)));
    }
}

fn show(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
