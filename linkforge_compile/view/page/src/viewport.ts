/** The picture: renderer, camera and lights. It is drawn when something has changed, and only then. */
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Camera } from "./scene";

/** From the front, the right and above; +x is ahead. */
const FIRST_VIEW: Camera = { azimuth: -40, elevation: 22 };

export class Viewport {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(35, 1, 0.01, 100);
  readonly renderer = new THREE.WebGLRenderer({ antialias: true });
  /** Called after the picture is drawn. */
  drawn: () => void = () => {};
  private readonly controls: OrbitControls;
  private waiting = 0;
  private radius = 1;
  private box = new THREE.Box3();
  /** Look again as at last, after a change of size; until a user moves the camera. */
  private refit: (() => void) | null = null;

  constructor(readonly element: HTMLElement) {
    this.camera.up.set(0, 0, 1);
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    element.append(this.renderer.domElement);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.moved());
    this.controls.addEventListener("start", () => (this.refit = null));
    this.addLights();
    this.renderer.domElement.addEventListener("webglcontextrestored", () => this.redraw());
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  setBackground(color: number): void {
    this.scene.background = new THREE.Color(color);
    this.redraw();
  }

  /** Draw once, in the next frame of the browser. */
  redraw(): void {
    this.waiting ||= requestAnimationFrame(() => this.draw());
  }

  /** Draw in the next frame, and wait for it: updates come no faster than they are drawn. */
  async frame(): Promise<void> {
    this.redraw();
    if (!document.hidden) await new Promise((done) => requestAnimationFrame(done));
  }

  /** Draw now. */
  draw(): void {
    cancelAnimationFrame(this.waiting);
    this.waiting = 0;
    this.renderer.render(this.scene, this.camera);
    this.drawn();
  }

  /** Take the size of what is shown, and stay where the camera is. */
  measure(box: THREE.Box3): void {
    this.box = box;
    this.radius = box.isEmpty() ? 0.5 : Math.max(box.getSize(new THREE.Vector3()).length() / 2, 1e-3);
    this.moved();
  }

  /** Look at all of a box, from where `camera` says. */
  fit(box: THREE.Box3, camera: Camera = FIRST_VIEW): void {
    this.measure(box);
    const middle = box.isEmpty() ? new THREE.Vector3() : box.getCenter(new THREE.Vector3());
    const target = camera.target ? new THREE.Vector3(...camera.target) : middle;
    const way = wayTo(camera);
    const distance = camera.distance ?? this.distanceTo(box, target, way);
    this.camera.position.copy(target).addScaledVector(way, distance);
    this.controls.target.copy(target);
    this.controls.update();
    this.moved();
    this.refit = () => this.fit(this.box, camera);
  }

  /** Return from how far all corners of a box are in the picture, with a margin. */
  private distanceTo(box: THREE.Box3, target: THREE.Vector3, way: THREE.Vector3): number {
    const right = new THREE.Vector3(0, 0, 1).cross(way).normalize();
    const up = way.clone().cross(right);
    const high = Math.tan(THREE.MathUtils.degToRad(this.camera.fov / 2)) * 0.86;
    const wide = high * this.camera.aspect;
    const size = box.isEmpty() ? new THREE.Vector3(1, 1, 1) : box.getSize(new THREE.Vector3());
    const least = this.radius * 1.2;
    return [0, 1, 2, 3, 4, 5, 6, 7].reduce((farthest, corner) => {
      const sign = new THREE.Vector3(corner & 1 ? 0.5 : -0.5, corner & 2 ? 0.5 : -0.5, corner & 4 ? 0.5 : -0.5);
      const place = box.isEmpty() ? sign : box.getCenter(new THREE.Vector3()).add(sign.multiply(size)).sub(target);
      const across = Math.max(Math.abs(place.dot(right)) / wide, Math.abs(place.dot(up)) / high);
      return Math.max(farthest, across + place.dot(way));
    }, least);
  }

  /** The lights turn with the camera, so that no side is dark. */
  private addLights(): void {
    const [key, fill] = [new THREE.DirectionalLight(0xffffff, 2.0), new THREE.DirectionalLight(0xdfe9ff, 0.6)];
    key.position.set(-0.6, 1, 0.8);
    fill.position.set(1, 0.1, 0.6);
    for (const light of [key, fill]) this.camera.add(light, light.target);
    const sky = new THREE.HemisphereLight(0xffffff, 0xc4c8d0, 1.4);
    sky.position.set(0, 0, 1);
    this.scene.add(sky, this.camera);
  }

  private moved(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(distance - this.radius * 4, distance / 200);
    this.camera.far = distance + this.radius * 30;
    this.camera.updateProjectionMatrix();
    this.redraw();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.refit?.();
    this.draw();
  }
}

/** Return the direction from the target to the camera. */
function wayTo({ azimuth, elevation }: Camera): THREE.Vector3 {
  const [turn, rise] = [azimuth, Math.min(Math.max(elevation, -89.9), 89.9)].map(THREE.MathUtils.degToRad) as [number, number];
  return new THREE.Vector3(Math.cos(rise) * Math.cos(turn), Math.cos(rise) * Math.sin(turn), Math.sin(rise));
}
