// SPDX-License-Identifier: GPL-3.0-or-later
// Colours of values: viridis, and for both signs the diverging map of the package's drawings.
const VIRIDIS = ['#440154', '#472d7b', '#3b528b', '#2c728e', '#21918c', '#28ae80', '#5ec962', '#addc30', '#fde725'];
const DIVERGING = ['#1b4f8f', '#4a90c8', '#a6cbe3', '#dedede', '#f4b698', '#d6604d', '#97162b'];

/** @param {string} hex */
const channels = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));

/** @param {boolean} diverging */
export const stops = (diverging) => diverging ? DIVERGING : VIRIDIS;

/**
 * 256 colours, four bytes each.
 * @param {boolean} diverging
 */
export function colours(diverging) {
  const anchors = stops(diverging).map(channels), bytes = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) {
    const at = i / 255 * (anchors.length - 1), low = Math.min(Math.floor(at), anchors.length - 2);
    for (let c = 0; c < 3; ++c)
      bytes[4 * i + c] = anchors[low][c] + (anchors[low + 1][c] - anchors[low][c]) * (at - low);
    bytes[4 * i + 3] = 255;
  }
  return bytes;
}

/** Colours of lines, told apart also by who sees few colours. */
export const LINES = ['#0072b2', '#d55e00', '#009e73', '#cc79a7', '#e69f00', '#56b4e9', '#8a6d3b', '#7f7f7f'];
