// What drawing needs of a mesh: normals, sides, and how steep a field is.

/** Vertex normals: faces count with the sign that agrees with the largest face there, so that flipped
 * faces do no harm (the shader picks the side that faces the eye). Zero on creases. */
export function vertexNormals(positions: Float32Array, triangles: Uint32Array): Float32Array {
  const count = positions.length, corners = triangles.length, face = new Float32Array(corners), size = new Float32Array(corners / 3);
  const largest = new Float32Array(count), best = new Float32Array(count / 3);
  for (let t = 0; t < corners; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const x = uy * vz - uz * vy, y = uz * vx - ux * vz, z = ux * vy - uy * vx, length = Math.sqrt(x * x + y * y + z * z);
    face[t] = x;
    face[t + 1] = y;
    face[t + 2] = z;
    size[t / 3] = length;
    for (let k = 0; k < 3; ++k) {
      const v = triangles[t + k];
      if (length <= best[v]) continue;
      best[v] = length;
      largest[3 * v] = x;
      largest[3 * v + 1] = y;
      largest[3 * v + 2] = z;
    }
  }
  const normals = new Float32Array(count);
  for (let t = 0; t < corners; t += 3) for (let k = 0; k < 3; ++k) {
    const v = 3 * triangles[t + k];
    const sign = face[t] * largest[v] + face[t + 1] * largest[v + 1] + face[t + 2] * largest[v + 2] < 0 ? -1 : 1;
    normals[v] += sign * face[t];
    normals[v + 1] += sign * face[t + 1];
    normals[v + 2] += sign * face[t + 2];
  }
  for (let v = 0; v < count; v += 3) {
    const length = Math.sqrt(normals[v] ** 2 + normals[v + 1] ** 2 + normals[v + 2] ** 2) || 1;
    normals[v] /= length;
    normals[v + 1] /= length;
    normals[v + 2] /= length;
  }
  // Creases stay: where a face leans more than 40 degrees from the mean, there is no common normal.
  const crease = new Uint8Array(count / 3);
  for (let t = 0; t < corners; t += 3) for (let k = 0; k < 3; ++k) {
    const v = 3 * triangles[t + k];
    const along = face[t] * normals[v] + face[t + 1] * normals[v + 1] + face[t + 2] * normals[v + 2];
    if (Math.abs(along) < 0.766 * size[t / 3]) crease[v / 3] = 1;
  }
  for (let v = 0; v < crease.length; ++v) if (crease[v]) normals.fill(0, 3 * v, 3 * v + 3);
  return normals;
}

/** Numbers of the triangles at each vertex, one of them; -1: none. */
export function someTriangle(triangles: Uint32Array, vertexCount: number): Int32Array {
  const out = new Int32Array(vertexCount).fill(-1);
  for (let c = 0; c < triangles.length; ++c) out[triangles[c]] = Math.floor(c / 3);
  return out;
}

/** Vertex pairs of the sides of the faces, each once; sides inside polygons are left out. */
export function wireEdges(triangles: Uint32Array, innerSides: Uint8Array | null, vertexCount: number): Uint32Array {
  const keys = new Float64Array(triangles.length);
  let n = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      if (innerSides && (innerSides[t / 3] >> k) & 1) continue;
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

/** Gradients of a field with one value a corner, linear on each triangle: three numbers a triangle. Zero where
 * the triangle has no area or a value is not finite. `corner(t, k)` is the value at corner k of triangle t. */
export function gradients(
  positions: Float32Array, triangles: Uint32Array, corner: (t: number, k: number) => number,
): Float32Array {
  const count = triangles.length / 3, out = new Float32Array(3 * count);
  for (let t = 0; t < count; ++t) {
    const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const uu = ux * ux + uy * uy + uz * uz, uv = ux * vx + uy * vy + uz * vz, vv = vx * vx + vy * vy + vz * vz;
    const area2 = uu * vv - uv * uv, f = corner(t, 0), p = corner(t, 1) - f, q = corner(t, 2) - f;
    if (!(area2 > 1e-14 * uu * vv) || !Number.isFinite(p) || !Number.isFinite(q)) continue;
    const r = (vv * p - uv * q) / area2, s = (uu * q - uv * p) / area2;
    out[3 * t] = r * ux + s * vx;
    out[3 * t + 1] = r * uy + s * vy;
    out[3 * t + 2] = r * uz + s * vz;
  }
  return out;
}

/** The mean of g g^T over the triangles at each vertex, by area: xx, yy, zz, xy, xz, yz. With it the slope of the
 * field across a line of the screen is the same on both sides of an edge, and opposite gradients do not cancel. */
export function slopeTensors(positions: Float32Array, triangles: Uint32Array, gradient: Float32Array): Float32Array {
  const vertices = positions.length / 3, sum = new Float32Array(6 * vertices), weight = new Float32Array(vertices);
  for (let t = 0; t < triangles.length / 3; ++t) {
    const a = 3 * triangles[3 * t], b = 3 * triangles[3 * t + 1], c = 3 * triangles[3 * t + 2];
    const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
    const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
    const area = Math.sqrt((uy * vz - uz * vy) ** 2 + (uz * vx - ux * vz) ** 2 + (ux * vy - uy * vx) ** 2);
    const x = gradient[3 * t], y = gradient[3 * t + 1], z = gradient[3 * t + 2];
    if (!(area > 0)) continue;
    for (let k = 0; k < 3; ++k) {
      const v = triangles[3 * t + k], at = 6 * v;
      sum[at] += area * x * x;
      sum[at + 1] += area * y * y;
      sum[at + 2] += area * z * z;
      sum[at + 3] += area * x * y;
      sum[at + 4] += area * x * z;
      sum[at + 5] += area * y * z;
      weight[v] += area;
    }
  }
  for (let v = 0; v < vertices; ++v) {
    if (!(weight[v] > 0)) continue;
    for (let k = 0; k < 6; ++k) sum[6 * v + k] /= weight[v];
  }
  return sum;
}
