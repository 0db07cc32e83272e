// Starts the installed Chromium on a page from disk and gathers what it complains about.
import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { chromium } from "playwright-core";

function executable() {
  if (process.env.CHROMIUM) return process.env.CHROMIUM;
  for (const name of ["chromium", "chromium-browser", "google-chrome"]) {
    try {
      return execFileSync("which", [name], { encoding: "utf8" }).trim();
    } catch {
      continue;
    }
  }
  throw new Error("no Chromium found: set CHROMIUM to its path");
}

const flags = [
  "--headless", "--no-sandbox", "--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader",
  "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];

export async function openPage(url, { extraFlags = [], ...options } = {}) {
  const folder = mkdtempSync(join(tmpdir(), "littoral-viewer-"));
  const context = await chromium.launchPersistentContext(folder, {
    executablePath: executable(),
    args: [...flags, ...extraFlags],
    viewport: { width: 900, height: 640 },
    ...options,
  });
  const page = await context.newPage();
  const errors = [], requests = [];
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  await page.goto(url);
  return {
    page, errors, requests,
    async close() {
      await context.close();
      rmSync(folder, { recursive: true, force: true });
    },
  };
}

/// Counts the pixels that an action changes.
export async function changed(page, act) {
  await page.evaluate(() => { window.was = littoral.pixels(); });
  await act();
  await page.waitForTimeout(150);
  return page.evaluate(() => {
    const now = littoral.pixels();
    let count = 0;
    for (let i = 0; i < now.length; i += 4) {
      if (now[i] !== was[i] || now[i + 1] !== was[i + 1] || now[i + 2] !== was[i + 2]) ++count;
    }
    return count;
  });
}
