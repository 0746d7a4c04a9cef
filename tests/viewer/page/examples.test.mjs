import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import * as harness from './harness.mjs';

const names = readdirSync(join(harness.sourceFolder, 'examples'))
  .filter((file) => file.endsWith('.json'))
  .map((file) => file.slice(0, -'.json'.length));
const refused = 'too_large_step';

test('the menu opens every example, and it moves', async () => {
  const server = await harness.view(harness.example('hanging_cloth'));
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  await harness.pause(page);
  for (const name of names.filter((name) => name !== refused)) {
    await harness.control(page, 'example').selectOption(name);
    await harness.until(page, (name) => window.sprung.title === `${name}.json` && window.sprung.frame === 1, name);
    assert.ok((await harness.colourCount(page)) >= 5, `${name} has an empty picture`);
    const first = await harness.positions(page);
    await harness.play(page);
    await harness.until(page, () => window.sprung.frame >= 3);
    await harness.pause(page);
    const later = await harness.positions(page);
    assert.ok(harness.largestDifference(first, later) > 1e-6, `${name} does not move`);
  }
  await harness.closePage(page);
});

test('the gallery tells each example in a sentence, shows its picture and opens it', async () => {
  const server = await harness.view(harness.example('hanging_cloth'));
  const page = await harness.openPage(server.address, { viewport: { width: 800, height: 500 } });
  await harness.firstFrame(page);
  if (!(await harness.control(page, 'browse').isVisible())) await page.keyboard.press('p');
  await harness.control(page, 'browse').click();
  const withoutPicture = ['materials', 'six_schemes', refused];
  for (const name of names) {
    const card = harness.control(page, `card-${name}`);
    if (name !== refused) assert.ok((await card.innerText()).length > name.length + 10, name);
    const drawn = (name) => document.querySelector(`[data-testid="card-${name}"] img`).naturalWidth > 0;
    if (!withoutPicture.includes(name)) await harness.until(page, drawn, name);
  }
  await harness.control(page, 'card-two_masses').click();
  await harness.until(page, () => window.sprung.title === 'two_masses.json');
  assert.equal(await harness.control(page, 'example').inputValue(), 'two_masses');
  await harness.closePage(page);
});

test('an example that is refused says why and leaves the one before', async () => {
  const server = await harness.view(harness.example('hanging_cloth'));
  const page = await harness.openPage(server.address);
  await harness.firstFrame(page);
  await harness.control(page, 'example').selectOption(refused);
  await harness.until(page, () => window.sprung.problems.length > 0);
  const problems = await page.evaluate(() => window.sprung.problems.join('\n'));
  assert.match(problems, /step/);
  await harness.play(page);
  await harness.until(page, () => window.sprung.frame >= 3);
  await harness.closePage(page);
});
