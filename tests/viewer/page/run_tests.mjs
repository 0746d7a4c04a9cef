// Runs one file of tests of the page: run_tests.mjs FILE. Ends with 77, which ctest counts as skipped, where the browser or its
// driver is missing; with SPRUNG_NO_SKIPS in the environment this is a failure.
import { spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { join } from 'node:path';

function findChromium() {
  const folders = (process.env.PATH ?? '').split(':');
  return ['chromium', 'chromium-browser', 'google-chrome'].flatMap((name) => folders.map((folder) => join(folder, name))).find(existsSync);
}

const chromium = findChromium();
const missing = !chromium
  ? 'chromium is not installed: examples/install_packages.sh view-test'
  : !existsSync(join(process.env.SPRUNG_PAGE_TEST_MODULES, 'playwright-core'))
    ? 'npm could not install playwright-core'
    : '';
if (missing) {
  console.log(`Skipped: ${missing}`);
  process.exit(process.env.SPRUNG_NO_SKIPS ? 1 : 77);
}
const run = spawnSync(process.execPath, ['--test', process.argv[2]], {
  stdio: 'inherit',
  env: { ...process.env, SPRUNG_CHROMIUM: chromium },
});
process.exit(run.status ?? 1);
