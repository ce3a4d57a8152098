// SPDX-License-Identifier: GPL-3.0-or-later
// The page: tabs, and what each shows.
import * as convergence from './convergence.js';
import {aside, button, byId, fill, make, plain, refill} from './dom.js';
import * as editor from './editor.js';
import * as jobs from './jobs.js';
import * as membrane from './membrane.js';
import {changed, currentLoad, currentStage, loadIndex, model, show, watch} from './model.js';
import {address, ask, notice, quiet} from './net.js';
import * as numbers from './numbers.js';
import * as series from './series.js';
import {get, listen, on, set} from './state.js';
import * as tables from './tables.js';
import * as traces from './traces.js';

/**
 * Tabs by name: title, whether the membrane is above, whether a result is needed, what draws the panel, and its figure.
 */
const TABS = /** @type {Record<string, any[]>} */ ({
  membrane: ['Membrane', true, true, null, 'membrane'],
  interfaces: ['Interfaces', true, true, traces.draw, 'traces'],
  convergence: ['Convergence', false, false, convergence.draw, 'convergence'],
  tables: ['Tables', false, true, tables.draw, 'overview'],
  sweep: ['Sweep', false, true, (panel, wanted) => series.draw(panel, wanted, 'sweep'), 'overview'],
  growth: ['Growth', true, true, (panel, wanted) => series.draw(panel, wanted, 'growth'), 'growth'],
  case: ['Case', false, false, editor.draw, 'overview'],
});
const THEMES = ['', 'dark', 'light'];
const LATER = 'Its answers are shown here when it has ended. Convergence shows it as it runs.';
let turn = 0, drawn = '';

const current = () => get('tab') in TABS ? get('tab') : model.of ? model.result?.sweep ? 'sweep' : 'membrane' : 'case';

async function draw() {
  const name = current(), [, stage, needs, panel] = TABS[name], mine = ++turn;
  const title = plain(model.result?.title ?? model.live?.job.title ?? '', 120) || 'anticrack';
  document.documentElement.dataset.theme = get('theme');
  document.title = `${title} \u2013 anticrack view`;
  fill(byId('title'), title);
  tabs(name);
  jobs.draw();
  numbers.draw();
  links(name);
  const box = byId('panel'), here = `${name} ${model.of} ${get('theme')}`, load = currentLoad();
  const surface = stage && Boolean(load || name === 'membrane' && currentStage());
  byId('stage').hidden = !surface;
  byId('columns').dataset.tab = name;
  box.hidden = surface && !panel;
  if (here !== drawn) fill(box);
  drawn = here;
  try {
    if (surface) membrane.draw(clicked);
    if (name === 'membrane') membrane.mark(null);
    if (needs && !model.result && !surface)
      fill(box, aside(model.of ? LATER : 'Choose a job, or write a case and run it.'));
    else if (needs && !load && !surface && name !== 'sweep' && name !== 'tables')
      fill(box, aside('No row has traces: there is nothing to draw.'));
    else
      await panel?.(box, () => mine === turn);
  } catch (error) {
    notice(error);
  }
}

function clicked(hit) {
  numbers.clicked(hit).catch(notice);
  if (hit && current() === 'growth') series.chosen(hit.x, hit.y);
}

/** @param {string} name */
function tabs(name) {
  const {result} = model, study = result?.sweep?.jobs, bar = byId('tabs');
  const useless = study ? ['membrane', 'interfaces', 'convergence', 'growth']
                        : [result && !result.sweep && 'sweep', result && !currentLoad()?.growth.length && 'growth'];
  const made = (tab) => button(study && tab === 'sweep' ? 'Study' : TABS[tab][0], () => set({tab}), {
    role: 'tab',
    id: `tab-${tab}`,
    'aria-selected': String(tab === name),
    'aria-controls': 'panel',
    tabindex: tab === name ? '0' : '-1'
  });
  refill(bar, Object.keys(TABS).filter((tab) => !useless.includes(tab)).map(made));
  if (bar.contains(document.activeElement)) byId(`tab-${name}`)?.focus();
}

/** @param {string} tab */
function links(tab) {
  const of = model.of, load = loadIndex(), has = Boolean(model.result);
  byId('export').hidden = !has;
  if (!has) return;
  const study = model.result.sweep?.jobs, plan = tab === 'membrane' && on('plan');
  const figure = study ? 'study' : plan ? 'plan' : TABS[tab][4];
  const look = {
    ...(get('amplify') ? {amplify: get('amplify')} : {}),
    ...(get('limits') && get('colour', 'u') === 'u' ? {limits: get('limits')} : {}),
    ...(figure === 'traces' ? {interface: model.result.interfaces[Number(get('line')) || 0]?.name ?? ''} : {}),
  };
  const link = (kind, text) =>
    make('a', {href: address('export', {of, load, kind, figure, ...look}), download: true}, text);
  fill(byId('export-links'),
    (currentLoad() || study) && ['png', 'svg'].map((kind) => link(kind, `Figure of ${figure}, ${kind.toUpperCase()}`)),
    currentLoad() && link('vtu', 'ParaView, VTU'), link('h5', `${study ? 'Study' : 'Result'}, HDF5`),
    model.result.case && link('toml', 'Case, TOML'));
}

byId('tabs').addEventListener('keydown', (event) => {
  const by = /** @type {any} */ ({ArrowRight: 1, ArrowLeft: -1})[event.key];
  if (!by) return;
  const shown = [...byId('tabs').children].map((tab) => tab.id.slice(4)), at = shown.indexOf(current());
  set({tab: shown[(at + by + shown.length) % shown.length]});
});
byId('theme').addEventListener('click', () => set({theme: THEMES[(THEMES.indexOf(get('theme')) + 1) % THEMES.length]}));

const first = await ask('begin');
if (!get('of') && first.of) set({of: first.of}, true);
watch(draw);
listen((keys) => {
  if (keys.has('of') && get('of') !== model.of) {
    quiet();
    membrane.picked.hit = null;
    if (!keys.has('stage')) set({stage: ''}, true);
    show(get('of'));
  }
  changed();
});
jobs.start();
show(get('of'));
