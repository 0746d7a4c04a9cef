import { control, byId, element, short } from './panel/dom';
import { Drag } from './picture/drag';
import { EmbeddedRun } from './run/embedded_run';
import { Gallery } from './panel/gallery';
import { History } from './run/history';
import { integratorLabel } from './panel/integrators';
import { LiveHistory } from './run/live_history';
import { Notices } from './panel/notices';
import { Plots } from './panel/plots';
import type { Command, DivergedMessage, Example, Frame, Header, ProblemsMessage, SavedMessage, SceneMessage, TextMessage, Topology } from './run/protocol';
import { ReplayPlayer } from './run/replay_player';
import { RunModel } from './run/run_model';
import { copyScene, downloadText, objText, Recorder, savePicture, sceneText } from './panel/saving';
import { DIRECTIONS } from './picture/scene_view';
import type { SceneView } from './picture/scene_view';
import { Selection } from './panel/selection';
import { Settings } from './panel/settings';
import type { Source, SourceListener } from './run/source';
import { publish } from './testing';
import type { Shown } from './testing';
import { LIGHT, ThemeChoice } from './panel/theme';
import { Toolbar } from './panel/toolbar';
import { ViewPanel } from './panel/view_panel';

const PLOT_MS = 200;
const ERROR_MS = 8000;
const DRAGGED_KEY = 'sprung-dragged';

/** Brings what a source tells to the picture and the panels, and what the user does to the source. */
export class Page implements SourceListener {
  private readonly shown: Shown = { title: '', models: [], playing: false, fps: 0, connected: false, mode: null, problems: [] };
  private readonly scenes = new Map<number, SceneMessage>();
  /** Runs whose first frame has not come yet. */
  private readonly coming = new Map<number, RunModel>();
  private readonly send = (command: Command) => this.source.send(command);
  private readonly toolbar: Toolbar;
  private readonly settings: Settings;
  private readonly notices = new Notices(this.send);
  private readonly plots: Plots;
  private readonly panel: ViewPanel;
  private readonly drag: Drag;
  private readonly gallery: Gallery;
  private readonly player: ReplayPlayer;
  private readonly recorder = new Recorder();
  private readonly status = control('status');
  private readonly saveName = control<HTMLInputElement>('save-name');
  private theme = LIGHT;
  private fitted = '';
  private plotted = { time: 0, stale: true };
  private sceneWanted: ((scene: unknown) => void) | null = null;
  private readonly past = new LiveHistory();
  /** An earlier frame of a live run is shown. */
  private looksBack = false;
  private readonly selection: Selection;
  private errorUntil = 0;
  private frameCount = { since: 0, drawn: 0 };

  constructor(
    private readonly source: Source,
    private readonly view: SceneView,
  ) {
    this.settings = new Settings(byId('settings'), (key, value) => {
      const own = key === 'integrator' && this.shown.models.length > 1 ? { run: 0 } : {};
      this.send({ do: 'set', ...own, key, value });
    });
    this.plots = new Plots(byId('plots'), () => (this.plotted.stale = true), (time) => this.seekTime(time));
    this.panel = new ViewPanel(view);
    this.selection = new Selection(view, this.send);
    this.drag = new Drag(view, this.send, {
      dragged: () => this.firstDragDone(),
      selected: (pick) => {
        this.selection.choose(pick);
        this.plotted.stale = true;
      },
    });
    this.player = new ReplayPlayer(this.send, (header, frame) => this.showFrame(header, frame));
    this.toolbar = new Toolbar({
      play: (playing) => this.play(playing),
      step: () => this.goOn({ do: 'step' }),
      frame: () => this.singleFrame(),
      reset: () => (this.recorded ? this.player.seek(1) : this.send({ do: 'reset' })),
      fit: (direction) => view.fit(DIRECTIONS[direction]),
      speed: (factor) => (this.recorded ? this.player.setSpeed(factor) : this.send({ do: 'speed', factor })),
      every: (steps) => this.send({ do: 'every', steps }),
      compare: (integrator) => this.send(integrator ? { do: 'compare', integrator } : { do: 'single' }),
      open: (example) => this.open(example),
      seek: (frame) => {
        this.play(false);
        this.player.seek(frame);
      },
    });
    this.gallery = new Gallery((example) => this.open(example), (example) => this.send({ do: 'picture', example }));
    const themes = new ThemeChoice((theme) => {
      this.theme = theme;
      view.setTheme(theme);
      this.plots.forgetColors();
      this.plotted.stale = true;
    });
    themes.apply();
    control('theme').addEventListener('click', () => themes.toggle());
    this.bindSaving();
    publish(this.shown, view);
  }

  start(): void {
    this.source.start(this);
    const tick = (now: number) => {
      this.tick(now);
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  connected(connected: boolean): void {
    this.shown.connected = connected;
    if (connected) this.setOffline('');
    if (!connected) this.drag.cancel();
    this.errorUntil = 0;
    this.showStatus();
  }

  lost(refused: boolean): void {
    this.setOffline(
      refused
        ? 'The program was started again: open the new address that it printed.'
        : 'The program has ended. This page goes on when it is started again with the same address.',
    );
  }

  text(message: TextMessage): void {
    if (message.type === 'hello') {
      this.greet(message.mode, message.title, message.examples);
    } else if (message.type === 'scene') {
      this.beginScene(message);
    } else if (message.type === 'problems') {
      this.showProblems(message);
    } else if (message.type === 'state') {
      this.shown.playing = message.playing;
      this.toolbar.setState(message);
      this.plotted.stale = true;
    } else if (message.type === 'diverged') {
      this.showDivergence(message);
    } else if (message.type === 'obj') {
      downloadText(message.name, message.text);
    } else if (message.type === 'error' || message.type === 'notice') {
      this.showError(message.text);
    } else if (message.type === 'changed') {
      this.sceneWanted?.(message.changed);
      this.sceneWanted = null;
    } else if (message.type === 'picture') {
      this.gallery.setPicture(message.example, message.png);
    } else if (message.type === 'tension') {
      this.selection.receive(message);
      this.plotted.stale = true;
    } else if (message.type === 'saved') {
      this.savedRun(message);
    } else if (message.type === 'removed') {
      this.remove(message.run);
    }
  }

  topology(header: Header, topology: Topology): void {
    const scene = this.scenes.get(header.run);
    if (scene?.generation !== header.generation) return;
    const last = this.shown.models[header.run];
    const history = scene.live && last ? last.history : new History();
    if (scene.diagnostics) history.load(scene.diagnostics, scene.frame_rate);
    this.coming.set(header.run, new RunModel(scene, topology, history));
    if (this.recorded) this.player.begin(scene);
  }

  frame(header: Header, frame: Frame): void {
    if (this.recorded) return this.player.receive(header, frame);
    this.past.add(header, frame);
    this.looksBack = false;
    this.showFrame(header, frame);
  }

  private get recorded(): boolean {
    return this.shown.mode === 'replay';
  }

  private greet(mode: 'live' | 'replay', title: string, examples: Example[]): void {
    this.shown.mode = mode;
    document.body.dataset.mode = mode;
    this.setTitle(title);
    this.toolbar.setExamples(examples.map(({ name }) => name));
    this.gallery.setExamples(examples);
    this.scenes.clear();
    this.coming.clear();
    this.remove(1);
    if (mode === 'live') this.showHint();
    if (mode !== 'replay') return;
    this.toolbar.setRecorded();
    const still = window.matchMedia('(prefers-reduced-motion: reduce)').matches;
    if (this.shown.models.length === 0 && !still) this.play(true);
  }

  private open(example: string): void {
    this.fitted = '';
    this.settings.forget();
    this.send({ do: 'open', example });
  }

  private beginScene(message: SceneMessage): void {
    this.scenes.set(message.run, message);
    this.shown.problems = [];
    this.notices.clearProblems();
    this.notices.clearDivergence(message.run);
    this.drag.cancel();
    if (message.run === 0) {
      this.setTitle(message.title);
      this.settings.show(message);
      this.notices.showWarnings(message.warnings);
      this.toolbar.setFrames(message.frames);
      this.offer(message);
      this.showLesson(message.lesson ?? '');
    } else {
      this.toolbar.setCompared(message.integrator);
    }
  }

  /** The first line is the title of the lesson. */
  private showLesson(text: string): void {
    const lesson = byId('lesson');
    const [title, ...lines] = text.trim().split('\n');
    lesson.hidden = title === '';
    lesson.replaceChildren(element('strong', { textContent: title }), lines.join('\n').trim());
  }

  private setTitle(title: string): void {
    // A changed setting keeps the name that was chosen.
    if (title !== this.shown.title) this.saveName.value = `${title.replace(/\.json$/, '').replace(/[^\w-]/g, '_').slice(0, 40)}_1`;
    this.shown.title = title;
    byId('title').textContent = title;
    this.toolbar.setExample(title);
    document.title = title ? `${title} - Sprung` : 'Sprung';
  }

  private offer(message: SceneMessage): void {
    const { complete } = message;
    const live = !this.recorded;
    // A file leaves out the speeds.
    const speed = complete && !(this.source instanceof EmbeddedRun);
    this.panel.offer({ springs: complete, pins: complete, contacts: complete, forces: message.forces ?? false }, { stretch: complete, speed, contact: complete });
    const save = (name: string) => () => {
      if (live) this.send({ do: 'obj', run: 0, body: name });
      else if (this.shown.models[0]) downloadText(`${name}.obj`, objText(this.shown.models[0], name));
    };
    const buttons = message.bodies.map(({ name }) => {
      const button = element('button', { type: 'button', textContent: `${name}.obj`, onclick: save(name) });
      button.dataset.testid = `save-${name}`;
      return button;
    });
    byId('save-bodies').replaceChildren(...buttons);
  }

  private showFrame(header: Header, frame: Frame): void {
    const coming = this.coming.get(header.run);
    let model = this.shown.models[header.run];
    if (coming?.scene.generation === header.generation) {
      coming.apply(header, frame);
      this.coming.delete(header.run);
      model = this.shown.models[header.run] = coming;
      this.view.setRun(header.run, model);
      this.selection.renumber(header.run);
      this.fitOnce(model);
      this.labelRuns();
    } else if (model?.scene.generation === header.generation) {
      model.apply(header, frame);
    } else {
      return;
    }
    if (!this.recorded) model.history.add(header.time, frame.numbers);
    this.plotted.stale = true;
    this.view.invalidate();
  }

  /** A scene that was changed keeps the view that the user has chosen. */
  private fitOnce(model: RunModel): void {
    const { bodies, obstacles, run } = model.scene;
    const scene = JSON.stringify([bodies, obstacles]);
    if (run !== 0 || scene === this.fitted) return;
    this.fitted = scene;
    this.selection.choose(null);
    this.panel.setDefaults(model.topology.particles, model.topology.triangles.length + model.topology.segments.length > 0);
    this.view.draw();
    this.view.fit();
  }

  private showDivergence(message: DivergedMessage): void {
    const models = [this.coming.get(message.run), this.shown.models[message.run]];
    const model = models.find((each) => each?.scene.generation === message.generation);
    if (!model) return;
    model.diverged = message;
    const name = this.shown.models.length > 1 ? `${integratorLabel(model.scene.integrator)} diverged` : 'The run diverged';
    this.notices.showDivergence(message, name);
    this.view.invalidate();
  }

  private showProblems(message: ProblemsMessage): void {
    this.shown.problems = message.problems.map(({ text }) => text);
    const fatal = message.run === null && this.shown.models.length === 0;
    const second = this.shown.models[1];
    this.toolbar.setCompared(second?.scene.integrator ?? null);
    this.toolbar.setExample(this.shown.title);
    // The field of the integrator is that of the first run.
    const comparison = message.run === 1 && !second;
    if (fatal || comparison || !this.settings.tell(message)) this.notices.showProblems(message.problems, fatal);
  }

  private remove(run: number): void {
    this.coming.delete(run);
    this.scenes.delete(run);
    this.notices.clearDivergence(run);
    if (this.shown.models.length > run) this.shown.models.length = run;
    this.view.setRun(run, null);
    this.toolbar.setCompared(null);
    this.plotted.stale = true;
    this.labelRuns();
  }

  private labelRuns(): void {
    const { models } = this.shown;
    const labels = models.length < 2 ? [] : models.map(({ scene }) => integratorLabel(scene.integrator));
    document.body.toggleAttribute('data-two', models.length > 1);
    byId('labels').replaceChildren(...labels.map((textContent) => element('span', { textContent })));
  }

  private play(playing: boolean): void {
    if (!this.recorded) return playing ? this.goOn({ do: 'play' }) : this.send({ do: 'pause' });
    this.player.play(playing);
    this.shown.playing = playing;
    this.toolbar.setPlaying(playing);
  }

  private seekTime(time: number): void {
    this.play(false);
    if (this.recorded) this.player.seekTime(time);
    else this.lookBack(time);
  }

  /** The run goes on from the frame that is shown, if that is an earlier one. */
  private goOn(command: Command): void {
    if (this.looksBack) this.send({ do: 'rewind', time: this.shown.models[0].time });
    this.looksBack = false;
    this.send(command);
  }

  /** Shows a frame of the last seconds of a live run. The run itself stays where it is until it goes on. */
  private lookBack(time: number): void {
    this.shown.models.forEach((model, run) => {
      const found = this.past.at(run, time);
      if (found?.header.generation === model.scene.generation) model.apply(found.header, found.frame);
      this.looksBack = found !== null && found.header !== this.past.newest(run)?.header;
    });
    this.plotted.stale = true;
    this.view.invalidate();
  }

  private singleFrame(): void {
    if (!this.recorded) return this.goOn({ do: 'frame' });
    this.play(false);
    this.player.seek(1 + (this.player.frame % this.player.frames));
  }

  private bindSaving(): void {
    const record = control('record');
    control('save-picture').addEventListener('click', () => savePicture(this.view, 'sprung'));
    record.addEventListener('click', () => {
      try {
        record.textContent = this.recorder.toggle(this.view.canvas, 'sprung') ? 'Stop recording' : 'Record';
      } catch {
        this.showError('this browser cannot record WebM');
      }
    });
    for (const as of ['run', 'page'] as const) {
      control(`save-${as}`).addEventListener('click', () => this.send({ do: 'save', as, name: this.saveName.value }));
    }
    control('copy-scene').addEventListener('click', () => this.askScene((scene) => void copyScene(scene)));
    control('save-scene').addEventListener('click', () => {
      this.askScene((scene) => downloadText(this.shown.title || 'scene.json', sceneText(scene)));
    });
  }

  /** Gives `use` the scene with its changes. The program knows the pins that were set since it began, and saves the state. */
  private askScene(use: (scene: unknown) => void): void {
    if (this.recorded) return use(this.scenes.get(0)?.changed ?? {});
    this.sceneWanted = use;
    const withState = control<HTMLInputElement>('with-state').checked;
    this.send({ do: 'scene', run: 0, ...(withState ? { state: this.saveName.value } : {}) });
  }

  /** After cloth_1 comes cloth_2. */
  private savedRun({ name, text }: SavedMessage): void {
    control('saved').textContent = text;
    if (name === '' || name !== this.saveName.value) return;
    const [, stem, number] = /^(.*?)(\d*)$/.exec(name)!;
    this.saveName.value = number ? `${stem}${Number(number) + 1}` : `${stem}_2`;
  }

  private tick(now: number): void {
    if (this.recorded) this.player.tick(now);
    this.drag.enabled = this.shown.mode === 'live' && this.shown.connected;
    this.drag.tick();
    this.view.controls.update();
    if (this.view.draw()) {
      ++this.frameCount.drawn;
      this.panel.showLegend(this.theme);
    }
    if (now - this.frameCount.since > 1000) {
      this.shown.fps = (1000 * this.frameCount.drawn) / (now - this.frameCount.since);
      this.frameCount = { since: now, drawn: 0 };
      this.showStatus();
    }
    if (!this.plotted.stale || now - this.plotted.time < PLOT_MS) return;
    this.plotted = { time: now, stale: false };
    this.plots.draw(this.shown.models, this.recorded || this.looksBack);
    this.showReadout();
    // Setting the slider forces a layout, so not in each animation frame.
    if (this.recorded) this.toolbar.setFrame(this.player.frame);
    // A simulator that a program steps has no scene.
    this.selection.show(!this.recorded && !this.looksBack && Object.keys(this.shown.models[0]?.scene.scene ?? {}).length > 0);
  }

  private showReadout(): void {
    const [model] = this.shown.models;
    if (!model) return;
    const { numbers } = model;
    const rates = this.shown.models.map((each) => `${short(each.numbers?.realtime ?? 0, 2)}x`).join(' | ');
    control('realtime').textContent = this.recorded || !this.shown.playing ? '' : rates;
    const infeasible = numbers?.infeasible ? `, ${numbers.infeasible} infeasible` : '';
    const past = this.looksBack ? ', earlier: play goes on from here' : '';
    control('readout').textContent = `frame ${model.frame}, ${model.time.toFixed(3)} s${infeasible}${past}`;
  }

  /** Why there is no program to talk to; empty if there is one. */
  private setOffline(text: string): void {
    const ended = control('ended');
    ended.textContent = text;
    ended.hidden = text === '';
    document.body.toggleAttribute('data-offline', text !== '');
    for (const part of document.querySelectorAll<HTMLElement>('[data-server]')) part.inert = text !== '';
  }

  /** Until the first drag of all, the page says that there is something to drag. */
  private showHint(): void {
    let done = false;
    try {
      done = localStorage.getItem(DRAGGED_KEY) !== null;
    } catch {
      // A browser without storage shows the hint each time.
    }
    control('hint').hidden = done;
  }

  private firstDragDone(): void {
    control('hint').hidden = true;
    try {
      localStorage.setItem(DRAGGED_KEY, '');
    } catch {
      // See showHint.
    }
  }

  private showError(text: string): void {
    this.status.textContent = text;
    this.errorUntil = performance.now() + ERROR_MS;
  }

  private showStatus(): void {
    if (performance.now() < this.errorUntil) return;
    const state = this.source instanceof EmbeddedRun ? this.source.note : this.shown.connected ? 'connected' : 'disconnected';
    this.status.dataset.state = this.shown.connected ? 'connected' : 'disconnected';
    // A screen reader speaks each text that is set.
    if (this.status.textContent !== state) this.status.textContent = state;
    control('fps').textContent = this.shown.connected && this.shown.fps >= 0.5 ? `${Math.round(this.shown.fps)} frames/s` : '';
  }
}
