// node test/screenshot.mjs PAGE.html OUT.png [WIDTH HEIGHT]: what a page shows once it is at rest.
import { pathToFileURL } from "node:url";
import { resolve } from "node:path";
import { openPage } from "./browser.mjs";

const [file, out, width = "720", height = "540"] = process.argv.slice(2);
const viewport = { width: Number(width), height: Number(height) };
const shown = await openPage(pathToFileURL(resolve(file)).href, { colorScheme: "light", viewport });
try {
  await shown.page.waitForFunction(() => window.littoral?.frames() > 0, null, { timeout: 300000 });
  await shown.page.waitForFunction(() => window.littoral.settled(), null, { timeout: 600000 });
  await shown.page.screenshot({ path: out });
  if (shown.errors.length) throw new Error(shown.errors.join("\n"));
} finally {
  await shown.close();
}
