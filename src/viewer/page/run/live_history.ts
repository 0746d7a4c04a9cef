import type { Frame, Header } from './protocol';

const SECONDS = 10;
const MOST_BYTES = 128e6;

interface Kept { header: Header; frame: Frame; bytes: number }

/** The last frames of the live runs, to look back at. A frame keeps the message that it came in, so nothing is copied. */
export class LiveHistory {
  private kept: Kept[] = [];
  private bytes = 0;

  add(header: Header, frame: Frame): void {
    const last = this.newest(header.run);
    if (last && header.generation !== last.header.generation) this.keepOnly(({ header: { run } }) => run !== header.run);
    // The run went back.
    else if (last && header.time <= last.header.time) this.keepOnly(({ header: { run, time } }) => run !== header.run || time < header.time);
    const bytes = frame.positions.buffer.byteLength;
    this.kept.push({ header, frame, bytes });
    this.bytes += bytes;
    while (this.bytes > MOST_BYTES || this.kept[0].header.time < header.time - SECONDS) this.bytes -= this.kept.shift()!.bytes;
  }

  private keepOnly(wanted: (kept: Kept) => boolean): void {
    this.kept = this.kept.filter(wanted);
    this.bytes = this.kept.reduce((sum, { bytes }) => sum + bytes, 0);
  }

  /** The frame of a run that is nearest to a time, if there is one. */
  at(run: number, time: number): { header: Header; frame: Frame } | null {
    let best: Kept | null = null;
    for (const each of this.kept) {
      if (each.header.run !== run) continue;
      if (!best || Math.abs(each.header.time - time) < Math.abs(best.header.time - time)) best = each;
    }
    return best;
  }

  newest(run: number): { header: Header; frame: Frame } | null {
    for (let k = this.kept.length - 1; k >= 0; --k) if (this.kept[k].header.run === run) return this.kept[k];
    return null;
  }
}
