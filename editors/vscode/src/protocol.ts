/** What the server's own commands take and give. Lines and characters are zero-based, characters in UTF-16. */

export interface Position {
  line: number;
  character: number;
}

export interface Span {
  start: Position;
  end: Position;
}

/** A macro call, loop turn or inclusion on the way to a statement. */
export interface OriginStep {
  kind: string;
  name: string;
  isn?: number | null;
  turn?: number | null;
}

export interface Finding {
  code: string;
  severity: 'error' | 'warning' | 'information' | 'hint';
  message: string;
  isn?: number | null;
  range?: Span | null;
  hint?: string | null;
}

/** The extreme signed clearances of a motion over the whole of every cut vector. */
export interface Clearance {
  min: number;
  max: number;
  intol: number;
  outtol: number;
}

export interface Motion {
  isn: number;
  statement: string;
  cut_vectors: number;
  minimum?: number | null;
  part?: Clearance | null;
  drive?: Clearance | null;
  check?: Clearance | null;
  verified: boolean;
}

export interface ClEntry {
  isn: number;
  type: string;
  surface?: string | null;
  words?: (string | number)[] | null;
  /** Class and subclass of the record; of a post-processor word its own code. */
  code?: number | number[] | null;
  points?: number[][] | null;
}

export interface Tape {
  machine: string;
  blocks: string[];
  origin: (number | null)[];
}

export interface RunResult {
  program: string;
  ok: boolean;
  diagnostics: Finding[];
  cl: ClEntry[];
  motions: Motion[];
  totals?: Partial<Totals> | null;
  tape?: Tape | null;
}

export interface Totals {
  points: number;
  length: number;
  cut_length: number;
  rapid_length: number;
  time_minutes: number | null;
}

export interface Expansion {
  text: string;
  origins: { line: number; isn: number; range: Span; stack: OriginStep[] }[];
}

export interface CanonicalForm {
  name: string;
  type: string;
  canonical: number[] | null;
  text: string;
}

export interface Machine {
  name: string;
  title: string;
  control: string;
}
