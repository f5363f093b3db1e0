//! The canary: a GUID in every file of a release whose format allows it. Searching a corpus for the canary shows
//! whether the corpus contains the release.

use base::Digest;

/// The key derivation context. It belongs to format 1, because changing it changes every canary.
const CONTEXT: &str = "infinite-arcade 1 canary";

/// Derives the canary of a sealed release from its commitment, or of an open release from its recipe's digest.
///
/// The canary is the first 16 bytes of BLAKE3's `derive_key(CONTEXT, of)` as an RFC 9562 version 8 GUID in
/// lower case. It reveals nothing about the content behind `of`.
pub fn canary(of: &Digest) -> String {
    let key = blake3::derive_key(CONTEXT, of.as_bytes());
    let mut text = String::with_capacity(36);
    for (index, byte) in key.iter().take(16).enumerate() {
        let byte = match index {
            6 => (byte & 0x0f) | 0x80, // version 8: "custom"
            8 => (byte & 0x3f) | 0x80, // variant 10
            _ => *byte,
        };
        if matches!(index, 4 | 6 | 8 | 10) {
            text.push('-');
        }
        text.push_str(&format!("{byte:02x}"));
    }
    text
}

/// Returns `true` if `text` has the form of a canary: 8-4-4-4-12 lower-case hexadecimal digits, version 8, variant
/// 10.
pub(crate) fn is_canary(text: &str) -> bool {
    text.len() == 36
        && text.bytes().enumerate().all(|(index, byte)| match index {
            8 | 13 | 18 | 23 => byte == b'-',
            14 => byte == b'8',
            19 => matches!(byte, b'8' | b'9' | b'a' | b'b'),
            _ => matches!(byte, b'0'..=b'9' | b'a'..=b'f'),
        })
}

/// Returns `true` if a file contains the release's canary.
pub(crate) fn carries(content: &[u8], canary: &str) -> bool {
    content.windows(canary.len()).any(|part| part == canary.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn golden() {
        assert_eq!(canary(&Digest::of(b"")), "e6d74e49-32e1-8210-bc00-6474ab88bb3b");
        assert_eq!(canary(&Digest::of(b"abc")), "9a0da525-e9c2-88c7-822e-6e5a8852ecfb");
    }

    #[test]
    fn shape() {
        for seed in 0..200_u8 {
            let text = canary(&Digest::of(&[seed]));
            assert!(is_canary(&text), "{text}");
        }
    }

    #[test]
    fn other_texts_are_not_canaries() {
        let good = canary(&Digest::of(b""));
        for bad in [
            String::new(),
            good.to_uppercase(),
            good.replace('-', ""),
            format!("{{{good}}}"),
            format!("{}4{}", &good[..14], &good[15..]),
            format!("{}c{}", &good[..19], &good[20..]),
            format!("{}\u{e9}", &good[..34]),
        ] {
            assert!(!is_canary(&bad), "{bad}");
        }
    }
}
