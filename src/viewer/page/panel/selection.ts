import { control, short } from './dom';
import type { Pick } from '../picture/picking';
import { HAS_FORCE, SPRING_KINDS } from '../run/protocol';
import type { Command, SceneMessage, TensionMessage } from '../run/protocol';
import type { RunModel } from '../run/run_model';
import type { SceneView } from '../picture/scene_view';

/** A particle, and a spring at it that was meant; without one, its most stretched spring is shown. */
export interface Selected extends Pick { spring?: number }

/** The numbers of the particle and the spring that a click has selected. */
export class Selection {
  private readonly node = control('selection');
  private selected: Selected | null = null;
  /** The tension of a spring [N], as the program told it last. */
  private tension: TensionMessage | null = null;
  private asked = { spring: -1, time: -1 };

  constructor(
    private readonly view: SceneView,
    private readonly send: (command: Command) => void,
  ) {}

  choose(selected: Selected | null): void {
    this.selected = selected;
    this.tension = null;
    this.asked = { spring: -1, time: -1 };
  }

  /** The springs of a run have other numbers now. */
  renumber(run: number): void {
    if (this.selected?.run === run) this.choose({ run, particle: this.selected.particle });
  }

  receive(message: TensionMessage): void {
    this.tension = message;
  }

  /** `ask` says whether there is a program that knows tensions. */
  show(ask: boolean): void {
    const { runs } = this.view;
    const run = this.selected && runs[this.selected.run];
    for (const each of runs) {
      if (each.bodies.markSpring(each === run ? this.selected?.spring : undefined)) this.view.invalidate();
    }
    let text = '';
    if (run && this.selected) {
      const spring = this.selected.spring ?? mostStretched(run.model, this.selected.particle);
      if (ask && spring !== null) this.ask(spring, run.model);
      text = particleText(run.model, this.selected.particle, spring, this.tension?.spring === spring ? this.tension : null);
    }
    if (this.node.textContent !== text) this.node.textContent = text;
    this.node.hidden = text === '';
  }

  private ask(spring: number, { time }: RunModel): void {
    if (!this.selected || (this.asked.spring === spring && this.asked.time === time)) return;
    this.asked = { spring, time };
    this.send({ do: 'tension', run: this.selected.run, spring });
  }
}

/** Lengths over rest lengths, less 1; -Infinity for a spring that is gone or has no rest length. */
function stretchOf({ topology, positions, springs }: RunModel, spring: number): number {
  const [a, b] = [3 * springs[2 * spring], 3 * springs[2 * spring + 1]];
  if (a === b || topology.restLengths[spring] <= 0) return -Infinity;
  const length = Math.hypot(positions[a] - positions[b], positions[a + 1] - positions[b + 1], positions[a + 2] - positions[b + 2]);
  return length / topology.restLengths[spring] - 1;
}

function mostStretched(model: RunModel, particle: number): number | null {
  const { springs } = model;
  let [most, found] = [-Infinity, null as number | null];
  for (let s = 0; 2 * s < springs.length; ++s) {
    if (springs[2 * s] !== particle && springs[2 * s + 1] !== particle) continue;
    const stretch = stretchOf(model, s);
    if (stretch > most) [most, found] = [stretch, s];
  }
  return found;
}

function nameOf(scene: SceneMessage, particle: number): string {
  const body = scene.bodies.find(({ first, count }) => particle >= first && particle < first + count);
  return `${body?.name ?? 'particle'} ${particle - (body?.first ?? 0)}`;
}

/** Position, speed and force of contact of a particle, stretch and tension of a spring, for people. */
function particleText(model: RunModel, particle: number, spring: number | null, tension: TensionMessage | null): string {
  const { scene, positions, speeds, states, springs, topology, contactForces } = model;
  const at = positions.subarray(3 * particle, 3 * particle + 3);
  const lines = [
    nameOf(scene, particle),
    `position ${[...at].map((value) => value.toFixed(3)).join(', ')} m`,
    `speed ${short(speeds[particle])} m/s`,
  ];
  if (contactForces && states[particle] & HAS_FORCE) {
    lines.push(`contact ${short(Math.hypot(...contactForces.subarray(3 * particle, 3 * particle + 3)))} N`);
  }
  if (spring !== null) {
    const other = springs[2 * spring] === particle ? springs[2 * spring + 1] : springs[2 * spring];
    lines.push(`${SPRING_KINDS[topology.kinds[spring]]} spring to ${nameOf(scene, other)}`, `stretch ${short(100 * stretchOf(model, spring))} %`);
    if (tension) lines.push(`tension ${short(tension.tension)} N${tension.limit ? '' : ', without the stretch limit'}`);
  }
  return lines.join('\n');
}
