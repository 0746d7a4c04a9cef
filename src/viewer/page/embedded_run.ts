import { decodeTopology, FRAME, TOPOLOGY } from './protocol';
import type { Command, Frame, FrameNumbers, Header, SceneMessage, Topology } from './protocol';
import type { Source, SourceListener } from './source';

interface EmbeddedFrame { time: number; positions: string; obstacles: string[] }
interface Embedded {
  scene: SceneMessage;
  topology: string;
  bounds: { min: number[]; size: number[] };
  error: number;
  frames: EmbeddedFrame[];
}

const LEVELS = 65535;

function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; ++k) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/** The run inside the page, or null. */
export function embeddedRun(): EmbeddedRun | null {
  const text = document.getElementById('sprung-run')?.textContent;
  return text ? new EmbeddedRun(JSON.parse(text) as Embedded) : null;
}

/** A run that `sprung export --format html` wrote into the page. Answers `seek` as the server does. */
export class EmbeddedRun implements Source {
  private readonly topology: Topology;
  private listener: SourceListener | null = null;

  constructor(private readonly data: Embedded) {
    this.topology = decodeTopology(bytesOf(data.topology).buffer);
  }

  /** What rounding has changed. */
  get note(): string {
    return `positions within ${this.data.error.toExponential(1)} m`;
  }

  start(listener: SourceListener): void {
    this.listener = listener;
    const scene = { ...this.data.scene, run: 0, generation: 1, frames: this.data.frames.length };
    listener.connected(true);
    listener.text({ type: 'hello', version: '', mode: 'replay', title: '', examples: [] });
    listener.text(scene);
    listener.topology(this.header(TOPOLOGY, 1), this.topology);
    this.answer(1);
  }

  send(command: Command): void {
    if (command.do === 'seek') this.answer(command.frame);
  }

  private answer(frame: number): void {
    const number = Math.min(Math.max(Math.round(frame), 1), this.data.frames.length);
    const { positions, obstacles } = this.data.frames[number - 1];
    const count = this.topology.particles;
    const decoded: Frame = {
      numbers: this.numbers(number),
      positions: this.dequantised(positions),
      speeds: new Float32Array(count),
      states: new Uint8Array(count),
      poses: [],
      deformed: obstacles.map((text) => this.dequantised(text)),
    };
    this.listener?.frame(this.header(FRAME, number), decoded);
  }

  private header(kind: number, frame: number): Header {
    const { time } = this.data.frames[frame - 1];
    return { kind, run: 0, generation: 1, frame, time, particles: this.topology.particles, playing: false };
  }

  private dequantised(text: string): Float32Array {
    const levels = new Uint16Array(bytesOf(text).buffer);
    const { min, size } = this.data.bounds;
    const positions = new Float32Array(levels.length);
    for (let k = 0; k < levels.length; ++k) positions[k] = min[k % 3] + (size[k % 3] * levels[k]) / LEVELS;
    return positions;
  }

  private numbers(frame: number): FrameNumbers {
    const diagnostics = this.data.scene.diagnostics;
    const value = (name: string): number => {
      const column = diagnostics?.columns.indexOf(name) ?? -1;
      return diagnostics?.rows[frame - 1]?.[column] ?? 0;
    };
    return {
      kinetic: value('kinetic_energy'),
      elastic: value('elastic_energy'),
      gravity: value('gravity_energy'),
      maxStretch: value('max_stretch'),
      contacts: value('contacts'),
      frameMs: value('frame_ms'),
      realtime: 0,
      infeasible: value('infeasible'),
    };
  }
}
