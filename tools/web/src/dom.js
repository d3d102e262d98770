// Elements without markup: whatever a file's name holds, it only ever becomes text.

const SVG = 'http://www.w3.org/2000/svg';

function fill(node, properties, children) {
  for (const [key, value] of Object.entries(properties ?? {})) {
    if (value === undefined || value === null || value === false) continue;
    if (key === 'class') node.setAttribute('class', value);
    else if (key.startsWith('on')) node.addEventListener(key.slice(2), value);
    else if (key === 'dataset') Object.assign(node.dataset, value);
    else if (key in node && typeof node[key] === 'boolean') node[key] = value;
    else node.setAttribute(key, value === true ? '' : value);
  }
  node.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

export const el = (tag, properties, ...children) => fill(document.createElement(tag), properties, children);
export const svg = (tag, properties, ...children) => fill(document.createElementNS(SVG, tag), properties, children);

const GLYPHS = {
  accept: 'M3 8.5 6.5 12 13 4.5',
  reject: 'M4 4l8 8M12 4l-8 8',
  play: 'M5 3.5v9l7.5-4.5z',
  pause: 'M5 3.5v9M11 3.5v9',
  back: 'M10 3 5 8l5 5',
  next: 'M6 3l5 5-5 5',
  first: 'M11 3 6 8l5 5M4 3v10',
  loop: 'M3 8a5 5 0 0 1 8.5-3.5L13 6M13 3v3h-3M13 8a5 5 0 0 1-8.5 3.5L3 10M3 13v-3h3',
  pin: 'M2.5 3h4.5v10H2.5zM9 3h4.5v10H9z',
  theme: 'M8 2.5a5.5 5.5 0 1 0 5.5 5.5A4.2 4.2 0 0 1 8 2.5z',
  save: 'M8 2.5v7M5 7l3 3 3-3M3 13h10',
  open: 'M8 10V3M5 5.5l3-3 3 3M3 13h10',
  help: 'M6 6a2 2 0 1 1 2.6 1.9c-.5.2-.6.6-.6 1.1M8 12v.1',
  up: 'M8 13V3M4 7l4-4 4 4',
  down: 'M8 3v10M4 9l4 4 4-4',
  comment: 'M3 3.5h10v7H7l-3 2.5v-2.5H3z',
};
export const glyph = (name) =>
  svg('svg', { class: 'glyph', viewBox: '0 0 16 16', 'aria-hidden': 'true' }, svg('path', { d: GLYPHS[name] }));

/// A path relative to the page as an address, each of its parts escaped.
export const address = (path) => path.split('/').map(encodeURIComponent).join('/');

export const key = (name) => el('kbd', { 'aria-hidden': 'true' }, name);
