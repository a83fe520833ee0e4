// Form with a control for each parameter of the server, with its name and range.

import { element } from './elements';
import { type Frozen, shortest } from './link';
import { defaultOf, faultOf, type ParameterKind, rangeOf, type Values } from './parameters';

const groups: Record<string, string> = { '': 'Refinement', view: 'View', output: 'Output' };

export class ParameterForm {
  /// Function called when the user sets or resets a parameter.
  onChange: (name: string, value: string | null) => void = () => {};
  #form: HTMLFormElement;
  #names = '';
  #rows = new Map<string, { kind: ParameterKind; input: HTMLInputElement | HTMLSelectElement; fault: HTMLElement }>();
  #placeholders = new Map<string, string>();
  #placeholdersDue: ReturnType<typeof setTimeout> | undefined;

  constructor(form: HTMLFormElement) {
    this.#form = form;
    form.addEventListener('submit', (event) => event.preventDefault());
  }

  /// Sets the parameters. Equal ones keep their controls: new ones cost a layout of the page.
  setKinds(kinds: readonly ParameterKind[]): void {
    const names = kinds.map(({ name }) => name).join();
    if (names === this.#names) return;
    this.#names = names;
    this.#rows.clear();
    const sections = Object.entries(groups).map(([prefix, title]) => {
      const section = element('fieldset');
      section.append(element('legend', '', title));
      for (const kind of kinds)
        if ((kind.name.includes('.') ? kind.name.split('.')[0] : '') === prefix) section.append(this.#row(kind));
      return section;
    });
    this.#form.replaceChildren(...sections);
  }

  /// Sets the controls; parameters absent from `values` show their defaults.
  setValues(values: Values): void {
    for (const [name, { kind, input }] of this.#rows) {
      const text = values.get(name);
      if (input instanceof HTMLInputElement && input.type === 'checkbox')
        input.checked = (text ?? defaultOf(kind)) === 'true';
      else if (input !== document.activeElement) input.value = text ?? (kind.type === 'choice' ? defaultOf(kind) : '');
      this.setFault(name, text === undefined ? null : faultOf(kind, text));
    }
  }

  /// Shows the view where its parameters are not set. Waits until none has come for 100 ms: one comes with each picture,
  /// and its texts cost a layout of the page.
  setView({ eye, target, pixels }: Frozen): void {
    this.#placeholders.set('view.eye', eye.map(shortest).join(','));
    this.#placeholders.set('view.target', target.map(shortest).join(','));
    this.#placeholders.set('view.viewport', pixels.join(','));
    clearTimeout(this.#placeholdersDue);
    this.#placeholdersDue = setTimeout(() => this.#showPlaceholders(), 100);
  }

  /// Shows a fault at a parameter; null: none.
  setFault(name: string, fault: string | null): void {
    const row = this.#rows.get(name);
    if (row === undefined) return;
    row.fault.textContent = fault ?? '';
    row.input.setAttribute('aria-invalid', String(fault !== null));
  }

  #showPlaceholders(): void {
    for (const [name, text] of this.#placeholders) {
      const input = this.#rows.get(name)?.input;
      if (input instanceof HTMLInputElement) input.placeholder = text;
    }
    this.#placeholders.clear();
  }

  #row(kind: ParameterKind): HTMLElement {
    const row = element('div', 'parameter');
    const id = `parameter-${kind.name}`;
    // Label in words, and name as in requests.
    const label = element('label', '', kind.description.split(/[;:.]( |$)/)[0]);
    if (kind.unit) label.append(` (${kind.unit})`);
    label.append(' ', element('code', '', kind.name));
    label.htmlFor = id;
    const input = inputFor(kind);
    input.id = id;
    input.name = kind.name;
    const help = element('p', 'help', `${kind.description}.`);
    help.id = `${id}-help`;
    const range = rangeOf(kind);
    if (range) help.textContent += ` ${range[0].toUpperCase()}${range.slice(1)}.`;
    if (kind.default_text) help.textContent += ` Default ${kind.default_text}.`;
    const fault = element('p', 'fault');
    fault.id = `${id}-fault`;
    fault.setAttribute('role', 'alert');
    input.setAttribute('aria-describedby', `${help.id} ${fault.id}`);
    row.title = help.textContent ?? '';
    input.addEventListener('change', () => this.#changed(kind, input));
    row.append(label, input, fault, help);
    this.#rows.set(kind.name, { kind, input, fault });
    return row;
  }

  #changed(kind: ParameterKind, input: HTMLInputElement | HTMLSelectElement): void {
    const isBox = input instanceof HTMLInputElement && input.type === 'checkbox';
    const text = isBox ? String(input.checked) : input.value.trim().replaceAll(/\s*,\s*|\s+/g, ',');
    const isDefault = text === '' || ((isBox || kind.type === 'choice') && text === defaultOf(kind));
    const fault = isDefault ? null : faultOf(kind, text);
    this.setFault(kind.name, fault);
    if (fault === null) this.onChange(kind.name, isDefault ? null : text);
  }
}

function inputFor(kind: ParameterKind): HTMLInputElement | HTMLSelectElement {
  if (kind.type === 'choice') {
    const select = document.createElement('select');
    for (const choice of kind.choices!) select.add(new Option(choice, choice));
    return select;
  }
  const input = document.createElement('input');
  if (kind.type === 'boolean') {
    input.type = 'checkbox';
    return input;
  }
  if (kind.type === 'integer') {
    input.type = 'number';
    input.min = String(kind.min ?? '');
    input.max = String(kind.max ?? '');
    input.step = '1';
  } else {
    input.type = 'text';
    input.inputMode = 'decimal';
    input.autocomplete = 'off';
    input.spellcheck = false;
  }
  input.placeholder = defaultOf(kind) || (kind.default_text ?? '').replace(/[:;].*/, '');
  return input;
}
