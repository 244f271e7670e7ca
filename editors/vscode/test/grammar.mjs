// Compares the scopes that the grammar gives to a sample with the assertions in the sample's comments.
import { spawnSync } from 'node:child_process';
import { readdirSync } from 'node:fs';
import path from 'node:path';

const extension = path.resolve(import.meta.dirname, '..');
const samples = readdirSync(path.join(extension, 'test/grammar')).map((name) => path.join('test/grammar', name));
let failed = 0;
for (const sample of samples) {
  const run = spawnSync(
    process.execPath,
    ['node_modules/vscode-tmgrammar-test/dist/unit.js', '-g', 'syntaxes/apt.tmLanguage.json', sample],
    { cwd: extension, encoding: 'utf8' },
  );
  if (run.status === 0) {
    console.log(`ok   ${sample}`);
  } else {
    failed += 1;
    console.log(`FAIL ${sample}\n${run.stdout}${run.stderr}`);
  }
}
console.log(`${samples.length - failed} passed, ${failed} failed`);
process.exit(failed > 0 || samples.length === 0 ? 1 : 0);
