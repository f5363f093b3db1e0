//! The masked twin of a game: the same rules, with nothing in names, characters, colours or comments that tells what they
//! are.
//!
//! Who has read about games knows what a `key` is for; who plays the twin has to find out. The names `wall` and `avatar`
//! stay, as the engine knows them by these.

use engine::syntax::{MappingLine, SpriteLine, Trivia};
use engine::{Description, Sampler, Seed};
use std::collections::BTreeMap;

/// Level characters of masked games.
const SYMBOLS: &str = "abcdefghijklmnopqrstuvwxyzBCDEFGHIJKLMNOPQRSTUVWXYZ0123456789";
/// Names that the engine gives a meaning to.
const RESERVED: [&str; 2] = ["wall", "avatar"];

/// A game without its fiction, and how its levels are written.
#[derive(Clone, Debug, PartialEq)]
pub struct Masked {
    description: Description,
    symbols: BTreeMap<char, char>,
}

impl Masked {
    /// The twin of a game, any that compiles: sprite types are called `t1`, `t2` and so on in drawn order, level characters
    /// are drawn, and the colours that the game uses change places. Pictures and comments go. The order of all lines is
    /// that of the game, so that the two play alike, state hashes included.
    pub fn of(description: &Description, seed: Seed) -> Masked {
        let mut sampler = seed.child("masked", 0).sampler();
        let mask = Mask::draw(description, &mut sampler);
        let mut masked = description.renamed(&mask.names);
        masked.header.trivia = Trivia::default();
        mask.sprites(&mut masked.sprites);
        mask.mapping(&mut masked.mapping);
        masked.interactions.iter_mut().for_each(|line| line.trivia = Trivia::default());
        masked.terminations.iter_mut().for_each(|line| line.trivia = Trivia::default());
        masked.parameters.iter_mut().for_each(|line| line.trivia = Trivia::default());
        masked.section_trivia = Default::default();
        masked.tail = Vec::new();
        Masked { description: masked, symbols: mask.symbols }
    }

    /// The rules.
    pub fn description(&self) -> &Description {
        &self.description
    }

    /// A level of the game, as the twin writes it. Characters that mean nothing become blanks.
    pub fn level(&self, text: &str) -> String {
        let symbol = |c: char| match self.symbols.get(&c) {
            Some(&masked) => masked,
            None if c.is_whitespace() => c,
            None => ' ',
        };
        text.chars().map(symbol).collect()
    }
}

/// What becomes of what.
struct Mask {
    names: BTreeMap<String, String>,
    symbols: BTreeMap<char, char>,
    colors: BTreeMap<String, String>,
}

impl Mask {
    fn draw(description: &Description, sampler: &mut Sampler) -> Mask {
        let lines = description.sprite_lines();
        let mut own: Vec<&str> = Vec::new();
        let mut colors: Vec<&str> = Vec::new();
        for (_, line) in &lines {
            let name = line.name.text.as_str();
            if !RESERVED.contains(&name) && !own.contains(&name) {
                own.push(name);
            }
            for param in line.params.iter().filter(|param| param.key.text == "color") {
                if !colors.contains(&param.value.text.as_str()) {
                    colors.push(&param.value.text);
                }
            }
        }
        let mut numbers: Vec<usize> = (1..=own.len()).collect();
        sampler.shuffle(&mut numbers);
        let names = own.iter().zip(numbers).map(|(name, number)| ((*name).to_owned(), format!("t{number}")));
        let mut shuffled = colors.clone();
        sampler.shuffle(&mut shuffled);
        let colors = colors.iter().zip(shuffled).map(|(from, to)| ((*from).to_owned(), to.to_owned()));
        // What the engine maps by itself gets a character too, if the game does not say otherwise.
        let known = ['w', 'A'].into_iter();
        let mut used: Vec<char> = description.mapping.iter().map(|line| line.symbol).collect();
        used.extend(known.filter(|&symbol| builtin(symbol, description).is_some()));
        let mut pool: Vec<char> = SYMBOLS.chars().collect();
        sampler.shuffle(&mut pool);
        // A game with more characters than the pool keeps the last ones.
        let symbols = used.iter().enumerate().map(|(at, &symbol)| (symbol, *pool.get(at).unwrap_or(&symbol)));
        Mask { names: names.collect(), symbols: symbols.collect(), colors: colors.collect() }
    }

    fn sprites(&self, lines: &mut [SpriteLine]) {
        for line in lines {
            line.trivia = Trivia::default();
            line.params.retain(|param| param.key.text != "img");
            for param in line.params.iter_mut().filter(|param| param.key.text == "color") {
                if let Some(color) = self.colors.get(&param.value.text) {
                    param.value.text.clone_from(color);
                }
            }
            self.sprites(&mut line.children);
        }
    }

    fn mapping(&self, lines: &mut Vec<MappingLine>) {
        let mapped: Vec<char> = lines.iter().map(|line| line.symbol).collect();
        for line in lines.iter_mut() {
            line.trivia = Trivia::default();
            line.symbol = self.symbols[&line.symbol];
        }
        for (&symbol, &masked) in self.symbols.iter().filter(|(symbol, _)| !mapped.contains(symbol)) {
            let name = if symbol == 'w' { "wall" } else { "avatar" };
            lines.push(MappingLine { symbol: masked, names: vec![name.into()], ..MappingLine::default() });
        }
        // In the order of their characters, which is not that of their parts.
        lines.sort_by_key(|line| line.symbol);
    }
}

/// What a character stands for in this game though it has no line.
fn builtin(symbol: char, description: &Description) -> Option<&'static str> {
    let name = if symbol == 'w' { "wall" } else { "avatar" };
    let declared = description.sprite_lines().iter().any(|(_, line)| line.name.text == name);
    let mapped = description.mapping.iter().any(|line| line.symbol == symbol);
    (declared && !mapped).then_some(name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Generator;
    use crate::games::ConstructiveGames;
    use crate::levels::{ConstructiveLevels, LevelConfig};
    use engine::{Game, syntax};
    use std::fs;
    use std::path::Path;

    fn seed() -> Seed {
        Seed::from_text("masks")
    }

    /// The same hashes and outcomes under the same actions.
    fn plays_alike(name: &str, source: &Description, levels: &[String]) {
        let masked = Masked::of(source, seed().child(name, 0));
        assert_eq!(masked, Masked::of(source, seed().child(name, 0)));
        let game = Game::compile(source).unwrap();
        let text = syntax::print(masked.description());
        let twin = Game::from_source(&text).unwrap_or_else(|problems| panic!("{name}: {problems}\n{text}"));
        for (number, level) in levels.iter().enumerate() {
            let seed = seed().child("level", number as u64);
            let own = game.level(level).unwrap_or_else(|problems| panic!("{name}: {problems}"));
            let other =
                twin.level(&masked.level(level)).unwrap_or_else(|problems| panic!("{name}: {problems}"));
            let (mut one, mut two) = (game.start(&own, seed), twin.start(&other, seed));
            let mut sampler = seed.sampler();
            for _ in 0..150 {
                assert_eq!(one.state_hash(), two.state_hash(), "{name}");
                assert_eq!(game.actions(&one), twin.actions(&two), "{name}");
                let action = *sampler.choose(game.actions(&one));
                assert_eq!(game.step(&mut one, action), twin.step(&mut two, action), "{name}");
                assert_eq!(one.score(), two.score(), "{name}");
            }
        }
        for (_, line) in source.sprite_lines() {
            let word = line.name.text.as_str();
            let kept = RESERVED.contains(&word)
                || text.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').all(|w| w != word);
            assert!(kept || word.len() < 3, "{name}: {word} is told\n{text}");
        }
        assert!(!text.contains('#') && !text.contains("img="), "{name}\n{text}");
    }

    #[test]
    fn masked_games_play_alike() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../corpora");
        let mut seen = 0;
        for entry in fs::read_dir(folder).unwrap().flatten() {
            let Ok(source) = fs::read_to_string(entry.path().join("game.vgdl")) else { continue };
            let level = |at: u32| fs::read_to_string(entry.path().join(format!("lvl{at}.txt"))).ok();
            let levels: Vec<String> = (0..5).filter_map(level).collect();
            plays_alike(&entry.file_name().to_string_lossy(), &syntax::parse(&source).0, &levels);
            seen += 1;
        }
        assert!(seen >= 20, "{seen} games");
    }

    #[test]
    fn masked_generated_games_play_alike() {
        for number in 0..40 {
            let made = ConstructiveGames::default().generate(seed().child("game", number)).unwrap();
            let game = Game::compile(&made.description).unwrap();
            let levels = ConstructiveLevels::new(&game, LevelConfig::default()).unwrap();
            let level = levels.generate(seed().child("level", number)).map(|level| vec![level.to_string()]);
            plays_alike(&made.title, &made.description, &level.unwrap_or_default());
        }
    }
}
