import { Color, DynamicDrawUsage, InstancedMesh, Matrix4, MeshStandardMaterial, SphereGeometry } from 'three';

const matrix = new Matrix4();
const color = new Color();

/** Particles as balls whose volume grows with their mass. */
export class MassView {
  readonly mesh: InstancedMesh;
  private readonly radii: number[];

  /** `radius` is that of the heaviest [m]. */
  constructor(masses: number[], radius: number) {
    const heaviest = Math.max(...masses);
    this.radii = masses.map((mass) => radius * Math.cbrt(mass / heaviest));
    this.mesh = new InstancedMesh(new SphereGeometry(1, 24, 16), new MeshStandardMaterial({ roughness: 0.4 }), masses.length);
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = this.mesh.receiveShadow = true;
  }

  place(positions: Float32Array): void {
    this.radii.forEach((radius, i) => {
      matrix.makeScale(radius, radius, radius).setPosition(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
      this.mesh.setMatrixAt(i, matrix);
    });
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  paint(colors: Float32Array): void {
    this.radii.forEach((_, i) => this.mesh.setColorAt(i, color.fromArray(colors, 3 * i)));
    if (this.mesh.instanceColor) this.mesh.instanceColor.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    (this.mesh.material as MeshStandardMaterial).dispose();
    this.mesh.dispose();
  }
}
