// SPDX-License-Identifier: GPL-3.0-or-later
// The membrane in space, by three.js. Coordinates are those of the result, moved to its middle and over its size; u
// is the third one, and the group's scale makes it rise, so that deforming costs nothing. No light: normals of slivers
// at tips would be noise.
import {byId, fill, make, plain} from './dom.js';
import {colours} from './palette.js';

const T = /** @type {any} */ (globalThis).THREE;
export const MANY = 200_000; // triangles, above which a thinned mesh is shown while the view moves
const UNKNOWN = -1e30;
const VERTEX = `attribute float value; varying float v;
void main() { v = value; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`;
const FACE = `uniform sampler2D palette; uniform float low, high, contours; varying float v;
void main() {
  float t = clamp((v - low) / (high - low), 0.0, 1.0);
  vec3 colour = v < -1e29 ? vec3(0.62) : texture2D(palette, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  float k = t * contours, width = fwidth(k);
  if (contours > 0.0 && t > 0.0 && t < 1.0)
    colour *= 0.35 + 0.65 * smoothstep(0.4, 1.4, (0.5 - abs(fract(k) - 0.5)) / max(width, 1e-6));
  gl_FragColor = vec4(colour, 1.0);
}`;
const DOT = VERTEX.replace('void main() {', 'uniform float size; void main() { gl_PointSize = size;');
const DOTS = `uniform vec3 colour; void main() {
  float r = length(gl_PointCoord - 0.5);
  if (r > 0.5) discard;
  gl_FragColor = vec4(r > 0.34 ? vec3(1.0) : colour, 1.0);
}`;

export class Scene {
  /** @param {(hit: any) => void} clicked */
  constructor(clicked) {
    this.canvas = byId('scene');
    this.renderer = new T.WebGLRenderer({canvas: this.canvas, antialias: true, alpha: true});
    this.camera = new T.OrthographicCamera(-1, 1, 1, -1, -50, 50);
    this.camera.up.set(0, 0, 1);
    this.controls = new T.OrbitControls(this.camera, this.canvas);
    this.controls.screenSpacePanning = true;
    this.scene = new T.Scene();
    /** @type {Record<string, {value: any}>} */
    this.uniforms = {low: {value: 0}, high: {value: 1}, contours: {value: 0}, palette: {value: null}};
    this.group = new T.Group();
    this.scene.add(this.group);
    this.middle = [0, 0];
    this.size = 1;
    /** @type {any} */
    this.full = this.thin = null; // layers
    /** @type {{node: any, at: any}[]} */ this.names = [];
    this.marker = this.dots([new T.Vector3()], '#e02020', 12);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => this.move(true));
    this.controls.addEventListener('end', () => this.move(false));
    let down = [0, 0];
    this.clicked = (x, y) => clicked(this.full && this.pick(x, y));
    this.canvas.addEventListener('pointerdown', (e) => down = [e.clientX, e.clientY]);
    this.canvas.addEventListener('click', (e) => {
      const {left, top, width, height} = this.canvas.getBoundingClientRect();
      if (Math.hypot(e.clientX - down[0], e.clientY - down[1]) < 5)
        this.clicked((e.clientX - left) / width * 2 - 1, 1 - (e.clientY - top) / height * 2);
    });
    this.canvas.addEventListener('keydown', (e) => this.key(e));
    new ResizeObserver(() => this.resize()).observe(byId('holder'));
    /** @type {(view: string) => void} */ this.moved = () => {};
    this.waiting = this.settle = 0;
  }

  /** @param {any[]} places @param {string} colour @param {number} size */
  dots(places, colour, size) {
    const uniforms = {colour: {value: new T.Color(colour)}, size: {value: size}};
    const look = new T.ShaderMaterial({vertexShader: DOT, fragmentShader: DOTS, uniforms, depthTest: false});
    const points = new T.Points(new T.BufferGeometry().setFromPoints(places), look);
    return Object.assign(points, {renderOrder: 3, frustumCulled: false});
  }

  /** Shows another surface: what membrane.js reads of the result, or of the mesh of a stage. @param {any} surface */
  show(surface) {
    this.group.traverse((object) => object.geometry?.dispose());
    this.group.remove(...this.group.children);
    this.group.add(this.marker);
    fill(byId('labels'));
    this.names = [];
    const ends =
      [0, 1].map((c) => surface.points.filter((_, i) => i % 2 === c)
                          .reduce(([low, high], at) => [Math.min(low, at), Math.max(high, at)], [Infinity, -Infinity]));
    this.middle = ends.map(([low, high]) => (low + high) / 2);
    this.size = Math.max(...ends.map(([low, high]) => high - low));
    this.full = this.thin = this.layer(surface);
    this.change(false);
  }

  /** Shows all triangles, and those that were shown while the view moves. @param {any} surface */
  whole(surface) {
    this.full = this.layer(surface);
    this.change(false);
  }

  /** @param {any} surface */
  layer(surface) {
    const {points, u} = surface, count = points.length / 2, group = new T.Group();
    const position = new Float32Array(3 * count);
    for (let i = 0; i < count; ++i) this.place(points[2 * i], points[2 * i + 1], u?.[i]).toArray(position, 3 * i);
    const value = new T.BufferAttribute(new Float32Array(count).fill(UNKNOWN), 1);
    const attributes = {position: new T.BufferAttribute(position, 3), value};
    const add = (kind, index, material) => {
      const made = Object.assign(new T.BufferGeometry(), {attributes});
      made.setIndex(new T.BufferAttribute(new Uint32Array(index.buffer, index.byteOffset, index.length), 1));
      return this.add(new kind(made, material), group);
    };
    const behind = {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}; // its lines
    const coloured = {vertexShader: VERTEX, fragmentShader: FACE, uniforms: this.uniforms, side: T.DoubleSide};
    const mesh =
      add(T.Mesh, surface.triangles, new T.ShaderMaterial({...coloured, ...behind, extensions: {derivatives: true}}));
    add(T.LineSegments, surface.outline, new T.LineBasicMaterial({color: '#333333'}));
    return {...surface, value, mesh, edges: null, group: this.add(group)};
  }

  add(object, to = this.group) {
    object.frustumCulled = false;
    to.add(object);
    return object;
  }

  /** Lines of the mesh, made when they are first wanted. @param {boolean} wanted */
  lines(wanted) {
    const look = {color: '#000000', opacity: 0.13, transparent: true, wireframe: true}; // edges come twice
    if (wanted)
      this.full.edges ??= this.add(new T.Mesh(this.full.mesh.geometry, new T.MeshBasicMaterial(look)), this.full.group);
    for (const {edges} of [this.thin, this.full])
      if (edges) edges.visible = wanted;
  }

  /**
   * Colours of the nodes. @param {any[]} values of the thinned layer and of the full one; none: not known
   * @param {number} low @param {number} high @param {boolean} diverging @param {number} contours
   */
  paint(values, low, high, diverging, contours) {
    [this.thin, this.full].forEach((layer, n) => {
      const to = layer.value.array, from = values[n] ?? values[0] ?? [];
      for (let i = 0; i < to.length; ++i) to[i] = Number.isFinite(from[i]) ? from[i] : UNKNOWN;
      layer.value.needsUpdate = true;
    });
    this.uniforms.low.value = low;
    this.uniforms.high.value = high > low ? high : low + 1;
    this.uniforms.contours.value = contours;
    const palette = new T.DataTexture(colours(diverging), 256, 1, T.RGBAFormat);
    palette.needsUpdate = true;
    this.uniforms.palette.value?.dispose();
    this.uniforms.palette.value = palette;
  }

  /** @param {number} amplify */
  rise(amplify) {
    this.group.scale.z = Math.max(amplify / this.size, 1e-9); // 0 has no inverse, which picking takes
    this.draw();
  }

  /** A place of the result in the group. @param {number} x @param {number} y @param {number} u */
  place(x, y, u) {
    const [midX, midY] = this.middle;
    return new T.Vector3((x - midX) / this.size, (y - midY) / this.size, Number.isFinite(u) ? u : 0);
  }

  /** @param {any[]} places @param {string} colour */
  line(places, colour) {
    const material = new T.LineBasicMaterial({color: colour});
    const line = new T.Line(new T.BufferGeometry().setFromPoints(places), material);
    this.add(Object.assign(line, {renderOrder: 1}));
  }

  /** @param {string} name @param {any} at its place */
  name(name, at) {
    const node = make('span', {}, plain(name, 40));
    byId('labels').append(node);
    this.names.push({node, at});
  }

  /** Marks a place, or none. @param {number[]|null} place x, y, u */
  mark(place) {
    this.marker.visible = place !== null && this.full !== null;
    if (place) this.marker.position.copy(this.place(place[0], place[1], place[2]));
    this.draw();
  }

  /**
   * The nearest triangle under a point of the window (each coordinate from -1 to 1), and the place on it; undefined if
   * there is none. It takes time with the triangles: a million some 50 ms. @param {number} px @param {number} py
   */
  pick(px, py) {
    const [near, far] = [-1, 1].map((z) => new T.Vector3(px, py, z).unproject(this.camera));
    const {mesh, points, triangles, total, u} = this.full;
    const [hit] = new T.Raycaster(near, far.sub(near).normalize()).intersectObject(mesh);
    if (!hit) return;
    const {face: {a, b, c}, point} = hit, at = [a, b, c].map((i) => this.place(points[2 * i], points[2 * i + 1], 0));
    const parts = T.Triangle.getBarycoord(point.setZ(0), ...at, new T.Vector3()).toArray();
    const triangle = 3 * total === triangles.length ? hit.faceIndex : NaN; // thinned triangles are none of the mesh
    const [x, y] = point.toArray().map((value, i) => this.middle[i] + value * this.size);
    return {triangle, x, y, u: u ? parts[0] * u[a] + parts[1] * u[b] + parts[2] * u[c] : NaN};
  }

  /** @param {boolean} begins */
  move(begins) {
    clearTimeout(this.settle);
    if (begins) return this.change(true);
    this.settle = setTimeout(() => {
      this.change(false);
      this.moved(this.view());
    }, 200);
  }

  /** Shows the thinned triangles or all of them, and says so. @param {boolean} moves */
  change(moves) {
    if (!this.full) return;
    const alone = this.full === this.thin, count = this.thin.triangles.length / 3, total = this.thin.total;
    this.full.group.visible = alone || !moves;
    this.thin.group.visible = alone || moves;
    byId('moving').hidden = count === total || !this.thin.group.visible;
    fill(byId('moving'), `${count} of ${total} triangles${alone ? '; all are being read' : ' while it moves'}`);
    this.draw();
  }

  wheel() {
    this.move(true);
    this.move(false);
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    const turns = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1]};
    const turn = /** @type {any} */ (turns)[event.key],
          zoom = /** @type {any} */ ({'+': 1.2, '=': 1.2, '-': 1 / 1.2})[event.key];
    if (turn && this.controls.enableRotate) {
      const {position, up} = this.camera, {target} = this.controls, right = up.clone().cross(position.sub(target));
      position.applyAxisAngle(right.normalize(), turn[1]).applyAxisAngle(up, turn[0]).add(target);
    } else if (zoom) {
      this.camera.zoom *= zoom;
    } else {
      return event.key === 'Enter' && this.clicked(0, 0); // what lies in the middle
    }
    event.preventDefault();
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.wheel();
  }

  /** The view as a text for the fragment: where the camera is, its zoom, what it looks at. */
  view() {
    const {position, zoom} = this.camera, {target} = this.controls;
    return [...position.toArray(), zoom, ...target.toArray()].map((value) => Number(value.toPrecision(5))).join(',');
  }

  /** @param {string} view @param {boolean} plan */
  setView(view, plan) {
    const given = view.split(',').map(Number), whole = plan ? [0, -3e-4, 3] : [1.21, -2.2154, 1.6209];
    const [x, y, z, zoom, ...target] =
      given.length === 7 && given.every(Number.isFinite) ? given : [...whole, 1, 0, 0, 0];
    this.controls.enableRotate = !plan;
    this.controls.target.fromArray(target);
    this.camera.position.set(x, y, z);
    this.camera.zoom = zoom;
    this.controls.update();
    this.resize();
  }

  resize() {
    const {clientWidth: width, clientHeight: height} = byId('holder');
    if (!width || !height) return;
    this.renderer.setPixelRatio(devicePixelRatio);
    this.renderer.setSize(width, height, false);
    const [across, down] = this.controls.enableRotate ? [0.74, 0.56] : [0.58, 0.58];
    const half = Math.max(down, across * height / width), wide = half * width / height;
    Object.assign(this.camera, {left: -wide, right: wide, top: half, bottom: -half});
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  draw() {
    if (!this.waiting) this.waiting = requestAnimationFrame(() => this.render());
  }

  render() {
    this.waiting = 0;
    this.renderer.render(this.scene, this.camera);
    const {clientWidth: width, clientHeight: height} = this.canvas;
    for (const {node, at} of this.names) {
      const {x, y} = this.group.localToWorld(at.clone()).project(this.camera);
      node.style.transform = `translate(${(x + 1) / 2 * width}px, ${(1 - y) / 2 * height}px) translate(-50%, -130%)`;
    }
    this.canvas.dataset.frames = String(Number(this.canvas.dataset.frames ?? 0) + 1);
  }
}
