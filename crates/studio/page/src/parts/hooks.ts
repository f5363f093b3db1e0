import { useEffect, useLayoutEffect, useReducer, useState } from 'preact/hooks';
import { words } from '../data/api';
import type { Run } from '../data/run';

/** The answer to a question, its failure, or neither yet. */
export interface Asked<T> {
  value: T | null;
  error: string | null;
}

/** Asks again when a dependency changes; late answers to earlier questions are dropped. */
export function useAsked<T>(ask: (signal: AbortSignal) => Promise<T>, dependencies: readonly unknown[]): Asked<T> {
  const [state, setState] = useState<Asked<T>>({ value: null, error: null });
  useEffect(() => {
    const abort = new AbortController();
    setState({ value: null, error: null });
    ask(abort.signal).then(
      (value) => {
        if (!abort.signal.aborted) setState({ value, error: null });
      },
      (error: unknown) => {
        if (!abort.signal.aborted) setState({ value: null, error: words(error) });
      },
    );
    return () => abort.abort();
  }, dependencies);
  return state;
}

/** Draws again when a run changes; from the first paint on, since a key may change it then. */
export function useRun(run: Run | null): void {
  const [, again] = useReducer((count: number) => count + 1, 0);
  useLayoutEffect(() => run?.listen(() => again(undefined as never)), [run]);
}

/** Names the page in the tab and in the history. */
export function useTitle(title: string): void {
  useEffect(() => {
    document.title = title ? `${title} · Infinite Arcade` : 'Infinite Arcade';
  }, [title]);
}
