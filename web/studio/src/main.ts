// The page begins.
import { App } from "./app";
import { element } from "./dom";
import { makeToolbar } from "./panel";

function fail(error: unknown): void {
  const box = element("message");
  box.textContent = error instanceof Error && error.message === "no WebGL 2"
    ? "This browser does not offer WebGL 2, which the view needs. Turn on hardware acceleration or try another browser."
    : `The page cannot be shown: ${error instanceof Error ? error.message : String(error)}`;
  box.hidden = false;
  element("status").textContent = "Not started";
}

makeToolbar();
App.start().then((app) => Object.assign(window, { studio: app }), fail);
