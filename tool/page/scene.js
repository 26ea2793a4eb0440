// The 3-D view: camera, light, floor and the loop that draws.

import {
  AmbientLight,
  BufferGeometry,
  CircleGeometry,
  Color,
  DirectionalLight,
  Group,
  HemisphereLight,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  OrbitControls,
  PCFShadowMap,
  PerspectiveCamera,
  Scene,
  ShadowMaterial,
  Vector3,
  WebGLRenderer,
} from "./vendor/three.js";
import { simple } from "./quality.js";
import { colour, isDark, onColours } from "./theme.js";

const FIRST_VIEW = new Vector3(21, -25, 14);
/// Below this number of frames per second, the view reduces its quality step by step: fewer pixels, no shadows.
const ENOUGH = 45;

/// Returns a cross, and circles whose radii are `step` apart, as line segments: two end points for each segment.
function rings(step, last) {
  const points = [-1, 1]
    .flatMap((side) => [new Vector3(0, 0, 0), new Vector3(side * last, 0, 0)])
    .concat([-1, 1].flatMap((side) => [new Vector3(0, 0, 0), new Vector3(0, side * last, 0)]));
  for (let radius = step; radius <= last; radius += step) {
    for (let part = 0; part < 32; part += 1) {
      const at = (angle) => new Vector3(radius * Math.cos(angle), radius * Math.sin(angle), 0);
      points.push(at((part * Math.PI) / 16), at(((part + 1) * Math.PI) / 16));
    }
  }
  return points;
}

export class View {
  constructor(canvas) {
    this.canvas = canvas;
    this.renderer = new WebGLRenderer({ canvas, antialias: !simple, powerPreference: "high-performance" });
    this.renderer.shadowMap.enabled = !simple;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.ratio = Math.min(devicePixelRatio, 2);
    this.scene = new Scene();
    this.camera = new PerspectiveCamera(32, 1, 1, 400);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.minDistance = 8;
    this.controls.maxDistance = 120;
    this.world = new Group();
    this.scene.add(this.world);
    this.light();
    onColours(() => this.colours());
    /// Whether the size of the canvas is that of the view. A new size makes the canvas empty, so `run` sets it just
    /// before it draws.
    this.fits = false;
    new ResizeObserver(() => (this.fits = false)).observe(canvas.parentElement);
    this.panel = 0;
    this.target = new Vector3(0, 0, 6);
    this.frames = { count: 0, since: performance.now(), rate: 0 };
  }

  light() {
    this.sky = new HemisphereLight(0xffffff, 0x8090a0, 1.6);
    this.sun = new DirectionalLight(0xffffff, 2.2);
    this.sun.position.set(14, -10, 34);
    this.sun.castShadow = !simple;
    this.sun.shadow.mapSize.set(1024, 1024);
    Object.assign(this.sun.shadow.camera, { left: -18, right: 18, top: 18, bottom: -18, near: 5, far: 70 });
    this.sun.shadow.radius = 4;
    this.sun.shadow.bias = -0.0008;
    this.sun.shadow.normalBias = 0.05;
    this.fill = new DirectionalLight(0xcfe0ff, 0.7);
    this.fill.position.set(-20, 16, 10);
    this.scene.add(this.sky, this.sun, this.fill, new AmbientLight(0xffffff, 0.25));
  }

  colours() {
    this.background = new Color(colour("scene"));
    this.scene.background = this.background;
    this.sky.intensity = isDark() ? 1.0 : 1.7;
    if (this.floor) this.floor.material.opacity = isDark() ? 0.35 : 0.16;
    if (this.grid) this.grid.material.color.set(colour("grid"));
  }

  /// Draws a floor at `height` along z, cm: a disc that receives shadows, and rings every 5 cm.
  setFloor(height) {
    if (this.floor) this.scene.remove(this.floor, this.grid);
    this.floor = new Mesh(new CircleGeometry(20, 40), new ShadowMaterial({ opacity: 0.2 }));
    this.floor.receiveShadow = true;
    this.floor.visible = !simple;
    this.floor.position.z = height;
    this.grid = new LineSegments(new BufferGeometry().setFromPoints(rings(5, 20)), new LineBasicMaterial());
    this.grid.position.z = height - 0.01;
    this.scene.add(this.floor, this.grid);
    this.colours();
  }

  /// Puts the camera where it sees the hand, whose middle is at `target`, cm, and whose radius is `radius`.
  frame(target, radius) {
    this.target.copy(target);
    this.radius = radius;
    this.reset();
  }

  reset() {
    this.camera.up.set(0, 0, 1);
    const narrow = Math.max(1, 1.15 / this.camera.aspect);
    const distance = (this.radius ?? 11) * 3.6 * narrow;
    this.camera.position.copy(FIRST_VIEW).setLength(distance).add(this.target);
    this.controls.target.copy(this.target);
    this.controls.update();
  }

  /// Keeps the middle of the picture clear of a panel at the left that has this width, pixels.
  setPanel(width) {
    if (this.panel === width) return;
    this.panel = width;
    this.fits = false;
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.canvas.parentElement;
    if (!width || !height) return;
    this.fits = true;
    const shift = width > 2.2 * this.panel ? this.panel / 2 : 0;
    this.camera.setViewOffset(width, height, -shift, 0, width, height);
    const turned = Math.abs(width / height - this.camera.aspect) > 0.3;
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.renderer.setPixelRatio(this.ratio);
    this.renderer.setSize(width, height, false);
    if (turned) this.reset();
  }

  /// Calls `draw` before every picture.
  run(draw) {
    const step = () => {
      requestAnimationFrame(step);
      if (!this.fits) this.resize();
      draw();
      this.controls.update();
      this.renderer.render(this.scene, this.camera);
      this.measure();
    };
    requestAnimationFrame(step);
  }

  measure() {
    const frames = this.frames;
    frames.count += 1;
    const elapsed = performance.now() - frames.since;
    if (elapsed < 1000) return;
    frames.rate = (frames.count * 1000) / elapsed;
    Object.assign(frames, { count: 0, since: performance.now() });
    if (frames.rate < ENOUGH && document.visibilityState === "visible") this.cheaper();
  }

  /// Reduces the quality by one step, so that a frame takes less time.
  cheaper() {
    if (this.ratio > 1) this.ratio = 1;
    else if (this.sun.castShadow) this.sun.castShadow = this.floor.visible = false;
    else if (this.ratio > 0.7) this.ratio = 0.7;
    else return;
    this.fits = false;
  }
}
