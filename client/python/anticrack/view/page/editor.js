// SPDX-License-Identifier: GPL-3.0-or-later
// A case to write: errors at their lines, keys explained, a drawing of what the server understood,
// Run.
import {choice, fill, make, plain} from './dom.js';
import {model} from './model.js';
import {address, ask, notice, post} from './net.js';
import {set} from './state.js';

const PAUSE = 350;  // after the last letter, before the case is checked [ms]
/** @type {any} */
let box = null;
/** @type {any[]} */
let keys = [];
let example = '', timer = 0, asked = 0;

/** @param {any} panel @param {() => boolean} wanted */
export async function draw(panel, wanted) {
  if (!box) box = await made();
  if (wanted() && !panel.contains(box)) fill(panel, box);
}

async function made() {
  const first = await ask('case');
  const text =
    make('textarea', {spellcheck: 'false', 'aria-label': 'case', autocomplete: 'off', rows: '24', wrap: 'off'});
  const lines = make('pre', {'aria-hidden': 'true', class: 'lines'}),
        errors = make('ul', {class: 'errors', role: 'status'});
  const key = make('div', {class: 'key', role: 'status'}), drawing = make('div', {class: 'drawing'});
  const parts = {text, lines, errors, key, drawing};
  text.value = first.text || model.result?.case || '';
  text.addEventListener('input', () => later(parts));
  text.addEventListener('scroll', () => lines.scrollTop = text.scrollTop);
  for (const event of ['keyup', 'click']) text.addEventListener(event, () => explain(parts));
  const from = first.examples.length ?
    choice(
      'begin from', [['', 'an example\u2026'], ...first.examples.map((name) => [name, name])], '',
      async (name) => {
        if (!name) return;
        example = name;
        text.value = (await ask('example', {name})).text;
        later(parts);
        fill(drawing);
      }) :
    null;
  const take = make(
    'button', {
      onclick: () => {
        if (!model.result?.case) return notice('the text of this case is not known');
        text.value = model.result.case;
        later(parts);
      }
    },
    'Case of this result');
  const run = (path, done) => async (event) => {
    event.target.disabled = true;
    try {
      const answer = await post(path, {text: text.value, example});
      if (answer.errors)
        say(parts, answer.errors, []);
      else
        done(answer);
    } catch (error) {
      notice(error instanceof Error ? error.message : error);
    }
    event.target.disabled = false;
  };
  const show = (answer) => fill(
    drawing, make('img', {
      src: address('drawing', {number: answer.number}),
      alt: `mesh of ${answer.triangles} triangles and ${answer.nodes} nodes`
    }),
    ...answer.warnings.map((warning) => make('p', {class: 'quiet'}, plain(warning))));
  later(parts);
  ask('keys').then((found) => {
    keys = found;
    explain(parts);
  }, () => fill(key, 'Keys are explained when the server answers.'));
  return make(
    'div', {class: 'editor'},
    make(
      'div', {class: 'controls'}, from, take, make('button', {onclick: run('draw', show)}, 'Draw'),
      make(
        'button', {class: 'main', onclick: run('run', (answer) => set({of: answer.name, tab: 'membrane', load: ''}))},
        'Run')),
    make(
      'div', {class: 'sides'}, make('div', {class: 'code'}, lines, text),
      make('div', {class: 'beside'}, errors, key, drawing)));
}

/** @param {any} parts */
function later(parts) {
  numbered(parts, []);
  clearTimeout(timer);
  timer = setTimeout(async () => {
    const mine = ++asked;
    if (!parts.text.value.trim()) return say(parts, [], ['Begin from an example, or write a case.']);
    try {
      const {errors, notes} = await post('check', {text: parts.text.value});
      if (mine === asked) say(parts, errors, notes);
    } catch (error) {
      if (mine === asked) say(parts, [{line: 0, message: error instanceof Error ? error.message : error}], []);
    }
  }, PAUSE);
}

/** @param {any} parts @param {any[]} errors @param {string[]} notes */
function say(parts, errors, notes) {
  numbered(parts, errors.map((error) => error.line));
  fill(
    parts.errors,
    ...errors.map(
      ({line, message}) => make(
        'li', {class: 'error'}, line ? make('button', {onclick: () => select(parts.text, line)}, `line ${line}`) : null,
        ' ' + plain(message, 1000))),
    ...notes.map((note) => make('li', {}, plain(note))),
    errors.length || notes.length ? null : make('li', {class: 'good'}, 'The server understands this case.'));
}

/** @param {any} parts @param {number[]} wrong */
function numbered(parts, wrong) {
  const count = parts.text.value.split('\n').length;
  fill(
    parts.lines,
    ...Array.from(
      {length: count}, (_, i) => make('span', {class: wrong.includes(i + 1) ? 'wrong' : ''}, `${i + 1}\n`)));
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
  const table =
    [...before].reverse().concat().map((each) => /^\s*\[+\s*([\w.]+)\s*\]+/.exec(each)?.[1]).find(Boolean) ?? '';
  const word = /^\s*([\w.-]+)\s*=/.exec(line)?.[1] ?? '';
  const name = [table, word].filter(Boolean).join('.');
  const bare = (key) => key.replace(/\.N(?=\.|$)/g, '').replace(/\.(?=\.)/g, '');
  const found = keys.find((each) => each.names.some((key) => bare(key) === name));
  fill(
    parts.key,
    found ?
      [
        make('strong', {}, name), ` ${found.form}`, found.unit ? ` [${found.unit}]` : '',
        make('p', {}, plain(found.meaning, 1500)),
        found.default ? make('p', {class: 'quiet'}, `default: ${found.default}`) : null
      ] :
                                                                 make('span', {class: 'quiet'}, 'Put the cursor on a key to learn what it means.'));
}
