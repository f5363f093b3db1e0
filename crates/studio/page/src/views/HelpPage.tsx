import { post } from '../data/api';
import { Markdown } from '../parts/Markdown';
import { useAsked, useTitle } from '../parts/hooks';
import { href } from '../parts/route';

const PAGES: [string, string][] = [
  ['first-game', 'Your first game'],
  ['studio', 'The studio and its keys'],
  ['sprites', 'Sprites'],
  ['effects', 'Effects'],
  ['terminations', 'Terminations'],
  ['validate', 'The verdict'],
];

/** A page of the manual. */
export function HelpPage({ name }: { name: string }) {
  useTitle('Help');
  const asked = useAsked((signal) => post<{ markdown: string }>('/api/page', { name }, signal), [name]);
  return (
    <main>
      <nav class="tabs" aria-label="Manual">
        {PAGES.map(([page, label]) => <a href={href('help', page)} aria-current={page === name ? 'page' : undefined}>{label}</a>)}
      </nav>
      {asked.error && <p class="notice bad" role="alert">{asked.error}</p>}
      {asked.value && <Markdown text={asked.value.markdown} />}
    </main>
  );
}
