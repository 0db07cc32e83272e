// What is opened: files, examples, links; and the source file and the link of what is drawn.
import type { Surface } from "littoral/inline";
import type { App } from "./app";
import { element } from "./dom";
import type { GivenFiles } from "./backend";
import { fromSources, isEmpty, toSources, type Drawing } from "./drawing";
import type { Task } from "./engine";
import { examples, type Example } from "./examples";
import type { Chosen } from "./forms";
import { contentHash, pack, unpack } from "./packed";

/** What a link carries. */
interface Linked {
  v: 1;
  example?: string;
  hash?: string;
  name?: string;
  sources: string;
  sourcesName: string;
  task: Task;
  method: string;
  options: Chosen;
  camera: string;
}

const largest = 1.5e9; // bytes of a file that are tried

const joined = <K extends string, T>(key: K, a: readonly T[] = [], b: readonly T[] = []) =>
  a.length + b.length ? { [key]: [...a, ...b] } as Record<K, T[]> : {};

function isLinked(value: unknown): value is Linked {
  const linked = value as Partial<Linked> | null, { options } = linked ?? {};
  return linked?.v === 1 && typeof options === "object" && options !== null &&
    [linked.sources, linked.sourcesName, linked.task, linked.method, linked.camera, ...Object.values(options)]
      .every((text) => typeof text === "string");
}

export class Files {
  private example: string | null = null;
  private hash = "";
  private linked: Linked | null = null; // waits for its mesh

  constructor(private readonly app: App) {}

  /** What the address asks for, or an example. */
  async begin(): Promise<void> {
    const given = await this.app.engine.library.given?.();
    if (given) {
      element<HTMLSelectElement>("examples").value = "";
      await this.show(given.name, given.hash, null, () => this.app.engine.loadGiven(given));
      await this.readGiven(given.sources);
    }
    if (!await this.followAddress() && !given) await this.openExample(examples[0]);
  }

  /** All of them together. */
  private async readGiven(files: GivenFiles["sources"]): Promise<void> {
    const { surface } = this.app.engine;
    if (!surface || !files.length) return;
    const drawings = await Promise.all(files.map(async ({ name, bytes }) => fromSources(await surface.readSources(bytes, name))));
    this.app.history.reset({
      strokes: drawings.flatMap(({ strokes }) => strokes), points: drawings.flatMap(({ points }) => points),
      beside: drawings.reduce((sum, { beside }) => ({
        ...joined("spaceCurves", sum.spaceCurves, beside.spaceCurves), ...joined("chains", sum.chains, beside.chains),
      }), {} as Drawing["beside"]),
    });
    this.app.changed();
  }

  /** False where the address carries no link. */
  async followAddress(): Promise<boolean> {
    const packed = window.location.hash.slice(1);
    if (!packed) return false;
    let linked: unknown;
    try {
      linked = await unpack(packed);
    } catch {
      linked = null;
    }
    if (isLinked(linked)) {
      await this.follow(linked);
      return true;
    }
    if (!this.app.engine.surface) await this.openExample(examples[0]);
    this.app.message("The link cannot be read: was it cut off?");
    return true;
  }

  // ------------------------------------------------------------------------- files and examples

  async openExample(example: Example): Promise<boolean> {
    element<HTMLSelectElement>("examples").value = example.id;
    if (!await this.load(await example.bytes(), example.file, example.id)) return false;
    const text = await example.sources();
    if (text) await this.readSources(text, "sources.txt", true);
    return true;
  }

  async openFile(file: File): Promise<void> {
    const name = file.name.toLowerCase(), extension = name.slice(name.lastIndexOf("."));
    const { sources, surfaces, volumes } = this.app.engine.library.extensions;
    if (file.size > largest)
      return this.app.message(`${file.name} has ${(file.size / 1e9).toFixed(1)} GB, more than a page can hold. The command line takes it.`);
    const bytes = new Uint8Array(await file.arrayBuffer());
    const onlySources = sources.includes(extension) && !surfaces.includes(extension) && !volumes.includes(extension);
    if (onlySources) await this.readSources(bytes, file.name);
    else if (await this.load(bytes, file.name, null)) element<HTMLSelectElement>("examples").value = "";
  }

  private load(bytes: Uint8Array, name: string, example: string | null): Promise<boolean> {
    // The library may take the bytes along to its worker.
    return this.show(name, contentHash(bytes), example, () => this.app.engine.load(bytes.slice(), name));
  }

  private async show(name: string, hash: string, example: string | null, read: () => Promise<Surface>): Promise<boolean> {
    this.app.message(null);
    try {
      const surface = await read();
      this.example = example;
      this.hash = hash;
      this.app.begin(surface);
      if (this.linked?.hash === hash && example === null) await this.follow(this.linked);
      return true;
    } catch (error) {
      this.app.message(`${name} cannot be opened.\n${(error as Error).message}`);
      this.app.idle();
      return false;
    }
  }

  /** Takes the place of what is drawn, as a step that can be undone unless it is the first. */
  private async readSources(text: string | Uint8Array, name: string, first = false): Promise<void> {
    const { surface } = this.app.engine;
    if (!surface) return;
    try {
      const drawing = fromSources(await surface.readSources(text, name));
      if (first) this.app.history.reset(drawing);
      else this.app.history.change(drawing, null);
      this.app.message(null);
      this.app.changed();
    } catch (error) {
      this.app.message(`${name} cannot be used here.\n${(error as Error).message}`);
    }
  }

  // ------------------------------------------------------------------------- links

  async linkText(): Promise<string> {
    const { name, text } = await this.sourceFile();
    const linked: Linked = {
      v: 1, ...(this.example ? { example: this.example } : { hash: this.hash, name: this.app.engine.surface?.name ?? "" }),
      sources: text, sourcesName: name, task: this.app.settings.task, method: this.app.settings.method,
      options: this.app.settings.options, camera: this.app.stage.cameraText,
    };
    // Never with what stands before the #: of `view --edit` that is the token.
    return `${window.location.href.split(/[?#]/)[0]}#${await pack(linked)}`;
  }

  private async follow(linked: Linked): Promise<void> {
    const example = examples.find(({ id }) => id === linked.example);
    this.linked = null;
    if (linked.example !== undefined && !example)
      return this.app.message(`This link belongs to an example that this page does not have: ${linked.example}.`);
    if (example) {
      element<HTMLSelectElement>("examples").value = example.id;
      if (!await this.load(await example.bytes(), example.file, example.id)) return;
    } else if (linked.hash !== this.hash) {
      this.linked = linked;
      return this.app.message(`This link belongs to the file ${linked.name ?? ""} (content ${linked.hash ?? "unknown"}). Open or drop that file here.`);
    }
    this.app.use({ task: linked.task === "regions" ? "regions" : "distance", method: linked.method, options: linked.options });
    if (linked.sources) await this.readSources(linked.sources, linked.sourcesName, true);
    this.app.stage.setCamera(linked.camera);
  }

  /** The text of a source file, as the command line takes it. */
  async sourceFile(): Promise<{ name: string; text: string }> {
    const { surface } = this.app.engine, sources = toSources(this.app.history.drawing);
    const name = sources.spaceCurves?.length ? "sources.json" : "sources.txt";
    return { name, text: surface && !isEmpty(sources) ? await surface.writeSources(sources, name) : "" };
  }
}
