/** The picture: renderer, camera, lights, grid and the pointer. It draws only when something has changed. */
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Camera } from "./scene";

const FIRST_VIEW = { azimuth: -40, elevation: 25 };

export class Viewport {
  readonly scene = new THREE.Scene();
  readonly camera = new THREE.PerspectiveCamera(40, 1, 0.01, 100);
  private readonly renderer = new THREE.WebGLRenderer({ antialias: true, preserveDrawingBuffer: false });
  private readonly controls: OrbitControls;
  private waiting = 0;

  constructor(private readonly element: HTMLElement) {
    this.camera.up.set(0, 0, 1);
    this.scene.background = new THREE.Color(0xf2f4f7);
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    element.append(this.renderer.domElement);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.redraw());
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8d8d99, 2), this.camera);
    const sun = new THREE.DirectionalLight(0xffffff, 2);
    sun.position.set(1, 2, 3);
    this.camera.add(sun);
    new ResizeObserver(() => this.resize()).observe(element);
    this.resize();
  }

  /** Draw once, in the next frame of the browser. */
  redraw(): void {
    this.waiting ||= requestAnimationFrame(() => this.draw());
  }

  /** Draw now. */
  draw(): void {
    cancelAnimationFrame(this.waiting);
    this.waiting = 0;
    this.renderer.render(this.scene, this.camera);
  }

  /** Look at all of a box, from where `camera` says or from the front, the right and above. */
  fit(box: THREE.Box3, camera: Camera = FIRST_VIEW): void {
    const sphere = box.getBoundingSphere(new THREE.Sphere());
    const radius = Math.max(sphere.radius, 0.01) || 0.5;
    const target = camera.target ? new THREE.Vector3(...camera.target) : sphere.center;
    const angle = THREE.MathUtils.degToRad(this.camera.fov / 2);
    const distance = camera.distance ?? radius / Math.sin(Math.atan(Math.tan(angle) * Math.min(1, this.camera.aspect)));
    const azimuth = THREE.MathUtils.degToRad(camera.azimuth);
    const elevation = THREE.MathUtils.degToRad(Math.min(Math.max(camera.elevation, -89.9), 89.9));
    const flat = Math.cos(elevation);
    const way = new THREE.Vector3(flat * Math.cos(azimuth), flat * Math.sin(azimuth), Math.sin(elevation));
    this.camera.near = Math.max(distance / 1000, 1e-4);
    this.camera.far = distance * 100 + radius * 10;
    this.camera.updateProjectionMatrix();
    this.camera.position.copy(target).addScaledVector(way, distance);
    this.controls.target.copy(target);
    this.controls.update();
    this.redraw();
  }

  private resize(): void {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }
}
