// Sphere tracing of blended tori, as in the library: methods/tori/torus.h, methods/tori/tori.cpp (eq. 5.1 with
// shifted exponents), methods/implicit/combined.cpp and methods/implicit/sphere_trace.cpp, in single precision.
import { mostClouds } from "./scene";
import { lightFunction, openFunction } from "./shaders";

/// Of both passes: a rectangle over the whole picture.
export const screenVertex = `
out vec2 place;
void main() {
  place = position.xy;
  gl_Position = vec4(position.xy, 0.0, 1.0);
}`;

export const traceFragment = `
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp isampler2D;
precision highp usampler2D;
precision highp sampler3D;
in vec2 place;
out vec4 result;           // where along the ray, or -1; the normal
uniform sampler2D tori;    // four texels a torus
uniform isampler2D nodes;
uniform usampler2D lists;
uniform sampler3D samples; // each cloud's field on a grid, page units, one above the other
uniform int clouds;
uniform int roots[${mostClouds}], operations[${mostClouds}];  // of each cloud; unite, intersect, subtract
uniform float blend, offset;
uniform vec3 origin, spacing;  // of the grid
uniform vec3 centre;       // of the octree
uniform float halfSide;
uniform vec3 low, high;    // nothing is outside
uniform vec4 cut;          // nor where cut.xyz . place > cut.w
uniform float level, steepness, tolerance;
uniform vec3 eye;
uniform mat3 rays;         // columns: right, up, ahead, for place in [-1, 1]^2

const int blended = 12;

ivec2 texel(int i) { return ivec2(i % 2048, i / 2048); }

float sampled(vec3 x, int cloud) {
  ivec3 n = textureSize(samples, 0);
  n.z /= clouds;
  int below = cloud * n.z;
  vec3 at = clamp((x - origin) / spacing, vec3(0.0), vec3(n) - 1.0001);
  ivec3 c = min(ivec3(at), n - 2);
  vec3 t = at - vec3(c);
  float v[8];
  for (int k = 0; k < 8; ++k)
    v[k] = texelFetch(samples, c + ivec3(k & 1, (k >> 1) & 1, below + (k >> 2)), 0).r;
  vec4 a = mix(vec4(v[0], v[2], v[4], v[6]), vec4(v[1], v[3], v[5], v[7]), t.x);
  vec2 b = mix(a.xz, a.yw, t.y);
  return mix(b.x, b.y, t.z);
}

float circleDistance(float k, float u2, float w) {
  float a = w - 0.5 * k * (u2 + w * w);
  return 2.0 * a / (1.0 + sqrt(max(0.0, 1.0 - 2.0 * k * a)));
}

float safe(float x) { return abs(x) < 1e-6 ? 1e-6 : x; }

float patchDistance(vec3 y, vec3 n, vec3 e1, float k1, float k2, float rho) {
  vec3 e2 = cross(n, e1);
  float u = dot(y, e1), v = dot(y, e2), w = dot(y, n);
  float c = circleDistance(k1, u * u, w), g = circleDistance(k2, v * v, c);
  float a = safe(1.0 - k1 * c), b = safe(1.0 - k2 * g), through = (1.0 - k2 * c) / b;
  vec3 f = vec3(u, v, w) - g * vec3(through * (-k1 * u) / a, -k2 * v / b, through * (1.0 - k1 * w) / a);
  float limit = 1.5 * rho;
  if (dot(f, f) <= limit * limit) return g;
  f.xy *= limit / max(1e-20, length(f.xy));
  f.z = 0.5 * (k1 * f.x * f.x + k2 * f.y * f.y);
  float d = length(vec3(u, v, w) - f);
  return g < 0.0 ? -d : d;
}

float cloudField(vec3 x, int cloud) {
  // The leaf of x.
  vec3 c = centre;
  float h = halfSide;
  int node = roots[cloud];
  ivec2 entry = texelFetch(nodes, texel(node), 0).rg;
  for (int depth = 0; depth < 12 && entry.y < 0; ++depth) {
    bvec3 up = greaterThanEqual(x, c);
    node = entry.x + (up.x ? 1 : 0) + (up.y ? 2 : 0) + (up.z ? 4 : 0);
    h *= 0.5;
    c += mix(vec3(-h), vec3(h), vec3(up));
    entry = texelFetch(nodes, texel(node), 0).rg;
  }
  if (entry.y <= 0) return sampled(x, cloud);

  // The 12 nearest; the list is sorted by distance from c, so it need not be read to its end.
  float d[blended];
  int who[blended];
  for (int j = 0; j < blended; ++j) { d[j] = 1e9; who[j] = 0; }
  int found = 0;
  float away = distance(x, c);
  for (int i = 0; i < entry.y; ++i) {
    int torus = int(texelFetch(lists, texel(entry.x + i), 0).r);
    vec3 p = texelFetch(tori, texel(4 * torus), 0).xyz;
    if (found >= blended && distance(p, c) - away > d[blended - 1]) break;
    float dp = distance(x, p);
    int who_p = torus;
    ++found;
    for (int j = 0; j < blended; ++j) {
      if (dp < d[j]) {
        float t = d[j]; d[j] = dp; dp = t;
        int s = who[j]; who[j] = who_p; who_p = s;
      }
    }
  }
  int n = min(found, blended);
  float nearest = d[0], farthest = d[0];
  for (int j = 0; j < blended; ++j) if (j < n) farthest = max(farthest, d[j]);
  float sum = 0.0, total = 0.0;
  for (int j = 0; j < blended; ++j) {
    if (j >= n) break;
    float close = 1.0 - d[j] / max(farthest, 1e-20), w = close * close + 1e-9;
    sum += w * texelFetch(tori, texel(4 * who[j]), 0).w;
    total += w;
  }
  float rho = sum / total, last = exp(-8.0 * (farthest - nearest) / rho);
  float plain = 0.0, negative = 0.0, size = 0.0;
  total = 0.0;
  for (int j = 0; j < blended; ++j) {
    if (j >= n) break;
    int at = 4 * who[j];
    vec4 q = texelFetch(tori, texel(at + 1), 0), m = texelFetch(tori, texel(at + 2), 0), e = texelFetch(tori, texel(at + 3), 0);
    float w = exp(q.w) * (exp(-8.0 * (d[j] - nearest) / rho) - last) + 1e-7;
    float g = patchDistance(x - q.xyz, m.xyz, e.xyz, m.w, e.w, texelFetch(tori, texel(at), 0).w);
    if (g < 0.0) negative += w;
    plain += w * g;
    size += w * abs(g);
    total += w;
  }
  // Where tori disagree on the side, away from the points, the samples know it.
  bool disputed = nearest > 1.5 * rho && negative > 0.02 * total && negative < 0.98 * total;
  float phi = disputed ? (sampled(x, cloud) < 0.0 ? -size : size) / total : plain / total;
  float bounded = clamp(abs(phi), max(0.0, nearest - rho), nearest);
  return phi < 0.0 ? -bounded : bounded;
}

void insert(inout float sorted[${mostClouds}], inout int n, float value) {
  int at = n++;
  for (; at > 0 && sorted[at - 1] > value; --at) sorted[at] = sorted[at - 1];
  sorted[at] = value;
}

float smoothMin(float sorted[${mostClouds}], int n) {
  float least = sorted[0];
  for (int i = 1; i < n; ++i) {
    float h = 1.0 - (sorted[i] - least) / blend;
    if (blend > 0.0 && h > 0.0) least -= 0.25 * blend * h * h;
  }
  return least;
}

// max(united, all intersected, -all subtracted) less the offset
float field(vec3 x) {
  if (clouds == 1) return cloudField(x, 0) - offset;
  float united[${mostClouds}], parts[${mostClouds}];
  int joined = 0, n = 0;
  for (int i = 0; i < clouds; ++i) {
    float phi = cloudField(x, i);
    if (operations[i] == 0) insert(united, joined, phi);
    else insert(parts, n, operations[i] == 1 ? -phi : phi);
  }
  insert(parts, n, -smoothMin(united, joined));
  return -smoothMin(parts, n) - offset;
}

void main() {
  result = vec4(-1.0, 0.0, 0.0, 0.0);
  vec3 ray = normalize(rays[0] * place.x + rays[1] * place.y + rays[2]);
  vec3 one = (low - eye) / ray, two = (high - eye) / ray;
  vec3 near = min(one, two), far = max(one, two);
  float t = max(max(near.x, near.y), max(near.z, 0.0)), end = min(far.x, min(far.y, far.z));
  float along = dot(cut.xyz, ray), room = cut.w - dot(cut.xyz, eye);
  if (along > 0.0) end = min(end, room / along);
  else if (along < 0.0) t = max(t, room / along);
  else if (room < 0.0) return;
  if (!(t < end)) return;
  float here = field(eye + t * ray) - level;
  bool hit = false;
  for (int i = 0; i < 400; ++i) {
    if (i > 0 && abs(here) < tolerance) { hit = true; break; }
    if (t >= end) break;
    float next = min(end, t + max(abs(here) / steepness, tolerance));
    float there = field(eye + next * ray) - level;
    if ((there < 0.0) == (here < 0.0)) { t = next; here = there; continue; }
    float a = t, fa = here, b = next, fb = there, root = t, at = here;
    for (int k = 0; k < 12 && abs(at) > 0.2 * tolerance; ++k) {
      root = k % 3 == 2 ? 0.5 * (a + b) : (a * fb - b * fa) / (fb - fa);
      at = field(eye + root * ray) - level;
      if ((at < 0.0) == (fa < 0.0)) { a = root; fa = at; fb *= 0.5; }
      else { b = root; fb = at; fa *= 0.5; }
    }
    if (abs(at) < 4.0 * tolerance) { t = root; hit = true; break; }
    t = next;  // a jump is no surface
    here = there;
  }
  if (!hit) return;
  vec3 x = eye + t * ray;
  float e = max(tolerance, 1e-3);
  vec2 s = vec2(1.0, -1.0);
  vec3 n = s.xyy * field(x + e * s.xyy) + s.yyx * field(x + e * s.yyx) + s.yxy * field(x + e * s.yxy) + s.xxx * field(x + e * s.xxx);
  result = vec4(t, n / max(1e-20, length(n)));
}`;

export const showFragment = `
precision highp float;
${lightFunction}${openFunction}
precision highp sampler2D;
precision highp sampler3D;
in vec2 place;
out vec4 result;
uniform sampler2D coarse, full;
uniform int fullRows;    // from below, that are traced in full
uniform vec3 eye;
uniform mat3 rays;
uniform sampler2D colours;
uniform float colourAt;  // 0..1, or less than 0
uniform vec3 plainColour;
uniform mat4 view, toScreen;
uniform bool occluded;
uniform sampler3D openness;  // on the grid
uniform vec3 origin, spacing;
void main() {
  ivec2 size = textureSize(full, 0), few = textureSize(coarse, 0);
  ivec2 at = min(ivec2((0.5 * place + 0.5) * vec2(size)), size - 1);
  vec4 hit = at.y < fullRows ? texelFetch(full, at, 0)
    : texelFetch(coarse, min(ivec2((0.5 * place + 0.5) * vec2(few)), few - 1), 0);
  if (!(hit.x > 0.0)) discard;  // nothing there, or not traced yet
  vec3 x = eye + hit.x * normalize(rays[0] * place.x + rays[1] * place.y + rays[2]);
  vec3 seen = (view * vec4(x, 1.0)).xyz, towards = dot(hit.yzw, x - eye) > 0.0 ? -hit.yzw : hit.yzw;
  vec3 colour = colourAt < 0.0 ? plainColour : texture(colours, vec2((255.0 * colourAt + 0.5) / 256.0, 0.5)).rgb;
  colour *= light(mat3(view) * towards);
  if (occluded) colour *= occlusion(texture(openness, ((x - origin) / spacing + 0.5) / vec3(textureSize(openness, 0))), towards);
  result = vec4(colour, 1.0);
  vec4 screen = toScreen * vec4(seen, 1.0);
  gl_FragDepth = clamp(0.5 * screen.z / screen.w + 0.5, 0.0, 1.0);
}`;
