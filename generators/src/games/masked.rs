//! Masked games: a copy of a game with the same rules, whose names, characters, colours and comments carry no meaning.
//!
//! A player who has read about games knows what a `key` is for. A player of the masked copy must find out. The names
//! `wall` and `avatar` are unchanged, because the engine depends on them.

use super::surface::{self, Symbols};
use base::{Sampler, Seed};
use engine::Description;
use engine::syntax::{SpriteLine, meaningless_names};
use itertools::Itertools;
use std::collections::BTreeMap;

/// Level characters of masked games.
const SYMBOLS: &str = "abcdefghijklmnopqrstuvwxyzBCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";

/// A game without its theme, and the mapping of its level characters.
#[derive(Clone, Debug, PartialEq)]
pub struct Masked {
    description: Description,
    symbols: Symbols,
}

impl Masked {
    /// Creates the masked copy of a game that compiles. Sprite types are called `t1`, `t2` and so on in random order,
    /// level characters are drawn at random, and the game's colours are permuted. Images and comments are removed. All
    /// lines keep their order, so both games play identically, including their state hashes.
    pub fn of(description: &Description, seed: Seed) -> Masked {
        let mut sampler = seed.child("masked", 0).sampler();
        let mask = Mask::draw(description, &mut sampler);
        let mut masked = surface::without_surface(description, &mask.names);
        mask.recolor(&mut masked.sprites);
        mask.symbols.write(&mut masked);
        // The mapping is sorted by character, so its order does not reveal the sprite types.
        masked.mapping.sort_by_key(|line| line.symbol);
        Masked { description: masked, symbols: mask.symbols }
    }

    /// Returns the rules of the masked game.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// Translates a level of the original game for the masked copy. Unmapped characters become spaces.
    pub fn level(&self, text: &str) -> String {
        self.symbols.level(text)
    }
}

/// The mappings from old to new names, characters and colours.
struct Mask {
    names: BTreeMap<String, String>,
    symbols: Symbols,
    colors: BTreeMap<String, String>,
}

impl Mask {
    fn draw(description: &Description, sampler: &mut Sampler) -> Mask {
        let own = description.own_names();
        let params = description.sprite_lines().into_iter().flat_map(|(_, line)| &line.params);
        let colors = params.filter(|param| param.key.text == "color").map(|param| param.value.text.as_str());
        let colors = colors.unique().collect_vec();
        let names = meaningless_names(&own, sampler);
        let mut shuffled = colors.clone();
        sampler.shuffle(&mut shuffled);
        let colors = colors.iter().zip(shuffled).map(|(from, to)| ((*from).to_owned(), to.to_owned()));
        let used = surface::symbols(description);
        let mut pool: Vec<char> = SYMBOLS.chars().collect();
        sampler.shuffle(&mut pool);
        pool.extend(
            ('!'..='~').filter(|symbol| symbol.is_ascii_punctuation() && !['#', '<', '>'].contains(symbol)),
        );
        let unmapped_builtins =
            || surface::unmapped_builtins(description).map(|(symbol, _)| (symbol, symbol));
        pool.retain(|&symbol| !unmapped_builtins().any(|(kept, _)| kept == symbol));
        let needed: Vec<char> = surface::mapped_builtins(description).collect();
        pool.retain(|symbol| !needed.contains(symbol));
        pool.truncate(used.len() - needed.len());
        pool.extend(needed);
        sampler.shuffle(&mut pool);
        // If a game uses more characters than the pool contains, the surplus characters stay unchanged.
        let symbols = used.iter().enumerate().map(|(at, &symbol)| (symbol, *pool.get(at).unwrap_or(&symbol)));
        let symbols = symbols.chain(unmapped_builtins());
        Mask { names, symbols: Symbols(symbols.collect()), colors: colors.collect() }
    }

    fn recolor(&self, lines: &mut [SpriteLine]) {
        for line in lines {
            for param in line.params.iter_mut().filter(|param| param.key.text == "color") {
                if let Some(color) = self.colors.get(&param.value.text) {
                    param.value.text.clone_from(color);
                }
            }
            self.recolor(&mut line.children);
        }
    }
}
