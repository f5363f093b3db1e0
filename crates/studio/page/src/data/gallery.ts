import type { Frame, Game, Release, Replay, SentFrame, Tile } from './types';

/**
 * The static gallery: the same page without a server. Data arrive as scripts that call `arcadeGallery(name, data)`, because a page
 * opened from `file://` may load scripts, but not fetch.
 */

/** A game of the static gallery: the game itself, with the frames that a server would compute. */
export interface StaticGame extends Omit<Game, 'witnesses'> {
  tiles: Tile[];
  boards?: (Frame | null)[];
  witnesses: { name: string; level: string | number; frames: SentFrame[]; actions: string[]; note: string | null }[];
}

declare global {
  interface Window {
    arcadeGallery?: (name: string, data: unknown) => void;
  }
}

const arrived = new Map<string, unknown>();
const waiting = new Map<string, (data: unknown) => void>();

window.arcadeGallery = (name, data) => {
  arrived.set(name, data);
  waiting.get(name)?.(data);
  waiting.delete(name);
};

/** Says that the page has the data of a gallery beside it instead of a server behind it. */
export function isStatic(): boolean {
  return document.querySelector('script[src="data/release.js"]') !== null;
}

/** Loads a data file by a script tag; once for each name. */
async function load(name: string, file: string): Promise<unknown> {
  const known = arrived.get(name);
  if (known !== undefined) return known;
  return new Promise((resolve, reject) => {
    waiting.set(name, resolve);
    const script = document.createElement('script');
    script.src = file;
    script.onerror = () => {
      waiting.delete(name);
      reject(new Error(`The file ${file} of this gallery is missing. Write the gallery again: arcade gallery SNAPSHOT --out DIR.`));
    };
    document.head.append(script);
  });
}

export const loadRelease = async (): Promise<Release> => (await load('release', 'data/release.js')) as Release;

/** Loads a game's data; the name of its file is the id, with anything unusual in it escaped. */
export const loadGame = async (id: string): Promise<StaticGame> =>
  (await load(`game/${id}`, `data/${encodeURIComponent(id)}.js`)) as StaticGame;

export function replayOf(game: StaticGame, name: string): Replay {
  const witness = game.witnesses.find((one) => one.name === name);
  if (!witness) throw new Error(`The gallery holds no witness named ${name}.`);
  return { tiles: game.tiles, frames: witness.frames, actions: witness.actions, agrees: true, note: witness.note };
}
