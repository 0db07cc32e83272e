// The controls of a volume: slice, level, clipping box, and the handles on the slice.
import type { Address } from "./address";
import { element, input, select } from "./elements";
import { between, fineOf, numberText } from "./numbers";
import type { Triple } from "./scene";
import type { VolumeView } from "./volume";
import type { ResultView } from "./view";

const steps = 1000, axes = "xyz", tilted = 3;

export interface VolumeControls {
  /** Puts the handles where the slice is, after a frame. */
  place(): void;
}

export function connectVolume(view: ResultView, volume: VolumeView, address: Address): VolumeControls {
  const { scene } = view, shown = volume.volume, field = scene.fields[0];
  const axis = select("axis"), slice = input("slice"), level = input("level"), shell = input("shell"), cut = input("cut");
  const parts: [Triple, Triple] = [[0, 0, 0], [1, 1, 1]], fine = fineOf(0, scene.radius);

  const unitAxis = (a: number) => [0, 1, 2].map((k) => (k === a ? 1 : 0)) as Triple;
  const partOf = () => {
    const [low, high] = volume.reach(volume.normal);
    return (volume.offset - low) / (high - low);
  };
  /** Where the plane is in the file's unit: along its axis, or along its normal. */
  function placeText(): string {
    const at = volume.normal.reduce((sum, c, k) => sum + c * scene.centre[k], 0) + scene.radius * volume.offset;
    return numberText(Math.abs(at) < 1e-9 * scene.radius ? 0 : at, fine);
  }
  function showSlice(write: boolean): void {
    const size = volume.normal.map(Math.abs), along = size.findIndex((x) => x > 1 - 1e-9);
    axis.selectedIndex = along >= 0 ? along : tilted;
    element("slice-text").textContent = placeText();
    slice.setAttribute("aria-valuetext", `${axis.value} = ${placeText()}`);
    if (write) address.set("slice", [...volume.normal, volume.offset].map((x) => Number(x.toFixed(4))).join(","));
    view.ask();
  }
  function setSlice(normal: Triple, offset: number): void {
    volume.setSlice(normal, offset);
    slice.value = String(Math.round(partOf() * steps));
    showSlice(true);
  }
  function showLevel(): void {
    const text = numberText(between(field.low, field.high, volume.level), view.panes[0].fine);
    element("level-text").textContent = text;
    level.setAttribute("aria-valuetext", text);
  }

  axis.addEventListener("change", () => {
    const part = partOf(), normal: Triple = axis.selectedIndex === tilted ? [0.5, 0.35, 0.79] : unitAxis(axis.selectedIndex);
    const length = Math.hypot(...normal), [low, high] = volume.reach(normal.map((x) => x / length) as Triple);
    setSlice(normal, low + part * (high - low));
  });
  slice.addEventListener("input", () => {
    const [low, high] = volume.reach(volume.normal);
    volume.setSlice(volume.normal, low + (Number(slice.value) / steps) * (high - low));
    showSlice(true);
  });
  level.addEventListener("input", () => {
    volume.setLevel(Number(level.value) / steps);
    showLevel();
    address.set("level", volume.level);
  });
  function useShell(): void {
    volume.showShell(shell.checked);
    level.disabled = !shell.checked;
    view.ask();
  }
  shell.addEventListener("change", () => {
    useShell();
    address.set("surface", shell.checked === shown.isosurface ? null : shell.checked ? 1 : 0);
  });
  cut.addEventListener("change", () => {
    volume.setCut(cut.checked);
    address.set("cut", cut.checked ? null : 0);
  });

  // The clipping box: a slider for each of its sides, at parts of the volume's.
  const sides: { a: number; end: 0 | 1; slider: HTMLInputElement; text: HTMLOutputElement }[] = [];
  function useBox(): void {
    for (const { a, end, slider, text } of sides) {
      const at = scene.centre[a] + scene.radius * (volume.low[a] + parts[end][a] * (volume.high[a] - volume.low[a]));
      text.textContent = numberText(Math.abs(at) < 1e-9 * scene.radius ? 0 : at, fine);
      slider.setAttribute("aria-valuetext", text.textContent);
    }
    volume.setBox(parts[0].map((x, k) => Math.min(x, parts[1][k])) as Triple, parts[1]);
    view.ask();
  }
  const wholeBox = () => parts[0].every((x) => x === 0) && parts[1].every((x) => x === 1);
  const box = address.get("box")?.split(",").map(Number);
  if (box?.length === 6 && box.every((x) => x >= 0 && x <= 1)) {
    for (const end of [0, 1]) parts[end] = box.slice(3 * end, 3 * end + 3) as Triple;
    element<HTMLDetailsElement>("box").open = !wholeBox();
  }
  for (let a = 0; a < 3; ++a) for (const end of [0, 1] as const) {
    const row = document.createElement("label"), slider = document.createElement("input");
    const name = document.createElement("span"), text = document.createElement("output");
    row.className = "row";
    name.textContent = `${axes[a]} ${end ? "to" : "from"}`;
    slider.setAttribute("aria-label", name.textContent);
    slider.type = "range";
    slider.min = "0";
    slider.max = "100";
    slider.value = String(100 * parts[end][a]);
    slider.id = `box-${axes[a]}-${end ? "high" : "low"}`;
    slider.addEventListener("input", () => {
      parts[end][a] = Number(slider.value) / 100;
      useBox();
      address.set("box", wholeBox() ? null : parts.flat().join(","));
    });
    row.append(name, slider, text);
    element("box").append(row);
    sides.push({ a, end, slider, text });
  }
  useBox();

  const move = element("slice-move"), tilt = element("slice-tilt"), arm = 0.32;
  /** The middle of the slice, and the tip of its normal. */
  function places(): [Triple, Triple] {
    const middle = volume.low.map((x, a) => (x + volume.high[a]) / 2);
    const away = volume.offset - volume.normal.reduce((sum, c, k) => sum + c * middle[k], 0);
    const centre = middle.map((x, k) => x + away * volume.normal[k]) as Triple;
    return [centre, centre.map((x, k) => x + arm * volume.normal[k]) as Triple];
  }
  function onDrag(handle: HTMLElement, act: (dx: number, dy: number) => void): void {
    let last: { x: number; y: number } | null = null;
    handle.addEventListener("pointerdown", (event) => {
      handle.setPointerCapture(event.pointerId);
      last = { x: event.clientX, y: event.clientY };
    });
    handle.addEventListener("pointermove", (event) => {
      if (!last) return;
      act(event.clientX - last.x, event.clientY - last.y);
      last = { x: event.clientX, y: event.clientY };
    });
    for (const end of ["pointerup", "pointercancel"] as const) handle.addEventListener(end, () => { last = null; });
    handle.addEventListener("keydown", (event) => {
      const keys: Record<string, [number, number]> = { ArrowLeft: [-8, 0], ArrowRight: [8, 0], ArrowUp: [0, -8], ArrowDown: [0, 8] };
      const by = keys[event.key];
      if (!by) return;
      event.preventDefault();
      act(...by);
    });
  }
  onDrag(move, (dx, dy) => {
    // As far along the normal as the drag goes along its picture.
    const [a, b] = places().map((p) => view.project(p)), ux = b.x - a.x, uy = b.y - a.y, length2 = Math.max(60, ux * ux + uy * uy);
    setSlice(volume.normal, volume.offset + (arm * (dx * ux + dy * uy)) / length2);
  });
  onDrag(tilt, (dx, dy) => {
    const [centre, tip] = places(), e = view.orbit.camera.matrixWorld.elements;
    const scale = 2.2 * view.orbit.pixel * view.orbit.camera.position.length();
    const moved = tip.map((x, k) => x + scale * (dx * e[k] - dy * e[4 + k])), normal = moved.map((x, k) => x - centre[k]) as Triple;
    const length = Math.hypot(...normal);
    if (length > 1e-3) setSlice(normal, normal.reduce((sum, c, k) => sum + (c / length) * centre[k], 0));
  });

  const written = address.get("slice")?.split(",").map(Number);
  if (written?.length === 4 && written.every(Number.isFinite) && Math.hypot(...written.slice(0, 3)) > 0.1)
    volume.setSlice(written.slice(0, 3) as Triple, written[3]);
  const wanted = address.number("level");
  if (wanted !== null && wanted >= 0 && wanted <= 1) volume.setLevel(wanted);
  const surface = address.number("surface");
  shell.checked = surface === null ? shown.isosurface : surface === 1;
  if (address.number("cut") === 0) {
    cut.checked = false;
    volume.setCut(false);
  }
  slice.value = String(Math.round(partOf() * steps));
  level.value = String(Math.round(volume.level * steps));
  element("volume-rows").hidden = move.hidden = tilt.hidden = false;
  showSlice(false);
  showLevel();
  useShell();
  return {
    place() {
      const [a, b] = places().map((p) => view.project(p));
      move.style.left = `${a.x}px`;
      move.style.top = `${a.y}px`;
      tilt.style.left = `${b.x}px`;
      tilt.style.top = `${b.y}px`;
    },
  };
}
