// What is drawn, on the surface: curves with their arrows, points, and of the curve that is
// selected its nodes and its sides.
import * as THREE from "three";
import { makeSources } from "../../../viewer/src/sources";
import type { Drawing, Selection } from "./drawing";
import { signedColour, unsignedColour } from "./skin";

/** Positions along the surface, in the page's units. */
export type Polyline = readonly THREE.Vector3[];

export interface Layout {
  readonly strokes: readonly Polyline[];
  /** Nodes by stroke. */
  readonly nodes: readonly Polyline[];
  readonly points: Polyline;
}

const dash = 0.03, head = 0.045, every = 0.3, nodeSize = 0.0095;

const lengthOf = (line: Polyline) => line.slice(1).reduce((sum, p, i) => sum + p.distanceTo(line[i]), 0);

/** Pieces of a line by where they begin along it. */
function* pieces(line: Polyline) {
  let from = 0;
  for (let i = 1; i < line.length; ++i) {
    const a = line[i - 1], b = line[i], size = a.distanceTo(b);
    if (size > 0) yield { a, b, size, from };
    from += size;
  }
}

function addStrokes(line: Polyline, whole: boolean, out: number[]): void {
  for (const { a, b, size, from } of pieces(line)) {
    if (whole) {
      out.push(...a.toArray(), ...b.toArray());
      continue;
    }
    for (let k = Math.floor(from / dash); k * dash < from + size; ++k) {
      const start = Math.max(0, k * dash - from), end = Math.min(size, (k + 1) * dash - from);
      if (k % 2 === 0 && end > start)
        out.push(...a.clone().lerp(b, start / size).toArray(), ...a.clone().lerp(b, end / size).toArray());
    }
  }
}

function addArrows(line: Polyline, out: number[]): void {
  const total = lengthOf(line), heads = Math.max(1, Math.round(total / every)), step = total / heads;
  let next = step;
  for (const { a, b, size, from } of pieces(line)) {
    while (next <= from + size + 1e-9 * total && next <= total * (1 + 1e-9)) {
      const tip = a.clone().lerp(b, Math.min(1, (next - from) / size));
      out.push(...tip.clone().addScaledVector(b.clone().sub(a), -Math.min(head, step / 2) / size).toArray(), ...tip.toArray());
      next += step;
    }
  }
}

export class Marks {
  private readonly ball = new THREE.SphereGeometry(1, 12, 8);
  private readonly handle = new THREE.MeshBasicMaterial({ color: 0xffffff });
  private readonly rim = new THREE.MeshBasicMaterial({ color: 0x101828, side: THREE.BackSide });
  private readonly chosen = new THREE.MeshBasicMaterial({ color: 0xffb000 });
  private readonly sides = [[1, 0xde7430], [-1, 0x3476be]].map(([side, color]) => ({
    side, material: new THREE.MeshBasicMaterial({ color, side: THREE.DoubleSide, transparent: true, opacity: 0.8, depthWrite: false }),
  }));
  private own: THREE.Object3D[] = []; // whose materials are kept

  constructor(
    private readonly group: THREE.Group,
    private readonly normalAt: (place: THREE.Vector3, out: THREE.Vector3) => THREE.Vector3,
  ) {}

  show(drawing: Drawing, layout: Layout, selection: Selection | null): void {
    this.clear();
    const signed: number[] = [], unsigned: number[] = [], arrows: number[] = [];
    drawing.strokes.forEach((stroke, i) => {
      const line = layout.strokes[i] ?? [], nodes = layout.nodes[i] ?? [];
      addStrokes(line, stroke.signed, stroke.signed ? signed : unsigned);
      if (stroke.signed && line.length > 1) addArrows(line, arrows);
      const chosen = selection?.kind === "stroke" && selection.index === i;
      if (chosen && stroke.signed) this.addSides(line);
      // The many nodes of a freehand stroke would hide it.
      if (nodes.length === 1 || (chosen && (nodes.length <= 24 || selection.node >= 0))) this.addNodes(nodes, chosen ? selection.node : -1);
    });
    const point = selection?.kind === "point" ? layout.points[selection.index] : undefined;
    if (point) this.addBalls([point], 0.019, this.chosen);
    this.group.add(makeSources({
      signed: Float32Array.from(signed), unsigned: Float32Array.from(unsigned), arrows: Float32Array.from(arrows),
      points: Float32Array.from(layout.points.flatMap((p) => p.toArray())), signedColour, unsignedColour,
    }));
  }

  private clear(): void {
    for (const child of this.own) if (child instanceof THREE.InstancedMesh) child.dispose();
      else if (child instanceof THREE.Mesh) child.geometry.dispose();
    this.group.remove(...this.own);
    this.own = [];
    this.group.traverse((child) => {
      if (!(child instanceof THREE.InstancedMesh)) return;
      child.geometry.dispose();
      child.material.dispose();
      child.dispose();
    });
    this.group.clear();
  }

  private keep(object: THREE.Object3D): void {
    object.frustumCulled = false;
    this.own.push(object);
    this.group.add(object);
  }

  private addBalls(places: Polyline, size: number, material: THREE.Material): void {
    if (!places.length) return;
    const mesh = new THREE.InstancedMesh(this.ball, material, places.length), matrix = new THREE.Matrix4();
    places.forEach((p, i) => mesh.setMatrixAt(i, matrix.makeScale(size, size, size).setPosition(p)));
    this.keep(mesh);
  }

  private addNodes(nodes: Polyline, picked: number): void {
    this.addBalls(nodes, 1.25 * nodeSize, this.rim);
    this.addBalls(nodes.filter((_, k) => k !== picked), nodeSize, this.handle);
    const one = nodes[picked];
    if (one) this.addBalls([one], 1.2 * nodeSize, this.chosen);
  }

  // Ribbons along both sides: distance is positive to the left of travel.
  private addSides(line: Polyline): void {
    const inner = 0.008, outer = 0.028, lift = 0.003, normal = new THREE.Vector3();
    for (const { side, material } of this.sides) {
      const places: number[] = [];
      for (const { a, b } of pieces(line)) {
        this.normalAt(a.clone().add(b).multiplyScalar(0.5), normal);
        const left = normal.clone().cross(b.clone().sub(a)).normalize();
        if (!(left.length() > 0.5)) continue;
        const corner = (p: THREE.Vector3, off: number) =>
          p.clone().addScaledVector(left, side * off).addScaledVector(normal, lift).toArray();
        const [p, q, r, s] = [corner(a, inner), corner(b, inner), corner(b, outer), corner(a, outer)];
        places.push(...p, ...q, ...r, ...p, ...r, ...s);
      }
      if (!places.length) continue;
      const geometry = new THREE.BufferGeometry();
      geometry.setAttribute("position", new THREE.BufferAttribute(Float32Array.from(places), 3));
      this.keep(new THREE.Mesh(geometry, material));
    }
  }
}
