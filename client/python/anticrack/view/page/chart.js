// SPDX-License-Identifier: GPL-3.0-or-later
// Lines over an axis, by Chart.js.
import {make, number} from './dom.js';

const Chart = /** @type {any} */ (globalThis).Chart;

/**
 * @typedef {{label: string, x: any, y: any, colour: string, dash?: number[], dots?: boolean, points?: boolean}} Line
 */

/** @param {string} name */
const css = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/**
 * At most four points in each of `columns` equal parts of the axis: the first, the least, the largest, the last.
 * Nothing that sticks out is lost. x must not fall. @param {ArrayLike<number>} x @param {ArrayLike<number>} y
 * @param {number} columns @return {{x: number, y: number}[]}
 */
export function thinned(x, y, columns) {
  const point = (i) => ({x: x[i], y: y[i]});
  if (x.length <= 4 * columns) return Array.from(x, (_, i) => point(i));
  const found = [], width = (x[x.length - 1] - x[0]) / columns || 1;
  for (let i = 0; i < x.length;) {
    const end = x[0] + (Math.floor((x[i] - x[0]) / width) + 1) * width, first = i;
    let low = i, high = i;
    for (; i < x.length && (x[i] < end || i === first); ++i) {
      if (y[i] < y[low]) low = i;
      if (y[i] > y[high]) high = i;
    }
    for (const each of [...new Set([first, low, high, i - 1])].sort((a, b) => a - b)) found.push(point(each));
  }
  return found;
}

const cursor = {
  id: 'cursor',
  beforeDatasetsDraw(chart) {
    const {ctx, chartArea: area, scales: {x}} = chart;
    const bar = (left, right, colour) => {
      ctx.fillStyle = css(colour);
      if (right >= left) ctx.fillRect(left, area.top, Math.max(right - left, 1), area.bottom - area.top);
    };
    ctx.save();
    for (const [from, to] of chart.shaded ?? [])
      bar(Math.max(x.getPixelForValue(from), area.left), Math.min(x.getPixelForValue(to), area.right), '--contact');
    if (chart.cursor !== undefined) bar(x.getPixelForValue(chart.cursor), x.getPixelForValue(chart.cursor), '--text');
    ctx.restore();
  },
};

/** A chart in a box of its own: `box` is the element. */
export class Lines {
  /**
   * @param {{title: string, x: string, y?: string, log?: boolean, short?: boolean}} options
   * @param {(x: number, y: number) => void} [pointed] told where the pointer is, or was clicked
   */
  constructor(options, pointed, on = /** @type {'mousemove'|'click'} */ ('mousemove')) {
    this.canvas = make('canvas', {role: 'img', tabindex: '0', 'aria-label': options.title});
    this.box = make('figure', {class: options.short ? 'chart short' : 'chart'}, make('div', {}, this.canvas));
    this.options = options;
    /** @type {any} */ this.chart = null;
    this.canvas.addEventListener(on, (event) => {
      const {x, y} = this.chart?.scales ?? {};
      if (x) pointed?.(x.getValueForPixel(event.offsetX), y.getValueForPixel(event.offsetY));
    });
  }

  /** @param {Line[]} lines @param {[number, number][]} shaded stretches of x */
  draw(lines, shaded = []) {
    const columns = Math.max(this.canvas.clientWidth, 300), log = this.options.log ?? false;
    const points = ({x, y}) => thinned(x, y, columns).filter((point) => !log || point.y > 0);
    const datasets = lines.map((line) => ({
      label: line.label,
      data: points(line),
      borderColor: line.colour,
      backgroundColor: line.colour,
      borderDash: line.dash ?? [],
      pointRadius: line.dots ? 3 : 0,
      showLine: !line.points
    }));
    if (this.chart)
      this.chart.data.datasets = datasets;
    else
      this.chart = new Chart(this.canvas, {type: 'line', data: {datasets}, options: this.look(log), plugins: [cursor]});
    this.chart.shaded = shaded;
    this.chart.update('none');
  }

  /** @param {boolean} log */
  look(log) {
    Object.assign(Chart.defaults, {color: css('--text'), borderColor: css('--line')});
    const round = (v) => /^[125](\.0*)?e/.test(v.toExponential(3)) ? number(v, 4) : null; // of a logarithmic axis
    const axis = (name, type) => ({
      type,
      title: {display: Boolean(name), text: name, padding: 2},
      ticks: {
        maxTicksLimit: this.options.short ? 5 : 7,
        maxRotation: 0,
        autoSkipPadding: 8,
        callback: (v) => type === 'linear' ? number(v, 4) : round(v)
      }
    });
    return {
      animation: false,
      parsing: false,
      normalized: true,
      maintainAspectRatio: false,
      elements: {line: {borderWidth: 1.5}, point: {hitRadius: 6}},
      interaction: {mode: 'nearest', intersect: false},
      scales: {x: axis(this.options.x, 'linear'), y: axis(this.options.y, log ? 'logarithmic' : 'linear')},
      plugins: {
        legend: {labels: {boxWidth: 18, boxHeight: 1, padding: 8}, position: 'top', align: 'end'},
        title: {display: true, text: this.options.title, align: 'start', padding: 0},
        tooltip: {callbacks: {title: (items) => items.length ? number(items[0].parsed.x) : ''}},
      }
    };
  }

  /** @param {number|undefined} x */
  mark(x) {
    if (!this.chart) return;
    this.chart.cursor = x;
    this.chart.draw();
  }

  destroy() { this.chart?.destroy(); }
}
