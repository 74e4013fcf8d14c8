/** What is made once for a key, and released when it is no longer used. */
export class Cache<T> {
  private readonly made = new Map<string, T>();
  private readonly used = new Set<string>();

  constructor(private readonly dispose: (value: T) => void) {}

  get(key: string, make: () => T): T {
    this.used.add(key);
    const known = this.made.get(key);
    if (known !== undefined) return known;
    const fresh = make();
    this.made.set(key, fresh);
    return fresh;
  }

  /** Release what was not asked for since the last sweep. */
  sweep(): void {
    for (const [key, value] of this.made) {
      if (this.used.has(key)) continue;
      this.made.delete(key);
      this.dispose(value);
    }
    this.used.clear();
  }
}
