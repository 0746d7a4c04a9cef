// Starts the program and a real browser for the tests of the page.
import assert from 'node:assert/strict';
import { spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after } from 'node:test';

export const program = process.env.SPRUNG_PROGRAM;
export const sourceFolder = process.env.SPRUNG_SOURCE_DIR;
const meshes = process.env.SPRUNG_TEST_MESHES;
const { chromium } = createRequire(join(process.env.SPRUNG_PAGE_TEST_MODULES, 'any.js'))('playwright-core');

/**
 * Tests wait for frames and states of the page, however long these take on a busy machine. This limit [ms] only ends a test of a page
 * or program that hangs.
 */
export const patience = 600_000;

let browser;
const servers = new Set();
const folders = [];

after(async () => {
  await browser?.close();
  for (const server of servers) await server.stop();
  for (const folder of folders) rmSync(folder, { recursive: true, force: true });
});

export function example(name) {
  return join(sourceFolder, 'examples', `${name}.json`);
}

/** A new empty folder that is removed after the tests. */
export function scratchFolder() {
  const folder = mkdtempSync(join(tmpdir(), 'sprung-page-'));
  folders.push(folder);
  return folder;
}

/** Runs a command of the program and returns what it prints: results, then messages. Throws if the command fails. */
export function sprung(...command) {
  const run = spawnSync(program, [...command, '--mesh-path', meshes], { encoding: 'utf8' });
  const text = run.stdout + run.stderr;
  if (run.status !== 0) throw new Error(text);
  return text;
}

/** Starts `sprung view`; the address is known when this returns. */
export async function view(target, ...options) {
  const child = spawn(program, ['view', target, '--no-open', '--mesh-path', meshes, ...options], { stdio: ['ignore', 'pipe', 'pipe'] });
  let errors = '';
  child.stderr.on('data', (text) => (errors += text));
  const ended = new Promise((resolve) => child.on('exit', (code, signal) => resolve(code ?? signal)));
  const address = await new Promise((resolve, reject) => {
    let output = '';
    child.stdout.on('data', (text) => {
      output += text;
      if (output.includes('\n')) resolve(output.trim());
    });
    ended.then((code) => reject(new Error(`sprung view ended with ${code}: ${errors}`)));
  });
  const server = {
    address,
    port: new URL(address).port,
    pid: child.pid,
    /** Interrupts the program as Ctrl-C does, and returns its exit code. */
    async stop() {
      servers.delete(server);
      child.kill('SIGINT');
      return ended;
    },
  };
  servers.add(server);
  return server;
}

/** Opens an address in a tab of its own, where `before` runs first. `closePage` checks that the tab printed no error. */
export async function openPage(address, { viewport = { width: 1000, height: 640 }, hasTouch = false, before } = {}) {
  browser ??= await chromium.launch({
    executablePath: process.env.SPRUNG_CHROMIUM,
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
  });
  const context = await browser.newContext({ viewport, hasTouch, permissions: ['clipboard-read', 'clipboard-write'] });
  const page = await context.newPage();
  page.setDefaultTimeout(patience);
  page.complaints = [];
  page.on('console', (message) => {
    if (message.type() === 'error') page.complaints.push(message.text());
  });
  page.on('pageerror', (error) => page.complaints.push(String(error)));
  if (before) await page.addInitScript(before);
  await page.goto(address);
  return page;
}

/** Closes a page and fails if it printed an error. */
export async function closePage(page) {
  const complaints = page.complaints;
  await page.context().close();
  assert.deepEqual(complaints, []);
}

export function control(page, id) {
  return page.getByTestId(id);
}

/** Waits until `condition`, a function that runs in the page, is true. */
export async function until(page, condition, argument) {
  await page.waitForFunction(condition, argument, { timeout: patience, polling: 50 });
}

/** What the page knows of the run, whether it plays included, is there when this returns. */
export async function firstFrame(page) {
  await until(page, () => Object.keys(window.sprung?.bodies ?? {}).length > 0 && window.sprung.frame >= 1);
}

/** The positions of all bodies, flat, as numbers. */
export async function positions(page) {
  return page.evaluate(() => Object.values(window.sprung.bodies).flatMap((body) => Array.from(body.positions)));
}

export async function play(page) {
  if (!(await page.evaluate(() => window.sprung.playing))) await control(page, 'play').click();
  await until(page, () => window.sprung.playing);
}

export async function pause(page) {
  if (await page.evaluate(() => window.sprung.playing)) await control(page, 'play').click();
  await until(page, () => !window.sprung.playing);
}

/** Advances a run by so many frames, one after the other, and pauses it. */
export async function advance(page, count) {
  await page.evaluate(async (count) => {
    await new Promise(requestAnimationFrame); // in which the page sends where the pointer is
    for (let k = 0; k < count; ++k) {
      const { frame } = window.sprung;
      document.body.dispatchEvent(new KeyboardEvent('keydown', { key: '.', bubbles: true }));
      while (window.sprung.frame === frame) await new Promise(requestAnimationFrame);
    }
  }, count);
}

/** Waits until the page, which plays, has shown so many more frames. Of a run that is faster than the page, it misses some. */
export async function shown(page, count) {
  await page.evaluate(async (count) => {
    for (let k = 0; k < count; ++k) {
      const { frame } = window.sprung;
      while (window.sprung.frame === frame) await new Promise(requestAnimationFrame);
    }
  }, count);
}

/** Waits until the page has drawn what it knows now. */
export async function drawn(page) {
  await page.evaluate(async () => {
    for (let k = 0; k < 2; ++k) await new Promise(requestAnimationFrame);
  });
}

/** Waits until no thread of the program computes: in twenty looks in a row, all of them wait. */
export async function idle(server) {
  const tasks = `/proc/${server.pid}/task`;
  const waits = () => readdirSync(tasks).every((task) => /^\d+ \(.*\) S/s.test(readFileSync(`${tasks}/${task}/stat`, 'utf8')));
  for (let looks = 0; looks < 20; looks = waits() ? looks + 1 : 0) await new Promise((resolve) => setTimeout(resolve, 10));
}

export function largestDifference(a, b) {
  assert.equal(a.length, b.length);
  let largest = 0;
  for (let k = 0; k < a.length; ++k) largest = Math.max(largest, Math.abs(a[k] - b[k]));
  return largest;
}

/** The number of different colours in the picture without the texts at its edges: an empty one has few. */
export async function colourCount(page) {
  return (await pictureFacts(page)).colours;
}

/** Of the same part of the picture also the mean brightness, from 0 to 255. */
export async function pictureFacts(page) {
  const { x, y, width, height } = await page.locator('canvas').first().boundingBox();
  const clip = { x, y: y + 60, width, height: height - 140 };
  const picture = (await page.screenshot({ clip })).toString('base64');
  return page.evaluate(async (base64) => {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext('2d');
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const sum = data.reduce((total, value, k) => total + (k % 4 === 3 ? 0 : value), 0);
    return { colours: new Set(new Uint32Array(data.buffer)).size, brightness: sum / (0.75 * data.length) };
  }, picture);
}
