import { existsSync } from 'node:fs';
import * as os from 'node:os';
import * as path from 'node:path';
import * as vscode from 'vscode';

/** Where the server program was taken from. */
export type ServerSource = 'setting' | 'extension' | 'search path';

export interface ServerProgram {
  path: string;
  source: ServerSource;
}

const PROGRAM = process.platform === 'win32' ? 'apt-lsp.exe' : 'apt-lsp';

/** The server to start: the one of the setting, the bundled one, or the first on the search path. */
export function findServer(extension: vscode.Uri): ServerProgram {
  const setting = vscode.workspace.getConfiguration('apt').get<string>('server.path', '').trim();
  if (setting !== '') {
    const file = setting.startsWith('~/') ? path.join(os.homedir(), setting.slice(2)) : setting;
    if (path.isAbsolute(file) && !existsSync(file)) {
      throw new Error(`The setting apt.server.path names ${file}, which does not exist.`);
    }
    return { path: file, source: 'setting' };
  }
  const bundled = vscode.Uri.joinPath(extension, 'server', PROGRAM).fsPath;
  if (existsSync(bundled)) {
    return { path: bundled, source: 'extension' };
  }
  const found = (process.env['PATH'] ?? '')
    .split(path.delimiter)
    .filter((folder) => folder !== '')
    .map((folder) => path.join(folder, PROGRAM))
    .find((file) => existsSync(file));
  if (found !== undefined) {
    return { path: found, source: 'search path' };
  }
  throw new Error(
    `The server ${PROGRAM} is neither in the extension nor on the search path; set apt.server.path.`,
  );
}
