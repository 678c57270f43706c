// Results with two dimensions as coloured maps.
import { element, figure } from "../dom.js";
import { colouring, line } from "../colours.js";
import { capital, interval, isNumber, number, readable, scale, words } from "../numbers.js";
import { colourBar, colourKey, map } from "../plots/map.js";

const MOST_NAMES = 8;
const colourOfName = (value) => (value === 0 ? "transparent" : line(value - 1));

export const axisName = (axis) => words(axis.name.replace(/_?(edges|centres|centers)/, "").replace(/_(deg|m|s)$/, "")) || "place";
const along = (axis, letter) => Boolean(axis) && new RegExp(`^${letter}(_|$)`).test(axis.name);

export const isMap = (result) => result.shape.length === 2 && Boolean(result.axes?.[0] && result.axes?.[1])
  && result.axes.every((axis, index) => Math.abs(axis.values.length - result.shape[index] - 0.5) < 1);

/** Edges of n cells, also where the axis gives their centres. */
export function edgesOf(values, count) {
  if (values.length === count + 1) return values;
  const middle = values.slice(1).map((value, index) => (value + values[index]) / 2);
  const first = middle.length ? 2 * values[0] - middle[0] : values[0] - 0.5;
  const last = middle.length ? 2 * values[count - 1] - middle[middle.length - 1] : values[0] + 0.5;
  return [first, ...middle, last];
}

/** [[number, name] …] of a map of names: "0 nothing, 1 en masse, …". */
function namesIn(result) {
  const found = [...(result.doc ?? "").matchAll(/(?:^|[,;] )(\d) ([a-z][a-z ]*)/g)].map((one) => [Number(one[1]), one[2].trim()]);
  const whole = result.value.every((value) => value === null || (Number.isInteger(value) && value >= 0 && value <= MOST_NAMES));
  return found.length > 1 && found[0][0] === 0 && whole ? found : null;
}

/** The map's numbers in the units that are read, with x across and y up. */
export function mapOf(result, shell) {
  const transposed = along(result.axes[0], "x") && along(result.axes[1], "y"); // rows are x: turn it
  const [up, across] = transposed ? [1, 0] : [0, 1];
  const [rows, columns] = [result.shape[up], result.shape[across]];
  const place = (index) => (transposed ? (index % columns) * rows + Math.floor(index / columns) : index);
  const by = scale(result.unit, result.value);
  const axes = [across, up].map((at) => {
    const unit = scale(result.axes[at].unit);
    return { name: axisName(result.axes[at]), unit: unit.unit, edges: edgesOf(result.axes[at].values, result.shape[at]).map((edge) => edge * unit.factor) };
  });
  const counts = /occupancy|visits|^time$/.test(result.name); // of these, 0 means never visited
  const values = [...Array(rows * columns).keys()].map((index) => {
    const value = result.value[place(index)];
    return isNumber(value) && !(counts && value === 0) ? value * by.factor : NaN;
  });
  const square = along(result.axes[up], "y") && along(result.axes[across], "x");
  const tell = (index) => {
    const at = place(index);
    const middle = (axis, cell) => number((axis.edges[cell] + axis.edges[cell + 1]) / 2, 3);
    const unit = by.unit ? ` ${by.unit}` : "";
    const rowsOfHint = [[`${axes[0].name} ${middle(axes[0], index % columns)}, ${axes[1].name} ${middle(axes[1], Math.floor(index / columns))} ${axes[0].unit}`, `${number(values[index])}${unit}`]];
    if (isNumber(result.sem?.[at])) rowsOfHint.push(["standard error", `${number(result.sem[at] * by.factor, 2)}${unit}`]);
    if (isNumber(result.low?.[at]) && isNumber(result.high?.[at])) rowsOfHint.push(["90 %", interval(result.low[at], result.high[at], by.factor)]);
    return rowsOfHint;
  };
  return { axes, values, unit: by.unit, tell, square, shell: square && shell ? shellIn(shell) : null };
}

/** Millimetres, with the lifters where they stand. */
export function shellIn(shell) {
  const turn = shell.angle_rad ?? 0;
  const [c, s] = [Math.cos(turn) * 1000, Math.sin(turn) * 1000];
  const at = (x, y) => [c * x - s * y, s * x + c * y];
  return { radius: shell.radius_m * 1000, segments: (shell.segments_m ?? []).map(([x1, y1, x2, y2]) => [...at(x1, y1), ...at(x2, y2)]) };
}

export function drawMap(key, result, shell, more = {}) {
  const found = mapOf(result, shell);
  const [x, y] = found.axes;
  const names = namesIn(result);
  const colours = names ? null : colouring(found.values);
  const colour = names ? colourOfName : colours?.colour;
  const title = capital(words(result.name));
  const tell = names ? (index) => [[found.tell(index)[0][0], names.find(([number_]) => number_ === found.values[index])?.[1] ?? String(found.values[index])]] : found.tell;
  const ends = (axis) => ({ name: axis.name, unit: axis.unit, min: axis.edges[0], max: axis.edges[axis.edges.length - 1] });
  const known = found.values.filter(Number.isFinite).length;
  const drawn = map(key, { label: `${title}: map of ${known} cells. ${more.label ?? result.doc ?? ""}`, x: ends(x), y: ends(y), square: found.square,
    cells: { edgesX: x.edges, edgesY: y.edges, values: found.values, tell }, colour: colour ?? (() => "transparent"), shell: found.shell, marks: more.marks ?? [], title });
  const below = names ? colourKey(names.filter(([value]) => value > 0).map(([value, name]) => [colourOfName(value), name])) : colourBar(colours, { name: words(result.name), unit: found.unit });
  return [drawn, below];
}

/** The result's name in full and what it is: axes may have less room than that. */
export const captionOf = (result) => [element("b", null, capital(words(result.name))), result.doc ? `. ${readable(result.doc)}` : ""];

/** Said in words, as an empty chart could also be one that failed. */
export const withoutValues = (result) => figure(captionOf(result), element("p", { class: "nothing" }, result.value.some(isNumber)
  ? "Nothing to draw: it is zero everywhere." : "Nothing to draw: these data have no value of it, because what it counts did not occur, or too seldom."));

export const mapFigure = (result, key, shell) => (result.value.some(isNumber) ? figure(captionOf(result), ...drawMap(key, result, shell).filter(Boolean)) : withoutValues(result));
