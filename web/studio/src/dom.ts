// Short forms for elements.

export { download, element } from "../../../viewer/src/elements";

type Properties<K extends keyof HTMLElementTagNameMap> = Partial<Omit<HTMLElementTagNameMap[K], "style">>;

export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K, properties: Properties<K> = {}, ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  Object.assign(made, properties);
  made.append(...children);
  return made;
}

export function fillSelect(select: HTMLSelectElement, choices: readonly { value: string; text: string }[], value: string): void {
  select.replaceChildren(...choices.map((choice) => make("option", { value: choice.value, textContent: choice.text })));
  select.value = value;
}

/** True if the text is on the clipboard now. The old way needs no permission, which pages from disk may
 * be asked for without an end. */
export async function toClipboard(text: string): Promise<boolean> {
  const area = make("textarea", { value: text }), focused = document.activeElement;
  document.body.append(area);
  area.select();
  const done = document.execCommand("copy");
  area.remove();
  if (focused instanceof HTMLElement) focused.focus();
  if (done || !navigator.clipboard) return done;
  const late = new Promise<boolean>((give) => setTimeout(() => give(false), 1000));
  return Promise.race([late, navigator.clipboard.writeText(text).then(() => true, () => false)]);
}
