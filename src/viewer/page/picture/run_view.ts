import {
  Box3,
  BufferAttribute,
  BufferGeometry,
  DirectionalLight,
  DynamicDrawUsage,
  HemisphereLight,
  Line,
  LineBasicMaterial,
  Scene,
  Sphere,
  Vector3,
} from 'three';
import { BodyView } from './body_view';
import { ObstacleView } from './obstacle_view';
import type { Json } from '../run/protocol';
import type { RunModel } from '../run/run_model';
import type { Theme } from '../panel/theme';
import type { ColorMode, ViewOptions } from './view_options';

/** From the side of the usual view, so that folds have a dark flank. */
const KEY_DIRECTION = new Vector3(-0.95, 1.5, 0.75).normalize();
const SHADOW_PIXELS = 2048;
const sphere = new Sphere();

interface ObstacleScene { shape?: { type?: string }; motion?: { keyframes?: { position?: Json }[] } }

/** The picture of one run. */
export class RunView {
  readonly scene = new Scene();
  readonly bodies: BodyView;
  readonly obstacles: ObstacleView[];
  private readonly key = new DirectionalLight(0xffffff, 1.9);
  private readonly pull: Line<BufferGeometry, LineBasicMaterial>;
  private readonly shadowCenter = new Vector3();
  private shadowRadius = 0;
  /** Of the bodies in the frame shown. */
  readonly bodyBox = new Box3();

  constructor(readonly model: RunModel) {
    const size = this.measureBodies().isEmpty() ? 1 : this.bodyBox.getSize(new Vector3()).length();
    this.bodies = new BodyView(model, size);
    const floor = { center: this.bodyBox.getCenter(new Vector3()), radius: size };
    this.obstacles = model.topology.obstacles.map((mesh, k) => {
      const { name, motion } = model.scene.obstacles[k] ?? { name: '', motion: 'fixed' };
      return new ObstacleView(mesh, motion, this.obstacleScene(name).shape?.type === 'half_space' ? floor : null);
    });
    const pull = new BufferGeometry();
    pull.setAttribute('position', new BufferAttribute(new Float32Array(6), 3).setUsage(DynamicDrawUsage));
    this.pull = new Line(pull, new LineBasicMaterial({ depthTest: false }));
    this.pull.visible = this.pull.frustumCulled = false;
    this.pull.renderOrder = 3;
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(SHADOW_PIXELS, SHADOW_PIXELS);
    this.key.shadow.radius = 4;
    this.key.shadow.intensity = 0.8;
    const rim = new DirectionalLight(0xffffff, 0.8);
    rim.position.set(1, 0.7, -1.2);
    this.scene.add(new HemisphereLight(0xffffff, 0xa4a7ad, 1.9), this.key, this.key.target, rim, this.pull, this.bodies.group);
    for (const obstacle of this.obstacles) this.scene.add(obstacle.floor?.mesh ?? obstacle.mesh);
  }

  /** The limit of stretch [1], or 0. */
  get stretchLimit(): number {
    const limit = this.model.scene.scene.stretch_limit as { max_stretch?: number } | null | undefined;
    return limit?.max_stretch ?? 0;
  }

  /** The middle of the bodies in the frame shown. */
  get center(): Vector3 {
    return this.bodyBox.getCenter(new Vector3());
  }

  /** A value that the scale of colours has to contain. */
  measure(color: ColorMode): number {
    return Math.max(this.bodies.particleColors.measure(color), color === 'stretch' ? this.stretchLimit : 0);
  }

  /** The largest force of contact [N]. */
  get largestForce(): number {
    const forces = this.model.contactForces;
    let largest = 0;
    if (forces) for (let k = 0; k < forces.length; k += 3) largest = Math.max(largest, forces[k] ** 2 + forces[k + 1] ** 2 + forces[k + 2] ** 2);
    return Math.sqrt(largest);
  }

  /** After `measure`; see BodyView. */
  update(options: ViewOptions, theme: Theme, top: number, force: number): void {
    this.bodies.update(options, theme, top, force);
    let pose = 0;
    let deformed = 0;
    for (const obstacle of this.obstacles) {
      if (obstacle.motion === 'rigid' && pose < this.model.poses.length) obstacle.setPose(this.model.poses[pose++]);
      if (obstacle.motion === 'deforming' && deformed < this.model.deformed.length) {
        obstacle.setVertices(this.model.deformed[deformed++]);
      }
      obstacle.update(options.obstacles, theme);
    }
    this.pull.material.color.copy(theme.drag);
    this.measureBodies();
    this.key.castShadow = options.shadows;
    if (options.shadows) this.placeShadow();
  }

  /** A line from a particle to where it is pulled; null hides it. */
  showPull(particle: number, target: Vector3 | null): void {
    this.pull.visible = target !== null;
    if (!target) return;
    const ends = this.pull.geometry.getAttribute('position');
    const p = this.model.positions;
    ends.setXYZ(0, p[3 * particle], p[3 * particle + 1], p[3 * particle + 2]);
    ends.setXYZ(1, target.x, target.y, target.z);
    ends.needsUpdate = true;
  }

  /** The bodies, the obstacles near them and their paths, and a floor that bodies will fall on. Half-spaces themselves never count. */
  box(): Box3 {
    const box = this.measureBodies().clone();
    if (box.isEmpty()) return box.set(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
    const size = box.getSize(new Vector3()).length();
    const near = box.clone().expandByScalar(0.8 * Math.max(size, 1e-6));
    const [bottom, top] = [box.min.y, box.max.y];
    this.obstacles.forEach((obstacle, k) => {
      const own = new Box3().setFromArray(obstacle.vertices).applyMatrix4(obstacle.mesh.matrix);
      if (own.isEmpty()) return;
      if (obstacle.floor) {
        const height = own.max.y;
        if (own.max.y - own.min.y < 1e-3 * size && height < bottom && bottom - height < 2 * size) box.min.y = Math.min(box.min.y, height);
        return;
      }
      const { name } = this.model.scene.obstacles[k] ?? { name: '' };
      const part = own.clone().intersect(near);
      if (part.isEmpty()) return;
      box.union(part);
      for (const offset of pathOf(this.obstacleScene(name))) box.union(part.clone().translate(offset));
    });
    // What begins flat falls or swings down, and what hangs stretches.
    box.min.y = Math.min(box.min.y, top - 0.6 * size, this.obstacles.length === 0 ? bottom - 0.25 * size : Infinity);
    return box;
  }

  dispose(): void {
    this.bodies.dispose();
    for (const obstacle of this.obstacles) obstacle.dispose();
    this.pull.geometry.dispose();
    this.pull.material.dispose();
    this.key.dispose();
  }

  private obstacleScene(name: string): ObstacleScene {
    const obstacles = (this.model.scene.scene.obstacles ?? {}) as Record<string, ObstacleScene>;
    return obstacles[name] ?? {};
  }

  private measureBodies(): Box3 {
    const { min, max } = this.bodyBox.makeEmpty();
    const p = this.model.positions;
    for (let k = 0; k + 2 < p.length; k += 3) {
      const x = p[k];
      const y = p[k + 1];
      const z = p[k + 2];
      if (!(x - x === 0 && y - y === 0 && z - z === 0)) continue; // not finite
      if (x < min.x) min.x = x;
      if (x > max.x) max.x = x;
      if (y < min.y) min.y = y;
      if (y > max.y) max.y = y;
      if (z < min.z) min.z = z;
      if (z > max.z) max.z = z;
    }
    return this.bodyBox;
  }

  /** The shadow map covers the bodies and what they throw shadows on; it moves only when they leave it, or shadows would crawl. */
  private placeShadow(): void {
    if (this.bodyBox.isEmpty()) return;
    const { min, max } = this.bodyBox;
    const radius = min.distanceTo(max) / 2;
    const center = this.center;
    if (center.distanceTo(this.shadowCenter) + radius < this.shadowRadius && this.shadowRadius < 6 * radius) return;
    this.shadowRadius = this.shadowRadius === 0 ? Math.max(this.box().getBoundingSphere(sphere).radius, 1.3 * radius) : 1.6 * radius;
    this.shadowCenter.copy(center);
    const { camera } = this.key.shadow;
    const reach = 1.25 * this.shadowRadius;
    camera.left = camera.bottom = -reach;
    camera.right = camera.top = reach;
    camera.near = reach / 10;
    camera.far = 8 * reach;
    camera.updateProjectionMatrix();
    this.key.shadow.normalBias = (4 * reach) / SHADOW_PIXELS;
    this.key.shadow.bias = -0.0008;
    this.key.target.position.copy(center);
    this.key.position.copy(center).addScaledVector(KEY_DIRECTION, 4 * reach);
  }
}

/** Where the keyframes of an obstacle take it, from where it begins. */
function pathOf({ motion }: ObstacleScene): Vector3[] {
  return (motion?.keyframes ?? []).flatMap(({ position }) => (Array.isArray(position) ? [new Vector3(...(position as number[]))] : []));
}
