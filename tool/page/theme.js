// Colours of the page, from style.css, so that the 3-D view and the plots follow the light or dark colour scheme.

const dark = matchMedia("(prefers-color-scheme: dark)");

/// Returns the value of a CSS variable, such as `--finger-1`.
export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

/// Calls `changed` now, and whenever the colours change.
export function onColours(changed) {
  dark.addEventListener("change", changed);
  changed();
}

export function isDark() {
  return dark.matches;
}
