import { byId, control, element, short } from './dom';
import type { Command, DivergedMessage, Problem } from '../run/protocol';

/** What a scene's author has to know, over the picture: mistakes, warnings, a run that diverged. */
export class Notices {
  private readonly problems = control('problems');
  private readonly warnings = byId<HTMLDetailsElement>('warnings');
  private readonly diverged = control('diverged');
  private divergedRun = 0;

  constructor(private readonly send: (command: Command) => void) {}

  /** Without a run to show, the problems are all there is to see. */
  showProblems(problems: Problem[], fatal: boolean): void {
    const title = fatal ? 'The scene has mistakes' : 'Refused';
    this.problems.replaceChildren(
      element('strong', { textContent: title }),
      element('ul', {}, ...[...new Set(problems.map(({ text }) => text))].map((textContent) => element('li', { textContent }))),
    );
    if (!fatal) this.problems.append(this.closeButton(this.problems));
    this.problems.classList.toggle('fatal', fatal);
    this.problems.hidden = problems.length === 0;
  }

  showSentence(text: string): void {
    this.problems.replaceChildren(element('strong', { textContent: text }));
    this.problems.classList.add('fatal');
    this.problems.hidden = false;
  }

  clearProblems(): void {
    this.problems.hidden = true;
  }

  showWarnings(texts: string[]): void {
    const [summary, list] = [this.warnings.children[0], this.warnings.children[1]];
    summary.textContent = texts.length === 1 ? '1 warning' : `${texts.length} warnings`;
    list.replaceChildren(...texts.map((textContent) => element('li', { textContent })));
    this.warnings.hidden = texts.length === 0;
  }

  /** The buttons come first: they stay in reach where a long text has to be scrolled. */
  showDivergence(message: DivergedMessage, title: string): void {
    const { run, stable_step: step } = message;
    const buttons = [...(step === null ? [] : [this.stepButton(step, run)]), this.closeButton(this.diverged)];
    this.diverged.replaceChildren(
      element('div', { className: 'message-head' }, element('strong', { textContent: title }), ...buttons),
      element('p', { textContent: message.text }),
    );
    this.diverged.hidden = false;
    this.divergedRun = run;
  }

  clearDivergence(run: number): void {
    if (run === this.divergedRun) this.diverged.hidden = true;
  }

  private stepButton(step: number, run: number): HTMLElement {
    const button = element('button', { type: 'button', className: 'primary', textContent: `Use a step of ${short(step, 6)} s` });
    button.dataset.testid = 'use-stable-step';
    button.addEventListener('click', () => {
      this.send({ do: 'set', run, key: 'step', value: step });
      this.send({ do: 'reset' });
    });
    return button;
  }

  private closeButton(panel: HTMLElement): HTMLElement {
    const button = element('button', { type: 'button', className: 'quiet', textContent: 'Close' });
    button.addEventListener('click', () => (panel.hidden = true));
    return button;
  }
}
