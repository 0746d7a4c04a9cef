import { Matrix4, Vector3 } from 'three';
import type { RunView } from './run_view';
import type { Rect, SceneView } from './scene_view';

const REACH_PX = 24;
/** A spring beside the pointer is meant, unless a particle is nearer. */
const SPRING_REACH_PX = 8;
const CANDIDATES = 16;

export interface Pick { run: number; particle: number }

interface Candidate { particle: number; distance: number }

const projection = new Matrix4();
const eye = new Vector3();
const point = new Vector3();

/** The run at a point of the picture. */
export function runAt(view: SceneView, x: number, y: number): number {
  return Math.max(
    view.rects().findIndex((rect) => x >= rect.x && x < rect.x + rect.width && y >= rect.y && y < rect.y + rect.height),
    0,
  );
}

/** A particle's place in the picture [pixels]. */
export function project(view: SceneView, pick: Pick): { x: number; y: number } | null {
  const run = view.runs[pick.run];
  if (!run) return null;
  const rect = view.aim(pick.run);
  point.fromArray(run.model.positions, 3 * pick.particle).project(view.camera);
  return { x: rect.x + ((point.x + 1) / 2) * rect.width, y: rect.y + ((1 - point.y) / 2) * rect.height };
}

/** The particle nearest to a point of the picture; with `hidden`, one behind something counts too. */
export function pick(view: SceneView, x: number, y: number, hidden = false): Pick | null {
  const number = runAt(view, x, y);
  const run = view.runs[number];
  if (!run) return null;
  const found = nearest(view, run, view.aim(number), x, y, hidden ? 1 : CANDIDATES);
  eye.copy(view.camera.position);
  for (const { particle } of found) {
    if (hidden || isVisible(view, run, particle)) return { run: number, particle };
  }
  return null;
}

/** The spring nearest to a point of the picture, with the nearer of its ends; springs behind something count too. */
export function pickSpring(view: SceneView, x: number, y: number, particle?: number): (Pick & { spring: number }) | null {
  const number = runAt(view, x, y);
  const run = view.runs[number];
  if (!run) return null;
  const { springs } = run.model;
  const places = placesOf(view, number);
  let best = SPRING_REACH_PX;
  let found: (Pick & { spring: number }) | null = null;
  for (let s = 0; 2 * s < springs.length; ++s) {
    const a = springs[2 * s];
    const b = springs[2 * s + 1];
    if (a === b || (particle !== undefined && a !== particle && b !== particle)) continue;
    const fromX = x - places[2 * a];
    const fromY = y - places[2 * a + 1];
    const dx = places[2 * b] - places[2 * a];
    const dy = places[2 * b + 1] - places[2 * a + 1];
    const along = Math.min(Math.max((fromX * dx + fromY * dy) / (dx * dx + dy * dy || 1), 0), 1);
    const distance = Math.hypot(fromX - along * dx, fromY - along * dy);
    if (!(distance < best)) continue; // one end is behind the camera
    best = distance;
    found = { run: number, spring: s, particle: particle ?? (along < 0.5 ? a : b) };
  }
  return found;
}

/** The places of all particles of a run in the picture [pixels]; NaN behind the camera. */
function placesOf(view: SceneView, number: number): Float32Array {
  const rect = view.aim(number);
  const e = projection.multiplyMatrices(view.camera.projectionMatrix, view.camera.matrixWorldInverse).elements;
  const p = view.runs[number].model.positions;
  const places = new Float32Array((2 * p.length) / 3).fill(NaN);
  for (let k = 0, to = 0; k < p.length; k += 3, to += 2) {
    const w = e[3] * p[k] + e[7] * p[k + 1] + e[11] * p[k + 2] + e[15];
    if (!(w > 0)) continue;
    places[to] = rect.x + ((e[0] * p[k] + e[4] * p[k + 1] + e[8] * p[k + 2] + e[12]) / w / 2 + 0.5) * rect.width;
    places[to + 1] = rect.y + (0.5 - (e[1] * p[k] + e[5] * p[k + 1] + e[9] * p[k + 2] + e[13]) / w / 2) * rect.height;
  }
  return places;
}

/** Particles within reach, the nearest first. */
function nearest(view: SceneView, run: RunView, rect: Rect, x: number, y: number, most: number): Candidate[] {
  const e = projection.multiplyMatrices(view.camera.projectionMatrix, view.camera.matrixWorldInverse).elements;
  const p = run.model.positions;
  const found: Candidate[] = [];
  let limit = REACH_PX * REACH_PX;
  for (let particle = 0; 3 * particle < p.length; ++particle) {
    const px = p[3 * particle];
    const py = p[3 * particle + 1];
    const pz = p[3 * particle + 2];
    const w = e[3] * px + e[7] * py + e[11] * pz + e[15];
    if (!(w > 0)) continue;
    const dx = rect.x + ((e[0] * px + e[4] * py + e[8] * pz + e[12]) / w / 2 + 0.5) * rect.width - x;
    const dy = rect.y + (0.5 - (e[1] * px + e[5] * py + e[9] * pz + e[13]) / w / 2) * rect.height - y;
    const distance = dx * dx + dy * dy;
    if (distance >= limit) continue;
    found.push({ particle, distance });
    if (found.length < 2 * most) continue;
    found.sort((a, b) => a.distance - b.distance).length = most;
    limit = found[most - 1].distance;
  }
  return found.sort((a, b) => a.distance - b.distance).slice(0, most);
}

function isVisible(view: SceneView, run: RunView, particle: number): boolean {
  const { positions, topology } = run.model;
  point.fromArray(positions, 3 * particle);
  if (view.options.surface && crosses(eye, point, positions, topology.triangles, particle)) return false;
  if (!view.options.obstacles) return true;
  const from = new Vector3();
  const to = new Vector3();
  const inverse = new Matrix4();
  return !run.obstacles.some((obstacle) => {
    inverse.copy(obstacle.mesh.matrix).invert();
    from.copy(eye).applyMatrix4(inverse);
    to.copy(point).applyMatrix4(inverse);
    return crosses(from, to, obstacle.vertices, obstacle.triangles, -1);
  });
}

/** Whether a triangle crosses a line of sight before its end (Möller and Trumbore 1997); those of `particle` are left out. */
function crosses(from: Vector3, to: Vector3, v: Float32Array, triangles: Uint32Array, particle: number): boolean {
  const dx = to.x - from.x;
  const dy = to.y - from.y;
  const dz = to.z - from.z;
  for (let t = 0; t < triangles.length; t += 3) {
    if (triangles[t] === particle || triangles[t + 1] === particle || triangles[t + 2] === particle) continue;
    const a = 3 * triangles[t];
    const b = 3 * triangles[t + 1];
    const c = 3 * triangles[t + 2];
    const e1x = v[b] - v[a];
    const e1y = v[b + 1] - v[a + 1];
    const e1z = v[b + 2] - v[a + 2];
    const e2x = v[c] - v[a];
    const e2y = v[c + 1] - v[a + 1];
    const e2z = v[c + 2] - v[a + 2];
    const px = dy * e2z - dz * e2y;
    const py = dz * e2x - dx * e2z;
    const pz = dx * e2y - dy * e2x;
    const determinant = e1x * px + e1y * py + e1z * pz;
    if (determinant === 0) continue;
    const sx = from.x - v[a];
    const sy = from.y - v[a + 1];
    const sz = from.z - v[a + 2];
    const first = (sx * px + sy * py + sz * pz) / determinant;
    if (first < 0 || first > 1) continue;
    const qx = sy * e1z - sz * e1y;
    const qy = sz * e1x - sx * e1z;
    const qz = sx * e1y - sy * e1x;
    const second = (dx * qx + dy * qy + dz * qz) / determinant;
    if (second < 0 || first + second > 1) continue;
    const at = (e2x * qx + e2y * qy + e2z * qz) / determinant;
    if (at > 0 && at < 0.995) return true;
  }
  return false;
}
