import { element } from './dom';
import type { Json } from '../run/protocol';

export type SceneJson = { [key: string]: Json };
export type Change = (key: string, value: Json) => void;

/** A setting of the scene. Shows the value that is in force, and problems of one that was refused. */
export interface Field {
  readonly node: HTMLElement;
  /** Whether a refused key belongs to the field. */
  owns(key: string): boolean;
  show(scene: SceneJson, step: number): void;
  tell(texts: string[]): void;
}

/** The value at a path of keys. */
export function valueAt(scene: SceneJson, path: readonly string[]): Json | undefined {
  let value: Json | undefined = scene;
  for (const key of path) {
    if (value === null || typeof value !== 'object' || Array.isArray(value)) return undefined;
    value = value[key];
  }
  return value;
}

function numberText(value: Json | undefined): string {
  return typeof value === 'number' ? String(Number(value.toPrecision(8))) : '';
}

/** Undefined for what is no number, null for an empty text. */
function parsed(text: string): number | null | undefined {
  if (text.trim() === '') return null;
  const value = Number(text);
  return Number.isFinite(value) ? value : undefined;
}

export function numberInput(label: string, testid: string): HTMLInputElement {
  const input = element('input', { type: 'text', inputMode: 'decimal', spellcheck: false });
  input.setAttribute('aria-label', label);
  input.dataset.testid = testid;
  return input;
}

/** What all fields have in common: their place for problems. */
abstract class BaseField implements Field {
  readonly node = element('div', { className: 'field' });
  protected readonly problem = element('p', { className: 'problem', hidden: true });
  private readonly note = element('p', { className: 'note', hidden: true });
  private noted = '';
  private scene: SceneJson = {};
  private step = 0;

  constructor(protected readonly keys: readonly string[]) {
    this.problem.setAttribute('role', 'alert');
    this.note.setAttribute('role', 'status');
  }

  owns(key: string): boolean {
    return this.keys.includes(key);
  }

  show(scene: SceneJson, step: number): void {
    this.scene = scene;
    this.step = step;
    this.tell([]);
    this.refresh(scene, step);
    this.note.textContent = this.noted;
    this.note.hidden = this.noted === '';
    this.noted = '';
  }

  tell(texts: string[]): void {
    this.problem.hidden = texts.length === 0;
    this.problem.textContent = texts.join('\n');
    if (texts.length > 0) this.refresh(this.scene, this.step);
  }

  /** A sentence about a change, which is shown once the change is in force. */
  protected explain(text: string): void {
    this.noted = text;
  }

  /** Adds what all fields end with. */
  protected finish(): void {
    this.node.append(this.problem, this.note);
  }

  protected notANumber(text: string): void {
    this.tell([`"${text}" is not a number`]);
  }

  protected abstract refresh(scene: SceneJson, step: number): void;
}

/** A mark of settings whose change begins the run anew. */
function labelText(label: string, restarts: boolean): HTMLElement {
  const text = element('span', { textContent: label });
  if (restarts) text.append(element('span', { className: 'restarts', textContent: ' \u21bb', title: 'A change begins the run anew' }));
  return text;
}

export interface NumberSpec {
  label: string;
  /** A change begins the run anew. */
  restarts?: boolean;
  /** A value that the scene takes instead, and a sentence that says so. */
  snap?(value: number): { value: number; note: string };
  testid: string;
  placeholder?: string;
  /** The present value. */
  read(scene: SceneJson, step: number): Json | undefined;
  /** The key that a value sets, and what it becomes. */
  write(value: number | null, scene: SceneJson): { key: string; value: Json };
  keys: readonly string[];
}

export class NumberField extends BaseField {
  private readonly input: HTMLInputElement;
  private latest: SceneJson = {};

  constructor(
    private readonly spec: NumberSpec,
    change: Change,
  ) {
    super(spec.keys);
    this.input = numberInput(spec.label, spec.testid);
    this.input.placeholder = spec.placeholder ?? '';
    const label = labelText(spec.label, spec.restarts ?? false);
    this.node.append(element('label', {}, label, this.input));
    this.finish();
    const set = () => {
      const value = parsed(this.input.value);
      if (value === undefined) return this.notANumber(this.input.value);
      const snapped = value !== null && value > 0 ? spec.snap?.(value) : undefined;
      this.explain(snapped?.note ?? '');
      const { key, value: written } = spec.write(snapped?.value ?? value, this.latest);
      change(key, written);
    };
    this.input.addEventListener('change', set);
    dragNumber(label, this.input, set);
  }

  protected refresh(scene: SceneJson, step: number): void {
    this.latest = scene;
    this.input.value = numberText(this.spec.read(scene, step));
  }
}

const DRAG_PX = 3;

/** A pull on the label, sideways, changes the number: by a factor, so that any size of number is in reach; zero in hundredths. */
function dragNumber(label: HTMLElement, input: HTMLInputElement, set: () => void): void {
  let from: { x: number; value: number; moved: boolean } | null = null;
  label.classList.add('drags');
  label.addEventListener('pointerdown', (event) => {
    const value = parsed(input.value);
    if (event.button !== 0 || typeof value !== 'number') return;
    from = { x: event.clientX, value, moved: false };
    label.setPointerCapture(event.pointerId);
  });
  label.addEventListener('pointermove', (event) => {
    if (!from) return;
    const pixels = event.clientX - from.x;
    from.moved ||= Math.abs(pixels) >= DRAG_PX;
    if (!from.moved) return;
    const value = from.value === 0 ? 0.01 * pixels : from.value * 1.01 ** (Math.sign(from.value) * pixels);
    input.value = String(Number(value.toPrecision(3)));
  });
  const end = () => {
    if (from?.moved) set();
    from = null;
  };
  label.addEventListener('pointerup', end);
  label.addEventListener('pointercancel', () => (from = null));
}

/** A setting that is on or off. */
export class CheckField extends BaseField {
  private readonly input = element('input', { type: 'checkbox' });

  constructor(
    label: string,
    testid: string,
    key: string,
    private readonly read: (scene: SceneJson) => boolean,
    write: (on: boolean) => Json,
    change: Change,
  ) {
    super([key]);
    this.input.dataset.testid = testid;
    this.node.append(element('label', {}, labelText(label, true), this.input));
    this.finish();
    this.input.addEventListener('change', () => change(key, write(this.input.checked)));
  }

  protected refresh(scene: SceneJson): void {
    this.input.checked = this.read(scene);
  }
}

export class VectorField extends BaseField {
  private readonly inputs: HTMLInputElement[];
  private readonly path: string[];

  constructor(label: string, testid: string, key: string, change: Change) {
    super([key]);
    this.path = key.split('.');
    this.inputs = ['x', 'y', 'z'].map((axis) => numberInput(`${label} ${axis}`, `${testid}-${axis}`));
    const group = element('span', { className: 'vector' }, ...this.inputs);
    group.dataset.testid = testid;
    group.setAttribute('role', 'group');
    group.setAttribute('aria-label', label);
    this.node.append(element('div', { className: 'labelled' }, element('span', { textContent: label }), group));
    this.finish();
    for (const input of this.inputs) {
      input.addEventListener('change', () => {
        const value = this.inputs.map((each) => parsed(each.value) ?? NaN);
        const wrong = value.findIndex(Number.isNaN);
        if (wrong >= 0) return this.notANumber(this.inputs[wrong].value);
        change(key, value);
      });
    }
  }

  protected refresh(scene: SceneJson): void {
    const value = valueAt(scene, this.path);
    const isKeyframed = value !== null && typeof value === 'object' && !Array.isArray(value);
    this.inputs.forEach((input, d) => {
      input.value = Array.isArray(value) ? numberText(value[d]) : '';
      input.placeholder = isKeyframed ? 'keyframes' : '';
      input.disabled = isKeyframed;
    });
  }
}

export class SelectField extends BaseField {
  private readonly select = element('select');

  constructor(
    label: string,
    testid: string,
    key: string,
    options: readonly { value: string; label: string }[],
    private readonly read: (scene: SceneJson) => string,
    change: (value: string) => void,
  ) {
    super([key]);
    this.select.append(...options.map((option) => element('option', { value: option.value, textContent: option.label })));
    this.select.dataset.testid = testid;
    this.select.setAttribute('aria-label', label);
    this.select.addEventListener('change', () => change(this.select.value));
    this.node.append(element('label', {}, labelText(label, true), this.select));
    this.finish();
  }

  protected refresh(scene: SceneJson): void {
    this.select.value = this.read(scene);
  }
}
