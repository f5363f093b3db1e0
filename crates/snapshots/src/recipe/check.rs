//! Parses recipes and checks their values.

use crate::recipe::Recipe;
use crate::recipe::error::{MAX_RECIPE, RecipeError, wrong};
use crate::recipe::parts::Mix;
use crate::recipe::placement::placement;
use crate::recipe::secret::Secret;
use crate::sections::SECTIONS;
use base::Digest;
use generators::games::Kind;
use generators::kernels::kinds;
use itertools::Itertools;
use validators::{CriteriaError, Criterion};

impl Recipe {
    /// Parses and checks a recipe.
    ///
    /// # Errors
    /// Returns the first problem, with its position or key.
    pub fn from_toml(text: &str) -> Result<Recipe, RecipeError> {
        let recipe = Recipe::parse(text)?;
        recipe.check()?;
        recipe.beacon.as_ref().map_or(Ok(()), |beacon| beacon.check(recipe.commitment.is_some()))?;
        Ok(recipe)
    }

    /// Parses and checks a recipe for minting. If a secret is given but the recipe has neither a seed nor a
    /// commitment, the error states the commitment that the recipe needs.
    ///
    /// # Errors
    /// Returns the first problem, with its position or key.
    pub fn to_mint(text: &str, secret: Option<&Secret>) -> Result<Recipe, RecipeError> {
        Recipe::from_toml(text).map_err(|error| match (error, secret) {
            (RecipeError::Value { key: "seed", .. }, Some(secret)) => RecipeError::Value {
                key: "seed",
                message: format!(
                    "is missing: for the given secret, write `commitment = \"{}\"` instead",
                    secret.commitment()
                ),
            },
            (error, _) => error,
        })
    }

    fn parse(text: &str) -> Result<Recipe, RecipeError> {
        if text.len() > MAX_RECIPE {
            return Err(RecipeError::TooLarge);
        }
        toml::from_str(text).map_err(|error| {
            let source = Box::new(error);
            match placement(&source, text) {
                Some(help) => RecipeError::Misplaced { source, help },
                None => RecipeError::Syntax(source),
            }
        })
    }

    /// Parses and checks a recipe for a commitment. Drops its `seed` and `commitment`.
    ///
    /// # Errors
    /// Returns the first problem, with its position or key.
    pub fn to_commit(text: &str) -> Result<Recipe, RecipeError> {
        let recipe = Recipe { seed: None, commitment: None, ..Recipe::parse(text)? };
        Recipe { commitment: Some(Digest::of(b"to be drawn")), ..recipe.clone() }.check()?;
        recipe.beacon.as_ref().map_or(Ok(()), |beacon| beacon.check(true))?;
        Ok(recipe)
    }

    /// Checks the values of the recipe.
    ///
    /// # Errors
    /// Returns an error for the first value that is out of range.
    pub fn check(&self) -> Result<(), RecipeError> {
        let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        if self.name.is_empty() || self.name.len() > 40 || !self.name.chars().all(plain) {
            return wrong("name", "takes 1 to 40 lower-case letters, digits and `-`");
        }
        let names =
            |text: &str| !text.trim().is_empty() && text.len() <= 200 && !text.chars().any(char::is_control);
        if self.authors.len() > 100 || !self.authors.iter().all(|author| names(author)) {
            return wrong("authors", "takes up to 100 names, each of 1 to 200 bytes on one line");
        }
        if self.publisher.as_ref().is_some_and(|publisher| !names(publisher)) {
            return wrong("publisher", "takes a name of 1 to 200 bytes on one line");
        }
        match (&self.seed, self.commitment) {
            (Some(seed), None) if seed.trim().is_empty() || seed.len() > 200 => {
                return wrong("seed", "takes a string of 1 to 200 bytes");
            }
            (Some(_), Some(_)) => {
                return wrong(
                    "commitment",
                    "and `seed` are mutually exclusive: a seed is either public or sealed",
                );
            }
            (None, None) => {
                let help = "is missing: specify any text, or a `commitment` from `arcade release RECIPE \
                            --commit`";
                return wrong("seed", help);
            }
            _ => {}
        }
        if self.games() == 0 {
            return wrong("generated.games", "and `corpus.games` are both 0: there is nothing to mint");
        }
        SECTIONS.iter().try_for_each(|section| section.check(self))?;
        let (old, new) = (&self.corpus, &self.generated);
        for (key, value, least, most) in [
            ("corpus.games", old.games, 0, 10_000),
            ("corpus.levels", old.levels, 1, 20),
            ("corpus.game_tries", old.game_tries, 1, 10_000),
            ("corpus.level_tries", old.level_tries, 1, 10_000),
            ("generated.games", new.games, 0, 10_000),
            ("generated.levels", new.levels, 1, 20),
            ("generated.game_tries", new.game_tries, 1, 10_000),
            ("generated.level_tries", new.level_tries, 1, 10_000),
            (
                "generated.least_interactions",
                u32::try_from(new.least_interactions).unwrap_or(u32::MAX),
                0,
                100,
            ),
            ("generated.least_mechanics", u32::try_from(new.least_mechanics).unwrap_or(u32::MAX), 0, 100),
        ] {
            if !(least..=most).contains(&value) {
                return wrong(key, format!("is {value}; the value must be from {least} to {most}"));
            }
        }
        for (key, value) in [("corpus.candidates", old.candidates), ("generated.candidates", new.candidates)]
        {
            if !(1.0..=20.0).contains(&value) {
                return wrong(key, format!("is {value}; the value must be from 1 to 20 for each game"));
            }
        }
        check_mix("generated.mix", new.mix)?;
        if new.mix.search > 0.0 || new.mix.evolutionary > 0.0 {
            let help = "requests kernel games by search, but kernel games can only be drawn: omit `mix`, \
                        or request games in [invented], whose `mix` allows all methods";
            return wrong("generated.mix", help);
        }
        if let Some(kind) = new.kinds.iter().find(|&&kind| !kinds().any(|known| known == kind)) {
            let known = kinds().map(Kind::name).join(", ");
            let message =
                format!("lists the kind `{}`, which has no generator; choose from {known}", kind.name());
            return wrong("generated.kinds", message);
        }
        if new.games > 0 && new.levels < 3 && self.criteria.includes(Criterion::Progression) {
            let help = "raise it to 3 or more, or drop `progression` from `criteria.ask`";
            return wrong(
                "generated.levels",
                format!("is {}; `progression` needs at least 3: {help}", new.levels),
            );
        }
        self.check_invented()?;
        self.check_selection()?;
        for (key, (least, most)) in [("board.columns", self.board.columns), ("board.rows", self.board.rows)] {
            if least < 5 || most < least || most > 100 {
                return wrong(
                    key,
                    format!(
                        "is [{least}, {most}]; the range needs two numbers from 5 to 100, in ascending order"
                    ),
                );
            }
        }
        let tables = [("criteria", Some(&self.criteria)), ("corpus.criteria", self.corpus.criteria.as_ref())];
        for (table, criteria) in tables {
            let Some(criteria) = criteria else { continue };
            let named = |problem| RecipeError::Criteria { table, problem };
            criteria.check().map_err(named)?;
            // These criteria are shown on the cards.
            let shown = [Criterion::NotIdle, Criterion::NotRandom, Criterion::Winnable];
            if let Some(missing) = shown.into_iter().find(|&shown| !criteria.includes(shown)) {
                let message = format!("lacks `{missing}`, which every card shows");
                return Err(named(CriteriaError { key: "ask", message }));
            }
        }
        Ok(())
    }

    /// Checks the values of the section `[invented]`.
    fn check_invented(&self) -> Result<(), RecipeError> {
        let Some(part) = &self.invented else { return Ok(()) };
        for (key, value, least, most) in [
            ("invented.games", part.games, 0, 10_000),
            ("invented.levels", part.levels, 1, 20),
            ("invented.game_tries", part.game_tries, 1, 10_000),
            ("invented.level_tries", part.level_tries, 1, 10_000),
        ] {
            if !(least..=most).contains(&value) {
                return wrong(key, format!("is {value}; the value must be from {least} to {most}"));
            }
        }
        if !(1.0..=20.0).contains(&part.candidates) {
            let message = format!("is {}; the value must be from 1 to 20 for each game", part.candidates);
            return wrong("invented.candidates", message);
        }
        check_mix("invented.mix", part.mix)?;
        if part.games > 0 && part.levels < 3 && self.criteria.includes(Criterion::Progression) {
            let help = "raise it to 3 or more, or drop `progression` from `criteria.ask`";
            let message = format!("is {}; `progression` needs at least 3: {help}", part.levels);
            return wrong("invented.levels", message);
        }
        Ok(())
    }

    /// Checks the values that govern the selection of games.
    fn check_selection(&self) -> Result<(), RecipeError> {
        if !self.difficulty.is_empty() {
            let total: f64 = self.difficulty.values().sum();
            if self.difficulty.values().any(|share| !(0.0..=1.0).contains(share))
                || (total - 1.0).abs() > 1e-6
            {
                return wrong("difficulty", format!("adds up to {total}; the fractions must add up to 1"));
            }
            let of_corpus =
                self.corpus.criteria.as_ref().is_none_or(|criteria| criteria.includes(Criterion::Skill));
            if !(self.criteria.includes(Criterion::Skill) && of_corpus) {
                let help = "requires the criterion `skill`, whose episodes provide the measurement: add `skill` to `criteria.ask`";
                return wrong("difficulty", help);
            }
        }
        for (key, quotas) in [
            ("taxonomy.goals", self.taxonomy.goals.values().collect::<Vec<_>>()),
            ("taxonomy.avatars", self.taxonomy.avatars.values().collect()),
        ] {
            if quotas.iter().any(|(least, most)| !(0.0 <= *least && least <= most && *most <= 1.0)) {
                return wrong(key, "takes pairs of fractions from 0 to 1, in ascending order");
            }
            let games = i64::from(self.games());
            let numbers = || quotas.iter().map(|&&share| self.quota(share));
            if let Some((&&(low, high), _)) =
                quotas.iter().zip(numbers()).find(|(_, (least, most))| least > most)
            {
                return wrong(
                    key,
                    format!(
                        "requires a fraction from {low} to {high}, which no number of games out of {games} \
                         gives"
                    ),
                );
            }
            let least: i64 = numbers().map(|(least, _)| least).sum();
            if least > games {
                return wrong(key, format!("requires at least {least} games, but there are {games}"));
            }
        }
        match self.taxonomy.crowd {
            Some(crowd) if !(crowd > 0.0 && crowd <= 1.0) => wrong(
                "taxonomy.crowd",
                format!("is {crowd}; the value must be a fraction above 0 and at most 1"),
            ),
            _ => Ok(()),
        }
    }
}

/// Checks the weights of generation methods.
fn check_mix(key: &'static str, mix: Mix) -> Result<(), RecipeError> {
    let weights = [mix.constructive, mix.search, mix.evolutionary];
    match weights.iter().all(|weight| (0.0..=1e6).contains(weight)) && weights.iter().sum::<f64>() > 0.0 {
        true => Ok(()),
        false => wrong(key, "needs at least one weight above 0"),
    }
}
