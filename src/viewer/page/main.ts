import { Connection } from './connection';
import { embeddedRun } from './embedded_run';
import { Notices } from './notices';
import { Page } from './page';
import { SceneView } from './scene_view';

/** Null where the browser cannot draw. */
function sceneView(): SceneView | null {
  try {
    const parent = document.getElementById('picture');
    return parent && new SceneView(parent);
  } catch {
    return null;
  }
}

const embedded = embeddedRun();
const view = sceneView();
if (view) {
  new Page(embedded ?? new Connection(), view).start();
} else {
  new Notices(() => undefined).showSentence(
    'This browser has no WebGL, which the picture needs. Switch on hardware acceleration in its settings, or take another browser.',
  );
}
