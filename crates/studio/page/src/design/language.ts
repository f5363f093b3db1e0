import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import type { Extension } from '@codemirror/state';
import { tags } from '@lezer/highlight';

/** VGDL by the line: enough for colours; everything that needs understanding is asked of the server. */
const vgdl = StreamLanguage.define<{ section: string; afterArrow: boolean; first: boolean }>({
  name: 'vgdl',
  startState: () => ({ section: '', afterArrow: false, first: true }),
  token(stream, state) {
    if (stream.sol()) {
      state.afterArrow = false;
      state.first = true;
    }
    if (stream.eatSpace()) return null;
    if (stream.match(/^#.*/)) return 'comment';
    if (stream.match(/^>/)) {
      state.afterArrow = true;
      return 'operator';
    }
    const section = state.first ? stream.match(/^(SpriteSet|LevelMapping|InteractionSet|TerminationSet|BasicGame)\b/) : null;
    if (section && section !== true) {
      state.section = section[1] ?? '';
      state.first = false;
      return 'heading';
    }
    if (state.section === 'LevelMapping' && !state.afterArrow) {
      stream.next();
      state.first = false;
      return 'character';
    }
    if (stream.match(/^[A-Za-z_][\w.]*(?==)/)) return 'propertyName';
    if (stream.match(/^=/)) return 'operator';
    if (stream.match(/^-?\d+(\.\d+)?\b/)) return 'number';
    if (stream.match(/^(True|False|true|false)\b/)) return 'bool';
    const word = stream.match(/^[\w.:/+-]+/);
    if (word && word !== true) {
      const text = word[0];
      const first = state.first;
      state.first = false;
      if (state.section === 'TerminationSet' && first) return 'typeName';
      if (state.section === 'InteractionSet' && state.afterArrow) return 'effect';
      if (state.section === 'SpriteSet' && state.afterArrow && /^[A-Z][a-z]/.test(text)) return 'typeName';
      if (/^[A-Z]{2,}$/.test(text)) return text === 'EOS' ? 'keyword' : 'constant';
      return 'variableName';
    }
    stream.next();
    return null;
  },
  languageData: { commentTokens: { line: '#' } },
  tokenTable: { effect: tags.function(tags.variableName), constant: tags.constant(tags.variableName) },
});

const colours = HighlightStyle.define([
  { tag: tags.comment, color: 'var(--soft)', fontStyle: 'italic' },
  { tag: tags.heading, color: 'var(--ink)', fontWeight: '650' },
  { tag: tags.typeName, color: 'var(--hue0)' },
  { tag: tags.function(tags.variableName), color: 'var(--hue3)' },
  { tag: tags.propertyName, color: 'var(--soft)' },
  { tag: tags.number, color: 'var(--hue1)' },
  { tag: tags.bool, color: 'var(--hue1)' },
  { tag: tags.constant(tags.variableName), color: 'var(--hue4)' },
  { tag: tags.keyword, color: 'var(--hue5)' },
  { tag: tags.character, color: 'var(--hue2)', fontWeight: '650' },
  { tag: tags.operator, color: 'var(--soft)' },
]);

export const language: Extension = [vgdl, syntaxHighlighting(colours)];
