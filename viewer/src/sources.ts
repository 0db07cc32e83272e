// Sources: tubes (dashed where unsigned), arrow heads along signed curves, spheres at points.
import * as THREE from "three";
import type { SourceMarks } from "./scene";

type Place = (i: number, matrix: THREE.Matrix4) => void;

const up = new THREE.Vector3(0, 1, 0);

function instances(geometry: THREE.BufferGeometry, material: THREE.Material, count: number, place: Place) {
  const mesh = new THREE.InstancedMesh(geometry, material, count);
  const matrix = new THREE.Matrix4();
  for (let i = 0; i < count; ++i) {
    place(i, matrix);
    mesh.setMatrixAt(i, matrix);
  }
  mesh.frustumCulled = false;
  return mesh;
}

// A shape of unit height along y, from a to b, `radius` thick.
function between(a: THREE.Vector3, b: THREE.Vector3, radius: number, matrix: THREE.Matrix4) {
  const along = new THREE.Vector3().subVectors(b, a);
  const length = along.length() || 1e-9;
  const turn = new THREE.Quaternion().setFromUnitVectors(up, along.divideScalar(length));
  const middle = new THREE.Vector3().addVectors(a, b).multiplyScalar(0.5);
  matrix.compose(middle, turn, new THREE.Vector3(radius, length, radius));
}

/** A line of some places (three numbers each), white with dark sides so that it is seen on any colour. */
export function makeLine(places: ArrayLike<number>, radius = 0.006): THREE.Group {
  const group = new THREE.Group(), count = places.length / 3, at = (i: number) => new THREE.Vector3(places[3 * i], places[3 * i + 1], places[3 * i + 2]);
  const tube = new THREE.CylinderGeometry(1, 1, 1, 10, 1, true), ball = new THREE.SphereGeometry(1, 12, 8);
  for (const [part, colour, side] of [[1, 0xffffff, THREE.FrontSide], [1.7, 0x10141c, THREE.BackSide]] as const) {
    const paint = new THREE.MeshBasicMaterial({ color: colour, side });
    if (count > 1) group.add(instances(tube, paint, count - 1, (i, m) => between(at(i), at(i + 1), part * radius, m)));
    const joints = instances(ball, paint, count, (i, m) => m.makeScale(part * radius, part * radius, part * radius).setPosition(at(i)));
    group.add(joints);
  }
  return group;
}

/** Frees what a group of marks holds on the graphics side. */
export function disposeMarks(group: THREE.Group): void {
  for (const child of group.children) if (child instanceof THREE.InstancedMesh) {
    (child.geometry as THREE.BufferGeometry).dispose();
    (child.material as THREE.Material).dispose();
    child.dispose();
  }
}

/** Tubes, arrow heads and spheres where sources are. */
export function makeSources(sources: SourceMarks): THREE.Group {
  const group = new THREE.Group();
  const at = (array: Float32Array, i: number) => new THREE.Vector3(array[3 * i], array[3 * i + 1], array[3 * i + 2]);
  const colour = (bytes: number[]) => new THREE.Color(`rgb(${bytes.join(",")})`);
  const material = (bytes: number[]) => new THREE.MeshLambertMaterial({ color: colour(bytes), emissive: colour(bytes), emissiveIntensity: 0.35 });
  const tube = new THREE.CylinderGeometry(1, 1, 1, 10, 1, true);
  const ball = new THREE.SphereGeometry(1, 12, 8);
  const cone = new THREE.ConeGeometry(1, 1, 16);
  const radius = 0.0055;
  const strokes = (array: Float32Array, paint: THREE.Material) => {
    const count = array.length / 6;
    if (!count) return;
    group.add(instances(tube, paint, count, (i, m) => between(at(array, 2 * i), at(array, 2 * i + 1), radius, m)));
    group.add(instances(ball, paint, 2 * count, (i, m) => m.makeScale(radius, radius, radius).setPosition(at(array, i))));
  };
  const signed = material(sources.signedColour), unsigned = material(sources.unsignedColour);
  strokes(sources.signed, signed);
  strokes(sources.unsigned, unsigned);
  const heads = sources.arrows.length / 6;
  if (heads) {
    group.add(instances(cone, signed, heads, (i, m) => {
      const a = at(sources.arrows, 2 * i), b = at(sources.arrows, 2 * i + 1);
      between(a, b, 0.32 * a.distanceTo(b), m);
    }));
  }
  const points = sources.points.length / 3;
  if (points) {
    group.add(instances(ball, unsigned, points, (i, m) => m.makeScale(0.016, 0.016, 0.016).setPosition(at(sources.points, i))));
  }
  return group;
}
