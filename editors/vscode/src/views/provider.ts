import * as vscode from 'vscode';
import { type Finding, type CanonicalForm, type Expansion, type RunResult, type Span, type Tape } from '../protocol';
import { reasonOf, type Session } from '../session';
import { clListing, type Listing, motionListing, tapeListing } from './listing';
import { SCHEME, type View, viewOf, viewUri } from './view';

/** Quiet time after the last change of a program before its open views are made again. */
const REFRESH_DELAY_MS = 300;

/** The origin of each line of a view in its program. */
export type LineOrigins = readonly (vscode.Range | undefined)[];

interface Rendered {
  text: string;
  origins: LineOrigins;
}

/** Makes the texts of views, keeps them fresh, and knows where their lines come from. */
export class ViewProvider implements vscode.TextDocumentContentProvider, vscode.Disposable {
  private readonly changed = new vscode.EventEmitter<vscode.Uri>();
  readonly onDidChange = this.changed.event;
  private readonly ran = new vscode.EventEmitter<{ source: vscode.Uri; version: number; result: RunResult; ranges: Map<number, vscode.Range> }>();
  /** Fires after each run of motion. */
  readonly onDidRun = this.ran.event;
  private readonly origins = new Map<string, LineOrigins>();
  private readonly timers = new Map<string, NodeJS.Timeout>();
  private readonly subscriptions: vscode.Disposable[];

  constructor(private readonly session: Session) {
    this.subscriptions = [
      this.changed,
      this.ran,
      vscode.workspace.registerTextDocumentContentProvider(SCHEME, this),
      vscode.workspace.onDidChangeTextDocument(({ document, contentChanges }) => {
        if (document.uri.scheme !== SCHEME && contentChanges.length > 0) {
          this.refreshSoon(document.uri);
        }
      }),
      vscode.workspace.onDidChangeConfiguration((event) => {
        if (event.affectsConfiguration('apt.machine') || event.affectsConfiguration('apt.dialect')) {
          this.refreshAll();
        }
      }),
      vscode.workspace.onDidCloseTextDocument(({ uri }) => this.origins.delete(uri.toString())),
    ];
  }

  /** Opens a view beside its program, made anew. */
  async open(view: View): Promise<vscode.TextDocument> {
    const uri = viewUri(view);
    if (vscode.workspace.textDocuments.some((document) => document.uri.toString() === uri.toString())) {
      await this.renewed(uri);
    }
    const document = await vscode.workspace.openTextDocument(uri);
    await vscode.window.showTextDocument(document, {
      viewColumn: vscode.ViewColumn.Beside,
      preserveFocus: true,
      preview: false,
    });
    return document;
  }

  /** Makes an open view again and waits until its document has the new text. */
  private async renewed(uri: vscode.Uri): Promise<void> {
    const open = vscode.workspace.textDocuments.find((document) => document.uri.toString() === uri.toString());
    const text = await this.provideTextDocumentContent(uri, new vscode.CancellationTokenSource().token);
    if (open === undefined || open.getText() === text) {
      return;
    }
    await new Promise<void>((resolve) => {
      const listener = vscode.workspace.onDidChangeTextDocument(({ document }) => {
        if (document === open) {
          listener.dispose();
          resolve();
        }
      });
      this.changed.fire(uri);
    });
  }

  /** Where the lines of a view's document come from. */
  originsOf(uri: vscode.Uri): LineOrigins | undefined {
    return this.origins.get(uri.toString());
  }

  async provideTextDocumentContent(uri: vscode.Uri, token: vscode.CancellationToken): Promise<string> {
    const view = viewOf(uri);
    if (view === undefined) {
      return 'This is not a view of an APT program.\n';
    }
    try {
      const { text, origins } = await this.render(view, token);
      this.origins.set(uri.toString(), origins);
      return text;
    } catch (error) {
      this.origins.delete(uri.toString());
      return `$$ ${reasonOf(error)}\n`;
    }
  }

  private async render(view: View, token: vscode.CancellationToken): Promise<Rendered> {
    // The server knows the programs that are open; a view restored with the window opens its own.
    const source = await vscode.workspace.openTextDocument(view.source);
    const uri = source.uri.toString();
    switch (view.kind) {
      case 'expansion': {
        const position = view.position === undefined ? {} : { position: view.position };
        const expansion = await this.session.execute<Expansion>('expanding macros and loops', 'apt.expand', { uri, ...position }, token);
        const origins: (vscode.Range | undefined)[] = [];
        for (const origin of expansion.origins) {
          origins[origin.line] = toRange(origin.range);
        }
        return { text: ensureLineEnd(expansion.text), origins };
      }
      case 'tree': {
        const { text } = await this.session.execute<{ text: string }>('making the syntax tree', 'apt.syntaxTree', { uri }, token);
        return { text: ensureLineEnd(text), origins: [] };
      }
      case 'canonical': {
        const form = await this.session.execute<CanonicalForm | null>(
          'finding the canonical form', 'apt.canonicalForm', { uri, position: view.position }, token);
        return { text: canonicalText(form), origins: [] };
      }
      case 'tape': {
        const machine = vscode.workspace.getConfiguration('apt', source.uri).get<string>('machine', '');
        const chosen = machine === '' ? {} : { machine };
        const tape = await this.session.execute<Tape & { diagnostics?: Finding[] }>('making the control tape', 'apt.post', { uri, ...chosen }, token);
        return this.located(source, tapeListing(tape), token);
      }
      case 'cl':
      case 'motion': {
        const range = view.range === undefined ? {} : { range: view.range };
        const version = source.version;
        const result = await this.session.execute<RunResult>('running motion', 'apt.runMotion', { uri, ...range }, token);
        const ranges = await this.statementRanges(source, token);
        this.ran.fire({ source: source.uri, version, result, ranges });
        const listing = view.kind === 'cl' ? clListing(result) : motionListing(result);
        return { text: listing.text, origins: linesOf(listing, ranges) };
      }
    }
  }

  private async located(source: vscode.TextDocument, listing: Listing, token: vscode.CancellationToken): Promise<Rendered> {
    return { text: listing.text, origins: linesOf(listing, await this.statementRanges(source, token)) };
  }

  /** Where each statement stands, as the expansion knows it. */
  private async statementRanges(source: vscode.TextDocument, token: vscode.CancellationToken): Promise<Map<number, vscode.Range>> {
    const ranges = new Map<number, vscode.Range>();
    const expansion = await this.session.execute<Expansion>('locating statements', 'apt.expand', { uri: source.uri.toString() }, token);
    for (const origin of expansion.origins) {
      ranges.set(origin.isn, toRange(origin.range));
    }
    return ranges;
  }

  private refreshSoon(source: vscode.Uri): void {
    const key = source.toString();
    clearTimeout(this.timers.get(key));
    this.timers.set(key, setTimeout(() => {
      this.timers.delete(key);
      for (const { uri } of vscode.workspace.textDocuments) {
        if (viewOf(uri)?.source.toString() === key) {
          this.changed.fire(uri);
        }
      }
    }, REFRESH_DELAY_MS));
  }

  private refreshAll(): void {
    for (const { uri } of vscode.workspace.textDocuments) {
      if (uri.scheme === SCHEME) {
        this.changed.fire(uri);
      }
    }
  }

  dispose(): void {
    for (const timer of this.timers.values()) {
      clearTimeout(timer);
    }
    for (const subscription of this.subscriptions) {
      subscription.dispose();
    }
  }
}

export function toRange({ start, end }: Span): vscode.Range {
  return new vscode.Range(start.line, start.character, end.line, end.character);
}

function linesOf(listing: Listing, ranges: Map<number, vscode.Range>): LineOrigins {
  return listing.isn.map((isn) => (isn === undefined ? undefined : ranges.get(isn)));
}

function canonicalText(form: CanonicalForm | null): string {
  if (form === null) {
    return 'There is no surface at this place.\n';
  }
  const numbers = (form.canonical ?? []).map((value) => `  ${value}\n`).join('');
  return `${form.name} = ${form.type}\n\n${ensureLineEnd(form.text)}\n${numbers}`;
}

function ensureLineEnd(text: string): string {
  return text.endsWith('\n') ? text : `${text}\n`;
}
