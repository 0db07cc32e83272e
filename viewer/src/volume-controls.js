// The sliders of a volume: where the slice is, and the level of the surface.
import { numberText, valueOf } from "./data.js";

const element = (id) => document.getElementById(id);

export function connectVolume(surface, scene, ask) {
  const { field, volume } = scene, { state } = surface, steps = 1000;
  const axis = element("axis"), slice = element("slice"), level = element("level");

  function useSlice() {
    const a = axis.selectedIndex, part = Number(slice.value) / steps;
    surface.setSlice(a, part);
    const at = volume.low[a] * (1 - part) + volume.high[a] * part;
    element("slice-text").textContent = numberText(at);
    slice.setAttribute("aria-valuetext", `${axis.value} = ${numberText(at)}`);
    ask();
  }
  // The slider meets the level of the file exactly, whatever its steps are.
  let level_at = state.level;
  function useLevel() {
    const text = numberText(valueOf(field, level_at));
    surface.setLevel(level_at);
    element("level-text").textContent = text;
    level.setAttribute("aria-valuetext", text);
    ask();
  }
  function useShell() {
    surface.shell.visible = element("shell").checked;
    level.disabled = !element("shell").checked;
    ask();
  }
  axis.selectedIndex = state.axis;
  slice.value = String(Math.round(state.position * steps));
  level.value = String(Math.round(state.level * steps));
  element("shell").checked = volume.isosurface;
  axis.addEventListener("change", useSlice);
  slice.addEventListener("input", useSlice);
  level.addEventListener("input", () => {
    level_at = Number(level.value) / steps;
    useLevel();
  });
  element("shell").addEventListener("change", useShell);
  element("cut").addEventListener("change", () => {
    surface.setCut(element("cut").checked);
    ask();
  });
  element("volume-rows").hidden = false;
  element("slice-text").textContent =
    numberText(volume.low[state.axis] * (1 - state.position) + volume.high[state.axis] * state.position);
  useLevel();
  useShell();
}
