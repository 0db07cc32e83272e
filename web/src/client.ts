// The interface of the package, on one worker.
import type * as api from "../package/littoral";
import { request } from "./handles";
import { type Call, Process, type RunningWorker } from "./process";
import { VolumeInWorker } from "./space";
import { bytesOf, numbers, SurfaceInWorker } from "./surface";

interface About {
  version: string;
  methods: string;
  surfaces: string;
  volumes: string;
  sources: string;
}

type Entry = Omit<api.OptionInfo, "low" | "high" | "choices"> &
  { low?: number | string; high?: number | string; choices?: string[] };
type Listed = Omit<api.MethodInfo, "options"> & { for: string; options: Entry[] };

/** JSON has no word for what is not finite; the library writes one. */
const bound = (value: number | string | undefined, otherwise: number) =>
  typeof value === "number" ? value : value === "inf" ? Infinity : value === "-inf" ? -Infinity : otherwise;

function familiesOf(json: string): api.MethodFamily[] {
  const byTitle = new Map<string, api.MethodInfo[]>();
  for (const { for: title, options, ...method } of JSON.parse(json) as Listed[]) {
    const methods = byTitle.get(title) ?? [];
    byTitle.set(title, methods);
    methods.push({
      ...method,
      options: options.map((option) => ({
        ...option,
        low: bound(option.low, -Infinity),
        high: bound(option.high, Infinity),
        choices: option.choices ?? [],
      })),
    });
  }
  return [...byTitle].map(([title, methods]) => ({ title, methods }));
}

export class Client implements api.Littoral {
  readonly version; readonly families; readonly extensions;

  constructor(protected readonly process: Process, about: About) {
    const words = (text: string) => text.split(" ").filter((word) => word !== "");
    this.version = about.version;
    this.families = familiesOf(about.methods);
    this.extensions = { surfaces: words(about.surfaces), volumes: words(about.volumes), sources: words(about.sources) };
  }

  loadSurface(bytes: Uint8Array | ArrayBuffer, name: string, call: Call = {}) {
    return SurfaceInWorker.make(this.process, "loadSurface", [bytesOf(bytes), name], name, call);
  }

  makeSurface({ positions, corners = [], offsets, normals = [] }: api.SurfaceData, call: Call = {}) {
    const args = [numbers(positions), numbers(corners), offsets && numbers(offsets), numbers(normals)];
    return SurfaceInWorker.make(this.process, "makeSurface", args, "arrays", call);
  }

  loadVolume(bytes: Uint8Array | ArrayBuffer, name: string, call: Call = {}) {
    return VolumeInWorker.make(this.process, "loadVolume", [bytesOf(bytes), name], name, call);
  }

  makeVolume(grid: api.Grid, values: ArrayLike<number>, call: Call = {}) {
    return VolumeInWorker.make(this.process, "makeVolume", [grid, numbers(values)], "values", call);
  }

  async memory() {
    return await request(this.process, "memory", [], [], {}) as number;
  }

  close() {
    this.process.close();
  }
}

type Made = new (process: Process, about: About) => Client;

export async function openWith<C extends Made>(start: () => Promise<RunningWorker>, made: C): Promise<InstanceType<C>> {
  const process = new Process(start);
  return new made(process, await request(process, "about", [], [], {}) as About) as InstanceType<C>;
}
