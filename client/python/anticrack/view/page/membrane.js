// SPDX-License-Identifier: GPL-3.0-or-later
// The membrane with its controls, or the mesh of a stage.
import {button, byId, choice, fill, make, nearest, number, parse, slider, tick} from './dom.js';
import {currentLoad, currentStage, loadIndex, model, stages, unit, values} from './model.js';
import {array, notice} from './net.js';
import {stops} from './palette.js';
import {MANY, Scene} from './scene.js';
import {get, on, set} from './state.js';

const NAMES = /** @type {Record<string, string[]>} */ ({
  u: ['u', 'L'],
  flux: ['|T grad u|, mean at nodes', 'F/L'],
  energy_density: ['energy density, mean at nodes', 'F/L'],
  indicator: ['log10 of error indicator over area', ''],
});
const KINDS =
  ['', '#8a8f98', '#d55e00', '#1f6fd0', '#c2188f', '#e69f00']; // glue, crack, bonded, delaminated, free crack
/** A stage, of which u is not kept. */
const BARE = {
  name: '',
  colours: /** @type {string[]} */ ([])
};
/** @type {Scene|null} */ let scene = null;
let shown = '';    // what the scene's geometry is of
let automatic = 1; // the amplification that shows u best
let task = 0;
/** @type {number[]|null} */ let marked = null;

/** What was clicked, for the column of numbers. */
export const picked = /** @type {{hit: any}} */ ({hit: null});

/** @param {number[]|null} place */
export function mark(place) {
  marked = place;
  scene?.mark(place);
}

/** Shows the membrane of the load that is looked at. @param {(hit: any) => void} clicked */
export async function draw(clicked) {
  const stage = currentStage(), load = stage ? BARE : currentLoad(), mine = ++task, wanted = () => mine === task;
  if (!load) return;
  try {
    scene ??= new Scene(clicked);
    scene.moved = (view) => set({view}, true);
    const key = [model.of, loadIndex(), stage?.mesh, get('plan'), get('names')].join(' ');
    const layer = layers(stage, load), thin = (stage ?? model.result).triangles > MANY;
    if (key !== shown) {
      if (!await surface(scene, await layer(thin), stage ? null : load, wanted)) return;
      scene.setView(get('view'), on('plan'));
    }
    shown = key;
    scene.mark(marked);
    await paint(scene, load, wanted);
    if (thin && scene.full === scene.thin) await paint(scene, load, wanted, await layer(false));
  } catch (error) {
    notice(error);
  }
}

/** What reads the surface of a load or the mesh of a stage: all of it, or fewer triangles. */
const layers = (stage, load) => async (thin) => {
  const few = thin ? {thin: 1} : {},
        of = (what) => stage ? array({mesh: stage.mesh, what, ...few}) : values(what, loadIndex(), few);
  const names = ['points', 'triangles', 'outline', ...(load.colours.length ? ['u'] : [])];
  const [points, triangles, outline, u = null] = await Promise.all(names.map(of));
  return {points, triangles, outline, u, total: (stage ?? model.result).triangles};
};

/** @param {Scene} to @param {any} layer @param {any} load null: of a stage @param {() => boolean} wanted */
async function surface(to, layer, load, wanted) {
  const {interfaces, marks, tips} = load ? model.result : {interfaces: [], marks: [], tips: []};
  const trace = (what, i) => values(what, loadIndex(), {interface: i});
  const traces = await Promise.all(
    interfaces.map((_, i) => Promise.all([trace('line', i), load.traces ? trace('trace', i) : null])));
  if (!wanted()) return false;
  to.show(layer);
  const [low, high] = layer.u?.range ?? [0, 0], most = Math.max(-low, high, 0.65 * (high - low));
  automatic = most > 0 ? Number((0.25 * to.size / most).toPrecision(2)) : 1;
  /** @type {number[][]} */ const places = [];
  traces.forEach(([line, trace], i) => {
    const k = interfaces[i].nodes,
          at = (j, face = 0) => [line[k + j], line[2 * k + j], trace ? trace[face * k + j] : 0];
    for (let begin = 0, j = 1; j < k; ++j) {
      if (j < k - 1 && line[3 * k + j] === line[3 * k + begin]) continue;
      const nodes = Array.from({length: j - begin + 1}, (_, n) => begin + n);
      for (const face of [0, 1])
        to.line(nodes.map((n) => to.place(...at(n, face))), KINDS[line[3 * k + begin]] || KINDS[1]);
      begin = j;
    }
    for (let j = 0; j < k; ++j) places.push(at(j, 1));
  });
  // As high as the nearest node of an interface.
  const placed = ([x, y]) => to.place(x, y, places[nearest(places, x, y)]?.[2] ?? 0);
  if (on('names', true))
    for (const {name, at} of marks.slice(0, 40)) to.name(name, placed(at));
  if (tips.length) to.add(to.dots(tips.map(placed), '#222222', 8));
  return true;
}

/** @param {Scene} to @param {any} load @param {() => boolean} wanted @param {any} whole a layer to show behind */
async function paint(to, load, wanted, whole = null) {
  const what = load.colours.includes(get('colour', 'u')) ? get('colour', 'u') : load.colours[0];
  const of = async (index, thin) => {
    const found = await values(what, index, thin ? {thin: 1} : {}), log = (v) => v > 0 ? Math.log10(v) : NaN;
    return what === 'indicator' ? Object.assign(found.map(log), {range: found.range.map(Math.log10)}) : found;
  };
  const same = what && on('same')
    ? model.result.loads.map((_, i) => i).filter((i) => model.result.loads[i].colours.includes(what)).slice(0, 12)
    : [];
  const few = to.thin.total > MANY, all = !few || whole || to.full !== to.thin;
  const found = await Promise.all(
    !what ? [] : [of(loadIndex(), few), all ? of(loadIndex(), false) : null, ...same.map((i) => of(i, few))]);
  if (!wanted()) return;
  if (whole) to.whole(whole);
  const ranges = found.filter(Boolean).map((each) => each.range), cut = ranges[0]?.[2] < ranges[0]?.[1];
  let low = Math.min(...ranges.map((range) => range[0])), high = Math.max(...ranges.map((range) => range[cut ? 2 : 1]));
  if (what === 'indicator') low = Math.max(low, high - 6); // decades that can be told apart
  const both = what === 'u' && Math.min(-low, high) > 0.05 * Math.max(-low, high);
  if (both) [low, high] = [-Math.max(-low, high), Math.max(-low, high)];
  const given = get('limits').split(',').map(Number);
  if (given.length === 2 && given[0] < given[1]) [low, high] = given;
  to.paint(found, low, high, both, on('contours') ? 12 : 0);
  to.lines(on('mesh') || load === BARE);
  const amplify = on('plan') ? 0 : get('amplify') ? Number(get('amplify')) : automatic;
  to.rise(amplify);
  controls(to, load, what, low, high, amplify);
  bar(what, low, high, both, cut && !get('limits'));
  byId('scene').setAttribute('aria-label',
    !what ? 'mesh' : `membrane under ${load.name}, ${NAMES[what][0]} from ${number(low)} to ${number(high)}`);
}

/** A choice that is also stepped through. @param {string} what @param {string[]} names @param {number} index */
function stepped(what, names, index) {
  const step = (by, text, label) =>
    button(text, () => set({[what]: index + by}), {'aria-label': label, disabled: !names[index + by]});
  return names.length > 1 && [
    step(-1, '\u25c0', `${what} before`),
    choice(what, names.map((name, i) => [String(i), name]), String(index), (value) => set({[what]: value})),
    step(1, '\u25b6', `next ${what}`)
  ];
}

/** @param {Scene} to @param {any} load @param {string} what */
function controls(to, load, what, low, high, amplify) {
  const all = stages(), stage = currentStage();
  const limited = (at) => (event) => {
    const limits = [low, high];
    limits[at] = parse(event.target.value);
    set({limits: limits[0] < limits[1] ? limits.join(',') : ''});
  };
  const limit = (label, at) => make('input', {
    'aria-label': label,
    title: `${label}: as 0.5 or 0,5`,
    size: '7',
    inputmode: 'decimal',
    value: number([low, high][at], 4),
    onchange: limited(at)
  });
  const risen = (event) => {
    const wanted = Number(event.target.value) <= -2 ? 0 : automatic * 10 ** Number(event.target.value);
    set({amplify: Number(wanted.toPrecision(3))}, true);
    to.rise(wanted);
    to.wheel(); // many triangles are thinned meanwhile
    fill(event.target.nextSibling, `\u00d7${number(wanted, 3)}`);
  };
  const deform = slider('deform', [-2, 2, 0.02], amplify > 0 ? Math.log10(amplify / automatic) : -2,
    {oninput: risen, title: `u is drawn ${number(amplify, 3)} times as large`});
  const whole = () => {
    set({view: ''}, true);
    to.setView('', on('plan'));
  };
  const at = stage ? all.indexOf(stage) : all.length - 1;
  const names = load !== BARE && model.result.loads.map((each) => each.name);
  fill(byId('stage-controls'), stepped('stage', all.map((each, i) => `${i + 1}: ${each.triangles} triangles`), at),
    names && stepped('load', names, loadIndex()),
    what &&
      choice('colour', load.colours.map((key) => [key, NAMES[key][0]]), what, (colour) => set({colour, limits: ''})),
    what && make('span', {}, 'from ', limit('lowest colour', 0), ' to ', limit('highest colour', 1)),
    what && get('limits') && button('all values', () => set({limits: ''})),
    what && !on('plan') && make('label', {}, 'deform ', deform, make('output', {}, `\u00d7${number(amplify, 3)}`)),
    choice('as', [['', 'in space'], ['1', 'plan']], get('plan') === '1' ? '1' : '', (plan) => set({plan, view: ''})),
    names && tick('mesh', on('mesh'), (mesh) => set({mesh})),
    what && tick('contours', on('contours'), (contours) => set({contours})),
    names && tick('names', on('names', true), (names) => set({names})),
    what && names.length > 1 && tick('same colours for all loads', on('same'), (same) => set({same, limits: ''})),
    button('whole view', whole));
}

/** @param {string} what @param {number} low @param {number} high @param {boolean} both @param {boolean} cut */
function bar(what, low, high, both, cut) {
  if (!what) return fill(byId('bar'), currentStage() ? 'the mesh; u of a stage is not kept' : 'u is not known here');
  const paint = make('i', {});
  paint.style.background = `linear-gradient(to right, ${stops(both).join(',')})`;
  fill(byId('bar'), make('span', {}, NAMES[what][0] + unit(NAMES[what][1], true)), make('span', {}, number(low, 4)),
    paint, make('span', {}, number(high, 4) + (cut ? ' and more, on 2 % of the area' : '')));
}
