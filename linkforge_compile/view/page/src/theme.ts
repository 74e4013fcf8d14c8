/** The colours of the 3D view that follow the theme of the page; those of panels are in style.css. */
import type { View } from "./scene";

export interface Theme {
  background: number;
  /** The lines of the grid, and those through its middle. */
  line: number;
  middle: number;
  /** The robot before, of a comparison. */
  before: number;
}

const LIGHT: Theme = { background: 0xf1f4f8, line: 0xc3cad4, middle: 0x98a3b3, before: 0x1b2129 };
const DARK: Theme = { background: 0x23282f, line: 0x3a424d, middle: 0x5c6877, before: 0xf1f3f6 };

const PREFERS_DARK = matchMedia("(prefers-color-scheme: dark)");

/** Return the theme of the page; a picture, which has no panels, is light on every machine. */
export function themeOf({ panels }: View): Theme {
  return panels && PREFERS_DARK.matches ? DARK : LIGHT;
}

/** Call a function after each change of the theme. */
export function listenToTheme(changed: () => void): void {
  PREFERS_DARK.addEventListener("change", changed);
}
