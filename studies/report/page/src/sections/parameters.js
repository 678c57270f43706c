// Names and units of contact parameters and nuisances: SI numbers without a unit of their own in the files.
import { among, interval, isNumber, scale, words } from "../numbers.js";

/** A filling is read in %, everything else as it is. */
export const scaleOf = (name) => (/filling/.test(name) ? { factor: 100, unit: "%" } : { factor: 1, unit: "" });

export const titleOf = (name) => {
  const { unit } = scaleOf(name);
  return unit ? `${words(name)} (${unit})` : words(name);
};

/** "0.24 (0.18 … 0.35)" of an interval. */
export function told(name, found) {
  if (!found) return "–";
  const { factor } = scaleOf(name);
  const value = among(found.value, found.low90, found.high90, factor);
  return found.high90 > found.low90 ? `${value} (${interval(found.low90, found.high90, factor)})` : value;
}

/** For a chart. */
export function point(name, found, more = {}) {
  if (!found) return null;
  const { factor } = scaleOf(name);
  return { value: found.value * factor, low: found.low90 * factor, high: found.high90 * factor, text: told(name, found), ...more };
}

/** What a candidate's own parameter is: "rolling friction 0.163 (0.134 … 0.177)". */
export const strength = (row, before = "") => Object.entries(row.parameters ?? {}).map(([name, found]) => {
  const by = scale(found.unit, [found.value, found.high90]);
  const known = isNumber(found.low90) && isNumber(found.high90);
  const unit = by.unit ? ` ${by.unit}` : "";
  return `${words(name)} ${among(found.value, found.low90, found.high90, by.factor)}${known ? ` (${before}${interval(found.low90, found.high90, by.factor)})` : ""}${unit}`;
}).join("; ");
