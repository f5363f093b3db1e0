//! Reads files within size limits, writes whole files, and locks files.
//!
//! A user-specified folder may be shared: a mailbox with players, or a cache with colleagues. Anyone who can
//! write to the folder can replace a file that is about to be opened with a link to someone else's file, or
//! with a pipe. Functions whose names end in `no_follow` therefore reject links.
//!
//! No function opens a pipe or a device, because opening a pipe blocks until something opens its other end,
//! which may never happen. No function truncates a file.
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
