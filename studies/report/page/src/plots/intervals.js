// One row per thing: a dot and its interval; and bars, side by side or on top of each other.
import { chart, hint } from "../chart.js";
import { line as colourOf } from "../colours.js";
import { named, number } from "../numbers.js";
import { axis, legend, legendHeight, range, roomBelow, roundRange } from "./axes.js";

const cut = (text, most) => (text.length > most ? `${text.slice(0, most - 1)}…` : text);

/** Names of rows, broken into two lines where they are long. */
const rowAxis = (rows, context, room) => ({
  type: "category", inverse: true, data: rows, axisTick: { show: false }, axisLine: { lineStyle: { color: context.colours.faint } },
  axisLabel: { color: context.colours.text, fontSize: 11, width: room - 10, overflow: "break", interval: 0, lineHeight: 12,
    formatter: (text) => cut(text, Math.floor((room - 10) / 5.6) * (context.narrow ? 3 : 2)) },
  splitLine: { show: true, lineStyle: { color: context.colours.rule, type: "dotted" } },
});

const roomFor = (rows, width) => Math.min(width * 0.42, 16 + 6.4 * Math.max(4, ...rows.map((row) => row.length)));

/**
 * rows: [name]; groups: [{name, colour, symbol, values: [{value, low, high, text} or null per row]}]; x: {name, unit, min, max};
 * zone: [low, high] is shaded; zero: where a vertical line stands.
 */
export function intervals(key, { label, rows, groups, x, zero, zone }) {
  const names = groups.map((group) => group.name).filter(Boolean);
  const all = groups.flatMap((group) => group.values.filter(Boolean).flatMap((one) => [one.value, one.low, one.high]))
    .concat(zero ?? [], zone ?? []).filter(Number.isFinite);
  const [low, high] = roundRange(range(all));
  const height = (width) => 12 + legendHeight(names, width) + roomBelow(x, width - roomFor(rows, width) - 20) + rows.length * ((width < 480 ? 36 : 26) + 8 * (groups.length - 1));
  const option = (context) => {
    const { width, colours } = context;
    const room = roomFor(rows, width);
    const shift = (index) => (index - (groups.length - 1) / 2) * 9;
    const item = (group, index) => ({
      type: "custom", name: group.name, color: group.colour ?? colourOf(index), encode: { x: [0, 2, 3], y: 1 }, z: 3,
      data: group.values.map((one, row) => (one && Number.isFinite(one.value) ? [one.value, row, one.low ?? one.value, one.high ?? one.value] : null))
        .filter(Boolean),
      renderItem(parameters, api) {
        const row = api.value(1);
        const one = group.values[row];
        const at = api.coord([api.value(0), row]);
        const ends = [api.coord([api.value(2), row])[0], api.coord([api.value(3), row])[0]];
        const y = at[1] + shift(index);
        const colour = one.colour ?? group.colour ?? colourOf(index);
        const whisker = (end) => ({ type: "line", shape: { x1: end, x2: end, y1: y - 4, y2: y + 4 }, style: { stroke: colour, lineWidth: 1.5 } });
        const symbol = group.symbol === "square" ? { type: "rect", shape: { x: at[0] - 4, y: y - 4, width: 8, height: 8 } }
          : { type: "circle", shape: { cx: at[0], cy: y, r: 4.5 } };
        const known = ends[1] - ends[0] > 0.5;
        return { type: "group", children: [
          ...(known ? [{ type: "line", shape: { x1: ends[0], x2: ends[1], y1: y, y2: y }, style: { stroke: colour, lineWidth: 2 } },
            whisker(ends[0]), whisker(ends[1])] : []),
          { ...symbol, style: one.hollow ? { fill: colours.back, stroke: colour, lineWidth: 2 } : { fill: colour } }] };
      },
    });
    const shade = zone ? [{
      type: "custom", silent: true, data: [[zone[0], 0]], encode: { x: -1, y: -1 }, z: 0, tooltip: { show: false },
      renderItem(parameters, api) {
        const [from, to] = zone.map((end) => api.coord([end, 0])[0]);
        return { type: "rect", shape: { x: from, y: parameters.coordSys.y, width: to - from, height: parameters.coordSys.height },
          style: { fill: colours.faint, opacity: 0.13 } };
      } }] : [];
    const origin = zero === undefined ? [] : [{
      type: "custom", silent: true, data: [[zero, 0]], encode: { x: -1, y: -1 }, z: 1, tooltip: { show: false },
      renderItem(parameters, api) {
        const at = api.coord([zero, 0])[0];
        return { type: "line", shape: { x1: at, x2: at, y1: parameters.coordSys.y, y2: parameters.coordSys.y + parameters.coordSys.height },
          style: { stroke: colours.text, lineWidth: 1.2 } };
      } }];
    const tell = (found) => {
      const group = groups.find((one) => (one.name ?? "") === (found.seriesName ?? "")) ?? groups[found.seriesIndex - shade.length] ?? groups[0];
      const one = group.values[found.value[1]];
      const text = one.text ?? `${number(one.value)}${Number.isFinite(one.low) ? ` (${number(one.low)} … ${number(one.high)})` : ""}${x.unit ? ` ${x.unit}` : ""}`;
      return hint(rows[found.value[1]], [[found.color, group.name || x.name, text]]);
    };
    return {
      grid: { left: room, right: 20, top: legendHeight(names, width), bottom: roomBelow(x, width - room - 20), outerBoundsMode: "none" },
      legend: legend(names, context), yAxis: rowAxis(rows, context, room),
      xAxis: axis("x", { ...x, min: x.min ?? low, max: x.max ?? high }, context, width - room - 20),
      series: [...shade, ...groups.map(item), ...origin], tooltip: { trigger: "item", formatter: tell },
    };
  };
  return chart(key, { label, axes: [named(x.name, x.unit)], height, option });
}

/** rows: [name]; groups: [{name, values: [number]}]; x: {name, unit}; stacked puts the groups of a row on top of each other. */
export function bars(key, { label, rows, groups, x, stacked = false }) {
  const names = groups.map((group) => group.name).filter(Boolean);
  const height = (width) => 12 + legendHeight(names, width) + roomBelow(x, width - roomFor(rows, width) - 24) + rows.length * (stacked || groups.length === 1 ? 34 : 14 + 16 * groups.length);
  const option = (context) => {
    const room = roomFor(rows, context.width);
    return {
      grid: { left: room, right: 24, top: legendHeight(names, context.width), bottom: roomBelow(x, context.width - room - 24), outerBoundsMode: "none" },
      legend: legend(names, context), yAxis: rowAxis(rows, context, room), xAxis: { ...axis("x", x, context, context.width - room - 24), scale: false },
      series: groups.map((group, index) => ({ type: "bar", name: group.name, data: group.values, color: group.colour ?? colourOf(index),
        stack: stacked ? "all" : undefined, barMaxWidth: 20, emphasis: { disabled: true },
        itemStyle: { decal: undefined, borderColor: context.colours.back, borderWidth: stacked ? 1 : 0 } })),
      tooltip: { trigger: "item", formatter: (found) => hint(rows[found.dataIndex],
        [[found.color, found.seriesName || x.name, `${number(found.value)}${x.unit ? ` ${x.unit}` : ""}`]]) },
    };
  };
  return chart(key, { label, axes: [named(x.name, x.unit)], height, option });
}
