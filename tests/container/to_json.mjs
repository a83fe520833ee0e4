// to_json.mjs FILE [KIND...]: what `kubectl kustomize` printed, an object of JSON a line; only of these kinds, if any.
import { readFileSync } from 'node:fs';
import { parseAllDocuments } from 'yaml';

const [file, ...kinds] = process.argv.slice(2);
for (const document of parseAllDocuments(readFileSync(file, 'utf8'))) {
  const object = document.toJS();
  if (kinds.length === 0 || kinds.includes(object.kind)) console.log(JSON.stringify(object));
}
