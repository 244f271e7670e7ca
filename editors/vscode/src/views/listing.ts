/** The texts of the views: plain functions from the server's answers to lines that know their statement. */
import type { ClEntry, Clearance, Motion, RunResult, Tape } from '../protocol';

/** Lines of text; `isn[i]` is the statement that line `i` comes from, if one. */
export class Listing {
  private readonly lines: string[] = [];
  private readonly statements: (number | undefined)[] = [];

  add(line: string, isn?: number | null): void {
    this.lines.push(line);
    this.statements.push(isn ?? undefined);
  }

  get text(): string {
    return this.lines.join('\n') + '\n';
  }

  get isn(): readonly (number | undefined)[] {
    return this.statements;
  }
}

/** Words whose operand is text: no slash follows them. */
const TEXT_WORDS = new Set(['PARTNO', 'PPRINT', 'INSERT', 'REMARK', 'TITLES']);

/** Decimals of lengths in the report; the CL file has them in full. */
const REPORT_DECIMALS = 6;

/** Code of the record that holds the circle of the points behind it. */
const CIRCLE_RECORD = 3000;

/** A value of the CL file: the shortest decimals that read back as the same double, always with a point. */
function clValue(value: string | number): string {
  const text = String(value);
  return typeof value === 'number' && Number.isInteger(value) && !text.includes('e') ? `${text}.0` : text;
}

const clValues = (values: (string | number)[]): string => values.map(clValue).join(',');

/** A CL entry as the APT CL text that `apt-lsp run --format cl` writes, in full precision. */
export function clText(entry: ClEntry): string[] {
  const verb = entry.type === 'from' ? 'FROM' : 'GOTO';
  const points = (entry.points ?? []).map((point) => `${verb}/${clValues(point)}`);
  if (points.length > 0) {
    return points;
  }
  const words = entry.words ?? [];
  const [major, ...operands] = words;
  if (typeof major === 'string') {
    if (operands.length === 0) {
      return [major];
    }
    return [TEXT_WORDS.has(major) ? `${major} ${operands.join(' ')}` : `${major}/${clValues(operands)}`];
  }
  const code = typeof entry.code === 'number' ? [entry.code] : (entry.code ?? []);
  if (words.length > 0 && code[0] === CIRCLE_RECORD) {
    return [`CIRCLE/${clValues(words)}`];
  }
  if (entry.type === 'fini') {
    return ['FINI'];
  }
  return [`$$ ${entry.type} ${clValues([...code, ...words])}`.trimEnd()];
}

/** The CL file of a run. */
export function clListing(result: RunResult): Listing {
  const listing = new Listing();
  for (const entry of result.cl) {
    for (const line of clText(entry)) {
      listing.add(line, entry.isn);
    }
  }
  if (result.cl.length === 0) {
    listing.add('$$ no CL records');
  }
  return listing;
}

/** The control tape. */
export function tapeListing(tape: Tape): Listing {
  const listing = new Listing();
  tape.blocks.forEach((block, index) => listing.add(block, tape.origin[index]));
  return listing;
}

const fixed = (value: number): string => (Math.abs(value) < 0.5e-6 ? 0 : value).toFixed(REPORT_DECIMALS);

function clearance(name: string, band: Clearance | null | undefined): string | undefined {
  if (band === null || band === undefined) {
    return undefined;
  }
  return `${name} ${fixed(band.min)} … ${fixed(band.max)} in [${fixed(-band.intol)}, ${fixed(band.outtol)}]`;
}

/** What one motion came to: the verdict, then one line per surface. */
export function motionSummary(motion: Motion): string[] {
  const least = motion.minimum === null || motion.minimum === undefined ? '' : ` (least ${motion.minimum})`;
  const vectors = `${motion.cut_vectors} cut vector${motion.cut_vectors === 1 ? '' : 's'}${least}`;
  const bands = [clearance('part ', motion.part), clearance('drive', motion.drive), clearance('check', motion.check)];
  return [
    `${motion.verified ? 'verified' : 'NOT VERIFIED'}, ${vectors}`,
    ...bands.filter((band) => band !== undefined),
  ];
}

/** How much of a run is proven. */
function verdict(result: RunResult): string {
  const all = result.motions.length;
  const verified = result.motions.filter((motion) => motion.verified).length;
  const proof = `${verified} of ${all} motions verified`;
  return result.ok ? proof : `errors in the program; ${proof}`;
}

/** The report of a run: verdict, findings, motions with their proof, CL points. */
export function motionListing(result: RunResult): Listing {
  const listing = new Listing();
  listing.add(`${result.program}: ${verdict(result)}`);
  const totals = result.totals;
  if (totals?.points !== undefined) {
    const parts = [`${totals.points} points`];
    if (totals.length !== undefined) parts.push(`length ${fixed(totals.length)}`);
    if (totals.cut_length !== undefined) parts.push(`cutting ${fixed(totals.cut_length)}`);
    if (totals.rapid_length !== undefined) parts.push(`rapid ${fixed(totals.rapid_length)}`);
    if (typeof totals.time_minutes === 'number') parts.push(`${totals.time_minutes.toFixed(2)} minutes`);
    listing.add(parts.join(', '));
  }
  if (result.diagnostics.length > 0) {
    listing.add('');
    listing.add('Findings');
    for (const finding of result.diagnostics) {
      const place = typeof finding.isn === 'number' ? ` in statement ${finding.isn}` : '';
      listing.add(`  ${finding.severity} ${finding.code}${place}: ${finding.message}`, finding.isn);
    }
  }
  listing.add('');
  listing.add('Motions');
  for (const motion of result.motions) {
    listing.add(`${String(motion.isn).padStart(6)}  ${motion.statement}`, motion.isn);
    for (const line of motionSummary(motion)) {
      listing.add(`        ${line}`, motion.isn);
    }
  }
  listing.add('');
  listing.add('CL points');
  for (const entry of result.cl) {
    for (const point of entry.points ?? []) {
      const numbers = point.map((value) => fixed(value).padStart(13)).join('');
      listing.add(`${String(entry.isn).padStart(6)}  ${(entry.surface ?? entry.type).padEnd(8)}${numbers}`, entry.isn);
    }
  }
  return listing;
}
