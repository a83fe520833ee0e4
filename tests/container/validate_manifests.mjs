// validate_manifests.mjs FILE: what `kubectl kustomize` printed, checked against Kubernetes' own schemas (their JSON
// schema: what is there is right) and types (the compiler: nothing is there that does not exist). Prints a line for each
// object, "Kind/name", and on standard error what is wrong with it; fails when anything is.
import { readFileSync, mkdtempSync, writeFileSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { spawnSync } from 'node:child_process';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseAllDocuments } from 'yaml';

const here = dirname(fileURLToPath(import.meta.url));
const require = createRequire(import.meta.url);
const objects = parseAllDocuments(readFileSync(process.argv[2], 'utf8')).map((document) => {
  if (document.errors.length > 0) throw document.errors[0];
  return document.toJS();
});
let wrong = 0;
const refuse = (name, text) => {
  wrong++;
  console.error(`${name}: ${text}`);
};

const typed = [];
for (const [index, object] of objects.entries()) {
  if (object.kind === 'Secret') {
    // Kustomize 5 breaks long values into lines, which Kubernetes takes and the schema's base64 does not.
    for (const key of Object.keys(object.data ?? {})) object.data[key] = object.data[key].replace(/\s/g, '');
  }
  const name = `${object.kind}/${object.metadata?.name}`;
  console.log(name);
  const module = `kubernetes-models/${object.apiVersion}`;
  let model;
  try {
    model = require(module)[object.kind];
  } catch {
    model = undefined;
  }
  if (model === undefined) {
    refuse(name, `there is no ${object.kind} in ${object.apiVersion}`);
    continue;
  }
  try {
    new model(object).validate();
  } catch (error) {
    refuse(name, error.message);
  }
  typed.push(
    `import type { I${object.kind} as T${index} } from "${module}";`,
    `export const object${index}: T${index} = ${JSON.stringify(object, null, 1)};`,
  );
}

// Beside node_modules, where the compiler looks for the types.
const folder = mkdtempSync(join(here, 'node_modules', '.manifests-'));
try {
  const file = join(folder, 'manifests.ts');
  writeFileSync(file, typed.join('\n'));
  const options = ['--noEmit', '--strict', '--skipLibCheck', '--module', 'nodenext', '--moduleResolution', 'nodenext'];
  const compiler = spawnSync(process.execPath, [require.resolve('typescript/bin/tsc'), ...options, file]);
  if (compiler.status !== 0) refuse('types', compiler.stdout.toString());
} finally {
  rmSync(folder, { recursive: true });
}
process.exit(wrong === 0 ? 0 : 1);
