// The colour bar with numbers; drawn on a canvas so that saved pictures can carry it.
import { numberText } from "./data.js";

export function drawLegend(canvas, scene, ratio) {
  const { field } = scene;
  const height = Math.min(320, Math.max(140, window.innerHeight * 0.42)), bar = 18, pad = 14, line = 18;
  const infinite = field.infinite ? 26 : 0;
  const context = canvas.getContext("2d");
  const font = '13px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';
  context.font = font;
  const widest = Math.max(...field.labels.map((text) => context.measureText(text).width),
    context.measureText(field.infinite ? "infinite" : "").width, context.measureText(field.name).width - bar - 12);
  const width = 2 * pad + bar + 12 + Math.min(widest, 140);
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round((height + 2 * pad + line + infinite) * ratio);
  canvas.style.width = `${width}px`;
  canvas.style.height = `${canvas.height / ratio}px`;
  context.scale(ratio, ratio);
  context.font = font;
  const ink = getComputedStyle(document.body).color;
  context.fillStyle = ink;
  context.textBaseline = "middle";
  context.fillText(field.name, pad, pad + 2, width - 2 * pad);
  const top = pad + line, range = field.high - field.low;
  const colourRange = field.colourHigh - field.colourLow;
  for (let y = 0; y < height; ++y) {
    const value = field.high - (range * (y + 0.5)) / height;
    const u = colourRange > 0 ? (value - field.colourLow) / colourRange : 0.5;
    const i = 3 * Math.max(0, Math.min(255, Math.round(255 * u)));
    context.fillStyle = `rgb(${field.colours[i]},${field.colours[i + 1]},${field.colours[i + 2]})`;
    context.fillRect(pad, top + y, bar, 1.5);
  }
  context.strokeStyle = context.fillStyle = ink;
  context.lineWidth = 1;
  context.strokeRect(pad + 0.5, top + 0.5, bar - 1, height);
  const ticks = field.ticks.length ? field.ticks : [field.low];
  const labels = field.ticks.length ? field.labels : [numberText(field.low)];
  ticks.forEach((tick, i) => {
    const y = top + (range > 0 ? (height * (field.high - tick)) / range : height / 2);
    context.fillRect(pad + bar, y - 0.5, 5, 1);
    context.fillText(labels[i], pad + bar + 9, y);
  });
  if (infinite) {
    context.fillStyle = `rgb(${scene.infiniteColour.join(",")})`;
    context.fillRect(pad, top + height + 10, bar, 14);
    context.fillStyle = ink;
    context.fillText("infinite", pad + bar + 9, top + height + 17);
  }
  canvas.setAttribute("aria-label",
    `Legend: ${field.name} from ${numberText(field.low)} to ${numberText(field.high)}` +
    (field.infinite ? "; grey where infinite" : ""));
}
