// SPDX-License-Identifier: GPL-3.0-or-later
// Elements, and text of others, which is never markup.

const HIDDEN =
  /[\u0000-\u0008\u000b-\u001f\u007f-\u009f\u00ad\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb]/g;

/**
 * Text that cannot hide: characters without a shape, as those that turn the direction of writing, become marks; a long
 * one is cut. @param {any} text @param {number} most
 */
export function plain(text, most = 400) {
  const cut = String(text ?? '').slice(0, most + 1);
  const shown =
    cut.replace(HIDDEN, (c) => `\u27e6${c.charCodeAt(0).toString(16).toUpperCase().padStart(4, '0')}\u27e7`);
  return shown.length > most && cut.length > most ? shown.slice(0, most) + '\u2026' : shown;
}

/**
 * An element; text children become text nodes. options: on... are listeners, others attributes. @param {string} tag
 * @param {Record<string, any>} [options] @param {...any} children @return {any}
 */
export function make(tag, options = {}, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(options)) {
    if (name.startsWith('on'))
      node.addEventListener(name.slice(2), value);
    else if (name === 'value' || name === 'checked')
      /** @type {any} */ (node)[name] = value;
    else if (value !== false && value !== undefined)
      node.setAttribute(name, value === true ? '' : plain(value, 2000));
  }
  return fill(node, ...children);
}

/** Changes the children of an element; the new one of the same name keeps the focus. @param {any} node */
function refocused(node, change) {
  const had = node.contains(document.activeElement) ? document.activeElement : null;
  const name = (of) => of.id || of.ariaLabel || of.dataset.key;
  change();
  if (had && had !== document.activeElement)
    [...node.querySelectorAll(had.localName)].find((each) => name(each) && name(each) === name(had))?.focus();
  return node;
}

/** Replaces the children of an element. @param {any} node @param {...any} children */
export function fill(node, ...children) {
  const wanted =
    children.flat(2).filter((child) => child !== null && child !== undefined && child !== false && child !== '');
  const texts = wanted.map((child) => child instanceof Node ? child : plain(child, 4000));
  return refocused(node, () => node.replaceChildren(...texts));
}

/** As fill, but keeps children that look the same, so that no click on them is lost. @param {any} node */
export function refill(node, ...children) {
  const old = [...node.children], made = [...fill(node.cloneNode(false), ...children).children];
  refocused(node, () => {
    made.forEach((child, i) => !old[i] ? node.append(child) : old[i].isEqualNode(child) || old[i].replaceWith(child));
    old.slice(made.length).forEach((child) => child.remove());
  });
}

/** @param {string} id @return {any} */
export const byId = (id) => document.getElementById(id);
/** A quiet paragraph. @param {any} text */
export const aside = (text) => make('p', {class: 'quiet'}, text);
/** @param {any} text @param {(event: any) => any} run @param {Record<string, any>} options */
export const button = (text, run, options = {}) => make('button', {onclick: run, ...options}, text);
/** The index of the place that is nearest to x, y. @param {number[][]} places */
export const nearest = (places, x, y) => places.reduce(
  (best, at, i) => Math.hypot(at[0] - x, at[1] - y) < Math.hypot(places[best][0] - x, places[best][1] - y) ? i : best,
  0);

/** The words of a name of the API. @param {any} name */
export const words = (name) => String(name ?? '').replace(/_/g, ' ');

/** A number for people. @param {any} value @param {number} digits */
export function number(value, digits = 6) {
  if (typeof value !== 'number' || !Number.isFinite(value)) return '\u2013';
  if (Number.isInteger(value) && Math.abs(value) < 1e9) return String(value).replace('-', '\u2212');
  const text = value.toPrecision(digits);
  return (text.includes('e') ? text.replace(/\.?0+e/, 'e') : text.replace(/\.?0+$/, '')).replace(/-/g, '\u2212');
}

/** A number, German or English: 1.234,5 and 1,234.5 are the same. NaN if it is none. @param {string} text */
export function parse(text) {
  let digits = text.trim().replace(/[\s'\u00a0\u202f]/g, '').replace(/[\u2212\u2013]/g, '-');
  const comma = digits.lastIndexOf(','), point = digits.lastIndexOf('.');
  if (comma >= 0 && point >= 0)
    digits = digits.replace(comma > point ? /\./g : /,/g, '');
  else if (digits.split(',').length > 2 || digits.split('.').length > 2)
    digits = digits.replace(/[.,]/g, '');
  return digits === '' ? NaN : Number(digits.replace(',', '.'));
}

/**
 * A labelled choice. options: value and text of each.
 * @param {string} label @param {[string, any][]} options @param {string} value @param {(to: string) => void} changed
 */
export function choice(label, options, value, changed) {
  const select = make('select', {onchange: (event) => changed(event.target.value)},
    ...options.map(([key, text]) => make('option', {value: key}, plain(text, 60))));
  select.value = value;
  return make('label', {}, label + ' ', select);
}

/** @param {string} label @param {number[]} range lowest, highest, step @param {number} value @param {any} options */
export const slider = (label, [min, max, step], value, options) =>
  make('input', {type: 'range', min, max, step, 'aria-label': label, ...options, value});

/** A labelled box to tick. @param {string} label @param {boolean} checked @param {(on: boolean) => void} changed */
export const tick = (label, checked, changed) => make('label', {class: 'tick'},
  make('input', {type: 'checkbox', checked, onchange: (event) => changed(event.target.checked)}), ' ' + label);
