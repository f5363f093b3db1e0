//! Tests with real rounds, whose signatures are verified, and with rounds from networks created by the tests.

use super::bls::{ON_G1, ON_G2};
use super::*;
use crate::Drawn;
use blst::{min_pk, min_sig};
use serde_json::{Value, json};

/// Rounds from real networks, in the format served by the networks.
const QUICKNET_123: &str =
    "b75c69d0b72a5d906e854e808ba7e2accb1542ac355ae486d591aa9d43765482e26cd02df835d3546d23c4b13e0dfc92";
const QUICKNET_1000: &str =
    "b44679b9a59af2ec876b1a6b1ad52ea9b1615fc3982b19576350f93447cb1125e342b73a8dd2bacbe47e4b6b63ed5e39";
const DEFAULT_72784: &str = "a609e19a03c2fcc559e8dae14900aaefe517cb55c840f6e69bc8e4f66c8d18e8a609685d9917efbfb0c37f058c2de88f\
    13d297c7e19e0ab24813079efe57a182554ff054c7638153f9b26a60e7111f71a0ff63d9571704905d3ca6df0b031747";
const DEFAULT_72785: &str = "82f5d3d2de4db19d40a6980e8aa37842a0e55d1df06bd68bddc8d60002e8e959eb9cfa368b3c1b77d18f02a54fe047b8\
    0f0989315f83b12a74fd8679c4f12aae86eaf6ab5690b34f1fddd50ee3cc6f6cdf59e95526d5a5d82aaa84fa6f181e42";
const TESTNET_KEY: &str =
    "8200fc249deb0148eb918d6e213980c5d01acd7fc251900d9260136da3b54836ce125172399ddc69c4e3e11429b62c11";
const TESTNET_223344: &str = "94f6b85df7cce7237e8e7df66d794ddad092de5d8bb6a791b97e905aa89852e506ac36a792eba7021e22eebf34891f89\
    14bf9a8dd9233ea0a4c5ca00ef8404999f899073dd2eade61fe54077fee8168f83dcb61a758b6883b38904054e64a433";

fn value(signature: &str) -> Digest {
    let hash: [u8; 32] = Sha256::digest(hex(signature).unwrap()).into();
    Digest::from_bytes(hash)
}

fn answer(source: &str, round: u64, signature: &str, more: Value) -> Value {
    let mut file =
        json!({ "source": source, "round": round, "randomness": value(signature), "signature": signature });
    file.as_object_mut().unwrap().extend(more.as_object().unwrap().clone());
    file
}

#[track_caller]
fn check(file: &Value, expect: Option<&str>) {
    match (Drawn::parse(file.to_string().as_bytes(), "x"), expect) {
        (Ok(_), None) => {}
        (Err(error), Some(words)) => assert!(error.to_string().contains(words), "{error}"),
        (found, expect) => panic!("{found:?}, and not {expect:?}"),
    }
}

/// The chain hashes cover the keys in the source code.
#[test]
fn known_keys_have_their_chain_hashes() {
    let facts = [
        (3, 1_692_803_367, "f477d5c89f21a17c863a7f937c6a6d15859414d2be09cd448d4279af331c5d3e", "quicknet"),
        (30, 1_595_431_050, "176f93498eac9ca337150b46d21dd58673ea4e3581185f869672e59fa4cb390a", "default"),
    ];
    for (known, (period, genesis_time, group, id)) in KNOWN.iter().zip(facts) {
        let chain = Chain {
            public_key: known.public_key.to_owned(),
            period,
            genesis_time,
            hash: known.hash.parse().unwrap(),
            group_hash: group.parse().unwrap(),
            scheme: known.scheme.to_owned(),
            metadata: Metadata { beacon_id: id.to_owned() },
        };
        assert_eq!(chain.computed_hash(), Some(chain.hash), "{}", known.name);
    }
}

#[test]
fn real_rounds_hold() {
    let none = json!({});
    check(&answer("drand quicknet", 123, QUICKNET_123, none.clone()), None);
    check(&answer("drand quicknet", 1000, QUICKNET_1000, none.clone()), None);
    assert_eq!(
        value(QUICKNET_1000).to_string(),
        "fe290beca10872ef2fb164d2aa4442de4566183ec51c56ff3cd603d930e54fdd"
    );
    let previous = json!({ "previous_signature": DEFAULT_72784 });
    check(&answer("drand default", 72785, DEFAULT_72785, previous.clone()), None);
    assert_eq!(
        value(DEFAULT_72785).to_string(),
        "8b676484b5fb1f37f9ec5c413d7d29883504e5b669f604a1ce68b3388e9ae3d9"
    );
    let [key, signature] = [TESTNET_KEY, TESTNET_223344].map(|text| hex(text).unwrap());
    assert_eq!(verifies("pedersen-bls-unchained", &key, 223_344, None, &signature), Ok(true));
    assert_eq!(verifies("pedersen-bls-unchained", &key, 223_343, None, &signature), Ok(false));

    // These signatures belong to a different round, network or predecessor.
    check(&answer("drand quicknet", 1001, QUICKNET_1000, none.clone()), Some("not belong to round 1001"));
    check(&answer("drand quicknet", 1000, QUICKNET_123, none.clone()), Some("not belong to round 1000"));
    check(&answer("drand default", 1000, QUICKNET_1000, previous.clone()), Some("not belong to round 1000"));
    check(&answer("drand quicknet", 72785, DEFAULT_72785, none.clone()), Some("not belong to round 72785"));
    check(&answer("drand quicknet", 1000, QUICKNET_1000, previous), Some("remove `previous_signature`"));
    check(&answer("drand default", 72785, DEFAULT_72785, none), Some("has no `previous_signature`"));
    let other = json!({ "previous_signature": DEFAULT_72785 });
    check(&answer("drand default", 72785, DEFAULT_72785, other), Some("not belong to round 72785"));
}

/// A publisher who makes up a value has no signature for it.
#[test]
fn a_round_of_drand_needs_its_signature() {
    let file = json!({ "source": "drand quicknet", "round": 1000, "randomness": value(QUICKNET_1000) });
    check(&file, Some("has no `signature` of round 1000 of drand quicknet"));
    check(&answer("drand quicknet", 1000, "00", json!({})), Some("not belong to round 1000"));
    check(&answer("drand quicknet", 1000, &"c0".repeat(48), json!({})), Some("not belong to round 1000"));
}

/// The uncompressed form of the same signature has a different hash.
#[test]
fn a_point_has_one_encoding() {
    let signature = min_sig::Signature::from_bytes(&hex(QUICKNET_1000).unwrap()).unwrap();
    let long: String = signature.serialize().iter().map(|byte| format!("{byte:02x}")).collect();
    check(&answer("drand quicknet", 1000, &long, json!({})), Some("not belong to round 1000"));
}

#[test]
fn sources_that_mention_drand_name_a_network() {
    let by_hash = format!("drand {}", "ab".repeat(32));
    for (source, is_drand) in
        [("drand quicknet", true), ("drand default", true), (&by_hash, true), ("dice", false)]
    {
        assert_eq!(check_source(source), Ok(is_drand), "{source}");
    }
    for source in ["drand", "Drand quicknet", "drand quiknet", "drand  default", "the default of DRAND"] {
        assert!(check_source(source).unwrap_err().contains("write `drand quicknet`"), "{source}");
    }
    let by_hash = check_source(&format!("drand {}", KNOWN[0].hash)).unwrap_err();
    assert!(by_hash.contains("is the network `drand quicknet`: write that"), "{by_hash}");
}

/// For an unnamed network, the source fixes the chain hash, and the chain hash fixes the key.
#[test]
fn other_networks_are_named_by_their_chain_hash() {
    let ikm = [7; 32];
    let (small, large) =
        (min_sig::SecretKey::key_gen(&ikm, &[]).unwrap(), min_pk::SecretKey::key_gen(&ikm, &[]).unwrap());
    let digits = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let unchained = Sha256::digest(9_u64.to_be_bytes());
    let chained = Sha256::new().chain_update([1; 96]).chain_update(9_u64.to_be_bytes()).finalize();
    let previous = json!({ "previous_signature": "01".repeat(96) });
    let cases = [
        (
            "bls-unchained-g1-rfc9380",
            digits(&small.sk_to_pk().to_bytes()),
            digits(&small.sign(&unchained, ON_G1, &[]).to_bytes()),
            json!({}),
        ),
        (
            "pedersen-bls-unchained",
            digits(&large.sk_to_pk().to_bytes()),
            digits(&large.sign(&unchained, ON_G2, &[]).to_bytes()),
            json!({}),
        ),
        (
            "pedersen-bls-chained",
            digits(&large.sk_to_pk().to_bytes()),
            digits(&large.sign(&chained, ON_G2, &[]).to_bytes()),
            previous,
        ),
    ];
    for (scheme, public_key, signature, mut more) in cases {
        let mut chain = Chain {
            public_key,
            period: 3,
            genesis_time: 1_700_000_000,
            hash: Digest::of(b""),
            group_hash: Digest::of(b"group"),
            scheme: scheme.to_owned(),
            metadata: Metadata { beacon_id: "own".to_owned() },
        };
        chain.hash = chain.computed_hash().unwrap();
        let source = format!("drand {}", chain.hash);
        check(&answer(&source, 9, &signature, more.clone()), Some("has no `chain`"));
        more["chain"] = serde_json::to_value(&chain).unwrap();
        check(&answer(&source, 9, &signature, more.clone()), None);
        check(&answer(&source, 8, &signature, more.clone()), Some("not belong to round 8"));
        check(
            &answer("drand quicknet", 9, &signature, more.clone()),
            Some("is already known: remove `chain`"),
        );
        check(&answer("dice", 9, &signature, more.clone()), Some("which only drand networks have"));
        for (field, other) in [
            ("public_key", json!(KNOWN[0].public_key)),
            ("period", json!(4)),
            ("hash", json!(Digest::of(b"x"))),
            ("metadata", json!({ "beaconID": "other" })),
        ] {
            let mut forged = more.clone();
            forged["chain"][field] = other;
            check(&answer(&source, 9, &signature, forged), Some("does not belong to drand"));
        }
        // The chain hash does not cover the scheme, but a signature is valid only under its own scheme.
        for (other, words) in [
            ("bls-unchained-g1-rfc9380", ""),
            ("pedersen-bls-unchained", ""),
            ("pedersen-bls-chained", ""),
            ("bls-unchained-on-g1", "which is not supported"),
        ] {
            let mut forged = more.clone();
            forged["chain"]["schemeID"] = json!(other);
            if other != scheme {
                check(&answer(&source, 9, &signature, forged), Some(words));
            }
        }
    }
}

/// The chain hash also covers the genesis time. With an invented genesis time, the same key could have any
/// number of chain hashes.
#[test]
fn a_known_key_has_one_name() {
    let mut chain = Chain {
        public_key: KNOWN[0].public_key.to_owned(),
        period: 3,
        genesis_time: 1_700_000_000,
        hash: Digest::of(b""),
        group_hash: Digest::of(b"group"),
        scheme: KNOWN[0].scheme.to_owned(),
        metadata: Metadata { beacon_id: "own".to_owned() },
    };
    chain.hash = chain.computed_hash().unwrap();
    let source = format!("drand {}", chain.hash);
    let file = answer(&source, 1000, QUICKNET_1000, json!({ "chain": chain }));
    check(&file, Some("its `chain` has the key of `drand quicknet`: specify that network as the source"));
}
