// A diagnosis: its answer, and how that was found: where it differs, what was tried, what was found, whether it predicts.
import { block, disclosure, figure, list, note, paragraph, table } from "../dom.js";
import { INSIDE, isNumber, number, probability, pValue, readable, signed, words } from "../numbers.js";
import { intervals } from "../plots/intervals.js";
import { answer } from "./diagnosis_answer.js";
import { drift } from "./diagnosis_friction.js";
import { heldOut } from "./diagnosis_held_out.js";
import { missingAcceleration } from "./diagnosis_acceleration.js";
import { strength } from "./parameters.js";

const VERDICTS = { no_mismatch: "nothing is missing", named: "named", ambiguous: "something is missing, more than one candidate remains",
  outside_library: "something is missing that is not among the candidates", undetectable: "these data cannot tell" };
const FARTHEST = 12; // numbers shown at once

const bare = (row) => (row.observable.startsWith(`${row.condition}: `) ? row.observable.slice(row.condition.length + 2) : row.observable);

/** ["0.8189", "0.7977", "m/s"] out of "… recording 0.8189, retuned base 0.7977 m/s: …". */
function both(row) {
  const found = /recording (\S+), retuned base (\S+) ?([^:]*):/.exec(row.sentence ?? "");
  return found ? found.slice(1).map((text) => text.replace("-", "−")) : ["–", "–", ""];
}

const mismatchTable = (rows, caption) => table({ caption, rows, columns: [
  { label: "observable", value: bare }, { label: "condition", value: (row) => row.condition },
  { label: "recording", number: true, value: (row) => both(row)[0] },
  { label: "retuned base", number: true, value: (row) => both(row)[1] }, { label: "unit", value: (row) => both(row)[2] },
  { label: "z", number: true, value: (row) => signed(row.z, 2) }, { label: "p, all together", number: true, value: (row) => probability(row.p_value) }] });

function mismatch({ mismatch: rows = [], base }, key) {
  if (rows.length === 0) return null;
  const first = rows.slice(0, FARTHEST);
  const rest = rows.slice(FARTHEST);
  const names = first.map((row) => `${row.condition}: ${bare(row)}`);
  const values = first.map((row) => ({ value: row.z, hollow: !(row.p_value < 0.05), text: `z ${signed(row.z, 3)}, p ${probability(row.p_value)} for all together` }));
  return block(`${key}-mismatch`, "Where it differs",
    paragraph(`Each of ${rows.length} numbers of the recordings beside what the base gives after friction has been retuned to all of them. `
      + `The retuned base as a whole: ${pValue(base?.p_value)}.`),
    figure("Recording less retuned base, in standard deviations, the farthest first. Shaded: within 1.645, as nine of ten numbers are when nothing differs. "
      + "Hollow: not significant among so many.", intervals(`${key}-mismatch`, { label: `The ${first.length} farthest of ${rows.length} numbers: ${first.slice(0, 4)
      .map((row, index) => `${names[index]} z = ${signed(row.z, 2)}`).join(", ")}`, rows: names, groups: [{ name: "", values }],
      x: { name: "z: difference over its standard deviation" }, zero: 0, zone: [-INSIDE, INSIDE] })),
    mismatchTable(first, `The ${first.length} farthest numbers`),
    rest.length ? disclosure(`${key}-rest`, `The other ${rest.length} numbers`, () => mismatchTable(rest, "The other numbers")) : null);
}

const canMatter = (row) => (row.undetectable ? "no" : "yes");

function tried({ hypotheses = [], notes = [] }, key) {
  if (hypotheses.length === 0) return null;
  const untested = notes.filter((one) => one.startsWith("not tested"));
  const rows = [...hypotheses].sort((a, b) => a.p_value - b.p_value || b.delta_q - a.delta_q);
  return block(`${key}-tried`, "What was tried", table({ caption: "Candidates for what is missing, the likeliest first", rows,
    classOf: (row) => (row.class === "best" ? "strong" : null), columns: [
      { label: "candidate", value: (row) => words(row.name) }, { label: "kind", value: (row) => row.kind },
      { label: "judgement", value: (row) => row.class }, { label: "p, all candidates together", number: true, value: (row) => probability(row.p_value) },
      { label: "p alone", number: true, value: (row) => probability(row.p_value_alone) },
      { label: "strength (90 %)", wide: true, value: strength }, { label: "gain ΔQ", number: true, value: (row) => number(Math.abs(row.delta_q) < 1e-6 ? 0 : row.delta_q, 3) },
      { label: "κ", number: true, value: (row) => number(row.kappa, 2) }, { label: "λ", number: true, value: (row) => number(row.lambda, 3) },
      { label: "could be seen", value: canMatter }] }),
  note("p, all candidates together: how often chance would bring one of them so far. κ: part of the effect that retuned friction cannot imitate, at the strength where it shows best (0: concealed wholly). "
    + "λ: the square of that part in noise units; below 9 it cannot be seen in these data. ΔQ: by how much the candidate lowers the misfit."),
  untested.length ? disclosure(`${key}-untested`, `Not tested (${untested.length})`, () => list(untested.map((one) => one.replace(/^not tested: /, "")))) : null);
}

function found(diagnosis, key) {
  const { named = [], hypotheses = [], two_effects: pairs = [], verdict } = diagnosis;
  const lines = [];
  for (const name of named) {
    const row = hypotheses.find((one) => one.name === name);
    if (row) lines.push(`${words(name)}: ${strength(row)}; ${pValue(row.p_value)} among all candidates; with it the recordings look like a draw of the model with ${pValue(row.p_goodness)}.`);
  }
  const others = hypotheses.filter((row) => isNumber(row.p_against_best) && !named.includes(row.name));
  const second = pairs.map((pair) => `Beside ${words(pair.first)} (${pValue(pair.p_first)}), ${words(pair.second)} helps most, with ${pValue(pair.p_second)}`
    + (pair.p_second < 0.05 ? "." : ": it is not needed."));
  const why = { no_mismatch: "The base with its parameters retuned describes the recordings, so nothing was looked for further.",
    undetectable: "No candidate could be seen in these data, at any strength.", outside_library: "The base is rejected, and no candidate brings it near enough.",
    ambiguous: diagnosis.named_together ? "Two effects are asked for together." : "The candidates above cannot be told apart with these data, or the held-out data do not confirm them yet." }[verdict];
  return block(`${key}-found`, "What was found", why ? paragraph(why) : null, lines.length ? list(lines) : null,
    others.length ? table({ caption: "The other candidates: if one of them were true, how often would the best seem better by so much?", rows: others, columns: [
      { label: "candidate", value: (row) => words(row.name) }, { label: "p", number: true, value: (row) => probability(row.p_against_best) },
      { label: "judgement", value: (row) => row.class }] }) : null,
    second.length ? list(second) : null);
}

export function diagnosis(section, key) {
  const { diagnosis: told, turns } = section;
  const others = (told.notes ?? []).filter((one) => !one.startsWith("not tested"));
  return {
    kind: "Diagnosis", answer: answer(section, key), sentence: readable(told.sentence), doubts: told.doubts, headline: [
      ["Verdict", VERDICTS[told.verdict] ?? words(told.verdict), told.named?.length ? told.named.map(words).join(", ") : null],
      ["Numbers compared", number(told.base?.observables), `${number(told.bank?.used)} parameter sets simulated`]],
    blocks: [mismatch(told, key), tried(told, key), found(told, key), drift(told, key), ...heldOut(told, key), missingAcceleration(told, key, turns),
      others.length || told.bank?.failures?.length ? block(`${key}-notes`, "Notes of the diagnosis", list([...others, ...(told.bank?.failures ?? [])])) : null],
  };
}
