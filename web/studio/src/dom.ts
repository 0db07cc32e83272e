// Short forms for elements.

export function element<T extends HTMLElement = HTMLElement>(id: string): T {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no ${id}`);
  return found as T;
}

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

/** Gives a file to the user. */
export function download(name: string, data: BlobPart | Blob, type = "application/octet-stream"): void {
  const blob = data instanceof Blob ? data : new Blob([data], { type });
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
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
