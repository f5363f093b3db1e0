import { useEffect, useLayoutEffect, useMemo, useRef, useState } from 'preact/hooks';
import { post, words } from '../data/api';
import { address, Tileset } from '../data/tiles';
import type { BoardAnswer, Frame, LegendEntry, Problem, Tile } from '../data/types';
import { cellFor, colour, type Highlight, onScheme } from '../parts/Board';
import { Icon } from '../parts/Icon';
import { Words } from '../parts/Markdown';
import { arrows } from '../parts/arrows';
import { area, at, type EdgeName, type Grid, grow, line, paint, parse, print, shrink, widthOf } from './grid';

interface Props {
  source: string;
  text: string;
  legend: LegendEntry[];
  tiles: Tile[];
  problems: Problem[];
  highlights: Highlight[];
  /** The symbol that is painted; null until one is chosen. */
  brush: string | null;
  onBrush: (symbol: string) => void;
  onChange: (text: string, stroke: number) => void;
  onUndo: () => void;
  onRedo: () => void;
  canUndo: boolean;
  canRedo: boolean;
}

/** The last board that the server drew, and the text that it drew. */
interface Drawn {
  tiles: Tileset;
  frame: Frame;
  grid: Grid;
}

let strokes = 0;

/** A level painted on its board, with the legend as the palette. */
export function LevelEditor(props: Props) {
  const { source, text, legend, tiles, highlights, onChange, brush, onBrush: setBrush } = props;
  const [tool, setTool] = useState<'brush' | 'fill'>('brush');
  const [asText, setAsText] = useState(false);
  const [cursor, setCursor] = useState<[number, number] | null>(null);
  const [drawn, setDrawn] = useState<Drawn | null>(null);
  const [error, setError] = useState<string | null>(null);
  const [size, setSize] = useState<[number, number]>([0, 0]);
  const [, redraw] = useState(0);
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const stroke = useRef<{ id: number; grid: Grid; x: number; y: number; symbol: string } | null>(null);

  const grid = useMemo(() => parse(text), [text]);
  const columns = widthOf(grid);
  const rows = grid.length;
  const legendTiles = useMemo(() => new Tileset(tiles), [tiles]);
  const bySymbol = useMemo(() => new Map(legend.map((entry) => [entry.symbol, entry])), [legend]);
  const symbol = brush !== null && (bySymbol.has(brush) || brush === ' ') ? brush : (legend[0]?.symbol ?? '.');
  // What the eraser and Delete leave behind: the symbol of the bare floor, or an empty square.
  const floor = legend.find((entry) => entry.floor)?.symbol ?? ' ';

  useEffect(() => {
    const abort = new AbortController();
    const timer = window.setTimeout(() => {
      post<BoardAnswer>('/api/board', { source, level: text }, abort.signal).then(
        (answer) => {
          setError(null);
          if (!answer.frame) return;
          const next = { tiles: new Tileset(answer.tiles), frame: answer.frame, grid: parse(text) };
          if (next.tiles.ready) return setDrawn(next);
          const stop = next.tiles.whenReady(() => {
            stop();
            if (!abort.signal.aborted) setDrawn(next);
          });
        },
        (failure: unknown) => {
          if (!abort.signal.aborted) setError(words(failure));
        },
      );
    }, 40);
    return () => {
      window.clearTimeout(timer);
      abort.abort();
    };
  }, [source, text]);

  useEffect(() => legendTiles.whenReady(() => redraw((count) => count + 1)), [legendTiles]);
  useEffect(() => onScheme(() => redraw((count) => count + 1)), []);
  useLayoutEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const measure = (): void => setSize([element.clientWidth, element.clientHeight]);
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    return () => observer.disconnect();
  }, [asText]);

  const cell = cellFor(size[0], size[1], columns, rows, 64);
  useLayoutEffect(() => {
    const element = canvas.current;
    const context = element?.getContext('2d');
    if (!element || !context || !size[0]) return;
    const ratio = window.devicePixelRatio || 1;
    const unit = cell * ratio;
    element.width = Math.round(columns * unit);
    element.height = Math.round(rows * unit);
    element.style.width = `${columns * cell}px`;
    element.style.height = `${rows * cell}px`;
    context.fillStyle = colour('--ground');
    context.fillRect(0, 0, element.width, element.height);
    const fits = drawn !== null && drawn.frame.width === columns && drawn.frame.height === rows;
    if (fits) drawn.tiles.draw(context, drawn.frame, unit);
    // Squares that changed since the server drew the board, from the palette.
    for (let y = 0; y < rows; y += 1) {
      for (let x = 0; x < columns; x += 1) {
        const here = at(grid, x, y);
        if (fits && at(drawn.grid, x, y) === here) continue;
        const left = Math.round(x * unit);
        const top = Math.round(y * unit);
        const side = Math.round((x + 1) * unit) - left;
        const high = Math.round((y + 1) * unit) - top;
        context.fillStyle = colour('--ground');
        context.fillRect(left, top, side, high);
        const tile = bySymbol.get(here)?.tile;
        if (tile !== null && tile !== undefined) legendTiles.stamp(context, tile, left, top, side, high);
        else if (here.trim()) {
          context.fillStyle = colour('--board-ink');
          context.font = `${Math.round(unit * 0.6)}px ui-monospace, monospace`;
          context.textAlign = 'center';
          context.textBaseline = 'middle';
          context.fillText(here, left + side / 2, top + high / 2);
        }
      }
    }
    context.strokeStyle = colour('--grid');
    context.lineWidth = 1;
    context.beginPath();
    for (let x = 0; x <= columns; x += 1) {
      context.moveTo(Math.round(x * unit) + 0.5, 0);
      context.lineTo(Math.round(x * unit) + 0.5, element.height);
    }
    for (let y = 0; y <= rows; y += 1) {
      context.moveTo(0, Math.round(y * unit) + 0.5);
      context.lineTo(element.width, Math.round(y * unit) + 0.5);
    }
    context.stroke();
    const ring = (x: number, y: number, name: string): void => {
      context.strokeStyle = colour(name);
      context.lineWidth = 3 * ratio;
      context.strokeRect(x * unit + 1.5 * ratio, y * unit + 1.5 * ratio, unit - 3 * ratio, unit - 3 * ratio);
    };
    for (const problem of props.problems) for (const [x, y] of spanOf(problem)) ring(x, y, '--bad');
    for (const spot of highlights) ring(spot.x, spot.y, '--warm');
    if (cursor) {
      context.fillStyle = colour('--cursor');
      context.fillRect(cursor[0] * unit, cursor[1] * unit, unit, unit);
      ring(cursor[0], cursor[1], '--fill');
    }
  });

  const squareAt = (event: PointerEvent): [number, number] | null => {
    const bounds = canvas.current?.getBoundingClientRect();
    if (!bounds) return null;
    const x = Math.floor((event.clientX - bounds.left) / cell);
    const y = Math.floor((event.clientY - bounds.top) / cell);
    return x >= 0 && y >= 0 && x < columns && y < rows ? [x, y] : null;
  };
  const change = (next: Grid, id: number): void => {
    if (next !== grid) onChange(print(next), id);
  };
  const put = (x: number, y: number, what: string): void => {
    strokes += 1;
    if (tool === 'fill') change(area(grid, x, y).reduce((made, [ax, ay]) => paint(made, ax, ay, what), grid), strokes);
    else change(paint(grid, x, y, what), strokes);
  };
  const down = (event: PointerEvent): void => {
    const square = squareAt(event);
    if (!square) return;
    event.preventDefault();
    canvas.current?.focus({ preventScroll: true });
    const [x, y] = square;
    setCursor(null);
    if (event.button === 2 || event.altKey) return setBrush(at(grid, x, y));
    if (event.button !== 0) return undefined;
    if (tool === 'fill') return put(x, y, symbol);
    strokes += 1;
    const next = paint(grid, x, y, symbol);
    stroke.current = { id: strokes, grid: next, x, y, symbol };
    canvas.current?.setPointerCapture(event.pointerId);
    return change(next, strokes);
  };
  const move = (event: PointerEvent): void => {
    const going = stroke.current;
    const square = going && squareAt(event);
    if (!going || !square || (square[0] === going.x && square[1] === going.y)) return;
    going.grid = line(going.x, going.y, square[0], square[1]).reduce((made, [x, y]) => paint(made, x, y, going.symbol), going.grid);
    [going.x, going.y] = square;
    onChange(print(going.grid), going.id);
  };
  const key = (event: KeyboardEvent): void => {
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'z') {
      event.preventDefault();
      return event.shiftKey ? props.onRedo() : props.onUndo();
    }
    if ((event.ctrlKey || event.metaKey) && event.key.toLowerCase() === 'y') {
      event.preventDefault();
      return props.onRedo();
    }
    if (event.ctrlKey || event.metaKey || event.altKey || event.key === 'Tab') return undefined;
    const [x, y] = cursor ?? [0, 0];
    const ways: Record<string, [number, number]> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
    const way = ways[event.key];
    if (way) {
      event.preventDefault();
      const to: [number, number] = cursor
        ? [Math.max(0, Math.min(columns - 1, x + way[0])), Math.max(0, Math.min(rows - 1, y + way[1]))]
        : [0, 0];
      if (event.shiftKey && cursor) put(to[0], to[1], symbol);
      return setCursor(to);
    }
    if (event.key === 'Escape') return setCursor(null);
    if (!cursor) return undefined;
    if (event.key === ' ' || event.key === 'Enter') {
      event.preventDefault();
      return put(x, y, symbol);
    }
    if (event.key === 'Delete' || event.key === 'Backspace') {
      event.preventDefault();
      return put(x, y, floor);
    }
    if (bySymbol.has(event.key)) {
      event.preventDefault();
      setBrush(event.key);
      return put(x, y, event.key);
    }
    return undefined;
  };
  const said = cursor
    ? `Column ${cursor[0] + 1}, row ${cursor[1] + 1}: ${bySymbol.get(at(grid, cursor[0], cursor[1]))?.types.join(', ') ?? at(grid, cursor[0], cursor[1])}`
    : '';
  const resize = (way: typeof grow, edge: EdgeName): void => {
    strokes += 1;
    change(way(grid, edge), strokes);
  };
  return (
    <div class="level-editor">
      <div class="tools" role="toolbar" aria-label="Painting">
        <div class="segments small">
          <button type="button" aria-pressed={tool === 'brush' && !asText} onClick={() => { setTool('brush'); setAsText(false); }}>Brush</button>
          <button type="button" aria-pressed={tool === 'fill' && !asText} onClick={() => { setTool('fill'); setAsText(false); }}>Fill</button>
          <button type="button" aria-pressed={asText} onClick={() => setAsText(true)}>Text</button>
        </div>
        <button type="button" class="round" aria-label="Undo (Ctrl-Z)" title="Undo (Ctrl-Z)" disabled={!props.canUndo} onClick={props.onUndo}><Icon name="undo" /></button>
        <button type="button" class="round flip" aria-label="Redo (Ctrl-Shift-Z)" title="Redo (Ctrl-Shift-Z)" disabled={!props.canRedo} onClick={props.onRedo}><Icon name="undo" /></button>
        <details class="menu">
          <summary>{`${columns} × ${rows}`}</summary>
          <div class="sizes">
            {(['top', 'right', 'bottom', 'left'] as const).map((edge) => (
              <div class="row">
                <span>{edge}</span>
                <button type="button" class="round" aria-label={`Add at the ${edge}`} onClick={() => resize(grow, edge)}><Icon name="plus" /></button>
                <button type="button" class="round" aria-label={`Remove at the ${edge}`} onClick={() => resize(shrink, edge)}><Icon name="minus" /></button>
              </div>
            ))}
          </div>
        </details>
      </div>
      <div class="palette" role="radiogroup" aria-label="Palette" onKeyDown={arrows}>
        {legend.map((entry) => {
          const tile = entry.tile === null ? undefined : tiles[entry.tile];
          return (
            <button type="button" role="radio" tabIndex={entry.symbol === symbol ? 0 : -1} aria-checked={entry.symbol === symbol} title={entry.label} aria-label={`${entry.types.join(', ')}, symbol ${entry.symbol}`} onClick={() => setBrush(entry.symbol)}>
              <span class="swatch">{tile ? <img src={address(tile)} alt="" width="28" height="28" /> : <b>{entry.symbol}</b>}</span>
              <span class="name">{entry.types.join(', ')}</span>
              <kbd>{entry.symbol}</kbd>
            </button>
          );
        })}
        {legend.length > 0 && floor === ' ' && (
          <button type="button" role="radio" tabIndex={symbol === ' ' ? 0 : -1} aria-checked={symbol === ' '} title="Eraser: a space is an empty square" aria-label="eraser, an empty square" onClick={() => setBrush(' ')}>
            <span class="swatch"><Icon name="eraser" /></span>
            <span class="name">eraser</span>
          </button>
        )}
        {legend.length === 0 && <p class="soft">The palette appears once the rules compile.</p>}
      </div>
      {asText ? (
        <textarea class="level-text" aria-label="Level as text" spellcheck={false} value={text} onInput={(event) => { strokes += 1; onChange(event.currentTarget.value, strokes); }} />
      ) : (
        <div class="board paint" ref={box} style={{ '--ratio': rows / columns }}>
          <canvas
            ref={canvas}
            tabIndex={0}
            role="application"
            aria-roledescription="level"
            aria-label={`Level, ${columns} columns and ${rows} rows. Arrow keys move, space paints, a symbol paints itself.`}
            onPointerDown={down}
            onPointerMove={move}
            onPointerUp={() => { stroke.current = null; }}
            onPointerCancel={() => { stroke.current = null; }}
            onContextMenu={(event) => event.preventDefault()}
            onKeyDown={key}
            onBlur={() => setCursor(null)}
          />
        </div>
      )}
      <p class="under" role="status"><Words text={said || error || ' '} /></p>
    </div>
  );
}

/** The squares of a level's problem; none of those that are about the level as a whole. */
export function spanOf(problem: Problem): [number, number][] {
  const isWhole = problem.code === 'no-avatar' || problem.start === problem.end;
  return isWhole ? [] : Array.from({ length: problem.end - problem.start }, (_, step) => [problem.column - 1 + step, problem.line - 1]);
}
