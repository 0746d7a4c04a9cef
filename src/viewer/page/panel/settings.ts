import { element, short } from './dom';
import { CheckField, NumberField, SelectField, valueAt, VectorField } from './fields';
import type { Change, Field, NumberSpec, SceneJson } from './fields';
import { INTEGRATORS } from './integrators';
import { materialsFor } from './materials';
import type { Json, ProblemsMessage, SceneMessage } from '../run/protocol';

const KINDS = ['structural', 'shear', 'bend'] as const;
/** So many bodies do not fit beside each other. */
const MANY_BODIES = 3;

/** The panel of settings that may change while a scene runs. */
export class Settings {
  private fields: Field[] = [];
  private structure = '';
  private frameRate = 30;
  /** What else a type of integrator was given, so that a choice can be taken back. */
  private readonly integrators = new Map<string, Json>();

  constructor(
    private readonly form: HTMLElement,
    private readonly change: Change,
  ) {
    form.addEventListener('submit', (event) => event.preventDefault());
  }

  /** Shows the values of a scene. */
  show(message: SceneMessage): void {
    const { scene } = message;
    this.frameRate = message.frame_rate;
    const structure = JSON.stringify([Object.keys(object(scene.bodies)), Object.keys(object(scene.obstacles)), springKeys(scene)]);
    if (structure !== this.structure) this.build(scene);
    this.structure = structure;
    this.integrators.set(message.integrator, scene.integrator ?? { type: message.integrator });
    for (const field of this.fields) field.show(scene, message.step);
  }

  /** Another scene: what was known of the last one does not hold. */
  forget(): void {
    this.structure = '';
    this.integrators.clear();
  }

  /** Returns whether there is a field for the problems. */
  tell(message: ProblemsMessage): boolean {
    const field = this.fields.find((each) => each.owns(message.key));
    field?.tell([...new Set(message.problems.map(({ rule }) => rule.replace(/^must be /, '')))]);
    return field !== undefined;
  }

  private build(scene: SceneJson): void {
    const number = (spec: NumberSpec) => new NumberField(spec, this.change);
    const chooseIntegrator = (type: string) => this.change('integrator', this.integrators.get(type) ?? { type });
    const general: Field[] = [
      new SelectField('integrator', 'integrator', 'integrator', INTEGRATORS, typeOf, chooseIntegrator),
      number({
        label: 'step [s]',
        testid: 'step-size',
        placeholder: 'auto',
        keys: ['step'],
        snap: (value) => divisorNear(value, this.frameRate),
        read: (_, step) => step,
        write: (value) => ({ key: 'step', value: value ?? 'auto' }),
      }),
      new CheckField(
        'run unstable steps',
        'unstable',
        'stability',
        (from) => from.stability === 'warn',
        (on) => (on ? 'warn' : 'refuse'),
        this.change,
      ),
      number({ ...plain('duration [s]', 'duration', 'duration'), restarts: true }),
      new VectorField('gravity [m/s²]', 'gravity', 'gravity', this.change),
      new VectorField('wind [m/s]', 'wind', 'air.wind', this.change),
      number({ ...plain('air drag [1/s]', 'drag', 'air.drag'), placeholder: 'none' }),
      number({
        label: 'stretch limit [1]',
        testid: 'stretch-limit',
        placeholder: 'none',
        keys: ['stretch_limit', 'stretch_limit.max_stretch'],
        read: (from) => valueAt(from, ['stretch_limit', 'max_stretch']),
        write: (value) => (value === null ? { key: 'stretch_limit', value } : { key: 'stretch_limit.max_stretch', value }),
      }),
    ];
    this.fields = [...general];
    const bodies = Object.keys(object(scene.bodies));
    const groups = bodies.map((name) => this.group(name, this.bodyFields(name, scene), bodies.length > MANY_BODIES));
    const obstacles = Object.keys(object(scene.obstacles)).map((name) =>
      number(plain(`friction of ${name}`, `friction-${name}`, `obstacles.${name}.friction`)),
    );
    if (obstacles.length > 0) groups.push(this.group('obstacles', obstacles, obstacles.length > MANY_BODIES));
    this.form.replaceChildren(...general.map(({ node }) => node), ...groups);
  }

  private bodyFields(name: string, scene: SceneJson): Field[] {
    const fields: Field[] = [];
    const key = `bodies.${name}`;
    const has = (own: string) => valueAt(scene, ['bodies', name, own]) !== undefined;
    const number = (spec: NumberSpec) => new NumberField(spec, this.change);
    const material = valueAt(scene, ['bodies', name, 'material']);
    if (typeof material === 'string') {
      const shape = valueAt(scene, ['bodies', name, 'shape', 'type']);
      const options = materialsFor(String(shape), material).map((value) => ({ value, label: value.replaceAll('_', ' ') }));
      const read = (from: SceneJson) => String(valueAt(from, ['bodies', name, 'material']));
      const choose = (value: string) => this.change(`${key}.material`, value);
      fields.push(new SelectField('material', `material-${name}`, `${key}.material`, options, read, choose));
    }
    if (has('mass')) fields.push(number({ ...plain('mass [kg]', `mass-${name}`, `${key}.mass`), restarts: true }));
    if (has('density')) fields.push(number({ ...plain('density', `density-${name}`, `${key}.density`), restarts: true }));
    fields.push(...bodySpecs(name, scene).map(number));
    fields.push(number(plain('thickness [m]', `thickness-${name}`, `${key}.thickness`)));
    if (has('self_contact')) {
      const isOn = (from: SceneJson) => valueAt(from, ['bodies', name, 'self_contact']) === true;
      fields.push(new CheckField('self-contact', `self-contact-${name}`, `${key}.self_contact`, isOn, (on) => on, this.change));
    }
    return fields;
  }

  /** Many bodies are folded, each under its name. */
  private group(title: string, fields: Field[], folded: boolean): HTMLElement {
    this.fields.push(...fields);
    const nodes = fields.map(({ node }) => node);
    if (folded) return element('details', {}, element('summary', { textContent: title }), ...nodes);
    return element('fieldset', {}, element('legend', { textContent: title }), ...nodes);
  }
}

/** The step nearest to a wish that divides a frame, and what is told of it. */
function divisorNear(wish: number, frameRate: number): { value: number; note: string } {
  const steps = 1 / (frameRate * wish);
  const count = [Math.floor(steps), Math.ceil(steps)]
    .map((each) => Math.max(each, 1))
    .reduce((a, b) => (Math.abs(1 / (frameRate * b) - wish) < Math.abs(1 / (frameRate * a) - wish) ? b : a));
  const value = 1 / (frameRate * count);
  if (Math.abs(value - wish) <= 1e-6 * wish) return { value, note: '' };
  const many = count === 1 ? 'one step' : `${count} steps`;
  return { value, note: `${short(wish, 6)} s does not divide a frame of 1/${short(frameRate, 6)} s: ${many} of ${short(value)} s instead` };
}

function bodySpecs(name: string, scene: SceneJson): NumberSpec[] {
  const own = object(valueAt(scene, ['bodies', name, 'springs']));
  const specs = KINDS.filter((kind) => own[kind] !== undefined && own[kind] !== null).flatMap((kind) => [
    springSpec(name, kind, scene, 'stiffness', ['modulus']),
    springSpec(name, kind, scene, 'damping', ['damping_time', 'damping_ratio']),
  ]);
  return [...specs, plain('friction', `friction-${name}`, `bodies.${name}.friction`)];
}

const UNITS: Record<string, string> = { stiffness: 'N/m', damping: 'N s/m', damping_time: 's', damping_ratio: '1' };

/** A spring has one of several keys: the one of the scene is shown. */
function springSpec(name: string, kind: string, scene: SceneJson, usual: string, others: string[]): NumberSpec {
  const path = ['bodies', name, 'springs', kind];
  const key = others.find((each) => valueAt(scene, [...path, each]) !== undefined) ?? usual;
  // The unit of a modulus, and of bends by angle, depends on the shape.
  const byAngle = valueAt(scene, [...path, 'model']) === 'angle' && key === usual;
  const unit = UNITS[key] && !byAngle ? ` [${UNITS[key]}]` : '';
  return {
    ...plain(`${kind} ${key.replace('_', ' ')}${unit}`, `${usual}-${name}-${kind}`, [...path, key].join('.')),
    placeholder: 'none',
  };
}

function plain(label: string, testid: string, key: string): NumberSpec {
  const path = key.split('.');
  return { label, testid, keys: [key], read: (scene) => valueAt(scene, path), write: (value) => ({ key, value }) };
}

function typeOf(scene: SceneJson): string {
  const type = valueAt(scene, ['integrator', 'type']);
  return typeof type === 'string' ? type : 'verlet';
}

/** Which keys the springs are given by: it decides on the fields. */
function springKeys(scene: SceneJson): string[] {
  return Object.values(object(scene.bodies)).flatMap((body) =>
    Object.values(object(object(body).springs)).map((spring) => Object.keys(object(spring)).join(' ')),
  );
}

function object(value: Json | undefined): SceneJson {
  return value !== null && typeof value === 'object' && !Array.isArray(value) ? value : {};
}
