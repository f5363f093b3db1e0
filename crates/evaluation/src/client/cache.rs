//! A cache of paid answers, stored in a folder with one file per answer.

use super::chat::{ChatReply, ChatRequest};
use super::provider::Provider;
use crate::error::EvaluationError;
use base::{Digest, Seed};
use disk::Access;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

/// A folder of cached answers that several programs may use concurrently. It must be trusted, because a
/// forged entry is indistinguishable from a server's answer.
#[derive(Debug)]
pub(super) struct Cache {
    folder: PathBuf,
}

/// The maximum size of a cache entry, in bytes. Longer answers are not cached.
const MAX_ENTRY: u64 = 16 << 20;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Entry {
    key: Digest,
    /// The digest of the reply's JSON, used to detect corruption.
    check: Digest,
    reply: ChatReply,
}

/// Returns a request's cache key.
///
/// The key covers everything that reaches the server: the provider, the URL, and every byte of the body,
/// including the model, the conversation and the decoding. If a client formats the same request differently,
/// the key is different.
///
/// The key also covers the draw ([`ChatRequest::sample`]). At a nonzero temperature, equal requests need
/// different answers, but a repeated run must receive the same answers as before. At temperature 0, all draws
/// share one answer.
///
/// The key does not cover the API key, time limits or caps, because they do not affect answers.
pub(super) fn key(provider: Provider, url: &str, body: &[u8], request: &ChatRequest) -> Digest {
    let mut hasher = blake3::Hasher::new_derive_key("infinite-arcade 1 cached reply");
    let mut add = |part: &[u8]| {
        hasher.update(&(part.len() as u64).to_le_bytes());
        hasher.update(part);
    };
    add(provider.name().as_bytes());
    add(url.as_bytes());
    add(body);
    let greedy = request.decoding.temperature == Some(0.0);
    add(if greedy { &[] } else { Seed::as_bytes(&request.sample) });
    Digest::from_bytes(*hasher.finalize().as_bytes())
}

impl Cache {
    /// Opens a cache folder, and creates it if it does not exist.
    ///
    /// # Errors
    /// Returns an error if the folder cannot be written.
    pub(super) fn open(folder: &Path) -> Result<Cache, EvaluationError> {
        fs::create_dir_all(folder).map_err(EvaluationError::io("create", folder))?;
        let cache = Cache { folder: folder.to_owned() };
        tempfile::tempfile_in(folder).map_err(EvaluationError::io("write to", folder))?;
        Ok(cache)
    }

    /// Returns the cached answer for a key, if present and intact.
    pub(super) fn get(&self, key: Digest) -> Option<ChatReply> {
        let bytes = disk::read_no_follow(&self.path(key), MAX_ENTRY).ok()??;
        let entry: Entry = serde_json::from_slice(&bytes).ok()?;
        (entry.key == key && entry.check == check(&entry.reply)).then_some(entry.reply)
    }

    /// Stores an answer. Ignores write errors, because the answer is usable even if the disk is full.
    pub(super) fn put(&self, key: Digest, reply: &ChatReply) {
        let reply = ChatReply { failures: Vec::new(), ..reply.clone() };
        let entry = Entry { key, check: check(&reply), reply };
        let bytes = serde_json::to_vec(&entry).expect("replies are plain data");
        let path = self.path(key);
        let folder = path.parent().expect("entries lie in a folder");
        if bytes.len() as u64 <= MAX_ENTRY && disk::create_folder_no_follow(folder).is_ok() {
            let _ = disk::write(&path, &bytes, Access::Shared);
        }
    }

    /// Returns an entry's path. Entries are distributed over folders by the first two digits of their keys,
    /// because a cache may contain a million entries.
    fn path(&self, key: Digest) -> PathBuf {
        let name = key.to_string();
        self.folder.join(&name[..2]).join(format!("{name}.json"))
    }
}

fn check(reply: &ChatReply) -> Digest {
    Digest::of(&serde_json::to_vec(reply).expect("replies are plain data"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::client::chat::{ChatMessage, Decoding, Finish, Role, Usage};

    fn request(temperature: Option<f64>, sample: &str) -> ChatRequest {
        let messages = vec![ChatMessage { role: Role::User, text: "Hi".to_owned(), image: None }];
        let decoding = Decoding { temperature, ..Decoding::default() };
        ChatRequest { messages, decoding, sample: Seed::from_text(sample) }
    }

    fn reply() -> ChatReply {
        ChatReply {
            text: "Action: 2 é \u{1}".to_owned(),
            reasoning: None,
            finish: Finish::Stop,
            usage: Usage { input_tokens: Some(3), ..Usage::default() },
            served_by: Some("m".to_owned()),
            failures: Vec::new(),
            latency_ms: 0.1,
            cached: false,
        }
    }

    #[test]
    fn keys() {
        let of = |url: &str, body: &str, request: &ChatRequest| {
            key(Provider::OpenAi, url, body.as_bytes(), request)
        };
        let warm = request(Some(0.7), "a");
        let base = of("u", "b", &warm);
        assert_ne!(base, of("u", "b", &request(Some(0.7), "b")), "two draws are two answers");
        assert_ne!(base, of("v", "b", &warm));
        assert_ne!(base, of("u", "c", &warm));
        assert_ne!(of("ub", "", &warm), of("u", "b", &warm));
        assert_ne!(base, key(Provider::Compatible, "u", b"b", &warm));
        let unset = of("u", "b", &request(None, "a"));
        assert_ne!(unset, of("u", "b", &request(None, "b")), "the provider's default is not 0");
        let cold = |sample| of("u", "b", &request(Some(0.0), sample));
        assert_eq!(cold("a"), cold("b"), "there is one answer at temperature 0");
    }

    #[test]
    fn stored_replies_are_returned() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(&folder.path().join("new/cache")).unwrap();
        let key = Digest::of(b"key");
        assert_eq!(cache.get(key), None);
        cache.put(key, &reply());
        assert_eq!(cache.get(key), Some(reply()));
        assert_eq!(cache.get(Digest::of(b"other")), None);
        let left = fs::read_dir(&cache.folder).unwrap().count();
        assert_eq!(left, 1, "no scratch files are left");
    }

    #[test]
    fn corrupt_entries_are_ignored_and_rewritten() {
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let key = Digest::of(b"key");
        cache.put(key, &reply());
        let sound = fs::read_to_string(cache.path(key)).unwrap();
        for corrupt in ["", &sound[..sound.len() / 2], &sound.replace("Action: 2", "Action: 3"), "{}"] {
            fs::write(cache.path(key), corrupt).unwrap();
            assert_eq!(cache.get(key), None, "{corrupt}");
            cache.put(key, &reply());
            assert_eq!(cache.get(key), Some(reply()));
        }
        let elsewhere = cache.path(Digest::of(b"other"));
        fs::create_dir_all(elsewhere.parent().unwrap()).unwrap();
        fs::copy(cache.path(key), &elsewhere).unwrap();
        assert_eq!(cache.get(Digest::of(b"other")), None, "an answer to another question");
    }

    /// Anyone who shares the folder could replace an entry with arbitrary content.
    #[cfg(unix)]
    #[test]
    fn only_plain_files_of_a_bounded_size_are_read() {
        use std::os::unix::fs::symlink;
        let folder = tempfile::tempdir().unwrap();
        let cache = Cache::open(folder.path()).unwrap();
        let key = Digest::of(b"key");
        cache.put(key, &reply());
        let (path, whole) = (cache.path(key), folder.path().join("whole"));
        fs::rename(&path, &whole).unwrap();
        for target in [whole.as_path(), Path::new("/dev/zero")] {
            symlink(target, &path).unwrap();
            assert_eq!(cache.get(key), None);
            fs::remove_file(&path).unwrap();
        }
        assert!(std::process::Command::new("mkfifo").arg(&path).status().unwrap().success());
        assert_eq!(cache.get(key), None);
        fs::remove_file(&path).unwrap();
        let mut large = fs::read(&whole).unwrap();
        large.resize(MAX_ENTRY as usize + 1, b' ');
        fs::write(&path, large).unwrap();
        assert_eq!(cache.get(key), None);
        // Storing an answer replaces the existing file, whatever its content.
        cache.put(key, &reply());
        assert_eq!(cache.get(key), Some(reply()));
    }
}
