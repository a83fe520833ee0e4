// Making elements of the page.

/// An element with a class and a text.
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

/// A labelled checkbox or radio button at the end of `parent`.
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

/// One of the page, which must have it.
export function find<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}
