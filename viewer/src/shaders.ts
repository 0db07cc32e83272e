// How a surface is shaded: colours and isolines are made per pixel (io/render/raster.cpp is the same).

/** How bright a surface is whose normal, towards the eye, is n. */
export const lightFunction = `
float light(vec3 n) {
  vec3 lamp = normalize(vec3(-0.25, 0.35, 1.0));
  return min(1.06, 0.5 + 0.5 * max(0.0, dot(n, lamp)) / lamp.z);
}
`;

/** How much light reaches a side of the surface from everywhere: the sky that is seen in direction d is a + b . d, of
 * which the half above the normal counts by its cosine (io/render/openness.h). */
export const openFunction = `
float openPart(vec4 open, vec3 n) {
  return clamp(open.w + dot(1.5 * open.xyz - 0.75, n) / 1.5, 0.0, 1.0);
}
float occlusion(vec4 open, vec3 n) { return 0.3 + 0.7 * openPart(open, n); }
`;

export const surfaceVertex = `
in float t;
in float infinite;
in float lightness;       // 1 - weight, so that geometry without the attribute has weight 1
in vec3 slopeA, slopeB;   // xx, yy, zz and xy, xz, yz of the mean of g g^T; 0: not known
in vec3 bulge, corner;    // of quadratic fields: sides above the mean of their ends; barycentric coordinates
in vec4 openness;         // how much of the sky is seen, see openPart()
in vec2 rim;              // of discs: place inside of a square about them
out float vTimes, vWeight, vInfinite, vSmooth;
out vec2 vRim;
out vec3 vNormal, vPosition, vPlace, vSlopeA, vSlopeB, vBulge, vCorner;
out vec4 vOpen;
void main() {
  vPlace = position;
  vWeight = 1.0 - lightness;
  vTimes = t * vWeight;
  vInfinite = infinite;
  vNormal = normalMatrix * normal;
  vSmooth = min(1.0, dot(normal, normal));
  vSlopeA = slopeA;
  vSlopeB = slopeB;
  vBulge = bulge;
  vCorner = corner;
  vOpen = openness;
  vRim = rim;
  vec4 p = modelViewMatrix * vec4(position, 1.0);
  vPosition = p.xyz;
  gl_Position = projectionMatrix * p;
}`;

export const surfaceFragment = `
precision highp float;
precision highp sampler2D;
in float vTimes, vWeight, vInfinite, vSmooth;
in vec2 vRim;
in vec3 vNormal, vPosition, vPlace, vSlopeA, vSlopeB, vBulge, vCorner;
in vec4 vOpen;
out vec4 result;
uniform vec4 cut;            // nothing is drawn where cut.xyz . place > cut.w
uniform vec3 boxLow, boxHigh;  // nor outside this box
uniform bool hasField, showLines, diverging, zeroLine, discrete, flatShading, occluded, trusted;
uniform sampler2D colours;
uniform float regions;       // colours of a discrete field, less 1
uniform vec2 colourMap, lineMap;  // lines where lineMap.x + lineMap.y * t is whole; y = 0: none
uniform float middle;        // where between its ends the map has its middle
uniform float zeroAt;        // t of the value 0
uniform sampler2D levels;    // explicit levels, ascending
uniform int levelCount;
uniform vec2 range;          // values outside are drawn pale
uniform float pixel;         // side of a CSS pixel at distance 1
uniform float pixelRatio;
uniform vec3 plainColour, infiniteColour;
${lightFunction}${openFunction}
// As in colours.ts.
float placeInMap(float part) {
  float u = clamp(part, 0.0, 1.0);
  if (u < middle) return 0.5 * u / middle;
  return 0.5 + (middle < 1.0 ? 0.5 * (u - middle) / (1.0 - middle) : 0.0);
}

float ink(float away, float width) { return clamp(0.5 * width + 0.5 - away, 0.0, 1.0); }

// t per CSS pixel. Where gradients at vertices are known, the slope is interpolated from them: then it is the
// same on both sides of an edge, and lines have no seam there. At creases and corners of weight, the triangle's.
float slopeOf(float vT, vec3 n, float known) {
  float own = length(vec2(dFdx(vT), dFdy(vT))) * pixelRatio;
  if (known <= 0.0 || vSlopeA.x + vSlopeA.y + vSlopeA.z <= 0.0) return own;
  float facing = dot(n, vPosition);
  facing = (facing < 0.0 ? -1.0 : 1.0) * max(abs(facing), 0.08 * length(vPosition));
  float size = pixel * -vPosition.z;
  mat3 back = transpose(mat3(viewMatrix));
  vec3 x = back * (vec3(size, 0.0, 0.0) - vPosition * (n.x * size / facing));
  vec3 y = back * (vec3(0.0, size, 0.0) - vPosition * (n.y * size / facing));
  vec3 xx = x * x + y * y, xy = 2.0 * (vec3(x.x, x.x, x.y) * vec3(x.y, x.z, x.z) + vec3(y.x, y.x, y.y) * vec3(y.y, y.z, y.z));
  float mean = sqrt(max(0.0, dot(vSlopeA, xx) + dot(vSlopeB, xy)));
  mean = clamp(mean, 0.6 * own, 1.7 * own);  // where the field has a kink, the triangle knows better
  return mix(own, mean, known);
}

void main() {
  if (dot(cut.xyz, vPlace) > cut.w || dot(vRim, vRim) > 1.0) discard;
  if (any(lessThan(vPlace, boxLow)) || any(greaterThan(vPlace, boxHigh))) discard;
  // Corners on creases have no normal of their own: the face's stands in. Where faces disagree in
  // orientation vertex normals may cancel; the face's is the fallback there too.
  vec3 flatNormal = normalize(cross(dFdx(vPosition), dFdy(vPosition)));
  vec3 n = flatNormal;
  float smoothly = flatShading ? 0.0 : vSmooth;
  if (trusted && !flatShading) n = normalize(vNormal);
  else if (!flatShading) {
    vec3 smoothNormal = dot(vNormal, flatNormal) < 0.0 ? -vNormal : vNormal;
    smoothNormal = normalize(smoothNormal + (1.0 - vSmooth + 1e-6) * flatNormal);
    n = normalize(mix(flatNormal, smoothNormal, smoothstep(0.3, 0.5, dot(smoothNormal, flatNormal))));
  }
  if (!(dot(n, n) > 0.5)) n = vec3(0.0, 0.0, 1.0);
  if (dot(n, vPosition) > 0.0) n = -n;
  // Projective interpolation: round a corner of weight 0 the field takes every value.
  float vT = vTimes / max(vWeight, 1e-6) + 4.0 * dot(vBulge, vCorner.yzx * vCorner.zxy);
  float slope = slopeOf(vT, n, vWeight > 0.999 ? vSmooth * vSmooth : 0.0);

  vec3 colour = plainColour;
  float strength = 0.0;
  bool dark = false;
  if (hasField) {
    if (vInfinite > 1e-4) {
      // Hatched, so that it is no colour of the map.
      float stripe = fract((gl_FragCoord.x + gl_FragCoord.y) / (9.0 * pixelRatio));
      colour = infiniteColour * (stripe < 0.3 ? 0.72 : 1.0);
    } else if (discrete) {
      colour = texelFetch(colours, ivec2(int(clamp(floor(vT * regions + 0.5), 0.0, regions)), 0), 0).rgb;
    } else {
      colour = texture(colours, vec2((255.0 * placeInMap(colourMap.x + colourMap.y * vT) + 0.5) / 256.0, 0.5)).rgb;
    }
    bool pale = vInfinite <= 1e-4 && (vT < range.x || vT > range.y);
    if (pale) colour = mix(plainColour, vec3(dot(colour, vec3(0.30, 0.59, 0.11))), 0.25);
    dark = dot(colour, vec3(0.30, 0.59, 0.11)) < 0.353;
    if (showLines && !discrete && !pale && vInfinite <= 1e-4 && slope > 1e-6) {  // less is rounding
      if (lineMap.y > 0.0) {
        float x = lineMap.x + lineMap.y * vT, apart = 1.0 / (lineMap.y * slope);
        // Where a field is as small or large as it gets, it may be so all over: no lines about rounding.
        float level = (round(x) - lineMap.x) / lineMap.y;
        if (level > 1e-6 && level < 1.0 - 1e-6)
          strength = 0.6 * ink(abs(x - round(x)) * apart, 1.0) * smoothstep(2.0, 5.0, apart);
      } else if (levelCount > 0) {
        int low = 0, high = levelCount;
        for (int i = 0; i < 14 && low < high; ++i) {
          int middle = (low + high) / 2;
          if (texelFetch(levels, ivec2(middle, 0), 0).r < vT) low = middle + 1; else high = middle;
        }
        float away = 1e9;
        if (low < levelCount) away = texelFetch(levels, ivec2(low, 0), 0).r - vT;
        if (low > 0) away = min(away, vT - texelFetch(levels, ivec2(low - 1, 0), 0).r);
        strength = 0.6 * ink(away / slope, 1.0);
      }
      if (diverging && zeroLine) {
        float main = 0.95 * ink(abs(vT - zeroAt) / slope, 2.6);
        if (main > strength) { strength = main; dark = false; }
      }
    }
  }
  colour *= light(n);
  if (occluded) colour *= occlusion(vOpen, transpose(mat3(viewMatrix)) * n);
  result = vec4(mix(colour, dark ? vec3(0.92, 0.93, 0.96) : vec3(0.07, 0.08, 0.11), strength), 1.0);
}`;

/** Depth along the view direction in 24 bits, for what asks whether something is hidden. */
export const depthFragment = `
precision highp float;
in vec2 vRim;
in vec3 vPosition, vPlace;
out vec4 result;
uniform vec4 cut;
uniform vec3 boxLow, boxHigh;
uniform vec2 depthRange;
void main() {
  if (dot(cut.xyz, vPlace) > cut.w || dot(vRim, vRim) > 1.0) discard;
  if (any(lessThan(vPlace, boxLow)) || any(greaterThan(vPlace, boxHigh))) discard;
  float x = floor(clamp((-vPosition.z - depthRange.x) / (depthRange.y - depthRange.x), 0.0, 1.0) * 16777215.0 + 0.5);
  result = vec4(floor(x / 65536.0), mod(floor(x / 256.0), 256.0), mod(x, 256.0), 255.0) / 255.0;
}`;
