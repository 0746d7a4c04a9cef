import { SCALE_CSS } from '../picture/colors';
import { byId, control, element, short } from './dom';
import type { Theme } from './theme';
import type { SceneView } from '../picture/scene_view';
import type { ColorMode, Switch } from '../picture/view_options';

const FEW_PARTICLES = 300;

/** The switches of what is shown, the choice of colours and their legend. */
export class ViewPanel {
  private readonly color = control<HTMLSelectElement>('color');
  private readonly legend = byId('legend');
  private readonly boxes: HTMLInputElement[];
  private legendKey = '';

  constructor(private readonly view: SceneView) {
    this.boxes = [...control('view').querySelectorAll<HTMLInputElement>('input')];
    for (const box of this.boxes) {
      box.checked = view.options[box.value as Switch];
      box.addEventListener('change', () => {
        view.options[box.value as Switch] = box.checked;
        view.invalidate();
      });
    }
    this.color.addEventListener('change', () => {
      view.options.color = this.color.value as ColorMode;
      view.invalidate();
    });
  }

  /** A few particles are worth to be seen each. */
  setDefaults(particles: number, hasSurface: boolean): void {
    this.set('particles', particles <= FEW_PARTICLES);
    this.set('springs', !hasSurface);
  }

  /** A recorded run has no speeds and no forces; one whose scene is gone has no springs and pins either. */
  offer(switches: Record<'springs' | 'pins' | 'contacts' | 'forces', boolean>, colors: Record<Exclude<ColorMode, 'plain'>, boolean>): void {
    for (const box of this.boxes) {
      const offered = switches[box.value as 'springs'] ?? true;
      (box.parentElement as HTMLElement).hidden = !offered;
    }
    for (const option of this.color.options) {
      const offered = colors[option.value as 'stretch'] ?? true;
      option.hidden = option.disabled = !offered;
      if (!offered && option.selected) {
        this.color.value = 'plain';
        this.view.options.color = 'plain';
        this.view.invalidate();
      }
    }
  }

  showLegend(theme: Theme): void {
    const { color, forces } = this.view.options;
    const { top } = this.view.scale;
    const force = forces ? `largest force ${short(this.view.largestForce)} N` : '';
    const limits = color === 'stretch' ? [...new Set(this.view.runs.map((run) => run.stretchLimit))].filter((limit) => limit > 0) : [];
    const key = `${color} ${top} ${limits.join(' ')} ${this.view.runs.length} ${force} ${theme.contact.getHexString()}`;
    if (key === this.legendKey) return;
    this.legendKey = key;
    this.legend.hidden = (color === 'plain' && force === '') || this.view.runs.length === 0;
    this.legend.replaceChildren();
    if (color === 'contact') {
      const swatch = element('i');
      swatch.style.background = `#${theme.contact.getHexString()}`;
      this.legend.append(swatch, 'in contact');
    } else if (color !== 'plain') {
      const bar = element('div', { className: 'scale' }, ...limits.map((limit) => limitMark(limit, top)));
      bar.style.background = SCALE_CSS;
      const [title, unit] = color === 'speed' ? ['speed', 'm/s'] : ['stretch of structural springs', ''];
      const end = element('span', { textContent: `${short(top)} ${unit}`.trim() });
      this.legend.append(title, element('span', { textContent: '0' }), bar, end);
    }
    if (force && this.view.runs.length > 0) {
      const swatch = element('i');
      swatch.style.background = `#${theme.force.getHexString()}`;
      this.legend.append(swatch, force);
    }
  }

  private set(name: Switch, on: boolean): void {
    const box = this.boxes.find(({ value }) => value === name);
    if (box) box.checked = on;
    this.view.options[name] = on;
    this.view.invalidate();
  }
}

/** The limit of stretch on the bar of colours. */
function limitMark(limit: number, top: number): HTMLElement {
  const mark = element('b', { className: 'limit', title: `stretch limit ${short(limit)}` }, element('span', { textContent: `limit ${short(limit)}` }));
  mark.style.left = `${(100 * limit) / top}%`;
  return mark;
}
