import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
  LineBasicMaterial,
  LineSegments,
  Mesh,
} from 'three';
import type { MeshStandardMaterial } from 'three';
import { ArrowView } from './arrow_view';
import { ParticleColors } from './colors';
import { Dots } from './dots';
import { MassView } from './mass_view';
import { looksOf, surfaceMaterial } from './looks';
import { vertexNormals } from './normals';
import { SURFACES } from './occlusion';
import { IN_CONTACT, PINNED } from '../run/protocol';
import { RopeView } from './rope_view';
import type { RunModel } from '../run/run_model';
import type { Theme } from '../panel/theme';
import type { ViewOptions } from './view_options';

/** The arrow of a velocity is the displacement in this time [s]. */
const SHOWN_TIME = 0.1;
/** How long the arrow of the largest force on the scale is, by the extent of the bodies. */
const LONGEST_FORCE = 0.2;
const MANY_PINS = 20;
/** More masses would hide each other. */
const MOST_BALLS = 30;

/** The bodies of a run: surfaces, ropes, springs, particles and marks. */
export class BodyView {
  readonly group = new Group();
  readonly particleColors: ParticleColors;
  private readonly positions: BufferAttribute;
  private readonly normals: BufferAttribute;
  private readonly colors: BufferAttribute;
  private readonly surface: Mesh<BufferGeometry, MeshStandardMaterial[]>;
  private readonly inside = { value: 1 };
  private removals = 0;
  private readonly rope: RopeView | null;
  private readonly springs: LineSegments<BufferGeometry, LineBasicMaterial>;
  private markedSprings: RopeView | null = null;
  private chosenSpring: { number: number; view: RopeView } | null = null;
  private readonly tubeRadius: number;
  private readonly particles: Dots;
  private readonly pins: Dots;
  private readonly contacts: Dots;
  private readonly mark: Dots;
  private readonly hovered: Dots;
  private readonly balls: MassView | null;
  private readonly velocities: ArrowView;
  private readonly forces: ArrowView;
  private readonly moved: Float32Array;

  /** `size` is the extent of the bodies [m]. */
  constructor(
    private readonly model: RunModel,
    private readonly size: number,
  ) {
    const { topology } = model;
    this.positions = new BufferAttribute(model.positions, 3).setUsage(DynamicDrawUsage);
    this.normals = new BufferAttribute(new Float32Array(model.positions.length), 3).setUsage(DynamicDrawUsage);
    this.particleColors = new ParticleColors(model);
    this.colors = new BufferAttribute(this.particleColors.colors, 3).setUsage(DynamicDrawUsage);
    const surface = this.geometry(model.triangles);
    surface.setAttribute('normal', this.normals);
    surface.setAttribute('color', this.colors);
    this.surface = new Mesh(surface, this.surfaceMaterials(surface));
    this.surface.castShadow = this.surface.receiveShadow = true;
    this.tubeRadius = ropeRadius(model, size);
    this.rope = topology.segments.length > 0 ? new RopeView(topology.segments, this.tubeRadius) : null;
    const springs = this.geometry(model.springs);
    springs.setAttribute('color', this.colors);
    this.springs = new LineSegments(springs, new LineBasicMaterial());
    this.particles = new Dots(this.positions, 4);
    this.particles.chooseAll();
    const { masses } = model.scene;
    const few = masses && masses.length > 0 && masses.length <= MOST_BALLS && topology.triangles.length === 0;
    this.balls = few ? new MassView(masses, Math.max(0.035 * size, 2 * this.tubeRadius)) : null;
    this.velocities = new ArrowView(topology.particles);
    this.forces = new ArrowView(topology.particles, true);
    this.moved = new Float32Array(model.positions.length);
    this.pins = new Dots(this.positions, pinSize(model));
    this.contacts = new Dots(this.positions, 6);
    this.mark = new Dots(this.positions, 15, 2);
    this.hovered = new Dots(this.positions, 11, 2);
    const dots = [this.particles, this.pins, this.contacts, this.mark, this.hovered].map(({ points }) => points);
    this.group.add(this.surface, this.springs, this.velocities.lines, this.forces.lines, ...dots);
    if (this.balls) this.group.add(this.balls.mesh);
    if (this.rope) this.group.add(this.rope.group);
    for (const mesh of [this.surface, this.balls?.mesh, ...(this.rope?.group.children ?? [])]) mesh?.layers.enable(SURFACES);
    this.surface.frustumCulled = this.springs.frustumCulled = false;
  }

  /** `top` is the value at the end of the scale of colours, `force` the largest force that is shown [N]. */
  update(options: ViewOptions, theme: Theme, top: number, force: number): void {
    const { model } = this;
    this.surface.visible = options.surface && model.topology.triangles.length > 0;
    this.springs.visible = options.springs && model.scene.complete;
    this.particles.points.visible = options.particles && !this.balls;
    this.showArrows(options, theme, force);
    if (this.balls) {
      this.balls.mesh.visible = options.particles;
      this.balls.place(model.positions);
    }
    this.pins.points.visible = options.pins;
    this.contacts.points.visible = options.contacts;
    this.positions.needsUpdate = true;
    if (this.removals !== model.removals) {
      this.removals = model.removals;
      for (const { geometry } of [this.surface, this.springs]) geometry.getIndex()!.needsUpdate = true;
    }
    if (this.surface.visible) {
      vertexNormals(model.positions, model.triangles, this.normals.array as Float32Array);
      this.normals.needsUpdate = true;
    }
    const repainted = this.particleColors.update(options.color, theme, top);
    if (repainted) this.colors.needsUpdate = true;
    if (repainted) this.balls?.paint(this.particleColors.colors);
    if (this.rope) {
      this.rope.group.visible = options.surface;
      if (options.surface) this.rope.place(model.positions);
      if (repainted) this.rope.paint(this.particleColors.colors);
    }
    if (options.pins) this.pins.chooseByState(model.states, PINNED);
    if (options.contacts) this.contacts.chooseByState(model.states, IN_CONTACT);
    this.paint(options, theme);
    this.markDivergence(theme);
    this.chosenSpring?.view.mark(theme.contact);
    this.chosenSpring?.view.place(model.positions);
  }

  private showArrows(options: ViewOptions, theme: Theme, force: number): void {
    const { positions, previous, elapsed, contactForces } = this.model;
    this.velocities.hide();
    this.forces.hide();
    if (options.velocities && elapsed > 0) {
      for (let k = 0; k < positions.length; ++k) this.moved[k] = positions[k] - previous[k];
      this.velocities.show(positions, this.moved, SHOWN_TIME / elapsed, theme.velocity);
    }
    if (options.forces && contactForces && force > 0) {
      this.forces.show(positions, contactForces, (LONGEST_FORCE * this.size) / force, theme.force);
    }
  }

  /** Marks a spring, or none. Returns whether that is another one. */
  markSpring(number: number | undefined): boolean {
    if (number === this.chosenSpring?.number) return false;
    this.chosenSpring?.view.group.removeFromParent();
    this.chosenSpring?.view.dispose();
    this.chosenSpring = null;
    if (number === undefined) return true;
    const view = new RopeView(this.model.topology.springs.slice(2 * number, 2 * number + 2), 0.7 * this.tubeRadius);
    view.place(this.model.positions);
    this.group.add(view.group);
    this.chosenSpring = { number, view };
    return true;
  }

  markHovered(particle: number | undefined): void {
    this.hovered.chooseOne(particle);
  }

  /** The number of triangles that are not torn in the frame shown last. */
  get triangleCount(): number {
    const shown = this.model.triangles;
    let count = 0;
    for (let k = 0; k < shown.length; k += 3) if (shown[k] !== shown[k + 1]) ++count;
    return count;
  }

  dispose(): void {
    this.surface.geometry.dispose();
    for (const material of this.surface.material) material.dispose();
    this.springs.geometry.dispose();
    this.springs.material.dispose();
    this.rope?.dispose();
    this.balls?.dispose();
    this.velocities.dispose();
    this.forces.dispose();
    this.markedSprings?.dispose();
    this.chosenSpring?.view.dispose();
    for (const dots of [this.particles, this.pins, this.contacts, this.mark, this.hovered]) dots.dispose();
  }

  /** A material for each look; triangles of a body follow each other. */
  private surfaceMaterials(geometry: BufferGeometry): MeshStandardMaterial[] {
    const { bodies } = this.model.scene;
    const { triangles } = this.model.topology;
    const looks = looksOf(this.model.scene);
    const materials: MeshStandardMaterial[] = [];
    let made = '';
    let begin = 0;
    bodies.forEach(({ first, count }, k) => {
      let end = begin;
      while (end < triangles.length && triangles[end] < first + count) end += 3;
      const { roughness, sheen, shape } = looks[k];
      const key = `${roughness} ${sheen} ${shape}`;
      if (key !== made) {
        materials.push(surfaceMaterial(shape, { sheen: { value: sheen }, inside: this.inside }));
        materials[materials.length - 1].roughness = roughness;
      }
      made = key;
      if (end > begin) geometry.addGroup(begin, end - begin, materials.length - 1);
      begin = end;
    });
    return materials;
  }

  private geometry(index: Uint32Array): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setAttribute('position', this.positions);
    geometry.setIndex(new BufferAttribute(index, 1));
    return geometry;
  }

  /** Springs on a surface take a colour of their own, or they could not be seen on it. */
  private paint(options: ViewOptions, theme: Theme): void {
    const byParticle = options.color !== 'plain' && !options.surface;
    this.inside.value = options.color === 'plain' ? 0.82 : 1;
    const material = this.springs.material;
    if (material.vertexColors !== byParticle) {
      material.vertexColors = byParticle;
      material.needsUpdate = true;
    }
    material.color.copy(theme.spring);
    if (byParticle) material.color.set(1, 1, 1);
    this.particles.setColor(theme.particle);
    this.pins.setColor(theme.pin);
    this.contacts.setColor(theme.contact);
    this.mark.setColor(theme.mark);
    this.hovered.setColor(theme.contact);
  }

  private markDivergence(theme: Theme): void {
    const { diverged, topology } = this.model;
    this.mark.points.visible = diverged?.particle !== undefined;
    if (!diverged) return;
    this.mark.chooseOne(diverged.particle);
    if (!this.markedSprings && diverged.springs.length > 0) {
      const ends = diverged.springs.flatMap((s) => [topology.springs[2 * s], topology.springs[2 * s + 1]]);
      this.markedSprings = new RopeView(new Uint32Array(ends), 0.7 * this.tubeRadius);
      this.group.add(this.markedSprings.group);
    }
    this.markedSprings?.mark(theme.mark);
    this.markedSprings?.place(this.model.positions);
  }
}

/** Many pins would hide what they hold. */
function pinSize(model: RunModel): number {
  let count = 0;
  for (const state of model.states) if (state & PINNED) ++count;
  return count > MANY_PINS ? 4 : 8;
}

/** A rope is drawn as thick as its contact gap, but thick enough to be seen. */
function ropeRadius(model: RunModel, size: number): number {
  const bodies = (model.scene.scene.bodies ?? {}) as Record<string, { thickness?: number }>;
  const thickness = Math.max(0, ...Object.values(bodies).map((body) => body.thickness ?? 0));
  return Math.min(Math.max(thickness, 0.006 * size), 0.02 * size);
}
