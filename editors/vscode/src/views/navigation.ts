/** From a line of a view to its statement, and from a statement to its lines. */
import * as vscode from 'vscode';
import type { LineOrigins, ViewProvider } from './provider';
import { SCHEME, viewOf } from './view';

/** The lines of a view that come from a line of the program. */
export function linesFrom(origins: LineOrigins, sourceLine: number): number[] {
  const lines: number[] = [];
  origins.forEach((range, line) => {
    if (range !== undefined && range.start.line <= sourceLine && sourceLine <= range.end.line) {
      lines.push(line);
    }
  });
  return lines;
}

/** "Go to Definition" in a view goes to the statement that the line comes from. */
class OriginProvider implements vscode.DefinitionProvider {
  constructor(private readonly views: ViewProvider) {}

  provideDefinition(document: vscode.TextDocument, position: vscode.Position): vscode.Location | undefined {
    const view = viewOf(document.uri);
    const range = this.views.originsOf(document.uri)?.[position.line];
    return view === undefined || range === undefined ? undefined : new vscode.Location(view.source, range);
  }
}

/** Marks, in every visible view, the lines of the statement under the cursor, and the other way round. */
class CounterpartMarker implements vscode.Disposable {
  private readonly mark = vscode.window.createTextEditorDecorationType({
    isWholeLine: true,
    backgroundColor: new vscode.ThemeColor('editor.rangeHighlightBackground'),
    overviewRulerColor: new vscode.ThemeColor('editorOverviewRuler.rangeHighlightForeground'),
  });
  private readonly listener: vscode.Disposable;

  constructor(private readonly views: ViewProvider) {
    this.listener = vscode.window.onDidChangeTextEditorSelection(({ textEditor }) => this.follow(textEditor));
  }

  private follow(editor: vscode.TextEditor): void {
    const line = editor.selection.active.line;
    const own = viewOf(editor.document.uri);
    if (own === undefined) {
      for (const other of vscode.window.visibleTextEditors) {
        const view = viewOf(other.document.uri);
        if (view?.source.toString() === editor.document.uri.toString()) {
          this.show(other, linesFrom(this.views.originsOf(other.document.uri) ?? [], line));
        }
      }
      return;
    }
    const range = this.views.originsOf(editor.document.uri)?.[line];
    for (const other of vscode.window.visibleTextEditors) {
      if (other.document.uri.toString() === own.source.toString()) {
        this.show(other, range === undefined ? [] : [range.start.line]);
      }
    }
  }

  private show(editor: vscode.TextEditor, lines: number[]): void {
    editor.setDecorations(this.mark, lines.map((line) => new vscode.Range(line, 0, line, 0)));
    const first = lines[0];
    if (first !== undefined) {
      editor.revealRange(
        new vscode.Range(first, 0, first, 0),
        vscode.TextEditorRevealType.InCenterIfOutsideViewport,
      );
    }
  }

  dispose(): void {
    this.listener.dispose();
    this.mark.dispose();
  }
}

/** Connects views and programs. */
export function registerNavigation(views: ViewProvider): vscode.Disposable {
  return vscode.Disposable.from(
    vscode.languages.registerDefinitionProvider({ scheme: SCHEME }, new OriginProvider(views)),
    new CounterpartMarker(views),
  );
}
