// The surface: colours and isolines are made in the fragment shader, so lines keep their width.
import * as THREE from "three";
import { vertexNormals, wireEdges } from "./data.js";

const vertexShader = `
in float t;
in float infinite;
in float lightness;  // 1 - weight, so that geometry without the attribute has weight 1
out float vTimes;
out float vWeight;
out float vInfinite;
out vec3 vNormal;
out float vSmooth;
out vec3 vPosition;
out vec3 vPlace;
void main() {
  vPlace = position;
  vWeight = 1.0 - lightness;
  vTimes = t * vWeight;
  vInfinite = infinite;
  vNormal = normalMatrix * normal;
  vSmooth = min(1.0, dot(normal, normal));
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  vPosition = p.xyz;
  gl_Position = projectionMatrix * p;
}`;

const fragmentHead = `
precision highp float;
in float vTimes;
in float vWeight;
in float vInfinite;
in vec3 vNormal;
in float vSmooth;
in vec3 vPosition;
in vec3 vPlace;
out vec4 result;
uniform vec4 cut;  // nothing is drawn where cut.xyz . place > cut.w
// Projective interpolation: round a corner of weight 0 the field takes every value.
float fieldValue() { return vTimes / max(vWeight, 1e-6); }
`;

/// How bright a surface is whose normal, towards the eye, is n.
export const lightFunction = `
float light(vec3 n) {
  vec3 lamp = normalize(vec3(-0.25, 0.35, 1.0));
  return min(1.06, 0.5 + 0.5 * max(0.0, dot(n, lamp)) / lamp.z);
}
`;

const fragmentShader = `${fragmentHead}${lightFunction}
precision highp sampler2D;
uniform bool hasField;
uniform bool showLines;
uniform bool diverging;
uniform bool zeroLine;
uniform sampler2D colours;
uniform vec2 colourMap;
uniform vec2 lineMap;      // lines where lineMap.x + lineMap.y * t is whole; y = 0: none
uniform float zeroAt;      // t of the value 0
uniform sampler2D levels;  // explicit levels, ascending
uniform int levelCount;
uniform float pixelRatio;
uniform vec3 plainColour;
uniform vec3 infiniteColour;

float ink(float away, float width) { return clamp(0.5 * width + 0.5 - away, 0.0, 1.0); }

void main() {
  if (dot(cut.xyz, vPlace) > cut.w) discard;
  // Corners on creases have no normal of their own: the face's stands in. Where faces disagree in
  // orientation vertex normals may cancel; the face's is the fallback there too.
  vec3 flatNormal = normalize(cross(dFdx(vPosition), dFdy(vPosition)));
  vec3 smoothNormal = dot(vNormal, flatNormal) < 0.0 ? -vNormal : vNormal;
  smoothNormal = normalize(smoothNormal + (1.0 - vSmooth + 1e-6) * flatNormal);
  vec3 n = normalize(mix(flatNormal, smoothNormal, smoothstep(0.3, 0.5, dot(smoothNormal, flatNormal))));
  if (dot(n, vPosition) > 0.0) n = -n;
  float vT = fieldValue();
  float slope = length(vec2(dFdx(vT), dFdy(vT)));

  vec3 colour = plainColour;
  float strength = 0.0;
  bool dark = false;
  if (hasField) {
    if (vInfinite > 1e-4) {
      colour = infiniteColour;
    } else {
      colour = texture(colours, vec2((255.0 * (colourMap.x + colourMap.y * vT) + 0.5) / 256.0, 0.5)).rgb;
      dark = dot(colour, vec3(0.30, 0.59, 0.11)) < 0.353;
      if (showLines && slope > 1e-6) {  // less is rounding
        float perPixel = slope * pixelRatio;
        if (lineMap.y > 0.0) {
          float x = lineMap.x + lineMap.y * vT;
          float away = abs(x - round(x)) / (lineMap.y * perPixel);
          strength = 0.6 * ink(away, 1.0) * smoothstep(2.0, 5.0, 1.0 / (lineMap.y * perPixel));
        } else if (levelCount > 0) {
          int low = 0, high = levelCount;
          for (int i = 0; i < 14 && low < high; ++i) {
            int middle = (low + high) / 2;
            if (texelFetch(levels, ivec2(middle, 0), 0).r < vT) low = middle + 1; else high = middle;
          }
          float away = 1e9;
          if (low < levelCount) away = texelFetch(levels, ivec2(low, 0), 0).r - vT;
          if (low > 0) away = min(away, vT - texelFetch(levels, ivec2(low - 1, 0), 0).r);
          strength = 0.6 * ink(away / perPixel, 1.0);
        }
        if (diverging && zeroLine) {
          float main = 0.95 * ink(abs(vT - zeroAt) / perPixel, 2.6);
          if (main > strength) { strength = main; dark = false; }
        }
      }
    }
  }
  colour *= light(n);
  result = vec4(mix(colour, dark ? vec3(0.92, 0.93, 0.96) : vec3(0.07, 0.08, 0.11), strength), 1.0);
}`;

const pickShader = `${fragmentHead}
void main() {
  if (dot(cut.xyz, vPlace) > cut.w) discard;
  float x = floor(clamp(fieldValue(), 0.0, 1.0) * 16777215.0 + 0.5);
  result = vec4(floor(x / 65536.0), mod(floor(x / 256.0), 256.0), mod(x, 256.0),
                vInfinite > 1e-4 ? 128.0 : 255.0) / 255.0;
}`;

const rgb = (bytes) => new THREE.Vector3(bytes[0], bytes[1], bytes[2]).divideScalar(255);

function texture(data, width, format, type, filter) {
  const t = new THREE.DataTexture(data, width, 1, format, type);
  t.minFilter = t.magFilter = filter;
  t.needsUpdate = true;
  return t;
}

/// Materials for the field's colours and lines, shared by all that is drawn with it.
export function makeLook(scene) {
  const { field } = scene;
  const range = field.high - field.low;
  const colourRange = field.colourHigh - field.colourLow;
  const map = new Uint8Array(256 * 4).fill(255);
  for (let i = 0; i < 256; ++i) map.set(field.colours.subarray(3 * i, 3 * i + 3), 4 * i);
  const sorted = field.levels.map((x) => (range > 0 ? (x - field.low) / range : 0)).sort((a, b) => a - b);
  const levels = Float32Array.from(sorted.length ? sorted.slice(0, 4096) : [0]);
  const uniforms = {
    cut: { value: new THREE.Vector4(0, 0, 0, 1) },
    hasField: { value: scene.values !== null || scene.volume !== undefined },
    showLines: { value: true },
    diverging: { value: field.diverging },
    zeroLine: { value: field.levels.length === 0 || field.levels.includes(0) },
    colours: { value: texture(map, 256, THREE.RGBAFormat, THREE.UnsignedByteType, THREE.LinearFilter) },
    colourMap: {
      value: colourRange > 0
        ? new THREE.Vector2((field.low - field.colourLow) / colourRange, range / colourRange)
        : new THREE.Vector2(0.5, 0),
    },
    lineMap: { value: new THREE.Vector2() },
    zeroAt: { value: range > 0 ? -field.low / range : -1 },
    levels: { value: texture(levels, levels.length, THREE.RedFormat, THREE.FloatType, THREE.NearestFilter) },
    levelCount: { value: Math.min(sorted.length, levels.length) },
    pixelRatio: { value: 1 },
    plainColour: { value: rgb(scene.plainColour) },
    // A field without any finite value is wholly infinite.
    infiniteColour: { value: rgb(scene.infiniteColour) },
  };
  if (!scene.values && field.infinite) uniforms.plainColour.value = rgb(scene.infiniteColour);
  const options = { glslVersion: THREE.GLSL3, side: THREE.DoubleSide, vertexShader };
  const material = new THREE.ShaderMaterial({
    ...options, fragmentShader, uniforms, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
  });
  const pickMaterial = new THREE.ShaderMaterial({
    ...options, fragmentShader: pickShader, uniforms, blending: THREE.NoBlending,
  });
  return {
    material,
    pickMaterial,
    uniforms,
    setSpacing(step) {
      const low = field.low / step;
      uniforms.lineMap.value.set(step > 0 ? low - Math.floor(low) : 0, step > 0 ? range / step : 0);
    },
  };
}

export function makeSurface(scene, look) {
  const { positions, triangles, values } = scene;
  const count = positions.length / 3;
  const t = new Float32Array(count), infinite = new Uint8Array(count);
  if (values) {
    for (let v = 0; v < count; ++v) {
      if (Number.isFinite(values[v])) t[v] = values[v];
      else infinite[v] = 255;
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(vertexNormals(positions, triangles), 3));
  geometry.setAttribute("t", new THREE.BufferAttribute(t, 1));
  geometry.setAttribute("infinite", new THREE.BufferAttribute(infinite, 1, true));
  if (scene.weights)
    geometry.setAttribute("lightness", new THREE.BufferAttribute(scene.weights.map((w) => 255 - w), 1, true));
  geometry.setIndex(new THREE.BufferAttribute(triangles, 1));
  geometry.boundingSphere = new THREE.Sphere(new THREE.Vector3(), 1);

  return {
    ...look,
    mesh: new THREE.Mesh(geometry, look.material),
    makeWires(colour) {
      const wires = new THREE.BufferGeometry();
      wires.setAttribute("position", geometry.getAttribute("position"));
      wires.setIndex(new THREE.BufferAttribute(wireEdges(triangles, scene.innerSides, count), 1));
      wires.boundingSphere = geometry.boundingSphere;
      return new THREE.LineSegments(
        wires, new THREE.LineBasicMaterial({ color: colour, transparent: true, opacity: 0.35 }));
    },
  };
}
