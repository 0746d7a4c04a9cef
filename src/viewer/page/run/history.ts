import type { Diagnostics, FrameNumbers } from './protocol';

export type Quantity = 'kinetic' | 'elastic' | 'gravity' | 'contact' | 'total' | 'stretch' | 'contacts' | 'ms';
export const QUANTITIES: readonly Quantity[] = ['kinetic', 'elastic', 'gravity', 'contact', 'total', 'stretch', 'contacts', 'ms'];

const CAPACITY = 1200;

/** Numbers of a run over time. A long run is thinned out, so that it always fits as a whole. */
export class History {
  readonly times: number[] = [];
  readonly values: Record<Quantity, number[]> = {
    kinetic: [],
    elastic: [],
    gravity: [],
    contact: [],
    total: [],
    stretch: [],
    contacts: [],
    ms: [],
  };
  /** What a recorded run has no numbers of. */
  readonly missing = new Set<Quantity>();
  private stride = 1;
  private skipped = 0;

  add(time: number, numbers: FrameNumbers): void {
    if (this.times.length > 0 && time < this.times[this.times.length - 1]) this.cut(time);
    if (this.times[this.times.length - 1] === time) return;
    if (this.times.length > 0 && ++this.skipped < this.stride) return;
    this.skipped = 0;
    const { kinetic, elastic, gravity, contactEnergy, maxStretch, contacts, frameMs } = numbers;
    this.push(time, [kinetic, elastic, gravity, contactEnergy, kinetic + elastic + gravity + contactEnergy, maxStretch, contacts, frameMs]);
    if (this.times.length >= CAPACITY) this.thin();
  }

  /** The columns of diagnostics.csv. */
  load(diagnostics: Diagnostics, frameRate: number): void {
    this.clear();
    const column = (name: string) => diagnostics.columns.indexOf(name);
    const columns = ['kinetic_energy', 'elastic_energy', 'gravity_energy', 'contact_energy', '', 'max_stretch', 'contacts', 'frame_ms'].map(column);
    const time = column('time');
    QUANTITIES.forEach((name, k) => {
      if (columns[k] < 0 && name !== 'total') this.missing.add(name);
    });
    if (this.missing.has('kinetic')) this.missing.add('total');
    diagnostics.rows.forEach((row, k) => {
      const numbers = columns.map((index) => row[index] ?? 0);
      numbers[4] = numbers[0] + numbers[1] + numbers[2] + numbers[3];
      this.push(row[time] ?? k / frameRate, numbers);
    });
  }

  /** Forgets what came after a time, as the run went back to it. */
  private cut(time: number): void {
    const after = this.times.findIndex((each) => each > time);
    if (after < 0) return;
    this.times.length = after;
    for (const name of QUANTITIES) this.values[name].length = after;
  }

  clear(): void {
    this.times.length = 0;
    for (const name of QUANTITIES) this.values[name].length = 0;
    this.stride = 1;
    this.skipped = 0;
  }

  private push(time: number, numbers: number[]): void {
    this.times.push(time);
    QUANTITIES.forEach((name, k) => this.values[name].push(numbers[k]));
  }

  private thin(): void {
    const halve = (values: number[]) => {
      for (let k = 0; 2 * k < values.length; ++k) values[k] = values[2 * k];
      values.length = Math.ceil(values.length / 2);
    };
    halve(this.times);
    for (const name of QUANTITIES) halve(this.values[name]);
    this.stride *= 2;
  }
}
