import * as vscode from 'vscode';
import {
  type CancellationToken,
  CancellationTokenSource,
  CloseAction,
  DidChangeConfigurationNotification,
  ErrorAction,
  ExecuteCommandRequest,
  type LanguageClientOptions,
  ResponseError,
  RevealOutputChannelOn,
  State,
  WorkDoneProgress,
} from 'vscode-languageclient';
import { LanguageClient } from 'vscode-languageclient/node';
import { findServer, type ServerProgram } from './server';

/** Restarts after a crash within `CRASH_WINDOW_MS` that are tried before the user is asked. */
const MAX_CRASHES = 4;
const CRASH_WINDOW_MS = 180_000;
/** A command that takes longer shows its progress. */
const LONG_COMMAND_MS = 700;

/** A command of the server that the editor was asked to run, for example by a code lens. */
export type CommandHandler = (argument: unknown) => Promise<unknown>;

/** The running server: its life, its state in the status bar, and its commands. */
export class Session implements vscode.Disposable {
  private client: LanguageClient | undefined;
  private program: ServerProgram | undefined;
  private readonly log = vscode.window.createOutputChannel('APT', { log: true });
  private readonly status = vscode.languages.createLanguageStatusItem('apt.server', { language: 'apt' });
  private readonly projectFiles = vscode.workspace.createFileSystemWatcher('**/apt-lsp.toml');
  private readonly settingsListener = vscode.workspace.onDidChangeConfiguration((event) => {
    if (event.affectsConfiguration('apt')) {
      void this.client?.sendNotification(DidChangeConfigurationNotification.type, { settings: { apt: settings() } });
    }
  });
  private readonly handlers = new Map<string, CommandHandler>();
  private crashes: number[] = [];
  private nextToken = 0;
  private lifecycle: Promise<void> = Promise.resolve();

  constructor(private readonly extension: vscode.Uri) {
    this.status.name = 'APT server';
    this.status.command = { command: 'apt.restartServer', title: 'Restart' };
    this.show('Not started', false);
  }

  /** Lets `handler` answer `command` when the editor runs it, instead of passing it straight to the server. */
  handle(command: string, handler: CommandHandler): void {
    this.handlers.set(command, handler);
  }

  showLog(): void {
    this.log.show();
  }

  /** Starts the server; a failure is shown, not thrown. */
  start(): Promise<void> {
    return this.inOrder(() => this.startNow());
  }

  restart(): Promise<void> {
    this.crashes = [];
    return this.inOrder(async () => {
      await this.stopNow();
      await this.startNow();
    });
  }

  stop(): Promise<void> {
    return this.inOrder(() => this.stopNow());
  }

  /** Starts and stops never overlap. */
  private inOrder(step: () => Promise<void>): Promise<void> {
    this.lifecycle = this.lifecycle.then(step, step);
    return this.lifecycle;
  }

  private async startNow(): Promise<void> {
    if (this.client !== undefined) {
      return;
    }
    try {
      this.program = findServer(this.extension);
      this.log.info(`server: ${this.program.path} (${this.program.source})`);
      this.show('Starting', true);
      this.client = this.createClient(this.program.path);
      this.client.onDidChangeState(({ newState }) => this.stateChanged(newState));
      await this.client.start();
    } catch (error) {
      this.client = undefined;
      const reason = error instanceof Error ? error.message : String(error);
      this.log.error(reason);
      this.show(`Cannot start: ${reason}`, false, vscode.LanguageStatusSeverity.Error);
      void this.offer(`APT: the server cannot start. ${reason}`, 'Open Settings');
    }
  }

  private async stopNow(): Promise<void> {
    const client = this.client;
    this.client = undefined;
    await client?.dispose();
  }

  private createClient(program: string): LanguageClient {
    const options: LanguageClientOptions = {
      documentSelector: [
        { language: 'apt', scheme: 'file' },
        { language: 'apt', scheme: 'untitled' },
      ],
      outputChannel: this.log,
      revealOutputChannelOn: RevealOutputChannelOn.Never,
      initializationOptions: settings(),
      synchronize: { fileEvents: this.projectFiles },
      middleware: {
        workspace: {
          configuration: ({ items }) => items.map(({ section, scopeUri }) => settingsOf(section, scopeUri)),
        },
        executeCommand: (command, parameters, next) => {
          const handler = this.handlers.get(command);
          return handler === undefined ? next(command, parameters) : handler((parameters as unknown[])[0]);
        },
      },
      errorHandler: {
        error: () => ({ action: ErrorAction.Continue }),
        closed: () => this.closed(),
      },
    };
    return new LanguageClient('apt', 'APT', { command: program, args: ['--stdio'] }, options);
  }

  private closed() {
    const now = Date.now();
    this.crashes = this.crashes.filter((time) => now - time < CRASH_WINDOW_MS);
    this.crashes.push(now);
    if (this.crashes.length <= MAX_CRASHES) {
      return { action: CloseAction.Restart };
    }
    this.client = undefined;
    this.show('Stopped', false, vscode.LanguageStatusSeverity.Error);
    void this.offer('APT: the server stopped again and again.', 'Show Log');
    return { action: CloseAction.DoNotRestart, handled: true };
  }

  private async offer(message: string, action: 'Open Settings' | 'Show Log'): Promise<void> {
    const choice = await vscode.window.showErrorMessage(message, action);
    if (choice === 'Show Log') {
      this.showLog();
    } else if (choice === 'Open Settings') {
      await vscode.commands.executeCommand('workbench.action.openSettings', 'apt.server.path');
    }
  }

  private stateChanged(state: State): void {
    if (state === State.Running) {
      const server = this.client?.initializeResult?.serverInfo;
      this.show(`Running: ${server?.name ?? 'apt-lsp'} ${server?.version ?? ''}`.trim(), false);
    } else if (state === State.Starting) {
      this.show('Starting', true);
    } else if (this.client !== undefined) {
      this.show('Stopped', false, vscode.LanguageStatusSeverity.Error);
    }
  }

  private show(
    text: string,
    busy: boolean,
    severity: vscode.LanguageStatusSeverity = vscode.LanguageStatusSeverity.Information,
  ): void {
    this.status.text = text;
    this.status.detail = this.program?.path ?? '';
    this.status.busy = busy;
    this.status.severity = severity;
  }

  /**
   * Runs a command of the server. One that takes long shows its progress with a cancel button.
   * Throws with the server's words when it fails.
   */
  async execute<T>(title: string, command: string, argument: object, token?: CancellationToken): Promise<T> {
    await this.lifecycle;
    const client = this.client;
    if (client === undefined) {
      throw new Error('The APT server is not running.');
    }
    const cancel = new CancellationTokenSource();
    const outer = token?.onCancellationRequested(() => cancel.cancel());
    const workDoneToken = `apt-${this.nextToken++}`;
    const messages: string[] = [];
    let report = (message: string): void => void messages.push(message);
    const listener = client.onProgress(WorkDoneProgress.type, workDoneToken, (value) => {
      if (value.kind !== 'end' && value.message !== undefined) {
        report(value.message);
      }
    });
    const answer = client.sendRequest(
      ExecuteCommandRequest.type,
      { command, arguments: [argument], workDoneToken },
      cancel.token,
    ) as Promise<T>;
    const timer = setTimeout(() => {
      void vscode.window.withProgress(
        { location: vscode.ProgressLocation.Notification, title: `APT: ${title}`, cancellable: true },
        async (progress, userToken) => {
          userToken.onCancellationRequested(() => cancel.cancel());
          report = (message) => progress.report({ message });
          messages.slice(-1).forEach(report);
          await answer.catch(() => undefined);
        },
      );
    }, LONG_COMMAND_MS);
    try {
      return await answer;
    } finally {
      clearTimeout(timer);
      listener.dispose();
      outer?.dispose();
      cancel.dispose();
    }
  }

  dispose(): void {
    void this.stop();
    this.settingsListener.dispose();
    this.projectFiles.dispose();
    this.status.dispose();
    this.log.dispose();
  }
}

/** Settings of the section `apt` that are the server's business. */
const SERVER_SETTINGS = ['dialect', 'units', 'include', 'motion', 'machine', 'severity', 'format', 'budget'];

/** Values that stand for "not set": the project file or the server's own default decides. */
function isUnset(value: unknown): boolean {
  if (typeof value === 'object' && value !== null) {
    return Object.keys(value).length === 0;
  }
  return value === undefined || value === null || value === '' || value === 'auto';
}

/** What the user has set for the server. */
function settings(scope?: vscode.Uri): Record<string, unknown> {
  const section = vscode.workspace.getConfiguration('apt', scope ?? null);
  const values = SERVER_SETTINGS.map((name) => [name, section.get<unknown>(name)] as const);
  return Object.fromEntries(values.filter(([, value]) => !isUnset(value)));
}

/** The answer to the server's question for a section. */
function settingsOf(section: string | undefined, scope: string | undefined): unknown {
  const own = settings(scope === undefined ? undefined : vscode.Uri.parse(scope, true));
  if (section === undefined || section === '') {
    return { apt: own };
  }
  if (section === 'apt') {
    return own;
  }
  return section.startsWith('apt.') ? (own[section.slice('apt.'.length)] ?? null) : null;
}

/** The words of a failure for the user. */
export function reasonOf(error: unknown): string {
  if (error instanceof ResponseError || error instanceof Error) {
    return error.message;
  }
  return String(error);
}
