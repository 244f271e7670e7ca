// Loaded by the real extension host: runs the tests with mocha and writes what came out.
import * as fs from 'node:fs';
import * as path from 'node:path';

interface Outcome {
  title: string;
  ms?: number;
  error?: string;
}

function report(verdict: { tests: Outcome[]; crash?: string }): void {
  const file = process.env['APT_HOST_VERDICT'];
  if (file === undefined) {
    throw new Error('APT_HOST_VERDICT is not set');
  }
  // Whole or not at all: the driver reads it as soon as it is there.
  fs.writeFileSync(`${file}.part`, JSON.stringify(verdict));
  fs.renameSync(`${file}.part`, file);
}

export async function run(): Promise<void> {
  try {
    const { default: Mocha } = await import('mocha');
    const mocha = new Mocha({ ui: 'bdd', timeout: 90_000, reporter: class {} as never });
    for (const name of fs.readdirSync(__dirname).filter((name) => name.endsWith('.test.js')).sort()) {
      mocha.addFile(path.join(__dirname, name));
    }
    const tests: Outcome[] = [];
    await new Promise<void>((resolve) => {
      const runner = mocha.run(() => resolve());
      runner.on('pass', (test) => tests.push({ title: test.fullTitle(), ms: test.duration ?? 0 }));
      runner.on('fail', (test, error: Error) => tests.push({ title: test.fullTitle(), error: error.stack ?? String(error) }));
      runner.on('pending', (test) => tests.push({ title: test.fullTitle(), error: 'skipped' }));
    });
    report({ tests });
  } catch (error) {
    report({ tests: [], crash: error instanceof Error ? (error.stack ?? error.message) : String(error) });
  }
}
