//! The pages that strangers read first: their programs are run here, where every crate has the name that strangers know.

#[doc = include_str!("../../README.md")]
struct Workspace;

#[doc = include_str!("../../docs/library.md")]
struct Library;

#[doc = include_str!("../../engine/README.md")]
struct Engine;

#[doc = include_str!("../../editor/README.md")]
struct Editor;

#[doc = include_str!("../../agents/README.md")]
struct Agents;

#[doc = include_str!("../../generators/README.md")]
struct Generators;

#[doc = include_str!("../../validators/README.md")]
struct Validators;

#[doc = include_str!("../../statistics/README.md")]
struct Statistics;

#[doc = include_str!("../../render/README.md")]
struct Render;

#[doc = include_str!("../../report/README.md")]
struct Report;

#[doc = include_str!("../../forge/README.md")]
struct Forge;

#[doc = include_str!("../../snapshots/README.md")]
struct Snapshots;

#[doc = include_str!("../../trust/README.md")]
struct Trust;

#[doc = include_str!("../../evaluation/README.md")]
struct Evaluation;
