// Maps over x and y of a mill: coloured cells, the shell, lifters, marked places. Equal scales on both axes.
import { chart, FONT, hint } from "../chart.js";
import { colourAt, line as colourOf } from "../colours.js";
import { element, freshId, svg } from "../dom.js";
import { named, number } from "../numbers.js";
import { axis } from "./axes.js";

const MARGIN = { left: 62, right: 14, top: 10, bottom: 46 };

const FREE = 300; // px: height of the plot where the axes have unlike units

/** Height that gives the plot the shape of its ranges. */
const heightFor = (x, y, square) => (width) => !square ? FREE + MARGIN.top + MARGIN.bottom :
  MARGIN.top + MARGIN.bottom + Math.min(760, ((width - MARGIN.left - MARGIN.right) * (y.max - y.min)) / (x.max - x.min));

/** A plot may be narrower than its box where its height is limited; then it stays in the middle. */
function gridFor({ width, height }, x, y, square) {
  if (!square) return { ...MARGIN, outerBoundsMode: "none" };
  const inner = Math.min(width - MARGIN.left - MARGIN.right, ((height - MARGIN.top - MARGIN.bottom) * (x.max - x.min)) / (y.max - y.min));
  return { left: MARGIN.left + (width - MARGIN.left - MARGIN.right - inner) / 2, top: MARGIN.top, width: inner,
    height: height - MARGIN.top - MARGIN.bottom, outerBoundsMode: "none" };
}

/** The bar below a map that says what the colours mean; prints as it is. */
export function colourBar(scale, { name, unit }) {
  if (!scale) return null;
  const id = freshId("ramp");
  const stops = [...Array(11).keys()].map((step) =>
    svg("stop", { offset: `${step * 10}%`, "stop-color": colourAt(scale.name, step / 10) }));
  const rounding = 1e-9 * (scale.high - scale.low);
  const beyond = scale.most > scale.high + rounding || scale.least < scale.low - rounding
    ? ` (single values from ${number(scale.least, 3)} to ${number(scale.most, 3)})` : "";
  const ends = [scale.low, (scale.low + scale.high) / 2, scale.high].map((value) => element("span", null, number(value, 3)));
  return element("div", { class: "colour-bar" },
    element("div", { class: "ramp" }, svg("svg", { "aria-hidden": "true", width: "100%", height: 12, preserveAspectRatio: "none" },
      svg("defs", null, svg("linearGradient", { id }, stops)), svg("rect", { width: "100%", height: 12, fill: `url(#${id})` }))),
    element("div", { class: "ramp-ends" }, ends), element("div", { class: "ramp-name" }, named(name, unit), beyond));
}

/** The key to a map of names. */
export const colourKey = (entries) => element("ul", { class: "colour-key" },
  entries.map(([colour, name]) => element("li", null, element("i", { style: `background:${colour}` }), name)));

const shape = (draw) => ({
  type: "custom", silent: true, clip: true, data: [[0, 0]], z: 4, tooltip: { show: false }, encode: { x: 0, y: 1 },
  renderItem: (parameters, api) => ({ type: "group", children: draw(api) }),
});

/** Shell and lifters; shell: {radius, segments: [[x1, y1, x2, y2]]} in the units of the axes. */
const shellShapes = (shell, { colours }) => shape((api) => {
  const centre = api.coord([0, 0]);
  const edge = api.coord([shell.radius, 0]);
  const draw = (stroke, lineWidth) => [{ type: "circle", shape: { cx: centre[0], cy: centre[1], r: edge[0] - centre[0] },
    style: { fill: "transparent", stroke, lineWidth } }, ...(shell.segments ?? []).map(([x1, y1, x2, y2]) => {
    const [from, to] = [api.coord([x1, y1]), api.coord([x2, y2])];
    return { type: "line", shape: { x1: from[0], y1: from[1], x2: to[0], y2: to[1] }, style: { stroke, lineWidth } };
  })];
  return [...draw(colours.back, 3.4), ...draw(colours.text, 1.5)]; // light beside dark: seen on every colour
});

/** Marked places: {x, y, text, side: "left" or "right"} a point, {x, y, x2, y2, text} a line from the first to the second. */
const markShapes = (marks, { colours, narrow }) => shape((api) => {
  const [signs, labels] = [[], []];
  marks.forEach((one, index) => {
    const colour = one.colour ?? colourOf(index + 1);
    const at = api.coord([one.x, one.y]);
    const label = (x, y, align) => labels.push({ type: "text", style: { text: one.text, x, y, fill: colours.strong, stroke: colours.back, lineWidth: 3.5,
      fontFamily: FONT, fontSize: narrow ? 10.5 : 12, fontWeight: 600, align, verticalAlign: "middle" } });
    if (one.x2 === undefined) {
      if (!one.hidden) signs.push({ type: "circle", shape: { cx: at[0], cy: at[1], r: 5.5 }, style: { fill: colour, stroke: colours.back, lineWidth: 2 } });
      const away = one.hidden ? 6 : 10;
      label(at[0] + (one.side === "left" ? -away : away), at[1] + (one.shift ?? 0), one.side === "left" ? "right" : "left");
      return;
    }
    const to = api.coord([one.x2, one.y2]);
    for (const style of [{ stroke: colours.back, lineWidth: 5 }, { stroke: colour, lineWidth: 2.6 }])
      signs.push({ type: "line", shape: { x1: at[0], y1: at[1], x2: to[0], y2: to[1] }, style });
    label(at[0] + (at[0] - to[0]) * 0.25, at[1] + (at[1] - to[1]) * 0.25 + (one.shift ?? 0), "center");
  });
  return [...signs, ...labels];
});

/** Arrows: [{x, y, dx, dy, sure, text}] in the units of the axes; what is not sure is drawn thin. */
const arrowShapes = (arrows, { colours }) => shape((api) => arrows.map((one) => {
  const from = api.coord([one.x, one.y]);
  const to = api.coord([one.x + one.dx, one.y + one.dy]);
  const long = Math.hypot(to[0] - from[0], to[1] - from[1]);
  const along = long > 0 ? [(to[0] - from[0]) / long, (to[1] - from[1]) / long] : [0, 0];
  const head = Math.min(8, long * 0.5);
  const side = (sign) => [to[0] - head * along[0] + sign * head * 0.45 * along[1], to[1] - head * along[1] - sign * head * 0.45 * along[0]];
  const colour = one.sure ? colourOf(1) : colours.faint;
  return { type: "group", children: [
    { type: "line", shape: { x1: from[0], y1: from[1], x2: to[0], y2: to[1] }, style: { stroke: colour, lineWidth: one.sure ? 2.4 : 1.2 } },
    { type: "polygon", shape: { points: [to, side(1), side(-1)] }, style: { fill: colour } }] };
}));

/**
 * cells: {edgesX, edgesY, values (row-major, row of y by column of x), tell(index) → rows of the hint}; colour(value) → CSS colour;
 * x, y: {name, unit, min, max}; shell, marks, arrows as above. All in the units of the axes; square: equal scales on both.
 */
export function map(key, { label, x, y, cells, colour, shell, marks = [], arrows = [], title, square = true }) {
  const option = (context) => {
    const across = cells ? cells.edgesX.length - 1 : 0;
    const data = [];
    for (const [index, value] of cells ? cells.values.entries() : []) {
      const [column, row] = [index % across, Math.floor(index / across)];
      if (Number.isFinite(value)) data.push([cells.edgesX[column], cells.edgesX[column + 1], cells.edgesY[row], cells.edgesY[row + 1], index]);
    }
    const mosaic = {
      type: "custom", name: title, data, encode: { x: [0, 1], y: [2, 3] }, z: 2, clip: true, progressive: 0,
      renderItem(parameters, api) {
        const low = api.coord([api.value(0), api.value(2)]);
        const high = api.coord([api.value(1), api.value(3)]);
        const [left, right, above, below] = [low[0], high[0], high[1], low[1]].map(Math.round); // whole pixels leave no seams between cells
        return { type: "rect", shape: { x: left, y: above, width: right - left, height: below - above },
          style: { fill: colour(cells.values[api.value(4)]) } };
      },
    };
    const fixed = { splits: 6 };
    return {
      grid: { ...gridFor(context, x, y, square), show: true, backgroundColor: context.colours.empty, borderColor: "transparent" },
      xAxis: axis("x", { ...x, ...fixed }, context, undefined, { splitLine: { show: false } }),
      yAxis: axis("y", { ...y, ...fixed }, context, undefined, { splitLine: { show: false }, nameGap: 42 }),
      series: [...(cells ? [mosaic] : []), ...(shell ? [shellShapes(shell, context)] : []), ...(arrows.length ? [arrowShapes(arrows, context)] : []),
        ...(marks.length ? [markShapes(marks, context)] : [])],
      tooltip: { trigger: "item", formatter: (found) => (found.value?.length === 5 && cells ? hint(title, cells.tell(found.value[4])) : "") },
    };
  };
  return chart(key, { label, axes: [named(x.name, x.unit), named(y.name, y.unit)], height: heightFor(x, y, square), option });
}
