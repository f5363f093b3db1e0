//! Small damage to files, similar to careless editing, disk errors and fuzzing.

use base::Sampler;
use engine::{EFFECTS, SPRITE_PARAMETERS, SpriteClass, TERMINATIONS};

/// Returns `bytes` with some damage.
pub fn mutated(bytes: &[u8], sampler: &mut Sampler) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..sampler.between(1, 4) {
        damage(&mut bytes, sampler);
    }
    bytes
}

/// Bytes and words that have a special meaning in some context.
const TOKENS: [&str; 24] = [
    "\n",
    "\r\n",
    "\t",
    " ",
    "#",
    "=",
    " > ",
    ">",
    "\0",
    "\u{feff}",
    "é",
    "\u{85}",
    "avatar",
    "wall",
    "EOS",
    "TIME",
    "SpriteSet",
    "InteractionSet",
    "stype=avatar",
    "1e999",
    "-2147483648",
    "NaN",
    "99999999999999999999",
    "timer=0",
];

fn damage(bytes: &mut Vec<u8>, sampler: &mut Sampler) {
    let start = sampler.below(bytes.len() + 1);
    let end = (start + sampler.between(1, 24)).min(bytes.len());
    match sampler.below(7) {
        // Remove, duplicate, copy or truncate.
        0 => drop(bytes.drain(start..end)),
        1 => {
            let piece = bytes[start..end].to_vec();
            bytes.splice(start..start, piece);
        }
        2 => {
            let piece = bytes[start..end].to_vec();
            let to = sampler.below(bytes.len() + 1);
            bytes.splice(to..to, piece);
        }
        3 => bytes.truncate(start),
        4 => bytes.iter_mut().skip(start).take(1).for_each(|byte| *byte ^= 1 << sampler.below(8)),
        5 => {
            let token = *sampler.choose(&TOKENS);
            bytes.splice(start..start, token.bytes());
        }
        _ => {
            let word = word(sampler);
            bytes.splice(start..end, word.bytes());
        }
    }
}

/// Returns a VGDL keyword.
fn word(sampler: &mut Sampler) -> &'static str {
    let words = match sampler.below(4) {
        0 => return sampler.choose(SpriteClass::ALL).name(),
        1 => EFFECTS,
        2 => SPRITE_PARAMETERS,
        _ => TERMINATIONS,
    };
    words[sampler.below(words.len())]
}
