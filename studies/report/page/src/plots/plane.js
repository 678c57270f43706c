// A function of two numbers as coloured ground with contour lines, and points on it.
import { chart, FONT, hint } from "../chart.js";
import { named, number } from "../numbers.js";
import { axis, legend, legendHeight, roomBelow, widthOfTicks } from "./axes.js";

/** Round levels of a contour map. */
export function levels(low, high, about = 9) {
  const rough = (high - low) / about;
  if (!(rough > 0)) return [];
  const size = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].find((one) => one * size >= rough) * size;
  const found = [];
  for (let level = Math.ceil(low / step) * step; level < high; level += step) found.push(Number(level.toPrecision(8)));
  return found;
}

/** Segments [[x1, y1], [x2, y2]] where the field, given at places xs × ys row by row, passes the level (marching squares). */
export function contour({ xs, ys, values }, level) {
  const segments = [];
  const at = (column, row) => values[row * xs.length + column] - level;
  for (let row = 0; row + 1 < ys.length; row++) {
    for (let column = 0; column + 1 < xs.length; column++) {
      const corners = [[column, row], [column + 1, row], [column + 1, row + 1], [column, row + 1]];
      const crossings = [];
      corners.forEach(([c1, r1], index) => {
        const [c2, r2] = corners[(index + 1) % 4];
        const [one, other] = [at(c1, r1), at(c2, r2)];
        if (one < 0 === other < 0) return;
        const share = one / (one - other);
        crossings.push([xs[c1] + share * (xs[c2] - xs[c1]), ys[r1] + share * (ys[r2] - ys[r1])]);
      });
      for (let index = 0; index + 1 < crossings.length; index += 2) segments.push([crossings[index], crossings[index + 1]]);
    }
  }
  return segments;
}

const shapes = (draw, z) => ({ type: "custom", silent: true, clip: true, data: [[0, 0]], z, tooltip: { show: false }, encode: { x: 0, y: 1 },
  renderItem: (parameters, api) => ({ type: "group", children: draw(api) }) });

function contourShapes(field, { colours }) {
  return shapes((api) => {
    const children = [];
    for (const level of field.levels) {
      const segments = contour(field, level).map((segment) => segment.map((point) => api.coord(point)));
      if (segments.length === 0) continue;
      const pathData = segments.map(([a, b]) => `M${a[0].toFixed(1)} ${a[1].toFixed(1)}L${b[0].toFixed(1)} ${b[1].toFixed(1)}`).join("");
      children.push({ type: "path", shape: { pathData }, style: { fill: "none", stroke: "#ffffff", lineWidth: 1.1, opacity: 0.85 } });
      const [x, y] = segments[Math.floor(segments.length / 2)][0];
      children.push({ type: "text", z2: 2, style: { text: number(level, 3), x, y, fill: colours.strong, stroke: colours.back, lineWidth: 3, fontFamily: FONT, fontSize: 11, align: "center",
        verticalAlign: "middle" } });
    }
    return children;
  }, 3);
}

function ground(field, colour) {
  const halfX = (field.xs[1] - field.xs[0]) / 2;
  const halfY = (field.ys[1] - field.ys[0]) / 2;
  const data = [...field.values.keys()].map((index) => [field.xs[index % field.xs.length], field.ys[Math.floor(index / field.xs.length)], index]);
  return { type: "custom", data, z: 1, clip: true, encode: { x: 0, y: 1 }, progressive: 0,
    renderItem(parameters, api) {
      const [low, high] = [api.coord([api.value(0) - halfX, api.value(1) - halfY]), api.coord([api.value(0) + halfX, api.value(1) + halfY])];
      const [left, right, above, below] = [low[0], high[0], high[1], low[1]].map(Math.round);
      return { type: "rect", shape: { x: left, y: above, width: right - left, height: below - above }, style: { fill: colour(field.values[api.value(2)]) } };
    } };
}

/**
 * x, y: {name, unit, min, max}; field: {xs, ys, values, levels, name} or nothing; colour(value) → CSS colour, of ground and points;
 * groups: [{name, symbol, points: [{x, y, value, text, fill}]}]; path: [[x, y] …] a line through places in their order.
 */
export function plane(key, { label, x, y, field, colour, groups = [], height = 380 }) {
  const names = groups.map((group) => group.name).filter(Boolean);
  const option = (context) => {
    const { width, height: full, colours } = context;
    const gap = widthOfTicks(y.min, y.max);
    const [left, above, below] = [gap + 24, legendHeight(names, width), roomBelow(x, width - gap - 42)];
    const marks = groups.map((group) => ({
      type: "scatter", name: group.name, z: 5, symbol: group.symbol ?? "circle", symbolSize: group.size ?? 11, color: group.fill ?? colours.faint, clip: true,
      data: group.points.map((point) => ({ value: [point.x, point.y], text: point.text,
        itemStyle: { color: group.fill ?? (Number.isFinite(point.value) ? colour(point.value) : colours.faint), borderColor: colours.text, borderWidth: 1.2 } })),
      emphasis: { disabled: true },
    }));
    const tell = (found) => {
      const group = groups.find((one) => one.name === found.seriesName && found.componentSubType === "scatter");
      if (group) return hint(group.name, found.data.text);
      return field && Array.isArray(found.value) ? hint(field.name, [[x.name, number(found.value[0], 3)], [y.name, number(found.value[1], 3)], ["value", number(field.values[found.value[2]], 3)]]) : "";
    };
    return {
      grid: { left, right: 18, top: above, bottom: below, outerBoundsMode: "none", show: true, backgroundColor: "transparent", borderColor: colours.rule }, legend: legend(names, context),
      xAxis: axis("x", x, context, width - left - 18, { splitLine: { show: !field, lineStyle: { color: colours.rule } } }),
      yAxis: axis("y", { ...y, gap }, context, full - above - below, { splitLine: { show: !field, lineStyle: { color: colours.rule } } }),
      series: [...(field ? [ground(field, colour), contourShapes(field, context)] : []), ...marks], tooltip: { trigger: "item", formatter: tell },
    };
  };
  return chart(key, { label, axes: [named(x.name, x.unit), named(y.name, y.unit)], height, option });
}
