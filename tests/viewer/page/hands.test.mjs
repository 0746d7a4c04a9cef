// What a user changes and sees besides the run itself.
import assert from 'node:assert/strict';
import { copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import * as harness from './harness.mjs';

async function openExample(name, options) {
  const server = await harness.view(harness.example(name));
  const page = await harness.openPage(server.address, options);
  await harness.firstFrame(page);
  await harness.pause(page);
  return { server, page };
}

async function enter(field, value) {
  await field.fill(String(value));
  await field.press('Enter');
}

async function pinCount(page) {
  return page.evaluate(() => window.sprung.runs[0].states.filter((state) => state & 2).length);
}

/** Pulls a particle upwards and pins it there. */
async function pinByHand(page, body, particle) {
  const at = await page.evaluate(([body, particle]) => window.sprung.project(body, particle), [body, particle]);
  await page.mouse.move(at.x, at.y);
  await page.mouse.down();
  await page.mouse.move(at.x + 20, at.y - 30, { steps: 3 });
  await page.keyboard.down('Shift');
  await page.mouse.up();
  await page.keyboard.up('Shift');
}

test('the scale of colours follows values down, contains the limit, and is one for two runs', async () => {
  const { page } = await openExample('hanging_cloth');
  await harness.control(page, 'color').selectOption('speed');
  await harness.control(page, 'speed').selectOption('0');
  await harness.play(page);
  await harness.until(page, () => window.sprung.scale >= 0.5);
  await harness.control(page, 'reset').click();
  await harness.pause(page);
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.frame === 1 && window.sprung.scale <= 0.01);
  await harness.control(page, 'color').selectOption('stretch');
  await harness.drawn(page);
  const limit = await page.evaluate(() => window.sprung.runs[0].scene.scene.stretch_limit.max_stretch);
  assert.ok((await page.evaluate(() => window.sprung.scale)) >= limit);
  await page.locator('#legend .limit').waitFor();
  await harness.control(page, 'compare').selectOption('implicit_euler');
  await harness.until(page, () => window.sprung.runs.length === 2);
  await harness.drawn(page);
  assert.equal(await page.locator('#legend .scale').count(), 1);
  await harness.closePage(page);
});

test('a step that divides no frame is snapped with a sentence, and a smaller one applies live', async () => {
  const { page } = await openExample('flag_in_gusts');
  await harness.advance(page, 3);
  await harness.control(page, 'unstable').check();
  await harness.until(page, () => window.sprung.runs[0].scene.scene.stability === 'warn');
  for (const [wish, count] of [[0.001, 33], [0.0005, 67], [0.05, 1]]) {
    await enter(harness.control(page, 'step-size'), wish);
    await harness.until(page, (count) => window.sprung.runs[0].scene.steps_per_frame === count, count);
    assert.match(await page.locator('#settings .note:visible').innerText(), /does not divide a frame of 1\/30 s/);
    assert.equal(await page.evaluate(() => window.sprung.runs[0].scene.live), true);
    assert.ok((await page.evaluate(() => window.sprung.frame)) >= 4);
  }
  await harness.closePage(page);
});

test('a refused value shows the rule alone', async () => {
  const { page } = await openExample('lab_rope');
  await enter(harness.control(page, 'drag'), -1);
  const problem = page.locator('#settings .problem:visible');
  await problem.waitFor();
  assert.doesNotMatch(await problem.innerText(), /json|--set|must be/);
  await harness.closePage(page);
});

test('pins of the hand survive a reset, a restart and a comparison, and are in the copied scene', async () => {
  const { page } = await openExample('hanging_cloth');
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.frame === 1);
  const before = await pinCount(page);
  await pinByHand(page, 'cloth', 500);
  await harness.advance(page, 1);
  assert.equal(await pinCount(page), before + 1);
  await harness.control(page, 'copy-scene').evaluate((button) => button.click());
  await page.getByText('Copied').waitFor({ state: 'attached' });
  const copied = JSON.parse(await page.evaluate(() => navigator.clipboard.readText()));
  assert.equal(copied.bodies.cloth.pins.at(-1).indices.length, 1);
  const generation = await page.evaluate(() => window.sprung.runs[0].scene.generation);
  await harness.control(page, 'reset').click();
  await harness.until(page, (generation) => window.sprung.runs[0].scene.generation > generation, generation);
  assert.equal(await pinCount(page), before + 1);
  await harness.control(page, 'integrator').selectOption('symplectic_euler');
  await harness.until(page, () => window.sprung.runs[0].scene.integrator === 'symplectic_euler');
  assert.equal(await pinCount(page), before + 1);
  await harness.control(page, 'compare').selectOption('verlet');
  await harness.until(page, () => window.sprung.runs.length === 2);
  const second = await page.evaluate(() => window.sprung.runs[1].states.filter((state) => state & 2).length);
  assert.equal(second, before + 1);
  await harness.closePage(page);
});

test('a scene that is saved in an editor begins anew, and mistakes show until they are mended', async () => {
  const file = join(harness.scratchFolder(), 'scene.json');
  copyFileSync(harness.example('lab_rope'), file);
  const server = await harness.view(file);
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  const scene = JSON.parse(readFileSync(file, 'utf8'));
  await harness.drawn(page);
  await page.waitForTimeout(1000); // the program has looked at the file
  writeFileSync(file, JSON.stringify({ ...scene, gravity: [0, -1, 0] }));
  await harness.until(page, () => window.sprung.runs[0].scene.scene.gravity[1] === -1);
  await page.getByText('has changed and begins anew').first().waitFor();
  writeFileSync(file, JSON.stringify({ ...scene, gravitee: 1 }));
  await page.getByText('gravitee').first().waitFor();
  writeFileSync(file, JSON.stringify(scene));
  await harness.until(page, () => window.sprung.runs[0].scene.scene.gravity[1] === -9.81 && window.sprung.problems.length === 0);
  await page.getByText('gravitee').first().waitFor({ state: 'hidden' });
  await harness.closePage(page);
});

test('the menu offers scenes alone, lessons with their text, and agrees with the title after a refusal', async () => {
  const folder = harness.scratchFolder();
  copyFileSync(harness.example('lab_rope'), join(folder, 'rope.json'));
  copyFileSync(harness.example('too_large_step'), join(folder, 'refused.json'));
  writeFileSync(join(folder, 'package.json'), '{"name": "no scene"}');
  const server = await harness.view(join(folder, 'rope.json'));
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  const menu = harness.control(page, 'example');
  assert.deepEqual(await menu.locator('option').evaluateAll((options) => options.map(({ value }) => value)), ['', 'refused', 'rope']);
  assert.equal(await menu.inputValue(), 'rope');
  await menu.selectOption('refused');
  await harness.until(page, () => window.sprung.problems.length > 0);
  assert.equal(await menu.inputValue(), 'rope');
  await harness.closePage(page);
  const { page: other } = await openExample('two_masses');
  await harness.control(other, 'example').selectOption('lessons/3_damping');
  await harness.control(other, 'lesson').getByText('3. Damping').waitFor();
  await harness.closePage(other);
});

test('Space plays after a click on a control, presses one that was reached by Tab, and ? shows the keys', async () => {
  const { page } = await openExample('lab_rope');
  await harness.control(page, 'theme').click();
  await page.keyboard.press(' ');
  await harness.until(page, () => window.sprung.playing);
  await page.keyboard.press('?');
  await harness.control(page, 'keys-dialog').waitFor();
  await page.keyboard.press('Escape');
  await harness.control(page, 'keys-dialog').waitFor({ state: 'hidden' });
  await harness.closePage(page);
});

test('the panel folds by its key and by itself on a small screen, where nothing is cut', async () => {
  const { page } = await openExample('lab_rope');
  const panel = page.locator('aside');
  await panel.waitFor();
  await page.keyboard.press('p');
  await panel.waitFor({ state: 'hidden' });
  await page.setViewportSize({ width: 1100, height: 600 });
  for (const width of [800, 500, 320]) {
    await page.setViewportSize({ width, height: 480 });
    await harness.drawn(page);
    const { header, scroll } = await page.evaluate(() => ({
      header: [...document.querySelectorAll('header button')].filter((b) => b.offsetParent).map((b) => b.getBoundingClientRect().right),
      scroll: document.documentElement.scrollWidth,
    }));
    assert.ok(Math.max(...header) <= width && scroll <= width, `${width} pixels: ${header}, ${scroll}`);
    assert.ok((await page.locator('header').boundingBox()).height < 50);
  }
  await panel.waitFor({ state: 'hidden' });
  await harness.closePage(page);
});

test('the picture is fitted again when the window changes, unless the user moved the camera', async () => {
  const { page } = await openExample('lab_rope');
  const middle = () => page.evaluate(() => window.sprung.project('rope', 0).x / document.querySelector('canvas').clientWidth);
  const before = await page.evaluate(() => window.sprung.project('rope', 0));
  await page.setViewportSize({ width: 700, height: 640 });
  await harness.drawn(page);
  const narrow = await page.evaluate(() => window.sprung.project('rope', 0));
  assert.ok(narrow.x >= 0 && narrow.x <= 700 && (await middle()) < 1, JSON.stringify([before, narrow]));
  await harness.control(page, 'panel-toggle').click();
  await harness.control(page, 'top').click();
  await harness.drawn(page);
  await harness.closePage(page);
});

test('a mass that leaves the picture by itself stays in sight until the camera is moved', async () => {
  const { page } = await openExample('two_masses', { viewport: { width: 800, height: 500 } });
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.frame === 1);
  const bottom = () => page.evaluate(() => window.sprung.project('masses', 1).y - document.querySelector('canvas').getBoundingClientRect().bottom);
  let longest = 0;
  for (let frame = 0; frame < 10; ++frame) {
    await harness.advance(page, 1);
    await harness.drawn(page);
    longest = Math.min(longest, await page.evaluate(() => window.sprung.bodies.masses.positions[4]));
    assert.ok((await bottom()) < 0, `frame ${frame}`);
  }
  assert.ok(longest < -1.7, 'it swings out'); // from -1, about m g / k = 0.49 m deeper
  await harness.closePage(page);
});

test('a click shows the numbers of a particle, a drag hides the hint and shows its force', async () => {
  const { page } = await openExample('lab_rope');
  await harness.control(page, 'hint').waitFor();
  const at = await page.evaluate(() => window.sprung.project('rope', 5));
  await page.mouse.click(at.x, at.y);
  await harness.control(page, 'selection').getByText('position').waitFor();
  await harness.control(page, 'selection').getByText(/structural spring to rope \d+/).waitFor();
  await harness.control(page, 'selection').getByText(/tension \S+ N/).waitFor();
  const now = await page.evaluate(() => window.sprung.project('rope', 5));
  await page.mouse.move(now.x, now.y);
  await page.mouse.down();
  await page.mouse.move(now.x + 60, now.y + 40, { steps: 3 });
  await harness.control(page, 'hint').waitFor({ state: 'hidden' });
  await harness.advance(page, 2);
  await harness.control(page, 'pull-force').getByText(/\d N/).waitFor();
  await page.mouse.up();
  await harness.control(page, 'pull-force').waitFor({ state: 'hidden' });
  await harness.closePage(page);
});

test('a click between two particles selects their spring, with the tension that its stretch gives', async () => {
  const { page } = await openExample('two_masses');
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.frame === 1);
  await harness.advance(page, 10);
  const [body] = await page.evaluate(() => Object.keys(window.sprung.bodies));
  const [a, b] = await page.evaluate((body) => [0, 1].map((k) => window.sprung.project(body, k)), body);
  await page.mouse.click((a.x + b.x) / 2 + 2, (a.y + b.y) / 2 + 2);
  const selection = harness.control(page, 'selection');
  await selection.getByText(/tension \S+ N/).waitFor();
  const text = await selection.innerText();
  const { stiffness, rest } = await page.evaluate((body) => {
    const { springs, shape } = window.sprung.runs[0].scene.scene.bodies[body];
    return { stiffness: springs.structural.stiffness, rest: Math.hypot(...shape.from.map((value, d) => value - shape.to[d])) };
  }, body);
  const stretch = Number(/stretch (\S+) %/.exec(text)[1]) / 100;
  const tension = Number(/tension (\S+) N/.exec(text)[1]);
  assert.ok(tension > 0 && Math.abs(tension - stiffness * rest * stretch) < 0.02 * tension, text); // of three digits each
  await harness.closePage(page);
});

test('a program that has ended greys the controls, and an old address says so', async () => {
  const file = harness.example('lab_rope');
  const server = await harness.view(file, '--token', 'first');
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  await server.stop();
  await harness.control(page, 'ended').getByText('The program has ended').waitFor();
  assert.ok(await page.evaluate(() => document.querySelector('[data-testid=play]').closest('[inert]') !== null));
  const again = await harness.view(file, '--token', 'second', '--port', server.port);
  await harness.control(page, 'ended').getByText('open the new address').waitFor();
  await again.stop();
  await page.context().close(); // the browser itself prints that connections are refused
});

test('at most three curves are drawn until more are asked for, and a plot tells the value under the pointer', async () => {
  const { page } = await openExample('lab_rope');
  await harness.advance(page, 5);
  const pressed = () => page.locator('[data-testid=energy] .plot-key[aria-pressed=true]').count();
  assert.equal(await pressed(), 3);
  await harness.control(page, 'energy-gravity').click();
  assert.equal(await pressed(), 4);
  const value = harness.control(page, 'energy').locator('output').first();
  const last = await value.innerText();
  const box = await harness.control(page, 'energy').locator('canvas').boundingBox();
  await page.mouse.move(box.x + 42, box.y + 20);
  await harness.until(page, (last) => document.querySelector('[data-testid=energy] output').textContent !== last, last);
  await harness.closePage(page);
});

test('the last seconds of a live run can be looked back at, and the run goes on from there', async () => {
  const { page } = await openExample('lab_rope');
  await harness.advance(page, 20);
  const last = await page.evaluate(() => window.sprung.frame);
  const box = await harness.control(page, 'energy').locator('canvas').boundingBox();
  await page.mouse.click(box.x + box.width / 2, box.y + 30);
  await harness.until(page, (last) => window.sprung.frame < last - 3, last);
  const past = await page.evaluate(() => window.sprung.frame);
  await page.keyboard.press('.');
  await harness.until(page, (past) => window.sprung.frame === past + 1, past);
  await harness.advance(page, 2);
  assert.equal(await page.evaluate(() => window.sprung.frame), past + 3);
  await harness.closePage(page);
});

test('forces of contact of a body at rest carry its weight, are shown as arrows, and recorded runs do not offer them', async () => {
  const folder = harness.scratchFolder();
  const file = join(folder, 'cube.json');
  writeFileSync(file, JSON.stringify({
    duration: 3,
    bodies: { cube: { shape: { type: 'solid', size: [0.3, 0.3, 0.3], resolution: [4, 4, 4] }, material: 'foam', mass: 0.5, place: { position: [0, 0.17, 0] } } },
    obstacles: { floor: { shape: { type: 'half_space', normal: [0, 1, 0], offset: 0 }, friction: 0.5 } },
  }));
  const server = await harness.view(file);
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  await harness.control(page, 'speed').selectOption('0');
  await harness.play(page);
  await harness.until(page, () => window.sprung.time > 3);
  await harness.pause(page);
  const forces = await page.evaluate(() => Array.from(window.sprung.runs[0].contactForces));
  const sum = [0, 1, 2].map((d) => forces.filter((_, k) => k % 3 === d).reduce((total, force) => total + force, 0));
  // A body falls asleep while it still moves a little.
  assert.ok(Math.abs(sum[1] - 0.5 * 9.81) < 0.05 * 0.5 * 9.81, `${sum}`);
  await harness.control(page, 'view-forces').check();
  await page.getByText(/largest force [\d.]+ N/).waitFor();
  await harness.closePage(page);
  harness.sprung('run', file, '--out', join(folder, 'run'), '--frames', '2');
  const replay = await harness.view(join(folder, 'run'));
  const second = await harness.openPage(replay.address);
  await harness.firstFrame(second);
  await harness.control(second, 'view-forces').waitFor({ state: 'hidden' });
  await harness.closePage(second);
});

test('occlusion darkens the picture, and nothing else changes it', async () => {
  const { page } = await openExample('jelly_on_stairs');
  const facts = async (on) => {
    await harness.control(page, 'view-occlusion').setChecked(on);
    await harness.drawn(page);
    return harness.pictureFacts(page);
  };
  const plain = await facts(false);
  const occluded = await facts(true);
  assert.ok(occluded.brightness < plain.brightness - 0.1, `${occluded.brightness} of ${plain.brightness}`);
  assert.ok(occluded.brightness > 0.8 * plain.brightness);
  assert.deepEqual(await facts(false), plain);
  await harness.closePage(page);
});
