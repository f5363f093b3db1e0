//! The parser of the command line, and its error messages.

use crate::Cli;
use crate::console::{self, Console};
use crate::failure::Failure;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{Command, CommandFactory, FromArgMatches};
use std::any::TypeId;
use std::error::Error;
use std::ffi::{OsStr, OsString};
use std::fmt::Write as _;
use std::io::Write as _;
use std::num::{IntErrorKind, ParseIntError};

/// Returns the command-line parser with all subcommands and a help text that fits on one screen.
pub(crate) fn command() -> Command {
    let command = numeric_flags_take_negative_numbers(Cli::command());
    let about = command.get_about().map(ToString::to_string).unwrap_or_default();
    let verbs = verbs_in_short(&command);
    let options = "--json           Print one JSON document on standard output, and nothing else\n  -q, --quiet      \
                       Print only the shortest answer, without progress or warnings\n  --jobs <N>       \
                       Number of \
                   threads [default: all cores]\n  --memory <SIZE>  Maximum memory for all searches together, \
                   such as 4GiB\n  -h, --help       Print help, also after a command; -V, --version prints \
                   the version";
    command.help_template(format!(
        "{about}\n\n{{usage-heading}} {{usage}}\n\n{verbs}Options:\n  {options}{{after-help}}"
    ))
}

/// Returns the command-line parser with the help text of `arcade help --all`.
fn help_of_all() -> Command {
    let command = command();
    let verbs = verbs_in_full(&command);
    command.help_template(format!(
        "{{about-with-newline}}\n{{usage-heading}} {{usage}}\n{verbs}\nOptions:\n{{options}}"
    ))
}

/// The width of the help text, in columns.
const COLUMNS: usize = 100;

/// Lists, by group, the subcommands that users need first. All other subcommands are listed by name only.
fn verbs_in_short(command: &Command) -> String {
    let mut verbs = command.get_subcommands();
    let mut groups = Vec::new();
    let mut others = Vec::new();
    for (group, first, more) in crate::GROUPS {
        groups.push((group, verbs.by_ref().take(*first).collect::<Vec<_>>()));
        others.extend(verbs.by_ref().take(*more).filter(|verb| !verb.is_hide_set()).map(Command::get_name));
    }
    let width = groups.iter().flat_map(|(_, verbs)| verbs).map(|verb| verb.get_name().len()).max();
    let width = width.unwrap_or_default();
    let mut text = String::new();
    for (group, verbs) in groups {
        let _ = writeln!(text, "{group}:");
        verbs.iter().for_each(|verb| row(&mut text, verb.get_name(), width, &first_clause(verb)));
    }
    row(&mut text, "help", width, &format!("Explains a command. --all: {}", others.join(", ")));
    text
}

/// Returns all subcommands, by group.
fn verbs_in_full(command: &Command) -> String {
    let mut verbs = command.get_subcommands();
    let width = command.get_subcommands().map(|verb| verb.get_name().len()).max().unwrap_or_default();
    let mut text = String::new();
    for (group, first, more) in crate::GROUPS {
        let _ = writeln!(text, "\n{group}:");
        for verb in verbs.by_ref().take(first + more).filter(|verb| !verb.is_hide_set()) {
            row(&mut text, verb.get_name(), width, &first_clause(verb));
        }
    }
    text
}

/// Returns the first clause of a subcommand's help.
fn first_clause(verb: &Command) -> String {
    let about = verb.get_about().map(ToString::to_string).unwrap_or_default();
    let end = [". ", ": ", "; "].iter().filter_map(|end| about.find(end)).min();
    about[..end.unwrap_or(about.len())].to_owned()
}

/// Adds a subcommand and its description, wrapped within its own column.
fn row(text: &mut String, name: &str, width: usize, description: &str) {
    let mut line = format!("  {name:<width$} ");
    for word in description.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > COLUMNS {
            let _ = writeln!(text, "{line}");
            line = " ".repeat(width + 3);
        }
        let _ = write!(line, " {word}");
    }
    let _ = writeln!(text, "{line}");
}

/// The groups into which subcommands from version 0.13 have moved. Version 0.14 still accepts the old
/// spellings.
const MOVED: [(&str, &[&str]); 2] = [
    ("trust", &["keygen", "keys", "sign", "log"]),
    ("study", &["calibrate", "scale", "timeline", "contamination"]),
];

/// The subcommand from version 0.13 that has become a developer task.
const CONFORMANCE: &str = "conformance";

/// Returns the index of a moved subcommand among the arguments, and its new group; `None` if the subcommand has not
/// moved.
fn moved(arguments: &[OsString]) -> Option<(usize, &'static str)> {
    let is_verb = |argument: &OsString| argument != "help" && !argument.to_string_lossy().starts_with('-');
    let at = 1 + arguments.iter().skip(1).position(is_verb)?;
    let group = MOVED.iter().find(|(_, verbs)| verbs.iter().any(|verb| arguments[at] == *verb))?;
    Some((at, group.0))
}

/// Parses the arguments, or returns the exit status if parsing fails. A request for help is not an error.
pub(crate) fn parse(arguments: &[OsString]) -> Result<Cli, u8> {
    let mut arguments = arguments.to_vec();
    let is_quiet = arguments.iter().any(|argument| argument == "-q" || argument == "--quiet");
    if let Some((at, group)) = moved(&arguments) {
        let verb = arguments[at].to_string_lossy().into_owned();
        arguments.insert(at, group.into());
        let note = format_args!(
            "`arcade {verb}` is now `arcade {group} {verb}`; the old spelling will be removed in version 0.15"
        );
        if !is_quiet {
            console::warn(note);
        }
    }
    let arguments = arguments.as_slice();
    if arguments.iter().skip(1).eq(["help", "--all"]) {
        let console = Console::new(false, false);
        console.printed(help_of_all().print_long_help());
        return Err(console.finish(Ok(true)));
    }
    let parsed = command()
        .try_get_matches_from(arguments)
        .and_then(|mut matches| Cli::from_arg_matches_mut(&mut matches));
    parsed.map_err(|error| {
        let error = with_own_verb(without_hidden_verbs(error), arguments);
        let json = is_json_wanted(arguments);
        let console = Console::new(json, false);
        if !error.use_stderr() {
            console.printed(error.print());
            return console.finish(Ok(true));
        }
        let message =
            in_words(&error).or_else(|| other_name(&error, arguments)).or_else(|| developers_task(&error));
        // Colours are printed only on standard error. The JSON document contains the message as plain text.
        let told = message.as_ref().map_or_else(|| error.render().to_string(), Clone::clone);
        match message {
            Some(message) => drop(write!(std::io::stderr(), "{message}")),
            None => drop(error.print()),
        }
        let failure = Failure::malformed(told.trim_start_matches("error: ").trim_end());
        console.error_document(&failure);
        failure.code()
    })
}

/// Removes hidden subcommands from an error's suggestions.
fn without_hidden_verbs(mut error: clap::Error) -> clap::Error {
    let Some(ContextValue::Strings(verbs)) = error.get(ContextKind::ValidSubcommand) else { return error };
    let command = command();
    let is_shown = |verb: &&String| command.find_subcommand(verb).is_none_or(|verb| !verb.is_hide_set());
    let shown = verbs.iter().filter(is_shown).cloned().collect();
    error.insert(ContextKind::ValidSubcommand, ContextValue::Strings(shown));
    error
}

/// Words from other programs whose subcommand has a different name in arcade. Each row contains a subcommand
/// and the words for it.
const OTHER_VERBS: [(&str, &[&str]); 6] = [
    ("new", &["create", "make", "init", "init-game", "new-game", "begin", "start"]),
    ("validate", &["check", "test", "lint", "judge"]),
    ("release", &["mint", "build", "publish"]),
    ("evaluate", &["eval", "benchmark", "bench"]),
    ("studio", &["edit", "editor", "gui", "ui"]),
    ("fmt", &["format", "convert"]),
];

/// If the unknown word is a command of other programs, suggests the `arcade` subcommand that does the same.
fn with_own_verb(mut error: clap::Error, arguments: &[OsString]) -> clap::Error {
    let Some(ContextValue::String(unknown)) = error.get(ContextKind::InvalidSubcommand) else { return error };
    let Some((verb, _)) = OTHER_VERBS.iter().find(|(_, words)| words.contains(&unknown.as_str())) else {
        return error;
    };
    let mut parent = command();
    for argument in arguments.iter().skip(1).take_while(|argument| argument.as_os_str() != unknown.as_str()) {
        if let Some(inner) = parent.find_subcommand(argument) {
            parent = inner.clone();
        }
    }
    if parent.find_subcommand(verb).is_some() {
        let suggested = ContextValue::Strings(vec![(*verb).to_owned()]);
        error.insert(ContextKind::SuggestedSubcommand, suggested);
    }
    error
}

/// Returns `true` if `--json` is among the flags. If parsing fails, the raw arguments are the only source of
/// this setting.
fn is_json_wanted(arguments: &[OsString]) -> bool {
    let flags = arguments.iter().take_while(|argument| *argument != OsStr::new("--"));
    flags.into_iter().any(|argument| argument == OsStr::new("--json"))
}

/// Makes `--budget -5` an invalid number instead of an unknown flag.
fn numeric_flags_take_negative_numbers(command: Command) -> Command {
    let numbers = [
        TypeId::of::<u16>(),
        TypeId::of::<u32>(),
        TypeId::of::<u64>(),
        TypeId::of::<usize>(),
        TypeId::of::<f64>(),
    ];
    let command = command.mut_args(|argument| {
        let is_number = numbers.iter().any(|number| argument.get_value_parser().type_id() == *number);
        if is_number { argument.allow_negative_numbers(true) } else { argument }
    });
    command.mut_subcommands(numeric_flags_take_negative_numbers)
}

/// Returns a plain message for an invalid number. clap's own message would be "invalid digit found in
/// string".
fn in_words(error: &clap::Error) -> Option<String> {
    if error.kind() != ErrorKind::ValueValidation {
        return None;
    }
    let text = |kind| match error.get(kind) {
        Some(ContextValue::String(text)) => Some(text.as_str()),
        _ => None,
    };
    let (flag, value) = (text(ContextKind::InvalidArg)?, text(ContextKind::InvalidValue)?);
    let cause = error.source()?.downcast_ref::<ParseIntError>()?;
    let is_negative =
        value.strip_prefix('-').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
    let what = match cause.kind() {
        _ if is_negative => "the number must not be negative",
        IntErrorKind::PosOverflow => "the number is too large",
        IntErrorKind::Zero => "the number must be at least 1",
        _ => "expected a whole number",
    };
    Some(format!(
        "error: invalid value '{value}' for '{flag}': {what}\n\nFor more information, try '--help'.\n"
    ))
}

/// Returns the flags that mean the same as an unknown flag, rather than a flag with a similar spelling.
fn other_name(error: &clap::Error, arguments: &[OsString]) -> Option<String> {
    let is_unknown = error.kind() == ErrorKind::UnknownArgument;
    let Some(ContextValue::String(flag)) = error.get(ContextKind::InvalidArg).filter(|_| is_unknown) else {
        return None;
    };
    let known = [
        ("evaluate", "--limit", "use --levels, --games or --max-requests to limit an evaluation"),
        ("play", "--text", "use --ascii to play with plain characters"),
    ];
    let is_it = |(verb, name, _): &&(&str, &str, &str)| {
        flag == name && arguments.iter().any(|argument| argument == verb)
    };
    let (_, _, instead) = known.iter().find(is_it)?;
    Some(format!("error: unexpected argument '{flag}': {instead}\n\nFor more information, try '--help'.\n"))
}

/// Returns a message about the command that replaces the developer subcommand.
fn developers_task(error: &clap::Error) -> Option<String> {
    let verb = error.get(ContextKind::InvalidSubcommand)?;
    (verb.to_string() == CONFORMANCE).then(|| {
        "error: the comparison with the reference engine is now `cargo xtask conformance`, in a clone of the repository\n".to_owned()
    })
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::book::manual;

    /// Calls `look` with the path of every subcommand, such as `arcade recipes show`, and the subcommand
    /// itself.
    pub(crate) fn for_each_verb(look: &mut dyn FnMut(&str, &Command)) {
        fn walk(path: &str, command: &Command, look: &mut dyn FnMut(&str, &Command)) {
            look(path, command);
            let shown = |verb: &&Command| verb.get_name() != "help" && !verb.is_hide_set();
            for verb in command.get_subcommands().filter(shown) {
                walk(&format!("{path} {}", verb.get_name()), verb, look);
            }
        }
        let mut command = command();
        command.build();
        walk("arcade", &command, look);
    }

    #[test]
    fn hidden_verbs_are_not_proposed() {
        let error = command().try_get_matches_from(["arcade", "--json"]).expect_err("no verb");
        assert!(error.render().to_string().contains("player-guard"), "{error}");
        let error = without_hidden_verbs(error).render().to_string();
        assert!(error.contains("release") && !error.contains("player-guard"), "{error}");
    }

    #[test]
    fn words_of_other_programs_lead_to_our_verbs() {
        let told = |line: &str| {
            let arguments: Vec<OsString> = line.split(' ').map(OsString::from).collect();
            let error = command().try_get_matches_from(&arguments).expect_err("no such verb");
            with_own_verb(error, &arguments).render().to_string()
        };
        for (line, verb) in [
            ("arcade create river", "new"),
            ("arcade -q init-game", "new"),
            ("arcade recipes create x", "new"),
            ("arcade mint starter", "release"),
        ] {
            assert!(told(line).contains(&format!("exists: '{verb}'")), "{}", told(line));
        }
        // `arcade trust log` has no `new`.
        assert!(!told("arcade trust log create").contains("'new'"), "{}", told("arcade trust log create"));
        for (verb, words) in OTHER_VERBS {
            assert!(command().find_subcommand(verb).is_some(), "{verb}");
            assert!(words.iter().all(|word| command().find_subcommand(word).is_none()), "{words:?}");
        }
    }

    #[test]
    fn the_full_help_lists_every_verb_in_its_group() {
        let help = help_of_all().render_long_help().to_string();
        let shown = help.lines().filter(|line| line.starts_with("  ") && !line.starts_with("   "));
        let shown: Vec<&str> = shown.filter_map(|line| line.split_whitespace().next()).collect();
        for_each_verb(&mut |path, _| {
            let words: Vec<&str> = path.split(' ').collect();
            assert!(words.len() != 2 || shown.contains(&words[1]), "{path}\n{help}");
        });
        assert!(!help.contains("player-guard"), "{help}");
        let of = |word: &str| help.lines().position(|line| line.trim_start().starts_with(word));
        assert!(of("Make games:") < of("new ") && of("new ") < of("Publish benchmarks:"), "{help}");
        assert!(help.lines().all(|line| line.chars().count() <= COLUMNS), "{help}");
    }

    #[test]
    fn the_help_fits_on_a_screen_and_names_every_verb_and_option() {
        let help = command().render_long_help().to_string();
        assert_eq!(help, command().render_help().to_string());
        assert!(help.lines().count() <= 30, "{}\n{help}", help.lines().count());
        assert!(help.lines().all(|line| line.chars().count() <= COLUMNS), "{help}");
        let words: Vec<&str> = help.split([' ', ',', ';', '\n']).collect();
        for_each_verb(&mut |path, verb| {
            if path.split(' ').count() == 2 {
                assert!(words.contains(&verb.get_name()), "{path}\n{help}");
            }
        });
        let mut command = command();
        command.build();
        for option in command.get_arguments().filter_map(clap::Arg::get_long) {
            assert!(words.contains(&format!("--{option}").as_str()), "--{option}\n{help}");
        }
        assert!(!help.contains("player-guard"), "{help}");
    }

    #[test]
    fn verbs_that_moved_are_where_the_notes_say() {
        let place = |line: &str| moved(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        assert_eq!(place("arcade --json log check x"), Some((2, "trust")));
        assert_eq!(place("arcade help scale"), Some((2, "study")));
        assert_eq!(place("arcade trust log"), None);
        assert_eq!(place("arcade docs scale"), None);
        assert_eq!(place("arcade -q"), None);
        for (group, verbs) in MOVED {
            for verb in verbs {
                assert!(command().find_subcommand(verb).is_none(), "{verb}");
                let group = command().find_subcommand(group).cloned().expect("the group");
                assert!(group.find_subcommand(verb).is_some(), "{verb}");
            }
        }
    }

    #[test]
    fn the_command_line_is_sound() {
        command().debug_assert();
    }

    #[test]
    fn the_help_of_every_verb_has_an_example() {
        for_each_verb(&mut |path, verb| {
            let help = verb.clone().render_long_help().to_string();
            assert!(path == "arcade" || help.contains("Example"), "{path}\n{help}");
            assert!(path == "arcade" || help.contains(path), "{path}\n{help}");
        });
    }

    #[test]
    fn help_names_pages_that_the_binary_has() {
        let mut named = 0;
        for_each_verb(&mut |path, verb| {
            let help = verb.clone().render_long_help().to_string();
            assert!(!help.contains("docs/"), "{path}\n{help}");
            // Help text may be wrapped after any word.
            let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
            for rest in help.split("`arcade docs ").skip(1) {
                let name = rest.split('`').next().unwrap_or_default();
                assert!(manual::page(name).is_ok(), "{path}: {name}");
                named += 1;
            }
        });
        assert!(named > 6, "{named}");
    }

    #[test]
    fn numbers_with_a_fraction_are_finite() {
        let mut flags = Vec::new();
        for_each_verb(&mut |path, verb| {
            let numbers =
                verb.get_arguments().filter(|one| one.get_value_parser().type_id() == TypeId::of::<f64>());
            flags.extend(numbers.filter_map(|one| Some((path.to_owned(), one.get_long()?.to_owned()))));
        });
        assert!(flags.len() > 5, "{flags:?}");
        for (path, flag) in flags {
            for value in ["nan", "inf", "-inf", "1e999", "x"] {
                let flag = format!("--{flag}={value}");
                let error = command().try_get_matches_from(path.split(' ').chain([&*flag])).expect_err(&flag);
                assert_eq!(error.kind(), ErrorKind::ValueValidation, "{path} {flag}");
                assert!(error.to_string().contains("expected a number from"), "{error}");
            }
        }
    }

    #[test]
    fn numbers_that_cannot_be_read_are_refused_in_plain_words() {
        let refused = |verb: &str, flag: &str, value: &str| {
            let words = verb.split(' ').chain([flag, value]);
            let error = command().try_get_matches_from(words).expect_err("refused");
            in_words(&error).unwrap_or_else(|| error.render().to_string())
        };
        let mut flags = 0;
        for_each_verb(&mut |path, verb| {
            let unsigned =
                [TypeId::of::<u16>(), TypeId::of::<u32>(), TypeId::of::<u64>(), TypeId::of::<usize>()];
            for argument in verb
                .get_arguments()
                .filter(|argument| unsigned.iter().any(|kind| argument.get_value_parser().type_id() == *kind))
            {
                let Some(flag) = argument.get_long() else { continue };
                let message = refused(path, &format!("--{flag}"), "-5");
                assert!(
                    message.contains("not be negative") || message.contains("-5 is not in"),
                    "{path} --{flag}: {message}"
                );
                assert!(!message.contains("-- -5"), "{path} --{flag}: {message}");
                flags += 1;
            }
        });
        assert!(flags > 20, "{flags}");
        assert!(refused("arcade evaluate", "--tries", "0").contains("must be at least 1"));
        assert!(refused("arcade evaluate", "--timeout", "0").contains("0 is not in 1.."));
        assert!(refused("arcade run", "--budget", "many").contains("expected a whole number"));
        assert!(refused("arcade run", "--budget", "99999999999999999999").contains("too large"));
    }

    #[test]
    fn json_flag_is_found_before_names() {
        let wanted = |line: &str| is_json_wanted(&line.split(' ').map(OsString::from).collect::<Vec<_>>());
        assert!(wanted("arcade --json run"));
        assert!(wanted("arcade run --planer x --json"));
        assert!(!wanted("arcade run -- --json"));
        assert!(!wanted("arcade run json"));
    }
}
