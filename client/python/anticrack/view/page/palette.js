// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of values: viridis, and for both signs the diverging map of the package's drawings.
const VIRIDIS = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];
const DIVERGING = ['#1b4f8f', '#4a90c8', '#a6cbe3', '#dedede', '#f4b698', '#d6604d', '#97162b'];
/** @param {boolean} diverging */
export const stops = (diverging) => diverging ? DIVERGING : VIRIDIS;

/** 256 colours, four bytes each. @param {boolean} diverging */
export function colours(diverging) {
  const anchors = stops(diverging).map((hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16)));
  return Uint8Array.from({length: 1024}, (_, i) => {
    const at = (i >> 2) / 255 * (anchors.length - 1), low = Math.min(Math.floor(at), anchors.length - 2), c = i & 3;
    return c === 3 ? 255 : anchors[low][c] + (anchors[low + 1][c] - anchors[low][c]) * (at - low);
  });
}

/** Whether the page is dark now. */
export const dark = () => getComputedStyle(document.documentElement).colorScheme === 'dark';
/** Colours of lines, told apart also by who sees few colours; on dark ground the dark ones are lighter. */
const LINES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8a6d3b', '#7f7f7f'];
const ON_DARK = ['#56b4e9', '#ff8c42', '#2fd0a0', '#e39cc4', '#f0c23c', '#9fd8ff', '#c8a878', '#b0b0b0'];
/** @param {number} i */
export const lineColour = (i) => (dark() ? ON_DARK : LINES)[i % LINES.length];
