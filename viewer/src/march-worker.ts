// Runs in a worker: takes a grid once, then levels, and answers with surfaces.
import { march, type Grid } from "./march";

interface Port {
  onmessage: ((event: MessageEvent<{ grid?: Grid; level?: number }>) => void) | null;
  postMessage(message: unknown, transfer: Transferable[]): void;
}
const port = globalThis as unknown as Port;
let grid: Grid | null = null;
port.onmessage = ({ data }) => {
  if (data.grid) grid = data.grid;
  if (data.level === undefined || !grid) return;
  const shell = march(grid, data.level);
  port.postMessage({ level: data.level, shell }, [shell.positions.buffer, shell.normals.buffer, shell.triangles.buffer] as Transferable[]);
};
