// Pointer and drawing: what a click, a stroke and a tap do in each mode.
import * as THREE from "three";
import type { SurfacePoint } from "littoral/inline";
import {
  canClose, replaced, withStroke, type Drawing, type History, type Selection, type Stroke,
} from "./drawing";
import type { Layout } from "./marks";
import { lineOf, nodeOf, type Hit } from "./pick";
import type { Stage } from "./stage";

export type Mode = "turn" | "curve" | "freehand" | "point";

export interface Host {
  readonly history: History;
  readonly layout: Layout;
  /** The drawing has changed; `done` once the gesture is over. */
  changed(): void;
  selected(): void;
  /** No stroke is being drawn any more. */
  ended(): void;
  hover(x: number, y: number): void;
  leave(): void;
  copy(line: string): void;
}

const near = { mouse: 9, pen: 12, touch: 22 } as const; // pixels
const still = 5; // pixels that a click may move

type Gesture =
  | { kind: "click"; x: number; y: number; touch: boolean }
  | { kind: "node"; index: number; node: number; x: number; y: number; moved: boolean }
  | { kind: "point"; index: number; x: number; y: number; moved: boolean }
  | { kind: "stroke"; index: number; x: number; y: number }
  | { kind: "aim"; x: number; y: number };

export class Tools {
  mode: Mode = "turn";
  snap = false;
  signed = true;
  /** The curve that clicks go on with, or -1. */
  open = -1;
  private gesture: Gesture | null = null;
  private readonly pointers = new Set<number>();

  constructor(private readonly stage: Stage, private readonly host: Host) {
    const { canvas } = stage, box = canvas.parentElement!;
    // Before the camera sees it: what draws is not a turn.
    box.addEventListener("pointerdown", (event) => this.down(event), { capture: true });
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event, true));
    canvas.addEventListener("pointercancel", (event) => this.up(event, false));
    canvas.addEventListener("pointerleave", () => this.host.leave());
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("dblclick", () => { if (this.mode === "curve") this.finish(); });
  }

  /** Is a stroke or a node on its way? */
  get drawing(): boolean { return this.gesture !== null && this.gesture.kind !== "click"; }

  setMode(mode: Mode): void {
    this.finish();
    this.mode = mode;
    this.stage.controls.touches.ONE = mode === "turn" ? THREE.TOUCH.ROTATE : null;
  }

  /** The next click begins a curve of its own. */
  finish(): void {
    const { history } = this.host, stroke = history.drawing.strokes[this.open];
    if (stroke && stroke.nodes.length < 2) {
      history.change({ ...history.drawing, strokes: history.drawing.strokes.filter((_, i) => i !== this.open) }, null);
      this.host.changed();
    }
    this.open = -1;
  }

  private node(hit: Hit): SurfacePoint { return nodeOf(hit, this.stage.surface?.kind ?? "", this.snap); }

  private down(event: PointerEvent): void {
    if (event.target !== this.stage.canvas) return;
    this.pointers.add(event.pointerId);
    this.host.leave();
    const { controls } = this.stage, touch = event.pointerType === "touch";
    controls.mouseButtons.LEFT = THREE.MOUSE.ROTATE;
    if (this.pointers.size > 1) return this.abandon(); // two fingers move the camera
    if (event.button !== 0) return;
    const { clientX: x, clientY: y } = event, reach = near[event.pointerType as keyof typeof near] ?? near.mouse;
    this.gesture = { kind: "click", x, y, touch };
    if (this.mode === "turn") return;
    const grabbed = this.handleNear(x, y, reach);
    const closing = this.mode === "curve" && grabbed?.kind === "stroke" && grabbed.index === this.open && grabbed.node === 0;
    if (grabbed && !closing && this.mode !== "freehand") {
      this.host.history.begin();
      this.gesture = grabbed.kind === "stroke"
        ? { kind: "node", index: grabbed.index, node: grabbed.node, x, y, moved: false }
        : { kind: "point", index: grabbed.index, x, y, moved: false };
    } else if (this.mode === "freehand" && this.stage.pick(x, y)) {
      this.beginStroke(x, y);
    } else if (touch && this.stage.pick(x, y)) {
      this.gesture = { kind: "aim", x, y };
    }
    if (this.gesture.kind !== "click") controls.mouseButtons.LEFT = null;
  }

  private move(event: PointerEvent): void {
    const { clientX: x, clientY: y } = event, { gesture } = this, { history } = this.host;
    if (this.pointers.size > 1) return;
    if (!gesture) {
      if (event.pointerType !== "touch") this.host.hover(x, y);
      return;
    }
    if (gesture.kind === "click") return;
    if (gesture.kind === "aim") {
      Object.assign(gesture, { x, y });
      return this.host.hover(x, y);
    }
    if (gesture.kind === "stroke") {
      // Every place that the browser saw, but none nearer than 10 pixels to the last.
      for (const at of event.getCoalescedEvents?.() ?? [event]) this.extend(gesture, at.clientX, at.clientY);
      return this.extend(gesture, x, y);
    }
    if (!gesture.moved && Math.hypot(x - gesture.x, y - gesture.y) < still) return;
    gesture.moved = true;
    const hit = this.stage.pick(x, y), { drawing } = history;
    if (!hit) return;
    if (gesture.kind === "point") {
      history.change({ ...drawing, points: replaced(drawing.points, gesture.index, this.node(hit)) }, { kind: "point", index: gesture.index });
    } else {
      const stroke = drawing.strokes[gesture.index];
      if (!stroke) return;
      history.change(withStroke(drawing, gesture.index, { ...stroke, nodes: replaced(stroke.nodes, gesture.node, this.node(hit)) }),
        { kind: "stroke", index: gesture.index, node: gesture.node });
    }
    this.host.changed();
  }

  private up(event: PointerEvent, ended: boolean): void {
    this.pointers.delete(event.pointerId);
    const { gesture } = this, { history } = this.host, { clientX: x, clientY: y } = event;
    this.gesture = null;
    if (!gesture) return;
    this.host.ended();
    if (!ended) {
      history.cancel();
      return this.host.changed();
    }
    switch (gesture.kind) {
      case "aim":
        this.host.leave();
        return this.click(x, y, near.touch);
      case "click":
        if (Math.hypot(x - gesture.x, y - gesture.y) < (gesture.touch ? 2 : 1) * still) this.click(x, y, gesture.touch ? near.touch : near.mouse);
        return;
      case "stroke":
        return this.endStroke(gesture.index, x, y);
      default:
        history.end();
        if (!gesture.moved) {
          this.select(gesture.kind === "node" ? { kind: "stroke", index: gesture.index, node: gesture.node } : { kind: "point", index: gesture.index });
        } else {
          this.host.changed();
        }
    }
  }

  /** A second finger: what the first had begun is taken back. */
  private abandon(): void {
    if (!this.gesture) return;
    this.host.history.cancel();
    this.gesture = null;
    this.host.changed();
  }

  /** As a click at that place; for keys at the middle of the picture. */
  click(x: number, y: number, reach: number = near.mouse): void {
    const hit = this.stage.pick(x, y), { history } = this.host;
    if (this.mode === "turn" || this.mode === "freehand") {
      const there = this.handleNear(x, y, reach) ?? this.strokeNear(x, y, reach);
      this.select(there);
      if (!there && hit && this.mode === "turn") this.host.copy(lineOf(this.node(hit)));
      return;
    }
    if (!hit) return this.finish();
    const node = this.node(hit), { drawing } = history;
    if (this.mode === "point") {
      history.change({ ...drawing, points: [...drawing.points, node] }, { kind: "point", index: drawing.points.length });
      return this.host.changed();
    }
    const stroke = drawing.strokes[this.open];
    if (!stroke) {
      this.open = drawing.strokes.length;
      this.begin({ nodes: [node], closed: false, signed: this.signed });
    } else if (canClose(stroke) && this.isNear(this.host.layout.nodes[this.open]?.[0], x, y, reach)) {
      history.change(withStroke(drawing, this.open, { ...stroke, closed: true }), { kind: "stroke", index: this.open, node: -1 });
      this.open = -1;
    } else {
      history.change(withStroke(drawing, this.open, { ...stroke, nodes: [...stroke.nodes, node] }),
        { kind: "stroke", index: this.open, node: stroke.nodes.length });
    }
    this.host.changed();
  }

  private begin(stroke: Stroke): void {
    const { history } = this.host, { drawing } = history;
    history.change({ ...drawing, strokes: [...drawing.strokes, stroke] }, { kind: "stroke", index: drawing.strokes.length, node: -1 });
  }

  private beginStroke(x: number, y: number): void {
    const hit = this.stage.pick(x, y), { history } = this.host;
    if (!hit) return;
    history.begin();
    this.gesture = { kind: "stroke", index: history.drawing.strokes.length, x, y };
    this.begin({ nodes: [this.node(hit)], closed: false, signed: this.signed });
  }

  private extend(gesture: { index: number; x: number; y: number }, x: number, y: number): void {
    if (Math.hypot(x - gesture.x, y - gesture.y) < 10) return;
    const hit = this.stage.pick(x, y), { history } = this.host, stroke = history.drawing.strokes[gesture.index];
    if (!hit || !stroke) return;
    Object.assign(gesture, { x, y });
    const node = this.node(hit);
    if (lineOf(node) === lineOf(stroke.nodes[stroke.nodes.length - 1])) return; // snapped to the same vertex
    history.change(withStroke(history.drawing, gesture.index, { ...stroke, nodes: [...stroke.nodes, node] }));
    this.host.changed();
  }

  /** A stroke that ends where it began is closed; one of a single node is none. */
  private endStroke(index: number, x: number, y: number): void {
    const { history } = this.host, stroke = history.drawing.strokes[index];
    if (!stroke || stroke.nodes.length < 2) {
      history.cancel();
      this.click(x, y);
    } else {
      const first = this.host.layout.nodes[index]?.[0];
      if (canClose(stroke) && stroke.nodes.length > 5 && this.isNear(first, x, y, 18)) {
        // The last node is as good as the first: it would only make a tiny last side.
        history.change(withStroke(history.drawing, index, { ...stroke, nodes: stroke.nodes.slice(0, -1), closed: true }));
      }
      history.end();
    }
    this.host.changed();
  }

  private select(selection: Selection | null): void {
    this.host.history.select(selection);
    if (selection?.kind !== "stroke" || selection.index !== this.open) this.open = -1;
    this.host.selected();
  }

  private isNear(place: THREE.Vector3 | undefined, x: number, y: number, reach: number): boolean {
    if (!place) return false;
    const p = this.stage.project(place);
    return Math.hypot(p.x - x, p.y - y) < reach;
  }

  /** A node of the selected curve or of the open one, or a point. */
  private handleNear(x: number, y: number, reach: number): Selection | null {
    const { layout, history: { selection } } = this.host;
    let best: Selection | null = null, least = reach;
    const offer = (place: THREE.Vector3, found: Selection) => {
      const p = this.stage.project(place), away = Math.hypot(p.x - x, p.y - y);
      if (away >= least || this.stage.hidden(place)) return;
      least = away;
      best = found;
    };
    layout.points.forEach((p, index) => offer(p, { kind: "point", index }));
    layout.nodes.forEach((nodes, index) => {
      if (index === this.open || (selection?.kind === "stroke" && selection.index === index))
        nodes.forEach((p, node) => offer(p, { kind: "stroke", index, node }));
    });
    return best;
  }

  private strokeNear(x: number, y: number, reach: number): Selection | null {
    let best: Selection | null = null, least = reach;
    this.host.layout.strokes.forEach((line, index) => {
      for (let i = 1; i < line.length; ++i) {
        const p = this.stage.project(line[i - 1]), q = this.stage.project(line[i]);
        const ux = q.x - p.x, uy = q.y - p.y, size = ux * ux + uy * uy;
        const t = size > 0 ? Math.min(1, Math.max(0, ((x - p.x) * ux + (y - p.y) * uy) / size)) : 0;
        const away = Math.hypot(p.x + t * ux - x, p.y + t * uy - y);
        if (away < least && !this.stage.hidden(line[i])) {
          least = away;
          best = { kind: "stroke", index, node: -1 };
        }
      }
    });
    return best;
  }

  /** What is selected is taken away: the node, or else the curve or point. */
  remove(): void {
    const { history } = this.host, { drawing, selection } = history;
    if (!selection) return;
    let next: Drawing, then: Selection | null = null;
    if (selection.kind === "point") {
      next = { ...drawing, points: drawing.points.filter((_, i) => i !== selection.index) };
    } else {
      const stroke = drawing.strokes[selection.index];
      if (!stroke) return;
      if (selection.node >= 0 && stroke.nodes.length > 2) {
        const nodes = stroke.nodes.filter((_, i) => i !== selection.node);
        next = withStroke(drawing, selection.index, { ...stroke, nodes, closed: stroke.closed && nodes.length > 2 });
        then = { ...selection, node: Math.min(selection.node, nodes.length - 1) };
      } else {
        next = { ...drawing, strokes: drawing.strokes.filter((_, i) => i !== selection.index) };
        this.open = -1;
      }
    }
    history.change(next, then);
    this.host.changed();
  }
}
