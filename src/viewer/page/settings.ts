import { element } from './dom';
import { NumberField, SelectField, valueAt, VectorField } from './fields';
import type { Change, Field, NumberSpec, SceneJson } from './fields';
import { INTEGRATORS } from './integrators';
import type { Json, ProblemsMessage, SceneMessage } from './protocol';

const KINDS = ['structural', 'shear', 'bend'] as const;

/** The panel of settings that may change while a scene runs. */
export class Settings {
  private fields: Field[] = [];
  private structure = '';
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
    field?.tell([...new Set(message.problems.map(({ text }) => text))]);
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
        read: (_, step) => step,
        write: (value) => ({ key: 'step', value: value ?? 'auto' }),
      }),
      new VectorField('gravity [m/s²]', 'gravity', 'gravity', this.change),
      new VectorField('wind [m/s]', 'wind', 'air.wind', this.change),
      number({ ...plain('air drag', 'drag', 'air.drag'), placeholder: 'none' }),
      number({
        label: 'stretch limit',
        testid: 'stretch-limit',
        placeholder: 'none',
        keys: ['stretch_limit', 'stretch_limit.max_stretch'],
        read: (from) => valueAt(from, ['stretch_limit', 'max_stretch']),
        write: (value) => (value === null ? { key: 'stretch_limit', value } : { key: 'stretch_limit.max_stretch', value }),
      }),
    ];
    this.fields = [...general];
    const groups = Object.keys(object(scene.bodies)).map((name) => this.group(name, bodySpecs(name, scene).map(number)));
    const obstacles = Object.keys(object(scene.obstacles)).map((name) =>
      number(plain(`friction of ${name}`, `friction-${name}`, `obstacles.${name}.friction`)),
    );
    if (obstacles.length > 0) groups.push(this.group('obstacles', obstacles));
    this.form.replaceChildren(...general.map(({ node }) => node), ...groups);
  }

  private group(title: string, fields: Field[]): HTMLElement {
    this.fields.push(...fields);
    return element('fieldset', {}, element('legend', { textContent: title }), ...fields.map(({ node }) => node));
  }
}

function bodySpecs(name: string, scene: SceneJson): NumberSpec[] {
  const specs = KINDS.flatMap((kind) => [
    springSpec(name, kind, scene, 'modulus', 'stiffness'),
    springSpec(name, kind, scene, 'damping_ratio', 'damping'),
  ]);
  return [...specs, plain('friction', `friction-${name}`, `bodies.${name}.friction`)];
}

/** A spring has either of two keys: the one of the scene is shown. */
function springSpec(name: string, kind: string, scene: SceneJson, either: string, or: string): NumberSpec {
  const path = ['bodies', name, 'springs', kind];
  const key = valueAt(scene, [...path, either]) === undefined ? or : either;
  return {
    ...plain(`${kind} ${key.replace('_', ' ')}`, `${or}-${name}-${kind}`, [...path, key].join('.')),
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
