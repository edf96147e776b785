// SPDX-License-Identifier: BSD-3-Clause
// The 3-D view of grains and parts over time, with three.js: spheres are points shaded as spheres.
"use strict";

const kAbsent = 65535; // code of a coordinate if the grain is absent from the frame
const kColours = [[0.27, 0.0, 0.33], [0.23, 0.32, 0.55], [0.13, 0.57, 0.55], [0.37, 0.79, 0.38], [0.99, 0.91, 0.15]];

function colourOf(share, out, at) {
  const s = Math.max(0, Math.min(0.9999, share)) * (kColours.length - 1);
  const k = Math.floor(s), t = s - k;
  for (let c = 0; c < 3; ++c) out[at + c] = kColours[k][c] * (1 - t) + kColours[k + 1][c] * t;
}

/** Restores frames of `size` codes that are stored as differences from the previous frame. */
function addUp(codes, size) {
  for (let i = size; i < codes.length; ++i) codes[i] += codes[i - size];
}

/** Geometry of a mesh with its vertices and triangles. */
function geometryOf(mesh) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(report.arrays[mesh.vertices], 3));
  geometry.setIndex(new THREE.BufferAttribute(report.arrays[mesh.triangles], 1));
  return geometry;
}

/** Material options of a part, transparent if it would hide the grains. */
function clearness(clear) {
  return { transparent: !!clear, depthWrite: !clear, opacity: clear ? 0.2 : 1 };
}

const kVertex = `
attribute float radius;
attribute vec3 tint;
uniform float pixels;
varying vec3 vTint, vCentre;
varying float vRadius;
void main() {
  vec4 centre = modelViewMatrix * vec4(position, 1.0);
  vTint = tint; vCentre = centre.xyz; vRadius = radius;
  gl_Position = projectionMatrix * centre;
  gl_PointSize = max(1.5, 2.0 * radius * pixels / gl_Position.w);
}`;

const kFragment = `
uniform mat4 projectionMatrix;
varying vec3 vTint, vCentre;
varying float vRadius;
void main() {
  vec2 p = 2.0 * gl_PointCoord - 1.0;
  p.y = -p.y;
  float r2 = dot(p, p);
  if (r2 > 1.0) discard;
  vec3 normal = vec3(p, sqrt(1.0 - r2));
  vec4 clip = projectionMatrix * vec4(vCentre + vRadius * normal, 1.0);
  gl_FragDepthEXT = 0.5 * clip.z / clip.w + 0.5;
  float light = 0.38 + 0.62 * max(0.0, dot(normal, normalize(vec3(0.35, 0.8, 0.5))));
  gl_FragColor = vec4(vTint * light, 1.0);
}`;

/** The 3-D view of a run. All share the canvas, its renderer and the controls; report.space is the visible one. */
class Space {
  constructor(data, renderer) {
    this.data = data;
    this.time = report.arrays[data.time];
    this.frame = this.time.length - 1;
    this.renderer = renderer;
    this.canvas = renderer.domElement;
    for (const [name, id] of [["slider", "frame"], ["play", "play"], ["colour", "colour"], ["following", "follow"]])
      this[name] = document.getElementById("space-" + id);
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(0x2b3038);
    this.camera = new THREE.PerspectiveCamera(35, 2, 0.01, 1000);
    this.camera.up.set(0, 0, 1);
    this.controls = new THREE.OrbitControls(this.camera, this.canvas);
    this.controls.enableKeys = false;
    this.controls.addEventListener("change", () => this.render());
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x777788, 0.75));
    const sun = new THREE.DirectionalLight(0xffffff, 0.7);
    sun.position.set(0.4, -0.6, 1);
    this.scene.add(sun);
    if (data.grains) this.addGrains(data.grains);
    this.addParts(data);
    this.addScale(data.box);
    this.controls.enabled = false;
    this.home();
  }

  /** Activates this view on canvas and controls. */
  enter() {
    this.controls.enabled = true;
    this.slider.max = this.time.length - 1;
    document.getElementById("space-words").textContent = this.data.words;
    this.followed = null;
    this.show(this.frame);
  }

  leave() {
    this.pause();
    this.controls.enabled = false;
  }

  addGrains(g) {
    const codes = report.arrays[g.places];
    const [frames, , count] = codes.shape;
    addUp(codes, 3 * count);
    this.grains = { codes, count, frames, speed: report.arrays[g.speed], ...g };
    this.grains.speed = report.arrays[g.speed];
    const geometry = new THREE.BufferGeometry();
    this.positions = new Float32Array(3 * count);
    this.tints = new Float32Array(3 * count);
    geometry.setAttribute("position", new THREE.BufferAttribute(this.positions, 3));
    geometry.setAttribute("tint", new THREE.BufferAttribute(this.tints, 3));
    geometry.setAttribute("radius", new THREE.BufferAttribute(report.arrays[g.radius], 1));
    const material = new THREE.ShaderMaterial({
      vertexShader: kVertex, fragmentShader: kFragment, uniforms: { pixels: { value: 1 } },
      extensions: { fragDepth: true },
    });
    this.points = new THREE.Points(geometry, material);
    this.points.frustumCulled = false;
    this.scene.add(this.points);
  }

  addParts(data) {
    this.parts = [];
    const colours = { shoe: 0x6d7278, sprocket: 0xd98a3d, wheel: 0xb7bcc2, chassis: 0x7f9bb8 };
    for (const shape of data.shapes || []) {
      const geometry = geometryOf(shape);
      const flat = geometry.toNonIndexed();
      flat.computeVertexNormals();
      for (const part of shape.parts) {
        const name = data.names[part] || "";
        const word = Object.keys(colours).find((w) => name.includes(w));
        const material = new THREE.MeshLambertMaterial({ color: word ? colours[word] : 0x9aa0a6,
          side: THREE.DoubleSide, ...clearness(shape.clear) });
        const mesh = new THREE.Mesh(flat, material);
        mesh.frustumCulled = false;
        this.parts.push({ mesh, part });
        this.scene.add(mesh);
      }
    }
    this.poses = data.poses ? report.arrays[data.poses] : null;
    if (data.soil) this.addSoil(data.soil);
    for (const ground of data.grounds || []) {
      const geometry = geometryOf(ground);
      geometry.computeVertexNormals();
      this.scene.add(new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ color: 0xb59f7a, side: THREE.DoubleSide,
        ...clearness(ground.clear) })));
    }
  }

  /** Surface of deformable soil. Heights: the undisturbed surface, then frames, as differences from the previous row. */
  addSoil(soil) {
    const codes = report.arrays[soil.heights], [rows, count] = codes.shape;
    addUp(codes, count);
    let deepest = 1;
    for (let i = 0; i < count; ++i) deepest = Math.max(deepest, codes[i] - codes[(rows - 1) * count + i]);
    const geometry = geometryOf(soil);
    geometry.setAttribute("color", new THREE.BufferAttribute(new Float32Array(3 * count), 3));
    const mesh = new THREE.Mesh(geometry, new THREE.MeshLambertMaterial({ vertexColors: true, side: THREE.DoubleSide }));
    mesh.frustumCulled = false;
    this.scene.add(mesh);
    this.soil = { codes, rows, count, deepest, geometry, low: soil.low, unit: soil.unit, stride: soil.stride };
  }

  /** Moves the soil to its heights in a frame; soil below the undisturbed surface is darker. */
  placeSoil(frame) {
    const { codes, rows, count, deepest, geometry, low, unit, stride } = this.soil;
    const { position, color } = geometry.attributes, brown = [0.74, 0.65, 0.5];
    const begin = Math.max(0, rows - 1 - Math.ceil((this.time.length - 1 - frame) / stride)) * count;
    for (let i = 0; i < count; ++i) {
      position.array[3 * i + 2] = low + unit * codes[begin + i];
      const light = 1 - 0.5 * Math.max(0, codes[i] - codes[begin + i]) / deepest;
      for (let c = 0; c < 3; ++c) color.array[3 * i + c] = brown[c] * light;
    }
    position.needsUpdate = color.needsUpdate = true;
    geometry.computeVertexNormals();
  }

  /** A scale bar of a round length along x, in front of the bounding box. */
  addScale(box) {
    const [low, high] = box, wide = high[0] - low[0];
    const length = [1, 2, 5].map((d) => d * 10 ** Math.floor(Math.log10(wide / 3))).filter((l) => l <= wide / 2).pop()
      || wide / 3;
    const y = low[1] - 0.03 * wide, thick = 0.006 * wide;
    const bar = new THREE.Mesh(new THREE.BoxGeometry(length, thick, thick), new THREE.MeshBasicMaterial({ color: 0xffffff }));
    bar.position.set(low[0] + 0.5 * length, y, low[2]);
    const label = document.createElement("canvas");
    label.width = 512;
    label.height = 128;
    const pen = label.getContext("2d");
    pen.fillStyle = "#fff";
    pen.font = "64px 'DejaVu Sans', sans-serif";
    pen.textAlign = "center";
    pen.fillText(Number(length.toPrecision(2)) + " m along x", 256, 86);
    const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: new THREE.CanvasTexture(label), depthTest: false }));
    const size = 0.2 * wide;
    sprite.scale.set(size, size / 4, 1);
    sprite.position.set(low[0] + 0.5 * length, y - 0.07 * wide, low[2]);
    this.scene.add(bar, sprite);
    this.scaleLabel = sprite;
    this.scaleLength = length;
  }

  home() {
    const [low, high] = this.data.box;
    const size = Math.hypot(...high.map((h, k) => h - low[k])) || 1;
    this.controls.target.set(...high.map((h, k) => 0.5 * (h + low[k])));
    this.controls.target.z -= 0.08 * size; // so that the scale bar is visible
    const away = new THREE.Vector3(-0.45, -1, 0.55).normalize().multiplyScalar(1.2 * size);
    this.camera.position.copy(this.controls.target).add(away);
    this.camera.near = size / 500;
    this.camera.far = 20 * size;
    this.followed = null;
    this.camera.lookAt(this.controls.target);
    for (let k = 0; k < 40 && !this.isInView(); ++k) this.retreat(1.05);
    this.controls.update();
    this.follow();
  }

  /** Whether the bounding box and the label of the scale bar are visible. */
  isInView() {
    if (this.canvas.clientHeight) this.camera.aspect = this.canvas.clientWidth / this.canvas.clientHeight;
    this.camera.updateMatrixWorld();
    this.camera.updateProjectionMatrix();
    const [low, high] = this.data.box;
    const places = [0, 1, 2, 3, 4, 5, 6, 7].map((k) => new THREE.Vector3(
      k & 1 ? high[0] : low[0], k & 2 ? high[1] : low[1], k & 4 ? high[2] : low[2]));
    const label = this.scaleLabel;
    for (const side of [-0.5, 0.5])
      for (const up of [-0.5, 0.5])
        places.push(new THREE.Vector3(side * label.scale.x, up * label.scale.y, 0)
          .applyQuaternion(this.camera.quaternion).add(label.position));
    return places.every((p) => Math.max(Math.abs(p.project(this.camera).x), Math.abs(p.y)) < 0.98);
  }

  retreat(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
  }

  key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const turn = 0.1;
    const does = {
      " ": () => this.toggle(), ".": () => this.step(1), ",": () => this.step(-1),
      ArrowLeft: () => this.orbit(-turn, 0), ArrowRight: () => this.orbit(turn, 0),
      ArrowUp: () => this.orbit(0, -turn), ArrowDown: () => this.orbit(0, turn),
      "+": () => this.dolly(0.85), "-": () => this.dolly(1 / 0.85),
      Home: () => this.show(0), End: () => this.show(this.time.length - 1),
      0: () => { this.home(); this.render(); },
    }[event.key];
    if (!does) return;
    event.preventDefault();
    does();
  }

  orbit(azimuth, polar) {
    const away = this.camera.position.clone().sub(this.controls.target);
    away.applyAxisAngle(this.camera.up, azimuth);
    const side = away.clone().cross(this.camera.up).normalize();
    const turned = away.clone().applyAxisAngle(side, -polar);
    if (Math.abs(turned.clone().normalize().z) < 0.995) away.copy(turned);
    this.camera.position.copy(this.controls.target).add(away);
    this.controls.update();
    this.render();
  }

  dolly(factor) {
    this.retreat(factor);
    this.controls.update();
    this.render();
  }

  step(by) {
    this.pause();
    this.show(Math.max(0, Math.min(this.time.length - 1, this.frame + by)));
  }

  toggle() { this.timer ? this.pause() : this.start(); }

  start() {
    if (this.frame === this.time.length - 1) this.show(0);
    this.play.textContent = "Pause";
    this.timer = setInterval(() => {
      if (this.frame >= this.time.length - 1) this.pause();
      else this.show(this.frame + 1);
    }, 100);
  }

  pause() {
    clearInterval(this.timer);
    this.timer = null;
    this.play.textContent = "Play";
  }

  /** Coordinate `k` of grain `i` in a frame [m], from the middle of the box; NaN if the grain is absent. */
  coordinate(frame, k, i) {
    const g = this.grains, code = g.codes[(3 * frame + k) * g.count + i];
    return code === kAbsent ? NaN : g.low[k] + code * g.unit[k];
  }

  placeGrains(frame) {
    const g = this.grains, what = this.colour.value in g.ranges ? this.colour.value : "height";
    const [low, high] = g.ranges[what];
    for (let i = 0; i < g.count; ++i) {
      const at = [0, 1, 2].map((k) => this.coordinate(frame, k, i));
      const absent = Number.isNaN(at[0]);
      for (let k = 0; k < 3; ++k) this.positions[3 * i + k] = absent ? 1e6 : at[k];
      let value = at[2] + this.data.middle[2];
      if (what === "speed") value = g.speed[frame * g.count + i] / 255 * g.fastest;
      if (what === "moved") {
        value = Math.hypot(...at.map((a, k) => a - this.coordinate(0, k, i)));
        if (Number.isNaN(value)) value = 0;
      }
      colourOf((value - low) / (high - low || 1), this.tints, 3 * i);
    }
    this.points.geometry.attributes.position.needsUpdate = true;
    this.points.geometry.attributes.tint.needsUpdate = true;
    this.scaleOf(what, low, high, g.units[what]);
  }

  scaleOf(what, low, high, unit) {
    const strip = document.getElementById("space-scale"), pen = strip.getContext("2d");
    const colour = [0, 0, 0];
    for (let x = 0; x < strip.width; ++x) {
      colourOf(x / strip.width, colour, 0);
      pen.fillStyle = `rgb(${colour.map((c) => Math.round(255 * c)).join(",")})`;
      pen.fillRect(x, 0, 1, strip.height);
    }
    document.getElementById("space-low").textContent = report.shown(low) + " " + unit;
    document.getElementById("space-high").textContent =
      report.shown(high) + " " + unit + (what === "height" ? "" : " or more");
  }

  follow() {
    if (!this.following || !this.following.checked || !this.poses) return;
    const count = this.data.names.length, part = Math.max(0, this.data.names.indexOf("chassis"));
    const at = new THREE.Vector3().fromArray(this.poses, 7 * (this.frame * count + part));
    if (this.followed) {
      const way = at.clone().sub(this.followed);
      this.controls.target.add(way);
      this.camera.position.add(way);
    }
    this.followed = at;
  }

  show(frame) {
    this.frame = frame;
    if (this.points) this.placeGrains(frame);
    if (this.soil) this.placeSoil(frame);
    const count = this.data.names ? this.data.names.length : 0;
    for (const { mesh, part } of this.parts) {
      const p = 7 * (frame * count + part), q = this.poses;
      mesh.position.set(q[p], q[p + 1], q[p + 2]);
      mesh.quaternion.set(q[p + 4], q[p + 5], q[p + 6], q[p + 3]);
    }
    this.follow();
    this.slider.value = frame;
    const text = `t = ${report.shown(this.time[frame])} s`;
    this.slider.setAttribute("aria-valuetext", text);
    document.getElementById("space-time").textContent = `${text}, frame ${frame + 1} of ${this.time.length}`;
    this.render();
  }

  render() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    if (this.points)
      this.points.material.uniforms.pixels.value =
        0.5 * height * this.renderer.getPixelRatio() * this.camera.projectionMatrix.elements[5];
    this.renderer.render(this.scene, this.camera);
  }
}

/** Connects the controls to the visible view. */
function connectSpace(canvas, choose) {
  const get = (id) => document.getElementById("space-" + id), on = (id, kind, does) => {
    if (get(id)) get(id).addEventListener(kind, does);
  };
  on("frame", "input", () => report.space.show(Number(get("frame").value)));
  on("play", "click", () => report.space.toggle());
  on("back", "click", () => report.space.step(-1));
  on("on", "click", () => report.space.step(1));
  on("home", "click", () => { report.space.home(); report.space.render(); });
  on("colour", "change", () => report.space.show(report.space.frame));
  on("follow", "change", () => { report.space.followed = null; report.space.show(report.space.frame); });
  on("run", "change", () => choose(get("run").selectedIndex));
  canvas.addEventListener("keydown", (event) => report.space.key(event));
  new ResizeObserver(() => report.space.render()).observe(canvas);
}

/** Opens the views of the runs in `list` and shows the first; false if the browser lacks WebGL. */
report.openSpaces = function (list) {
  const trial = document.createElement("canvas");
  const context = trial.getContext("webgl");
  if (!context || !context.getExtension("EXT_frag_depth")) {
    document.getElementById("space").textContent = "The 3-D view requires WebGL (EXT_frag_depth).";
    return false;
  }
  context.getExtension("WEBGL_lose_context")?.loseContext();
  const canvas = document.getElementById("space-canvas");
  const renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
  renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
  const spaces = [];
  const choose = (k) => {
    if (report.space) report.space.leave();
    report.space = spaces[k] ||= new Space(list[k], renderer);
    report.space.enter();
  };
  choose(0);
  connectSpace(canvas, choose);
  return true;
};
