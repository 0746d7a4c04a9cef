import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments } from 'three';
import type { RunModel } from '../run/run_model';
import type { Theme } from '../panel/theme';

/** An arrow is as long as the way of its particle in this time [s]. */
const SHOWN_TIME = 0.1;

/** The velocities of the particles, as lines from where they are to where they go. */
export class VelocityView {
  readonly lines: LineSegments<BufferGeometry, LineBasicMaterial>;
  private readonly ends: BufferAttribute;

  constructor(private readonly model: RunModel) {
    this.ends = new BufferAttribute(new Float32Array(2 * model.positions.length), 3).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.ends);
    this.lines = new LineSegments(geometry, new LineBasicMaterial());
    this.lines.frustumCulled = false;
  }

  update(visible: boolean, theme: Theme): void {
    this.lines.visible = visible;
    if (!visible) return;
    this.lines.material.color.copy(theme.contact);
    const { positions, previous, elapsed } = this.model;
    const ends = this.ends.array;
    const factor = elapsed > 0 ? SHOWN_TIME / elapsed : 0;
    for (let k = 0, to = 0; k < positions.length; k += 3, to += 6) {
      for (let d = 0; d < 3; ++d) {
        ends[to + d] = positions[k + d];
        ends[to + 3 + d] = positions[k + d] + factor * (positions[k + d] - previous[k + d]);
      }
    }
    this.ends.needsUpdate = true;
  }

  dispose(): void {
    this.lines.geometry.dispose();
    this.lines.material.dispose();
  }
}
