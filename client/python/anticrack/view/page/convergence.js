// SPDX-License-Identifier: GPL-3.0-or-later
// How a job came to its answer, also while it runs: residuals, stages with their bounds, the timeline.
import {Lines} from './chart.js';
import {aside, choice, fill, make, number, plain, words} from './dom.js';
import {history, model, RESIDUALS, unit} from './model.js';
import {lineColour} from './palette.js';
import {get, set} from './state.js';

const NAMES = /** @type {any} */ (
  {energy: 'middle', energy_lower: 'lower bound', energy_upper: 'upper bound', displacement_error: 'A'});
const NO_STEPS = 'No iterations are kept of this; the active set often takes a single step.';
const NO_TIMES = 'A result file has no timeline; a job of the server does.';
/** @type {{key: string, residuals: Lines, energy: Lines, error: Lines, time: any, head: any}|null} */
let parts = null;

/** @param {any} panel @param {() => boolean} wanted */
export async function draw(panel, wanted) {
  const job = model.live?.job, names = model.result?.loads.map((load) => load.name) ?? job?.loads ?? [];
  const mode = get('residual') || (names.length > 1 ? 'criterion' : '0'), all = RESIDUALS.includes(mode);
  const key = [model.of, mode, get('theme'), unit('F L')].join(' ');
  const found = await Promise.all(all ? names.slice(0, 8).map((_, i) => history(i)) : [history(Number(mode))]);
  if (!wanted()) return;
  if (parts?.key !== key || !panel.contains(parts.time)) {
    for (const chart of [parts?.residuals, parts?.energy, parts?.error]) chart?.destroy();
    const chart = (title, x, log, short) => new Lines({title, x, log, short}), triangles = 'triangles';
    const residuals =
      chart(all ? `${words(mode)} of every load` : 'residuals, absolute, and criterion', 'iteration', true, false);
    const energy = chart(`bounds of the energy${unit('F L', true)}`, triangles, false, true);
    const error = chart('proved relative error of A', triangles, true, true);
    parts = {key, residuals, energy, error, head: make('p', {class: 'quiet'}), time: make('ol', {class: 'timeline'})};
    const options = [
      ...names.map((name, i) => [String(i), `all of ${plain(name, 40)}`]),
      ...RESIDUALS.map((name) => [name, `${words(name)}, every load`])
    ];
    fill(panel, make('div', {class: 'controls'}, choice('show', options, mode, (residual) => set({residual}))),
      parts.head, parts.residuals.box, parts.energy.box, parts.error.box, make('h3', {}, 'Timeline'), parts.time);
  }
  const lines = found.flatMap((samples, i) => !samples ? [] : (all ? [mode] : RESIDUALS).map((name, n) => ({
    label: all ? plain(names[i], 30) : words(name.replace('kkt_', '')),
    x: samples.iteration,
    y: samples[name],
    colour: lineColour(all ? i : n),
    dots: samples.iteration.length < 30
  })));
  const count = found.reduce((sum, samples) => sum + (samples?.iteration.length ?? 0), 0);
  fill(parts.head,
    !count ? NO_STEPS
           : `${count} sample${count === 1 ? '' : 's'}. ` +
        'Of more than 4 samples a pixel the first, least, largest and last are drawn.');
  parts.residuals.box.hidden = !lines.length;
  if (lines.length) parts.residuals.draw(lines);
  stages(parts, Number(mode) || 0);
  const begin = job?.timeline[0]?.time;
  fill(parts.time, !job?.timeline.length && aside(NO_TIMES),
    (job?.timeline ?? [])
      .map((step) => make('li', {}, make('time', {}, `${number((step.time - begin) / 1000, 4)} s`),
             ` ${words(step.state)}`, step.detail ? `: ${plain(step.detail, 200)}` : '',
             step.attempt > 1 ? ` (attempt ${step.attempt})` : '')));
}

/** @param {any} to @param {number} load */
function stages(to, load) {
  const live = (model.live?.job.stages ?? []).filter((stage) => stage.answers[load]), told = model.result?.loads[load];
  const of = (name) =>
    told?.stages[name] ?? live.map((stage) => (name === 'triangles' ? stage : stage.answers[load])[name]);
  const line = (name, n, dash = /** @type {number[]} */ ([])) =>
    ({label: NAMES[name], x: of('triangles'), y: of(name), colour: lineColour(n), dash, dots: true});
  const some = of('triangles').length > 0;
  to.energy.box.hidden = to.error.box.hidden = !some;
  if (!some) return;
  to.energy.draw([line('energy', 0), line('energy_lower', 1, [4, 3]), line('energy_upper', 2, [4, 3])]);
  to.error.draw([line('displacement_error', 3)]);
}
