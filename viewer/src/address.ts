// Camera and settings in the address, so that a link or a reload shows the same.

export class Address {
  private readonly values = new Map<string, string>();
  private timer = 0;

  constructor(hash: string) {
    for (const part of hash.replace(/^#/, "").split("&")) {
      const at = part.indexOf("=");
      if (at <= 0) continue;
      try {
        this.values.set(part.slice(0, at), decodeURIComponent(part.slice(at + 1)));
      } catch {
        continue;  // not ours
      }
    }
  }

  get(key: string): string | null {
    return this.values.get(key) ?? null;
  }

  number(key: string): number | null {
    const text = this.values.get(key);
    const x = text === undefined || text === "" ? NaN : Number(text);
    return Number.isFinite(x) ? x : null;
  }

  /** Writes a setting down, soon; null: as it is by itself. */
  set(key: string, value: string | number | null): void {
    if (value === null) this.values.delete(key);
    else this.values.set(key, String(value));
    window.clearTimeout(this.timer);
    this.timer = window.setTimeout(() => this.write(), 250);
  }

  text(): string {
    return [...this.values].map(([key, value]) => `${key}=${encodeURIComponent(value).replace(/%2C/g, ",")}`).join("&");
  }

  private write(): void {
    const text = this.text();
    try {
      history.replaceState(null, "", text ? `#${text}` : location.pathname + location.search);
    } catch {
      return;  // pages without an address of their own, as in notebooks
    }
  }
}
