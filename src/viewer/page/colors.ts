import { Color } from 'three';
import { IN_CONTACT } from './protocol';
import type { RunModel } from './run_model';
import type { Theme } from './theme';
import type { ColorMode } from './view_options';

/** Stops of viridis. */
const STOPS = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];
const STEPS = 256;
const SMALLEST_SCALE: Record<ColorMode, number> = { plain: 1, contact: 1, stretch: 0.001, speed: 0.01 };

export const SCALE_CSS = `linear-gradient(to right, ${STOPS.join(', ')})`;

const table = new Float32Array(3 * STEPS);
for (let k = 0; k < STEPS; ++k) {
  const at = (k / (STEPS - 1)) * (STOPS.length - 1);
  const low = Math.min(Math.floor(at), STOPS.length - 2);
  new Color(STOPS[low]).lerp(new Color(STOPS[low + 1]), at - low).toArray(table, 3 * k);
}

/** The next of 1, 2, 5, 10, ... */
function niceAbove(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  for (const factor of [1, 2, 5]) {
    if (value <= factor * power) return factor * power;
  }
  return 10 * power;
}

/** The colours of particles of a run. */
export class ParticleColors {
  readonly colors: Float32Array;
  private readonly values: Float32Array;
  private readonly plain: Float32Array;
  private theme: Theme | null = null;
  private mode: ColorMode = 'plain';
  /** The value at the end of the scale; it only grows, so that colours can be compared over time. */
  private top = 0;

  constructor(private readonly model: RunModel) {
    const count = model.topology.particles;
    this.colors = new Float32Array(3 * count);
    this.values = new Float32Array(count);
    this.plain = new Float32Array(3 * count);
  }

  get scale(): number {
    return this.top;
  }

  /** Returns whether colours have changed. `scale` is a value that the scale has to contain. */
  update(mode: ColorMode, theme: Theme, scale: number): boolean {
    const stale = this.theme !== theme || this.mode !== mode;
    if (this.theme !== theme) this.setPlain(theme);
    if (this.mode !== mode) this.top = 0;
    this.theme = theme;
    this.mode = mode;
    if (mode === 'plain') {
      if (stale) this.colors.set(this.plain);
      return stale;
    }
    if (mode === 'contact') this.colorContacts(theme);
    else this.colorValues(mode, scale);
    return true;
  }

  private setPlain(theme: Theme): void {
    this.model.scene.bodies.forEach(({ first, count }, k) => {
      for (let i = first; i < first + count; ++i) theme.bodies[k % theme.bodies.length].toArray(this.plain, 3 * i);
    });
  }

  private colorContacts(theme: Theme): void {
    this.colors.set(this.plain);
    this.model.states.forEach((state, i) => {
      if (state & IN_CONTACT) theme.contact.toArray(this.colors, 3 * i);
    });
  }

  private colorValues(mode: ColorMode, scale: number): void {
    const values = this.values;
    if (mode === 'stretch') stretches(this.model, values);
    else values.set(this.model.speeds);
    let largest = Math.max(scale, SMALLEST_SCALE[mode]);
    for (let i = 0; i < values.length; ++i) if (values[i] > largest && values[i] < Infinity) largest = values[i];
    if (largest > this.top) this.top = niceAbove(largest);
    const factor = (STEPS - 1) / this.top;
    for (let i = 0; i < values.length; ++i) {
      const at = 3 * Math.min(Math.max(Math.round(factor * values[i]), 0), STEPS - 1);
      this.colors[3 * i] = table[at];
      this.colors[3 * i + 1] = table[at + 1];
      this.colors[3 * i + 2] = table[at + 2];
    }
  }
}

/** The largest stretch of the springs at each particle [1]. */
function stretches(model: RunModel, values: Float32Array): void {
  const { springs, topology: { restLengths } } = model;
  const p = model.positions;
  values.fill(0);
  for (let s = 0; s < restLengths.length; ++s) {
    if (restLengths[s] <= 0) continue;
    const a = springs[2 * s];
    const b = springs[2 * s + 1];
    const x = p[3 * b] - p[3 * a];
    const y = p[3 * b + 1] - p[3 * a + 1];
    const z = p[3 * b + 2] - p[3 * a + 2];
    const stretch = Math.sqrt(x * x + y * y + z * z) / restLengths[s] - 1;
    if (stretch > values[a]) values[a] = stretch;
    if (stretch > values[b]) values[b] = stretch;
  }
}
