// The life of a chart: drawn when it comes into view, drawn anew when its width, the colour scheme or its data change, and all of them
// before printing. A live page builds its sections anew; a chart with a known key keeps its element.
import * as echarts from "echarts/core";
import { BarChart, CustomChart, LineChart, ScatterChart } from "echarts/charts";
import { GridComponent, LegendComponent, TooltipComponent } from "echarts/components";
import { SVGRenderer } from "echarts/renderers";
import { setPrinting, theme } from "./colours.js";
import { element } from "./dom.js";

echarts.use([LineChart, BarChart, ScatterChart, CustomChart, GridComponent, TooltipComponent, LegendComponent, SVGRenderer]);

const PAPER = { whole: 660, half: 322 }; // px: the width of charts on paper, alone and side by side
const NARROW = 480; // px: below it charts have less room for labels
export const FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif';

let onPaper = false; // while it prints, widths are those of the paper
const charts = new Map();
const byElement = new WeakMap();

const seen = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    const one = byElement.get(entry.target);
    one.visible = entry.isIntersecting;
    if (one.visible) one.draw();
  }
}, { rootMargin: "400px 0px" });

const sized = new ResizeObserver((entries) => {
  for (const entry of entries) {
    const one = byElement.get(entry.target);
    if (!onPaper && entry.contentRect.width > 0 && Math.abs(entry.contentRect.width - one.width) > 0.5) one.changed();
  }
});

class Chart {
  constructor() {
    this.element = element("div", { class: "chart", role: "img" });
    this.width = 0;
    this.instance = null;
    this.visible = false;
    this.stale = true;
    byElement.set(this.element, this);
    seen.observe(this.element);
    sized.observe(this.element);
  }

  set(description) {
    this.description = description;
    this.element.setAttribute("aria-label", description.label);
    if (description.axes) this.element.dataset.axes = JSON.stringify(description.axes);
    const expected = this.element.clientWidth || Math.min(640, window.innerWidth - 40);
    this.element.style.height = `${this.height(expected)}px`; // room is kept, so that nothing jumps when it is drawn
    this.changed();
  }

  height(width) {
    return Math.round(typeof this.description.height === "function" ? this.description.height(width) : this.description.height);
  }

  changed() {
    this.stale = true;
    const box = this.element.getBoundingClientRect();
    const near = this.element.isConnected && box.width > 0 && box.bottom > -400 && box.top < window.innerHeight + 400;
    if (this.visible || near) this.draw();
  }

  draw() {
    const width = onPaper ? paperWidth(this.element) : this.element.clientWidth; // also for what comes into view while it prints
    if (width === 0 || !this.element.isConnected || (!this.stale && Math.abs(width - this.width) <= 0.5)) return;
    const height = this.height(width);
    this.element.style.height = `${height}px`;
    if (this.instance) this.instance.resize({ width, height });
    else this.instance = echarts.init(this.element, null, { renderer: "svg", width, height });
    const colours = theme();
    const option = this.description.option({ width, height, narrow: width < NARROW, colours });
    this.instance.setOption({ animation: false, textStyle: { fontFamily: FONT, color: colours.text }, backgroundColor: "transparent",
      ...option, tooltip: { ...tooltip(colours), ...option.tooltip } }, { notMerge: true });
    this.width = width;
    this.stale = false;
    this.element.dataset.drawn = "1";
  }
}

const tooltip = (colours) => ({
  confine: true, transitionDuration: 0, backgroundColor: colours.panel, borderColor: colours.rule,
  textStyle: { color: colours.text, fontSize: 12 }, axisPointer: { lineStyle: { color: colours.faint } },
});

/** description: {label, axes: [names as drawn], height: px or (width) → px, option: ({width, height, narrow, colours}) → ECharts option} */
export function chart(key, description) {
  if (!charts.has(key)) charts.set(key, new Chart());
  charts.get(key).set(description);
  return charts.get(key).element;
}

/** Draws what stands in view, at once: called after sections were put into the page. */
export function drawVisible() {
  for (const one of charts.values()) one.changed();
}

/** A tooltip's content as an element, so that no text of the data is taken for markup: rows of [name, value] or [colour, name, value]. */
export function hint(title, rows) {
  return element("div", { class: "hint" }, title ? element("strong", null, title) : null,
    rows.map((row) => {
      const [colour, name, value] = row.length === 3 ? row : [null, ...row];
      const swatch = colour ? element("i", { style: `background:${colour}` }) : null;
      return element("div", null, swatch, element("span", null, name), element("b", null, value));
    }));
}

const paperWidth = (node) => {
  const halves = node.closest(".halves");
  return halves && halves.children.length > 1 ? PAPER.half : PAPER.whole;
};

const redrawAll = (paper) => {
  onPaper = paper;
  setPrinting(paper);
  for (const one of charts.values()) {
    one.stale = true;
    one.draw();
  }
};

let shut = [];
window.addEventListener("beforeprint", () => {
  if (onPaper) return; // all is drawn for paper already
  shut = [...document.querySelectorAll("main details:not([open])")];
  for (const details of shut) {
    if (details.complete) details.complete();
    details.open = true;
  }
  redrawAll(true);
});
window.addEventListener("afterprint", () => {
  for (const details of shut) details.open = false;
  redrawAll(false);
});
window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => redrawAll(false));
