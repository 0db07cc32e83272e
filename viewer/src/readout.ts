// What is under the cursor, and what a click pins and copies.
import type { Descended } from "./descent";
import { element, input, say } from "./elements";
import { fineOf, numberText } from "./numbers";
import type { Picked, ResultView } from "./view";

export class Readout {
  private pointer: { x: number; y: number } | null = null;
  private pinned: Picked | null = null;
  private readonly box = element("readout");
  private readonly pin = element("pin");

  constructor(private readonly view: ResultView, private readonly stage: HTMLElement) {
    const { canvas } = view;
    let down: { x: number; y: number } | null = null;
    const place = (event: PointerEvent) => {
      const at = canvas.getBoundingClientRect();
      return { x: event.clientX - at.left, y: event.clientY - at.top };
    };
    canvas.addEventListener("pointermove", (event) => {
      this.pointer = event.buttons ? null : place(event);
      requestAnimationFrame(() => this.update());
    });
    canvas.addEventListener("pointerleave", () => {
      this.pointer = null;
      this.box.hidden = true;
    });
    canvas.addEventListener("pointerdown", (event) => { down = event.isPrimary && event.button === 0 ? place(event) : null; });
    canvas.addEventListener("pointerup", (event) => {
      const at = place(event);
      if (down && Math.hypot(at.x - down.x, at.y - down.y) < 4) this.pinAt(at.x, at.y);
      down = null;
    });
    for (const id of ["path", "field"]) element(id).addEventListener("change", () => this.follow());
    element("pin-close").addEventListener("click", () => this.unpin());
  }

  /** In words: value, place, and the node. */
  describe(picked: Picked, way: Descended | null = null): string {
    const { field, fine, scene } = this.view.panes[picked.pane], lines: string[] = [];
    if (field && picked.value !== null) {
      const label = field.discrete ? field.labels.get(picked.value) : undefined;
      lines.push(`${field.name} ${label ?? (picked.value === Infinity ? "unreachable" : numberText(picked.value, fine))}`);
    }
    lines.push(picked.place.map((x) => numberText(x, fineOf(0, scene.radius))).join("  "));
    if (way && way.places.length > 3)
      lines.push(`way ${numberText(way.length * scene.radius)}${way.reached ? "" : ", which ends at no source"}`);
    if (picked.node) lines.push(picked.node);
    return lines.join("\n");
  }

  valueText(picked: Picked): string {
    return this.describe(picked).split("\n")[0];
  }

  pinAt(x: number, y: number): void {
    const picked = this.view.pick(x, y);
    if (!picked) {
      this.unpin();
      return;
    }
    this.view.panes.forEach((pane) => pane.showWay(null));
    this.pinned = picked;
    const text = this.follow();
    this.pin.hidden = false;
    this.place();
    const copied = picked.node ?? text;
    say(`Pinned: ${text}`);
    void navigator.clipboard?.writeText(copied).then(
      () => {
        if (this.pinned === picked && picked.node) element("pin-text").textContent = `${text}  (copied)`;
      },
      () => undefined,  // where copying is forbidden, the text is there to read
    );
  }

  /** What the pin says, and the way from it to the source. */
  private follow(): string {
    const picked = this.pinned;
    if (!picked) return "";
    const pane = this.view.panes[picked.pane], wanted = input("path").checked && picked.triangle !== null && picked.b !== null;
    const now = picked.triangle !== null && picked.b ? { ...picked, value: pane.valueAt(picked.triangle, picked.b) } : picked;
    const way = wanted && picked.b && picked.triangle !== null ? pane.wayFrom(picked.triangle, picked.b) : null;
    pane.showWay(way?.places ?? null);
    this.way = way;
    this.view.ask();
    return (element("pin-text").textContent = this.describe(now, way));
  }

  /** From the pin, if it is shown. */
  way: Descended | null = null;

  unpin(): void {
    if (this.pinned) this.view.panes[this.pinned.pane].showWay(null);
    this.way = null;
    this.view.ask();
    this.pinned = null;
    this.pin.hidden = true;
  }

  get pinnedNow(): Picked | null {
    return this.pinned;
  }

  /** After a frame: the read-out at the cursor, the pin at its place. */
  update(): void {
    this.place();
    const at = this.pointer, picked = at ? this.view.pick(at.x, at.y) : null;
    this.box.hidden = !picked;
    if (!at || !picked) return;
    this.box.textContent = this.valueText(picked);
    this.box.style.left = `${Math.min(at.x, this.stage.clientWidth - this.box.offsetWidth - 20)}px`;
    this.box.style.top = `${Math.min(at.y, this.stage.clientHeight - 44)}px`;
  }

  private place(): void {
    if (!this.pinned) return;
    const at = this.view.project(this.pinned.spot, this.pinned.pane);
    this.pin.style.left = `${at.x}px`;
    this.pin.style.top = `${at.y}px`;
  }
}
