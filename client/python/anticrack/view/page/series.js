// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a sweep or a study and steps of growth: any column against any other; a click chooses a row.
import {Lines} from './chart.js';
import {aside, button, choice, fill, make, nearest, number, plain, slider} from './dom.js';
import {mark} from './membrane.js';
import {currentLoad, model, tables} from './model.js';
import {address} from './net.js';
import {lineColour} from './palette.js';
import {get, set} from './state.js';

/** @type {Lines|null} */ let chart = null;

const MOST = 8; // lines
const short = (key) => plain(key.split('.').slice(-2).join('.'), 40);
const choose = (row) => set({row});

/** @param {any} panel @param {() => boolean} wanted @param {'sweep'|'growth'} kind */
export async function draw(panel, wanted, kind) {
  const table = (await tables()).find((each) => each.name === kind), grows = kind === 'growth';
  if (!wanted()) return;
  if (!table) return fill(panel, aside(grows ? 'Nothing grows in this result.' : 'This result is not of a sweep.'));
  const loads = table.columns.find((column) => column.name === 'load case')?.values ?? [];
  const names = [...new Set(loads)], own = grows ? currentLoad()?.name : names[Number(get('among')) || 0];
  const rows = table.columns[0].values.map((_, i) => i).filter((i) => !loads.length || loads[i] === own);
  const numbers = table.columns.filter((column) => column.values.some((value) => typeof value === 'number'));
  const named = (name, otherwise) => numbers.find((column) => column.name === name) ?? otherwise;
  const swept = model.result.sweep?.loads ?? [];
  const varying = numbers.filter((column) => swept.includes(column.name) && new Set(column.values).size > 1);
  const across = named(get('across'),
    grows ? named('position', numbers[0])
          : varying[model.result.sweep?.jobs || varying.length < 2 ? 0 : -1] ?? numbers[0]);
  const first = grows ? named('load', named('G1', numbers[1]))
                      : numbers.find((column) => column.name.startsWith('A of')) ?? named('energy', numbers[1]);
  const up = named(get('up'), first);
  const sorted = rows.filter((i) => typeof across.values[i] === 'number' && typeof up.values[i] === 'number')
                   .sort((i, j) => grows ? i - j : across.values[i] - across.values[j]);
  const of = (column, own = sorted) => own.map((i) => column.values[i] ?? NaN);
  const title = (column) => column.name + (column.unit === '-' ? '' : ` [${column.unit}]`);
  const bounds =
    ['lower', 'upper']
      .map((end) => named(/^A of/.test(up.name) ? up.name.replace('A of', `A_${end} of`) : `${up.name}_${end}`, null))
      .filter(Boolean);
  const others = varying.filter((column) => column !== across);
  /** @type {Map<string, number[]>} rows of a line: all, or of a grid those with the same other values */
  let groups = new Map();
  for (const i of sorted) {
    const label = others.map((column) => `${short(column.name)} = ${number(column.values[i], 4)}`).join(', ');
    groups.set(label, [...groups.get(label) ?? [], i]);
  }
  const grid = others.length > 0 && groups.size <= MOST && 2 * groups.size <= sorted.length;
  if (!grid) groups = new Map([[up.name, sorted]]);
  const points = !grid && others.length > 0 && varying.includes(across); // which no line follows
  const contours = model.result.sweep?.jobs && swept.length === 2 && !swept.includes(up.name) && make('img', {
    alt: `contours of ${up.name} over ${swept.join(' and ')}`,
    src: address('export', {of: model.of, kind: 'svg', column: up.name, among: own ?? ''}),
    onerror: (event) => event.target.remove()
  });
  chart?.destroy();
  chart = new Lines({title: `${up.name} against ${across.name}`, x: title(across), y: title(up)}, (x, y) => {
    const area = chart?.chart.scales, spanX = area.x.max - area.x.min, spanY = area.y.max - area.y.min;
    const far = (i) => Math.hypot((across.values[i] - x) / spanX, (up.values[i] - y) / spanY);
    if (sorted.length) choose(sorted.reduce((best, i) => far(i) < far(best) ? i : best));
  }, 'click');
  const row = rows.includes(Number(get('row') || NaN)) ? Number(get('row')) : rows[0], place = rows.indexOf(row);
  const steps = slider(grows ? 'step' : 'row', [0, rows.length - 1, 1], place,
    {onchange: (event) => choose(rows[Number(event.target.value)])});
  const options = numbers.map((column) => [column.name, title(column)]);
  fill(panel,
    make('div', {class: 'controls'}, choice('across', options, across.name, (name) => set({across: name})),
      choice('up', options, up.name, (name) => set({up: name})),
      names.length > 1 && !grows &&
        choice('load', names.map((name, i) => [String(i), name]), String(names.indexOf(own)), (among) => set({among})),
      make('label', {}, grows ? 'step ' : 'row ', steps, ` ${place + 1} of ${rows.length}`)),
    chart.box, make('div', {class: 'drawing'}, contours), about(table, row, kind),
    grows && (currentLoad()?.growth_notes ?? []).map(aside));
  chart.draw([
    ...[...groups].map(([label, own], n) => ({
      label,
      x: of(across, own),
      y: of(up, own),
      colour: lineColour(n),
      dots: points || sorted.length < 100,
      points
    })),
    ...(grid || points ? [] : bounds)
      .map((column, i) =>
             ({label: plain(column.name, 40), x: of(across), y: of(column), colour: lineColour(i + 1), dash: [4, 3]}))
  ]);
  chart.mark(across.values[row] ?? undefined);
  const front = grows ? currentLoad()?.growth[place] : null;
  mark(front ? [front[0], front[1], 0] : null);
  chosen = (x, y) => choose(rows[nearest(currentLoad()?.growth ?? [], x, y)]);
}

/** Chooses the front that is nearest to a place of the membrane. @type {(x: number, y: number) => void} */
export let chosen = (_x, _y) => {};

/** The values of a row, and a way to more of it. @param {any} table @param {number} row @param {string} kind */
function about(table, row, kind) {
  const {kept = [], jobs} = model.result.sweep ?? {}, at = kept.indexOf(row), job = jobs?.[row];
  const way = jobs ? job
      ? button(`Show the job of row ${table.columns[0].values[row]}`, () => set({of: job, load: '', tab: ''}))
      : 'This row has no job.'
    : at < 0 ? `Traces of row ${row} were not kept; a sweep keeps those of --traces.`
             : button(`Show row ${row} on the interfaces`, () => set({load: at, tab: 'interfaces'}));
  const value = (of) => typeof of === 'number' ? number(of, 7) : plain(of ?? '\u2013', 200);
  return make('div', {class: 'wide'}, kind === 'sweep' && make('p', {}, way),
    make('table', {class: 'row'},
      table.columns.map(
        (column) => make('tr', {}, make('th', {scope: 'row', title: column.meaning}, plain(column.name, 60)),
          make('td', {class: 'number'}, value(column.values[row])),
          make('td', {}, column.unit === '-' ? '' : column.unit)))));
}
