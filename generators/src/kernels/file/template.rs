//! Texts with placeholders for numbers that are drawn when a game is generated: `{2..4}`, `{price:2..4}`, `{price}`,
//! `{price+1}`.

/// A kernel's numbers, in the order in which its texts introduce them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Numbers(pub(crate) Vec<Number>);

impl Numbers {
    /// Draws a value for each number.
    pub(crate) fn draw(&self, sampler: &mut base::Sampler) -> Vec<u32> {
        let mut draw = |number: &Number| sampler.between(number.least as usize, number.most as usize) as u32;
        self.0.iter().map(&mut draw).collect()
    }

    /// Adds the numbers that a text introduces under new names.
    pub(crate) fn complete(&mut self, text: &str) {
        for inside in text.split('{').skip(1).filter_map(|rest| Some(rest.split_once('}')?.0)) {
            let mut own = Numbers::default();
            let introduced = number(inside, &mut own).is_ok();
            let is_known = |new: &Number| self.0.iter().any(|number| number.name == new.name);
            let missing = own.0.into_iter().filter(|new| introduced && new.name.is_some());
            let missing: Vec<Number> = missing.filter(|new| !is_known(new)).collect();
            self.0.extend(missing);
        }
    }
}

/// A number and its range.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Number {
    /// The name by which other parts of the text refer to this number.
    name: Option<String>,
    pub(crate) least: u32,
    pub(crate) most: u32,
}

/// A text with placeholders for numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Template(Vec<Part>);

#[derive(Clone, Debug, PartialEq)]
enum Part {
    Text(String),
    /// The index of a number, and the amount to add to its value.
    Number(usize, i64),
}

impl Template {
    /// Parses a text and adds the numbers that it introduces to `numbers`.
    ///
    /// # Errors
    /// Returns an error if a brace is unmatched, a range is invalid, or a name is unknown or introduced twice.
    pub(crate) fn read(text: &str, numbers: &mut Numbers) -> Result<Template, String> {
        let mut parts = Vec::new();
        let mut rest = text;
        while let Some((before, after)) = rest.split_once('{') {
            let (inside, after) = after.split_once('}').ok_or("a `{` without a matching `}`")?;
            parts.push(Part::Text(before.to_owned()));
            parts.push(number(inside, numbers)?);
            rest = after;
        }
        parts.push(Part::Text(rest.to_owned()));
        Ok(Template(parts))
    }

    /// Returns the text with its numbers set to the given values.
    pub(crate) fn fill(&self, values: &[u32]) -> String {
        let part = |part: &Part| match part {
            Part::Text(text) => text.clone(),
            &Part::Number(at, added) => (i64::from(values[at]) + added).max(0).to_string(),
        };
        self.0.iter().map(part).collect()
    }
}

/// Returns a text filled with the values of numbers that other texts introduce. If the text contains any other number,
/// returns it unchanged.
pub(crate) fn filled(text: &str, numbers: &Numbers, values: &[u32]) -> String {
    Template::read(text, &mut numbers.clone()).map_or_else(|_| text.to_owned(), |text| text.fill(values))
}

fn number(inside: &str, numbers: &mut Numbers) -> Result<Part, String> {
    if let Some((bounds, (least, most))) =
        inside.split_once("..").map(|(low, most)| (inside, (low.rsplit(':').next().unwrap_or(low), most)))
    {
        let parse =
            |text: &str| text.trim().parse::<u32>().map_err(|_| format!("`{{{bounds}}}` is not a range"));
        let (least, most) = (parse(least)?, parse(most)?);
        if least > most {
            return Err(format!("`{{{bounds}}}` is empty"));
        }
        let name = inside.split_once(':').map(|(name, _)| name.trim().to_owned());
        if name.is_some() && numbers.0.iter().any(|number| number.name == name) {
            return Err(format!("`{{{bounds}}}` defines a name that is already defined"));
        }
        numbers.0.push(Number { name, least, most });
        return Ok(Part::Number(numbers.0.len() - 1, 0));
    }
    let (name, added) = match inside.find(['+', '-']) {
        None => (inside, 0),
        Some(at) => {
            let added = inside[at..]
                .parse()
                .map_err(|_| format!("`{{{inside}}}` does not add or subtract a number"))?;
            (&inside[..at], added)
        }
    };
    let known = |number: &Number| number.name.as_deref() == Some(name.trim());
    let at = numbers
        .0
        .iter()
        .position(known)
        .ok_or_else(|| format!("`{{{inside}}}` is not defined before its use"))?;
    Ok(Part::Number(at, added))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_introduced_and_used() {
        let mut numbers = Numbers::default();
        let text = "limit={price:2..4} cooldown={3..3} coin*{price+1} {price-2}";
        let template = Template::read(text, &mut numbers).unwrap();
        assert_eq!(numbers.0.len(), 2);
        let mut more = numbers.clone();
        more.complete("{1..9} {price} {price:1..9} {need:2..3} {");
        assert!(more.0[..2] == numbers.0 && more.0.len() == 3, "{more:?}");
        assert_eq!(template.fill(&[4, 3]), "limit=4 cooldown=3 coin*5 2");
        for wrong in ["{", "{x}", "{4..2}", "{price:1..2}", "{price+x}"] {
            assert!(Template::read(wrong, &mut numbers.clone()).is_err(), "{wrong}");
        }
    }
}
