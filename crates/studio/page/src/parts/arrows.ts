/** Lets arrow keys move the focus among the buttons of a group and choose the one that they reach, as in native groups. */
export function arrows(event: KeyboardEvent): void {
  const by = { ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1 }[event.key];
  const { currentTarget } = event;
  if (by === undefined || !(currentTarget instanceof HTMLElement)) return;
  const buttons = [...currentTarget.querySelectorAll('button')];
  const at = buttons.findIndex((button) => button === document.activeElement);
  const next = buttons[(at + by + buttons.length) % buttons.length];
  if (at < 0 || !next) return;
  event.preventDefault();
  event.stopPropagation();
  next.click();
  next.focus();
}
