// What can be saved: isolines as a drawing, the surface as a file; and the numbers on lines.
import { valueAt } from "./field";
import { fineOfLevels, numberText } from "./numbers";
import type { Pane } from "./pane";
import type { ResultView } from "./view";

export interface LineStyle {
  spacing: number;
  ink: string;
  paper: string;
}

const escape = (text: string) => text.replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c] ?? c);

/** Segments as few polylines: end to end where they meet, by rounded places. */
function chains(ends: number[]): number[][] {
  const at = new Map<string, number[]>(), used = new Uint8Array(ends.length / 4), key = (i: number) => `${ends[i].toFixed(1)},${ends[i + 1].toFixed(1)}`;
  for (let s = 0; s < used.length; ++s) for (const e of [0, 2]) {
    const k = key(4 * s + e);
    const there = at.get(k);
    if (there) there.push(s);
    else at.set(k, [s]);
  }
  const out: number[][] = [];
  for (let s = 0; s < used.length; ++s) {
    if (used[s]) continue;
    used[s] = 1;
    const line = [ends[4 * s], ends[4 * s + 1], ends[4 * s + 2], ends[4 * s + 3]];
    for (const forward of [true, false]) {
      for (;;) {
        const [x, y] = forward ? line.slice(-2) : line.slice(0, 2), k = `${x.toFixed(1)},${y.toFixed(1)}`;
        const next = at.get(k)?.find((i) => !used[i]);
        if (next === undefined) break;
        used[next] = 1;
        const far = key(4 * next) === k ? 4 * next + 2 : 4 * next;
        if (forward) line.push(ends[far], ends[far + 1]);
        else line.unshift(ends[far], ends[far + 1]);
      }
    }
    out.push(line);
  }
  return out;
}

/** The isolines of a pane that are in sight, as an SVG drawing of the picture's size. */
export function isolineSvg(view: ResultView, index: number, size: { width: number; height: number }, style: LineStyle): string {
  const pane = view.panes[index], visible = view.visibility(index), paths: string[] = [];
  const fine = fineOfLevels(pane.levels(style.spacing));
  for (const { level, ends } of pane.lines(style.spacing)) {
    const flat: number[] = [];
    for (let i = 0; i < ends.length; i += 6) {
      const a = view.orbit.project(ends.slice(i, i + 3)), b = view.orbit.project(ends.slice(i + 3, i + 6));
      if (visible((a.x + b.x) / 2, (a.y + b.y) / 2, (a.depth + b.depth) / 2)) flat.push(a.x, a.y, b.x, b.y);
    }
    if (!flat.length) continue;
    const d = chains(flat).map((line) => {
      let text = `M${line[0].toFixed(1)} ${line[1].toFixed(1)}`;
      for (let i = 2; i < line.length; i += 2) text += `L${line[i].toFixed(1)} ${line[i + 1].toFixed(1)}`;
      return text;
    }).join("");
    const title = escape(numberText(level, fine));
    paths.push(`<path d="${d}" stroke-width="${level === 0 ? 2.2 : 1}"><title>${title}</title></path>`);
  }
  const { width, height } = size;
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}">\n` +
    `<title>${escape(pane.scene.title)}: ${escape(pane.field?.name ?? "")}</title>\n<g fill="none" stroke="${style.ink}" stroke-linejoin="round">\n${paths.join("\n")}\n</g>\n</svg>\n`;
}

/** The surface in its own unit; the field at vertices as texture coordinate u, as the library writes it. */
export function surfaceObj(pane: Pane): string {
  const { surface, centre, radius, title } = pane.scene, { field } = pane;
  const shell = pane.volume ? { positions: pane.volume.positions, triangles: pane.volume.shell.geometry.getIndex()?.array ?? [] } : surface;
  const { positions: p, triangles } = shell, out = [`# ${title.replace(/[\r\n]+/g, " ")}`], withField = !pane.volume && field?.values && field.at === "vertex";
  for (let i = 0; i < p.length; i += 3) out.push(`v ${[0, 1, 2].map((k) => centre[k] + radius * p[i + k]).join(" ")}`);
  if (withField) {
    const corner = new Int32Array(p.length / 3).fill(-1);
    for (let c = 0; c < triangles.length; ++c) corner[triangles[c]] = c;
    for (let v = 0; v < corner.length; ++v) {
      const c = corner[v], b = [0, 0, 0];
      if (c >= 0) b[c % 3] = 1;
      out.push(`vt ${c < 0 ? 0 : valueAt(field, surface, Math.floor(c / 3), b)} 0`);
    }
  }
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [triangles[t] + 1, triangles[t + 1] + 1, triangles[t + 2] + 1];
    out.push(withField ? `f ${a}/${a} ${b}/${b} ${c}/${c}` : `f ${a} ${b} ${c}`);
  }
  return out.join("\n") + "\n";
}

export interface NumberStyle {
  spacing: number;
  /** Of the text: 1 on the page. */
  scale: number;
}

/** Writes numbers on the lines in sight, on a picture whose pane begins at `offset`; returns how many. */
export function drawNumbers(
  context: CanvasRenderingContext2D, view: ResultView, index: number, offset: number, style: NumberStyle,
): number {
  const { spacing, scale } = style;
  const pane = view.panes[index], visible = view.visibility(index), taken: { x: number; y: number }[] = [];
  const fine = fineOfLevels(pane.levels(spacing));
  context.font = `${11 * scale}px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif`;
  context.textAlign = "center";
  context.textBaseline = "middle";
  const far = (x: number, y: number, room: number) => taken.every((q) => Math.hypot(q.x - x, q.y - y) > room);
  for (const { level, ends } of pane.lines(spacing)) {
    const text = numberText(level, fine);
    const count = ends.length / 6, stride = Math.max(1, Math.floor(count / 80));
    let mine = 0;
    for (let s = Math.floor(stride / 2); s < count && mine < 3 && taken.length < 80; s += stride) {
      const a = view.orbit.project(ends.slice(6 * s, 6 * s + 3)), b = view.orbit.project(ends.slice(6 * s + 3, 6 * s + 6));
      const x = (a.x + b.x) / 2, y = (a.y + b.y) / 2;
      if (!far(x, y, (mine ? 110 : 44) * scale) || !visible(x, y, (a.depth + b.depth) / 2)) continue;
      let angle = Math.atan2(b.y - a.y, b.x - a.x);
      if (Math.cos(angle) < 0) angle += Math.PI;
      taken.push({ x, y });
      ++mine;
      context.save();
      context.translate(x + offset, y);
      context.rotate(angle);
      context.lineWidth = 3.5 * scale;
      context.strokeStyle = "rgba(255, 255, 255, 0.9)";
      context.strokeText(text, 0, 0);
      context.fillStyle = "#14181f";
      context.fillText(text, 0, 0);
      context.restore();
    }
  }
  return taken.length;
}
