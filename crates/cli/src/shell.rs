//! Suggested commands in messages, ready to be pasted into a shell.

use itertools::Itertools;
use std::ffi::OsStr;

/// Returns an argument, quoted for a shell if it contains a space or any other special character. Invalid
/// Unicode is replaced with U+FFFD, and NUL is removed.
pub(crate) fn quoted(argument: impl AsRef<OsStr>) -> String {
    let text = argument.as_ref().to_string_lossy();
    shlex::try_quote(&text).map_or_else(|_| text.replace('\0', ""), |quoted| quoted.into_owned())
}

/// Returns the command line with the given arguments after `arcade`.
pub(crate) fn command<S: AsRef<OsStr>>(arguments: impl IntoIterator<Item = S>) -> String {
    let arguments = arguments.into_iter().map(quoted);
    ["arcade".to_owned()].into_iter().chain(arguments).join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_are_quoted_for_shells() {
        assert_eq!(command(["verify", "releases/tiny"]), "arcade verify releases/tiny");
        let line = command(["verify", "my games/it's $HOME"]);
        assert_eq!(shlex::split(&line).unwrap(), ["arcade", "verify", "my games/it's $HOME"]);
    }
}
