// A calibration: what each parameter is and how well the recordings determine it, and how that was found.
import { block, disclosure, element, figure, list, note, paragraph, table } from "../dom.js";
import { capital, interval, isNumber, number, percent, probability, pValue, quantity, words } from "../numbers.js";
import { bars, intervals } from "../plots/intervals.js";
import { progressBlock, planeBlock } from "./calibration_runs.js";
import { surfaceBlock } from "./calibration_surface.js";
import { scaleOf, titleOf } from "./parameters.js";

const value = (parameter, at) => number(at * scaleOf(parameter.name).factor);
const span = (parameter, low, high) => interval(low, high, scaleOf(parameter.name).factor);

function parameters({ parameters: all = [], posterior }, key) {
  const known = all.filter((one) => one.posterior);
  const share = (one, at) => (100 * (at - one.range[0])) / (one.range[1] - one.range[0]);
  const bar = (one) => ({ value: share(one, one.value), low: share(one, one.posterior?.low90), high: share(one, one.posterior?.high90),
    text: `${value(one, one.value)}${one.posterior ? ` (${span(one, one.posterior.low90, one.posterior.high90)})` : ""}` });
  // Where the posterior piles up at an end of the range, the end itself contradicts nothing.
  const apart = known.filter((one) => one.value < Math.min(one.posterior.low90, one.posterior.mode) || one.value > Math.max(one.posterior.high90, one.posterior.mode));
  return block(`${key}-parameters`, "Parameters", apart.map((one) => paragraph(`${capital(words(one.name))} was retuned to ${value(one, one.value)}, outside its own interval (${span(one, one.posterior.low90, one.posterior.high90)}): `
    + "that moves it where the recordings as a whole do not want it.")),
  figure("The calibrated set with 90 % intervals, as places in the range of the study: 0 % its lower end, 100 % its upper end.",
    intervals(`${key}-parameters`, { label: all.map((one) => `${words(one.name)} ${bar(one).text}`).join(", "), rows: all.map((one) => titleOf(one.name)), groups: [{ name: "", values: all.map(bar) }],
      x: { name: "place in the range of the study", unit: "%", min: 0, max: 100 }, zone: [0, 100] })),
  table({ caption: "The calibrated set", rows: all, columns: [{ label: "parameter", value: (one) => titleOf(one.name) }, { label: "value", number: true, value: (one) => value(one, one.value) },
    { label: "90 % interval", number: true, value: (one) => (one.posterior ? span(one, one.posterior.low90, one.posterior.high90) : "–") }, { label: "range of the study", number: true, value: (one) => span(one, ...one.range) },
    { label: "determined", value: (one) => one.posterior?.determined ?? "not known" }, { label: "width left", number: true, value: (one) => percent(one.posterior?.width_ratio, 2) },
    { label: "place in the case", wide: true, value: (one) => [element("code", null, one.path), one.tied?.length ? `, tied: ${one.tied.join(", ")}` : null] }] }),
  known.length ? note("Width left: the interval's width as a part of what it was before the data; well determined below a third, hardly above two thirds.") : paragraph("There is no posterior, so the intervals are not known; the notes say why."),
  posterior?.statements?.length ? list(posterior.statements) : null);
}

function screening({ screening: found }, key) {
  if (!found) return null;
  const title = (name) => words(name).replace("*", " × ");
  const rows = [...found.effects].sort((a, b) => Math.abs(b.effect) - Math.abs(a.effect));
  const all = [...rows.map((row) => ({ name: title(row.name), alias: row.alias, effect: row.effect, pooled: row.pooled, ...row.sum })),
    found.curvature && { name: "curvature", ...found.curvature }, { name: "residual", ...found.residual }].filter(Boolean);
  return block(`${key}-screening`, "Screening", figure("Effect of each factor: mean objective at its high level less the mean at its low one.",
    bars(`${key}-screening`, { label: rows.map((row) => `${title(row.name)} ${number(row.effect, 3)}`).join(", "), rows: rows.map((row) => title(row.name)), groups: [{ name: "", values: rows.map((row) => row.effect) }],
      x: { name: "effect on the objective" } })),
  table({ caption: `Analysis of variance; resolution of the plan: ${found.resolution}`, rows: all, columns: [{ label: "effect", value: (row) => row.name }, { label: "size", number: true, value: (row) => number(row.effect, 3) },
    { label: "sum of squares", number: true, value: (row) => number(row.sum, 4) }, { label: "degrees of freedom", number: true, value: (row) => number(row.df) }, { label: "F", number: true, value: (row) => number(row.F, 3) },
    { label: "p", number: true, value: (row) => probability(row.p) }, { label: "remark", value: (row) => [row.pooled ? "part of the residual" : null, row.alias ? `stands also for ${row.alias}` : null].filter(Boolean).join("; ") }] }),
  found.kept?.length ? paragraph(`Kept for the surface: ${found.kept.map(words).join(", ")}.`) : null, found.aliases?.length ? list(found.aliases) : null, found.notes?.length ? list(found.notes) : null);
}

function posterior({ parameters: all = [], posterior: found }, key) {
  const known = all.filter((one) => one.profile);
  if (!found || known.length === 0) return null;
  const share = (one, at) => (100 * (at - one.range[0])) / (one.range[1] - one.range[0]);
  const values = (which) => known.map((one) => ({ value: share(one, one.posterior?.mode ?? one.value), low: share(one, one.profile[`low_${which}`]), high: share(one, one.profile[`high_${which}`]),
    text: span(one, one.profile[`low_${which}`], one.profile[`high_${which}`]) }));
  const cells = all.map((one, row) => ({ name: one.name, row }));
  return block(`${key}-posterior`, "Posterior and profile", figure("90 % intervals of each parameter about the most probable set: with the others held, and with the others readjusted as well as they can. "
    + "Where the second is much wider, other parameters conceal this one.", intervals(`${key}-profile`, { label: known.map((one) => `${words(one.name)}: ${percent(one.profile.concealed, 2)} concealed`).join(", "), rows: known.map((one) => titleOf(one.name)),
    groups: [{ name: "others held", symbol: "square", values: values("alone") }, { name: "others readjusted", values: values("readjusted") }], x: { name: "place in the range of the study", unit: "%", min: 0, max: 100 } })),
  table({ caption: "Posterior of each parameter", rows: known, columns: [{ label: "parameter", value: (one) => titleOf(one.name) }, { label: "median", number: true, value: (one) => value(one, one.posterior?.median) },
    { label: "50 %", number: true, value: (one) => span(one, one.posterior?.low50, one.posterior?.high50) }, { label: "90 %", number: true, value: (one) => span(one, one.posterior?.low90, one.posterior?.high90) },
    { label: "others held", number: true, value: (one) => span(one, one.profile.low_alone, one.profile.high_alone) }, { label: "others readjusted", number: true, value: (one) => span(one, one.profile.low_readjusted, one.profile.high_readjusted) },
    { label: "concealed", number: true, value: (one) => percent(one.profile.concealed, 2) }] }),
  all.length > 1 && found.correlation ? table({ caption: "Correlation of the parameters", rows: cells, columns: [{ label: "", value: (cell) => words(cell.name) },
    ...all.map((other, column) => ({ label: words(other.name), number: true, value: (cell) => number(found.correlation[cell.row]?.[column], 2) }))] }) : null,
  paragraph(`Misfit at the most probable set ${number(found.misfit, 3)} for ${number(found.observables?.length)} numbers; a larger one would come by chance with ${pValue(found.misfit_probability)}. `
    + `The emulator's 90 % intervals held ${percent(found.emulator_coverage90, 2)} of left-out numbers.`));
}

const UNLIKELY = 0.01; // as in the statements of the posterior: below it no parameters fit
const OBJECTIVES = { chagas2015: "errors of power (W) and of the distributions of place and speed (%), summed (Chagas 2015, Eq. 4.3)",
  likelihood: "squared differences over their variances, summed (misfit)" };

/** Null without a posterior: then nothing is known of the fit. */
function fitOf({ posterior: found }) {
  const p = found?.misfit_probability;
  if (!isNumber(p)) return null;
  const exact = p < 1e-300 ? "p < 10⁻³⁰⁰" : p < 0.001 ? `p = ${number(p, 1)}` : pValue(p);
  return { fits: p >= UNLIKELY, told: `misfit ${number(found.misfit, 3)} for ${number(found.observables?.length)} numbers, ${exact}` };
}

function sentenceOf(found, all, fit) {
  if (fit && !fit.fits) return `No parameters fit (${fit.told}): the simulation cannot tell what was recorded, and the intervals below would hold only if it could.`;
  const values = all.map((one) => `${words(one.name)} ${value(one, one.value)}${one.posterior ? `, ${one.posterior.determined} determined` : ""}`).join("; ");
  return fit ? `${capital(values)}. The most probable set fits (${fit.told}).` : all.some((one) => one.posterior) ? `${capital(values)}.` : `The calibrated set is ${found.how}.`;
}

export function calibration(section, key) {
  const { calibration: found } = section;
  const all = found.parameters ?? [];
  const fit = fitOf(found);
  const bound = (one) => (!one.posterior ? "interval not known"
    : `${span(one, one.posterior.low90, one.posterior.high90)} (90 %), ${fit && !fit.fits ? "if anything fitted" : `${one.posterior.determined} determined`}`);
  const conditions = Object.entries(found.conditions ?? {}).map(([name, one]) => ({ name, ...one }));
  const failed = found.failed ?? [];
  return {
    kind: "Calibration", sentence: sentenceOf(found, all, fit), doubts: found.doubts,
    headline: [fit && ["Fit", fit.fits ? "yes" : "none", fit.told], ...all.map((one) => [titleOf(one.name), value(one, one.value), bound(one)]),
      ["Method", words(found.method), `objective: ${OBJECTIVES[found.objective] ?? found.objective}`], ["Simulations", number(found.simulations), failed.length ? `${failed.length} failed` : "none failed"],
      found.at_best && ["Objective at the set", number(found.at_best.objective, 3), isNumber(found.predicted_objective) ? `${number(found.predicted_objective, 3)} was predicted` : null],
      found.at_best?.chagas2015 && ["Power error at the set", quantity(found.at_best.chagas2015.power_W, "W", 3), "mean over the fitted conditions"]],
    blocks: [
      parameters(found, key), progressBlock(section, key), screening(found, key), surfaceBlock(section, key), planeBlock(section, key), posterior(found, key),
      conditions.length ? block(`${key}-conditions`, "Recordings", table({ caption: "Conditions of the study", rows: conditions, columns: [{ label: "condition", value: (row) => row.name }, { label: "role", value: (row) => words(row.role) },
        { label: "power (W)", number: true, value: (row) => number(row.power_W) }, { label: "power is", value: (row) => row.power_is }, { label: "recorded time of beads (s)", number: true, value: (row) => number(row.bead_seconds, 3) },
        { label: "numbers compared", number: true, value: (row) => number(row.observables) }] }),
      conditions.filter((row) => row.notes?.length).map((row) => disclosure(`${key}-notes-${row.name}`, `Notes of ${row.name} (${row.notes.length})`, () => list(row.notes)))) : null,
      found.notes?.length || found.how ? block(`${key}-notes`, "Notes of the calibration", paragraph(`The set is ${found.how}.`), found.notes?.length ? list(found.notes) : null) : null],
  };
}
