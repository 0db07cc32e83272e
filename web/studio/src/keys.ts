// What keys and the buttons of the toolbar do.
import type { App } from "./app";
import { canClose, reversed, withStroke } from "./drawing";
import { element } from "./dom";
import { listKeys } from "./panel";
import type { Stage } from "./stage";
import type { Mode } from "./tools";

const help: readonly (readonly [string, string])[] = [
  ["V C F P", "turn and select; curve by clicks; draw freehand; points"],
  ["Click", "in Turn: selects, or copies the place as a line of a source file"],
  ["Drag a node", "moves it"],
  ["Enter, Esc", "ends the curve; Esc closes messages first"],
  ["L", "closes or opens the curve"],
  ["R", "reverses it: the other side is positive"],
  ["U", "signed or unsigned"],
  ["S", "snaps to vertices"],
  ["Del", "deletes the node, curve or point"],
  ["Ctrl Z, Ctrl Shift Z", "undo, redo"],
  ["Space", "a node at the middle of the picture"],
  ["Arrows, + −", "turn, zoom; with Shift move"],
  ["H", "first view"],
  ["I W O", "isolines; sides of faces; what is drawn"],
  ["Ctrl O, Ctrl S", "open a file; save the sources"],
  ["Touch", "one finger draws, two move the camera"],
];

export function connectKeys(app: App, stage: Stage): void {
  const { history, tools } = app;
  const change = (act: (index: number) => void) => () => {
    const { selection } = history;
    if (selection?.kind !== "stroke" || !history.drawing.strokes[selection.index]) return;
    act(selection.index);
    app.changed();
  };
  const close = change((index) => {
    const stroke = history.drawing.strokes[index];
    if (!canClose(stroke)) return;
    history.change(withStroke(history.drawing, index, { ...stroke, closed: !stroke.closed }), { kind: "stroke", index, node: -1 });
    tools.open = -1;
  });
  const reverse = change((index) => {
    history.change(withStroke(history.drawing, index, reversed(history.drawing.strokes[index])), { kind: "stroke", index, node: -1 });
  });
  const sign = () => {
    const stroke = app.selectedStroke(), { selection } = history;
    tools.signed = !(stroke ? stroke.signed : tools.signed);
    if (stroke && selection) {
      history.change(withStroke(history.drawing, selection.index, { ...stroke, signed: tools.signed }));
      return app.changed();
    }
    app.selected();
  };
  const snap = () => {
    tools.snap = !tools.snap;
    app.selected();
  };
  const end = () => {
    tools.finish();
    app.selected();
  };
  const menu = element<HTMLDetailsElement>("save-menu");
  const leave = () => { // what lies over the picture goes first
    if (!element("message").hidden) app.message(null);
    else if (menu.open) menu.open = false;
    else end();
  };
  element("message-close").addEventListener("click", () => app.message(null));
  document.addEventListener("pointerdown", ({ target }) => { if (!menu.contains(target as Node)) menu.open = false; });
  const mode = (next: Mode) => () => app.setMode(next);
  const tick = (id: string) => () => element<HTMLInputElement>(id).click();
  const middle = () => {
    const box = stage.canvas.getBoundingClientRect();
    tools.click(box.left + box.width / 2, box.top + box.height / 2);
  };
  const buttons: Record<string, () => void> = {
    "mode-turn": mode("turn"), "mode-curve": mode("curve"), "mode-freehand": mode("freehand"), "mode-point": mode("point"),
    snap, signed: sign, undo: () => app.undo(), redo: () => app.redo(), close, reverse, delete: () => tools.remove(),
  };
  for (const [id, act] of Object.entries(buttons)) element(id).addEventListener("click", act);

  const keys: Record<string, () => void> = {
    v: mode("turn"), c: mode("curve"), f: mode("freehand"), p: mode("point"), s: snap, u: sign, l: close, r: reverse,
    delete: () => tools.remove(), backspace: () => tools.remove(), enter: end, escape: leave,
    h: () => stage.reset(), i: tick("lines"), w: tick("wires"), o: tick("marks"),
    "?": () => { element<HTMLDetailsElement>("keys").open = !element<HTMLDetailsElement>("keys").open; },
  };
  const withFocus: Record<string, (shift: boolean) => void> = {
    " ": middle,
    arrowleft: (shift) => (shift ? stage.move(-0.03, 0) : stage.turn(-0.12, 0)),
    arrowright: (shift) => (shift ? stage.move(0.03, 0) : stage.turn(0.12, 0)),
    arrowup: (shift) => (shift ? stage.move(0, 0.03) : stage.turn(0, 0.12)),
    arrowdown: (shift) => (shift ? stage.move(0, -0.03) : stage.turn(0, -0.12)),
    "+": () => stage.zoom(0.87), "=": () => stage.zoom(0.87), "-": () => stage.zoom(1.15),
  };
  const controlled: Record<string, (shift: boolean) => void> = {
    z: (shift) => (shift ? app.redo() : app.undo()), y: () => app.redo(),
    o: () => element("open").click(), s: () => element("save-sources").click(),
  };
  document.addEventListener("keydown", (event) => {
    const target = event.target as HTMLElement, key = event.key.toLowerCase();
    const typing = target.matches("input:not([type=checkbox]):not([type=range]), textarea, select");
    if (event.altKey || typing) return;
    const onButton = target.matches("button, summary, input") && ["enter", " "].includes(key);
    let act: (() => void) | undefined;
    if (event.ctrlKey || event.metaKey) {
      const found = controlled[key];
      act = found && (() => found(event.shiftKey));
    } else if (!onButton) {
      const found = target === stage.canvas || target === document.body ? withFocus[key] : undefined;
      act = keys[key] ?? (found && (() => found(event.shiftKey)));
    }
    if (!act) return;
    event.preventDefault();
    act();
  });
  listKeys(help);
}
