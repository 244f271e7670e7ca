// Runs the mocha tests inside the real extension host. The page only starts the host; the tests write their
// verdict into a file.
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { address, extension, given, launchBrowser, profile, remote, results, startWorkbench } from './workbench.mjs';

/** Only a hang lets this pass. */
const LIMIT_MS = 280_000;
const verdict = path.join(results, 'in-host.json');
const own = profile();
const { base, stop } = await startWorkbench(own, {
  args: (port) => [
    given('APT_HOST_SERVER'), '--accept-server-license-terms', '--without-connection-token', '--disable-telemetry',
    '--disable-workspace-trust', '--enable-smoke-test-driver', // newer workbenches heed the test options only with it
    '--host', '127.0.0.1', '--port', String(port), '--server-data-dir', path.join(own.folder, 'server'), ...own.switches,
  ],
  readyPath: '/version',
  log: 'in-host-server.log',
  environment: { APT_HOST_VERDICT: verdict },
});
const browser = await launchBrowser();
const page = await browser.newPage();
const seen = [];
page.on('console', (message) => seen.push(message.text()));
await page.goto(address(base, own.workspace, [
  ['extensionDevelopmentPath', remote(base, extension)],
  ['extensionTestsPath', remote(base, path.join(extension, 'dist/test/index.js'))],
]));
for (const end = Date.now() + LIMIT_MS; !existsSync(verdict) && Date.now() < end; ) {
  await new Promise((resolve) => setTimeout(resolve, 100));
}
await browser.close();
stop();
own.remove();
if (!existsSync(verdict)) {
  console.error(`${seen.join('\n')}\nthe tests never ran`);
  process.exit(2);
}
const { crash, tests } = JSON.parse(readFileSync(verdict, 'utf8'));
if (crash !== undefined) {
  console.log(crash);
}
for (const test of tests) {
  console.log(test.error === undefined ? `ok   ${test.title} (${test.ms} ms)` : `FAIL ${test.title}\n${test.error}`);
}
const failed = tests.filter((test) => test.error !== undefined).length;
console.log(`in the extension host: ${tests.length - failed} passed, ${failed} failed`);
process.exit(crash !== undefined || failed > 0 || tests.length === 0 ? 1 : 0);
