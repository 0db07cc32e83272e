// Lists and tables beside the picture.
import type { Surface } from "littoral/inline";
import type { Drawing, Selection } from "./drawing";
import { element, make } from "./dom";

const count = (n: number, one: string) => `${n} ${one}${n === 1 ? "" : "s"}`;

/** One button for each curve and point; the selected one says which side is positive. */
export function listCurves(drawing: Drawing, selection: Selection | null, select: (selection: Selection) => void): void {
  const rows: HTMLElement[] = drawing.strokes.map((stroke, index) => {
    const chosen = selection?.kind === "stroke" && selection.index === index;
    const mark = make("i");
    mark.style.background = stroke.signed ? "rgb(0,122,70)" : "rgb(214,0,108)";
    const side = chosen && stroke.signed ? "; + on the orange side" : "";
    const button = make("button", { type: "button", ariaPressed: String(chosen) }, mark,
      `${stroke.signed ? "Signed" : "Unsigned"} ${stroke.closed ? "closed" : "open"}, ${count(stroke.nodes.length, "node")}${side}`);
    button.onclick = () => select({ kind: "stroke", index, node: -1 });
    return make("li", {}, button);
  });
  drawing.points.forEach((_, index) => {
    const chosen = selection?.kind === "point" && selection.index === index;
    const mark = make("i");
    mark.style.cssText = "background: rgb(214,0,108); width: 8px; height: 8px; border-radius: 4px";
    const button = make("button", { type: "button", ariaPressed: String(chosen) }, mark, `Point ${index + 1}`);
    button.onclick = () => select({ kind: "point", index });
    rows.push(make("li", {}, button));
  });
  const more = (drawing.beside.spaceCurves?.length ?? 0) + (drawing.beside.chains?.length ?? 0);
  if (more) rows.push(make("li", { className: "none", textContent: `${count(more, "curve")} of the file beside these` }));
  if (!rows.length) rows.push(make("li", { className: "none", textContent: "Nothing yet." }));
  element("curves").replaceChildren(...rows);
}

const isCloud = ({ kind }: Surface) => kind === "point cloud";

/** "5,856 faces"; of clouds their points. */
export const sizeOf = (surface: Surface) => isCloud(surface)
  ? `${surface.counts.vertices.toLocaleString("en")} points` : `${surface.counts.faces.toLocaleString("en")} faces`;

export function showFacts(surface: Surface): void {
  const { counts } = surface, rows: [string, string][] = [
    ["Name", surface.name], ["Kind", surface.kind],
    ...(isCloud(surface) ? [["Points", counts.vertices.toLocaleString("en")]] : [
      ["Vertices", counts.vertices.toLocaleString("en")], ["Faces", counts.faces.toLocaleString("en")],
      ["Components", String(counts.components)],
    ]) as [string, string][],
    ["Up", surface.up],
  ];
  element("facts").replaceChildren(...rows.map(([key, value]) =>
    make("tr", {}, make("th", { scope: "row", textContent: key }), make("td", { textContent: value }))));
}

/** All of them, in the footer, where nothing hides them. */
export function showWarnings(warnings: readonly string[], failure: string | null): void {
  const items = warnings.map((text) => make("li", { textContent: text }));
  if (failure) items.unshift(make("li", { className: "bad", textContent: failure }));
  element("warnings").replaceChildren(...items);
}

export function listKeys(rows: readonly (readonly [string, string])[]): void {
  element("key-list").replaceChildren(...rows.map(([key, what]) =>
    make("tr", {}, make("th", { scope: "row" }, make("b", { textContent: key })), make("td", { textContent: what }))));
}

interface Button { id: string; label: string; title: string; icon: string; pressed?: boolean }

const buttons: readonly (Button | null)[] = [
  { id: "mode-turn", label: "Turn", title: "Turn and select (V)", pressed: true, icon: "M4 12a8 8 0 1 1 3 6M4 20v-5h5" },
  { id: "mode-curve", label: "Curve", title: "Click nodes of a curve (C)", icon: "M4 18L9 7l6 8 5-10M3 18h2M8 7h2M14 15h2M19 5h2" },
  { id: "mode-freehand", label: "Draw", title: "Draw freehand (F)", icon: "M3 18c3-9 6 3 9-4s5-9 9-8" },
  { id: "mode-point", label: "Point", title: "Points (P)", icon: "M12 9a3 3 0 1 0 .1 0M12 3v3M12 18v3M3 12h3M18 12h3" },
  { id: "snap", label: "Snap", title: "Snap to vertices (S)", pressed: false, icon: "M6 4v8a6 6 0 0 0 12 0V4h-4v8a2 2 0 0 1-4 0V4zM6 8h4M14 8h4" },
  { id: "signed", label: "Signed", title: "Signed: positive to the left of the curve (U)", pressed: true, icon: "M4 8h6M7 5v6M14 16h6M6 20L18 4" },
  null,
  { id: "undo", label: "Undo", title: "Undo (Ctrl Z)", icon: "M8 5L3 10l5 5M3 10h11a6 6 0 0 1 0 11h-3" },
  { id: "redo", label: "Redo", title: "Redo (Ctrl Shift Z)", icon: "M16 5l5 5-5 5M21 10H10a6 6 0 0 0 0 11h3" },
  { id: "close", label: "Close", title: "Close or open the curve (L)", icon: "M12 4a8 8 0 1 1-6 3M6 3v4h4" },
  { id: "reverse", label: "Flip", title: "Reverse the curve: the other side is positive (R)", icon: "M7 4L3 8l4 4M3 8h15M17 12l4 4-4 4M21 16H6" },
  { id: "delete", label: "Delete", title: "Delete the node, curve or point (Del)", icon: "M5 7h14M9 7V4h6v3M7 7l1 13h8l1-13" },
];

export function makeToolbar(): void {
  element("tools").replaceChildren(...buttons.map((button) => {
    if (!button) return make("hr");
    const made = make("button", { id: button.id, type: "button", title: button.title, ariaLabel: button.title });
    if (button.pressed !== undefined || button.id.startsWith("mode-")) made.ariaPressed = String(button.pressed ?? false);
    made.innerHTML = `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="${button.icon}"/></svg>`;
    made.append(make("span", { textContent: button.label }));
    return made;
  }));
}
