//! Token prices. If a model's price is unknown, its cost is unknown too, rather than zero.

use crate::client::chat::Usage;
use crate::client::provider::Provider;
use crate::error::EvaluationError;
use crate::run::text::read_text;
use serde::{Deserialize, Serialize};
use std::fmt;
use std::path::Path;
use std::str::FromStr;

/// An amount of money in US dollars, stored as a multiple of 10⁻¹² dollars. Integer sums do not depend on the
/// order in which replies arrive.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct Usd(u64);

/// The maximum size of a price table, in bytes.
const MAX_PRICES: usize = 1 << 20;

/// The number of [`Usd`] units per dollar.
const UNITS_PER_DOLLAR: f64 = 1e12;

/// The maximum accepted amount, in dollars. Larger amounts are assumed to be typing errors.
const MAX_DOLLARS: f64 = 1e6;

impl Usd {
    /// Converts an amount in dollars. Returns `None` unless the amount is between 0 and a million.
    pub fn from_dollars(dollars: f64) -> Option<Usd> {
        (0.0..=MAX_DOLLARS).contains(&dollars).then(|| Usd((dollars * UNITS_PER_DOLLAR).round() as u64))
    }

    /// Returns the amount in dollars.
    pub fn dollars(self) -> f64 {
        self.0 as f64 / UNITS_PER_DOLLAR
    }

    /// Adds an amount. The sum saturates at the maximum.
    pub fn plus(self, other: Usd) -> Usd {
        Usd(self.0.saturating_add(other.0))
    }

    /// Subtracts an amount. The difference saturates at 0.
    pub(in crate::client) fn minus(self, other: Usd) -> Usd {
        Usd(self.0.saturating_sub(other.0))
    }
}

impl fmt::Display for Usd {
    /// Formats the amount to the cent, or to a hundredth of a cent if it is below one dollar.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let digits = if self.dollars() < 1.0 { 4 } else { 2 };
        write!(f, "${:.digits$}", self.dollars())
    }
}

impl FromStr for Usd {
    type Err = String;

    /// Parses an amount in dollars, such as `2.50`.
    fn from_str(text: &str) -> Result<Usd, String> {
        let dollars = text.trim().trim_start_matches('$').parse().ok();
        dollars
            .and_then(Usd::from_dollars)
            .ok_or_else(|| format!("`{text}` is not an amount in dollars, such as `2.50`"))
    }
}

/// A model's token prices, in US dollars per million tokens.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Price {
    /// The price for input tokens.
    pub input: f64,
    /// The price for input tokens read from the provider's cache.
    pub cached_input: f64,
    /// The price for input tokens written to the provider's cache.
    pub cache_write: f64,
    /// The price for output tokens, including reasoning.
    pub output: f64,
    /// The date of the price, as stated in the table.
    pub as_of: String,
}

impl Price {
    /// Returns the cost of a reply, or `None` if the provider did not report its token counts.
    pub fn cost(&self, usage: &Usage) -> Option<Usd> {
        let (input, output) = (usage.input_tokens?, usage.output_tokens?);
        let read = usage.cached_input_tokens.unwrap_or(0).min(input);
        let written = usage.cache_write_tokens.unwrap_or(0).min(input - read);
        let parts = [
            (input - read - written, self.input),
            (read, self.cached_input),
            (written, self.cache_write),
            (output, self.output),
        ];
        Some(parts.into_iter().map(|(tokens, price)| of(tokens, price)).fold(Usd::default(), Usd::plus))
    }
}

/// Returns the cost of `tokens` tokens at a price per million.
fn of(tokens: u64, price: f64) -> Usd {
    Usd(tokens.saturating_mul((price * (UNITS_PER_DOLLAR / 1e6)).round() as u64))
}

/// Price tables in order of precedence.
#[derive(Clone, Debug)]
pub struct Prices {
    tables: Vec<Table>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Table {
    as_of: String,
    model: Vec<Row>,
}

#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    provider: Provider,
    name: String,
    input: f64,
    cached_input: Option<f64>,
    cache_write: Option<f64>,
    output: f64,
}

impl Prices {
    /// Returns the table embedded in the program.
    pub fn embedded() -> Prices {
        let table = read(include_str!("prices.toml")).expect("a test reads the embedded table");
        Prices { tables: vec![table] }
    }

    /// Returns the price table in a file, followed by the embedded table.
    ///
    /// # Errors
    /// Returns an error if the file cannot be read, or is not a price table.
    pub fn with_file(path: &Path) -> Result<Prices, EvaluationError> {
        let text = read_text(path, MAX_PRICES, "pass a TOML file of prices")?;
        let wrong = |problem| EvaluationError::malformed(path, format!("not a price table: {problem}"));
        let table = read(&text).map_err(wrong)?;
        let mut prices = Prices::embedded();
        prices.tables.insert(0, table);
        Ok(prices)
    }

    /// Returns a model's price, if known.
    pub fn find(&self, provider: Provider, model: &str) -> Option<Price> {
        self.tables.iter().find_map(|table| {
            let fitting = table.model.iter().filter(|row| row.provider == provider && fits(&row.name, model));
            let row = fitting.max_by_key(|row| row.name.len())?;
            Some(Price {
                input: row.input,
                cached_input: row.cached_input.unwrap_or(row.input),
                cache_write: row.cache_write.unwrap_or(row.input),
                output: row.output,
                as_of: table.as_of.clone(),
            })
        })
    }
}

fn read(text: &str) -> Result<Table, String> {
    let table: Table = toml::from_str(text).map_err(|error| error.to_string())?;
    for row in &table.model {
        let prices = [Some(row.input), row.cached_input, row.cache_write, Some(row.output)];
        if !prices.iter().flatten().all(|price| (0.0..=MAX_DOLLARS).contains(price)) {
            return Err(format!("`{}` has a price that is not a valid amount in dollars", row.name));
        }
    }
    Ok(table)
}

/// Returns `true` if a name in a table matches a model. `gpt-5` does not match `gpt-5-pro`, which costs ten
/// times as much.
fn fits(name: &str, model: &str) -> bool {
    if let Some(start) = name.strip_suffix('*') {
        return model.starts_with(start);
    }
    let Some(rest) = model.strip_prefix(name) else { return false };
    let Some(version) = rest.strip_prefix('-') else { return rest.is_empty() };
    let digits = version.bytes().take_while(u8::is_ascii_digit).count();
    digits >= 3 || ["latest", "preview", "exp"].iter().any(|word| version.starts_with(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn money() {
        let usd = |text: &str| text.parse::<Usd>();
        assert_eq!(usd("2.50").unwrap().to_string(), "$2.50");
        assert_eq!(usd("$0.0001").unwrap().to_string(), "$0.0001");
        assert!(["", "-1", "NaN", "inf", "2e9", "much"].iter().all(|text| usd(text).is_err()));
        assert_eq!(Usd(u64::MAX).plus(Usd(1)), Usd(u64::MAX));
    }

    #[test]
    fn names_match_their_versions_only() {
        for (name, model, expect) in [
            ("gpt-5", "gpt-5", true),
            ("gpt-5", "gpt-5-2025-08-07", true),
            ("gpt-5", "gpt-5-pro", false),
            ("gpt-5", "gpt-5.1", false),
            ("gpt-5", "gpt-50", false),
            ("claude-opus-4", "claude-opus-4-20250514", true),
            ("claude-opus-4", "claude-opus-4-9", false),
            ("gemini-2.0-flash", "gemini-2.0-flash-001", true),
            ("gemini-3-pro", "gemini-3-pro-preview-11-2025", true),
            ("llama*", "llama-3-70b", true),
        ] {
            assert_eq!(fits(name, model), expect, "{name} for {model}");
        }
    }

    #[test]
    fn the_embedded_table() {
        let prices = Prices::embedded();
        let mini = prices.find(Provider::OpenAi, "gpt-4o-mini-2024-07-18").unwrap();
        assert_eq!((mini.input, mini.cached_input, mini.output), (0.15, 0.075, 0.60));
        assert_eq!(prices.find(Provider::OpenAi, "gpt-99"), None);
        assert_eq!(prices.find(Provider::Compatible, "gpt-4o-mini"), None, "another server has other prices");
        for row in &prices.tables[0].model {
            assert_eq!(row.provider == Provider::Anthropic, row.cache_write.is_some(), "{}", row.name);
        }
    }

    #[test]
    fn a_price_file_overrides_the_embedded_table() {
        let file = tempfile::NamedTempFile::new().unwrap();
        let row = |rest: &str| {
            format!("as_of = \"today\"\n[[model]]\nprovider = \"compatible\"\nname = \"qwen*\"\n{rest}")
        };
        std::fs::write(file.path(), row("input = 1\noutput = 2.0\n")).unwrap();
        let prices = Prices::with_file(file.path()).unwrap();
        let price = prices.find(Provider::Compatible, "qwen3:32b").unwrap();
        assert_eq!((price.input, price.cached_input, price.as_of.as_str()), (1.0, 1.0, "today"));
        assert!(prices.find(Provider::OpenAi, "gpt-4o").is_some());
        for (rest, words) in
            [("input = 1\n", "output"), ("input = -1\noutput = 1\n", "not a valid amount in dollars")]
        {
            std::fs::write(file.path(), row(rest)).unwrap();
            let problem = Prices::with_file(file.path()).unwrap_err().to_string();
            assert!(problem.contains(words), "{problem}");
        }
    }

    #[test]
    fn the_cost_of_a_reply() {
        let price =
            Price { input: 3.0, cached_input: 0.3, cache_write: 3.75, output: 15.0, as_of: String::new() };
        let usage = Usage {
            input_tokens: Some(1_000_000),
            cached_input_tokens: Some(500_000),
            cache_write_tokens: Some(100_000),
            output_tokens: Some(10_000),
            reasoning_tokens: Some(5_000),
        };
        let cost = price.cost(&usage).unwrap().dollars();
        assert!((cost - (0.4 * 3.0 + 0.5 * 0.3 + 0.1 * 3.75 + 0.01 * 15.0)).abs() < 1e-12, "{cost}");
        assert_eq!(price.cost(&Usage { output_tokens: None, ..usage }), None);
    }
}
