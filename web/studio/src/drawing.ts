// What the user has drawn, as values that never change, and the way back and forth between them.
import type { Curve, Sources, SurfacePoint } from "littoral/inline";

export interface Stroke {
  readonly nodes: readonly SurfacePoint[];
  readonly closed: boolean;
  readonly signed: boolean;
}

export interface Drawing {
  readonly strokes: readonly Stroke[];
  readonly points: readonly SurfacePoint[];
  /** Of a file that was opened: what is not drawn on the surface, kept as it is. */
  readonly beside: Pick<Sources, "spaceCurves" | "chains">;
}

/** What is selected: a curve or a point, by its number, and a node of the curve, or -1. */
export type Selection =
  | { readonly kind: "stroke"; readonly index: number; readonly node: number }
  | { readonly kind: "point"; readonly index: number };

export const nothing: Drawing = { strokes: [], points: [], beside: {} };

export function fromSources(sources: Sources): Drawing {
  return {
    strokes: (sources.curves ?? []).map((curve) => ({
      nodes: curve.nodes, closed: curve.closed ?? false, signed: curve.signed ?? true,
    })),
    points: sources.points ?? [],
    beside: {
      ...(sources.spaceCurves?.length ? { spaceCurves: sources.spaceCurves } : {}),
      ...(sources.chains?.length ? { chains: sources.chains } : {}),
    },
  };
}

/** Curves of one node are still being drawn and no sources yet. */
export function toSources(drawing: Drawing): Sources {
  const curves: Curve[] = drawing.strokes.filter((stroke) => stroke.nodes.length > 1)
    .map(({ nodes, closed, signed }) => ({ nodes, closed, signed }));
  return { curves, points: drawing.points, ...drawing.beside };
}

export function isEmpty(sources: Sources): boolean {
  return !sources.curves?.length && !sources.points?.length && !sources.spaceCurves?.length &&
    !sources.chains?.length;
}

export const without = <T>(list: readonly T[], index: number): readonly T[] =>
  list.filter((_, i) => i !== index);

export const replaced = <T>(list: readonly T[], index: number, item: T): readonly T[] =>
  list.map((old, i) => (i === index ? item : old));

export function withStroke(drawing: Drawing, index: number, stroke: Stroke): Drawing {
  return { ...drawing, strokes: replaced(drawing.strokes, index, stroke) };
}

/** The same set of points, travelled the other way; a closed curve keeps its first node. */
export function reversed(stroke: Stroke): Stroke {
  const nodes = [...stroke.nodes].reverse();
  return { ...stroke, nodes: stroke.closed ? [...nodes.slice(-1), ...nodes.slice(0, -1)] : nodes };
}

/** A closed curve of two nodes would run back on itself. */
export const canClose = (stroke: Stroke): boolean => stroke.nodes.length > 2;

interface Step { readonly drawing: Drawing; readonly selection: Selection | null }

const most = 500; // steps back

/** Steps back and forth. A gesture that changes the drawing many times is one step. */
export class History {
  private past: Step[] = [];
  private future: Step[] = [];
  private now: Step = { drawing: nothing, selection: null };
  private gesture: Step | null = null;

  get drawing(): Drawing { return this.now.drawing; }
  get selection(): Selection | null { return this.now.selection; }
  get canUndo(): boolean { return this.past.length > 0; }
  get canRedo(): boolean { return this.future.length > 0; }

  select(selection: Selection | null): void {
    this.now = { drawing: this.now.drawing, selection };
  }

  change(drawing: Drawing, selection: Selection | null = this.now.selection): void {
    if (!this.gesture) this.keep(this.now);
    this.now = { drawing, selection };
  }

  begin(): void { this.gesture = this.now; }

  end(): void {
    if (this.gesture && this.gesture.drawing !== this.now.drawing) this.keep(this.gesture);
    this.gesture = null;
  }

  /** As if the gesture had not been made. */
  cancel(): void {
    if (this.gesture) this.now = this.gesture;
    this.gesture = null;
  }

  undo(): void { this.move(this.past, this.future); }
  redo(): void { this.move(this.future, this.past); }

  reset(drawing: Drawing): void {
    this.past = [];
    this.future = [];
    this.gesture = null;
    this.now = { drawing, selection: null };
  }

  private keep(step: Step): void {
    this.past.push(step);
    if (this.past.length > most) this.past.shift();
    this.future = [];
  }

  private move(from: Step[], to: Step[]): void {
    const step = from.pop();
    if (!step) return;
    to.push(this.now);
    this.now = step;
  }
}
