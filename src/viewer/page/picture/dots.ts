import { BufferAttribute, BufferGeometry, CanvasTexture, DynamicDrawUsage, Points, PointsMaterial } from 'three';
import type { Color } from 'three';

let discTexture: CanvasTexture | null = null;

function disc(): CanvasTexture {
  if (discTexture) return discTexture;
  const canvas = document.createElement('canvas');
  canvas.width = canvas.height = 32;
  const context = canvas.getContext('2d');
  if (context) {
    context.fillStyle = '#fff';
    context.arc(16, 16, 15, 0, 2 * Math.PI);
    context.fill();
  }
  discTexture = new CanvasTexture(canvas);
  return discTexture;
}

/** Some of the particles, as discs of one colour. */
export class Dots {
  readonly points: Points<BufferGeometry, PointsMaterial>;
  private readonly chosen: Uint32Array;
  private readonly index: BufferAttribute;

  /** `size` in pixels; `order` above 0 draws over everything. */
  constructor(positions: BufferAttribute, size: number, order = 0) {
    this.chosen = new Uint32Array(positions.count);
    this.index = new BufferAttribute(this.chosen, 1).setUsage(DynamicDrawUsage);
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', positions);
    geometry.setIndex(this.index);
    geometry.setDrawRange(0, 0);
    const material = new PointsMaterial({ size, sizeAttenuation: false, map: disc(), alphaTest: 0.5 });
    material.depthTest = order === 0;
    this.points = new Points(geometry, material);
    this.points.renderOrder = order;
    this.points.frustumCulled = false;
  }

  setColor(color: Color): void {
    this.points.material.color.copy(color);
  }

  /** Shows the particles whose state has the bit. */
  chooseByState(states: Uint8Array, bit: number): void {
    const { chosen } = this;
    let count = 0;
    let changed = false;
    for (let i = 0; i < states.length; ++i) {
      if (!(states[i] & bit)) continue;
      changed ||= chosen[count] !== i;
      chosen[count++] = i;
    }
    if (changed || count !== this.points.geometry.drawRange.count) this.show(count);
  }

  chooseAll(): void {
    for (let i = 0; i < this.chosen.length; ++i) this.chosen[i] = i;
    this.show(this.chosen.length);
  }

  chooseOne(particle: number | undefined): void {
    this.chosen[0] = particle ?? 0;
    this.show(particle === undefined ? 0 : 1);
  }

  dispose(): void {
    this.points.geometry.dispose();
    this.points.material.dispose();
  }

  private show(count: number): void {
    this.points.geometry.setDrawRange(0, count);
    this.index.needsUpdate = true;
  }
}
