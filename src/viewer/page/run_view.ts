import { Box3, BufferAttribute, BufferGeometry, Color, DirectionalLight, DynamicDrawUsage, Fog, HemisphereLight, Line, LineBasicMaterial, Scene, Vector3 } from 'three';
import { BodyView } from './body_view';
import { ObstacleView } from './obstacle_view';
import type { RunModel } from './run_model';
import type { Theme } from './theme';
import type { ColorMode, ViewOptions } from './view_options';

/** The picture of one run. */
export class RunView {
  readonly scene = new Scene();
  readonly bodies: BodyView;
  readonly obstacles: ObstacleView[];
  private readonly haze = new Fog(0xffffff);
  private readonly pull: Line<BufferGeometry, LineBasicMaterial>;

  constructor(readonly model: RunModel) {
    const box = this.bodyBox();
    this.bodies = new BodyView(model, box.isEmpty() ? 1 : box.getSize(new Vector3()).length());
    this.obstacles = model.topology.obstacles.map((mesh, k) => new ObstacleView(mesh, model.scene.obstacles[k]?.motion ?? 'fixed'));
    const pull = new BufferGeometry();
    pull.setAttribute('position', new BufferAttribute(new Float32Array(6), 3).setUsage(DynamicDrawUsage));
    this.pull = new Line(pull, new LineBasicMaterial({ depthTest: false }));
    this.pull.visible = this.pull.frustumCulled = false;
    this.pull.renderOrder = 3;
    const key = new DirectionalLight(0xffffff, 1.9);
    key.position.set(1, 2.5, 1.8);
    const fill = new DirectionalLight(0xffffff, 0.6);
    fill.position.set(-2, 0.6, -1);
    this.scene.fog = this.haze;
    this.scene.add(new HemisphereLight(0xffffff, 0x777788, 1.5), key, fill, this.pull, this.bodies.group);
    for (const obstacle of this.obstacles) this.scene.add(obstacle.mesh);
  }

  /** The limit of stretch [1], or 0. */
  get stretchLimit(): number {
    const limit = this.model.scene.scene.stretch_limit as { max_stretch?: number } | null | undefined;
    return limit?.max_stretch ?? 0;
  }

  /** A value that the scale of colours has to contain. */
  measure(color: ColorMode): number {
    return Math.max(this.bodies.particleColors.measure(color), color === 'stretch' ? this.stretchLimit : 0);
  }

  /** After `measure`; `top` is the value at the end of the scale of colours. */
  update(options: ViewOptions, theme: Theme, top: number): void {
    this.bodies.update(options, theme, top);
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

  /** A floor without end fades into the background. */
  setHaze(color: Color, radius: number, distance: number): void {
    this.haze.color.copy(color);
    this.haze.near = distance + 4 * radius;
    this.haze.far = distance + 22 * radius;
  }

  bodyBox(): Box3 {
    return finiteBox(this.model.positions);
  }

  /** The bodies, and of the obstacles what is not far from them: a floor without end must not make them tiny. */
  box(): Box3 {
    const box = this.bodyBox();
    if (box.isEmpty()) return box.set(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
    const size = box.getSize(new Vector3()).length();
    const near = box.clone().expandByScalar(0.8 * Math.max(size, 1e-6));
    this.obstacles.forEach((obstacle) => {
      const own = finiteBox(obstacle.vertices).applyMatrix4(obstacle.mesh.matrix);
      if (own.isEmpty()) return;
      // What is much larger than the bodies counts only where they are above it.
      const large = own.getSize(new Vector3()).length() > 4 * size;
      const part = own.intersect(large ? box.clone().expandByVector(new Vector3(0, 0.8 * size, 0)) : near);
      if (!part.isEmpty()) box.union(part);
    });
    // What begins flat falls or swings down.
    box.min.y = Math.min(box.min.y, box.max.y - 0.6 * size);
    return box;
  }

  dispose(): void {
    this.bodies.dispose();
    for (const obstacle of this.obstacles) obstacle.dispose();
    this.pull.geometry.dispose();
    this.pull.material.dispose();
  }
}

function finiteBox(positions: Float32Array): Box3 {
  const box = new Box3();
  const point = new Vector3();
  for (let k = 0; k + 2 < positions.length; k += 3) {
    point.fromArray(positions, k);
    if (Number.isFinite(point.x + point.y + point.z)) box.expandByPoint(point);
  }
  return box;
}
