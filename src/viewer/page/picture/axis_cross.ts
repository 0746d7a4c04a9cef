import { Matrix4 } from 'three';
import { byId } from '../panel/dom';

const AXES = [
  { name: 'x', color: '#c8423f' },
  { name: 'y', color: '#3f9a4d' },
  { name: 'z', color: '#3f78c8' },
];
const LENGTH = 22;
const XML = 'http://www.w3.org/2000/svg';

/** The directions of the axes, in a corner of the picture. */
export class AxisCross {
  private readonly axes = AXES.map(({ name, color }) => {
    const group = document.createElementNS(XML, 'g');
    const line = document.createElementNS(XML, 'line');
    const text = document.createElementNS(XML, 'text');
    line.setAttribute('stroke', color);
    text.setAttribute('fill', color);
    text.textContent = name;
    group.append(line, text);
    return { group, line, text };
  });

  private readonly shown = new Matrix4();

  constructor() {
    byId('axes').append(...this.axes.map(({ group }) => group));
  }

  show(view: Matrix4): void {
    if (view.equals(this.shown)) return;
    this.shown.copy(view);
    const e = view.elements;
    this.axes.forEach(({ line, text }, k) => {
      const x = LENGTH * e[4 * k];
      const y = -LENGTH * e[4 * k + 1];
      line.setAttribute('x2', x.toFixed(1));
      line.setAttribute('y2', y.toFixed(1));
      text.setAttribute('x', (1.3 * x).toFixed(1));
      text.setAttribute('y', (1.3 * y).toFixed(1));
    });
  }
}
