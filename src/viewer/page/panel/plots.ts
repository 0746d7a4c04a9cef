import { element, short } from './dom';
import type { History, Quantity } from '../run/history';

/** `optional` curves are drawn on request: more than three cannot be told apart. */
interface Series { quantity: Quantity; label: string; color: string; optional?: boolean }
interface PlotSpec { id: string; title: string; unit: string; series: Series[]; whole?: boolean }

/** Two runs: the first is drawn solid, the second dashed. */
const SECOND_COLOR = '#d55e00';
const SPECS: PlotSpec[] = [
  {
    id: 'energy',
    title: 'Energy',
    unit: 'J',
    series: [
      { quantity: 'kinetic', label: 'kinetic', color: '#2f7fd0' },
      { quantity: 'elastic', label: 'elastic', color: '#e69f00' },
      { quantity: 'total', label: 'total', color: '' },
      { quantity: 'gravity', label: 'gravity', color: '#009e73', optional: true },
      { quantity: 'contact', label: 'contact', color: '#cc79a7', optional: true },
    ],
  },
  { id: 'stretch', title: 'Largest stretch, structural', unit: '', series: [{ quantity: 'stretch', label: '', color: '#2f7fd0' }] },
  { id: 'contacts', title: 'Contacts', unit: '', series: [{ quantity: 'contacts', label: '', color: '#2f7fd0' }], whole: true },
  { id: 'frame-ms', title: 'Time of a frame', unit: 'ms', series: [{ quantity: 'ms', label: '', color: '#2f7fd0' }] },
];

const LEFT = 40;
const RIGHT = 6;
const TOP = 7;
const BOTTOM = 16;
const NEAR_END_PX = 26;

export interface PlottedRun { history: History; time: number }

/** The plots that run along. */
export class Plots {
  private readonly plots: Plot[];
  private readonly group: HTMLElement;
  private inks: Inks | null = null;

  /** `changed` asks for `draw`; `seek` gets the time that was clicked at. */
  constructor(parent: HTMLElement, changed: () => void, seek: (time: number) => void) {
    this.group = parent.closest('details') ?? parent;
    this.plots = SPECS.map((spec) => new Plot(spec, parent, changed, seek));
  }

  /** The theme has changed. */
  forgetColors(): void {
    this.inks = null;
  }

  /** Marks the time of each run if `marked`. */
  draw(runs: PlottedRun[], marked: boolean): void {
    this.inks ??= inksOfPage();
    for (const plot of this.plots) plot.draw(runs, marked, this.inks);
    this.group.hidden = runs.length > 0 && this.plots.every(({ hidden }) => hidden);
  }
}

interface Inks { ink: string; muted: string; line: string }

function inksOfPage(): Inks {
  const style = getComputedStyle(document.documentElement);
  const [ink, muted, line] = ['--ink', '--muted', '--line'].map((name) => style.getPropertyValue(name));
  return { ink, muted, line };
}

interface Curve extends Series { value: HTMLElement; key: HTMLElement; shown: boolean }

class Plot {
  private readonly canvas: HTMLCanvasElement;
  private readonly node: HTMLElement;
  private readonly curves: Curve[];
  /** Of the canvas [pixels]; told by the browser, as to ask for it would make the page compute its layout. */
  private width = 0;
  private readonly height: number;
  private end = 1e-9;
  /** The pointer in the plot [pixels], or null. */
  private pointer: number | null = null;

  constructor(
    private readonly spec: PlotSpec,
    parent: HTMLElement,
    changed: () => void,
    seek: (time: number) => void,
  ) {
    this.height = spec.series.length > 1 ? 116 : 74;
    const canvas = element('canvas');
    this.canvas = canvas;
    const head = element('div', { className: 'plot-head' });
    head.append(element('span', { textContent: spec.unit ? `${spec.title} [${spec.unit}]` : spec.title }));
    this.curves = spec.series.map((series) => {
      const curve = { ...series, value: element('output'), key: element('i'), shown: !series.optional };
      if (!series.label) {
        head.append(curve.value);
        return curve;
      }
      const button = element('button', { type: 'button', className: 'plot-key', title: `Show or hide ${series.label}` });
      button.append(curve.key, `${series.label} `, curve.value);
      button.dataset.testid = `${spec.id}-${series.quantity}`;
      const press = () => button.setAttribute('aria-pressed', String(curve.shown));
      button.addEventListener('click', () => {
        curve.shown = !curve.shown;
        press();
        changed();
      });
      press();
      head.append(button);
      return curve;
    });
    const plot = element('div', { className: 'plot' }, head, canvas);
    this.node = plot;
    plot.dataset.testid = spec.id;
    plot.setAttribute('role', 'group');
    plot.setAttribute('aria-label', `Plot: ${spec.title}`);
    canvas.style.height = `${this.height}px`;
    parent.append(plot);
    new ResizeObserver(([entry]) => {
      this.resize(entry.contentRect.width);
      changed();
    }).observe(canvas);
    canvas.addEventListener('pointermove', (event) => {
      this.pointer = event.offsetX;
      if (event.buttons === 1) seek(this.timeAt(event.offsetX));
      changed();
    });
    canvas.addEventListener('pointerleave', () => {
      this.pointer = null;
      changed();
    });
    canvas.addEventListener('pointerdown', (event) => {
      canvas.setPointerCapture(event.pointerId);
      seek(this.timeAt(event.offsetX));
    });
  }

  get hidden(): boolean {
    return this.node.hidden === true;
  }

  draw(runs: PlottedRun[], marked: boolean, inks: Inks): void {
    const { width, height, curves } = this;
    this.node.hidden = runs.length > 0 && curves.every(({ quantity }) => runs.every(({ history }) => history.missing.has(quantity)));
    if (this.node.hidden) return;
    const context = this.canvas.getContext('2d');
    if (!context || width <= LEFT + RIGHT) return;
    const ratio = window.devicePixelRatio;
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    this.end = Math.max(1e-9, ...runs.map(({ history }) => history.times[history.times.length - 1] ?? 0));
    const ticks = ticksOf(range(curves, runs), this.spec.whole ? 1 : 0);
    const [low, high] = [ticks[0], ticks[ticks.length - 1]];
    const x = (time: number) => LEFT + (time / this.end) * (width - LEFT - RIGHT);
    const y = (value: number) => height - BOTTOM - ((value - low) / (high - low)) * (height - TOP - BOTTOM);
    this.drawAxes(context, ticks, x, y, inks);
    const at = this.pointer === null ? null : this.timeAt(this.pointer);
    for (const curve of curves) {
      const color = curve.color || inks.ink;
      curve.key.style.background = color;
      runs.forEach((run, number) => {
        if (!curve.shown) return;
        context.strokeStyle = number > 0 && curves.length === 1 ? SECOND_COLOR : color;
        context.lineWidth = 1.5;
        context.setLineDash(number > 0 ? [4, 3] : []);
        drawCurve(context, run.history.times, run.history.values[curve.quantity], x, y);
      });
      context.setLineDash([]);
      setText(curve.value, runs.map((run) => short(valueAt(run, curve.quantity, at ?? (marked ? run.time : Infinity)))).join(' | '));
    }
    context.lineWidth = 1;
    context.strokeStyle = inks.muted;
    if (marked && runs[0]) line(context, x(runs[0].time), TOP, x(runs[0].time), height - BOTTOM);
    if (at === null || this.end <= 1e-9) return;
    context.strokeStyle = inks.ink;
    line(context, x(at), TOP, x(at), height - BOTTOM);
    this.label(context, `${short(at)} s`, x(at), inks.ink, true);
  }

  private drawAxes(context: CanvasRenderingContext2D, ticks: number[], x: (t: number) => number, y: (v: number) => number, inks: Inks): void {
    const { width, height } = this;
    context.font = '10px system-ui, sans-serif';
    context.lineWidth = 1;
    context.strokeStyle = inks.line;
    context.fillStyle = inks.muted;
    context.textBaseline = 'middle';
    context.textAlign = 'right';
    for (const tick of ticks) {
      line(context, LEFT, y(tick), width - RIGHT, y(tick));
      context.fillText(short(tick), LEFT - 5, y(tick));
    }
    if (this.end <= 1e-9) return;
    for (const tick of ticksOf([0, this.end], 0, 4)) {
      if (tick > this.end || x(tick) > width - NEAR_END_PX) continue;
      line(context, x(tick), height - BOTTOM, x(tick), height - BOTTOM + 3);
      this.label(context, short(tick), x(tick), inks.muted, false);
    }
    context.textAlign = 'right';
    context.fillText('s', width - RIGHT, height - 5);
  }

  /** A text under the axis of time; `clear` removes what is behind it. */
  private label(context: CanvasRenderingContext2D, text: string, x: number, ink: string, clear: boolean): void {
    const half = context.measureText(text).width / 2 + 3;
    const at = Math.min(Math.max(x, half), this.width - half);
    if (clear) context.clearRect(at - half, this.height - BOTTOM + 1, 2 * half, BOTTOM);
    context.fillStyle = ink;
    context.textBaseline = 'middle';
    context.textAlign = 'center';
    context.fillText(text, at, this.height - 5);
  }

  private timeAt(x: number): number {
    return this.end * Math.min(Math.max((x - LEFT) / (this.width - LEFT - RIGHT), 0), 1);
  }

  private resize(width: number): void {
    this.width = width;
    this.canvas.width = Math.round(width * window.devicePixelRatio);
    this.canvas.height = Math.round(this.height * window.devicePixelRatio);
  }
}

/** A text that is set again makes the page compute its layout again. */
function setText(node: HTMLElement, text: string): void {
  if (node.textContent !== text) node.textContent = text;
}

function line(context: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}

function drawCurve(
  context: CanvasRenderingContext2D,
  times: number[],
  values: number[],
  x: (time: number) => number,
  y: (value: number) => number,
): void {
  context.beginPath();
  for (let k = 0; k < times.length; ++k) context.lineTo(x(times[k]), y(values[k]));
  context.stroke();
}

function range(curves: Curve[], runs: PlottedRun[]): [number, number] {
  let low = 0;
  let high = 0;
  for (const { history } of runs) {
    for (const { quantity, shown } of curves) {
      if (!shown) continue;
      for (const value of history.values[quantity]) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
  }
  return high > low ? [low, high] : [low, low + 1];
}

/** Multiples of 1, 2 or 5 times a power of ten, about `count`, that enclose the range. */
function ticksOf([low, high]: [number, number], smallest: number, count = 3): number[] {
  const rough = (high - low) / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = Math.max(smallest, power * ([1, 2, 5].find((factor) => factor * power >= rough) ?? 10));
  const ticks: number[] = [];
  for (let k = Math.floor(low / step + 1e-9); k <= Math.ceil(high / step - 1e-9); ++k) ticks.push(k * step);
  return ticks;
}

function valueAt(run: PlottedRun, quantity: Quantity, time: number): number {
  const { times, values } = run.history;
  let k = times.length - 1;
  while (k > 0 && times[k] > time + 1e-9) --k;
  return values[quantity][k] ?? NaN;
}
