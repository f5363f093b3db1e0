import { get, post, segment } from './api';
import { isStatic, loadGame, loadRelease, replayOf } from './gallery';
import type { BoardAnswer, Episode, Game, Release, Replay, Witness, Workspace } from './types';

/** Questions that both a server and a static gallery answer. */

export const live = !isStatic();

export async function workspace(): Promise<Workspace> {
  if (live) return get('/api/workspace');
  const release = await loadRelease();
  return {
    kind: 'snapshot',
    name: release.name,
    version: '',
    judge: false,
    templates: [],
    games: release.games.map((game) => ({
      id: game.id,
      title: game.title,
      levels: game.levels.length,
      writable: false,
      summary: '',
      tile: game.frame,
      tiles: game.tiles,
      kind: game.kind,
    })),
  };
}

export async function game(id: string): Promise<Game> {
  return live ? get(`/api/games/${segment(id)}`) : loadGame(id);
}

export async function release(): Promise<Release> {
  return live ? get('/api/release') : loadRelease();
}

/** The start of a level, to be drawn. */
export async function board(of: Game, level: number, signal?: AbortSignal): Promise<BoardAnswer> {
  if (live) return post('/api/board', { source: of.source.text, level: of.levels[level]?.text ?? '' }, signal);
  const held = await loadGame(of.id);
  return { tiles: held.tiles, frame: held.boards?.[level] ?? null, problems: [] };
}

export async function replay(source: string, level: string, episode: Episode): Promise<Replay> {
  return post('/api/replay', { source, level, episode });
}

/** The number of a level, which is that of its file everywhere. */
export function numberOf(levels: readonly { name: string }[], index: number): number {
  return Number(/^lvl(\d+)/.exec(levels[index]?.name ?? '')?.[1] ?? index);
}

/** The level that a witness belongs to, as an index: witnesses name the file, its number or its stem. */
export function levelOf(of: Game, witness: Witness): number {
  if (typeof witness.level === 'number') return witness.level;
  const at = of.levels.findIndex((level) => level.name === witness.level || level.name === `${witness.level}.txt`);
  if (at >= 0) return at;
  const number = Number(/\d+/.exec(witness.level)?.[0] ?? 0);
  return number < of.levels.length ? number : 0;
}

export async function witness(of: Game, one: Witness): Promise<Replay> {
  if (!live) return replayOf(await loadGame(of.id), one.name);
  const episode = await get<Episode>(`/api/games/${segment(of.id)}/witness/${segment(one.name)}`);
  return replay(of.source.text, of.levels[levelOf(of, one)]?.text ?? '', episode);
}
