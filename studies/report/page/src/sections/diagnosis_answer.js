// The answer of a diagnosis: what was left out, what to do next, and before and after: at the held-out speed, and of friction.
import { block, element, figure, paragraph, table } from "../dom.js";
import { doubtsElement } from "../doubts.js";
import { hint } from "../chart.js";
import { INSIDE, capital, isNumber, number, pValue, readable, scale, signed, words } from "../numbers.js";
import { range, roundRange } from "../plots/axes.js";
import { lines } from "../plots/lines.js";
import { frictionBlock } from "./diagnosis_friction.js";
import { CORRECTED, TO_ALL, TO_POWER } from "./models.js";
import { strength } from "./parameters.js";

const either = (names) => (names.length < 2 ? names.join("") : `${names.slice(0, -1).join(", ")} or ${names[names.length - 1]}`);

function namedSentence(row, unmasked) {
  const p = pValue(row.p_value);
  const unknown = row.kind === "nuisance" ? "what it is, is not known" : "how strong it is, is not known";
  const amount = unmasked ? strength(row, "90 %: ") : unknown;
  return row.kind === "nuisance" ? `The case states ${words(row.name)} wrongly: ${amount}; ${p}.` : `The simulation leaves out ${words(row.name)}: ${amount}; ${p}.`;
}

function ambiguousSentence({ named = [], named_together: together, two_effects: pairs = [], held_out: held = [] }, best) {
  const names = named.map(words);
  if (together) return `The simulation leaves out two things together: ${names.join(" and ")} (${pValue(pairs[0]?.p_second)} for the second beside the first).`;
  if (names.length > 1) return `Something is left out (${pValue(best?.p_value)}), but these recordings cannot tell which: ${either(names)}.`;
  return `${capital(names.join())} may be left out (${pValue(best?.p_value)}), but ${held.length ? "the held-out recording does not confirm it" : "no recording was held out to confirm it"}.`;
}

/** The verdict in one sentence. */
function verdictSentence(found, best) {
  const named = (found.hypotheses ?? []).find((row) => row.name === found.named?.[0]);
  const base = pValue(found.base?.p_value);
  switch (found.verdict) {
    case "named": return namedSentence(named, found.contact_parameters?.unmasked);
    case "ambiguous": return ambiguousSentence(found, best);
    case "outside_library": return best ? `Something is left out that is not among the candidates: ${words(best.name)} helps most, but does not suffice (${base} for the retuned simulation).` : readable(found.sentence);
    case "no_mismatch": return `Nothing is left out that these recordings could show: once retuned, the simulation describes them (${base}).`;
    case "undetectable": return "These recordings cannot tell: no candidate could be seen in them, at any strength.";
    default: return readable(found.sentence);
  }
}

/** Held-out conditions where a verdict of no mismatch does not hold: the rule of the diagnosis. */
function contradicted({ verdict, held_out: held = [], level }) {
  const differ = held.filter((one) => isNumber(one.p_base) && one.p_base <= level / held.length);
  return ["no_mismatch", "undetectable"].includes(verdict) && differ.length
    ? element("p", { class: "missing" }, `But something differs where it was not fitted: ${differ.map((one) => `${one.condition} (${pValue(one.p_base)})`).join(", ")}.`) : null;
}

function next(found, source) {
  if (found.next_experiment) return readable(found.next_experiment);
  if (found.verdict === "named") return ["Run the corrected case: ", element("code", null, `millscope run ${source}/corrected/case.yaml `, element("span", { class: "whole" }, "-o corrected"))];
  return "Use the retuned case. It may still lack what these data cannot show.";
}

/** What practice knows: numbers of the whole mill, and the misfit of all numbers together. A row for the recording and for each model. */
function figures(held, sides) {
  const of = (side) => held.models.find((model) => model.model === side.model);
  const whole = (held.observables ?? []).filter((row) => row.observable !== "power" && !/\d/.test(row.observable));
  const watts = scale("W", [held.recorded_power_W]);
  const power = ({ power_W: value, power_percent: error }) => [number(value * watts.factor), isNumber(error) ? element("small", null, `${signed(error, 2)}\u00a0%`) : null];
  const recorded = { name: "recorded" };
  return table({ caption: `${held.condition}, which was not fitted; what the fitted parameters are off by adds to the misfit`, rows: [recorded, ...sides], classOf: (side) => (side.model === CORRECTED.model ? "strong" : null), columns: [
    { label: "", value: (side) => side.name },
    isNumber(held.recorded_power_W) && { label: `power (${watts.unit})`, number: true, value: (side) => power(side === recorded ? { power_W: held.recorded_power_W } : of(side)) },
    ...whole.map((row) => ({ label: `${row.observable} (${row.unit})`, number: true, value: (side) => number(row[side === recorded ? "recorded" : side.model]) })),
    { label: "misfit; 1 is chance", number: true, value: (side) => (side === recorded ? "" : number(of(side).misfit, 2)) }].filter(Boolean) });
}

const groupOf = (name) => (/^(x|y|z) /.test(name) ? `along ${name[0]}` : /of the shell's$/.test(name) ? "speed" : /^(occupancy|speed) /.test(name) ? "by region" : "the whole mill");

/** Where each kind of number begins, for the lines that part them. */
function parts(rows) {
  const groups = rows.map((row) => groupOf(row.observable));
  return groups.flatMap((name, index) => (index === 0 || name !== groups[index - 1] ? [{ x: index + 0.5, text: name }] : []));
}

/** Every number of the held-out recording less what the models say of it; null where the file does not have it yet. */
function picture(held, sides, id) {
  const rows = held.observables ?? [];
  if (!rows.some((row) => row.z)) return null;
  const series = sides.map((side, index) => ({ name: side.name, colour: side.colour, dots: true, size: 7, symbol: ["rect", "triangle", "circle"][index],
    points: rows.flatMap((row, place) => (isNumber(row.z?.[side.model]) ? [[place + 1, row.z[side.model]]] : [])) }));
  const [low, high] = roundRange(range([-3, 3, ...series.flatMap((one) => one.points.map((point) => point[1]))]));
  const chance = { name: "", unlisted: true, points: [], colour: "#7f7f7f", band: [[0, -INSIDE, INSIDE], [rows.length + 1, -INSIDE, INSIDE]] };
  const groups = parts(rows);
  return figure(`Each number of ${held.condition}: recording less model, in standard deviations. Shaded: where nine of ten lie when nothing differs. `
    + `From the left: ${groups.map((one) => one.text).join(", ")}.`,
    lines(id, { label: sides.map((side) => `${side.name}: misfit ${number(held.models.find((model) => model.model === side.model).misfit, 2)}`).join(", "), series: [...series, chance],
      x: { name: `the ${rows.length} numbers of the recording`, min: 0, max: rows.length + 1 }, y: { name: "standard deviations", min: low, max: high },
      marks: groups.slice(1), hover: "item", describe: ([place, z], name) => hint(rows[place - 1].observable, [[name, signed(z, 2)]]) }));
}

/** after: the name of the model with the best candidate; it is corrected where that is named. */
function beforeAndAfter(held, key, index, after) {
  const sides = [TO_POWER, TO_ALL, { ...CORRECTED, name: after }].filter((side) => held.models?.some((model) => model.model === side.model));
  if (sides.length === 0) return null;
  const id = `${key}-after-${index + 1}`;
  const corrected = sides.some((side) => side.model === CORRECTED.model);
  return block(id, corrected ? `Before and after, at ${held.condition}` : `The retuned simulation at ${held.condition}`,
    corrected ? paragraph(`The ${after === CORRECTED.name ? "corrected simulation" : `simulation ${after}`} ${held.improves_on_every_rival ? "predicts this recording better than every other model that was tried." : "does not surely predict this recording better than every other model."}`) : null,
    figures(held, sides), picture(held, sides, `${id}-picture`));
}

export function answer(section, key) {
  const { diagnosis: found, source } = section;
  const best = (found.hypotheses ?? []).find((row) => row.class === "best");
  const after = found.verdict === "named" ? CORRECTED.name : `with ${words(best?.name ?? "")}`;
  return element("section", { class: "answer", id: `${key}-answer`, "data-title": section.title }, element("h2", null, "The answer"),
    element("p", { class: "sentence" }, verdictSentence(found, best)), doubtsElement(found.doubts), contradicted(found),
    element("p", { class: "next" }, element("strong", null, "Next: "), next(found, source)),
    (found.held_out ?? []).map((held, index) => beforeAndAfter(held, key, index, after)), frictionBlock(found, key));
}
