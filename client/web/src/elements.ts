// Elements of the page.

/// Makes an element with a class and a text.
export function element<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  className = '',
  text = '',
): HTMLElementTagNameMap[Tag] {
  const made = document.createElement(tag);
  if (className) made.className = className;
  made.textContent = text;
  return made;
}

export function button(text: string, onClick: (button: HTMLButtonElement) => void, className = ''): HTMLButtonElement {
  const made = element('button', className, text);
  made.type = 'button';
  made.addEventListener('click', () => onClick(made));
  return made;
}

/// Adds a labelled checkbox or radio button at the end of `parent`.
export function addChoice(
  parent: HTMLElement,
  attributes: { type: string; name: string; value: string },
  title: string,
  onChange: (isOn: boolean) => void,
): void {
  const label = element('label');
  const input = element('input');
  Object.assign(input, attributes);
  input.addEventListener('change', () => onChange(input.checked));
  label.append(input, element('span', '', title));
  parent.append(label);
}

/// Returns an element that the page must have.
export function find<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

/// Sets the children of an element; they must have no listeners. Keeps equal children at their places; of others, sets
/// only the texts and attributes that differ: new elements cost far more layout.
export function setChildren(parent: Element, wanted: Iterable<Node>): void {
  let own = parent.firstChild;
  for (const node of wanted) {
    const next: ChildNode | null = own && own.nextSibling;
    if (own === null) parent.append(node);
    else change(own, node);
    own = next;
  }
  while (own !== null) {
    const next = own.nextSibling;
    own.remove();
    own = next;
  }
}

function change(own: ChildNode, wanted: Node): void {
  if (own.isEqualNode(wanted)) return;
  if (own instanceof Text && wanted instanceof Text) own.data = wanted.data;
  else if (own instanceof HTMLElement && wanted instanceof HTMLElement && own.tagName === wanted.tagName) {
    setAttributes(own, wanted);
    setChildren(own, [...wanted.childNodes]);
  } else own.replaceWith(wanted);
}

function setAttributes(own: HTMLElement, wanted: HTMLElement): void {
  for (const name of own.getAttributeNames()) if (!wanted.hasAttribute(name)) own.removeAttribute(name);
  for (const name of wanted.getAttributeNames()) {
    const value = wanted.getAttribute(name)!;
    if (own.getAttribute(name) === value) continue;
    if (name === 'style')
      own.style.cssText = value; // a policy may forbid the attribute
    else own.setAttribute(name, value);
  }
}
