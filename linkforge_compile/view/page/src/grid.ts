/** The ground: a grid with round cells, and how wide they are. */
import * as THREE from "three";
import type { Theme } from "./theme";

const CELLS_TO_EDGE = 10;

export class Grid {
  readonly root = new THREE.Group();
  private readonly text = document.createElement("div");
  private lines: THREE.GridHelper | null = null;
  private box = new THREE.Box3();
  private size = 1;

  constructor(
    element: HTMLElement,
    private theme: Theme,
  ) {
    this.text.className = "scale";
    element.append(this.text);
  }

  /** Lay the grid under a robot, at z = 0 if it does not reach lower. */
  layUnder(box: THREE.Box3, size: number): void {
    [this.box, this.size] = [box, size];
    this.make();
  }

  /** Take the colours of a theme. */
  useTheme(theme: Theme): void {
    this.theme = theme;
    if (this.lines) this.make();
  }

  private make(): void {
    const { box, theme } = this;
    const cell = roundCell(this.size / 6);
    const reach = cell * CELLS_TO_EDGE * 2;
    this.lines?.removeFromParent();
    this.lines?.dispose();
    this.lines = new THREE.GridHelper(reach, CELLS_TO_EDGE * 2, theme.middle, theme.line).rotateX(Math.PI / 2);
    this.lines.position.z = box.isEmpty() ? 0 : Math.min(0, box.min.z);
    this.root.add(this.lines);
    this.text.textContent = `grid ${cell >= 1 ? `${cell} m` : cell >= 0.01 ? `${Math.round(cell * 100)} cm` : `${Number((cell * 1000).toPrecision(1))} mm`}`;
  }

  show(isShown: boolean): void {
    this.root.visible = isShown;
    this.text.hidden = !isShown;
  }
}

/** Return 1, 2 or 5 times a power of ten, not over a length. */
function roundCell(length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  return Number((power * ([5, 2].find((factor) => factor * power <= length) ?? 1)).toPrecision(1));
}
