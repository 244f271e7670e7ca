// The real VS Code workbench: started on a fresh profile, opened in chromium, ended with its process group.
import { spawn } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, openSync, realpathSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import os from 'node:os';
import path from 'node:path';
import { chromium } from 'playwright-core';

/** The value of an environment variable that `cargo xtask test-vscode` sets. */
export function given(name) {
  const value = process.env[name];
  if (value === undefined || value === '') {
    throw new Error(`${name} is not set; run \`cargo xtask test-vscode\``);
  }
  return value;
}

export const extension = path.resolve(import.meta.dirname, '..');
export const results = given('APT_RESULTS');

/** A profile that asks nothing, fetches nothing and shows nothing beside the program. */
const SETTINGS = {
  'security.workspace.trust.enabled': false,
  'workbench.startupEditor': 'none',
  'workbench.enableExperiments': false,
  'workbench.secondarySideBar.defaultVisibility': 'hidden',
  'workbench.tips.enabled': false,
  'telemetry.telemetryLevel': 'off',
  'update.mode': 'none',
  'extensions.autoUpdate': false,
  'extensions.autoCheckUpdates': false,
  'chat.disableAIFeatures': true,
  'editor.minimap.enabled': false,
  'editor.hover.delay': 100,
};

/** Only a hang lets this pass. */
const READY_MS = 100_000;

async function freePort() {
  return new Promise((resolve, reject) => {
    const probe = createServer();
    probe.on('error', reject);
    probe.listen(0, '127.0.0.1', () => {
      const { port } = probe.address();
      probe.close(() => resolve(port));
    });
  });
}

/** A fresh profile with a workspace that holds the test parts. */
export function profile(settings = {}) {
  const folder = realpathSync(mkdtempSync(path.join(os.tmpdir(), 'apt-vscode-')));
  for (const name of ['user/User', 'extensions', 'workspace', 'server']) {
    mkdirSync(path.join(folder, name), { recursive: true });
  }
  writeFileSync(path.join(folder, 'user/User/settings.json'), JSON.stringify({ ...SETTINGS, ...settings }));
  cpSync(path.resolve(extension, '../parts'), path.join(folder, 'workspace'), { recursive: true });
  return {
    folder,
    workspace: path.join(folder, 'workspace'),
    switches: ['--user-data-dir', path.join(folder, 'user'), '--extensions-dir', path.join(folder, 'extensions')],
    environment: {
      XDG_CONFIG_HOME: path.join(folder, 'xdg/config'),
      XDG_DATA_HOME: path.join(folder, 'xdg/data'),
      XDG_CACHE_HOME: path.join(folder, 'xdg/cache'),
    },
    remove: () => rmSync(folder, { recursive: true, force: true, maxRetries: 5 }),
  };
}

// A stopped test ends what it started: `exit` is not heard of a signal by itself.
for (const [signal, status] of [['SIGTERM', 143], ['SIGINT', 130]]) {
  process.on(signal, () => process.exit(status));
}

/** Runs a program of the host to its end. */
export async function runHost(args, own) {
  const child = spawn(given('APT_HOST_NODE'), args, {
    env: { ...process.env, ...own.environment },
    stdio: ['ignore', 'inherit', 'inherit'],
  });
  const status = await new Promise((resolve, reject) => {
    child.on('error', reject);
    child.on('exit', resolve);
  });
  if (status !== 0) {
    throw new Error(`${args.join(' ')} ended with ${status}`);
  }
}

/** Starts a server of the workbench and waits until `readyPath` answers. */
export async function startWorkbench(own, { args, readyPath, log, environment = {} }) {
  const port = await freePort();
  const output = openSync(path.join(results, log), 'w');
  const child = spawn(given('APT_HOST_NODE'), args(port), {
    env: { ...process.env, ...own.environment, ...environment },
    stdio: ['ignore', output, output],
    detached: true, // a process group of its own: extension host and language server go with it
  });
  const base = `http://127.0.0.1:${port}`;
  const stop = () => {
    try {
      process.kill(-child.pid, 'SIGKILL');
    } catch {
      // It has ended by itself.
    }
  };
  process.on('exit', stop);
  for (const end = Date.now() + READY_MS; ; await new Promise((resolve) => setTimeout(resolve, 100))) {
    if (child.exitCode !== null) {
      throw new Error(`the workbench ended with ${child.exitCode}; see ${log}`);
    }
    const answer = await fetch(base + readyPath).catch(() => undefined);
    if (answer?.ok) {
      return { base, stop };
    }
    if (Date.now() > end) {
      stop();
      throw new Error(`the workbench did not come up; see ${log}`);
    }
  }
}

/** The address of a file or folder as the workbench at `base` names it. */
export const remote = (base, file) => `vscode-remote://${new URL(base).host}${file}`;

/** The address of the workbench with a folder open; `payload` are options of the workbench. */
export const address = (base, folder, payload) =>
  `${base}/?folder=${encodeURIComponent(folder)}&payload=${encodeURIComponent(JSON.stringify(payload))}`;

export function launchBrowser() {
  return chromium.launch({
    executablePath: given('CHROMIUM'),
    headless: true,
    args: [
      '--no-sandbox', // CI runs as root
      '--disable-quic',
      '--no-first-run',
      '--disable-background-networking',
      '--disable-component-update',
      '--disable-sync',
      '--use-gl=angle',
      '--use-angle=swiftshader',
      '--enable-unsafe-swiftshader',
    ],
  });
}
