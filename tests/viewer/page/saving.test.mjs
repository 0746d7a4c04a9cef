// What a page saves through the program.
import assert from 'node:assert/strict';
import { copyFileSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import * as harness from './harness.mjs';

/** A copy of an example in a folder of its own, paused. */
async function openCopy() {
  const folder = harness.scratchFolder();
  copyFileSync(harness.example('lab_rope'), join(folder, 'rope.json'));
  const server = await harness.view(join(folder, 'rope.json'));
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  await harness.pause(page);
  await page.locator('summary', { hasText: 'Save' }).click();
  return { folder, page };
}

test('a run is saved beside its scene, as a folder and as a page that show what was shown', async () => {
  const { folder, page } = await openCopy();
  await harness.advance(page, 5);
  const [frame, last] = [await page.evaluate(() => window.sprung.frame), await harness.positions(page)];
  await harness.control(page, 'save-run').click();
  await harness.control(page, 'saved').getByText('rope_1').waitFor();
  assert.equal(await harness.control(page, 'save-name').inputValue(), 'rope_2');
  await harness.control(page, 'gravity').locator('input').nth(1).fill('-9');
  await harness.control(page, 'gravity').locator('input').nth(1).press('Enter');
  await harness.until(page, () => window.sprung.runs[0].scene.scene.gravity[1] === -9);
  assert.equal(await harness.control(page, 'save-name').inputValue(), 'rope_2');
  await harness.control(page, 'save-page').click();
  await harness.control(page, 'saved').getByText('rope_2.html').waitFor();
  await harness.control(page, 'save-name').fill('rope_1');
  await harness.control(page, 'save-run').click();
  await harness.control(page, 'saved').getByText('is taken').waitFor();
  assert.deepEqual(readdirSync(folder).sort(), ['rope.json', 'rope_1', 'rope_2.html']);
  await harness.closePage(page);
  const server = await harness.view(join(folder, 'rope_1'));
  for (const [address, rounding] of [[server.address, 0], [pathToFileURL(join(folder, 'rope_2.html')).href, 1e-3]]) {
    const replay = await harness.openPage(address);
    await harness.firstFrame(replay);
    await harness.pause(replay);
    await harness.control(replay, 'frame').fill(String(frame));
    await harness.until(replay, (frame) => window.sprung.frame === frame, frame);
    assert.ok(harness.largestDifference(await harness.positions(replay), last) <= rounding, address);
    await harness.closePage(replay);
  }
});

test('a copied scene with the present state begins from it', async () => {
  const { folder, page } = await openCopy();
  await harness.advance(page, 5);
  const last = await harness.positions(page);
  await harness.control(page, 'with-state').check();
  await harness.control(page, 'copy-scene').click();
  await page.getByText('Copied').waitFor();
  const copied = JSON.parse(await page.evaluate(() => navigator.clipboard.readText()));
  assert.equal(copied.initial_state, 'rope_1');
  assert.match(harness.sprung('validate', join(folder, 'rope.json'), '--set', 'initial_state="rope_1"'), /particles/);
  await harness.closePage(page);
  const server = await harness.view(join(folder, 'rope.json'), '--set', 'initial_state="rope_1"');
  const begun = await harness.openPage(server.address);
  await harness.firstFrame(begun);
  await harness.pause(begun);
  await harness.control(begun, 'reset').click();
  await harness.until(begun, () => window.sprung.frame === 1);
  assert.deepEqual(await harness.positions(begun), last);
  await harness.closePage(begun);
});

test('two runs side by side are saved both, the second under the name of its integrator too', async () => {
  const { folder, page } = await openCopy();
  await harness.control(page, 'compare').selectOption('implicit_euler');
  await harness.until(page, () => window.sprung.runs.length === 2);
  await harness.advance(page, 2);
  await harness.control(page, 'save-run').click();
  await harness.control(page, 'saved').getByText('rope_1_implicit_euler').waitFor();
  await harness.control(page, 'save-name').fill('');
  await harness.control(page, 'save-run').click();
  await harness.control(page, 'saved').getByText('must be 1 to 64 letters').waitFor();
  assert.deepEqual(readdirSync(folder).sort(), ['rope.json', 'rope_1', 'rope_1_implicit_euler']);
  const { scene } = JSON.parse(readFileSync(join(folder, 'rope_1_implicit_euler', 'run.json'), 'utf8'));
  assert.equal(scene.integrator.type, 'implicit_euler');
  await harness.closePage(page);
});
