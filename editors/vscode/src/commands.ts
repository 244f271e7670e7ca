import * as vscode from 'vscode';
import type { Machine, Position, RunResult, Span } from './protocol';
import { reasonOf, type Session } from './session';
import { toRange, type ViewProvider } from './views/provider';
import { type View, type ViewKind, viewOf } from './views/view';

/** Registers the commands of the palette and those that the server's code lenses name. */
export function registerCommands(session: Session, views: ViewProvider): vscode.Disposable {
  const register = (command: string, action: () => Promise<unknown>): vscode.Disposable =>
    vscode.commands.registerCommand(command, async () => {
      try {
        return await action();
      } catch (error) {
        void vscode.window.showErrorMessage(`APT: ${reasonOf(error)}`);
        return undefined;
      }
    });
  const show = (kind: ViewKind, part: 'program' | 'position' | 'selection' = 'program') => () =>
    views.open(viewOfEditor(kind, part));

  session.handle('apt.runMotion', (argument) => runMotion(session, views, argument));
  return vscode.Disposable.from(
    register('apt.showMotion', show('motion')),
    register('apt.showSelectedMotion', show('motion', 'selection')),
    register('apt.showExpansion', show('expansion')),
    register('apt.showClFile', show('cl')),
    register('apt.showControlTape', () => showControlTape(session, views)),
    register('apt.showSyntaxTree', show('tree')),
    register('apt.showCanonicalForm', show('canonical', 'position')),
    register('apt.selectMachine', () => selectMachine(session)),
    register('apt.restartServer', () => session.restart()),
    register('apt.showServerLog', async () => session.showLog()),
  );
}

/** The view of what the active editor shows; a view's own commands are about its program. */
function viewOfEditor(kind: ViewKind, part: 'program' | 'position' | 'selection'): View {
  const editor = vscode.window.activeTextEditor;
  if (editor === undefined) {
    throw new Error('Open an APT program first.');
  }
  const inner = viewOf(editor.document.uri);
  if (inner !== undefined) {
    return { kind, source: inner.source };
  }
  if (editor.document.languageId !== 'apt') {
    throw new Error(`${editor.document.fileName} is not an APT program.`);
  }
  const view: View = { kind, source: editor.document.uri };
  if (part === 'position') {
    view.position = editor.selection.active;
  } else if (part === 'selection' && !editor.selection.isEmpty) {
    view.range = editor.selection;
  }
  return view;
}

/** What a code lens asks for: the run's report on the screen, and its result to the caller. */
async function runMotion(session: Session, views: ViewProvider, argument: unknown): Promise<RunResult | undefined> {
  const { uri, range } = (argument ?? {}) as { uri?: string; range?: Span };
  if (uri === undefined) {
    throw new Error('apt.runMotion needs { "uri" }.');
  }
  const view: View = { kind: 'motion', source: vscode.Uri.parse(uri, true) };
  if (range !== undefined && range !== null) {
    view.range = toRange(range);
  }
  await views.open(view);
  return session.execute<RunResult>('running motion', 'apt.runMotion', argument as { uri: string; position?: Position });
}

/** The tape; without a machine in the settings or the project file, one is chosen first. */
async function showControlTape(session: Session, views: ViewProvider): Promise<unknown> {
  const view = viewOfEditor('tape', 'program');
  if (vscode.workspace.getConfiguration('apt', view.source).get<string>('machine', '') === '') {
    try {
      await session.execute('making the control tape', 'apt.post', { uri: view.source.toString() });
    } catch {
      // Whatever else is wrong is said again when the view asks for the tape.
      if (!(await selectMachine(session))) {
        return undefined;
      }
    }
  }
  return views.open(view);
}

/** Lets the user choose the machine of the tape; false when nothing was chosen. */
async function selectMachine(session: Session): Promise<boolean> {
  const machines = await session.execute<Machine[]>('listing machines', 'apt.machines', {});
  const resource = vscode.window.activeTextEditor?.document.uri;
  const current = vscode.workspace.getConfiguration('apt', resource).get<string>('machine', '');
  const choice = await vscode.window.showQuickPick(
    machines.map(({ name, title, control }) => ({
      label: name,
      description: control,
      detail: title,
      picked: name === current,
    })),
    { title: 'Machine of the control tape', matchOnDescription: true, matchOnDetail: true },
  );
  if (choice === undefined) {
    return false;
  }
  const target = vscode.workspace.workspaceFolders === undefined
    ? vscode.ConfigurationTarget.Global
    : vscode.ConfigurationTarget.Workspace;
  await vscode.workspace.getConfiguration('apt').update('machine', choice.label, target);
  return true;
}
