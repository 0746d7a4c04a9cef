import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Mesh, MeshStandardMaterial } from 'three';
import type { Vector3 } from 'three';
import { FloorView } from './floor_view';
import { creased, vertexNormals } from './normals';
import { SURFACES } from './occlusion';
import type { Mesh as MeshData, Motion } from '../run/protocol';
import type { Theme } from '../panel/theme';

/** An obstacle: fixed, moved as a rigid body, or deforming. */
export class ObstacleView {
  readonly mesh: Mesh<BufferGeometry, MeshStandardMaterial>;

  /** Of a half-space: what is drawn in place of the mesh, which is only a part of it. */
  readonly floor: FloorView | null;

  /** `floor` says where the scene is [m] if the obstacle is a half-space. */
  constructor(
    private readonly data: MeshData,
    readonly motion: Motion,
    floor: { center: Vector3; radius: number } | null,
  ) {
    const geometry = new BufferGeometry();
    if (motion === 'deforming') {
      const normals = new Float32Array(data.vertices.length);
      geometry.setAttribute('position', new BufferAttribute(data.vertices.slice(), 3).setUsage(DynamicDrawUsage));
      geometry.setAttribute('normal', new BufferAttribute(normals, 3).setUsage(DynamicDrawUsage));
      geometry.setIndex(new BufferAttribute(data.triangles, 1));
    } else {
      const { positions, normals } = creased(data);
      geometry.setAttribute('position', new BufferAttribute(positions, 3));
      geometry.setAttribute('normal', new BufferAttribute(normals, 3));
    }
    // Bodies that lie on the obstacle are in front of it.
    const material = new MeshStandardMaterial({ side: DoubleSide, roughness: 0.8, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
    this.mesh = new Mesh(geometry, material);
    this.mesh.matrixAutoUpdate = false;
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = this.mesh.receiveShadow = true;
    this.floor = floor && new FloorView(data, floor.center, floor.radius);
    for (const mesh of [this.mesh, this.floor?.mesh]) mesh?.layers.enable(SURFACES);
  }

  /** Vertices that picking tests, in the obstacle's frame. */
  get vertices(): Float32Array {
    return this.motion === 'deforming' ? (this.mesh.geometry.getAttribute('position').array as Float32Array) : this.data.vertices;
  }

  get triangles(): Uint32Array {
    return this.data.triangles;
  }

  setPose(pose: Float32Array): void {
    const [a, b, c, d, e, f, g, h, i, x, y, z] = pose;
    // prettier-ignore
    this.mesh.matrix.set(
      a, b, c, x,
      d, e, f, y,
      g, h, i, z,
      0, 0, 0, 1);
    this.mesh.matrixWorldNeedsUpdate = true;
    this.floor?.setMatrix(this.mesh.matrix);
  }

  setVertices(vertices: Float32Array): void {
    const positions = this.mesh.geometry.getAttribute('position');
    const normals = this.mesh.geometry.getAttribute('normal');
    (positions.array as Float32Array).set(vertices);
    vertexNormals(vertices, this.data.triangles, normals.array as Float32Array);
    positions.needsUpdate = true;
    normals.needsUpdate = true;
  }

  update(visible: boolean, theme: Theme): void {
    this.mesh.visible = visible && !this.floor;
    this.floor?.update(visible, theme);
    this.mesh.material.color.copy(theme.obstacle);
  }

  dispose(): void {
    this.floor?.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
