// The messages of PROTOCOL.md.

export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };
export type Mode = 'live' | 'replay';
export type Motion = 'fixed' | 'rigid' | 'deforming';

export interface BodyRange { name: string; first: number; count: number }
export interface Diagnostics { columns: string[]; rows: (number | null)[][] }
export interface Problem { key: string; value: string; rule: string; remedy: string; text: string }

export interface Example { name: string; sentence: string; picture: boolean }
export interface PictureMessage { type: 'picture'; example: string; png: string }

export interface HelloMessage { type: 'hello'; version: string; mode: Mode; title: string; examples: Example[] }
export interface SceneMessage {
  type: 'scene';
  run: number;
  generation: number;
  title: string;
  integrator: string;
  step: number;
  steps_per_frame: number;
  frame_rate: number;
  frames: number;
  largest_stable_step: number | null;
  live: boolean;
  complete: boolean;
  scene: { [key: string]: Json };
  changed: Json;
  warnings: string[];
  /** The text beside the scene, as of a lesson. */
  lesson?: string;
  /** Of the particles [kg], where they are few. */
  masses?: number[];
  bodies: BodyRange[];
  obstacles: { name: string; motion: Motion }[];
  /** Whether frames have forces of contact. */
  forces?: boolean;
  diagnostics?: Diagnostics;
  torn?: { frame: number; triangles: number[] }[];
  broken?: { frame: number; springs: number[] }[];
}
export interface ProblemsMessage { type: 'problems'; run: number | null; key: string; problems: Problem[] }
export interface StateMessage { type: 'state'; playing: boolean; every: number; speed: number }
export interface DivergedMessage {
  type: 'diverged';
  run: number;
  generation: number;
  text: string;
  body?: string;
  particle?: number;
  springs: number[];
  stable_step: number | null;
}
export interface ObjMessage { type: 'obj'; name: string; text: string }
export interface ChangedMessage { type: 'changed'; run: number; changed: Json }
/** Of a spring [N]; `limit` says whether the pull of the stretch limit is in it, or there is none. */
export interface TensionMessage { type: 'tension'; run: number; spring: number; tension: number; limit: boolean }
export interface SavedMessage { type: 'saved'; name: string; text: string }
export interface NoticeMessage { type: 'notice'; text: string }
export interface ErrorMessage { type: 'error'; text: string }
export interface RemovedMessage { type: 'removed'; run: number }
export type TextMessage =
  | HelloMessage
  | SceneMessage
  | ProblemsMessage
  | StateMessage
  | DivergedMessage
  | ObjMessage
  | ChangedMessage
  | SavedMessage
  | PictureMessage
  | TensionMessage
  | NoticeMessage
  | ErrorMessage
  | RemovedMessage;

export type Command =
  | { do: 'play' | 'pause' | 'step' | 'frame' | 'reset' | 'single' }
  | { do: 'every'; steps: number }
  | { do: 'speed'; factor: number }
  | { do: 'set'; run?: number; key: string; value: Json }
  | { do: 'compare'; integrator: string }
  | { do: 'open' | 'picture'; example: string }
  | { do: 'grab' | 'release'; run: number; particle: number }
  | { do: 'drag'; target: [number, number, number] }
  | { do: 'drop'; pin: boolean }
  | { do: 'scene'; run: number; state?: string }
  | { do: 'save'; as: 'run' | 'page'; name: string }
  | { do: 'rewind'; time: number }
  | { do: 'tension'; run: number; spring: number }
  | { do: 'obj'; run: number; body: string }
  | { do: 'seek'; frame: number };

export interface Header {
  kind: number;
  run: number;
  generation: number;
  frame: number;
  time: number;
  particles: number;
  playing: boolean;
}

export interface Mesh { vertices: Float32Array; triangles: Uint32Array }

export interface Topology {
  particles: number;
  triangles: Uint32Array;
  segments: Uint32Array;
  springs: Uint32Array;
  restLengths: Float32Array;
  kinds: Uint32Array;
  obstacles: Mesh[];
}

export interface FrameNumbers {
  kinetic: number;
  elastic: number;
  gravity: number;
  maxStretch: number;
  contacts: number;
  frameMs: number;
  realtime: number;
  infeasible: number;
  contactEnergy: number;
  /** The force of the hand [N]. */
  pull: number;
}

export interface Frame {
  numbers: FrameNumbers;
  positions: Float32Array;
  speeds: Float32Array;
  states: Uint8Array;
  /** Of the rigid obstacles, in their order: rotation by rows, then position. */
  poses: Float32Array[];
  /** Vertices of the deforming obstacles, in their order. */
  deformed: Float32Array[];
  /** On the particles whose state has the bit HAS_FORCE [N], three numbers each. */
  contactForces: Float32Array;
}

export const TOPOLOGY = 1;
export const FRAME = 2;
export const IN_CONTACT = 1;
export const PINNED = 2;
export const HAS_FORCE = 4;
/** Kinds of springs, by number. */
export const SPRING_KINDS = ['structural', 'shear', 'bend'];
export const STRUCTURAL = 0;
const HEADER_BYTES = 32;

export function decodeHeader(buffer: ArrayBuffer): Header {
  const view = new DataView(buffer);
  return {
    kind: view.getUint32(0, true),
    run: view.getUint32(4, true),
    generation: view.getUint32(8, true),
    frame: view.getUint32(12, true),
    time: view.getFloat64(16, true),
    particles: view.getUint32(24, true),
    playing: (view.getUint32(28, true) & 1) !== 0,
  };
}

/** Takes arrays out of a message one after the other, without a copy. */
class Reader {
  private at = HEADER_BYTES;

  constructor(private readonly buffer: ArrayBuffer) {}

  u32(count: number): Uint32Array {
    const array = new Uint32Array(this.buffer, this.at, count);
    this.at += 4 * count;
    return array;
  }

  f32(count: number): Float32Array {
    const array = new Float32Array(this.buffer, this.at, count);
    this.at += 4 * count;
    return array;
  }

  u8(count: number): Uint8Array {
    const array = new Uint8Array(this.buffer, this.at, count);
    this.at += 4 * Math.ceil(count / 4);
    return array;
  }
}

export function decodeTopology(buffer: ArrayBuffer): Topology {
  const reader = new Reader(buffer);
  const [triangles, segments, springs, obstacles] = reader.u32(4);
  const sizes = reader.u32(2 * obstacles);
  const topology: Topology = {
    particles: decodeHeader(buffer).particles,
    triangles: reader.u32(3 * triangles),
    segments: reader.u32(2 * segments),
    springs: reader.u32(2 * springs),
    restLengths: reader.f32(springs),
    kinds: reader.u32(springs),
    obstacles: [],
  };
  for (let k = 0; k < obstacles; ++k) {
    topology.obstacles.push({ vertices: reader.f32(3 * sizes[2 * k]), triangles: reader.u32(3 * sizes[2 * k + 1]) });
  }
  return topology;
}

/** All poses come before all deformed vertices. */
export function decodeFrame(buffer: ArrayBuffer, header: Header, scene: SceneMessage, topology: Topology): Frame {
  const reader = new Reader(buffer);
  const [kinetic, elastic, gravity, maxStretch, contacts, frameMs, realtime, infeasible, contactEnergy, pull] = reader.f32(10);
  const positions = reader.f32(3 * header.particles);
  const speeds = reader.f32(header.particles);
  const states = reader.u8(header.particles);
  const poses: Float32Array[] = [];
  const deformed: Float32Array[] = [];
  for (const obstacle of scene.obstacles) {
    if (obstacle.motion === 'rigid') poses.push(reader.f32(12));
  }
  scene.obstacles.forEach((obstacle, k) => {
    if (obstacle.motion === 'deforming') deformed.push(reader.f32(topology.obstacles[k].vertices.length));
  });
  let pushed = 0;
  for (let i = 0; i < states.length; ++i) if (states[i] & HAS_FORCE) ++pushed;
  const contactForces = reader.f32(3 * pushed);
  return {
    numbers: { kinetic, elastic, gravity, maxStretch, contacts, frameMs, realtime, infeasible, contactEnergy, pull },
    positions,
    speeds,
    states,
    poses,
    deformed,
    contactForces,
  };
}
