/** Numbers as the panels show them. */
import type { Joint, Place } from "../scene";

const DEGREES = 180 / Math.PI;

/** Return at most so many significant digits, without trailing zeros and without "-0". */
export function brief(value: number, digits = 4): string {
  const rounded = Number(value.toPrecision(digits));
  return String(rounded === 0 ? 0 : rounded).replace("-", "−");
}

/** How a position of a joint is shown: degrees or radians, or metres. */
interface PositionUnit {
  name: "°" | "rad" | "m";
  /** Shown positions per rad or m. */
  scale: number;
  decimals: number;
  /** What an arrow key adds to the number. */
  step: number;
}

const IN_DEGREES: PositionUnit = { name: "°", scale: DEGREES, decimals: 2, step: 1 };
const IN_RADIANS: PositionUnit = { name: "rad", scale: 1, decimals: 4, step: 0.01 };
const IN_METRES: PositionUnit = { name: "m", scale: 1, decimals: 4, step: 0.001 };

export function positionUnit(joint: Joint, isInDegrees: boolean): PositionUnit {
  if (joint.type === "prismatic") return IN_METRES;
  return isInDegrees ? IN_DEGREES : IN_RADIANS;
}

/** Return a position [rad, m] as its number in a unit, without trailing zeros. */
export function shownPosition(position: number, unit: PositionUnit): string {
  const shown = Number((position * unit.scale).toFixed(unit.decimals));
  return String(shown === 0 ? 0 : shown);
}

/** Return the least and the greatest position of a slider [rad, m]; a missing limit is π or 1 m from 0. */
export function sliderRange(joint: Joint): [number, number] {
  const span = joint.type === "prismatic" ? 1 : Math.PI;
  if (joint.type === "continuous") return [-span, span];
  const lower = joint.lower ?? Math.min(-span, (joint.upper ?? 0) - span);
  return [lower, joint.upper ?? Math.max(span, lower + span)];
}

/** Return the limits of a joint, such as "−90° to 90°"; "none" if it has none. */
export function shownLimits(joint: Joint, isInDegrees: boolean): string {
  if (joint.type === "continuous" || (joint.lower === null && joint.upper === null)) return "none";
  const unit = positionUnit(joint, isInDegrees);
  const space = unit.name === "°" ? "" : " ";
  const shown = (limit: number | null): string =>
    limit === null ? "none" : shownPosition(limit, unit).replace("-", "−") + space + unit.name;
  return `${shown(joint.lower)} to ${shown(joint.upper)}`;
}

/** Return a place as diagnostics write it: FILE:LINE. */
export function shownPlace(place: Place): string {
  return `${place.file}:${place.line}`;
}

/** Return a size in bytes, such as "1.2 MB". */
export function shownSize(bytes: number): string {
  if (bytes < 1000) return `${bytes} B`;
  return bytes < 1e6 ? `${brief(bytes / 1e3, 3)} kB` : `${brief(bytes / 1e6, 3)} MB`;
}
