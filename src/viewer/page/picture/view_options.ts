export type ColorMode = 'plain' | 'stretch' | 'speed' | 'contact';
export type Switch = 'surface' | 'springs' | 'particles' | 'obstacles' | 'pins' | 'contacts' | 'shadows' | 'occlusion' | 'follow' | 'velocities' | 'forces';

/** What of a run is shown, and how. */
export interface ViewOptions extends Record<Switch, boolean> {
  color: ColorMode;
}

export function defaultOptions(): ViewOptions {
  return { surface: true, springs: false, particles: false, obstacles: true, pins: true, contacts: false, shadows: true, occlusion: true, follow: false, velocities: false, forces: false, color: 'plain' };
}
