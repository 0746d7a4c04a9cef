// Makes the pictures of the viewer from real pages, in the folder SPRUNG_PICTURES of the environment: examples/view_pictures.sh.
import { join } from 'node:path';
import { test } from 'node:test';
import * as harness from './harness.mjs';

const folder = process.env.SPRUNG_PICTURES;
const viewport = { width: 1120, height: 700 };
/** Who makes pictures knows that there is something to drag. */
const before = () => localStorage.setItem('sprung-dragged', '');
/** After so long a pause [ms] the page tells no rate of frames, which is that of this machine. */
const still = 2500;

test('live', async () => {
  const server = await harness.view(harness.example('cloth_on_bunny'));
  const page = await harness.openPage(server.address, { viewport, before });
  await harness.firstFrame(page);
  // Off where there is no graphics card.
  await harness.control(page, 'view-shadows').check();
  await harness.control(page, 'view-occlusion').check();
  await harness.play(page);
  await harness.until(page, () => window.sprung.frame >= 22);
  await harness.pause(page);
  await page.waitForTimeout(still);
  await page.screenshot({ path: join(folder, 'view_live.png') });
  await harness.closePage(page);
});

test('two integrators', async () => {
  const server = await harness.view(harness.example('six_schemes'));
  const page = await harness.openPage(server.address, { viewport, before });
  await harness.firstFrame(page);
  await harness.pause(page);
  await harness.control(page, 'integrator').selectOption('explicit_euler');
  await harness.control(page, 'compare').selectOption('verlet');
  await harness.until(page, () => window.sprung.runs.length === 2);
  await harness.control(page, 'speed').selectOption('0.25');
  await harness.play(page);
  await harness.until(page, () => window.sprung.time >= 0.5);
  await harness.pause(page);
  await harness.control(page, 'fit').click();
  await page.waitForTimeout(still);
  await page.screenshot({ path: join(folder, 'view_two.png') });
  await harness.closePage(page);
});
