// SPDX-License-Identifier: GPL-3.0-or-later
// What is looked at, in the address's fragment: who opens the same file with it sees the same.

/** @type {Set<(changed: Set<string>) => void>} */
const listeners = new Set();
let values = new URLSearchParams(location.hash.slice(1));

/** @param {string} key */
export const get = (key, otherwise = '') => values.get(key) ?? otherwise;

/** @param {string} key */
export const on = (key, otherwise = false) => get(key, otherwise ? '1' : '') === '1';

/**
 * Changes values and tells who listens; an empty one is left out.
 * @param {Record<string, string|number|boolean>} changes
 * @param {boolean} quiet true: nobody is told
 */
export function set(changes, quiet = false) {
  const changed = new Set();
  for (const [key, value] of Object.entries(changes)) {
    const text = value === true ? '1' : value === false ? '0' : String(value);
    if (get(key) === text) continue;
    changed.add(key);
    if (text === '')
      values.delete(key);
    else
      values.set(key, text);
  }
  if (changed.size === 0) return;
  history.replaceState(null, '', '#' + values.toString());
  if (!quiet)
    for (const listener of listeners) listener(changed);
}

/** @param {(changed: Set<string>) => void} listener */
export const listen = (listener) => listeners.add(listener);

addEventListener('hashchange', () => {
  const before = values;
  values = new URLSearchParams(location.hash.slice(1));
  const keys = [...before.keys(), ...values.keys()];
  const changed = new Set(keys.filter((key) => before.get(key) !== values.get(key)));
  for (const listener of listeners) listener(changed);
});
