/// Returns an element with a class and children, which may be texts. Texts are never read as HTML.
export function element(tag, className, ...children) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  made.append(...children);
  return made;
}
