// The turning mill: the recorded pictures of all beads, with the liner at the angle of each picture.
import { AmbientLight, DirectionalLight, Vector3 } from "three";
import { channels } from "../colours.js";
import { inflate } from "../data.js";
import { element, freshId, svg } from "../dom.js";
import { number } from "../numbers.js";
import { Beads, MANY } from "./beads.js";
import { Liner } from "./liner.js";
import { View } from "./view.js";

const PACES = [1, 0.5, 0.2, 0.1, 0.05];
const stillness = window.matchMedia("(prefers-reduced-motion: reduce)");
const button = (text, title, click) => element("button", { type: "button", title, click }, text);

export class Mill {
  constructor(name, beads) {
    this.view = new View(`${name}: beads in the turning mill, coloured by speed. Arrow keys turn the view, + and − zoom, space plays, page up and down step.`, { plain: beads > MANY });
    this.works = Boolean(this.view.renderer);
    if (!this.works) return;
    this.view.renderer.localClippingEnabled = true;
    this.view.scene.add(new AmbientLight(0xffffff, 1.6));
    const sun = new DirectionalLight(0xffffff, 1.6);
    sun.position.set(-0.4, 0.6, 0.8);
    this.view.scene.add(sun);
    this.frame = 0;
    this.pace = 0.2;
    this.playing = false;
    this.wanted = !stillness.matches; // plays by itself when it comes into view, unless the reader's system asks for stillness
    this.build();
    new IntersectionObserver(([entry]) => {
      this.inView = entry.isIntersecting;
      if (this.wanted) this.play(this.inView);
    }, { threshold: 0.25 }).observe(this.view.element);
    stillness.addEventListener("change", () => stillness.matches && this.stop());
  }

  build() {
    const [slider, cut] = [freshId("time"), freshId("cut")];
    this.playButton = button("Play", "Play or pause (space)", () => (this.playing ? this.stop() : this.start()));
    this.slider = element("input", { id: slider, type: "range", min: 0, max: 0, step: 1, value: 0, "data-role": "time",
      input: () => {
        this.stop();
        this.show(Number(this.slider.value));
      } });
    this.clock = element("output", { for: slider });
    this.cut = element("input", { id: cut, type: "range", min: 0, max: 1000, step: 1, value: 1000, "data-role": "cut", input: () => this.cutChanged() });
    this.cutText = element("output", { for: cut });
    const pace = element("select", { "aria-label": "Pace", change: (event) => (this.pace = Number(event.target.value)) },
      PACES.map((one) => element("option", { value: one, selected: one === this.pace }, one === 1 ? "real time" : `1/${Math.round(1 / one)} of real time`)));
    this.legend = element("div", { class: "colour-bar" });
    this.element = element("div", { class: "mill" }, this.view.element, this.legend, element("div", { class: "controls" },
      element("div", { class: "row" }, this.playButton, pace, button("End view", "Along the axis: x to the right, y up", () => this.view.look(0, 0)),
        button("3-D", "From aside and above", () => this.view.look(0.7, 0.35)), button("+", "Nearer", () => this.view.zoomBy(1.25)),
        button("−", "Farther", () => this.view.zoomBy(0.8))),
      element("div", { class: "row" }, element("label", { for: slider }, "Time"), this.slider, this.clock),
      element("div", { class: "row" }, element("label", { for: cut }, "Cut"), this.cut, this.cutText)));
    this.view.canvas.addEventListener("keydown", (event) => {
      const steps = { PageUp: -1, PageDown: 1, Home: -Infinity, End: Infinity };
      if (event.key === " ") this.playButton.click();
      else if (event.key in steps && this.movie) {
        this.stop();
        this.show(Math.min(this.movie.frames - 1, Math.max(0, this.frame + steps[event.key])));
      } else return;
      event.preventDefault();
    });
  }

  /** The page may bring more frames of the same run; place, pace, view and cut stay. */
  async load({ movie, liner, mill }) {
    const [n, beads] = [movie.frames, movie.beads];
    const low = new Vector3(...movie.low_m);
    const high = new Vector3(...movie.high_m);
    const radius = await inflate(movie.radius_m, "f32", beads, "the beads' radii");
    const position = await inflate(movie.position, "u16", 3 * n * beads, "the beads' positions");
    const speed = await inflate(movie.speed, "u8", n * beads, "the beads' speeds");
    const old = this.beads;
    this.movie = { ...movie, low, span: high.clone().sub(low), radius, position, speed };
    this.beads = new Beads(this.movie);
    this.view.before = [(camera) => this.beads.prepare(camera)];
    if (old) {
      this.view.scene.remove(old.mesh);
      old.dispose();
    } else {
      if (liner) {
        this.liner = new Liner();
        await this.liner.load(liner, 0x5d6f80);
        this.view.scene.add(this.liner.group);
      }
      this.ends = mill ? [mill.low_m, mill.high_m] : [low.z, high.z];
      const wide = mill ? mill.radius_m : Math.max(...[low, high].flatMap((v) => [Math.abs(v.x), Math.abs(v.y)]));
      const long = (this.ends[1] - this.ends[0]) / 2;
      this.view.fit(new Vector3(0, 0, (this.ends[0] + this.ends[1]) / 2), Math.hypot(wide, long), wide);
    }
    this.view.scene.add(this.beads.mesh);
    this.slider.max = n - 1;
    this.drawLegend(movie.speed_high_m_per_s);
    this.cutChanged();
    this.show(Math.min(this.frame, n - 1));
    if (this.wanted && this.inView) this.play(true);
    this.element.dataset.ready = "1";
  }

  drawLegend(top) {
    const id = freshId("speed");
    const stops = [...Array(11).keys()].map((step) => svg("stop", { offset: `${step * 10}%`, "stop-color": `rgb(${channels("sequential", step / 10).join(",")})` }));
    this.legend.replaceChildren(
      element("div", { class: "ramp" }, svg("svg", { "aria-hidden": "true", width: "100%", height: 12, preserveAspectRatio: "none" },
        svg("defs", null, svg("linearGradient", { id }, stops)), svg("rect", { width: "100%", height: 12, fill: `url(#${id})` }))),
      element("div", { class: "ramp-ends" }, [0, top / 2, top].map((value, index) => element("span", null, (index === 2 ? "≥ " : "") + number(value, 3)))),
      element("div", { class: "ramp-name" }, "speed of a bead (m/s)"));
  }

  show(frame) {
    this.frame = frame;
    this.slider.value = frame;
    this.clock.textContent = `${this.movie.time_s[frame].toFixed(3)} s`;
    this.slider.setAttribute("aria-valuetext", `${this.movie.time_s[frame].toFixed(3)} seconds, picture ${frame + 1} of ${this.movie.frames}`);
    this.beads.show(frame);
    this.liner?.turn(this.movie.wall_angle_rad[frame]);
    this.view.draw();
  }

  cutChanged() {
    if (!this.movie) return;
    const share = Number(this.cut.value) / 1000;
    const z = this.ends[0] + share * (this.ends[1] - this.ends[0]);
    const text = share === 1 ? "whole length" : `up to z = ${number(1000 * z, 4)} mm`;
    this.cutText.textContent = text;
    this.cut.setAttribute("aria-valuetext", text);
    this.beads.cutAt(share === 1 ? Infinity : z);
    this.liner?.cutAt(share === 1 ? 1e9 : z);
    this.view.draw();
  }

  start() {
    this.wanted = true;
    this.play(true);
  }

  stop() {
    this.wanted = false;
    this.play(false);
  }

  play(on) {
    if (!this.movie || this.movie.frames < 2 || on === this.playing) return;
    this.playing = on;
    this.playButton.textContent = on ? "Pause" : "Play";
    this.playButton.setAttribute("aria-pressed", String(on));
    if (!on) return;
    const times = this.movie.time_s;
    let [before, at] = [performance.now(), this.frame === times.length - 1 ? times[0] : times[this.frame]];
    const step = (now) => {
      if (!this.playing) return;
      at += (this.pace * Math.min(200, now - before)) / 1000;
      before = now;
      const all = this.movie.time_s;
      if (at > all[all.length - 1] + 0.2 * this.pace) at = all[0];
      let frame = at < all[this.frame] ? 0 : this.frame;
      while (frame + 1 < all.length && all[frame + 1] <= at) frame += 1;
      if (frame !== this.frame) this.show(frame);
      requestAnimationFrame(step);
    };
    requestAnimationFrame(step);
  }
}
