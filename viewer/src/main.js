import * as THREE from "three";
import { makeCamera } from "./camera.js";
import { numberText, readScene, valueOf } from "./data.js";
import { drawLegend } from "./legend.js";
import { makeSources } from "./sources.js";
import { makeLook, makeSurface } from "./surface.js";
import { makeTracer } from "./tracer.js";
import { makeVolume } from "./volume.js";
import { connectVolume } from "./volume-controls.js";

const element = (id) => document.getElementById(id);

function fail(text) {
  element("message").textContent = text;
  element("message").hidden = false;
}

function makeRenderer(canvas) {
  const context = canvas.getContext("webgl2", { antialias: true, alpha: false, powerPreference: "high-performance" });
  return context && new THREE.WebGLRenderer({ canvas, context, antialias: true });
}

function showFacts(scene) {
  element("title").textContent = scene.title || "littoral";
  for (const [key, value] of scene.facts) {
    const row = element("facts").insertRow();
    const head = document.createElement("th");
    head.scope = "row";
    head.textContent = key;
    row.append(head);
    row.insertCell().textContent = value;
  }
  element("panel").hidden = false;
  element("view").setAttribute("aria-label",
    `${scene.title || "Surface"}: ` +
    (scene.trace ? `${scene.trace.tori.length / 16} points, ` : "") +
    (scene.volume ? `volume of ${scene.volume.n.join(" x ")} nodes` : `${scene.triangles.length / 3} triangles`) +
    (scene.values || scene.volume ? `, ${scene.field.name} from ${numberText(scene.field.low)} to ${numberText(scene.field.high)}` : ""));
}

function start() {
  const canvas = element("view");
  const scene = readScene();
  showFacts(scene);
  const renderer = makeRenderer(canvas);
  if (!renderer) {
    fail("This browser does not offer WebGL 2, which the view needs. Turn on hardware acceleration or try another browser.");
    return;
  }
  const { field } = scene;
  const hasField = scene.values !== null || scene.volume !== undefined;
  const look = makeLook(scene);
  const tracer = scene.trace ? makeTracer(scene, renderer, look) : null;
  const surface = scene.volume ? makeVolume(scene, look, tracer) : makeSurface(scene, look);
  const sources = makeSources(scene.sources);
  const world = new THREE.Scene();
  world.add(surface.mesh, sources);
  let wires = null;

  // Rendering on demand: whatever changes the picture asks for one frame.
  let asked = false, frames = 0, pointer = null;
  const ask = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      draw();
    });
  };
  const { camera, controls, reset, turn, move, zoom } = makeCamera(canvas, scene, ask);
  const lamp = new THREE.DirectionalLight(0xffffff, 2.2);
  lamp.position.set(-0.25, 0.35, 1);
  camera.add(lamp, lamp.target);
  world.add(camera, new THREE.AmbientLight(0xffffff, 1));

  const size = new THREE.Vector2();
  function draw() {
    const more = tracer?.mesh.visible && tracer.prepare(camera);
    renderer.render(world, camera);
    ++frames;
    if (more) ask();
    showValue();
  }

  function fit() {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    renderer.setPixelRatio(ratio);
    renderer.setSize(canvas.parentElement.clientWidth, canvas.parentElement.clientHeight, false);
    renderer.getSize(size);
    surface.uniforms.pixelRatio.value = ratio;
    camera.aspect = size.x / Math.max(1, size.y);
    camera.updateProjectionMatrix();
    if (hasField) drawLegend(element("legend"), scene, ratio);
    ask();
  }

  // The value under the cursor: one pixel of the surface, drawn with its value as colour.
  const target = new THREE.WebGLRenderTarget(1, 1);
  const pixel = new Uint8Array(4), clear = new THREE.Color();
  function pick(x, y) {
    const ratio = renderer.getPixelRatio();
    camera.setViewOffset(size.x * ratio, size.y * ratio, x * ratio - 0.5, y * ratio - 0.5, 1, 1);
    renderer.getClearColor(clear);
    const shown = [sources.visible, wires?.visible];
    const traced = tracer?.mesh.visible;
    if (traced) tracer.mesh.visible = false;
    sources.visible = false;
    if (wires) wires.visible = false;
    world.overrideMaterial = surface.pickMaterial;
    renderer.setRenderTarget(target);
    renderer.setClearColor(0, 0);
    renderer.clear();
    renderer.render(world, camera);
    renderer.readRenderTargetPixels(target, 0, 0, 1, 1, pixel);
    renderer.setRenderTarget(null);
    renderer.setClearColor(clear, 1);
    world.overrideMaterial = null;
    sources.visible = shown[0];
    if (wires) wires.visible = shown[1];
    camera.clearViewOffset();
    if (traced) {
      tracer.mesh.visible = true;
      const at = [(2 * x) / size.x - 1, 1 - (2 * y) / size.y], t = tracer.depthAt(camera, ...at);
      if (t >= 0 && (pixel[3] === 0 || t < surface.sliceDepth(camera, ...at))) return valueOf(field, surface.state.level);
    }
    if (pixel[3] === 0) return null;
    if (pixel[3] < 200) return Infinity;
    return valueOf(field, (65536 * pixel[0] + 256 * pixel[1] + pixel[2]) / 16777215);
  }

  const readout = element("readout");
  function showValue() {
    const value = pointer && hasField ? pick(pointer.x, pointer.y) : null;
    readout.hidden = value === null;
    if (value === null) return;
    readout.textContent = `${field.name} ${numberText(value)}`;
    readout.style.left = `${Math.min(pointer.x, size.x - readout.offsetWidth - 20)}px`;
    readout.style.top = `${Math.min(pointer.y, size.y - 44)}px`;
  }
  canvas.addEventListener("pointermove", (event) => {
    const box = canvas.getBoundingClientRect();
    pointer = event.buttons ? null : { x: event.clientX - box.left, y: event.clientY - box.top };
    if (!asked) requestAnimationFrame(() => asked || showValue());
  });
  canvas.addEventListener("pointerleave", () => {
    pointer = null;
    readout.hidden = true;
  });

  const say = (text) => { element("status").textContent = text; };
  function useSpacing() {
    const step = field.spacings[Number(element("spacing").value)] ?? 0;
    surface.setSpacing(step);
    element("spacing-text").textContent = step > 0 ? `every ${numberText(step)}` : "";
    element("spacing").setAttribute("aria-valuetext", `one line every ${numberText(step)}`);
    ask();
  }
  function useToggles() {
    surface.uniforms.showLines.value = element("isolines").checked;
    element("spacing").disabled = !element("isolines").checked;
    sources.visible = element("sources").checked;
    if (element("wireframe").checked && !wires) {
      wires = surface.makeWires(0x10141c);
      world.add(wires);
    }
    if (wires) wires.visible = element("wireframe").checked;
    ask();
  }
  function toggle(id) {
    const box = element(id);
    if (box.closest("[hidden]")) return;
    box.checked = !box.checked;
    say(`${box.parentElement.textContent.trim()} ${box.checked ? "shown" : "hidden"}`);
    useToggles();
  }
  for (const id of ["isolines", "sources", "wireframe"]) element(id).addEventListener("change", useToggles);
  element("spacing").addEventListener("input", useSpacing);
  element("isolines-row").hidden = !hasField || !(field.high > field.low);
  element("spacing-row").hidden = element("isolines-row").hidden || field.levels.length > 0;
  element("wireframe-row").hidden = scene.volume !== undefined;
  if (scene.volume) connectVolume(surface, scene, ask);
  element("sources-row").hidden = sources.children.length === 0;
  element("legend").hidden = !hasField;
  element("spacing").max = String(Math.max(0, field.spacings.length - 1));
  const first = field.spacings.findIndex((step) => step <= field.spacing * (1 + 1e-9));
  element("spacing").value = String(Math.max(0, first));
  if (field.levels.length === 0) {
    if (field.spacing === 0) element("isolines").checked = false;
    useSpacing();
  }

  function save() {
    renderer.render(world, camera);
    const out = document.createElement("canvas");
    out.width = canvas.width;
    out.height = canvas.height;
    const context = out.getContext("2d");
    context.drawImage(canvas, 0, 0);
    const legend = element("legend");
    if (!legend.hidden) context.drawImage(legend, out.width - legend.width - 20, (out.height - legend.height) / 2);
    out.toBlob((blob) => {
      const link = document.createElement("a");
      link.href = URL.createObjectURL(blob);
      link.download = `${(scene.title || "littoral").replace(/[^\w.-]+/g, "_")}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
      say("Picture saved");
    });
  }
  element("reset").addEventListener("click", reset);
  element("save").addEventListener("click", save);

  const keys = {
    ArrowLeft: (shift) => (shift ? move(-0.03, 0) : turn(-0.12, 0)),
    ArrowRight: (shift) => (shift ? move(0.03, 0) : turn(0.12, 0)),
    ArrowUp: (shift) => (shift ? move(0, 0.03) : turn(0, 0.12)),
    ArrowDown: (shift) => (shift ? move(0, -0.03) : turn(0, -0.12)),
    "+": () => zoom(0.87), "=": () => zoom(0.87), "-": () => zoom(1.15),
    r: reset, s: save,
    i: () => toggle("isolines"), o: () => toggle("sources"), w: () => toggle("wireframe"), c: () => scene.volume && element("cut").click(),
    v: () => {
      const value = hasField ? pick(size.x / 2, size.y / 2) : null;
      say(value === null ? "No surface at the centre" : `${field.name} ${numberText(value)} at the centre`);
    },
  };
  canvas.addEventListener("keydown", (event) => {
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act(event.shiftKey);
  });

  function useColours() {
    renderer.setClearColor(getComputedStyle(document.documentElement).getPropertyValue("--paper").trim(), 1);
    fit();
  }
  window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", useColours);
  new ResizeObserver(fit).observe(canvas.parentElement);
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    fail("The browser has taken the graphics context away; it comes back by itself or on reload.");
  });
  canvas.addEventListener("webglcontextrestored", () => {
    element("message").hidden = true;
    ask();
  });

  element("controls").hidden = false;
  renderer.setClearColor(0xffffff, 1);
  useColours();
  useToggles();
  reset();

  // For tests: where a vertex is on the screen, and what the page shows there.
  window.littoral = {
    volume: scene.volume && surface,
    tracer,
    settled: () => !asked && (!tracer || tracer.settled()),
    frames: () => frames,
    pick,
    project(vertex) {
      const p = new THREE.Vector3().fromArray(scene.positions, 3 * vertex).project(camera);
      return { x: ((p.x + 1) / 2) * size.x, y: ((1 - p.y) / 2) * size.y, depth: p.z };
    },
    pixels() {
      renderer.render(world, camera);
      const gl = renderer.getContext();
      const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
      gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
      return bytes;
    },
  };
}

try {
  start();
} catch (error) {
  fail(`The page cannot be shown: ${error.message}`);
  throw error;
}
