// node record.mjs FOLDER: draws a curve on Spot in the studio and writes the frames as PNG.
import { mkdirSync } from "node:fs";
import { join } from "node:path";
import { openStudio, settled } from "./test/helpers.mjs";

const folder = process.argv[2];
mkdirSync(folder, { recursive: true });
const { page, close } = await openStudio({ example: "spot", viewport: { width: 960, height: 600 } });
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

// A ring on the flank: the largest that nothing hides, from the screen's point of view.
const path = await page.evaluate(() => {
  const box = document.getElementById("view").getBoundingClientRect(), eye = studio.stage.camera.position;
  const around = (cx, cy, r) => Array.from({ length: 37 }, (_, i) => {
    const a = -0.6 - (2 * Math.PI * i) / 36, s = r * (1 + 0.16 * Math.cos(3 * a));
    return { x: cx + s * Math.cos(a), y: cy + s * Math.sin(a) };
  });
  for (let r = 0.22 * box.height; r > 20; r -= 4) {
    for (let x = box.left; x < box.right; x += 8) for (let y = box.top; y < box.bottom; y += 8) {
      const path = around(x, y, r), far = path.map((p) => studio.stage.pick(p.x, p.y)?.place.distanceTo(eye));
      if (far.every((d, i) => d !== undefined && (i === 0 || Math.abs(d - far[i - 1]) < 0.06))) return path;
    }
  }
  return [];
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
