// SPDX-License-Identifier: GPL-3.0-or-later
// Interfaces: u on both sides, the jump, the pressure and the contact, of several loads over each
// other.
import {Lines} from './chart.js';
import {choice, fill, make, number, plain, tick} from './dom.js';
import {mark} from './membrane.js';
import {loadIndex, model, values} from './model.js';
import {LINES} from './palette.js';
import {get, set} from './state.js';

const MOST = 8;
/** @type {Lines[]} */
let charts = [];

/** @param {any} panel @param {() => boolean} wanted */
export async function draw(panel, wanted) {
  const {loads, interfaces, units} = model.result;
  const opening = interfaces.findIndex((line) => line.opens);
  const line = Math.min(Number(get('line', String(Math.max(opening, 0)))) || 0, interfaces.length - 1);
  const have = loads.map((_, i) => i).filter((i) => loads[i].traces);
  if (line < 0 || !have.length) {
    fill(
      panel, make('p', {class: 'quiet'}, line < 0 ? 'There is no interface in this membrane.' : 'No load has traces.'));
    return;
  }
  const over = get('over').split(',').filter(Boolean).map(Number);
  const shown = have.filter((i) => i === loadIndex() || over.includes(i)).slice(0, MOST);
  const k = interfaces[line].nodes;
  const [[s, x, y], ...traces] =
    await Promise.all([values('line', loadIndex(), line), ...shown.map((i) => values('trace', i, line))])
      .then(([places, ...rest]) => [split(places, k), ...rest.map((each) => split(each, k))]);
  if (!wanted()) return;
  charts.forEach((chart) => chart.destroy());
  const length = units.L === '-' ? '' : ` [${units.L}]`, pressure = units['F/L'] === '-' ? '' : ` [${units['F/L']}]`;
  const table = make('table', {class: 'cursor'});
  const point = (at) => {
    const n = nearest(s, at);
    charts.forEach((chart) => chart.mark(s[n]));
    mark([x[n], y[n], traces[0]?.[1][n] ?? 0]);
    const cells = (row, tag = 'td') =>
      make('tr', {}, ...row.map((cell) => make(tag, {}, typeof cell === 'number' ? number(cell) : plain(cell, 40))));
    fill(
      table, make('caption', {}, `s = ${number(s[n])}, x = ${number(x[n])}, y = ${number(y[n])}`),
      cells(['load', 'u\u2212', 'u+', '[u]', 'pressure', 'contact'], 'th'),
      ...traces.map(
        (trace, i) =>
          cells([loads[shown[i]].name, ...[0, 1, 2, 3].map((row) => trace[row][n]), trace[6][n] ? 'closed' : 'open'])));
    table.dataset.node = String(n);
  };
  const made = (title, unit, rows) => {
    const chart = new Lines({title: title + unit, x: 's, arc length' + length, y: '', short: true}, point);
    chart.canvas.addEventListener('keydown', (event) => {
      const by = /** @type {any} */ ({ArrowLeft: -1, ArrowRight: 1})[event.key];
      if (by) point(s[Math.min(Math.max(Number(table.dataset.node ?? 0) + by, 0), k - 1)]);
    });
    return {chart, rows};
  };
  const parts = [
    made('u+ (full) and u\u2212 (dashed)', length, [1, 0]), made('[u] = u+ \u2212 u\u2212', length, [2]),
    made('contact pressure; shaded: contact', pressure, [3])
  ];
  charts = parts.map(({chart}) => chart);
  fill(
    panel,
    make(
      'div', {class: 'controls'},
      choice(
        'interface', interfaces.map((each, i) => [String(i), each.name]), String(line), (value) => set({line: value})),
      ...(
        have.length > 1 ? have.slice(0, 40).map(
                            (i) => tick(
                              plain(loads[i].name, 40), shown.includes(i),
                              (on) => set(i === loadIndex() ? {load: have.find((other) => other !== i) ?? i} : {
                                over: (on ? [...over, i] : over.filter((each) => each !== i)).join(',')
                              }))) :
                          [])),
    ...charts.map((chart) => chart.box), table);
  const shades = contacts(s, traces[0]?.[6] ?? []);
  for (const {chart, rows} of parts) {
    chart.draw(
      shown.flatMap(
        (i, n) => rows.map((row) => ({
                             label: plain(loads[i].name, 30) + (rows.length > 1 ? row ? ' u+' : ' u\u2212' : ''),
                             x: s,
                             y: traces[n][row],
                             colour: LINES[n % LINES.length],
                             dash: rows.length > 1 && row === 0 ? [5, 3] : [],
                           }))),
      shades);
  }
}

/** @param {Float64Array} packed @param {number} k */
const split = (packed, k) => Array.from({length: packed.length / k}, (_, i) => packed.subarray(i * k, (i + 1) * k));

/** @param {ArrayLike<number>} s @param {number} at */
function nearest(s, at) {
  let best = 0;
  for (let i = 1; i < s.length; ++i)
    if (Math.abs(s[i] - at) < Math.abs(s[best] - at)) best = i;
  return best;
}

/**
 * The stretches in contact.
 * @param {ArrayLike<number>} s
 * @param {ArrayLike<number>} contact
 */
function contacts(s, contact) {
  /** @type {[number, number][]} */
  const found = [];
  for (let i = 0; i < contact.length; ++i) {
    if (!contact[i]) continue;
    const first = i;
    while (i + 1 < contact.length && contact[i + 1]) ++i;
    found.push([s[first], s[i]]);
  }
  return found;
}
