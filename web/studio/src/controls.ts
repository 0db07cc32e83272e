// What the buttons, lists and sliders do.
import { numberText } from "../../../viewer/src/numbers";
import type { App } from "./app";
import { element, fillSelect, toClipboard } from "./dom";
import type { Task } from "./engine";
import { examples } from "./examples";
import { connectKeys } from "./keys";
import { connectSaving } from "./save-menu";

export function connectControls(app: App): void {
  const { engine, stage, files } = app, { library } = engine;
  const on = (id: string, type: string, act: (event: Event) => void) => element(id).addEventListener(type, act);
  const list = element<HTMLSelectElement>("examples"), file = element<HTMLInputElement>("file");
  fillSelect(list, [{ value: "", text: "Examples" }, ...examples.map(({ id, title }) => ({ value: id, text: title }))], "");
  on("examples", "change", () => {
    const example = examples.find(({ id }) => id === list.value);
    if (example) void files.openExample(example);
  });
  file.accept = [...library.extensions.surfaces, ...library.extensions.volumes, ...library.extensions.sources].join(",");
  on("open", "click", () => file.click());
  on("file", "change", () => {
    const [chosen] = file.files ?? [];
    file.value = "";
    if (chosen) void files.openFiles([chosen]);
  });
  const box = element("stage");
  document.addEventListener("dragover", (event) => {
    event.preventDefault();
    box.classList.add("over");
  });
  document.addEventListener("dragleave", (event) => { if (!event.relatedTarget) box.classList.remove("over"); });
  document.addEventListener("drop", (event) => {
    event.preventDefault();
    box.classList.remove("over");
    void files.openFiles([...event.dataTransfer?.files ?? []]);
  });
  on("task", "change", () => {
    app.use({ task: element<HTMLSelectElement>("task").value as Task, method: "", options: {} });
  });
  on("method", "change", () => {
    app.use({ ...app.settings, method: element<HTMLSelectElement>("method").value, options: {} });
  });
  on("shown", "change", () => app.showAnswer());
  for (const id of ["lines", "wires", "marks"]) on(id, "change", () => app.usePicture());
  on("spacing", "input", () => {
    const step = stage.skin?.steps[Number(element<HTMLInputElement>("spacing").value)] ?? 0;
    stage.setLines(element<HTMLInputElement>("lines").checked, step, element<HTMLInputElement>("wires").checked);
    element("spacing-text").textContent = step ? `every ${numberText(step)}` : "";
  });
  on("home", "click", () => stage.reset());
  on("cancel", "click", () => engine.cancel());
  on("link", "click", () => void files.linkText().then(async (text) => {
    window.history.replaceState(null, "", text.slice(text.indexOf("#"))); // the address keeps its token, for reloads
    const limits = window.location.search ? ". It opens what was drawn behind the address of any page of this file" : "";
    app.toast(await toClipboard(text) ? `Link copied (${text.length} characters)${limits}` : "The link is in the address bar");
  }));
  on("theme", "click", () => app.useTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark"));
  on("panel-toggle", "click", () => {
    const open = element("panel").classList.toggle("open");
    element("panel-toggle").ariaExpanded = String(open);
  });
  window.addEventListener("hashchange", () => void files.followAddress());
  connectKeys(app, stage);
  connectSaving(app, engine, stage);
  stage.controls.addEventListener("start", () => app.leave());
}
