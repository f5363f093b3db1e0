//! Standard output, standard error and progress bars.

use crate::failure::{Answer, ENVIRONMENT, Failure, NO};
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use report::{is_invisible, visible_lines};
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::{self, Display};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A subcommand's output streams.
pub(crate) struct Console {
    json: bool,
    quiet: bool,
    output: Mutex<Output>,
}

#[derive(Default)]
struct Output {
    /// `true` once the reader has disconnected (`arcade … | head`) or a write has failed. Nothing more is
    /// written afterwards.
    is_closed: bool,
    failure: Option<io::Error>,
    /// `true` once a document has been written. A run writes at most one document.
    is_documented: bool,
}

impl Output {
    fn write(&mut self, target: &mut impl Write, text: fmt::Arguments<'_>) {
        if self.is_closed {
            return;
        }
        self.note(target.write_fmt(text).and_then(|()| target.flush()));
    }

    fn note(&mut self, result: io::Result<()>) {
        if let Err(error) = result {
            self.is_closed = true;
            self.failure = Some(error).filter(|error| error.kind() != ErrorKind::BrokenPipe);
        }
    }
}

impl Console {
    pub(crate) fn new(json: bool, quiet: bool) -> Console {
        Console { json, quiet, output: Mutex::default() }
    }

    /// Writes to standard output. If the reader disconnects early, the subcommand still runs to completion
    /// and keeps its exit status. [`finish`](Console::finish) reports a full device, after the subcommand has
    /// written its files.
    fn out(&self, text: fmt::Arguments<'_>, is_document: bool) {
        let mut output = self.output.lock().unwrap_or_else(PoisonError::into_inner);
        output.is_documented |= is_document;
        output.write(&mut io::stdout().lock(), text);
    }

    /// Returns `true` if nothing more can be printed, such as after `arcade … | head`.
    pub(crate) fn is_closed(&self) -> bool {
        self.output.lock().unwrap_or_else(PoisonError::into_inner).is_closed
    }

    /// Records the result of a write to standard output by a library.
    pub(crate) fn printed(&self, result: io::Result<()>) {
        let result = result.and_then(|()| io::stdout().flush());
        self.output.lock().unwrap_or_else(PoisonError::into_inner).note(result);
    }

    /// Reports the failure, if any, and returns the exit status for the subcommand's answer.
    pub(crate) fn finish(&self, answer: Answer) -> u8 {
        let status = match answer {
            Ok(true) => 0,
            Ok(false) => NO,
            Err(failure) => {
                self.error(&failure);
                failure.code()
            }
        };
        let broken = self.output.lock().unwrap_or_else(PoisonError::into_inner).failure.take();
        match broken {
            Some(error) => {
                self.report(&Failure::environment(error, "cannot write to standard output"));
                ENVIRONMENT
            }
            None => status,
        }
    }

    /// Returns `true` if the user requested JSON.
    pub(crate) fn is_json(&self) -> bool {
        self.json
    }

    /// Returns `true` if the user requested as little output as possible.
    pub(crate) fn is_quiet(&self) -> bool {
        self.quiet
    }

    /// Prints the human-readable answer, unless the user requested JSON.
    pub(crate) fn say(&self, text: impl Display) {
        if !self.json {
            self.out(format_args!("{}\n", shown(&text.to_string())), false);
        }
    }

    /// Prints a file's content for people, unchanged except for characters that are unsafe on a terminal.
    /// Prints nothing if the user requested JSON.
    pub(crate) fn file(&self, content: &str) {
        if !self.json {
            match io::stdout().is_terminal() {
                true => self.out(format_args!("{}", visible_lines(content)), false),
                false => self.out(format_args!("{content}"), false),
            }
        }
    }

    /// Prints the machine-readable answer if the user requested JSON.
    pub(crate) fn document(&self, value: &impl Serialize) -> Result<(), Failure> {
        if self.json {
            let text = serde_json::to_string_pretty(value)
                .map_err(|error| Failure::environment(error, "the answer cannot be written as JSON"))?;
            self.json(&text);
        }
        Ok(())
    }

    /// Prints a line of JSON, even if the user did not request JSON. Used by subcommands that keep running
    /// after their answer.
    pub(crate) fn line(&self, value: &serde_json::Value) {
        self.json(&value.to_string());
    }

    fn json(&self, text: &str) {
        self.out(format_args!("{}\n", in_ascii_escapes(text)), true);
    }

    /// Prints a note to standard error, unless the user requested quiet output.
    pub(crate) fn remark(&self, text: impl Display) {
        if !self.quiet {
            let _ = writeln!(io::stderr(), "{}", shown(&text.to_string()));
        }
    }

    /// Returns a function that prints notes, for players that run in other threads.
    pub(crate) fn remarks(&self) -> Arc<dyn Fn(&str) + Send + Sync> {
        let remarks = Console::new(self.json, self.quiet);
        Arc::new(move |text| remarks.remark(text))
    }

    /// Prints the failure, even if the user requested quiet output. If the user requested JSON and no
    /// document has been written yet, also prints the failure as a document.
    pub(crate) fn error(&self, failure: &Failure) {
        self.report(failure);
        self.error_document(failure);
    }

    /// Prints the failure as a document if the user requested JSON and no document has been written yet.
    pub(crate) fn error_document(&self, failure: &Failure) {
        let is_documented = self.output.lock().unwrap_or_else(PoisonError::into_inner).is_documented;
        if self.json && !is_documented {
            self.json(&format!("{:#}", failure.document()));
        }
    }

    fn report(&self, failure: &Failure) {
        let _ = writeln!(io::stderr(), "error: {}", shown(&failure.to_string()));
    }

    /// Returns a progress bar on standard error. The bar is hidden unless standard error is a terminal.
    pub(crate) fn progress(&self, length: u64, what: &'static str) -> ProgressBar {
        let bar = ProgressBar::with_draw_target(
            Some(length),
            if self.quiet || !io::stderr().is_terminal() {
                ProgressDrawTarget::hidden()
            } else {
                ProgressDrawTarget::stderr()
            },
        );
        let style = ProgressStyle::with_template(
            "{prefix:>12} [{wide_bar:.cyan}] {pos}/{len} {elapsed_precise}{left} {msg}",
        );
        let left = |state: &ProgressState, text: &mut dyn fmt::Write| {
            let _ = text.write_str(&time_left(state.pos(), state.eta()));
        };
        let style = style.expect("the template is well-formed").with_key("left", left);
        bar.set_style(style.progress_chars("=> "));
        bar.set_prefix(what);
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}

/// Returns the remaining time in a progress bar. It is unknown until the first item is done.
fn time_left(done: u64, left: Duration) -> String {
    match done {
        0 => String::new(),
        _ => format!(", {:#} left", HumanDuration(left)),
    }
}

/// The elapsed time, for notes. No recorded output depends on the elapsed time.
/// `tests/tests/it/tidy/clocks.rs` lists all code that reads clocks.
pub(crate) struct Stopwatch(Instant);

impl Stopwatch {
    #[expect(clippy::disallowed_methods, reason = "only messages for people show the elapsed time")]
    pub(crate) fn start() -> Stopwatch {
        Stopwatch(Instant::now())
    }

    /// Returns the seconds since the start.
    pub(crate) fn seconds(&self) -> f64 {
        self.0.elapsed().as_secs_f64()
    }
}

/// Prints a note, even in quiet mode, that the program is doing something other than requested.
pub(crate) fn warn(text: impl Display) {
    let _ = writeln!(io::stderr(), "note: {}", shown(&text.to_string()));
}

/// Escapes, in JSON notation, the characters that [`visible_lines`] escapes. In a JSON document, such
/// characters occur only in strings.
fn in_ascii_escapes(text: &str) -> Cow<'_, str> {
    if *visible_lines(text) == *text {
        return Cow::Borrowed(text);
    }
    let spelt = |character: char| match is_invisible(character) && character != '\n' {
        true => format!("\\u{:04x}", character as u32),
        false => character.to_string(),
    };
    Cow::Owned(text.chars().map(spelt).collect())
}

/// Makes text safe to print on a terminal. The text may quote untrusted input, so control characters are
/// escaped, except for the colours of our own diagnostics.
fn shown(text: &str) -> Cow<'_, str> {
    let is_terminal = io::stderr().is_terminal();
    escaped(text, &if is_terminal { editor::colours() } else { Vec::new() })
}

/// Escapes a text's invisible characters like [`visible_lines`], but leaves the sequences in `kept`
/// unchanged.
fn escaped<'a>(text: &'a str, kept: &[String]) -> Cow<'a, str> {
    let is_escaped = |character: char| is_invisible(character) && !matches!(character, '\n' | '\t');
    if !text.contains(is_escaped) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let sequence = kept.iter().find(|sequence| rest.starts_with(sequence.as_str()));
        let length = sequence.map_or(first.len_utf8(), String::len);
        match sequence.is_none() && is_escaped(first) {
            true => escaped.extend(first.escape_unicode()),
            false => escaped.push_str(&rest[..length]),
        }
        rest = &rest[length..];
    }
    Cow::Owned(escaped)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A writer that always fails.
    struct Broken(ErrorKind);

    impl Write for Broken {
        fn write(&mut self, _bytes: &[u8]) -> io::Result<usize> {
            Err(self.0.into())
        }

        fn flush(&mut self) -> io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn closed_pipes_are_ignored_and_full_devices_reported() {
        for (kind, expect) in
            [(ErrorKind::BrokenPipe, None), (ErrorKind::StorageFull, Some(ErrorKind::StorageFull))]
        {
            let mut output = Output::default();
            output.write(&mut Broken(kind), format_args!("text"));
            assert!(output.is_closed);
            assert_eq!(output.failure.as_ref().map(io::Error::kind), expect);
            let mut later = Vec::new();
            output.write(&mut later, format_args!("more"));
            assert!(later.is_empty());
        }
    }

    #[test]
    fn the_remaining_time_is_unknown_at_first() {
        assert_eq!(time_left(0, Duration::ZERO), "");
        assert_eq!(time_left(2, Duration::from_secs(10)), ", 10s left");
    }

    #[track_caller]
    fn check(text: &str, expect: &str) {
        assert_eq!(escaped(text, &[]), expect);
    }

    #[test]
    fn control_characters_are_spelt_out() {
        check("tiny: verified\n\troot é ─ 🎮", "tiny: verified\n\troot é ─ 🎮");
        check("a\u{1b}[2Jb", "a\\u{1b}[2Jb");
        check("\0\u{7}\r\u{7f}\u{9b}2J", "\\u{0}\\u{7}\\u{d}\\u{7f}\\u{9b}2J");
    }

    #[test]
    fn documents_are_safe_and_mean_the_same() {
        let value = serde_json::json!({ "name": "a\u{9b}2J\u{202e}b\n\u{1b}\t é" });
        let text = format!("{value:#}");
        let safe = in_ascii_escapes(&text);
        assert!(!safe.chars().any(|c| is_invisible(c) && c != '\n'), "{safe}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&safe).unwrap(), value);
    }

    #[test]
    fn the_colours_of_diagnostics_are_kept() {
        let problem =
            engine::Diagnostic::error("bad", engine::Span::new(0, 3), "no such thing").help("try another");
        let source = editor::Source { name: "game.vgdl", text: "hen", is_coloured: true };
        let painted = editor::one_in_words(source, &problem);
        assert!(painted.contains('\u{1b}'));
        assert_eq!(escaped(&painted, &editor::colours()), painted);
        // The sequence for hidden text is not one of our colours.
        assert_eq!(escaped("\u{1b}[8mx", &editor::colours()), "\\u{1b}[8mx");
    }
}
