import type { Command, Frame, Header, SceneMessage } from './protocol';

const CACHE_BYTES = 400e6;
const MOST_ASKED = 2;

/** Plays recorded frames. Frames that were shown once are kept, as far as memory allows. */
export class ReplayPlayer {
  playing = false;
  speed = 1;
  frame = 1;
  frames = 1;
  private rate = 30;
  private readonly cache = new Map<number, { header: Header; frame: Frame }>();
  private bytes = 0;
  private readonly asked = new Set<number>();
  private startTime = 0;
  private startFrame = 1;
  private shown = 0;

  constructor(
    private readonly send: (command: Command) => void,
    private readonly show: (header: Header, frame: Frame) => void,
  ) {}

  /** A run is there, perhaps again after a lost connection. */
  begin(scene: SceneMessage): void {
    this.frames = Math.max(scene.frames, 1);
    this.rate = scene.frame_rate > 0 ? scene.frame_rate : 30;
    this.cache.clear();
    this.asked.clear();
    this.bytes = 0;
    this.shown = 0;
    this.seek(this.frame);
  }

  play(playing: boolean): void {
    this.playing = playing;
    this.restartClock();
  }

  setSpeed(speed: number): void {
    this.speed = speed;
    this.restartClock();
  }

  seek(frame: number): void {
    this.frame = Math.min(Math.max(Math.round(frame), 1), this.frames);
    this.restartClock();
    this.present();
  }

  seekTime(time: number): void {
    this.seek(1 + Math.round(time * this.rate));
  }

  /** To be called in each animation frame. */
  tick(now: number): void {
    if (!this.playing || this.frames < 2) return;
    const elapsed = ((now - this.startTime) / 1000) * this.rate * this.speed;
    this.frame = 1 + ((this.startFrame - 1 + Math.max(Math.floor(elapsed), 0)) % this.frames);
    this.present();
  }

  receive(header: Header, frame: Frame): void {
    this.asked.delete(header.frame);
    if (!this.cache.has(header.frame)) {
      const size = frame.positions.byteLength + frame.deformed.reduce((sum, { byteLength }) => sum + byteLength, 0);
      if (this.bytes + size > CACHE_BYTES) this.cache.clear();
      this.bytes = this.cache.size === 0 ? size : this.bytes + size;
      this.cache.set(header.frame, { header, frame });
    }
    // A server that is late still moves the picture, but never backwards.
    const behind = (number: number) => (this.frame - number + this.frames) % this.frames;
    if (this.shown === 0 || behind(header.frame) < behind(this.shown)) this.display(header, frame);
    if (header.frame !== this.frame) this.present();
  }

  private present(): void {
    if (this.shown === this.frame) return this.askAhead();
    const known = this.cache.get(this.frame);
    if (known) this.display(known.header, known.frame);
    else this.ask(this.frame);
    this.askAhead();
  }

  private askAhead(): void {
    if (!this.playing) return;
    for (let ahead = 1; ahead <= 8 && this.asked.size < MOST_ASKED; ++ahead) this.ask(1 + ((this.frame - 1 + ahead) % this.frames));
  }

  private ask(frame: number): void {
    if (this.cache.has(frame) || this.asked.has(frame) || this.asked.size >= MOST_ASKED) return;
    this.asked.add(frame);
    this.send({ do: 'seek', frame });
  }

  private display(header: Header, frame: Frame): void {
    if (this.shown === header.frame) return;
    this.shown = header.frame;
    this.show(header, frame);
  }

  private restartClock(): void {
    this.startTime = performance.now();
    this.startFrame = this.frame;
  }
}
