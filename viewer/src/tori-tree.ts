// Which tori have a say where: an octree over the box whose leaves near the points list the nearest
// ones. Made here because it is larger than the tori themselves.

export const width = 2048;  // texels in a row of the textures below

const candidates = 96, deepest = 10, blended = 12;

export interface ToriTree {
  centre: number[];
  half: number;
  nodes: Int32Array<ArrayBuffer>;
  lists: Uint32Array<ArrayBuffer>;
}

/// points: 16 numbers a torus, the first four its point and spacing. The root is a cube around the
/// box. nodes: two integers a node: first child and -1; or, of a leaf, where its list begins in
/// `lists` and how long it is, 0 where the sampled field serves. Lists are sorted by distance from
/// the leaf's centre and hold every torus that is among the 12 nearest anywhere in the leaf, but at
/// most 96.
export function makeTree(tori: Float32Array, low: number[], high: number[]): ToriTree {
  const count = tori.length / 16;
  const half = Math.max(...low.map((x, a) => high[a] - x)) / 2 * 1.001;
  const centre = low.map((x, a) => (x + high[a]) / 2);
  const nodes = [0, 0], lists: number[] = [];
  const everyone = new Uint32Array(count).map((_, i) => i);

  function fill(node: number, c: number[], h: number, from: Uint32Array, depth: number): void {
    const r = h * Math.sqrt(3), distance = new Float32Array(from.length);
    let first = Infinity, nearest = 0;
    for (let i = 0; i < from.length; ++i) {
      const t = 16 * from[i];
      const d = Math.sqrt((tori[t] - c[0]) ** 2 + (tori[t + 1] - c[1]) ** 2 + (tori[t + 2] - c[2]) ** 2);
      distance[i] = d;
      if (d < first) { first = d; nearest = from[i]; }
    }
    // The surface passes within about a spacing of the points.
    if (first - r > tori[16 * nearest + 3]) return;
    const reach = kth(distance, Math.min(blended, from.length) - 1) + 2 * r;
    let kept = 0;
    for (let i = 0; i < from.length; ++i) if (distance[i] <= reach) ++kept;
    if (kept <= candidates || depth === deepest) {
      // Sorted as numbers: distance before, place in `from` behind.
      const keys = new Float64Array(kept);
      for (let i = 0, n = 0; i < from.length; ++i) if (distance[i] <= reach) keys[n++] = Math.floor(distance[i] * 16777216) * 1048576 + i;
      keys.sort();
      nodes[2 * node] = lists.length;
      nodes[2 * node + 1] = Math.min(kept, candidates);
      for (let i = 0; i < Math.min(kept, candidates); ++i) lists.push(from[keys[i] % 1048576]);
      return;
    }
    const passed = new Uint32Array(kept);
    for (let i = 0, n = 0; i < from.length; ++i) if (distance[i] <= reach) passed[n++] = from[i];
    const child = nodes.length / 2;
    nodes[2 * node] = child;
    nodes[2 * node + 1] = -1;
    for (let k = 0; k < 8; ++k) nodes.push(0, 0);
    for (let k = 0; k < 8; ++k) {
      const q = [c[0] + (k & 1 ? h / 2 : -h / 2), c[1] + (k & 2 ? h / 2 : -h / 2), c[2] + (k & 4 ? h / 2 : -h / 2)];
      fill(child + k, q, h / 2, passed, depth + 1);
    }
  }
  fill(0, centre, half, everyone, 0);
  return { centre, half, nodes: Int32Array.from(nodes), lists: Uint32Array.from(lists) };
}

/// Trees of several clouds as one: where the root of each is. Lists name tori as if all stood in one
/// array.
export function makeTrees(clouds: Float32Array[], low: number[], high: number[]): ToriTree & { roots: number[] } {
  const trees = clouds.map((tori) => makeTree(tori, low, high)), roots: number[] = [];
  const size = (of: (tree: ToriTree) => ArrayLike<number>) => trees.reduce((sum, tree) => sum + of(tree).length, 0);
  const nodes = new Int32Array(size((tree) => tree.nodes)), lists = new Uint32Array(size((tree) => tree.lists));
  let atNode = 0, atList = 0, torus = 0;
  trees.forEach((tree, which) => {
    roots.push(atNode / 2);
    for (let i = 0; i < tree.nodes.length; i += 2) {
      const inner = tree.nodes[i + 1] < 0;
      nodes[atNode + i] = tree.nodes[i] + (inner ? atNode / 2 : atList);
      nodes[atNode + i + 1] = tree.nodes[i + 1];
    }
    for (let i = 0; i < tree.lists.length; ++i) lists[atList + i] = tree.lists[i] + torus;
    atNode += tree.nodes.length;
    atList += tree.lists.length;
    torus += clouds[which].length / 16;
  });
  return { centre: trees[0].centre, half: trees[0].half, nodes, lists, roots };
}

/// The k-th smallest (from 0) of some numbers, which stay as they are.
export function kth(numbers: Float32Array, k: number): number {
  const a = numbers.slice();
  for (let low = 0, high = a.length - 1; low < high;) {
    const pivot = a[(low + high) >> 1];
    let i = low, j = high;
    while (i <= j) {
      while (a[i] < pivot) ++i;
      while (a[j] > pivot) --j;
      if (i <= j) {
        const swap = a[i];
        a[i++] = a[j];
        a[j--] = swap;
      }
    }
    if (k <= j) high = j;
    else if (k >= i) low = i;
    else break;
  }
  return a[k];
}
