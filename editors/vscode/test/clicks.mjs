// What a person sees: the packaged extension in the workbench, clicked through in a browser.
import path from 'node:path';
import { address, given, launchBrowser, profile, remote, results, runHost, startWorkbench } from './workbench.mjs';

const own = profile();
await runHost([given('APT_HOST_ENTRY'), ...own.switches, '--config', path.join(own.folder, 'none.yaml'),
  '--install-extension', given('APT_VSIX')], own);
const { base, stop } = await startWorkbench(own, {
  args: (port) => [
    given('APT_HOST_ENTRY'), ...own.switches, '--config', path.join(own.folder, 'none.yaml'), '--auth', 'none',
    '--bind-addr', `127.0.0.1:${port}`, '--disable-telemetry', '--disable-update-check', '--disable-workspace-trust',
    '--disable-getting-started-override',
  ],
  readyPath: '/healthz',
  log: 'clicks-server.log',
});
const browser = await launchBrowser();
const page = await (await browser.newContext({ viewport: { width: 1400, height: 900 } })).newPage();
// Only a hang lets this pass: the tests wait for what shall be seen, however busy the machine is.
page.setDefaultTimeout(100_000);
/** Times that the mouse comes to a word for its hover. */
const HOVER_ATTEMPTS = 15;
let shots = 0;
/** A picture for people; no test depends on one. */
const shot = (name) => page.screenshot({ path: path.join(results, `${++shots}-${name}.png`) })
  .catch((error) => console.log(`no picture of ${name}: ${error.message.split('\n')[0]}`));
/** The text of an element as it is read: blanks of the page are of the no-break kind. */
const read = async (locator) => (await locator.innerText()).replaceAll('\u00a0', ' ');

async function palette(prefix, text) {
  await page.keyboard.press('F1');
  const input = page.locator('.quick-input-widget input[type=text]');
  await input.waitFor();
  await input.fill(prefix + text);
  await page.locator('.quick-input-list .monaco-list-row', { hasText: text }).first().waitFor();
  await page.keyboard.press('Enter');
}

const openFile = async (name) => {
  await page.keyboard.press('Control+1');
  await palette('', name);
  await page.locator('.editor-group-container.active .tab.active', { hasText: name }).waitFor();
};

/** The lines of the editor whose tab has this name. */
const editorOf = (tab) => page.locator('.editor-group-container', { has: page.locator('.tab.active', { hasText: tab }) });
const lineWith = (tab, text) => editorOf(tab).locator('.view-line', { hasText: text }).first();

const tests = {
  'shows a mistake: squiggle and Problems': async () => {
    await page.locator('.squiggly-error').first().waitFor();
    await palette('>', 'Problems: Focus on Problems View');
    const row = page.locator('.markers-panel .monaco-list-row', { hasText: 'P9' }).first();
    await row.waitFor();
    if (!/\[Ln 4, Col \d+\]/.test(await read(row))) {
      throw new Error(`not in line 4: ${await read(row)}`);
    }
    await shot('mistake');
    await page.keyboard.press('Control+j');
    await page.locator('.markers-panel').waitFor({ state: 'hidden' });
  },
  'shows a hover with the canonical form': async () => {
    await openFile('bracket.apt');
    const line = lineWith('bracket.apt', 'GORGT');
    await line.waitFor();
    const hover = page.locator('.monaco-hover', { hasText: 'CIRCLE' });
    // A layout that is still moving takes a hover away again: the mouse comes back until it stays.
    for (let attempt = 1; ; attempt += 1) {
      await page.mouse.move(700, 20);
      await line.getByText('C1').last().hover();
      try {
        await hover.first().waitFor({ timeout: 5_000 });
        break;
      } catch (error) {
        if (attempt === HOVER_ATTEMPTS) {
          throw error;
        }
      }
    }
    const text = await read(hover.first());
    if (!/C1/.test(text) || !/radius 2\b/.test(text)) {
      throw new Error(`no canonical form: ${text}`);
    }
    await shot('hover');
    await page.keyboard.press('Escape');
  },
  'shows the expansion of macros and loops': async () => {
    await openFile('bracket.apt');
    await palette('>', 'APT: Show Expansion');
    await lineWith('bracket expanded.apt', 'GOTO').waitFor();
    const text = await read(editorOf('bracket expanded.apt').locator('.view-lines'));
    const lines = text.split('\n').filter((line) => line.includes('GOTO'));
    // Two calls of the macro with their arguments, three turns of the loop.
    for (const [expected, times] of [[/GOTO ?\/ ?6, ?1, ?1/, 1], [/GOTO ?\/ ?7, ?2, ?1/, 1], [/GOTO ?\/ ?8,/, 3]]) {
      if (lines.filter((line) => expected.test(line)).length !== times) {
        throw new Error(`not ${times} of ${expected} in\n${text}`);
      }
    }
    await shot('expansion');
  },
  'runs motion from the code lens to verified CL points': async () => {
    await openFile('bracket.apt');
    await page.keyboard.press('Control+Home');
    const lens = editorOf('bracket.apt').locator('.codelens-decoration a', { hasText: /run motion/i }).first();
    await lens.waitFor();
    await lens.click();
    await lineWith('bracket motion.txt', /\b([1-9]\d*)\s+of\s+\1\s+motions\s+verified/).waitFor();
    // Only the lines on the screen are in the page.
    await lineWith('bracket motion.txt', 'CL points').waitFor();
    // The verdict behind the statement is drawn by a style: it is no text of the page.
    await page.waitForFunction(() =>
      [...document.querySelectorAll('.view-line span')].some((span) =>
        getComputedStyle(span, '::after').content.includes('✓')));
    const text = await read(editorOf('bracket motion.txt').locator('.view-lines'));
    if (!/3\.000000 +-2\.000000/.test(text)) {
      throw new Error(`no starting point in\n${text}`);
    }
    await shot('motion');
  },
  'shows the CL file': async () => {
    await openFile('bracket.apt');
    await palette('>', 'APT: Show CL File');
    await lineWith('bracket.cl', 'FROM/3').waitFor();
    await shot('cl-file');
  },
};

let failed = 0;
try {
  const sample = path.join(own.workspace, 'mistake.apt');
  await page.goto(address(base, own.workspace, [['openFile', remote(base, sample)]]));
  await page.locator('.monaco-workbench').waitFor({ timeout: 60_000 });
  await page.locator('.monaco-editor .view-line', { hasText: 'PARTNO' }).first().waitFor({ timeout: 60_000 });
  for (const [title, test] of Object.entries(tests)) {
    try {
      await test();
      console.log(`ok   ${title}`);
    } catch (error) {
      failed += 1;
      console.log(`FAIL ${title}\n${error.stack ?? error}`);
      await shot('failure');
    }
  }
} catch (error) {
  failed += 1;
  console.log(`FAIL the workbench comes up\n${error.stack ?? error}`);
  await shot('failure');
} finally {
  await browser.close();
  stop();
  own.remove();
}
console.log(`in the browser: ${Object.keys(tests).length - Math.min(failed, Object.keys(tests).length)} passed, ${failed} failed`);
process.exit(failed > 0 ? 1 : 0);
