use super::*;

const VALUE: &str = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";

#[track_caller]
fn check(rest: &str, expect: Option<&str>) {
    let text = format!("{{ \"source\": \"s\", \"round\": 7, {rest} }}");
    match (Drawn::parse(text.as_bytes(), "x"), expect) {
        (Ok(drawn), None) => assert_eq!(drawn.round, Round { source: "s".to_owned(), round: 7 }),
        (Err(error), Some(words)) => assert!(error.to_string().contains(words), "{error}"),
        (found, expect) => panic!("{found:?}, and not {expect:?}"),
    }
}

#[test]
fn the_value_is_the_hash_of_the_signature() {
    check(&format!("\"value\": \"{VALUE}\""), None);
    check(&format!("\"randomness\": \"{VALUE}\", \"signature\": \"\""), None);
    check(&format!("\"value\": \"{VALUE}\", \"signature\": \"00\""), Some("is not the SHA-256"));
    check(&format!("\"value\": \"{VALUE}\", \"signature\": \"0g\""), Some("lower-case hexadecimal"));
    check("\"value\": \"7\"", Some("64 hexadecimal"));
    check(&format!("\"value\": \"{VALUE}\", \"previous_signature\": \"\""), Some("has no `signature`"));
    let surplus = format!("\"value\": \"{VALUE}\", \"signature\": \"\", \"previous_signature\": \"\"");
    check(&surplus, Some("which only drand networks have"));
}

/// Checks that the error for a file that is not a beacon file describes the expected content.
#[test]
fn no_file_of_a_beacon() {
    for bytes in [&b""[..], b"\xff\xfe", b"[]", b"{}", b"{\"source\": 7}"] {
        let said = Drawn::parse(bytes, "round.json").unwrap_err().to_string();
        assert!(said.starts_with("`round.json`: isn't a beacon value"), "{said}");
        assert!(said.contains("write the source's answer together with its name"), "{said}");
    }
}
