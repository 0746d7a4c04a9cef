import {
  Color,
  CylinderGeometry,
  DynamicDrawUsage,
  Group,
  InstancedBufferAttribute,
  InstancedMesh,
  Matrix4,
  MeshStandardMaterial,
  SphereGeometry,
} from 'three';

const matrix = new Matrix4();
const color = new Color();
/** One turn of the strands of a rope [radii]. */
const PITCH = 11;
/** What has fewer segments is no rope, but masses on springs. */
const FEWEST_STRANDED = 8;

/** Ropes as tubes: a cylinder for each segment, a ball at each vertex. */
export class RopeView {
  readonly group = new Group();
  private readonly tubes: InstancedMesh;
  private readonly balls: InstancedMesh;
  private readonly vertices: Uint32Array;
  /** Where the strands of each tube begin, and their turns along it. */
  private readonly twists: InstancedBufferAttribute;
  private measured = false;
  /** A direction across the last tube: strands go on from tube to tube. */
  private readonly across = new Float32Array(3);

  constructor(
    private readonly segments: Uint32Array,
    private readonly radius: number,
  ) {
    this.vertices = new Uint32Array([...new Set(segments)].sort((a, b) => a - b));
    const count = segments.length / 2;
    this.twists = new InstancedBufferAttribute(new Float32Array(2 * count), 2);
    const tube = new CylinderGeometry(1, 1, 1, 14, 1, true);
    tube.setAttribute('twist', this.twists);
    this.tubes = new InstancedMesh(tube, tubeMaterial(count >= FEWEST_STRANDED), count);
    this.balls = new InstancedMesh(new SphereGeometry(radius, 14, 10), new MeshStandardMaterial({ roughness: 0.85 }), this.vertices.length);
    for (const mesh of [this.tubes, this.balls]) {
      mesh.instanceMatrix.setUsage(DynamicDrawUsage);
      mesh.frustumCulled = false;
      mesh.castShadow = mesh.receiveShadow = true;
      this.group.add(mesh);
    }
  }

  place(positions: Float32Array): void {
    if (!this.measured) this.measure(positions);
    this.measured = true;
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
    for (const mesh of [this.tubes, this.balls]) {
      const material = mesh.material as MeshStandardMaterial;
      material.emissive.copy(tint);
      material.color.set(0);
      material.depthTest = false;
      mesh.renderOrder = 1;
      mesh.castShadow = false;
    }
  }

  dispose(): void {
    for (const mesh of [this.tubes, this.balls]) {
      mesh.geometry.dispose();
      (mesh.material as MeshStandardMaterial).dispose();
      mesh.dispose();
    }
  }

  private measure(positions: Float32Array): void {
    let turns = 0;
    for (let s = 0; s < this.segments.length / 2; ++s) {
      const a = 3 * this.segments[2 * s];
      const b = 3 * this.segments[2 * s + 1];
      const x = positions[b] - positions[a];
      const y = positions[b + 1] - positions[a + 1];
      const z = positions[b + 2] - positions[a + 2];
      const along = Math.sqrt(x * x + y * y + z * z) / (PITCH * this.radius);
      this.twists.setXY(s, turns, along);
      turns += along;
    }
    this.twists.needsUpdate = true;
  }

  /** The tube's axis is the cylinder's y; x and z are any two directions across it. */
  private placeTube(s: number, positions: Float32Array): void {
    const a = 3 * this.segments[2 * s];
    const b = 3 * this.segments[2 * s + 1];
    const yx = positions[b] - positions[a];
    const yy = positions[b + 1] - positions[a + 1];
    const yz = positions[b + 2] - positions[a + 2];
    const length = Math.sqrt(yx * yx + yy * yy + yz * yz) || 1e-9;
    const last = this.across;
    const along = (last[0] * yx + last[1] * yy + last[2] * yz) / (length * length);
    let xx = last[0] - along * yx;
    let xy = last[1] - along * yy;
    let xz = last[2] - along * yz;
    if (s === 0 || this.segments[2 * s] !== this.segments[2 * s - 1] || xx * xx + xy * xy + xz * xz < 1e-4) {
      // The cross product with the axis that the direction is farthest from.
      const awayFromX = Math.abs(yx) < 0.7 * length;
      xx = awayFromX ? 0 : -yz;
      xy = awayFromX ? yz : 0;
      xz = awayFromX ? -yy : yx;
    }
    const inverse = 1 / (Math.sqrt(xx * xx + xy * xy + xz * xz) || 1);
    last[0] = xx * inverse;
    last[1] = xy * inverse;
    last[2] = xz * inverse;
    xx = last[0] * this.radius;
    xy = last[1] * this.radius;
    xz = last[2] * this.radius;
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

/** Three strands wind around a rope; from afar they fade. */
function tubeMaterial(stranded: boolean): MeshStandardMaterial {
  const material = new MeshStandardMaterial({ roughness: 0.85 });
  if (!stranded) return material;
  material.onBeforeCompile = (shader) => {
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', '#include <common>\nattribute vec2 twist;\nvarying float vStrand;')
      .replace('#include <begin_vertex>', '#include <begin_vertex>\nvStrand = 3.0 * (uv.x + twist.x + uv.y * twist.y);');
    shader.fragmentShader = shader.fragmentShader.replace('#include <common>', '#include <common>\nvarying float vStrand;').replace(
      '#include <color_fragment>',
      `#include <color_fragment>
      float groove = pow(abs(sin(PI * vStrand)), 0.7);
      diffuseColor.rgb *= mix(0.85, mix(0.6, 1.05, groove), 1.0 - smoothstep(0.2, 0.6, fwidth(vStrand)));`,
    );
  };
  return material;
}
