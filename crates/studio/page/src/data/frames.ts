import type { Frame, Mark, SentFrame } from './types';

/**
 * Frames as they are sent: the marks themselves, or the difference from the frame before as splices (place, number removed, marks
 * put there) in the order in which they are applied.
 */
export function unfold(sent: readonly SentFrame[]): Frame[] {
  let before: Mark[] = [];
  return sent.map((frame) => {
    const { change, ...rest } = frame;
    const marks = frame.marks ?? [...before];
    if (!frame.marks) for (const [at, removed, put] of change ?? []) marks.splice(at, removed, ...put);
    before = marks;
    return { ...rest, marks };
  });
}
