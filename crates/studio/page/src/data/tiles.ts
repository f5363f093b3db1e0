import type { Frame, Tile } from './types';

/** A decoded tile with its bitmaps by size in pixels. */
interface Picture {
  image: HTMLImageElement;
  bitmaps: Map<string, HTMLCanvasElement>;
}

const pictures = new Map<string, Picture>();
const MOST_PICTURES = 4000;

/** The picture of a tile; equal tiles of different games and sessions share one, so that a changed board does not flicker. */
function pictureOf(tile: Tile): Picture {
  const source = address(tile);
  let picture = pictures.get(source);
  if (!picture) {
    if (pictures.size >= MOST_PICTURES) pictures.clear();
    picture = { image: new Image(), bitmaps: new Map() };
    picture.image.src = source;
    pictures.set(source, picture);
  }
  return picture;
}

/**
 * The tiles of one game or session, drawn as images and never as markup, so that nothing in them can run.
 *
 * A tile is rasterised once for each size in pixels; a frame is then a few hundred copies of bitmaps.
 */
export class Tileset {
  private readonly pictures: Picture[] = [];
  private readonly waiting = new Set<() => void>();
  private pending = 0;

  constructor(tiles: readonly Tile[] = []) {
    this.add(tiles);
  }

  /** Appends tiles; frames that use them may be drawn at once and are drawn again when the images are there. */
  add(tiles: readonly Tile[]): void {
    for (const tile of tiles) {
      const picture = pictureOf(tile);
      this.pictures.push(picture);
      if (picture.image.complete) continue;
      this.pending += 1;
      const loaded = (): void => {
        this.pending -= 1;
        if (this.pending === 0) for (const call of [...this.waiting]) call();
      };
      picture.image.addEventListener('load', loaded, { once: true });
      picture.image.addEventListener('error', loaded, { once: true });
    }
  }

  /** Calls back whenever all images are there; returns the way to stop that. */
  whenReady(call: () => void): () => void {
    this.waiting.add(call);
    return () => this.waiting.delete(call);
  }

  get ready(): boolean {
    return this.pending === 0;
  }

  draw(context: CanvasRenderingContext2D, frame: Frame, cell: number): void {
    for (const [index, x, y, width, height] of frame.marks) {
      // Edges are rounded, not sizes: neighbours meet without a seam.
      const left = Math.round(x * cell);
      const top = Math.round(y * cell);
      this.stamp(context, index, left, top, Math.round((x + width) * cell) - left, Math.round((y + height) * cell) - top);
    }
  }

  stamp(context: CanvasRenderingContext2D, index: number, left: number, top: number, width: number, height: number): void {
    const picture = this.pictures[index];
    if (!picture?.image.complete || picture.image.naturalWidth === 0 || width <= 0 || height <= 0) return;
    const key = `${width} ${height}`;
    let bitmap = picture.bitmaps.get(key);
    if (!bitmap) {
      if (picture.bitmaps.size > 24) picture.bitmaps.clear();
      bitmap = document.createElement('canvas');
      bitmap.width = width;
      bitmap.height = height;
      bitmap.getContext('2d')?.drawImage(picture.image, 0, 0, width, height);
      picture.bitmaps.set(key, bitmap);
    }
    context.drawImage(bitmap, left, top);
  }
}

/** The address of a tile as an image; a size is added, because some browsers draw no image without one. */
export function address(tile: Tile): string {
  const sized = /^<svg[^>]*\swidth=/.test(tile.svg) ? tile.svg : tile.svg.replace('<svg', '<svg width="96" height="96"');
  const named = /^<svg[^>]*\sxmlns=/.test(sized) ? sized : sized.replace('<svg', '<svg xmlns="http://www.w3.org/2000/svg"');
  return `data:image/svg+xml,${encodeURIComponent(named)}`;
}
