import type { ComponentChild } from 'preact';
import { Wide } from './Wide';

/**
 * The Markdown of descriptions, hovers and manual pages, as nodes: nothing of a text is ever markup. Headings, lists, tables,
 * fences and quotes; code, strong and emphasised words. Links inside the manual have no address here and show as their words.
 */
export function Markdown({ text }: { text: string }) {
  return <div class="prose">{blocks(text.replace(/<!--[\s\S]*?-->/g, '').split('\n'))}</div>;
}

function blocks(lines: string[]): ComponentChild[] {
  const out: ComponentChild[] = [];
  let at = 0;
  const line = (): string => lines[at] ?? '';
  const take = (test: RegExp): string[] => {
    const taken: string[] = [];
    while (at < lines.length && test.test(line())) taken.push(lines[at++] ?? '');
    return taken;
  };
  while (at < lines.length) {
    const fence = /^\s*(```|~~~)/.exec(line());
    const heading = /^(#{1,6})\s+(.*)$/.exec(line());
    if (!line().trim()) {
      at += 1;
    } else if (fence) {
      at += 1;
      const start = at;
      while (at < lines.length && !line().trim().startsWith(fence[1] ?? '```')) at += 1;
      out.push(<pre>{lines.slice(start, at).join('\n')}</pre>);
      at += 1;
    } else if (heading) {
      const words = inline(heading[2] ?? '');
      out.push((heading[1]?.length ?? 1) <= 1 ? <h3>{words}</h3> : <h4>{words}</h4>);
      at += 1;
    } else if (/^\s*\|.*\|\s*$/.test(line())) {
      out.push(table(take(/^\s*\|.*\|\s*$/)));
    } else if (/^\s*>/.test(line())) {
      out.push(<blockquote>{blocks(take(/^\s*>/).map((one) => one.replace(/^\s*> ?/, '')))}</blockquote>);
    } else if (/^\s*([-*]|\d+\.)\s+/.test(line())) {
      const ordered = /^\s*\d+\./.test(line());
      const items: string[] = [];
      while (at < lines.length && line().trim()) {
        const item = /^\s*([-*]|\d+\.)\s+(.*)$/.exec(line());
        if (item) items.push(item[2] ?? '');
        else items[items.length - 1] += ` ${line().trim()}`;
        at += 1;
      }
      const entries = items.map((item) => <li>{inline(item)}</li>);
      out.push(ordered ? <ol>{entries}</ol> : <ul>{entries}</ul>);
    } else if (/^\s{2,}\S/.test(line())) {
      out.push(<div class="indented">{take(/^\s{2,}\S/).map((one) => <p>{inline(one.trim())}</p>)}</div>);
    } else {
      const start = at;
      at += 1;
      while (at < lines.length && line().trim() && !/^(#{1,6}\s|\s*(```|~~~)|\s{2,}\S|\s*[-*]\s|\s*\|)/.test(line())) at += 1;
      out.push(<p>{inline(lines.slice(start, at).join(' '))}</p>);
    }
  }
  return out;
}

function table(rows: string[]): ComponentChild {
  const cells = rows
    .map((row) => row.trim().replace(/^\||\|$/g, '').split('|').map((cell) => cell.trim()))
    .filter((row) => !row.every((cell) => /^:?-+:?$/.test(cell)));
  const [head, ...body] = cells;
  return (
    <Wide name="Table">
      <table>
        <thead><tr>{head?.map((cell) => <th>{inline(cell)}</th>)}</tr></thead>
        <tbody>{body.map((row) => <tr>{row.map((cell) => <td>{inline(cell)}</td>)}</tr>)}</tbody>
      </table>
    </Wide>
  );
}

/** A sentence of a message: names in backquotes are set as code. */
export function Words({ text }: { text: string }) {
  return <>{text.split(/`([^`]*)`/).map((part, index) => (index % 2 === 1 ? <code>{part}</code> : part))}</>;
}

function inline(text: string): ComponentChild[] {
  const out: ComponentChild[] = [];
  const pattern = /`([^`]+)`|\*\*([^*]+)\*\*|\*([^*\s][^*]*)\*|\[([^\]]+)\]\(([^)\s]+)\)/g;
  let from = 0;
  for (const match of text.matchAll(pattern)) {
    out.push(text.slice(from, match.index));
    if (match[1] !== undefined) out.push(<code>{match[1]}</code>);
    else if (match[2] !== undefined) out.push(<strong>{match[2]}</strong>);
    else if (match[3] !== undefined) out.push(<em>{match[3]}</em>);
    else out.push(...inline(match[4] ?? ''));
    from = match.index + match[0].length;
  }
  out.push(text.slice(from));
  return out;
}
