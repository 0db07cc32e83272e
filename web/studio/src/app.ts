// The page: what is drawn goes to the library, and what comes back is shown.
import * as THREE from "three";
import { Cancelled, type Lines, type Surface, type SurfacePoint } from "littoral/inline";
import { gradientField, histogram, makeField } from "../../../viewer/src/field";
import { Legend } from "../../../viewer/src/legend";
import { fineOf, numberText } from "../../../viewer/src/numbers";
import { connectControls } from "./controls";
import { element, fillSelect, toClipboard } from "./dom";
import { History, isEmpty, nothing, toSources, type Selection } from "./drawing";
import { Engine, type Answer, type Settings, type Task } from "./engine";
import { Files } from "./files";
import { fillForm, type Chosen } from "./forms";
import { Marks, type Layout } from "./marks";
import { listCurves, showFacts, showWarnings, sizeOf } from "./panel";
import { lineOf, nodeOf } from "./pick";
import { fieldOf, infiniteColour } from "./skin";
import { Stage } from "./stage";
import { Tools, type Mode } from "./tools";

export class App {
  readonly history = new History();
  layout: Layout = { strokes: [], nodes: [], points: [] };
  answer: Answer | null = null;
  /** Milliseconds from the last change of the drawing to the picture of its field. */
  latency = NaN;
  tools!: Tools;
  engine!: Engine;
  readonly files = new Files(this);
  readonly stage: Stage;
  private readonly marks: Marks;
  private readonly legend: Legend;
  settings: { task: Task; method: string; options: Chosen } = { task: "distance", method: "", options: {} };
  private failure: string | null = null;
  private stamp = 0;
  private changedAt = 0;
  private histogram: Float64Array | null = null;
  private toastTimer = 0;

  private constructor() {
    const canvas = element<HTMLCanvasElement>("view");
    this.stage = new Stage(canvas);
    this.marks = new Marks(this.stage.overlay, (place, out) => this.stage.normalAt(place, out));
    this.legend = new Legend(element<HTMLCanvasElement>("legend"));
    this.stage.resized = () => this.drawLegend();
    canvas.addEventListener("webglcontextlost", (event) => {
      event.preventDefault();
      this.message("The browser has taken the graphics context away. It comes back by itself; nothing that was drawn is lost.");
    });
    canvas.addEventListener("webglcontextrestored", () => {
      this.message(null);
      this.usePaper(); // the new context has forgotten it
    });
  }

  static async start(): Promise<App> {
    const app = new App();
    app.tools = new Tools(app.stage, app);
    app.useTheme(window.matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
    app.engine = await Engine.start({
      busy: (stage, fraction) => app.busy(stage, fraction),
      idle: () => app.idle(),
      joined: () => app.showMarks(),
      answer: (answer, stamp) => app.take(answer, stamp),
      failure: (error) => app.failed(error),
    });
    connectControls(app);
    await app.files.begin();
    return app;
  }

  /** A surface without anything drawn on it. */
  begin(surface: Surface): void {
    this.history.reset(nothing);
    this.tools.open = -1;
    this.answer = null;
    this.failure = null;
    this.stage.show(surface);
    showFacts(surface);
    this.listMethods();
    this.drawingChanged();
    element("view").setAttribute("aria-label", `${surface.name}: ${surface.kind}, ${surface.counts.vertices} vertices`);
  }

  // ------------------------------------------------------------------------- drawing

  changed(): void { this.drawingChanged(); }

  selected(): void { this.showMarks(); }

  ended(): void { this.showWarnings(); }

  private drawingChanged(): void {
    this.changedAt = performance.now();
    ++this.stamp;
    this.showMarks();
    const sources = toSources(this.history.drawing);
    if (!isEmpty(sources)) {
      this.engine.request(sources, this.chosen, this.stamp);
      return;
    }
    this.engine.drop();
    this.answer = null;
    this.failure = null;
    this.showAnswer();
    if (!this.engine.busy) this.idle();
  }

  /** Answers what is drawn where that was broken off. */
  goOn(): void {
    if (!this.answer || this.answer.preview) this.drawingChanged();
    else this.idle();
  }

  /** Lines at these distances from what is drawn. */
  offsets(distances: readonly number[]): Promise<Lines> {
    const sources = toSources(this.history.drawing);
    if (isEmpty(sources)) throw new Error("nothing is drawn yet");
    return this.engine.offsets(sources, this.chosen, distances);
  }

  private get chosen(): Settings {
    return { task: this.settings.task, method: { name: this.settings.method, options: this.settings.options } };
  }

  private place(node: SurfacePoint): THREE.Vector3 {
    const surface = this.stage.surface!, { positions } = surface, { centre, radius } = this.stage.frame;
    const out = new THREE.Vector3(), add = (v: number, weight: number) => {
      out.x += weight * positions[3 * v];
      out.y += weight * positions[3 * v + 1];
      out.z += weight * positions[3 * v + 2];
    };
    if ("vertex" in node) add(node.vertex, 1);
    else if ("edge" in node) {
      add(node.edge[0], 1 - node.t);
      add(node.edge[1], node.t);
    } else {
      const first = surface.offsets[node.face];
      node.barycentric.forEach((weight, k) => add(surface.corners[first + k], weight));
    }
    return out.sub(new THREE.Vector3(...centre)).divideScalar(radius);
  }

  private showMarks(): void {
    const { drawing, selection } = this.history, { centre, radius } = this.stage.frame;
    if (!this.stage.surface) return;
    const nodes = drawing.strokes.map((stroke) => stroke.nodes.map((node) => this.place(node)));
    const strokes = drawing.strokes.map((stroke, i) => {
      const known = this.engine.pathOf(stroke.nodes, stroke.closed);
      if (!known) return stroke.closed ? [...nodes[i], nodes[i][0]] : nodes[i];
      return Array.from({ length: known.length / 3 }, (_, k) => new THREE.Vector3(
        (known[3 * k] - centre[0]) / radius, (known[3 * k + 1] - centre[1]) / radius, (known[3 * k + 2] - centre[2]) / radius));
    });
    this.layout = { strokes, nodes, points: drawing.points.map((node) => this.place(node)) };
    this.marks.show(drawing, this.layout, selection);
    listCurves(drawing, selection, (next) => {
      this.history.select(next);
      this.showMarks();
    });
    this.showTools();
    this.stage.ask();
  }

  private showTools(): void {
    const { history, tools } = this, stroke = this.selectedStroke();
    for (const mode of ["turn", "curve", "freehand", "point"]) element(`mode-${mode}`).ariaPressed = String(tools.mode === mode);
    element("snap").ariaPressed = String(tools.snap);
    element("signed").ariaPressed = String(stroke ? stroke.signed : tools.signed);
    const enable = (id: string, on: boolean) => { element<HTMLButtonElement>(id).disabled = !on; };
    enable("undo", history.canUndo);
    enable("redo", history.canRedo);
    enable("close", stroke !== null && stroke.nodes.length > 2);
    enable("reverse", stroke !== null && stroke.nodes.length > 1);
    enable("delete", history.selection !== null);
    element("stage").classList.toggle("drawing", tools.mode !== "turn");
    const hints: Record<Mode, string> = {
      turn: history.drawing.strokes.length || history.drawing.points.length ? "" : "Choose Curve, Draw or Point and draw on the surface, or drop a file.",
      curve: tools.open >= 0 ? "Click on; on the first node to close; Enter ends the curve." : "Click on the surface to begin a curve. Drag beside it to turn.",
      freehand: "Draw along the surface. Drag beside it to turn.",
      point: "Click on the surface: distance to all points.",
    };
    element("hint").textContent = hints[tools.mode];
  }

  selectedStroke() {
    const { drawing, selection } = this.history;
    return selection?.kind === "stroke" ? drawing.strokes[selection.index] ?? null : null;
  }

  setMode(mode: Mode): void {
    this.tools.setMode(mode);
    this.showTools();
  }

  undo(): void {
    this.history.undo();
    this.tools.open = -1;
    this.changed();
  }

  redo(): void {
    this.history.redo();
    this.tools.open = -1;
    this.changed();
  }

  // ------------------------------------------------------------------------- answers

  private busy(stage: string, fraction: number): void {
    const already = this.answer?.preview ? `Preview ${this.previewText()} · ` : "";
    element("status").textContent = `${already}${stage[0]?.toUpperCase() ?? ""}${stage.slice(1)}…`;
    const bar = element<HTMLProgressElement>("progress");
    bar.hidden = element("cancel").hidden = false;
    if (fraction > 0) bar.value = fraction;
    else bar.removeAttribute("value");
  }

  private previewText(): string {
    const metric = this.answer?.report.options["metric"];
    return metric ? `by metric ${metric}` : "of the curves as drawn, not completed yet";
  }

  idle(): void {
    element("progress").hidden = element("cancel").hidden = true;
    const { answer, failure } = this, surface = this.engine?.surface;
    let text = surface ? `${sizeOf(surface)}. Nothing to measure from yet.` : "Nothing open";
    if (failure && !answer) text = "No answer";
    else if (answer) {
      const { report } = answer, warnings = report.warnings.length;
      text = `${report.method}${answer.preview ? `, preview ${this.previewText()}` : ""}: ${report.status}${warnings ? `, ${warnings} warning${warnings > 1 ? "s" : ""}` : ""} · ${(1000 * answer.seconds).toFixed(0)} ms`;
    }
    element("status").textContent = text;
  }

  private take(answer: Answer, stamp: number): void {
    if (isEmpty(toSources(this.history.drawing))) return; // all was taken back meanwhile
    this.answer = answer;
    this.failure = null;
    this.showAnswer();
    if (stamp === this.stamp) {
      const since = this.changedAt;
      this.stage.drawn = () => {
        this.stage.drawn = () => {};
        this.latency = performance.now() - since;
      };
      this.stage.ask();
    }
  }

  private failed(error: Error): void {
    const kept = error instanceof Cancelled && this.answer?.preview === true;
    if (!kept) this.answer = null;
    this.failure = !(error instanceof Cancelled) ? error.message
      : kept ? `Cancelled: what is shown is the preview, ${this.previewText()}.` : "Cancelled: there is no answer to what is drawn.";
    this.showAnswer();
  }

  /** What the picture shows of an answer: the field, or what it says about itself. */
  get shown(): string {
    const { answer } = this, select = element<HTMLSelectElement>("shown"), whole = answer?.field ?? null;
    const has: Record<string, boolean> = { field: true, confidence: whole?.confidence != null, slope: whole !== null && this.engine.surface!.triangles.length > 0 };
    for (const option of select.options) option.disabled = answer !== null && !has[option.value];
    return has[select.value] ? select.value : "field";
  }

  showAnswer(): void {
    const { answer, stage, shown } = this, confidence = answer?.field?.confidence;
    if (answer && shown === "confidence" && confidence) {
      stage.showField({ ...makeField({ name: "confidence", values: confidence }), colourLow: 0, colourHigh: 1 }, null);
    } else {
      const field = answer ? fieldOf(answer.name, answer.values, answer.weights) : null, refined = answer?.refined ?? null;
      stage.showField(field && field.high >= field.low ? field : null, refined);
      if (field && shown === "slope" && stage.skin?.field) stage.showField(gradientField(field, stage.skin.asSurface(), stage.frame.radius), refined);
    }
    this.histogram = null;
    this.drawLegend();
    this.fillSpacing();
    this.showWarnings();
  }

  /** Not in the middle of a stroke: the picture would change its size. */
  showWarnings(): void {
    if (this.tools.drawing) return;
    showWarnings([...(this.engine.surface?.warnings ?? []), ...(this.answer?.report.warnings ?? []).map(({ message }) => message)], this.failure);
  }

  private drawLegend(): void {
    const canvas = element<HTMLCanvasElement>("legend"), skin = this.stage.skin, field = skin?.field;
    canvas.hidden = !field;
    const across = this.stage.width < 620;
    // Room for a legend, whether there is one or not: the picture stays where it is while one draws.
    this.stage.setInsets(across ? 0 : 140, across ? 88 : 0);
    if (!field || !skin) return;
    this.histogram ??= histogram(field, skin.asSurface(), field.discrete ? Math.round(field.high - field.low) + 1 : 48);
    canvas.classList.toggle("across", across);
    this.legend.draw({
      field, map: field.map, colourLow: field.colourLow, colourHigh: field.colourHigh, range: [field.low, field.high],
      histogram: this.histogram, infiniteColour,
    }, { width: this.stage.width, height: this.stage.height }, this.stage.pixelRatio, across);
  }

  /** The value, face and place under the cursor. */
  hover(x: number, y: number): void {
    const readout = element("readout"), hit = this.stage.pick(x, y), surface = this.stage.surface;
    readout.hidden = !hit || !surface;
    if (!hit || !surface) return;
    const value = this.stage.valueAt(x, y), field = this.stage.skin?.field;
    const lines = [lineOf(nodeOf(hit, surface.kind, this.tools.snap))];
    if (value !== null && field) lines.unshift(`${field.name} ${numberText(value, fineOf(field.low, field.high))}`);
    readout.textContent = lines.join("\n");
    const box = this.stage.canvas.getBoundingClientRect();
    readout.style.left = `${Math.max(0, Math.min(x - box.left + 14, box.width - readout.offsetWidth - 6))}px`;
    readout.style.top = `${Math.max(0, Math.min(y - box.top + 14, box.height - readout.offsetHeight - 6))}px`;
  }

  leave(): void { element("readout").hidden = true; }

  copy(line: string): void {
    void toClipboard(line).then((done) => this.toast(done ? `Copied: ${line}` : line));
  }

  toast(text: string): void {
    const box = element("toast");
    box.textContent = text;
    box.hidden = false;
    window.clearTimeout(this.toastTimer);
    this.toastTimer = window.setTimeout(() => { box.hidden = true; }, 3500);
  }

  message(text: string | null): void {
    element("message").hidden = text === null;
    element("message-text").textContent = text ?? "";
  }

  // ------------------------------------------------------------------------- controls

  /** Another task, method or options. */
  use(settings: App["settings"]): void {
    this.settings = settings;
    this.listMethods();
    this.changed();
  }

  private listMethods(): void {
    const methods = this.engine.methods(this.settings.task), select = element<HTMLSelectElement>("method");
    const current = methods.find(({ name }) => name === this.settings.method) ?? methods[0];
    if (!current) return;
    if (current.name !== this.settings.method) this.settings = { ...this.settings, method: current.name, options: {} };
    element<HTMLSelectElement>("task").value = this.settings.task;
    fillSelect(select, methods.map(({ name }) => ({ value: name, text: name })), current.name);
    element("summary").textContent = current.summary;
    element("options-box").hidden = current.options.length === 0;
    fillForm(element<HTMLFormElement>("options"), current.options, this.settings.options, (options) => {
      this.settings = { ...this.settings, options };
      this.changed();
    });
  }

  private fillSpacing(): void {
    const slider = element<HTMLInputElement>("spacing"), { skin } = this.stage, steps = skin?.steps ?? [];
    slider.max = String(Math.max(0, steps.length - 1));
    slider.disabled = !steps.length;
    const wanted = this.stage.spacing || (skin?.field?.spacing ?? 0);
    const at = steps.findIndex((step) => step <= wanted * (1 + 1e-9));
    slider.value = String(at < 0 ? steps.length - 1 : at);
    element("spacing-text").textContent = wanted > 0 && steps.length ? `every ${numberText(wanted)}` : "";
  }

  /** The spacing of the isolines on show [length]; 0: there are none. */
  get spacing(): number {
    const { skin } = this.stage;
    return element<HTMLInputElement>("lines").checked && skin?.field ? this.stage.spacing || skin.field.spacing : 0;
  }

  usePicture(): void {
    this.stage.setLines(element<HTMLInputElement>("lines").checked, this.stage.spacing, element<HTMLInputElement>("wires").checked);
    this.stage.overlay.visible = element<HTMLInputElement>("marks").checked;
    this.stage.ask();
  }

  useTheme(theme: string): void {
    document.documentElement.dataset.theme = theme;
    this.usePaper();
    if (this.answer) this.drawLegend();
  }

  private usePaper(): void {
    this.stage.usePaper(getComputedStyle(document.documentElement).getPropertyValue("--paper").trim());
  }

  select(selection: Selection | null): void {
    this.history.select(selection);
    this.showMarks();
  }
}
