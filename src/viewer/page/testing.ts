import { project } from './picture/picking';
import type { Mode } from './run/protocol';
import type { RunModel } from './run/run_model';
import type { SceneView } from './picture/scene_view';

declare global {
  interface Window {
    sprung: unknown;
  }
}

export interface Shown {
  title: string;
  models: RunModel[];
  playing: boolean;
  fps: number;
  connected: boolean;
  mode: Mode | null;
  problems: string[];
}

/** Sets `window.sprung`; its values are always the present ones. */
export function publish(shown: Shown, view: SceneView | null): void {
  window.sprung = {
    get title() {
      return shown.title;
    },
    get frame() {
      return shown.models[0]?.frame ?? 0;
    },
    get time() {
      return shown.models[0]?.time ?? 0;
    },
    get playing() {
      return shown.playing;
    },
    get fps() {
      return shown.fps;
    },
    get realtime() {
      return shown.models[0]?.numbers?.realtime ?? 0;
    },
    get connected() {
      return shown.connected;
    },
    get mode() {
      return shown.mode;
    },
    get problems() {
      return shown.problems;
    },
    /** The value at the end of the scale of colours. */
    get scale() {
      return view?.scale.top ?? 0;
    },
    get triangles() {
      return view?.runs[0]?.bodies.triangleCount ?? 0;
    },
    get bodies() {
      return shown.models[0]?.bodies ?? {};
    },
    get runs() {
      return shown.models.map(({ frame, time, bodies, scene, states, contactForces, diverged, numbers }) => ({
        frame,
        time,
        bodies,
        scene,
        states,
        contactForces,
        diverged: diverged !== null,
        numbers,
      }));
    },
    /** A particle of a body, in pixels of the page. */
    project(bodyName: string, index: number, run = 0): { x: number; y: number } | null {
      const body = shown.models[run]?.scene.bodies.find(({ name }) => name === bodyName);
      if (!body || !view) return null;
      const point = project(view, { run, particle: body.first + index });
      const box = view.canvas.getBoundingClientRect();
      return point && { x: point.x + box.left, y: point.y + box.top };
    },
  };
}
