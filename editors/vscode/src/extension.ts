import * as vscode from 'vscode';
import { registerCommands } from './commands';
import { Session } from './session';
import { registerNavigation } from './views/navigation';
import { ViewProvider } from './views/provider';
import { VerdictDecorations } from './views/verdicts';

let session: Session | undefined;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  session = new Session(context.extensionUri);
  const views = new ViewProvider(session);
  context.subscriptions.push(
    session,
    views,
    registerNavigation(views),
    new VerdictDecorations(views),
    registerCommands(session, views),
    vscode.workspace.onDidChangeConfiguration((event) => {
      if (event.affectsConfiguration('apt.server.path')) {
        void session?.restart();
      }
    }),
  );
  await session.start();
}

export async function deactivate(): Promise<void> {
  await session?.stop();
}
