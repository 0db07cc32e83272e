// The package beside the program.
import assert from "node:assert/strict";
import { cases, native, nativeDistance, queries, regionSources } from "./inputs.mjs";

/** The largest difference, in the largest finite value that is right; infinities must agree. */
export function difference(values, right) {
  assert.equal(values.length, right.length);
  let most = 0, size = 0;
  for (let i = 0; i < right.length; ++i) {
    if (!Number.isFinite(right[i])) {
      assert.equal(values[i], right[i]);
      continue;
    }
    size = Math.max(size, Math.abs(right[i]));
    most = Math.max(most, Math.abs(values[i] - right[i]));
  }
  return most / size;
}

let known; // one run of the program serves all environments
function right() {
  known ??= {
    fields: cases.map(nativeDistance),
    region: native("winding", regionSources.surface, "-s", regionSources.name),
    distances: ["spot.obj", "sphere.xyz"].map((name) => native("query", name, "--points", "queries.csv").slice(-queries.length)),
  };
  return known;
}

export function assertSameAsProgram(found) {
  const { fields, region, distances } = right();
  cases.forEach((it, k) => {
    const off = difference(found.fields[k].values, fields[k]);
    assert.ok(off < 1e-9, `${it.method} on ${it.surface} is off by ${off}`);
    assert.ok(found.fields[k].same, `${it.method} on ${it.surface} is another from its own text`);
    assert.equal(found.fields[k].method, it.method);
    assert.equal(found.fields[k].progress, 1);
  });
  assert.ok(found.fields[4].refined.vertices > fields[4].length, "values that jump have vertices of their own");
  assert.deepEqual(found.region, region);
  distances.forEach((values, k) => assert.ok(difference(found.distances[k], values) < 1e-9));
  assert.deepEqual(found.kinds, ["triangle mesh", "polygon mesh", "triangle mesh", "point cloud", "voxel surface"]);
}
