// SPDX-License-Identifier: GPL-3.0-or-later
// A case to write: errors at their lines, keys explained, a drawing of what the server understood, Run, a sweep.
import {aside, button, choice, fill, make, plain, tick} from './dom.js';
import {model} from './model.js';
import {address, ask, notice, post} from './net.js';
import {set} from './state.js';

const PAUSE = 350; // after the last letter, before the case is checked [ms]
const SWEEP =
  'Many combinations of the loads of this case: a line of their names, then a line of numbers for each row, ' +
  'as 0.5, 1 or 0,5; 1 or pasted from a table.';
/** @type {any} */ let box = null;
/** @type {any[]} */ let keys = [];
let example = '', timer = 0, asked = 0;

/** @param {any} panel @param {() => boolean} wanted */
export async function draw(panel, wanted) {
  if (!box) box = await made();
  if (wanted() && !panel.contains(box)) fill(panel, box);
}

async function made() {
  const first = await ask('case'), given = {bounds: false, tips: false};
  const text =
    make('textarea', {spellcheck: 'false', 'aria-label': 'case', autocomplete: 'off', rows: '24', wrap: 'off'});
  const rows = make('textarea', {spellcheck: 'false', 'aria-label': 'rows of the sweep', rows: '5', wrap: 'off'});
  const lines = make('pre', {'aria-hidden': 'true', class: 'lines'});
  const errors = make('ul', {class: 'errors', role: 'status'});
  const key = make('div', {class: 'key', role: 'status'}), drawing = make('div', {class: 'drawing'});
  const parts = {text, lines, errors, key};
  const replace = (content) => {
    text.value = content;
    later(parts);
    fill(drawing);
  };
  text.addEventListener('input', () => later(parts));
  text.addEventListener('scroll', () => lines.scrollTop = text.scrollTop);
  for (const event of ['keyup', 'click']) text.addEventListener(event, () => explain(parts));
  const begin = async (name) => {
    example = name;
    if (name) replace((await ask('example', {name})).text);
  };
  const from = [['', 'an example\u2026'], ...first.examples.map((name) => [name, name])];
  const take = () => model.result?.case ? replace(model.result.case) : notice('the text of this case is not known');
  const run = (path, done, more = () => ({})) => async (event) => {
    event.target.disabled = true;
    try {
      const answer = await post(path, {text: text.value, example, ...more()});
      if (answer.errors)
        say(parts, answer.errors, []);
      else
        done(answer);
    } catch (error) {
      notice(error);
    }
    event.target.disabled = false;
  };
  const drawn = (answer) => fill(drawing, make('img', {
    src: address('drawing', {number: answer.number}),
    alt: `mesh of ${answer.triangles} triangles and ${answer.nodes} nodes`
  }),
    answer.warnings.map((each) => aside(plain(each))));
  const show = (answer) => set({of: answer.name, tab: '', load: '', stage: ''});
  const sweep = make('details', {class: 'sweep'}, make('summary', {}, 'Sweep over loads'), aside(SWEEP), rows,
    make('div', {class: 'controls'}, tick('bounds', false, (on) => given.bounds = on),
      tick('tips', false, (on) => given.tips = on),
      button('Run sweep', run('run', show, () => ({sweep: rows.value, ...given})))));
  replace(first.text || model.result?.case || '');
  ask('keys').then((found) => {
    keys = found;
    explain(parts);
  }, () => fill(key, 'Keys are explained when the server answers.'));
  return make('div', {class: 'editor'},
    make('div', {class: 'controls'}, first.examples.length > 0 && choice('begin from', from, '', begin),
      button('Case of this result', take), button('Draw', run('draw', drawn)),
      button('Run', run('run', show), {class: 'main'})),
    make('div', {class: 'sides'}, make('div', {class: 'code'}, lines, text),
      make('div', {class: 'beside'}, errors, key, sweep, drawing)));
}

function later(parts) {
  numbered(parts, []);
  clearTimeout(timer);
  timer = setTimeout(async () => {
    const mine = ++asked, text = parts.text.value, failed = (error) => [{line: 0, message: error.message}];
    if (!text.trim()) return say(parts, [], ['Begin from an example, or write a case.']);
    const answer = await post('check', {text}).catch((error) => ({notes: [], errors: failed(error)}));
    if (mine === asked) say(parts, answer.errors, answer.notes);
  }, PAUSE);
}

/** @param {any} parts @param {any[]} errors @param {string[]} notes */
function say(parts, errors, notes) {
  numbered(parts, errors.map((error) => error.line));
  fill(parts.errors,
    errors.map(({line, message}) => make('li', {class: 'error'},
                 line > 0 && button(`line ${line}`, () => select(parts.text, line)), ' ' + plain(message, 1000))),
    notes.map((note) => make('li', {}, plain(note))),
    !errors.length && !notes.length && make('li', {class: 'good'}, 'The server understands this case.'));
}

/** @param {any} parts @param {number[]} wrong */
function numbered(parts, wrong) {
  fill(parts.lines,
    parts.text.value.split('\n').map(
      (_, i) => make('span', {class: wrong.includes(i + 1) ? 'wrong' : ''}, `${i + 1}\n`)));
  parts.lines.scrollTop = parts.text.scrollTop;
}

/** @param {any} text @param {number} line */
function select(text, line) {
  const all = text.value.split('\n'), begin = all.slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0);
  text.focus();
  text.setSelectionRange(begin, begin + (all[line - 1]?.length ?? 0));
  text.scrollTop = (line - 5) * parseFloat(getComputedStyle(text).lineHeight);
}

/** Explains the key at the cursor. @param {any} parts */
function explain(parts) {
  const before = parts.text.value.slice(0, parts.text.selectionStart).split('\n');
  const line = parts.text.value.split('\n')[before.length - 1] ?? '';
  const table = before.reverse().map((each) => /^\s*\[+\s*([\w.]+)\s*\]+/.exec(each)?.[1]).find(Boolean);
  const name = [table, /^\s*([\w.-]+)\s*=/.exec(line)?.[1]].filter(Boolean).join('.');
  const bare = (key) => key.replace(/\.N(?=\.|$)/g, '').replace(/\.(?=\.)/g, '');
  const found = keys.find((each) => each.names.some((key) => bare(key) === name));
  fill(parts.key, !found ? aside('Put the cursor on a key to learn what it means.') : [
    make('strong', {}, name), ` ${found.form}`, found.unit ? ` [${found.unit}]` : '',
    make('p', {}, plain(found.meaning, 1500)), found.default && aside(`default: ${found.default}`)
  ]);
}
