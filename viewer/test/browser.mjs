// Starts the installed Chromium on a page from disk and gathers what it complains about. FIREFOX=/usr/bin/firefox takes
// that one instead, by WebDriver BiDi; it draws with WebGL only where there is a display (xvfb-run -a ...).
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { pathToFileURL } from "node:url";
import playwright from "playwright-core";

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
  "--headless", "--no-sandbox", ...(process.env.GPU ? ["--use-gl=angle"] : ["--disable-gpu", "--use-gl=angle", "--use-angle=swiftshader"]),
  "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run", "--disable-background-networking",
  "--disable-component-update", "--disable-sync",
];

/// Whether edges are smooth. Most tests judge other things, and without a graphics card that takes a seventh of their time.
export const drawing = { smooth: !process.env.NODE_TEST_CONTEXT };
const edges = () => (drawing.smooth ? [] : ["--webgl-antialiasing-mode=none"]);

// One browser serves the pages of a test file; it ends soon after the last of them.
let running = null, open = 0, ending = 0;
export const firefox = process.env.FIREFOX;
/// Of tests that need what playwright offers of Chromium alone: downloads, touches, the clipboard.
export const chromiumOnly = { skip: firefox ? "needs Chromium" : false };
// Firefox takes the scheme from its profile: what drives it cannot change that of a page.
const launch = (extraFlags, scheme) => firefox
  ? playwright._bidiFirefox.launch({
    executablePath: firefox, headless: false,
    firefoxUserPrefs: { "webgl.force-enabled": true, "layout.css.prefers-color-scheme.content-override": scheme === "dark" ? 0 : 1 },
  })
  : playwright.chromium.launch({ executablePath: executable(), args: [...flags, ...edges(), ...extraFlags] });

async function contextOf(extraFlags, options) {
  if (extraFlags.length > 0 || (firefox && options.colorScheme === "dark")) {
    const browser = await launch(extraFlags, options.colorScheme);
    return { context: await browser.newContext(options), end: () => browser.close() };
  }
  clearTimeout(ending);
  ++open;
  running ??= launch([]);
  const browser = await running, context = await browser.newContext(options);
  return {
    context,
    async end() {
      await context.close();
      if (--open > 0) return;
      ending = setTimeout(() => {
        running = null;
        void browser.close();
      }, 200);
    },
  };
}

export async function openPage(url, { extraFlags = [], prepare, ...options } = {}) {
  const { context, end } = await contextOf(extraFlags, { viewport: { width: 900, height: 640 }, ...options });
  const page = await context.newPage();
  const errors = [], requests = [];
  page.on("console", (message) => {
    if (message.type() === "error") errors.push(message.text());
  });
  page.on("pageerror", (error) => errors.push(String(error)));
  page.on("request", (request) => requests.push(request.url()));
  await prepare?.(page);
  await page.goto(url);
  return {
    page, errors, requests,
    close: end,
  };
}

/// Opens the page that an environment variable names and waits until it has been drawn.
export async function openResult(variable, options, timeout = 30000) {
  const file = process.env[variable];
  assert.ok(file && existsSync(file), `set ${variable} to a page made by the library`);
  const url = pathToFileURL(resolve(file)).href;
  const shown = await openPage(url, { colorScheme: "light", ...options });
  await shown.page.waitForFunction(() => window.littoral?.frames() > 0, null, { timeout });
  return { ...shown, url };
}

/// The page has complained about nothing and asked for nothing but itself.
export function assertAlone({ errors, requests, url }) {
  assert.deepEqual(errors, []);
  const others = requests.filter((r) => !/^(data|blob):/.test(r) && r.split("#")[0] !== url);
  assert.deepEqual(others, []);
  assert.equal(requests.filter((r) => r.split("#")[0] === url).length, firefox ? 0 : 1);  // which says nothing of files
}

const axe = createRequire(import.meta.url).resolve("axe-core/axe.min.js");

/// axe-core finds nothing that those who cannot see, hear or point would miss: names, roles, contrast, order.
export async function assertAccessible(page) {
  await page.addScriptTag({ path: axe });
  const found = await page.evaluate(async () => {
    const { violations } = await axe.run(document, { resultTypes: ["violations"], preload: false });
    return violations.flatMap(({ id, nodes }) => nodes.map(({ target, any }) => `${id}: ${target} (${any.map((one) => one.message).join("; ")})`));
  });
  assert.deepEqual(found, []);
}

/// Moves the slider of that name.
export const drag = (page, id, value) => page.evaluate(([name, x]) => {
  const slider = document.getElementById(name);
  slider.value = String(x);
  slider.dispatchEvent(new Event("input"));
}, [id, value]);

/// Watches an element from now on. What comes back waits until it has been shown, however briefly, and gives what `look` finds then.
export async function whenShown(page, id, look = (element) => element.textContent) {
  await page.evaluate(`window.seen = new Promise((done, fail) => {
    const element = document.getElementById(${JSON.stringify(id)});
    new MutationObserver((_, observer) => {
      if (element.hidden) return;
      observer.disconnect();
      done((${look})(element));
    }).observe(element, { attributes: true });
    setTimeout(() => fail(new Error("#${id} was not shown")), 30000);
  }), undefined`);
  return () => page.evaluate(() => window.seen);
}

/// Waits for so many frames of the page: one for what was asked for, one more if a size or a scheme changes first.
export const frames = (page, count = 2) => page.evaluate(async (n) => {
  for (let i = 0; i < n; ++i) await new Promise(requestAnimationFrame);
}, count);

/// Counts the pixels that an action changes.
export async function changed(page, act) {
  await page.evaluate(() => { window.was = littoral.pixels(); });
  await act();
  await frames(page);
  return page.evaluate(() => {
    const now = littoral.pixels();
    let count = 0;
    for (let i = 0; i < now.length; i += 4) {
      if (now[i] !== was[i] || now[i + 1] !== was[i + 1] || now[i + 2] !== was[i + 2]) ++count;
    }
    return count;
  });
}
