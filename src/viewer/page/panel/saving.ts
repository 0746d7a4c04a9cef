import { byId, control, element } from './dom';
import type { RunModel } from '../run/run_model';
import type { SceneView } from '../picture/scene_view';

export function download(name: string, content: Blob): void {
  const address = URL.createObjectURL(content);
  element('a', { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10000);
}

export function downloadText(name: string, text: string): void {
  download(name, new Blob([text], { type: 'text/plain' }));
}

/** The picture has to be drawn in the same task, or it is empty. */
export function savePicture(view: SceneView, name: string): void {
  view.touch();
  view.draw();
  view.canvas.toBlob((blob) => {
    if (blob) download(`${name}.png`, blob);
  });
}

/** Records the picture as WebM; the second call ends it. */
export class Recorder {
  private recorder: MediaRecorder | null = null;

  /** Returns whether it records now. Throws where the browser cannot record. */
  toggle(canvas: HTMLCanvasElement, name: string): boolean {
    if (this.recorder) {
      this.recorder.stop();
      this.recorder = null;
      return false;
    }
    const pieces: Blob[] = [];
    const stream = canvas.captureStream(60);
    const recorder = new MediaRecorder(stream, { mimeType: 'video/webm', videoBitsPerSecond: 12e6 });
    recorder.ondataavailable = ({ data }) => pieces.push(data);
    recorder.onstop = () => {
      for (const track of stream.getTracks()) track.stop();
      download(`${name}.webm`, new Blob(pieces, { type: 'video/webm' }));
    };
    recorder.start();
    this.recorder = recorder;
    return true;
  }
}

/** A body as it is shown, as triangles and lines. */
export function objText(model: RunModel, bodyName: string): string {
  const body = model.scene.bodies.find(({ name }) => name === bodyName);
  if (!body) return '';
  const lines: string[] = [];
  const positions = model.bodies[bodyName].positions;
  for (let k = 0; k < positions.length; k += 3) lines.push(`v ${positions[k]} ${positions[k + 1]} ${positions[k + 2]}`);
  const elements = (letter: string, indices: Uint32Array, size: number) => {
    for (let k = 0; k < indices.length; k += size) {
      const corners = Array.from(indices.subarray(k, k + size), (index) => index - body.first);
      if (corners[0] >= 0 && corners[0] < body.count) lines.push(`${letter} ${corners.map((corner) => corner + 1).join(' ')}`);
    }
  };
  elements('f', model.topology.triangles, 3);
  elements('l', model.topology.segments, 2);
  return `${lines.join('\n')}\n`;
}

/** The scene as JSON text. */
export function sceneText(scene: unknown): string {
  return `${JSON.stringify(scene, null, 2)}\n`;
}

/** Where the clipboard is not allowed, the text is shown to be copied by hand. */
export async function copyScene(scene: unknown): Promise<void> {
  const text = sceneText(scene);
  const button = control('copy-scene');
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = 'Copied';
    setTimeout(() => (button.textContent = 'Copy scene'), 1500);
  } catch {
    const area = byId<HTMLTextAreaElement>('scene-text');
    area.hidden = false;
    area.value = text;
    area.select();
  }
}
