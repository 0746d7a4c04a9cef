/** The element with a data-testid. */
export function control<T extends HTMLElement = HTMLElement>(name: string): T {
  return required<T>(document.querySelector(`[data-testid="${name}"]`), name);
}

export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  return required<T>(document.getElementById(id), id);
}

export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  properties: Partial<HTMLElementTagNameMap[K]> = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = Object.assign(document.createElement(tag), properties);
  made.append(...children);
  return made;
}

export function setOptions(select: HTMLSelectElement, options: readonly { value: string; label: string }[]): void {
  select.replaceChildren(...options.map(({ value, label }) => element('option', { value, textContent: label })));
}

/** A number for people: at most `digits` digits that count. */
export function short(value: number, digits = 3): string {
  if (!Number.isFinite(value)) return '-';
  if (value !== 0 && (Math.abs(value) < 1e-4 || Math.abs(value) >= 1e6)) return value.toExponential(Math.max(digits - 1, 0)).replace(/\.?0+e/, 'e');
  return String(Number(value.toPrecision(digits)));
}

function required<T extends HTMLElement>(found: Element | null, name: string): T {
  if (!found) throw new Error(`the page has no ${name}`);
  return found as T;
}
