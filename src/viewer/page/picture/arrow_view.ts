import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments } from 'three';
import type { Color } from 'three';

/** Of an arrow's length: how long its head is, and half of its width. */
const HEAD = 0.22;
const HALF_WIDTH = 0.08;
/** A shaft and two barbs, two ends each. */
const ENDS = 6;

/** An arrow from each particle. */
export class ArrowView {
  readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;
  private readonly ends: BufferAttribute;

  /** Arrows that are `inFront` are not hidden by surfaces: forces act at surfaces, and point into what they push. */
  constructor(particles: number, inFront = false) {
    this.ends = new BufferAttribute(new Float32Array(3 * ENDS * particles), 3).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.ends);
    this.lines = new LineSegments(geometry, new LineBasicMaterial({ depthTest: !inFront }));
    this.lines.renderOrder = inFront ? 2 : 0;
    this.lines.visible = this.lines.frustumCulled = false;
  }

  hide(): void {
    this.lines.visible = false;
  }

  /** Arrows of `factor` times the vectors, three numbers for each particle. */
  show(from: Float32Array, vectors: Float32Array, factor: number, color: Color): void {
    this.lines.visible = true;
    this.lines.material.color.copy(color);
    const ends = this.ends.array;
    for (let k = 0, to = 0; k < from.length; k += 3, to += 3 * ENDS) {
      const x = factor * vectors[k];
      const y = factor * vectors[k + 1];
      const z = factor * vectors[k + 2];
      // Across the arrow and as upright as can be, or across x if it points up.
      const flat = Math.sqrt(x * x + z * z);
      const length = Math.sqrt(x * x + y * y + z * z);
      const upright = flat < 1e-3 * length;
      const scale = flat > 0 ? HALF_WIDTH / flat : 0;
      const sideX = upright ? HALF_WIDTH * length : -scale * x * y;
      const sideY = upright ? 0 : HALF_WIDTH * flat;
      const sideZ = upright ? 0 : -scale * z * y;
      const tipX = from[k] + x;
      const tipY = from[k + 1] + y;
      const tipZ = from[k + 2] + z;
      ends[to] = from[k];
      ends[to + 1] = from[k + 1];
      ends[to + 2] = from[k + 2];
      ends[to + 3] = ends[to + 6] = ends[to + 12] = tipX;
      ends[to + 4] = ends[to + 7] = ends[to + 13] = tipY;
      ends[to + 5] = ends[to + 8] = ends[to + 14] = tipZ;
      ends[to + 9] = tipX - HEAD * x + sideX;
      ends[to + 10] = tipY - HEAD * y + sideY;
      ends[to + 11] = tipZ - HEAD * z + sideZ;
      ends[to + 15] = tipX - HEAD * x - sideX;
      ends[to + 16] = tipY - HEAD * y - sideY;
      ends[to + 17] = tipZ - HEAD * z - sideZ;
    }
    this.ends.needsUpdate = true;
  }

  dispose(): void {
    this.lines.geometry.dispose();
    this.lines.material.dispose();
  }
}
