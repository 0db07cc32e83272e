// The colour bar with numbers and a histogram, or a list of colours, of regions or of the one value there is; drawn on
// a canvas so that saved pictures can carry it. Dragging along the bar keeps a range of values.
import { colourMap, css, middleOf, placeInMap, regionColour } from "./colours";
import { fineOf, niceSpacing, niceTicks, numberText } from "./numbers";
import type { Field } from "./scene";

export interface LegendState {
  field: Field;
  map: string;
  colourLow: number;
  colourHigh: number;
  /** The values kept. */
  range: [number, number];
  /** Shares of the area in equal parts from low to high, or null. */
  histogram: Float64Array | null;
  infiniteColour: ArrayLike<number>;
  /** Without handles: the range cannot be dragged. */
  fixed?: boolean;
}

/** A colour and what it stands for. */
interface Row {
  label: string;
  colour: string;
}

const pad = 12, bar = 18, most = 24;
const font = '13px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';

export class Legend {
  private state: LegendState | null = null;
  private across = false;  // along the lower edge instead of at the right
  private along = { from: 0, length: 1 };  // the bar, CSS pixels
  private dragging: "low" | "high" | null = null;
  onRange: (low: number, high: number) => void = () => undefined;

  constructor(readonly canvas: HTMLCanvasElement) {
    canvas.addEventListener("pointerdown", (event) => {
      const value = this.valueOf(event);
      if (value === null || !this.state) return;
      const { range } = this.state;
      this.dragging = Math.abs(value - range[0]) <= Math.abs(value - range[1]) ? "low" : "high";
      canvas.setPointerCapture(event.pointerId);
      this.move(value);
    });
    canvas.addEventListener("pointermove", (event) => {
      const value = this.dragging ? this.valueOf(event) : null;
      if (value !== null) this.move(value);
    });
    canvas.addEventListener("pointerup", () => { this.dragging = null; });
    canvas.addEventListener("pointercancel", () => { this.dragging = null; });
    canvas.addEventListener("dblclick", () => {
      if (this.state) this.onRange(this.state.field.low, this.state.field.high);
    });
  }

  private move(value: number): void {
    if (!this.state) return;
    const [low, high] = this.state.range, { field } = this.state;
    const near = 0.015 * (field.high - field.low);
    if (this.dragging === "low") this.onRange(value < field.low + near ? field.low : Math.min(value, high), high);
    else this.onRange(low, value > field.high - near ? field.high : Math.max(value, low));
  }

  private valueOf(event: PointerEvent): number | null {
    if (!this.state || this.state.field.discrete || !(this.state.field.high > this.state.field.low)) return null;
    const at = this.across ? event.offsetX : event.offsetY, { from, length } = this.along;
    const part = Math.min(1, Math.max(0, (at - from) / length)), { low, high } = this.state.field;
    return this.across ? low + part * (high - low) : high - part * (high - low);
  }

  /** Draws it for a stage of that size. */
  draw(state: LegendState, stage: { width: number; height: number }, ratio: number, across: boolean): void {
    this.state = state;
    this.across = across;
    const { field } = state;
    if (field.discrete) this.drawRows(state, this.regions(state), stage, ratio, across);
    else if (field.high > field.low) this.drawBar(state, stage, ratio, across);
    else this.drawRows(state, this.oneValue(state), stage, ratio, across);
  }

  private begin(width: number, height: number, ratio: number): CanvasRenderingContext2D {
    const { canvas } = this;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    canvas.style.width = `${width}px`;
    canvas.style.height = `${height}px`;
    const context = canvas.getContext("2d") as CanvasRenderingContext2D;
    context.scale(ratio, ratio);
    context.font = font;
    context.textBaseline = "middle";
    context.fillStyle = context.strokeStyle = getComputedStyle(canvas).color;
    context.lineWidth = 1;
    return context;
  }

  private measure(texts: string[]): number {
    const context = this.canvas.getContext("2d") as CanvasRenderingContext2D;
    context.font = font;
    return Math.max(0, ...texts.map((text) => context.measureText(text).width));
  }

  private colourOf(state: LegendState): (value: number) => string {
    const { map, colourLow: low, colourHigh: high } = state;
    const colours = colourMap(map), middle = middleOf(map, low, high);
    return (value) => {
      const part = high > low ? (value - low) / (high - low) : 0.5;
      const k = 3 * Math.round(255 * placeInMap(part, middle));
      return css(colours.subarray(k, k + 3));
    };
  }

  private regions({ field, histogram }: LegendState): Row[] {
    const rows: Row[] = [];
    const count = Math.round(field.high - field.low) + 1;
    for (let i = 0; i < count; ++i) {
      const number = Math.round(field.low) + i, share = histogram ? histogram[i] : 1;
      if (!(share > 0)) continue;  // no triangle has it
      const name = field.labels.get(number) ?? String(number);
      rows.push({ label: histogram ? `${name}  ·  ${(100 * share).toPrecision(2)} %` : name, colour: css(regionColour(number)) });
    }
    return rows;
  }

  /** Of a field that is the same all over; none where nothing is reached. */
  private oneValue(state: LegendState): Row[] {
    const { field, histogram } = state;
    if (field.infinite && histogram?.every((share) => share === 0)) return [];
    return [{ label: numberText(field.low), colour: this.colourOf(state)(field.low) }];
  }

  private drawRows(
    { field, infiniteColour }: LegendState, rows: Row[], stage: { width: number }, ratio: number, across: boolean,
  ): void {
    const shown = rows.slice(0, most);
    if (rows.length > most) shown.push({ label: `and ${rows.length - most} more`, colour: "transparent" });
    if (field.infinite) shown.push({ label: "unreachable", colour: css(infiniteColour) });
    const cell = 2 * pad + bar + 8 + this.measure(shown.map((row) => row.label)), line = 21;
    const columns = across ? Math.max(1, Math.floor((stage.width - pad) / cell)) : 1;
    const width = across ? stage.width : Math.max(cell, this.measure([field.name]) + 2 * pad);
    const context = this.begin(width, Math.ceil(shown.length / columns) * line + line + 2 * pad - 4, ratio);
    const ink = context.fillStyle;
    context.fillText(field.name, pad, pad + 6, width - 2 * pad);
    shown.forEach((row, i) => {
      const x = pad + (i % columns) * cell, y = pad + line + Math.floor(i / columns) * line;
      context.fillStyle = row.colour;
      context.fillRect(x, y, bar, 14);
      if (row.colour !== "transparent") context.strokeRect(x + 0.5, y + 0.5, bar - 1, 13);
      context.fillStyle = ink;
      context.fillText(row.label, x + bar + 8, y + 7.5);
    });
    this.canvas.setAttribute("aria-label", `Legend: ${field.name}: ${shown.map((row) => row.label).join("; ")}`);
  }

  /** With their numbers; side by side if a length is given, which then have room. */
  private ticks({ low, high }: Field, length: number): { ticks: number[]; labels: string[] } {
    for (let count = length ? Math.max(2, length / 70) : 7; ; count *= 0.8) {
      const step = niceSpacing(low, high, count), found = niceTicks(low, high, step);
      const ticks = found.length ? found : [low], apart = (length * step) / (high - low);
      const labels = ticks.map((tick) => numberText(tick, 0.1 * step));
      if (!length || count < 2 || this.measure(labels) + 10 < apart) return { ticks, labels };
    }
  }

  private drawBar(state: LegendState, stage: { width: number; height: number }, ratio: number, across: boolean): void {
    const { field, range } = state, span = field.high - field.low, bins = across ? 22 : 34;
    const colour = this.colourOf(state);
    const length = across ? Math.max(80, stage.width - 2 * pad - 2) : Math.min(320, Math.max(110, stage.height * 0.46));
    const { ticks, labels } = this.ticks(field, across ? length : 0);
    const infinite = field.infinite ? "unreachable" : "";
    const width = across ? stage.width : 2 * pad + bins + bar + 14 + Math.min(120, Math.max(this.measure([...labels, infinite]), this.measure([field.name]) - bar - bins - 14));
    const context = this.begin(width, across ? 20 + bins + bar + 26 : length + 2 * pad + 20 + (infinite ? 26 : 0), ratio);
    const ink = context.fillStyle;
    context.fillText(field.name, pad, pad + 2, width - 2 * pad - (across && infinite ? 110 : 0));
    const from = across ? pad : pad + 20, side = across ? 18 + bins : pad + bins;
    this.along = { from, length };
    const place = (value: number) => {
      const part = (value - field.low) / span;
      return from + length * (across ? part : 1 - part);
    };
    for (let i = 0; i < length; ++i) {
      const value = across ? field.low + (span * (i + 0.5)) / length : field.high - (span * (i + 0.5)) / length;
      context.fillStyle = colour(value);
      if (across) context.fillRect(from + i, side, 1.5, bar);
      else context.fillRect(side, from + i, bar, 1.5);
    }
    context.fillStyle = ink;
    this.drawHistogram(context, state, place, side, bins);
    if (across) context.strokeRect(from + 0.5, side + 0.5, length, bar - 1);
    else context.strokeRect(side + 0.5, from + 0.5, bar - 1, length);
    if (across) context.textAlign = "center";
    ticks.forEach((tick, i) => {
      const at = place(tick);
      if (across) {
        context.fillRect(at - 0.5, side + bar, 1, 4);
        const half = context.measureText(labels[i]).width / 2;
        context.fillText(labels[i], Math.min(width - half - 2, Math.max(half + 2, at)), side + bar + 12);
      } else {
        context.fillRect(side + bar, at - 0.5, 5, 1);
        context.fillText(labels[i], side + bar + 9, at);
      }
    });
    context.textAlign = "start";
    if (!state.fixed) this.drawHandles(context, range.map(place), side);
    if (infinite) this.drawHatch(context, state, ink, across ? width - pad - 105 : side, across ? pad - 6 : from + length + 10);
    const text = (x: number) => numberText(x, fineOf(field.low, field.high));
    this.canvas.setAttribute("aria-label",
      `Legend: ${field.name} from ${text(field.low)} to ${text(field.high)}` +
      (range[0] > field.low || range[1] < field.high ? `, shown from ${text(range[0])} to ${text(range[1])}` : "") +
      (field.infinite ? "; hatched where unreachable" : ""));
  }

  private drawHistogram(context: CanvasRenderingContext2D, state: LegendState, place: (value: number) => number, side: number, room: number): void {
    const { histogram, field, range } = state;
    if (!histogram || !(field.high > field.low)) return;
    const tallest = Math.max(...histogram), step = (field.high - field.low) / histogram.length;
    histogram.forEach((share, i) => {
      const low = field.low + i * step, a = place(low), b = place(low + step), size = ((room - 4) * share) / tallest;
      context.globalAlpha = low + step < range[0] || low > range[1] ? 0.18 : 0.5;
      if (this.across) context.fillRect(Math.min(a, b), side - 1 - size, Math.abs(b - a) - 0.4, size);
      else context.fillRect(side - 1 - size, Math.min(a, b), size, Math.abs(b - a) - 0.4);
    });
    context.globalAlpha = 1;
  }

  private drawHandles(context: CanvasRenderingContext2D, places: number[], side: number): void {
    for (const at of places) {
      context.beginPath();
      if (this.across) { context.moveTo(at, side); context.lineTo(at - 5, side - 8); context.lineTo(at + 5, side - 8); }
      else { context.moveTo(side, at); context.lineTo(side - 8, at - 5); context.lineTo(side - 8, at + 5); }
      context.closePath();
      context.fill();
    }
  }

  private drawHatch(context: CanvasRenderingContext2D, state: LegendState, ink: string | CanvasGradient | CanvasPattern, x: number, y: number): void {
    context.save();
    context.beginPath();
    context.rect(x, y, bar, 14);
    context.clip();
    context.fillStyle = css(state.infiniteColour);
    context.fillRect(x, y, bar, 14);
    context.strokeStyle = "rgba(0, 0, 0, 0.35)";
    context.lineWidth = 2;
    for (let i = -14; i < bar; i += 7) {
      context.beginPath();
      context.moveTo(x + i, y);
      context.lineTo(x + i + 14, y + 14);
      context.stroke();
    }
    context.restore();
    context.fillStyle = ink;
    context.fillText("unreachable", x + bar + 8, y + 7);
  }
}
