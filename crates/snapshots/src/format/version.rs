//! The versions of the suite, and the generation that each of them mints.
//!
//! Version `0.G.p` mints `GENERATION` G. Raising `GENERATION` or `SEMANTICS` requires a new row in
//! [`VERSIONS`], a new workspace version and a new changelog section. Tests check that all three agree. A fix
//! that changes no minted byte raises the workspace's `p` without adding a row.

use std::fmt;

/// A version of the suite, with the generation that it mints and the semantics under which it replays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Version {
    /// The first version that mints these bytes, such as `0.11.0`. Its tag is `v0.11.0`.
    pub number: &'static str,
    /// The version's `GENERATION`, which determines the bytes that a recipe produces.
    pub generation: u32,
    /// The version's `SEMANTICS`, which determines the hashes that witnesses record.
    pub semantics: u32,
    /// The last commit that mints these bytes; `None` for the current version.
    pub commit: Option<&'static str>,
}

/// Every version that mints different bytes from its predecessor, from oldest to newest. The last entry is
/// the current version.
pub const VERSIONS: &[Version] = &[
    superseded("0.1.0", 1, 1, "73214b9b5e56768a2dc20881f6d9dab5ceeba5fe"),
    superseded("0.2.0", 2, 2, "2bd65cebcea99b65f4bc1dea74290f2a24b95701"),
    superseded("0.3.0", 3, 2, "50d854e56ffda7e20dfd4a4130c40a28fd086617"),
    superseded("0.4.0", 4, 2, "2b3979962d041650425cf75d8ae8afb085888e88"),
    superseded("0.5.0", 5, 2, "b1cec7245f11669477c6bd64fb359a2958b43089"),
    superseded("0.6.0", 6, 2, "ea25e6ab8ad79552a779a1d59d2b308641539665"),
    superseded("0.7.0", 7, 2, "92628817746229fbf28d01926b1a1b5b81a28185"),
    superseded("0.8.0", 8, 2, "2ae8058ac6d6d75716d382e1f761fd4e222fc6e3"),
    superseded("0.9.0", 9, 2, "3f01cd480cfdeefbf0174fd9c8a8b3ebd9a683a9"),
    superseded("0.9.1", 9, 3, "afac3a3126ff6a9c3a62e93f9b1be71c1c93a81f"),
    superseded("0.10.0", 10, 3, "5182d4800aab8e21f4e6e70917feca3a2a298163"),
    superseded("0.11.0", 11, 3, "2794ad50f9d1f87fa618097a77bb9d6b81cbfe08"),
    superseded("0.12.0", 12, 3, "9f86038f584b06eb2adce814913672ab049928c5"),
    superseded("0.13.0", 13, 3, "eb6380330268e994b1fdfb26e2f4c5f76c16dc27"),
    superseded("0.14.0", 14, 3, "3d33844090f34abc1df37461ae2226a4ed14e99a"),
    superseded("0.15.0", 15, 3, "a7ccd546bdd5e807b4c9c252324dab106f5896fb"),
    superseded("0.16.0", 16, 3, "79f11a8c4dcda95feb068efa3fefb2c54fe6e486"),
    superseded("0.17.0", 17, 3, "ba6f2644c1a02ac2f3eed5dba620418608133905"),
    CURRENT,
];

/// The suite's current version.
pub const CURRENT: Version = Version {
    number: "0.18.0",
    generation: generators::GENERATION,
    semantics: engine::SEMANTICS,
    commit: None,
};

const fn superseded(number: &'static str, generation: u32, semantics: u32, commit: &'static str) -> Version {
    Version { number, generation, semantics, commit: Some(commit) }
}

impl Version {
    /// Returns the known version, if any, that mints the given generation under the given semantics.
    pub fn that_mints(generation: u32, semantics: u32) -> Option<&'static Version> {
        VERSIONS.iter().find(|version| (version.generation, version.semantics) == (generation, semantics))
    }

    /// Returns the commands that install the version, to be run in a clone of the repository.
    pub fn install_command(&self) -> String {
        let revision = match self.commit {
            Some(commit) => commit[..12].to_owned(),
            None => format!("v{}", self.number),
        };
        install_command(&revision, if self.generation < IN_CRATES { "cli" } else { "crates/cli" })
    }
}

/// Writes the number, the generation and the semantics: `0.11.0 (GENERATION 11, SEMANTICS 3)`.
impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (GENERATION {}, SEMANTICS {})", self.number, self.generation, self.semantics)
    }
}

/// The first generation whose binary is in `crates/cli`. Earlier generations have it in `cli`.
const IN_CRATES: u32 = 14;

/// Returns the commands that install `revision`, to be run in a clone of the repository.
fn install_command(revision: &str, folder: &str) -> String {
    format!("git fetch --tags && git checkout {revision} && cargo install --locked --path {folder}")
}

/// The version that minted a release, for use in messages. The version number comes from the table of known versions
/// if possible, and otherwise from the manifest.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MintedBy {
    /// The manifest's `version`, if its format has one.
    pub version: Option<String>,
    /// The manifest's `generation`.
    pub generation: u32,
    /// The manifest's `semantics`.
    pub semantics: u32,
}

impl MintedBy {
    /// Returns the commands that install the version; `None` if neither the table of known versions nor the manifest
    /// contains its number.
    pub fn install_command(&self) -> Option<String> {
        match (Version::that_mints(self.generation, self.semantics), &self.version) {
            (Some(known), _) => Some(known.install_command()),
            (None, Some(number)) => Some(install_command(&format!("v{number}"), "crates/cli")),
            (None, None) => None,
        }
    }
}

impl fmt::Display for MintedBy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = Version::that_mints(self.generation, self.semantics).map(|version| version.number);
        match known.or(self.version.as_deref()) {
            Some(number) => write!(f, "arcade {number}")?,
            None => write!(f, "an unknown version of arcade")?,
        }
        write!(f, " (GENERATION {}, SEMANTICS {})", self.generation, self.semantics)
    }
}

/// Returns `true` if a text is a version number (`MAJOR.MINOR.PATCH` in decimal digits) and therefore safe to insert
/// into a suggested command.
pub(crate) fn is_version_number(text: &str) -> bool {
    let is_number = |part: &str| {
        (1..=9).contains(&part.len())
            && part.bytes().all(|byte| byte.is_ascii_digit())
            && (part == "0" || !part.starts_with('0'))
    };
    text.split('.').count() == 3 && text.split('.').all(is_number)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Raising GENERATION or SEMANTICS requires a row, a workspace version and a changelog section.
    #[test]
    fn each_bump_has_a_version_and_a_section_of_the_changelog() {
        let changelog = include_str!("../../../../CHANGELOG.md");
        let sections: Vec<&str> =
            changelog.lines().filter(|line| line.starts_with("## ") && line.contains("GENERATION")).collect();
        let expect: Vec<String> = VERSIONS
            .iter()
            .rev()
            .map(|version| {
                let commit =
                    version.commit.map_or(String::new(), |commit| format!(", commit `{}`", &commit[..12]));
                let Version { number, generation, semantics, .. } = version;
                format!(
                    "## {number}: GENERATION {generation}, SEMANTICS {semantics} (tag `v{number}`{commit})"
                )
            })
            .collect();
        assert_eq!(sections, expect, "the sections of CHANGELOG.md are not the rows of VERSIONS");
        let (crate_version, minor) = (env!("CARGO_PKG_VERSION"), format!("0.{}.", generators::GENERATION));
        assert!(
            crate_version.starts_with(&minor),
            "version {crate_version} of the workspace is not {minor}x"
        );
    }

    #[test]
    fn rows_ascend_and_only_the_last_is_current() {
        let key = |version: &Version| (version.generation, version.semantics);
        assert!(VERSIONS.windows(2).all(|pair| key(&pair[0]) < key(&pair[1])));
        let (last, others) = VERSIONS.split_last().expect("there are versions");
        assert_eq!(*last, CURRENT);
        for version in others {
            let commit = version.commit.expect("superseded");
            assert!(commit.len() == 40 && commit.bytes().all(|byte| byte.is_ascii_hexdigit()), "{version}");
        }
        for version in VERSIONS {
            assert!(is_version_number(version.number), "{version}");
            assert!(version.number.starts_with(&format!("0.{}.", version.generation)), "{version}");
        }
    }

    #[test]
    fn the_version_to_install_is_named() {
        let command = |version: Option<&str>, generation, semantics| {
            MintedBy { version: version.map(str::to_owned), generation, semantics }.install_command()
        };
        let install = "&& cargo install --locked --path cli";
        let later = "&& cargo install --locked --path crates/cli";
        assert_eq!(
            command(None, 10, 3),
            Some(format!("git fetch --tags && git checkout 5182d4800aab {install}"))
        );
        // A version newer than this binary is known only from the manifest.
        assert_eq!(
            command(Some("0.99.0"), 99, 7),
            Some(format!("git fetch --tags && git checkout v0.99.0 {later}"))
        );
        assert_eq!(command(None, 99, 7), None);
    }

    #[test]
    fn a_version_number_is_three_numbers() {
        for sound in ["0.12.0", "1.0.10"] {
            assert!(is_version_number(sound), "{sound}");
        }
        for unsound in
            ["", "0.12", "0.12.0.1", "0.12.x", "0.012.0", "0.12.0; rm -rf ~", "0..1", "1.0.1234567890"]
        {
            assert!(!is_version_number(unsound), "{unsound}");
        }
    }
}
