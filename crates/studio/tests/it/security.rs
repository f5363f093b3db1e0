//! Tests of requests that the server must reject, and of requests that it must accept.

use crate::client::{GAME, LEVEL, in_folder, run, studio, usual};
use serde_json::json;
use std::io::Write;
use std::net::TcpStream;

/// Paths whose requests read or change something.
const QUESTIONS: [(&str, &str); 11] = [
    ("GET", "/api/workspace"),
    ("GET", "/api/games/one"),
    ("GET", "/api/planners"),
    ("POST", "/api/check"),
    ("POST", "/api/verdict"),
    ("POST", "/api/copy"),
    ("PUT", "/api/games/one/files/lvl0.txt"),
    ("DELETE", "/api/games/one/files/lvl0.txt"),
    ("POST", "/api/judge/watch"),
    ("GET", "/api/judge/report"),
    ("GET", "/api/nothing"),
];

#[test]
fn nothing_is_answered_without_the_token() {
    let running = usual();
    let host = ("Host".to_owned(), running.host());
    let with = |name: &str, value: &str| vec![host.clone(), (name.to_owned(), value.to_owned())];
    let mut twice = running.own();
    twice.push(("X-Arcade-Token".to_owned(), running.token.clone()));
    let wrong = [
        vec![host.clone()],
        with("X-Arcade-Token", ""),
        with("X-Arcade-Token", "0"),
        with("X-Arcade-Token", &running.token[1..]),
        with("X-Arcade-Token", &format!("{}0", running.token)),
        with("X-Arcade-Token", &running.token.replace(|c: char| c.is_ascii_digit(), "x")),
        with("Authorization", &format!("Bearer {}", running.token)),
        with("Cookie", &format!("token={}", running.token)),
        twice,
    ];
    for (method, path) in QUESTIONS {
        for headers in &wrong {
            let answer = running.send(method, path, headers, b"{}");
            assert_eq!(answer.status, 403, "{method} {path} {headers:?}");
            let by_address = format!("{path}?token={}", running.token);
            assert_eq!(running.send(method, &by_address, headers, b"{}").status, 403, "{by_address}");
        }
    }
    assert_eq!(running.get("/api/workspace").status, 200);
}

#[test]
fn other_hosts_origins_and_sites_are_refused() {
    let running = usual();
    let port = running.host().split(':').nth(1).unwrap().to_owned();
    let token = ("X-Arcade-Token".to_owned(), running.token.clone());
    for host in [
        "evil.example",
        &format!("evil.example:{port}"),
        "127.0.0.1",
        "127.0.0.1:1",
        &format!("127.0.0.1.evil.example:{port}"),
        &format!("0.0.0.0:{port}"),
        &format!("[::1]:{port}"),
        "",
    ] {
        let headers = [("Host".to_owned(), host.to_owned()), token.clone()];
        for path in ["/api/workspace", "/", "/app.js"] {
            let answer = running.send("GET", path, &headers, b"");
            assert!([400, 403].contains(&answer.status), "{host} {path}: {}", answer.status);
        }
    }
    let with = |name: &str, value: &str| {
        let mut headers = running.own();
        headers.push((name.to_owned(), value.to_owned()));
        headers
    };
    for origin in ["http://evil.example", "null", "https://127.0.0.1", "http://localhost:1", "file://"] {
        let answer = running.send("GET", "/api/workspace", &with("Origin", origin), b"");
        assert_eq!(answer.status, 403, "{origin}");
    }
    for site in ["cross-site", "same-site", "", "SAME-ORIGIN, cross-site"] {
        let answer = running.send("GET", "/api/workspace", &with("Sec-Fetch-Site", site), b"");
        assert_eq!(answer.status, 403, "{site}");
    }
    let own = format!("http://localhost:{port}");
    assert_eq!(running.send("GET", "/api/workspace", &with("Origin", &own), b"").status, 200);
    assert_eq!(
        running.send("GET", "/api/workspace", &with("Sec-Fetch-Site", "same-origin"), b"").status,
        200
    );
    let local = [("Host".to_owned(), format!("localhost:{port}")), token];
    assert_eq!(running.send("GET", "/api/workspace", &local, b"").status, 200);
}

#[test]
fn every_answer_has_the_headers_of_security() {
    let running = usual();
    let none: [(String, String); 0] = [];
    let answers = [
        running.get("/"),
        running.get("/api/workspace"),
        running.get("/nothing"),
        running.send("GET", "/api/workspace", &none, b""),
        running.send("DELETE", "/api/workspace", &running.own(), b""),
        running.post("/api/verdict", &json!({ "source": GAME, "level": LEVEL, "budget": 1000 })),
    ];
    for answer in answers {
        let policy = answer.header("content-security-policy").expect("a policy");
        for part in ["default-src 'none'", "script-src 'self'", "frame-ancestors 'none'", "base-uri 'none'"] {
            assert!(policy.contains(part), "{policy}");
        }
        assert!(!policy.contains("script-src 'self' ") && !policy.contains("unsafe-eval"), "{policy}");
        assert_eq!(answer.header("x-content-type-options"), Some("nosniff"));
        assert_eq!(answer.header("referrer-policy"), Some("no-referrer"));
        assert_eq!(answer.header("cache-control"), Some("no-store"));
        assert_eq!(answer.header("access-control-allow-origin"), None);
    }
    let page = running.get("/?token=x");
    assert_eq!((page.status, page.header("content-type")), (200, Some("text/html; charset=utf-8")));
    assert!(!String::from_utf8_lossy(&page.body).contains(&running.token));
}

#[test]
fn files_of_other_names_are_out_of_reach() {
    let home = tempfile::tempdir().expect("temporary folder");
    let folder = home.path().join("game");
    std::fs::create_dir(&folder).expect("created");
    std::fs::write(home.path().join("lvl0.txt"), "secret").expect("written");
    let running = run(studio(home.path(), vec![in_folder("one", &folder)]));
    let before = names(home.path());
    for name in [
        "..%2Flvl0.txt",
        "..%2f..%2flvl0.txt",
        "%2e%2e%2flvl0.txt",
        "..%5Clvl0.txt",
        "%2Fetc%2Fpasswd",
        "lvl0.txt%00",
        "lvl0.txt%2F",
        "lvl00.txt",
        "lvl-1.txt",
        "LVL0.TXT",
        "CARD.toml",
        ".git",
        "game.vgdl.bak",
        "%F0%9F%98%80.txt",
        "lvl0.txt/../../lvl0.txt",
    ] {
        let path = format!("/api/games/one/files/{name}");
        let answer = running.put(&path, &json!({ "text": "x", "base": null }));
        assert!((400..500).contains(&answer.status), "{name}: {}", answer.status);
    }
    for path in ["/../../Cargo.toml", "/..%2FCargo.toml", "/%2e%2e/src/lib.rs", "/src/lib.rs", "//etc/passwd"]
    {
        assert_eq!(running.get(path).status, 404, "{path}");
    }
    for id in ["..", "%2e%2e", "one%2F..", "", "two"] {
        assert_eq!(running.get(&format!("/api/games/{id}/versions")).status, 404, "{id}");
    }
    assert_eq!(names(home.path()), before);
    assert_eq!(std::fs::read_to_string(home.path().join("lvl0.txt")).expect("read"), "secret");
    assert_eq!(std::fs::read_to_string(folder.join("lvl0.txt")).expect("read"), LEVEL);
}

#[cfg(unix)]
#[test]
fn links_are_neither_followed_nor_replaced() {
    let home = tempfile::tempdir().expect("temporary folder");
    let folder = home.path().join("game");
    std::fs::create_dir(&folder).expect("created");
    let target = home.path().join("target.txt");
    std::fs::write(&target, "target").expect("written");
    let running = run(studio(home.path(), vec![in_folder("one", &folder)]));
    std::os::unix::fs::symlink(&target, folder.join("lvl1.txt")).expect("linked");
    for base in [json!(null), json!(base::Digest::of(b"target"))] {
        let answer = running.put("/api/games/one/files/lvl1.txt", &json!({ "text": "x", "base": base }));
        assert_eq!(answer.status, 403);
    }
    let base = json!({ "base": base::Digest::of(b"target") });
    let answer =
        running.send("DELETE", "/api/games/one/files/lvl1.txt", &running.own(), base.to_string().as_bytes());
    assert_eq!(answer.status, 403);
    assert_eq!(std::fs::read_to_string(&target).expect("read"), "target");
    assert!(folder.join("lvl1.txt").is_symlink());
}

fn names(folder: &std::path::Path) -> Vec<std::ffi::OsString> {
    let mut names: Vec<_> = std::fs::read_dir(folder)
        .expect("readable")
        .map(|entry| entry.expect("readable").file_name())
        .collect();
    names.sort();
    names
}

#[test]
fn large_and_broken_requests_are_refused() {
    let running = usual();
    let large = vec![b' '; (4 << 20) + 1];
    assert_eq!(running.send("POST", "/api/check", &running.own(), &large).status, 413);
    for body in
        [&b"{"[..], b"[]", b"{\"source\": 1}", b"\xff\xfe", b"null", b"{\"source\":\"x\",\"levels\":{}}"]
    {
        let answer = running.send("POST", "/api/check", &running.own(), body);
        assert_eq!(answer.status, 400, "{}", String::from_utf8_lossy(body));
        assert!(answer.json()["error"].as_str().expect("a message").contains("is malformed"));
    }
    let deep = format!("{}{}", "[".repeat(100_000), "]".repeat(100_000));
    assert_eq!(running.send("POST", "/api/check", &running.own(), deep.as_bytes()).status, 400);
    assert_eq!(running.send("DELETE", "/api/workspace", &running.own(), b"").status, 405);
    assert_eq!(running.get("/api/workspace").status, 200);
}

/// Neither idle connections nor clients that do not read can lock out the owner, with or without the token.
#[test]
fn silent_clients_lock_nobody_out() {
    let running = usual();
    let idle: Vec<TcpStream> =
        (0..64).map(|_| TcpStream::connect(running.host()).expect("connected")).collect();
    assert_eq!(running.get("/api/workspace").status, 200);
    drop(idle);
    let ask = format!("GET /app.js HTTP/1.1\r\nHost: {}\r\n\r\n", running.host()).repeat(20);
    let greedy: Vec<TcpStream> = (0..64)
        .map(|_| {
            let mut stream = TcpStream::connect(running.host()).expect("connected");
            stream.write_all(ask.as_bytes()).expect("sent");
            stream
        })
        .collect();
    for _ in 0..3 {
        assert_eq!(running.get("/api/workspace").status, 200);
        assert_eq!(running.get("/").status, 200);
    }
    drop(greedy);
}

/// A folder that is a link, or becomes one while it is open, is never written to.
#[cfg(unix)]
#[test]
fn linked_folders_are_not_written_to() {
    use std::os::unix::fs::symlink;
    let home = tempfile::tempdir().expect("temporary folder");
    let (outside, link, inside) = {
        let [a, b, c] = ["outside", "link", "inside"].map(|name| home.path().join(name));
        (a, b, c)
    };
    std::fs::create_dir(&outside).expect("created");
    std::fs::create_dir(&inside).expect("created");
    symlink(&outside, &link).expect("linked");
    let running = run(studio(home.path(), vec![in_folder("linked", &link), in_folder("one", &inside)]));
    std::fs::rename(&inside, home.path().join("moved")).expect("moved");
    symlink(&outside, &inside).expect("linked");
    let before = names(&outside);
    for id in ["linked", "one"] {
        for (name, base) in
            [("game.vgdl", json!(base::Digest::of(GAME.as_bytes()))), ("lvl7.txt", json!(null))]
        {
            let path = format!("/api/games/{id}/files/{name}");
            assert_eq!(running.put(&path, &json!({ "text": "x", "base": base })).status, 403, "{path}");
        }
        let base = json!({ "base": base::Digest::of(LEVEL.as_bytes()) });
        assert_eq!(running.delete(&format!("/api/games/{id}/files/lvl0.txt"), &base).status, 403);
    }
    assert_eq!(names(&outside), before);
    assert_eq!(std::fs::read_to_string(outside.join("game.vgdl")).expect("read"), GAME);
}

/// Pipes in place of files are reported, and the server does not wait for them.
#[cfg(unix)]
#[test]
fn pipes_are_no_files() {
    let home = tempfile::tempdir().expect("temporary folder");
    let folder = home.path().join("game");
    std::fs::create_dir(&folder).expect("created");
    let running = run(studio(home.path(), vec![in_folder("one", &folder)]));
    for name in ["lvl1.txt", "game.vgdl"] {
        let _ = std::fs::remove_file(folder.join(name));
        let made = std::process::Command::new("mkfifo").arg(folder.join(name)).status();
        assert!(made.expect("mkfifo runs").success());
        let answer = running.get("/api/games/one");
        assert_eq!(answer.status, 400);
        assert_eq!(answer.json()["error"], format!("{name} is not a file"));
    }
    assert_eq!(running.get("/api/workspace").status, 200);
}

/// Texts beyond the size limits of games and levels are rejected, and so are games whose levels are too large
/// in total.
#[test]
fn answers_take_bounded_memory() {
    let running = usual();
    let source = format!("{GAME}    {}\n", "key ".repeat(100_000));
    for path in ["/api/rename", "/api/check", "/api/hover", "/api/complete", "/api/definition"] {
        let asked = json!({ "source": source, "at": GAME.find("key").expect("there"), "name": "lamp" });
        assert_eq!(running.post(path, &asked).status, 413, "{path}");
    }
    let level = "k".repeat(engine::MAX_LEVEL_TEXT);
    let asked = |levels: Vec<&str>| {
        let at = GAME.find("k > key").expect("there");
        json!({ "source": GAME, "at": at, "name": "K", "levels": levels })
    };
    let answer = running.post("/api/rename", &asked(vec![&level; 8]));
    assert_eq!(answer.status, 400);
    assert!(answer.json()["error"].as_str().expect("a message").contains("more than 100000 places"));
    assert_eq!(running.post("/api/rename", &asked(vec![LEVEL])).status, 200);
    let home = tempfile::tempdir().expect("temporary folder");
    let folder = home.path().join("game");
    std::fs::create_dir(&folder).expect("created");
    let running = run(studio(home.path(), vec![in_folder("one", &folder)]));
    for number in 0..20 {
        std::fs::write(folder.join(format!("lvl{number}.txt")), &level).expect("written");
    }
    let answer = running.get("/api/games/one");
    assert_eq!(answer.status, 400);
    assert!(answer.json()["error"].as_str().expect("a message").contains("4194304 bytes in total"));
}
