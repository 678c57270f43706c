// How well diagnoses met sealed answers.
import { block, element, figure, note, paragraph, table } from "../dom.js";
import { isNumber, number, percent, words } from "../numbers.js";
import { intervals } from "../plots/intervals.js";
import { lines } from "../plots/lines.js";

const COUNTS = [["false_alarms", "nothing hidden: something is said to be missing (false alarm)"], ["false_names", "nothing hidden: physics or a belief is listed"], ["false_physics", "nothing hidden: physics is named or listed"],
  ["named_alone", "one effect: named alone, and rightly"], ["top_1", "one effect: the best candidate is the truth"], ["in_class", "one effect: the truth is listed"],
  ["in_class_of_two", "one effect: listed, alone or in a class of two"], ["faint_nothing_else", "one effect, faint: no physics is listed but the truth"], ["abstained_on_effect", "one effect: said to lie outside the library (wrong)"],
  ["two_both", "two effects: both listed, as two at once"], ["two_both_in_class", "two effects: both listed"], ["two_at_least_one", "two effects: at least one listed"], ["outside_abstained", "physics outside the list: said to lie outside (right)"],
  ["outside_named", "physics outside the list: something of the list named (wrong)"], ["outside_missed", "physics outside the list: not noticed"],
  ["decoys_named", "decoy (another camera, or what is believed is wrong): physics is listed (wrong)"], ["decoys_outside", "decoy: said to lie outside the library (wrong)"]];

const share = (count) => (count?.of > 0 ? `${count.hits} of ${count.of}` : "none tried");
const bounds = (count) => (count?.of > 0 ? `${number(100 * count.low95, 2)} … ${percent(count.high95, 2)}` : "–");
const point = (count) => (count?.of > 0 ? { value: 100 * count.share, low: 100 * count.low95, high: 100 * count.high95, text: `${share(count)} (${bounds(count)})` } : null);
const countTable = (caption, rows) => table({ caption, rows, columns: [{ label: "", wide: true, value: (row) => row[0] }, { label: "counted", number: true, value: (row) => share(row[1]) },
  { label: "share", number: true, value: (row) => percent(row[1]?.of > 0 ? row[1].share : NaN) }, { label: "90 % interval", number: true, value: (row) => bounds(row[1]) }] });
const SHARE = { unit: "%", min: 0, max: 100 };

/// What a test of one number with known noise would reach.
function ideal(bins) {
  if (!bins.some((bin) => isNumber(bin.ideal))) return [];
  return [{ name: "ideal test of one number", values: bins.map((bin) => (isNumber(bin.ideal) ? { value: 100 * bin.ideal, low: 100 * bin.ideal, high: 100 * bin.ideal, text: percent(bin.ideal) } : null)) }];
}

/// Whether practice, with a base tuned in one way, would have missed that something is missing.
function concealed(row, seen) {
  if (!seen || row.truth === "none" || row.truth.startsWith("decoy")) return "";
  return seen.unsuspicious ? "yes" : "no";
}

function power(score, key) {
  const bins = (score.power ?? []).filter((bin) => bin.named?.of > 0);
  if (bins.length === 0) return null;
  const rows = bins.map((bin) => (isNumber(bin.lambda_to) ? `λ ${number(bin.lambda_from)} to ${number(bin.lambda_to)}` : `λ above ${number(bin.lambda_from)}`));
  return block(`${key}-power`, "Power", figure("How often a hidden effect is listed, alone or in a class of two, against its size λ (square of what friction cannot imitate, in noise units).",
    intervals(`${key}-power`, { label: rows.map((row, index) => `${row}: ${share(bins[index].named)}`).join(", "), rows, groups: [{ name: "listed", values: bins.map((bin) => point(bin.named)) }].concat(ideal(bins)),
      x: { name: "listed", ...SHARE } })));
}

function strengths(score, key) {
  const { estimates: all = [], slope, intercept, without_faint: clear = {}, at_zero: zero = [] } = score.strengths ?? {};
  if (all.length === 0) return null;
  const of = (named) => all.filter((one) => one.named === named).map((one) => [100 * one.truth, 100 * one.estimate]);
  const most = Math.max(100, ...all.map((one) => 100 * Math.max(one.truth, one.estimate)));
  const least = Math.min(0, ...all.map((one) => 100 * Math.min(one.truth, one.estimate)));
  const series = [{ name: "listed", dots: true, points: of(true) }, { name: "not listed", dots: true, outline: true, points: of(false) },
    { name: "hidden = estimated", points: [[least, least], [most, most]], dashed: true, colour: "#7f7f7f", width: 1.2 }].filter((one) => one.points.length);
  if (isNumber(slope) && isNumber(intercept)) series.push({ name: "least squares", points: [least, most].map((x) => [x, 100 * intercept + slope * x]), width: 1.4, colour: "#009e73" });
  return block(`${key}-strengths`, "Strengths", figure("Hidden against estimated strength, 100 % the far end of the prior range, whether the effect was listed or not.",
    lines(`${key}-strengths`, { label: `${all.length} hidden strengths and their estimates`, series, hover: "item", x: { name: "hidden strength", unit: "%", min: Math.floor(least / 10) * 10, max: Math.ceil(most / 10) * 10 },
      y: { name: "estimated strength", unit: "%" }, height: 340 })),
  isNumber(slope) ? paragraph(`Least squares: estimate = ${number(100 * intercept, 3)} % + ${number(slope, 3)} × hidden${isNumber(clear.slope) ? `; without faint effects ${number(100 * clear.intercept, 3)} % + ${number(clear.slope, 3)} × hidden` : ""}.`) : null,
  zero.length ? note(`Where nothing was hidden, the mean estimated strength is ${percent(zero.reduce((sum, value) => sum + value, 0) / zero.length)} of the range (${zero.length} estimates).`) : null);
}

function confusion({ confusion: found }, key) {
  if (!found?.truths?.length) return null;
  const rows = found.truths.map((truth, index) => ({ truth, counts: found.counts[index] }));
  return block(`${key}-confusion`, "Confusion", table({ caption: "Hidden (rows) and said (columns), numbers of sets", rows, columns: [{ label: "hidden", value: (row) => words(row.truth) },
    ...found.diagnoses.map((name, index) => ({ label: words(name), number: true, value: (row) => number(row.counts[index]) }))] }));
}

export function challenge(section, key) {
  const { score } = section;
  const alarms = score.false_alarms ?? {};
  const todo = score.sets - score.diagnosed;
  const covered = (row) => `${words(row.of)}${isNumber(row.truth) ? `, truth ${number(row.truth, 3)}` : ""}${row.engine ? `, played by ${row.engine}` : ""}`;
  const coverage = (score.coverage ?? []).map((row) => [covered(row), row.inside]);
  return {
    kind: "Challenge", sentence: alarms.of > 0 ? `False alarms: ${share(alarms)}; with 95 % confidence the rate is below ${percent(alarms.high95)}.` : "No set with nothing hidden was diagnosed: false alarms are not known.",
    headline: [["False alarms", share(alarms), alarms.of > 0 ? `below ${percent(alarms.high95)} with 95 % confidence` : null], ["Best candidate is the truth", share(score.top_1), bounds(score.top_1)],
      ["Truth listed", share(score.in_class), isNumber(score.mean_class_size) ? `${number(score.mean_class_size, 3)} listed in the mean` : null],
      ["Sets", number(score.sets), `${number(score.diagnosed)} diagnosed${todo ? `, ${todo} to be diagnosed` : ""}${score.failed ? `, ${score.failed} failed` : ""}`]],
    blocks: [
      block(`${key}-counts`, "What was counted", countTable("Counts with 90 % intervals (Clopper & Pearson 1934)", COUNTS.filter(([name]) => score[name]).map(([name, text]) => [text, score[name]]))),
      power(score, key), strengths(score, key), confusion(score, key),
      block(`${key}-coverage`, "Intervals", countTable("How often the 90 % intervals hold the truth", coverage),
        score.recovery?.length ? table({ caption: "Mean distance of parameters from the truth", rows: score.recovery, columns: [{ label: "parameter", value: (row) => words(row.parameter) },
          { label: "sets", number: true, value: (row) => number(row.sets) }, { label: "retuned", number: true, value: (row) => number(row.error_retuned, 3) },
          { label: "unmasked", number: true, value: (row) => number(row.error_unmasked, 3) }] }) : null),
      score.held_out?.length ? block(`${key}-held-out`, "Held-out gain", table({ caption: "Where the best candidate is right: gain of the corrected model on each rival", rows: score.held_out, columns: [
        { label: "against", value: (row) => row.against }, { label: "surely better", number: true, value: (row) => share(row.surely) }, { label: "90 % interval", number: true, value: (row) => bounds(row.surely) },
        { label: "median gain in misfit", number: true, value: (row) => number(row.median_improvement, 3) }] })) : null,
      score.every_set?.length ? block(`${key}-sets`, "Every set", element("div", { class: "tall" }, table({ caption: "What was hidden and what was said", rows: score.every_set, columns: [
        { label: "set", value: (row) => row.set }, { label: "hidden", value: (row) => words(row.truth) }, { label: "concealed: friction retuned to power", value: (row) => concealed(row, row.practice?.to_power) },
        { label: "concealed: refitted to everything", value: (row) => concealed(row, row.practice?.to_all) },
        { label: "diagnosis", wide: true, value: (row) => (row.failure ? element("span", { class: "fail" }, `failed: ${row.failure}`) : words(row.diagnosis ?? "not yet diagnosed")) }] }))) : null,
      score.manifest_hash ? block(`${key}-seal`, "Seal", paragraph("Hash of the manifest of sealed answers: ", element("code", null, score.manifest_hash))) : null],
  };
}
