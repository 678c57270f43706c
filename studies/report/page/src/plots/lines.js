// Curves with bands, steps for histograms, points, and lines that mark a place.
import { chart, hint } from "../chart.js";
import { line as colourOf } from "../colours.js";
import { named, number } from "../numbers.js";
import { axis, legend, legendHeight, roomBelow, widthOfTicks } from "./axes.js";

/** Values between edges as points of a staircase. */
export function stairs(edges, values) {
  const points = [];
  values.forEach((value, index) => points.push([edges[index], value], [edges[index + 1], value]));
  return points;
}

const bandPolygon = (points, fill, opacity) => ({
  type: "custom", silent: true, clip: true, z: 1, legendHoverLink: false, encode: { x: 0, y: [1, 2] }, data: points, tooltip: { show: false },
  renderItem(parameters, api) {
    if (parameters.dataIndexInside !== 0) return null;
    const upper = points.map((point) => api.coord([point[0], point[2]]));
    const lower = points.map((point) => api.coord([point[0], point[1]]));
    return { type: "polygon", shape: { points: upper.concat(lower.reverse()) }, style: { fill, opacity } };
  },
});

/** Points may lack their y; a band is then drawn in pieces. */
function pieces(band) {
  const found = [[]];
  for (const point of band) {
    if (point.every((value) => Number.isFinite(value))) found[found.length - 1].push(point);
    else if (found[found.length - 1].length > 0) found.push([]);
  }
  return found.filter((piece) => piece.length > 1);
}

/** Ends of a logarithmic axis. */
function ends(series, index) {
  const values = series.flatMap((one) => one.points.filter((point) => point[1] !== null).map((point) => point[index])).filter((value) => value > 0);
  return values.length ? { min: Math.min(...values), max: Math.max(...values) } : {};
}

const mark = ({ x, y, text, dashed = true }, { colours }) => ({
  type: "custom", silent: true, clip: true, z: 5, data: [[x ?? 0, y ?? 0]], encode: { x: -1, y: -1 }, tooltip: { show: false },
  renderItem(parameters, api) {
    const { x: left, y: top, width, height } = parameters.coordSys;
    const at = api.coord([x ?? NaN, y ?? NaN]);
    const vertical = x !== undefined;
    const across = vertical ? { x1: at[0], x2: at[0], y1: top, y2: top + height } : { x1: left, x2: left + width, y1: at[1], y2: at[1] };
    const label = vertical ? { x: at[0] + 4, y: top + 3 } : { x: left + width - 4, y: at[1] - 4 };
    return { type: "group", children: [
      { type: "line", shape: across, style: { stroke: colours.faint, lineWidth: 1.2, lineDash: dashed ? [5, 4] : null } },
      { type: "text", style: { text, ...label, fill: colours.faint, fontSize: 11, align: vertical ? "left" : "right",
        verticalAlign: vertical ? "top" : "bottom" } }] };
  },
});

/**
 * series: [{name, points: [[x, y] …], band: [[x, low, high] …], colour, dashed, dots, width, faint}]; x, y: {name, unit, log, min, max};
 * marks: [{x or y, text}]; hover: "axis" tells all curves at one x, "item" one point by describe(point, series).
 */
export function lines(key, { label, series, x, y, marks = [], height = 320, hover = "axis", describe }) {
  const names = series.filter((one) => one.name && !one.unlisted).map((one) => one.name);
  const colour = (one, index) => one.colour ?? colourOf(index);
  const tall = series.flatMap((one) => one.points.map((point) => point[1]).concat((one.band ?? []).flatMap((point) => [point[1], point[2]]))).filter(Number.isFinite);
  const gap = widthOfTicks(y.min ?? Math.min(0, ...tall), y.max ?? Math.max(...tall), y.log);
  const spread = (one, index) => (one.log && one.min === undefined ? { ...one, ...ends(series, index) } : one);
  const option = (context) => {
    const { width, height: full, colours } = context;
    const left = gap + 24;
    const below = roomBelow(x, width - left - 18);
    const above = legendHeight(names, width);
    const drawn = [];
    series.forEach((one, index) => {
      for (const piece of one.band ? pieces(one.band) : []) drawn.push(bandPolygon(piece, colour(one, index), 0.2));
      drawn.push({
        type: one.dots ? "scatter" : "line", name: one.name, data: one.points, color: colour(one, index), z: 3, clip: true,
        showSymbol: Boolean(one.symbols), symbol: one.symbol ?? "circle", symbolSize: one.size ?? (one.dots ? 8 : 5), connectNulls: false,
        lineStyle: { width: one.width ?? 1.8, type: one.dashed ? "dashed" : "solid", opacity: one.faint ? 0.45 : 1 }, emphasis: { disabled: true },
        itemStyle: one.outline ? { color: "transparent", borderColor: colour(one, index), borderWidth: 2 } : { borderColor: colours.back, borderWidth: 0.5 },
      });
    });
    const tell = (found) => {
      const all = (Array.isArray(found) ? found : [found]).filter((one) => Array.isArray(one.value) && Number.isFinite(one.value[1]));
      if (all.length === 0) return "";
      if (describe) return describe(all[0].value, all[0].seriesName);
      const once = all.filter((one, index) => all.findIndex((other) => other.seriesName === one.seriesName) === index);
      return hint(`${x.name} ${number(all[0].value[0])}${x.unit ? ` ${x.unit}` : ""}`,
        once.map((one) => [one.color, one.seriesName || y.name, `${number(one.value[1])}${y.unit ? ` ${y.unit}` : ""}`]));
    };
    return {
      grid: { left, right: 18, top: above, bottom: below, outerBoundsMode: "none" }, legend: legend(names, context),
      xAxis: axis("x", spread(x, 0), context, width - left - 18), yAxis: axis("y", { ...spread(y, 1), gap }, context, full - above - below),
      series: drawn.concat(marks.map((one) => mark(one, context))), tooltip: { trigger: hover, formatter: tell },
    };
  };
  return chart(key, { label, axes: [named(x.name, x.unit), named(y.name, y.unit)], height, option });
}
