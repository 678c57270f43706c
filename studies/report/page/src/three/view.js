// A canvas that shows a scene without perspective, so that lengths compare; turned by dragging, arrow keys and buttons.
import { OrthographicCamera, Scene, Vector3, WebGLRenderer } from "three";
import { theme } from "../colours.js";
import { element } from "../dom.js";

const STEP = Math.PI / 24; // a key press turns by so much

/** Null where the browser has no WebGL 2. */
function newRenderer(plain) {
  try {
    return new WebGLRenderer({ antialias: !plain, preserveDrawingBuffer: true }); // the buffer is kept for printing
  } catch {
    return null;
  }
}

export class View {
  /** azimuth and height of the eye, rad: 0 and 0 look along −z with x to the right and y up; plain: without smooth edges, for much to draw. */
  constructor(label, { azimuth = 0, height = 0, plain = false } = {}) {
    this.renderer = newRenderer(plain);
    if (!this.renderer) return;
    this.renderer.setPixelRatio(plain ? 1 : Math.min(2, window.devicePixelRatio || 1));
    this.scene = new Scene();
    this.camera = new OrthographicCamera(-1, 1, 1, -1, 0, 10);
    this.centre = new Vector3();
    this.reach = 1; // the scene's radius about its centre
    this.wide = 1; // what must fit at azimuth 0: half its height
    this.zoom = 1;
    this.turn = { azimuth, height };
    this.before = []; // called before each picture
    this.canvas = this.renderer.domElement;
    for (const [name, value] of Object.entries({ tabindex: 0, role: "img", "aria-label": label })) this.canvas.setAttribute(name, value);
    this.element = element("div", { class: "view" }, this.canvas);
    this.listen();
    new ResizeObserver(() => this.resize()).observe(this.element);
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    window.addEventListener("beforeprint", () => this.paint());
    window.addEventListener("afterprint", () => this.draw());
    this.canvas.addEventListener("webglcontextrestored", () => this.draw());
  }

  fit(centre, reach, wide) {
    this.centre.copy(centre);
    this.reach = reach;
    this.wide = wide ?? reach;
    this.draw();
  }

  look(azimuth, height) {
    this.turn = { azimuth, height };
    this.zoom = 1;
    this.draw();
  }

  zoomBy(factor) {
    this.zoom = Math.min(12, Math.max(0.5, this.zoom * factor));
    this.draw();
  }

  /** One picture soon, however often it is asked for. */
  draw() {
    if (this.asked) return;
    this.asked = true;
    requestAnimationFrame(() => {
      this.asked = false;
      this.paint();
    });
  }

  paint() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    const { azimuth, height: up } = this.turn;
    const away = Math.min(1, Math.hypot(Math.sin(azimuth), Math.sin(up)) * 2); // turned: the whole sphere must fit
    const half = ((this.wide + (this.reach - this.wide) * away) * 1.06) / this.zoom / Math.min(1, width / height);
    Object.assign(this.camera, { left: (-half * width) / height, right: (half * width) / height, top: half, bottom: -half, near: 0, far: 6 * this.reach });
    const eye = new Vector3(Math.sin(azimuth) * Math.cos(up), Math.sin(up), Math.cos(azimuth) * Math.cos(up));
    this.camera.position.copy(this.centre).addScaledVector(eye, 3 * this.reach);
    this.camera.lookAt(this.centre);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    this.renderer.setClearColor(theme().back, 1);
    this.before.forEach((prepare) => prepare(this.camera, width, height));
    this.renderer.render(this.scene, this.camera);
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (width === 0 || height === 0) return;
    this.renderer.setSize(width, height);
    this.paint();
  }

  rotate(azimuth, height) {
    this.turn.azimuth += azimuth;
    this.turn.height = Math.min(1.5, Math.max(-1.5, this.turn.height + height));
    this.draw();
  }

  listen() {
    let from = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      from = [event.clientX, event.clientY];
      this.canvas.setPointerCapture(event.pointerId);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!from) return;
      this.rotate((from[0] - event.clientX) * 0.008, (event.clientY - from[1]) * 0.008);
      from = [event.clientX, event.clientY];
    });
    for (const name of ["pointerup", "pointercancel"]) this.canvas.addEventListener(name, () => (from = null));
    this.canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== this.canvas) return; // else the page scrolls
      event.preventDefault();
      this.zoomBy(Math.exp(-0.0015 * event.deltaY));
    }, { passive: false });
    const turns = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, STEP], ArrowDown: [0, -STEP] };
    this.canvas.addEventListener("keydown", (event) => {
      if (turns[event.key]) this.rotate(...turns[event.key]);
      else if (event.key === "+" || event.key === "-") this.zoomBy(event.key === "+" ? 1.2 : 1 / 1.2);
      else return;
      event.preventDefault();
    });
  }
}
