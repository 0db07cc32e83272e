// What is opened: files, examples, links; and the source file and the link of what is drawn.
import type { Surface } from "littoral/inline";
import type { App } from "./app";
import { element } from "./dom";
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
      await this.readSources(given.sources, true);
    }
    if (!await this.followAddress() && !given) await this.openExample(examples[0]);
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
    if (text) await this.readSources([{ name: "sources.txt", bytes: text }], true);
    return true;
  }

  /** A surface, and what is drawn on it. */
  async openFiles(files: readonly File[]): Promise<void> {
    const { sources, surfaces, volumes } = this.app.engine.library.extensions;
    const drawn = files.filter(({ name }) => {
      const extension = name.slice(name.lastIndexOf(".")).toLowerCase();
      return sources.includes(extension) && !surfaces.includes(extension) && !volumes.includes(extension);
    });
    const [surface, ...more] = files.filter((file) => !drawn.includes(file)), huge = files.find(({ size }) => size > largest);
    if (huge)
      return this.app.message(`${huge.name} has ${(huge.size / 1e9).toFixed(1)} GB, more than a page can hold. The command line takes it.`);
    if (more.length)
      return this.app.message(`One surface at a time: ${[surface, ...more].map(({ name }) => name).join(", ")}.`);
    const bytesOf = async (file: File) => new Uint8Array(await file.arrayBuffer());
    if (surface) {
      if (!await this.load(await bytesOf(surface), surface.name, null)) return;
      element<HTMLSelectElement>("examples").value = "";
    }
    await this.readSources(await Promise.all(drawn.map(async (file) => ({ name: file.name, bytes: await bytesOf(file) }))));
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
      this.app.goOn(); // reading has cancelled what was being computed
      return false;
    }
  }

  /** All together they take the place of what is drawn, as a step that can be undone unless it is the first. */
  private async readSources(files: readonly { name: string; bytes: string | Uint8Array }[], first = false): Promise<void> {
    const { surface } = this.app.engine, drawings: Drawing[] = [];
    if (!surface || !files.length) return;
    for (const { name, bytes } of files) {
      try {
        drawings.push(fromSources(await surface.readSources(bytes, name)));
      } catch (error) {
        return this.app.message(`${name} cannot be used here.\n${(error as Error).message}`);
      }
    }
    const drawing: Drawing = {
      strokes: drawings.flatMap(({ strokes }) => strokes), points: drawings.flatMap(({ points }) => points),
      beside: drawings.reduce((sum, { beside }) => ({
        ...joined("spaceCurves", sum.spaceCurves, beside.spaceCurves), ...joined("chains", sum.chains, beside.chains),
      }), {} as Drawing["beside"]),
    };
    if (first) this.app.history.reset(drawing);
    else this.app.history.change(drawing, null);
    this.app.message(null);
    this.app.changed();
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
    if (linked.sources) await this.readSources([{ name: linked.sourcesName, bytes: linked.sources }], true);
    this.app.stage.setCamera(linked.camera);
  }

  /** The text of a source file, as the command line takes it. */
  async sourceFile(): Promise<{ name: string; text: string }> {
    const { surface } = this.app.engine, sources = toSources(this.app.history.drawing);
    const name = sources.spaceCurves?.length ? "sources.json" : "sources.txt";
    return { name, text: surface && !isEmpty(sources) ? await surface.writeSources(sources, name) : "" };
  }
}
