// The same interface, answered by the program that serves the page: `littoral view --edit`.
import type * as api from "../package/littoral";
import { Client, openWith } from "./client";
import { request } from "./handles";
import { decode, encode } from "./message";
import type { Call, RunningWorker } from "./process";
import type { Reply, Request } from "./protocol";
import { SurfaceInWorker } from "./surface";

export * from "./errors";

/** What the program was started with. */
export interface GivenFiles {
  readonly name: string;
  /** Of its content. */
  readonly hash: string;
  readonly sources: readonly { readonly name: string; readonly bytes: Uint8Array }[];
}

/** Milliseconds after which, and at which distance, progress is asked for. */
const patience = 200;

async function textOf(answer: Response): Promise<string> {
  const text = await answer.text();
  try {
    return (JSON.parse(text) as { message: string }).message;
  } catch {
    return text || answer.statusText;
  }
}

/** The program on this machine, at the page's own address, whose token goes with every request. */
function program(): RunningWorker {
  const token = new URLSearchParams(window.location.search).get("token") ?? "";
  const page = Array.from(crypto.getRandomValues(new Uint8Array(8)), (x) => x.toString(16).padStart(2, "0")).join("");
  let hear: (reply: Reply) => void = () => {}, hearError: (what: string) => void = () => {};
  let calls = 0, ended = false;
  const send = (what: string, method: string, body?: Uint8Array<ArrayBuffer>) =>
    fetch(`/${what}?page=${page}&call=${calls}`, { method, headers: { Authorization: `Bearer ${token}` }, body });

  const watch = (call: number) => {
    const timer = setInterval(() => {
      send("progress", "GET").then((answer) => answer.json()).then(({ progress, stage }) => {
        if (call === calls && !ended && stage) hear({ progress, stage });
      }, () => {}); // the call itself fails too, and says so
    }, patience);
    return () => clearInterval(timer);
  };

  async function answered({ op, args, as, free, progress }: Request): Promise<void> {
    const stop = progress ? watch(++calls) : (++calls, () => {});
    try {
      const answer = await send("call", "POST", encode({ op, args, as, free }));
      const reply: Reply = answer.ok ? decode(new Uint8Array(await answer.arrayBuffer())) as Reply
        : { error: "InternalError", message: `littoral refuses: ${await textOf(answer)}` };
      stop();
      if (!ended && op !== "") hear(reply);
    } catch {
      stop();
      if (!ended) hearError("littoral has ended; start it again and open the address that it prints");
    }
  }

  return {
    post: (asked) => void answered(asked),
    onMessage: (listener) => { hear = listener; },
    onError: (listener) => { hearError = listener; },
    cancel: () => void send("cancel", "POST").catch(() => {}),
    end: () => { ended = true; },
  };
}

class NativeClient extends Client {
  /** Files of the machine, which do not go through the page. */
  async given(): Promise<GivenFiles | null> {
    return await request(this.process, "given", [], [], {}) as GivenFiles | null;
  }

  loadGiven({ name }: GivenFiles, call: Call = {}): Promise<api.Surface> {
    return SurfaceInWorker.make(this.process, "loadGiven", [], name, call);
  }
}

export function open(): Promise<NativeClient> {
  return openWith(async () => program(), NativeClient);
}
