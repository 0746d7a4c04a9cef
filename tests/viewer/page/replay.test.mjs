import assert from 'node:assert/strict';
import { cpSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import * as harness from './harness.mjs';

const frames = 12;
const run = join(harness.scratchFolder(), 'run');
const exported = join(harness.scratchFolder(), 'animation.html');

before(() => {
  harness.sprung('run', harness.example('hanging_cloth'), '--out', run, '--frames', String(frames));
});

/** The numbers of the `v` lines of a frame. */
function objPositions(frame) {
  const [body] = Object.keys(JSON.parse(readFileSync(harness.example('hanging_cloth'), 'utf8')).bodies);
  const file = join(run, body, `${body}.${String(frame).padStart(4, '0')}.obj`);
  return readFileSync(file, 'utf8')
    .split('\n')
    .filter((line) => line.startsWith('v '))
    .flatMap((line) => line.slice(2).trim().split(/\s+/).map(Number));
}

async function show(page, frame) {
  await harness.control(page, 'frame').evaluate((slider, frame) => {
    slider.value = String(frame);
    slider.dispatchEvent(new Event('input', { bubbles: true }));
  }, frame);
  await harness.until(page, (frame) => window.sprung.frame === frame, frame);
}

test('a replay shows the positions of the OBJ files', async () => {
  const server = await harness.view(run);
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  await harness.pause(page);
  for (const frame of [1, 6, frames]) {
    await show(page, frame);
    assert.deepEqual(await harness.positions(page), Array.from(new Float32Array(objPositions(frame))));
  }
  assert.ok((await harness.colourCount(page)) >= 5);
  await harness.closePage(page);
});

test('a replay without diagnostics has no empty plots', async () => {
  const folder = join(harness.scratchFolder(), 'run');
  cpSync(run, folder, { recursive: true });
  rmSync(join(folder, 'diagnostics.csv'));
  for (const [shown, count] of [[run, 4], [folder, 0]]) {
    const server = await harness.view(shown);
    const page = await harness.openPage(server.address);
    await harness.firstFrame(page);
    await harness.until(page, (count) => [...document.querySelectorAll('.plot')].filter(({ hidden }) => !hidden).length === count, count);
    await harness.closePage(page);
  }
});

test('a replay plays and loops', async () => {
  const server = await harness.view(run);
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  await harness.play(page);
  await page.evaluate(() => {
    window.turns = 0;
    let last = window.sprung.frame;
    setInterval(() => {
      if (window.sprung.frame < last) ++window.turns;
      last = window.sprung.frame;
    }, 5);
  });
  await harness.until(page, () => window.turns >= 2);
  await harness.closePage(page);
});

test('an exported page shows the positions within its error, without a server', async () => {
  const message = harness.sprung('export', run, '--format', 'html', '--out', exported);
  const told = Number(/within ([0-9.e+-]+) m/.exec(message)?.[1]);
  assert.ok(told > 0 && told < 1e-4, message);
  const page = await harness.openPage(pathToFileURL(exported).href);
  const requests = [];
  page.on('request', (request) => requests.push(request.url()));
  await harness.firstFrame(page);
  await harness.pause(page);
  for (const frame of [1, 6, frames]) {
    await show(page, frame);
    const difference = harness.largestDifference(await harness.positions(page), objPositions(frame));
    // Shown in single precision, told with two digits.
    assert.ok(difference <= 1.05 * told + 1e-6, `frame ${frame} differs by ${difference} m`);
  }
  assert.ok((await harness.colourCount(page)) >= 5);
  assert.deepEqual(requests.filter((url) => !url.startsWith('blob:') && !url.startsWith('data:')), []);
  await harness.closePage(page);
});

test('an exported page shows no face that is torn', async () => {
  const folder = harness.scratchFolder();
  const cloth = {
    shape: { type: 'cloth', size: [1, 1], resolution: [5, 5] },
    mass: 1,
    place: { rotation: [-90, 0, 0] },
    springs: { structural: { stiffness: 200, damping: 0.1, break: 0.05 } },
    pins: [{ indices: [0, 1, 2, 3, 4] }],
  };
  writeFileSync(join(folder, 'scene.json'), JSON.stringify({ version: 1, duration: 1, step: 0.001, frame_rate: 25, bodies: { cloth } }));
  const torn = join(folder, 'run');
  harness.sprung('run', join(folder, 'scene.json'), '--out', torn, '--frames', '20');
  harness.sprung('export', torn, '--format', 'html', '--out', join(folder, 'torn.html'));
  const page = await harness.openPage(pathToFileURL(join(folder, 'torn.html')).href);
  await harness.firstFrame(page);
  await harness.pause(page);
  for (const frame of [20, 1]) {
    await show(page, frame);
    const file = join(torn, 'cloth', `cloth.${String(frame).padStart(4, '0')}.obj`);
    const faces = readFileSync(file, 'utf8').split('\n').filter((line) => line.startsWith('f '));
    const triangles = faces.map((face) => face.trim().split(/\s+/).length - 3).reduce((a, b) => a + b, 0);
    await harness.until(page, (count) => window.sprung.triangles === count, triangles);
    assert.ok(frame === 1 ? triangles === 32 : triangles < 32);
  }
  await harness.closePage(page);
});

test('a browser that cannot unpack an exported page says so', async () => {
  harness.sprung('export', run, '--format', 'html', '--overwrite', '--out', exported);
  const page = await harness.openPage(pathToFileURL(exported).href, { before: () => delete window.DecompressionStream });
  await page.getByText('Take a newer one').waitFor();
  await harness.closePage(page);
});
