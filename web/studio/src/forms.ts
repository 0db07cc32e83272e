// Forms made of the library's option tables.
import type { OptionInfo } from "littoral/inline";
import { make } from "./dom";

export type Chosen = Record<string, string>; // text as the command line takes it, where not the default

const shown = (value: OptionInfo["default"]): string => typeof value === "boolean" ? (value ? "on" : "off") : String(value);

function control(option: OptionInfo, value: string): HTMLInputElement | HTMLSelectElement {
  switch (option.kind) {
    case "choice": {
      const select = make("select");
      select.append(...option.choices.map((text) => make("option", { value: text, textContent: text })));
      select.value = value;
      return select;
    }
    case "toggle":
      return make("input", { type: "checkbox", checked: value === "on" });
    case "text":
      return make("input", { type: "text", value: value === "none" ? "" : value, spellcheck: false });
    default: {
      const input = make("input", { type: "number", value, required: true, step: option.kind === "integer" ? "1" : "any" });
      if (Number.isFinite(option.low)) input.min = String(option.low);
      if (Number.isFinite(option.high)) input.max = String(option.high);
      return input;
    }
  }
}

/** Fills the form; `use` gets what is not the default, whenever all that is given is allowed. */
export function fillForm(form: HTMLFormElement, options: readonly OptionInfo[], chosen: Chosen, use: (chosen: Chosen) => void): void {
  form.replaceChildren();
  const inputs = new Map<string, HTMLInputElement | HTMLSelectElement>();
  for (const option of options) {
    const fallback = shown(option.default), input = control(option, chosen[option.name] ?? fallback);
    input.id = `option-${option.name}`;
    inputs.set(option.name, input);
    const limits = [option.unit, option.range].filter(Boolean).join("; ");
    form.append(make("label", { htmlFor: input.id }, make("span", { textContent: option.name }), input,
      make("small", { textContent: `${option.help}${limits ? ` (${limits})` : ""}` })));
  }
  form.onsubmit = (event) => event.preventDefault();
  form.onchange = () => {
    if (!form.checkValidity()) return;
    const result: Chosen = {};
    for (const option of options) {
      const input = inputs.get(option.name)!;
      const text = option.kind === "toggle" ? ((input as HTMLInputElement).checked ? "on" : "off") : input.value;
      const same = option.kind === "number" || option.kind === "integer"
        ? Number(text) === option.default : text === shown(option.default) || (text === "" && option.kind === "text");
      if (!same) result[option.name] = text;
    }
    use(result);
  };
}
