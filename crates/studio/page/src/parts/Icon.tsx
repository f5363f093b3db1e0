const PATHS = {
  play: 'M5 3.5v9l7.5-4.5z',
  pause: 'M4.5 3.5h2.5v9h-2.5zM9 3.5h2.5v9H9z',
  restart: 'M8 3a5 5 0 1 1-4.6 3M3 2.5V6h3.5',
  undo: 'M6 3 2.5 6.5 6 10M3 6.5h6.5a3.5 3.5 0 0 1 0 7H7',
  step: 'M4 3.5v9l6-4.5zM11.5 3.5v9',
  left: 'M10 3 5 8l5 5',
  right: 'M6 3l5 5-5 5',
  up: 'M3 10l5-5 5 5',
  down: 'M3 6l5 5 5-5',
  cross: 'M4 4l8 8M12 4l-8 8',
  check: 'M3 8.5 6.5 12 13 4.5',
  help: 'M6 6a2 2 0 1 1 2.6 1.9c-.4.2-.6.5-.6 1V9.5M8 12v.2',
  save: 'M8 2.5v7M5 6.5l3 3 3-3M3 12.5h10',
  open: 'M8 9.5v-7M5 5.5l3-3 3 3M3 12.5h10',
  plus: 'M8 3v10M3 8h10',
  minus: 'M3 8h10',
  eraser: 'M6.5 13 2.5 9l6-6 5 5-5 5zM5.5 6l5 5M6 13h8',
} as const;

export type IconName = keyof typeof PATHS;

/** A small drawing in the colour of the text; hidden from screen readers, since every button has a name. */
export function Icon({ name }: { name: IconName }) {
  const solid = name === 'play' || name === 'pause';
  return (
    <svg class="icon" viewBox="0 0 16 16" width="16" height="16" aria-hidden="true" focusable="false">
      <path
        d={PATHS[name]}
        fill={solid ? 'currentColor' : 'none'}
        stroke="currentColor"
        stroke-width={solid ? 1 : 1.6}
        stroke-linecap="round"
        stroke-linejoin="round"
      />
    </svg>
  );
}
