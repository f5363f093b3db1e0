/** The transport: every request carries the token, failures become `Failure`, streams are read line by line. */

const KEY = 'arcade-studio-token';
const STOPPED = 'Is `arcade studio` still running in the terminal? Start it again, then reload.';

/** An answer of the server that says no, with the next move if it names one. */
export class Failure extends Error {
  constructor(
    message: string,
    readonly help: string | null,
    readonly status: number,
    readonly body: Record<string, unknown>,
  ) {
    super(message);
  }
}

let token = '';

/** This page among others of the same browser: a newer question of it ends the older stream. */
const page = Array.from(crypto.getRandomValues(new Uint32Array(2)), (part) => part.toString(36)).join('');

/** Takes the token from the address, keeps it for reloads of this tab, and takes it out of the address bar (the history of some browsers keeps it). */
export function takeToken(): void {
  const here = new URL(location.href);
  const given = here.searchParams.get('token');
  if (given) {
    token = given;
    try {
      sessionStorage.setItem(KEY, given);
    } catch {
      return; // Without storage the token stays in the address, so that a reload still works.
    }
    here.searchParams.delete('token');
    history.replaceState(null, '', here.pathname + here.search + here.hash);
    return;
  }
  try {
    token = sessionStorage.getItem(KEY) ?? '';
  } catch {
    token = '';
  }
}

async function request(method: string, path: string, body?: unknown, signal?: AbortSignal): Promise<Response> {
  const headers: Record<string, string> = { 'X-Arcade-Token': token, 'X-Arcade-Page': page };
  const init: RequestInit = { method, headers };
  if (signal) init.signal = signal;
  if (body !== undefined) {
    headers['Content-Type'] = 'application/json';
    init.body = JSON.stringify(body);
  }
  let answer: Response;
  try {
    answer = await fetch(path, init);
  } catch (error) {
    if (signal?.aborted) throw error;
    throw new Failure('The studio does not answer.', STOPPED, 0, {});
  }
  if (answer.ok) return answer;
  let said: Record<string, unknown> = {};
  try {
    said = (await answer.json()) as Record<string, unknown>;
  } catch {
    said = {};
  }
  let message = typeof said.error === 'string' ? said.error : `The studio answered ${answer.status}.`;
  let help = typeof said.help === 'string' ? said.help : null;
  if (answer.status === 403 && !token) {
    message = 'This page has no token.';
    help = 'Open the address that `arcade studio` printed in the terminal, with its token.';
  }
  throw new Failure(message, help, answer.status, said);
}

export async function get<T>(path: string, signal?: AbortSignal): Promise<T> {
  return (await (await request('GET', path, undefined, signal)).json()) as T;
}

export async function post<T>(path: string, body: unknown, signal?: AbortSignal): Promise<T> {
  return (await (await request('POST', path, body, signal)).json()) as T;
}

export async function put<T>(path: string, body: unknown): Promise<T> {
  return (await (await request('PUT', path, body)).json()) as T;
}

export async function remove(path: string, body: unknown): Promise<void> {
  await request('DELETE', path, body);
}

/** Yields the objects of a stream as they come; ends quietly when the signal aborts it. */
export async function* stream<T>(path: string, body: unknown, signal: AbortSignal): AsyncGenerator<T> {
  try {
    const answer = await request('POST', path, body, signal);
    const reader = answer.body?.pipeThrough(new TextDecoderStream()).getReader();
    if (!reader) return;
    let rest = '';
    for (;;) {
      const { value, done } = await reader.read();
      rest += value ?? '';
      const lines = rest.split('\n');
      rest = done ? '' : (lines.pop() ?? '');
      for (const line of lines) if (line.trim()) yield JSON.parse(line) as T;
      if (done) return;
    }
  } catch (error) {
    if (signal.aborted) return;
    // A connection that breaks, or a line that is cut off.
    if (error instanceof Failure) throw error;
    throw new Failure("The studio's answer was cut off.", STOPPED, 0, {});
  }
}

/** The words for any failure. */
export function words(error: unknown): string {
  if (error instanceof Failure) return error.help ? `${error.message}${/[.!?]$/.test(error.message) ? '' : ';'} ${error.help}` : error.message;
  return error instanceof Error ? error.message : String(error);
}

export const segment = encodeURIComponent;
