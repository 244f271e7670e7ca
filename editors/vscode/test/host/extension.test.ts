import * as assert from 'node:assert';
import { execFileSync } from 'node:child_process';
import * as vscode from 'vscode';
import type { RunResult } from '../../src/protocol';

/** Only a hang lets this pass. */
const WAIT_MS = 60_000;

/** Waits for `probe` to give something; what it waits for comes with an event of the server. */
async function until<T>(what: string, probe: () => T | undefined | false | Promise<T | undefined | false>): Promise<T> {
  for (const end = Date.now() + WAIT_MS; Date.now() < end; await new Promise((resolve) => setTimeout(resolve, 30))) {
    const found = await probe();
    if (found !== undefined && found !== false) {
      return found;
    }
  }
  throw new Error(`never came: ${what}`);
}

async function open(name: string): Promise<vscode.TextEditor> {
  const [file] = await vscode.workspace.findFiles(name);
  assert.ok(file, `${name} is in the workspace`);
  const document = await vscode.workspace.openTextDocument(file);
  return vscode.window.showTextDocument(document, vscode.ViewColumn.One);
}

function errors(document: vscode.TextDocument): vscode.Diagnostic[] {
  return vscode.languages
    .getDiagnostics(document.uri)
    .filter(({ severity }) => severity === vscode.DiagnosticSeverity.Error);
}

/** The document of a view by the first part of its path. */
function view(kind: string): vscode.TextDocument | undefined {
  return vscode.workspace.textDocuments.find(
    ({ uri }) => uri.scheme === 'apt-view' && uri.path.startsWith(`/${kind}/`) && uri.query.includes('bracket'));
}

function lineOf(document: vscode.TextDocument, text: string): number {
  const line = document.getText().split(/\r?\n/).findIndex((candidate) => candidate.includes(text));
  assert.ok(line >= 0, `${text} is in ${document.fileName}`);
  return line;
}

/** The server in the extension. */
function serverProgram(): string {
  const extension = vscode.extensions.getExtension('apt-lsp.apt');
  assert.ok(extension);
  return vscode.Uri.joinPath(extension.extensionUri, 'server', 'apt-lsp').fsPath;
}

/** Where the tool ends: on the circle of the tool centre round C1, at the height of L1. */
const CENTRE_RADIUS = 2 + 0.25;
const LAST_OF_ARC = [Math.sqrt(CENTRE_RADIUS ** 2 - 0.5 ** 2), 0.5, 0] as const;
/** The check surface is met within the tolerance of the program. */
const TOLERANCE = 0.0011;

function isNear(point: readonly number[], expected: readonly number[]): boolean {
  return expected.every((value, axis) => Math.abs((point[axis] ?? Number.NaN) - value) <= TOLERANCE);
}

describe('the APT extension in the real extension host', () => {
  let bracket: vscode.TextEditor;

  before(async () => {
    bracket = await open('bracket.apt');
    const extension = vscode.extensions.getExtension('apt-lsp.apt');
    assert.ok(extension, 'the extension is known');
    await until('activation', () => extension.isActive);
  });

  it('knows the language by ending and by first line', async () => {
    assert.strictEqual(bracket.document.languageId, 'apt');
    const byFirstLine = await vscode.workspace.openTextDocument({ content: 'PARTNO X\nFINI\n' });
    await until('language by first line', () => byFirstLine.languageId === 'apt' || undefined);
  });

  it('shows a mistake at its place', async () => {
    const { document } = await open('mistake.apt');
    const found = await until('an error', () => errors(document).find(({ range }) => range.start.line === 3));
    assert.match(document.getText(found.range), /P9|CIRCLE/);
    assert.match(found.message, /P9/);
    const code = typeof found.code === 'object' ? found.code.value : found.code;
    assert.match(String(code), /^APT\d{4}$/);
  });

  it('takes the mistake back when it is mended, and shows it again', async () => {
    const { document } = await open('mistake.apt');
    await until('an error', () => errors(document).length > 0);
    const place = document.getText().indexOf('P9');
    const range = new vscode.Range(document.positionAt(place), document.positionAt(place + 2));
    const mend = new vscode.WorkspaceEdit();
    mend.replace(document.uri, range, 'P1');
    assert.ok(await vscode.workspace.applyEdit(mend));
    await until('no error', () => errors(document).length === 0);
    const spoil = new vscode.WorkspaceEdit();
    spoil.replace(document.uri, range, 'P9');
    assert.ok(await vscode.workspace.applyEdit(spoil));
    await until('the error again', () => errors(document).length > 0);
  });

  it('finds nothing wrong with a good program', async () => {
    // The tokens are asked for so that the server has seen the program; the mistake above proves that errors come.
    const hovers = await vscode.commands.executeCommand<vscode.Hover[]>(
      'vscode.executeHoverProvider', bracket.document.uri, new vscode.Position(8, 0));
    assert.ok(hovers.length > 0);
    assert.deepStrictEqual(errors(bracket.document).map(({ message }) => message), []);
  });

  it('hovers a surface with its canonical form', async () => {
    const line = lineOf(bracket.document, 'GORGT/C1');
    const character = bracket.document.lineAt(line).text.indexOf('C1');
    const hovers = await until('a hover', async () => {
      const found = await vscode.commands.executeCommand<vscode.Hover[]>(
        'vscode.executeHoverProvider', bracket.document.uri, new vscode.Position(line, character));
      return found.length > 0 && found;
    });
    const text = hovers.flatMap(({ contents }) => contents).map((part) => (typeof part === 'string' ? part : part.value)).join('\n');
    assert.match(text, /CIRCLE/);
    assert.match(text, /radius 2\b/);
  });

  it('shows the expansion, and goes back from its lines', async () => {
    await open('bracket.apt');
    await vscode.commands.executeCommand('apt.showExpansion');
    const document = await until('the expansion', () => view('expansion'));
    assert.strictEqual(document.languageId, 'apt');
    const body = lineOf(bracket.document, 'GOTO/X,Y,1');
    const lines = [...Array(document.lineCount).keys()];
    const fromBody: string[] = [];
    for (const line of lines) {
      const places = await vscode.commands.executeCommand<vscode.Location[]>(
        'vscode.executeDefinitionProvider', document.uri, new vscode.Position(line, 0));
      const text = document.lineAt(line).text;
      if (places.some(({ range }) => range.start.line === body) && text.includes('GOTO')) {
        fromBody.push(text);
      }
    }
    assert.strictEqual(fromBody.length, 2, document.getText());
    assert.match(fromBody[0] ?? '', /GOTO\s*\/.*6.*1.*1/);
    assert.match(fromBody[1] ?? '', /GOTO\s*\/.*7.*2.*1/);
  });

  it('runs motion to verified CL points', async () => {
    const result = await vscode.commands.executeCommand<RunResult>('apt.runMotion', { uri: bracket.document.uri.toString() });
    assert.strictEqual(result.ok, true, JSON.stringify(result.diagnostics));
    assert.ok(result.motions.length > 0);
    assert.ok(result.motions.every(({ verified }) => verified));
    const points = result.cl.flatMap(({ points }) => points ?? []);
    assert.ok(points.some((point) => isNear(point, LAST_OF_ARC)), JSON.stringify(points));
    const document = await until('the report', () => view('motion'));
    const all = result.motions.length;
    assert.ok(document.getText().includes(`${all} of ${all} motions verified`), document.getText());
    assert.ok(document.getText().includes(points[0]?.[0]?.toFixed(6) ?? 'no point'));
  });

  it('shows the CL file and makes it anew after a change', async () => {
    await open('bracket.apt');
    await vscode.commands.executeCommand('apt.showClFile');
    const document = await until('the CL file', () => view('cl'));
    assert.match(document.getText(), /^FROM\/3\.0,-2\.0,0\.0$/m);
    assert.match(document.getText(), /^CIRCLE\/0\.0,0\.0,0\.0,0\.0,0\.0,1\.0,2\.0$/m);
    assert.match(document.getText(), /^FINI$/m);
    const written = execFileSync(serverProgram(), ['run', bracket.document.fileName, '--format', 'cl'], {
      encoding: 'utf8',
      stdio: ['ignore', 'pipe', 'ignore'],
    });
    assert.strictEqual(document.getText(), written);
    const line = lineOf(bracket.document, 'GOTO/9,9,1');
    const original = bracket.document.lineAt(line).text;
    const change = async (text: string) => {
      const edit = new vscode.WorkspaceEdit();
      edit.replace(bracket.document.uri, bracket.document.lineAt(line).range, text);
      assert.ok(await vscode.workspace.applyEdit(edit));
    };
    await change(original.replace('9,9,1', '9,9,5'));
    await until('the new point', () => /^GOTO\/9\.0,9\.0,5\.0$/m.test(document.getText()));
    await change(original);
    await until('the old point', () => /^GOTO\/9\.0,9\.0,1\.0$/m.test(document.getText()));
  });

  it('shows the control tape of the chosen machine', async () => {
    const machines = await vscode.commands.executeCommand<{ name: string }[]>('apt.machines', {});
    assert.ok(machines.some(({ name }) => name === 'linuxcnc-mill3'), JSON.stringify(machines));
    await vscode.workspace.getConfiguration('apt').update('machine', 'linuxcnc-mill3', vscode.ConfigurationTarget.Workspace);
    await open('bracket.apt');
    await vscode.commands.executeCommand('apt.showControlTape');
    const document = await until('the tape', () => view('tape'));
    assert.match(document.getText(), /\bM0?3\b/);
    assert.match(document.getText(), /X9\.?0*\s?Y9/);
    const block = lineOf(document, 'Y9');
    const places = await vscode.commands.executeCommand<vscode.Location[]>(
      'vscode.executeDefinitionProvider', document.uri, new vscode.Position(block, 0));
    assert.strictEqual(places[0]?.range.start.line, lineOf(bracket.document, 'GOTO/9,9,1'));
  });

  it('shows the syntax tree and the canonical form', async () => {
    const editor = await open('bracket.apt');
    await vscode.commands.executeCommand('apt.showSyntaxTree');
    const tree = await until('the tree', () => view('tree'));
    assert.match(tree.getText(), /MACRO/);
    assert.ok(tree.lineCount > bracket.document.lineCount);
    await open('bracket.apt');
    const line = lineOf(bracket.document, 'C1=CIRCLE');
    editor.selection = new vscode.Selection(line, 0, line, 0);
    await vscode.commands.executeCommand('apt.showCanonicalForm');
    const form = await until('the canonical form', () => view('canonical'));
    assert.match(form.getText(), /C1 = CIRCLE/);
  });

  it('serves again after a restart', async () => {
    await vscode.commands.executeCommand('apt.restartServer');
    const result = await vscode.commands.executeCommand<RunResult>('apt.runMotion', { uri: bracket.document.uri.toString() });
    assert.ok(result.cl.length > 0);
    const { document } = await open('mistake.apt');
    await until('an error', () => errors(document).length > 0);
  });
});
