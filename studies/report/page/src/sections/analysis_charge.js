// The charge's outline on the map of where its beads are.
import { block, element, figure, table } from "../dom.js";
import { line } from "../colours.js";
import { among, interval, isNumber, scale } from "../numbers.js";
import { drawMap, isMap } from "./analysis_maps.js";

// Angles of charge_features, degrees from 6 o'clock in the turning sense.
const ANGLES = [["departure_shoulder", "shoulder", line(1)], ["bulk_toe", "toe", line(4)], ["impact_toe", "impact toe", line(3)], ["head_angle", "head", line(5)]];
const PLACES = [["centre_of_circulation", "centre of circulation", line(1)], ["centre_of_mass", "centre of mass", line(4)]];
const TABLE = [["departure_shoulder", "shoulder: the flow begins to leave the shell"], ["departure_median", "half of the flow has left the shell"], ["head_angle", "head: highest part of the charge"],
  ["bulk_toe", "toe of the bulk: half of the flow is back"], ["farthest_toe", "farthest toe"], ["impact_toe", "impact toe: median of the flights' ends"],
  ["free_surface_angle", "free surface, from the horizontal"], ["centre_of_circulation_x", "centre of circulation, x"], ["centre_of_circulation_y", "centre of circulation, y"],
  ["centre_of_mass_x", "centre of mass, x"], ["centre_of_mass_y", "centre of mass, y"], ["head_height", "height of the head above the axis"]];
const NEAR = 9; // degrees: labels that stand nearer are moved apart

export function chargeBlock(find, shell, key) {
  const occupancy = [find("pept_grid", "occupancy"), find("ergodicity", "occupancy_all")].find((result) => result && isMap(result));
  const feature = (name) => find("charge_features", name);
  const value = (name) => (isNumber(feature(name)?.value?.[0]) ? feature(name).value[0] : null);
  const rows = TABLE.map(([name, title]) => ({ title, result: feature(name) })).filter((row) => isNumber(row.result?.value?.[0]));
  if (!occupancy && rows.length === 0) return null;
  const radius = (shell?.radius_m ?? 0) * 1000;
  const marks = [];
  const used = [];
  for (const [name, text, colour] of radius > 0 ? ANGLES : []) {
    const degrees = value(name);
    if (degrees === null) continue;
    const angle = degrees * (Math.PI / 180);
    const [x, y] = [(shell.turns || 1) * Math.sin(angle), -Math.cos(angle)];
    const crowded = used.filter((one) => Math.abs(one - degrees) < NEAR).length;
    used.push(degrees);
    marks.push({ x: 0.78 * radius * x, y: 0.78 * radius * y, x2: radius * x, y2: radius * y, text, colour, shift: 14 * crowded });
  }
  const places = PLACES.map(([name, text, colour]) => ({ x: value(`${name}_x`) * 1000, y: value(`${name}_y`) * 1000, text, colour, known: value(`${name}_x`) !== null && value(`${name}_y`) !== null }))
    .filter((one) => one.known).sort((a, b) => b.y - a.y);
  const close = places.length === 2 && places[0].y - places[1].y < 0.2 * radius;
  places.forEach((one, index) => marks.push({ ...one, side: one.x > 0 ? "left" : "right", shift: close ? 14 * index - 7 : 0 })); // towards the middle, where there is room
  const facts = rows.length ? table({ caption: "Charge features with 90 % intervals", rows, columns: [{ label: "feature", wide: true, value: (row) => row.title },
    { label: "value", number: true, value: (row) => among(row.result.value[0], row.result.low?.[0], row.result.high?.[0], scale(row.result.unit).factor) },
    { label: "90 %", number: true, value: (row) => (row.result.high?.[0] > row.result.low?.[0] ? interval(row.result.low[0], row.result.high[0], scale(row.result.unit).factor) : "–") },
    { label: "unit", value: (row) => scale(row.result.unit).unit }] }) : null;
  const picture = occupancy ? figure("Share of the time in each cell, with the shell, the lifters at the start, and the charge's features. Angles count from 6 o'clock in the turning sense. "
    + "Plain ground: never visited.", ...drawMap(`${key}-charge`, occupancy, shell, { marks, label: `Marked: ${marks.map((mark) => mark.text).join(", ")}.` }).filter(Boolean)) : null;
  return block(`${key}-charge`, "Where the charge is", element("div", { class: "halves" }, picture, facts));
}
