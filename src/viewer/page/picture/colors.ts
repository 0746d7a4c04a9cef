import { Color } from 'three';
import { looksOf } from './looks';
import { IN_CONTACT, STRUCTURAL } from '../run/protocol';
import type { RunModel } from '../run/run_model';
import type { Theme } from '../panel/theme';
import type { ColorMode } from './view_options';

/** Stops of viridis. */
const STOPS = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];
const STEPS = 256;
const SMALLEST_SCALE: Record<ColorMode, number> = { plain: 1, contact: 1, stretch: 0.001, speed: 0.01 };
/** A few particles must not decide on the scale. */
const PERCENTILE = 0.99;
const BINS = 1024;

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

/** A scale that all runs share. It follows the values up and down, in steps that do not flicker. */
export class Scale {
  /** The value at the end of the scale. */
  top = 0;

  follow(largest: number): void {
    if (largest > this.top || niceAbove(1.25 * largest) < this.top) this.top = niceAbove(largest);
  }
}

export class ColorScale extends Scale {
  private mode: ColorMode = 'plain';

  followMode(mode: ColorMode, value: number): void {
    if (mode !== this.mode) this.top = 0;
    this.mode = mode;
    this.follow(Math.max(value, SMALLEST_SCALE[mode]));
  }
}

const bins = new Uint32Array(BINS);

/** The value that all but a hundredth of the particles stay below. */
function percentile(values: Float32Array): number {
  let largest = 0;
  for (let i = 0; i < values.length; ++i) if (values[i] > largest && values[i] < Infinity) largest = values[i];
  if (largest === 0) return 0;
  bins.fill(0);
  const factor = (BINS - 1) / largest;
  for (let i = 0; i < values.length; ++i) if (values[i] > 0 && values[i] <= largest) ++bins[Math.ceil(factor * values[i])];
  let above = 0;
  let bin = BINS - 1;
  while (bin > 0 && above + bins[bin] <= (1 - PERCENTILE) * values.length) above += bins[bin--];
  return bin / factor;
}

/** The colours of particles of a run. */
export class ParticleColors {
  readonly colors: Float32Array;
  private readonly values: Float32Array;
  private readonly plain: Float32Array;
  private theme: Theme | null = null;
  private mode: ColorMode = 'plain';

  constructor(private readonly model: RunModel) {
    const count = model.topology.particles;
    this.colors = new Float32Array(3 * count);
    this.values = new Float32Array(count);
    this.plain = new Float32Array(3 * count);
    const looks = looksOf(model.scene);
    model.scene.bodies.forEach(({ first, count: size }, k) => {
      for (let i = first; i < first + size; ++i) looks[k].color.toArray(this.plain, 3 * i);
    });
  }

  /** Computes what is shown by colour, and returns a value that the scale has to contain. */
  measure(mode: ColorMode): number {
    if (mode === 'stretch') stretches(this.model, this.values);
    else if (mode === 'speed') this.values.set(this.model.speeds);
    else return 0;
    return percentile(this.values);
  }

  /** After `measure`. Returns whether colours have changed. */
  update(mode: ColorMode, theme: Theme, top: number): boolean {
    const stale = this.theme !== theme || this.mode !== mode;
    this.theme = theme;
    this.mode = mode;
    if (mode === 'plain') {
      if (stale) this.colors.set(this.plain);
      return stale;
    }
    if (mode === 'contact') this.colorContacts(theme);
    else this.colorValues(top);
    return true;
  }

  private colorContacts(theme: Theme): void {
    this.colors.set(this.plain);
    const { states } = this.model;
    for (let i = 0; i < states.length; ++i) if (states[i] & IN_CONTACT) theme.contact.toArray(this.colors, 3 * i);
  }

  private colorValues(top: number): void {
    const { values, colors } = this;
    const factor = (STEPS - 1) / top;
    for (let i = 0; i < values.length; ++i) {
      const at = 3 * Math.min(Math.max(Math.round(factor * values[i]), 0), STEPS - 1);
      colors[3 * i] = table[at];
      colors[3 * i + 1] = table[at + 1];
      colors[3 * i + 2] = table[at + 2];
    }
  }
}

/** The largest stretch of the structural springs at each particle [1], of which the plot shows the largest. */
function stretches(model: RunModel, values: Float32Array): void {
  const { springs, topology: { restLengths, kinds } } = model;
  const p = model.positions;
  values.fill(0);
  for (let s = 0; s < restLengths.length; ++s) {
    if (kinds[s] !== STRUCTURAL || restLengths[s] <= 0) continue;
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
