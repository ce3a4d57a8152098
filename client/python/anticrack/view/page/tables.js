// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of numbers, sorted by a click on a head.
import {aside, button, choice, fill, make, number, plain} from './dom.js';
import {model, tables} from './model.js';
import {address} from './net.js';
import {get, set} from './state.js';

const ROWS = 200;

/**
 * The indices of the rows in the order that is asked for; unknown values come last.
 * @param {any} column @param {number} count @param {boolean} down
 */
function ordered(column, count, down) {
  const rows = Array.from({length: count}, (_, i) => i), known = (value) => value !== null && value !== '';
  return !column ? rows : rows.sort((i, j) => {
    const [a, b] = [column.values[i], column.values[j]];
    if (!known(a) || !known(b)) return Number(known(b)) - Number(known(a));
    return (down ? -1 : 1) * (typeof a === 'number' ? a - b : String(a).localeCompare(String(b))) || i - j;
  });
}

/** @param {any} panel @param {() => boolean} wanted */
export async function draw(panel, wanted) {
  const all = await tables();
  if (!wanted()) return;
  const table = all.find((each) => each.name === get('table')) ?? all[0];
  if (!table) return fill(panel, aside('This result has no numbers.'));
  const [, sorted, direction] = /^(.*) (up|down)$/.exec(get('sort')) ?? [], down = direction === 'down';
  const at = table.columns.findIndex((column) => column.name === sorted);
  const count = table.columns[0].values.length, most = Number(get('rows')) || ROWS;
  const rows = ordered(table.columns[at], count, down).slice(0, most);
  const order = (i) => i !== at ? 0 : down ? 2 : 1;
  const head =
    table.columns.map(
      (column, i) =>
        make('th', {scope: 'col', 'aria-sort': ['none', 'ascending', 'descending'][order(i)], title: column.meaning},
          button(
            [
              plain(column.name, 60), column.unit === '-' ? null : make('small', {}, ` ${plain(column.unit, 30)}`),
              ['', ' \u25b4', ' \u25be'][order(i)]
            ],
            () => set({sort: `${column.name} ${i === at && !down ? 'down' : 'up'}`}))));
  const cell = (value) => typeof value === 'number'
    ? make('td', {class: 'number', title: String(value)}, number(value, 7))
    : make('td', {}, plain(value === null ? '\u2013' : value, 200));
  fill(panel,
    make('div', {class: 'controls'},
      choice('table', all.map((each) => [each.name, each.name]), table.name, (name) => set({table: name, sort: ''})),
      make(
        'a', {class: 'button', href: address('csv', {of: model.of, table: table.name}), download: true}, 'Save as CSV'),
      make('span', {class: 'quiet'},
        `${count} row${count === 1 ? '' : 's'}; a click on a name sorts; the pointer on it tells what it is`)),
    make('div', {class: 'wide'},
      make('table', {}, make('thead', {}, make('tr', {}, head)),
        make('tbody', {}, rows.map((row) => make('tr', {}, table.columns.map((column) => cell(column.values[row]))))))),
    count > most && button(`show more of the ${count - most} others`, () => set({rows: most + 5 * ROWS})));
}
