// Parameters of a refinement, as texts of the query.

/// Parameter as the server describes it.
export interface ParameterKind {
  name: string;
  type: 'integer' | 'number' | 'numbers' | 'boolean' | 'choice';
  min?: number;
  max?: number;
  least?: number;
  most?: number;
  group?: number;
  unit?: string;
  choices?: string[];
  default: unknown;
  default_text?: string;
  description: string;
}

/// Values by the parameters' names, without defaults.
export type Values = Map<string, string>;

/// Returns the query, in the order of the server's table.
export function queryOf(values: Values, kinds: readonly ParameterKind[]): string {
  return kinds
    .filter((kind) => values.has(kind.name))
    .map((kind) => `${kind.name}=${encodeURIComponent(values.get(kind.name)!).replaceAll('%2C', ',')}`)
    .join('&');
}

/// Returns why a text is not a value of the parameter; null if it is one.
export function faultOf(kind: ParameterKind, text: string): string | null {
  if (kind.type === 'choice') return kind.choices!.includes(text) ? null : `One of ${kind.choices!.join(', ')}.`;
  if (kind.type === 'boolean') return text === 'true' || text === 'false' ? null : 'true or false.';
  const numbers = text.split(',').map((part) => (part.trim() === '' ? NaN : Number(part)));
  const isList = kind.type === 'numbers';
  if (numbers.some((n) => !Number.isFinite(n))) return isList ? 'Numbers, divided by commas.' : 'A number.';
  const [least, most] = isList ? [kind.least ?? 1, kind.most ?? 1] : [1, 1];
  if (numbers.length < least || numbers.length > most || numbers.length % (kind.group ?? 1) !== 0)
    return `${countOf(kind)}, divided by commas.`;
  if (kind.type === 'integer' && !numbers.every(Number.isInteger)) return 'A whole number.';
  const isInRange = (n: number) => n >= (kind.min ?? -Infinity) && n <= (kind.max ?? Infinity);
  return numbers.every(isInRange) ? null : `${rangeOf(kind)}.`;
}

/// Returns the range: "0 to 10", "3 numbers, mesh units".
export function rangeOf(kind: ParameterKind): string {
  if (kind.type === 'boolean' || kind.type === 'choice') return '';
  const parts: string[] = [];
  if (kind.type === 'numbers') parts.push(countOf(kind));
  // The largest float stands for no limit.
  const [low, high] = [kind.min ?? -Infinity, kind.max ?? Infinity].map((n) => (Math.abs(n) > 1e15 ? null : n));
  if (low !== null && high !== null) parts.push(`${low} to ${high}`);
  else if (low !== null) parts.push(`at least ${low}`);
  if (kind.unit) parts.push(kind.unit);
  return parts.join(', ');
}

function countOf(kind: ParameterKind): string {
  const each = kind.group ?? 1;
  const [least, most] = [(kind.least ?? 1) / each, (kind.most ?? 1) / each];
  const what = each > 1 ? `times ${each} numbers` : 'numbers';
  return least === most ? `${least} ${what}` : `${least} to ${most} ${what}`;
}

/// Returns the default as in the query; empty if it depends on other parameters or on the mesh.
export function defaultOf(kind: ParameterKind): string {
  return Array.isArray(kind.default) ? kind.default.join(',') : String(kind.default ?? '');
}
