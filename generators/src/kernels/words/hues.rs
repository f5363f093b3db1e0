//! The natural colours of objects.

/// Colours, each with the nouns whose objects naturally have it. A noun is listed by its last word, or in full if it
/// differs from other nouns with the same last word.
const NATURAL: &[(&str, &str)] = &[
    (
        "BROWN",
        "acorn barrel basket bear beaver boar box bridge buffalo bull cart cask chest chestnut coffin \
         crate dam dormouse drawer fence footbridge furrow gangplank gorilla hammer hare hatch hazelnut \
         hedgehog horse keg log loaf lynx monkey moth mud otter owl plank pony potato root rowboat soil \
         sparrow stoat trapdoor trunk turnstile walrus wardrobe weasel wheelbarrow wood",
    ),
    (
        "GRAY",
        "anvil ash badger boulder cannonball donkey drain elephant gargoyle grate grating grille heron \
         hippo mole mouse pebble pigeon portcullis raccoon railing rat ratling rhino seal shark shrew \
         slate stone vole wire wolf",
    ),
    (
        "LIGHTGRAY",
        "armour breastplate fog gull helmet herring knife knight mackerel mask needle ram salmon sardine \
         shield silverfish smoke spoon sprat statue steam tin trout",
    ),
    ("DARKGRAY", "ape cannon coal crow jackdaw magpie raven soot spider starling"),
    (
        "WHITE",
        "aunt bone chalk egg ewe gander ghost goat goose icicle kid lamb letter milk note parcel pearl \
         polarBear salt sheet skeleton snow snowball snowdrift snowman sugar swan teacup teapot",
    ),
    (
        "ORANGE",
        "brazier carrot cheetah ember fire fox goldfish mango marigold orange pumpkin spark tiger vixen",
    ),
    ("LIGHTORANGE", "biscuit bread camel cookie jackal lion matchbox puma rope sack"),
    ("YELLOW", "banana bee canary cheese chick duckling hornet lemon straw sunflower wasp"),
    ("LIGHTYELLOW", "bean butter candle cream grain hay match oat paper sand wheat"),
    ("GOLD", "bell crown goblet gong honey key trumpet"),
    (
        "RED",
        "apple blaze brick cherry crab dynamite firecracker ladybird lobster macaroon poppy rocket rose \
         scorpion strawberry tomato",
    ),
    ("PINK", "flamingo ham orchid pig piglet sausage sow steak worm"),
    (
        "GREEN",
        "adder bramble bush cabbage cress crocodile cucumber frog gecko grass ivy leek lizard marrow \
         melon newt parrot pea sapling seedling shoot snake sprout toad tortoise turtle vine viper",
    ),
    ("DARKGREEN", "bottle dragon fern hedge kelp moss pine thicket troll"),
    ("BLUE", "drop kingfisher lake peacock pond pool puddle raindrop river tide water"),
    ("DARKBLUE", "eel ink moat moray shadow whale"),
    ("LIGHTBLUE", "crystal glass ice mirror pane window"),
];

/// For each colour, similar colours that can replace it if it is taken.
const NEAR: &[(&str, &[&str])] = &[
    ("BROWN", &["LIGHTORANGE", "ORANGE"]),
    ("DARKGRAY", &["BLACK", "GRAY"]),
    ("DARKGREEN", &["GREEN", "LIGHTGREEN"]),
    ("GRAY", &["LIGHTGRAY", "DARKGRAY"]),
    ("GREEN", &["DARKGREEN", "LIGHTGREEN"]),
    ("LIGHTGRAY", &["WHITE", "GRAY"]),
    ("RED", &["LIGHTRED"]),
    ("WHITE", &["LIGHTGRAY"]),
    ("YELLOW", &["LIGHTYELLOW", "GOLD"]),
];

/// Returns an object's natural colours, from most to least suitable. Returns no colours if none are known.
pub(crate) fn natural(noun: &str) -> impl Iterator<Item = &'static str> {
    let best = best(noun);
    let near =
        NEAR.iter().filter(move |(color, _)| Some(*color) == best).flat_map(|(_, near)| near.iter().copied());
    best.into_iter().chain(near)
}

fn best(noun: &str) -> Option<&'static str> {
    let last = noun.rfind(|letter: char| letter.is_ascii_uppercase()).map_or("", |at| &noun[at..]);
    let last = last.to_ascii_lowercase();
    let of = |word: &str| {
        NATURAL
            .iter()
            .find(|(_, nouns)| nouns.split_whitespace().any(|noun| noun == word))
            .map(|(color, _)| *color)
    };
    of(noun).or_else(|| of(&last))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::games::palette::COLORS;

    #[test]
    fn things_have_the_colour_of_the_noun_or_of_its_last_word() {
        let of = ["polarBear", "iceBear", "bear", "duchess"].map(best);
        assert_eq!(of, [Some("WHITE"), Some("BROWN"), Some("BROWN"), None]);
        assert_eq!(natural("rat").collect::<Vec<_>>(), ["GRAY", "LIGHTGRAY", "DARKGRAY"]);
    }

    #[test]
    fn natural_colours_are_colours_of_the_language_and_no_noun_has_two() {
        let mut nouns: Vec<&str> = NATURAL.iter().flat_map(|(_, nouns)| nouns.split_whitespace()).collect();
        assert!(NATURAL.iter().all(|(color, _)| COLORS.contains(color)));
        nouns.sort_unstable();
        let twice: Vec<_> = nouns.windows(2).filter(|pair| pair[0] == pair[1]).collect();
        assert!(twice.is_empty(), "{twice:?}");
    }
}
