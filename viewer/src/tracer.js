// The surface of a cloud, traced through its tori in a fragment shader. While the view or a slider
// moves, it is traced at as few pixels as the machine can do at once; at rest, strip by strip at all.
import * as THREE from "three";
import { makeTree, width } from "./tori-tree.js";
import { screenVertex, showFragment, traceFragment } from "./trace-shader.js";

const quick = 25, strip = 30, rest = 150;  // milliseconds

function texture(data, channels, format, type, internal) {
  const rows = Math.max(1, Math.ceil(data.length / channels / width));
  const padded = new data.constructor(rows * width * channels);
  padded.set(data);
  const t = new THREE.DataTexture(padded, width, rows, format, type);
  t.internalFormat = internal;
  t.minFilter = t.magFilter = THREE.NearestFilter;
  t.needsUpdate = true;
  return t;
}

function grid(volume, trace) {
  const { n, values } = volume;
  const t = new THREE.Data3DTexture(values.map((x) => trace.low + trace.range * x), ...n);
  t.format = THREE.RedFormat;
  t.type = THREE.FloatType;
  t.internalFormat = "R32F";
  t.minFilter = t.magFilter = THREE.NearestFilter;
  t.unpackAlignment = 4;
  t.needsUpdate = true;
  return t;
}

/// Null where the browser cannot render to floating-point numbers.
export function makeTracer(scene, renderer, look) {
  if (!renderer.extensions.has("EXT_color_buffer_float")) return null;
  const { volume, trace } = scene;
  const low = volume.origin, high = low.map((x, a) => x + (volume.n[a] - 1) * volume.spacing[a]);
  const tree = makeTree(trace.tori, low, high);
  const uniforms = {
    tori: { value: texture(trace.tori, 4, THREE.RGBAFormat, THREE.FloatType, "RGBA32F") },
    nodes: { value: texture(tree.nodes, 2, THREE.RGIntegerFormat, THREE.IntType, "RG32I") },
    lists: { value: texture(tree.lists, 1, THREE.RedIntegerFormat, THREE.UnsignedIntType, "R32UI") },
    samples: { value: grid(volume, trace) },
    origin: { value: new THREE.Vector3(...volume.origin) },
    spacing: { value: new THREE.Vector3(...volume.spacing) },
    centre: { value: new THREE.Vector3(...tree.centre) },
    halfSide: { value: tree.half },
    low: { value: new THREE.Vector3(...low) },
    high: { value: new THREE.Vector3(...high) },
    level: { value: 0 },
    steepness: { value: trace.steepness },
    tolerance: { value: 1e-4 },
    eye: { value: new THREE.Vector3() },
    rays: { value: new THREE.Matrix3() },
  };
  const showUniforms = {
    hits: { value: null }, eye: { value: new THREE.Vector3() }, rays: { value: new THREE.Matrix3() },
    colours: look.uniforms.colours, plainColour: look.uniforms.plainColour, colourAt: { value: -1 },
    view: { value: new THREE.Matrix4() }, toScreen: { value: new THREE.Matrix4() },
  };
  const options = { glslVersion: THREE.GLSL3, vertexShader: screenVertex, depthTest: false, depthWrite: false };
  const tracing = new THREE.ShaderMaterial({ ...options, fragmentShader: traceFragment, uniforms });
  const showing = new THREE.ShaderMaterial({
    ...options, depthTest: true, depthWrite: true, fragmentShader: showFragment, uniforms: showUniforms,
  });
  const quad = (material) => {
    const mesh = new THREE.Mesh(new THREE.PlaneGeometry(2, 2), material);
    mesh.frustumCulled = false;
    return mesh;
  };
  const stage = new THREE.Scene(), still = new THREE.Camera(), mesh = quad(showing);
  stage.add(quad(tracing));
  const makeTarget = () => new THREE.WebGLRenderTarget(1, 1, {
    type: THREE.FloatType, format: THREE.RGBAFormat, depthBuffer: false,
    minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter,
  });
  const coarse = makeTarget(), full = makeTarget(), single = makeTarget();
  const size = new THREE.Vector2(), one = new Float32Array(4);
  let scale = 0.25, dirty = true, rows = 0, changedAt = 0, perRow = strip / 16, last = "";

  /// Traces rows [from, to) of a target and waits for it; returns milliseconds.
  function run(target, from, to) {
    const start = performance.now(), before = renderer.getRenderTarget(), clear = renderer.autoClear;
    target.scissor.set(0, from, target.width, to - from);
    target.scissorTest = true;
    renderer.autoClear = false;
    renderer.setRenderTarget(target);
    renderer.render(stage, still);
    renderer.readRenderTargetPixels(target, 0, from, 1, 1, one);
    renderer.setRenderTarget(before);
    renderer.autoClear = clear;
    return performance.now() - start;
  }

  function aim(camera) {
    camera.updateMatrixWorld();
    const e = camera.matrixWorld.elements, tan = Math.tan((camera.fov * Math.PI) / 360) / camera.zoom;
    const column = (k, s) => [s * e[4 * k], s * e[4 * k + 1], s * e[4 * k + 2]];
    const [r, u, b] = [column(0, tan * camera.aspect), column(1, tan), column(2, -1)];
    uniforms.eye.value.setFromMatrixPosition(camera.matrixWorld);
    uniforms.rays.value.set(r[0], u[0], b[0], r[1], u[1], b[1], r[2], u[2], b[2]);
    // A fifth of a pixel at the nearest place.
    uniforms.tolerance.value = Math.max(2e-5, 0.4 * tan * Math.max(0.05, uniforms.eye.value.length() - 1) / Math.max(1, size.y));
  }

  /// Before a frame. True while there is more to trace: then another frame is wanted.
  function prepare(camera) {
    renderer.getDrawingBufferSize(size);
    aim(camera);
    showUniforms.view.value.copy(camera.matrixWorldInverse);
    showUniforms.toScreen.value.copy(camera.projectionMatrix);
    const now = performance.now(), key = [...camera.matrixWorld.elements, camera.aspect, size.x, size.y].join();
    if (key !== last) { last = key; dirty = true; }
    if (dirty) {
      dirty = false;
      rows = 0;
      changedAt = now;
      coarse.setSize(Math.max(16, Math.round(size.x * scale)), Math.max(16, Math.round(size.y * scale)));
      const took = run(coarse, 0, coarse.height);
      perRow = Math.max(0.01, took / coarse.height / scale);
      scale = Math.min(1, Math.max(0.06, scale * Math.sqrt(quick / Math.max(1, took))));
      showUniforms.hits.value = coarse.texture;
    } else if (rows < size.y && now - changedAt > rest) {
      if (rows === 0) full.setSize(size.x, size.y);
      const next = Math.min(size.y, rows + Math.max(1, Math.floor(strip / perRow)));
      perRow = Math.max(0.01, run(full, rows, next) / (next - rows));
      rows = next;
      if (rows === size.y) showUniforms.hits.value = full.texture;
    }
    showUniforms.eye.value.copy(uniforms.eye.value);
    showUniforms.rays.value.copy(uniforms.rays.value);
    return rows < size.y;
  }

  return {
    mesh, prepare, tree,
    settled: () => !dirty && rows >= size.y,
    setLevel(t) {
      uniforms.level.value = trace.low + trace.range * t;
      const map = look.uniforms.colourMap.value;
      showUniforms.colourAt.value = Math.min(1, Math.max(0, map.x + map.y * t));
      dirty = true;
    },
    /// Cuts away all below a place along an axis; without an axis nothing.
    setCut(axis, at) {
      uniforms.low.value.set(...low);
      if (axis !== null) uniforms.low.value.setComponent(axis, at);
      dirty = true;
    },
    /// How far along its ray the surface is at a place of the screen in [-1, 1]^2, or -1.
    depthAt(camera, x, y) { return this.probe(camera, [[x, y]])[0]; },
    /// The same for many places.
    probe(camera, places) {
      aim(camera);
      const rays = uniforms.rays.value.clone(), e = rays.elements;
      return places.map(([x, y]) => {
        // One pixel whose only ray is the one asked for.
        const ahead = [0, 1, 2].map((k) => e[k] * x + e[3 + k] * y + e[6 + k]);
        uniforms.rays.value.set(0, 0, ahead[0], 0, 0, ahead[1], 0, 0, ahead[2]);
        run(single, 0, 1);
        uniforms.rays.value.copy(rays);
        return one[0];
      });
    },
    /// Hits (t, normal) of size x size rays from an eye in the page's units, rows from below.
    look(eye, right, up, ahead, n) {
      uniforms.eye.value.set(...eye);
      uniforms.rays.value.set(right[0], up[0], ahead[0], right[1], up[1], ahead[1], right[2], up[2], ahead[2]);
      uniforms.tolerance.value = 1e-4;
      const target = makeTarget(), data = new Float32Array(4 * n * n);
      target.setSize(n, n);
      run(target, 0, n);
      renderer.readRenderTargetPixels(target, 0, 0, n, n, data);
      target.dispose();
      dirty = true;
      return data;
    },
  };
}
