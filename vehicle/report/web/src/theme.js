// Colours of the style sheet, for canvases, which are redrawn when the scheme changes.

const scheme = window.matchMedia("(prefers-color-scheme: dark)");

export function colour(name) {
  return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
}

export function onSchemeChange(action) {
  scheme.addEventListener("change", action);
}
