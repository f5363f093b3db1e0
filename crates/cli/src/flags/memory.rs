//! Memory sizes on the command line.

use std::fmt::{self, Display, Formatter};
use std::str::FromStr;

/// A number of bytes, such as `2GiB` or `1500MB`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bytes(pub(crate) usize);

/// The units, and their sizes in bytes.
const UNITS: [(&str, u64); 6] = [
    ("kib", 1 << 10),
    ("mib", 1 << 20),
    ("gib", 1 << 30),
    ("kb", 1_000),
    ("mb", 1_000_000),
    ("gb", 1_000_000_000),
];

impl FromStr for Bytes {
    type Err = String;

    fn from_str(text: &str) -> Result<Bytes, String> {
        let wrong =
            || format!("`{text}` isn't a valid memory size: use a number and a unit, such as 2GiB or 1500MB");
        let lower = text.to_ascii_lowercase();
        let (number, unit) = UNITS
            .iter()
            .find_map(|(unit, bytes)| Some((lower.strip_suffix(unit)?, *bytes)))
            .ok_or_else(wrong)?;
        let number: f64 = number.trim().parse().map_err(|_| wrong())?;
        let bytes = number * unit as f64;
        if !(bytes >= 1.0 && bytes < usize::MAX as f64) {
            return Err(wrong());
        }
        Ok(Bytes(bytes as usize))
    }
}

impl Display for Bytes {
    /// Formats the size in a form that [`from_str`](Bytes::from_str) parses. Dividing by a power of two is
    /// exact.
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let bytes = self.0 as f64;
        match self.0 {
            size if size.is_multiple_of(1_000_000) => write!(f, "{}MB", size / 1_000_000),
            size if size >= 1 << 30 => write!(f, "{}GiB", bytes / f64::from(1 << 30)),
            size if size >= 1 << 20 => write!(f, "{}MiB", bytes / f64::from(1 << 20)),
            _ => write!(f, "{}KiB", bytes / 1024.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        for (text, bytes) in
            [("2GiB", 2 << 30), ("1.5 gib", 3 << 29), ("1500MB", 1_500_000_000), ("64kib", 65_536)]
        {
            assert_eq!(text.parse(), Ok(Bytes(bytes)), "{text}");
            assert_eq!(Bytes(bytes).to_string().parse(), Ok(Bytes(bytes)), "{text}");
        }
        for text in ["", "2", "GiB", "-1GiB", "NaNMB", "infGiB", "1e300GB", "2 TiBs", "0MB"] {
            let error = text.parse::<Bytes>().unwrap_err();
            assert!(error.contains(&format!("`{text}`")), "{error}");
        }
    }
}
