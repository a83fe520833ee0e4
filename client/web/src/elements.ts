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

/// One of the page, which must have it.
export function find<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}
