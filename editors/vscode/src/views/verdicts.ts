import * as vscode from 'vscode';
import type { Motion } from '../protocol';
import { motionSummary } from './listing';
import type { ViewProvider } from './provider';

/** Shows, behind each motion statement, what its last run came to, until the program changes. */
export class VerdictDecorations implements vscode.Disposable {
  private readonly good = annotation('editorCodeLens.foreground');
  private readonly bad = annotation('editorWarning.foreground');
  private readonly shown = new Map<string, { good: vscode.DecorationOptions[]; bad: vscode.DecorationOptions[] }>();
  private readonly listeners: vscode.Disposable[];

  constructor(views: ViewProvider) {
    this.listeners = [
      views.onDidRun(({ source, version, result, ranges }) => this.show(source, version, result.motions, ranges)),
      vscode.workspace.onDidChangeTextDocument(({ document, contentChanges }) => {
        if (contentChanges.length > 0 && this.shown.delete(document.uri.toString())) {
          this.paint();
        }
      }),
      vscode.workspace.onDidCloseTextDocument(({ uri }) => this.shown.delete(uri.toString())),
      vscode.window.onDidChangeVisibleTextEditors(() => this.paint()),
    ];
  }

  private show(source: vscode.Uri, version: number, motions: Motion[], ranges: Map<number, vscode.Range>): void {
    const document = vscode.workspace.textDocuments.find(({ uri }) => uri.toString() === source.toString());
    if (document?.version !== version) {
      return;
    }
    // A statement inside a loop or macro runs many times: one line holds its last run and the number of runs.
    const last = new Map<number, { motion: Motion; runs: number; verified: boolean }>();
    for (const motion of motions) {
      const before = last.get(motion.isn);
      last.set(motion.isn, {
        motion,
        runs: (before?.runs ?? 0) + 1,
        verified: (before?.verified ?? true) && motion.verified,
      });
    }
    const good: vscode.DecorationOptions[] = [];
    const bad: vscode.DecorationOptions[] = [];
    for (const [isn, { motion, runs, verified }] of last) {
      const range = ranges.get(isn);
      if (range === undefined) {
        continue;
      }
      const end = document.lineAt(Math.min(range.end.line, document.lineCount - 1)).range.end;
      const vectors = `${motion.cut_vectors} cut vector${motion.cut_vectors === 1 ? '' : 's'}`;
      const times = runs > 1 ? `, run ${runs} times` : '';
      (verified ? good : bad).push({
        range: new vscode.Range(end, end),
        renderOptions: { after: { contentText: `${verified ? '✓' : '✗ not verified,'} ${vectors}${times}` } },
        hoverMessage: motionSummary(motion),
      });
    }
    this.shown.set(source.toString(), { good, bad });
    this.paint();
  }

  private paint(): void {
    for (const editor of vscode.window.visibleTextEditors) {
      const verdicts = this.shown.get(editor.document.uri.toString());
      editor.setDecorations(this.good, verdicts?.good ?? []);
      editor.setDecorations(this.bad, verdicts?.bad ?? []);
    }
  }

  dispose(): void {
    for (const listener of [...this.listeners, this.good, this.bad]) {
      listener.dispose();
    }
  }
}

function annotation(colour: string): vscode.TextEditorDecorationType {
  return vscode.window.createTextEditorDecorationType({
    after: { margin: '0 0 0 2em', color: new vscode.ThemeColor(colour) },
    rangeBehavior: vscode.DecorationRangeBehavior.ClosedOpen,
  });
}
