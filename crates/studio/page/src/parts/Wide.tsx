import type { ComponentChildren } from 'preact';

/** A table that may be wider than the screen: it scrolls by itself, with the keyboard too. */
export function Wide({ name, children }: { name: string; children: ComponentChildren }) {
  return <div class="wide" role="region" aria-label={name} tabIndex={0}>{children}</div>;
}
