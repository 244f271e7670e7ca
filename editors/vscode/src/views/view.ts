import * as path from 'node:path';
import * as vscode from 'vscode';

/** The scheme of documents that show what the server makes of a program. */
export const SCHEME = 'apt-view';

/** What a view shows. */
export const VIEW_KINDS = ['motion', 'expansion', 'cl', 'tape', 'tree', 'canonical'] as const;
export type ViewKind = (typeof VIEW_KINDS)[number];

/** How the name of a view's document is made from the name of its program. The ending picks the language. */
const NAMES: Record<ViewKind, (stem: string) => string> = {
  motion: (stem) => `${stem} motion.txt`,
  expansion: (stem) => `${stem} expanded.apt`,
  cl: (stem) => `${stem}.cl`,
  tape: (stem) => `${stem} tape.ngc`,
  tree: (stem) => `${stem} tree.txt`,
  canonical: (stem) => `${stem} canonical.txt`,
};

/** A view of a program; `range` and `position` limit it to a part. */
export interface View {
  kind: ViewKind;
  source: vscode.Uri;
  range?: vscode.Range;
  position?: vscode.Position;
}

interface Query {
  source: string;
  range?: [number, number, number, number];
  position?: [number, number];
}

/** The address of a view's document. */
export function viewUri(view: View): vscode.Uri {
  const stem = path.basename(view.source.path).replace(/\.[^.]*$/, '') || 'program';
  const query: Query = { source: view.source.toString() };
  if (view.range !== undefined) {
    const { start, end } = view.range;
    query.range = [start.line, start.character, end.line, end.character];
  }
  if (view.position !== undefined) {
    query.position = [view.position.line, view.position.character];
  }
  return vscode.Uri.from({
    scheme: SCHEME,
    path: `/${view.kind}/${NAMES[view.kind](stem)}`,
    query: JSON.stringify(query),
  });
}

/** The view that a document shows, or undefined for any other document. */
export function viewOf(uri: vscode.Uri): View | undefined {
  if (uri.scheme !== SCHEME) {
    return undefined;
  }
  const kind = VIEW_KINDS.find((known) => known === uri.path.split('/')[1]);
  if (kind === undefined) {
    return undefined;
  }
  try {
    const query = JSON.parse(uri.query) as Query;
    const view: View = { kind, source: vscode.Uri.parse(query.source, true) };
    if (query.range !== undefined) {
      view.range = new vscode.Range(...query.range);
    }
    if (query.position !== undefined) {
      view.position = new vscode.Position(...query.position);
    }
    return view;
  } catch {
    return undefined;
  }
}
