/** Bytes of the scene's files by digest: those in the page, else those of the server. */
import { LoadingManager } from "three";
import { TGALoader } from "three/examples/jsm/loaders/TGALoader.js";
import type { SceneFile } from "./scene";

/** One white pixel, for a texture that is missing. */
const WHITE = "data:image/gif;base64,R0lGODlhAQABAIAAAP///////yH5BAAAAAAALAAAAAABAAEAAAICRAEAOw==";

const MEDIA: Readonly<Record<string, string>> = { jpg: "image/jpeg" };

export class Files {
  constructor(private readonly files: Readonly<Record<string, SceneFile>>) {}

  /** Return the ending of a file in lower case. */
  kind(digest: string): string {
    return this.files[digest]?.kind ?? "";
  }

  name(digest: string): string {
    return this.files[digest]?.name ?? digest;
  }

  /** Return the files that a file names, those that they name included: digests by name. */
  uses(digest: string): Map<string, string> {
    const found = new Map<string, string>();
    const add = (user: string): void => {
      for (const [name, used] of Object.entries(this.files[user]?.uses ?? {})) {
        if (found.has(name)) continue;
        found.set(name, used);
        add(used);
      }
    };
    add(digest);
    return found;
  }

  async bytes(digest: string): Promise<ArrayBuffer> {
    const data = this.files[digest]?.data;
    if (data !== undefined) return decode(data);
    const answer = await fetch(`files/${digest}`);
    if (!answer.ok) throw new Error(`the server answered ${answer.status}`);
    return answer.arrayBuffer();
  }

  async text(digest: string): Promise<string> {
    return new TextDecoder().decode(await this.bytes(digest));
  }

  /** Run a loader with an address of each file that it may ask for; they are valid until all is loaded. */
  async lend<T>(names: ReadonlyMap<string, string>, load: (manager: LoadingManager) => T | Promise<T>): Promise<T> {
    const addresses = new Map<string, string>();
    for (const [name, digest] of names) addresses.set(plain(name), await this.address(digest));
    const manager = new LoadingManager();
    manager.addHandler(/\.tga$/i, new TGALoader(manager));
    manager.setURLModifier((url) => (/^(data|blob):/.test(url) ? url : (addresses.get(plain(url)) ?? WHITE)));
    let isLoading = false;
    const loaded = new Promise<void>((resolve) => (manager.onLoad = resolve));
    manager.onStart = () => (isLoading = true);
    try {
      const made = await load(manager);
      if (isLoading) await loaded;
      return made;
    } finally {
      for (const address of addresses.values()) URL.revokeObjectURL(address);
    }
  }

  private async address(digest: string): Promise<string> {
    const kind = this.kind(digest);
    return URL.createObjectURL(new Blob([await this.bytes(digest)], { type: MEDIA[kind] ?? `image/${kind}` }));
  }
}

/** A loop: `Uint8Array.from` takes ten times as long, and browsers limit addresses of data. */
function decode(base64: string): ArrayBuffer {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let index = 0; index < text.length; index++) bytes[index] = text.charCodeAt(index);
  return bytes.buffer;
}

/** Return a name of a file as loaders may write it, too. */
function plain(name: string): string {
  try {
    return decodeURIComponent(name).replaceAll("\\", "/").replace(/^\.\//, "");
  } catch {
    return name;
  }
}
