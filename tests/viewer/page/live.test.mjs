import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import * as harness from './harness.mjs';

async function openExample(name, options) {
  const server = await harness.view(harness.example(name));
  const page = await harness.openPage(server.address, options);
  await harness.firstFrame(page);
  return { server, page };
}

async function enter(field, value) {
  await field.fill(String(value));
  await field.press('Enter');
}

test('reset gives back the bits of the first frame', async () => {
  const { page } = await openExample('hanging_cloth');
  await harness.pause(page);
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.frame === 1);
  const first = await harness.positions(page);
  await harness.play(page);
  await harness.until(page, () => window.sprung.frame >= 5);
  await harness.pause(page);
  assert.notDeepEqual(await harness.positions(page), first);
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.frame === 1);
  assert.deepEqual(await harness.positions(page), first);
  await harness.closePage(page);
});

test('one step and one frame advance by their time and pause', async () => {
  const { page } = await openExample('lab_rope');
  await harness.play(page);
  await harness.control(page, 'step').click();
  await harness.until(page, () => !window.sprung.playing);
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.time === 0);
  await harness.control(page, 'step').click();
  await harness.until(page, () => window.sprung.time > 0);
  const { time, step, stepsPerFrame } = await page.evaluate(() => ({
    time: window.sprung.time,
    step: window.sprung.runs[0].scene.step,
    stepsPerFrame: window.sprung.runs[0].scene.steps_per_frame,
  }));
  assert.equal(time, step);
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.time === 0);
  await harness.control(page, 'single-frame').click();
  await harness.until(page, () => window.sprung.frame === 2);
  const frameTime = await page.evaluate(() => window.sprung.time);
  assert.ok(Math.abs(frameTime - step * stepsPerFrame) < 1e-12);
  await harness.closePage(page);
});

test('a change of the integrator begins anew with it', async () => {
  const { page } = await openExample('five_node_rope');
  await harness.play(page);
  await harness.until(page, () => window.sprung.frame >= 3);
  await harness.control(page, 'integrator').selectOption('symplectic_euler');
  await harness.until(page, () => window.sprung.runs[0].scene.integrator === 'symplectic_euler');
  await harness.until(page, () => window.sprung.frame >= 3);
  assert.equal(await harness.control(page, 'integrator').inputValue(), 'symplectic_euler');
  await harness.closePage(page);
});

test('gravity changes while the run goes on', async () => {
  const { page } = await openExample('lab_rope');
  await harness.play(page);
  await harness.until(page, () => window.sprung.frame >= 10);
  await enter(harness.control(page, 'gravity').locator('input').nth(1), 4);
  await harness.until(page, () => window.sprung.runs[0].scene.scene.gravity[1] === 4);
  assert.ok((await page.evaluate(() => window.sprung.frame)) >= 10);
  assert.equal(await page.evaluate(() => window.sprung.runs[0].scene.live), true);
  await harness.closePage(page);
});

test('a value that is refused is explained as sprung validate explains it', async () => {
  const { page } = await openExample('lab_rope');
  let expected = '';
  try {
    harness.sprung('validate', harness.example('lab_rope'), '--set', 'step=-1');
  } catch (error) {
    expected = error.message;
  }
  const rule = /must be ([^;\n]*)/.exec(expected)?.[1];
  assert.ok(rule, expected);
  await enter(harness.control(page, 'step-size'), -1);
  await page.getByText(rule).first().waitFor();
  await harness.until(page, () => window.sprung.frame >= 1);
  await harness.closePage(page);
});

test('a scene with a mistake shows it in place of the picture', async () => {
  const scene = JSON.parse(readFileSync(harness.example('hanging_cloth'), 'utf8'));
  scene.gravitee = [0, 1, 0];
  const file = join(harness.scratchFolder(), 'mistake.json');
  writeFileSync(file, JSON.stringify(scene));
  const server = await harness.view(file);
  const page = await harness.openPage(server.address);
  await page.getByText('gravitee').first().waitFor();
  await harness.closePage(page);
});

test('a browser without WebGL gets a sentence', async () => {
  const server = await harness.view(harness.example('hanging_cloth'));
  const before = () => {
    const { getContext } = HTMLCanvasElement.prototype;
    HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
      return kind.startsWith('webgl') ? null : getContext.call(this, kind, ...rest);
    };
  };
  const page = await harness.openPage(server.address, { before });
  await page.getByText('This browser has no WebGL').waitFor();
  await page.context().close(); // three has printed why there is no picture
});

test('two integrators run side by side', async () => {
  const { page } = await openExample('five_node_rope');
  await harness.control(page, 'compare').selectOption('explicit_euler');
  await harness.until(page, () => window.sprung.runs.length === 2);
  await harness.play(page);
  await harness.until(page, () => window.sprung.runs.every((run) => run.frame >= 4));
  await harness.pause(page);
  const [a, b] = await page.evaluate(() =>
    window.sprung.runs.map((run) => ({
      integrator: run.scene.integrator,
      positions: Object.values(run.bodies).flatMap((body) => Array.from(body.positions)),
    })),
  );
  assert.equal(a.integrator, 'verlet');
  assert.equal(b.integrator, 'explicit_euler');
  assert.ok(harness.largestDifference(a.positions, b.positions) > 1e-6);
  await harness.closePage(page);
});

test('a run that diverges shows why and offers a stable step', async () => {
  const { page } = await openExample('too_large_step_warned', { viewport: { width: 800, height: 500 } });
  await harness.control(page, 'speed').selectOption('0');
  await harness.play(page);
  const panel = harness.control(page, 'diverged');
  await panel.waitFor();
  assert.match(await panel.innerText(), /diverge|finite|energy/i);
  const picture = await page.locator('canvas').first().boundingBox();
  const { height } = await panel.boundingBox();
  assert.ok(height < 0.45 * picture.height, `the panel covers ${height} of ${picture.height} pixels`);
  const offered = /of (\S+) s/.exec(await harness.control(page, 'use-stable-step').innerText())[1];
  let advice = '';
  try {
    harness.sprung('validate', harness.example('too_large_step_warned'), '--set', 'stability=refuse');
  } catch (error) {
    advice = error.message;
  }
  const advised = /use a step of at most ([\d.e-]+)/.exec(advice)?.[1];
  assert.ok(Math.abs(Number(offered) - Number(advised)) < 1e-5 * Number(advised), `${offered} is not what it says: ${advice}`);
  await harness.control(page, 'use-stable-step').click();
  await harness.until(page, (step) => Math.abs(window.sprung.runs[0].scene.step - step) < 1e-2 * step, Number(advised));
  await panel.waitFor({ state: 'hidden' });
  await harness.closePage(page);
});

test('scenes that are opened one after the other leave no buffers behind', async () => {
  const { page } = await openExample('lab_rope');
  await page.evaluate(() => {
    window.buffers = 0;
    for (const [name, change] of [['createBuffer', 1], ['deleteBuffer', -1]]) {
      const call = WebGL2RenderingContext.prototype[name];
      WebGL2RenderingContext.prototype[name] = function (...values) {
        window.buffers += change;
        return call.apply(this, values);
      };
    }
  });
  const counts = [];
  for (let round = 0; round < 4; ++round) {
    for (const name of ['hanging_cloth', 'five_node_rope']) {
      await harness.control(page, 'example').selectOption(name);
      await harness.until(page, (title) => window.sprung.runs[0].scene.title === title && window.sprung.frame >= 3, `${name}.json`);
    }
    counts.push(await page.evaluate(() => window.buffers));
  }
  assert.equal(new Set(counts).size, 1, `${counts} buffers`);
  await harness.closePage(page);
});

test('keys play, step and move the view', async () => {
  const { page } = await openExample('lab_rope');
  await harness.pause(page);
  const canvas = page.locator('canvas').first();
  await canvas.focus();
  const before = await page.evaluate(() => ({
    frame: window.sprung.frame,
    at: window.sprung.project('rope', 0),
    generation: window.sprung.runs[0].scene.generation,
  }));
  await page.keyboard.press('.');
  await harness.until(page, (frame) => window.sprung.frame > frame, before.frame);
  await page.keyboard.press('ArrowLeft');
  await harness.until(page, (x) => Math.abs(window.sprung.project('rope', 0).x - x) > 1, before.at.x);
  await page.keyboard.press(' ');
  await harness.until(page, () => window.sprung.playing);
  await harness.control(page, 'color').focus();
  await page.keyboard.press('Tab');
  await page.keyboard.press('r');
  await harness.until(page, (generation) => window.sprung.runs[0].scene.generation > generation, before.generation);
  await page.keyboard.press(' '); // presses the button
  assert.ok(await page.evaluate(() => window.sprung.playing));
  await harness.closePage(page);
});

test('switches and plots are there, and the page draws what is switched', async () => {
  // Who has dragged before gets no hint over the picture.
  const { page } = await openExample('cloth_on_bunny', { before: () => localStorage.setItem('sprung-dragged', '') });
  for (const id of ['view', 'energy', 'stretch']) await harness.control(page, id).waitFor();
  await harness.pause(page);
  assert.ok((await harness.colourCount(page)) > 50);
  const boxes = harness.control(page, 'view').locator('input[type=checkbox]');
  for (let k = 0; k < (await boxes.count()); ++k) await boxes.nth(k).uncheck();
  await harness.drawn(page);
  assert.ok((await harness.colourCount(page)) < 5);
  await harness.closePage(page);
});

test('ten tabs show the same run, and closing them all pauses it', async () => {
  const server = await harness.view(harness.example('lab_rope'));
  const pages = [];
  for (let k = 0; k < 10; ++k) {
    pages.push(await harness.openPage(server.address, { viewport: { width: 400, height: 300 } }));
    await harness.firstFrame(pages[k]);
    // Few frames a second, as all ten are drawn by one processor.
    if (k === 0) await harness.control(pages[k], 'speed').selectOption('0.1');
  }
  await harness.play(pages[0]);
  for (const page of pages) await harness.until(page, () => window.sprung.playing && window.sprung.frame >= 5);
  await harness.pause(pages[9]);
  for (const page of pages) await harness.until(page, () => !window.sprung.playing);
  const last = await harness.positions(pages[9]);
  for (const page of pages) assert.deepEqual(await harness.positions(page), last);
  for (const page of pages.slice(1)) await harness.closePage(page);
  await harness.control(pages[0], 'speed').selectOption('0');
  await harness.play(pages[0]);
  await harness.closePage(pages[0]);
  await harness.idle(server);
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  assert.ok(await page.evaluate(() => window.sprung.playing));
  await harness.shown(page, 3);
  await harness.closePage(page);
});

test('a lost connection is shown and comes back by itself, after a restart too', async () => {
  const file = harness.example('lab_rope');
  const server = await harness.view(file, '--token', 'token-of-the-test');
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  assert.equal(await server.stop(), 0);
  await page.getByText('disconnected').first().waitFor();
  const again = await harness.view(file, '--token', 'token-of-the-test', '--port', server.port);
  await page.getByText('disconnected').first().waitFor({ state: 'hidden' });
  await harness.play(page);
  await harness.until(page, () => window.sprung.connected && window.sprung.frame >= 3);
  assert.equal(await again.stop(), 0);
  await page.context().close(); // the browser itself prints that connections are refused
});
