// SPDX-License-Identifier: GPL-3.0-or-later
// What is looked at, in the address's fragment: who opens the same file with it sees the same.

let heard = /** @type {(changed: Set<string>) => void} */ (() => {});
let values = new URLSearchParams(location.hash.slice(1));

/** @param {string} key */
export const get = (key, otherwise = '') => values.get(key) ?? otherwise;
/** @param {string} key */
export const on = (key, otherwise = false) => get(key, otherwise ? '1' : '') === '1';
/** @param {(changed: Set<string>) => void} listener */
export const listen = (listener) => heard = listener;

/** @param {URLSearchParams} next */
function become(next, quiet = false) {
  const changed = new Set([...values.keys(), ...next.keys()].filter((key) => values.get(key) !== next.get(key)));
  values = next;
  if (changed.size && !quiet) heard(changed);
}

/**
 * Changes values and tells who listens; an empty one is left out.
 * @param {Record<string, string|number|boolean>} changes @param {boolean} quiet true: nobody is told
 */
export function set(changes, quiet = false) {
  const next = new URLSearchParams(values);
  for (const [key, value] of Object.entries(changes)) {
    next.set(key, value === true ? '1' : value === false ? '0' : String(value));
    if (value === '') next.delete(key);
  }
  history.replaceState(null, '', '#' + next);
  become(next, quiet);
}

addEventListener('hashchange', () => become(new URLSearchParams(location.hash.slice(1))));
