// SPDX-License-Identifier: GPL-3.0-or-later
// What is asked of the page's server.
import {byId, fill, make, plain} from './dom.js';

/** Says something above the page until it is taken away. @param {any} text a text or an error */
export function notice(text) {
  const line = make('p', {}, text instanceof Error ? text.message : String(text),
    make('button', {'aria-label': 'close', onclick: () => line.remove()}, '\u00d7'));
  byId('notices').append(line);
  while (byId('notices').children.length > 4) byId('notices').firstChild.remove();
}

/** @param {{server: string, lost: string, met: boolean}} told met: whether the server has ever answered */
function connection({server, lost, met}) {
  const line = byId('connection'), before = line.className;
  if (lost && !met) return fill(line, `no server answers at ${plain(server, 60)}`);
  line.className = lost ? 'lost' : '';
  fill(
    line, lost ? `connection lost: ${plain(lost, 120)}` : plain(server, 60) + (before ? ': connection restored' : ''));
}

/** Takes away what was said. */
export const quiet = () => fill(byId('notices'));
/** @param {string} path @param {Record<string, any>} query */
export const address = (path, query = {}) => `/api/${path}?${new URLSearchParams(query)}`;

/** @param {string} where @param {any} [options] */
async function answered(where, options) {
  const answer =
    await fetch(where, options).catch(() => { throw new Error('anticrack view has ended; start it again'); });
  if (answer.ok) return answer;
  const text = await answer.text();
  throw new Error(text.startsWith('{') ? JSON.parse(text).error : text);
}

/** @param {string} path @param {Record<string, any>} query @return {Promise<any>} */
export const ask = async (path, query = {}) => (await answered(address(path, query))).json();

/** @param {string} path @param {any} body @return {Promise<any>} */
export const post = async (path, body) =>
  (await answered(`/api/${path}`, {method: 'POST', body: JSON.stringify(body)})).json();

/** @type {Map<string, Promise<any>>} */ const kept = new Map();
const MOST = 24;

/** An array of a result, typed; the last are kept. @param {Record<string, any>} query @return {Promise<any>} */
export function array(query) {
  const where = address('array', query);
  const found = kept.get(where) ?? answered(where).then(async (answer) => {
    const buffer = await answer.arrayBuffer();
    const values = answer.headers.get('X-Array') === 'i4' ? new Int32Array(buffer) : new Float64Array(buffer);
    return Object.assign(values, {range: (answer.headers.get('X-Range') || '0 1 1').split(' ').map(Number)});
  });
  kept.delete(where);
  kept.set(where, found);
  found.catch(() => kept.delete(where));
  if (kept.size > MOST) kept.delete(/** @type {string} */ (kept.keys().next().value));
  return found;
}

/**
 * Listens to server-sent events; the browser restores a lost connection. Returns what ends it.
 * @param {string} path @param {Record<string, any>} query @param {() => void} after each event
 * @param {Record<string, (data: any) => void>} handlers
 */
export function events(path, query, after, handlers) {
  const source = new EventSource(address(path, query));
  const data = (event) => JSON.parse(event.data);
  for (const [name, handle] of Object.entries(handlers))
    source.addEventListener(name, (event) => {
      handle(data(event));
      after();
    });
  source.addEventListener('connection', (event) => connection(data(event)));
  source.onerror = () => connection({server: '', met: true, lost: 'anticrack view does not answer; trying again'});
  return () => source.close();
}
