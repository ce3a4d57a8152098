// SPDX-License-Identifier: GPL-3.0-or-later
// Which triangle lies under the pointer.
const T = /** @type {any} */ (globalThis).THREE;

/**
 * The nearest triangle on the ray through a point of the window (each coordinate from -1 to 1), and the place on it;
 * null if there is none. By Moeller and Trumbore, over all triangles: a million take some 30 ms.
 * @param {any} scene @param {number} px @param {number} py
 */
export function pick(scene, px, py) {
  const {position, height, triangles, points, u, total} = scene.full, rise = scene.uniforms.rise.value;
  const near = new T.Vector3(px, py, -1).unproject(scene.camera),
        ray = new T.Vector3(px, py, 1).unproject(scene.camera).sub(near);
  const [ox, oy, oz] = near.toArray(), [dx, dy, dz] = ray.toArray();
  let best = Infinity, found = -1, fb = 0, fc = 0;
  for (let i = 0; i < triangles.length; i += 3) {
    const a = triangles[i], b = triangles[i + 1], c = triangles[i + 2];
    const ax = position[3 * a], ay = position[3 * a + 1], az = height[a] * rise;
    const ex = position[3 * b] - ax, ey = position[3 * b + 1] - ay, ez = height[b] * rise - az;
    const gx = position[3 * c] - ax, gy = position[3 * c + 1] - ay, gz = height[c] * rise - az;
    const hx = dy * gz - dz * gy, hy = dz * gx - dx * gz, hz = dx * gy - dy * gx;
    const det = ex * hx + ey * hy + ez * hz;
    if (det === 0) continue;
    const sx = ox - ax, sy = oy - ay, sz = oz - az, v = (sx * hx + sy * hy + sz * hz) / det;
    if (v < 0 || v > 1) continue;
    const qx = sy * ez - sz * ey, qy = sz * ex - sx * ez, qz = sx * ey - sy * ex;
    const w = (dx * qx + dy * qy + dz * qz) / det;
    if (w < 0 || v + w > 1) continue;
    const t = (gx * qx + gy * qy + gz * qz) / det;
    if (t >= 0 && t < best) [best, found, fb, fc] = [t, i, v, w];
  }
  if (found < 0) return null;
  const [a, b, c] = triangles.subarray(found, found + 3), fa = 1 - fb - fc;
  const mean = (of, k = 1, at = 0) => fa * of[k * a + at] + fb * of[k * b + at] + fc * of[k * c + at];
  const triangle = 3 * total === triangles.length ? found / 3 : NaN; // thinned triangles are none of the mesh
  return {triangle, x: mean(points, 2), y: mean(points, 2, 1), u: u ? mean(u) : NaN};
}
