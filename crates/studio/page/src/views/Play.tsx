import { useEffect, useRef, useState } from 'preact/hooks';
import { get, words } from '../data/api';
import { live } from '../data/studio';
import * as studio from '../data/studio';
import { Run } from '../data/run';
import type { Episode, Game } from '../data/types';
import { Icon } from '../parts/Icon';
import { Markdown } from '../parts/Markdown';
import { Player } from '../parts/Player';
import { useAsked, useRun, useTitle } from '../parts/hooks';
import { go, href } from '../parts/route';
import { Choice } from './Browse';

/** Whether a game waits for the player: by its card, else by its description. */
export function isTurnBased(card: Record<string, unknown> | null, describe: string): boolean {
  if (typeof card?.real_time === 'boolean') return !card.real_time;
  return !/^\s*real-time/im.test(describe);
}

/** Play a level, let a planner play it, or watch a witness or an opened episode. */
export function Play({ game, level, watch }: { game: Game; level: number; watch: string | null }) {
  const [run, setRun] = useState<Run | null>(null);
  const [error, setError] = useState<string | null>(null);
  const [seed, setSeed] = useState('play');
  const [sown, setSown] = useState('play');
  const [budget, setBudget] = useState('400');
  const planners = useAsked<{ name: string; help: string }[]>((signal) => (live ? get('/api/planners', signal) : Promise.resolve([])), []);
  const file = useRef<HTMLInputElement>(null);
  const holds = useRef(0);
  const witness = watch === null ? null : (game.witnesses.find((one) => one.name === watch) ?? null);
  const shownLevel = witness ? studio.levelOf(game, witness) : Math.min(level, game.levels.length - 1);
  const number = studio.numberOf(game.levels, shownLevel);
  useTitle(`${game.title}, level ${number}`);
  useRun(run);

  /** Shows a run when it is there, unless another one was asked for meanwhile. */
  const hold = (make: Promise<Run>): (() => void) => {
    holds.current += 1;
    const mine = holds.current;
    setError(null);
    make.then(
      (made) => {
        if (mine !== holds.current) made.close();
        else setRun((before) => { before?.close(); return made; });
      },
      (failure: unknown) => { if (mine === holds.current) setError(words(failure)); },
    );
    return () => { holds.current += 1; };
  };
  const begin = (): Promise<Run> => {
    setSown(seed);
    return Run.begin(game.source.text, game.levels[shownLevel]?.text ?? '', seed, isTurnBased(game.card, game.describe));
  };
  useEffect(() => {
    setRun((before) => { before?.close(); return null; });
    if (watch !== null && !witness) { setError(`${game.title} has no witness called ${watch}.`); return undefined; }
    return hold(witness ? studio.witness(game, witness).then((replay) => Run.replay(replay)) : begin());
  }, [game, shownLevel, watch]);
  useEffect(() => () => run?.close(), [run]);

  /** Opens a recording on the level that it fits: the one shown first, then the others. */
  const open = async (chosen: File): Promise<Run> => {
    const episode = JSON.parse(await chosen.text()) as Episode;
    const order = [shownLevel, ...game.levels.map((_, index) => index).filter((index) => index !== shownLevel)];
    let first: Run | null = null;
    let failure: unknown = new Error('This file is not an episode of this game.');
    for (const index of order) {
      try {
        const replay = await studio.replay(game.source.text, game.levels[index]?.text ?? '', episode);
        if (replay.agrees) return Run.replay(replay);
        first ??= Run.replay(replay);
      } catch (error) {
        failure = error;
      }
    }
    if (first) return first;
    throw failure;
  };

  const download = async (): Promise<void> => {
    if (!run) return;
    try {
      save(`${game.id}-lvl${number}.json`, JSON.stringify(await run.episode(), null, 1));
    } catch (failure) {
      setError(words(failure));
    }
  };

  const intent = intentOf(game, shownLevel);
  const planner = run?.planner?.split(':')[0] ?? '';
  const choosePlanner = (name: string, calls: string): void => run?.setPlanner(name ? (calls ? `${name}:${calls}` : name) : null);
  return (
    <main class="play">
      <div class="stage">
        {error && <p class="notice bad" role="alert">{error}</p>}
        {run ? <Player run={run} keys="page" label={`${game.title}, level ${number}`} /> : !error && <div class="board" aria-busy="true" />}
      </div>
      <aside class="side" aria-label="About this level">
        <div>
          <h1>{`Level ${number}`}<span class="hidden">{` of ${game.title}`}</span></h1>
          {intent && <p class="soft">{intent}</p>}
        </div>
        {game.levels.length > 1 && (
          <nav class="tabs" aria-label="Levels">
            {game.levels.map((one, index) => (
              <a href={live ? href('play', game.id, index) : watchHref(game, index)} aria-current={index === shownLevel ? 'page' : undefined} title={one.name}>{studio.numberOf(game.levels, index)}</a>
            ))}
          </nav>
        )}
        {run?.kind === 'live' && (
          <div class="group">
            <label class="check"><input type="checkbox" checked={run.turns} onChange={(event) => run.setTurns(event.currentTarget.checked)} /> Wait for me each turn</label>
            <form class="row" onSubmit={(event) => { event.preventDefault(); hold(begin()); }}>
              <label class="field inline">Seed<input class="medium" value={seed} onInput={(event) => setSeed(event.currentTarget.value)} /></label>
              {seed !== sown && <button type="submit">Begin again</button>}
            </form>
          </div>
        )}
        {run?.kind === 'live' && (
          <fieldset class="group">
            <legend>A planner plays</legend>
            <div class="row">
              <Choice label="Planner" all="nobody: you play" value={planner} options={(planners.value ?? []).map((one) => one.name)} onChange={(name) => choosePlanner(name, budget)} />
              {planner && (
                <label class="field inline">Calls<input class="short" inputMode="numeric" value={budget} onInput={(event) => {
                  const calls = event.currentTarget.value.replace(/\D/g, '');
                  setBudget(calls);
                  choosePlanner(planner, calls);
                }} /></label>
              )}
            </div>
            {planner && (
              <>
                <p class="soft">{planners.value?.find((one) => one.name === planner)?.help}</p>
                <div class="row">
                  <button type="button" onClick={() => { run.stop(); void run.act(null); }} disabled={run.over}>Step</button>
                  <button type="button" class="strong" onClick={() => run.toggle()} disabled={run.over}>{run.clock ? 'Pause' : 'Let it run'}</button>
                </div>
              </>
            )}
          </fieldset>
        )}
        <div class="group row">
          {run?.kind === 'live' && <button type="button" onClick={() => void download()} disabled={run.at === 0}><Icon name="save" /> Save episode</button>}
          {live && <button type="button" onClick={() => file.current?.click()}><Icon name="open" /> Open episode</button>}
          {run?.kind === 'replay' && live && <button type="button" class="strong" onClick={() => { if (watch === null) hold(begin()); else go('play', game.id, shownLevel); }}>Play it yourself</button>}
          <input ref={file} type="file" accept=".json,application/json" hidden aria-label="Episode file" onChange={(event) => {
            const chosen = event.currentTarget.files?.[0];
            event.currentTarget.value = '';
            if (chosen) hold(open(chosen));
          }} />
        </div>
        {game.witnesses.length > 0 && (
          <div class="group">
            <h2>Recorded wins</h2>
            <ul class="plain">
              {game.witnesses.map((one) => (
                <li><a href={href('watch', game.id, one.name)} aria-current={one.name === watch ? 'page' : undefined}>{`Level ${studio.numberOf(game.levels, studio.levelOf(game, one))}`}<span class="soft"> {one.name}</span></a></li>
              ))}
            </ul>
          </div>
        )}
        <details class="group" open>
          <summary>How it is played</summary>
          <Markdown text={game.describe} />
        </details>
        <details class="group keys">
          <summary>Keys</summary>
          <dl>
            <div><dt><kbd>←↑↓→</kbd> <kbd>WASD</kbd></dt><dd>move; in replays one tick back or ahead</dd></div>
            <div><dt><kbd>Space</kbd></dt><dd>act; in replays run or pause</dd></div>
            <div><dt><kbd>.</kbd></dt><dd>wait</dd></div>
            <div><dt><kbd>Z</kbd> <kbd>R</kbd></dt><dd>undo, restart</dd></div>
            <div><dt><kbd>P</kbd> <kbd>N</kbd></dt><dd>run or pause, one tick</dd></div>
            <div><dt><kbd>+</kbd> <kbd>−</kbd></dt><dd>pace</dd></div>
          </dl>
        </details>
      </aside>
    </main>
  );
}

/** The sentence of a card on what a level asks. */
export function intentOf(game: Game, level: number): string | null {
  const levels = game.card?.levels;
  const card = Array.isArray(levels) ? (levels[level] as { intent?: unknown; asks?: unknown } | undefined) : undefined;
  const intent = card?.intent ?? card?.asks;
  return typeof intent === 'string' ? intent : null;
}

function watchHref(game: Game, level: number): string {
  const witness = game.witnesses.find((one) => studio.levelOf(game, one) === level);
  return witness ? href('watch', game.id, witness.name) : href('game', game.id);
}

/** Hands a text to the browser as a file. */
function save(name: string, text: string): void {
  const address = URL.createObjectURL(new Blob([text], { type: 'application/json' }));
  const link = document.createElement('a');
  link.href = address;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}
