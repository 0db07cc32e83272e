// The camera: where it starts, and how keys move it.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

export function makeCamera(canvas, scene, onChange) {
  const camera = new THREE.PerspectiveCamera(30, 1, 0.01, 100);
  const controls = new OrbitControls(camera, canvas);
  controls.zoomToCursor = true;
  controls.minDistance = 0.02;
  controls.maxDistance = 40;
  controls.addEventListener("change", () => {
    // As tight about the unit sphere as can be: depth buffers are coarse.
    const distance = camera.position.length();
    camera.near = Math.max(0.002, distance - 1.3);
    camera.far = distance + 1.3;
    camera.updateProjectionMatrix();
    onChange();
  });

  // Nearest position along the view direction from which every vertex is inside the picture.
  function reset() {
    const z = new THREE.Vector3(...scene.towardsEye), y = new THREE.Vector3(...scene.up);
    const x = new THREE.Vector3().crossVectors(y, z);
    const dot = (a, i) => a.x * scene.positions[i] + a.y * scene.positions[i + 1] + a.z * scene.positions[i + 2];
    let left = 1, right = -1, bottom = 1, top = -1;
    for (const v of scene.triangles) {
      const a = dot(x, 3 * v), b = dot(y, 3 * v);
      left = Math.min(left, a); right = Math.max(right, a);
      bottom = Math.min(bottom, b); top = Math.max(top, b);
    }
    const tan = Math.tan((15 * Math.PI) / 180) * 0.86, wide = tan * camera.aspect * 0.84; // room for the legend
    const cx = (left + right) / 2, cy = (bottom + top) / 2;
    let distance = 1.2;
    for (const v of scene.triangles) {
      distance = Math.max(distance, dot(z, 3 * v) + Math.max(Math.abs(dot(x, 3 * v) - cx) / wide, Math.abs(dot(y, 3 * v) - cy) / tan));
    }
    camera.up.copy(y);
    controls._quat?.setFromUnitVectors(camera.up, new THREE.Vector3(0, 1, 0));
    if (controls._quat) controls._quatInverse.copy(controls._quat).invert();
    controls.target.copy(x.multiplyScalar(cx)).addScaledVector(y, cy);
    camera.position.copy(controls.target).addScaledVector(z, distance);
    controls.update();
    controls.dispatchEvent({ type: "change" });
  }

  function turn(across, upward) {
    const offset = camera.position.clone().sub(controls.target);
    const axis = new THREE.Vector3().crossVectors(camera.up, offset).normalize();
    const angle = offset.angleTo(camera.up);
    offset.applyAxisAngle(axis, Math.max(0.02, Math.min(Math.PI - 0.02, angle - upward)) - angle);
    offset.applyAxisAngle(camera.up, across);
    camera.position.copy(controls.target).add(offset);
    controls.update();
  }

  function move(across, upward) {
    const distance = camera.position.distanceTo(controls.target);
    const right = new THREE.Vector3().setFromMatrixColumn(camera.matrix, 0).multiplyScalar(across * distance);
    right.addScaledVector(new THREE.Vector3().setFromMatrixColumn(camera.matrix, 1), upward * distance);
    controls.target.add(right);
    camera.position.add(right);
    controls.update();
  }

  function zoom(factor) {
    const offset = camera.position.clone().sub(controls.target);
    offset.setLength(Math.max(controls.minDistance, Math.min(controls.maxDistance, offset.length() * factor)));
    camera.position.copy(controls.target).add(offset);
    controls.update();
  }

  return { camera, controls, reset, turn, move, zoom };
}
