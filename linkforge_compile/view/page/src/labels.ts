/** Names over the picture: that of the link under the pointer, or those of all. */
import * as THREE from "three";

export class Labels {
  private readonly layer = document.createElement("div");
  private readonly texts = new Map<string, HTMLElement>();

  constructor(element: HTMLElement) {
    this.layer.className = "labels";
    element.append(this.layer);
  }

  /** Show these names, each at the place that `draw` gives it. */
  set(names: readonly string[]): void {
    const wanted = new Set(names);
    for (const [name, text] of this.texts) {
      if (wanted.has(name)) continue;
      text.remove();
      this.texts.delete(name);
    }
    for (const name of wanted) {
      if (this.texts.has(name)) continue;
      const text = document.createElement("span");
      text.textContent = name;
      this.texts.set(name, text);
      this.layer.append(text);
    }
  }

  draw(camera: THREE.Camera, place: (name: string) => THREE.Vector3): void {
    const { clientWidth: width, clientHeight: height } = this.layer;
    for (const [name, text] of this.texts) {
      const { x, y, z } = place(name).project(camera);
      text.hidden = z > 1;
      text.style.transform = `translate(${((x + 1) / 2) * width}px, ${((1 - y) / 2) * height}px)`;
    }
  }
}
