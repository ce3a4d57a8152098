// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a sweep and steps of growth: any column against any other; a click chooses a row.
import {Lines} from './chart.js';
import {choice, fill, make, number, plain} from './dom.js';
import {mark} from './membrane.js';
import {currentLoad, model, tables} from './model.js';
import {LINES} from './palette.js';
import {get, set} from './state.js';

const GROWTH = 'position';
/** @type {Lines|null} */
let chart = null;

/** @param {any} panel @param {() => boolean} wanted @param {'sweep'|'growth'} kind */
export async function draw(panel, wanted, kind) {
  const table = (await tables()).find((each) => each.name === kind);
  if (!wanted()) return;
  if (!table) {
    fill(
      panel,
      make(
        'p', {class: 'quiet'}, kind === 'sweep' ? 'This result is not of a sweep.' : 'Nothing grows in this result.'));
    return;
  }
  const own = kind === 'growth' ? currentLoad()?.name : null, loads = table.columns.find((c) => c.name === 'load case');
  const rows = table.columns[0].values.map((_, i) => i).filter((i) => own === null || loads.values[i] === own);
  const numbers = table.columns.filter((column) => column.values.some((value) => typeof value === 'number'));
  const named = (name, otherwise) => numbers.find((column) => column.name === name) ?? otherwise;
  const swept = model.result.sweep?.loads ?? [];
  const varying = numbers.find((column) => swept.includes(column.name) && new Set(column.values).size > 1);
  const across = named(get('across'), kind === 'growth' ? named(GROWTH, numbers[0]) : varying ?? numbers[0]);
  const up = named(
    get('up'),
    kind === 'growth' ? named('load', named('G1', numbers[1])) :
                        numbers.find((column) => column.name.startsWith('A of')) ?? named('energy', numbers[1]));
  const sorted = rows.filter((i) => typeof across.values[i] === 'number' && typeof up.values[i] === 'number')
                   .sort((i, j) => kind === 'growth' ? i - j : across.values[i] - across.values[j]);
  const of = (column) => sorted.map((i) => column.values[i] ?? NaN);
  const unit = (column) => column.name + (column.unit === '-' ? '' : ` [${column.unit}]`);
  const bounds =
    ['lower', 'upper']
      .map((end) => named(/^A of/.test(up.name) ? up.name.replace('A of', `A_${end} of`) : `${up.name}_${end}`, null))
      .filter(Boolean);
  const choose = (row) => set({row});
  chart?.destroy();
  chart = new Lines({title: `${up.name} against ${across.name}`, x: unit(across), y: unit(up)}, (x, y) => {
    const area = chart?.chart.scales, spanX = area.x.max - area.x.min, spanY = area.y.max - area.y.min;
    const far = (i) => Math.hypot((across.values[i] - x) / spanX, (up.values[i] - y) / spanY);
    if (sorted.length) choose(sorted.reduce((best, i) => far(i) < far(best) ? i : best, sorted[0]));
  }, 'click');
  const row = rows.includes(Number(get('row'))) ? Number(get('row')) : rows[0], place = rows.indexOf(row);
  const options = (column) => [column.name, unit(column)];
  const slider = make('input', {
    type: 'range',
    min: '0',
    max: rows.length - 1,
    step: '1',
    value: place,
    'aria-label': kind === 'growth' ? 'step' : 'row',
    onchange: (event) => choose(rows[Number(event.target.value)])
  });
  fill(
    panel,
    make(
      'div', {class: 'controls'}, choice('across', numbers.map(options), across.name, (name) => set({across: name})),
      choice('up', numbers.map(options), up.name, (name) => set({up: name})),
      make('label', {}, kind === 'growth' ? 'step ' : 'row ', slider, ` ${place + 1} of ${rows.length}`)),
    chart.box, about(table, row, kind),
    ...(kind === 'growth' ? currentLoad()?.growth_notes ?? [] : [])
      .map((note) => make('p', {class: 'quiet'}, plain(note))));
  chart.draw([
    {label: up.name, x: of(across), y: of(up), colour: LINES[0], dots: sorted.length < 100},
    ...bounds.map(
      (column, i) =>
        ({label: plain(column.name, 40), x: of(across), y: of(column), colour: LINES[i + 1], dash: [4, 3]}))
  ]);
  chart.mark(across.values[row] ?? undefined);
  const front = kind === 'growth' ? currentLoad()?.growth[place] : null;
  mark(front ? [front[0], front[1], 0] : null);
}

/**
 * The values of a row, and a way to its traces. @param {any} table @param {number}
 * row @param {string} kind
 */
function about(table, row, kind) {
  const kept = kind === 'sweep' ? model.result.sweep.kept.indexOf(row) : -1;
  return make(
    'div', {class: 'wide'},
    kind === 'sweep' ?
      make(
        'p', {},
        kept >= 0 ?
          make('button', {onclick: () => set({load: kept, tab: 'interfaces'})}, `Show row ${row} on the interfaces`) :
          `Traces of row ${row} were not kept; a sweep keeps those of --traces.`) :
          null,
    make(
      'table', {class: 'row'},
      ...table.columns.map(
        (column) => make(
          'tr', {}, make('th', {scope: 'row', title: column.meaning}, plain(column.name, 60)),
          make(
            'td', {class: 'number'},
            typeof column.values[row] === 'number' ? number(column.values[row], 7) :
                                                     plain(column.values[row] ?? '\u2013', 80)),
          make('td', {}, column.unit === '-' ? '' : column.unit)))));
}
