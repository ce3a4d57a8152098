// SPDX-License-Identifier: GPL-3.0-or-later
// The membrane in space, by three.js. Coordinates are those of the result, moved to its middle and over its size; u
// rises by a number that the shaders multiply, so that deforming costs nothing. No light: normals of slivers at tips
// would be noise.
import {byId, fill, make, plain} from './dom.js';
import {colours} from './palette.js';
import {pick} from './pick.js';

const T = /** @type {any} */ (globalThis).THREE;
export const MANY = 200_000; // triangles, above which a thinned mesh is shown while the view moves
const UNKNOWN = -1e30;
const VERTEX = `attribute float u; attribute float value; uniform float rise; varying float v;
void main() { v = value; gl_Position = projectionMatrix * modelViewMatrix * vec4(position.xy, u * rise, 1.0); }`;
const FACE = `uniform sampler2D palette; uniform float low, high, contours; varying float v;
void main() {
  float t = clamp((v - low) / (high - low), 0.0, 1.0);
  vec3 colour = v < -1e29 ? vec3(0.62) : texture2D(palette, vec2((t * 255.0 + 0.5) / 256.0, 0.5)).rgb;
  float k = t * contours, width = fwidth(k);
  if (contours > 0.0 && t > 0.0 && t < 1.0)
    colour *= 0.35 + 0.65 * smoothstep(0.4, 1.4, (0.5 - abs(fract(k) - 0.5)) / max(width, 1e-6));
  gl_FragColor = vec4(colour, 1.0);
}`;
const LINE = `uniform vec3 colour; uniform float opacity; void main() { gl_FragColor = vec4(colour, opacity); }`;
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
    this.uniforms = {rise: {value: 1}, low: {value: 0}, high: {value: 1}, contours: {value: 0}, palette: {value: null}};
    this.group = new T.Group();
    this.scene.add(this.group);
    this.middle = [0, 0];
    this.size = 1;
    /** @type {any} */
    this.full = this.thin = null; // layers
    /** @type {{node: any, x: number, y: number, u: number}[]} */ this.names = [];
    this.marker = this.dots([[0, 0, 0]], '#e02020', 12);
    this.marker.visible = false;
    this.scene.add(this.marker);
    this.controls.addEventListener('change', () => this.draw());
    this.controls.addEventListener('start', () => this.move(true));
    this.controls.addEventListener('end', () => this.move(false));
    this.canvas.addEventListener('wheel', () => this.wheel(), {passive: true});
    let down = [0, 0];
    this.clicked = (x, y) => clicked(this.full && pick(this, x, y));
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

  /** @param {string} vertexShader @param {string} fragmentShader @param {any} uniforms @param {any} more */
  material(vertexShader, fragmentShader, uniforms, more = {}) {
    const values = Object.entries(uniforms).map(([name, value]) => [name, {value}]);
    return new T.ShaderMaterial(
      {vertexShader, fragmentShader, ...more, uniforms: {...this.uniforms, ...Object.fromEntries(values)}});
  }

  /** @param {string} colour @param {number} opacity @param {boolean} wireframe of triangles, whose edges come twice */
  lineMaterial(colour, opacity = 1, wireframe = false) {
    return this.material(VERTEX, LINE, {colour: new T.Color(colour), opacity}, {transparent: opacity < 1, wireframe});
  }

  /** @param {number[][]} places x, y in the scene, u @param {string} colour @param {number} size */
  dots(places, colour, size) {
    const points = new T.Points(
      this.geometry(places), this.material(DOT, DOTS, {colour: new T.Color(colour), size}, {depthTest: false}));
    return Object.assign(points, {renderOrder: 3, frustumCulled: false});
  }

  /** @param {number[][]} places x, y in the scene, u */
  geometry(places) {
    const geometry = new T.BufferGeometry();
    geometry.setAttribute('position', new T.Float32BufferAttribute(places.flatMap(([x, y]) => [x, y, 0]), 3));
    geometry.setAttribute('u', new T.Float32BufferAttribute(places.map((place) => place[2]), 1));
    return geometry;
  }

  /** Shows another surface: what membrane.js reads of the result, or of the mesh of a stage. @param {any} surface */
  show(surface) {
    this.clear();
    const low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    surface.points.forEach((value, i) => {
      low[i & 1] = Math.min(low[i & 1], value);
      high[i & 1] = Math.max(high[i & 1], value);
    });
    this.middle = [0, 1].map((c) => (low[c] + high[c]) / 2);
    this.size = Math.max(high[0] - low[0], high[1] - low[1]);
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
    const position = new Float32Array(3 * count), height = new Float32Array(count);
    for (let i = 0; i < count; ++i) {
      for (let c = 0; c < 2; ++c) position[3 * i + c] = (points[2 * i + c] - this.middle[c]) / this.size;
      height[i] = Number.isFinite(u?.[i]) ? u[i] : 0;
    }
    const value = new T.BufferAttribute(new Float32Array(count).fill(UNKNOWN), 1);
    const shared = {position: new T.BufferAttribute(position, 3), u: new T.BufferAttribute(height, 1), value};
    const add = (kind, index, material) => {
      const made = new T.BufferGeometry();
      for (const [name, attribute] of Object.entries(shared)) made.setAttribute(name, attribute);
      made.setIndex(new T.BufferAttribute(new Uint32Array(index.buffer, index.byteOffset, index.length), 1));
      return this.add(new kind(made, material), group);
    };
    const behind = {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1}; // its lines
    add(T.Mesh, surface.triangles,
      this.material(VERTEX, FACE, {}, {side: T.DoubleSide, extensions: {derivatives: true}, ...behind}));
    add(T.LineSegments, surface.outline, this.lineMaterial('#333333'));
    return {...surface, position, height, value, add, edges: null, group: this.add(group)};
  }

  add(object, to = this.group) {
    object.frustumCulled = false;
    to.add(object);
    return object;
  }

  clear() {
    this.group.traverse((object) => object.geometry?.dispose());
    this.group.remove(...this.group.children);
    fill(byId('labels'));
    this.names = [];
    this.marker.visible = false;
    this.full = this.thin = null;
  }

  /** Lines of the mesh, made when they are first wanted. @param {boolean} wanted */
  lines(wanted) {
    if (wanted)
      this.full.edges ??= this.full.add(T.Mesh, this.full.triangles, this.lineMaterial('#000000', 0.13, true));
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
    this.uniforms.rise.value = amplify / this.size;
    this.draw();
  }

  /** A place of the result in the scene. @param {number} x @param {number} y @param {number} u */
  place(x, y, u) {
    return [(x - this.middle[0]) / this.size, (y - this.middle[1]) / this.size, Number.isFinite(u) ? u : 0];
  }

  /** @param {number[][]} line places x, y, u @param {string} colour */
  line(line, colour) {
    const geometry = this.geometry(line.map(([x, y, u]) => this.place(x, y, u)));
    this.add(Object.assign(new T.Line(geometry, this.lineMaterial(colour)), {renderOrder: 1}));
  }

  /** @param {string} name @param {number} x @param {number} y @param {number} u */
  name(name, x, y, u) {
    const node = make('span', {}, plain(name, 40));
    byId('labels').append(node);
    const [px, py, pu] = this.place(x, y, u);
    this.names.push({node, x: px, y: py, u: pu});
  }

  /** Marks a place, or none. @param {number[]|null} place x, y, u */
  mark(place) {
    this.marker.visible = place !== null && this.full !== null;
    if (this.marker.visible && place) {
      const [x, y, u] = this.place(place[0], place[1], place[2]);
      this.marker.geometry.attributes.position.setXYZ(0, x, y, 0).needsUpdate = true;
      this.marker.geometry.attributes.u.setX(0, u).needsUpdate = true;
    }
    this.draw();
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
    for (const {node, x, y, u} of this.names) {
      const at = new T.Vector3(x, y, u * this.uniforms.rise.value).project(this.camera);
      node.style.transform =
        `translate(${(at.x + 1) / 2 * width}px, ${(1 - at.y) / 2 * height}px) translate(-50%, -130%)`;
    }
    this.canvas.dataset.frames = String(Number(this.canvas.dataset.frames ?? 0) + 1);
  }
}
