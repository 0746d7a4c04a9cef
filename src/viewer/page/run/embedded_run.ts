import { decodeTopology, FRAME, TOPOLOGY } from './protocol';
import type { Command, Frame, FrameNumbers, Header, SceneMessage, Topology } from './protocol';
import type { Source, SourceListener } from './source';

/** See html_export.h. */
interface Embedded {
  scene: SceneMessage;
  bounds: { min: number[]; size: number[] };
  error: number;
  times: number[];
  poses: number[][][];
  topology_bytes: number;
  level_bytes: number;
  data: string;
}

const LEVELS = 65535;

function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; ++k) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

async function decompressed(bytes: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return await new Response(stream).arrayBuffer();
}

/** Levels of all frames, from their differences. */
function levelsOf(bytes: Uint8Array, frames: number): Uint16Array[] {
  const values = bytes.length / (2 * frames);
  const levels: Uint16Array[] = [];
  for (let frame = 0; frame < frames; ++frame) {
    const low = bytes.subarray(2 * values * frame, 2 * values * (frame + 1));
    const before = levels.at(-1) ?? new Uint16Array(values);
    const next = new Uint16Array(values);
    for (let k = 0; k < values; ++k) next[k] = before[k] + low[k] + 256 * low[values + k];
    levels.push(next);
  }
  return levels;
}

/** States of the vertices in all frames, from their differences. */
function statesOf(bytes: Uint8Array, frames: number): Uint8Array[] {
  const count = bytes.length / frames;
  const states: Uint8Array[] = [];
  for (let frame = 0; frame < frames; ++frame) {
    const before = states.at(-1) ?? new Uint8Array(count);
    const next = new Uint8Array(count);
    for (let k = 0; k < count; ++k) next[k] = before[k] + bytes[count * frame + k];
    states.push(next);
  }
  return states;
}

/** The run inside the page, or null. Throws where the browser cannot decompress it. */
export async function embeddedRun(): Promise<EmbeddedRun | null> {
  const text = document.getElementById('sprung-run')?.textContent;
  if (!text) return null;
  const data = JSON.parse(text) as Embedded;
  const bytes = await decompressed(bytesOf(data.data));
  const frames = data.times.length;
  const levels = levelsOf(new Uint8Array(bytes, data.topology_bytes, data.level_bytes), frames);
  const states = statesOf(new Uint8Array(bytes, data.topology_bytes + data.level_bytes), frames);
  return new EmbeddedRun(data, decodeTopology(bytes.slice(0, data.topology_bytes)), levels, states);
}

/** A run that `sprung export --format html` wrote into the page. Answers `seek` as the server does. */
export class EmbeddedRun implements Source {
  private listener: SourceListener | null = null;
  /** A file leaves out the speeds. */
  private readonly speeds: Float32Array;

  constructor(
    private readonly data: Embedded,
    private readonly topology: Topology,
    private readonly levels: Uint16Array[],
    private readonly states: Uint8Array[],
  ) {
    this.speeds = new Float32Array(topology.particles);
  }

  /** What rounding has changed. */
  get note(): string {
    return `positions within ${this.data.error.toExponential(1)} m`;
  }

  start(listener: SourceListener): void {
    this.listener = listener;
    const scene = { ...this.data.scene, run: 0, generation: 1, frames: this.data.times.length };
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
    const number = Math.min(Math.max(Math.round(frame), 1), this.data.times.length);
    const count = this.topology.particles;
    const positions = this.positions(number);
    const decoded: Frame = {
      numbers: this.numbers(number),
      positions: positions.subarray(0, 3 * count),
      speeds: this.speeds,
      states: this.states[number - 1],
      poses: this.data.poses[number - 1].map((pose) => Float32Array.from(pose)),
      deformed: this.deformed(positions.subarray(3 * count)),
      contactForces: new Float32Array(0),
    };
    this.listener?.frame(this.header(FRAME, number), decoded);
  }

  private header(kind: number, frame: number): Header {
    const time = this.data.times[frame - 1];
    return { kind, run: 0, generation: 1, frame, time, particles: this.topology.particles, playing: false };
  }

  private positions(frame: number): Float32Array {
    const { min, size } = this.data.bounds;
    const levels = this.levels[frame - 1];
    const positions = new Float32Array(levels.length);
    // Float32Array.from with a function takes 15 times as long.
    for (let d = 0; d < 3; ++d) {
      for (let k = d; k < levels.length; k += 3) positions[k] = min[d] + (size[d] * levels[k]) / LEVELS;
    }
    return positions;
  }

  /** The vertices of each obstacle that deforms. */
  private deformed(vertices: Float32Array): Float32Array[] {
    let begin = 0;
    return this.data.scene.obstacles.flatMap(({ motion }, k) => {
      if (motion !== 'deforming') return [];
      const from = begin;
      begin += this.topology.obstacles[k].vertices.length;
      return [vertices.subarray(from, begin)];
    });
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
      contactEnergy: value('contact_energy'),
      pull: 0,
    };
  }
}
