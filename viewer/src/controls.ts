// The panel's controls of what every result has: field, colours, lines, range, what is shown, theme.
import type { Address } from "./address";
import { mapNames } from "./colours";
import { drawNumbers } from "./drawings";
import { element, fillSelect, input, say, select } from "./elements";
import { Legend } from "./legend";
import { commonField } from "./field";
import { between, fineOf, numberText, spacings } from "./numbers";
import type { Insets } from "./camera";
import { shadings, type Field, type Shading } from "./scene";
import type { Pane } from "./pane";
import type { ResultView } from "./view";

export class Controls {
  readonly legend = new Legend(element<HTMLCanvasElement>("legend"));
  /** Of a pane with another field. */
  private readonly legendBeside = new Legend(element<HTMLCanvasElement>("legend-beside"));
  spacing = 0;
  private merged: Field | null = null;  // the range of the panes that show the field
  private same: Pane[] = [];            // those
  private steps: number[] = [];
  private map = "";
  private range: [number, number] = [0, 0];
  private histogram: Float64Array | null = null;
  private histogramBeside: Float64Array | null = null;
  private numbersTimer = 0;
  private readonly numbers = element<HTMLCanvasElement>("numbers");

  constructor(private readonly view: ResultView, private readonly address: Address, private readonly fit: () => void) {
    const names = view.panes[0].choices.map((choice) => choice.name);
    fillSelect(select("field"), names);
    element("field-row").hidden = names.length < 2;
    fillSelect(select("map"), mapNames);
    select("field").addEventListener("change", () => this.useField(true));
    select("map").addEventListener("change", () => {
      this.map = select("map").value;
      address.set("map", this.map === this.merged?.map ? null : this.map);
      this.useColours();
    });
    input("spacing").addEventListener("input", () => {
      this.spacing = this.steps[Number(input("spacing").value)] ?? 0;
      address.set("spacing", this.spacing);
      this.useLines();
    });
    for (const [id, act] of Object.entries(this.toggles)) {
      const written = address.number(id);
      if (written !== null) input(id).checked = written === 1;
      const initially = input(id).defaultChecked;
      input(id).addEventListener("change", () => {
        const usual = id !== "isolines" && input(id).checked === initially;
        address.set(id, usual ? null : input(id).checked ? 1 : 0);
        act();
      });
    }
    this.legend.onRange = (low, high) => this.useRange(low, high, true);
    (["low", "high"] as const).forEach((end, i) => {
      const box = input(`range-${end}`);
      box.addEventListener("change", () => {
        const x = Number(box.value.replace(",", ".")), range: [number, number] = [...this.range];
        range[i] = box.value.trim() !== "" && Number.isFinite(x) ? x : this.merged?.[end] ?? 0;
        this.useRange(...range, true);
      });
    });
    const shading = select("shading"), asked = address.get("shading") ?? view.scene.shading;
    const open = view.panes.some((pane) => pane.hasOcclusion);
    fillSelect(shading, shadings.filter((name) => name !== "occluded" || open));
    shading.value = Array.from(shading.options).some((option) => option.value === asked) ? asked : "smooth";
    shading.addEventListener("change", () => {
      address.set("shading", shading.value === view.scene.shading ? null : shading.value);
      this.useShown();
    });
    element("discs-row").hidden = view.panes.every((pane) => !pane.scene.surface.discs);
    element("wireframe-row").hidden = view.panes.every((pane) => !pane.surface);
    element("sources-row").hidden = view.panes.every((pane) => pane.sources.children.length === 0);
    const theme = select("theme"), dark = window.matchMedia("(prefers-color-scheme: dark)");
    theme.value = address.get("theme") ?? "";
    if (!["", "light", "dark"].includes(theme.value)) theme.value = "";
    theme.addEventListener("change", () => {
      address.set("theme", theme.value || null);
      this.useTheme();
    });
    dark.addEventListener("change", () => this.useTheme());
  }

  private readonly toggles: Record<string, () => void> = {
    isolines: () => this.useLines(),
    labels: () => this.useLines(),
    sources: () => this.useShown(),
    wireframe: () => this.useShown(),
    discs: () => this.useShown(),
    path: () => this.view.ask(),
  };

  /** Turns a check box over, as a key does. */
  toggle(id: string): void {
    const box = input(id);
    if (box.closest("[hidden]") || box.disabled) return;
    box.click();
    say(`${box.parentElement?.textContent?.trim() ?? id} ${box.checked ? "shown" : "hidden"}`);
  }

  /** The next kind of shading, as a key does. */
  nextShading(): void {
    const shading = select("shading");
    shading.selectedIndex = (shading.selectedIndex + 1) % shading.options.length;
    shading.dispatchEvent(new Event("change"));
    say(`Shading ${shading.value}`);
  }

  start(): void {
    const name = this.address.get("field"), index = this.view.panes[0].choices.findIndex((choice) => choice.name === name);
    if (index > 0) select("field").selectedIndex = index;
    const written = { map: this.address.get("map"), spacing: this.address.number("spacing"), range: this.address.get("range") };
    this.useField(false);
    if (written.map && mapNames.includes(written.map)) {
      this.map = select("map").value = written.map;
      this.useColours();
    }
    if (written.spacing !== null && this.steps.length) {
      const near = this.steps.reduce((best, step, i) => (Math.abs(step - (written.spacing ?? 0)) < Math.abs(this.steps[best] - (written.spacing ?? 0)) ? i : best), 0);
      input("spacing").value = String(near);
      this.spacing = this.steps[near];
      this.useLines();
    }
    const range = written.range?.split(",").map(Number);
    if (range?.length === 2 && range.every(Number.isFinite)) this.useRange(range[0], range[1], true);
    this.useShown();
    this.useTheme();
  }

  private useField(write: boolean): void {
    const index = Math.max(0, select("field").selectedIndex), name = this.view.panes[0].choices[index]?.name;
    // A pane without such a field, as beside a difference, keeps its first one with colours of its own.
    this.same = this.view.panes.filter((pane, i) => {
      const own = i === 0 ? index : pane.choices.findIndex((choice) => choice.name === name);
      pane.setField(Math.max(0, own));
      return own >= 0 || pane.choices.length === 0;
    });
    const fields = this.same.map((pane) => pane.field).filter((field): field is Field => field !== null && field.high >= field.low);
    if (write) {
      this.address.set("field", index === 0 ? null : name ?? null);
      for (const key of ["map", "spacing", "range"]) this.address.set(key, null);
    }
    this.merged = commonField(fields);
    const field = this.merged, varies = field !== null && field.high > field.low && !field.discrete;
    element("legend").hidden = field === null;
    element("path-row").hidden = this.view.panes.every((pane) => !pane.hasWays);
    element("map-row").hidden = element("range-row").hidden = !varies;
    element("isolines-row").hidden = !varies || field.at === "face";
    element("labels-row").hidden = element("isolines-row").hidden;
    const other = this.beside, shares = (pane: Pane, { discrete, low, high }: Field) =>
      pane.histogram(discrete ? Math.round(high - low) + 1 : 48, low, high);
    element("legend-beside").hidden = other === null;
    this.histogramBeside = other?.field ? shares(other, other.field) : null;
    if (!field) return this.fit();
    this.histogram = shares(this.view.panes[0], field);
    this.map = select("map").value = field.map;
    this.steps = field.levels.length ? [] : spacings(field.low, field.high);
    input("spacing").hidden = element("spacing-text").hidden = this.steps.length === 0;
    input("spacing").max = String(Math.max(0, this.steps.length - 1));
    const near = this.steps.findIndex((step) => step <= field.spacing * (1 + 1e-9));
    input("spacing").value = String(Math.max(0, near));
    this.spacing = this.steps[Math.max(0, near)] ?? 0;
    const written = this.address.number("isolines");  // what was asked for, or what suits the field
    input("isolines").checked = written === null ? field.spacing > 0 || field.levels.length > 0 : written === 1;
    this.useRange(field.low, field.high, false);
    this.useColours();
    this.useLines();
    this.fit();
  }

  /** A pane whose field is another one, with colours of its own. */
  private get beside(): Pane | null {
    return this.view.panes.find((pane) => pane.field !== null && !this.same.includes(pane)) ?? null;
  }

  /** Values at the ends of the colours; of two hues that are chosen, as far on both sides of 0. */
  private colourEnds({ map, low, high, colourLow, colourHigh }: Field): [number, number] {
    const reach = Math.max(Math.abs(low), Math.abs(high));
    return this.map === "diverging" && map !== "diverging" ? [-reach, reach] : [colourLow, colourHigh];
  }

  private useColours(): void {
    const field = this.merged;
    if (!field) return;
    for (const pane of this.same) {
      pane.look.setColours(this.map, ...this.colourEnds(field));
      pane.volume?.tracer?.recolour(pane.volume.level);
    }
    this.drawLegend();
    this.view.ask();
  }

  private useLines(): void {
    const shown = input("isolines").checked;
    for (const pane of this.same) {
      pane.look.setSpacing(this.steps.length ? this.spacing : 0);
    }
    for (const pane of this.view.panes) pane.look.uniforms.showLines.value = shown;
    input("spacing").disabled = input("labels").disabled = !shown;
    element("spacing-text").textContent = this.spacing > 0 && shown ? `every ${numberText(this.spacing)}` : "";
    input("spacing").setAttribute("aria-valuetext", `one line every ${numberText(this.spacing)}`);
    this.view.ask();
    this.afterFrame();
  }

  private useRange(low: number, high: number, write: boolean): void {
    const field = this.merged;
    if (!field) return;
    // What an address or a box has rounded is the end itself.
    const near = 1e-6 * (field.high - field.low);
    const inside = (x: number) => (x <= field.low + near ? field.low : x >= field.high - near ? field.high : x);
    const some = low <= high && low <= field.high && high >= field.low;
    this.range = some ? [inside(low), inside(high)] : [field.low, field.high];
    for (const pane of this.same) pane.look.setRange(...this.range);
    const fine = fineOf(field.low, field.high);
    ["range-low", "range-high"].forEach((id, i) => {
      const box = input(id), text = numberText(this.range[i], fine);
      box.value = text;
      const narrow = text.replace(/[^.-]/g, "").length;
      box.style.setProperty("--letters", String(Math.max(5, text.length - 0.5 * narrow)));
    });
    const whole = this.range[0] === field.low && this.range[1] === field.high;
    const texts = this.range.map((x) => Number(numberText(x, 0.01 * fine)));
    if (write) this.address.set("range", whole ? null : texts.join(","));
    this.drawLegend();
    this.view.ask();
  }

  private useShown(): void {
    for (const pane of this.view.panes) {
      pane.sources.visible = input("sources").checked;
      pane.showWires(input("wireframe").checked);
      pane.setShading(select("shading").value as Shading);
      pane.surface?.showDiscs(input("discs").checked);
    }
    this.view.ask();
  }

  private useTheme(): void {
    const dark = select("theme").value ? select("theme").value === "dark" : window.matchMedia("(prefers-color-scheme: dark)").matches;
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    this.view.setPaper(getComputedStyle(document.documentElement).getPropertyValue("--paper").trim());
    this.drawLegend();
  }

  /** Draws the legend and says how much of the stage it covers. */
  drawLegend(): Insets {
    const canvas = this.legend.canvas, stage = element("stage");
    const across = window.matchMedia("(max-width: 700px)").matches || this.view.panes.length > 1;
    canvas.classList.toggle("across", across);
    const other = this.beside, { infiniteColour } = this.view.scene;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const size = { width: stage.clientWidth / (other ? 2 : 1), height: stage.clientHeight };
    if (other?.field) {
      const { field } = other, { map, colourLow, colourHigh } = field;
      this.legendBeside.draw({
        field, map, colourLow, colourHigh, infiniteColour,
        range: [field.low, field.high], fixed: true, histogram: this.histogramBeside,
      }, size, ratio, true);
    }
    if (this.merged && !canvas.hidden) {
      const field = this.merged, [colourLow, colourHigh] = this.colourEnds(field);
      this.legend.draw({
        field, map: this.map || field.map, colourLow, colourHigh, infiniteColour,
        range: this.range, histogram: this.histogram,
      }, size, ratio, across);
    }
    const bottom = Math.max(...this.legends.map((one) => one.offsetHeight), 0);
    return across ? { right: 0, bottom } : { right: canvas.hidden ? 0 : canvas.offsetWidth + 20, bottom: 0 };
  }

  /** Those that are shown. */
  get legends(): HTMLCanvasElement[] {
    return [this.legend.canvas, this.legendBeside.canvas].filter((canvas) => !canvas.hidden);
  }

  private get numbersWanted(): boolean {
    return input("labels").checked && input("isolines").checked && !element("labels-row").hidden;
  }

  /** Numbers on lines: gone while what is in sight changes, there once it rests. */
  afterFrame(): void {
    window.clearTimeout(this.numbersTimer);
    if (this.numbers.width > 1) this.numbers.width = 1;
    this.written = 0;
    if (this.numbersWanted) this.numbersTimer = window.setTimeout(() => this.writeNumbers(), 120);
  }

  /** How many numbers are on lines now. */
  written = 0;

  private writeNumbers(): void {
    const { clientWidth, clientHeight } = element("stage"), ratio = Math.min(window.devicePixelRatio || 1, 2);
    this.numbers.width = Math.round(clientWidth * ratio);
    this.numbers.height = Math.round(clientHeight * ratio);
    const context = this.numbers.getContext("2d");
    if (!context) return;
    context.scale(ratio, ratio);
    this.written = this.drawNumbers(context, clientWidth, 1);
  }

  /** The numbers on lines of a picture of that width, if they are wanted; returns how many. */
  drawNumbers(context: CanvasRenderingContext2D, width: number, scale: number): number {
    if (!this.numbersWanted) return 0;
    return this.view.panes.reduce((sum, pane, i) => {
      const spacing = this.same.includes(pane) ? this.spacing : pane.field?.spacing ?? 0;
      return sum + drawNumbers(context, this.view, i, (i * width) / this.view.panes.length, { spacing, scale });
    }, 0);
  }

  /** The value of the field at a part of its range, for tests and saving. */
  valueAt(t: number): number {
    return this.merged ? between(this.merged.low, this.merged.high, t) : NaN;
  }
}
