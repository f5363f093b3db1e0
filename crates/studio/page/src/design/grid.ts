/** A level as rows of symbols; rows may differ in length, as in the file. */
export type Grid = string[][];

export function parse(text: string): Grid {
  const lines = text.replace(/\r\n?/g, '\n').split('\n');
  while (lines.length > 1 && lines[lines.length - 1] === '') lines.pop();
  return lines.map((line) => Array.from(line));
}

export function print(grid: Grid): string {
  return grid.map((row) => row.join('')).join('\n') + '\n';
}

export function widthOf(grid: Grid): number {
  return Math.max(1, ...grid.map((row) => row.length));
}

export function at(grid: Grid, x: number, y: number): string {
  return grid[y]?.[x] ?? ' ';
}

/** The grid with a symbol on a square; a short row is filled up to it. */
export function paint(grid: Grid, x: number, y: number, symbol: string): Grid {
  if (at(grid, x, y) === symbol && grid[y] && x < grid[y].length) return grid;
  return grid.map((row, index) => {
    if (index !== y) return row;
    const next = [...row];
    while (next.length < x) next.push(' ');
    next[x] = symbol;
    return next;
  });
}

/** The squares of a line between two squares, so that a fast stroke leaves no gaps. */
export function line(x0: number, y0: number, x1: number, y1: number): [number, number][] {
  const steps = Math.max(Math.abs(x1 - x0), Math.abs(y1 - y0), 1);
  return Array.from({ length: steps + 1 }, (_, step) => [
    Math.round(x0 + ((x1 - x0) * step) / steps),
    Math.round(y0 + ((y1 - y0) * step) / steps),
  ]);
}

/** All squares of the symbol that are joined to a square, for filling. */
export function area(grid: Grid, x: number, y: number): [number, number][] {
  const wanted = at(grid, x, y);
  const width = widthOf(grid);
  const seen = new Set<string>();
  const found: [number, number][] = [];
  const open: [number, number][] = [[x, y]];
  while (open.length > 0) {
    const [cx, cy] = open.pop() as [number, number];
    const key = `${cx} ${cy}`;
    if (cx < 0 || cy < 0 || cx >= width || cy >= grid.length || seen.has(key) || at(grid, cx, cy) !== wanted) continue;
    seen.add(key);
    found.push([cx, cy]);
    open.push([cx + 1, cy], [cx - 1, cy], [cx, cy + 1], [cx, cy - 1]);
  }
  return found;
}

export type EdgeName = 'left' | 'right' | 'top' | 'bottom';

/** The grid with a column or a row more, copied from the edge, so that a border of walls stays one. */
export function grow(grid: Grid, edge: EdgeName): Grid {
  const width = widthOf(grid);
  const full = grid.map((row) => [...row, ...Array<string>(width - row.length).fill(' ')]);
  switch (edge) {
    case 'left':
      return full.map((row) => [row[0] ?? ' ', ...row]);
    case 'right':
      return full.map((row) => [...row, row[width - 1] ?? ' ']);
    case 'top':
      return [[...(full[0] ?? [])], ...full];
    case 'bottom':
      return [...full, [...(full[full.length - 1] ?? [])]];
  }
}

export function shrink(grid: Grid, edge: EdgeName): Grid {
  const width = widthOf(grid);
  if ((edge === 'left' || edge === 'right') && width <= 1) return grid;
  if ((edge === 'top' || edge === 'bottom') && grid.length <= 1) return grid;
  switch (edge) {
    case 'left':
      return grid.map((row) => row.slice(1));
    case 'right':
      return grid.map((row) => row.slice(0, width - 1));
    case 'top':
      return grid.slice(1);
    case 'bottom':
      return grid.slice(0, -1);
  }
}
