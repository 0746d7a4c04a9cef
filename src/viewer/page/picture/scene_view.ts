import { Box3, NeutralToneMapping, PerspectiveCamera, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { AxisCross } from './axis_cross';
import { ColorScale, Scale } from './colors';
import { Occlusion } from './occlusion';
import type { RunModel } from '../run/run_model';
import { RunView } from './run_view';
import { LIGHT } from '../panel/theme';
import type { Theme } from '../panel/theme';
import { defaultOptions } from './view_options';
import type { ViewOptions } from './view_options';

export interface Rect { x: number; y: number; width: number; height: number }

const MARGIN = 1.12;
/** Two runs have their names above them. */
const MARGIN_OF_TWO = 1.25;
const MOST_GROWTH = 2;
/** From where the picture is seen. */
export const DIRECTIONS = {
  usual: new Vector3(0.55, 0.38, 1).normalize(),
  front: new Vector3(0, 0, 1),
  side: new Vector3(1, 0, 0),
  // Not quite upright, or left and right would be undefined.
  top: new Vector3(0, 1, 1e-3).normalize(),
};

/** Whether a program draws in place of a graphics card: shadows then take longer than all else. */
function drawsWithoutGpu(renderer: WebGLRenderer): boolean {
  const gl = renderer.getContext();
  const info = gl.getExtension('WEBGL_debug_renderer_info');
  return info !== null && /swiftshader|llvmpipe|softpipe|basic render/i.test(String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL)));
}

/** The picture: up to two runs, side by side, through one camera. */
export class SceneView {
  readonly options: ViewOptions = defaultOptions();
  readonly camera = new PerspectiveCamera(38, 1, 0.01, 100);
  readonly canvas: HTMLCanvasElement;
  readonly controls: OrbitControls;
  readonly runs: RunView[] = [];
  readonly scale = new ColorScale();
  /** The largest force that is shown [N]. */
  largestForce = 0;
  private readonly forceScale = new Scale();
  private readonly renderer: WebGLRenderer;
  private theme: Theme = LIGHT;
  private radius = 1;
  private stale = true;
  private moved = true;
  /** The user has moved the camera: the picture is not fitted again by itself. */
  private chosen = false;
  private direction = DIRECTIONS.usual;
  private readonly followed = new Vector3();
  /** What the camera was placed for, and half of its diagonal [m] before bodies left it. */
  private readonly fitted = new Box3();
  private firstRadius = 1;
  private readonly axes = new AxisCross();
  private readonly occlusion = new Occlusion();

  /** Throws where there is no WebGL. */
  constructor(private readonly parent: HTMLElement) {
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setScissorTest(true);
    this.options.shadows = this.options.occlusion = !drawsWithoutGpu(this.renderer);
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.autoUpdate = false;
    this.renderer.toneMapping = NeutralToneMapping;
    this.canvas = this.renderer.domElement;
    this.canvas.setAttribute('role', 'img');
    this.canvas.setAttribute('aria-label', 'Simulation');
    this.canvas.tabIndex = 0;
    parent.append(this.canvas);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.listenToKeyEvents(this.canvas);
    this.controls.addEventListener('change', () => this.touch());
    this.controls.addEventListener('start', () => (this.chosen = true));
    new ResizeObserver(() => this.resize()).observe(parent);
    this.resize();
  }

  setRun(number: number, model: RunModel | null): void {
    const before = this.runs.length;
    this.runs[number]?.dispose();
    if (model) this.runs[number] = new RunView(model);
    else this.runs.length = Math.min(this.runs.length, number);
    if (this.runs.length > 0 && this.runs.length !== before && !this.chosen) this.fit(this.direction);
    this.invalidate();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.renderer.setClearColor(theme.background);
    this.invalidate();
  }

  /** Marks a particle under the pointer. */
  hover(pick: { run: number; particle: number } | null): void {
    this.runs.forEach((run, number) => run.bodies.markHovered(pick?.run === number ? pick.particle : undefined));
    this.touch();
  }

  /** The runs or the options have changed. */
  invalidate(): void {
    this.stale = true;
  }

  /** Only the camera has changed. */
  touch(): void {
    this.moved = true;
  }

  /** The areas of the runs, in pixels of the picture. */
  rects(): Rect[] {
    const width = this.parent.clientWidth;
    const height = this.parent.clientHeight;
    if (this.runs.length < 2) return [{ x: 0, y: 0, width, height }];
    const beside = width >= height;
    const w = beside ? width / 2 : width;
    const h = beside ? height : height / 2;
    return [
      { x: 0, y: 0, width: w, height: h },
      { x: beside ? w : 0, y: beside ? 0 : h, width: w, height: h },
    ];
  }

  /** The camera as run `number` is seen through it. */
  aim(number: number): Rect {
    const rect = this.rects()[number] ?? this.rects()[0];
    this.camera.aspect = rect.width / Math.max(rect.height, 1);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    return rect;
  }

  fit(direction = DIRECTIONS.usual): void {
    if (!this.runs[0]) return;
    this.chosen = false;
    this.direction = direction;
    this.fitted.copy(this.runs[0].box());
    this.firstRadius = Math.max(this.fitted.getSize(new Vector3()).length() / 2, 1e-6);
    this.place();
  }

  /** Bodies that leave the picture by themselves take it with them, in few jumps and not to infinity. */
  private grow(run: RunView): void {
    if (this.chosen || this.options.follow || !this.controls.enabled || this.fitted.containsBox(run.bodyBox)) return;
    const wanted = run.bodyBox.clone().expandByScalar(run.bodyBox.isEmpty() ? 0 : 0.15 * this.radius).union(this.fitted);
    if (wanted.getSize(new Vector3()).length() / 2 > MOST_GROWTH * this.firstRadius) return;
    this.fitted.copy(wanted);
    this.place();
  }

  /** Puts the camera where all of the fitted box is in the picture. */
  private place(): void {
    const { fitted: box, direction } = this;
    const center = box.getCenter(new Vector3());
    this.radius = Math.max(box.getSize(new Vector3()).length() / 2, 1e-6);
    const { width, height } = this.rects()[0];
    const vertical = Math.tan((this.camera.fov * Math.PI) / 360);
    const horizontal = vertical * (width / Math.max(height, 1));
    const right = new Vector3(0, 1, 0).cross(direction).normalize();
    const up = direction.clone().cross(right);
    // The nearest distance at which all corners of the box are in the picture.
    const margin = this.runs.length > 1 ? MARGIN_OF_TWO : MARGIN;
    let distance = this.radius;
    for (let k = 0; k < 8; ++k) {
      const corner = new Vector3(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y, k & 4 ? box.max.z : box.min.z).sub(center);
      const across = Math.max(Math.abs(corner.dot(right)) / horizontal, Math.abs(corner.dot(up)) / vertical);
      distance = Math.max(distance, margin * across + corner.dot(direction));
    }
    this.controls.target.copy(center);
    this.camera.position.copy(center).addScaledVector(direction, distance);
    this.controls.update();
    this.touch();
  }

  /** Draws if something has changed. Returns whether it has. */
  draw(): boolean {
    if (!this.stale && !this.moved) return false;
    const shadows = this.stale;
    if (this.stale) this.update();
    this.stale = this.moved = false;
    this.setDepthRange();
    const height = this.parent.clientHeight;
    if (this.runs.length === 0) {
      const [rect] = this.rects();
      this.renderer.setScissor(0, 0, rect.width, rect.height);
      this.renderer.clear();
    }
    this.runs.forEach((run, number) => {
      const rect = this.aim(number);
      const bottom = height - rect.y - rect.height;
      this.renderer.setViewport(rect.x, bottom, rect.width, rect.height);
      this.renderer.setScissor(rect.x, bottom, rect.width, rect.height);
      this.renderer.shadowMap.needsUpdate = shadows;
      this.renderer.render(run.scene, this.camera);
      if (this.options.occlusion) this.occlusion.draw(this.renderer, run.scene, this.camera, rect, this.radius);
    });
    this.axes.show(this.camera.matrixWorldInverse);
    return true;
  }

  private update(): void {
    const { color, forces } = this.options;
    this.scale.followMode(color, Math.max(0, ...this.runs.map((run) => run.measure(color))));
    this.largestForce = forces ? Math.max(0, ...this.runs.map((run) => run.largestForce)) : 0;
    if (this.largestForce > 0) this.forceScale.follow(this.largestForce);
    for (const run of this.runs) run.update(this.options, this.theme, this.scale.top, this.forceScale.top);
    if (!this.runs[0]) return;
    this.follow(this.runs[0].center);
    this.grow(this.runs[0]);
  }

  /** Moves the camera as the bodies have moved since the last frame. */
  private follow(center: Vector3): void {
    const moved = center.clone().sub(this.followed);
    this.followed.copy(center);
    if (!this.options.follow || !(moved.length() < this.radius)) return;
    this.controls.target.add(moved);
    this.camera.position.add(moved);
    this.camera.updateMatrixWorld();
  }

  private setDepthRange(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance / 100, 1e-6);
    this.camera.far = distance + 60 * this.radius;
  }

  private resize(): void {
    this.renderer.setSize(this.parent.clientWidth, this.parent.clientHeight);
    if (!this.chosen) this.fit(this.direction);
    this.touch();
    // Or the picture stays empty until the next animation frame.
    this.draw();
  }
}
