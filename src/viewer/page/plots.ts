import { element, short } from './dom';
import type { History, Quantity } from './history';

interface Series { quantity: Quantity; label: string; color: string }
interface PlotSpec { id: string; title: string; unit: string; series: Series[] }

/** Two runs: the first is drawn solid, the second dashed. */
const SECOND_COLOR = '#d55e00';
const SPECS: PlotSpec[] = [
  {
    id: 'energy',
    title: 'Energy',
    unit: 'J',
    series: [
      { quantity: 'kinetic', label: 'kinetic', color: '#0072b2' },
      { quantity: 'elastic', label: 'elastic', color: '#e69f00' },
      { quantity: 'gravity', label: 'gravity', color: '#009e73' },
      { quantity: 'contact', label: 'contact', color: '#cc79a7' },
      { quantity: 'total', label: 'total', color: '' },
    ],
  },
  { id: 'stretch', title: 'Largest stretch', unit: '', series: [{ quantity: 'stretch', label: '', color: '#0072b2' }] },
  { id: 'contacts', title: 'Contacts', unit: '', series: [{ quantity: 'contacts', label: '', color: '#0072b2' }] },
  { id: 'frame-ms', title: 'Time of a frame', unit: 'ms', series: [{ quantity: 'ms', label: '', color: '#0072b2' }] },
];

export interface PlottedRun { history: History; time: number }

/** The plots that run along. */
export class Plots {
  private readonly plots: Plot[];

  constructor(parent: HTMLElement) {
    this.plots = SPECS.map((spec) => new Plot(spec, parent));
  }

  /** Marks the time of each run if `marked`. */
  draw(runs: PlottedRun[], marked: boolean): void {
    const style = getComputedStyle(document.documentElement);
    const ink = style.getPropertyValue('--ink');
    const muted = style.getPropertyValue('--muted');
    const line = style.getPropertyValue('--line');
    for (const plot of this.plots) plot.draw(runs, marked, { ink, muted, line });
  }
}

interface Inks { ink: string; muted: string; line: string }

class Plot {
  private readonly canvas: HTMLCanvasElement;
  private readonly values: HTMLElement[] = [];
  private readonly keys: HTMLElement[] = [];

  constructor(
    private readonly spec: PlotSpec,
    parent: HTMLElement,
  ) {
    this.canvas = element('canvas', { height: spec.series.length > 1 ? 96 : 52 });
    const head = element('div', { className: 'plot-head' }, element('span', { textContent: spec.unit ? `${spec.title} [${spec.unit}]` : spec.title }));
    for (const { label } of spec.series) {
      const value = element('output');
      const key = element('i');
      this.values.push(value);
      this.keys.push(key);
      head.append(element('span', { className: 'plot-key' }, ...(label ? [key, `${label} `] : []), value));
    }
    const plot = element('div', { className: 'plot' }, head, this.canvas);
    plot.dataset.testid = spec.id;
    plot.setAttribute('role', 'img');
    plot.setAttribute('aria-label', `Plot: ${spec.title}`);
    this.canvas.style.height = `${this.canvas.height}px`;
    parent.append(plot);
  }

  draw(runs: PlottedRun[], marked: boolean, inks: Inks): void {
    const { canvas, spec } = this;
    const width = canvas.clientWidth;
    const height = canvas.clientHeight;
    const context = canvas.getContext('2d');
    if (!context || width === 0) return;
    const ratio = window.devicePixelRatio;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    const [low, high] = range(spec, runs);
    const end = Math.max(1e-9, ...runs.map(({ history }) => history.times[history.times.length - 1] ?? 0));
    const x = (time: number) => 1 + (time / end) * (width - 2);
    const y = (value: number) => height - 3 - ((value - low) / (high - low)) * (height - 6);
    context.strokeStyle = inks.line;
    context.lineWidth = 1;
    for (const value of low < 0 && high > 0 ? [low, 0, high] : [low, high]) {
      line(context, 0, y(value), width, y(value));
    }
    spec.series.forEach((series, k) => {
      this.keys[k].style.background = series.color || inks.ink;
      runs.forEach((run, number) => {
        const alone = spec.series.length === 1;
        context.strokeStyle = number > 0 && alone ? SECOND_COLOR : series.color || inks.ink;
        context.lineWidth = 1.4;
        context.setLineDash(number > 0 ? [4, 3] : []);
        curve(context, run.history.times, run.history.values[series.quantity], x, y);
      });
      context.setLineDash([]);
      this.values[k].textContent = runs.map((run) => short(valueAt(run, series.quantity, marked))).join(' | ');
    });
    if (marked && runs[0]) {
      context.strokeStyle = inks.muted;
      line(context, x(runs[0].time), 0, x(runs[0].time), height);
    }
    context.fillStyle = inks.muted;
    context.font = '10px system-ui, sans-serif';
    context.textBaseline = 'top';
    context.fillText(short(high, 2), 2, 4);
    context.textBaseline = 'bottom';
    context.fillText(short(low, 2), 2, height - 4);
    context.textAlign = 'right';
    if (end > 1e-9) context.fillText(`${short(end)} s`, width - 2, height - 4);
    context.textAlign = 'left';
  }
}

function line(context: CanvasRenderingContext2D, x0: number, y0: number, x1: number, y1: number): void {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}

function curve(
  context: CanvasRenderingContext2D,
  times: number[],
  values: number[],
  x: (time: number) => number,
  y: (value: number) => number,
): void {
  context.beginPath();
  times.forEach((time, k) => context.lineTo(x(time), y(values[k])));
  context.stroke();
}

function range(spec: PlotSpec, runs: PlottedRun[]): [number, number] {
  let low = 0;
  let high = 0;
  for (const { history } of runs) {
    for (const { quantity } of spec.series) {
      for (const value of history.values[quantity]) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
  }
  return high > low ? [low, high] : [low, low + 1];
}

function valueAt(run: PlottedRun, quantity: Quantity, marked: boolean): number {
  const { times, values } = run.history;
  let k = times.length - 1;
  if (marked) while (k > 0 && times[k] > run.time + 1e-9) --k;
  return values[quantity][k] ?? NaN;
}
