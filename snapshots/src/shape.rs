//! The rules of a game with the fiction taken away: two games of one shape differ in names, symbols and colours only.

use engine::Digest;
use engine::syntax::{self, Description, SpriteLine, Word};
use std::collections::BTreeMap;

/// The digest of the canonical print with sprites named by their order and level characters by theirs.
///
/// Interactions keep their order, which the engine's semantics depend on.
pub fn shape(description: &Description) -> Digest {
    let mut tree = description.clone();
    let names: BTreeMap<String, String> = tree
        .sprite_lines()
        .into_iter()
        .enumerate()
        .map(|(at, (_, line))| (line.name.text.clone(), format!("t{at}")))
        .collect();
    rename_sprites(&mut tree.sprites, &names);
    for (at, line) in tree.mapping.iter_mut().enumerate() {
        line.symbol = char::from_u32('0' as u32 + at as u32).unwrap_or('~');
        line.names.iter_mut().for_each(|name| rename(name, &names));
    }
    for line in &mut tree.interactions {
        rename(&mut line.first, &names);
        line.second.iter_mut().for_each(|name| rename(name, &names));
        line.params.iter_mut().for_each(|param| rename(&mut param.value, &names));
    }
    for line in &mut tree.terminations {
        line.params.iter_mut().for_each(|param| rename(&mut param.value, &names));
    }
    Digest::of(syntax::print_bare(&tree).as_bytes())
}

fn rename_sprites(lines: &mut [SpriteLine], names: &BTreeMap<String, String>) {
    for line in lines {
        rename(&mut line.name, names);
        line.params.retain(|param| !["color", "img"].contains(&param.key.text.as_str()));
        line.params.iter_mut().for_each(|param| rename(&mut param.value, names));
        rename_sprites(&mut line.children, names);
    }
}

/// Each name of a comma list.
fn rename(word: &mut Word, names: &BTreeMap<String, String>) {
    let parts = word.text.split(',').map(|part| names.get(part).map_or(part, String::as_str));
    word.text = parts.collect::<Vec<_>>().join(",");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fiction_does_not_matter_and_rules_do() {
        let source = "BasicGame\n  SpriteSet\n    fox > Chaser stype=hen color=RED\n    hen > RandomNPC\n  LevelMapping\n    f > fox\n  InteractionSet\n    hen fox > killSprite scoreChange=1\n  TerminationSet\n    Timeout limit=5 win=True\n";
        let of = |text: &str| shape(&syntax::parse(text).0);
        let renamed =
            source.replace("fox", "eel").replace("hen", "prawn").replace("RED", "BLUE").replace("f >", "e >");
        assert_eq!(of(source), of(&renamed));
        assert_ne!(of(source), of(&source.replace("scoreChange=1", "scoreChange=2")));
    }
}
