//! A Merkle tree over a release's files, which makes it possible to prove one file without the others.
//!
//! The shape follows RFC 6962 §2.1: a tree of n leaves splits at the largest power of two below n. The hash is
//! BLAKE3. Leaves and nodes are domain-separated, so that neither can pass for the other:
//!
//! ```text
//! leaf  = BLAKE3(0x00 ‖ length of path: u64, little-endian ‖ path ‖ digest)
//! node  = BLAKE3(0x01 ‖ left ‖ right)
//! empty = BLAKE3("")
//! ```
//!
//! Leaves are ordered by the bytes of their paths. Format 1 fixes this layout.
//!
//! A proof shows that a leaf, including its path, is in the tree. As in RFC 6962, a proof does not bind the *number*
//! of leaves. `size` only determines the shape to follow, and a different size can describe the same path to the
//! root.

use itertools::Itertools;
use serde::{Deserialize, Serialize};

use base::Digest;

/// A file in the tree.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Leaf {
    /// The relative path, `/`-separated. The tree hashes the path's bytes without checking the path (see
    /// [`check_path`](crate::check_path)).
    pub path: String,
    /// The digest of the file's content.
    pub digest: Digest,
}

/// The error for two leaves with the same path, which would make the tree ambiguous.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("`{}` is listed twice: list each file once", path.escape_debug())]
pub struct DuplicatePath {
    /// The first duplicate path in byte order.
    pub path: String,
}

/// Computes the root over `leaves`, which may be in any order. Cost: O(n log n).
///
/// # Errors
/// Returns an error if two leaves have the same path.
pub fn root(leaves: &[Leaf]) -> Result<Digest, DuplicatePath> {
    let hashes: Vec<Digest> = sorted(leaves)?.into_iter().map(leaf_hash).collect();
    Ok(subtree_root(&hashes))
}

/// Returns the proof for the leaf at `path` in the tree over `leaves`, which may be in any order. Cost: O(n log n).
///
/// Returns `None` if no leaf has that path, or if any two leaves have the same path, in which case no tree
/// exists.
pub fn prove(leaves: &[Leaf], path: &str) -> Option<Proof> {
    let leaves = sorted(leaves).ok()?;
    let index = leaves.binary_search_by(|leaf| leaf.path.as_str().cmp(path)).ok()?;
    let hashes: Vec<Digest> = leaves.into_iter().map(leaf_hash).collect();
    let mut siblings = Vec::new();
    collect_siblings(&hashes, index, &mut siblings);
    Some(Proof { index: index as u64, size: hashes.len() as u64, siblings })
}

/// The hashes on the path from a leaf to the root: the audit path of RFC 6962 §2.1.1.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Proof {
    /// The leaf's index among the sorted leaves, from 0.
    pub index: u64,
    /// The number of leaves in the tree.
    pub size: u64,
    /// The roots of the sibling subtrees, starting with the leaf's sibling and ending with a child of the root.
    pub siblings: Vec<Digest>,
}

impl Proof {
    /// Returns `true` if `leaf` is in the tree with the given root, and `false` if it is not or the proof is
    /// malformed. Cost: at most 64 hashes.
    pub fn verify(&self, leaf: &Leaf, root: &Digest) -> bool {
        if self.index >= self.size {
            return false;
        }
        // RFC 9162 §2.1.3.2: the bits of `position` state on which side each sibling is. `last` is the position of
        // the rightmost node on the same level, which has no sibling if the tree is ragged.
        let (mut position, mut last) = (self.index, self.size - 1);
        let mut hash = leaf_hash(leaf);
        for sibling in &self.siblings {
            if last == 0 {
                return false;
            }
            if position % 2 == 1 || position == last {
                hash = node_hash(sibling, &hash);
                while position % 2 == 0 && position != 0 {
                    position /= 2;
                    last /= 2;
                }
            } else {
                hash = node_hash(&hash, sibling);
            }
            position /= 2;
            last /= 2;
        }
        last == 0 && hash == *root
    }
}

fn sorted(leaves: &[Leaf]) -> Result<Vec<&Leaf>, DuplicatePath> {
    let sorted = leaves.iter().sorted_unstable_by_key(|leaf| &leaf.path).collect_vec();
    match sorted.windows(2).find(|pair| pair[0].path == pair[1].path) {
        Some(pair) => Err(DuplicatePath { path: pair[0].path.clone() }),
        None => Ok(sorted),
    }
}

fn leaf_hash(leaf: &Leaf) -> Digest {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&[0x00]);
    hasher.update(&(leaf.path.len() as u64).to_le_bytes());
    hasher.update(leaf.path.as_bytes());
    hasher.update(leaf.digest.as_bytes());
    Digest::from_bytes(*hasher.finalize().as_bytes())
}

fn node_hash(left: &Digest, right: &Digest) -> Digest {
    let mut hasher = blake3::Hasher::new();
    hasher.update(&[0x01]);
    hasher.update(left.as_bytes());
    hasher.update(right.as_bytes());
    Digest::from_bytes(*hasher.finalize().as_bytes())
}

/// Computes the root of a subtree. The recursion depth is the logarithm of the number of leaves.
fn subtree_root(hashes: &[Digest]) -> Digest {
    match hashes {
        [] => Digest::of(b""),
        [leaf] => *leaf,
        _ => {
            let (left, right) = hashes.split_at(split(hashes.len()));
            node_hash(&subtree_root(left), &subtree_root(right))
        }
    }
}

fn collect_siblings(hashes: &[Digest], index: usize, siblings: &mut Vec<Digest>) {
    if hashes.len() < 2 {
        return;
    }
    let (left, right) = hashes.split_at(split(hashes.len()));
    if index < left.len() {
        collect_siblings(left, index, siblings);
        siblings.push(subtree_root(right));
    } else {
        collect_siblings(right, index - left.len(), siblings);
        siblings.push(subtree_root(left));
    }
}

/// Returns the largest power of two smaller than `count`, which must be at least 2.
fn split(count: usize) -> usize {
    count.next_power_of_two() / 2
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaves(count: usize) -> Vec<Leaf> {
        (0..count)
            .map(|n| Leaf { path: format!("f{n}"), digest: Digest::of(format!("content {n}").as_bytes()) })
            .collect()
    }

    fn flip(digest: &Digest, bit: usize) -> Digest {
        let mut bytes = *digest.as_bytes();
        bytes[bit / 8 % 32] ^= 1 << (bit % 8);
        Digest::from_bytes(bytes)
    }

    /// The roots were computed from the module's formulas by an independent implementation (Python, with
    /// BLAKE3 according to its paper).
    #[test]
    fn golden_roots() {
        for (count, expected) in [
            (0, "af1349b9f5f9a1a6a0404dea36dcc9499bcb25c9adc112b7cc9a93cae41f3262"),
            (1, "6941371421659101048150cecbb8289d04a6b90aef676c43c062e0eacc94ae80"),
            (2, "cc6ae0f2505d042baf3ba341341a7785c946f908118574747a956dda9edb98c0"),
            (3, "4f3f9c85697d010b0b86816c250fc5bd6aaf905da103829fe534ff69f6bc5897"),
            (7, "b4128f86ceeb7499b9000250309acfbf9b1de55d52e8a08a1351bedc07517052"),
            (8, "62c2ba21c02a3a41519e46a79d7da97c36c31a2c59c71a5bb311e3f67e50860f"),
            (13, "90eb3580f6f8d24648f7418c638217a557c6de698000e2421998269397bfb79b"),
        ] {
            assert_eq!(root(&leaves(count)).expect("distinct").to_string(), expected, "{count} leaves");
        }
    }

    #[test]
    fn split_is_the_largest_smaller_power_of_two() {
        let splits: Vec<usize> = (2..=9).map(split).collect();
        assert_eq!(splits, [1, 2, 2, 4, 4, 4, 4, 8]);
    }

    #[test]
    fn order_does_not_matter_and_duplicates_are_refused() {
        let forward = leaves(13);
        let mut backward = forward.clone();
        backward.reverse();
        assert_eq!(root(&forward), root(&backward));
        assert_eq!(prove(&forward, "f3"), prove(&backward, "f3"));
        backward.push(Leaf { path: "f3".into(), digest: Digest::of(b"other") });
        assert_eq!(root(&backward), Err(DuplicatePath { path: "f3".into() }));
        assert_eq!(prove(&backward, "f1"), None);
        assert_eq!(prove(&forward, "f99"), None);
        assert_eq!(prove(&[], "f0"), None);
    }

    /// Moving a byte between a path and the adjacent field, or passing off a node as a leaf, must not result in the
    /// same hash.
    #[test]
    fn leaves_are_unambiguous() {
        let digest = Digest::of(b"x");
        let one = |path: &str| root(&[Leaf { path: path.into(), digest }]).expect("one leaf");
        assert_ne!(one("a"), one("a\0"));
        assert_ne!(one(""), one("\0"));
        let two = leaves(2);
        assert_ne!(root(&two), root(&two[..1]));
        assert_ne!(root(&[]), Ok(one("")));
    }

    #[test]
    fn every_leaf_is_proved_and_every_alteration_fails() {
        for count in 0..=33 {
            let leaves = leaves(count);
            let root = root(&leaves).expect("distinct");
            for (n, leaf) in leaves.iter().enumerate() {
                let proof = prove(&leaves, &leaf.path).expect("present");
                assert!(proof.verify(leaf, &root), "{n} of {count}");
                assert_eq!(proof.size, count as u64);

                assert!(!proof.verify(leaf, &flip(&root, n)));
                assert!(!proof.verify(&Leaf { digest: flip(&leaf.digest, n), ..leaf.clone() }, &root));
                assert!(!proof.verify(&Leaf { path: format!("{}x", leaf.path), ..leaf.clone() }, &root));
                for other in leaves.iter().filter(|other| *other != leaf) {
                    assert!(!proof.verify(other, &root));
                }
                for index in (0..70).chain([u64::MAX]).filter(|index| *index != proof.index) {
                    assert!(!Proof { index, ..proof.clone() }.verify(leaf, &root), "{n} as {index}");
                }
                for (k, sibling) in proof.siblings.iter().enumerate() {
                    let mut altered = proof.clone();
                    altered.siblings[k] = flip(sibling, 7 * n + k);
                    assert!(!altered.verify(leaf, &root));
                    let mut shorter = proof.clone();
                    shorter.siblings.remove(k);
                    assert!(!shorter.verify(leaf, &root));
                }
                for k in 0..=proof.siblings.len() {
                    let mut longer = proof.clone();
                    longer.siblings.insert(k, root);
                    assert!(!longer.verify(leaf, &root));
                }
                assert!(!Proof { size: 0, ..proof.clone() }.verify(leaf, &root));
                assert!(!Proof { size: proof.index, ..proof }.verify(leaf, &root));
            }
        }
    }

    /// The rightmost leaf is rightmost in a tree of any size, so the siblings must be used up exactly at the
    /// stated size.
    #[test]
    fn a_size_that_ends_too_early_fails() {
        let leaves = leaves(8);
        let root = root(&leaves).expect("distinct");
        let siblings = prove(&leaves, "f7").expect("present").siblings;
        for size in 1..=4 {
            let proof = Proof { index: size - 1, size, siblings: siblings.clone() };
            assert!(!proof.verify(&leaves[7], &root), "size {size}");
        }
    }

    #[test]
    fn proofs_serialise() {
        let proof = prove(&leaves(5), "f4").expect("present");
        let json = serde_json::to_string(&proof).expect("plain data");
        assert_eq!(serde_json::from_str::<Proof>(&json).expect("what was written"), proof);
        assert!(json.starts_with(r#"{"index":4,"size":5,"siblings":[""#), "{json}");
        assert!(serde_json::from_str::<Proof>(r#"{"index":0,"size":1,"siblings":[],"more":1}"#).is_err());
    }
}
