// The scene as the library wrote it: JSON with arrays in base64, little endian.

function bytes(text) {
  const raw = atob(text);
  const out = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
  return out;
}

const floats = (text) => new Float32Array(bytes(text).buffer);

export function readScene() {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  document.getElementById("scene").remove(); // the text is as large as the arrays
  scene.positions = floats(scene.positions);
  scene.triangles = new Uint32Array(bytes(scene.triangles).buffer);
  scene.innerSides = bytes(scene.innerSides);
  // 0..1 between the field's least and greatest value, or +inf
  scene.values = scene.values === undefined ? null : floats(scene.values);
  // of values in interpolation, 255: 1
  scene.weights = scene.weights === undefined ? null : bytes(scene.weights);
  if (scene.volume) {
    // 0..1 as for surfaces, in 65534 steps; 65535 is infinite
    const steps = new Uint16Array(bytes(scene.volume.values).buffer);
    scene.volume.values = Float32Array.from(steps, (x) => (x === 65535 ? Infinity : x / 65534));
  }
  if (scene.trace) scene.trace.tori = floats(scene.trace.tori);
  scene.field.colours = bytes(scene.field.colours);
  for (const key of ["signed", "unsigned", "arrows", "points"]) {
    scene.sources[key] = floats(scene.sources[key]);
  }
  return scene;
}

// A sum of two parts: what their rounding leaves of 0 is 0.
export function valueOf(field, t) {
  const a = field.low * (1 - t), b = field.high * t;
  return Math.abs(a + b) < 1e-12 * (Math.abs(a) + Math.abs(b)) ? 0 : a + b;
}

export function numberText(x) {
  if (!Number.isFinite(x)) return x > 0 ? "infinite" : "-infinite";
  if (x === 0) return "0";
  const size = Math.abs(x);
  return size >= 1e6 || size < 1e-4 ? x.toExponential(4) : String(Number(x.toPrecision(5)));
}

/// Vertex normals: faces count with the sign that agrees with the largest face there, so that flipped
/// faces do no harm (the shader picks the side that faces the eye). Zero on creases.
export function vertexNormals(positions, triangles) {
  const count = positions.length, face = new Float32Array(3);
  const faceNormal = (t) => {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    face[0] = uy * vz - uz * vy;
    face[1] = uz * vx - ux * vz;
    face[2] = ux * vy - uy * vx;
    return Math.hypot(face[0], face[1], face[2]);
  };
  const along = (v, vectors) => face[0] * vectors[v] + face[1] * vectors[v + 1] + face[2] * vectors[v + 2];

  const largest = new Float32Array(count), best = new Float32Array(count / 3);
  for (let t = 0; t < triangles.length; t += 3) {
    const size = faceNormal(t);
    for (let k = 0; k < 3; ++k) {
      const v = triangles[t + k];
      if (size <= best[v]) continue;
      best[v] = size;
      largest.set(face, 3 * v);
    }
  }
  const normals = new Float32Array(count);
  for (let t = 0; t < triangles.length; t += 3) {
    faceNormal(t);
    for (let k = 0; k < 3; ++k) {
      const v = 3 * triangles[t + k], sign = along(v, largest) < 0 ? -1 : 1;
      for (let i = 0; i < 3; ++i) normals[v + i] += sign * face[i];
    }
  }
  for (let v = 0; v < count; v += 3) {
    const length = Math.hypot(normals[v], normals[v + 1], normals[v + 2]) || 1;
    for (let i = 0; i < 3; ++i) normals[v + i] /= length;
  }
  // Creases stay: where a face leans more than 40 degrees from the mean, there is no common normal.
  const crease = new Uint8Array(count / 3);
  for (let t = 0; t < triangles.length; t += 3) {
    const size = faceNormal(t);
    for (let k = 0; k < 3; ++k) {
      const v = triangles[t + k];
      if (Math.abs(along(3 * v, normals)) < 0.766 * size) crease[v] = 1;
    }
  }
  for (let v = 0; v < crease.length; ++v) if (crease[v]) normals.fill(0, 3 * v, 3 * v + 3);
  return normals;
}

/// Vertex pairs of the sides of the faces, each once; sides inside polygons are left out.
export function wireEdges(triangles, innerSides, vertexCount) {
  const keys = new Float64Array(triangles.length);
  let n = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      if (innerSides.length && (innerSides[t / 3] >> k) & 1) continue;
      const a = triangles[t + k], b = triangles[t + ((k + 1) % 3)];
      keys[n++] = Math.min(a, b) * vertexCount + Math.max(a, b);
    }
  }
  const sorted = keys.subarray(0, n).sort();
  const edges = new Uint32Array(2 * n);
  let used = 0;
  for (let i = 0; i < n; ++i) {
    if (i > 0 && sorted[i] === sorted[i - 1]) continue;
    edges[used++] = Math.floor(sorted[i] / vertexCount);
    edges[used++] = sorted[i] % vertexCount;
  }
  return edges.slice(0, used);
}
