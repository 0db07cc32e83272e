// The menu that saves.
import type { Report } from "littoral/inline";
import type { App } from "./app";
import { download, element, fillSelect } from "./dom";
import type { Engine } from "./engine";
import { linesAsSvg, picture } from "./saving";
import type { Stage } from "./stage";

const fieldFormats = [".ply", ".glb", ".csv", ".npy", ".npz", ".obj", ".vtp", ".txt"], lineFormats = [".svg", ".obj", ".ply", ".vtp"];
const surfaceFormats = [".ply", ".obj", ".stl", ".glb", ".3mf", ".off"], sampleFormats = [".npz", ".tar"];

export function connectSaving(app: App, engine: Engine, stage: Stage): void {
  const menu = element<HTMLDetailsElement>("save-menu");
  const stem = () => (engine.surface?.name ?? "littoral").replace(/\.[^.]*$/, "").replace(/[^\w.-]+/g, "_") || "littoral";
  const choices = (formats: string[]) => formats.map((value) => ({ value, text: value }));
  const fieldFormat = element<HTMLSelectElement>("field-format"), lineFormat = element<HTMLSelectElement>("lines-format");
  fillSelect(fieldFormat, choices(fieldFormats), fieldFormats[0]);
  fillSelect(lineFormat, choices(lineFormats), lineFormats[0]);
  const offsetFormat = element<HTMLSelectElement>("offsets-format"), spaceFormats = lineFormats.slice(1);
  fillSelect(offsetFormat, choices(spaceFormats), spaceFormats[0]);

  const repairedFormat = element<HTMLSelectElement>("repaired-format"), sampleFormat = element<HTMLSelectElement>("samples-format");
  fillSelect(repairedFormat, choices(surfaceFormats), surfaceFormats[0]);
  fillSelect(sampleFormat, choices(sampleFormats), sampleFormats[0]);

  const connect = (id: string, save: () => Promise<string>) => element(id).addEventListener("click", () => {
    menu.open = false;
    save().then((text) => app.toast(text), (error: Error) => app.toast(`Not saved: ${error.message}`));
  });
  const field = () => {
    const { answer } = app;
    if (!answer || !engine.surface) throw new Error("there is no field yet; draw something");
    if (answer.preview) throw new Error("what is shown is a preview, whose numbers are not those of the method");
    return { values: { values: answer.values, refined: answer.refined }, surface: engine.surface };
  };
  connect("save-sources", async () => {
    const { name, text } = await app.files.sourceFile();
    if (!text) throw new Error("nothing is drawn yet");
    const extension = name.slice(name.lastIndexOf("."));
    download(`${stem()}-sources${extension}`, new Blob([text], { type: "text/plain" }));
    return "Sources saved";
  });
  connect("save-field", async () => {
    const { values, surface } = field(), name = `${stem()}-${app.answer!.name}${fieldFormat.value}`;
    download(name, new Blob([await surface.writeField(values, name) as BlobPart]));
    return `${name} saved`;
  });
  connect("save-lines", async () => {
    const { values, surface } = field(), { spacing } = app;
    if (app.shown !== "field") throw new Error("the isolines in the picture are not those of the distance; show that");
    if (!(spacing > 0)) throw new Error("there are no isolines in the picture");
    const lines = await surface.isolines(values, { spacing }), name = `${stem()}-isolines${lineFormat.value}`;
    if (lineFormat.value === ".svg")
      download(name, new Blob([linesAsSvg(stage, lines, app.history.drawing, app.layout, name)], { type: "image/svg+xml" }));
    else download(name, new Blob([await surface.writeLines(lines, name) as BlobPart]));
    return `${name} saved`;
  });
  connect("save-offsets", async () => {
    const words = element<HTMLInputElement>("offsets").value.split(/[\s,;]+/).filter(Boolean), distances = words.map(Number);
    if (!distances.length) throw new Error("which distances? Write them beside the button");
    if (!distances.every(Number.isFinite)) throw new Error(`${words.find((word) => !Number.isFinite(Number(word)))} is not a number`);
    const lines = await app.offsets(distances), name = `${stem()}-offsets${offsetFormat.value}`;
    download(name, new Blob([await engine.surface!.writeLines(lines, name) as BlobPart]));
    return `${name} saved`;
  });
  /** What a report says that somebody should know who takes the file along. */
  const doubts = ({ status, warnings }: Report) =>
    status === "converged" && !warnings.length ? "" : `, ${status}: ${warnings.map(({ message }) => message).join("; ")}`;
  connect("save-repaired", () => engine.apart("repairing", async (surface, call) => {
    const { surface: made, report } = await surface.repair({}, {}, {}, call), name = `${stem()}-repaired${repairedFormat.value}`;
    const text = `${made.counts.faces.toLocaleString("en")} faces`;
    download(name, new Blob([await made.write(name, call) as BlobPart]));
    made.dispose();
    return `${name} saved, ${text}${doubts(report)}`;
  }));
  connect("save-samples", () => engine.apart("sampling", async (surface, call) => {
    const name = `${stem()}-samples${sampleFormat.value}`, { file, card, report } = await surface.samples(name, {}, {}, {}, call);
    download(name, new Blob([file as BlobPart]));
    download(`${stem()}-samples.json`, new Blob([card], { type: "application/json" }));
    return `${name} and its card saved${doubts(report)}`;
  }));
  connect("save-picture", async () => {
    const legend = element<HTMLCanvasElement>("legend"), blob = await picture(stage, legend.hidden ? null : legend);
    if (!blob) throw new Error("the browser made no picture");
    download(`${stem()}.png`, blob);
    return `${stem()}.png saved`;
  });
}
