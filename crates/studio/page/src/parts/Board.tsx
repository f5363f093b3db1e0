import { useEffect, useLayoutEffect, useRef, useState } from 'preact/hooks';
import { Tileset } from '../data/tiles';
import type { Frame, Tile } from '../data/types';

/** Colours of the style sheet by name; the canvas follows light and dark. */
export function colour(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Calls back when the system changes between light and dark. */
export function onScheme(call: () => void): () => void {
  const query = matchMedia('(prefers-color-scheme: dark)');
  query.addEventListener('change', call);
  return () => query.removeEventListener('change', call);
}

/** The largest cell, in CSS pixels, with which a board fits into a box. */
export function cellFor(width: number, height: number, columns: number, rows: number, limit: number): number {
  return Math.max(4, Math.min(limit, Math.floor(Math.min(width / columns, height / rows))));
}

export interface Highlight {
  x: number;
  y: number;
}

interface BoardProps {
  tiles: Tileset;
  frame: Frame | undefined;
  label: string;
  highlights?: Highlight[];
  /** The largest cell in CSS pixels. */
  limit?: number;
}

/** A frame on a canvas, as large as its box allows. */
export function Board({ tiles, frame, label, highlights, limit = 96 }: BoardProps) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [size, setSize] = useState<[number, number]>([0, 0]);
  const [, setLoads] = useState(0);

  useLayoutEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const measure = (): void => setSize([element.clientWidth, element.clientHeight]);
    measure();
    const observer = new ResizeObserver(measure);
    observer.observe(element);
    return () => observer.disconnect();
  }, []);

  useEffect(() => {
    setLoads((count) => count + 1);
    return tiles.whenReady(() => setLoads((count) => count + 1));
  }, [tiles]);
  useEffect(() => onScheme(() => setLoads((count) => count + 1)), []);

  useLayoutEffect(() => {
    const element = canvas.current;
    const context = element?.getContext('2d');
    if (!element || !context || !frame || !size[0]) return;
    const cell = cellFor(size[0], size[1], frame.width, frame.height, limit);
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(frame.width * cell * ratio);
    const height = Math.round(frame.height * cell * ratio);
    if (element.width !== width) element.width = width;
    if (element.height !== height) element.height = height;
    element.style.width = `${frame.width * cell}px`;
    element.style.height = `${frame.height * cell}px`;
    context.clearRect(0, 0, width, height);
    tiles.draw(context, frame, cell * ratio);
    context.lineWidth = 3 * ratio;
    context.strokeStyle = colour('--warm');
    for (const { x, y } of highlights ?? []) {
      context.strokeRect((x * cell + 1.5) * ratio, (y * cell + 1.5) * ratio, (cell - 3) * ratio, (cell - 3) * ratio);
    }
  });

  return (
    <div class="board" ref={box} style={frame ? { '--ratio': frame.height / frame.width } : {}}>
      <canvas ref={canvas} role="img" aria-label={label} />
    </div>
  );
}

/** A small board for lists: its images are decoded and drawn once it comes near the visible part. */
export function Thumb({ tiles, frame, label }: { tiles: Tile[]; frame: Frame | null; label: string }) {
  const box = useRef<HTMLDivElement>(null);
  const canvas = useRef<HTMLCanvasElement>(null);
  const [near, setNear] = useState(false);
  useEffect(() => {
    const element = box.current;
    if (!element) return undefined;
    const observer = new IntersectionObserver((entries) => {
      if (entries.some((entry) => entry.isIntersecting)) setNear(true);
    }, { rootMargin: '300px' });
    observer.observe(element);
    return () => observer.disconnect();
  }, []);
  useEffect(() => {
    const context = canvas.current?.getContext('2d');
    const element = canvas.current;
    if (!near || !frame || !context || !element) return undefined;
    const set = new Tileset(tiles);
    const cell = Math.max(8, Math.ceil((640 / Math.max(frame.width, frame.height * 1.5))));
    const draw = (): void => {
      element.width = frame.width * cell;
      element.height = frame.height * cell;
      set.draw(context, frame, cell);
    };
    if (set.ready) draw();
    return set.whenReady(draw);
  }, [near, frame, tiles]);
  const shape = frame ? `${frame.width} / ${frame.height}` : '3 / 2';
  return (
    <div class="thumb" ref={box}>
      {frame ? <canvas ref={canvas} role="img" aria-label={label} style={{ aspectRatio: shape }} /> : <span class="nothing">no board</span>}
    </div>
  );
}
