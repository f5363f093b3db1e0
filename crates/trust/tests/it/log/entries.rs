//! Attacks on the entries of a log.

use super::*;

fn bytes_of(hex: &str) -> Vec<u8> {
    (0..hex.len()).step_by(2).map(|at| u8::from_str_radix(&hex[at..at + 2], 16).unwrap()).collect()
}

fn at(entries: &[Entry], is_it: impl Fn(&Entry) -> bool) -> Vec<usize> {
    (0..entries.len()).filter(|at| is_it(&entries[*at])).collect()
}

fn one_of(places: &[usize], chance: &mut Sampler) -> usize {
    places[chance.below(places.len())]
}

#[test]
fn equivocation_is_told() {
    let entries = year();
    let roots = at(&entries, |entry| matches!(entry, Entry::Root { .. }));
    for number in 0..mutations() {
        let mut chance = chance("equivocation", number);
        let place = one_of(&roots, &mut chance);
        let mut second = entries[place].clone();
        if let Entry::Root { root, .. } = &mut second {
            *root = any_digest(&mut chance);
        }
        let mut forged = entries.clone();
        forged.insert(place + 1 + chance.below(entries.len() - place), second);
        broken(&forged, "a second root for");
    }
}

#[test]
fn swapped_beacons_are_told() {
    let entries = year();
    let [commitments, beacons, roots] = [
        at(&entries, |entry| matches!(entry, Entry::Commitment { .. })),
        at(&entries, |entry| matches!(entry, Entry::Beacon { .. })),
        at(&entries, |entry| matches!(entry, Entry::Root { .. })),
    ];
    for number in 0..mutations() {
        let mut chance = chance("beacon", number);
        let mut forged = entries.clone();
        let words = match number % 8 {
            0 => {
                // The release was minted with a different value.
                if let Entry::Root { beacon, .. } = &mut forged[one_of(&roots, &mut chance)] {
                    *beacon = Some(any_digest(&mut chance));
                }
                "was minted with a value other than that of round"
            }
            1 => {
                // The release was minted without a value.
                if let Entry::Root { beacon, .. } = &mut forged[one_of(&roots, &mut chance)] {
                    *beacon = None;
                }
                "was minted with a value other than that of round"
            }
            2 => {
                // The value was known before the commitment.
                let place = one_of(&commitments, &mut chance);
                forged.swap(place, place + 1);
                "which was known before it"
            }
            3 => {
                // The round has a second value, which suits the publisher better.
                let place = one_of(&beacons, &mut chance);
                let mut second = forged[place].clone();
                if let Entry::Beacon { value, .. } = &mut second {
                    *value = any_digest(&mut chance);
                }
                forged.insert(place + 1, second);
                "has two values"
            }
            4 => {
                // The value is made up, and so is the release.
                let place = one_of(&beacons, &mut chance);
                let made_up = any_digest(&mut chance);
                if let Entry::Beacon { value, proof, .. } = &mut forged[place] {
                    *value = made_up;
                    if chance.below(2) == 0 {
                        *proof = None;
                    }
                }
                if let Entry::Root { beacon, .. } = &mut forged[place + 1] {
                    *beacon = Some(made_up);
                }
                "the value of round"
            }
            5 => {
                // The signature is altered, and the value is its hash.
                let place = one_of(&beacons, &mut chance);
                let mut made_up = None;
                if let Entry::Beacon { value, proof: Some(proof), .. } = &mut forged[place] {
                    let mut signature = bytes_of(&proof.signature);
                    let at = chance.below(signature.len());
                    signature[at] ^= 1 << chance.below(8);
                    proof.signature = hex(&signature);
                    let hash: [u8; 32] = Sha256::digest(&signature).into();
                    *value = Digest::from_bytes(hash);
                    made_up = Some(*value);
                }
                if let Entry::Root { beacon, .. } = &mut forged[place + 1] {
                    *beacon = made_up;
                }
                "its `signature` does not belong to round"
            }
            6 => {
                // The value belongs to a different round of the network, which suits the publisher better.
                let place = one_of(&beacons, &mut chance);
                let other = Network::new().round(100_000 + chance.below(1_000_000) as u64);
                if let Entry::Beacon { value, proof, .. } = &mut forged[place] {
                    (*value, *proof) = (other.value, other.proof);
                }
                if let Entry::Root { beacon, .. } = &mut forged[place + 1] {
                    *beacon = Some(other.value);
                }
                "its `signature` does not belong to round"
            }
            _ => {
                // The value was never published.
                forged.remove(one_of(&beacons, &mut chance));
                "whose value is not in the log"
            }
        };
        broken(&forged, words);
    }
}

#[test]
fn choosing_among_a_hundred_secrets_is_told() {
    let entries = year();
    let commitments = at(&entries, |entry| matches!(entry, Entry::Commitment { .. }));
    for number in 0..mutations() {
        let mut chance = chance("secrets", number);
        let place = one_of(&commitments, &mut chance);
        let Entry::Commitment { release, beacon, parent, .. } = entries[place].clone() else {
            panic!("chosen")
        };
        let mut forged = entries.clone();
        match number % 3 {
            // A hundred commitments under one name.
            0 => {
                for _ in 0..99 {
                    let (commitment, recipe) = (any_digest(&mut chance), any_digest(&mut chance));
                    let (release, beacon) = (release.clone(), beacon.clone());
                    forged
                        .insert(place + 1, Entry::Commitment { release, commitment, recipe, parent, beacon });
                }
                broken(&forged, "and a publisher may commit only once");
            }
            // A hundred names share one round, and the publisher keeps the name with the best result.
            1 => {
                for other in 0..99 {
                    let (commitment, recipe) = (any_digest(&mut chance), any_digest(&mut chance));
                    let (release, beacon) = (format!("{release}-{other}"), beacon.clone());
                    forged
                        .insert(place + 1, Entry::Commitment { release, commitment, recipe, parent, beacon });
                }
                broken(&forged, "as another commitment does, so the publisher could choose");
                assert_eq!(unkept(&forged).len(), 99);
            }
            // The secret is chosen after the fact.
            _ => {
                if let Some(Entry::Reveal(revealed)) = forged.get_mut(place + 3) {
                    revealed.seed = format!("better {number}");
                }
                broken(&forged, "does not match the commitment");
            }
        }
    }
}

/// Checks that every improved number in a result row is reported if the logs give different numbers.
#[test]
fn altered_rows_are_told() {
    let entries = year();
    let row = entries.iter().find_map(|entry| match entry {
        Entry::Result(row) => Some(row.clone()),
        _ => None,
    });
    let honest = row.unwrap();
    assert_eq!(honest.differences(&honest), [""; 0]);
    // The last bits of a logarithm may differ between machines.
    let rounded = ResultRow { interval: (honest.interval.0 + 1e-13, honest.interval.1), ..honest.clone() };
    assert_eq!(honest.differences(&rounded), [""; 0]);
    for number in 0..mutations() {
        let mut chance = chance("rows", number);
        let mut better = honest.clone();
        let by = 1 + chance.below(100);
        let share = by as f64 / 1000.0;
        let key = match number % 10 {
            0 => (better.wins += by as u64, "`wins`").1,
            1 => (better.episodes -= by as u64, "`episodes`").1,
            2 => (better.rate += share, "`rate`").1,
            3 => (better.interval.0 += share, "`interval.low`").1,
            4 => (better.interval.1 += share, "`interval.high`").1,
            5 => (better.score = Some(3.5 + share), "`score`").1,
            6 => (better.score = None, "`score`").1,
            7 => (better.player = format!("mcts:{by}1"), "`player`").1,
            8 => (better.horizon = format!("{by}0"), "`horizon`").1,
            _ => (better.track = None, "`track`").1,
        };
        let found = better.differences(&honest);
        assert!(found.len() == 1 && found[0].starts_with(key), "{key}: {found:?}");
    }
}
