// SPDX-License-Identifier: GPL-3.0-or-later
// The list of jobs, and what may be done with one.
import {button, byId, choice, fill, make, plain, refill, words} from './dom.js';
import {changed, model} from './model.js';
import {events, notice, post} from './net.js';
import {get, set} from './state.js';

const STATES = ['queued', 'waiting_for_mesh', 'running', 'succeeded', 'not_converged', 'failed', 'cancelled'];
const ENDED = STATES.slice(3);
const list = make('ul', {class: 'jobs'});

export function start() {
  const filter = make('input', {
    type: 'search',
    placeholder: 'filter by title, owner, ID',
    'aria-label': 'filter jobs',
    value: get('filter'),
    oninput: (event) => set({filter: event.target.value})
  });
  const states =
    choice('state', [['', 'all'], ...STATES.map((state) => /** @type {[string, string]} */ ([state, words(state)]))],
      get('state'), (state) => set({state}));
  fill(byId('jobs'), make('h2', {}, 'Jobs'), filter, states, list);
  events('jobs', {}, changed, {
    failed: (data) => notice(data.error),
    jobs: (jobs) => {
      const name = model.of, here = (of) => of.some((job) => job.name === name), gone = here(model.jobs) && !here(jobs);
      model.jobs = jobs;
      if (gone) {
        set({of: ''}); // which takes away older notices
        notice(`${name} has been deleted`);
      }
    },
  });
}

export function draw() {
  const wanted = get('filter').toLowerCase(), state = get('state');
  const shown = model.jobs.filter(
    (job) => (!state || job.state === state) && `${job.title} ${job.owner} ${job.name}`.toLowerCase().includes(wanted));
  const owners = new Set(model.jobs.map((job) => job.owner)).size > 1;
  refill(list, shown.map((job) => item(job, owners)),
    !shown.length && make('li', {class: 'quiet'}, model.jobs.length ? 'no job is like this' : 'there is no job yet'));
}

/** @param {any} job @param {boolean} owners */
function item(job, owners) {
  const here = job.name === model.of, live = here ? model.live?.job : null, state = live?.state || job.state;
  const part = job.total > 0 ? Math.max(job.done, here ? model.live?.rows ?? 0 : 0) / job.total : 0;
  const phase = live?.timeline[live.timeline.length - 1]?.detail, ended = ENDED.includes(state);
  const does = (text, run) => button(text, run, {'data-key': job.name + text});
  return make('li', {class: here ? 'here' : ''},
    button(
      [
        make('strong', {}, plain(job.title, 80) || job.name.slice(5, 17)),
        make('span', {class: `state ${state}`}, words(state) + (phase && !ended ? `: ${phase}` : '')),
        !ended && make('progress', {max: '1', value: part, 'aria-label': 'progress'}),
        make('small', {}, new Date(job.created).toLocaleTimeString(),
          owners ? ` \u00b7 ${plain(job.owner || 'nobody', 40)}` : '',
          job.total > 1 ? ` \u00b7 ${job.done} of ${job.total}` : '', job.task ? ` \u00b7 ${job.task}` : '')
      ],
      () => set({of: job.name, load: ''}),
      {class: 'job', 'data-key': job.name, 'aria-pressed': String(here), title: job.name}),
    here &&
      make('div', {class: 'actions'}, !ended && does('Cancel', () => act(job, 'cancel')),
        does('Submit again', () => act(job, 'again')), ended && does('Delete\u2026', () => act(job, 'delete'))));
}

/** @param {any} job @param {string} action */
async function act(job, action) {
  const about = `Delete ${plain(job.title, 80) || 'this job'} (${job.name}) with its results? This cannot be undone.`;
  if (action === 'delete' && !confirm(about)) return;
  try {
    const {name} = await post('job', {name: job.name, action});
    if (action === 'again') set({of: name, load: ''});
  } catch (error) {
    notice(error);
  }
}
