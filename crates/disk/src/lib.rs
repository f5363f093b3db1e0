//! Files read within limits, files written whole, and locks.
//!
//! A folder that a user names may be shared: a mailbox with players, a cache with colleagues. Whoever can write there can put
//! a link to somebody else's file, or a pipe, in the place of a file that is about to be opened. Functions whose names end in
//! `no_follow` therefore refuse links. No function opens a pipe or a device, since opening a pipe waits for its other end, maybe
//! for ever. No function truncates a file.
#![cfg_attr(not(doctest), doc = "", doc = include_str!("../README.md"))]

mod lock;
mod open;
mod write;

pub use lock::Lock;
pub use open::{
    append_no_follow, create_folder_no_follow, is_readable_by_others, is_same_file, open, open_no_follow,
    read, read_no_follow, read_start, start,
};
pub use write::{Access, Disk, create, create_folder, is_unfinished, sync_folder, unfinished, write};
