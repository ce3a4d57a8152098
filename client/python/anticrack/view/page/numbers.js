// SPDX-License-Identifier: GPL-3.0-or-later
// The column of numbers: what is proved of the load that is looked at, and what was clicked.
import {byId, fill, make, number, plain} from './dom.js';
import {picked} from './membrane.js';
import {currentLoad, loadIndex, model} from './model.js';
import {ask} from './net.js';

/** @param {string} name @param {any} value */
const row = (name, value) => [make('dt', {}, name), make('dd', {}, value)];

export function draw() {
  const load = currentLoad(), result = model.result, job = model.live?.job, column = byId('numbers');
  if (!result && !job) return fill(column, make('p', {class: 'quiet'}, 'Choose a job, or write a case and run it.'));
  if (!result) return fill(column, make('h2', {}, 'As it runs'), running(job));
  const unit = (of) => result.units[of] === '-' ? '' : ` ${result.units[of]}`;
  fill(
    column, make('h2', {}, load ? plain(load.name, 60) : 'Sweep'),
    load ? make('p', {class: `state ${load.status}`}, load.status.replace(/_/g, ' ')) : null,
    ...[result.not_reached, load?.reason, load?.error, load?.no_bracket].filter(Boolean).map(
      (text) => make('p', {class: 'warning'}, plain(text))),
    load ? make(
             'dl', {}, ...load.inclusions.slice(0, 30).flatMap((part) => row(`A of ${plain(part.name, 40)}`, part.A)),
             load.inclusions.length > 30 ? row('more', `${load.inclusions.length - 30} in the tables`) : [],
             row('energy', load.energy), row('contact length', number(load.contact_length, 3) + unit('L')),
             load.growth.length ? row('growth', `${load.growth.length} positions`) : []) :
           null,
    result.sweep ? make(
                     'dl', {}, row('rows', `${result.sweep.rows}, ${result.sweep.converged} converged`),
                     row('of the loads', plain(result.sweep.loads.join(', '), 300))) :
                   null,
    hit(unit),
    make(
      'dl', {class: 'quiet'}, row('mesh', `${result.triangles} triangles, ${result.nodes} nodes`),
      load?.iterations ? row('steps', String(load.iterations)) : [],
      result.job ? row('job', plain(result.job, 40)) : []),
    load && !load.colours.length && !result.sweep ? make('p', {class: 'quiet'}, plain(result.cure)) : null,
    ...[...(load?.warnings ?? []), ...result.warnings, ...result.notes].slice(0, 20).map(
      (text) => make('p', {class: 'warning'}, plain(text))));
}

/** @param {any} job */
function running(job) {
  const last = job.timeline[job.timeline.length - 1];
  return [
    make(
      'p', {class: `state ${job.state}`}, job.state.replace(/_/g, ' '),
      last?.detail ? `: ${plain(last.detail, 100)}` : ''),
    job.error ? make('p', {class: 'warning'}, plain(job.error)) : null,
    make(
      'dl', {},
      ...job.answers.slice(0, 12)
        .flatMap(
          (answer) =>
            [row(plain(answer.name, 40), answer.status.replace(/_/g, ' ')),
             ...answer.inclusions.slice(0, 8).map((part) => row(`A of ${plain(part.name, 40)}`, number(part.A)))])
        .flat(),
      model.live?.rows ? row('rows', String(model.live.rows)) : [],
      model.live?.growth.length ? row('positions', String(model.live.growth.length)) : []),
  ];
}

/** @param {(of: string) => string} unit */
function hit(unit) {
  /** @type {any} */
  const at = picked.hit;
  if (!at) return make('p', {class: 'quiet'}, 'A click on the membrane tells x, y, u and the triangle.');
  return make(
    'dl', {id: 'hit'}, row('x', number(at.x) + unit('L')), row('y', number(at.y) + unit('L')),
    Number.isNaN(at.u) ? [] : row('u', number(at.u) + unit('L')), row('triangle', String(at.triangle)),
    at.told ?
      [
        at.told.subdomain ? row('subdomain', plain(at.told.subdomain, 40)) : [], row('nodes', at.told.nodes.join(', ')),
        at.told.flux === undefined ? [] : row('|T grad u|', number(at.told.flux) + unit('F/L')),
        at.told.energy_density === undefined ? [] : row('energy density', number(at.told.energy_density) + unit('F/L')),
        at.told.indicator === undefined ? [] : row('indicator / area', number(at.told.indicator))
      ] :
      []);
}

/** @param {any} found what was clicked, or null */
export async function clicked(found) {
  picked.hit = found;
  draw();
  if (!found) return;
  found.told = await ask('triangle', {of: model.of, load: loadIndex(), index: found.triangle});
  draw();
}
