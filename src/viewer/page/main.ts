import { Connection } from './run/connection';
import { embeddedRun } from './run/embedded_run';
import { Notices } from './panel/notices';
import { Page } from './page';
import { SceneView } from './picture/scene_view';

/** Null where the browser cannot draw. */
function sceneView(): SceneView | null {
  try {
    const parent = document.getElementById('picture');
    return parent && new SceneView(parent);
  } catch {
    return null;
  }
}

function sentence(text: string): void {
  new Notices(() => undefined).showSentence(text);
}

async function start(): Promise<void> {
  const view = sceneView();
  if (!view) {
    sentence('This browser has no WebGL, which the picture needs. Switch on hardware acceleration in its settings, or take another browser.');
    return;
  }
  let embedded = null;
  try {
    embedded = await embeddedRun();
  } catch (error) {
    sentence(`This browser cannot unpack the run. Take a newer one. (${String(error)})`);
    return;
  }
  new Page(embedded ?? new Connection(), view).start();
}

void start();
