//! Report tables, which can be formatted as Markdown, CSV and LaTeX.

use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write;

/// A table. Every row has one cell per column.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Table {
    /// The file name without its extension, which consists of letters, digits and hyphens.
    pub id: String,
    /// The table title.
    pub title: String,
    /// A note for the reader, such as the units, or the reasons for missing values.
    pub note: String,
    /// The column headings.
    pub columns: Vec<String>,
    /// The table rows, each with one cell per column.
    pub rows: Vec<Vec<TableCell>>,
}

/// A column of a table with one row per `R`: a heading, and a function that returns the cell for a row.
pub type Column<'a, R> = (&'a str, &'a dyn Fn(&R) -> TableCell);

/// A cell of a [`Table`].
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum TableCell {
    /// An unknown value.
    Missing,
    /// A text.
    Text(String),
    /// A text that contains numbers and is aligned like a number.
    Figure(String),
    /// A count.
    Count(u64),
    /// A number with a fixed number of decimal places.
    Number {
        /// The value of the number.
        value: f64,
        /// The number of decimal places.
        digits: usize,
    },
    /// A number and its confidence interval.
    Interval {
        /// The value of the number.
        value: f64,
        /// The interval's lower bound.
        low: f64,
        /// The interval's upper bound.
        high: f64,
        /// The number of decimal places.
        digits: usize,
    },
    /// A probability, such as a p-value, printed with two significant digits.
    Probability(f64),
}

impl TableCell {
    /// Creates a text cell.
    pub fn text(text: impl Into<String>) -> TableCell {
        TableCell::Text(text.into())
    }

    /// Creates a number cell with `digits` decimal places, or a missing cell if there is no value.
    pub fn number(value: impl Into<Option<f64>>, digits: usize) -> TableCell {
        value.into().map_or(TableCell::Missing, |value| TableCell::Number { value, digits })
    }

    /// Creates a text cell aligned like a number, or a missing cell if there is no text.
    pub fn figure(words: impl Into<Option<String>>) -> TableCell {
        words.into().map_or(TableCell::Missing, TableCell::Figure)
    }

    /// Creates a number cell, or a missing cell if there is no value. Integers are shown without decimal
    /// places, and other numbers with up to two, depending on their size.
    pub fn short(value: impl Into<Option<f64>>) -> TableCell {
        let digits = |value: f64| match value.abs() {
            size if value.fract() == 0.0 || size >= 100.0 => 0,
            size if size >= 1.0 => 1,
            _ => 2,
        };
        let value = value.into();
        TableCell::number(value, value.map_or(0, digits))
    }

    /// Creates a count cell, or a missing cell if there is no count.
    pub fn count(count: impl Into<Option<u64>>) -> TableCell {
        count.into().map_or(TableCell::Missing, TableCell::Count)
    }

    /// Creates a probability cell, or a missing cell if there is no value.
    pub fn probability(p: impl Into<Option<f64>>) -> TableCell {
        p.into().map_or(TableCell::Missing, TableCell::Probability)
    }

    /// Formats the cell as human-readable text.
    pub fn plain(&self) -> String {
        match self {
            TableCell::Missing => "–".to_owned(),
            TableCell::Text(text) | TableCell::Figure(text) => visible(text).into_owned(),
            TableCell::Count(count) => count.to_string(),
            TableCell::Number { value, digits } => rounded(*value, *digits),
            TableCell::Interval { value, low, high, digits } => {
                let [value, low, high] = [value, low, high].map(|number| rounded(*number, *digits));
                format!("{value} [{low}, {high}]")
            }
            TableCell::Probability(p) if *p != 0.0 && *p < 0.0001 => format!("{p:.1e}"),
            TableCell::Probability(p) if *p < 0.01 => rounded(*p, 4),
            TableCell::Probability(p) => rounded(*p, 3),
        }
    }

    fn is_words(&self) -> bool {
        matches!(self, TableCell::Text(_))
    }
}

/// Formats a number with `digits` decimal places. Zero is formatted without a sign.
fn rounded(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.chars().all(|c| matches!(c, '0' | '.')) => rest.to_owned(),
        _ => text,
    }
}

impl Table {
    /// Creates a table without rows.
    pub fn new(id: &str, title: &str, note: &str, columns: &[&str]) -> Table {
        let columns = columns.iter().map(|&column| column.to_owned()).collect();
        Table { id: id.to_owned(), title: title.to_owned(), note: note.to_owned(), columns, rows: Vec::new() }
    }

    /// Creates a table with one row per item in `rows`.
    pub fn of<R>(id: &str, title: &str, note: &str, rows: &[R], columns: &[Column<'_, R>]) -> Table {
        let names: Vec<&str> = columns.iter().map(|(name, _)| *name).collect();
        let mut table = Table::new(id, title, note, &names);
        table.rows = rows.iter().map(|row| columns.iter().map(|(_, cell)| cell(row)).collect()).collect();
        table
    }

    /// Adds a row. Columns without a cell become [`Missing`](TableCell::Missing), and cells without a column
    /// are dropped.
    pub fn push(&mut self, mut row: Vec<TableCell>) {
        row.resize(self.columns.len(), TableCell::Missing);
        self.rows.push(row);
    }

    /// Returns `true` if a column contains text and should therefore be left-aligned.
    fn is_words(&self, column: usize) -> bool {
        self.rows.iter().any(|row| row[column].is_words())
    }

    /// Formats the table as Markdown, with its title as a heading above and its note below.
    ///
    /// ```
    /// use infinite_arcade_report::{Table, TableCell};
    /// let mut table = Table::new("wins", "Wins", "", &["player", "win rate"]);
    /// table.push(vec![TableCell::text("mcts|100"), TableCell::number(0.5, 2)]);
    /// assert_eq!(table.to_markdown(), "## Wins\n\n| player | win rate |\n|:--|--:|\n| mcts\\|100 | 0.50 |\n");
    /// ```
    pub fn to_markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let mut text = format!("## {}\n\n", in_markdown(&self.title));
        text += &line(self.columns.iter().map(|column| in_markdown(column)).collect());
        let rule = (0..self.columns.len()).map(|column| if self.is_words(column) { ":--|" } else { "--:|" });
        text += &format!("|{}\n", rule.collect::<String>());
        for row in &self.rows {
            let cell = |cell: &TableCell| match cell {
                TableCell::Text(words) | TableCell::Figure(words) => in_markdown(words),
                figures => figures.plain(),
            };
            text += &line(row.iter().map(cell).collect());
        }
        if !self.note.is_empty() {
            text += &format!("\n{}\n", in_markdown(&self.note));
        }
        text
    }

    /// Formats the table as CSV. Numbers are written with all digits, unknown values are empty fields, and
    /// intervals span three columns. Text that spreadsheets would interpret as a formula gets a leading
    /// apostrophe.
    ///
    /// ```
    /// use infinite_arcade_report::{Table, TableCell};
    /// let mut table = Table::new("wins", "Wins", "", &["player", "win rate"]);
    /// let rate = TableCell::Interval { value: 0.25, low: 0.125, high: 0.5, digits: 2 };
    /// table.push(vec![TableCell::text("a, b"), rate]);
    /// table.push(vec![TableCell::text("c"), TableCell::Missing]);
    /// assert_eq!(
    ///     table.to_csv(),
    ///     "player,win rate,win rate low,win rate high\n\"a, b\",0.25,0.125,0.5\nc,,,\n"
    /// );
    /// ```
    pub fn to_csv(&self) -> String {
        let is_interval =
            |column: usize| self.rows.iter().any(|row| matches!(row[column], TableCell::Interval { .. }));
        let wide: Vec<bool> = (0..self.columns.len()).map(is_interval).collect();
        let mut writer = csv::Writer::from_writer(Vec::new());
        let header = self.columns.iter().zip(&wide).flat_map(|(column, wide)| {
            let ends = wide.then(|| [format!("{column} low"), format!("{column} high")]);
            [column.clone()].into_iter().chain(ends.into_iter().flatten()).map(|name| in_csv(&name))
        });
        writer.write_record(header).expect("memory can be written");
        for row in &self.rows {
            let fields = row.iter().zip(&wide).flat_map(|(cell, wide)| {
                let one = |field: String| [field, String::new(), String::new()];
                let fields = match cell {
                    TableCell::Missing => one(String::new()),
                    TableCell::Text(text) | TableCell::Figure(text) => one(in_csv(text)),
                    TableCell::Count(count) => one(count.to_string()),
                    TableCell::Number { value, .. } | TableCell::Probability(value) => one(value.to_string()),
                    TableCell::Interval { value, low, high, .. } => [value, low, high].map(f64::to_string),
                };
                fields.into_iter().take(if *wide { 3 } else { 1 })
            });
            writer.write_record(fields).expect("memory can be written, and every row has the same fields");
        }
        let bytes = writer.into_inner().expect("memory can be written");
        String::from_utf8(bytes).expect("the writer writes UTF-8")
    }

    /// Formats the table as a LaTeX `table` that requires no packages.
    pub fn to_latex(&self) -> String {
        let columns: String =
            (0..self.columns.len()).map(|column| if self.is_words(column) { 'l' } else { 'r' }).collect();
        let line = |cells: Vec<String>| format!("    {} \\\\\n", cells.join(" & "));
        let mut text = String::from("\\begin{table}\n  \\centering\n");
        let _ = writeln!(text, "  \\caption{{{}}}\n  \\label{{tab:{}}}", latex(&self.title), self.id);
        let _ = writeln!(text, "  \\begin{{tabular}}{{{columns}}}\n    \\hline");
        text += &line(self.columns.iter().map(|column| latex(column)).collect());
        text += "    \\hline\n";
        for row in &self.rows {
            text += &line(row.iter().map(|cell| latex(&cell.plain())).collect());
        }
        text += "    \\hline\n  \\end{tabular}\n";
        if !self.note.is_empty() {
            let _ = writeln!(text, "\n  {{\\footnotesize {}}}", latex(&self.note));
        }
        text + "\\end{table}\n"
    }
}

/// Escapes text for Markdown, on a single line. Escapes all characters that could be interpreted as markup,
/// HTML, a link or the end of a cell.
///
/// ```
/// use infinite_arcade_report::in_markdown;
/// assert_eq!(in_markdown("gpt_5 <b>[a](b)</b> &lt; R & D"), "gpt_5 &lt;b&gt;\\[a\\](b)&lt;/b&gt; &amp;lt; R & D");
/// ```
pub fn in_markdown(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    let text = visible(text);
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        let after = characters.peek().copied().unwrap_or(' ');
        match character {
            '<' => out += "&lt;",
            '>' => out += "&gt;",
            '&' if after.is_ascii_alphabetic() || after == '#' => out += "&amp;",
            '\\' | '`' | '*' | '[' | ']' | '|' | '~' => out.extend(['\\', character]),
            // An underscore within a word is not markup.
            '_' if !(before.is_alphanumeric() && after.is_alphanumeric()) => out += "\\_",
            _ => out.push(character),
        }
        before = character;
    }
    out
}

/// Returns `true` if a character is a control character, or changes the direction or line structure of the
/// surrounding text. Such characters could make one name look like another.
pub fn is_invisible(character: char) -> bool {
    let turns = ['\u{61c}', '\u{200e}', '\u{200f}', '\u{2028}', '\u{2029}'];
    character.is_control()
        || turns.contains(&character)
        || ('\u{202a}'..='\u{202e}').contains(&character)
        || ('\u{2066}'..='\u{2069}').contains(&character)
}

/// Returns a text on a single line, with every invisible character ([`is_invisible`]) escaped. Text from
/// files must be passed through this function before display.
///
/// ```
/// use infinite_arcade_report::visible;
/// assert_eq!(visible("a\nb\u{1b}[2Jc\u{202e}é"), "a\\nb\\u{1b}[2Jc\\u{202e}é");
/// ```
pub fn visible(text: &str) -> Cow<'_, str> {
    spelt_out(text, is_invisible)
}

/// Returns a text with every invisible character escaped, like [`visible`], but preserves line feeds and
/// tabs.
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    spelt_out(text, |character| is_invisible(character) && !matches!(character, '\n' | '\t'))
}

fn spelt_out(text: &str, is_spelt: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&is_spelt) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            _ if !is_spelt(character) => out.push(character),
            '\n' => out += "\\n",
            '\t' => out += "\\t",
            _ => out.extend(character.escape_unicode()),
        }
    }
    Cow::Owned(out)
}

/// Formats text as a CSV field on a single line (see [`visible`]). A leading apostrophe prevents spreadsheets
/// from interpreting the text as a formula (OWASP, *CSV Injection*).
pub fn in_csv(text: &str) -> String {
    let starts =
        |text: &str| text.starts_with(['=', '+', '-', '@', '\t', '\r', '\n', '＝', '＋', '－', '＠']);
    // Some spreadsheets ignore leading spaces.
    let is_formula = starts(text) || starts(text.trim_start_matches(|c: char| c == ' ' || is_invisible(c)));
    format!("{}{}", if is_formula { "'" } else { "" }, visible(text))
}

/// Escapes LaTeX's special characters.
fn latex(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for character in visible(text).chars() {
        match character {
            '\\' => out += "\\textbackslash{}",
            '~' => out += "\\textasciitilde{}",
            '^' => out += "\\textasciicircum{}",
            '&' | '%' | '$' | '#' | '_' | '{' | '}' => out.extend(['\\', character]),
            // At the start of a row, LaTeX would interpret a bracket as an option to the previous line break.
            '[' => out += "{[}",
            ']' => out += "{]}",
            '<' => out += "\\textless{}",
            '>' => out += "\\textgreater{}",
            '|' => out += "\\textbar{}",
            '–' => out += "--",
            '−' => out += "$-$",
            _ => out.push(character),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::new("a-table", "100 % & more", "Of $5.", &["a_b", "n", "p"]);
        let rate = TableCell::Interval { value: 0.08, low: 0.0222, high: 0.2497, digits: 2 };
        table.push(vec![TableCell::text("x^2\\|"), rate, TableCell::Probability(0.00105512)]);
        table.push(vec![TableCell::Missing, TableCell::Count(3), TableCell::Probability(4.11e-13)]);
        table
    }

    #[test]
    fn markdown() {
        let expect = "## 100 % & more\n\n| a_b | n | p |\n|:--|--:|--:|\n\
                      | x^2\\\\\\| | 0.08 [0.02, 0.25] | 0.0011 |\n| – | 3 | 4.1e-13 |\n\nOf $5.\n";
        assert_eq!(table().to_markdown(), expect);
    }

    #[test]
    fn markup_in_names_is_escaped() {
        let check = |name: &str, expect: &str| assert_eq!(in_markdown(name), expect);
        check("<script>alert(1)</script>", "&lt;script&gt;alert(1)&lt;/script&gt;");
        check("![x](javascript:y)", "!\\[x\\](javascript:y)");
        check("_a_ mcts_guided `b` **c** ~~d~~", "\\_a\\_ mcts_guided \\`b\\` \\*\\*c\\*\\* \\~\\~d\\~\\~");
        check("a\n# b\u{1b}[2J", "a\\\\n# b\\\\u{1b}\\[2J");
    }

    /// Checks that names from files neither break lines nor change the direction of text, and are not
    /// interpreted by terminals.
    #[test]
    fn invisible_characters_are_spelt_out_everywhere() {
        let name = "a\nb\u{1b}[2J\u{9b}\u{202e}\u{2028}";
        let mut table = Table::new("a-table", name, name, &[name, name]);
        let rate = TableCell::Interval { value: 0.5, low: 0.0, high: 1.0, digits: 1 };
        table.push(vec![TableCell::text(name), rate]);
        table.push(vec![TableCell::Figure(name.to_owned()), TableCell::Missing]);
        for text in [table.to_csv(), table.to_latex(), table.to_markdown(), table.rows[0][0].plain()] {
            assert!(!text.chars().any(|c| is_invisible(c) && c != '\n'), "{text}");
            assert!(text.contains("u\u{7b}1b") || text.contains("u\\{1b"), "{text}");
        }
        assert_eq!(table.to_csv().lines().count(), 3);
    }

    #[test]
    fn formulas_in_names_are_escaped() {
        let mut table = Table::new("a-table", "", "", &["player", "difference"]);
        for name in ["=1+1", "+1", "-2+3", "@sum", "\tx", "a=1", "–"] {
            table.push(vec![TableCell::text(name), TableCell::number(-0.5, 1)]);
        }
        assert_eq!(
            table.to_csv(),
            "player,difference\n'=1+1,-0.5\n'+1,-0.5\n'-2+3,-0.5\n'@sum,-0.5\n'\\tx,-0.5\na=1,-0.5\n–,-0.5\n"
        );
    }

    #[test]
    fn csv_keeps_all_digits() {
        let expect = "a_b,n,n low,n high,p\nx^2\\|,0.08,0.0222,0.2497,0.00105512\n,3,,,0.000000000000411\n";
        assert_eq!(table().to_csv(), expect);
    }

    #[test]
    fn latex_is_escaped() {
        let expect = "\\begin{table}\n  \\centering\n  \\caption{100 \\% \\& more}\n  \\label{tab:a-table}\n  \
                      \\begin{tabular}{lrr}\n    \\hline\n    a\\_b & n & p \\\\\n    \\hline\n    \
                      x\\textasciicircum{}2\\textbackslash{}\\textbar{} & 0.08 {[}0.02, 0.25{]} & 0.0011 \\\\\n    \
                      -- & 3 & 4.1e-13 \\\\\n    \\hline\n  \\end{tabular}\n\n  {\\footnotesize Of \\$5.}\n\\end{table}\n";
        assert_eq!(table().to_latex(), expect);
    }

    #[test]
    fn numbers() {
        let plain = |cell: TableCell| cell.plain();
        assert_eq!(plain(TableCell::number(-0.0004, 2)), "0.00");
        assert_eq!(plain(TableCell::number(-0.4, 1)), "-0.4");
        let short = [3.0, 0.3333, 9.5, 12.25, 123.4].map(|value| plain(TableCell::short(value)));
        assert_eq!(short, ["3", "0.33", "9.5", "12.2", "123"]);
        assert_eq!(plain(TableCell::number(None, 1)), "–");
        assert_eq!(plain(TableCell::Probability(1.0)), "1.000");
        assert_eq!(plain(TableCell::Probability(0.0)), "0.0000");
    }

    #[test]
    fn rows_are_fitted_to_the_columns() {
        let mut table = table();
        table.push(vec![TableCell::Count(1); 9]);
        table.push(Vec::new());
        let columns = table.columns.len();
        assert_eq!(table.rows[table.rows.len() - 2], vec![TableCell::Count(1); columns]);
        assert_eq!(table.rows[table.rows.len() - 1], vec![TableCell::Missing; columns]);
    }
}
