// An analysis: where the charge is, every single number, and maps and curves that are drawn when they are opened.
import { block, disclosure, element, list, table } from "../dom.js";
import { among, capital, interval, isNumber, number, quantity, readable, scale, withError, words } from "../numbers.js";
import { chargeBlock } from "./analysis_charge.js";
import { curveFigure, isCurve } from "./analysis_curves.js";
import { isMap, mapFigure } from "./analysis_maps.js";

const FLAGS = [[1, "few blocks"], [2, "widened"], [4, "often undefined"], [8, "no uncertainty"]];

export const remarks = (bits) => FLAGS.filter(([bit]) => (bits ?? 0) & bit).map((flag) => flag[1]).join(", ");

const size = (result) => result.shape.reduce((product, part) => product * part, 1);

/** Single numbers, and the parts of short lists without an axis, each as a row. */
function rowsOf(results) {
  const rows = [];
  for (const result of results) {
    const count = size(result);
    if (result.shape.length > 0 && (isMap(result) || isCurve(result) || count > 12)) continue;
    for (let index = 0; index < count; index++) {
      const at = (name) => result[name]?.[index];
      const by = scale(result.unit, [at("value"), at("high")]);
      rows.push({ analyzer: result.analyzer, name: words(result.name) + (result.shape.length ? ` [${index + 1}]` : ""), doc: result.doc, unit: by.unit, factor: by.factor,
        value: at("value"), low: at("low"), high: at("high"), flags: at("flags") });
    }
  }
  return rows;
}

function numbers(results, key) {
  const rows = rowsOf(results);
  if (rows.length === 0) return null;
  const known = rows.filter((row) => isNumber(row.value));
  const undefinedRows = rows.filter((row) => !isNumber(row.value));
  return block(`${key}-numbers`, "All single numbers", element("div", { class: "tall" }, table({ caption: `${known.length} numbers with 90 % intervals`, rows: known, groupOf: (row) => capital(words(row.analyzer)), columns: [
    { label: "result", header: true, wide: true, value: (row) => [row.name, row.doc ? element("small", null, readable(row.doc)) : null] },
    { label: "value", number: true, value: (row) => among(row.value, row.low, row.high, row.factor) },
    { label: "90 % interval", number: true, value: (row) => (row.high > row.low ? interval(row.low, row.high, row.factor) : "–") }, { label: "unit", value: (row) => row.unit },
    { label: "remarks", value: (row) => remarks(row.flags) }] })),
  undefinedRows.length ? disclosure(`${key}-undefined`, `${undefinedRows.length} numbers are undefined in these data`,
    () => list(undefinedRows.map((row) => `${words(row.analyzer)}: ${row.name}`))) : null);
}

/** One disclosure per analyzer; its charts are drawn when it is open and they come into view. */
function drawings(results, what, figureOf, key, shell, open) {
  const analyzers = [...new Set(results.map((result) => result.analyzer))];
  return analyzers.map((analyzer) => {
    const own = results.filter((result) => result.analyzer === analyzer);
    return disclosure(`${key}-${what}-${analyzer}`, `${capital(words(analyzer))}: ${own.length} ${own.length === 1 ? what.slice(0, -1) : what}`,
      () => element("div", { class: "halves" }, own.map((result) => figureOf(result, `${key}-${analyzer}-${result.name}`, shell))), analyzer === open);
  });
}

export function analysis(section, key) {
  const { meta = {}, shell, results = [] } = section;
  const find = (analyzer, name) => results.find((result) => result.analyzer === analyzer && result.name === name);
  const single = (analyzer, name) => {
    const result = find(analyzer, name);
    return isNumber(result?.value?.[0]) ? withError(result.value[0], result.sem?.[0], result.unit) : null;
  };
  const fact = (title, analyzer, name, note) => {
    const text = single(analyzer, name);
    return text ? [title, text, note ?? remarks(find(analyzer, name).flags?.[0])] : null;
  };
  const maps = results.filter(isMap);
  const curves = results.filter((result) => !isMap(result) && isCurve(result));
  const { context = {} } = meta;
  return {
    kind: ["simulation", "coarse frames"].includes(meta.source) ? "Analysis of a simulation" : "Analysis of a recording", sentence: meta.description,
    headline: [fact("Power, by the charge's place", "power", "power_gravity"), fact("Shoulder", "charge_features", "departure_shoulder"), fact("Toe of the bulk", "charge_features", "bulk_toe"),
      fact("Centre of circulation", "charge_features", "centre_of_circulation_radius"), fact("Free surface", "charge_features", "free_surface_angle"),
      isNumber(context.omega) && ["Speed", quantity(Math.abs(context.omega), "rad/s"), context.omega > 0 ? "counter-clockwise" : "clockwise"],
      isNumber(meta.blocks) && ["Independent blocks", number(meta.blocks), isNumber(meta.block_duration_s) ? `of ${quantity(meta.block_duration_s, "s", 3)}` : null]],
    blocks: [
      chargeBlock(find, shell, key), numbers(results, key),
      maps.length ? block(`${key}-maps`, "Maps", drawings(maps, "maps", mapFigure, key, shell, "pept_grid")) : null,
      curves.length ? block(`${key}-curves`, "Curves", drawings(curves, "curves", curveFigure, key, shell, "distributions")) : null,
      meta.left_out?.length ? block(`${key}-left-out`, "Left out", list(meta.left_out.map((one) => (typeof one === "string" ? one : Object.values(one).join(": "))))) : null,
    ],
  };
}
