// Parameters of a refinement, for client and kernel.

type Value = string | number | boolean | readonly number[];
/// Parameters of a refinement, as in the service's JSON: `{ levels: 3, view: { eye: [0, 0, 3] } }`.
export interface Parameters {
  [name: string]: Value | { [name: string]: Value };
}

/// Returns the parameters as a query: "levels=3&view.eye=0,0,3". A string must be a query.
export function queryOf(parameters: Parameters | string): string {
  if (typeof parameters === 'string') return parameters;
  const fields: string[] = [];
  const add = (name: string, value: Value) => fields.push(`${name}=${encodeURIComponent(String(value))}`);
  for (const [name, value] of Object.entries(parameters)) {
    if (typeof value !== 'object' || Array.isArray(value)) add(name, value as Value);
    else for (const [inner, of] of Object.entries(value)) add(`${name}.${inner}`, of);
  }
  return fields.join('&');
}
