/** What the pointer does in the picture, turning the camera apart: it is over a point, or clicks it. */
import { Raycaster, Vector2, type Camera } from "three";

/** How far a click may move [pixels]. */
const STILL = 4;
/** How often a movement is followed [ms]; to find what is under the pointer is slow with large meshes. */
const PAUSE = 60;

/** How near to an edge of a missing mesh's box the pointer hits it, as a share of the box. */
const NEAR_LINE = 0.02;

interface Pointing {
  click(ray: Raycaster): void;
  /** null: the pointer is not over the picture. */
  hover(ray: Raycaster | null): void;
}

export function listenToPointer(canvas: HTMLElement, camera: Camera, pointing: Pointing): void {
  const pressed = new Vector2(Infinity, Infinity);
  let timer = 0;
  const rayAt = ({ clientX, clientY }: PointerEvent): Raycaster => {
    const { left, top, width, height } = canvas.getBoundingClientRect();
    const ray = new Raycaster();
    ray.params.Line.threshold = NEAR_LINE;
    const place = new Vector2(((clientX - left) / width) * 2 - 1, 1 - ((clientY - top) / height) * 2);
    ray.setFromCamera(place, camera);
    return ray;
  };
  const hover = (ray: () => Raycaster | null): void => {
    window.clearTimeout(timer);
    timer = window.setTimeout(() => pointing.hover(ray()), PAUSE);
  };
  canvas.addEventListener("pointerdown", ({ clientX, clientY }) => void pressed.set(clientX, clientY));
  canvas.addEventListener("pointerup", (event) => {
    if (event.button === 0 && pressed.distanceTo(new Vector2(event.clientX, event.clientY)) <= STILL) pointing.click(rayAt(event));
  });
  canvas.addEventListener("pointermove", (event) => event.buttons || hover(() => rayAt(event)));
  canvas.addEventListener("pointerleave", () => hover(() => null));
}
