// SPDX-License-Identifier: GPL-3.0-or-later
// Interfaces: u on both sides, the jump, the pressure and the contact, of several loads over each other.
import {Lines} from './chart.js';
import {aside, choice, fill, make, number, plain, tick} from './dom.js';
import {mark} from './membrane.js';
import {loadIndex, model, unit, values} from './model.js';
import {lineColour} from './palette.js';
import {get, set} from './state.js';

const MOST = 8;
/** @type {Lines[]} */ let charts = [];

/** @param {any} panel @param {() => boolean} wanted */
export async function draw(panel, wanted) {
  const {loads, interfaces} = model.result, own = loadIndex();
  const opening = Math.max(interfaces.findIndex((line) => line.opens), 0);
  const line = Math.min(Number(get('line', String(opening))) || 0, interfaces.length - 1);
  const have = loads.map((_, i) => i).filter((i) => loads[i].traces);
  if (line < 0) return fill(panel, aside('There is no interface in this membrane.'));
  if (!have.length) return fill(panel, aside('No load has traces.'));
  const over = get('over').split(',').filter(Boolean).map(Number), k = interfaces[line].nodes;
  const shown = have.filter((i) => i === own || over.includes(i)).slice(0, MOST);
  const [[s, x, y], ...traces] = (await Promise.all([
    values('line', own, {interface: line}), ...shown.map((i) => values('trace', i, {interface: line}))
  ])).map((each) => split(each, k));
  if (!wanted()) return;
  charts.forEach((chart) => chart.destroy());
  const table = make('table', {class: 'cursor'}), mine = Math.max(shown.indexOf(own), 0);
  const point = (at) => {
    const n = s.reduce((best, value, i) => Math.abs(value - at) < Math.abs(s[best] - at) ? i : best, 0);
    charts.forEach((chart) => chart.mark(s[n]));
    mark([x[n], y[n], traces[mine]?.[1][n] ?? 0]);
    const cells = (row, tag = 'td') =>
      make('tr', {}, row.map((cell) => make(tag, {}, typeof cell === 'number' ? number(cell) : plain(cell, 40))));
    fill(table, make('caption', {}, `s = ${number(s[n])}, x = ${number(x[n])}, y = ${number(y[n])}${unit('L')}`),
      cells(['load', 'u\u2212', 'u+', '[u]', 'pressure', 'contact'], 'th'),
      traces.map(
        (trace, i) =>
          cells([loads[shown[i]].name, ...trace.slice(0, 4).map((row) => row[n]), trace[6][n] ? 'closed' : 'open'])));
    table.dataset.node = String(n);
  };
  const made = (title, rows) => {
    const chart = new Lines({title, x: `s, arc length${unit('L', true)}`, short: true}, point);
    chart.canvas.addEventListener('keydown', (event) => {
      const by = /** @type {any} */ ({ArrowLeft: -1, ArrowRight: 1})[event.key];
      if (by) point(s[Math.min(Math.max(Number(table.dataset.node ?? 0) + by, 0), k - 1)]);
    });
    return {chart, rows};
  };
  const parts = [
    made(`u+ (full) and u\u2212 (dashed)${unit('L', true)}`, [1, 0]),
    made(`[u] = u+ \u2212 u\u2212${unit('L', true)}`, [2]),
    made(`contact pressure${unit('F/L', true)}; shaded: contact`, [3])
  ];
  charts = parts.map(({chart}) => chart);
  const toggled = (i, wanted) =>
    set(/** @type {any} */ (i === own ? {load: have.find((other) => other !== i) ?? i}
                                      : {over: (wanted ? [...over, i] : over.filter((each) => each !== i)).join(',')}));
  fill(panel,
    make('div', {class: 'controls'},
      choice(
        'interface', interfaces.map((each, i) => [String(i), each.name]), String(line), (name) => set({line: name})),
      have.length > 1 &&
        have.slice(0, 40).map(
          (i) => tick(plain(loads[i].name, 40), shown.includes(i), (wanted) => toggled(i, wanted)))),
    charts.map((chart) => chart.box), table);
  for (const {chart, rows} of parts) {
    chart.draw(shown.flatMap((i, n) => rows.map((row) => ({
      label: plain(loads[i].name, 30) + (rows.length > 1 ? [' u\u2212', ' u+'][row] : ''),
      x: s,
      y: traces[n][row],
      colour: lineColour(n),
      dash: rows.length > 1 && row === 0 ? [5, 3] : []
    }))),
      (loads[shown[mine]]?.contacts ?? []).filter((at) => at[0] === line).map((at) => at.slice(1)));
  }
}

/** @param {Float64Array} packed @param {number} k */
const split = (packed, k) => Array.from({length: packed.length / k}, (_, i) => packed.subarray(i * k, (i + 1) * k));
