/** The data of the contract between page and server; see docs/how-to/studio.md. */

export interface Tile {
  id: string;
  svg: string;
}

export type Outcome = 'playing' | 'won' | 'lost' | 'draw' | 'stopped';

/** A mark of a frame: index of the tile, then x, y, width and height in cells. */
export type Mark = [number, number, number, number, number];

export interface Frame {
  width: number;
  height: number;
  marks: Mark[];
  caption: string[];
  tick: number;
  score: number;
  outcome: Outcome;
  actions: string[];
}

/** A frame as it is sent in lists: with its marks, or with the difference from the frame before. */
export interface SentFrame extends Omit<Frame, 'marks'> {
  marks?: Mark[];
  change?: [number, number, Mark[]][];
}

export interface Edit {
  start: number;
  end: number;
  text: string;
}

export interface Fix {
  title: string;
  edits: Edit[];
}

export interface Problem {
  code: string;
  severity: 'error' | 'warning';
  message: string;
  label: string | null;
  help: string | null;
  start: number;
  end: number;
  line: number;
  column: number;
  fixes: Fix[];
  page: string | null;
  /** In a verdict: the text that the problem is in. */
  in?: 'source' | 'level';
}

export type Episode = Record<string, unknown>;

export interface GameEntry {
  id: string;
  title: string;
  levels: number;
  writable: boolean;
  summary: string;
  tile: Frame | null;
  tiles: Tile[];
  kind: string | null;
}

export interface Workspace {
  kind: 'corpus' | 'games' | 'snapshot' | 'results';
  name: string;
  version: string;
  games: GameEntry[];
  judge: boolean;
  /** The games to begin with, if the page can write. */
  templates: { genre: string; about: string }[];
}

export interface SourceFile {
  name: string;
  text: string;
  digest: string;
}

export interface Witness {
  name: string;
  level: string | number;
}

export interface Game {
  id: string;
  title: string;
  writable: boolean;
  source: SourceFile;
  levels: SourceFile[];
  card: Record<string, unknown> | null;
  witnesses: Witness[];
  describe: string;
}

export interface LegendEntry {
  symbol: string;
  types: string[];
  label: string;
  tile: number | null;
  /** Places only the ground, which has no rule. */
  floor: boolean;
}

export interface Check {
  problems: Problem[];
  levels: { problems: Problem[] }[];
  describe: string;
  legend: LegendEntry[];
  tiles: Tile[];
}

export interface BoardAnswer {
  tiles: Tile[];
  frame: Frame | null;
  problems: Problem[];
}

export interface Replay {
  tiles: Tile[];
  frames: SentFrame[];
  actions: string[];
  agrees: boolean;
  note: string | null;
}

export interface RuleSpan {
  line: number;
  start: number;
  end: number;
}

export interface Evidence {
  text: string;
  tick: number | null;
  cell: [number, number] | null;
  rule: RuleSpan | null;
}

export type VerdictLine =
  | { stage: 'problems'; problems: Problem[] }
  | {
      stage: 'reach';
      reachable: string[];
      unreachable: { type: string; cells: [number, number][] }[];
      why: { text: string; cell: [number, number] | null; rule: RuleSpan | null }[];
    }
  | { stage: 'search'; calls: number }
  | { stage: 'judging'; level: number; of: number }
  | { stage: 'win'; ticks: number; shortest: boolean; calls: number; episode: Episode }
  | { stage: 'impossible'; text: string; states: number }
  | { stage: 'unknown'; calls: number; text: string }
  | {
      stage: 'criterion';
      name: string;
      verdict: 'pass' | 'fail' | 'unknown' | 'skipped';
      text: string;
      evidence: Evidence[];
      episode: Episode | null;
    }
  | { stage: 'ladder'; rows: { player: string; wins: number; plays: number; low: number; high: number }[] }
  | { stage: 'done' }
  | { stage: 'error'; error: string };

export type MoreLine =
  | { stage: 'level'; level: string; tiles: Tile[]; frame: Frame; ticks: number | null; difficulty?: string | null; tier?: number | null }
  | { stage: 'none'; text: string }
  | { stage: 'done' }
  | { stage: 'error'; error: string };

export interface ReleaseLevel {
  name: string;
  tier: number | null;
  difficulty: string | null;
  /** The length of the recorded win. */
  ticks: number | null;
  width: number;
  height: number;
}

export interface ReleaseGame {
  id: string;
  title: string;
  kind: string | null;
  levels: ReleaseLevel[];
  tiles: Tile[];
  frame: Frame | null;
}

export interface Release {
  name: string;
  root: string;
  parent: string | null;
  format: number;
  semantics: number;
  generation: number;
  sealed: boolean;
  games: ReleaseGame[];
}

/** A release that a later one names as its parent; without a name if it was not found. */
export interface Ancestor {
  stage: 'ancestor';
  name: string | null;
  root: string;
  place: string | null;
  ok: boolean | null;
  text: string;
}

export type VerifyLine =
  | { stage: 'file'; path: string; ok: boolean; done: number; total: number }
  | Ancestor
  | { stage: 'verdict'; ok: boolean; sound: boolean; lines: string[] }
  | { stage: 'done' }
  | { stage: 'error'; error: string };

export interface Comparison {
  other: string;
  new: string[];
  gone: string[];
  kept: string[];
  changed: string[];
  nearest: { id: string; other: string; distance: number }[];
}

export interface ResultEpisode {
  index: number;
  game: string;
  level: string | number;
  run: string | number;
  outcome: string;
  score: number;
  steps: number;
}

export interface Results {
  players: { name: string; episodes: ResultEpisode[] }[];
}

export interface Talk {
  frame: number;
  prompt: string;
  answer: string;
  reasoning?: string;
  parsed: string | null;
  validity: string | null;
}

export interface ResultReplay {
  title: string;
  player?: string;
  agrees?: boolean;
  note?: string | null;
  tiles: Tile[];
  frames: SentFrame[];
  actions: string[];
  talk: Talk[];
}

export interface JudgeSide {
  title: string;
  describe: string;
  source: string;
  levels: string[];
}

export type Side = 'left' | 'right';

export interface JudgePair {
  pair: number;
  of: number;
  done: boolean;
  left: JudgeSide | null;
  right: JudgeSide | null;
}

/** What the judgements say; while pairs are left to be judged blindly, only how many are judged. */
export type JudgeReport =
  | { blind: true; judged: number; of: number }
  | {
      blind: false;
      judged: number;
      of: number;
      sources: { name: string; wins: number; losses: number; ties: number; rate: number | null; low: number; high: number }[];
      measures: { name: string; agrees: number; pairs: number; rate: number | null; low: number; high: number }[];
    };
