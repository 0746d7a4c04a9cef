import { History } from './history';
import { HAS_FORCE } from './protocol';
import type { DivergedMessage, Frame, FrameNumbers, Header, SceneMessage, Topology } from './protocol';

export interface BodyState { positions: Float32Array }

/** One run: its scene and its newest frame. The arrays stay the same ones from frame to frame. */
export class RunModel {
  readonly positions: Float32Array;
  /** Those of the frame before, and the time between [s]. */
  readonly previous: Float32Array;
  elapsed = 0;
  readonly speeds: Float32Array;
  readonly states: Uint8Array;
  /** Those that are gone in the frame have the same corner three times, or the same end twice. */
  readonly triangles: Uint32Array;
  readonly springs: Uint32Array;
  /** Grows or shrinks when triangles or springs change. */
  removals = 0;
  /** By name: views of `positions`. */
  readonly bodies: Record<string, BodyState> = {};
  poses: Float32Array[] = [];
  deformed: Float32Array[] = [];
  /** The mean force of contact on each particle in the frame [N]; null where it is not known. */
  readonly contactForces: Float32Array | null;
  numbers: FrameNumbers | null = null;
  frame = 0;
  time = 0;
  diverged: DivergedMessage | null = null;

  constructor(
    readonly scene: SceneMessage,
    readonly topology: Topology,
    readonly history: History,
  ) {
    const count = topology.particles;
    this.positions = new Float32Array(3 * count);
    this.previous = new Float32Array(3 * count);
    this.speeds = new Float32Array(count);
    this.states = new Uint8Array(count);
    this.contactForces = scene.forces ? new Float32Array(3 * count) : null;
    this.triangles = topology.triangles.slice();
    this.springs = topology.springs.slice();
    for (const { name, first, count: size } of scene.bodies) {
      this.bodies[name] = { positions: this.positions.subarray(3 * first, 3 * (first + size)) };
    }
  }

  apply(header: Header, frame: Frame): void {
    if (header.time !== this.time) {
      this.previous.set(this.positions);
      this.elapsed = header.time - this.time;
    }
    this.positions.set(frame.positions);
    this.speeds.set(frame.speeds);
    this.states.set(frame.states);
    this.poses = frame.poses;
    this.deformed = frame.deformed;
    this.setContactForces(frame.contactForces);
    this.numbers = frame.numbers;
    this.frame = header.frame;
    this.time = header.time;
    this.remove();
  }

  /** A frame has those of the particles alone on which contact acted. */
  private setContactForces(forces: Float32Array): void {
    if (!this.contactForces) return;
    this.contactForces.fill(0);
    for (let i = 0, at = 0; i < this.states.length; ++i) {
      if (!(this.states[i] & HAS_FORCE)) continue;
      for (let d = 0; d < 3; ++d) this.contactForces[3 * i + d] = forces[at++];
    }
  }

  /** Removes what tore or broke until the frame. */
  private remove(): void {
    const torn = (this.scene.torn ?? []).filter((tear) => tear.frame <= this.frame);
    const broken = (this.scene.broken ?? []).filter((breaking) => breaking.frame <= this.frame);
    if (torn.length + broken.length === this.removals) return;
    this.removals = torn.length + broken.length;
    this.triangles.set(this.topology.triangles);
    this.springs.set(this.topology.springs);
    for (const t of torn.flatMap(({ triangles }) => triangles)) this.triangles.fill(this.triangles[3 * t], 3 * t, 3 * t + 3);
    for (const s of broken.flatMap(({ springs }) => springs)) this.springs[2 * s + 1] = this.springs[2 * s];
  }
}
