// Files made of what is on show.
import * as THREE from "three";
import type { Lines } from "littoral/inline";
import type { Stage } from "./stage";
import type { Layout } from "./marks";
import type { Drawing } from "./drawing";
import { signedColour, unsignedColour } from "./skin";

const escape = (text: string) => text.replace(/[&<>"]/g, (c) => `&#${c.charCodeAt(0)};`);

/** Isolines and curves as the camera sees them; what the surface hides is left out. */
export function linesAsSvg(stage: Stage, lines: Lines, drawing: Drawing, layout: Layout, title: string): string {
  const { centre, radius } = stage.frame, box = stage.canvas.getBoundingClientRect();
  const { width, height } = box;
  const place = (i: number) => new THREE.Vector3(
    (lines.positions[3 * i] - centre[0]) / radius, (lines.positions[3 * i + 1] - centre[1]) / radius,
    (lines.positions[3 * i + 2] - centre[2]) / radius);
  const path = (line: readonly THREE.Vector3[]) => {
    let out = "", drawing = false;
    for (let i = 1; i < line.length; ++i) {
      const middle = line[i - 1].clone().add(line[i]).multiplyScalar(0.5);
      if (stage.hidden(middle)) {
        drawing = false;
        continue;
      }
      const text = (p: THREE.Vector3) => {
        const { x, y } = stage.project(p);
        return `${(x - box.left).toFixed(2)} ${(y - box.top).toFixed(2)}`;
      };
      out += drawing ? `L${text(line[i])}` : `M${text(line[i - 1])}L${text(line[i])}`;
      drawing = true;
    }
    return out;
  };
  const parts: string[] = [];
  for (let i = 0; i + 1 < lines.offsets.length; ++i) {
    const line = Array.from({ length: lines.offsets[i + 1] - lines.offsets[i] }, (_, k) => place(lines.offsets[i] + k));
    const d = path(line), level = lines.levels[i];
    if (d) parts.push(`<path d="${d}" stroke-width="${level === 0 ? 2 : 0.8}"><title>${level}</title></path>`);
  }
  const curves = layout.strokes.map((line, i) => {
    const d = path(line), colour = (drawing.strokes[i]?.signed ? signedColour : unsignedColour).join(",");
    return d ? `<path d="${d}" stroke="rgb(${colour})" stroke-width="2.5"/>` : "";
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}">
<title>${escape(title)}</title>
<g fill="none" stroke="#14181f" stroke-linecap="round" stroke-linejoin="round">
${[...parts, ...curves].filter(Boolean).join("\n")}
</g>
</svg>
`;
}

/** The picture as it is, with its legend. */
export function picture(stage: Stage, legend: HTMLCanvasElement | null): Promise<Blob | null> {
  stage.render();
  const { canvas } = stage, out = document.createElement("canvas");
  out.width = canvas.width;
  out.height = canvas.height;
  const context = out.getContext("2d");
  context?.drawImage(canvas, 0, 0);
  if (legend) {
    const box = canvas.getBoundingClientRect(), at = legend.getBoundingClientRect(), ratio = canvas.width / box.width;
    context?.drawImage(legend, (at.left - box.left) * ratio, (at.top - box.top) * ratio, at.width * ratio, at.height * ratio);
  }
  return new Promise((done) => out.toBlob(done, "image/png"));
}
