//! The API that the page uses.

mod boards;
mod editor;
mod judge;
mod play;
mod release;
mod results;
mod verdict;
mod workspace;

use crate::answers::{Serving, asked, awaited, change_part, of_game, of_part, streamed, told};
use axum::Router;
use axum::routing::MethodFilter;

pub(crate) use boards::{CUT, Replayed};
pub(crate) use release::release as release_of;
pub(crate) use workspace::game as game_of;

/// Returns the API routes.
pub(crate) fn routes() -> Router<Serving> {
    let files = change_part(MethodFilter::PUT, workspace::save)
        .merge(change_part(MethodFilter::DELETE, workspace::remove));
    Router::new()
        .route("/api/workspace", told(workspace::workspace))
        .route("/api/games/{id}", of_game(workspace::game))
        .route("/api/games/{id}/versions", of_game(workspace::versions))
        .route("/api/games/{id}/witness/{name}", of_part(workspace::witness))
        .route("/api/games/{id}/files/{name}", files)
        .route("/api/copy", asked(workspace::copy))
        .route("/api/new", asked(workspace::begin))
        .route("/api/check", asked(editor::check))
        .route("/api/hover", asked(editor::hover))
        .route("/api/complete", asked(editor::complete))
        .route("/api/definition", asked(editor::definition))
        .route("/api/rename", asked(editor::rename))
        .route("/api/format", asked(editor::format))
        .route("/api/page", asked(editor::page))
        .route("/api/board", asked(boards::board))
        .route("/api/replay", asked(boards::replay))
        .route("/api/play/begin", asked(play::begin))
        .route("/api/play/act", asked(play::act))
        .route("/api/play/seek", asked(play::seek))
        .route("/api/play/episode", asked(play::episode))
        .route("/api/verdict", streamed(verdict::verdict))
        .route("/api/necessity", streamed(verdict::necessity))
        .route("/api/more", streamed(verdict::more))
        .route("/api/release", told(release::release))
        .route("/api/release/verify", streamed(release::verified))
        .route("/api/release/compare", told(release::compare))
        .route("/api/results", told(results::results))
        .route("/api/results/{index}", of_game(results::episode))
        .route("/api/judge", told(judge::next).merge(asked(judge::add)))
        .route("/api/judge/watch", awaited(judge::watch))
        .route("/api/judge/end", asked(judge::end))
        .route("/api/judge/report", told(judge::report))
        .route("/api/planners", told(play::planners))
}
