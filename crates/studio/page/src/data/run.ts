import { post, words } from './api';
import { unfold } from './frames';
import { Tileset } from './tiles';
import type { Episode, Frame, Replay, Tile } from './types';

export const NIL = 'ACTION_NIL';

/** Paces in ticks a second; those below 2 are slow motion. */
export const PACES = [0.5, 1, 2, 4, 8, 16, 32] as const;

/**
 * One timeline on a board: frames from the start on, and a place in them. A replay has all its frames; a live run gets one more
 * with each act, and going back before acting drops what came after.
 */
export class Run {
  readonly tiles = new Tileset();
  frames: Frame[] = [];
  actions: string[] = [];
  at = 0;
  pace: number = 8;
  clock = false;
  turns = true;
  planner: string | null = null;
  error: string | null = null;
  note: string | null = null;
  private session: string | null = null;
  private serverTick = 0;
  private busy = false;
  private queued: string | null = null;
  private held: string | null = null;
  private tapped: string | null = null;
  private timer = 0;
  private closed = false;
  private readonly listeners = new Set<() => void>();

  private constructor(readonly kind: 'live' | 'replay') {}

  static replay(replay: Replay): Run {
    const run = new Run('replay');
    run.tiles.add(replay.tiles);
    run.frames = unfold(replay.frames);
    run.actions = replay.actions;
    run.note = replay.agrees ? replay.note : (replay.note ?? 'This replay differs from the recording.');
    return run;
  }

  static async begin(source: string, level: string, seed: string, turns: boolean): Promise<Run> {
    const run = new Run('live');
    const answer = await post<{ session: string; tiles: Tile[]; frame: Frame }>('/api/play/begin', { source, level, seed });
    run.session = answer.session;
    run.tiles.add(answer.tiles);
    run.frames = [answer.frame];
    run.turns = turns;
    return run;
  }

  get frame(): Frame | undefined {
    return this.frames[this.at];
  }

  get over(): boolean {
    return (this.frame?.outcome ?? 'playing') !== 'playing';
  }

  get atEnd(): boolean {
    return this.at >= this.frames.length - 1;
  }

  /** The most ticks that were reached: how long someone played, for judging. */
  get reached(): number {
    return this.frames.length - 1;
  }

  listen(call: () => void): () => void {
    this.listeners.add(call);
    return () => this.listeners.delete(call);
  }

  private changed(): void {
    for (const call of [...this.listeners]) call();
  }

  close(): void {
    this.closed = true;
    this.stop();
  }

  go(at: number): void {
    this.at = Math.max(0, Math.min(at, this.frames.length - 1));
    this.changed();
  }

  undo(): void {
    this.stop();
    this.go(this.at - 1);
  }

  restart(): void {
    this.stop();
    this.go(0);
  }

  setPace(pace: number): void {
    this.pace = pace;
    this.changed();
  }

  faster(by: number): void {
    const near = PACES.findIndex((pace) => pace >= this.pace);
    this.setPace(PACES[Math.max(0, Math.min(PACES.length - 1, (near < 0 ? PACES.length - 1 : near) + by))] ?? 8);
  }

  setTurns(turns: boolean): void {
    this.turns = turns;
    if (turns) this.stop();
    this.changed();
  }

  setPlanner(planner: string | null): void {
    this.planner = planner;
    this.changed();
  }

  /** Starts or stops the clock: of a replay, of a game in real time, or of a planner that plays. */
  toggle(): void {
    if (this.clock) this.stop();
    else this.start();
  }

  start(): void {
    if (this.clock || this.closed) return;
    if (this.kind === 'replay' && this.atEnd) this.at = 0;
    if (this.kind === 'live' && (this.over || (this.turns && this.planner === null))) return;
    this.clock = true;
    this.timer = window.setTimeout(() => void this.tick(), 0);
    this.changed();
  }

  stop(): void {
    window.clearTimeout(this.timer);
    if (!this.clock) return;
    this.clock = false;
    this.changed();
  }

  private async tick(): Promise<void> {
    const began = performance.now();
    if (this.kind === 'replay') {
      if (this.atEnd) return this.stop();
      this.go(this.at + 1);
    } else if (this.planner !== null) {
      await this.act(null);
    } else {
      const action = this.tapped ?? this.held ?? NIL;
      this.tapped = null;
      await this.act(action);
    }
    if (!this.clock || this.closed) return;
    if (this.kind === 'live' && this.over) return this.stop();
    this.timer = window.setTimeout(() => void this.tick(), Math.max(0, 1000 / this.pace - (performance.now() - began)));
  }

  /** A key or a button of the pad goes down. */
  press(action: string): void {
    if (this.kind !== 'live') return;
    this.held = action;
    if (this.turns || this.planner !== null) {
      void this.act(action);
    } else {
      this.tapped = action;
      this.start();
    }
  }

  release(action: string): void {
    if (this.held === action) this.held = null;
  }

  /** Plays one tick: the action, or what the planner chooses if the action is null. */
  async act(action: string | null): Promise<void> {
    if (this.kind !== 'live' || this.over || this.closed) return;
    if (this.busy) {
      this.queued = action;
      return;
    }
    this.busy = true;
    try {
      await this.catchUp();
      const asked = { session: this.session, action, planner: action === null ? this.planner : null };
      const answer = await post<{ tiles: Tile[]; frame: Frame; action: string }>('/api/play/act', asked);
      this.tiles.add(answer.tiles);
      this.frames = [...this.frames.slice(0, this.serverTick + 1), answer.frame];
      this.actions = [...this.actions.slice(0, this.serverTick), answer.action];
      this.serverTick += 1;
      this.at = this.serverTick;
      this.error = null;
    } catch (error) {
      this.error = words(error);
      this.stop();
    } finally {
      this.busy = false;
    }
    const next = this.queued;
    this.queued = null;
    this.changed();
    if (next !== null && !this.clock) await this.act(next);
  }

  /** Tells the server the place shown, if someone went back since it played. */
  private async catchUp(): Promise<void> {
    const tick = this.at;
    if (this.serverTick === tick) return;
    const answer = await post<{ tiles: Tile[] }>('/api/play/seek', { session: this.session, tick });
    this.tiles.add(answer.tiles);
    this.serverTick = tick;
  }

  /** The episode up to the place shown. */
  async episode(): Promise<Episode> {
    this.stop();
    // A tick that is under way is part of it.
    while (this.busy) await new Promise((resolve) => window.setTimeout(resolve, 10));
    await this.catchUp();
    this.frames = this.frames.slice(0, this.at + 1);
    this.actions = this.actions.slice(0, this.at);
    this.changed();
    return post('/api/play/episode', { session: this.session });
  }
}

/** The directions and the action in words. */
export function actionWords(action: string): string {
  const word = action.replace(/^ACTION_/, '').toLowerCase();
  return word === 'nil' ? 'wait' : word;
}
