// Runs in a worker: takes surfaces, and answers with the openness of their vertices; of several the newest counts.
import { follow, type Asked } from "./openness";

interface Port {
  onmessage: ((event: MessageEvent<Asked>) => void) | null;
  postMessage(message: unknown, transfer: Transferable[]): void;
}
const port = globalThis as unknown as Port, steps = follow((open, job) => port.postMessage({ open, job }, [open.buffer as ArrayBuffer]));
port.onmessage = ({ data }) => steps(data);
