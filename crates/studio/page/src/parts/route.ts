import { useEffect, useState } from 'preact/hooks';
import { segment } from '../data/api';

/** The address as parts: `#/play/quiet-jars/0` is `['play', 'quiet-jars', '0']`. */
export type Route = string[];

function read(): Route {
  return location.hash
    .replace(/^#\/?/, '')
    .split('/')
    .filter(Boolean)
    .map((part) => {
      try {
        return decodeURIComponent(part);
      } catch {
        return part;
      }
    });
}

export function href(...parts: (string | number)[]): string {
  return `#/${parts.map((part) => segment(String(part))).join('/')}`;
}

export function go(...parts: (string | number)[]): void {
  location.hash = href(...parts);
}

/** Asks before leaving a view with unsaved changes; the design view sets it. */
export const leaving: { ask: (() => boolean) | null } = { ask: null };

export function useRoute(): Route {
  const [route, setRoute] = useState(read);
  useEffect(() => {
    let address = location.hash;
    const changed = (): void => {
      if (location.hash === address) return;
      if (leaving.ask && !leaving.ask()) {
        history.replaceState(null, '', address || '#/');
        return;
      }
      address = location.hash;
      setRoute(read());
    };
    window.addEventListener('hashchange', changed);
    return () => window.removeEventListener('hashchange', changed);
  }, []);
  return route;
}
