//! The relative paths that a release may contain. Each of them denotes the same file on every system, and none leads
//! outside the release folder.

/// The maximum length of a path, in bytes.
pub const MAX_PATH: usize = 255;
/// The maximum number of components in a path, counting its folders and its file. Releases use at most four
/// components.
pub const MAX_COMPONENTS: usize = 16;

/// A reason why a path is not allowed in a release.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, thiserror::Error)]
#[non_exhaustive]
pub enum PathProblem {
    /// The path is empty.
    #[error("the path is empty")]
    Empty,
    /// The path has more than [`MAX_PATH`] bytes.
    #[error("the path is longer than {MAX_PATH} bytes")]
    TooLong,
    /// The path has more than [`MAX_COMPONENTS`] components.
    #[error("the path has more than {MAX_COMPONENTS} components")]
    TooDeep,
    /// The path starts with `/`.
    #[error("the path is absolute")]
    Absolute,
    /// The path contains two consecutive `/`, or ends with one.
    #[error("the path has an empty component")]
    EmptyComponent,
    /// A component is `.` or `..`.
    #[error("the path has a `.` or `..` component")]
    DotComponent,
    /// A component ends with a dot, which Windows removes.
    #[error("a component ends with a dot")]
    TrailingDot,
    /// The path contains a character outside `A-Z a-z 0-9 . _ - /`, such as `\`, `:`, a control character or any
    /// non-ASCII character.
    #[error("the path has the character {0:?}: only A-Z, a-z, 0-9, `.`, `_`, `-` and `/` may be used")]
    Character(char),
    /// The name is not Unicode.
    #[error("the path is not valid Unicode")]
    NotUnicode,
}

/// Checks that `path` is allowed in a release. The path must be relative and `/`-separated, with at most [`MAX_PATH`]
/// bytes and [`MAX_COMPONENTS`] components, and consist of the characters `A-Z a-z 0-9 . _ -`. No component may be
/// empty, be `.` or `..`, or end with a dot.
///
/// # Errors
/// Returns the first rule that the path violates.
pub fn check_path(path: &str) -> Result<(), PathProblem> {
    if path.is_empty() {
        return Err(PathProblem::Empty);
    }
    if path.len() > MAX_PATH {
        return Err(PathProblem::TooLong);
    }
    if path.starts_with('/') {
        return Err(PathProblem::Absolute);
    }
    let safe = |c: &char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-' | '/');
    if let Some(character) = path.chars().find(|c| !safe(c)) {
        return Err(PathProblem::Character(character));
    }
    path.split('/').try_for_each(|component| match component {
        "" => Err(PathProblem::EmptyComponent),
        "." | ".." => Err(PathProblem::DotComponent),
        _ if component.ends_with('.') => Err(PathProblem::TrailingDot),
        _ => Ok(()),
    })?;
    if path.split('/').count() > MAX_COMPONENTS { Err(PathProblem::TooDeep) } else { Ok(()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn safe_paths() {
        let longest = "a".repeat(MAX_PATH);
        let deepest = ["a"; MAX_COMPONENTS].join("/");
        for path in [
            "a",
            "README.md",
            "games/maze-0a1b2c3d/lvl0.txt",
            ".gitattributes",
            "a/..b/c",
            &longest,
            &deepest,
        ] {
            assert_eq!(check_path(path), Ok(()), "{path}");
        }
    }

    #[test]
    fn unsafe_paths() {
        let too_long = "a".repeat(MAX_PATH + 1);
        let too_deep = ["a"; MAX_COMPONENTS + 1].join("/");
        for (path, problem) in [
            ("", PathProblem::Empty),
            (too_long.as_str(), PathProblem::TooLong),
            (too_deep.as_str(), PathProblem::TooDeep),
            ("/etc/passwd", PathProblem::Absolute),
            ("/", PathProblem::Absolute),
            ("a//b", PathProblem::EmptyComponent),
            ("a/", PathProblem::EmptyComponent),
            (".", PathProblem::DotComponent),
            ("..", PathProblem::DotComponent),
            ("a/../b", PathProblem::DotComponent),
            ("a/./b", PathProblem::DotComponent),
            ("a/..", PathProblem::DotComponent),
            ("...", PathProblem::TrailingDot),
            ("a./b", PathProblem::TrailingDot),
            ("a\\b", PathProblem::Character('\\')),
            ("C:/a", PathProblem::Character(':')),
            ("a\0b", PathProblem::Character('\0')),
            ("a\nb", PathProblem::Character('\n')),
            ("a b", PathProblem::Character(' ')),
            ("~/a", PathProblem::Character('~')),
            ("a\u{7f}", PathProblem::Character('\u{7f}')),
            ("caf\u{e9}", PathProblem::Character('\u{e9}')),
            ("a\u{2215}b", PathProblem::Character('\u{2215}')),
        ] {
            assert_eq!(check_path(path), Err(problem), "{path:?}");
        }
    }

    /// Every byte outside the allowed set is rejected at any position.
    #[test]
    fn the_alphabet_is_closed() {
        for byte in 0..128_u8 {
            let c = char::from(byte);
            let allowed = c.is_ascii_alphanumeric() || ".-_".contains(c) || c == '/';
            assert_eq!(check_path(&format!("a{c}b")).is_ok(), allowed, "{c:?}");
        }
    }
}
