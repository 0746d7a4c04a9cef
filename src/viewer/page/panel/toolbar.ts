import { byId, control, element, setOptions } from './dom';
import { labelOf } from './gallery';
import { INTEGRATORS } from './integrators';
import type { StateMessage } from '../run/protocol';

export type Direction = 'usual' | 'front' | 'side' | 'top';

/** What the toolbar asks for. */
export interface ToolbarActions {
  play(playing: boolean): void;
  step(): void;
  frame(): void;
  reset(): void;
  fit(direction: Direction): void;
  speed(factor: number): void;
  every(steps: number): void;
  compare(integrator: string | null): void;
  open(example: string): void;
  /** A frame of the slider. */
  seek(frame: number): void;
}

const TAKES_TEXT = 'textarea, input:not([type="checkbox"], [type="range"])';
const VIEW_KEYS: Record<string, Direction> = { f: 'usual', 1: 'front', 2: 'side', 3: 'top' };
const TAKES_SPACE = 'button, summary, input, select';

/** Playback, speed, examples and the second run, by buttons and by keys. */
export class Toolbar {
  private readonly playButton = control<HTMLButtonElement>('play');
  private readonly speed = control<HTMLSelectElement>('speed');
  private readonly every = control<HTMLInputElement>('every');
  private readonly compare = control<HTMLSelectElement>('compare');
  private readonly example = control<HTMLSelectElement>('example');
  private readonly slider = control<HTMLInputElement>('frame');
  private readonly sliderNumber = document.getElementById('frame-number');
  private playing = false;
  /** The control in focus was reached by Tab. */
  private tabbed = false;

  constructor(private readonly actions: ToolbarActions) {
    this.playButton.addEventListener('click', () => actions.play(!this.playing));
    const buttons = { step: actions.step, 'single-frame': actions.frame, reset: actions.reset };
    for (const [name, act] of Object.entries(buttons)) control(name).addEventListener('click', () => act());
    const views: Record<string, Direction> = { fit: 'usual', front: 'front', side: 'side', top: 'top' };
    for (const [name, direction] of Object.entries(views)) control(name).addEventListener('click', () => actions.fit(direction));
    this.speed.addEventListener('change', () => actions.speed(Number(this.speed.value)));
    this.every.addEventListener('change', () => actions.every(Math.max(Math.round(Number(this.every.value)) || 0, 0)));
    setOptions(this.compare, [{ value: '', label: 'nothing' }, ...INTEGRATORS]);
    this.compare.addEventListener('change', () => actions.compare(this.compare.value || null));
    this.example.addEventListener('change', () => {
      if (this.example.value) actions.open(this.example.value);
    });
    this.slider.addEventListener('input', () => actions.seek(Number(this.slider.value)));
    window.addEventListener('keydown', (event) => this.press(event));
    // Buttons act on the key's release.
    window.addEventListener('keyup', (event) => {
      const target = event.target as HTMLElement | null;
      if (event.key === ' ' && !this.tabbed && target?.matches(TAKES_SPACE) && !target.closest('dialog')) event.preventDefault();
    });
    window.addEventListener('pointerdown', () => (this.tabbed = false), { capture: true });
    control('keys').addEventListener('click', () => byId<HTMLDialogElement>('keys-dialog').showModal());
    control('panel-toggle').addEventListener('click', () => this.togglePanel());
    const small = window.matchMedia('(max-width: 820px)');
    small.addEventListener('change', () => this.togglePanel(!small.matches));
    this.togglePanel(!small.matches);
  }

  setPlaying(playing: boolean): void {
    this.playing = playing;
    this.playButton.textContent = playing ? 'Pause' : 'Play';
    this.playButton.setAttribute('aria-pressed', String(playing));
  }

  setState(state: StateMessage): void {
    this.setPlaying(state.playing);
    this.every.value = state.every > 0 ? String(state.every) : '';
    const value = String(state.speed);
    if (![...this.speed.options].some((option) => option.value === value)) this.speed.add(new Option(`${value}x`, value));
    this.speed.value = value;
  }

  setExamples(names: string[]): void {
    const option = (name: string) => element('option', { value: name, textContent: labelOf(name) });
    const groupOf = (label: string, members: string[]) => element('optgroup', { label }, ...members.map(option));
    const lessons = names.filter((name) => name.startsWith('lessons/'));
    const others = names.filter((name) => !name.startsWith('lessons/'));
    this.example.replaceChildren(element('option', { value: '', textContent: 'choose' }), ...others.map(option));
    if (lessons.length > 0) this.example.append(groupOf('Lessons', lessons));
    const group = document.getElementById('example-group');
    if (group) group.hidden = names.length === 0;
  }

  /** The example that is shown, by the title of the scene. */
  setExample(title: string): void {
    const name = title.replace(/\.json$/, '');
    this.example.value = [...this.example.options].find(({ value }) => value.replace(/^lessons\//, '') === name)?.value ?? '';
  }

  setCompared(integrator: string | null): void {
    this.compare.value = integrator ?? '';
  }

  /** A recorded run cannot be played as fast as possible. */
  setRecorded(): void {
    this.speed.querySelector('option[value="0"]')?.remove();
  }

  setFrames(frames: number): void {
    this.slider.max = String(frames);
  }

  setFrame(frame: number): void {
    this.slider.value = String(frame);
    if (this.sliderNumber) this.sliderNumber.textContent = `${frame} / ${this.slider.max}`;
  }

  /** A control that was reached by Tab keeps its own keys; one that was clicked gives them back. */
  private press(event: KeyboardEvent): void {
    if (event.key === 'Tab') this.tabbed = true;
    const target = event.target as HTMLElement | null;
    if (event.ctrlKey || event.metaKey || event.altKey || target?.matches(TAKES_TEXT) || target?.closest('dialog')) return;
    if (this.tabbed && target?.matches(event.key === ' ' ? TAKES_SPACE : 'select')) return;
    if (event.key === ' ') this.actions.play(!this.playing);
    else if (event.key === '.') this.actions.frame();
    else if (event.key === 'r') this.actions.reset();
    else if (event.key === 'p') this.togglePanel();
    else if (event.key === '?') byId<HTMLDialogElement>('keys-dialog').showModal();
    else if (event.key in VIEW_KEYS) this.actions.fit(VIEW_KEYS[event.key]);
    else return;
    event.preventDefault();
  }

  private togglePanel(open = document.body.dataset.panel === 'closed'): void {
    document.body.dataset.panel = open ? 'open' : 'closed';
    control('panel-toggle').setAttribute('aria-expanded', String(open));
  }
}
