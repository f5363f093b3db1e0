//! The pages that newcomers read first. Their example programs run in this crate, in which every crate has
//! its public name.

#[doc = include_str!("../../README.md")]
struct Workspace;

#[doc = include_str!("../../docs/how-to/library.md")]
struct Library;

#[doc = include_str!("../../crates/base/README.md")]
struct Base;

#[doc = include_str!("../../crates/disk/README.md")]
struct Disk;

#[doc = include_str!("../../crates/loopback/README.md")]
struct Loopback;

#[doc = include_str!("../../engine/README.md")]
struct Engine;

#[doc = include_str!("../../crates/editor/README.md")]
struct Editor;

#[doc = include_str!("../../crates/agents/README.md")]
struct Agents;

#[doc = include_str!("../../generators/README.md")]
struct Generators;

#[doc = include_str!("../../validators/README.md")]
struct Validators;

#[doc = include_str!("../../crates/statistics/README.md")]
struct Statistics;

#[doc = include_str!("../../crates/render/README.md")]
struct Render;

#[doc = include_str!("../../crates/report/README.md")]
struct Report;

#[doc = include_str!("../../crates/forge/README.md")]
struct Forge;

#[doc = include_str!("../../crates/snapshots/README.md")]
struct Snapshots;

#[doc = include_str!("../../crates/design/README.md")]
struct Design;

#[doc = include_str!("../../crates/pages/README.md")]
struct Pages;

#[doc = include_str!("../../crates/terminal/README.md")]
struct Terminal;

#[doc = include_str!("../../crates/trust/README.md")]
struct Trust;

#[doc = include_str!("../../crates/evaluation/README.md")]
struct Evaluation;
