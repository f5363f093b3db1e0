//! The derivation of a seed: its root seed, and the steps from the root to the seed.

use crate::seed::Seed;
use std::fmt;

/// The arguments of a call to [`Seed::child`]: the purpose and the index.
pub type SeedStep = (String, u64);

/// A seed that stores its root and the steps from the root to the seed.
///
/// `Display` writes the steps as a JSON list of pairs, as published in the witnesses of sealed releases. The
/// root is not part of that text.
///
/// ```
/// use infinite_arcade_base::{Seed, SeedPath};
///
/// let root = Seed::from_text("starter");
/// let path = SeedPath::from(root).child("level", 2).child("winnable", 0);
/// assert_eq!(path.seed(), root.child("level", 2).child("winnable", 0));
/// assert_eq!(path.to_string(), r#"[["level",2],["winnable",0]]"#);
/// assert_eq!(SeedPath::parse(root, &path.to_string())?, path);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct SeedPath {
    root: Seed,
    steps: Vec<SeedStep>,
    /// The seed at the end of the steps.
    seed: Seed,
}

impl SeedPath {
    /// Creates the path that follows `steps` from a root.
    pub fn new(root: Seed, steps: Vec<SeedStep>) -> SeedPath {
        let seed = steps.iter().fold(root, |seed, (purpose, index)| seed.child(purpose, *index));
        SeedPath { root, steps, seed }
    }

    /// Parses the steps that `Display` writes, and follows them from a root.
    ///
    /// # Errors
    /// Returns an error if the text is not a JSON list of pairs of a string and a 64-bit number.
    pub fn parse(root: Seed, text: &str) -> Result<SeedPath, serde_json::Error> {
        serde_json::from_str(text).map(|steps| SeedPath::new(root, steps))
    }

    /// Appends a step. The seed of the result is `self.seed().child(purpose, index)`.
    #[must_use]
    pub fn child(&self, purpose: &str, index: u64) -> SeedPath {
        let mut steps = Vec::with_capacity(self.steps.len() + 1);
        steps.extend_from_slice(&self.steps);
        steps.push((purpose.to_owned(), index));
        SeedPath { root: self.root, steps, seed: self.seed.child(purpose, index) }
    }

    /// Returns the seed at the end of the path.
    pub fn seed(&self) -> Seed {
        self.seed
    }

    /// Returns the seed at the start of the path.
    pub fn root(&self) -> Seed {
        self.root
    }

    /// Returns the steps from the root to the seed.
    pub fn steps(&self) -> &[SeedStep] {
        &self.steps
    }

    /// Consumes the path and returns its steps.
    pub fn into_steps(self) -> Vec<SeedStep> {
        self.steps
    }
}

/// Creates a path without steps from its root seed.
impl From<Seed> for SeedPath {
    fn from(root: Seed) -> SeedPath {
        SeedPath::new(root, Vec::new())
    }
}

impl From<&SeedPath> for SeedPath {
    fn from(path: &SeedPath) -> SeedPath {
        path.clone()
    }
}

impl fmt::Display for SeedPath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&serde_json::to_string(&self.steps).expect("strings and numbers have a JSON form"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_seed_is_that_of_the_same_children() {
        let root = Seed::from_text("paths");
        let mut path = SeedPath::from(root);
        let mut seed = root;
        assert_eq!((path.seed(), path.root(), path.steps().len()), (root, root, 0));
        for (purpose, index) in [("job", 7), ("candidate", 0), ("", u64::MAX), ("\"odd\"\n", 1)] {
            (path, seed) = (path.child(purpose, index), seed.child(purpose, index));
            assert_eq!((path.seed(), path.root()), (seed, root));
            assert_eq!(SeedPath::new(root, path.steps().to_vec()), path);
            assert_eq!(SeedPath::parse(root, &path.to_string()).expect("written by us"), path);
        }
        let elsewhere = SeedPath::new(Seed::from_text("another root"), path.steps().to_vec());
        assert_ne!(elsewhere.seed(), seed);
    }

    #[test]
    fn other_texts_are_refused() {
        let root = Seed::from_text("paths");
        for text in ["", "[[\"a\"]]", "[[\"a\",-1]]", "[[\"a\",1.5]]", "[[1,\"a\"]]", "{}", "[[\"a\",1]] x"] {
            assert!(SeedPath::parse(root, text).is_err(), "{text}");
        }
        assert_eq!(SeedPath::parse(root, " [ [\"a\", 1] ] ").expect("spaces").seed(), root.child("a", 1));
    }
}
