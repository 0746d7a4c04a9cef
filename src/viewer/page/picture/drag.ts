import { Plane, Raycaster, Vector2, Vector3 } from 'three';
import { byId, short } from '../panel/dom';
import { pick, pickSpring, project } from './picking';
import type { Pick } from './picking';
import { PINNED } from '../run/protocol';
import type { Command } from '../run/protocol';
import type { SceneView } from './scene_view';
import type { Selected } from '../panel/selection';

const CLICK_PX = 4;
const ON_PARTICLE_PX = 6;

interface Held extends Pick {
  pointer: number;
  /** Where the pointer took it. */
  start: Vector2;
  dragged: boolean;
  /** From the particle to the pointer, when it was taken [pixels]. */
  offset: Vector2;
  plane: Plane;
  target: Vector3;
  moved: boolean;
}

interface Pressed extends Pick {
  pointer: number;
  x: number;
  y: number;
}

/** Pulls particles with the pointer; a click on a pin frees it. */
export class Drag {
  enabled = false;
  private held: Held | null = null;
  private pressedPin: Pressed | null = null;
  /** A spring far from particles: a click selects it, a drag turns the view. */
  private pressedSpring: (Pressed & Selected) | null = null;
  private hover: { x: number; y: number } | null = null;
  private readonly force = byId('pull-force');
  private readonly raycaster = new Raycaster();

  constructor(
    private readonly view: SceneView,
    private readonly send: (command: Command) => void,
    private readonly notify: { dragged(): void; selected(selected: Selected): void },
  ) {
    const { canvas } = view;
    // Before OrbitControls, which listens to the canvas itself.
    const parent = canvas.parentElement ?? canvas;
    parent.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerup', (event) => this.lift(event));
    canvas.addEventListener('pointercancel', (event) => this.lift(event));
    canvas.addEventListener('pointerleave', () => {
      this.hover = null;
      view.hover(null);
    });
  }

  /** To be called in each animation frame: sends the newest target. */
  tick(): void {
    if (this.held) {
      this.view.runs[this.held.run]?.showPull(this.held.particle, this.held.target);
      this.view.touch();
      this.showForce(this.view.runs[this.held.run]?.model.numbers?.pull ?? 0);
      if (this.held.moved) this.send({ do: 'drag', target: this.held.target.toArray() });
      this.held.moved = false;
    } else if (this.hover) {
      const found = this.enabled ? pick(this.view, this.hover.x, this.hover.y) : null;
      this.view.canvas.style.cursor = found ? 'grab' : '';
      this.view.hover(found);
      this.hover = null;
    }
  }

  /** The particles are no longer those that were there. */
  cancel(): void {
    this.pressedPin = this.pressedSpring = null;
    if (this.held) this.letGo(false);
  }

  private press(event: PointerEvent): void {
    if (!this.enabled || event.button !== 0 || this.held) return;
    const { x, y } = this.at(event);
    const found = pick(this.view, x, y);
    if (!found) {
      const spring = pickSpring(this.view, x, y);
      this.pressedSpring = spring && { ...spring, pointer: event.pointerId, x, y };
      return;
    }
    const run = this.view.runs[found.run];
    if (run.model.states[found.particle] & PINNED) {
      this.pressedPin = { ...found, pointer: event.pointerId, x, y };
      return;
    }
    const place = project(this.view, found);
    if (!place) return;
    const target = new Vector3().fromArray(run.model.positions, 3 * found.particle);
    const plane = new Plane().setFromNormalAndCoplanarPoint(this.view.camera.getWorldDirection(new Vector3()), target);
    this.held = { ...found, pointer: event.pointerId, start: new Vector2(x, y), dragged: false, offset: new Vector2(x - place.x, y - place.y), plane, target, moved: false };
    this.view.controls.enabled = false;
    this.view.canvas.setPointerCapture(event.pointerId);
    this.view.canvas.style.cursor = 'grabbing';
    this.view.hover(found);
    this.send({ do: 'grab', run: found.run, particle: found.particle });
  }

  private move(event: PointerEvent): void {
    const { x, y } = this.at(event);
    if (!this.held) {
      if (event.buttons === 0) this.hover = { x, y };
      return;
    }
    if (event.pointerId !== this.held.pointer) return;
    this.force.style.translate = `${x + 14}px ${y - 26}px`;
    if (!this.held.dragged && Math.hypot(x - this.held.start.x, y - this.held.start.y) >= CLICK_PX) {
      this.held.dragged = true;
      this.notify.dragged();
    }
    const rect = this.view.aim(this.held.run);
    const left = (x - this.held.offset.x - rect.x) / rect.width;
    const top = (y - this.held.offset.y - rect.y) / rect.height;
    this.raycaster.setFromCamera(new Vector2(2 * left - 1, 1 - 2 * top), this.view.camera);
    if (this.raycaster.ray.intersectPlane(this.held.plane, this.held.target)) this.held.moved = true;
  }

  private lift(event: PointerEvent): void {
    if (this.held?.pointer === event.pointerId) {
      if (this.held.moved) this.tick();
      if (!this.held.dragged && event.type === 'pointerup') this.select(this.held, this.at(event));
      this.letGo(event.type === 'pointerup' && event.shiftKey);
    } else if (this.pressedPin?.pointer === event.pointerId) {
      const { run, particle, x, y } = this.pressedPin;
      const now = this.at(event);
      if (event.type === 'pointerup' && Math.hypot(now.x - x, now.y - y) < CLICK_PX) this.send({ do: 'release', run, particle });
      this.pressedPin = null;
    } else if (this.pressedSpring?.pointer === event.pointerId) {
      const { run, particle, spring, x, y } = this.pressedSpring;
      const now = this.at(event);
      if (event.type === 'pointerup' && Math.hypot(now.x - x, now.y - y) < CLICK_PX) this.notify.selected({ run, particle, spring });
      this.pressedSpring = null;
    }
  }

  /** A particle, and that of its springs on which the pointer is, unless it is on the particle itself. */
  private select({ run, particle }: Pick, { x, y }: { x: number; y: number }): void {
    const place = project(this.view, { run, particle })!;
    const spring = Math.hypot(place.x - x, place.y - y) < ON_PARTICLE_PX ? null : pickSpring(this.view, x, y, particle);
    this.notify.selected({ run, particle, spring: spring?.spring });
  }

  private showForce(newtons: number): void {
    const text = `${short(newtons, 2)} N`;
    if (this.force.textContent !== text) this.force.textContent = text;
    this.force.hidden = newtons === 0;
  }

  private letGo(pin: boolean): void {
    if (!this.held) return;
    this.showForce(0);
    this.view.runs[this.held.run]?.showPull(this.held.particle, null);
    this.view.touch();
    this.held = null;
    this.view.controls.enabled = true;
    this.view.canvas.style.cursor = '';
    this.send({ do: 'drop', pin });
  }

  private at(event: PointerEvent): { x: number; y: number } {
    const box = this.view.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  }
}
