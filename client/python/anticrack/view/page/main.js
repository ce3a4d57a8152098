// SPDX-License-Identifier: GPL-3.0-or-later
// The page: tabs, what each shows, and what is told of the connection.
import * as convergence from './convergence.js';
import {byId, fill, make, plain} from './dom.js';
import * as editor from './editor.js';
import * as jobs from './jobs.js';
import * as membrane from './membrane.js';
import {changed, currentLoad, loadIndex, model, show, watch} from './model.js';
import {address, ask, notice, quiet} from './net.js';
import * as numbers from './numbers.js';
import * as series from './series.js';
import {get, listen, set} from './state.js';
import * as tables from './tables.js';
import * as traces from './traces.js';

/**
 * Tabs by name: title, whether the membrane is above, whether a result is needed, and what draws
 * the panel.
 */
const TABS =
  /**
     @type {Record<string, [string, boolean, boolean, ((panel: any, wanted: () => boolean) =>
         any)|null]>}
   */
  ({
    membrane: ['Membrane', true, true, null],
    interfaces: ['Interfaces', true, true, traces.draw],
    convergence: ['Convergence', false, false, convergence.draw],
    tables: ['Tables', false, true, tables.draw],
    sweep: ['Sweep', false, true, (panel, wanted) => series.draw(panel, wanted, 'sweep')],
    growth: ['Growth', true, true, (panel, wanted) => series.draw(panel, wanted, 'growth')],
    case: ['Case', false, false, editor.draw],
  });
const THEMES = ['', 'dark', 'light'];
let turn = 0, drawn = '';

const current = () => get('tab') in TABS ? get('tab') : model.of ? model.result?.sweep ? 'sweep' : 'membrane' : 'case';

async function draw() {
  const name = current(), [, stage, needs, panel] = TABS[name], mine = ++turn;
  document.documentElement.dataset.theme = get('theme');
  document.title =
    `${plain(model.result?.title ?? model.live?.job.title ?? '', 80) || 'anticrack'} \u2013 anticrack view`;
  fill(byId('title'), plain(model.result?.title ?? model.live?.job.title ?? '', 120) || 'anticrack');
  tabs(name);
  jobs.draw();
  numbers.draw();
  links(name);
  const box = byId('panel'), here = `${name} ${model.of} ${get('theme')}`, has = model.result || !needs;
  byId('stage').hidden = !stage || !model.result || !currentLoad();
  byId('columns').dataset.tab = name;
  box.hidden = Boolean(has && !panel && currentLoad());
  if (here !== drawn) fill(box);
  drawn = here;
  if (!has)
    return fill(
      box,
      make(
        'p', {class: 'quiet'},
        model.of ? 'Its answers are shown here when it has ended. Convergence shows it as it runs.' :
                   'Choose a job, or write a case and run it.'));
  if (needs && !currentLoad() && name !== 'sweep' && name !== 'tables')
    return fill(box, make('p', {class: 'quiet'}, 'No row of this sweep has traces: there is nothing to draw.'));
  try {
    if (stage) membrane.draw(numbers.clicked);
    await panel?.(box, () => mine === turn);
  } catch (error) {
    notice(error instanceof Error ? error.message : error);
  }
}

/** @param {string} name */
function tabs(name) {
  const names = Object.keys(TABS).filter(
    (tab) => (tab !== 'sweep' || !model.result || model.result.sweep) &&
      (tab !== 'growth' || !model.result || currentLoad()?.growth.length));
  const bar = byId('tabs'), focused = bar.contains(document.activeElement);
  fill(
    bar,
    ...names.map(
      (tab) => make(
        'button', {
          role: 'tab',
          id: `tab-${tab}`,
          'aria-selected': String(tab === name),
          'aria-controls': 'panel',
          tabindex: tab === name ? '0' : '-1',
          onclick: () => set({tab})
        },
        TABS[tab][0])));
  if (focused) byId(`tab-${name}`)?.focus();
}

/** @param {string} tab */
function links(tab) {
  const of = model.of, load = loadIndex(), has = Boolean(model.result);
  byId('export').hidden = !has;
  if (!has) return;
  const figure = tab === 'interfaces' ? 'traces' :
    tab === 'convergence'             ? 'convergence' :
    tab === 'growth'                  ? 'growth' :
    get('plan') === '1'               ? 'plan' :
                                        'membrane';
  const look = {
    ...(get('amplify') ? {amplify: get('amplify')} : {}),
    ...(get('limits') && get('colour', 'u') === 'u' ? {limits: get('limits')} : {}),
    ...(figure === 'traces' ? {interface: model.result.interfaces[Number(get('line')) || 0]?.name ?? ''} : {})
  };
  const link = (kind, text) =>
    make('a', {href: address('export', {of, load, kind, figure, ...look}), download: true}, text);
  fill(
    byId('export-links'),
    currentLoad() ?
      [link('png', `Figure of ${figure}, PNG`), link('svg', `Figure of ${figure}, SVG`), link('vtu', 'ParaView, VTU')] :
      null,
    link('h5', 'Result, HDF5'), model.result.case ? link('toml', 'Case, TOML') : null);
}

/** @param {{server: string, lost: string}} told */
function connection({server, lost}) {
  byId('connection').className = lost ? 'lost' : '';
  const before = byId('connection').dataset.lost;
  byId('connection').dataset.lost = lost ? '1' : '';
  fill(
    byId('connection'),
    lost ? `connection lost: ${plain(lost, 120)}` :
      before ? `${plain(server, 60)}: connection restored` :
               plain(server, 60));
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
    show(get('of'), connection);
  }
  changed();
});
jobs.start(connection);
show(get('of'), connection);
