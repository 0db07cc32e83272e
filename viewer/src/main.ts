// The page: reads the scene, shows it, and connects the controls.
import { Address } from "./address";
import { colourMap } from "./colours";
import { Controls } from "./controls";
import { isolineSvg, surfaceObj } from "./drawings";
import { download, element, fillTable, input, say } from "./elements";
import { fineOf, numberText } from "./numbers";
import { Readout } from "./readout";
import { readScene, SceneError, type SceneData } from "./scene";
import { ResultView, ViewError } from "./view";
import { connectVolume } from "./volume-controls";

function fail(text: string): void {
  document.documentElement.dataset.theme ??= window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light";
  element("message").textContent = text;
  element("message").hidden = false;
}

function describe(scene: SceneData): string {
  const field = scene.fields[0], what: string[] = [];
  if (scene.trace) what.push(`${scene.trace.clouds.reduce((sum, cloud) => sum + cloud.tori.length / 16, 0)} points`);
  what.push(scene.volume ? `volume of ${scene.volume.n.join(" x ")} nodes` : `${scene.surface.triangles.length / 3} triangles`);
  if (field && (field.values || scene.volume)) {
    const [low, high] = [field.low, field.high].map((x) => numberText(x, fineOf(field.low, field.high)));
    what.push(`${field.name} from ${low} to ${high}`);
  }
  return `${scene.title || "Surface"}: ${what.join(", ")}`;
}

function showFacts(scene: SceneData): void {
  const parts = scene.beside ? [scene, scene.beside] : [scene];
  element("title").textContent = parts.map((part) => part.title || "littoral").join(" | ");
  // What went wrong comes first.
  const warnings = [...new Set(parts.flatMap((part) => part.warnings))];
  element("warnings").append(...warnings.map((text) => Object.assign(document.createElement("li"), { textContent: text })));
  element("warnings").hidden = warnings.length === 0;
  for (const part of parts) {
    fillTable(element<HTMLTableElement>("facts"), part.facts);
    fillTable(element<HTMLTableElement>("options"), part.options);
  }
  element("facts-box").hidden = parts.every((part) => part.facts.length === 0);
  element("options-box").hidden = parts.every((part) => part.options.length === 0);
  element("panel").hidden = false;
  element("view").setAttribute("aria-label", parts.map(describe).join("; beside "));
  if (scene.beside) {
    element("names").append(...parts.map((part) => Object.assign(document.createElement("span"), { textContent: part.title })));
    element("names").hidden = false;
  }
}

function start(scene: SceneData, began: number): void {
  const read = performance.now(), canvas = element<HTMLCanvasElement>("view"), stage = element("stage");
  const view = new ResultView(canvas, scene), address = new Address(location.hash);
  const ratio = () => Math.min(window.devicePixelRatio || 1, 2);
  const size = () => `${stage.clientWidth} ${stage.clientHeight} ${ratio()}`;
  let moved = address.get("camera") !== null, ready = false, fitted = "";

  function fit(): void {
    if (!ready) return;
    fitted = size();
    const insets = controls.drawLegend();
    view.setSize({ width: stage.clientWidth, height: stage.clientHeight, insets, pixelRatio: ratio() });
    if (!moved) view.orbit.reset();
  }
  const controls = new Controls(view, address, fit), readout = new Readout(view, stage);
  const first = view.panes[0].volume, volume = first && connectVolume(view, first, address);
  let firstFrame = 0, cameraTimer = 0, camera = "", inSight = "";

  view.onFrame = () => {
    firstFrame ||= performance.now();
    volume?.place();
    readout.update();
    const now = view.orbit.toText();
    if (now !== camera) {
      camera = now;
      window.clearTimeout(cameraTimer);
      if (moved) cameraTimer = window.setTimeout(() => address.set("camera", camera), 300);
    }
    const lines = [now, fitted, ...view.panes.map((pane) => pane.cuts)].join(" ");
    if (lines !== inSight) {
      inSight = lines;
      controls.afterFrame();
    }
    hint();
  };
  // What is not finished yet says so.
  function hint(): void {
    const pane = view.panes.find((one) => one.tracer?.mesh.visible && !one.tracer.settled), working = view.panes.some((one) => one.volume?.working);
    const progress = pane?.tracer?.progress ?? 1;
    const shading = view.panes.some((one) => one.volume?.shadingNow);
    element("hint").textContent = pane ? `Tracing the cloud … ${Math.floor(100 * progress)} %` : shading ? "Shading corners …" : "Making the surface …";
    element("hint").hidden = !pane && !working;
  }
  view.orbit.controls.addEventListener("start", () => { moved = true; });
  const moving = (act: () => void) => () => {
    moved = true;
    act();
  };
  function reset(): void {
    moved = false;
    address.set("camera", null);
    view.orbit.reset();
  }
  const fold = () => {
    const folded = element("app").classList.toggle("folded");
    element("fold").setAttribute("aria-expanded", String(!folded));
    address.set("panel", folded ? 0 : null);
  };

  const fileName = (extension: string) => `${(scene.title || "littoral").replace(/[^\w.-]+/g, "_")}.${extension}`;
  function savePicture(): void {
    const side = (id: string, otherwise: number) => Math.round(Math.min(8192, Math.max(16, Number(input(id).value) || otherwise)));
    const width = side("save-width", stage.clientWidth * ratio()), height = side("save-height", stage.clientHeight * ratio());
    const insets = controls.drawLegend(), scale = height / Math.max(1, stage.clientHeight);
    const out = view.picture(width, height, insets, (context) => {
      controls.drawNumbers(context, width, scale);
      for (const legend of controls.legends) {
        const w = legend.offsetWidth * scale, h = legend.offsetHeight * scale, stretch = width / stage.clientWidth;
        if (legend.classList.contains("across"))
          context.drawImage(legend, stretch * legend.offsetLeft, height - h, stretch * legend.offsetWidth, h);
        else context.drawImage(legend, width - w - 12 * scale, (height - h) / 2, w, h);
      }
    });
    fit();
    out.toBlob((blob) => {
      if (!blob) return say("The picture is too large for this browser");
      download(fileName("png"), blob);
      say("Picture saved");
    });
  }
  element("reset").addEventListener("click", reset);
  element("save").addEventListener("click", savePicture);
  element("fold").addEventListener("click", fold);
  element("save-svg").addEventListener("click", () => {
    const svg = isolineSvg(view, 0, { width: stage.clientWidth / view.panes.length, height: stage.clientHeight }, { spacing: controls.spacing, ink: "#111", paper: "#fff" });
    download(fileName("svg"), new Blob([svg], { type: "image/svg+xml" }));
    view.ask();
  });
  element("save-obj").addEventListener("click", () => download(fileName("obj"), new Blob([surfaceObj(view.panes[0])], { type: "text/plain" })));
  input("save-width").placeholder = String(Math.round(stage.clientWidth * ratio()));
  input("save-height").placeholder = String(Math.round(stage.clientHeight * ratio()));

  const { orbit } = view, centre = () => [stage.clientWidth / (2 * view.panes.length), stage.clientHeight / 2] as const;
  const arrows = (across: number, upward: number) => (shift: boolean) =>
    moving(() => (shift ? orbit.move(0.03 * across, 0.03 * upward) : orbit.turn(0.12 * across, 0.12 * upward)))();
  const keys: Record<string, (shift: boolean) => void> = {
    ArrowLeft: arrows(-1, 0), ArrowRight: arrows(1, 0), ArrowUp: arrows(0, 1), ArrowDown: arrows(0, -1),
    "+": moving(() => orbit.zoom(0.87)), "=": moving(() => orbit.zoom(0.87)), "-": moving(() => orbit.zoom(1.15)),
    r: reset, s: savePicture, p: fold,
    i: () => controls.toggle("isolines"), n: () => controls.toggle("labels"), o: () => controls.toggle("sources"),
    w: () => controls.toggle("wireframe"), f: () => controls.nextShading(), d: () => controls.toggle("discs"), g: () => controls.toggle("path"), c: () => { if (volume) controls.toggle("cut"); },
    v: () => {
      const picked = view.pick(...centre());
      say(picked ? `${readout.describe(picked)} at the centre` : "No surface at the centre");
    },
    Enter: () => readout.pinAt(...centre()), Escape: () => readout.unpin(),
  };
  canvas.addEventListener("keydown", (event) => {
    const act = keys[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act(event.shiftKey);
  });

  new ResizeObserver(() => {
    if (size() !== fitted) fit();  // it also calls when it begins: a frame less of a large surface
  }).observe(stage);
  canvas.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    view.setLost(true);
    fail("The browser has taken the graphics context away; it comes back by itself or on reload.");
  });
  canvas.addEventListener("webglcontextrestored", () => {
    element("message").hidden = true;
    view.setLost(false);
  });

  if (address.number("panel") === 0) fold();
  controls.start();
  ready = true;
  fit();
  const built = performance.now(), written = address.get("camera");
  if (!written || !orbit.fromText(written)) {
    moved = false;
    orbit.reset();
  }

  // For tests: what the page holds, where a vertex is on the screen, and what is shown there.
  Object.assign(window, {
    littoral: {
      view, controls, colourMap,
      volume: view.panes[0].volume,
      tracer: view.panes[0].tracer,
      settled: () => !view.waiting && view.panes.every((pane) => (!pane.tracer?.mesh.visible || pane.tracer.settled) && !pane.volume?.working),
      frames: () => view.frames,
      times: () => ({ began, read, built, firstFrame }),
      pick: (x: number, y: number) => view.pick(x, y),
      readout,
      written: () => controls.written,
      way: () => readout.way,
      project: (vertex: number) => view.project(scene.surface.positions.subarray(3 * vertex, 3 * vertex + 3)),
      pixels() {
        view.render();
        const gl = view.renderer.getContext();
        const bytes = new Uint8Array(4 * gl.drawingBufferWidth * gl.drawingBufferHeight);
        gl.readPixels(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight, gl.RGBA, gl.UNSIGNED_BYTE, bytes);
        return bytes;
      },
    },
  });
}

try {
  const began = performance.now(), text = element("scene").textContent ?? "";
  element("scene").remove();  // the text is as large as the arrays
  const scene = readScene(text);
  showFacts(scene);
  start(scene, began);
} catch (error) {
  const known = error instanceof SceneError || error instanceof ViewError, message = error instanceof Error ? error.message : String(error);
  fail(known ? message : `The page cannot be shown: ${message}`);
  if (!known) throw error;
}
