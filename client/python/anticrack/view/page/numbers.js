// SPDX-License-Identifier: GPL-3.0-or-later
// The column of numbers: what is proved of the load that is looked at, and what was clicked.
import {aside, byId, fill, make, number, plain, words} from './dom.js';
import {picked} from './membrane.js';
import {currentLoad, currentStage, loadIndex, model, stages, unit} from './model.js';
import {ask} from './net.js';

/** @param {string} name @param {any} value */
const row = (name, value) => [make('dt', {}, name), make('dd', {}, value)];
const warning = (text) => make('p', {class: 'warning'}, plain(text));
const state = (of) => make('p', {class: `state ${of}`}, words(of));

export function draw() {
  const load = currentLoad(), result = model.result, job = model.live?.job, column = byId('numbers');
  if (!result && !job) return fill(column, aside('Choose a job, or write a case and run it.'));
  if (!result) return fill(column, make('h2', {}, 'As it runs'), running(job), stage(), hit());
  if (currentStage()) return fill(column, make('h2', {}, load ? plain(load.name, 60) : ''), stage(), hit());
  const sweep = result.sweep, kind = sweep?.jobs ? 'Study' : 'Sweep';
  fill(column, make('h2', {}, load ? plain(load.name, 60) : kind), load && state(load.status),
    [result.not_reached, load?.reason, load?.error, load?.no_bracket].filter(Boolean).map(warning),
    load &&
      make('dl', {}, load.inclusions.slice(0, 30).map((part) => row(`A of ${plain(part.name, 40)}`, part.A)),
        load.inclusions.length > 30 && row('more', `${load.inclusions.length - 30} in the tables`),
        row('energy', load.energy), row('contact length', number(load.contact_length, 3) + unit('L')),
        load.growth.length > 0 && row('growth', `${load.growth.length} positions`)),
    sweep &&
      make('dl', {}, row('rows', `${sweep.rows}, ${sweep.converged} converged`),
        row(sweep.jobs ? 'varied' : 'of the loads', plain(sweep.loads.join(', '), 300))),
    load && hit(),
    make('dl', {class: 'quiet'},
      result.triangles && row('mesh', `${result.triangles} triangles, ${result.nodes} nodes`),
      load?.iterations > 0 && row('steps', String(load.iterations)), result.job && row('job', plain(result.job, 40))),
    load && !load.colours.length && !sweep && aside(`Fields are not kept; ${plain(result.cure)}`),
    [...(load?.warnings ?? []), ...result.warnings, ...result.notes].slice(0, 20).map(warning));
}

function running(job) {
  const detail = job.timeline[job.timeline.length - 1]?.detail, {rows = 0, growth = []} = model.live ?? {};
  return [
    state(job.state), detail && aside(plain(detail, 100)), job.error && warning(job.error),
    make('dl', {},
      job.answers.slice(0, 12)
        .flatMap((answer) => [row(plain(answer.name, 40), words(answer.status)),
                   ...answer.inclusions.slice(0, 8).map((part) => row(`A of ${plain(part.name, 40)}`, number(part.A)))])
        .flat(),
      rows > 0 && row('rows', String(rows)), growth.length > 0 && row('positions', String(growth.length)))
  ];
}

/** The stage that is looked at. */
function stage() {
  const found = currentStage(), answer = found?.answers[loadIndex()];
  return !found ?
    null :
    make('dl', {id: 'stage-numbers'},
      row('stage', `${stages().indexOf(found) + 1} of ${stages().length}, ${found.triangles} triangles`),
      answer ?
        [
          row('energy', number(answer.energy) + unit('F L')),
          row('bounds of the energy', `${number(answer.energy_lower)} to ${number(answer.energy_upper)}${unit('F L')}`),
          row('proved error of A', number(100 * answer.displacement_error, 3) + ' %')
        ] :
        null);
}

function hit() {
  /** @type {any} */ const at = picked.hit, told = at?.told;
  const known = (name, value, behind = '') =>
    typeof value === 'number' && !Number.isNaN(value) && row(name, number(value) + behind);
  return !at
    ? aside('A click on the membrane tells x, y, u and the triangle.')
    : make('dl', {id: 'hit'}, known('x', at.x, unit('L')), known('y', at.y, unit('L')), known('u', at.u, unit('L')),
        known('triangle', at.triangle), told?.subdomain && row('subdomain', plain(told.subdomain, 40)),
        told && row('nodes', told.nodes.join(', ')), known('|T grad u|', told?.flux, unit('F/L')),
        known('energy density', told?.energy_density, unit('F/L')), known('indicator / area', told?.indicator));
}

/** @param {any} found what was clicked, or null */
export async function clicked(found) {
  picked.hit = found;
  draw();
  if (!found || currentStage() || Number.isNaN(found.triangle)) return;
  found.told = await ask('triangle', {of: model.of, load: loadIndex(), index: found.triangle});
  draw();
}
