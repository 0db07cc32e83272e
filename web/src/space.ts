// Signed distance in space, and volumes of it.
import type * as api from "../package/littoral";
import { forgotten, Remote, request } from "./handles";
import type { Call, Process } from "./process";
import { numbers, reportOf, type SurfaceDescription, SurfaceInWorker } from "./surface";

type Box = api.Sdf["bounds"];

export class SdfInWorker implements api.Sdf {
  private constructor(private readonly process: Process, private readonly remote: Remote,
                      readonly report: api.Report, readonly bounds: Box) {
    forgotten.register(this, remote, this);
  }

  static async make(process: Process, op: string, args: unknown[], call: Call): Promise<SdfInWorker> {
    const remote = new Remote(process, op, args);
    const { report, bounds } = await request(process, op, args, [remote], call) as { report: string; bounds: Box };
    return new SdfInWorker(process, remote, reportOf(report), bounds);
  }

  async at(points: ArrayLike<number>, call: Call = {}) {
    return await this.ask("sdfAt", numbers(points), call) as Float64Array;
  }
  async slice(slice: api.Slice, call: Call = {}) {
    return await this.ask("sdfSlice", slice, call) as Float64Array;
  }
  async withGradients(points: ArrayLike<number>, call: Call = {}) {
    return await this.ask("sdfGradients", numbers(points), call) as { values: Float64Array; gradients: Float64Array };
  }
  async closest(points: ArrayLike<number>, call: Call = {}) {
    return await this.ask("sdfClosest", numbers(points), call) as api.NearestPoints;
  }
  async windingNumber(points: ArrayLike<number>, call: Call = {}) {
    return await this.ask("sdfWinding", numbers(points), call) as Float64Array;
  }
  async confidence(points: ArrayLike<number>, call: Call = {}) {
    return await this.ask("sdfConfidence", numbers(points), call) as Float64Array;
  }
  sample(grid: api.GridOptions | api.Grid = {}, call: Call = {}) {
    return VolumeInWorker.make(this.process, "sample", [this.remote, grid], "distance", call);
  }

  dispose() {
    forgotten.unregister(this);
    this.remote.dispose();
  }

  private ask(op: string, about: unknown, call: Call): Promise<unknown> {
    return request(this.process, op, [this.remote, about], [], call);
  }
}

export class VolumeInWorker implements api.Volume {
  private constructor(private readonly process: Process, private readonly remote: Remote,
                      readonly name: string, readonly grid: api.Grid) {
    forgotten.register(this, remote, this);
  }

  static async make(process: Process, op: string, args: unknown[], name: string, call: Call): Promise<VolumeInWorker> {
    const remote = new Remote(process, op, args);
    const grid = await request(process, op, args, [remote], call) as api.Grid;
    return new VolumeInWorker(process, remote, name, grid);
  }

  async values(call: Call = {}) {
    return await this.ask("volumeValues", [], call) as Float64Array;
  }
  async at(points: ArrayLike<number>, call: Call = {}) {
    return await this.ask("volumeAt", [numbers(points)], call) as Float64Array;
  }
  async slice(slice: api.Slice, call: Call = {}) {
    return await this.ask("volumeSlice", [slice], call) as Float64Array;
  }

  isosurface(level = 0, closeAtBox = false, call: Call = {}) {
    return SurfaceInWorker.make(this.process, "isosurface", [this.remote, level, closeAtBox], "isosurface", call);
  }

  async offsets(distances: readonly number[], { open = 0, close = 0 }: api.Morphology = {}, call: Call = {}) {
    const remotes = distances.map((distance) =>
      new Remote(this.process, "volumeOffsets", [this.remote, numbers([distance]), open, close]));
    const described = await request(this.process, "volumeOffsets", [this.remote, numbers(distances), open, close], remotes, call) as SurfaceDescription[];
    return described.map((surface, k) => new SurfaceInWorker(this.process, remotes[k], `offset ${distances[k]}`, surface));
  }

  signedDistance(meaning: "automatic" | "distance" | "mask" | "density" = "automatic", threshold?: number, call: Call = {}) {
    return SdfInWorker.make(this.process, "volumeDistance", [this.remote, meaning, threshold], call);
  }

  async write(name: string, call: Call = {}) {
    return await this.ask("writeVolume", [name], call) as Uint8Array;
  }

  dispose() {
    forgotten.unregister(this);
    this.remote.dispose();
  }

  private ask(op: string, args: unknown[], call: Call): Promise<unknown> {
    return request(this.process, op, [this.remote, ...args], [], call);
  }
}
