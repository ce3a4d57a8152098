// SPDX-License-Identifier: GPL-3.0-or-later
// The column of numbers: what is proved of the load that is looked at, and what was clicked.
import {aside, byId, fill, make, number, plain, words} from './dom.js';
import {picked} from './membrane.js';
import {currentLoad, currentStage, loadIndex, model, stages, unit} from './model.js';
import {ask} from './net.js';

/** @param {string} name @param {any} value */
const row = (name, value) => [make('dt', {}, name), make('dd', {}, value)];
/** @param {any} text */
const warning = (text) => make('p', {class: 'warning'}, plain(text));
/** @param {any} of */
const state = (of) => make('p', {class: `state ${of}`}, words(of));

export function draw() {
  const load = currentLoad(), result = model.result, job = model.live?.job, column = byId('numbers');
  if (!result && !job) return fill(column, aside('Choose a job, or write a case and run it.'));
  if (!result) return fill(column, make('h2', {}, 'As it runs'), running(job), stage(), hit());
  if (currentStage()) return fill(column, make('h2', {}, load ? plain(load.name, 60) : ''), stage(), hit());
  const sweep = result.sweep;
  fill(column,
    make('h2', {},
      load         ? plain(load.name, 60) :
        sweep.jobs ? 'Study' :
                     'Sweep'),
    load ? state(load.status) : null,
    [result.not_reached, load?.reason, load?.error, load?.no_bracket].filter(Boolean).map(warning),
    load ? make('dl', {}, load.inclusions.slice(0, 30).map((part) => row(`A of ${plain(part.name, 40)}`, part.A)),
             load.inclusions.length > 30 ? row('more', `${load.inclusions.length - 30} in the tables`) : null,
             row('energy', load.energy), row('contact length', number(load.contact_length, 3) + unit('L')),
             load.growth.length ? row('growth', `${load.growth.length} positions`) : null) :
           null,
    sweep ? make('dl', {}, row('rows', `${sweep.rows}, ${sweep.converged} converged`),
              row(sweep.jobs ? 'varied' : 'of the loads', plain(sweep.loads.join(', '), 300))) :
            null,
    load ? hit() : null,
    make('dl', {class: 'quiet'},
      result.triangles ? row('mesh', `${result.triangles} triangles, ${result.nodes} nodes`) : null,
      load?.iterations ? row('steps', String(load.iterations)) : null,
      result.job ? row('job', plain(result.job, 40)) : null),
    load && !load.colours.length && !sweep ? aside(plain(result.cure)) : null,
    [...(load?.warnings ?? []), ...result.warnings, ...result.notes].slice(0, 20).map(warning));
}

/** @param {any} job */
function running(job) {
  const detail = job.timeline[job.timeline.length - 1]?.detail, {rows = 0, growth = []} = model.live ?? {};
  return [
    state(job.state), detail ? aside(plain(detail, 100)) : null, job.error ? warning(job.error) : null,
    make('dl', {},
      job.answers.slice(0, 12)
        .flatMap((answer) => [row(plain(answer.name, 40), words(answer.status)),
                   ...answer.inclusions.slice(0, 8).map((part) => row(`A of ${plain(part.name, 40)}`, number(part.A)))])
        .flat(),
      rows ? row('rows', String(rows)) : null, growth.length ? row('positions', String(growth.length)) : null)
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
  /** @type {any} */
  const at = picked.hit, told = at?.told;
  const known = (name, value, behind = '') =>
    typeof value === 'number' && !Number.isNaN(value) ? row(name, number(value) + behind) : null;
  return !at ?
    aside('A click on the membrane tells x, y, u and the triangle.') :
    make('dl', {id: 'hit'}, known('x', at.x, unit('L')), known('y', at.y, unit('L')), known('u', at.u, unit('L')),
      known('triangle', at.triangle), told?.subdomain ? row('subdomain', plain(told.subdomain, 40)) : null,
      told ? row('nodes', told.nodes.join(', ')) : null, known('|T grad u|', told?.flux, unit('F/L')),
      known('energy density', told?.energy_density, unit('F/L')), known('indicator / area', told?.indicator));
}

/** @param {any} found what was clicked, or null */
export async function clicked(found) {
  picked.hit = found;
  draw();
  if (!found || currentStage()) return;
  found.told = await ask('triangle', {of: model.of, load: loadIndex(), index: found.triangle});
  draw();
}
