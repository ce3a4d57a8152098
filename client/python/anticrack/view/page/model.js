// SPDX-License-Identifier: GPL-3.0-or-later
// What is shown now: a job as it runs, and a result once there is one.
import {array, ask, events, notice} from './net.js';
import {get} from './state.js';

/** @typedef {{of: string, result: any, live: Live|null, jobs: any[], tables: any[]|null}} Model */
export const model = /** @type {Model} */ ({of: '', result: null, live: null, jobs: [], tables: null});
let waiting = 0, shown = () => {};

/** @param {() => any} draw called once a frame at most */
export const watch = (draw) => shown = draw;

export function changed() {
  waiting ||= requestAnimationFrame(() => {
    waiting = 0;
    shown();
  });
}

export const RESIDUALS = ['criterion', 'kkt_equilibrium', 'kkt_gap', 'kkt_sign', 'kkt_complementarity'];
const HISTORY = ['iteration', 'criterion', 'energy', 'contact_count', ...RESIDUALS.slice(1)]; // as scene.py sends it

/** A job that is watched. samples: arrays by name for each load, of its last stage. */
class Live {
  /** @param {string} name */
  constructor(name) {
    /** @type {any} */
    this.job = {name, state: '', loads: [], timeline: [], stages: [], answers: [], done: 0, total: 0};
    /** @type {any[]} */ this.samples = [];
    this.rows = 0;
    /** @type {any[]} */ this.growth = [];
    this.close = events('watch', {of: name}, changed, {
      snapshot: (job) => this.job = job,
      samples: (data) => this.sample(data),
      phase: (data) => {
        this.job.state = data.state;
        const last = this.job.timeline[this.job.timeline.length - 1];
        if (last?.state !== data.state || last?.detail !== data.detail)
          this.job.timeline.push({time: Date.now(), ...data});
      },
      answer: (data) => this.job.answers[data.load] = data,
      stage_ended: (data) => {
        const at = this.job.stages.findIndex((stage) => stage.mesh === data.mesh);
        this.job.stages.splice(at < 0 ? this.job.stages.length : at, 1, data);
      },
      sweep_rows: (data) => this.rows += data.count,
      growth_step: (data) => this.growth.push(data),
      ended: (job) => {
        this.job = job;
        this.close();
        if (job.result)
          load(job.name);
        else
          notice(`${job.name} ${job.state}: ${job.error || 'it has no answers'}`);
      },
      failed: (data) => {
        this.close();
        notice(data.error);
      },
    });
  }

  /** The first iteration again is that of a new stage, or of another attempt. @param {any} data */
  sample(data) {
    data.iteration.forEach((iteration, i) => {
      let to = this.samples[data.load_case[i]];
      if (!to || iteration <= to.iteration[to.iteration.length - 1])
        to = this.samples[data.load_case[i]] = Object.fromEntries(HISTORY.map((name) => [name, []]));
      for (const name of HISTORY) to[name].push(data[name][i]);
    });
  }
}

/** Reads the result of a job, or of the file. @param {string} of */
async function load(of) {
  try {
    const result = await ask('result', {of});
    if (model.of !== of) return;
    model.result = result;
    changed();
  } catch (error) {
    notice(error);
  }
}

/** Shows "jobs/ID", "file", or "", nothing. @param {string} of */
export function show(of) {
  model.live?.close();
  Object.assign(model, {of, result: null, live: null, tables: null});
  if (of === 'file')
    load(of);
  else if (of)
    model.live = new Live(of);
  changed();
}

/** The index of the load that is looked at. */
export const loadIndex = () =>
  Math.min(Math.max(Number(get('load')) || 0, 0), Math.max((model.result?.loads.length ?? 1) - 1, 0));

/** The load that is looked at; undefined if there is none. */
export const currentLoad = () => model.result?.loads[loadIndex()];

/** The stages of the job that have a mesh, which the first tab steps through. */
export const stages = () =>
  !['', 'membrane'].includes(get('tab')) ? [] : model.live?.job.stages.filter((stage) => stage.mesh) ?? [];

/** The stage that is looked at in place of the result: an earlier one, or while the job runs the last. */
export function currentStage() {
  const all = stages(), last = all.length - 1, wanted = get('stage') === '' ? last : Number(get('stage'));
  return all[model.result && !(wanted < last) ? -1 : Math.min(wanted, last)];
}

/** A unit behind a number or, in brackets, a name; or nothing. @param {string} of @param {boolean} brackets */
export function unit(of, brackets = false) {
  const told = model.result?.units[of] ?? '-';
  return told === '-' ? '' : brackets ? ` [${told}]` : ` ${told}`;
}

/** Tables of the result, read when they are first wanted. */
export async function tables() {
  const of = model.of, found = model.tables ?? await ask('tables', {of});
  if (model.of === of) model.tables = found;
  return found;
}

/** An array of the result. @param {string} what @param {number} load @param {any} more interface, or thin */
export const values = (what, load = loadIndex(), more = {}) => array({of: model.of, what, load, ...more});

/** The history of a load by name, as it comes or of the result; undefined if there is none. @param {number} index */
export async function history(index) {
  const steps = model.result?.loads[index]?.steps;
  if (!steps) return model.live?.samples[index];
  const packed = await values('history', index);
  return Object.fromEntries(HISTORY.map((name, i) => [name, packed.subarray(i * steps, (i + 1) * steps)]));
}
