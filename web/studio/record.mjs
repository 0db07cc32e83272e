// node record.mjs FOLDER: draws a curve on Spot in the studio and writes the frames as PNG.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { openStudio, settled } from "./test/helpers.mjs";

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
const { page, close } = await openStudio({ example: "spot", viewport: { width: 760, height: 560 } });
let frames = 0;
const shoot = () => page.screenshot({ path: join(folder, `${String(frames++).padStart(3, "0")}.png`) });

// A cursor, which screenshots leave out.
await page.evaluate(() => {
  const dot = document.createElement("div");
  dot.id = "pointer";
  dot.style.cssText = "position:fixed;width:18px;height:18px;margin:-9px;border-radius:9px;background:#0008;border:2px solid #fff;z-index:99;pointer-events:none";
  document.body.append(dot);
  addEventListener("pointermove", (event) => Object.assign(dot.style, { left: `${event.clientX}px`, top: `${event.clientY}px` }), true);
});
await page.click("#mode-freehand");
await settled(page);

// Round the body, from the screen's point of view.
const path = await page.evaluate(() => {
  const box = document.getElementById("view").getBoundingClientRect(), { right, bottom } = studio.stage.insets;
  const cx = box.left + (box.width - right) * 0.42, cy = box.top + (box.height - bottom) * 0.53, out = [];
  for (let i = 0; i <= 44; ++i) {
    const a = -0.6 - (1.8 * Math.PI * i) / 44, r = box.height * (0.115 + 0.028 * Math.cos(3 * a));
    const at = { x: cx + 1.25 * r * Math.cos(a), y: cy + r * Math.sin(a) };
    if (studio.stage.pick(at.x, at.y)) out.push(at);
  }
  return out;
});
await page.mouse.move(path[0].x, path[0].y);
await shoot();
await page.mouse.down();
for (let i = 1; i < path.length; ++i) {
  await page.mouse.move(path[i].x, path[i].y, { steps: 3 });
  await settled(page);
  if (i % 2 === 0) await shoot();
}
await page.mouse.up();
await settled(page);
await shoot();
await page.click("#mode-turn");
await page.focus("#view");
for (let i = 0; i < 12; ++i) {
  await page.keyboard.press(i < 6 ? "ArrowRight" : "ArrowLeft");
  await settled(page);
  await shoot();
}
await close();
console.log(`${frames} frames`);
