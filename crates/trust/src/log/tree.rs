//! A log's Merkle tree, as specified in RFC 6962, with SHA-256.
//!
//! A release's tree has the same shape, but uses BLAKE3 and includes paths in its leaves. Release trees are
//! implemented in the crate `snapshots`. Neither crate depends on the other, so the implementations share no
//! code.

use sha2::{Digest as _, Sha256};

/// The hash of a tree node.
pub type Hash = [u8; 32];

/// Returns an entry's leaf hash.
pub(super) fn leaf(entry: &[u8]) -> Hash {
    Sha256::new().chain_update([0]).chain_update(entry).finalize().into()
}

fn node(left: &Hash, right: &Hash) -> Hash {
    Sha256::new().chain_update([1]).chain_update(left).chain_update(right).finalize().into()
}

/// Computes the tree's root from the entries' hashes.
pub(super) fn root(leaves: &[Hash]) -> Hash {
    match leaves {
        [] => Sha256::digest([]).into(),
        [leaf] => *leaf,
        _ => {
            let (left, right) = leaves.split_at(split(leaves.len()));
            node(&root(left), &root(right))
        }
    }
}

/// Returns the largest power of two below `count`. `count` must be at least 2.
fn split(count: usize) -> usize {
    count.next_power_of_two() / 2
}

/// Returns the proof that the entry at `index` is in the tree (RFC 6962 §2.1.1). The hashes are ordered from
/// the leaf's sibling upwards. Returns `None` if there is no such entry.
pub(super) fn inclusion(leaves: &[Hash], index: usize) -> Option<Vec<Hash>> {
    if index >= leaves.len() {
        return None;
    }
    let (mut rest, mut index, mut proof) = (leaves, index, Vec::new());
    while rest.len() > 1 {
        let (left, right) = rest.split_at(split(rest.len()));
        if index < left.len() {
            proof.push(root(right));
            rest = left;
        } else {
            proof.push(root(left));
            index -= left.len();
            rest = right;
        }
    }
    proof.reverse();
    Some(proof)
}

/// Returns `true` if an inclusion proof is valid (RFC 9162 §2.1.3.2).
pub(super) fn includes(leaf: &Hash, index: u64, size: u64, proof: &[Hash], expect: &Hash) -> bool {
    if index >= size {
        return false;
    }
    let (mut position, mut last, mut hash) = (index, size - 1, *leaf);
    for sibling in proof {
        if last == 0 {
            return false;
        }
        if position % 2 == 1 || position == last {
            hash = node(sibling, &hash);
            while position.is_multiple_of(2) && position != 0 {
                position /= 2;
                last /= 2;
            }
        } else {
            hash = node(&hash, sibling);
        }
        position /= 2;
        last /= 2;
    }
    last == 0 && hash == *expect
}

/// Returns the proof that this tree extends the tree over the first `old` entries (RFC 6962 §2.1.2). Returns
/// `None` if `old` is 0, or larger than the tree.
pub(super) fn consistency(leaves: &[Hash], old: usize) -> Option<Vec<Hash>> {
    if old == 0 || old > leaves.len() {
        return None;
    }
    let mut proof = Vec::new();
    prove(leaves, old, true, &mut proof);
    Some(proof)
}

fn prove(leaves: &[Hash], old: usize, is_known: bool, proof: &mut Vec<Hash>) {
    if old == leaves.len() {
        if !is_known {
            proof.push(root(leaves));
        }
        return;
    }
    let (left, right) = leaves.split_at(split(leaves.len()));
    if old <= left.len() {
        prove(left, old, is_known, proof);
        proof.push(root(right));
    } else {
        prove(right, old - left.len(), false, proof);
        proof.push(root(left));
    }
}

/// Returns `true` if a consistency proof is valid for two sizes and their roots (RFC 9162 §2.1.4.2).
pub(super) fn extends(old: u64, new: u64, old_root: &Hash, new_root: &Hash, proof: &[Hash]) -> bool {
    if old == 0 || old > new {
        return false;
    }
    if old == new {
        return proof.is_empty() && old_root == new_root;
    }
    let mut path = proof.iter();
    let first = if old.is_power_of_two() { Some(old_root) } else { path.next() };
    let Some(first) = first else { return false };
    let (mut position, mut last) = (old - 1, new - 1);
    while position % 2 == 1 {
        position /= 2;
        last /= 2;
    }
    let (mut of_old, mut of_new) = (*first, *first);
    for sibling in path {
        if last == 0 {
            return false;
        }
        if position % 2 == 1 || position == last {
            of_old = node(sibling, &of_old);
            of_new = node(sibling, &of_new);
            while position.is_multiple_of(2) && position != 0 {
                position /= 2;
                last /= 2;
            }
        } else {
            of_new = node(&of_new, sibling);
        }
        position /= 2;
        last /= 2;
    }
    last == 0 && of_old == *old_root && of_new == *new_root
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leaves(count: usize) -> Vec<Hash> {
        (0..count).map(|n| leaf(format!("entry {n}").as_bytes())).collect()
    }

    fn hex(hash: &Hash) -> String {
        hash.iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// The expected roots come from a Python implementation of the formulas in RFC 6962.
    #[test]
    fn golden_roots() {
        assert_eq!(hex(&root(&[])), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
        for (count, expect) in GOLDEN {
            assert_eq!(hex(&root(&leaves(count))), expect, "{count} entries");
        }
    }

    const GOLDEN: [(usize, &str); 4] = [
        (1, "773885a613489e24ce2cf76199d6a423f042e4bbf12d7eecee912ef276c65701"),
        (2, "5a47662fd8a317d96049a3f9f47c55dc67ca66051baa3683dbb19b2fe09a07b0"),
        (7, "98c97f0ba3175cd08b031dd084b9dc4e649b64d1a28e6ea694646503173ab587"),
        (269, "328d61b4784044b1d4d2daae5598d88a202ceea67599e1f7b051c7cb28f90df2"),
    ];

    /// Each proof is valid only for its own claim.
    #[test]
    fn proofs_hold_for_their_own_question() {
        for size in 1..=17_usize {
            let all = leaves(size);
            let top = root(&all);
            for index in 0..size {
                let proof = inclusion(&all, index).expect("inside");
                assert!(includes(&all[index], index as u64, size as u64, &proof, &top));
                assert!(!includes(&all[index], index as u64 + 1, size as u64, &proof, &top));
                assert!(!includes(&leaf(b"other"), index as u64, size as u64, &proof, &top));
                let longer: Vec<Hash> = proof.iter().copied().chain([top]).collect();
                assert!(!includes(&all[index], index as u64, size as u64, &longer, &top));
            }
            assert_eq!(inclusion(&all, size), None);
            for old in 1..=size {
                let before = root(&all[..old]);
                let proof = consistency(&all, old).expect("inside");
                assert!(extends(old as u64, size as u64, &before, &top, &proof), "{old} of {size}");
                let other = leaf(b"other");
                assert!(!extends(old as u64, size as u64, &other, &top, &proof));
                assert!(!extends(old as u64, size as u64, &before, &other, &proof));
                for at in 0..proof.len() {
                    let mut altered = proof.clone();
                    altered[at][0] ^= 1;
                    assert!(!extends(old as u64, size as u64, &before, &top, &altered));
                    assert!(!extends(old as u64, size as u64, &before, &top, &proof[..at]));
                }
            }
            assert_eq!((consistency(&all, 0), consistency(&all, size + 1)), (None, None));
        }
    }
}
