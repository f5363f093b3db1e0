import { useState } from 'preact/hooks';
import { post, words } from '../data/api';
import type { Workspace } from '../data/types';
import { Dialog } from '../parts/Dialog';
import { go } from '../parts/route';

/** Asks for the genre and the title of a new game, and opens it to be changed. */
export function NewDialog({ workspace, onClose, onBegun }: { workspace: Workspace; onClose: () => void; onBegun: () => void }) {
  const [title, setTitle] = useState('My first game');
  const [genre, setGenre] = useState(workspace.templates[0]?.genre ?? '');
  const [error, setError] = useState<string | null>(null);
  const begin = async (): Promise<void> => {
    try {
      const made = await post<{ id: string }>('/api/new', { genre, title });
      onBegun();
      onClose();
      go('design', made.id, 0);
    } catch (failure) {
      setError(words(failure));
    }
  };
  return (
    <Dialog title="New game" onClose={onClose}>
      <p>A small commented game with two levels, ready to play and to change. The game is written to a new folder.</p>
      <form onSubmit={(event) => { event.preventDefault(); void begin(); }}>
        <label class="field">Title<input value={title} onInput={(event) => setTitle(event.currentTarget.value)} autofocus /></label>
        <ul class="genres" role="radiogroup" aria-label="Kind of game">
          {workspace.templates.map((one) => (
            <li><label><input type="radio" name="genre" checked={one.genre === genre} onChange={() => setGenre(one.genre)} /><span><strong>{one.genre}</strong>: {one.about}</span></label></li>
          ))}
        </ul>
        {error && <p class="notice bad" role="alert">{error}</p>}
        <div class="buttons"><button type="button" onClick={onClose}>Cancel</button><button class="strong" type="submit" disabled={!title.trim()}>Begin</button></div>
      </form>
    </Dialog>
  );
}
