// A volume: a slice to move through it and an isosurface, both made here from the values.
import * as THREE from "three";
import { vertexNormals } from "./data.js";

// The six tetrahedra of a cell, by corner (bits x, y, z); all cells are cut alike, so faces match.
const tets = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];

/// Triangles where the values take a level: positions as grid coordinates, and indices.
export function marchTets(n, values, level) {
  const stepY = n[0], stepZ = n[0] * n[1], points = [], triangles = [], made = new Map();
  const offset = Array.from({ length: 8 }, (_, c) => (c & 1) + (c >> 1 & 1) * stepY + (c >> 2) * stepZ);
  const crossing = (low, high) => {
    const key = low * values.length + high;
    let found = made.get(key);
    if (found === undefined) {
      const a = values[low], t = (level - a) / (values[high] - a);
      const at = (v) => [v % stepY, Math.floor((v % stepZ) / stepY), Math.floor(v / stepZ)];
      const p = at(low), q = at(high);
      found = points.length / 3;
      points.push(p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1]), p[2] + t * (q[2] - p[2]));
      made.set(key, found);
    }
    return found;
  };
  const below = [], above = [];
  for (let k = 0; k + 1 < n[2]; ++k) for (let j = 0; j + 1 < n[1]; ++j) for (let i = 0; i + 1 < n[0]; ++i) {
    const base = i + j * stepY + k * stepZ;
    let least = Infinity, most = -Infinity;
    for (let c = 0; c < 8; ++c) {
      const v = values[base + offset[c]];
      if (v < least) least = v;
      if (v > most) most = v;
    }
    if (least > level || most <= level || most === Infinity) continue;
    for (const tet of tets) {
      below.length = above.length = 0;
      for (const c of tet) (values[base + offset[c]] <= level ? below : above).push(base + offset[c]);
      if (below.length === 1) triangles.push(...above.map((v) => crossing(below[0], v)));
      else if (below.length === 3) triangles.push(...below.map((v) => crossing(v, above[0])));
      else if (below.length === 2) {
        const a = crossing(below[0], above[0]), b = crossing(below[0], above[1]);
        const c = crossing(below[1], above[1]), d = crossing(below[1], above[0]);
        triangles.push(a, b, c, a, c, d);
      }
    }
  }
  return { points, triangles };
}

/// With a tracer the surface is its, and not made of triangles.
export function makeVolume(scene, look, tracer) {
  const { volume } = scene, { n, values, origin, spacing } = volume;
  const state = { axis: volume.axis, position: volume.position, level: volume.level, cut: true };
  const slice = new THREE.Mesh(new THREE.BufferGeometry(), look.material);
  const shell = tracer ? tracer.mesh : new THREE.Mesh(new THREE.BufferGeometry(), look.material);
  const mesh = new THREE.Group();
  mesh.add(shell, slice);

  function fill(target, positions, t, infinite, triangles) {
    target.geometry.dispose();
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    geometry.setAttribute("normal", new THREE.BufferAttribute(vertexNormals(positions, triangles), 3));
    geometry.setAttribute("t", new THREE.BufferAttribute(t, 1));
    geometry.setAttribute("infinite", new THREE.BufferAttribute(infinite, 1, true));
    geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
    geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 2);
    target.geometry = geometry;
  }

  function moveSlice() {
    const { axis } = state, u = (axis + 1) % 3, w = (axis + 2) % 3, step = [1, n[0], n[0] * n[1]];
    const at = state.position * (n[axis] - 1);
    const low = Math.min(n[axis] - 2, Math.floor(at)), part = at - low;
    const count = n[u] * n[w], positions = new Float32Array(3 * count), t = new Float32Array(count);
    const infinite = new Uint8Array(count), triangles = [];
    for (let j = 0; j < n[w]; ++j) for (let i = 0; i < n[u]; ++i) {
      const v = i + n[u] * j, node = i * step[u] + j * step[w] + low * step[axis];
      const a = part < 1 ? (1 - part) * values[node] : 0;
      const value = a + (part > 0 ? part * values[node + step[axis]] : 0);
      if (Number.isFinite(value)) t[v] = value;
      else infinite[v] = 255;
      positions[3 * v + axis] = origin[axis] + at * spacing[axis];
      positions[3 * v + u] = origin[u] + i * spacing[u];
      positions[3 * v + w] = origin[w] + j * spacing[w];
      if (i + 1 < n[u] && j + 1 < n[w]) triangles.push(v, v + 1, v + 1 + n[u], v, v + 1 + n[u], v + n[u]);
    }
    fill(slice, positions, t, infinite, Uint32Array.from(triangles));
    cutAway();
  }

  function cutAway() {
    const plane = look.uniforms.cut.value.set(0, 0, 0, 1);
    tracer?.setCut(state.cut ? state.axis : null, origin[state.axis] + state.position * (n[state.axis] - 1) * spacing[state.axis]);
    if (!state.cut) return;
    // What lies behind the slice, seen from the first view, is hidden by it anyway.
    plane.setComponent(state.axis, -1);
    plane.w = 1e-4 - origin[state.axis] - state.position * (n[state.axis] - 1) * spacing[state.axis];
  }

  function moveLevel() {
    if (tracer) return tracer.setLevel(state.level);
    const { points, triangles } = marchTets(n, values, state.level);
    const positions = Float32Array.from(points, (x, i) => origin[i % 3] + x * spacing[i % 3]);
    const count = points.length / 3;
    fill(shell, positions, new Float32Array(count).fill(state.level), new Uint8Array(count), Uint32Array.from(triangles));
  }

  moveSlice();
  moveLevel();
  return {
    ...look, mesh, state, shell,
    /// How far along its ray the slice's plane is at a place of the screen in [-1, 1]^2; infinity beside it.
    sliceDepth(camera, x, y) {
      const eye = new THREE.Vector3().setFromMatrixPosition(camera.matrixWorld);
      const ray = new THREE.Vector3(x, y, 0.5).unproject(camera).sub(eye).normalize();
      const at = origin[state.axis] + state.position * (n[state.axis] - 1) * spacing[state.axis];
      const t = (at - eye.getComponent(state.axis)) / ray.getComponent(state.axis);
      return t > 0 ? t : Infinity;
    },
    setSlice(axis, position) { Object.assign(state, { axis, position }); moveSlice(); },
    setLevel(level) { state.level = level; moveLevel(); },
    setCut(cut) { state.cut = cut; cutAway(); },
    triangleCount: () => tracer ? 0 : shell.geometry.getIndex().count / 3,
  };
}
