import { Color, CylinderGeometry, DynamicDrawUsage, Group, InstancedMesh, Matrix4, MeshLambertMaterial, SphereGeometry } from 'three';

const matrix = new Matrix4();
const color = new Color();

/** Ropes as tubes: a cylinder for each segment, a ball at each vertex. */
export class RopeView {
  readonly group = new Group();
  private readonly tubes: InstancedMesh;
  private readonly balls: InstancedMesh;
  private readonly vertices: Uint32Array;

  constructor(
    private readonly segments: Uint32Array,
    private readonly radius: number,
  ) {
    this.vertices = new Uint32Array([...new Set(segments)].sort((a, b) => a - b));
    const material = new MeshLambertMaterial();
    this.tubes = new InstancedMesh(new CylinderGeometry(1, 1, 1, 12, 1, true), material, segments.length / 2);
    this.balls = new InstancedMesh(new SphereGeometry(radius, 12, 8), material, this.vertices.length);
    for (const mesh of [this.tubes, this.balls]) {
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      mesh.frustumCulled = false;
      this.group.add(mesh);
    }
  }

  place(positions: Float32Array): void {
    for (let s = 0; s < this.segments.length / 2; ++s) this.placeTube(s, positions);
    for (let k = 0; k < this.vertices.length; ++k) {
      const i = 3 * this.vertices[k];
      matrix.makeTranslation(positions[i], positions[i + 1], positions[i + 2]);
      this.balls.setMatrixAt(k, matrix);
    }
    this.tubes.instanceMatrix.needsUpdate = true;
    this.balls.instanceMatrix.needsUpdate = true;
  }

  paint(colors: Float32Array): void {
    for (let s = 0; s < this.segments.length / 2; ++s) {
      const a = 3 * this.segments[2 * s];
      const b = 3 * this.segments[2 * s + 1];
      color.setRGB((colors[a] + colors[b]) / 2, (colors[a + 1] + colors[b + 1]) / 2, (colors[a + 2] + colors[b + 2]) / 2);
      this.tubes.setColorAt(s, color);
    }
    for (let k = 0; k < this.vertices.length; ++k) this.balls.setColorAt(k, color.fromArray(colors, 3 * this.vertices[k]));
    if (this.tubes.instanceColor) this.tubes.instanceColor.needsUpdate = true;
    if (this.balls.instanceColor) this.balls.instanceColor.needsUpdate = true;
  }

  /** One colour, drawn over everything. */
  mark(tint: Color): void {
    const material = this.tubes.material as MeshLambertMaterial;
    material.emissive.copy(tint);
    material.color.set(0);
    material.depthTest = false;
    this.tubes.renderOrder = this.balls.renderOrder = 1;
  }

  dispose(): void {
    for (const mesh of [this.tubes, this.balls]) {
      mesh.geometry.dispose();
      mesh.dispose();
    }
    (this.tubes.material as MeshLambertMaterial).dispose();
  }

  /** The tube's axis is the cylinder's y; x and z are any two directions across it. */
  private placeTube(s: number, positions: Float32Array): void {
    const a = 3 * this.segments[2 * s];
    const b = 3 * this.segments[2 * s + 1];
    const yx = positions[b] - positions[a];
    const yy = positions[b + 1] - positions[a + 1];
    const yz = positions[b + 2] - positions[a + 2];
    const length = Math.sqrt(yx * yx + yy * yy + yz * yz) || 1e-9;
    // Across the direction: the cross product with the axis that it is farthest from.
    const awayFromX = Math.abs(yx) < 0.7 * length;
    let xx = awayFromX ? 0 : -yz;
    let xy = awayFromX ? yz : 0;
    let xz = awayFromX ? -yy : yx;
    const across = this.radius / (Math.sqrt(xx * xx + xy * xy + xz * xz) || 1);
    xx *= across;
    xy *= across;
    xz *= across;
    const zx = (xy * yz - xz * yy) / length;
    const zy = (xz * yx - xx * yz) / length;
    const zz = (xx * yy - xy * yx) / length;
    // prettier-ignore
    matrix.set(
      xx, yx, zx, (positions[a] + positions[b]) / 2,
      xy, yy, zy, (positions[a + 1] + positions[b + 1]) / 2,
      xz, yz, zz, (positions[a + 2] + positions[b + 2]) / 2,
      0, 0, 0, 1);
    this.tubes.setMatrixAt(s, matrix);
  }
}
