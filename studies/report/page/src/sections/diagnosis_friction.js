// What friction is with and without the missing physics, over all recordings and for each speed alone.
import { block, element, figure, note, paragraph, table } from "../dom.js";
import { capital, number, readable, words } from "../numbers.js";
import { intervals } from "../plots/intervals.js";
import { lines } from "../plots/lines.js";
import { range, roundRange } from "../plots/axes.js";
import { CORRECTED, TO_ALL, TO_POWER } from "./models.js";
import { point, scaleOf, titleOf, told } from "./parameters.js";

/** θ of the base that was retuned to the power alone: where it was tried on a held-out condition. */
const practiceOf = (all = []) => all.flatMap((held) => held.models ?? []).find((model) => model.model === TO_POWER.model)?.parameters;

/** The interval below the value: a table of several has to fit on a phone. */
function stacked(name, found) {
  const [value, interval] = told(name, found).split(" (");
  return [value, interval ? element("small", null, interval.replace(")", "")) : null];
}

export function frictionBlock({ contact_parameters: parameters, hypotheses = [], held_out: held, moved_by_practice: moved = [] }, key) {
  const { retuned = {}, unmasked } = parameters ?? {};
  const names = Object.keys(retuned);
  if (names.length === 0) return null;
  const best = hypotheses.find((row) => row.class === "best");
  const practice = practiceOf(held);
  const frictions = names.filter((name) => scaleOf(name).unit === "");
  const alone = (name) => ({ value: practice?.[name], low90: practice?.[name], high90: practice?.[name] });
  const sides = [practice && { ...TO_POWER, of: alone }, { ...TO_ALL, of: (name) => retuned[name] },
    unmasked && { ...CORRECTED, short: "unmasked", name: `unmasked, with ${best ? words(best.name) : "the best candidate"}`, of: (name) => unmasked[name] }].filter(Boolean);
  return block(`${key}-friction`, "Friction, retuned and unmasked",
    paragraph(unmasked ? "Retuning friction can conceal missing physics. What friction is once that physics is there is called unmasked."
      : best ? "The fit with the best candidate stands at an end of what was simulated, so what friction is beside it is not known: these are the retuned values."
        : "No candidate is significant, so there is no unmasked friction: these are the retuned values."),
    moved.map((sentence) => paragraph(capital(readable(sentence)), ".")),
    frictions.length ? figure("With 90 % intervals.", intervals(`${key}-friction`, {
      label: `Contact parameters: ${frictions.map((name) => `${name} ${told(name, retuned[name])}`).join(", ")}`, rows: frictions.map(titleOf),
      groups: sides.map(({ name, colour, of }) => ({ name, colour, values: frictions.map((one) => point(one, of(one))) })), x: { name: "value of the parameter" } })) : null,
    table({ caption: "Parameters with 90 % intervals", rows: names, columns: [{ label: "parameter", value: titleOf },
      ...sides.map(({ name, short, of }) => ({ label: short ?? name, number: true, value: (one) => stacked(one, of(one)) }))] }));
}

const SPEED = 30 / Math.PI; // rad/s → rpm

/** Friction that must drift with speed is a sign that it stands for something else. */
export function drift({ per_speed_friction: rows = [], hypotheses = [] }, key) {
  const names = Object.keys(rows[0]?.before ?? {}).filter((name) => scaleOf(name).unit === "");
  if (rows.length < 2 || names.length === 0) return null;
  const sorted = [...rows].sort((a, b) => a.speed_rad_per_s - b.speed_rad_per_s);
  const after = sorted.some((row) => Object.keys(row.after ?? {}).length > 0);
  const best = hypotheses.find((row) => row.class === "best")?.name.replace(/_/g, " ") ?? "the best candidate";
  const x = (row) => row.speed_rad_per_s * SPEED;
  const [left, right] = range(sorted.map(x), 0.08);
  const plots = names.map((name) => {
    const curve = (side) => ({ points: sorted.map((row) => [x(row), row[side]?.[name]?.value ?? null]),
      band: sorted.filter((row) => row[side]?.[name]).map((row) => [x(row), row[side][name].low90, row[side][name].high90]), symbols: true, size: 8 });
    const series = [{ name: "without a candidate", dashed: true, symbol: "rect", ...curve("before") }];
    if (after) series.push({ name: `with ${best}`, ...curve("after") });
    const [low, high] = roundRange(range([0, ...series.flatMap((one) => one.band.flatMap((point) => point.slice(1)))]), 5);
    return element("div", { class: "half" }, lines(`${key}-drift-${name}`, { label: `${titleOf(name)} fitted to each speed alone`, series,
      x: { name: "speed of the mill", unit: "rpm", min: Math.floor(left), max: Math.ceil(right) }, y: { name: titleOf(name), min: low, max: high }, height: 280 }));
  });
  return block(`${key}-drift`, "Friction for each speed alone", figure("Each condition fitted alone, with 90 % bands. A material has one friction: where it must drift with speed, or jump, it "
    + "stands for something else.", element("div", { class: "halves" }, plots)),
  table({ caption: "Friction for each condition alone", rows: sorted, columns: [{ label: "condition", value: (row) => row.condition },
    { label: "speed (rpm)", number: true, value: (row) => number(x(row), 3) },
    ...names.map((name) => ({ label: `${titleOf(name)}, without`, number: true, value: (row) => told(name, row.before?.[name]) })),
    ...(after ? names.map((name) => ({ label: `${titleOf(name)}, with`, number: true, value: (row) => told(name, row.after?.[name]) })) : [])] }),
  after ? null : note("There is no candidate that is significant, so there is only one fit."));
}
