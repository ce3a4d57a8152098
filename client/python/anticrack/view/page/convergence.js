// SPDX-License-Identifier: GPL-3.0-or-later
// How a job came to its answer, also while it runs: residuals, stages with their bounds, the
// timeline.
import {Lines} from './chart.js';
import {choice, fill, make, number, plain} from './dom.js';
import {history, model} from './model.js';
import {LINES} from './palette.js';
import {get, set} from './state.js';

const RESIDUALS = ['criterion', 'kkt_equilibrium', 'kkt_gap', 'kkt_sign', 'kkt_complementarity'];
const RULE = 'Of more than 4 samples a pixel the first, least, largest and last are drawn.';
/**
 * @type {{key: string, residuals: Lines, energy: Lines, error: Lines, time: any, head: any}|null}
 */
let parts = null;

/** @param {any} panel @param {() => boolean} wanted */
export async function draw(panel, wanted) {
  const job = model.live?.job, names = model.result?.loads.map((load) => load.name) ?? job?.loads ?? [];
  const mode = get('residual') || (names.length > 1 ? 'criterion' : '0');
  const energy = model.result?.units['F L'] ?? '-', key = [model.of, mode, get('theme')].join(' ');
  const found = RESIDUALS.includes(mode) ? await Promise.all(names.slice(0, 8).map((_, i) => history(i))) :
                                           [await history(Number(mode))];
  if (!wanted()) return;
  if (parts?.key !== key || !panel.contains(parts.time)) {
    parts?.residuals.destroy();
    parts = {
      key,
      head: make('p', {class: 'quiet'}),
      time: make('ol', {class: 'timeline'}),
      residuals: new Lines({
        title: RESIDUALS.includes(mode) ? `${mode} of every load` : 'residuals, absolute, and criterion',
        x: 'iteration',
        y: '',
        log: true
      }),
      energy: new Lines(
        {title: 'bounds of the energy' + (energy === '-' ? '' : ` [${energy}]`), x: 'triangles', y: '', short: true}),
      error: new Lines({title: 'proved relative error of A', x: 'triangles', y: '', log: true, short: true}),
    };
    fill(
      panel,
      make(
        'div', {class: 'controls'},
        choice(
          'show',
          [
            ...names.map((name, i) => [String(i), `all of ${plain(name, 40)}`]),
            ...RESIDUALS.map((name) => [name, `${name}, every load`])
          ],
          mode, (residual) => set({residual}))),
      parts.head, parts.residuals.box, parts.energy.box, parts.error.box, make('h3', {}, 'Timeline'), parts.time);
  }
  const lines = found.flatMap(
    (samples, i) => !samples ?
      [] :
      (RESIDUALS.includes(mode) ? [mode] : RESIDUALS)
        .map((name, n) => ({
               label: RESIDUALS.includes(mode) ? plain(names[i], 30) : name.replace('kkt_', ''),
               x: samples.iteration,
               y: samples[name],
               colour: LINES[(RESIDUALS.includes(mode) ? i : n) % LINES.length],
               dots: samples.iteration.length < 30,
             })));
  const count = found.reduce((sum, samples) => sum + (samples?.iteration.length ?? 0), 0);
  fill(
    parts.head,
    lines.length ? `${count} samples. ${RULE}` :
                   'No iterations are kept of this; the active set often takes a single step.');
  parts.residuals.box.hidden = !lines.length;
  if (lines.length) parts.residuals.draw(lines);
  stages(parts, Math.max(Number(mode) || 0, 0));
  const begin = job?.timeline[0]?.time;
  fill(
    parts.time,
    ...(job?.timeline ?? [])
      .map(
        (step) => make(
          'li', {}, make('time', {}, `${number((step.time - begin) / 1000, 4)} s`), ` ${step.state.replace(/_/g, ' ')}`,
          step.detail ? `: ${plain(step.detail, 200)}` : '', step.attempt > 1 ? ` (attempt ${step.attempt})` : '')),
    job?.timeline.length ? null :
                           make('li', {class: 'quiet'}, 'A result file has no timeline; a job of the server does.'));
}

/** @param {any} to @param {number} load */
function stages(to, load) {
  /** @type {Record<string, number[]>} */
  const live = {triangles: [], energy: [], energy_lower: [], energy_upper: [], displacement_error: []};
  for (const stage of model.live?.job.stages ?? []) {
    if (!stage.answers[load]) continue;
    live.triangles.push(stage.triangles);
    for (const name of Object.keys(live).slice(1)) live[name].push(stage.answers[load][name]);
  }
  const told = model.result?.loads[load]?.stages, rows = told?.triangles ? told : live,
        some = rows.triangles?.length > 0;
  const line = (label, n, dash = [0]) =>
    ({label, x: rows.triangles, y: rows[label], colour: LINES[n], dash: dash[0] ? dash : [], dots: true});
  to.energy.box.hidden = to.error.box.hidden = !some;
  if (!some) return;
  to.energy.draw([line('energy', 0), line('energy_lower', 1, [4, 3]), line('energy_upper', 2, [4, 3])]);
  to.error.draw([line('displacement_error', 3)]);
}
