import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import * as harness from './harness.mjs';

const judge = process.env.SPRUNG_JUDGE;
const scene = harness.example('cloth_on_bunny');
const corner = 0;

/** A cloth that has come down on the bunny, in a run that is paused. */
async function openRestingCloth(options) {
  const server = await harness.view(scene);
  const page = await harness.openPage(server.address, options);
  await harness.firstFrame(page);
  await harness.pause(page);
  await harness.control(page, 'reset').click();
  await harness.until(page, () => window.sprung.frame === 1);
  const stepsPerFrame = await page.evaluate(() => window.sprung.runs[0].scene.steps_per_frame);
  const every = harness.control(page, 'every');
  await every.fill(String(40 * stepsPerFrame)); // drawn once
  await every.press('Enter');
  await harness.advance(page, 1);
  await every.fill('');
  await every.press('Enter');
  await page.locator('canvas').first().focus(); // keys are the canvas's, not the field's
  return page;
}

/** Moves the pointer in five steps, each followed by a frame. */
async function moveOverFiveFrames(page, from, to) {
  for (let k = 1; k <= 5; ++k) {
    await page.mouse.move(from.x + (k / 5) * (to.x - from.x), from.y + (k / 5) * (to.y - from.y));
    await harness.advance(page, 1);
  }
}

/** Collects the positions of each frame that the page shows, until `recorded` takes them. */
async function record(page) {
  await page.evaluate(() => {
    window.recorded = [];
    let last = -1;
    const look = () => {
      const [body] = Object.values(window.sprung.bodies);
      if (window.sprung.time !== last) window.recorded.push(Array.from(body.positions));
      last = window.sprung.time;
      requestAnimationFrame(look);
    };
    look();
  });
}

async function recorded(page) {
  return page.evaluate(() => window.recorded);
}

async function place(page, particle) {
  return page.evaluate((particle) => window.sprung.project(Object.keys(window.sprung.bodies)[0], particle), particle);
}

async function positionOf(page, particle) {
  return page.evaluate((particle) => {
    const [body] = Object.values(window.sprung.bodies);
    return Array.from(body.positions.slice(3 * particle, 3 * particle + 3));
  }, particle);
}

function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/** Fails if a frame has a particle in an obstacle or a triangle that meets one. */
function checkFrames(frames) {
  const file = join(harness.scratchFolder(), 'frames.f32');
  writeFileSync(file, Buffer.from(new Float32Array(frames.flat()).buffer));
  execFileSync(judge, [scene, file], { stdio: ['ignore', 'inherit', 'inherit'] });
}

test('a drag moves the cloth, and not through the bunny', async () => {
  const page = await openRestingCloth();
  const before = await positionOf(page, corner);
  const from = await place(page, corner);
  const across = { x: 500, y: 320 }; // so that the cloth between is pulled through the bunny unless contact prevents that
  const back = { x: 1000 - from.x, y: 600 };
  await record(page);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await moveOverFiveFrames(page, from, across);
  await harness.advance(page, 10);
  await moveOverFiveFrames(page, across, back);
  await harness.advance(page, 10);
  const after = await positionOf(page, corner);
  await page.mouse.up();
  await harness.advance(page, 5);
  const frames = await recorded(page);
  assert.ok(distance(before, after) > 0.05, `the corner moved by ${distance(before, after)} m`);
  assert.ok(frames.length > 30);
  checkFrames(frames);
  await harness.closePage(page);
});

test('Shift pins the particle where it is dropped, and a click releases it', async () => {
  const page = await openRestingCloth();
  const from = await place(page, corner);
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  await moveOverFiveFrames(page, from, { x: from.x, y: from.y - 120 });
  await harness.advance(page, 5);
  await page.keyboard.down('Shift');
  await page.mouse.up();
  await page.keyboard.up('Shift');
  await harness.advance(page, 3);
  const dropped = await harness.positions(page);
  await harness.advance(page, 15);
  const later = await harness.positions(page);
  // The pointer took the corner or a neighbour that hides it.
  const still = [...Array(dropped.length / 3).keys()].filter((i) => [0, 1, 2].every((d) => later[3 * i + d] === dropped[3 * i + d]));
  assert.equal(still.length, 1);
  const [particle] = still;
  const pinned = await positionOf(page, particle);
  // So that nothing hides it.
  for (const name of ['view-surface', 'view-obstacles']) await harness.control(page, name).uncheck();
  const pin = await place(page, particle);
  await page.mouse.click(pin.x, pin.y);
  await harness.advance(page, 20);
  assert.ok(distance(await positionOf(page, particle), pinned) > 0.01);
  await harness.closePage(page);
});

test('a finger drags a run that plays, as the mouse does', async () => {
  const page = await openRestingCloth({ hasTouch: true });
  const before = await positionOf(page, corner);
  const from = await place(page, corner);
  const client = await page.context().newCDPSession(page);
  const touch = (type, points) => client.send('Input.dispatchTouchEvent', { type, touchPoints: points });
  await touch('touchStart', [from]);
  await page.keyboard.press(' ');
  await harness.until(page, () => window.sprung.playing);
  for (let k = 1; k <= 10; ++k) {
    await touch('touchMove', [{ x: from.x, y: from.y - 12 * k }]);
    await harness.shown(page, 1);
  }
  await harness.shown(page, 15);
  const after = await positionOf(page, corner);
  await touch('touchEnd', []);
  assert.ok(after[1] > before[1] + 0.03, `the corner rose by ${after[1] - before[1]} m`);
  await harness.closePage(page);
});
