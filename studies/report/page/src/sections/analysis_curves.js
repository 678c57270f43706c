// Results with one dimension as curves with 90 % bands; a few rows without an axis of their own as several curves.
import { figure } from "../dom.js";
import { capital, isNumber, scale, words } from "../numbers.js";
import { lines } from "../plots/lines.js";
import { axisName, captionOf, withoutValues } from "./analysis_maps.js";

const MOST_ROWS = 6;

const fits = (axis, count) => Boolean(axis) && count > 1 && (axis.values.length === count || axis.values.length === count + 1);

export const isCurve = (result) => (result.shape.length === 1 && fits(result.axes?.[0], result.shape[0]))
  || (result.shape.length === 2 && !result.axes?.[0] && result.shape[0] <= MOST_ROWS && fits(result.axes?.[1], result.shape[1]));

/** Steps between edges, points at centres. */
const pointsOf = (places, values) => (places.length === values.length + 1
  ? values.flatMap((value, index) => [[places[index], value], [places[index + 1], value]]) : values.map((value, index) => [places[index], value]));

export function curveFigure(result, key) {
  const count = result.shape[result.shape.length - 1];
  const rows = result.shape.length === 2 ? result.shape[0] : 1;
  const axis = result.axes[result.axes.length - 1];
  const across = scale(axis.unit, axis.values);
  const places = axis.values.map((place) => place * across.factor);
  const by = scale(result.unit, result.value);
  const cut = (name, row) => (result[name] ? result[name].slice(row * count, (row + 1) * count).map((value) => (isNumber(value) ? value * by.factor : null)) : null);
  const series = [...Array(rows).keys()].map((row) => {
    const [low, high] = [cut("low", row), cut("high", row)];
    const lower = low && pointsOf(places, low);
    const upper = high && pointsOf(places, high);
    return { name: rows > 1 ? `${row + 1}` : "", points: pointsOf(places, cut("value", row)),
      band: low && high && rows === 1 ? lower.map((point, index) => [point[0], point[1] ?? NaN, upper[index][1] ?? NaN]) : null };
  });
  const wide = places[0] > 0 && places[places.length - 1] / places[0] > 1000;
  const positive = result.value.filter((value) => value > 0);
  const steep = wide && positive.length > 2 && Math.max(...positive) / Math.min(...positive) > 1000 && result.value.every((value) => !(value < 0));
  if (steep)
    for (const one of series) {
      one.points = one.points.map(([x, y]) => [x, y > 0 ? y : null]);
      one.band = one.band?.map(([x, low, high]) => [x, low > 0 ? low : NaN, high > 0 ? high : NaN]) ?? null;
    }
  const title = capital(words(result.name));
  if (!result.value.some((value) => isNumber(value) && value !== 0)) return withoutValues(result);
  return figure(captionOf(result), lines(key, { label: `${title} against ${axisName(axis)}. ${result.doc ?? ""}`, series,
    x: { name: axisName(axis), unit: across.unit, log: wide, min: wide ? undefined : places[0], max: wide ? undefined : places[places.length - 1] },
    y: { name: words(result.name), unit: by.unit, log: steep }, height: 290 }));
}
