import { useEffect, useLayoutEffect, useRef } from 'preact/hooks';
import { Board } from './Board';
import { Icon, type IconName } from './Icon';
import { useRun } from './hooks';
import { actionWords, NIL, PACES, type Run } from '../data/run';

const KEYS: Record<string, string> = {
  ArrowLeft: 'ACTION_LEFT',
  ArrowRight: 'ACTION_RIGHT',
  ArrowUp: 'ACTION_UP',
  ArrowDown: 'ACTION_DOWN',
  a: 'ACTION_LEFT',
  d: 'ACTION_RIGHT',
  w: 'ACTION_UP',
  s: 'ACTION_DOWN',
  ' ': 'ACTION_USE',
  '.': NIL,
};

interface PlayerProps {
  run: Run;
  /** The name of the board for screen readers. */
  label: string;
  /** Where keys are taken from: anywhere on the page, or only when the player has the focus. */
  keys: 'page' | 'focus';
  compact?: boolean;
}

/** The board of a run with its caption, its transport and, for live runs, the pad. */
export function Player({ run, label, keys, compact }: PlayerProps) {
  useRun(run);
  const root = useRef<HTMLElement>(null);

  // Before the first paint: whoever sees the board may press a key.
  useLayoutEffect(() => {
    const target: HTMLElement | Window | null = keys === 'page' ? window : root.current;
    if (!target) return undefined;
    const down = (event: Event): void => {
      if (event instanceof KeyboardEvent && key(run, event)) event.preventDefault();
    };
    const up = (event: Event): void => {
      if (!(event instanceof KeyboardEvent)) return;
      const action = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
      if (action) run.release(action);
    };
    target.addEventListener('keydown', down);
    target.addEventListener('keyup', up);
    return () => {
      target.removeEventListener('keydown', down);
      target.removeEventListener('keyup', up);
    };
  }, [run, keys]);

  useEffect(() => {
    const hidden = (): void => {
      if (document.hidden) run.stop();
    };
    document.addEventListener('visibilitychange', hidden);
    return () => document.removeEventListener('visibilitychange', hidden);
  }, [run]);

  const frame = run.frame;
  const outcome = frame?.outcome ?? 'playing';
  const last = run.frames.length - 1;
  return (
    <section
      class={`player ${compact ? 'compact' : ''}`}
      ref={root}
      tabIndex={keys === 'focus' ? 0 : undefined}
      aria-label={label}
      onPointerDown={() => keys === 'focus' && root.current?.focus({ preventScroll: true })}
    >
      <Board tiles={run.tiles} frame={frame} label={`${label}, tick ${frame?.tick ?? 0}`} />
      <div class="caption">
        <p class="lines" role="status" aria-live="polite">
          {outcome !== 'playing' && <strong class={`outcome ${outcome}`}>{OUTCOMES[outcome]}</strong>}
          {frame && <span>{`Score ${frame.score}`}</span>}
          {frame?.caption.map((line) => <span>{line}</span>)}
        </p>
        {run.kind === 'replay' && run.at > 0 && (
          <span class="chip">{actionWords(run.actions[run.at - 1] ?? NIL)}</span>
        )}
      </div>
      {run.error && <p class="notice bad" role="alert">{run.error}</p>}
      {run.note && <p class="notice">{run.note}</p>}
      <div class="transport" role="group" aria-label="Transport">
        <Button icon="restart" name="Restart (R)" disabled={run.at === 0} onClick={() => run.restart()} />
        <Button icon={run.kind === 'live' ? 'undo' : 'left'} name={run.kind === 'live' ? 'Undo (Z)' : 'Back one tick (Z)'} disabled={run.at === 0} onClick={() => run.undo()} />
        {(run.kind === 'replay' || !run.turns || run.planner !== null) && (
          <Button
            icon={run.clock ? 'pause' : 'play'}
            name={run.clock ? 'Pause (P)' : 'Run (P)'}
            strong
            disabled={run.kind === 'live' && run.over}
            onClick={() => run.toggle()}
          />
        )}
        {(run.kind === 'replay' || run.planner !== null) && (
          <Button icon="step" name="One tick (N)" disabled={run.kind === 'replay' ? run.atEnd : run.over} onClick={() => step(run)} />
        )}
        <input
          class="scrub"
          type="range"
          min={0}
          max={Math.max(last, 0)}
          value={run.at}
          disabled={last < 1}
          aria-label="Rewind"
          aria-valuetext={`tick ${run.at} of ${last}`}
          onInput={(event) => {
            run.stop();
            run.go(Number(event.currentTarget.value));
          }}
        />
        <output class="tick">{run.at}<small>/{last}</small></output>
      </div>
      {(run.kind === 'replay' || !run.turns || run.planner !== null) && (
        <label class="pace">
          <span>Pace</span>
          <input
            type="range"
            min={0}
            max={PACES.length - 1}
            value={Math.max(0, PACES.indexOf(run.pace as (typeof PACES)[number]))}
            aria-valuetext={paceWords(run.pace)}
            onInput={(event) => run.setPace(PACES[Number(event.currentTarget.value)] ?? 8)}
          />
          <span class="soft">{paceWords(run.pace)}</span>
        </label>
      )}
      {run.kind === 'live' && <Pad run={run} />}
    </section>
  );
}

const OUTCOMES = { won: 'Won', lost: 'Lost', draw: 'Over', stopped: 'Stopped', playing: '' } as const;

function paceWords(pace: number): string {
  if (pace < 2) return pace < 1 ? 'slow: a tick in 2 s' : 'slow: a tick a second';
  return `${pace} ticks per second`;
}

function step(run: Run): void {
  run.stop();
  if (run.kind === 'replay') run.go(run.at + 1);
  else void run.act(run.planner === null ? NIL : null);
}

/** Answers a key; says whether it was one of ours. */
function key(run: Run, event: KeyboardEvent): boolean {
  if (event.ctrlKey || event.metaKey || event.altKey) return false;
  const target = event.target;
  if (target instanceof HTMLElement) {
    if (target.closest('input:not([type=checkbox], [type=range]), select, textarea, dialog, .cm-editor')) return false;
    if (event.key === ' ' && target.closest('button, a, summary, input')) return false;
    if (event.key.startsWith('Arrow') && target.closest('input[type=range]')) return false;
  }
  const action = KEYS[event.key] ?? KEYS[event.key.toLowerCase()];
  if (action) {
    if (run.kind === 'replay') {
      if (action === 'ACTION_USE') run.toggle();
      else if (action === 'ACTION_LEFT') run.undo();
      else if (action === 'ACTION_RIGHT') step(run);
      else return false;
      return true;
    }
    if (event.repeat && !run.turns) return true;
    run.press(action);
    return true;
  }
  switch (event.key.toLowerCase()) {
    case 'z':
      run.undo();
      return true;
    case 'r':
      run.restart();
      return true;
    case 'p':
      run.toggle();
      return true;
    case 'n':
      step(run);
      return true;
    case '+':
      run.faster(1);
      return true;
    case '-':
      run.faster(-1);
      return true;
    default:
      return false;
  }
}

export function Button({ icon, name, onClick, disabled, strong }: { icon: IconName; name: string; onClick: () => void; disabled?: boolean; strong?: boolean }) {
  return (
    <button type="button" class={`round ${strong ? 'strong' : ''}`} aria-label={name} title={name} disabled={disabled ?? false} onClick={onClick}>
      <Icon name={icon} />
    </button>
  );
}

/** Arrows and an action button for fingers; shown where the pointer is coarse. */
function Pad({ run }: { run: Run }) {
  const actions = run.frame?.actions ?? [];
  const has = (action: string): boolean => action === NIL || actions.includes(action);
  const one = (action: string, icon: IconName | null, place: string) => {
    let timer = 0;
    const down = (event: PointerEvent): void => {
      event.preventDefault();
      run.press(action);
      window.clearInterval(timer);
      if (run.turns) timer = window.setInterval(() => run.press(action), 220);
      const up = (): void => {
        window.clearInterval(timer);
        run.release(action);
        window.removeEventListener('pointerup', up);
        window.removeEventListener('pointercancel', up);
      };
      window.addEventListener('pointerup', up);
      window.addEventListener('pointercancel', up);
    };
    return (
      <button
        type="button"
        class={`pad-${place}`}
        aria-label={actionWords(action)}
        disabled={!has(action)}
        onPointerDown={down}
        onClick={(event) => {
          // A click without a pointer comes from a keyboard or a screen reader.
          if (event.detail !== 0) return;
          run.press(action);
          run.release(action);
        }}
        onContextMenu={(event) => event.preventDefault()}
      >
        {icon ? <Icon name={icon} /> : actionWords(action)}
      </button>
    );
  };
  return (
    <div class="pad" role="group" aria-label="Pad">
      {one('ACTION_UP', 'up', 'up')}
      {one('ACTION_LEFT', 'left', 'left')}
      {one(NIL, null, 'nil')}
      {one('ACTION_RIGHT', 'right', 'right')}
      {one('ACTION_DOWN', 'down', 'down')}
      {has('ACTION_USE') && one('ACTION_USE', null, 'use')}
    </div>
  );
}
