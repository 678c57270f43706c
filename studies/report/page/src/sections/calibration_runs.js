// The campaign of a calibration: objective against simulation by stage, and where in the parameters it looked.
import { block, disclosure, element, figure, table } from "../dom.js";
import { isNumber, number, words } from "../numbers.js";
import { lines } from "../plots/lines.js";
import { colouring } from "../colours.js";
import { colourBar } from "../plots/map.js";
import { plane } from "../plots/plane.js";
import { range, roundRange } from "../plots/axes.js";
import { scaleOf, titleOf } from "./parameters.js";

/** "round 3" and "round 4" are one stage of a chart; the table tells them apart. */
const stageOf = (text) => String(text).replace(/ \d+$/, "s");

const STAGE_SYMBOLS = ["circle", "rect", "triangle", "diamond", "roundRect", "arrow", "pin"];

export function trials({ runs, calibration }) {
  const { columns = [], rows = [] } = runs ?? {};
  const at = (row, name) => row[columns.indexOf(name)];
  return rows.map((row, index) => ({ number: at(row, "number") || index + 1, stage: at(row, "stage") ?? "", state: at(row, "state"), replicate: at(row, "replicate"), objective: isNumber(at(row, "objective")) ? at(row, "objective") : null,
    wall: at(row, "wall_s"), message: at(row, "message") ?? "", point: (calibration.parameters ?? []).map((parameter) => at(row, parameter.name)) }));
}

export function progressBlock(section, key) {
  const all = trials(section);
  const done = all.filter((trial) => trial.objective !== null);
  if (done.length === 0) return null;
  const stages = [...new Set(all.map((trial) => stageOf(trial.stage)))];
  const values = done.map((trial) => trial.objective);
  const log = Math.min(...values) > 0 && Math.max(...values) / Math.min(...values) > 20;
  let least = Infinity;
  const best = done.map((trial) => [trial.number, (least = Math.min(least, trial.objective))]);
  const [low, high] = roundRange(range(values));
  const failed = all.filter((trial) => trial.state === "failed");
  const series = stages.map((stage, index) => ({ name: stage, dots: true, symbol: STAGE_SYMBOLS[index % STAGE_SYMBOLS.length], size: 9,
    points: done.filter((trial) => stageOf(trial.stage) === stage).map((trial) => [trial.number, trial.objective]) })).filter((one) => one.points.length);
  if (failed.length) series.push({ name: "failed", dots: true, symbol: "path://M0 0L2 0L5 3L8 0L10 0L6 5L10 10L8 10L5 7L2 10L0 10L4 5Z", size: 12, colour: "#d55e00", points: failed.map((trial) => [trial.number, log ? Math.max(...values) : high]) });
  series.push({ name: "best so far", points: best, dashed: true, colour: "#7f7f7f", width: 1.4 });
  const { parameters = [] } = section.calibration;
  return block(`${key}-campaign`, "The campaign as it went", figure(`Objective (${section.calibration.objective}) of each simulated set, in the order in which they were asked for.`
    + `${failed.length ? " Crosses at the top edge: failed." : ""}`, lines(`${key}-campaign`, { label: `Objective of ${done.length} simulated sets, from ${number(Math.max(...values), 3)} down to ${number(Math.min(...values), 3)}`, series, hover: "item",
    x: { name: "simulation", min: 0, max: all.length + 1 }, y: { name: "objective", log, min: log ? undefined : Math.max(0, low), max: log ? undefined : high }, height: 330 })),
  disclosure(`${key}-trials`, `All ${all.length} simulated sets`, () => element("div", { class: "tall" }, table({ caption: "Simulated sets", rows: all, columns: [{ label: "number", number: true, header: true, value: (trial) => number(trial.number) },
    { label: "stage", value: (trial) => trial.stage }, ...parameters.map((parameter, index) => ({ label: titleOf(parameter.name), number: true, value: (trial) => number(trial.point[index] * scaleOf(parameter.name).factor) })),
    { label: "objective", number: true, value: (trial) => number(trial.objective) }, { label: "computed for (s)", number: true, value: (trial) => number(trial.wall, 3) },
    { label: "remark", value: (trial) => (trial.state === "failed" ? element("span", { class: "fail" }, `failed: ${trial.message}`) : trial.replicate > 0 ? "repeated with another seed" : "") }] }))));
}

const chosen = new Map();

export function planeBlock(section, key) {
  const { parameters = [], best = [], posterior } = section.calibration;
  const all = trials(section).filter((trial) => trial.objective !== null || trial.state === "failed");
  if (parameters.length < 2 || all.length === 0) return null;
  const holder = element("div");
  const current = () => chosen.get(key) ?? [0, 1];
  const draw = () => {
    const [a, b] = current();
    const by = [a, b].map((index) => scaleOf(parameters[index].name).factor);
    const values = all.map((trial) => trial.objective).filter(isNumber);
    const scale = colouring(values, { signed: false });
    const text = (trial) => [["simulation", number(trial.number)], ["stage", trial.stage], ["objective", number(trial.objective, 3)]];
    const point = (set) => ({ x: set[a] * by[0], y: set[b] * by[1] });
    const ends = (index, factor) => {
      const [low, high] = parameters[index].range.map((end) => end * factor);
      const beyond = 0.04 * (high - low);
      return { name: words(parameters[index].name), unit: scaleOf(parameters[index].name).unit, min: low - beyond, max: high + beyond };
    };
    const groups = [{ name: "simulated", points: all.filter((trial) => trial.objective !== null).map((trial) => ({ ...point(trial.point), value: trial.objective, text: text(trial) })) },
      { name: "failed", symbol: "triangle", fill: "#7f7f7f", points: all.filter((trial) => trial.objective === null).map((trial) => ({ ...point(trial.point), text: [["why", trial.message]] })) },
      { name: "calibrated set", symbol: "diamond", size: 17, fill: "#d55e00", points: [{ ...point(best), text: parameters.map((one, index) => [words(one.name), number(best[index])]) }] }];
    if (posterior?.mode) groups.push({ name: "most probable set", symbol: "rect", size: 11, fill: "#e69f00", points: [{ ...point(posterior.mode), text: parameters.map((one, index) => [words(one.name), number(posterior.mode[index])]) }] });
    const [x, y] = [ends(a, by[0]), ends(b, by[1])];
    holder.replaceChildren(plane(`${key}-plane`, { label: `${all.length} simulated sets over ${x.name} and ${y.name}`, x, y, colour: scale?.colour ?? (() => "#888888"), groups: groups.filter((group) => group.points.length), height: 420 }),
      colourBar(scale, { name: "objective" }) ?? "");
  };
  draw();
  const select = (position) => element("select", { "aria-label": position === 0 ? "Parameter to the right" : "Parameter upwards", change: (event) => {
    const next = [...current()];
    next[position] = Number(event.target.value);
    if (next[0] === next[1]) next[1 - position] = (next[position] + 1) % parameters.length;
    chosen.set(key, next);
    chooser.querySelectorAll("select").forEach((one, index) => (one.value = next[index]));
    draw();
  } }, parameters.map((one, index) => element("option", { value: index, selected: index === current()[position] }, words(one.name))));
  const chooser = element("div", { class: "chooser" }, "To the right:", select(0), "upwards:", select(1));
  return block(`${key}-plane`, "Where it looked", parameters.length > 2 ? chooser : null, figure("Every simulated set in the colour of its objective, within the ranges of the study.", holder));
}
